// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "wakeline/core/types.hpp"

namespace wakeline::detail {

/// Weighted sums over cells, with range and bearing relative to a nearby reference.
struct StrobeSums {
  double weight;        ///< Σ w
  double squares;       ///< Σ w²
  double range;         ///< Σ w ρ
  double range2;        ///< Σ w ρ²
  double along;         ///< Σ w cos β
  double across;        ///< Σ w sin β
  double range_along;   ///< Σ w ρ cos β
  double range_across;  ///< Σ w ρ sin β
  double amplitude;     ///< Σ a
  int peak;             ///< max a
  int cells;
  bool extends_outside;  ///< a cell adjacent to one of them is above the threshold but outside the
                         ///< strobe

  StrobeSums& operator+=(const StrobeSums& other) noexcept {
    weight += other.weight;
    squares += other.squares;
    range += other.range;
    range2 += other.range2;
    along += other.along;
    across += other.across;
    range_along += other.range_along;
    range_across += other.range_across;
    amplitude += other.amplitude;
    peak = std::max(peak, other.peak);
    cells += other.cells;
    extends_outside = extends_outside || other.extends_outside;
    return *this;
  }

  [[nodiscard]] double mean_range() const noexcept { return range / weight; }

  /// Direction of the mean unit vector.
  [[nodiscard]] double mean_bearing() const noexcept { return std::atan2(across, along); }

  /// Covariance of range and bearing over the cells. The bearing variance is 2 (1 - R), R the
  /// length of the mean unit vector: for a narrow echo the variance, and never too small for a
  /// covariance matrix.
  [[nodiscard]] Mat<double, 2, 2> spread() const noexcept {
    const double length = std::hypot(along, across);
    const double range_spread = range2 / weight - mean_range() * mean_range();
    const double bearing_spread = 2.0 * (1.0 - length / weight);
    const double common =
        length > 0.0 ? (range_across * along - range_along * across) / (length * weight) : 0.0;
    Mat<double, 2, 2> spread;
    spread << std::max(0.0, range_spread), common, common, std::max(0.0, bearing_spread);
    return spread;
  }

  /// (Σ w)² / Σ w²: the number of cells of equal weight with the same information.
  [[nodiscard]] double effective_cells() const noexcept { return weight * weight / squares; }
};

/// The sums over all cells of an echo, and over those that no rival strobe has.
struct ClaimedSums {
  StrobeSums all;
  StrobeSums own;

  ClaimedSums& operator+=(const ClaimedSums& other) noexcept {
    all += other.all;
    own += other.own;
    return *this;
  }

  /// Share of the echo's weight in cells that no rival has.
  [[nodiscard]] double share() const noexcept { return own.weight / all.weight; }
};

}  // namespace wakeline::detail
