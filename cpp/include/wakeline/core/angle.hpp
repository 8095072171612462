// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <numbers>

#include "wakeline/core/types.hpp"

namespace wakeline {

template <class Scalar>
inline constexpr Scalar kPi = std::numbers::pi_v<Scalar>;

/// Degrees to radians.
constexpr double deg(double degrees) noexcept { return degrees * (kPi<double> / 180.0); }

/// Knots to metres per second.
constexpr double knots(double speed_kn) noexcept { return speed_kn * (1852.0 / 3600.0); }

/// The same angle in [-pi, pi].
template <class Scalar>
Scalar wrap_angle(Scalar angle_rad) noexcept {
  using std::floor;
  using Real = RealOf<Scalar>;
  constexpr Real turn = Real(2) * kPi<Real>;
  constexpr Real turns_per_rad = Real(1) / turn;
  const Scalar wrapped = angle_rad - turn * floor(angle_rad * turns_per_rad + Real(0.5));
  // Next to half a turn the sum above may round to a whole one.
  const Scalar half = kPi<Real>;
  return select(wrapped > half, half, select(wrapped < -half, -half, wrapped));
}

/// The same angle in [0, 2 pi): how bearings and courses are shown.
template <class Scalar>
Scalar compass_angle(Scalar angle_rad) noexcept {
  using std::floor;
  const Scalar turn = RealOf<Scalar>(2) * kPi<RealOf<Scalar>>;
  const Scalar wrapped = angle_rad - turn * floor(angle_rad / turn);
  // Rounding may leave it next to one end of the turn, outside.
  return select(wrapped < Scalar(0) || wrapped >= turn, Scalar(0), wrapped);
}

/// Weighted circular mean of N angles: the direction of the sum of weighted unit vectors.
template <class Scalar, int N>
Scalar mean_angle(const Vec<Scalar, N>& angles_rad, const Vec<Scalar, N>& weights) noexcept {
  using std::atan2;
  return atan2((weights.array() * angles_rad.array().sin()).sum(),
               (weights.array() * angles_rad.array().cos()).sum());
}

}  // namespace wakeline
