// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/archive.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/track/beam.hpp"
#include "wakeline/track/clutter_density.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/place_index.hpp"
#include "wakeline/track/plot_ownership.hpp"
#include "wakeline/track/radar.hpp"
#include "wakeline/track/scan_plots.hpp"
#include "wakeline/track/start.hpp"

namespace wakeline {

/// A plot that perhaps no track owns.
struct FreePlot {
  Gaussian<2> position;
  double time_s;
  double beam_rad;  ///< as in `ScanPlot`
  ConvertedErrors errors = {};
  double free = 1.0;  ///< the probability of that
};

/// The free plots of the turn before, found by position. Memory is taken by the constructor.
class FreePlots {
 public:
  explicit FreePlots(int max_plots)
      : capacity_(4 * static_cast<std::size_t>(max_plots)), index_(4 * max_plots) {
    plots_.reserve(capacity_);
  }

  /// Calls `f(earlier)` for the plots, at most `kMostNear` of a layer of the index, that a target
  /// under the speed limit can have given in one of the two turns before, by the angle of the beam
  /// or by time, and at most `longest_s` before it gave `later`.
  template <class Function>
  void for_each_before(const ScanPlot& later, double max_speed_mps, double period_s, double sigmas,
                       double longest_s, Function&& function) const {
    const double way_m = max_speed_mps * std::clamp(later.time_s - earliest_s_, 0.0, longest_s);
    const double variance_m2 = later.position.covariance.trace();
    const auto reach_m = [&](double earlier_m2) {
      return way_m + sigmas * std::sqrt(earlier_m2 + variance_m2);
    };
    index_.for_each_nearest_of<kMostNear>(plots_, later.position.mean, reach_m, [&](int k) {
      const FreePlot& plot = plots_[static_cast<std::size_t>(k)];
      const double dt_s = later.time_s - plot.time_s;
      const double turns = (later.beam_rad - plot.beam_rad) / Beam::kTurn;
      const bool turn_before =
          !(std::abs(turns - 1.5) > 1.0) || std::abs(dt_s - 1.5 * period_s) < period_s;
      if (turn_before && dt_s > 0.0 && dt_s <= longest_s &&
          within_speed_limit(plot.position, later.position, dt_s, max_speed_mps, sigmas))
        function(plot);
    });
  }

  /// Adds the plots that do not wait and may start a track.
  void add(const ScanPlots& plots, const PlotOwnership& ownership, double free_plot) noexcept {
    for (int k = 0; k < plots.size() && plots_.size() < capacity_; ++k) {
      const ScanPlot& plot = plots[k];
      const double free = ownership.free_probability()[static_cast<std::size_t>(k)];
      if (ownership.may_start(k, free_plot) && !plot.waits)
        plots_.push_back({plot.position, plot.time_s, plot.beam_rad, plot.errors, free});
    }
  }

  /// Drops the plots up to an angle of the beam.
  void drop_before(double beam_rad) noexcept {
    std::erase_if(plots_, [&](const FreePlot& plot) { return !(plot.beam_rad > beam_rad); });
  }

  /// Has those found that there are now.
  void sort() noexcept { sort(plots_.size()); }

  /// Saves or restores the plots.
  void archive(Archive& fields) {
    auto count = static_cast<std::uint64_t>(plots_.size());
    fields(count);
    auto found = static_cast<std::uint64_t>(found_);
    fields(found);
    if (count > capacity_ || found > count) fields.fail();
    if (!fields.ok()) return;
    plots_.resize(static_cast<std::size_t>(count));
    for (FreePlot& plot : plots_) {
      fields(plot.position.mean);
      fields(plot.position.covariance);
      fields(plot.time_s);
      fields(plot.beam_rad);
      fields(plot.errors);
      fields(plot.free);
    }
    if (fields.loading()) sort(static_cast<std::size_t>(found));
  }

 private:
  void sort(std::size_t found) noexcept {
    found_ = found;
    index_.clear();
    earliest_s_ = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < found_; ++k) {
      const FreePlot& plot = plots_[k];
      index_.add(plot.position.mean, plot.position.covariance.trace(), static_cast<int>(k));
      earliest_s_ = std::min(earliest_s_, plot.time_s);
    }
    index_.sort();
  }

  static constexpr int kMostNear = 32;

  std::size_t capacity_;
  std::vector<FreePlot> plots_;
  std::size_t found_ = 0;  ///< the first of them
  PlaceIndex index_;       ///< of these
  double earliest_s_ = std::numeric_limits<double>::infinity();
};

