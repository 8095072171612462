// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/measurement/range_bearing.hpp"

namespace wakeline {

/// What a console knows of its radar and of the vessels it looks at.
struct Radar {
  double range_std_m = 10.0;
  double bearing_std_rad = deg(1.0);
  double extent_std_m = 5.0;
  double period_s = 3.0;
  double max_speed_mps = 30.0;
  double bearing_offset_rad = 0.0;

  static constexpr auto fields() noexcept {
    using R = Radar;
    return field_table(
        field("range_std_m", &R::range_std_m, between(1e-3, 1e5), "m",
              "Standard deviation of the range of a plot."),
        field("bearing_std_rad", &R::bearing_std_rad, kAngleStd, "rad",
              "Standard deviation of the bearing of a plot."),
        field("extent_std_m", &R::extent_std_m, between(0, 1e4), "m",
              "Standard deviation of an echo's position on the hull, per axis."),
        field("period_s", &R::period_s, between(0.01, 3600), "s", "Antenna revolution."),
        field(
            "max_speed_mps", &R::max_speed_mps, between(0.1, 1e4), "m/s",
            "Speed limit of the vessels: no faster track starts, and a confirmed one is lost above "
            "it by three standard deviations of its speed."),
        field("bearing_offset_rad", &R::bearing_offset_rad, kFinite, "rad",
              "Measured minus true bearing; subtracted from every plot."));
  }

  /// A plot seen from own ship as a position with its covariance.
  [[nodiscard]] Gaussian<2> position(double range_m, double bearing_rad,
                                     const OwnShip& own) const noexcept {
    return PolarErrors{range_std_m, bearing_std_rad, extent_std_m, bearing_offset_rad, own}
        .position(range_m, bearing_rad, true);
  }

  friend bool operator==(const Radar&, const Radar&) = default;

  void validate() const { validate_fields(*this); }
};

/// One plot of a scan: when it was seen, where, and from where.
struct Plot {
  double time_s = 0.0;
  double range_m = 0.0;
  double bearing_rad = 0.0;
  OwnShip own = {};
};

}  // namespace wakeline
