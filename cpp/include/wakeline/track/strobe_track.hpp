// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/gating/strobe_echo.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// A strobe: where and when an echo is expected.
struct Strobe {
  Vec<double, 2> centre_m = Vec<double, 2>::Zero();  ///< [north, east]
  double radius_m = 0.0;
  double time_s = -std::numeric_limits<double>::infinity();  ///< when the beam passes the centre

  void archive(Archive& fields) {
    fields(centre_m);
    fields(radius_m);
    fields(time_s);
  }
};

/// What a `StrobeTracker` knows of a vessel, besides the estimator that follows its motion.
struct StrobeTrack {
  int slot = 0;  ///< place in the tracker's memory, as long as the track lives
  std::int64_t id = 0;
  std::int64_t tentative_id = 0;
  TrackStatus status = TrackStatus::kTentative;
  double time_s = 0.0;          ///< of the estimate: when the beam last passed the vessel
  Gaussian<4> kinematics = {};  ///< of the estimate, `[x, vx, y, vy]`
  double nis = std::numeric_limits<double>::quiet_NaN();  ///< of the last echo
  int hits = 0;                                           ///< turns with an echo
  int misses = 0;                                         ///< turns in a row without one
  Strobe strobe = {};                                     ///< the one that the beam will pass next
  Strobe last = {};                                       ///< the one read last

  // Angles of the beam, unwrapped
  double pass_rad = 0.0;  ///< at which it passes the centre of the strobe
  double from_rad = 0.0;  ///< from which on sweeps may reach it
  double due_rad = 0.0;   ///< at which it has passed it

  [[nodiscard]] bool confirmed() const noexcept { return status != TrackStatus::kTentative; }
  [[nodiscard]] Vec<double, 2> position() const noexcept {
    return {kinematics.mean[0], kinematics.mean[2]};
  }
  [[nodiscard]] double speed_mps() const noexcept {
    return std::hypot(kinematics.mean[1], kinematics.mean[3]);
  }

  /// The one of its strobes that was or will be read nearest to a time.
  [[nodiscard]] const Strobe& strobe_at(double at_s) const noexcept {
    return std::abs(last.time_s - at_s) < std::abs(strobe.time_s - at_s) ? last : strobe;
  }

  /// Saves or restores all but the slot.
  void archive(Archive& fields) {
    fields(id);
    fields(tentative_id);
    fields(status);
    fields(time_s);
    fields(kinematics.mean);
    fields(kinematics.covariance);
    fields(nis);
    fields(hits);
    fields(misses);
    strobe.archive(fields);
    last.archive(fields);
    fields(pass_rad);
    fields(from_rad);
    fields(due_rad);
  }
};

/// What was found in a strobe.
struct StrobeReading {
  std::int64_t track_id;       ///< as of now: positive from the turn on in which it was confirmed
  double time_s;               ///< when the beam passed the echo, or else the centre
  Vec<double, 2> predicted_m;  ///< centre of the strobe, [north, east]
  double radius_m;
  StrobeEcho echo;         ///< range and bearing as the radar measures them
  Gaussian<2> position_m;  ///< of the echo, [north, east]; NaN without one
  bool fills;              ///< the echo fills the strobe
};

}  // namespace wakeline
