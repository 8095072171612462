// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/track/clutter_density.hpp"
#include "wakeline/track/track_gate.hpp"

namespace wakeline {

/// A plot that a track may own, with what association weighs.
struct CandidatePlot : ValidatedPlot {
  double likelihood;      ///< p(z) of the track, over modes and errors, 1/m²
  double clutter_per_m2;  ///< density of false plots about it, the track's own left out
};

/// The likelihood of a validated plot: `(1 - w) N(ν; S) + w N(ν; S_outlier)` over all modes, where
/// a share w of plots are outliers.
inline double plot_likelihood(const ValidatedPlot& plot, const ModePositions& modes,
                              double outlier_probability) noexcept {
  const double outlier = modes.evidence(plot.z, plot.outlier_r).likelihood;
  const double nominal = modes.evidence(plot.z, plot.nominal_r).likelihood;
  return (1.0 - outlier_probability) * nominal + outlier_probability * outlier;
}

/// The likeliest plots of one track, best first.
class CandidatePlots {
 public:
  static constexpr std::size_t kMost = 8;  ///< plots of one track

  void clear() noexcept { count_ = 0; }

  /// Chooses the likeliest of a track's validated plots, each with the density of clutter about it,
  /// without what was learned of its own.
  void choose(std::span<const ValidatedPlot> validated, const OwnPlots& own,
              const ModePositions& modes, double outlier_probability, const ClutterDensity& clutter,
              const ScanPlots& plots) noexcept {
    clear();
    for (const ValidatedPlot& plot : validated) {
      const double likelihood = plot_likelihood(plot, modes, outlier_probability);
      if (admits(likelihood)) add({plot, likelihood, clutter.without(own, plots, plot.plot)});
    }
  }

  /// Leaves the plots for which a predicate holds.
  template <class Predicate>
  void keep_if(const Predicate& predicate) noexcept {
    std::size_t left = 0;
    for (std::size_t k = 0; k < count_; ++k)
      if (predicate(plots_[k])) plots_[left++] = plots_[k];
    count_ = left;
  }

  /// Weighs each plot by the probability that it is free still: clutter about it is so much denser.
  /// Leaves out those that are not free.
  void thin(std::span<const double> free_probability) noexcept {
    const auto free = [&](const CandidatePlot& plot) {
      return free_probability[static_cast<std::size_t>(plot.plot)];
    };
    keep_if([&](const CandidatePlot& plot) { return free(plot) > 0.0; });
    for (std::size_t k = 0; k < count_; ++k) plots_[k].clutter_per_m2 /= free(plots_[k]);
  }

  /// Whether a plot of that likelihood is among the likeliest.
  [[nodiscard]] bool admits(double likelihood) const noexcept {
    return count_ < kMost || likelihood > plots_.back().likelihood;
  }

  /// Adds a plot if it is among the likeliest.
  void add(const CandidatePlot& plot) noexcept {
    if (!admits(plot.likelihood)) return;
    std::size_t place = std::min(count_, kMost - 1);
    for (; place > 0 && plot.likelihood > plots_[place - 1].likelihood; --place)
      plots_[place] = plots_[place - 1];
    plots_[place] = plot;
    count_ = std::min(count_ + 1, kMost);
  }

  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] const CandidatePlot& operator[](std::size_t k) const noexcept { return plots_[k]; }
  [[nodiscard]] const CandidatePlot* begin() const noexcept { return plots_.data(); }
  [[nodiscard]] const CandidatePlot* end() const noexcept { return plots_.data() + count_; }

 private:
  std::array<CandidatePlot, kMost> plots_;
  std::size_t count_ = 0;
};

/// L⁻¹ ν of a plot with covariance `r` (m²) from a predicted position, with S = L Lᵀ; infinite
/// where S is not positive definite.
inline Vec<double, 2> whitened_innovation(const Gaussian<2>& predicted, const Vec<double, 2>& z,
                                          const Mat<double, 2, 2>& r) noexcept {
  const Cholesky<2> factor(predicted.covariance + r);
  if (!factor.ok()) return Vec<double, 2>::Constant(std::numeric_limits<double>::infinity());
  return factor.whiten<1>(z - predicted.mean);
}

/// Normalised innovation squared: d² of such a plot.
inline double innovation_squared(const Gaussian<2>& predicted, const Vec<double, 2>& z,
                                 const Mat<double, 2, 2>& r) noexcept {
  return whitened_innovation(predicted, z, r).squaredNorm();
}

/// The same from the position in a belief over `[x, vx, y, vy]`.
inline double innovation_squared(const Gaussian<4>& kinematics, const Vec<double, 2>& z,
                                 const Mat<double, 2, 2>& r) noexcept {
  return innovation_squared(position_in(kinematics), z, r);
}

}  // namespace wakeline
