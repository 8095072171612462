// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/track/innovation_consistency.hpp"

namespace wakeline {

/// Where a track is in its life.
enum class TrackStatus : std::uint8_t {
  kTentative,  ///< perhaps a target
  kConfirmed,  ///< a target, seen in this scan
  kCoasting,   ///< a target not seen in the last scan or scans
  kHeld,       ///< a target not seen for longer, or far too fast: kept, but not shown
};

/// What has happened to a track.
enum class TrackEvent : std::uint8_t {
  kStarted,
  kConfirmed,
  kCoasting,
  kLost,
  kFull,          ///< `max_tracks` is reached; again only when there has been room in between
  kIdentified,    ///< the track is believed to be of a vessel that reports
  kIdentityLost,  ///< it is believed so no longer
  /// A report of the track's vessel is far from it, of another velocity, or contradicts those
  /// before; again after one that agreed.
  kIdentityDisagrees,
  kIdentityJumps,   ///< a report is farther from the one before than a vessel runs
  kIdentityShared,  ///< the vessel that reports may be on a track which another one is on
};

/// Name of an event, as in files.
constexpr const char* to_string(TrackEvent event) noexcept {
  switch (event) {
    case TrackEvent::kStarted:
      return "started";
    case TrackEvent::kConfirmed:
      return "confirmed";
    case TrackEvent::kCoasting:
      return "coasting";
    case TrackEvent::kLost:
      return "lost";
    case TrackEvent::kFull:
      return "full";
    case TrackEvent::kIdentified:
      return "identified";
    case TrackEvent::kIdentityLost:
      return "identity_lost";
    case TrackEvent::kIdentityDisagrees:
      return "identity_disagrees";
    case TrackEvent::kIdentityJumps:
      return "identity_jumps";
    case TrackEvent::kIdentityShared:
      return "identity_shared";
  }
  return "unknown";
}

/// Why a track was lost.
enum class LossReason : std::uint8_t {
  kNone,       ///< it was not lost
  kMissed,     ///< without a plot for too long
  kDoubtful,   ///< a tentative track whose target hardly exists
  kTooFast,    ///< above the speed limit of the radar
  kUncertain,  ///< the position is not known well enough
  kDuplicate,  ///< a senior track follows the same target
  kDisplaced,  ///< a tentative track that made room for a more probable one
  kFailed,     ///< the estimator cannot follow the measurements
  kCorrected,  ///< with late data there is no such track
};

/// Name of a reason, as in files.
constexpr const char* to_string(LossReason reason) noexcept {
  switch (reason) {
    case LossReason::kNone:
      return "";
    case LossReason::kMissed:
      return "missed";
    case LossReason::kDoubtful:
      return "doubtful";
    case LossReason::kTooFast:
      return "too_fast";
    case LossReason::kUncertain:
      return "uncertain";
    case LossReason::kDuplicate:
      return "duplicate";
    case LossReason::kDisplaced:
      return "displaced";
    case LossReason::kFailed:
      return "failed";
    case LossReason::kCorrected:
      return "corrected";
  }
  return "unknown";
}

/// A change in the life of a track. A tentative track has a negative number; when it is confirmed
/// it gets the next positive one, for good.
struct Event {
  TrackEvent kind;
  std::int64_t track_id;      ///< 0 of `kFull`, and where no track is meant
  std::int64_t tentative_id;  ///< the number before it was confirmed; 0 for a designated track
  double time_s;
  LossReason reason = LossReason::kNone;  ///< of a lost track
  std::array<char, 32> identity = {};     ///< of the vessel that reports, zero-terminated
};

/// Sensors of bearings or ranges alone.
inline constexpr std::size_t kMostPartialSensors = 4;

/// A belief over `[x, vx, y, vy]` moved in time, also backwards, at constant velocity.
inline Gaussian<4> at_constant_velocity(const Gaussian<4>& kinematics, double dt_s) noexcept {
  Mat<double, 4, 4> step = Mat<double, 4, 4>::Identity();
  step(0, 1) = step(2, 3) = dt_s;
  return {step * kinematics.mean, step * kinematics.covariance * step.transpose()};
}

/// The position in a belief over `[x, vx, y, vy]`.
inline Gaussian<2> position_in(const Gaussian<4>& kinematics) noexcept {
  const auto rows = Eigen::seqN(0, Eigen::fix<2>, Eigen::fix<2>);
  return {kinematics.mean(rows), kinematics.covariance(rows, rows)};
}

/// The position in such a belief moved in time at constant velocity, without the velocity.
inline Gaussian<2> position_at_constant_velocity(const Gaussian<4>& kinematics,
                                                 double dt_s) noexcept {
  Gaussian<2> position;
  for (const int i : {0, 1}) {
    const int north_or_east = 2 * i;
    position.mean[i] = kinematics.mean[north_or_east] + dt_s * kinematics.mean[north_or_east + 1];
    for (const int j : {0, 1}) {
      const auto moved = [&](int column) {
        return kinematics.covariance(north_or_east, column) +
               dt_s * kinematics.covariance(north_or_east + 1, column);
      };
      position.covariance(i, j) = moved(2 * j) + dt_s * moved(2 * j + 1);
    }
  }
  return position;
}

/// Of the velocity in a belief over `[x, vx, y, vy]`.
inline Mat<double, 2, 2> velocity_covariance(const Gaussian<4>& kinematics) noexcept {
  const auto rows = Eigen::seqN(1, Eigen::fix<2>, Eigen::fix<2>);
  return kinematics.covariance(rows, rows);
}

/// Whether the speed in a belief over `[x, vx, y, vy]` is above a limit by that many of its
/// standard deviations, or by three tenths of the limit if that is less.
inline bool exceeds_speed(const Gaussian<4>& kinematics, double limit_mps, double sigmas) noexcept {
  const Vec<double, 2> velocity(kinematics.mean[1], kinematics.mean[3]);
  const double speed_mps = velocity.norm();
  if (!(speed_mps > limit_mps)) return false;
  const Vec<double, 2> along = velocity / speed_mps;
  const double margin_mps = sigmas * std::sqrt(along.dot(velocity_covariance(kinematics) * along));
  return speed_mps - limit_mps > std::min(margin_mps, 0.3 * limit_mps);
}

/// By so many standard deviations a confirmed track exceeds the speed limit before it is lost.
inline constexpr double kSpeedSigmas = 3.0;

/// What a tracker knows of a target, besides the estimator that follows its motion.
struct Track {
  int slot = 0;  ///< place in the tracker's memory, as long as the track lives
  std::int64_t id = 0;
  std::int64_t tentative_id = 0;
  std::int64_t birth = 0;       ///< no other track has this number
  int identity = -1;            ///< number of the vessel that reports, which it is; -1: none
  std::array<char, 32> name{};  ///< given by the operator, zero-terminated
  TrackStatus status = TrackStatus::kTentative;
  double time_s = 0.0;           ///< of the estimate
  Gaussian<4> kinematics = {};   ///< of the estimate, `[x, vx, y, vy]`
  double existence = 0.0;        ///< probability that there is such a target
  double start_existence = 1.0;  ///< the same when it started
  double nis = std::numeric_limits<double>::quiet_NaN();  ///< of the most probable plot of the scan
  InnovationConsistency consistency;                      ///< of these plots, where it was seen
  int scans = 0;
  int hits = 0;
  int misses = 0;              ///< in a row
  int unexplained_misses = 0;  ///< of these, without those in which another track had its plot
  std::uint32_t history = 0;   ///< bit k: seen k scans ago
  int duplicate_scans = 0;     ///< in a row that a senior track was on the same target
  double plot_m2 = 0.0;        ///< variance of its last plot, per axis (mean of both)
  double errors_scale = 1.0;   ///< of its variance, as the errors of the radar are not as stated
  Mat<double, 2, 2> stays_m2 = Mat<double, 2, 2>::Zero();  ///< errors of the position that stay
  double looked_s = 0.0;  ///< when a radar last looked: a plot or a miss
  double seen_until_s = -std::numeric_limits<double>::infinity();
  ///< until then a miss does not count: another sensor has seen it
  /// Of each sensor of bearings or ranges alone, the probability that it sees the target.
  std::array<double, kMostPartialSensors> in_view = {0.5, 0.5, 0.5, 0.5};
  bool hushed = false;  ///< followed, but neither shown nor reported: the operator's word

