// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <vector>

#include "batch_works.hpp"
#include "fma_peak.hpp"
#include "go_round.hpp"

namespace wakeline::bench {

/// The processor's time, in seconds, that `work()` takes.
template <class Function>
double seconds_of(const Function& work) {
  const std::clock_t began = std::clock();
  work();
  return double(std::clock() - began) / CLOCKS_PER_SEC;
}

/// Adds what the time means for one lane, and returns it.
template <class Scalar>
double tell_time(benchmark::State& state, double seconds) {
  const double ns = 1e9 * seconds / (double(state.iterations()) * kLanesOf<Scalar>);
  state.counters["ns_a_step"] = ns;
  return ns;
}

/// Adds the arithmetic of a step and the share of the measured peak that its sums and products are.
template <class Scalar>
void tell_arithmetic(benchmark::State& state, const FlopCount& count, double ns_a_step) {
  state.counters["flops"] = double(count.flops());
  state.counters["div"] = double(count.divisions);
  state.counters["sqrt"] = double(count.roots);
  state.counters["functions"] = double(count.functions);
  state.counters["of_peak"] =
      1e9 * double(count.flops()) / ns_a_step / peak_flops<RealOf<Scalar>>();
}

/// Steps of an estimator of ours.
template <class Scalar, class Estimator, class Sensor>
void ours(benchmark::State& state, Estimator estimator, const Sensor& sensor, Work work) {
  static const LaneCourse<Scalar> course;
  (void)estimator.start(course.start);
  const double seconds = seconds_of([&] {
    go_round(state, estimator, course.plots(sensor), [&](Estimator& at, const auto& z) {
      benchmark::DoNotOptimize(take(at, sensor, z));
      benchmark::DoNotOptimize(at.estimate());
    });
  });
  tell_arithmetic<Scalar>(state, arithmetic_of(work), tell_time<Scalar>(state, seconds));
}

/// The best of the repetitions, as others use the machine, too.
inline void best_of(benchmark::internal::Benchmark* benchmark) {
  const auto least = [](const std::vector<double>& of) { return *std::ranges::min_element(of); };
  const auto most = [](const std::vector<double>& of) { return *std::ranges::max_element(of); };
  benchmark->ComputeStatistics("min", least)->ComputeStatistics("max", most);
}

}  // namespace wakeline::bench
