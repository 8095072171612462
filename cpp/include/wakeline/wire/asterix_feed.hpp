// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Tracks as ASTERIX: category 062 (system tracks) and 010 (tracks of a coastal radar).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "wakeline/navigation/geodesy.hpp"
#include "wakeline/wire/asterix_items.hpp"
#include "wakeline/wire/reported_track.hpp"

namespace wakeline {

/// Who sends tracks as ASTERIX, and how.
struct AsterixFeedConfig {
  asterix::Source source;
  std::uint8_t service = 1;            ///< I062/015
  bool several_radars = false;         ///< I062/080 MON is 0
  double interval_s = 0.0;             ///< least time between reports of a track
  double hold_off_s = 60.0;            ///< rest of a number
  std::size_t datagram_octets = 1400;  ///< octets at most
};

namespace asterix {

/// A turn rate above which a track is reported as turning.
inline constexpr double kTurning_rad_s = deg(0.3);

/// A number of steps within [low, high]; a larger magnitude becomes the limit.
inline std::int64_t steps(double value, double step, double low, double high) noexcept {
  return std::llround(std::clamp(value / step, low, high));
}
inline std::int64_t signed_steps(double value, double step, int bits) noexcept {
  const double most = std::ldexp(1.0, bits - 1);
  return steps(value, step, -most, most - 1.0);
}
inline std::int64_t unsigned_steps(double value, double step, int bits) noexcept {
  return steps(value, step, 0.0, std::ldexp(1.0, bits) - 1.0);
}

/// What a record says of a track.
struct TrackRecord {
  const AsterixFeedConfig& config;
  const LocalPlane& plane;
  const ReportedTrack& track;
  ReportTurn turn;

  [[nodiscard]] GeoPoint place() const noexcept { return plane.place(track.position()); }
  [[nodiscard]] double std_of(int component) const noexcept {
    return std::sqrt(std::max(track.kinematics.covariance(component, component), 0.0));
  }
};

/// Latitude and longitude as steps of pi / 2^bits rad, 4 octets each.
inline void put_place(BlockWriter& block, const GeoPoint& place, int bits) noexcept {
  const double step = std::ldexp(kPi<double>, -bits);
  block.put(4, signed_steps(place.latitude_rad, step, 32));
  block.put(4, signed_steps(wrap_angle(place.longitude_rad), step, 32));
}

/// Eight characters of six bits: capital letters, digits and spaces.
inline std::uint64_t six_bit_text(std::string_view text) noexcept {
  std::uint64_t code = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    char letter = k < text.size() ? text[k] : ' ';
    if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
    const bool digit = letter >= '0' && letter <= '9', capital = letter >= 'A' && letter <= 'Z';
    const unsigned six = capital ? static_cast<unsigned>(letter - 'A' + 1)
                                 : static_cast<unsigned>(digit ? letter : ' ');
    code = code << 6 | six;
  }
  return code;
}

/// Category 062: I062/010, 015, 070, 105, 100, 185, 245 (of a named track), 040, 080, 290 (age of
/// the last plot, if known), 200 and 500 (if the covariance is known); of one that is being
/// acquired neither 185 nor 500. Cartesian positions and
/// velocities are in the plane of the feed, x east.
struct Cat062 {
  static constexpr unsigned kCategory = cat062::kCategory;
  static constexpr int kNumbers = 65536;

