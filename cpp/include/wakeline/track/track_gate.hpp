// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "wakeline/gating/chi_square_gate.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/mode_positions.hpp"
#include "wakeline/track/scan_plots.hpp"
#include "wakeline/track/time_alignment.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// A plot inside the gate of a track, at the track's time.
struct ValidatedPlot {
  int plot;                     ///< its index in the scan
  Vec<double, 2> z;             ///< position, m
  Mat<double, 2, 2> nominal_r;  ///< its covariance, m²,
  Mat<double, 2, 2> outlier_r;  ///< and that of an outlier
};

/// Validation: which plots of a scan a track may own. Those within the gate probability of any mode
/// of its estimator, with the covariance of outliers. Memory is taken by the constructor. Source:
/// Bar-Shalom, Li, Multitarget-Multisensor Tracking, 1995, 2.3.
class TrackGate {
 public:
  /// The variance of the widest mode of an estimator over that of the mixture, about.
  static constexpr double kWidestMode = 9.0;

  explicit TrackGate(const TrackerConfig& config)
      : threshold_(EllipsoidalGate<2>(ChiSquareGate{config.gate_probability}).threshold()),
        outlier_variance_(config.outlier_variance()),
        in_strip_(static_cast<std::size_t>(config.max_plots)) {
    validated_.reserve(static_cast<std::size_t>(config.max_plots));
  }

  /// The plots inside the gate; valid until the next call.
  std::span<const ValidatedPlot> validate(const Track& track, const ModePositions& modes,
                                          const TimeAlignment& alignment,
                                          const ScanPlots& plots) noexcept {
    validated_.clear();
    const auto& p = track.kinematics.covariance;
    const double own_m = std::sqrt(kWidestMode) * std::sqrt(threshold_ * (p(0, 0) + p(2, 2)));
    const double apart_s = plots.greatest_lag_s(track.time_s);
    const double way_m = alignment.longest_way_m(apart_s);
    const double way_m2 = alignment.added_m2(apart_s).trace();
    const GateSquare square = modes.about(track.position());
    const auto reach_m = [&](double plot_m2) {
      const double outlier_m2 = generous_factor() * plot_m2 + way_m2;
      // Generous: the widest mode of an estimator may be some times wider than the mixture.
      const double generous_m = own_m + std::sqrt(threshold_ * outlier_m2);
      return std::min(generous_m, square.reach_m(outlier_m2, threshold_)) + way_m;
    };
    // In range plots are precise, so that most others are outside of the gate in this direction.
    const GateStrip strip = modes.along(track.position() - plots.antenna(), track.position());
    std::size_t count = 0;
    plots.for_each_near(track.position(), reach_m, [&](int index) {
      const ScanPlot& plot = plots[index];
      in_strip_[count] = index;  // without a branch, which a processor would often guess wrong
      count += std::size_t{
          !strip.excludes(alignment.moved(plot), generous_r(plot, alignment), threshold_)};
    });
    for (const int index : std::span(in_strip_).first(count)) {
      const ScanPlot& plot = plots[index];
      if (!modes.gate(alignment.moved(plot), generous_r(plot, alignment), threshold_)) continue;
      const Mat<double, 2, 2> added_m2 = alignment.added_m2(plot);
      const Gaussian<2> there = alignment.at_prediction(plot);
      const ValidatedPlot moved{index, there.mean, there.covariance + added_m2,
                                outlier_variance_ * there.covariance + added_m2};
      if (modes.gate(moved.z, moved.outlier_r, threshold_)) validated_.push_back(moved);
    }
    return validated_;
  }

  /// The covariance of a plot as an outlier over that as read, at most.
  [[nodiscard]] double generous_factor() const noexcept { return kElsewhere * outlier_variance_; }

  /// γ, the largest squared distance inside the gate.
  [[nodiscard]] double threshold() const noexcept { return threshold_; }

 private:
  /// How much larger the covariance of a plot may be at the prediction than as read, by which plots
  /// far outside are left out at less expense.
  static constexpr double kElsewhere = 1.5;

  /// The covariance of a plot as an outlier, at most.
  [[nodiscard]] Mat<double, 2, 2> generous_r(const ScanPlot& plot,
                                             const TimeAlignment& alignment) const noexcept {
    return generous_factor() * plot.position.covariance + alignment.added_m2(plot);
  }

  double threshold_;
  double outlier_variance_;
  std::vector<int> in_strip_;  ///< room for all plots
  std::vector<ValidatedPlot> validated_;
};

}  // namespace wakeline
