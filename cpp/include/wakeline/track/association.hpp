// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Which plot belongs to which track: the hypotheses of each track, weighed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "wakeline/association/global_nearest_neighbour.hpp"
#include "wakeline/association/nearest_neighbour.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/existence.hpp"
#include "wakeline/track/plot_likelihood.hpp"
#include "wakeline/track/track_list.hpp"

namespace wakeline {

/// The hypotheses of one track about a scan, weighed before their likelihoods.
struct AssociationWeights {
  double none = 1.0;                                    ///< that no plot is the target's
  std::array<double, CandidatePlots::kMost> plot = {};  ///< that candidate k is, m²
  bool assigned = false;                                ///< one plot for certain
};

/// PD pv g / ρ: how much likelier a plot is as the track's than as clutter.
inline double likelihood_ratio(const Detection& detection, const CandidatePlot& plot) noexcept {
  return detection.detected * plot.likelihood / plot.clutter_per_m2;
}

/// Probabilistic data association of many targets in linear time: to each track, what the other
/// tracks claim of a plot is as good as denser clutter.
///
/// A track claims a plot with the probability P that it owns it, existence allowed for; the density
/// of clutter about that plot rises for the others by g P / (1 - P). This keeps boats side by side
/// apart. Memory is taken by the constructor. Source: D. Mušicki, B. La Scala, IEEE Trans. AES-44,
/// 2008 (linear multitarget).
class LinearMultitarget {
 public:
  explicit LinearMultitarget(const TrackerConfig& config)
      : own_(static_cast<std::size_t>(config.max_tracks)) {
    all_.reserve(static_cast<std::size_t>(config.max_plots));
  }

  /// Begins a scan of that many plots, which nobody claims.
  void clear(int plots) noexcept { all_.assign(static_cast<std::size_t>(plots), 0.0); }

  /// Adds what a track claims of its candidates.
  void claim(const Track& track, const Detection& detection,
             const CandidatePlots& candidates) noexcept {
    constexpr double kMostProbable = 0.9999;  // no claim is more certain
    double sum = detection.missed;
    for (const CandidatePlot& plot : candidates) sum += likelihood_ratio(detection, plot);
    const double norm = 1.0 - track.existence + track.existence * sum;
    Claims& own = own_[static_cast<std::size_t>(track.slot)];
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const CandidatePlot& plot = candidates[k];
      const double owned =
          std::min(track.existence * likelihood_ratio(detection, plot) / norm, kMostProbable);
      own[k] = plot.likelihood * owned / (1.0 - owned);
      all_[static_cast<std::size_t>(plot.plot)] += own[k];
    }
  }

  /// The hypotheses of a track, once all have claimed.
  [[nodiscard]] AssociationWeights weights(const Track& track, const Detection& detection,
                                           const CandidatePlots& candidates) const noexcept {
    AssociationWeights weights{.none = detection.missed};
    const Claims& own = own_[static_cast<std::size_t>(track.slot)];
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const double all = all_[static_cast<std::size_t>(candidates[k].plot)];
      const double of_others = std::max(all - own[k], 0.0);  // their sum is rounded
      weights.plot[k] = detection.detected / (candidates[k].clutter_per_m2 + of_others);
    }
    return weights;
  }

 private:
  using Claims = std::array<double, CandidatePlots::kMost>;  ///< of each candidate, 1/m²

  std::vector<Claims> own_;  ///< of each track, by slot
  std::vector<double> all_;  ///< of each plot, the sum over all tracks
};

/// Assignment of at most one plot to each track and one track to each plot, confirmed tracks before
/// tentative ones: the best total (`kGlobalNearest`) or the best pair first (`kNearest`). Memory is
/// taken by the constructor.
class PlotAssignment {
 public:
  static constexpr int kNone = kUnassigned;

  explicit PlotAssignment(const TrackerConfig& config)
      : global_nearest_(config.association == Association::kGlobalNearest),
        plot_of_track_(static_cast<std::size_t>(config.max_tracks), kNone),
        candidates_(config.max_tracks, config.max_tracks * int(CandidatePlots::kMost)),
        global_(config.max_tracks, config.max_plots),
        nearest_(config.max_tracks, config.max_plots, candidates_.candidate_capacity()) {
    row_slot_.reserve(static_cast<std::size_t>(config.max_tracks));
    assigned_.reserve(static_cast<std::size_t>(config.max_plots));
  }

  /// Assigns plots of a scan, of which there are so many, to the tracks of these slots.
  void assign(const TrackerConfig& config, const TrackList& tracks, std::span<const int> slots,
              std::span<const CandidatePlots> candidates_of_slot, int plots) noexcept {
    assigned_.assign(static_cast<std::size_t>(plots), 0);
    for (const bool confirmed : {true, false}) {
      candidates_.clear(plots);
      row_slot_.clear();
      for (const int slot : slots) {
        const Track& track = tracks.at(slot);
        if (track.confirmed() != confirmed) continue;
        row_slot_.push_back(slot);
        candidates_.start_row(0.0);
        const Detection detection(config, track.visibility);
        for (const CandidatePlot& plot : candidates_of_slot[static_cast<std::size_t>(slot)])
          if (assigned_[static_cast<std::size_t>(plot.plot)] == 0)
            candidates_.add(plot.plot,
                            -std::log(likelihood_ratio(detection, plot) / detection.missed));
      }
      const std::span<const int> column_of_row = solve().column_of_row();
      for (std::size_t row = 0; row < row_slot_.size(); ++row) {
        const int plot = column_of_row[row];
        plot_of_track_[static_cast<std::size_t>(row_slot_[row])] = plot;
        if (plot != kNone) assigned_[static_cast<std::size_t>(plot)] = 1;
      }
    }
  }

  /// The plot of the track in that slot, or `kNone`.
  [[nodiscard]] int plot_of(int slot) const noexcept {
    return plot_of_track_[static_cast<std::size_t>(slot)];
  }

  /// The hypotheses of a track: its plot, for certain, or none.
  [[nodiscard]] AssociationWeights weights(const Track& track, const Detection& detection,
                                           const CandidatePlots& candidates) const noexcept {
    AssociationWeights weights{.none = detection.missed};
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      if (candidates[k].plot != plot_of(track.slot)) continue;
      weights.none = 0.0;
      weights.plot[k] = detection.detected / candidates[k].clutter_per_m2;
      weights.assigned = true;
    }
    return weights;
  }

 private:
  /// The assignment of the candidates, which always fit.
  const Assignment<double>& solve() noexcept {
    if (global_nearest_) {
      (void)global_.solve(candidates_);
      return global_.assignment();
    }
    (void)nearest_.solve(candidates_);
    return nearest_.assignment();
  }

  bool global_nearest_;
  std::vector<int> plot_of_track_;  ///< by slot
  std::vector<char> assigned_;      ///< by plot
  std::vector<int> row_slot_;       ///< of the rows of `candidates_`
  Candidates<double> candidates_;
  GlobalNearestNeighbour<double> global_;
  NearestNeighbour<double> nearest_;
};

}  // namespace wakeline
