// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Pictures for the tests of video, and how an extractor is fed with them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "wakeline/video/plot_extractor.hpp"

namespace wakeline::test {

template <class Amplitude = std::uint8_t>
struct Picture {
  int sweeps = 0;
  int cells = 0;
  std::vector<Amplitude> amplitude =
      std::vector<Amplitude>(static_cast<std::size_t>(sweeps) * static_cast<std::size_t>(cells));
  double start_range_m = 100.0;
  double cell_m = 10.0;

  [[nodiscard]] double step() const { return 2 * kPi<double> / sweeps; }

  Amplitude& at(int sweep, int cell) {
    const int row = ((sweep % sweeps) + sweeps) % sweeps;
    return amplitude[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells) +
                     static_cast<std::size_t>(cell)];
  }
  Amplitude at(int sweep, int cell) const { return const_cast<Picture*>(this)->at(sweep, cell); }

  /// Sweep k of the turns that the antenna makes, at 1 ms each.
  [[nodiscard]] Sweep<Amplitude> sweep(int k) const {
    const int row = k % sweeps;
    return {.time_s = k * 1e-3,
            .azimuth_rad = row * step(),
            .azimuth_width_rad = step(),
            .start_range_m = start_range_m,
            .cell_m = cell_m,
            .amplitude = {amplitude.data() + static_cast<std::ptrdiff_t>(row) * cells,
                          static_cast<std::size_t>(cells)}};
  }

  [[nodiscard]] AmplitudeImage<Amplitude> image() const {
    return {.amplitudes = amplitude.data(),
            .sweeps = sweeps,
            .cells = cells,
            .first_azimuth_rad = 0.0,
            .azimuth_step_rad = step(),
            .start_range_m = start_range_m,
            .cell_m = cell_m};
  }
};

/// Every cell is above its threshold that is not zero, and all of an echo are wanted.
inline PlotExtractorSettings every_cell(int cells) {
  return {.cfar = {.train_cells = 128, .guard_cells = 0, .threshold_factor = 1e-6},
          .max_sweep_cells = cells,
          .min_cells = 1};
}

template <class Amplitude>
std::vector<VideoPlot> feed(PlotExtractor<Amplitude>& extractor, const Picture<Amplitude>& picture,
                            int first, int count) {
  std::vector<VideoPlot> plots;
  for (int k = first; k < first + count; ++k)
    for (const VideoPlot& plot : extractor.process(picture.sweep(k))) plots.push_back(plot);
  return plots;
}

template <class Amplitude>
std::vector<VideoPlot> finish(PlotExtractor<Amplitude>& extractor) {
  const auto plots = extractor.finish();
  return {plots.begin(), plots.end()};
}

/// Speckle: each cell is there with a probability, with an amplitude of 1 to `most`.
template <class Amplitude = std::uint8_t>
Picture<Amplitude> speckle(int sweeps, int cells, double probability, std::mt19937& random,
                           int most = 200) {
  Picture<Amplitude> picture{sweeps, cells};
  std::bernoulli_distribution there(probability);
  std::uniform_int_distribution<int> any(1, most);
  for (auto& a : picture.amplitude) a = static_cast<Amplitude>(there(random) ? any(random) : 0);
  return picture;
}

/// A smooth echo about (sweep, cell), which need not be whole numbers, across north too.
template <class Amplitude>
void add_ship(Picture<Amplitude>& picture, double sweep, double cell, double peak = 200.0,
              double sweeps = 4.0, double cells = 1.2) {
  for (int j = static_cast<int>(sweep - 4 * sweeps); j <= sweep + 4 * sweeps; ++j)
    for (int i = std::max(static_cast<int>(cell - 4 * cells), 0);
         i <= std::min(static_cast<int>(cell + 4 * cells), picture.cells - 1); ++i) {
      const double u = (j - sweep) / sweeps;
      const double v = (i - cell) / cells;
      const double a = peak * std::exp(-0.5 * (u * u + v * v));
      Amplitude& there = picture.at(j, i);
      there = std::max(there, static_cast<Amplitude>(a));
    }
}

}  // namespace wakeline::test
