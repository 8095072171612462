// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Whole recordings: what `run_batch` adds to the steps by reading plots and writing all results.
#include <chrono>
#include <cstdint>

#include "batch_timing.hpp"
#include "wakeline/batch/run.hpp"

namespace {

using namespace wakeline;
using namespace wakeline::bench;

constexpr std::size_t kRuns = 500, kScans = 250, kStates = 4, kModels = 3;

/// Plots of all runs, and room for all results.
struct Recordings {
  std::vector<double> z, mean, covariance, probability, innovation, nis, log_likelihood;
  std::vector<double> dt_s = std::vector<double>(kScans, kStep_s);
  std::vector<std::uint8_t> status = std::vector<std::uint8_t>(kRuns * kScans);

  Recordings() {
    constexpr std::size_t kSteps = kRuns * kScans;
    for (unsigned run = 0; run < kRuns; ++run) {
      const Course<double> course(run + 1);
      for (std::size_t scan = 0; scan < kScans; ++scan)
        for (int m = 0; m < 2; ++m) z.push_back(course.position[scan][m]);
    }
    mean.resize(kSteps * kStates);
    covariance.resize(kSteps * kStates * kStates);
    probability.resize(kSteps * kModels);
    innovation.resize(kSteps * 2);
    nis.resize(kSteps);
    log_likelihood.resize(kSteps);
  }

  RunInput in() const {
    return {.runs = kRuns, .scans = kScans, .z = z.data(), .dt_s = dt_s.data()};
  }
  RunOutput out() {
    return {.states = kStates,
            .models = kModels,
            .mean = mean.data(),
            .covariance = covariance.data(),
            .mode_probability = probability.data(),
            .innovation = innovation.data(),
            .nis = nis.data(),
            .log_likelihood = log_likelihood.data(),
            .status = status.data()};
  }
};

void imm3_run(benchmark::State& state) {
  using Scalar = Lanes<double>;
  static Recordings recordings;
  const Threads threads{static_cast<int>(state.range(0))};
  const auto start = Course<double>().start.cast<Scalar>();
  const auto begin = [&](std::size_t) {
    auto filter = imm<3, Scalar>();
    (void)filter.start(start);
    return filter;
  };
  const auto began = std::chrono::steady_clock::now();
  for (auto _ : state) {
    run_batch(begin, kFix, recordings.in(), recordings.out(), threads);
    benchmark::ClobberMemory();
  }
  const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - began;
  state.counters["ns_a_step"] =
      elapsed.count() / (double(state.iterations()) * double(kRuns * kScans));
}

}  // namespace

BENCHMARK(imm3_run)
    ->Name("imm3_run/batch_double/threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->Apply(best_of);
