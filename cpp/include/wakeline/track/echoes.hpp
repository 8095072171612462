// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "wakeline/core/cholesky.hpp"
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
};

/// The usable plots of one scan, found by where they are. Memory is taken by the constructor.
class Echoes {
 public:
  explicit Echoes(int max_plots) {
    echoes_.reserve(static_cast<std::size_t>(max_plots));
    by_north_.reserve(static_cast<std::size_t>(max_plots));
  }

  /// Converts the plots, at most as many as there is room for, and forgets those before. Plots that
  /// are not finite, behind the antenna, or farther than `slack_s` from the time of the scan are
  /// left out.
  void take(const Radar& radar, std::span<const Plot> plots, double time_s,
            double slack_s) noexcept {
    echoes_.clear();
    by_north_.clear();
    largest_variance_ = 0.0;
    const std::size_t count = std::min(plots.size(), echoes_.capacity());
    for (std::size_t k = 0; k < count; ++k) {
      const Plot& plot = plots[k];
      const Gaussian<2> position = radar.position(plot.range_m, plot.bearing_rad, plot.own);
      const bool usable = std::fabs(plot.time_s - time_s) <= slack_s && plot.range_m >= 0.0 &&
                          is_finite(position.mean) && Cholesky<2>(position.covariance).ok();
      if (!usable) continue;
      by_north_.push_back(size());
      echoes_.push_back({.position = position, .time_s = plot.time_s, .plot = static_cast<int>(k)});
      largest_variance_ = std::max(largest_variance_, position.covariance.trace());
    }
    std::sort(by_north_.begin(), by_north_.end(),
              [&](int a, int b) { return north(a) < north(b) || (north(a) == north(b) && a < b); });
  }

  /// Calls `f(echo index)` for every plot in the square of half side `reach_m` about a position.
  template <class Function>
  void for_each_near(const Vec<double, 2>& position, double reach_m, Function&& function) const {
    auto place = std::lower_bound(by_north_.begin(), by_north_.end(), position[0] - reach_m,
                                  [&](int echo, double limit) { return north(echo) < limit; });
    for (; place != by_north_.end() && north(*place) <= position[0] + reach_m; ++place)
      if (std::fabs((*this)[*place].position.mean[1] - position[1]) <= reach_m) function(*place);
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

  /// Indices from south to north.
  [[nodiscard]] std::span<const int> by_north() const noexcept { return by_north_; }

  /// Largest trace of a covariance, m².
  [[nodiscard]] double largest_variance_m2() const noexcept { return largest_variance_; }

 private:
  [[nodiscard]] double north(int index) const noexcept { return (*this)[index].position.mean[0]; }

  std::vector<Echo> echoes_;
  std::vector<int> by_north_;
  double largest_variance_ = 0.0;
};

}  // namespace wakeline
