// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/track/place_index.hpp"
#include "wakeline/track/radar.hpp"

namespace wakeline {

/// A plot as a position in the plane, and what tracks say of it.
struct Echo {
  Gaussian<2> position;
  double time_s;
  int plot;              ///< its place among the plots of the scan
  double density = 0.0;  ///< of false plots about it, per m²
  double odds = 0.0;     ///< of all tracks that claim it
  double free = 1.0;     ///< probability that it is no target's that is tracked
  double stray = 1.0;  ///< probability that no track takes it for its own, be there a target or not
  double best_claim = 0.5;
  int best_slot = -1;              ///< of the track with that claim
  std::int64_t best_track_id = 0;  ///< its number then
};

/// The usable plots of one scan, found by where they are. Memory is taken by the constructor.
class Echoes {
 public:
  explicit Echoes(int max_plots) : index_(max_plots) {
    echoes_.reserve(static_cast<std::size_t>(max_plots));
  }

  /// Converts the plots, at most as many as there is room for, and forgets those before. Plots that
  /// are not finite, behind the antenna, of a bearing so large that it is rounded by more than the
  /// radar errs, or farther than `slack_s` from the time of the scan are left out; one that is
  /// ahead of it has a wrong clock, and counts as of its end.
  void take(const Radar& radar, std::span<const Plot> plots, double time_s,
            double slack_s) noexcept {
    echoes_.clear();
    index_.clear();
    earliest_s_ = scan_s_ = time_s;
    constexpr double kRounding = std::numeric_limits<double>::epsilon();
    const std::size_t count = std::min(plots.size(), echoes_.capacity());
    for (std::size_t k = 0; k < count; ++k) {
      const Plot& plot = plots[k];
      const Gaussian<2> position = radar.position(plot.range_m, plot.bearing_rad, plot.own);
      const bool usable = std::fabs(plot.time_s - time_s) <= slack_s && plot.range_m >= 0.0 &&
                          kRounding * std::fabs(plot.bearing_rad) <= radar.bearing_std_rad &&
                          is_finite(position.mean) && Cholesky<2>(position.covariance).ok();
      if (!usable) continue;
      const double plot_s = std::min(plot.time_s, time_s);
      index_.add(position.mean, position.covariance.trace(), size());
      echoes_.push_back({.position = position, .time_s = plot_s, .plot = static_cast<int>(k)});
      earliest_s_ = std::min(earliest_s_, plot_s);
    }
    index_.sort();
  }

  /// Calls `f(echo index)` for every plot in a square about a position: `reach_m(variance)` is its
  /// half side for plots whose covariance has at most that trace.
  template <class Reach, class Function>
  void for_each_near(const Vec<double, 2>& position, const Reach& reach_m,
                     Function&& function) const {
    index_.for_each_near(position, reach_m, function);
  }

  [[nodiscard]] int size() const noexcept { return static_cast<int>(echoes_.size()); }
  [[nodiscard]] const Echo& operator[](int index) const noexcept {
    return echoes_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] Echo& operator[](int index) noexcept {
    return echoes_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] auto begin() noexcept { return echoes_.begin(); }
  [[nodiscard]] auto end() noexcept { return echoes_.end(); }

  [[nodiscard]] auto begin() const noexcept { return echoes_.begin(); }
  [[nodiscard]] auto end() const noexcept { return echoes_.end(); }

  /// No plot is farther from that time.
  [[nodiscard]] double apart_s(double time_s) const noexcept {
    return std::max(scan_s_ - time_s, time_s - earliest_s_);
  }

 private:
  std::vector<Echo> echoes_;
  PlaceIndex index_;
  double earliest_s_ = 0.0;
  double scan_s_ = 0.0;  ///< time of the scan, and of its latest plots
};

}  // namespace wakeline
