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

#include "wakeline/core/archive.hpp"
#include "wakeline/track/clutter_density.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/place_index.hpp"
#include "wakeline/track/plot_ownership.hpp"
#include "wakeline/track/radar.hpp"
#include "wakeline/track/scan_plots.hpp"
#include "wakeline/track/start.hpp"

namespace wakeline {

/// A plot that no track owns.
struct FreePlot {
  Gaussian<2> position;
  double time_s;
};

/// The free plots of the scan before, found by position. Memory is taken by the constructor.
class FreePlots {
 public:
  explicit FreePlots(int max_plots)
      : capacity_(static_cast<std::size_t>(max_plots)), index_(max_plots) {
    plots_.reserve(capacity_);
  }

  /// Calls `f(earlier)` for every plot that a target under the speed limit can have given at most
  /// `longest_s` before it gave `later`.
  template <class Function>
  void for_each_before(const ScanPlot& later, double max_speed_mps, double sigmas, double longest_s,
                       Function&& function) const {
    const double way_m = max_speed_mps * std::clamp(later.time_s - earliest_s_, 0.0, longest_s);
    const double variance_m2 = later.position.covariance.trace();
    const auto reach_m = [&](double earlier_m2) {
      return way_m + sigmas * std::sqrt(earlier_m2 + variance_m2);
    };
    index_.for_each_near(later.position.mean, reach_m, [&](int k) {
      const FreePlot& plot = plots_[static_cast<std::size_t>(k)];
      const double dt_s = later.time_s - plot.time_s;
      if (dt_s > 0.0 && dt_s <= longest_s &&
          within_speed_limit(plot.position, later.position, dt_s, max_speed_mps, sigmas))
        function(plot);
    });
  }

  /// Keeps the plots that are free with more than the least probability, in place of those before.
  void replace(const ScanPlots& plots, std::span<const double> free_probability,
               double least) noexcept {
    plots_.clear();
    for (int k = 0; k < plots.size(); ++k)
      if (free_probability[static_cast<std::size_t>(k)] > least)
        plots_.push_back({plots[k].position, plots[k].time_s});
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

/// The start of a tentative track.
struct TrackStart {
  Gaussian<4> belief;  ///< `[x, vx, y, vy]`
  double time_s;
  double existence;      ///< probability
  LearnedPlots learned;  ///< what the clutter map has learned of its plots
};

/// Two-point initiation: a free plot, and one of the scan before that is near enough for the speed
/// limit, start a track. Memory is taken by the constructor.
class TrackInitiation {
 public:
  TrackInitiation(const Radar& radar, const TrackerConfig& config)
      : config_(config), radar_(radar), before_(config.max_plots) {}

  /// Calls `start(TrackStart)` for every pair, as long as `has_room(existence)`; then keeps the
  /// free plots for the next scan.
  template <class HasRoom, class Start>
  void initiate(const ScanPlots& plots, const PlotOwnership& ownership,
                const ClutterDensity& clutter, const HasRoom& has_room, const Start& start) {
    const double longest_s = std::max(config_.coast_scans_max, kLeastScans) * radar_.period_s;
    for (int k = 0; k < plots.size(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (!(ownership.free_probability()[at] > config_.free_plot)) continue;
      if (!has_room(existence(clutter.per_m2(k), clutter))) continue;
      const auto pair = [&](const FreePlot& earlier) {
        const LearnedPlots own{earlier.position.mean, 1.0, earlier.time_s};
        const double probability = existence(clutter.without(own, plots, k), clutter);
        if (!has_room(probability)) return;
        start(TrackStart{belief(earlier, plots[k]), plots[k].time_s, probability,
                         clutter.with(own, plots, k, ownership.clutter_probability()[at])});
      };
      before_.for_each_before(plots[k], radar_.max_speed_mps, config_.start_gate_sigma, longest_s,
                              pair);
    }
    before_.replace(plots, ownership.free_probability(), config_.free_plot);
  }

  /// What is believed of a velocity before it is measured.
  [[nodiscard]] Gaussian<2> prior_velocity() const noexcept {
    const double factor = config_.start_speed_factor > 0.0 ? config_.start_speed_factor : 1.0;
    const double std_mps = factor * radar_.max_speed_mps;
    return {Vec<double, 2>::Zero(), std_mps * std_mps / 2 * Mat<double, 2, 2>::Identity()};
  }

  /// Saves or restores the free plots of the scan before.
  void archive(Archive& fields) { before_.archive(fields); }

 private:
  static constexpr int kLeastScans = 2;  ///< so far apart two plots of a start may be at least

  /// Probability of existence, which falls with the density of clutter.
  [[nodiscard]] double existence(double clutter_per_m2,
                                 const ClutterDensity& clutter) const noexcept {
    return config_.initial_existence * clutter.floor_per_m2() / clutter_per_m2;
  }

  [[nodiscard]] Gaussian<4> belief(const FreePlot& earlier, const ScanPlot& later) const noexcept {
    const Gaussian<4> of_plots =
        two_point<double>(with_outliers(earlier.position), with_outliers(later.position),
                          later.time_s - earlier.time_s);
    if (!(config_.start_speed_factor > 0.0)) return of_plots;
    return with_speed_prior(of_plots, std::sqrt(prior_velocity().covariance(0, 0)));
  }

  /// With the covariance of nominal and outlier errors together.
  [[nodiscard]] Gaussian<2> with_outliers(const Gaussian<2>& plot) const noexcept {
    const double w = config_.outlier_probability;
    return {plot.mean, (1.0 - w + w * config_.outlier_variance()) * plot.covariance};
  }

  TrackerConfig config_;
  Radar radar_;
  FreePlots before_;
};

}  // namespace wakeline
