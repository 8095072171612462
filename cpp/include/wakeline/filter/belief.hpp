// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/filter/control.hpp"
#include "wakeline/filter/start.hpp"
#include "wakeline/measurement/concept.hpp"
#include "wakeline/motion/concept.hpp"

namespace wakeline {

/// Base of the filters with one motion model: the model, the belief and its start.
template <class MotionType, class ScalarType>
class Belief {
  static_assert(MotionModel<MotionType>,
                "wakeline: this motion model is neither linear (kComponents, matrix(dt_s), "
                "process_noise(dt_s)) nor "
                "nonlinear (kComponents, transition(x, dt_s), jacobian(x, dt_s), process_noise(x, "
                "dt_s)), with the sizes given by kComponents; see cpp/docs/concepts.md");

 public:
  using Motion = MotionType;
  using Scalar = ScalarType;
  static constexpr auto kComponents = Motion::kComponents;
  static constexpr int kStates = kStatesOf<Motion>;

  /// Throws `std::invalid_argument` when a parameter of the model is invalid.
  explicit Belief(const Motion& motion) : motion_(validated(motion)) { check_components<Motion>(); }

  /// Starts with `belief`; rejects one that is not finite or whose covariance is not symmetric
  /// positive definite.
  StatusOf<Scalar> start(const Gaussian<kStates, Scalar>& belief) noexcept {
    const StatusOf<Scalar> status = check(belief);
    if (none(ok(status))) return status;
    assign_where(ok(status), belief_, belief);
    mirror_lower<Scalar, kStates>(belief_.covariance);
    started_ = true;
    return status;
  }

  /// Starts with a belief over `[x, vx, y, vy]`; the other components get the model's prior.
  StatusOf<Scalar> start(const Gaussian<4, Scalar>& kinematics) noexcept
      requires(kStates != 4 && holds(kComponents, kKinematics)) {
    return start(lift(motion_, kinematics));
  }

  /// Replaces the belief, unchecked.
  [[gnu::always_inline]] StatusOf<Scalar> assign(const Gaussian<kStates, Scalar>& belief) noexcept {
    copy(belief, belief_);
    started_ = true;
    return Status::kOk;
  }

  /// The belief for assignment in place, unchecked.
  [[nodiscard, gnu::always_inline]] Gaussian<kStates, Scalar>& to_assign() noexcept {
    started_ = true;
    return belief_;
  }

