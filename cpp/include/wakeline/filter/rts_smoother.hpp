// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/filter/control.hpp"
#include "wakeline/motion/concept.hpp"

namespace wakeline {

/// Rauch-Tung-Striebel smoother, in place: turns the filtered beliefs of T scans into smoothed
/// ones.
///
/// `dt_s[k]` leads from scan k to scan k + 1 (T - 1 of them), under `acceleration_mps2[k]` where
/// the filter was told any; see `Control`. The covariance is kept in a form that stays positive
/// definite: (I - G F) P (I - G F)ᵀ + G (Ps + Q) Gᵀ. Returns the first failure, with that scan and
/// everything before it left as filtered. Source: Bar-Shalom, Li, Kirubarajan, 8.6.
template <MotionModel Motion, class Scalar>
Status smooth(const Motion& motion, std::span<Gaussian<kStatesOf<Motion>, Scalar>> beliefs,
              std::span<const Scalar> dt_s,
              std::span<const Vec<Scalar, 2>> acceleration_mps2 = {}) noexcept {
  constexpr int kStates = kStatesOf<Motion>;
  using Matrix = Mat<Scalar, kStates, kStates>;
  for (std::size_t k = beliefs.size(); k-- > 1;) {
    const Gaussian<kStates, Scalar>& later = beliefs[k];
    Gaussian<kStates, Scalar>& belief = beliefs[k - 1];
    const Scalar dt = dt_s[k - 1];
    if (const Status forward = check_time_step(dt); forward != Status::kOk) return forward;
    Vec<Scalar, kStates> predicted = transition(motion, belief.mean, dt);
    if (!acceleration_mps2.empty())
      predicted += Control::shift(Motion::kComponents, dt, acceleration_mps2[k - 1]);
    const Matrix f = transition_jacobian(motion, belief.mean, dt);
    const Matrix q = process_noise(motion, belief.mean, dt);
    const Matrix fp = f * belief.covariance;
    const Cholesky<kStates, Scalar> factor(Matrix(fp * f.transpose() + q));
    if (!factor.ok()) return Status::kNotPositiveDefinite;
    const Matrix gain = factor.template solve<kStates>(fp).transpose();
    const Matrix rest = Matrix::Identity() - gain * f;
    Gaussian<kStates, Scalar> smoothed;
    smoothed.mean = belief.mean + gain * (later.mean - predicted);
    smoothed.covariance = rest * belief.covariance * rest.transpose() +
                          gain * (later.covariance + q) * gain.transpose();
    mirror_lower<Scalar, kStates>(smoothed.covariance);
    if (!is_finite(smoothed.mean) || !is_finite(smoothed.covariance)) return Status::kNotFinite;
    belief = smoothed;
  }
  return Status::kOk;
}

}  // namespace wakeline
