// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "wakeline/track/config.hpp"
#include "wakeline/track/radar.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// The speed above which no track starts.
inline double speed_limit_mps(const TrackerConfig& config, const Radar& radar) noexcept {
  return config.drop_speed_factor * radar.max_speed_mps;
}

/// M of the last N scans had a plot, this one too, existence is beyond doubt, and the speed within
/// the limit.
inline bool is_confirmable(const TrackerConfig& config, const Radar& radar,
                           const Track& track) noexcept {
  const std::uint32_t window =
      config.confirm_window >= 32 ? ~0u : (1u << config.confirm_window) - 1u;
  return track.misses == 0 && track.existence > config.confirm_existence &&
         !(track.speed_mps() > speed_limit_mps(config, radar)) &&
         std::popcount(track.history & window) >= config.confirm_hits;
}

/// How many scans in a row a target may be missed before its track is deleted.
inline double allowed_misses(const TrackerConfig& config, const Track& track) noexcept {
  if (!track.confirmed()) return config.tentative_misses;
  return std::min(config.coast_scans + config.coast_scans_per_hit * track.hits,
                  double(config.coast_scans_max));
}

/// Below which probability of existence a tentative track is deleted. In dense clutter all starts
/// are doubtful, and one is not deleted before it has become more so.
inline double least_existence(const TrackerConfig& config, const Track& track) noexcept {
  constexpr double kDoubt = 0.3;  // of the existence at the start
  return std::min(config.drop_existence, kDoubt * track.start_existence);
}

/// Whether a track is so much faster than vessels are that it is not shown. One that is at the
/// limit is kept and shown, until its speed is beyond doubt.
inline bool is_too_fast_to_show(const TrackerConfig& config, const Radar& radar,
                                const Track& track) noexcept {
  constexpr double kToSpare = 1.2;
  return track.speed_mps() > kToSpare * speed_limit_mps(config, radar);
}

/// Confirms a track, or lets a confirmed one coast, by the scans counted: it is shown for so many
/// misses in a row. True when it has just begun to coast.
inline bool confirm_or_coast(const TrackerConfig& config, const Radar& radar, double shown_misses,
                             Track& track) noexcept {
  const bool was_seen = track.status == TrackStatus::kConfirmed;
  if (track.confirmed() || is_confirmable(config, radar, track))
    track.status =
        track.unexplained_misses > shown_misses || is_too_fast_to_show(config, radar, track)
            ? TrackStatus::kHeld
        : track.misses == 0 ? TrackStatus::kConfirmed
                            : TrackStatus::kCoasting;
  return was_seen && track.misses > 0;
}

/// Why a track is to be deleted, or `kNone`.
inline LossReason reason_to_delete(const TrackerConfig& config, const Radar& radar,
                                   const Track& track) noexcept {
  // Where another track has its plot a target may be there still: such misses count half.
  const double misses =
      track.confirmed() ? 0.5 * (track.misses + track.unexplained_misses) : track.misses;
  if (misses > allowed_misses(config, track)) return LossReason::kMissed;
  if (!track.confirmed() && track.existence < least_existence(config, track))
    return LossReason::kDoubtful;
  if (exceeds_speed(track.kinematics, speed_limit_mps(config, radar),
                    track.confirmed() ? kSpeedSigmas : 0.0))
    return LossReason::kTooFast;
  // A confirmed track is kept through a silence in which the target may move this far.
  const double run_m = radar.max_speed_mps * radar.period_s * config.coast_scans;
  const double allowed_std_m = std::max({config.drop_position_std_m, 2.0 * std::sqrt(track.plot_m2),
                                         track.confirmed() ? run_m : 0.0});
  return track.position_std_m() <= allowed_std_m ? LossReason::kNone : LossReason::kUncertain;
}

}  // namespace wakeline
