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
  explicit FreePlots(int max_plots)
      : capacity_(static_cast<std::size_t>(max_plots)), index_(max_plots) {
    plots_.reserve(capacity_);
  }

  /// Calls `f(earlier)` for every plot that a target under the speed limit can have given at most
  /// `longest_s` before it gave the echo.
  template <class Function>
  void for_each_before(const Echo& echo, double max_speed_mps, double sigmas, double longest_s,
                       Function&& function) const {
    const double way_m = max_speed_mps * std::clamp(echo.time_s - earliest_s_, 0.0, longest_s);
    const double variance_m2 = echo.position.covariance.trace();
    const auto reach_m = [&](double earlier_m2) {
      return way_m + sigmas * std::sqrt(earlier_m2 + variance_m2);
    };
    index_.for_each_near(echo.position.mean, reach_m, [&](int k) {
      const FreePlot& plot = plots_[static_cast<std::size_t>(k)];
      const double dt_s = echo.time_s - plot.time_s;
      if (dt_s > 0.0 && dt_s <= longest_s &&
          within_speed_limit(plot.position, echo.position, dt_s, max_speed_mps, sigmas))
        function(plot);
    });
  }

  /// Keeps the echoes that are free with more than that probability, for the next scan.
  void replace(const Echoes& echoes, double free) noexcept {
    plots_.clear();
    for (const Echo& echo : echoes)
      if (echo.free > free) plots_.push_back({echo.position, echo.time_s});
    sort();
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
    sort();
  }

 private:
  void sort() noexcept {
    index_.clear();
    earliest_s_ = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < plots_.size(); ++k) {
      const FreePlot& plot = plots_[k];
      index_.add(plot.position.mean, plot.position.covariance.trace(), static_cast<int>(k));
      earliest_s_ = std::min(earliest_s_, plot.time_s);
    }
    index_.sort();
  }

  std::size_t capacity_;
  std::vector<FreePlot> plots_;
  PlaceIndex index_;  ///< of `plots_`
  double earliest_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace wakeline
