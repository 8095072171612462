// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "wakeline/core/fields.hpp"
#include "wakeline/gating/strobe_echo.hpp"

namespace wakeline {

/// The rules by which the tracks of a `StrobeTracker` live.
struct StrobeTrackerConfig {
  int least_amplitude = 1;
  int pedestal = 0;
  EchoChoice several = EchoChoice::kNearest;
  double least_share = 0.25;
  double radius_m = 45.0;
  double max_radius_m = 150.0;
  double growth = 1.5;
  double shrinkage = 0.6;
  double fill_share = 0.9;
  int lost_after = 3;
  int confirm_hits = 4;
  int max_tracks = 1000;
  int max_sweep_cells = 4096;
  int max_strobe_sweeps = 1024;

  static constexpr auto fields() noexcept {
    using S = StrobeTrackerConfig;
    return field_table(
        strobe_echo_fields<S>(),
        field("radius_m", &S::radius_m, between(1, 1e6), "m",
              "Radius of the strobe of a track that is seen in every turn."),
        field("max_radius_m", &S::max_radius_m, between(1, 1e6), "m",
              "Largest radius, of a new track or after misses; at least radius_m."),
        field("growth", &S::growth, between(1, 100), "1",
              "Factor of the radius after a turn without an echo."),
        field("shrinkage", &S::shrinkage, above_to(0, 1), "1",
              "Factor of a radius above radius_m after a turn with an echo."),
        field("fill_share", &S::fill_share, above_to(0, 1), "1",
              "Share of the cells of a strobe from which on an echo fills it."),
        field("lost_after", &S::lost_after, between(1, 100), "turns",
              "Turns in a row without an echo after which a track is lost."),
        field("confirm_hits", &S::confirm_hits, between(1, 100), "turns",
              "Turns with an echo after which a track acquired from a plot is confirmed; until "
              "then the first turn without one ends it."),
        field("max_tracks", &S::max_tracks, between(1, 100000), "tracks", "Room for tracks."),
        field("max_sweep_cells", &S::max_sweep_cells, between(1, 65536), "cells",
              "Longer sweeps are rejected."),
        field("max_strobe_sweeps", &S::max_strobe_sweeps, between(8, 65536), "sweeps",
              "Sweeps that are kept: of a wider strobe the first sweeps are missing."));
  }

  /// How a strobe is evaluated.
  [[nodiscard]] StrobeSettings echo() const noexcept {
    return {least_amplitude, pedestal, several, least_share};
  }

  /// The radius of the next strobe after one with an echo, or without.
  [[nodiscard]] double next_radius_m(double radius, bool seen) const noexcept {
    return seen ? std::max(radius_m, shrinkage * radius) : std::min(max_radius_m, growth * radius);
  }

  void validate() const {
    validate_fields(*this);
    echo().validate();
    require(max_radius_m >= radius_m, "max_radius_m", "at least radius_m", max_radius_m);
  }
};

}  // namespace wakeline
