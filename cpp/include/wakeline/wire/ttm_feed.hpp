// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "wakeline/core/require.hpp"
#include "wakeline/measurement/own_ship.hpp"
#include "wakeline/navigation/geodesy.hpp"
#include "wakeline/wire/nmea.hpp"
#include "wakeline/wire/reported_track.hpp"

namespace wakeline {

/// Distance and time of the closest approach of two vessels on straight courses; the time is NaN,
/// and the distance the one now, where their relative speed is below 0.05 m/s.
inline std::pair<double, double> straight_approach(const Vec<double, 2>& position_m,
                                                   const Vec<double, 2>& velocity_mps) noexcept {
  const double speed2 = velocity_mps.squaredNorm();
  if (!(speed2 > 0.05 * 0.05)) return {position_m.norm(), NAN};
  const double tcpa_s = -position_m.dot(velocity_mps) / speed2;
  return {(position_m + tcpa_s * velocity_mps).norm(), tcpa_s};
}

/// Sends tracks as NMEA 0183: OSD, then a TTM for each target that is due.
///
/// Readers such as OpenCPN put a target at range and bearing from the position of own ship that
/// they have when the sentence arrives. So targets are predicted, at constant velocity, to the time
/// of sending and referred to `own`, which should be the fix that the reader has. Directions are
/// true. A target has a number 0-99 for life; `L` is sent once; the number then rests for
/// `hold_off_s`. See `ReportSchedule` for when a target is due.
class TtmFeed {
 public:
  static constexpr int kNumbers = 100;

  /// Talker, numbers and intervals of the sentences.
  struct Config {
    std::string talker = "RA";  ///< two letters
    double interval_s =
        3.0;  ///< least time between sentences of a target; the period of a slower antenna
    double hold_off_s = 60.0;  ///< rest of a number
    bool tll = false;          ///< send TLL instead of TTM
  };

  /// `plane` has the positions of the tracks. Throws `std::invalid_argument` when a talker is not
  /// two capital letters or an interval is negative.
  TtmFeed(const LocalPlane& plane, const Config& config)
      : plane_(plane), config_(config), schedule_(kNumbers, config.interval_s, config.hold_off_s) {
    const auto capital = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); };
    if (config.talker.size() != 2 || !capital(config.talker[0]) || !capital(config.talker[1]))
      reject("talker must be two capital letters or digits, got \"" + config.talker + "\"");
  }
  explicit TtmFeed(const LocalPlane& plane) : TtmFeed(plane, Config{}) {}

  /// Calls `sink(sentence)`, with carriage return and line feed, for what is due. `tracks` are all
  /// that are shown; `own` is own ship in the plane, `heading_rad` its true heading, NaN when
  /// unknown or old. What needs the velocity of own ship is empty where that is not known.
  template <class Sink>
  void update(double time_s, const OwnShip& own, double heading_rad,
              std::span<const ReportedTrack> tracks, Sink&& sink,
              bool own_velocity_known = true) noexcept {
    const GeoPoint place = plane_.place(own.position<double>());
    bool osd_sent = false;
    schedule_.update(time_s, tracks, [&](const ReportedTrack& track, const ReportTurn& turn) {
      NmeaSentence sentence;
      const NmeaTarget target = describe(time_s, own, place, own_velocity_known, track, turn);
      const std::string_view text = config_.tll ? write_tll(sentence, config_.talker, target)
                                                : write_ttm(sentence, config_.talker, target);
      if (text.empty()) return;
      if (!std::exchange(osd_sent, true))
        sink(write_own(own, place, heading_rad, own_velocity_known));
      sink(text);
    });
  }

  [[nodiscard]] const LocalPlane& plane() const noexcept { return plane_; }
  [[nodiscard]] const Config& config() const noexcept { return config_; }
  [[nodiscard]] const ReportSchedule& schedule() const noexcept { return schedule_; }
  void archive(Archive& fields) { schedule_.archive(fields); }

 private:
  [[nodiscard]] NmeaTarget describe(double time_s, const OwnShip& own, const GeoPoint& own_place,
                                    bool own_velocity_known, const ReportedTrack& track,
                                    const ReportTurn& turn) const noexcept {
    const Vec<double, 2> velocity = track.velocity();
    const Vec<double, 2> position = track.position() + (time_s - track.time_s) * velocity;
    NmeaTarget target;
    target.number = turn.number;
    target.place = plane_.place(position);
    const GeoLine line = geodesic(own_place, target.place);
    target.range_m = line.distance_m;
    target.bearing_rad = line.course_rad;
    if (!track.acquiring) {
      target.speed_mps = velocity.norm();
      target.course_rad =
          plane_.true_course_rad(std::atan2(velocity[1], velocity[0]), target.place);
      if (own_velocity_known)
        std::tie(target.cpa_m, target.tcpa_s) =
            straight_approach(position - own.position<double>(), velocity - own.velocity<double>());
    }
    target.acquiring = track.acquiring;
    target.manual = track.manual;
    target.name = track.label();
    target.lost = turn.last;
    target.time_s = time_s;
    return target;
  }

  std::string_view write_own(const OwnShip& own, const GeoPoint& place, double heading_rad,
                             bool velocity_known) noexcept {
    NmeaOwnShip ship;
    const Vec<double, 2> velocity = own.velocity<double>();
    ship.heading_rad = heading_rad;
    if (velocity_known) ship.speed_mps = velocity.norm();
    if (ship.speed_mps > 0.05)
      ship.course_rad = plane_.true_course_rad(std::atan2(velocity[1], velocity[0]), place);
    return write_osd(own_sentence_, config_.talker, ship);
  }

  LocalPlane plane_;
  Config config_;
  ReportSchedule schedule_;
  NmeaSentence own_sentence_;
};

}  // namespace wakeline
