// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Standard deviations of angles. A larger one than half a turn is in degrees.
inline constexpr Rule kAngleStd{
    .low = kLeastPositive, .high = kPi<double>, .words = "1e-9 to pi, in radians"};
inline constexpr Rule kAngleStdOrZero{
    .low = 0.0, .high = kPi<double>, .words = "0 to pi, in radians"};

/// Position and velocity of the antenna at the time of a measurement, with their errors.
struct OwnShip {
  double north_m = 0.0;
  double east_m = 0.0;
  double vnorth_mps = 0.0;
  double veast_mps = 0.0;
  double position_std_m = 0.0;
  double velocity_std_mps = 0.0;
  double heading_std_rad = 0.0;

  static constexpr auto fields() noexcept {
    using O = OwnShip;
    return field_table(
        field("north_m", &O::north_m, kFinite, "m", "Position of the antenna to the north."),
        field("east_m", &O::east_m, kFinite, "m", "Position of the antenna to the east."),
        field("vnorth_mps", &O::vnorth_mps, kFinite, "m/s", "Velocity to the north."),
        field("veast_mps", &O::veast_mps, kFinite, "m/s", "Velocity to the east."),
        field("position_std_m", &O::position_std_m, kNotNegative, "m",
              "Standard deviation of the position, per axis."),
        field("velocity_std_mps", &O::velocity_std_mps, kNotNegative, "m/s",
              "Standard deviation of the velocity, per axis."),
        field("heading_std_rad", &O::heading_std_rad, kAngleStdOrZero, "rad",
              "Standard deviation of the heading, which turns every bearing."));
  }

  template <class Scalar>
  Vec<Scalar, 2> position() const noexcept {
    return {Scalar(north_m), Scalar(east_m)};
  }

  template <class Scalar>
  Vec<Scalar, 2> velocity() const noexcept {
    return {Scalar(vnorth_mps), Scalar(veast_mps)};
  }

  void validate() const { validate_fields(*this); }
};

/// Own ship that carries a sensor, null of a sensor without one.
template <class Sensor>
auto* own_ship_of(Sensor& sensor) noexcept {
  using Own = std::conditional_t<std::is_const_v<Sensor>, const OwnShip, OwnShip>;
  if constexpr (requires { sensor.own_ship(); })
    return sensor.own_ship();
  else if constexpr (requires { sensor.own; })
    return static_cast<Own*>(&sensor.own);
  else
    return static_cast<Own*>(nullptr);
}

}  // namespace wakeline
