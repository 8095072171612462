// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/core/asterix.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "support/malloc_fence.hpp"
#include "wakeline/wire/asterix_feed.hpp"
#include "wakeline/wire/asterix_reader.hpp"

namespace wakeline::wire_asterix_test {
namespace {

using Bytes = std::vector<std::byte>;
constexpr double kReceived_s = 1.7e9;  // 2023-11-14 22:13:20

Bytes bytes(std::string_view hex) {
  Bytes result;
  for (std::size_t k = 0; k + 1 < hex.size(); k += 2)
    result.push_back(static_cast<std::byte>(std::stoi(std::string(hex.substr(k, 2)), nullptr, 16)));
  return result;
}

/// A block of a category with one record.
template <class Write>
Bytes block(unsigned category, std::initializer_list<std::size_t> items, Write write) {
  Bytes room(2000);
  asterix::BlockWriter writer;
  writer.begin(category, room);
  std::uint64_t bits = 0;
  for (const std::size_t item : items) bits |= std::uint64_t{1} << item;
  writer.specify(bits);
  write(writer);
  EXPECT_TRUE(writer.end());
  room.resize(writer.size());
  return room;
}

Bytes north_mark() {
  using namespace asterix::cat034;
  return block(kCategory,
               {kSource, kMessageType, kTimeOfDay, kPeriod, kConfiguration, kRadarPosition},
               [](auto& out) {
                 out.put(2, 0x1907);
                 out.put(1, 1);
                 out.put(3, 80000 * 128 + 64);
                 out.put(2, 320);
                 out.put(1, 0x94);  // COM, PSR, MDS
                 out.put(4, 0);
                 out.put(2, 0);
                 out.put(3, 1 << 21);     // 45 degrees north
                 out.put(3, -(1 << 20));  // 22.5 degrees west
               });
}

Bytes sector_mark(unsigned sector) {
  using namespace asterix::cat034;
  return block(kCategory, {kSource, kMessageType, kTimeOfDay, kSector}, [&](auto& out) {
    out.put(2, 0x1907);
    out.put(1, 2);
    out.put(3, 80001 * 128);
    out.put(1, sector);
  });
}

Bytes coastal_plot() {
  using namespace asterix::cat010;
  return block(kCategory,
               {kSource, kMessageType, kDescriptor, kTimeOfDay, kCartesian, kTrackNumber},
               [](auto& out) {
                 out.put(2, 0x1907);
                 out.put(1, 1);
                 out.put(1, 0x61);
                 out.put(1, 0x80);  // SIM
                 out.put(3, 80002 * 128);
                 out.put(2, -3000);
                 out.put(2, 4000);
                 out.put(2, 77);
               });
}

std::vector<RadarRecord> records_of(const Bytes& datagram, double received_s = kReceived_s) {
  AsterixReader reader;
  reader.feed(datagram, received_s);
  std::vector<RadarRecord> records;
  for (auto event = reader.next(); event != AsterixEvent::kEnd; event = reader.next()) {
    EXPECT_EQ(event, AsterixEvent::kRecord) << to_string(reader.problem().fault);
    if (event == AsterixEvent::kRecord) records.push_back(reader.record());
  }
  return records;
}

Bytes operator+(Bytes left, const Bytes& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

/// A report of an airport radar, SAC 25 SIC 201, with compound and repetitive items; published with
/// several decoders.
const Bytes kPublished = bytes(
    "300030fdf70219c9356d4da0c5aff1e0020005283c660c10c236d4182001c0780031bc0000400deb07b9582e410020"
    "f5");

TEST(WireAsterix, ReadsAPublishedReportOfCategory048) {
  const auto records = records_of(kPublished);
  ASSERT_EQ(records.size(), 1u);
  const RadarRecord& one = records[0];
  EXPECT_EQ(one.kind, RadarRecordKind::kPlot);
  EXPECT_EQ(one.source, (asterix::Source{25, 201}));
  EXPECT_NEAR(one.range_m, 197.68359375 * 1852.0, 1e-6);
  EXPECT_NEAR(one.bearing_rad, deg(340.13671875), 1e-12);
  EXPECT_EQ(one.track_number, 3563);
  EXPECT_NEAR(std::fmod(one.time_s, 86400.0), 27354.6015625, 1e-6);
  EXPECT_LT(std::abs(one.time_s - kReceived_s), 43200.0);
}

TEST(WireAsterix, ReadsMarks) {
  const auto records = records_of(north_mark() + sector_mark(64));
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0].kind, RadarRecordKind::kNorth);
  EXPECT_EQ(records[0].bearing_rad, 0.0);
  EXPECT_EQ(records[0].period_s, 2.5);
  EXPECT_NEAR(records[0].latitude_rad, deg(45.0), 1e-12);
  EXPECT_NEAR(records[0].longitude_rad, deg(-22.5), 1e-12);
  EXPECT_EQ(std::fmod(records[0].time_s, 86400.0), 80000.5);
  EXPECT_EQ(records[1].kind, RadarRecordKind::kSector);
  EXPECT_NEAR(records[1].bearing_rad, deg(90.0), 1e-12);
  EXPECT_TRUE(std::isnan(records[1].period_s));
}

TEST(WireAsterix, ReadsCartesianPlotsOfCategory010) {
  const auto records = records_of(coastal_plot());
  ASSERT_EQ(records.size(), 1u);
  EXPECT_EQ(records[0].range_m, 5000.0);
  EXPECT_NEAR(records[0].bearing_rad, compass_angle(std::atan2(-3000.0, 4000.0)), 1e-12);
  EXPECT_TRUE(records[0].test);
  EXPECT_EQ(records[0].track_number, 77);
}

TEST(WireAsterix, CountsWhatIsNeitherPlotNorMark) {
  AsterixReader reader;
  const Bytes other = bytes("3e000400");
  const Bytes no_detection = block(48, {0, 2}, [](auto& out) {
    out.put(2, 1);
    out.put(1, 0);
  });
  const Bytes all = other + no_detection + north_mark();
  reader.feed(all, kReceived_s);
  EXPECT_EQ(reader.next(), AsterixEvent::kRecord);
  EXPECT_EQ(reader.next(), AsterixEvent::kEnd);
  EXPECT_EQ(reader.other_blocks(), 1u);
  EXPECT_EQ(reader.other_records(), 1u);
}

TEST(WireAsterix, ContinuesAfterAFaultyBlock) {
  AsterixReader reader;
  const Bytes faulty = bytes("300008ffffffffff");
  const Bytes all = faulty + sector_mark(3);
  reader.feed(all, kReceived_s);
  EXPECT_EQ(reader.next(), AsterixEvent::kProblem);
  EXPECT_EQ(reader.problem().fault, AsterixFault::kFieldSpecification);
  EXPECT_EQ(reader.problem().offset, 3u);
  EXPECT_EQ(reader.next(), AsterixEvent::kRecord);
  EXPECT_EQ(reader.next(), AsterixEvent::kEnd);
}

TEST(WireAsterix, EveryCutIsAProblemAndNothingElse) {
  for (const Bytes& whole : {kPublished, north_mark(), coastal_plot()}) {
    for (std::size_t size = 1; size < whole.size(); ++size) {
      AsterixReader reader;
      const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      reader.feed(cut, kReceived_s);
      EXPECT_EQ(reader.next(), AsterixEvent::kProblem);
      EXPECT_EQ(reader.problem().fault, AsterixFault::kTruncated);
      EXPECT_EQ(reader.next(), AsterixEvent::kEnd);

      Bytes shorter = cut;  // the same with a length that says so: an item is cut
      if (size <= asterix::kBlockHeader) continue;
      shorter[1] = std::byte{0};
      shorter[2] = static_cast<std::byte>(size);
      reader.feed(shorter, kReceived_s);
      EXPECT_EQ(reader.next(), AsterixEvent::kProblem);
      EXPECT_EQ(reader.problem().fault, AsterixFault::kItemLength);
    }
  }
}

TEST(WireAsterix, MutatedDatagramsEndAndStayInside) {
  std::mt19937 random(7);
  const Bytes whole = kPublished + north_mark() + sector_mark(9) + coastal_plot();
  std::uniform_int_distribution<std::size_t> place(0, whole.size() - 1);
  std::uniform_int_distribution<int> octet(0, 255), count(1, 6);
  AsterixReader reader;
  std::uint64_t records = 0, problems = 0;
  for (int round = 0; round < 100'000; ++round) {
    Bytes mutated(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(place(random) + 1));
    for (int k = count(random); k > 0; --k)
      mutated[place(random) % mutated.size()] = static_cast<std::byte>(octet(random));
    mutated.shrink_to_fit();  // so that a sanitizer sees a read past the end
    reader.feed(mutated, kReceived_s);
    std::size_t events = 0;
    for (auto event = reader.next(); event != AsterixEvent::kEnd; event = reader.next()) {
      ASSERT_LE(++events, mutated.size());
      if (event == AsterixEvent::kProblem) {
        ++problems;
        ASSERT_LT(reader.problem().offset, mutated.size());
      } else {
        ++records;
        const RadarRecord& one = reader.record();
        ASSERT_TRUE(one.kind != RadarRecordKind::kPlot || one.range_m >= 0.0 ||
                    std::abs(one.latitude_rad) <= kPi<double>);
      }
    }
  }
  EXPECT_GT(records, 10'000u);
  EXPECT_GT(problems, 10'000u);
}

TEST(WireAsterix, NothingIsAllocated) {
  AsterixReader reader;
  const Bytes whole = kPublished + north_mark() + coastal_plot();
  const test::NoHeap fence;
  reader.feed(whole, kReceived_s);
  while (reader.next() != AsterixEvent::kEnd) {
  }
  EXPECT_EQ(fence.allocations(), 0);
}

TEST(WireSensorClock, TheDayIsTheNearest) {
  EXPECT_EQ(on_nearest_day(86399.0, 10 * 86400.0 + 0.5), 10 * 86400.0 - 1.0);
  EXPECT_EQ(on_nearest_day(1.0, 10 * 86400.0 - 0.5), 10 * 86400.0 + 1.0);
  EXPECT_EQ(on_nearest_day(40000.0, 40001.0), 40000.0);
}

TEST(WireSensorClock, HoldsTheOffsetOfAWrongClock) {
  SensorClock right, wrong, ahead;
  for (int k = 0; k < 20'000; ++k) {
    const double time_s = 86000.0 + k, received_s = time_s + 0.1 * (k % 7);  // across midnight
    const double of_day = std::fmod(time_s, 86400.0);
    EXPECT_EQ(right(of_day, received_s), time_s);
    const double off = wrong(std::fmod(time_s + 3 * 3600.0, 86400.0), received_s);
    EXPECT_NEAR(off, time_s, 0.7);
    const double far = ahead(std::fmod(time_s + 12 * 3600.0, 86400.0), received_s);
    EXPECT_NEAR(far, time_s, 0.7);
  }
  EXPECT_EQ(right.offset_s(), 0.0);
  EXPECT_EQ(right.changes(), 0);
  EXPECT_NEAR(wrong.offset_s(), -3 * 3600.0, 0.7);
  EXPECT_EQ(wrong.changes(), 1);
  EXPECT_EQ(ahead.changes(), 1);
  EXPECT_EQ(right(std::nan(""), 5.0), 5.0);
  for (const double time_s : {200'000.0, 200'010.0})  // it has been set right
    (void)wrong(std::fmod(time_s, 86400.0), time_s);
  EXPECT_EQ(wrong.offset_s(), 0.0);
}

TEST(WireSensorClock, DataHeldUpForSecondsKeepTheirTimes) {
  SensorClock clock;
  for (int k = 0; k < 30; ++k) EXPECT_EQ(clock(k, k + 0.1), k);
  for (int k = 30; k < 39; ++k) EXPECT_EQ(clock(k, 39.0 + 1e-3 * k), k);  // all at once
  EXPECT_EQ(clock(39.0, 39.1), 39.0);
  EXPECT_EQ(clock.changes(), 0);
  // Set back by an hour: late at first, then found again.
  for (int k = 40; k < 80; ++k)
    EXPECT_NEAR(clock(k - 3600.0, k + 0.1), k < 50 ? k - 3600.0 : k + 0.1, 1e-9);
  EXPECT_EQ(clock.changes(), 1);
  EXPECT_LE(clock(80.0 + 3600.0, 80.0), 80.0);  // nothing comes before it is sent
}

// The feeds of tracks -----------------------------------------------------------------------------

ReportedTrack track_at(std::int64_t id, double time_s, double north_m, double east_m) {
  ReportedTrack track;
  track.id = id;
  track.time_s = time_s;
  track.kinematics.mean << north_m, 5.0, east_m, -4.0;
  return track;
}

TEST(WireAsterixFeed, ACategory010TrackIsReadBackAsAPlot) {
  const LocalPlane plane({deg(63.4), deg(10.4)});
  Cat010Feed feed(plane, {.source = {7, 9}});
  ReportedTrack track = track_at(3, kReceived_s, -12'345.0, 23'456.0);
  std::vector<Bytes> datagrams;
  const auto keep = [&](asterix::Octets octets) {
    datagrams.emplace_back(octets.begin(), octets.end());
  };
  feed.update(kReceived_s, std::span(&track, 1), keep);
  ASSERT_EQ(datagrams.size(), 1u);
  const auto records = records_of(datagrams[0]);
  ASSERT_EQ(records.size(), 1u);
  EXPECT_EQ(records[0].source, (asterix::Source{7, 9}));
  EXPECT_EQ(records[0].time_s, kReceived_s);
  EXPECT_NEAR(records[0].range_m, std::hypot(12'345.0, 23'456.0), 1.0);
  EXPECT_NEAR(records[0].speed_mps, std::hypot(5.0, 4.0), 0.06);
  const GeoPoint place = plane.place(track.position());
  EXPECT_NEAR(records[0].latitude_rad, place.latitude_rad, 1e-9);
  EXPECT_NEAR(records[0].longitude_rad, place.longitude_rad, 1e-9);
  EXPECT_NEAR(records[0].course_rad,
              plane.true_course_rad(compass_angle(std::atan2(-4.0, 5.0)), place), 1e-4);
}

TEST(WireAsterixFeed, ManyTracksFillSeveralDatagrams) {
  const LocalPlane plane({deg(63.4), deg(10.4)});
  AsterixFeedConfig config;
  config.datagram_octets = 512;
  Cat062Feed feed(plane, config);
  std::vector<ReportedTrack> tracks;
  for (int k = 0; k < 1000; ++k) tracks.push_back(track_at(k + 1, 10.0, 10.0 * k, -5.0 * k));
  std::size_t octets = 0, datagrams = 0;
  const auto count = [&](asterix::Octets one) {
    EXPECT_LE(one.size(), 512u);
    EXPECT_EQ(asterix::number(one.subspan(1, 2)), one.size());
    octets += one.size() - asterix::kBlockHeader;
    ++datagrams;
  };
  feed.update(10.0, tracks, count);
  EXPECT_EQ(octets % 1000, 0u);  // each once, none cut
  EXPECT_GT(datagrams, 60u);
  feed.update(10.1, tracks, count);
  EXPECT_EQ(octets % 1000, 0u);  // nothing new, nothing sent
  const std::size_t before = octets;
  feed.update(10.2, {}, count);  // all ended
  EXPECT_GT(octets, before);
  const std::size_t ended = octets;
  feed.update(10.3, {}, count);
  EXPECT_EQ(octets, ended);
}

TEST(WireAsterixFeed, ExtremeTracksAreHeldToTheRangesOfTheFormat) {
  const LocalPlane plane({deg(-89.0), deg(179.0)});
  Cat062Feed feed(plane);
  Cat010Feed coastal(plane);
  std::vector<ReportedTrack> tracks{track_at(1, 1e9, 4e6, -4e6), track_at(2, -1e9, 0.0, 0.0),
                                    track_at(3, 0.0, std::nan(""), 0.0)};
  tracks[1].kinematics.mean << 1e5, 1e6, -1e5, -1e6;
  tracks[1].kinematics.covariance *= 1e12;
  tracks[1].has_covariance = true;
  tracks[1].turn_rate_rad_s = 1e3;
  tracks[1].age_s = 1e9;
  tracks[1].coasting = true;
  int datagrams = 0;
  const auto count = [&](asterix::Octets) { ++datagrams; };
  feed.update(1e9, tracks, count);
  coastal.update(1e9, tracks, count);
  EXPECT_EQ(datagrams, 2);
}

}  // namespace
}  // namespace wakeline::wire_asterix_test
