// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <benchmark/benchmark.h>

#include <cstddef>
#include <vector>

namespace wakeline::bench {

/// Calls `step(filter, plot)` for plot after plot, each round with the filter as it was started: a
/// loop of the book, P - K S Kᵀ on a full P, loses its symmetry, is NaN after some two thousand
/// scans and then quick, as functions of NaN are.
template <class Filter, class Plot, class Step>
void go_round(benchmark::State& state, const Filter& started, const std::vector<Plot>& plots,
              const Step& step) {
  Filter filter = started;
  std::size_t k = 0;
  for (auto _ : state) {
    if (k == plots.size()) {
      filter = started;
      k = 0;
    }
    step(filter, plots[k++]);
    benchmark::DoNotOptimize(filter);
  }
}

}  // namespace wakeline::bench
