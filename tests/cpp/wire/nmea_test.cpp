// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/wire/nmea.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "support/malloc_fence.hpp"
#include "wakeline/wire/ttm_feed.hpp"

namespace wakeline::wire_nmea_test {
namespace {

std::vector<std::string> fields_of(std::string_view sentence) {
  EXPECT_EQ(sentence.front(), '$');
  EXPECT_LE(sentence.size(), 82u);
  EXPECT_EQ(sentence.substr(sentence.size() - 2), "\r\n");
  const std::size_t star = sentence.find('*');
  unsigned sum = 0;
  for (std::size_t k = 1; k < star; ++k) sum ^= static_cast<unsigned char>(sentence[k]);
  EXPECT_EQ(std::stoul(std::string(sentence.substr(star + 1, 2)), nullptr, 16), sum);
  std::vector<std::string> fields(1);
  for (const char letter : sentence.substr(1, star - 1)) {
    if (letter == ',')
      fields.emplace_back();
    else
      fields.back() += letter;
  }
  return fields;
}

NmeaTarget target() {
  return {.number = 7,
          .range_m = 1852.0 * 4.2904,
          .bearing_rad = deg(155.9),
          .place = {deg(-58.5), deg(-11.25)},
          .speed_mps = knots(0.34),
          .course_rad = deg(74.7),
          .cpa_m = 1852.0 * 1.07,
          .tcpa_s = -60 * 76.4,
          .name = "tug",
          .time_s = 7 * 3600.0 + 40 * 60.0 + 51.0};
}

TEST(WireNmea, TtmHasItsFields) {
  NmeaSentence room;
  const auto fields = fields_of(write_ttm(room, "RA", target()));
  EXPECT_EQ(fields,
            (std::vector<std::string>{"RATTM", "07", "4.290", "155.900", "T", "0.3", "074.7", "T",
                                      "1.07", "-76.4", "N", "tug", "T", "", "074051.00", "A"}));
}

TEST(WireNmea, TllHasItsFields) {
  NmeaSentence room;
  const auto fields = fields_of(write_tll(room, "RA", target()));
  EXPECT_EQ(fields, (std::vector<std::string>{"RATLL", "07", "5830.00000", "S", "01115.00000", "W",
                                              "tug", "074051.00", "T", ""}));
}

TEST(WireNmea, OsdSaysWhatIsNotValid) {
  NmeaSentence room;
  EXPECT_EQ(
      fields_of(write_osd(room, "RA", {deg(359.96), deg(10.0), knots(12.0)})),
      (std::vector<std::string>{"RAOSD", "000.0", "A", "010.0", "P", "12.0", "P", "", "", "N"}));
  EXPECT_EQ(fields_of(write_osd(room, "II", {})),
            (std::vector<std::string>{"IIOSD", "", "V", "", "", "", "", "", "", "N"}));
}

TEST(WireNmea, AnglesAndTimesWrapAfterRounding) {
  NmeaSentence room;
  NmeaTarget one = target();
  one.bearing_rad = deg(359.9999);
  one.course_rad = deg(-0.01);
  one.time_s = 86399.996;
  one.place = {deg(59.9999999999), deg(-179.9999999999)};
  const auto ttm = fields_of(write_ttm(room, "RA", one));
  EXPECT_EQ(ttm[3], "000.000");
  EXPECT_EQ(ttm[6], "000.0");
  EXPECT_EQ(ttm[14], "000000.00");
  const auto tll = fields_of(write_tll(room, "RA", one));
  EXPECT_EQ(tll[2], "6000.00000");
  EXPECT_EQ(tll[4], "18000.00000");
}

TEST(WireNmea, NoRangeMeansLostToAReader) {
  NmeaSentence room;
  NmeaTarget one = target();
  one.range_m = 0.0;
  EXPECT_EQ(fields_of(write_ttm(room, "RA", one))[2], "0.001");
}

TEST(WireNmea, AnyTargetFitsOrGivesNoSentence) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> magnitude(-3.0, 9.0), sign(-1.0, 1.0);
  std::uniform_int_distribution<int> letter(0, 255), length(0, 60), number(0, 99);
  const auto any = [&] { return std::copysign(std::pow(10.0, magnitude(random)), sign(random)); };
  NmeaSentence room;
  int sent = 0;
  for (int round = 0; round < 50'000; ++round) {
    std::string name;
    for (int k = length(random); k > 0; --k) name += static_cast<char>(letter(random));
    const NmeaTarget one{number(random), any(),          any(), {any() / 1e9, any() / 1e9},
                         any(),          any(),          any(), any(),
                         name,           round % 2 == 0, any()};
    for (const std::string_view text : {write_ttm(room, "RA", one), write_tll(room, "RA", one)}) {
      if (text.empty()) continue;
      ++sent;
      const auto fields = fields_of(text);
      ASSERT_EQ(fields.size(), fields[0] == "RATTM" ? 16u : 10u);
    }
  }
  EXPECT_GT(sent, 30'000);
}

TEST(WireNmea, AWrongTalkerIsRejected) {
  const LocalPlane plane({0.0, 0.0});
  for (const char* talker : {"", "R", "ra", "RAX", "R,"})
    EXPECT_THROW(TtmFeed(plane, {.talker = talker}), std::invalid_argument) << talker;
  EXPECT_THROW(TtmFeed(plane, {.interval_s = -1.0}), std::invalid_argument);
}

/// Hours of traffic in which tracks come and go, some for a second, more at once than there are
/// numbers.
TEST(WireTtmFeed, ATargetHasOneNumberForLifeAndIsLostOnce) {
  const LocalPlane plane({deg(50.0), deg(-1.0)});
  TtmFeed feed(plane);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform;
  std::map<std::int64_t, double> ends_s;  // of the tracks that live
  std::vector<ReportedTrack> tracks;
  std::map<std::string, std::string> holder;      // number -> name
  std::map<std::string, double> freed_s, last_s;  // by number
  std::set<std::string> lost;
  std::int64_t next_id = 1;
  int sentences = 0, most = 0;
  for (double time_s = 0.0; time_s < 2 * 3600.0; time_s += 0.625) {  // quarters of a turn of 2.5 s
    std::erase_if(ends_s, [&](const auto& one) { return one.second < time_s; });
    if (uniform(random) < 0.25 && ends_s.size() < 150)
      ends_s[next_id++] = time_s - std::log(uniform(random)) * 500.0;
    tracks.clear();
    for (const auto& [id, end_s] : ends_s) {
      ReportedTrack track;
      track.id = id;
      track.time_s = std::floor((time_s - 0.01 * double(id % 250)) / 2.5) * 2.5;
      track.kinematics.mean << 100.0 * double(id % 90), 5.0, 2000.0, 0.0;
      track.set_name("t" + std::to_string(id));
      tracks.push_back(track);
    }
    feed.update(time_s, {}, NAN, tracks, [&](std::string_view text) {
      const auto fields = fields_of(text);
      if (fields[0] == "RAOSD") return;
      ++sentences;
      const std::string &number = fields[1], &name = fields[11];
      EXPECT_FALSE(lost.contains(name)) << "a lost target again";
      if (holder[number].empty()) {
        if (freed_s.contains(number)) {
          EXPECT_GE(time_s - freed_s[number], 60.0);
        }
        holder[number] = name;
      } else {
        EXPECT_EQ(holder[number], name);
        if (fields[12] == "T") {
          EXPECT_GE(time_s - last_s[number], 3.0);
        }
      }
      last_s[number] = time_s;
      if (fields[12] != "L") return;
      lost.insert(name);
      freed_s[number] = time_s;
      holder[number].clear();
    });
    most = std::max(most, feed.schedule().waiting());
  }
  EXPECT_GT(lost.size(), 300u);
  EXPECT_GT(sentences, 50'000);
  EXPECT_GT(most, 0);  // there were more than numbers
}

TEST(WireTtmFeed, ASavedFeedGoesOnWithTheSameNumbers) {
  const LocalPlane plane({deg(50.0), deg(-1.0)});
  TtmFeed feed(plane), other(plane);
  std::vector<ReportedTrack> tracks(40);
  for (std::size_t k = 0; k < tracks.size(); ++k) tracks[k].id = static_cast<std::int64_t>(k + 1);
  std::string first, second;
  const auto into = [](std::string& all) { return [&all](std::string_view text) { all += text; }; };
  feed.update(0.0, {}, NAN, std::span(tracks).first(30), into(first));
  feed.update(1.0, {}, NAN, std::span(tracks).subspan(10, 20), into(first));
  Archive saved;
  feed.archive(saved);
  Archive loaded(saved.bytes());
  other.archive(loaded);
  ASSERT_TRUE(loaded.ok() && loaded.at_end());
  first.clear();
  for (ReportedTrack& track : tracks) track.time_s = 5.0;
  feed.update(5.0, {}, NAN, tracks, into(first));
  other.update(5.0, {}, NAN, tracks, into(second));
  EXPECT_EQ(first, second);
  EXPECT_FALSE(first.empty());
}

TEST(WireTtmFeed, WhatIsNotKnownIsEmpty) {
  const LocalPlane plane({deg(50.0), deg(-1.0)});
  const auto sent = [&](const ReportedTrack& track, bool own_velocity_known) {
    std::vector<std::vector<std::string>> sentences;
    TtmFeed(plane).update(
        0.0, {.vnorth_mps = 5.0}, NAN, std::span(&track, 1),
        [&](std::string_view text) { sentences.push_back(fields_of(text)); }, own_velocity_known);
    return sentences;
  };
  ReportedTrack track;
  track.id = 1;
  track.kinematics.mean << 900.0, 4.0, 100.0, -3.0;
  const std::vector<int> motion{5, 6}, approach{8, 9};
  for (const bool acquiring : {false, true})
    for (const bool own_velocity_known : {false, true}) {
      track.acquiring = track.manual = acquiring;
      const auto sentences = sent(track, own_velocity_known);
      ASSERT_EQ(sentences.size(), 2u);
      EXPECT_EQ(sentences[0][5].empty(), !own_velocity_known) << "speed in OSD";
      for (const int k : motion) EXPECT_EQ(sentences[1][std::size_t(k)].empty(), acquiring) << k;
      for (const int k : approach)
        EXPECT_EQ(sentences[1][std::size_t(k)].empty(), acquiring || !own_velocity_known) << k;
      EXPECT_EQ(sentences[1][12], acquiring ? "Q" : "T");
      EXPECT_EQ(sentences[1][15].substr(0, 1), acquiring ? "M" : "A");
    }
}

TEST(WireTtmFeed, NothingIsAllocated) {
  const LocalPlane plane({deg(50.0), deg(-1.0)});
  TtmFeed feed(plane);
  std::vector<ReportedTrack> tracks(90);
  for (std::size_t k = 0; k < tracks.size(); ++k) tracks[k].id = static_cast<std::int64_t>(k + 1);
  std::size_t octets = 0;
  const test::NoHeap fence;
  for (int turn = 0; turn < 10; ++turn) {
    for (ReportedTrack& track : tracks) track.time_s = 3.0 * turn;
    feed.update(3.0 * turn, {}, 0.0, std::span(tracks).first(std::size_t(90 - turn)),
                [&](std::string_view text) { octets += text.size(); });
  }
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_GT(octets, 0u);
}

}  // namespace
}  // namespace wakeline::wire_nmea_test