  /// Replaces the belief in some lanes, unchecked.
  void assign_in(const MaskOf<Scalar>& lanes, const Gaussian<kStates, Scalar>& belief) noexcept {
    assign_where(lanes, belief_, belief);
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

/// Names what a sensor lacks where a filter cannot take it.
template <class Sensor, class Filter>
constexpr void check_sensor() noexcept {
  static_assert(
      MeasurementModel<Sensor>,
      "wakeline: this sensor needs kReads, kMeasurements, observe(z), measure(x), jacobian(x) and "
      "residual(a, b), with the sizes given by the first two; see cpp/docs/concepts.md");
  if constexpr (MeasurementModel<Sensor>)
    static_assert(
        holds(Filter::kComponents, Sensor::kReads),
        "wakeline: this sensor reads a component that the state of the motion model does not hold");
}

/// An observed reading as a filter takes it: of a `SensorAtPrediction` beside the belief over
/// `kComponents`, else as it is.
template <auto kComponents, class Sensor, class Scalar, int N>
[[gnu::always_inline]] inline Gaussian<Sensor::kMeasurements, Scalar> at_prediction(
    const Sensor& sensor, const Gaussian<Sensor::kMeasurements, Scalar>& reading,
    const Gaussian<N, Scalar>& belief) noexcept {
  if constexpr (SensorAtPrediction<Sensor>) {
    constexpr int kReads = kReadsOf<Sensor>;
    constexpr auto kRows = rows_read<Sensor>(kComponents);
    Gaussian<kReads, Scalar> read;
    unroll<kReads>([&](int j) {
      read.mean[j] = belief.mean[kRows[j]];
      unroll<kReads>([&](int i) { read.covariance(i, j) = belief.covariance(kRows[i], kRows[j]); });
    });
    return sensor.at_prediction(reading, read);
  } else {
    return reading;
  }
}

/// P Hᵀ of a sensor that reads `kRows` of the state, and S = H P Hᵀ + R in place of R.
template <class Sensor, auto kRows, class Scalar, int N, int M, int Reads>
[[gnu::always_inline]] inline void project(const Mat<Scalar, N, N>& p,
                                           const Mat<Scalar, M, Reads>& h, Mat<Scalar, N, M>& ph,
                                           Mat<Scalar, M, M>& s) noexcept {
  unroll<M>([&](int m) {
    unroll<N>([&](int i) {
      if constexpr (kIsDirect<Sensor>) {
        ph(i, m) = p(i, kRows[m]);
      } else {
        Scalar sum = h(m, 0) * p(i, kRows[0]);
        unroll<Reads - 1>([&](int k) { sum += h(m, k + 1) * p(i, kRows[k + 1]); });
        ph(i, m) = sum;
      }
    });
  });
  unroll_lower<M>([&](int m, int n) {
    Scalar sum = s(m, n);
    if constexpr (kIsDirect<Sensor>)
      sum += ph(kRows[m], n);
    else
      unroll<Reads>([&](int k) { sum += h(m, k) * ph(kRows[k], n); });
    s(m, n) = s(n, m) = sum;
  });
}

/// x += W v.
template <class Scalar, int N, int M>
[[gnu::always_inline]] inline void shift(Vec<Scalar, N>& x, const Mat<Scalar, N, M>& w,
                                         const Vec<Scalar, M>& v) noexcept {
  unroll<N>([&](int i) {
    Scalar element = x[i];
    unroll<M>([&](int m) { element += w(i, m) * v[m]; });
    x[i] = element;
  });
}

/// P -= W Wᵀ, symmetric to the last bit.
template <class Scalar, int N, int M>
[[gnu::always_inline]] inline void subtract_gram(Mat<Scalar, N, N>& p,
                                                 const Mat<Scalar, N, M>& w) noexcept {
  unroll_lower<N>([&](int i, int j) {
    Scalar element = p(i, j);
    unroll<M>([&](int m) { element -= w(i, m) * w(j, m); });
    p(i, j) = p(j, i) = element;
  });
}

/// True when a posterior variance is lost in the rounding of the prior one, so that P - K S Kᵀ is
/// not accurate. In `float` this is common: a thin ellipse oblique to the axes loses its short axis
/// long before either variance is small.
template <class Scalar, int N>
[[gnu::always_inline]] inline MaskOf<Scalar> cancels(const Mat<Scalar, N, N>& prior,
                                                     const Mat<Scalar, N, N>& posterior) noexcept {
  constexpr auto kSafe = sizeof(RealOf<Scalar>) > 4 ? RealOf<Scalar>(1e-8) : RealOf<Scalar>(0.1);
  MaskOf<Scalar> safe = true;
  unroll<N>([&](int i) { safe = safe && posterior(i, i) > kSafe * prior(i, i); });
  return !safe;
}

/// The reason why an innovation covariance has no Cholesky factor.
template <class Scalar, int M>
StatusOf<Scalar> factor_failure(const Mat<Scalar, M, M>& innovation_covariance) noexcept {
  return first_failure(ok_or(is_finite(innovation_covariance), Status::kNotFinite),
                       Status::kNotPositiveDefinite);
}

/// The square root of 2π.
inline constexpr double kRootOf2Pi = 2.506628274631000502415765284811045253007;

/// Sets NIS = |L⁻¹ v|², the peak of the likelihood, and the status of a correction.
template <int M, class Scalar>
void rate(Correction<M, Scalar>& correction, const Vec<Scalar, M>& whitened,
          const Cholesky<M, Scalar>& factor) noexcept {
  using std::isfinite;
  constexpr double kScale = [] {
    double scale = 1.0;
    for (int m = 0; m < M; ++m) scale /= kRootOf2Pi;
    return scale;
  }();
  correction.nis = whitened[0] * whitened[0];
  unroll<M - 1>([&](int m) { correction.nis += whitened[m + 1] * whitened[m + 1]; });
  correction.peak = RealOf<Scalar>(kScale) * factor.inverse_root_determinant();
  // Branch-free, because GCC 12 fails on the masks of a branch.
  constexpr auto kUnknown = std::numeric_limits<RealOf<Scalar>>::quiet_NaN();
  const auto definite = factor.ok();
  correction.nis = select(definite, correction.nis, Scalar(kUnknown));
  correction.peak = select(definite, correction.peak, Scalar(0));
  // The most frequent case first, because GCC 12 would otherwise join the two masks bit by bit.
  // (NIS is finite only where S is definite.)
  const auto finite = isfinite(correction.nis);
  correction.status = select(finite, StatusOf<Scalar>(Status::kOk),
                             select(definite, StatusOf<Scalar>(Status::kNotFinite),
                                    factor_failure<Scalar, M>(correction.innovation_covariance)));
}

/// A correction that failed with this status.
template <int M, class Scalar>
Correction<M, Scalar> failed_correction(const StatusOf<Scalar>& status) noexcept {
  Correction<M, Scalar> correction;
  correction.status = status;
  return correction;
}

}  // namespace wakeline
