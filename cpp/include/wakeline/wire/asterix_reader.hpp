// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "wakeline/wire/asterix_items.hpp"
#include "wakeline/wire/sensor_clock.hpp"

namespace wakeline {

/// What a record of a radar says.
enum class RadarRecordKind : std::uint8_t {
  kPlot = 0,    ///< a target report with a position
  kNorth = 1,   ///< the antenna passes north (034), or an update cycle starts (010)
  kSector = 2,  ///< the antenna enters a sector (034)
};

/// A plot or a mark of a rotating radar, from categories 010, 034 and 048. Numbers that the record
/// does not have are NaN.
struct RadarRecord {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  RadarRecordKind kind = RadarRecordKind::kPlot;
  std::uint8_t category = 0;
  asterix::Source source;
  double time_s = kNone;  ///< its time of day, on the day nearest to that of reception
  double range_m = kNone;
  double bearing_rad = kNone;    ///< clockwise from the radar's north; of a sector: its start
  double latitude_rad = kNone;   ///< of the target; of a mark: of the radar
  double longitude_rad = kNone;  ///< of the target; of a mark: of the radar
  double speed_mps = kNone;
  double course_rad = kNone;
  double period_s = kNone;         ///< of the antenna
  std::int32_t track_number = -1;  ///< -1 when absent
  bool test = false;               ///< a simulated or test target
};

/// What the reader has found.
enum class AsterixEvent : std::uint8_t {
  kEnd = 0,      ///< no more in these data
  kRecord = 1,   ///< see `record()`
  kProblem = 2,  ///< data that cannot be read: see `problem()`
};

/// What is wrong with a record.
enum class AsterixFault : std::uint8_t {
  kNone = 0,
  kBlockLength = 1,         ///< a block shorter than its header
  kTruncated = 2,           ///< the data end inside a block
  kFieldSpecification = 3,  ///< names undefined items
  kItemLength = 4,          ///< an item is undefined or extends past its block
};

/// The fault as text, for messages and logs.
constexpr const char* to_string(AsterixFault fault) noexcept {
  switch (fault) {
    case AsterixFault::kNone:
      return "no fault";
    case AsterixFault::kBlockLength:
      return "a data block is shorter than its header";
    case AsterixFault::kTruncated:
      return "the data end inside a data block";
    case AsterixFault::kFieldSpecification:
      return "a field specification is too long";
    case AsterixFault::kItemLength:
      return "an item is undefined or extends past its data block";
  }
  return "unknown";
}

/// A fault, where it is, what was expected and what was found.
struct AsterixProblem {
  AsterixFault fault = AsterixFault::kNone;
  std::size_t offset = 0;  ///< of the faulty block or record
  unsigned category = 0;
  const char* item = "";   ///< the faulty item, if any
  std::size_t wanted = 0;  ///< octets
  std::size_t came = 0;    ///< octets
};

/// Reads datagrams of ASTERIX categories 010, 034 and 048, record by record; never allocates, never
/// throws.
///
///     AsterixReader reader;
///     reader.feed(datagram, received_s);
///     for (auto event = reader.next(); event != AsterixEvent::kEnd; event = reader.next())
///       if (event == AsterixEvent::kRecord) take(reader.record());
///
/// Blocks of other categories are skipped and counted, as are records that are neither a plot with
/// a position nor a mark (status messages, tracks without detection). After a record that cannot be
/// split, the rest of its block is skipped, as its end is unknown.
class AsterixReader {
 public:
  /// A datagram, which must live until the next `feed`, and its time of reception.
  void feed(asterix::Octets datagram, double received_s) noexcept {
    data_ = datagram;
    received_s_ = received_s;
    at_ = block_end_ = 0;
  }

