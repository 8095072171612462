// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// An update of EncounterWatch beside the closest approach and probability of all pairs. Arguments:
// vessels, side of the square in km, and how many of a hundred are under way (the others are moored
// or at anchor). Counters: approaches that matter, and encounters.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "wakeline/core/angle.hpp"
#include "wakeline/navigation/encounter_watch.hpp"

namespace {

using namespace wakeline;

/// Vessels at 2 to 10 m/s on any course, or at rest; settled tracks of 10 to 40 m and 0.05 to 0.15
/// m/s per axis.
class Waters {
 public:
  explicit Waters(const benchmark::State& state) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform;
    const double side_m = 1000.0 * static_cast<double>(state.range(1));
    for (int k = 1; k <= state.range(0); ++k) {
      const bool under_way = 100.0 * uniform(random) < static_cast<double>(state.range(2));
      const double course = 2 * kPi<double> * uniform(random);
      const double speed = under_way ? 2.0 + 8.0 * uniform(random) : 0.2 * uniform(random);
      const double p = 10.0 + 30.0 * uniform(random), v = 0.05 + 0.1 * uniform(random);
      WatchedVessel one{k, {}};
      one.kinematics.mean << side_m * uniform(random), speed * std::cos(course),
          side_m * uniform(random), speed * std::sin(course);
      one.kinematics.covariance.setZero();
      for (const int axis : {0, 2}) {
        one.kinematics.covariance(axis, axis) = p * p;
        one.kinematics.covariance(axis + 1, axis + 1) = v * v;
        one.kinematics.covariance(axis, axis + 1) = one.kinematics.covariance(axis + 1, axis) =
            p * v / 2;
      }
      vessels_.push_back(one);
    }
  }

  /// The vessels three seconds later.
  const std::vector<WatchedVessel>& next() {
    for (WatchedVessel& one : vessels_)
      for (const int axis : {0, 2})
        one.kinematics.mean[axis] += 3.0 * one.kinematics.mean[axis + 1];
    return vessels_;
  }

 private:
  std::vector<WatchedVessel> vessels_;
};

void watch(benchmark::State& state) {
  Waters waters(state);
  EncounterWatch watch({}, {}, static_cast<int>(state.range(0)));
  double time_s = 0.0;
  std::size_t approaches = 0;
  for (auto _ : state) {
    approaches = watch.update(time_s += 3.0, waters.next()).approaches.size();
    benchmark::DoNotOptimize(approaches);
  }
  state.counters["approaches"] = static_cast<double>(approaches);
  state.counters["encounters"] = static_cast<double>(watch.encounters().size());
}

void all_pairs(benchmark::State& state) {
  Waters waters(state);
  const DangerLimits limits;
  int dangers = 0;
  for (auto _ : state) {
    const std::vector<WatchedVessel>& vessels = waters.next();
    dangers = 0;
    for (std::size_t i = 0; i < vessels.size(); ++i)
      for (std::size_t j = i + 1; j < vessels.size(); ++j) {
        const auto approach = closest_approach(vessels[i].kinematics, vessels[j].kinematics);
        const double p = approach.probability(limits.cpa_limit_m, limits.tcpa_limit_s);
        dangers += p >= limits.alarm_probability;
      }
    benchmark::DoNotOptimize(dangers);
  }
  state.counters["dangers"] = dangers;
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"vessels", "km", "under_way"})
      ->Unit(benchmark::kMillisecond)
      ->Iterations(40);
  benchmark->Args({100, 20, 100})
      ->Args({1000, 40, 30})
      ->Args({1000, 40, 100})
      ->Args({1000, 80, 100});
}

}  // namespace

BENCHMARK(watch)->Name("encounters/watch")->Apply(sizes);
BENCHMARK(all_pairs)->Name("encounters/all_pairs")->Apply(sizes);
