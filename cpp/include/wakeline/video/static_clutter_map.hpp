// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/archive.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/video/azimuth_rows.hpp"
#include "wakeline/video/sweep.hpp"

namespace wakeline {

/// Stationary clutter: the mean amplitude m of each cell of azimuth and range, averaged with the
/// time constant T,
///
///     m += (1 - exp(-dt / T)) (a - m),    dt since the last sweep at this azimuth, m = 0 at first;
///
/// a cell must exceed `factor` * m. Land and buoys disappear after T ln(factor / (factor - 1)), and
/// so does a ship that stays as long: choose T well above the time in which the slowest ship of
/// interest moves by the length of its echo (200 m at 1 m/s: 200 s), and well below the hours in
/// which the tide changes the picture.
///
/// A default-constructed map is empty and does nothing. A change of start range or cell length
/// clears it.
class StaticClutterMap {
 public:
  StaticClutterMap() = default;

  /// `azimuths` rows per revolution and `cells` of range; further cells of a sweep are not changed.
  /// Of several sweeps in a row the largest amplitudes are averaged. Allocates all memory, 4 bytes
  /// per cell. Throws `std::invalid_argument` when a size, time or factor is invalid.
  StaticClutterMap(int azimuths, int cells, double time_constant_s, double factor = 1.5)
      : cells_(static_cast<std::size_t>(cells)),
        time_constant_s_(time_constant_s),
        factor_(static_cast<float>(factor)) {
    require(azimuths >= 1 && azimuths <= 65536, "azimuths", "1 to 65536", azimuths);
    require(cells >= 1 && cells <= 65536, "cells", "1 to 65536", cells);
    require_positive("time_constant_s", time_constant_s);
    require(factor >= 1.0 && factor <= 1000.0, "factor", "1 to 1000", factor);
    seen_s_.resize(static_cast<std::size_t>(azimuths), kNever);
    mean_.resize(seen_s_.size() * cells_, 0.0f);
    strongest_.resize(cells_, 0.0f);
  }

  [[nodiscard]] bool enabled() const noexcept { return !mean_.empty(); }
  [[nodiscard]] int azimuths() const noexcept { return static_cast<int>(seen_s_.size()); }
  [[nodiscard]] int cells() const noexcept { return static_cast<int>(cells_); }

  /// Mean amplitudes (azimuths, cells), row-major.
  [[nodiscard]] std::span<const float> mean() const noexcept { return mean_; }

  [[nodiscard]] double time_constant_s() const noexcept { return time_constant_s_; }
  [[nodiscard]] double factor() const noexcept { return double(factor_); }

  /// Saves or restores the means; fails for a map of different sizes and settings.
  void archive(Archive& fields) {
    const std::size_t rows = seen_s_.size(), cells = mean_.size(), row_cells = strongest_.size();
    fields(start_range_m_);
    fields(cell_m_);
    fields(seen_s_, rows);
    fields(mean_, cells);
    fields(visited_);
    fields(azimuth_rad_);
    fields(turned_rad_);
    fields(gain_);
    fields(strongest_, row_cells);
    if (seen_s_.size() != rows || mean_.size() != cells || strongest_.size() != row_cells)
      fields.fail();
  }

  void clear() noexcept {
    std::ranges::fill(mean_, 0.0f);
    std::ranges::fill(seen_s_, kNever);
    visited_ = kNone;
  }

  /// Raises thresholds by the stationary clutter, then averages the sweep.
  template <class Amplitude>
  void lift_and_learn(const Sweep<Amplitude>& sweep, std::span<Amplitude> threshold) noexcept {
    if (!enabled()) return;
    if (sweep.start_range_m != start_range_m_ || sweep.cell_m != cell_m_) {
      clear();
      start_range_m_ = sweep.start_range_m;
      cell_m_ = sweep.cell_m;
    }
    const std::size_t row = detail::AzimuthRows(azimuths()).of(sweep.azimuth_rad);
    const double half_rad = 0.5 * sweep.azimuth_width_rad;
    const double step_rad = sweep.azimuth_rad - azimuth_rad_;
    turned_rad_ += compass_angle(step_rad);
    const bool first = row != visited_ || std::fabs(wrap_angle(step_rad)) < half_rad ||
                       turned_rad_ > 2 * kPi<double> - half_rad;
    azimuth_rad_ = sweep.azimuth_rad;
    if (first) {
      visited_ = row;
      turned_rad_ = 0.0;
      gain_ = gain_at(row, sweep.time_s);
    }
    constexpr auto kMost = static_cast<float>(std::numeric_limits<Amplitude>::max());
    const float gain = gain_;
    const float factor = factor_;
    const std::size_t cells = std::min(cells_, sweep.amplitude.size());
    const Amplitude* __restrict a = sweep.amplitude.data();
    Amplitude* __restrict t = threshold.data();
    float* __restrict m = mean_.data() + row * cells_;
    float* __restrict s = strongest_.data();
    for (std::size_t i = 0; i < cells; ++i) {
      const auto level = static_cast<Amplitude>(static_cast<int>(std::min(factor * m[i], kMost)));
      t[i] = std::max(t[i], level);
      const auto amplitude = static_cast<float>(a[i]);
      m[i] += gain * (first ? amplitude - m[i] : std::max(amplitude - s[i], 0.0f));
      s[i] = first ? amplitude : std::max(amplitude, s[i]);
    }
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  /// Weight of the new amplitude in the mean of a row; zero at first, or when the time does not
  /// increase.
  [[nodiscard]] float gain_at(std::size_t row, double time_s) noexcept {
    const double since_s = seen_s_[row] == kNever ? 0.0 : time_s - seen_s_[row];
    seen_s_[row] = time_s;
    return static_cast<float>(1.0 - std::exp(-std::max(since_s, 0.0) / time_constant_s_));
  }

  std::size_t cells_ = 0;
  double time_constant_s_ = 0.0;
  float factor_ = 1.0f;
  double start_range_m_ = -1.0;
  double cell_m_ = 0.0;
  std::vector<double> seen_s_;  ///< last time of each azimuth
  std::vector<float> mean_;
  std::size_t visited_ = kNone;   ///< the row of the last sweep
  double azimuth_rad_ = 0.0;      ///< of it
  double turned_rad_ = 0.0;       ///< since the start of the visit to that row
  float gain_ = 0.0f;             ///< weight for the visit to that row
  std::vector<float> strongest_;  ///< largest amplitude of the visit, by cell
};

}  // namespace wakeline
