// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/environment.hpp"

#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>

namespace wakeline {

/// The radar's reception at one azimuth: amplitudes of range cells, from the antenna outwards.
template <std::unsigned_integral Amplitude = std::uint8_t>
struct Sweep {
  double time_s = 0.0;             ///< time of reception
  double azimuth_rad = 0.0;        ///< centre of the sweep, clockwise from north
  double azimuth_width_rad = 0.0;  ///< to the centre of the next sweep
  double start_range_m = 0.0;      ///< near edge of the first cell
  double cell_m = 0.0;             ///< length of a cell
  std::span<const Amplitude> amplitude;

  /// Centre of a cell.
  [[nodiscard]] double range_m(double cell) const noexcept {
    return start_range_m + (cell + 0.5) * cell_m;
  }

  /// True when all numbers are finite and in range, the cell length is positive, the azimuth width
  /// at most half a revolution, and there are cells.
  [[nodiscard]] bool valid() const noexcept {
    return std::fabs(time_s) < 1e15 && std::fabs(azimuth_rad) < 1e6 && azimuth_width_rad > 0.0 &&
           azimuth_width_rad < 3.15 && start_range_m >= 0.0 && start_range_m < 1e9 &&
           cell_m > 0.0 && cell_m < 1e6 && !amplitude.empty();
  }
};

}  // namespace wakeline
