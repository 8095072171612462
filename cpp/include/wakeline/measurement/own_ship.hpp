// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "wakeline/core/require.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Position and velocity of the antenna at the time of a measurement, with their errors.
struct OwnShip {
  double north_m = 0.0;
  double east_m = 0.0;
  double vnorth_mps = 0.0;
  double veast_mps = 0.0;
  double position_std_m = 0.0;    ///< error of the position, per axis
  double velocity_std_mps = 0.0;  ///< error of the velocity, per axis
  double heading_std_rad = 0.0;   ///< error of the heading, which turns every bearing

  template <class Scalar>
  Vec<Scalar, 2> position() const noexcept {
    return {Scalar(north_m), Scalar(east_m)};
  }

  template <class Scalar>
  Vec<Scalar, 2> velocity() const noexcept {
    return {Scalar(vnorth_mps), Scalar(veast_mps)};
  }

  void validate() const {
    require_finite("own.north_m", north_m);
    require_finite("own.east_m", east_m);
    require_finite("own.vnorth_mps", vnorth_mps);
    require_finite("own.veast_mps", veast_mps);
    require_not_negative("own.position_std_m", position_std_m);
    require_not_negative("own.velocity_std_mps", velocity_std_mps);
    require_not_negative("own.heading_std_rad", heading_std_rad);
  }
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
