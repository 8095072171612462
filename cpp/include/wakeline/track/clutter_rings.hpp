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

/// The density of false plots by their range from the antenna, learned with a fading memory: even
/// clutter over the whole sea, and sea clutter that falls off with range.
///
/// On an area A that has had n false plots in T scans the density is (n + 1) / (A T + 1 / ρ), the
/// mean of its gamma posterior: as if there had been one plot more, at the prior density ρ. For the
/// whole sea ρ is given; for a ring it is the density of the whole sea. n and T fade alike, so that
/// the first scans count in full.
class ClutterRings {
 public:
  ClutterRings(double prior_per_m2, double memory_s)
      : prior_per_m2_(prior_per_m2), memory_s_(memory_s) {
    density_.fill(prior_per_m2);
  }

  /// False plots per m² and scan at a range; at least the prior.
  [[nodiscard]] double density(double range_m) const noexcept { return density_[ring_of(range_m)]; }

  /// Learns each plot that does not wait, of so many turns of the antenna, which ended `dt_s` after
  /// those before, with the probability that it is false.
  void learn(const ScanPlots& plots, std::span<const double> false_probability, double dt_s,
             double turns) noexcept {
    const double left = std::exp(-dt_s / memory_s_);
    scans_ = left * scans_ + turns;
    for (double& count : plots_) count *= left;
    double farthest_m = 0.0;
    for (int k = 0; k < plots.size(); ++k) {
      if (plots[k].waits) continue;
      const double range_m = plots[k].range_m;
      plots_[ring_of(range_m)] += false_probability[static_cast<std::size_t>(k)];
      farthest_m = std::max(farthest_m, range_m);
    }
    if (plots.size() > 0)
      farthest_m_ = std::max(farthest_m, left * farthest_m_ + (1.0 - left) * farthest_m);
    evaluate();
  }

  /// Saves or restores what has been learned.
  void archive(Archive& fields) {
    fields(plots_);
    fields(scans_);
    fields(farthest_m_);
    evaluate();
  }

 private:
  static constexpr std::size_t kRings = 18;
  static constexpr double kInnermost_m = 250.0;  ///< radius of the first; the areas double

  static std::size_t ring_of(double range_m) noexcept {
    const double ratio = range_m / kInnermost_m;
    if (!(ratio >= 1.0)) return 0;
    return std::min(kRings - 1, static_cast<std::size_t>(std::ilogb(ratio * ratio)) + 1);
  }

  /// The square of a ring's outer radius, or of the farthest plot if that is nearer, m².
  [[nodiscard]] double end_m2(std::size_t ring) const noexcept {
    const double reach_m2 = farthest_m_ * farthest_m_;
    if (ring + 1 == kRings) return reach_m2;
    return std::min(std::ldexp(kInnermost_m * kInnermost_m, static_cast<int>(ring)), reach_m2);
  }

  [[nodiscard]] double posterior(double plots, double squared_m2, double prior) const noexcept {
    return (plots + 1.0) / (std::numbers::pi * squared_m2 * scans_ + 1.0 / prior);
  }

  void evaluate() noexcept {
    const double all = std::accumulate(plots_.begin(), plots_.end(), 0.0);
    const double even =
        std::max(prior_per_m2_, posterior(all, farthest_m_ * farthest_m_, prior_per_m2_));
    double inner_m2 = 0.0;
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      const double outer_m2 = end_m2(ring);
      density_[ring] = std::max(prior_per_m2_, posterior(plots_[ring], outer_m2 - inner_m2, even));
      inner_m2 = outer_m2;
    }
  }

  double prior_per_m2_;
  double memory_s_;
  std::array<double, kRings> plots_ = {};  ///< n of each ring
  double scans_ = 0.0;                     ///< T
  double farthest_m_ = 0.0;  ///< mean range of the farthest plot, or that of the last scan
  std::array<double, kRings> density_;
};

}  // namespace wakeline
