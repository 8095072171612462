// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <tuple>

#include "wakeline/core/require.hpp"

namespace wakeline {

/// How plots are given to tracks.
enum class Association : std::uint8_t {
  kProbabilistic,  ///< every gated plot as far as it is likely (PDA), less what other tracks claim
                   ///< of it
  kGlobalNearest,  ///< one plot each, the best total (GNN)
  kNearest,        ///< one plot each, the best pair first
};

/// The rules by which tracks live. The defaults are one set for all radars.
struct TrackerConfig {
  // Detection
  double detection_probability = 0.8;  ///< PD of a target that is visible at all
  double gate_probability = 0.95;      ///< PG of the gate
  double clutter_density_per_m2 =
      1e-7;                        ///< false plots per m² and scan, where the map knows of none
  double wild_probability = 0.2;   ///< share of plots with a wild error
  double wild_scale = 4.0;         ///< how many times larger that error is
  double clutter_cell_m = 150.0;   ///< cell of the clutter map; 0: no map
  double clutter_memory_s = 60.0;  ///< fading memory of the map
  double clutter_weight = 1.0;     ///< how far the map is believed
  double visible_time_s = 60.0;    ///< mean time until a target is hidden from the radar; 0: never
  double hidden_time_s = 40.0;     ///< mean time until a hidden target is seen again
  Association association = Association::kProbabilistic;

  // Start
  double initial_existence = 0.08;  ///< probability that two plots a speed limit apart are a target
  double free_plot = 0.8;  ///< a plot starts a track when free of others with this probability
  double start_gate_sigma = 3.0;  ///< plot errors that the speed limit of a start is widened by
  double start_speed_factor =
      1.0;  ///< prior speed of a start over the radar's speed limit; 0: none

  // Confirm
  double confirm_existence = 0.99;  ///< a track is confirmed above this probability of existence
  int confirm_hits = 3;             ///< and with at least this many plots
  int confirm_window = 5;           ///< in this many of its last scans

  // Coast and drop
  double survival_time_s = 1000.0;   ///< mean time until a target leaves
  double drop_existence = 0.005;     ///< a track below this probability of existence is dropped
  int tentative_misses = 4;          ///< a tentative track is dropped after more misses in a row
  double coast_scans = 5.0;          ///< a confirmed one after more than this,
  double coast_scans_per_hit = 0.3;  ///< and this for each plot it ever had,
  int coast_scans_max = 15;          ///< but never more than this
  int shown_scans = 4;  ///< a coasting track is shown for this many scans, then held in mind
  double drop_position_std_m =
      100.0;  ///< a track that knows its place worse than this, or than two of its plots (a
              ///< confirmed one: than a vessel runs in `coast_scans`), if that is more, is dropped
  double drop_speed_factor =
      1.0;  ///< a track faster than this times the radar's speed limit is dropped

  // Duplicates
  double duplicate_distance =
      0.5;  ///< two tracks nearer than this, in squared sigmas of their difference, are one
  double vessel_length_m =
      0.0;  ///< so is one nearer than this to a shown one, at the same velocity: another echo
            ///< of the same vessel; 0: each vessel has one echo
  int duplicate_scans = 3;  ///< once they have been so for this many scans

  // Room
  int max_tracks = 500;   ///< when full, a new track takes the place of the weakest tentative one,
                          ///< or is not started
  int max_plots = 20000;  ///< plots of a scan beyond this are refused

  /// PD PG: a visible target gives a plot, and that in its gate. Where plots may err wildly the
  /// gate is that of wild ones, and holds all others.
  [[nodiscard]] double detection() const noexcept {
    const double w = wild_probability;
    const double in_gate = w > 0.0 ? 1.0 - w + w * gate_probability : gate_probability;
    return detection_probability * in_gate;
  }

  /// k², by which the covariance of a wild plot is larger; 1 where there are none.
  [[nodiscard]] double wild_variance() const noexcept {
    return wild_probability > 0.0 ? wild_scale * wild_scale : 1.0;
  }

  /// All settings in order, to be saved.
  [[nodiscard]] auto settings() noexcept {
    return std::tie(detection_probability, gate_probability, clutter_density_per_m2,
                    wild_probability, wild_scale, clutter_cell_m, clutter_memory_s, clutter_weight,
                    visible_time_s, hidden_time_s, association, initial_existence, free_plot,
                    start_gate_sigma, start_speed_factor, confirm_existence, confirm_hits,
                    confirm_window, survival_time_s, drop_existence, tentative_misses, coast_scans,
                    coast_scans_per_hit, coast_scans_max, shown_scans, drop_position_std_m,
                    drop_speed_factor, duplicate_distance, vessel_length_m, duplicate_scans,
                    max_tracks, max_plots);
  }

  friend bool operator==(const TrackerConfig&, const TrackerConfig&) = default;

  void validate() const {
    require_probability("detection_probability", detection_probability);
    require(gate_probability > 0.0 && gate_probability < 1.0, "gate_probability", "between 0 and 1",
            gate_probability);
    require_positive("clutter_density_per_m2", clutter_density_per_m2);
    require(wild_probability >= 0.0 && wild_probability < 1.0, "wild_probability",
            "at least 0 and below 1", wild_probability);
    require(wild_scale >= 1.0 && std::isfinite(wild_scale), "wild_scale", "finite and at least 1",
            wild_scale);
    require_not_negative("clutter_cell_m", clutter_cell_m);
    require_time("clutter_memory_s", clutter_memory_s);
    require_not_negative("clutter_weight", clutter_weight);
    if (visible_time_s != 0.0) require_time("visible_time_s", visible_time_s);
    require_time("hidden_time_s", hidden_time_s);
    require_probability("initial_existence", initial_existence);
    require_probability("free_plot", free_plot);
    require_not_negative("start_gate_sigma", start_gate_sigma);
    require_not_negative("start_speed_factor", start_speed_factor);
    require_probability("confirm_existence", confirm_existence);
    require(confirm_hits >= 1, "confirm_hits", "at least 1", confirm_hits);
    require(confirm_window >= confirm_hits && confirm_window <= 32, "confirm_window",
            "at least confirm_hits and at most 32", confirm_window);
    require_time("survival_time_s", survival_time_s);
    require_probability("drop_existence", drop_existence);
    require(tentative_misses >= 0, "tentative_misses", "at least 0", tentative_misses);
    require_not_negative("coast_scans", coast_scans);
    require_not_negative("coast_scans_per_hit", coast_scans_per_hit);
    require(coast_scans_max >= 0, "coast_scans_max", "at least 0", coast_scans_max);
    require(shown_scans >= 0, "shown_scans", "at least 0", shown_scans);
    require_positive("drop_position_std_m", drop_position_std_m);
    require_positive("drop_speed_factor", drop_speed_factor);
    require_not_negative("duplicate_distance", duplicate_distance);
    require_not_negative("vessel_length_m", vessel_length_m);
    require(duplicate_scans >= 1, "duplicate_scans", "at least 1", duplicate_scans);
    require(max_tracks >= 1 && max_tracks <= 1'000'000, "max_tracks", "1 to 1000000", max_tracks);
    require(max_plots >= 1 && max_plots <= 10'000'000, "max_plots", "1 to 10000000", max_plots);
  }
};

}  // namespace wakeline
