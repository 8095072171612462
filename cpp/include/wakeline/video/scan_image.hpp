// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wakeline/core/amplitude_image.hpp"
#include "wakeline/core/angle.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/video/sweep.hpp"

namespace wakeline {

/// The picture of the last revolution on a regular polar grid, updated sweep by sweep.
///
/// Row k is at the azimuth `first_azimuth_rad` + k 2 pi / `sweeps`. A sweep is written to all rows
/// whose middles it covers, or else to the nearest one. Where consecutive sweeps share a row, the
/// larger amplitude is kept; in the next revolution a row is overwritten. Rows not seen yet are
/// zero.
template <class Amplitude = std::uint8_t>
class ScanImage {
 public:
  /// Allocates all memory. Throws `std::invalid_argument` when a size is invalid.
  ScanImage(int sweeps, int cells, double first_azimuth_rad = 0.0) {
    require(sweeps >= 3 && sweeps <= 65536, "sweeps", "3 to 65536", sweeps);
    require(cells >= 1 && cells <= 65536, "cells", "1 to 65536", cells);
    require_finite("first_azimuth_rad", first_azimuth_rad);
    amplitude_.resize(static_cast<std::size_t>(sweeps) * static_cast<std::size_t>(cells));
    view_ = {.amplitudes = nullptr,
             .sweeps = sweeps,
             .cells = cells,
             .first_azimuth_rad = compass_angle(first_azimuth_rad),
             .azimuth_step_rad = 2 * kPi<double> / sweeps,
             .start_range_m = 0.0,
             .cell_m = 1.0};
  }

  /// Adds a sweep; false, and nothing changed, when it is invalid or has more cells than the image.
  /// Shorter ones are padded with zeros. A different start range or cell length clears the image.
  [[nodiscard]] bool add(const Sweep<Amplitude>& sweep) noexcept {
    if (!sweep.valid() || sweep.amplitude.size() > static_cast<std::size_t>(view_.cells))
      return false;
    if (sweep.start_range_m != view_.start_range_m || sweep.cell_m != view_.cell_m) {
      clear();
      view_.start_range_m = sweep.start_range_m;
      view_.cell_m = sweep.cell_m;
    }
    const double place =
        compass_angle(sweep.azimuth_rad - view_.first_azimuth_rad) / view_.azimuth_step_rad;
    const double half = 0.5 * sweep.azimuth_width_rad / view_.azimuth_step_rad;
    int first = static_cast<int>(std::ceil(place - half - kTouch));
    int last = static_cast<int>(std::ceil(place + half - kTouch)) - 1;
    if (first > last) first = last = static_cast<int>(std::lround(place));
    for (int row = first; row <= last; ++row) write(row, sweep);
    first_ = wrapped(first);
    written_ = std::min(last - first + 1, view_.sweeps);
    return true;
  }

  void clear() noexcept {
    std::ranges::fill(amplitude_, Amplitude{0});
    written_ = 0;
  }

  /// Valid while the image lives; changes with it.
  [[nodiscard]] AmplitudeImage<Amplitude> view() const noexcept {
    AmplitudeImage<Amplitude> image = view_;
    image.amplitudes = amplitude_.data();
    return image;
  }

 private:
  static constexpr double kTouch = 1e-6;  // rows: of two middles at the edges the nearer one counts

  [[nodiscard]] int wrapped(int row) const noexcept {
    return ((row % view_.sweeps) + view_.sweeps) % view_.sweeps;
  }

  /// True for rows of the last sweep.
  [[nodiscard]] bool just_written(int row) const noexcept {
    return wrapped(row - first_) < written_;
  }

  void write(int row, const Sweep<Amplitude>& sweep) noexcept {
    Amplitude* to = amplitude_.data() +
                    static_cast<std::size_t>(wrapped(row)) * static_cast<std::size_t>(view_.cells);
    const std::size_t cells = sweep.amplitude.size();
    if (!just_written(wrapped(row)))
      std::fill_n(to, static_cast<std::size_t>(view_.cells), Amplitude{0});
    for (std::size_t i = 0; i < cells; ++i) to[i] = std::max(to[i], sweep.amplitude[i]);
  }

  std::vector<Amplitude> amplitude_;
  AmplitudeImage<Amplitude> view_;
  int first_ = 0;    ///< rows of the last sweep
  int written_ = 0;  ///< their number
};

}  // namespace wakeline