  [[nodiscard]] bool confirmed() const noexcept { return status != TrackStatus::kTentative; }
  /// Confirmed, and not silent for so long that it is only held.
  [[nodiscard]] bool active() const noexcept {
    return status == TrackStatus::kConfirmed || status == TrackStatus::kCoasting;
  }
  /// Active, and not hushed.
  [[nodiscard]] bool shown() const noexcept { return active() && !hushed; }
  [[nodiscard]] double speed_mps() const noexcept {
    return std::hypot(kinematics.mean[1], kinematics.mean[3]);
  }
  /// Per axis, the mean of both.
  [[nodiscard]] double position_variance_m2() const noexcept {
    return (kinematics.covariance(0, 0) + kinematics.covariance(2, 2)) / 2;
  }
  [[nodiscard]] double position_std_m() const noexcept { return std::sqrt(position_variance_m2()); }
  /// How much a plot like its last one counts for its position; 1 while other sensors see it too,
  /// since the weight of one plot is then not that of all that comes.
  [[nodiscard]] double gain() const noexcept {
    return time_s < seen_until_s ? 1.0 : position_variance_m2() / plot_m2;
  }
  [[nodiscard]] Vec<double, 2> position() const noexcept {
    return {kinematics.mean[0], kinematics.mean[2]};
  }
  [[nodiscard]] Vec<double, 2> velocity() const noexcept {
    return {kinematics.mean[1], kinematics.mean[3]};
  }
  [[nodiscard]] Mat<double, 2, 2> velocity_covariance() const noexcept {
    return wakeline::velocity_covariance(kinematics);
  }
  [[nodiscard]] std::string_view label() const noexcept { return name.data(); }

  /// Counts a scan in which the target was seen, or not, be it that another track had its plot.
  void count(bool seen, bool shared = false) noexcept {
    ++scans;
    history = (history << 1) | (seen ? 1u : 0u);
    hits += seen;
    misses = seen ? 0 : misses + 1;
    unexplained_misses = seen ? 0 : unexplained_misses + !shared;
  }

  /// Saves or restores all but the slot.
  void archive(Archive& fields) {
    fields(id);
    fields(tentative_id);
    fields(birth);
    fields(identity);
    fields(name);
    fields(status);
    fields(time_s);
    fields(kinematics.mean);
    fields(kinematics.covariance);
    fields(existence);
    fields(start_existence);
    fields(nis);
    consistency.archive(fields);
    fields(scans);
    fields(hits);
    fields(misses);
    fields(unexplained_misses);
    fields(history);
    fields(duplicate_scans);
    fields(plot_m2);
    fields(errors_scale);
    fields(stays_m2);
    fields(looked_s);
    fields(seen_until_s);
    fields(in_view);
    fields(hushed);
  }
};

}  // namespace wakeline
