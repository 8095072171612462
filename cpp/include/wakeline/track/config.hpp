// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "wakeline/core/fields.hpp"

namespace wakeline {

/// How plots are given to tracks.
enum class Association : std::uint8_t {
  kProbabilistic,  ///< every gated plot as far as it is likely (PDA), less what other tracks claim
                   ///< of it
  kGlobalNearest,  ///< one plot each, the best total (GNN)
  kNearest,        ///< one plot each, the best pair first
};

/// Names of the methods.
constexpr std::array<Word<Association>, 3> words_of(Association) noexcept {
  return {{{"probabilistic", Association::kProbabilistic},
           {"global_nearest", Association::kGlobalNearest},
           {"nearest", Association::kNearest}}};
}

/// The rules by which tracks live. The defaults are one set for all radars.
struct TrackerConfig {
  // Detection
  double detection_probability = 0.8;
  double gate_probability = 0.95;
  double clutter_density_per_m2 = 1e-7;
  double outlier_probability = 0.11;
  double outlier_scale = 4.0;
  double clutter_cell_m = 150.0;
  double clutter_memory_s = 60.0;
  double clutter_weight = 1.0;
  double visible_time_s = 60.0;
  double hidden_time_s = 40.0;
  Association association = Association::kProbabilistic;

  // Start
  double birth_density_per_m2 = 3e-10;
  double free_plot = 0.75;
  double start_gate_sigma = 3.0;
  double start_speed_factor = 0.5;

  // Confirm
  double confirm_existence = 0.995;
  int confirm_hits = 3;
  int confirm_window = 5;

  // Coast and drop
  double survival_time_s = 1000.0;
  double drop_existence = 0.005;
  int tentative_misses = 6;
  double coast_scans = 5.0;
  double coast_scans_per_hit = 0.3;
  int coast_scans_max = 15;
  double shown_probability = 0.003;
  double drop_position_std_m = 100.0;
  double drop_speed_factor = 1.0;

  // Duplicates
  double duplicate_distance = 0.35;
  double vessel_length_m = 0.0;
  int duplicate_scans = 3;

  // Room
  int max_tracks = 500;
  int max_plots = 20000;