/// The start of a tentative track.
struct TrackStart {
  Gaussian<4> belief;  ///< `[x, vx, y, vy]`
  double time_s;
  double beam_rad;   ///< angle of the beam at that time, unwrapped
  double existence;  ///< probability
  OwnPlots learned;  ///< what was learned as clutter of its plots
};

/// Two-point initiation: a free plot, and one of the two scans before that is near enough for the
/// speed limit, start a track. Memory is taken by the constructor.
class TrackInitiation {
 public:
  explicit TrackInitiation(const TrackerConfig& config)
      : config_(config), before_(config.max_plots) {}

  /// Calls `start(TrackStart)` for every pair, as long as `has_room(existence)`; then keeps the
  /// free plots for the next turns. Plots that wait are left out. The beam has passed that angle,
  /// and a whole turn or a sector.
  template <class HasRoom, class Start>
  void initiate(const Radar& radar, const ScanPlots& plots, const PlotOwnership& ownership,
                const ClutterDensity& clutter, double detection_probability, double beam_rad,
                bool whole_turn, const HasRoom& has_room, const Start& start) {
    const double longest_s = std::max(config_.coast_scans_max, kLeastScans) * radar.period_s;
    if (begin_rad_ == kNever) begin_rad_ = whole_turn ? beam_rad - Beam::kTurn : beam_rad;
    // Plots are of few turns: the density of the last two is kept.
    std::array<FirstSeen, 2> known{};
    const auto first_seen = [&](const FreePlot& plot) {
      const double turns = turns_until(plot.beam_rad);
      if (turns != known[0].turns) std::swap(known[0], known[1]);
      if (turns != known[0].turns)
        known[0] = {turns, first_seen_per_m2(radar, turns, detection_probability)};
      return known[0].per_m2;
    };
    for (int k = 0; k < plots.size(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double free = ownership.free_probability()[at];
      if (plots[k].waits || !ownership.may_start(k, config_.free_plot)) continue;
      if (!has_room(kMostExistence)) break;
      const auto pair = [&](const FreePlot& earlier) {
        const double likelihood = likelihood_of_way(radar, earlier, plots[k]);
        if (likelihood == 0.0) return;
        const LearnedPlots first{earlier.position.mean, 1.0, earlier.time_s};
        const OwnPlots own{first, first};
        const double first_per_m2 = earlier.free * free * first_seen(earlier);
        const double probability =
            existence(likelihood, (plots[k].time_s - earlier.time_s) / radar.period_s, first_per_m2,
                      clutter.without(own, plots, k), detection_probability);
        if (!has_room(probability)) return;
        start(TrackStart{belief(radar, earlier, plots[k]), plots[k].time_s, plots[k].beam_rad,
                         probability,
                         clutter.with(own, plots, k, ownership.clutter_probability(),
                                      ownership.free_probability())});
      };
      before_.for_each_before(plots[k], radar.max_speed_mps, radar.period_s,
                              config_.start_gate_sigma, longest_s, pair);
    }
    keep_free(plots, ownership, beam_rad, whole_turn);
  }

  /// What is believed of a velocity before it is measured.
  [[nodiscard]] Gaussian<2> prior_velocity(const Radar& radar) const noexcept {
    const double factor = config_.start_speed_factor > 0.0 ? config_.start_speed_factor : 1.0;
    const double std_mps = factor * radar.max_speed_mps;
    return {Vec<double, 2>::Zero(), std_mps * std_mps / 2 * Mat<double, 2, 2>::Identity()};
  }

  /// Saves or restores the free plots of the scans before.
  void archive(Archive& fields) {
    before_.archive(fields);
    fields(sorted_rad_);
    fields(begin_rad_);
  }

 private:
  /// Free plots pair with those of half a turn to two and a half before, so that they are sorted in
  /// after half a turn, and dropped after three.
  void keep_free(const ScanPlots& plots, const PlotOwnership& ownership, double beam_rad,
                 bool whole_turn) noexcept {
    const bool sorts = whole_turn || beam_rad - sorted_rad_ >= Beam::kTurn / 2;
    if (sorts) before_.drop_before(beam_rad - (whole_turn ? 2.0 : 3.0) * Beam::kTurn);
    before_.add(plots, ownership, config_.free_plot);
    if (!sorts) return;
    before_.sort();
    sorted_rad_ = beam_rad;
  }

  static constexpr double kNever = -std::numeric_limits<double>::infinity();
  static constexpr double kMostExistence = 0.3;  ///< of two plots, however near
  static constexpr double kLongestWay = 12.0;    ///< sigma²; of two plots of a target 99.75 %
  static constexpr int kLeastScans = 2;  ///< so far apart two plots of a start may be at least

  /// N(z₂; z₁) of two plots of a target, with the prior of the velocity. 0 where they are farther
  /// apart than those of a target are, so that clutter starts fewer tracks.
  [[nodiscard]] double likelihood_of_way(const Radar& radar, const FreePlot& earlier,
                                         const ScanPlot& later) const noexcept {
    const double dt_s = later.time_s - earlier.time_s;
    const Cholesky<2> factor(earlier.position.covariance + later.position.covariance +
                             dt_s * dt_s * prior_velocity(radar).covariance);
    if (!factor.ok()) return 0.0;
    const double squared = factor.squared_norm(later.position.mean - earlier.position.mean);
    if (squared > kLongestWay) return 0.0;
    return std::exp(-0.5 * squared) * factor.inverse_root_determinant() / (2.0 * std::numbers::pi);
  }

  /// Probability that two plots are a target's and not clutter of density ρ: odds of β/ρ for the
  /// first, with the density β of targets first seen where both plots are free; of PD N(z₂; z₁) / ρ
  /// for the second; and 1 - PD for each scan between.
  [[nodiscard]] static double existence(double likelihood, double periods_apart,
                                        double first_seen_per_m2, double clutter_per_m2,
                                        double detection_probability) noexcept {
    const double missed = std::max(std::round(periods_apart) - 1.0, 0.0);
    const double miss = 1.0 - detection_probability;
    const double all_missed = missed == 0.0 ? 1.0 : missed == 1.0 ? miss : std::pow(miss, missed);
    const double odds = first_seen_per_m2 / clutter_per_m2 * detection_probability * likelihood /
                        clutter_per_m2 * all_missed;
    return std::min(odds / (1.0 + odds), kMostExistence);
  }

  /// Targets per area that are first seen in the turn after so many.
  struct FirstSeen {
    double turns = -1.0;
    double per_m2 = 0.0;
  };

  /// Turns of the antenna before the one in which the beam had that angle.
  [[nodiscard]] double turns_until(double beam_rad) const noexcept {
    return std::max(std::floor((beam_rad - begin_rad_) / Beam::kTurn), 0.0);
  }

  /// Targets per area whose first plot is one of the turn after so many: β in the long run, PD of
  /// all that are there in the first turn, and of those that it has missed in the next ones. As
  /// many are there as appear in the mean time until one leaves.
  [[nodiscard]] double first_seen_per_m2(const Radar& radar, double turns,
                                         double detection_probability) const noexcept {
    const double born = config_.birth_density_per_m2;
    const double there = born * config_.survival_time_s / radar.period_s;
    const double missed = std::pow(1.0 - detection_probability, turns);
    return born + missed * std::max(detection_probability * there - born, 0.0);
  }

  /// Of both plots beside the middle between them, as each plot alone is correlated with its
  /// covariance.
  [[nodiscard]] Gaussian<4> belief(const Radar& radar, const FreePlot& earlier,
                                   const ScanPlot& later) const noexcept {
    const Gaussian<2> middle{(earlier.position.mean + later.position.mean) / 2,
                             (earlier.position.covariance + later.position.covariance) / 4};
    const Gaussian<4> of_plots = two_point<double>(
        with_outliers(earlier.errors.at(earlier.position, middle)),
        with_outliers(later.errors.at(later.position, middle)), later.time_s - earlier.time_s);
    if (!(config_.start_speed_factor > 0.0)) return of_plots;
    return with_speed_prior(of_plots, std::sqrt(prior_velocity(radar).covariance(0, 0)));
  }

  /// With the covariance of nominal and outlier errors together.
  [[nodiscard]] Gaussian<2> with_outliers(const Gaussian<2>& plot) const noexcept {
    const double w = config_.outlier_probability;
    return {plot.mean, (1.0 - w + w * config_.outlier_variance()) * plot.covariance};
  }

  TrackerConfig config_;
  FreePlots before_;
  double sorted_rad_ = 0.0;    ///< angle of the beam when they were sorted
  double begin_rad_ = kNever;  ///< and before the first turn, or after its first part
};

}  // namespace wakeline