  static void write(BlockWriter& block, const TrackRecord& record) noexcept {
    using namespace cat062;
    const ReportedTrack& track = record.track;
    const auto& mean = track.kinematics.mean;
    const bool named = !track.label().empty(), aged = std::isfinite(track.age_s);
    const bool moves = !track.acquiring, rated = moves && track.has_covariance;
    const auto bit = [](Item item, bool present = true) { return std::uint64_t{present} << item; };
    block.specify(bit(kSource) | bit(kService) | bit(kTimeOfDay) | bit(kWgs84) | bit(kCartesian) |
                  bit(kVelocity, moves) | bit(kIdentification, named) | bit(kTrackNumber) |
                  bit(kTrackStatus) | bit(kUpdateAges, aged) | bit(kModeOfMovement) |
                  bit(kAccuracies, rated));
    block.put(1, record.config.source.area);
    block.put(1, record.config.source.system);
    block.put(1, record.config.service);
    block.put(3, day_ticks(track.time_s));
    put_place(block, record.place(), 25);
    block.put(3, signed_steps(mean[2], 0.5, 24));
    block.put(3, signed_steps(mean[0], 0.5, 24));
    if (moves) {
      block.put(2, signed_steps(mean[3], 0.25, 16));
      block.put(2, signed_steps(mean[1], 0.25, 16));
    }
    if (named) {
      block.put(1, 0x40);  // STI: not downlinked from the target
      block.put(6, six_bit_text(track.label()));
    }
    block.put(2, record.turn.number);
    put_status(block, record);
    if (aged) {
      block.put(1, 0x40);  // PSR
      block.put(1, unsigned_steps(track.age_s, 0.25, 8));
    }
    block.put(1, movement(track.turn_rate_rad_s));
    if (rated) put_accuracies(block, record);
  }

 private:
  /// MON and CNF, then TSE and TSB, then, of a coasting track, CST and PSR in the fourth octet.
  static void put_status(BlockWriter& block, const TrackRecord& record) noexcept {
    const bool coasting = record.track.coasting;
    block.put(
        1, (record.config.several_radars ? 0x00 : 0x80) | (record.track.acquiring ? 0x02 : 0) | 1);
    block.put(1,
              (record.turn.last ? 0x40 : 0) | (record.turn.first ? 0x20 : 0) | (coasting ? 1 : 0));
    if (!coasting) return;
    block.put(1, 1);
    block.put(1, 0xC0);
  }

  /// TRANS: constant, right, left or undetermined; LONG: undetermined.
  static unsigned movement(double turn_rate_rad_s) noexcept {
    const unsigned turn = std::isnan(turn_rate_rad_s)         ? 3
                          : turn_rate_rad_s > kTurning_rad_s  ? 1
                          : turn_rate_rad_s < -kTurning_rad_s ? 2
                                                              : 0;
    return turn << 6 | 3u << 4;
  }

  /// APC, COV and ATV.
  static void put_accuracies(BlockWriter& block, const TrackRecord& record) noexcept {
    block.put(1, 0xC4);
    block.put(2, unsigned_steps(record.std_of(2), 0.5, 16));
    block.put(2, unsigned_steps(record.std_of(0), 0.5, 16));
    const double covariance = record.track.kinematics.covariance(0, 2);
    block.put(2, signed_steps(std::copysign(std::sqrt(std::abs(covariance)), covariance), 0.5, 16));
    block.put(1, unsigned_steps(record.std_of(3), 0.25, 8));
    block.put(1, unsigned_steps(record.std_of(1), 0.25, 8));
  }
};

/// Category 010: I010/010, 000, 020 (primary radar), 140, 041, 042 (within 32 km), 200, 161, 170
/// and 500 (if the covariance is known). The velocity is I010/200, as readers disagree on the unit
/// of I010/202.
struct Cat010 {
  static constexpr unsigned kCategory = cat010::kCategory;
  static constexpr int kNumbers = 4096;

