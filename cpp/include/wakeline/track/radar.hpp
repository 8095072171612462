// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <tuple>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/measurement/range_bearing.hpp"

namespace wakeline {

/// What a console knows of its radar and of the vessels it looks at.
struct Radar {
  double range_std_m = 10.0;
  double bearing_std_rad = deg(1.0);
  double extent_std_m = 5.0;        ///< wander of an echo over its hull, per axis
  double period_s = 3.0;            ///< of the antenna
  double max_speed_mps = 30.0;      ///< of the vessels, with a fifth to spare: tracks above end
  double bearing_offset_rad = 0.0;  ///< bearing read minus true bearing

  /// A plot seen from own ship as a position with its covariance.
  [[nodiscard]] Gaussian<2> position(double range_m, double bearing_rad,
                                     const OwnShip& own) const noexcept {
    return PolarErrors{range_std_m, bearing_std_rad, extent_std_m, bearing_offset_rad, own}
        .position(range_m, bearing_rad, true);
  }

  /// All settings in order, to be saved.
  [[nodiscard]] auto settings() noexcept {
    return std::tie(range_std_m, bearing_std_rad, extent_std_m, period_s, max_speed_mps,
                    bearing_offset_rad);
  }

  friend bool operator==(const Radar&, const Radar&) = default;

  void validate() const {
    require_positive("range_std_m", range_std_m);
    require_positive("bearing_std_rad", bearing_std_rad);
    require_not_negative("extent_std_m", extent_std_m);
    require_positive("period_s", period_s);
    require_positive("max_speed_mps", max_speed_mps);
    require_finite("bearing_offset_rad", bearing_offset_rad);
  }
};

/// One plot of a scan: when it was seen, where, and from where.
struct Plot {
  double time_s = 0.0;
  double range_m = 0.0;
  double bearing_rad = 0.0;
  OwnShip own = {};
};

}  // namespace wakeline
