// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/filter/control.hpp"
#include "wakeline/filter/unscented.hpp"
#include "wakeline/motion/concept.hpp"

namespace wakeline {

/// A motion linearised about a belief x ~ N(m, P): to mean + F (x - m) with noise covariance Q.
/// `status` is not `kOk` where there is none.
template <int N, class Scalar>
struct LinearisedMotion {
  Status status = Status::kOk;
  Vec<Scalar, N> mean;
  Mat<Scalar, N, N> f;
  Mat<Scalar, N, N> q;
};

/// Linearised about the mean by the Jacobian, as in an extended filter.
template <MotionModel Motion, class Scalar>
LinearisedMotion<kStatesOf<Motion>, Scalar> linearised(
    const Motion& motion, const Gaussian<kStatesOf<Motion>, Scalar>& belief, Scalar dt_s) noexcept {
  return {.mean = transition(motion, belief.mean, dt_s),
          .f = transition_jacobian(motion, belief.mean, dt_s),
          .q = process_noise(motion, belief.mean, dt_s)};
}

/// Statistical linear regression over the sigma points, as in an unscented filter: the best linear
/// fit of their images, with the residuals as noise. With L the root of P, e+ and e- the images of
/// a pair of points relative to that of the centre, s the spread of the points and w their weight,
///
///     F L = (e+ - e-) / (2 s),   Q += w/2 Σ (e+ + e-) (e+ + e-)ᵀ + (beta - alpha²) d dᵀ,
///
/// which reproduces the filter's moments. Source: S. Särkkä, IEEE Trans. AC-53, 2008; I.
/// Arasaratnam, S. Haykin, R. J. Elliott, Proc. IEEE 95, 2007 (statistical linear regression).
template <MotionModel Motion, class Scalar>
LinearisedMotion<kStatesOf<Motion>, Scalar> linearised(
    const Motion& motion, const Unscented& unscented,
    const Gaussian<kStatesOf<Motion>, Scalar>& belief, Scalar dt_s) noexcept {
  constexpr int kStates = kStatesOf<Motion>;
  LinearisedMotion<kStates, Scalar> result;
  const Cholesky<kStates, Scalar> root(belief.covariance);
  if (!root.ok()) {
    result.status = Status::kNotPositiveDefinite;
    return result;
  }
  const auto spread = unscented.template spread<Scalar>(kStates);
  const auto weight = unscented.template weight<Scalar>(kStates);
  const MovedPoints<Scalar, kStates> moved(
      motion, dt_s, belief.mean, sigma_points<Scalar, kStates>(belief.mean, root.lower(), spread));
  Mat<Scalar, kStates, kStates> slope, bend;
  Vec<Scalar, kStates> shift = Vec<Scalar, kStates>::Zero();
  for (int k = 0; k < kStates; ++k)
    for (int i = 0; i < kStates; ++i) {
      const Scalar ahead = moved.differences(i, 2 * k), behind = moved.differences(i, 2 * k + 1);
      slope(i, k) = (ahead - behind) / (2 * spread);
      bend(i, k) = ahead + behind;
      shift[i] += weight * bend(i, k);
    }
  result.mean = moved.centre + shift;
  result.f = root.template unwhiten_rows<kStates>(slope);
  result.q = process_noise(motion, belief.mean, dt_s) +
             weight / 2 * product_transposed(bend, bend) +
             unscented.template centre_correction<Scalar>() * product_transposed(shift, shift);
  return result;
}

/// One step of the smoother: turns a filtered belief into a smoothed one, by the motion from it to
/// the smoothed belief `later`. By the number of states alone, so that all filters share it.
template <int N, class Scalar>
[[gnu::noinline]] Status smooth_step(const LinearisedMotion<N, Scalar>& motion,
                                     const Gaussian<N, Scalar>& later,
                                     Gaussian<N, Scalar>& belief) noexcept {
  using Matrix = Mat<Scalar, N, N>;
  const Matrix pf = product_transposed(belief.covariance, motion.f);
  const Cholesky<N, Scalar> factor(Matrix(product(motion.f, pf) + motion.q));
  if (!factor.ok()) return Status::kNotPositiveDefinite;
  const Matrix gain = factor.template unwhiten_rows<N>(factor.template whiten_rows<N>(pf));
  const Matrix rest = Matrix::Identity() - product(gain, motion.f);
  const Matrix added = later.covariance + motion.q;
  Gaussian<N, Scalar> smoothed;
  smoothed.mean = belief.mean + product(gain, Vec<Scalar, N>(later.mean - motion.mean));
  smoothed.covariance = product_transposed(product(rest, belief.covariance), rest) +
                        product_transposed(product(gain, added), gain);
  mirror_lower<Scalar, N>(smoothed.covariance);
  if (!is_finite(smoothed.mean) || !is_finite(smoothed.covariance)) return Status::kNotFinite;
  belief = smoothed;
  return Status::kOk;
}

/// Rauch-Tung-Striebel smoother, in place: turns the filtered beliefs of T scans into smoothed
/// ones, with the motion linearised as in the filter.
///
/// `dt_s[k]` is the step from scan k to scan k + 1 (T - 1 of them), under `acceleration_mps2[k]` if
/// the filter was given any; see `Control`. `linearise(belief, dt_s)` returns the motion. The
/// covariance has a form that stays positive definite: (I - G F) P (I - G F)ᵀ + G (Ps + Q) Gᵀ.
/// Returns the first failure, with that scan and all before it left as filtered. Source:
/// Bar-Shalom, Li, Kirubarajan, 8.6.
template <MotionModel Motion, class Scalar, class Linearise>
Status smooth_by(const Linearise& linearise, std::span<Gaussian<kStatesOf<Motion>, Scalar>> beliefs,
                 std::span<const Scalar> dt_s,
                 std::span<const Vec<Scalar, 2>> acceleration_mps2) noexcept {
  constexpr int kStates = kStatesOf<Motion>;
  for (std::size_t k = beliefs.size(); k-- > 1;) {
    const Scalar dt = dt_s[k - 1];
    if (const Status forward = check_time_step(dt); forward != Status::kOk) return forward;
    LinearisedMotion<kStates, Scalar> motion = linearise(beliefs[k - 1], dt);
    if (motion.status != Status::kOk) return motion.status;
    if (!acceleration_mps2.empty())
      motion.mean += Control::shift(Motion::kComponents, dt, acceleration_mps2[k - 1]);
    if (const Status status = smooth_step(motion, beliefs[k], beliefs[k - 1]);
        status != Status::kOk)
      return status;
  }
  return Status::kOk;
}

/// For the beliefs of an extended filter.
template <MotionModel Motion, class Scalar>
Status smooth(const Motion& motion, std::span<Gaussian<kStatesOf<Motion>, Scalar>> beliefs,
              std::span<const Scalar> dt_s,
              std::span<const Vec<Scalar, 2>> acceleration_mps2 = {}) noexcept {
  return smooth_by<Motion, Scalar>(
      [&](const auto& belief, Scalar dt) { return linearised<Motion, Scalar>(motion, belief, dt); },
      beliefs, dt_s, acceleration_mps2);
}

/// For the beliefs of an unscented filter.
template <MotionModel Motion, class Scalar>
Status smooth(const Motion& motion, const Unscented& unscented,
              std::span<Gaussian<kStatesOf<Motion>, Scalar>> beliefs, std::span<const Scalar> dt_s,
              std::span<const Vec<Scalar, 2>> acceleration_mps2 = {}) noexcept {
  return smooth_by<Motion, Scalar>(
      [&](const auto& belief, Scalar dt) {
        return linearised<Motion, Scalar>(motion, unscented, belief, dt);
      },
      beliefs, dt_s, acceleration_mps2);
}

/// For the beliefs of a filter with the motion model `motion`.
template <class Filter, MotionModel Motion>
Status smooth_as(const Filter& filter, const Motion& motion,
                 std::span<Gaussian<Filter::kStates, typename Filter::Scalar>> beliefs,
                 std::span<const typename Filter::Scalar> dt_s,
                 std::span<const Vec<typename Filter::Scalar, 2>> acceleration_mps2 = {}) noexcept {
  using Scalar = typename Filter::Scalar;
  if constexpr (requires { filter.unscented(); })
    return smooth<Motion, Scalar>(motion, filter.unscented(), beliefs, dt_s, acceleration_mps2);
  else
    return smooth<Motion, Scalar>(motion, beliefs, dt_s, acceleration_mps2);
}

}  // namespace wakeline
