// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/core/scalar.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/motion/process_noise.hpp"

namespace wakeline {

/// The trigonometry of a steady turn by theta = omega dt, with exact limits at zero rate.
/// Source: Bar-Shalom, Li, Kirubarajan, 11.7.1; paper A, equation (3).
template <class Scalar>
struct Turn {
  Scalar angle;          ///< theta
  Scalar sine;           ///< sin theta
  Scalar cosine;         ///< cos theta
  Scalar along_s;        ///< sin(theta) / omega, s: how far a unit speed goes ahead
  Scalar across_s;       ///< (1 - cos(theta)) / omega, s: how far it goes to starboard
  Scalar inverse_angle;  ///< 1 / theta; of no turn 1
  Scalar dt_s;

  Turn(Scalar turn_rate_rad_s, Scalar dt) noexcept : angle(turn_rate_rad_s * dt), dt_s(dt) {
    using std::abs, std::cos, std::sin;
    const Scalar half_sine = sin(angle / 2);
    const Scalar half_cosine = cos(angle / 2);
    sine = 2 * half_sine * half_cosine;
    cosine = 1 - 2 * half_sine * half_sine;
    const auto straight = abs(angle) < Scalar(kTiny);
    inverse_angle = reciprocal(select(straight, Scalar(1), angle));
    along_s = select(straight, dt, sine * inverse_angle * dt);
    across_s = dt * select(straight, angle / 2, 2 * half_sine * half_sine * inverse_angle);
  }

  /// F of `[x, vx, y, vy]`.
  Mat<Scalar, 4, 4> matrix() const noexcept {
    Mat<Scalar, 4, 4> f = Mat<Scalar, 4, 4>::Identity();
    f(1, 1) = f(3, 3) = cosine;
    f(0, 1) = f(2, 3) = along_s;
    f(2, 1) = across_s;
    f(0, 3) = -across_s;
    f(3, 1) = sine;
    f(1, 3) = -sine;
    return f;
  }

  /// d along / d omega and d across / d omega, s².
  Vec<Scalar, 2> rate_derivatives() const noexcept {
    using std::abs;
    const Scalar a2 = angle * angle;
    const auto nearly_straight = abs(angle) < Scalar(kSeries);
    const Scalar divisor = select(nearly_straight, Scalar(1), angle);
    const Scalar along = select(nearly_straight, -angle * (1 - a2 / 10 * (1 - a2 / 28)) / 3,
                                (cosine - along_s / dt_s) / divisor);
    const Scalar across = select(nearly_straight, (1 - a2 / 4 * (1 - a2 / 18 * (1 - a2 / 40))) / 2,
                                 (sine - across_s / dt_s) / divisor);
    return dt_s * dt_s * Vec<Scalar, 2>(along, across);
  }

  /// Q of `[x, vx, y, vy]` under the piecewise policy, whatever the turn.
  static Mat<Scalar, 4, 4> piecewise_noise(const ProcessNoise& policy, Scalar dt_s) noexcept {
    Mat<Scalar, 4, 4> q = Mat<Scalar, 4, 4>::Zero();
    q.template topLeftCorner<2, 2>() = q.template bottomRightCorner<2, 2>() =
        policy.of_velocity_axis(dt_s);
    return q;
  }

  /// Q of `[x, vx, y, vy]` under acceleration noise that acts throughout the turn. White
  /// acceleration gives the exact integral of F(s) G q Gᵀ F(s)ᵀ; the piecewise policy is the
  /// papers' G s² Gᵀ, which knows nothing of the turn.
  Mat<Scalar, 4, 4> noise(const ProcessNoise& policy) const noexcept {
    if (policy.kind() == ProcessNoise::Kind::kPiecewiseAcceleration)
      return piecewise_noise(policy, dt_s);
    return white_noise(Scalar(policy.strength()));
  }

  /// The same with white acceleration of so much more density.
  Mat<Scalar, 4, 4> noise(const ProcessNoise& policy, Scalar more_m2s3) const noexcept {
    if (policy.kind() == ProcessNoise::Kind::kPiecewiseAcceleration)
      return piecewise_noise(policy, dt_s) + white_noise(more_m2s3);
    return white_noise(Scalar(policy.strength()) + more_m2s3);
  }

 private:
  /// That of white acceleration.
  Mat<Scalar, 4, 4> white_noise(Scalar density) const noexcept {
    using std::abs;
    Mat<Scalar, 4, 4> q;
    const Scalar a2 = angle * angle;
    const auto nearly_straight = abs(angle) < Scalar(kSeries);
    // 2 (theta - sin theta) / theta³
    const Scalar spread =
        select(nearly_straight, Scalar(1.0 / 3) - a2 * (Scalar(1.0 / 60) - a2 * Scalar(1.0 / 2520)),
               2 * (angle - sine) * inverse_angle * inverse_angle * inverse_angle);
    // dt (1 - cos theta) / theta²
    const auto straight = abs(angle) < Scalar(kTiny);
    const Scalar coupling_s = select(straight, dt_s / 2, across_s * inverse_angle);
    const Scalar velocity = density * dt_s;
    const Scalar position = velocity * dt_s * dt_s * spread;
    const Scalar ahead = velocity * coupling_s;
    const Scalar aside = velocity * dt_s * angle * spread / 2;
    // clang-format off
    q << position,  ahead,    0,        aside,
         ahead,     velocity, -aside,   0,
         0,         -aside,   position, ahead,
         aside,     0,        ahead,    velocity;
    // clang-format on
    return q;
  }

  static constexpr double kTiny = 1e-12;
  static constexpr double kSeries = sizeof(RealOf<Scalar>) > 4 ? 0.02 : 0.3;
};

}  // namespace wakeline
