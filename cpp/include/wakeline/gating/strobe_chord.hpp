// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// The part of a ray from the antenna inside a strobe: ranges from `near_m` to `far_m`.
struct StrobeChord {
  double near_m = std::numeric_limits<double>::infinity();
  double far_m = -std::numeric_limits<double>::infinity();

  /// The ranges within `half_m` of `centre_m`, not below zero. Empty when `half_m` is negative or
  /// NaN.
  [[nodiscard]] static StrobeChord about(double centre_m, double half_m) noexcept {
    if (!(half_m >= 0.0) || centre_m + half_m < 0.0) return {};
    return {std::max(0.0, centre_m - half_m), centre_m + half_m};
  }

  [[nodiscard]] bool empty() const noexcept { return !(near_m <= far_m); }
};

/// Upper bound of half the angle that a convex strobe at `range_m` subtends at the antenna, given
/// its half lengths along the line of sight and across it. pi when the antenna may be inside.
inline double half_angle_of_box(double range_m, double along_m, double across_m) noexcept {
  if (!(along_m >= 0.0) || !(across_m >= 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return range_m > along_m ? std::atan2(across_m, range_m - along_m) : kPi<double>;
}

}  // namespace wakeline
