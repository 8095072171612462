// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>

#include "wakeline/core/archive.hpp"
#include "wakeline/track/scan_plots.hpp"

namespace wakeline {

/// As if a small area had had so many plots more, at the density about it, after T scans: in the
/// first ones all plots are free, for no track can own them yet.
inline double more_at_first(double scans) noexcept { return 20.0 * std::exp(-scans / 2.0); }

/// The density of false plots by their range from the antenna, learned with a fading memory: even
/// clutter over the whole sea, and sea clutter that falls off with range.
///
/// On an area A that has had n false plots in T scans the density is (n + k) / (A T + k / ρ), the
/// mean of its gamma posterior: as if there had been k plots more, at the prior density ρ. For the
/// whole sea ρ is given and k = 1; for a ring ρ is the density of the whole sea. As there is more
/// sea clutter upwind, near rings are in eighths, whose ρ is that of the ring and k is larger by
/// `more_at_first`; in such a small area one plot a scan may be a target's and is left out. n and T
/// fade alike, so that the first scans count in full.
class ClutterRings {
 public:
  ClutterRings(double prior_per_m2, double memory_s)
      : prior_per_m2_(prior_per_m2), memory_s_(memory_s) {
    evaluate();
  }

  /// False plots per m² and scan at a range; at least the prior.
  [[nodiscard]] double density(double range_m) const noexcept { return density_[ring_of(range_m)]; }

  /// About a plot: that of its range, or more where it is upwind.
  [[nodiscard]] double density(const ScanPlot& plot) const noexcept {
    const std::size_t ring = ring_of(plot.range_m);
    return ring < kNear ? eighth_density_[ring][eighth_of(plot)] : density_[ring];
  }

  /// Learns each plot that does not wait, of so many turns of the antenna, which ended `dt_s` after
  /// those before, with the probability that it is false.
  void learn(const ScanPlots& plots, std::span<const double> false_probability, double dt_s,
             double turns) noexcept {
    const double left = std::exp(-dt_s / memory_s_);
    scans_ = left * scans_ + turns;
    for (double& count : plots_) count *= left;
    for (auto& ring : eighth_plots_)
      for (double& count : ring) count *= left;
    double farthest_m = 0.0;
    for (int k = 0; k < plots.size(); ++k) {
      if (plots[k].waits) continue;
      const std::size_t ring = ring_of(plots[k].range_m);
      const double is_false = false_probability[static_cast<std::size_t>(k)];
      plots_[ring] += is_false;
      if (ring < kNear) eighth_plots_[ring][eighth_of(plots[k])] += is_false;
      farthest_m = std::max(farthest_m, plots[k].range_m);
    }
    if (plots.size() > 0)
      farthest_m_ = std::max(farthest_m, left * farthest_m_ + (1.0 - left) * farthest_m);
    evaluate();
  }

  /// Saves or restores what has been learned.
  void archive(Archive& fields) {
    fields(plots_);
    fields(eighth_plots_);
    fields(scans_);
    fields(farthest_m_);
    evaluate();
  }

 private:
  static constexpr std::size_t kRings = 18;
  static constexpr std::size_t kNear = 4;  ///< rings in eighths, up to 707 m
  static constexpr std::size_t kEighths = 8;
  static constexpr double kInnermost_m = 250.0;  ///< radius of the first; the areas double
  using Eighths = std::array<std::array<double, kEighths>, kNear>;

  static std::size_t ring_of(double range_m) noexcept {
    const double ratio = range_m / kInnermost_m;
    if (!(ratio >= 1.0)) return 0;
    return std::min(kRings - 1, static_cast<std::size_t>(std::ilogb(ratio * ratio)) + 1);
  }

  /// In which eighth of the compass a plot is from the antenna.
  static std::size_t eighth_of(const ScanPlot& plot) noexcept {
    const double north_m = plot.position.mean[0] - plot.errors.antenna_north_m;
    const double east_m = plot.position.mean[1] - plot.errors.antenna_east_m;
    return 4 * std::size_t{north_m < 0.0} + 2 * std::size_t{east_m < 0.0} +
           std::size_t{std::abs(north_m) < std::abs(east_m)};
  }

  /// The square of a ring's outer radius, or of the farthest plot if that is nearer, m².
  [[nodiscard]] double end_m2(std::size_t ring) const noexcept {
    const double reach_m2 = farthest_m_ * farthest_m_;
    if (ring + 1 == kRings) return reach_m2;
    return std::min(std::ldexp(kInnermost_m * kInnermost_m, static_cast<int>(ring)), reach_m2);
  }

  [[nodiscard]] double posterior(double plots, double squared_m2, double prior,
                                 double more = 1.0) const noexcept {
    return (plots + more) / (std::numbers::pi * squared_m2 * scans_ + more / prior);
  }

  void evaluate() noexcept {
    const double more_of_eighth = 1.0 + more_at_first(scans_);
    const double all = std::accumulate(plots_.begin(), plots_.end(), 0.0);
    const double even =
        std::max(prior_per_m2_, posterior(all, farthest_m_ * farthest_m_, prior_per_m2_));
    double inner_m2 = 0.0;
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      const double outer_m2 = end_m2(ring);
      density_[ring] = std::max(prior_per_m2_, posterior(plots_[ring], outer_m2 - inner_m2, even));
      for (std::size_t k = 0; ring < kNear && k < kEighths; ++k)
        eighth_density_[ring][k] =
            std::max(density_[ring],
                     posterior(std::max(eighth_plots_[ring][k] - scans_, 0.0),
                               (outer_m2 - inner_m2) / kEighths, density_[ring], more_of_eighth));
      inner_m2 = outer_m2;
    }
  }

  double prior_per_m2_;
  double memory_s_;
  std::array<double, kRings> plots_ = {};  ///< n of each ring,
  Eighths eighth_plots_ = {};              ///< and of each eighth of a near one
  double scans_ = 0.0;                     ///< T
  double farthest_m_ = 0.0;  ///< mean range of the farthest plot, or that of the last scan
  std::array<double, kRings> density_;
  Eighths eighth_density_;
};

}  // namespace wakeline
