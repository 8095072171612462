// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the calls of a tracker give back, and their limits.
#pragma once

#include <cstdint>
#include <span>

#include "wakeline/core/status.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// The result of a scan. The spans are valid until the next call.
struct [[nodiscard]] ScanReport {
  Status status = Status::kOk;
  std::span<const std::int64_t>
      plot_track_id;  ///< of each plot up to `max_plots` the track it belongs to, or 0
  std::span<const Event> events;
  /// Not finite, out of range, behind the antenna, of so many turns that the bearing is lost, of
  /// another time than the scan, or beyond `max_plots`.
  int rejected_plots = 0;
};

/// The result of a report. The events are valid until the next call.
struct [[nodiscard]] ReportResult {
  Status status = Status::kOk;  ///< `kGated`: it has changed no track
  std::int64_t track_id = 0;    ///< of the track that its vessel is believed to be; 0: none
  std::span<const Event> events;
};

/// A tracker has so many radars at most.
inline constexpr int kMostRadars = 16;

/// A report or a partial scan may be so much older than the last scan.
inline constexpr double kOldestReport_s = 120.0;

}  // namespace wakeline
