// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// What late data cost: a turn of the antenna by a tracker behind a window, and its ratio to a
// tracker that has the same inputs in order, measured in turns. A snapshot, beside what saves.

#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "anchorage.hpp"
#include "wakeline/track/late_window.hpp"

namespace {

using namespace wakeline;

using VesselTracker = Tracker<VesselImm>;

constexpr double kTurn = Beam::kTurn;
constexpr int kWarmTurns = 12;

Radar radar() {
  return {.range_std_m = 8.0, .bearing_std_rad = deg(0.5), .period_s = 2.5, .max_speed_mps = 25.0};
}

TrackerConfig config(int targets) { return {.max_tracks = 2 * targets + 100}; }

double cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

struct Part {
  double from_rad, to_rad, time_s;
  std::vector<Plot> plots;

  [[nodiscard]] Sector sector() const { return {0, from_rad, to_rad, time_s, plots}; }
};

/// Vessels that go to and fro around own ship among false plots, half as many, turn by turn.
class Traffic {
 public:
  explicit Traffic(int targets) : targets_(targets) {
    for (int k = 0; k < targets; ++k)
      vessels_.push_back({20000.0 * std::sqrt(0.01 + uniform_(random_)), kTurn * uniform_(random_),
                          8.0 * normal_(random_)});
  }

  /// The next turn in so many sectors.
  std::vector<Part> next(int sectors) {
    const double period_s = radar().period_s;
    std::vector<Part> parts;
    for (int k = 0; k < sectors; ++k)
      parts.push_back({kTurn * k / sectors,
                       kTurn * (k + 1) / sectors,
                       (turn_ + (k + 1.0) / sectors) * period_s,
                       {}});
    const auto add = [&](double range_m, double bearing_rad) {
      bearing_rad = compass_angle(bearing_rad + radar().bearing_std_rad * normal_(random_));
      const auto part =
          std::min(static_cast<std::size_t>(bearing_rad / kTurn * sectors), parts.size() - 1);
      parts[part].plots.push_back({(turn_ + bearing_rad / kTurn) * period_s,
                                   std::abs(range_m + radar().range_std_m * normal_(random_)),
                                   bearing_rad,
                                   {}});
    };
    for (const Vessel& vessel : vessels_)
      if (uniform_(random_) < 0.9)
        add(vessel.range_m + 100.0 * std::sin(vessel.speed_mps * turn_ * period_s / 100.0),
            vessel.bearing_rad);
    for (int k = 0; k < targets_ / 2; ++k)
      add(20000.0 * std::sqrt(uniform_(random_)), kTurn * uniform_(random_));
    ++turn_;
    return parts;
  }

 private:
  struct Vessel {
    double range_m, bearing_rad, speed_mps;
  };

  int targets_;
  int turn_ = 0;
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
  std::vector<Vessel> vessels_;
};

/// How inputs come: in time, or some a turn late. Every other sector is of the sensor that is late;
/// of whole turns, every other one comes after the next.
enum class Order { kInTime, kOneTurnLate };

/// The parts of this turn, of `sectors` each, as they come.
std::vector<const Part*> as_they_come(const std::vector<Part>& now, const std::vector<Part>& before,
                                      int turn, Order order) {
  std::vector<const Part*> come;
  if (order == Order::kInTime || now.size() > 1) {
    for (std::size_t k = 0; k < now.size(); ++k)
      come.push_back(order == Order::kInTime || k % 2 == 0 ? &now[k] : &before[k]);
  } else if (turn % 2 == 1) {
    come = {&now[0], &before[0]};
  }
  return come;
}

void late_window(benchmark::State& state, Order order) {
  const auto targets = static_cast<int>(state.range(0)), sectors = static_cast<int>(state.range(1));
  Traffic traffic(targets);
  VesselTracker tracker(radar(), config(targets), vessel_imm(radar()));
  LateWindow<VesselTracker> window({}, radar(), config(targets), vessel_imm(radar()));
  std::vector<Part> before = traffic.next(sectors);
  double in_order_s = 0.0, window_s = 0.0;
  int turn = 1;
  const auto take_turn = [&] {
    std::vector<Part> now = traffic.next(sectors);
    const double began_s = cpu_s();
    for (const Part& part : now) benchmark::DoNotOptimize(tracker.sector(part.sector()));
    const double ordered_s = cpu_s();
    for (const Part* part : as_they_come(now, before, turn, order))
      benchmark::DoNotOptimize(window.sector(part->sector()));
    const double late_s = cpu_s();
    before = std::move(now);
    if (++turn <= kWarmTurns) return 0.0;
    in_order_s += ordered_s - began_s;
    window_s += late_s - ordered_s;
    return late_s - ordered_s;
  };
  while (turn < kWarmTurns) take_turn();
  for (auto _ : state) state.SetIterationTime(take_turn());
  state.counters["ratio"] = window_s / in_order_s;
  state.counters["tracks"] = bench::shown(window.tracker());
  state.counters["corrections"] = double(window.counts().corrections) / double(turn);
}

void in_time(benchmark::State& state) { late_window(state, Order::kInTime); }
void one_turn_late(benchmark::State& state) { late_window(state, Order::kOneTurnLate); }

/// A tracker that has processed some turns.
VesselTracker busy_tracker(int targets) {
  Traffic traffic(targets);
  VesselTracker tracker(radar(), config(targets), vessel_imm(radar()));
  for (int k = 0; k < 2 * kWarmTurns; ++k)
    for (const Part& part : traffic.next(8)) (void)tracker.sector(part.sector());
  return tracker;
}

void snapshot(benchmark::State& state) {
  const auto targets = static_cast<int>(state.range(0));
  const VesselTracker tracker = busy_tracker(targets);
  std::vector<VesselTracker> snapshots;
  for (int k = 0; k < 8; ++k) snapshots.emplace_back(radar(), config(targets), vessel_imm(radar()));
  std::size_t next = 0;
  for (auto _ : state) {
    snapshots[next].copy_state_from(tracker);
    next = (next + 1) % snapshots.size();
    benchmark::ClobberMemory();
  }
  state.counters["tracks"] = tracker.size();
}

void save(benchmark::State& state) {
  const VesselTracker tracker = busy_tracker(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(tracker.save());
  state.counters["tracks"] = tracker.size();
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"targets", "sectors"})->Unit(benchmark::kMillisecond)->UseManualTime();
  benchmark->Args({100, 32})->Args({1000, 1})->Args({1000, 32});
}

}  // namespace

BENCHMARK(in_time)->Name("late_window/in_time")->Apply(sizes);
BENCHMARK(one_turn_late)->Name("late_window/one_turn_late")->Apply(sizes);
BENCHMARK(snapshot)->Name("tracker/copy_state_from")->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(save)->Name("tracker/save")->Arg(1000)->Unit(benchmark::kMillisecond);
