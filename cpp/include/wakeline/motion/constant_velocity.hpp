// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/fields.hpp"
#include "wakeline/motion/concept.hpp"
#include "wakeline/motion/pattern.hpp"
#include "wakeline/motion/process_noise.hpp"

namespace wakeline {

/// Constant velocity: state `[x, vx, y, vy]` (m, m/s), x' = x + vx dt. Source: Bar-Shalom, Li,
/// Kirubarajan, 6.2.2; paper A, equation (1).
struct ConstantVelocity {
  static constexpr const char* kName = "ConstantVelocity";
  static constexpr const char* kSummary = "Constant velocity: state [x, vx, y, vy] (m, m/s).";
  static constexpr auto kComponents = kKinematics;
  static constexpr bool kForPacks = true;
  static constexpr Pattern<4> kPattern{"1x00 0100 001x 0001"};

  ProcessNoise noise = WhiteAcceleration{};

  static constexpr auto fields() noexcept {
    using C = ConstantVelocity;
    return field_table(field("noise", &C::noise, "Process noise."));
  }

  /// F(dt), 4 x 4.
  template <class Scalar>
  Mat<Scalar, 4, 4> matrix(Scalar dt_s) const noexcept {
    Mat<Scalar, 4, 4> f = Mat<Scalar, 4, 4>::Identity();
    f(0, 1) = f(2, 3) = dt_s;
    return f;
  }

  /// Q(dt), 4 x 4.
  template <class Scalar>
  Mat<Scalar, 4, 4> process_noise(Scalar dt_s) const noexcept {
    Mat<Scalar, 4, 4> q = Mat<Scalar, 4, 4>::Zero();
    q.template topLeftCorner<2, 2>() = q.template bottomRightCorner<2, 2>() =
        noise.of_velocity_axis(dt_s);
    return q;
  }

  void validate() const { noise.validate(false); }
};

}  // namespace wakeline
