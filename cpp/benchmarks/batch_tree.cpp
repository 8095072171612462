// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A tree of mode histories, of which one course fills all lanes.
#include "batch_timing.hpp"
#include "wakeline/multimodel/mode_history.hpp"
#include "wakeline/multimodel/turning_chain.hpp"

namespace {

using namespace wakeline;
using namespace wakeline::bench;

template <class Scalar>
void mode_history(benchmark::State& state) {
  using Filter = Ekf<CoordinatedTurn, Scalar>;
  const TurnRateGrid grid = TurnRateGrid::evenly(deg(4.0), 4);
  static ModeHistory<Filter> tree({.max_branches = 100}, grid, turning_chain(grid),
                                  Filter(turning(0)));
  static const LaneCourse<double> course;
  (void)tree.start(course.start);
  double branches = 0.0;
  const double seconds = seconds_of([&] {
    std::size_t k = 0;
    for (auto _ : state) {
      (void)tree.predict(kStep_s);
      branches += double(tree.hypotheses().size());
      benchmark::DoNotOptimize(tree.update(kRadar, course.polar[k]));
      benchmark::DoNotOptimize(tree.estimate());
      k = (k + 1) % course.polar.size();
    }
  });
  state.counters["us_a_scan"] = 1e6 * seconds / double(state.iterations());
  state.counters["hypotheses"] = branches / double(state.iterations());
}

}  // namespace

BENCHMARK(mode_history<Lanes<double>>)->Name("mode_history100_scan/lanes_double")->Apply(best_of);
BENCHMARK(mode_history<double>)->Name("mode_history100_scan/scalar_double")->Apply(best_of);
