// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "support/draw.hpp"
#include "wakeline/track/tracker.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline {
extern template class Tracker<VesselImm>;  // compiled once, in instance_test.cpp
}

namespace wakeline::test {

using VesselTracker = Tracker<VesselImm>;

inline const Radar kTestRadar{.range_std_m = 8.0,
                              .bearing_std_rad = deg(0.5),
                              .extent_std_m = 2.0,
                              .period_s = 2.5,
                              .max_speed_mps = 25.0};

VesselTracker make_tracker(const TrackerConfig& config = {}, const Radar& radar = kTestRadar);

/// A boat on a straight course.
struct Boat {
  Vec<double, 2> start_m;
  Vec<double, 2> velocity_mps;

  [[nodiscard]] Vec<double, 2> at(double time_s) const { return start_m + time_s * velocity_mps; }
};

/// The plot of a position without any error, seen from the origin.
inline Plot exact_plot(const Vec<double, 2>& position, double time_s) {
  return {time_s, position.norm(), std::atan2(position[1], position[0])};
}

/// What a radar at the origin sees.
class Sea {
 public:
  explicit Sea(std::uint64_t seed, const Radar& radar = kTestRadar) : draw(seed), radar_(radar) {}

  /// A plot with the errors that the radar admits, at the scan's time.
  Plot plot(const Vec<double, 2>& position, double time_s) {
    Plot plot = exact_plot(position + radar_.extent_std_m * draw.normals<2>(), time_s);
    plot.range_m = std::fabs(plot.range_m + radar_.range_std_m * draw.normal());
    plot.bearing_rad += radar_.bearing_std_rad * draw.normal();
    return plot;
  }

  /// A plot of a boat at the moment when the antenna, north at the beginning of the scan, passes
  /// it.
  Plot swept(const Boat& boat, double scan_start_s) {
    double time_s = scan_start_s;
    for (int k = 0; k < 3; ++k) {
      const Vec<double, 2> p = boat.at(time_s);
      const double turn = std::atan2(p[1], p[0]) / (2 * kPi);
      time_s = scan_start_s + (turn < 0 ? turn + 1 : turn) * radar_.period_s;
    }
    return plot(boat.at(time_s), time_s);
  }

  /// A plot of nothing, anywhere in a square.
  Plot clutter(double time_s, double half_side_m) {
    return exact_plot(
        {draw.uniform(-half_side_m, half_side_m), draw.uniform(-half_side_m, half_side_m)}, time_s);
  }

  Draw draw;

 private:
  static constexpr double kPi = 3.14159265358979323846;
  Radar radar_;
};

inline std::vector<const Track*> tracks_of(const VesselTracker& tracker, bool confirmed_only) {
  std::vector<const Track*> tracks;
  tracker.for_each([&](const Track& track) {
    if (track.confirmed() || !confirmed_only) tracks.push_back(&track);
  });
  return tracks;
}

/// The confirmed track nearest to a position, and not farther than a gate; null when there is none.
inline const Track* track_at(const VesselTracker& tracker, const Vec<double, 2>& position,
                             double gate_m = 100.0) {
  const Track* nearest = nullptr;
  for (const Track* track : tracks_of(tracker, true))
    if (const double d = (track->position() - position).norm(); d < gate_m) {
      gate_m = d;
      nearest = track;
    }
  return nearest;
}

inline std::vector<Event> events_of(const ScanReport& report, TrackEvent kind) {
  std::vector<Event> events;
  for (const Event& event : report.events)
    if (event.kind == kind) events.push_back(event);
  return events;
}

/// The numbers of all tracks, by the events reported.
class Ledger {
 public:
  void note(const ScanReport& report) {
    for (const Event& event : report.events) {
      switch (event.kind) {
        case TrackEvent::kStarted:
          EXPECT_LT(event.track_id, 0);
          EXPECT_EQ(event.tentative_id, event.track_id);
          EXPECT_TRUE(ids.insert(event.track_id).second) << event.track_id << " started twice";
          break;
        case TrackEvent::kConfirmed:
          EXPECT_GT(event.track_id, 0);
          EXPECT_EQ(ids.erase(event.tentative_id), 1u) << event.tentative_id << " was not known";
          EXPECT_TRUE(ids.insert(event.track_id).second) << event.track_id << " confirmed twice";
          break;
        case TrackEvent::kCoasting:
          EXPECT_TRUE(ids.contains(event.track_id)) << event.track_id;
          EXPECT_GT(event.track_id, 0);
          break;
        case TrackEvent::kLost:
          EXPECT_EQ(ids.erase(event.track_id), 1u) << event.track_id << " was not known";
          break;
        case TrackEvent::kFull:
          EXPECT_EQ(event.track_id, 0);
          break;
        default:
          EXPECT_TRUE(event.track_id == 0 || ids.contains(event.track_id)) << event.track_id;
          break;
      }
      EXPECT_EQ(event.reason != LossReason::kNone, event.kind == TrackEvent::kLost)
          << to_string(event.kind) << " for the reason " << to_string(event.reason);
    }
  }

  std::set<std::int64_t> ids;
};

inline std::set<std::int64_t> ids_of(const VesselTracker& tracker) {
  std::set<std::int64_t> ids;
  tracker.for_each([&](const Track& track) { ids.insert(track.id); });
  return ids;
}

/// Every number of every track makes sense.
inline void expect_sound(const VesselTracker& tracker) {
  tracker.for_each([&](const Track& track) {
    EXPECT_TRUE(is_finite(track.kinematics.mean)) << track.id;
    EXPECT_TRUE(is_covariance(track.kinematics.covariance)) << track.id << "\n"
                                                            << track.kinematics.covariance;
    EXPECT_TRUE(track.existence >= 0.0 && track.existence <= 1.0) << track.existence;
    const double visibility = tracker.visibility(track);
    EXPECT_TRUE(visibility >= 0.0 && visibility <= 1.0) << visibility;
    EXPECT_TRUE(std::isnan(track.nis) || (track.nis >= 0.0 && std::isfinite(track.nis)))
        << track.nis;
    EXPECT_TRUE(std::isfinite(track.time_s));
    const auto& mode_probability = tracker.estimator_of(track).mode_probability();
    EXPECT_NEAR(mode_probability.sum(), 1.0, 1e-9);
    EXPECT_GE(mode_probability.minCoeff(), 0.0);
    EXPECT_GE(track.scans, track.hits);
    EXPECT_EQ(track.id > 0, track.confirmed());
  });
}

}  // namespace wakeline::test
