// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/track/beam.hpp"
#include "wakeline/track/clutter_density.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/existence.hpp"
#include "wakeline/track/initiation.hpp"
#include "wakeline/track/look.hpp"
#include "wakeline/track/plot_ownership.hpp"
#include "wakeline/track/radar.hpp"
#include "wakeline/track/reported.hpp"
#include "wakeline/track/scan_plots.hpp"

namespace wakeline {

/// What a tracker keeps of one of its radars: where its beam is, the plots that wait for the next
/// sector, and what it has learned of clutter, of detection and of each track. Memory is taken by
/// the constructor.
struct RadarState {
  RadarState(const Radar& of, const TrackerConfig& config)
      : radar(of),
        detection_probability(config),
        plots(config.max_plots),
        clutter(config),
        ownership(config),
        initiation(config),
        looks(static_cast<std::size_t>(config.max_tracks)),
        meetings(looks.size()) {}

  Radar radar;
  bool in_use = true;  ///< false once the radar has been removed
  bool started = false;
  double time_s = 0.0;  ///< of its last scan
  Beam beam;
  PlotLag plot_lag = {};
  OwnShip own;  ///< as of the last plot, moved on
  DetectionProbability detection_probability;
  LearnedErrors learned_errors;
  ScanPlots plots;
  ClutterDensity clutter;
  PlotOwnership ownership;
  TrackInitiation initiation;
  std::vector<Look> looks;        ///< at each track, by slot
  std::vector<Meeting> meetings;  ///< with each track, by slot

  [[nodiscard]] Vec<double, 2> position() const noexcept { return own.position<double>(); }

  [[nodiscard]] Look& look(const Track& track) noexcept {
    return looks[static_cast<std::size_t>(track.slot)];
  }
  [[nodiscard]] const Look& look(const Track& track) const noexcept {
    return looks[static_cast<std::size_t>(track.slot)];
  }
  [[nodiscard]] Meeting& meeting(int slot) noexcept {
    return meetings[static_cast<std::size_t>(slot)];
  }

  /// Begins to look at a new track. The beam was there last when it had the track's bearing.
  void open(const Track& track, double time_s) noexcept {
    const Vec<double, 2> d = track.position() - position();
    const double passed_rad = beam.last_rad(std::atan2(d[1], d[0]) + radar.bearing_offset_rad);
    look(track) = {.looked_s = time_s};
    meeting(track.slot) = {passed_rad, passed_rad};
  }

  /// Whether the radar covers a position.
  [[nodiscard]] bool covers(const Vec<double, 2>& target) const noexcept {
    if (radar.covers_all()) return true;
    const Vec<double, 2> d = target - position();
    return radar.covers(d.norm() + radar.range_offset_m,
                        std::atan2(d[1], d[0]) + radar.bearing_offset_rad);
  }

  void archive(Archive& fields, std::span<const int> slots) {
    fields(started);
    fields(time_s);
    beam.archive(fields);
    plot_lag.archive(fields);
    fields(own);
    detection_probability.archive(fields);
    learned_errors.archive(fields);
    clutter.archive(fields);
    initiation.archive(fields);
    plots.archive(fields);
    ownership.archive(fields, plots.size());
    for (const int slot : slots) {
      looks[static_cast<std::size_t>(slot)].archive(fields);
      fields(meeting(slot));
    }
  }
};

}  // namespace wakeline
