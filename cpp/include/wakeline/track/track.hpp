// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "wakeline/core/archive.hpp"
#include "wakeline/track/clutter_map.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/radar.hpp"

namespace wakeline {

/// Where a track is in its life.
enum class TrackStatus : std::uint8_t {
  kTentative,  ///< perhaps a target
  kConfirmed,  ///< a target, seen in this scan
  kCoasting,   ///< a target not seen in the last scan or scans
  kHeld,       ///< a target not seen for longer: held in mind, not shown
};

enum class TrackEvent : std::uint8_t { kStarted, kConfirmed, kCoasting, kLost };

/// Something that became of a track in a scan. A tentative track has a negative number; when it is
/// confirmed it gets the next positive one, for good.
struct Event {
  TrackEvent kind;
  std::int64_t track_id;
  std::int64_t tentative_id;  ///< the number it had before it was confirmed; 0 for a designated one
  double time_s;
};

/// What the time between two scans does to existence and visibility, for all tracks the same.
struct Ageing {
  double survival;       ///< probability that a target stays
  double settled = 0.0;  ///< probability of being visible in the long run
  double memory = 1.0;   ///< what is left of the difference to it

  Ageing(const TrackerConfig& config, double dt_s) noexcept
      : survival(std::exp(-dt_s / config.survival_time_s)) {
    if (!(config.visible_time_s > 0.0)) return;
    const double hide = 1.0 / config.visible_time_s;
    const double show = 1.0 / config.hidden_time_s;
    settled = show / (hide + show);
    memory = std::exp(-(hide + show) * dt_s);
  }
};

/// A track: an estimator, and what is known of the target's being there.
template <class Estimator>
struct Track {
  Estimator estimator;
  std::int64_t id = 0;
  std::int64_t tentative_id = 0;
  std::array<char, 32> name{};  ///< given by the operator, zero-terminated
  TrackStatus status = TrackStatus::kTentative;
  double time_s = 0.0;          ///< of the estimate
  Gaussian<4> kinematics = {};  ///< of the estimate, `[x, vx, y, vy]`
  double existence = 0.0;       ///< probability that there is such a target
  double visibility = 1.0;      ///< probability that the radar can see it
  double nis = std::numeric_limits<double>::quiet_NaN();  ///< of the likeliest plot of the scan
  int scans = 0;
  int hits = 0;
  int misses = 0;             ///< in a row
  std::uint32_t history = 0;  ///< bit k: seen k scans ago
  int duplicate_scans = 0;
  LearnedPlots learned = {};  ///< of its own plots, what the clutter map has taken in
  int best_echo = -1;    ///< in the last scan, the plot that it most likely owns; -1 without one
  double plot_m2 = 0.0;  ///< variance of its last plot, of an axis as the mean of both

  [[nodiscard]] bool confirmed() const noexcept { return status != TrackStatus::kTentative; }
  /// Confirmed and not merely held in mind.
  [[nodiscard]] bool shown() const noexcept {
    return status == TrackStatus::kConfirmed || status == TrackStatus::kCoasting;
  }
  [[nodiscard]] double speed_mps() const noexcept {
    return std::hypot(kinematics.mean[1], kinematics.mean[3]);
  }
  /// Of an axis, as the mean of both.
  [[nodiscard]] double position_variance_m2() const noexcept {
    return (kinematics.covariance(0, 0) + kinematics.covariance(2, 2)) / 2;
  }
  [[nodiscard]] double position_std_m() const noexcept { return std::sqrt(position_variance_m2()); }
  [[nodiscard]] Vec<double, 2> position() const noexcept {
    return {kinematics.mean[0], kinematics.mean[2]};
  }
  [[nodiscard]] Vec<double, 2> velocity() const noexcept {
    return {kinematics.mean[1], kinematics.mean[3]};
  }
  [[nodiscard]] Mat<double, 2, 2> velocity_covariance() const noexcept {
    const auto rows = Eigen::seqN(1, Eigen::fix<2>, Eigen::fix<2>);
    return kinematics.covariance(rows, rows);
  }
  [[nodiscard]] std::string_view label() const noexcept { return name.data(); }

  /// Time passes: the target may leave, be hidden from the radar, or be seen again.
  void age(const Ageing& ageing) noexcept {
    existence *= ageing.survival;
    visibility = ageing.settled + (visibility - ageing.settled) * ageing.memory;
  }

  /// Bayes' rule for "the target exists" and "it is visible", given how well the scan fits the
  /// track: `total` for all that its plots may mean, of which `none` is that it gave none. A
  /// `certain` track was given its plot and cannot have none.
  void weigh(const TrackerConfig& config, double total, double none, bool certain) noexcept {
    if (config.visible_time_s > 0.0) {
      const double seen = std::max(total - none, 0.0);  // their sum is rounded
      const double visible = certain ? seen : visibility * (1.0 - config.detection()) + seen;
      const double either = certain ? visible : visible + (1.0 - visibility);
      if (either > 0.0) visibility = visible / either;
    }
    const double exists = existence * total;
    existence = std::min(exists / (1.0 - existence + exists), 0.99999);
  }

  /// Counts a scan in which the target was seen, or not.
  void count(bool seen) noexcept {
    ++scans;
    history = (history << 1) | (seen ? 1u : 0u);
    hits += seen;
    misses = seen ? 0 : misses + 1;
  }

  /// M of the last N scans had a plot, this one too, and existence is beyond doubt.
  [[nodiscard]] bool confirmable(const TrackerConfig& config) const noexcept {
    const std::uint32_t window =
        config.confirm_window >= 32 ? ~0u : (1u << config.confirm_window) - 1u;
    return misses == 0 && existence > config.confirm_existence &&
           std::popcount(history & window) >= config.confirm_hits;
  }

  /// How many scans in a row the target may go unseen.
  [[nodiscard]] double patience(const TrackerConfig& config) const noexcept {
    if (!confirmed()) return config.tentative_misses;
    return std::min(config.coast_scans + config.coast_scans_per_hit * hits,
                    double(config.coast_scans_max));
  }

  /// True when the track has no future. A confirmed one is held through a silence that its age
  /// allows.
  [[nodiscard]] bool hopeless(const TrackerConfig& config, const Radar& radar) const noexcept {
    const bool silent = misses > patience(config);
    const bool doubtful = !confirmed() && existence < config.drop_existence;
    const bool too_fast = speed_mps() > config.drop_speed_factor * radar.max_speed_mps;
    const double run_m = radar.max_speed_mps * radar.period_s * config.coast_scans;
    const double roam_m =
        std::max({config.drop_position_std_m, 2.0 * std::sqrt(plot_m2), confirmed() ? run_m : 0.0});
    return silent || doubtful || too_fast || !(position_std_m() <= roam_m);
  }

  /// Saves or restores all but the rules.
  void archive(Archive& fields) {
    estimator.archive(fields);
    fields(id);
    fields(tentative_id);
    fields(name);
    fields(status);
    fields(time_s);
    fields(kinematics.mean);
    fields(kinematics.covariance);
    fields(existence);
    fields(visibility);
    fields(nis);
    fields(scans);
    fields(hits);
    fields(misses);
    fields(history);
    fields(duplicate_scans);
    fields(plot_m2);
    learned.archive(fields);
  }
};

}  // namespace wakeline
