// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "wakeline/core/angle.hpp"

namespace wakeline::detail {

/// A revolution divided into rows of equal width. Radars have the centres of their sweeps at whole
/// or half steps; the row boundaries are at neither, so that a sweep falls into the same row in
/// every revolution, however its azimuth is rounded.
class AzimuthRows {
 public:
  explicit AzimuthRows(int rows) noexcept : rows_(rows) {}

  [[nodiscard]] double step() const noexcept { return 2 * kPi<double> / rows_; }

  /// Number of rows from the one about north to an azimuth from 0 to 2 pi, not wrapped.
  [[nodiscard]] int count_to(double azimuth_rad) const noexcept {
    return static_cast<int>(azimuth_rad / step() + kPhase);
  }

  /// Row of any azimuth.
  [[nodiscard]] std::size_t of(double azimuth_rad) const noexcept {
    return static_cast<std::size_t>(count_to(compass_angle(azimuth_rad)) % rows_);
  }

  /// Azimuth of the middle of a row.
  [[nodiscard]] double middle(int row) const noexcept { return (row + 0.5 - kPhase) * step(); }

 private:
  static constexpr double kPhase = 0.38;

  int rows_;
};

}  // namespace wakeline::detail
