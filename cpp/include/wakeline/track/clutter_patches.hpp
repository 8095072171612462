// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/track/clutter_map.hpp"
#include "wakeline/track/clutter_rings.hpp"
#include "wakeline/track/scan_plots.hpp"

namespace wakeline {

/// The density of false plots in patches, such as rain or a shoal, learned over the plane with a
/// fading memory of plots that no track owns.
///
/// It is that of the densest of the four cells about a plot, so that it holds in full up to the
/// edge of a patch and where a patch moves to. The density of a cell of area A that has had n free
/// plots in T scans is (n + k) / (A T + k / ρ), the mean of its gamma posterior, where ρ is the
/// density of the range: as if there had been k plots more, 0.2 and `more_at_first`. Nearer to the
/// antenna than a cell is wide the rings are finer, and it is ρ. Memory is taken by the constructor.
class ClutterPatches {
 public:
  /// Without cells where `cell_m` is 0.
  ClutterPatches(double cell_m, double memory_s, int max_plots)
      : memory_s_(memory_s), map_(cell_m, memory_s, kTiles) {
    about_.reserve(static_cast<std::size_t>(max_plots));
  }

  /// Counts the plots learned about each plot of a scan, as of a scan `before_s` ago.
  void evaluate(const ScanPlots& plots, double before_s) noexcept {
    about_.clear();
    if (!map_.enabled()) return;
    time_s_ = map_.no_sooner_s(plots.scan_s() - before_s);
    const double scans = scans_ > 0.0 ? scans_ * std::exp((learned_s_ - time_s_) / memory_s_) : 0.0;
    more_ = kMore + more_at_first(scans);
    area_m2_ = map_.cell_m() * map_.cell_m() * scans;
    for (const ScanPlot& plot : plots)
      about_.push_back(map_.plots_about(plot.position.mean, time_s_));
  }

  /// False plots per m² and scan about a plot of the scan, without those of a target's own that
  /// were learned; at least that of its range.
  [[nodiscard]] double density(const LearnedPlots& own, const ScanPlots& plots, int plot,
                               double of_range_per_m2) const noexcept {
    if (!map_.enabled() || plots[plot].range_m < map_.cell_m()) return of_range_per_m2;
    const std::array<double, 4>& about = about_[static_cast<std::size_t>(plot)];
    const auto of_cell_per_m2 = [&](double free_plots) {
      return (free_plots + more_) / (area_m2_ + more_ / of_range_per_m2);
    };
    if (of_cell_per_m2(*std::max_element(about.begin(), about.end())) <= of_range_per_m2)
      return of_range_per_m2;
    const std::array<double, 4> of_own = map_.plots_about(own, plots[plot].position.mean, time_s_);
    double most = 0.0;
    for (std::size_t k = 0; k < about.size(); ++k) most = std::max(most, about[k] - of_own[k]);
    return std::max(of_cell_per_m2(most), of_range_per_m2);
  }

  /// Learns each plot that does not wait, of so many turns of the antenna, which ended `dt_s` after
  /// those before, with the probability that it is free.
  void learn(const ScanPlots& plots, std::span<const double> free_probability, double dt_s,
             double turns) noexcept {
    if (!map_.enabled()) return;
    scans_ = std::exp(-dt_s / memory_s_) * scans_ + turns;
    learned_s_ = plots.scan_s();
    for (int k = 0; k < plots.size(); ++k)
      if (!plots[k].waits)
        map_.add(plots[k].position.mean, learned_s_, free_probability[static_cast<std::size_t>(k)]);
  }

  /// Adds a plot that `learn` learns to those of its target.
  void remember(const ScanPlots& plots, int plot, double free_probability,
                LearnedPlots& own) const noexcept {
    map_.remember(plots[plot].position.mean, plots.scan_s(), free_probability, own);
  }

  /// Saves or restores what was learned.
  void archive(Archive& fields) {
    map_.archive(fields);
    fields(scans_);
    fields(learned_s_);
  }

 private:
  static constexpr std::size_t kTiles = 1 << 11;
  static constexpr double kMore = 0.2;

  double memory_s_;
  ClutterMap map_;
  double scans_ = 0.0;      ///< T
  double learned_s_ = 0.0;  ///< time of the last plots learned

  // Of the scan at hand:
  std::vector<std::array<double, 4>> about_;  ///< of each plot, n of the four cells
  double time_s_ = 0.0;                       ///< of these
  double area_m2_ = 0.0;                      ///< A T
  double more_ = 0.0;                         ///< k
};

}  // namespace wakeline