  static void write(BlockWriter& block, const TrackRecord& record) noexcept {
    using namespace cat010;
    const ReportedTrack& track = record.track;
    const auto& mean = track.kinematics.mean;
    const bool fits = std::max(std::abs(mean[0]), std::abs(mean[2])) < 32767.0;
    const auto bit = [](Item item, bool present = true) { return std::uint64_t{present} << item; };
    block.specify(bit(kSource) | bit(kMessageType) | bit(kDescriptor) | bit(kTimeOfDay) |
                  bit(kWgs84) | bit(kCartesian, fits) | bit(kVelocityPolar, !track.acquiring) |
                  bit(kTrackNumber) | bit(kTrackStatus) | bit(kDeviation, track.has_covariance));
    block.put(1, record.config.source.area);
    block.put(1, record.config.source.system);
    block.put(1, 1);     // target report
    block.put(1, 0x60);  // TYP: primary radar
    block.put(3, day_ticks(track.time_s));
    const GeoPoint place = record.place();
    put_place(block, place, 31);
    if (fits) {
      block.put(2, signed_steps(mean[2], 1.0, 16));
      block.put(2, signed_steps(mean[0], 1.0, 16));
    }
    if (!track.acquiring) {
      const double course_rad = std::atan2(mean[3], mean[1]);
      block.put(2, unsigned_steps(track.velocity().norm(), kSpeedUnit, 16));
      block.put(2, azimuth_steps(record.plane.true_course_rad(course_rad, place)));
    }
    block.put(2, record.turn.number);
    const bool turning = std::abs(track.turn_rate_rad_s) > kTurning_rad_s;
    block.put(1, (track.acquiring ? 0x80 : 0) | (record.turn.last ? 0x40 : 0) |
                     (track.coasting ? 0x30 : 0) | (turning ? 0x08 : 0) |
                     0x02);  // CNF, TRE, CST, MAH, STH: smoothed
    if (!track.has_covariance) return;
    block.put(1, unsigned_steps(record.std_of(2), 0.25, 8));
    block.put(1, unsigned_steps(record.std_of(0), 0.25, 8));
    block.put(2, signed_steps(track.kinematics.covariance(0, 2), 0.25, 16));
  }
};

}  // namespace asterix

/// Sends tracks as datagrams of one ASTERIX category, `asterix::Cat062` or `asterix::Cat010`.
///
/// Estimates are sent with their own time. The first report of a track and, once, the last one are
/// marked (TSB, TSE; in category 010 TRE). See `ReportSchedule` for when a track is due.
template <class Format>
class AsterixFeed {
 public:
  /// `plane` has the positions of the tracks. Throws `std::invalid_argument` when an interval is
  /// negative or a datagram shorter than 128 octets.
  explicit AsterixFeed(const LocalPlane& plane, const AsterixFeedConfig& config = {})
      : plane_(plane),
        config_(config),
        schedule_(Format::kNumbers, config.interval_s, config.hold_off_s) {
    require(config.datagram_octets >= 128 && config.datagram_octets <= kRoom, "datagram_octets",
            "128 to 8192", static_cast<double>(config.datagram_octets));
  }

  /// Calls `sink(octets)` for each datagram of what is due. `tracks` are all that are shown.
  template <class Sink>
  void update(double time_s, std::span<const ReportedTrack> tracks, Sink&& sink) noexcept {
    const std::span<std::byte> room = std::span(room_).first(config_.datagram_octets);
    block_.begin(Format::kCategory, room);
    const auto flush = [&] {
      if (block_.size() > asterix::kBlockHeader && block_.end())
        sink(asterix::Octets(room.first(block_.size())));
      block_.begin(Format::kCategory, room);
    };
    schedule_.update(time_s, tracks, [&](const ReportedTrack& track, const ReportTurn& turn) {
      const asterix::TrackRecord record{config_, plane_, track, turn};
      const std::size_t before = block_.size();
      Format::write(block_, record);
      if (block_.fits()) return;
      block_.cut(before);
      flush();
      Format::write(block_, record);
    });
    flush();
  }

  [[nodiscard]] const LocalPlane& plane() const noexcept { return plane_; }
  [[nodiscard]] const AsterixFeedConfig& config() const noexcept { return config_; }
  [[nodiscard]] const ReportSchedule& schedule() const noexcept { return schedule_; }
  void archive(Archive& fields) { schedule_.archive(fields); }

 private:
  static constexpr std::size_t kRoom = 8192;

  LocalPlane plane_;
  AsterixFeedConfig config_;
  ReportSchedule schedule_;
  asterix::BlockWriter block_;
  std::array<std::byte, kRoom> room_{};
};

using Cat062Feed = AsterixFeed<asterix::Cat062>;
using Cat010Feed = AsterixFeed<asterix::Cat010>;

}  // namespace wakeline
