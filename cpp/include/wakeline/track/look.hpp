// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/archive.hpp"
#include "wakeline/track/clutter_map.hpp"

namespace wakeline {

/// Where the beam of a radar meets the gate of a track, by its angles, unwrapped.
struct Meeting {
  double passed_rad = 0.0;  ///< when it last passed the target
  double look_rad = 0.0;    ///< before that angle it does not reach the gate

  /// Up to which angle the gate that it last passed may have reached.
  [[nodiscard]] double end_rad() const noexcept {
    return 2.0 * passed_rad + 2 * kPi<double> - look_rad;
  }

  /// The beam has missed turns of that angle.
  void miss_turns(double missed_rad) noexcept {
    passed_rad += missed_rad;
    look_rad += missed_rad;
  }
};

/// What is known of a track as one radar sees it.
struct Look {
  double visibility = 1.0;  ///< probability that the radar can see the target
  double looked_s = 0.0;    ///< when the radar last looked: a plot or a miss
  double seen_s = -std::numeric_limits<double>::infinity();  ///< when it saw the target last
  int misses = 0;                                            ///< of this radar, in a row
  Vec<double, 2> innovation = Vec<double, 2>::Zero();        ///< the last one, whitened
  double product = 0.0;                                      ///< of the last two
  OwnPlots learned = {};  ///< what was learned as clutter of the target's own plots

  void archive(Archive& fields) {
    fields(visibility);
    fields(looked_s);
    fields(seen_s);
    fields(misses);
    fields(innovation);
    fields(product);
    learned.archive(fields);
  }
};

}  // namespace wakeline
