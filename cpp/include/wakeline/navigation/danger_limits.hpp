// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Limits of a dangerous approach of two vessels.
///
/// An encounter begins when two vessels will be closer than `cpa_limit_m` within `tcpa_limit_s`
/// with at least `alarm_probability`, their closest approach within that time, too. It ends when
/// the danger is over for `clear_hold_s`: the probability below `clear_probability`, or the closest
/// approach past, or no motion relative to each other, or both vessels at rest. The hold time keeps
/// one alarm per encounter while the estimate of a distant vessel varies.
struct DangerLimits {
  double cpa_limit_m = 926.0;
  double tcpa_limit_s = 1200.0;
  double alarm_probability = 0.5;
  double clear_probability = 0.3;
  double clear_hold_s = 60.0;
  double rest_speed_mps = 0.5;
  double own_length_m = 50.0;
  double own_velocity_std_mps = 0.2;

  static constexpr auto fields() noexcept {
    using D = DangerLimits;
    return field_table(
        field("cpa_limit_m", &D::cpa_limit_m, between(0, 1e6), "m",
              "Distance below which an approach is dangerous."),
        field("tcpa_limit_s", &D::tcpa_limit_s, between(0, 1e5), "s",
              "Time within which the vessels come so close, and to their closest approach."),
        field("alarm_probability", &D::alarm_probability, kProbability, "1",
              "With this probability or more, an encounter begins."),
        field("clear_probability", &D::clear_probability, kProbability, "1",
              "An encounter ends when the probability stays below this, at most "
              "`alarm_probability`."),
        field("clear_hold_s", &D::clear_hold_s, between(0, 1e5), "s",
              "Time for which the danger must be over; shorter gaps end no encounter."),
        field(
            "rest_speed_mps", &D::rest_speed_mps, between(0, 100), "m/s",
            "Vessels up to this speed are at rest (moored, berthed or at anchor); two of them are "
            "no danger to each other."),
        field("own_length_m", &D::own_length_m, between(0, 1000), "m",
              "A vessel that is first dangerous closer than this to own ship is an echo of own "
              "ship."),
        field("own_velocity_std_mps", &D::own_velocity_std_mps, between(0, 100), "m/s",
              "Standard deviation of own ship's velocity per axis, if its covariance is unknown."));
  }

  friend bool operator==(const DangerLimits&, const DangerLimits&) = default;

  void validate() const {
    validate_fields(*this);
    require(clear_probability <= alarm_probability, "clear_probability",
            "at most alarm_probability", clear_probability);
  }
};

/// An area with separate limits, such as a harbor or a fairway.
struct DangerZone {
  std::string name;
  std::vector<Vec<double, 2>> outline_m;  ///< corners [north, east] of a polygon
  DangerLimits limits;

  /// Throws `std::invalid_argument` for fewer than 3 corners, corners that are not finite, and
  /// limits out of range.
  void validate() const {
    require(outline_m.size() >= 3, "outline_m", "3 or more corners",
            static_cast<double>(outline_m.size()));
    for (const auto& corner : outline_m)
      for (const double coordinate : corner) require_finite("outline_m", coordinate);
    limits.validate();
  }

  /// Whether a place [north, east] is inside, by the crossings of its parallel.
  [[nodiscard]] bool contains(const Vec<double, 2>& place_m) const noexcept {
    bool inside = false;
    for (std::size_t k = 0, last = outline_m.size() - 1; k < outline_m.size(); last = k++) {
      const auto &a = outline_m[k], &b = outline_m[last];
      if ((a[0] > place_m[0]) == (b[0] > place_m[0])) continue;
      const double east = a[1] + (place_m[0] - a[0]) / (b[0] - a[0]) * (b[1] - a[1]);
      inside ^= place_m[1] < east;
    }
    return inside;
  }
};

}  // namespace wakeline
