// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// A whole scan of the tracker with its default three-model estimator: prediction, gate,
// association, update, life and death of tracks. Targets circle in an anchorage, each seen in 9 of
// 10 scans, among false plots; the scans repeat after a full circle, so that the tracker can go on
// for as long as the timing takes. Counters: confirmed tracks and plots of a scan.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "wakeline/track/tracker.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace {

using namespace wakeline;

constexpr int kScans = 120;
constexpr double kPeriod_s = 3.0;

/// `targets` targets on circles about the points of a grid with 600 m between them, and
/// `false_plots` false plots.
std::vector<std::vector<Plot>> make_scans(int targets, int false_plots, const Radar& radar) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const int side = static_cast<int>(std::ceil(std::sqrt(targets)));
  const double spacing = 600.0, radius = 200.0, corner = 2000.0;
  std::vector<std::vector<Plot>> scans(kScans);
  for (int scan = 0; scan < kScans; ++scan) {
    const auto add = [&](double north, double east) {
      scans[static_cast<std::size_t>(scan)].push_back(
          {0.0,
           std::hypot(north, east) + radar.range_std_m * normal(random),
           std::atan2(east, north) + radar.bearing_std_rad * normal(random),
           {}});
    };
    for (int k = 0; k < targets; ++k) {
      if (uniform(random) > 0.9) continue;
      const double angle = 2 * kPi<double> * scan / kScans + k;
      add(corner + spacing * (k / side) + radius * std::cos(angle),
          corner + spacing * (k % side) + radius * std::sin(angle));
    }
    for (int k = 0; k < false_plots; ++k)
      add(corner + spacing * (side * uniform(random) - 0.5),
          corner + spacing * (side * uniform(random) - 0.5));
  }
  return scans;
}

void tracker_scan(benchmark::State& state, Association association) {
  const Radar radar{.range_std_m = 8.0,
                    .bearing_std_rad = deg(0.1),
                    .period_s = kPeriod_s,
                    .max_speed_mps = 25.0};
  auto scans =
      make_scans(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), radar);
  Tracker tracker(radar, TrackerConfig{.association = association, .max_tracks = 4000},
                  vessel_imm(radar));
  double time_s = 0.0;
  std::size_t next = 0;
  const auto take_scan = [&] {
    time_s += kPeriod_s;
    for (Plot& plot : scans[next]) plot.time_s = time_s;
    benchmark::DoNotOptimize(tracker.process(time_s, scans[next]));
    next = (next + 1) % kScans;
  };
  for (int k = 0; k < kScans; ++k) take_scan();
  for (auto _ : state) take_scan();

  int confirmed = 0;
  tracker.for_each([&](const auto& track) { confirmed += track.shown(); });
  state.counters["tracks"] = confirmed;
  state.counters["all_tracks"] = tracker.size();
  state.counters["plots"] = static_cast<double>(scans[0].size());
}

void probabilistic(benchmark::State& state) { tracker_scan(state, Association::kProbabilistic); }
void global_nearest(benchmark::State& state) { tracker_scan(state, Association::kGlobalNearest); }

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"targets", "false"})->Unit(benchmark::kMicrosecond);
  benchmark->Args({100, 110})->Args({200, 200})->Args({1000, 600});
}

}  // namespace

BENCHMARK(probabilistic)->Name("tracker_scan/probabilistic")->Apply(sizes);
BENCHMARK(global_nearest)->Name("tracker_scan/global_nearest")->Apply(sizes);
