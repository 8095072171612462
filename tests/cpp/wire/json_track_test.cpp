// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/wire/json_track.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <string>

namespace wakeline::json_track_test {
namespace {

JsonTrack sailing() {
  JsonTrack track{.id = 7, .status = "confirmed", .name = "Å", .time_s = 12.5};
  track.kinematics.mean = {100.0, 3.0, -200.0, -4.0};
  track.kinematics.covariance.setIdentity();
  return track;
}

std::string line_of(const JsonTrack& track) {
  std::string line;
  append_track_line(track, line);
  return line;
}

bool contains(const std::string& line, const std::string& part) {
  return line.find(part) != std::string::npos;
}

TEST(JsonTrack, IsOneLineWithWhatIsKnown) {
  JsonTrack track = sailing();
  const std::string bare = line_of(track);
  EXPECT_EQ(bare.find('\n'), bare.size() - 1);
  EXPECT_TRUE(contains(bare, R"("track_id":7,"status":"confirmed","name":"Å","time_s":12.5)"));
  EXPECT_TRUE(contains(bare, R"("speed_mps":5.00000)"));
  EXPECT_TRUE(contains(bare, R"("covariance":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]])"));
  EXPECT_TRUE(contains(bare, R"("course_rad":5.355890)"));  // atan2(-4, 3) + 2 pi
  for (const char* absent : {"latitude_deg", "range_m", "cpa", "radar"})
    EXPECT_FALSE(contains(bare, absent)) << absent;
  track.place = {54.0, 10.0};
  track.direction = {500.0, 1.0};
  track.approach = {40.0, 90.0, 0.25};
  track.radar = "A";
  const std::string whole = line_of(track);
  EXPECT_TRUE(contains(whole, R"("latitude_deg":54.000000000,"longitude_deg":10.000000000)"));
  EXPECT_TRUE(contains(whole, R"("cpa":{"cpa_m":40.00,"tcpa_s":90.00,"probability":0.25000})"));
  EXPECT_TRUE(contains(whole, R"("radar":"A"})"));
}

TEST(JsonTrack, HasNullForNumbersThatAreNotFinite) {
  JsonTrack track = sailing();
  track.kinematics.covariance(1, 1) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(contains(line_of(track), R"("covariance":[[1,0,0,0],[0,null,0,0],)"));
  EXPECT_TRUE(contains(line_of(track), R"("nis":{"mean":null,"lower":null,"upper":null})"));
  track.kinematics.mean[0] = std::numeric_limits<double>::max();
  EXPECT_GT(line_of(track).size(), std::size_t{300});  // all its digits
}

TEST(JsonTrack, EscapesTexts) {
  JsonTrack track = sailing();
  track.name = "a\"b\\c\n\x1f";
  EXPECT_TRUE(contains(line_of(track), R"("name":"a\"b\\c\u000a\u001f")"));
}

}  // namespace
}  // namespace wakeline::json_track_test