  static constexpr auto fields() noexcept {
    using C = TrackerConfig;
    constexpr Rule kScans = between(0, 1'000'000), kCell{.low = 1.0, .high = 1e6, .or_zero = true};
    return field_table(
        field("detection_probability", &C::detection_probability, kProbability, "1",
              "Probability PD that a visible target gives a plot in a scan, before it is learned."),
        field("gate_probability", &C::gate_probability, inside(0, 1), "1",
              "Probability PG that the plot of a target is in its gate."),
        field("clutter_density_per_m2", &C::clutter_density_per_m2, between(1e-15, 1), "1/m²",
              "False plots per area and scan, at the least; what is more is learned."),
        field("outlier_probability", &C::outlier_probability, from_to_below(0, 1), "1",
              "Share of plots whose error is an outlier."),
        field("outlier_scale", &C::outlier_scale, between(1, 1000), "1",
              "Standard deviation of an outlier over that of a usual plot."),
        field("clutter_cell_m", &C::clutter_cell_m, kCell, "m",
              "Side of a cell of the clutter map; cells of patches are 3.5 times as wide; 0: "
              "neither."),
        field("clutter_memory_s", &C::clutter_memory_s, kTime, "s",
              "Fading memory of the clutter map and of rings; that of patches is a third."),
        field("clutter_weight", &C::clutter_weight, between(0, 1000), "1",
              "Weight of the clutter map; 1: its density counts in full."),
        field("visible_time_s", &C::visible_time_s, kTimeOrZero, "s",
              "Mean time until a target is hidden from the radar; 0: never."),
        field("hidden_time_s", &C::hidden_time_s, kTime, "s",
              "Mean time until a hidden target is visible again."),
        field("association", &C::association,
              "Association of plots with tracks: 'probabilistic' weighs every plot in the gate "
              "(PDA) less what other tracks claim of it, 'global_nearest' gives each track one "
              "plot by the best total (GNN), 'nearest' by the best pair first."),
        field("birth_density_per_m2", &C::birth_density_per_m2, between(0, 1), "1/m²",
              "New targets per area and scan; 0: none but designated ones."),
        field("free_plot", &C::free_plot, kProbability, "1",
              "A plot starts a track when it belongs to no other with this probability."),
        field("start_gate_sigma", &C::start_gate_sigma, between(0, 1000), "sigma",
              "Plot errors by which the speed limit of a start is widened."),
        field("start_speed_factor", &C::start_speed_factor, between(0, 1000), "1",
              "Prior speed of a start over the speed limit of the radar; 0: the speed of two plots "
              "is taken as it is."),
        field("confirm_existence", &C::confirm_existence, kProbability, "1",
              "A track is confirmed above this probability of existence, with `confirm_hits` of "
              "its last `confirm_window` scans."),
        field("confirm_hits", &C::confirm_hits, between(1, 32), "plots",
              "Plots that a track needs to be confirmed."),
        field("confirm_window", &C::confirm_window, between(1, 32), "scans",
              "Last scans in which these plots are counted; `confirm_hits` or more."),
        field("survival_time_s", &C::survival_time_s, kTime, "s",
              "Mean time until a target leaves."),
        field("drop_existence", &C::drop_existence, kProbability, "1",
              "A tentative track below this probability of existence, and below a third of that of "
              "its start, is dropped."),
        field("tentative_misses", &C::tentative_misses, kScans, "scans",
              "A tentative track is dropped after more misses in a row."),
        field("coast_scans", &C::coast_scans, kScans, "scans",
              "A confirmed track is dropped after more misses in a row than this and "
              "`coast_scans_per_hit` together."),
        field("coast_scans_per_hit", &C::coast_scans_per_hit, kScans, "scans",
              "Further misses allowed for each plot that the track has had."),
        field("coast_scans_max", &C::coast_scans_max, kScans, "scans",
              "Upper limit of the misses in a row of a confirmed track; one in which another track "
              "had its plot counts half."),
        field(
            "shown_probability", &C::shown_probability, kProbability, "1",
            "A coasting track is held without being shown when a target that is there has so many "
            "misses in a row with less than this probability."),
        field("drop_position_std_m", &C::drop_position_std_m, between(0.1, 1e9), "m",
              "A track with a larger standard deviation of its position is dropped; the limit is "
              "raised to two plot errors and, for a confirmed track, to what a vessel runs in "
              "`coast_scans`."),
        field(
            "drop_speed_factor", &C::drop_speed_factor, between(0.1, 1e6), "1",
            "Factor on the speed limit of the radar, above which a tentative track is dropped, and "
            "a confirmed one by three standard deviations of its speed."),
        field("duplicate_distance", &C::duplicate_distance, kNotNegative, "sigma²",
              "Two tracks nearer than this, in squared sigmas of their difference, are one."),
        field("vessel_length_m", &C::vessel_length_m, between(0, 1e4), "m",
              "A track nearer than this to a shown one, at the same velocity, is another echo of "
              "its vessel; 0: each vessel has one echo."),
        field("duplicate_scans", &C::duplicate_scans, between(1, 1'000'000), "scans",
              "Scans for which two tracks must be so near before one is removed."),
        field("max_tracks", &C::max_tracks, between(1, 100'000), "tracks",
              "Room for tracks; when full, a new track replaces the weakest tentative one or is "
              "not started."),
        field("max_plots", &C::max_plots, between(1, 1'000'000), "plots",
              "Room for the plots of a scan; those beyond it are rejected."));
  }

  /// PG: the plot of a target is in its gate. Where there are outliers the gate is theirs, and
  /// holds all other plots.
  [[nodiscard]] double in_gate() const noexcept {
    const double w = outlier_probability;
    return w > 0.0 ? 1.0 - w + w * gate_probability : gate_probability;
  }

  /// k², by which the covariance of an outlier is larger; 1 where there are none.
  [[nodiscard]] double outlier_variance() const noexcept {
    return outlier_probability > 0.0 ? outlier_scale * outlier_scale : 1.0;
  }

  friend bool operator==(const TrackerConfig&, const TrackerConfig&) = default;

  void validate() const {
    validate_fields(*this);
    require(confirm_window >= confirm_hits, "confirm_window", "at least confirm_hits",
            confirm_window);
  }
};

}  // namespace wakeline
