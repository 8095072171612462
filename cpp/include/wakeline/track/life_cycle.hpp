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

/// M of the last N scans had a plot, this one too, and existence is beyond doubt.
inline bool is_confirmable(const TrackerConfig& config, const Track& track) noexcept {
  const std::uint32_t window =
      config.confirm_window >= 32 ? ~0u : (1u << config.confirm_window) - 1u;
  return track.misses == 0 && track.existence > config.confirm_existence &&
         std::popcount(track.history & window) >= config.confirm_hits;
}

/// How many scans in a row a target may be missed before its track is deleted.
inline double allowed_misses(const TrackerConfig& config, const Track& track) noexcept {
  if (!track.confirmed()) return config.tentative_misses;
  return std::min(config.coast_scans + config.coast_scans_per_hit * track.hits,
                  double(config.coast_scans_max));
}

/// Confirms a track, or lets a confirmed one coast, by the scans counted. True when it has just
/// begun to coast.
inline bool confirm_or_coast(const TrackerConfig& config, Track& track) noexcept {
  const bool was_confirmed = track.confirmed();
  if (was_confirmed || is_confirmable(config, track))
    track.status = track.misses == 0                    ? TrackStatus::kConfirmed
                   : track.misses <= config.shown_scans ? TrackStatus::kCoasting
                                                        : TrackStatus::kHeld;
  return was_confirmed && track.misses == 1;
}

/// Whether a track is to be deleted: missed for too long, doubtful, too fast, or lost in position.
inline bool is_to_delete(const TrackerConfig& config, const Radar& radar,
                         const Track& track) noexcept {
  const bool missed = track.misses > allowed_misses(config, track);
  const bool doubtful = !track.confirmed() && track.existence < config.drop_existence;
  const bool too_fast = track.speed_mps() > config.drop_speed_factor * radar.max_speed_mps;
  // A confirmed track is kept through a silence in which the target may move this far.
  const double run_m = radar.max_speed_mps * radar.period_s * config.coast_scans;
  const double allowed_std_m = std::max({config.drop_position_std_m, 2.0 * std::sqrt(track.plot_m2),
                                         track.confirmed() ? run_m : 0.0});
  return missed || doubtful || too_fast || !(track.position_std_m() <= allowed_std_m);
}

}  // namespace wakeline
