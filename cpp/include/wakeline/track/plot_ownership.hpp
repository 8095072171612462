// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/track/association_probabilities.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/scan_plots.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// Whose the plots of a scan are, by the association probabilities of all tracks. Memory is taken
/// by the constructor.
class PlotOwnership {
 public:
  /// The track that most probably owns a plot, more probably than not.
  struct Owner {
    int slot = -1;  ///< -1: none
    std::int64_t track_id = 0;
    double probability = 0.5;
  };

  explicit PlotOwnership(const TrackerConfig& config)
      : plot_of_track_(static_cast<std::size_t>(config.max_tracks), -1) {
    const auto plots = static_cast<std::size_t>(config.max_plots);
    free_.reserve(plots);
    clutter_.reserve(plots);
    owner_.reserve(plots);
    seen_.reserve(plots);
  }

  /// Begins a scan of that many plots, which nobody owns.
  void clear(int plots) noexcept {
    free_.assign(static_cast<std::size_t>(plots), 1.0);
    clutter_.assign(static_cast<std::size_t>(plots), 1.0);
    owner_.assign(static_cast<std::size_t>(plots), {});
    seen_.assign(static_cast<std::size_t>(plots), 1.0);
  }

  /// Makes room for that many plots; nobody owns the new ones.
  void extend(int plots) noexcept {
    free_.resize(static_cast<std::size_t>(plots), 1.0);
    clutter_.resize(static_cast<std::size_t>(plots), 1.0);
    owner_.resize(static_cast<std::size_t>(plots));
    seen_.resize(static_cast<std::size_t>(plots), 1.0);
  }

  /// Leaves the plots that wait.
  void drop_settled(const ScanPlots& plots) noexcept {
    std::size_t left = 0;
    for (std::size_t k = 0; k < free_.size(); ++k) {
      if (!plots[static_cast<int>(k)].waits) continue;
      free_[left] = free_[k];
      clutter_[left] = clutter_[k];
      seen_[left] = seen_[k];
      owner_[left++] = owner_[k];
    }
    free_.resize(left);
    clutter_.resize(left);
    owner_.resize(left);
    seen_.resize(left);
  }

  /// Saves or restores what is known of that many plots, except who owns them.
  void archive(Archive& fields, int plots) {
    fields(free_, free_.capacity());
    fields(clutter_, clutter_.capacity());
    fields(seen_, seen_.capacity());
    const auto count = static_cast<std::size_t>(plots);
    if (free_.size() != count || clutter_.size() != count || seen_.size() != count) fields.fail();
    if (fields.loading()) owner_.assign(count, {});
  }

  /// Adds one track, updated, with what association gave it of its candidates.
  void add(const Track& track, const CandidatePlots& candidates, const AssociationWeights& weights,
           const AssociationProbabilities& probabilities) noexcept {
    plot_of_track_[static_cast<std::size_t>(track.slot)] =
        probabilities.best < 0 ? -1 : candidates[std::size_t(probabilities.best)].plot;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      const auto plot = static_cast<std::size_t>(candidates[k].plot);
      const double if_target = std::min(probabilities.of_candidate[k], 1.0);
      const double owned = if_target * track.existence;
      clutter_[plot] *= 1.0 - if_target;
      free_[plot] *= weights.assigned && weights.plot[k] > 0.0 ? 0.0 : 1.0 - owned;
      if (owned > kOwned) seen_[plot] = std::min(seen_[plot], probabilities.any);
      if (owned > owner_[plot].probability) owner_[plot] = {track.slot, track.id, owned};
    }
  }

  /// Of each plot, the probability that no target which is tracked owns it; 0 where it was
  /// assigned.
  [[nodiscard]] std::span<const double> free_probability() const noexcept { return free_; }
  /// Whether a plot may start a track: where it is free with that probability. Tracks that have
  /// surely seen their targets may have seen them in other plots, as where one follows two vessels
  /// abreast: where those alone may own it, where it is more probably free than not.
  [[nodiscard]] bool may_start(int plot, double free_plot) const noexcept {
    constexpr double kSurelySeen = 0.9;
    const auto at = static_cast<std::size_t>(plot);
    return free_[at] > (seen_[at] > kSurelySeen ? std::min(free_plot, 0.5) : free_plot);
  }
  /// Of each plot, the probability that it is clutter to all tracks, even if their targets all
  /// exist.
  [[nodiscard]] std::span<const double> clutter_probability() const noexcept { return clutter_; }
  [[nodiscard]] const Owner& owner(int plot) const noexcept {
    return owner_[static_cast<std::size_t>(plot)];
  }
  /// The plot that the track of a slot most probably owns, or -1.
  [[nodiscard]] int plot_of(int slot) const noexcept {
    return plot_of_track_[static_cast<std::size_t>(slot)];
  }

 private:
  static constexpr double kOwned = 0.1;

  std::vector<double> free_;        ///< by plot
  std::vector<double> clutter_;     ///< by plot
  std::vector<Owner> owner_;        ///< by plot
  std::vector<double> seen_;        ///< by plot: least probability that an owner saw its target
  std::vector<int> plot_of_track_;  ///< by slot
};

}  // namespace wakeline
