// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Continuous white acceleration of the given power spectral density per axis. Its Q is consistent
/// for any dt: Q(a + b) = F(b) Q(a) F(b)ᵀ + Q(b). Source: Bar-Shalom, Li, Kirubarajan, Estimation
/// with Applications to Tracking and Navigation, 6.2.2.
struct WhiteAcceleration {
  double psd_m2s3 = 0.1;

  static constexpr auto fields() noexcept {
    using W = WhiteAcceleration;
    return field_table(field("psd_m2s3", &W::psd_m2s3, kNotNegative, "m²/s³",
                             "Power spectral density of the acceleration, per axis."));
  }
};

/// A random acceleration per axis, independent in each step and constant during it: Q = G s² Gᵀ, G
/// = [dt²/2, dt]ᵀ (and [dt²/2, dt, 1]ᵀ where the acceleration is a state). The papers' form: the
/// noise per second depends on the step. Source: Bar-Shalom, Li, Kirubarajan, 6.3.2 and 6.3.3;
/// paper A, equations (1)-(3).
struct PiecewiseAcceleration {
  double std_mps2 = 0.1;

  static constexpr auto fields() noexcept {
    using P = PiecewiseAcceleration;
    return field_table(field("std_mps2", &P::std_mps2, kNotNegative, "m/s²",
                             "Standard deviation of the acceleration of a step, per axis."));
  }
};

/// Continuous white jerk per axis, for states with an acceleration; consistent for any dt. Source:
/// Bar-Shalom, Li, Kirubarajan, 6.2.3.
struct WhiteJerk {
  double psd_m2s5 = 0.01;

  static constexpr auto fields() noexcept {
    using W = WhiteJerk;
    return field_table(field("psd_m2s5", &W::psd_m2s5, kNotNegative, "m²/s⁵",
                             "Power spectral density of the jerk, per axis."));
  }
};

/// Process noise of a motion model: one of the policies above.
class ProcessNoise {
 public:
  enum class Kind { kWhiteAcceleration, kPiecewiseAcceleration, kWhiteJerk };

  // NOLINTBEGIN(google-explicit-constructor): a policy is a process noise.
  constexpr ProcessNoise(WhiteAcceleration noise) noexcept
      : kind_(Kind::kWhiteAcceleration), parameter_(noise.psd_m2s3) {}
  constexpr ProcessNoise(PiecewiseAcceleration noise) noexcept
      : kind_(Kind::kPiecewiseAcceleration), parameter_(noise.std_mps2) {}
  constexpr ProcessNoise(WhiteJerk noise) noexcept
      : kind_(Kind::kWhiteJerk), parameter_(noise.psd_m2s5) {}
  // NOLINTEND(google-explicit-constructor)

  [[nodiscard]] constexpr Kind kind() const noexcept { return kind_; }

  /// The policy's parameter: a density or a standard deviation.
  [[nodiscard]] constexpr double parameter() const noexcept { return parameter_; }

  /// The density of white noise, or the variance s² of a piecewise acceleration.
  [[nodiscard]] constexpr double strength() const noexcept {
    return kind_ == Kind::kPiecewiseAcceleration ? parameter_ * parameter_ : parameter_;
  }

  /// Throws `std::invalid_argument` when the parameter is negative or not finite, or for white jerk
  /// when the state has no acceleration.
  void validate(bool holds_acceleration) const {
    switch (kind_) {
      case Kind::kWhiteAcceleration:
        require_not_negative("noise.psd_m2s3", parameter_);
        break;
      case Kind::kPiecewiseAcceleration:
        require_not_negative("noise.std_mps2", parameter_);
        break;
      case Kind::kWhiteJerk:
        require_not_negative("noise.psd_m2s5", parameter_);
        break;
    }
    if (kind_ == Kind::kWhiteJerk && !holds_acceleration)
      reject("white jerk needs an acceleration in the state, this model has none");
  }

  /// Q of one axis `[position, velocity]`, without a turn.
  template <class Scalar>
  Mat<Scalar, 2, 2> of_velocity_axis(Scalar dt_s) const noexcept {
    const Scalar q = Scalar(strength());
    const Scalar dt2 = dt_s * dt_s;
    const bool piecewise = kind_ == Kind::kPiecewiseAcceleration;
    Mat<Scalar, 2, 2> noise;
    noise(0, 0) = q * (piecewise ? dt2 * dt2 / 4 : dt2 * dt_s / 3);
    noise(0, 1) = noise(1, 0) = q * (piecewise ? dt2 * dt_s / 2 : dt2 / 2);
    noise(1, 1) = q * (piecewise ? dt2 : dt_s);
    return noise;
  }

  /// Q of one axis `[position, velocity, acceleration]`.
  template <class Scalar>
  Mat<Scalar, 3, 3> of_acceleration_axis(Scalar dt_s) const noexcept {
    Mat<Scalar, 3, 3> noise = Mat<Scalar, 3, 3>::Zero();
    if (kind_ == Kind::kWhiteAcceleration) {
      const Mat<Scalar, 2, 2> axis = of_velocity_axis(dt_s);
      for (int column = 0; column < 2; ++column)
        for (int row = 0; row < 2; ++row) noise(row, column) = axis(row, column);
    } else if (kind_ == Kind::kPiecewiseAcceleration) {
      const Scalar gain[3] = {dt_s * dt_s / 2, dt_s, Scalar(1)};
      for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
          noise(row, column) = Scalar(strength()) * gain[row] * gain[column];
    } else {
      const Scalar dt2 = dt_s * dt_s;
      const Scalar dt3 = dt2 * dt_s;
      // clang-format off
      const Scalar rows[3][3] = {{dt2 * dt3 / 20, dt2 * dt2 / 8, dt3 / 6},
                                 {dt2 * dt2 / 8,  dt3 / 3,       dt2 / 2},
                                 {dt3 / 6,        dt2 / 2,       dt_s}};
      // clang-format on
      for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
          noise(row, column) = Scalar(strength()) * rows[row][column];
    }
    return noise;
  }

 private:
  Kind kind_;
  double parameter_;
};

}  // namespace wakeline