  /// Advances to the next record or problem.
  AsterixEvent next() noexcept {
    for (;;) {
      if (at_ == block_end_) {
        if (at_ == data_.size()) return AsterixEvent::kEnd;
        if (!enter_block()) return AsterixEvent::kProblem;
        continue;
      }
      const asterix::Octets rest = data_.subspan(at_, block_end_ - at_);
      asterix::Split found;
      bool wanted = false;
      record_ = {};
      record_.category = static_cast<std::uint8_t>(category_);
      if (category_ == asterix::cat048::kCategory)
        wanted = read(rest, asterix::cat048::kForms, found, &AsterixReader::target_048);
      else if (category_ == asterix::cat034::kCategory)
        wanted = read(rest, asterix::cat034::kForms, found, &AsterixReader::service_034);
      else
        wanted = read(rest, asterix::cat010::kForms, found, &AsterixReader::target_010);
      if (found.flaw != asterix::Flaw::kNone) {
        const auto fault = found.flaw == asterix::Flaw::kSpecification
                               ? AsterixFault::kFieldSpecification
                               : AsterixFault::kItemLength;
        problem_ = {fault, at_, category_, found.item, found.wanted, found.came};
        at_ = block_end_;
        return AsterixEvent::kProblem;
      }
      at_ += found.octets;
      if (wanted) return AsterixEvent::kRecord;
      ++other_records_;
    }
  }

  [[nodiscard]] const RadarRecord& record() const noexcept { return record_; }
  [[nodiscard]] const AsterixProblem& problem() const noexcept { return problem_; }
  /// Number of blocks of other categories so far.
  [[nodiscard]] std::uint64_t other_blocks() const noexcept { return other_blocks_; }
  /// Number of records so far that are neither plots nor marks.
  [[nodiscard]] std::uint64_t other_records() const noexcept { return other_records_; }

 private:
  using Octets = asterix::Octets;
  using Items = std::span<const Octets>;
  static constexpr std::size_t kMostItems = 28;

  bool enter_block() noexcept {
    using namespace asterix;
    const std::size_t left = data_.size() - at_;
    const auto fail = [&](AsterixFault fault, std::size_t wanted, std::size_t came) {
      problem_ = {fault, at_, category_, "", wanted, came};
      at_ = block_end_ = data_.size();
      return false;
    };
    category_ = std::to_integer<unsigned>(data_[at_]);
    if (left < kBlockHeader) return fail(AsterixFault::kTruncated, kBlockHeader, left);
    const auto length = static_cast<std::size_t>(number(data_.subspan(at_ + 1, 2)));
    if (length < kBlockHeader) return fail(AsterixFault::kBlockLength, kBlockHeader, length);
    if (length > left) return fail(AsterixFault::kTruncated, length, left);
    block_end_ = at_ + length;
    const bool known = category_ == cat010::kCategory || category_ == cat034::kCategory ||
                       category_ == cat048::kCategory;
    at_ = known ? at_ + kBlockHeader : block_end_;
    if (!known) ++other_blocks_;
    return true;
  }

  /// Splits a record and interprets it; whether it is a plot or a mark.
  bool read(Octets rest, std::span<const asterix::ItemForm> forms, asterix::Split& found,
            bool (AsterixReader::*interpret)(Items) noexcept) noexcept {
    std::array<Octets, kMostItems> items{};
    found = asterix::split(forms, rest, std::span(items).first(forms.size()));
    return found.flaw == asterix::Flaw::kNone && (this->*interpret)(items);
  }

  bool target_048(Items items) noexcept {
    using namespace asterix::cat048;
    read_source(items[kSource]);
    read_time(items[kTimeOfDay]);
    const unsigned descriptor = octet(items[kDescriptor], 0);
    if (!items[kDescriptor].empty() && descriptor >> 5 == 0) return false;  // TYP: no detection
    record_.test = (descriptor & 0x10) != 0 || (octet(items[kDescriptor], 1) & 0x80) != 0;
    read_polar(items[kPolar], asterix::kNauticalMile / 256);
    if (items[kPolar].empty()) read_cartesian(items[kCartesian], asterix::kNauticalMile / 128);
    read_track(items[kTrackNumber], items[kVelocityPolar]);
    return !std::isnan(record_.range_m);
  }

