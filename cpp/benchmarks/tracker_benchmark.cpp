// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// A whole scan of the tracker with its default three-model estimator: prediction, gate,
// association, update, life and death of tracks. Counters: confirmed tracks, all tracks, and plots
// of a scan.

#include <benchmark/benchmark.h>

#include <cstddef>

#include "anchorage.hpp"

namespace {

using namespace wakeline;
using bench::Anchorage;

void tracker_scan(benchmark::State& state, Association association) {
  Anchorage anchorage(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const Radar radar = Anchorage::radar();
  Tracker tracker(radar, TrackerConfig{.association = association, .max_tracks = 4000},
                  vessel_imm(radar));
  std::size_t plots = 0;
  const auto take_scan = [&] {
    const auto scan = anchorage.next_scan();
    plots = scan.size();
    benchmark::DoNotOptimize(tracker.process(anchorage.time_s(), scan));
  };
  for (int k = 0; k < Anchorage::kScans; ++k) take_scan();
  for (auto _ : state) take_scan();

  state.counters["tracks"] = bench::shown(tracker);
  state.counters["all_tracks"] = tracker.size();
  state.counters["plots"] = static_cast<double>(plots);
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
