// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/filter/control.hpp"
#include "wakeline/filter/start.hpp"
#include "wakeline/measurement/concept.hpp"
#include "wakeline/motion/concept.hpp"

namespace wakeline {

/// Throws what `model.validate()` throws, where the model has one.
template <class Model>
const Model& validated(const Model& model) {
  if constexpr (requires { model.validate(); }) model.validate();
  return model;
}

/// `kOk` when time goes forward by a finite step.
template <class Scalar>
Status check_time_step(Scalar dt_s) noexcept {
  using std::isfinite;
  if (!isfinite(dt_s)) return Status::kNotFinite;
  return dt_s < Scalar(0) ? Status::kNegativeTimeStep : Status::kOk;
}

/// What every filter over one motion model shares: the model, the belief and its start.
template <class MotionType, class ScalarType>
class Belief {
  static_assert(MotionModel<MotionType>,
                "wakeline: this motion model is neither linear (kComponents, matrix(dt_s), "
                "process_noise(dt_s)) nor "
                "nonlinear (kComponents, transition(x, dt_s), jacobian(x, dt_s), process_noise(x, "
                "dt_s)); see "
                "cpp/docs/concepts.md");

 public:
  using Motion = MotionType;
  using Scalar = ScalarType;
  static constexpr auto kComponents = Motion::kComponents;
  static constexpr int kStates = kStatesOf<Motion>;

  /// Throws `std::invalid_argument` when a parameter of the model makes no sense.
  explicit Belief(const Motion& motion) : motion_(validated(motion)) {}

  /// Begins with `belief`; refuses one whose covariance is not symmetric positive definite.
  Status start(const Gaussian<kStates, Scalar>& belief) noexcept {
    if (const Status status = check(belief); status != Status::kOk) return status;
    belief_ = belief;
    mirror_lower<Scalar, kStates>(belief_.covariance);
    started_ = true;
    return Status::kOk;
  }

  /// Begins with a belief over `[x, vx, y, vy]`; the other components get the model's prior.
  Status start(const Gaussian<4, Scalar>& kinematics) noexcept
      requires(kStates != 4 && holds(kComponents, kKinematics)) {
    return start(lift(motion_, kinematics));
  }

  /// Replaces the belief, unchecked.
  [[gnu::flatten]] Status assign(const Gaussian<kStates, Scalar>& belief) noexcept {
    belief_ = belief;
    started_ = true;
    return Status::kOk;
  }

  /// Replaces the motion model, unchecked; the belief stays.
  void set_motion(const Motion& motion) noexcept { motion_ = motion; }

  /// Saves or restores the belief.
  void archive(Archive& fields) {
    fields(belief_.mean);
    fields(belief_.covariance);
    fields(started_);
  }

  [[nodiscard]] const Gaussian<kStates, Scalar>& estimate() const noexcept { return belief_; }
  [[nodiscard]] const Motion& motion() const noexcept { return motion_; }
  [[nodiscard]] bool started() const noexcept { return started_; }

 protected:
  friend struct Control;
  Vec<Scalar, kStates>& mean() noexcept { return belief_.mean; }

  Motion motion_;
  Gaussian<kStates, Scalar> belief_;
  bool started_ = false;
};

/// Rows of the state that a sensor reads.
template <class Sensor, std::size_t N>
constexpr Rows<Sensor::kReads.size()> rows_read(
    const std::array<Component, N>& components) noexcept {
  return rows_of(components, Sensor::kReads);
}

template <class Sensor, class Filter>
constexpr void check_sensor() noexcept {
  static_assert(
      MeasurementModel<Sensor>,
      "wakeline: this sensor needs kReads, kMeasurements, observe(z), measure(x), jacobian(x) and "
      "residual(a, b); see cpp/docs/concepts.md");
  static_assert(
      holds(Filter::kComponents, Sensor::kReads),
      "wakeline: this sensor reads a component that the state of the motion model does not hold");
}

/// True when a posterior variance is lost in the rounding of the prior one, and P - K S Kᵀ will not
/// do.
template <class Scalar, int N>
bool cancels(const Mat<Scalar, N, N>& prior, const Mat<Scalar, N, N>& posterior) noexcept {
  constexpr Scalar kSafe = sizeof(Scalar) > 4 ? Scalar(1e-8) : Scalar(1e-3);
  bool safe = true;
  for (int i = 0; i < N; ++i) safe = safe && posterior(i, i) > kSafe * prior(i, i);
  return !safe;
}

/// Why an innovation covariance has no Cholesky factor.
template <class Scalar, int M>
Status refusal(const Mat<Scalar, M, M>& innovation_covariance) noexcept {
  return is_finite(innovation_covariance) ? Status::kNotPositiveDefinite : Status::kNotFinite;
}

/// NIS = |L⁻¹ v|², and the status of a step that got so far.
template <int M, class Scalar>
void rate(Step<M, Scalar>& step, const Vec<Scalar, M>& whitened) noexcept {
  using std::isfinite;
  step.nis = whitened.squaredNorm();
  step.status = isfinite(step.nis) ? Status::kOk : Status::kNotFinite;
}

/// The likelihood part of a step, NIS and ln N(v; 0, S), and its status.
template <int M, class Scalar>
void score(Step<M, Scalar>& step, const Vec<Scalar, M>& whitened,
           const Cholesky<M, Scalar>& factor) noexcept {
  constexpr Scalar kLog2Pi = Scalar(1.837877066409345483560659472811235279723);
  rate(step, whitened);
  step.log_likelihood = -(step.nis + factor.log_determinant() + Scalar(M) * kLog2Pi) / 2;
}

}  // namespace wakeline
