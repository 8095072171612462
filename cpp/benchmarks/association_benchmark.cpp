// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// Assignment of n tracks to n plots, each track with about 1.5 or 5 gated plots: its own, and
// clutter and neighbours chosen uniformly. Costs are NIS of two measured quantities against the 99
// % gate. Each run cycles through 64 scans, so that the branch predictor cannot learn one by heart.
// A loop written by hand does the same beside; where their totals differ both fail.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "sparse_matching.hpp"
#include "wakeline/association/candidates.hpp"
#include "wakeline/association/global_nearest_neighbour.hpp"
#include "wakeline/association/nearest_neighbour.hpp"
#include "wakeline/gating/chi_square_gate.hpp"

namespace {

using namespace wakeline;

constexpr std::size_t kScans = 64;

Candidates<double> draw_scan(int size, double candidates_per_row, std::mt19937_64& random) {
  const double gate = ChiSquareGate{.probability = 0.99}.threshold(2);
  std::uniform_int_distribution<int> any_plot(0, size - 1);
  std::uniform_real_distribution<double> clutter_nis(0.0, gate);
  std::exponential_distribution<double> own_nis(0.5);
  std::poisson_distribution<int> others(candidates_per_row - 1.0);
  Candidates<double> scan(size, 16 * size);
  scan.clear(size);
  std::vector<bool> used(static_cast<std::size_t>(size));
  for (int track = 0; track < size; ++track) {
    scan.start_row(gate);
    used.assign(used.size(), false);
    const auto add_once = [&](int plot, double nis) {
      if (!used[static_cast<std::size_t>(plot)] && nis < gate) scan.add(plot, nis);
      used[static_cast<std::size_t>(plot)] = true;
    };
    add_once(track, own_nis(random));
    for (int k = others(random); k > 0; --k) add_once(any_plot(random), clutter_nis(random));
  }
  return scan;
}

std::vector<Candidates<double>> draw_scans(const benchmark::State& state) {
  std::mt19937_64 random(1);
  std::vector<Candidates<double>> scans;
  for (std::size_t k = 0; k < kScans; ++k)
    scans.push_back(draw_scan(static_cast<int>(state.range(0)),
                              static_cast<double>(state.range(1)) / 10.0, random));
  return scans;
}

template <class Solver>
void run(benchmark::State& state, Solver solver) {
  const auto scans = draw_scans(state);
  std::size_t scan = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(solver.solve(scans[scan]));
    benchmark::ClobberMemory();
    scan = (scan + 1) % kScans;
  }
}

bench::SparseCosts plain(const Candidates<double>& scan) {
  bench::SparseCosts costs;
  costs.columns = scan.columns();
  for (int row = 0; row < scan.rows(); ++row) {
    costs.column.insert(costs.column.end(), scan.columns_of(row).begin(),
                        scan.columns_of(row).end());
    costs.cost.insert(costs.cost.end(), scan.costs_of(row).begin(), scan.costs_of(row).end());
    costs.start.push_back(static_cast<int>(costs.column.size()));
    costs.unassigned.push_back(scan.unassigned_cost(row));
  }
  return costs;
}

void global_nearest_neighbour(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  GlobalNearestNeighbour<double> ours(size, size);
  bench::SparseMatching theirs(size);
  for (const auto& scan : draw_scans(state)) {
    const bool solved = ours.solve(scan);
    if (!solved || std::abs(ours.assignment().total_cost() - theirs.solve(plain(scan))) > 1e-9)
      state.SkipWithError("not the optimum");
  }
  run(state, ours);
}

void hand_loop(benchmark::State& state) {
  std::vector<bench::SparseCosts> scans;
  for (const auto& scan : draw_scans(state)) scans.push_back(plain(scan));
  bench::SparseMatching matching(static_cast<int>(state.range(0)));
  std::size_t scan = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(matching.solve(scans[scan]));
    scan = (scan + 1) % kScans;
  }
}

void nearest_neighbour(benchmark::State& state) {
  const int size = static_cast<int>(state.range(0));
  run(state, NearestNeighbour<double>(size, size, 16 * size));
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"size", "candidates_x10"})->Unit(benchmark::kMicrosecond);
  for (const int size : {200, 1000})
    for (const int candidates_x10 : {15, 50}) benchmark->Args({size, candidates_x10});
}

}  // namespace

BENCHMARK(global_nearest_neighbour)->Apply(sizes);
BENCHMARK(hand_loop)->Name("global_nearest_neighbour/hand_loop")->Apply(sizes);
BENCHMARK(nearest_neighbour)->Apply(sizes);
