// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/fields.hpp"
#include "wakeline/motion/concept.hpp"
#include "wakeline/motion/pattern.hpp"
#include "wakeline/motion/process_noise.hpp"

namespace wakeline {

/// State layout `[x, vx, ax, y, vy, ay]` (m, m/s, m/s²).
inline constexpr std::array kAccelerationKinematics{Component::kNorth,  Component::kVnorth,
                                                    Component::kAnorth, Component::kEast,
                                                    Component::kVeast,  Component::kAeast};

/// The same 3 x 3 matrix for both axes, as a block-diagonal 6 x 6 matrix.
template <class Scalar>
Mat<Scalar, 6, 6> both_axes(const Mat<Scalar, 3, 3>& axis) noexcept {
  Mat<Scalar, 6, 6> matrix = Mat<Scalar, 6, 6>::Zero();
  matrix.template topLeftCorner<3, 3>() = matrix.template bottomRightCorner<3, 3>() = axis;
  return matrix;
}

/// Constant acceleration: state `[x, vx, ax, y, vy, ay]`, x' = x + vx dt + ax dt²/2, vx' = vx + ax
/// dt. Source: Bar-Shalom, Li, Kirubarajan, 6.2.3; paper A, equation (2).
struct ConstantAcceleration {
  static constexpr const char* kName = "ConstantAcceleration";
  static constexpr const char* kSummary =
      "Constant acceleration: state [x, vx, ax, y, vy, ay] (m, m/s, m/s²).";
  static constexpr auto kComponents = kAccelerationKinematics;
  static constexpr bool kForPacks = true;
  static constexpr Pattern<6> kPattern{"1xx000 01x000 001000 0001xx 00001x 000001"};

  ProcessNoise noise = WhiteJerk{};
  double prior_accel_std_mps2 = 1.0;

  static constexpr auto fields() noexcept {
    using C = ConstantAcceleration;
    return field_table(field("noise", &C::noise, "Process noise."),
                       field("prior_accel_std_mps2", &C::prior_accel_std_mps2, kPositive, "m/s²",
                             "Standard deviation of the acceleration, per axis, for a start that "
                             "does not know it."));
  }

  /// F(dt), 6 x 6.
  template <class Scalar>
  Mat<Scalar, 6, 6> matrix(Scalar dt_s) const noexcept {
    Mat<Scalar, 3, 3> axis = Mat<Scalar, 3, 3>::Identity();
    axis(0, 1) = axis(1, 2) = dt_s;
    axis(0, 2) = dt_s * dt_s / 2;
    return both_axes(axis);
  }

  /// Q(dt), 6 x 6.
  template <class Scalar>
  Mat<Scalar, 6, 6> process_noise(Scalar dt_s) const noexcept {
    return both_axes(noise.of_acceleration_axis(dt_s));
  }

  double prior_variance(Component) const noexcept {
    return prior_accel_std_mps2 * prior_accel_std_mps2;
  }

  void validate() const {
    validate_fields(*this);
    noise.validate(true);
  }
};

}  // namespace wakeline
