// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include "wakeline/core/types.hpp"

namespace wakeline {

/// The circular strobe of another track on the same picture.
struct RivalStrobe {
  Vec<double, 2> centre_m;  ///< [north, east] from the antenna
  double radius_m;
  bool senior;  ///< has the cells that are equally far from both centres
};

/// Whether a point inside a strobe about `centre_m` belongs to one of its rivals: to one that
/// contains it and whose centre is nearer.
inline bool is_rivals(const Vec<double, 2>& point_m, const Vec<double, 2>& centre_m,
                      std::span<const RivalStrobe> rivals) noexcept {
  const double distance2 = (point_m - centre_m).squaredNorm();
  for (const RivalStrobe& rival : rivals) {
    const double other2 = (point_m - rival.centre_m).squaredNorm();
    if (other2 <= rival.radius_m * rival.radius_m &&
        (other2 < distance2 || (rival.senior && other2 == distance2)))
      return true;
  }
  return false;
}

}  // namespace wakeline
