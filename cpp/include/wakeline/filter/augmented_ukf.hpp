// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include "wakeline/filter/ukf.hpp"

namespace wakeline {

/// A motion driven by `kInputs` measured inputs with independent errors of standard deviation
/// `input_std()`: x' = f(x, e, dt) + w, w ~ N(0, W(x, dt)).
///
/// `disturbed(e)` is the motion with the errors e added to its inputs, and `walk_noise(x, dt_s)` is
/// W, the part of its `process_noise` that does not come from the inputs.
template <class Motion>
concept DisturbedMotionModel = NonlinearMotionModel<Motion> &&
    requires(const Motion& motion, const Vec<double, Motion::kInputs>& error,
             const StateOf<Motion>& x, double dt_s) {
  { motion.input_std() } -> SameSize<Vec<double, Motion::kInputs>>;
  { motion.disturbed(error) } -> std::convertible_to<Motion>;
  { motion.walk_noise(x, dt_s) } -> SameSize<StateMatrixOf<Motion>>;
};

/// The unscented Kalman filter with augmented noise: a prediction moves sigma points of the state
/// and of the input errors, 2 (N + kInputs) and the centre, and adds only W, so that no noise is
/// counted twice. `Ukf`, with additive noise, moves 2 N points and adds all of Q. Updates are those
/// of `Ukf`.
///
/// Where the errors enter linearly both are equal except for the spread of the points, alpha² (N +
/// kInputs + kappa) here. Source: S. J. Julier, J. K. Uhlmann, Proc. IEEE 92, 2004, section III; E.
/// A. Wan, R. van der Merwe, 2000.
template <class MotionType, class ScalarType = double>
class AugmentedUkf : public Ukf<MotionType, ScalarType> {
  static_assert(DisturbedMotionModel<MotionType>,
                "wakeline: AugmentedUkf needs a motion model with noisy inputs: kInputs, "
                "input_std(), disturbed(error) and walk_noise(x, dt_s) in addition to those of a "
                "nonlinear model; see cpp/docs/concepts.md");
  using Base = Ukf<MotionType, ScalarType>;

 public:
  using Base::kStates;
  using typename Base::Scalar;
  static constexpr int kInputs = MotionType::kInputs;
  static constexpr int kAugmented = kStates + kInputs;

  explicit AugmentedUkf(const MotionType& motion, const Unscented& unscented = {})
      : Base(motion, unscented) {}

  /// Moments of the moved sigma points, plus W.
  StatusOf<Scalar> predict(Scalar dt_s) noexcept {
    if (!this->started_) return Status::kNotStarted;
    const StatusOf<Scalar> forward = check_time_step(dt_s);
    if (none(ok(forward))) return forward;
    const Vec<Scalar, kStates>& x = this->belief_.mean;
    const auto spread = this->unscented().template spread<Scalar>(kAugmented);
    const MovedPoints<Scalar, kStates> moved(
        this->motion_, dt_s, x, sigma_points<Scalar, kStates>(x, this->root().lower(), spread));
    Mat<Scalar, kStates, 2 * kAugmented> differences;
    differences << moved.differences, by_errors(dt_s, moved.centre);
    return this->take_moments(kAugmented, moved.centre, differences,
                              this->motion_.walk_noise(x, dt_s), forward);
  }

 private:
  /// Images of the mean under each input error of either sign, relative to the centre's image.
  Mat<Scalar, kStates, 2 * kInputs> by_errors(Scalar dt_s,
                                              const Vec<Scalar, kStates>& centre) const noexcept {
    const Vec<double, kInputs> reach =
        this->unscented().template spread<double>(kAugmented) * this->motion_.input_std();
    Mat<Scalar, kStates, 2 * kInputs> differences;
    for (int k = 0; k < kInputs; ++k)
      for (const int side : {0, 1}) {
        const Vec<double, kInputs> error =
            (side == 0 ? reach[k] : -reach[k]) * Vec<double, kInputs>::Unit(k);
        differences.col(2 * k + side) =
            this->motion_.disturbed(error).transition(this->belief_.mean, dt_s) - centre;
      }
    return differences;
  }
};

}  // namespace wakeline
