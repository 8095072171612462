// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// How long a console waits for a scan: the time of every single scan of the tracker, its
// percentiles and the worst, and whether memory is asked for once it runs.
//
//     latency [association] [targets false_plots scans]...
//
// with association `probabilistic` (unless told otherwise), `global_nearest` or `nearest`. Times
// are by the wall clock and, less what other programs took of the processor, by that of the thread.

#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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

}  // namespace

int main(int argc, char** argv) {
  int next = 1;
  auto association = Association::kProbabilistic;
  if (argc > 1 && std::strchr("gnp", argv[1][0]) != nullptr) {
    const std::string_view name = argv[next++];
    if (name == "global_nearest") association = Association::kGlobalNearest;
    if (name == "nearest") association = Association::kNearest;
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
