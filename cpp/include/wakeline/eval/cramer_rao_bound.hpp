// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/component.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/measurement/concept.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/concept.hpp"

namespace wakeline {

/// The posterior Cramér-Rao bound for known motion: the lower bound of the covariance (N x N) of
/// any unbiased estimator, conditional on the sequence of motion models and, for a nonlinear model,
/// on the true path.
///
///     predict:  P' = F P Fᵀ + Q
///     update:   P'⁻¹ = P⁻¹ + p Hᵀ R⁻¹ H
///
/// with F, Q, H and R at the true state and p the probability of a measurement. Computed as P' = L
/// (I + p Bᵀ B)⁻¹ Lᵀ with P = L Lᵀ, R = U Uᵀ and B = U⁻¹ H L, which keeps P' symmetric and positive
/// definite without an inverse. For a linear model it is the Kalman filter's covariance. No heap; a
/// step that fails returns its status and changes nothing. Source: Tichavsky, Muravchik, Nehorai,
/// Posterior Cramér-Rao Bounds for Discrete-Time Nonlinear Filtering, IEEE Trans. Signal Processing
/// 46(5), 1998, equation (21).
template <int N, class Scalar = double>
class CramerRaoBound {
 public:
  using Covariance = Mat<Scalar, N, N>;

  /// Starts with the covariance of the prior. Throws `std::invalid_argument` unless it is finite,
  /// symmetric and positive definite.
  explicit CramerRaoBound(const Covariance& start_covariance) : covariance_(start_covariance) {
    if (check(Gaussian<N, Scalar>{Vec<Scalar, N>::Zero(), start_covariance}) != Status::kOk)
      reject("start_covariance must be finite, symmetric and positive definite");
  }

  /// (N x N), over the state of the motion model.
  [[nodiscard]] const Covariance& covariance() const noexcept { return covariance_; }

  /// Predicts with a transition F and a process noise Q (N x N each).
  [[nodiscard]] Status predict(const Covariance& transition,
                               const Covariance& process_noise) noexcept {
    Covariance moved = transition * covariance_ * transition.transpose() + process_noise;
    moved = (Scalar(0.5) * (moved + moved.transpose())).eval();
    return take(moved);
  }

  /// Predicts with a motion model at the true state at the start of the step.
  template <MotionModel Motion>
  [[nodiscard]] Status predict(const Motion& motion, const StateOf<Motion, Scalar>& truth,
                               Scalar dt_s) noexcept {
    static_assert(kStatesOf<Motion> == N, "the motion must have the N states of the bound");
    if (const Status forward = check_time_step(dt_s); forward != Status::kOk) return forward;
    return predict(transition_jacobian(motion, truth, dt_s), process_noise(motion, truth, dt_s));
  }

  /// Updates with a measurement of Jacobian H (M x N) and noise R (M x M), made with probability
  /// `chance` in [0, 1].
  template <int M>
  [[nodiscard]] Status update(const Mat<Scalar, M, N>& jacobian, const Mat<Scalar, M, M>& noise,
                              Scalar chance = Scalar(1)) noexcept {
    if (!is_finite(jacobian) || !(chance >= Scalar(0) && chance <= Scalar(1)))
      return Status::kNotFinite;
    const Cholesky<M, Scalar> root_noise(noise);
    const Cholesky<N, Scalar> root(covariance_);
    if (!root_noise.ok() || !root.ok()) return Status::kNotPositiveDefinite;
    const Covariance lower = root.lower();
    const Mat<Scalar, M, N> whitened = root_noise.template whiten<N>(jacobian * lower);
    const Covariance gain = Covariance::Identity() + chance * whitened.transpose() * whitened;
    const Cholesky<N, Scalar> root_gain(gain);
    if (!root_gain.ok()) return Status::kNotPositiveDefinite;
    const Covariance half = root_gain.template whiten<N>(lower.transpose());
    return take(half.transpose() * half);
  }

  /// Updates with a sensor at the true state. A converted measurement has the information of the
  /// plot that it is computed from.
  template <MotionModel Motion, MeasurementModel Sensor>
  [[nodiscard]] Status update(const Sensor& sensor, const StateOf<Motion, Scalar>& truth,
                              Scalar chance = Scalar(1)) noexcept {
    static_assert(kStatesOf<Motion> == N, "the motion must have the N states of the bound");
    static_assert(holds(Motion::kComponents, Sensor::kReads),
                  "the sensor reads a component that the motion does not have");
    if constexpr (std::same_as<Sensor, ConvertedRangeBearing>) {
      return update<Motion>(RangeBearing{.range_std_m = sensor.range_std_m,
                                         .bearing_std_rad = sensor.bearing_std_rad,
                                         .extent_std_m = sensor.extent_std_m,
                                         .bearing_offset_rad = sensor.bearing_offset_rad,
                                         .own = sensor.own},
                            truth, chance);
    } else {
      constexpr auto kRows = rows_of(Motion::kComponents, Sensor::kReads);
      Vec<Scalar, kReadsOf<Sensor>> read;
      for (int k = 0; k < kReadsOf<Sensor>; ++k) read[k] = truth[kRows[k]];
      const auto seen = sensor.observe(Vec<Scalar, Sensor::kMeasurements>(sensor.measure(read)));
      const auto narrow = sensor.jacobian(read);
      Mat<Scalar, Sensor::kMeasurements, N> jacobian =
          Mat<Scalar, Sensor::kMeasurements, N>::Zero();
      for (int k = 0; k < kReadsOf<Sensor>; ++k) jacobian.col(kRows[k]) = narrow.col(k);
      return update<Sensor::kMeasurements>(jacobian, seen.covariance, chance);
    }
  }

 private:
  Status take(const Covariance& covariance) noexcept {
    if (!is_finite(covariance)) return Status::kNotFinite;
    if (!Cholesky<N, Scalar>(covariance).ok()) return Status::kNotPositiveDefinite;
    covariance_ = covariance;
    return Status::kOk;
  }

  Covariance covariance_;
};

}  // namespace wakeline
