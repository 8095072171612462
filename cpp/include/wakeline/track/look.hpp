// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "wakeline/core/archive.hpp"
#include "wakeline/track/clutter_map.hpp"

namespace wakeline {

/// What is known of a track as one radar sees it.
struct Look {
  double visibility = 1.0;  ///< probability that the radar can see the target
  double looked_s = 0.0;    ///< when the radar last looked: a plot or a miss
  double seen_s = -std::numeric_limits<double>::infinity();  ///< when it saw the target last
  int misses = 0;                                            ///< of this radar, in a row
  Vec<double, 2> innovation = Vec<double, 2>::Zero();        ///< the last one, whitened
  double product = 0.0;                                      ///< of the last two
  Vec<double, 2> sum = Vec<double, 2>::Zero();  ///< of them, each a twentieth less than the next
  OwnPlots learned = {};  ///< what was learned as clutter of the target's own plots

  /// Takes the whitened innovation of a plot.
  void note(const Vec<double, 2>& whitened) noexcept {
    product = whitened.dot(innovation);
    innovation = whitened;
    sum = kMemory * sum + whitened;
  }

  /// Whether plots are beside the track by what no chance is: χ² of two degrees of freedom, were
  /// they about it.
  [[nodiscard]] bool is_beside() const noexcept {
    constexpr double kBeside = 25.0;
    return (1.0 - kMemory * kMemory) * sum.squaredNorm() > kBeside;
  }

  void archive(Archive& fields) {
    fields(visibility);
    fields(looked_s);
    fields(seen_s);
    fields(misses);
    fields(innovation);
    fields(product);
    fields(sum);
    learned.archive(fields);
  }

 private:
  static constexpr double kMemory = 0.95;
};

}  // namespace wakeline