  bool service_034(Items items) noexcept {
    using namespace asterix::cat034;
    read_source(items[kSource]);
    read_time(items[kTimeOfDay]);
    if (const Octets period = items[kPeriod]; !period.empty())
      record_.period_s = static_cast<double>(asterix::number(period)) / asterix::kTicksPerSecond;
    if (const Octets sector = items[kSector]; !sector.empty())
      record_.bearing_rad = octet(sector, 0) * (2 * kPi<double> / 256);
    if (const Octets place = items[kRadarPosition]; !place.empty()) {
      constexpr double step = kPi<double> / (1 << 23);
      record_.latitude_rad = value(place.subspan(2, 3)) * step;
      record_.longitude_rad = value(place.subspan(5, 3)) * step;
    }
    const unsigned type = octet(items[kMessageType], 0);
    record_.kind = type == 1 ? RadarRecordKind::kNorth : RadarRecordKind::kSector;
    if (type == 1) record_.bearing_rad = 0.0;
    return type == 1 || (type == 2 && !std::isnan(record_.bearing_rad));
  }

  bool target_010(Items items) noexcept {
    using namespace asterix::cat010;
    read_source(items[kSource]);
    read_time(items[kTimeOfDay]);
    const unsigned type = octet(items[kMessageType], 0);
    if (type == 2) {
      record_.kind = RadarRecordKind::kNorth;
      return true;
    }
    record_.test = (octet(items[kDescriptor], 1) & 0xC0) != 0;
    read_polar(items[kPolar], 1.0);
    if (items[kPolar].empty()) read_cartesian(items[kCartesian], 1.0);
    if (const Octets place = items[kWgs84]; !place.empty()) {
      constexpr double step = kPi<double> / 2147483648.0;
      record_.latitude_rad = value(place.first(4)) * step;
      record_.longitude_rad = value(place.subspan(4, 4)) * step;
    }
    read_track(items[kTrackNumber], items[kVelocityPolar]);
    return type == 1 && !(std::isnan(record_.range_m) && std::isnan(record_.latitude_rad));
  }

  void read_source(Octets source) noexcept {
    if (!source.empty())
      record_.source = {std::to_integer<std::uint8_t>(source[0]),
                        std::to_integer<std::uint8_t>(source[1])};
  }

  void read_time(Octets ticks) noexcept {
    if (ticks.empty()) return;
    const double of_day = static_cast<double>(asterix::number(ticks)) / asterix::kTicksPerSecond;
    record_.time_s = on_nearest_day(of_day, received_s_);
  }

  void read_polar(Octets polar, double step_m) noexcept {
    if (polar.empty()) return;
    record_.range_m = static_cast<double>(asterix::number(polar.first(2))) * step_m;
    record_.bearing_rad = angle(polar.subspan(2, 2));
  }

  /// x east, y north.
  void read_cartesian(Octets xy, double step_m) noexcept {
    if (xy.empty()) return;
    const double east = value(xy.first(2)) * step_m, north = value(xy.subspan(2, 2)) * step_m;
    record_.range_m = std::hypot(north, east);
    record_.bearing_rad = compass_angle(std::atan2(east, north));
  }

  void read_track(Octets track_number, Octets velocity) noexcept {
    if (!track_number.empty())
      record_.track_number = static_cast<std::int32_t>(asterix::number(track_number) & 0xFFF);
    if (velocity.empty()) return;
    record_.speed_mps =
        static_cast<double>(asterix::number(velocity.first(2))) * asterix::kSpeedUnit;
    record_.course_rad = angle(velocity.subspan(2, 2));
  }

  /// An octet of an item, 0 where it has none.
  static unsigned octet(Octets item, std::size_t k) noexcept {
    return k < item.size() ? std::to_integer<unsigned>(item[k]) : 0;
  }
  static double value(Octets octets) noexcept {
    return static_cast<double>(asterix::signed_number(octets));
  }
  static double angle(Octets octets) noexcept {
    return static_cast<double>(asterix::number(octets)) * (2 * kPi<double> / asterix::kAzimuthTurn);
  }

  Octets data_;
  double received_s_ = 0.0;
  std::size_t at_ = 0;
  std::size_t block_end_ = 0;
  unsigned category_ = 0;
  std::uint64_t other_blocks_ = 0;
  std::uint64_t other_records_ = 0;
  RadarRecord record_;
  AsterixProblem problem_;
};

}  // namespace wakeline
