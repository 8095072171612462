// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the benchmarks of the tracker look at: vessels that circle in an anchorage among false
// plots, so that a tracker can go on for as long as the timing takes.
#pragma once

#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <vector>

#include "wakeline/track/tracker.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline::bench {

/// Scans that repeat after a full circle of every target. Each target is seen in 9 of 10 scans.
class Anchorage {
 public:
  static constexpr int kScans = 120;
  static constexpr double kPeriod_s = 3.0;

  static Radar radar() {
    return {.range_std_m = 8.0,
            .bearing_std_rad = deg(0.1),
            .period_s = kPeriod_s,
            .max_speed_mps = 25.0};
  }

  /// Targets on circles of 200 m about the points of a grid with 600 m between them.
  Anchorage(int targets, int false_plots) : scans_(kScans) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const int side = static_cast<int>(std::ceil(std::sqrt(targets)));
    const double spacing = 600.0, radius = 200.0, corner = 2000.0;
    for (std::size_t scan = 0; scan < scans_.size(); ++scan) {
      const auto add = [&](double north, double east) {
        scans_[scan].push_back({0.0,
                                std::hypot(north, east) + radar().range_std_m * normal(random),
                                std::atan2(east, north) + radar().bearing_std_rad * normal(random),
                                {}});
      };
      for (int k = 0; k < targets; ++k) {
        if (uniform(random) > 0.9) continue;
        const double angle = 2 * kPi<double> * double(scan) / kScans + k;
        add(corner + spacing * (k / side) + radius * std::cos(angle),
            corner + spacing * (k % side) + radius * std::sin(angle));
      }
      for (int k = 0; k < false_plots; ++k)
        add(corner + spacing * (side * uniform(random) - 0.5),
            corner + spacing * (side * uniform(random) - 0.5));
    }
  }

  /// Time and plots of the next scan.
  std::span<const Plot> next_scan() noexcept {
    time_s_ += kPeriod_s;
    std::vector<Plot>& scan = scans_[next_];
    for (Plot& plot : scan) plot.time_s = time_s_;
    next_ = (next_ + 1) % scans_.size();
    return scan;
  }
  [[nodiscard]] double time_s() const noexcept { return time_s_; }

 private:
  std::vector<std::vector<Plot>> scans_;
  std::size_t next_ = 0;
  double time_s_ = 0.0;
};

/// Confirmed tracks that a console shows.
template <class AnyTracker>
int shown(const AnyTracker& tracker) {
  int count = 0;
  tracker.for_each([&](const auto& track) { count += track.shown(); });
  return count;
}

}  // namespace wakeline::bench
