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
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/track/place_index.hpp"
#include "wakeline/track/radar.hpp"

namespace wakeline {

/// A plot as a position in the plane.
struct ScanPlot {
  Gaussian<2> position;  ///< [north, east], m
  double time_s;
  int input;             ///< its index among the plots given to the tracker; -1: of an earlier call
  double beam_rad;       ///< angle of the beam that saw it, unwrapped; NaN where it is not known
  bool waits;            ///< for the next call
  double range_m = 0.0;  ///< from the antenna
  ConvertedErrors errors = {};  ///< where its target is predicted
};

/// The usable plots of one scan, found by position. Memory is taken by the constructor.
class ScanPlots {
 public:
  explicit ScanPlots(int max_plots) : index_(max_plots) {
    plots_.reserve(static_cast<std::size_t>(max_plots));
  }

  /// Converts plots to positions, up to the capacity, in place of those of the scan before.
  ///
  /// Rejects plots that are not finite, at a place or with an error beyond `kLargestInput`, behind
  /// the antenna, of a bearing so large that it is rounded by more than the bearing error, or
  /// farther than `slack_s` from the time of the scan. One later than the scan has a wrong clock
  /// and counts as of the scan's time.
  void convert(const Radar& radar, std::span<const Plot> plots, double time_s,
               double slack_s) noexcept {
    plots_.clear();
    (void)add(radar, plots, time_s, slack_s,
              [](const Plot&) { return std::numeric_limits<double>::quiet_NaN(); });
  }

  /// The same beside those that wait; `beam_rad(plot)` is the angle of the beam that saw a plot.
  /// Returns how many are taken.
  template <class BeamAngle>
  int add(const Radar& radar, std::span<const Plot> plots, double time_s, double slack_s,
          const BeamAngle& beam_rad) noexcept {
    const int before = size();
    index_.clear();
    earliest_s_ = scan_s_ = time_s;
    for (int k = 0; k < before; ++k) {
      const ScanPlot& plot = plots_[static_cast<std::size_t>(k)];
      index_.add(plot.position.mean, plot.position.covariance.trace(), k);
      earliest_s_ = std::min(earliest_s_, plot.time_s);
    }
    constexpr double kRounding = std::numeric_limits<double>::epsilon();
    const std::size_t count = std::min(plots.size(), plots_.capacity() - plots_.size());
    for (std::size_t k = 0; k < count; ++k) {
      const Plot& plot = plots[k];
      const Gaussian<2> position = radar.position(plot);
      const double true_s = radar.true_time_s(plot.time_s);
      const bool usable = std::fabs(true_s - time_s) <= slack_s &&
                          plot.range_m >= std::max(0.0, radar.range_offset_m) &&
                          kRounding * std::fabs(plot.bearing_rad) <= radar.bearing_std_rad &&
                          in_range(position.mean) &&
                          in_range(std::sqrt(position.covariance.trace())) &&
                          Cholesky<2>(position.covariance).ok();
      if (!usable) continue;
      const double plot_s = std::min(true_s, time_s);
      index_.add(position.mean, position.covariance.trace(), size());
      plots_.push_back({position, plot_s, static_cast<int>(k), beam_rad(plot), false, plot.range_m,
                        radar.errors(plot)});
      earliest_s_ = std::min(earliest_s_, plot_s);
    }
    index_.sort();
    return size() - before;
  }

  /// Has a plot wait for the next sector.
  void keep(int index) noexcept { plots_[static_cast<std::size_t>(index)].waits = true; }

  /// Leaves the plots that wait; their places have changed.
  void drop_settled() noexcept {
    std::erase_if(plots_, [](const ScanPlot& plot) { return !plot.waits; });
    for (ScanPlot& plot : plots_) {
      plot.waits = false;
      plot.input = -1;
    }
  }

  /// Saves or restores the plots that wait.
  void archive(Archive& fields) {
    auto count = static_cast<std::uint64_t>(plots_.size());
    fields(count);
    if (count > plots_.capacity()) fields.fail();
    if (!fields.ok()) return;
    plots_.resize(static_cast<std::size_t>(count));
    for (ScanPlot& plot : plots_) {
      fields(plot.position.mean);
      fields(plot.position.covariance);
      fields(plot.time_s);
      fields(plot.beam_rad);
      fields(plot.range_m);
      fields(plot.errors);
      plot.input = -1;
      plot.waits = false;
    }
  }

  /// Calls `f(index)` for the plots in a square about a position: `reach_m(variance_m2)` is its
  /// half side for plots whose covariance has at most that trace. Of more than `kMostNear` plots
  /// of a layer of the index, for the nearest.
  template <class Reach, class Function>
  void for_each_near(const Vec<double, 2>& position, const Reach& reach_m,
                     Function&& function) const {
    index_.for_each_nearest_of<kMostNear>(plots_, position, reach_m, function);
  }

  [[nodiscard]] int size() const noexcept { return static_cast<int>(plots_.size()); }
  [[nodiscard]] const ScanPlot& operator[](int index) const noexcept {
    return plots_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] auto begin() const noexcept { return plots_.begin(); }
  [[nodiscard]] auto end() const noexcept { return plots_.end(); }

  /// Where the antenna was at the last plot.
  [[nodiscard]] Vec<double, 2> antenna() const noexcept {
    if (plots_.empty()) return Vec<double, 2>::Zero();
    return {plots_.back().errors.antenna_north_m, plots_.back().errors.antenna_east_m};
  }

  /// Time of the scan.
  [[nodiscard]] double scan_s() const noexcept { return scan_s_; }
  /// No plot is farther from that time.
  [[nodiscard]] double greatest_lag_s(double time_s) const noexcept {
    return std::max(scan_s_ - time_s, time_s - earliest_s_);
  }

 private:
  static constexpr int kMostNear = PlaneSlices::kMostNear;

  std::vector<ScanPlot> plots_;
  PlaceIndex index_;
  double earliest_s_ = 0.0;  ///< of the plots and the scan
  double scan_s_ = 0.0;
};

}  // namespace wakeline
