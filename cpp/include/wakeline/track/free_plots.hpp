// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/track/echoes.hpp"
#include "wakeline/track/start.hpp"

namespace wakeline {

/// A plot that no track has claimed.
struct FreePlot {
  Gaussian<2> position;
  double time_s;
};

/// The free plots of the scan before, from which tracks start. Memory is taken by the constructor.
class FreePlots {
 public:
  explicit FreePlots(int max_plots) : capacity_(static_cast<std::size_t>(max_plots)) {
    plots_.reserve(capacity_);
  }

  /// Calls `f(earlier)` for every plot that a target under the speed limit can have given at most
  /// `longest_s` before it gave the echo.
  template <class Function>
  void for_each_before(const Echo& echo, double max_speed_mps, double sigmas, double longest_s,
                       Function&& function) const {
    const double reach = max_speed_mps * std::clamp(echo.time_s - earliest_s_, 0.0, longest_s) +
                         sigmas * std::sqrt(largest_variance_ + echo.position.covariance.trace());
    const double north = echo.position.mean[0];
    const double east = echo.position.mean[1];
    auto place = std::lower_bound(
        plots_.begin(), plots_.end(), north - reach,
        [](const FreePlot& plot, double limit) { return plot.position.mean[0] < limit; });
    for (; place != plots_.end() && place->position.mean[0] <= north + reach; ++place) {
      if (!(std::fabs(place->position.mean[1] - east) <= reach)) continue;
      const double dt_s = echo.time_s - place->time_s;
      if (dt_s > 0.0 && dt_s <= longest_s &&
          within_speed_limit(place->position, echo.position, dt_s, max_speed_mps, sigmas))
        function(*place);
    }
  }

  /// Keeps the echoes that are free with more than that probability, for the next scan.
  void replace(const Echoes& echoes, double free) noexcept {
    plots_.clear();
    for (const int index : echoes.by_north())
      if (const Echo& echo = echoes[index]; echo.free > free)
        plots_.push_back({echo.position, echo.time_s});
    measure();
  }

  /// Saves or restores the plots.
  void archive(Archive& fields) {
    auto count = static_cast<std::uint64_t>(plots_.size());
    fields(count);
    if (count > capacity_) fields.fail();
    if (!fields.ok()) return;
    plots_.resize(static_cast<std::size_t>(count));
    for (FreePlot& plot : plots_) {
      fields(plot.position.mean);
      fields(plot.position.covariance);
      fields(plot.time_s);
    }
    measure();
  }

 private:
  void measure() noexcept {
    largest_variance_ = 0.0;
    earliest_s_ = std::numeric_limits<double>::infinity();
    for (const FreePlot& plot : plots_) {
      largest_variance_ = std::max(largest_variance_, plot.position.covariance.trace());
      earliest_s_ = std::min(earliest_s_, plot.time_s);
    }
  }

  std::size_t capacity_;
  std::vector<FreePlot> plots_;  ///< from south to north
  double largest_variance_ = 0.0;
  double earliest_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace wakeline
