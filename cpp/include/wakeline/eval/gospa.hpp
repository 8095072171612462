// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "wakeline/association/candidates.hpp"
#include "wakeline/association/global_nearest_neighbour.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Distance between the true targets and the tracks of one scan. The three parts are p-th powers:
/// gospa^p = localisation + missed + false_tracks.
struct SetDistance {
  double gospa_m = 0.0;
  double localisation = 0.0;  ///< Σ d^p of the pairs
  double missed = 0.0;        ///< c^p/2 for each target without a track
  double false_tracks = 0.0;  ///< c^p/2 for each track without a target
  double ospa_m = 0.0;        ///< at most the cut-off
  int pairs = 0;              ///< targets with a track within the cut-off
};

/// GOSPA (alpha = 2) and OSPA of a set of targets and a set of tracks, with cut-off c and order p.
///
///     gospa^p = min over pairings of  Σ d^p + c^p/2 (targets + tracks - 2 pairs)
///     ospa^p  = min over pairings of (Σ d^p + c^p (n - pairs)) / n,   n = max(targets, tracks)
///
/// One optimal assignment gives both. Two empty sets have distance zero. Distances that are NaN or
/// not below the cut-off form no pair. Sources: A. S. Rahmathullah, A. F. Garcia-Fernandez, L.
/// Svensson, Generalized Optimal Sub-Pattern Assignment Metric, Fusion 2017, proposition 1 (alpha =
/// 2); D. Schuhmacher, B.-T. Vo, B.-N. Vo, A Consistent Metric for Performance Evaluation of
/// Multi-Object Filters, IEEE Trans. Signal Processing 56(8), 2008, section III.
class Gospa {
 public:
  using Matrix = Eigen::MatrixXd;

  /// Cut-off, order, and the share of a missed target.
  struct Options {
    double cutoff_m = 50.0;
    double order = 2.0;  ///< p >= 1
  };

  /// A target and a track closer than the cut-off.
  struct Pair {
    int target, track;
    double distance_m;
  };

  /// Allocates all memory for up to this many targets and tracks. Throws `std::invalid_argument`
  /// when the cut-off is not positive, the order is below 1 or so large that c^p overflows or
  /// underflows, or a capacity is negative.
  Gospa(const Options& options, int target_capacity, int track_capacity)
      : Gospa(options, Candidates<double>::dense(target_capacity, track_capacity), track_capacity) {
  }

  /// The same for at most that many pairs below the cut-off.
  Gospa(const Options& options, int target_capacity, int track_capacity, int pair_capacity)
      : Gospa(options, Candidates<double>(target_capacity, pair_capacity), track_capacity) {}

  [[nodiscard]] const Options& options() const noexcept { return options_; }

  /// From distances, targets in rows and tracks in columns. All NaN when the matrix is larger than
  /// the capacities.
  [[nodiscard]] SetDistance between(const Eigen::Ref<const Matrix>& distance) noexcept {
    return measure(static_cast<int>(distance.rows()), static_cast<int>(distance.cols()),
                   [&](int target, int track) { return distance(target, track); });
  }

  /// From the pairs below the cut-off, in order of targets. All NaN when there are more targets,
  /// tracks or pairs than the capacities.
  [[nodiscard]] SetDistance between(int targets, int tracks, std::span<const Pair> pairs) noexcept {
    candidates_.clear(tracks);
    auto pair = pairs.begin();
    for (int target = 0; target < targets; ++target) {
      candidates_.start_row(cutoff_power_);
      for (; pair != pairs.end() && pair->target == target; ++pair)
        candidates_.add(pair->track, std::pow(pair->distance_m, options_.order));
    }
    return assigned(targets, tracks);
  }

  /// From points by Euclidean distance. All NaN when a set is larger than its capacity.
  template <int N, class Scalar>
  [[nodiscard]] SetDistance between(std::span<const Vec<Scalar, N>> targets,
                                    std::span<const Vec<Scalar, N>> tracks) noexcept {
    return measure(static_cast<int>(targets.size()), static_cast<int>(tracks.size()),
                   [&](int target, int track) {
                     const Vec<Scalar, N> difference = targets[static_cast<std::size_t>(target)] -
                                                       tracks[static_cast<std::size_t>(track)];
                     return static_cast<double>(difference.norm());
                   });
  }

  /// The assignment of the last result: rows are targets, columns tracks.
  [[nodiscard]] const Assignment<double>& assignment() const noexcept {
    return solver_.assignment();
  }

 private:
  Gospa(const Options& options, Candidates<double> candidates, int track_capacity)
      : options_(options),
        candidates_(std::move(candidates)),
        solver_(candidates_.row_capacity(), track_capacity) {
    require_positive("cutoff_m", options.cutoff_m);
    require(options.order >= 1.0 && std::isfinite(options.order), "order", "at least 1",
            options.order);
    cutoff_power_ = std::pow(options.cutoff_m, options.order);
    require(std::isnormal(cutoff_power_), "order",
            "such that cutoff_m to its power does not overflow", options.order);
  }

  template <class Distance>
  SetDistance measure(int targets, int tracks, const Distance& distance) noexcept {
    candidates_.clear(tracks);
    for (int target = 0; target < targets; ++target) {
      candidates_.start_row(cutoff_power_);
      for (int track = 0; track < tracks; ++track) {
        const double d = distance(target, track);
        if (d < options_.cutoff_m) candidates_.add(track, std::pow(d, options_.order));
      }
    }
    return assigned(targets, tracks);
  }

  /// The distance by the best pairing of the candidates.
  [[nodiscard]] SetDistance assigned(int targets, int tracks) noexcept {
    const bool fits = candidates_.rows() == targets && candidates_.rejected() == 0;
    if (!fits || !solver_.solve(candidates_)) return not_measured();

    SetDistance result;
    result.pairs = solver_.assignment().pairs();
    result.missed = 0.5 * cutoff_power_ * (targets - result.pairs);
    result.false_tracks = 0.5 * cutoff_power_ * (tracks - result.pairs);
    result.localisation = solver_.assignment().pair_cost();
    result.gospa_m = root(result.localisation + result.missed + result.false_tracks);
    const int larger = std::max(targets, tracks);
    if (larger > 0)
      result.ospa_m =
          root((result.localisation + cutoff_power_ * (larger - result.pairs)) / larger);
    return result;
  }

  [[nodiscard]] double root(double power) const noexcept {
    return std::pow(power, 1.0 / options_.order);
  }

  [[nodiscard]] static SetDistance not_measured() noexcept {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan, nan, nan, 0};
  }

  Options options_;
  double cutoff_power_ = 0.0;
  Candidates<double> candidates_;
  GlobalNearestNeighbour<double> solver_;
};

}  // namespace wakeline
