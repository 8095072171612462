// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "wakeline/track/clutter_map.hpp"
#include "wakeline/track/clutter_patches.hpp"
#include "wakeline/track/clutter_rings.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/look.hpp"
#include "wakeline/track/scan_plots.hpp"

namespace wakeline {

/// The density of false plots about each plot of a scan: that of its range, that of a patch, or
/// that of its cell in the clutter map, whichever is the largest. Memory is taken by the
/// constructor.
class ClutterDensity {
 public:
  explicit ClutterDensity(const TrackerConfig& config)
      : rings_(config.clutter_density_per_m2, config.clutter_memory_s),
        patches_(kPatchCells * config.clutter_cell_m, kPatchMemories * config.clutter_memory_s,
                 config.max_plots),
        map_weight_(config.clutter_weight),
        map_(config.clutter_cell_m, config.clutter_memory_s) {
    mapped_per_m2_.reserve(static_cast<std::size_t>(config.max_plots));
  }

  /// Evaluates the density at all plots of a scan, `dt_s` after the scan before.
  void evaluate(const ScanPlots& plots, double dt_s, double period_s) noexcept {
    // The map as it was when it had learned the scan before: a period later it has faded by one.
    const double before_s = std::min(dt_s, period_s);
    learned_s_ = map_.no_sooner_s(plots.scan_s() - before_s);
    period_s_ = period_s;
    patches_.evaluate(plots, before_s);
    mapped_per_m2_.clear();
    for (const ScanPlot& plot : plots)
      mapped_per_m2_.push_back(map_weight_ *
                               map_.density(plot.position.mean, learned_s_, period_s));
  }

  /// At a plot of the scan, without the part that was learned of a target's own plots: they do not
  /// make the next one of the same target clutter.
  [[nodiscard]] double without(const OwnPlots& own, const ScanPlots& plots,
                               int plot) const noexcept {
    const double of_patch =
        patches_.density(own.of_patches, plots, plot, rings_.density(plots[plot]));
    const double mapped = mapped_per_m2_[static_cast<std::size_t>(plot)];
    if (mapped <= of_patch) return of_patch;
    const double of_own =
        map_weight_ * map_.density_of(own.of_map, plots[plot].position.mean, learned_s_, period_s_);
    return std::max(mapped - of_own, of_patch);
  }

  /// Learns by range and in patches, with the probability of each plot that no target owns it;
  /// `turns` of the antenna ended `dt_s` after those before.
  void learn_free(const ScanPlots& plots, std::span<const double> free_probability, double dt_s,
                  double turns) noexcept {
    rings_.learn(plots, free_probability, dt_s, turns);
    patches_.learn(plots, free_probability, dt_s, turns);
  }

  /// Learns in the map each plot of the scan that does not wait with the probability that it is
  /// clutter, and notes for the tracks of these slots how much of what is learned, here and by
  /// `learn_free`, comes from their own plots: `plot_of(slot)`, or -1.
  template <class PlotOf>
  void learn(const ScanPlots& plots, std::span<const double> clutter_probability,
             std::span<const double> free_probability, const PlotOf& plot_of, std::span<Look> looks,
             std::span<const int> slots) noexcept {
    for (int plot = 0; plot < plots.size(); ++plot)
      if (!plots[plot].waits)
        map_.add(plots[plot].position.mean, plots.scan_s(),
                 clutter_probability[static_cast<std::size_t>(plot)]);
    for (const int slot : slots) {
      const int plot = plot_of(slot);
      if (plot < 0) continue;
      OwnPlots& own = looks[static_cast<std::size_t>(slot)].learned;
      own = with(own, plots, plot, clutter_probability, free_probability);
    }
  }

  /// What is known of a target's own plots once this one has been learned, too.
  [[nodiscard]] OwnPlots with(OwnPlots own, const ScanPlots& plots, int plot,
                              std::span<const double> clutter_probability,
                              std::span<const double> free_probability) const noexcept {
    const auto at = static_cast<std::size_t>(plot);
    map_.remember(plots[plot].position.mean, plots.scan_s(), clutter_probability[at], own.of_map);
    patches_.remember(plots, plot, free_probability[at], own.of_patches);
    return own;
  }

  /// Saves or restores what was learned.
  void archive(Archive& fields) {
    rings_.archive(fields);
    patches_.archive(fields);
    map_.archive(fields);
  }

 private:
  static constexpr double kPatchCells = 3.5;  ///< side of a cell of patches, in cells of the map
  static constexpr double kPatchMemories = 1.0 / 3.0;  ///< memory of patches, in that of the map

  ClutterRings rings_;
  ClutterPatches patches_;
  double map_weight_;
  ClutterMap map_;
  std::vector<double> mapped_per_m2_;  ///< of each plot, by the map
  double learned_s_ = 0.0;
  double period_s_ = 1.0;
};

}  // namespace wakeline
