// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "wakeline/core/angle.hpp"
#include "wakeline/video/video_plot.hpp"

namespace wakeline::detail {

/// Cells `first` to `last` of a sweep, with sums over those above their thresholds: of amplitude a
/// and of k = cell - first.
struct EchoRun {
  int first = 0;
  int last = 0;
  int cells = 0;
  std::uint32_t peak = 0;
  std::uint64_t a = 0;
  std::uint64_t ak = 0;
  std::uint64_t akk = 0;
  std::uint64_t aa = 0;
};

/// Sums over a run; cells not above their threshold are in a gap and do not count. `threshold` may
/// be null when there is no gap.
template <class Amplitude>
[[nodiscard]] EchoRun add_up(const Amplitude* amplitude, const Amplitude* threshold, int first,
                             int last) noexcept {
  EchoRun run{.first = first, .last = last};
  for (int i = first; i <= last; ++i) {
    if (threshold != nullptr && amplitude[i] <= threshold[i]) continue;
    const std::uint32_t a = amplitude[i];
    const auto k = static_cast<std::uint64_t>(i - first);
    ++run.cells;
    run.peak = std::max(run.peak, a);
    run.a += a;
    run.ak += a * k;
    run.akk += a * k * k;
    run.aa += std::uint64_t{a} * a;
  }
  return run;
}

/// Position of the beam.
struct BeamPlace {
  double azimuth_rad = 0.0;
  double width_rad = 0.0;
  double time_s = 0.0;
};

/// An echo under construction: sums over its cells, of amplitude a, cell r, and offsets b from the
/// azimuth and t from the time of its start.
struct Echo {
  static constexpr double kNothing = std::numeric_limits<double>::infinity();

  BeamPlace began;
  double a = 0.0;
  double ar = 0.0;
  double arr = 0.0;
  double ab = 0.0;
  double abb = 0.0;
  double arb = 0.0;
  double at = 0.0;
  double aa = 0.0;
  double from_rad = kNothing;  ///< edges, as offsets
  double to_rad = -kNothing;
  int first_cell = std::numeric_limits<int>::max();
  int last_cell = -1;
  int cells = 0;
  std::uint32_t peak = 0;
  std::int64_t first_sweep = 0;
  std::int64_t last_sweep = 0;
  bool touches_last_cell = false;
  bool cut = false;
  bool held = false;    ///< connected with the first sweeps of a circle that will be closed
  bool turned = false;  ///< its part at the beginning of the circle has been moved to the end

  void add(const EchoRun& run, const BeamPlace& beam) noexcept {
    const auto first = static_cast<double>(run.first);
    const auto w = static_cast<double>(run.a);
    const auto wk = static_cast<double>(run.ak);
    const double wr = wk + first * w;
    const double b = beam.azimuth_rad - began.azimuth_rad;
    a += w;
    ar += wr;
    arr += static_cast<double>(run.akk) + first * (wk + wr);
    ab += w * b;
    abb += w * b * b;
    arb += wr * b;
    at += w * (beam.time_s - began.time_s);
    aa += static_cast<double>(run.aa);
    from_rad = std::min(from_rad, b - 0.5 * beam.width_rad);
    to_rad = std::max(to_rad, b + 0.5 * beam.width_rad);
    first_cell = std::min(first_cell, run.first);
    last_cell = std::max(last_cell, run.last);
    cells += run.cells;
    peak = std::max(peak, run.peak);
  }

  /// Merges another echo, a connected part of this one.
  void add(const Echo& part) noexcept {
    const double b = part.began.azimuth_rad - began.azimuth_rad;
    a += part.a;
    ar += part.ar;
    arr += part.arr;
    ab += part.ab + b * part.a;
    abb += part.abb + b * (2 * part.ab + b * part.a);
    arb += part.arb + b * part.ar;
    at += part.at + (part.began.time_s - began.time_s) * part.a;
    aa += part.aa;
    from_rad = std::min(from_rad, part.from_rad + b);
    to_rad = std::max(to_rad, part.to_rad + b);
    first_cell = std::min(first_cell, part.first_cell);
    last_cell = std::max(last_cell, part.last_cell);
    cells += part.cells;
    peak = std::max(peak, part.peak);
    first_sweep = std::min(first_sweep, part.first_sweep);
    last_sweep = std::max(last_sweep, part.last_sweep);
    touches_last_cell |= part.touches_last_cell;
    cut |= part.cut;
    held |= part.held;
    turned |= part.turned;
  }

  /// The plot of an echo with at least one cell.
  [[nodiscard]] VideoPlot plot(double start_range_m, double cell_m) const noexcept {
    const double r = ar / a;
    const double b = ab / a;
    const double effective_cells = a * a / aa;
    const double range_spread = std::max(arr / a - r * r, 0.0) * cell_m * cell_m;
    const double bearing_spread = std::max(abb / a - b * b, 0.0);
    const double cross_spread = (arb / a - r * b) * cell_m;
    VideoPlot plot;
    plot.time_s = began.time_s + at / a;
    plot.range_m = start_range_m + (r + 0.5) * cell_m;
    plot.bearing_rad = compass_angle(began.azimuth_rad + b);
    plot.covariance(0, 0) = range_spread / effective_cells + cell_m * cell_m / 12;
    plot.covariance(1, 1) =
        bearing_spread / effective_cells + began.width_rad * began.width_rad / 12;
    plot.covariance(0, 1) = plot.covariance(1, 0) = cross_spread / effective_cells;
    plot.range_extent_m = (last_cell + 1 - first_cell) * cell_m;
    plot.bearing_extent_rad = std::min(to_rad - from_rad, 2 * kPi<double>);
    plot.peak_amplitude = peak;
    plot.total_amplitude = a;
    plot.cells = cells;
    plot.touches_first_cell = first_cell == 0;
    plot.touches_last_cell = touches_last_cell;
    plot.cut = cut;
    return plot;
  }
};

}  // namespace wakeline::detail
