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
#include "wakeline/track/look.hpp"
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

/// The probability that one of its candidates is the target's if there are no other tracks, given
/// that it exists.
inline double seen_alone(const Detection& detection, const CandidatePlots& candidates) noexcept {
  double seen = 0.0;
  for (const CandidatePlot& plot : candidates) seen += likelihood_ratio(detection, plot);
  return seen / (detection.missed + seen);
}

/// Joint probabilistic data association of many targets by belief propagation (the sum-product
/// algorithm), in time that is linear in the number of claims.
///
/// A track claims a plot with ψ = e w / (1 - e + e (1 - PD PG v)), where w is the likelihood ratio
/// of the plot and e the existence of the track. Tracks and plots exchange messages until they
/// agree: a plot answers ν = 1 / (1 + the messages of the other tracks), and a track sends
/// ψ / (1 + Σ ψ ν over its other plots). To each track the density of clutter about a plot is then
/// 1 + the messages of the others times what it is. This keeps boats side by side apart. Memory is
/// taken by the constructor. Source: J. L. Williams, R. A. Lau, "Approximate evaluation of marginal
/// association probabilities with belief propagation", IEEE Trans. AES-50, 2014, algorithm 1.
class BeliefPropagation {
 public:
  explicit BeliefPropagation(const TrackerConfig& config)
      : claims_(static_cast<std::size_t>(config.max_tracks)) {
    const auto plots = static_cast<std::size_t>(config.max_plots);
    sent_.reserve(plots);
    sending_.reserve(plots);
    claimants_.reserve(plots);
    disputing_.reserve(claims_.size());
  }

  /// Begins a scan of that many plots, which nobody claims.
  void clear(int plots) noexcept {
    sent_.assign(static_cast<std::size_t>(plots), 0.0);
    claimants_.assign(static_cast<std::size_t>(plots), 0);
  }

  /// Adds what a track claims of its candidates.
  void claim(const Track& track, const Detection& detection,
             const CandidatePlots& candidates) noexcept {
    const double none = 1.0 - track.existence + track.existence * detection.missed;
    Claims& claims = claims_[static_cast<std::size_t>(track.slot)];
    claims.count = candidates.size();
    for (std::size_t k = 0; k < claims.count; ++k) {
      claims.plot[k] = static_cast<std::size_t>(candidates[k].plot);
      claims.psi[k] =
          std::min(track.existence * likelihood_ratio(detection, candidates[k]) / none, kMostOdds);
      claims.message[k] = 0.0;
      ++claimants_[claims.plot[k]];
    }
  }

  /// Passes messages between the tracks of these slots, all of which have claimed, and their plots.
  void propagate(std::span<const int> slots) noexcept {
    disputing_.clear();
    for (const int slot : slots)
      if (is_disputed(claims_[static_cast<std::size_t>(slot)])) disputing_.push_back(slot);
    double change = disputing_.empty() ? 0.0 : 1.0;
    for (int pass = 0; pass < kMostPasses && change > kAgreed; ++pass) change = pass_messages();
  }

  /// The hypotheses of a track, once messages have been passed.
  [[nodiscard]] AssociationWeights weights(const Track& track, const Detection& detection,
                                           const CandidatePlots& candidates) const noexcept {
    AssociationWeights weights{.none = detection.missed};
    const Claims& claims = claims_[static_cast<std::size_t>(track.slot)];
    for (std::size_t k = 0; k < candidates.size(); ++k)
      weights.plot[k] =
          detection.detected / candidates[k].clutter_per_m2 / (1.0 + of_others(claims, k));
    return weights;
  }

 private:
  static constexpr double kMostOdds = 1e12;  ///< no claim is more certain
  static constexpr int kMostPasses = 30;
  static constexpr double kAgreed = 1e-3;  ///< relative change of the messages

  /// What a track claims, candidate by candidate.
  struct Claims {
    std::size_t count = 0;
    std::array<std::size_t, CandidatePlots::kMost> plot;
    std::array<double, CandidatePlots::kMost> psi;
    std::array<double, CandidatePlots::kMost> message;
  };

  /// Whether another track claims one of the plots, too.
  [[nodiscard]] bool is_disputed(const Claims& claims) const noexcept {
    for (std::size_t k = 0; k < claims.count; ++k)
      if (claimants_[claims.plot[k]] > 1) return true;
    return false;
  }

  /// The sum of the messages of the other tracks to a plot.
  [[nodiscard]] double of_others(const Claims& claims, std::size_t k) const noexcept {
    return std::max(sent_[claims.plot[k]] - claims.message[k], 0.0);  // their sum is rounded
  }

  /// One pass, all tracks at once; gives the largest relative change of 1 + a message.
  double pass_messages() noexcept {
    double change = 0.0;
    sending_.assign(sent_.size(), 0.0);
    for (const int slot : disputing_) {
      Claims& claims = claims_[static_cast<std::size_t>(slot)];
      std::array<double, CandidatePlots::kMost> belief;  // ψ ν
      double all = 1.0;
      for (std::size_t k = 0; k < claims.count; ++k)
        all += belief[k] = claims.psi[k] / (1.0 + of_others(claims, k));
      for (std::size_t k = 0; k < claims.count; ++k) {
        const double message = claims.psi[k] / std::max(all - belief[k], 1.0);
        change = std::max(change, std::abs(message - claims.message[k]) / (1.0 + message));
        claims.message[k] = message;
        sending_[claims.plot[k]] += message;
      }
    }
    sent_.swap(sending_);
    return change;
  }

  std::vector<Claims> claims_;   ///< by slot
  std::vector<double> sent_;     ///< by plot, the sum of the messages of all tracks
  std::vector<double> sending_;  ///< the same of the pass at hand
  std::vector<int> claimants_;   ///< by plot, how many tracks claim it
  std::vector<int> disputing_;   ///< slots of tracks that claim a plot which others claim, too
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
  void assign(const DetectionProbability& detection_probability, std::span<const Look> looks,
              const TrackList& tracks, std::span<const int> slots,
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
        const Detection detection =
            detection_probability.of(looks[static_cast<std::size_t>(slot)].visibility);
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
