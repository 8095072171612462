// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// How long a console waits for a scan: the time of every single scan of the tracker, its
// percentiles and the worst, and whether memory is asked for once it runs.
//
//     latency [association] [targets false_plots scans]...
//     latency sectors [targets false_plots farthest_m]
//
// The first has association `probabilistic` (unless another is named), `global_nearest` or
// `nearest`. Times are by the wall clock and, less what other programs took of the processor, by
// that of the thread. The second prints the wait from a plot to its updated track where turns come
// in sectors, and the processor time of a turn.

#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numeric>
#include <random>
#include <string_view>
#include <vector>

#include "anchorage.hpp"
#include "support/malloc_fence.hpp"

namespace {

using namespace wakeline;
using bench::Anchorage;

double now_ms(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

long peak_memory_kib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

/// One row of the table: the time that this part of all scans does not exceed.
void print_percentiles(const char* clock, std::vector<double> scan_ms) {
  std::sort(scan_ms.begin(), scan_ms.end());
  const auto quantile = [&](double part) {
    return scan_ms[static_cast<std::size_t>(part * static_cast<double>(scan_ms.size() - 1))];
  };
  std::printf("  %-7s %9.3f %9.3f %9.3f %9.3f %9.3f\n", clock, scan_ms.front(), quantile(0.5),
              quantile(0.99), quantile(0.999), scan_ms.back());
}

void measure(Association association, int targets, int false_plots, int scans) {
  Anchorage anchorage(targets, false_plots);
  const Radar radar = Anchorage::radar();
  Tracker tracker(radar, TrackerConfig{.association = association, .max_tracks = 2 * targets + 100},
                  vessel_imm(radar));
  std::vector<double> wall_ms, thread_ms;
  wall_ms.reserve(static_cast<std::size_t>(scans));
  thread_ms.reserve(static_cast<std::size_t>(scans));
  for (int k = 0; k < Anchorage::kScans; ++k) {
    const auto plots = anchorage.next_scan();
    (void)tracker.process(anchorage.time_s(), plots);
  }

  const test::NoHeap fence;
  const long memory_before_kib = peak_memory_kib();
  std::size_t most_plots = 0;
  for (int k = 0; k < scans; ++k) {
    const auto plots = anchorage.next_scan();
    most_plots = std::max(most_plots, plots.size());
    const double wall_began_ms = now_ms(CLOCK_MONOTONIC);
    const double thread_began_ms = now_ms(CLOCK_THREAD_CPUTIME_ID);
    (void)tracker.process(anchorage.time_s(), plots);
    thread_ms.push_back(now_ms(CLOCK_THREAD_CPUTIME_ID) - thread_began_ms);
    wall_ms.push_back(now_ms(CLOCK_MONOTONIC) - wall_began_ms);
  }
  const long allocated = fence.allocations();
  const long grown_kib = peak_memory_kib() - memory_before_kib;
  std::printf(
      "%d targets, up to %zu plots, %d scans, %d tracks shown: %ld allocations, "
      "memory %+ld KiB\n",
      targets, most_plots, scans, bench::shown(tracker), allocated, grown_kib);
  std::printf("  %-7s %9s %9s %9s %9s %9s\n", "ms", "least", "median", "99 %", "99.9 %", "worst");
  print_percentiles("wall", wall_ms);
  print_percentiles("thread", thread_ms);
}

/// Vessels around own ship, of which nine of ten go straight and the others to and fro, seen by an
/// antenna of 24 turns a minute in sectors: the wait from a plot until its track is updated, and
/// the time of a turn.
void measure_sectors(int targets, int false_plots, double farthest_m, int sectors, int turns) {
  constexpr double kPeriod_s = 2.5, kTurn = Beam::kTurn;
  const Radar radar{.range_std_m = 8.0,
                    .bearing_std_rad = deg(0.5),
                    .period_s = kPeriod_s,
                    .max_speed_mps = 25.0};
  Tracker tracker(radar, TrackerConfig{.max_tracks = 2 * targets + 100}, vessel_imm(radar));
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  struct Vessel {
    Vec<double, 2> start_m, heading;
    double speed_mps;
    bool returns;

    [[nodiscard]] Vec<double, 2> at(double time_s) const {
      constexpr double kFarthest_m = 100.0;
      const double way_m = speed_mps * time_s;
      return start_m + heading * (returns ? kFarthest_m * std::sin(way_m / kFarthest_m) : way_m);
    }
  };
  const auto towards = [](double rad) { return Vec<double, 2>(std::cos(rad), std::sin(rad)); };
  std::vector<Vessel> vessels;
  for (int k = 0; k < targets; ++k) {
    const double range_m = farthest_m * std::sqrt(0.01 + uniform(random));
    vessels.push_back({range_m * towards(kTurn * uniform(random)), towards(kTurn * uniform(random)),
                       8.0 * std::abs(normal(random)), k % 10 == 9});
  }
  std::vector<double> wait_ms, turn_ms;
  std::map<std::int64_t, double> updated_s;
  std::vector<Plot> plots, seen;
  for (int turn = 0; turn < turns; ++turn) {
    plots.clear();
    const auto add = [&](double range_m, double bearing_rad) {
      plots.push_back({(turn + compass_angle(bearing_rad) / kTurn) * kPeriod_s,
                       range_m + radar.range_std_m * normal(random),
                       bearing_rad + radar.bearing_std_rad * normal(random),
                       {}});
    };
    for (const Vessel& vessel : vessels) {
      const Vec<double, 2> position_m = vessel.at(turn * kPeriod_s);
      if (uniform(random) < 0.9) add(position_m.norm(), std::atan2(position_m[1], position_m[0]));
    }
    for (int k = 0; k < false_plots; ++k)
      add(farthest_m * std::sqrt(uniform(random)), kTurn * uniform(random));
    double cpu_ms = 0.0;
    for (int sector = 0; sector < sectors; ++sector) {
      const double from_rad = kTurn * sector / sectors, to_rad = kTurn * (sector + 1) / sectors;
      const double time_s = (turn + (sector + 1.0) / sectors) * kPeriod_s;
      seen.clear();
      for (const Plot& plot : plots)
        if (compass_angle(plot.bearing_rad) >= from_rad &&
            compass_angle(plot.bearing_rad) < to_rad) {
          seen.push_back(plot);
          seen.back().time_s = (turn + compass_angle(plot.bearing_rad) / kTurn) * kPeriod_s;
        }
      const double began_ms = now_ms(CLOCK_THREAD_CPUTIME_ID);
      (void)tracker.sector({0, from_rad, to_rad, time_s, seen});
      cpu_ms += now_ms(CLOCK_THREAD_CPUTIME_ID) - began_ms;
      tracker.for_each([&](const Track& track) {
        double& before_s = updated_s[track.tentative_id];
        if (track.shown() && track.misses == 0 && track.time_s > before_s && turn >= 10)
          wait_ms.push_back(1e3 * (time_s - track.time_s));
        before_s = track.time_s;
      });
    }
    if (turn >= 10) turn_ms.push_back(cpu_ms);
  }
  std::printf("%d targets, %d false plots, %d sectors a turn of %.1f s, %d tracks shown\n", targets,
              false_plots, sectors, kPeriod_s, bench::shown(tracker));
  std::printf("  %-7s %9s %9s %9s %9s %9s\n", "ms", "least", "median", "99 %", "99.9 %", "worst");
  print_percentiles("wait", wait_ms);
  print_percentiles("turn", turn_ms);
  std::printf("  %-7s %9.3f\n", "mean",
              std::accumulate(turn_ms.begin(), turn_ms.end(), 0.0) / double(turn_ms.size()));
}

}  // namespace

int main(int argc, char** argv) {
  int next = 1;
  auto association = Association::kProbabilistic;
  if (argc > 1 && std::strchr("gnp", argv[1][0]) != nullptr) {
    const std::string_view name = argv[next++];
    if (name == "global_nearest") association = Association::kGlobalNearest;
    if (name == "nearest") association = Association::kNearest;
  }
  if (argc > 1 && std::string_view(argv[1]) == "sectors") {
    const bool is_given = argc > 4;
    const int targets = is_given ? std::max(std::atoi(argv[2]), 1) : 1000;
    const int false_plots = is_given ? std::max(std::atoi(argv[3]), 0) : 500;
    const double farthest_m = is_given ? std::atof(argv[4]) : 20000.0;
    for (const int sectors : {1, 8, 16, 32, 64})
      measure_sectors(targets, false_plots, farthest_m, sectors, 60);
    return 0;
  }
  if (next == argc) {
    measure(association, 100, 60, 10000);
    measure(association, 1000, 600, 10000);
    measure(association, 5000, 3000, 1000);
  }
  for (; next + 2 < argc; next += 3)
    measure(association, std::max(std::atoi(argv[next]), 1), std::max(std::atoi(argv[next + 1]), 0),
            std::max(std::atoi(argv[next + 2]), 1));
}
