// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "wakeline/track/clutter_map.hpp"
#include "wakeline/track/clutter_rings.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/look.hpp"
#include "wakeline/track/scan_plots.hpp"

namespace wakeline {

/// The density of false plots about each plot of a scan: that of its range, or that of its cell in
/// the clutter map where it is larger. Memory is taken by the constructor.
class ClutterDensity {
 public:
  explicit ClutterDensity(const TrackerConfig& config)
      : rings_(config.clutter_density_per_m2, config.clutter_memory_s),
        map_weight_(config.clutter_weight),
        map_(config.clutter_cell_m, config.clutter_memory_s) {
    mapped_per_m2_.reserve(static_cast<std::size_t>(config.max_plots));
  }

  /// Evaluates the density at all plots of a scan, `dt_s` after the scan before.
  void evaluate(const ScanPlots& plots, double dt_s, double period_s) noexcept {
    // The map as it was when it had learned the scan before: a period later it has faded by one.
    learned_s_ = map_.no_sooner_s(plots.scan_s() - std::min(dt_s, period_s));
    period_s_ = period_s;
    mapped_per_m2_.clear();
    for (const ScanPlot& plot : plots)
      mapped_per_m2_.push_back(map_weight_ *
                               map_.density(plot.position.mean, learned_s_, period_s));
  }

  /// At a plot of the scan, without the part that the map has learned of a target's own plots: they
  /// do not make the next one of the same target clutter.
  [[nodiscard]] double without(const LearnedPlots& own, const ScanPlots& plots,
                               int plot) const noexcept {
    const double of_range = rings_.density(plots[plot].range_m);
    const double mapped = mapped_per_m2_[static_cast<std::size_t>(plot)];
    if (mapped <= of_range) return of_range;
    const double of_own =
        map_weight_ * map_.density_of(own, plots[plot].position.mean, learned_s_, period_s_);
    return std::max(mapped - of_own, of_range);
  }

  /// Learns by range, with the probability of each plot that no target owns it; `turns` of the
  /// antenna ended `dt_s` after those before.
  void learn_rings(const ScanPlots& plots, std::span<const double> free_probability, double dt_s,
                   double turns) noexcept {
    rings_.learn(plots, free_probability, dt_s, turns);
  }

  /// Learns in the map each plot of the scan that does not wait with the probability that it is
  /// clutter, and notes for the tracks of these slots how much of that came from their own plots:
  /// `plot_of(slot)`, or -1.
  template <class PlotOf>
  void learn(const ScanPlots& plots, std::span<const double> clutter_probability,
             const PlotOf& plot_of, std::span<Look> looks, std::span<const int> slots) noexcept {
    for (int plot = 0; plot < plots.size(); ++plot)
      if (!plots[plot].waits)
        map_.add(plots[plot].position.mean, plots.scan_s(),
                 clutter_probability[static_cast<std::size_t>(plot)]);
    for (const int slot : slots) {
      const int plot = plot_of(slot);
      if (plot < 0) continue;
      LearnedPlots& own = looks[static_cast<std::size_t>(slot)].learned;
      own = with(own, plots, plot, clutter_probability[static_cast<std::size_t>(plot)]);
    }
  }

  /// What the map knows of a target's own plots once it has learned this one, too.
  [[nodiscard]] LearnedPlots with(LearnedPlots own, const ScanPlots& plots, int plot,
                                  double clutter_probability) const noexcept {
    map_.remember(plots[plot].position.mean, plots.scan_s(), clutter_probability, own);
    return own;
  }

  /// Saves or restores what was learned.
  void archive(Archive& fields) {
    rings_.archive(fields);
    map_.archive(fields);
  }

 private:
  ClutterRings rings_;
  double map_weight_;
  ClutterMap map_;
  std::vector<double> mapped_per_m2_;  ///< of each plot, by the map
  double learned_s_ = 0.0;
  double period_s_ = 1.0;
};

}  // namespace wakeline
