// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/track/clutter_map.hpp"

namespace wakeline {

/// Where a track is in its life.
enum class TrackStatus : std::uint8_t {
  kTentative,  ///< perhaps a target
  kConfirmed,  ///< a target, seen in this scan
  kCoasting,   ///< a target not seen in the last scan or scans
  kHeld,       ///< a target not seen for longer: kept, but not shown
};

enum class TrackEvent : std::uint8_t { kStarted, kConfirmed, kCoasting, kLost };

/// A change in the life of a track. A tentative track has a negative number; when it is confirmed
/// it gets the next positive one, for good.
struct Event {
  TrackEvent kind;
  std::int64_t track_id;
  std::int64_t tentative_id;  ///< the number before it was confirmed; 0 for a designated track
  double time_s;
};

/// What a tracker knows of a target, besides the estimator that follows its motion.
struct Track {
  int slot = 0;  ///< place in the tracker's memory, as long as the track lives
  std::int64_t id = 0;
  std::int64_t tentative_id = 0;
  std::array<char, 32> name{};  ///< given by the operator, zero-terminated
  TrackStatus status = TrackStatus::kTentative;
  double time_s = 0.0;          ///< of the estimate
  Gaussian<4> kinematics = {};  ///< of the estimate, `[x, vx, y, vy]`
  double existence = 0.0;       ///< probability that there is such a target
  double visibility = 1.0;      ///< probability that the radar can see it
  double nis = std::numeric_limits<double>::quiet_NaN();  ///< of the most probable plot of the scan
  int scans = 0;
  int hits = 0;
  int misses = 0;             ///< in a row
  std::uint32_t history = 0;  ///< bit k: seen k scans ago
  int duplicate_scans = 0;    ///< in a row that a senior track was on the same target
  double plot_m2 = 0.0;       ///< variance of its last plot, per axis (mean of both)
  LearnedPlots learned = {};  ///< what the clutter map has learned of its own plots

  [[nodiscard]] bool confirmed() const noexcept { return status != TrackStatus::kTentative; }
  /// Confirmed, and not silent for so long that it is only held.
  [[nodiscard]] bool shown() const noexcept {
    return status == TrackStatus::kConfirmed || status == TrackStatus::kCoasting;
  }
  [[nodiscard]] double speed_mps() const noexcept {
    return std::hypot(kinematics.mean[1], kinematics.mean[3]);
  }
  /// Per axis, the mean of both.
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

  /// Counts a scan in which the target was seen, or not.
  void count(bool seen) noexcept {
    ++scans;
    history = (history << 1) | (seen ? 1u : 0u);
    hits += seen;
    misses = seen ? 0 : misses + 1;
  }

  /// Saves or restores all but the slot.
  void archive(Archive& fields) {
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
