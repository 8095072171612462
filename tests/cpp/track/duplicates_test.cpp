// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/duplicates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/draw.hpp"

namespace wakeline::duplicates_test {
namespace {

constexpr double kThreshold = 6.0, kPeriod_s = 2.5;

/// A new track at that place and velocity, with a number if that is above zero.
Track& open(TrackList& tracks, std::int64_t id, const Vec<double, 4>& mean) {
  Track& track = tracks.open();
  track.id = id;
  track.status = id > 0 ? TrackStatus::kConfirmed : TrackStatus::kTentative;
  track.existence = 0.5;
  track.kinematics.mean = mean;
  track.kinematics.covariance = Vec<double, 4>(100.0, 4.0, 100.0, 4.0).asDiagonal();
  return track;
}

bool never(const Track&, const Track&) { return false; }
bool always(const Track&, const Track&) { return true; }

template <class SeenByOthers = decltype(never)>
std::vector<int> found(Duplicates& duplicates, TrackList& tracks, int radars = 1,
                       const SeenByOthers& seen_by_others = never) {
  const std::span<const int> slots =
      duplicates.find(tracks, tracks.slots(), tracks.slots(), kPeriod_s, radars, seen_by_others);
  return {slots.begin(), slots.end()};
}

TEST(Duplicates, OfTwoTracksOnOneTargetTheSeniorStays) {
  const TrackerConfig config{.duplicate_scans = 3};
  TrackList tracks(10);
  Duplicates duplicates(config, kThreshold);
  const int senior = open(tracks, 4, {0.0, 5.0, 0.0, 0.0}).slot;
  const int junior = open(tracks, 7, {3.0, 5.0, -2.0, 0.0}).slot;
  open(tracks, 2, {500.0, 5.0, 0.0, 0.0});
  EXPECT_TRUE(found(duplicates, tracks).empty());
  EXPECT_TRUE(found(duplicates, tracks).empty());
  EXPECT_EQ(found(duplicates, tracks), std::vector<int>{junior}) << "after three scans in a row";
  EXPECT_EQ(tracks.at(senior).duplicate_scans, 0);
}

TEST(Duplicates, TheCountBeginsAnewWhereTheyPart) {
  TrackList tracks(10);
  Duplicates duplicates(TrackerConfig{.duplicate_scans = 2}, kThreshold);
  open(tracks, 1, {0.0, 5.0, 0.0, 0.0});
  Track& junior = open(tracks, 2, {3.0, 5.0, 0.0, 0.0});
  EXPECT_TRUE(found(duplicates, tracks).empty());
  junior.kinematics.mean[0] = 300.0;
  EXPECT_TRUE(found(duplicates, tracks).empty());
  junior.kinematics.mean[0] = 3.0;
  EXPECT_TRUE(found(duplicates, tracks).empty());
  EXPECT_EQ(found(duplicates, tracks).size(), 1u);
}

TEST(Duplicates, ATentativeOneGoesAtOnceAndAVelocityTellsTargetsApart) {
  TrackList tracks(10);
  Duplicates duplicates(TrackerConfig{}, kThreshold);
  open(tracks, 1, {0.0, 5.0, 0.0, 0.0});
  const int same = open(tracks, -3, {3.0, 5.0, 0.0, 0.0}).slot;
  open(tracks, -4, {0.0, -9.0, 0.0, 0.0});
  EXPECT_EQ(found(duplicates, tracks), std::vector<int>{same});
}

TEST(Duplicates, EachSeenByAnotherRadarAreAsFarApartAsIndependentEstimates) {
  TrackList tracks(10);
  Duplicates duplicates(TrackerConfig{}, kThreshold);
  open(tracks, 1, {0.0, 5.0, 0.0, 0.0});
  const int same = open(tracks, -3, {20.0, 5.0, 20.0, 3.0}).slot;  // 1.4, 1.4 and 1.1 sigmas
  open(tracks, -4, {0.0, 5.0, 60.0, 0.0});
  EXPECT_TRUE(found(duplicates, tracks).empty());
  EXPECT_TRUE(found(duplicates, tracks, 2, never).empty());
  EXPECT_EQ(found(duplicates, tracks, 2, always), std::vector<int>{same});
}

// A track that is to be deleted itself is no reason to delete another.
TEST(Duplicates, OfManyOnOneTargetOneStays) {
  TrackList tracks(10);
  Duplicates duplicates(TrackerConfig{}, kThreshold);
  for (int k = 1; k <= 6; ++k) open(tracks, -k, {double(k), 5.0, 0.0, 0.0});
  EXPECT_EQ(found(duplicates, tracks).size(), 5u);
  TrackList chain(10);  // each near the next only
  for (int k = 1; k <= 3; ++k) open(chain, -k, {8.0 * k, 5.0, 0.0, 0.0});
  EXPECT_EQ(found(duplicates, chain), std::vector<int>{1});
}

TEST(Duplicates, OneVesselOfAKnownLengthIsOneTarget) {
  const auto count = [](double length_m, double speed_mps) {
    TrackList tracks(10);
    Duplicates duplicates(TrackerConfig{.vessel_length_m = length_m, .duplicate_scans = 1},
                          kThreshold);
    open(tracks, 1, {0.0, 5.0, 0.0, 0.0});
    open(tracks, 2, {80.0, speed_mps, 0.0, 0.0});
    return found(duplicates, tracks).size();
  };
  EXPECT_EQ(count(0.0, 5.0), 0u);
  EXPECT_EQ(count(100.0, 5.0), 1u);
  EXPECT_EQ(count(100.0, -5.0), 0u) << "it goes the other way";
  EXPECT_EQ(count(70.0, 5.0), 0u);
}

TEST(Duplicates, TwoTracksAreComparedAtOneTime) {
  TrackList tracks(10);
  Duplicates duplicates(TrackerConfig{}, kThreshold);
  open(tracks, 1, {0.0, 20.0, 0.0, 0.0});
  Track& there = open(tracks, -1, {50.0, 20.0, 0.0, 0.0});
  Track& here = open(tracks, -2, {0.0, 20.0, 0.0, 0.0});
  there.time_s = here.time_s = 2.5;
  EXPECT_EQ(found(duplicates, tracks), std::vector<int>{there.slot});
  tracks.remove(there.slot);
  here.time_s = 3600.0;
  here.kinematics.mean[0] = 72000.0;
  EXPECT_TRUE(found(duplicates, tracks).empty()) << "too far apart in time to be compared";
}

// Tracks of sizes and times that differ, in a crowd: those of some slots, as by comparing all.
TEST(Duplicates, AreThoseOfAllPairs) {
  const TrackerConfig config{.duplicate_distance = 2.0, .vessel_length_m = 12.0};
  test::Draw draw(5);
  for (int run = 0; run < 50; ++run) {
    TrackList tracks(100);
    Duplicates duplicates(config, kThreshold);
    std::vector<int> slots;
    for (int k = 1; k <= 100; ++k) {
      Track& track = open(tracks, -k, Vec<double, 4>::Zero());
      const auto axis = [&] { return draw.uniform(-400.0, 400.0); };
      track.kinematics.mean << axis(), draw.uniform(-20.0, 20.0), axis(), draw.uniform(-20.0, 20.0);
      track.kinematics.covariance *= draw.uniform(0.0, 1.0) < 0.1 ? 100.0 : 1.0;
      track.time_s = draw.uniform(0.0, 3.0 * kPeriod_s);
      track.existence = draw.uniform(0.1, 0.9);
      if (k % 3 == 0) slots.push_back(track.slot);
    }
    std::vector<int> expected;
    for (const int slot : slots) {
      const Track& track = tracks.at(slot);
      for (const int senior : tracks.slots()) {
        const Track& other = tracks.at(senior);
        const double dt_s = track.time_s - other.time_s;
        if (!is_senior(other, track) || std::abs(dt_s) > 2.0 * kPeriod_s ||
            std::ranges::count(expected, senior) > 0)
          continue;
        const Gaussian<4> then = at_constant_velocity(other.kinematics, dt_s);
        if (!same_target(then, track.kinematics, config.duplicate_distance) &&
            !same_vessel(other, then, track, config.vessel_length_m, kThreshold))
          continue;
        expected.push_back(slot);
        break;
      }
    }
    const std::span<const int> found =
        duplicates.find(tracks, slots, tracks.slots(), kPeriod_s, 1, never);
    EXPECT_EQ(std::vector<int>(found.begin(), found.end()), expected);
  }
}

TEST(Seniority, IsAStrictOrder) {
  TrackList tracks(10);
  open(tracks, 3, Vec<double, 4>::Zero());
  open(tracks, 5, Vec<double, 4>::Zero());
  open(tracks, -1, Vec<double, 4>::Zero()).existence = 0.9;
  open(tracks, -2, Vec<double, 4>::Zero()).existence = 0.4;
  open(tracks, -3, Vec<double, 4>::Zero()).existence = 0.4;
  for (const int a : tracks.slots())
    for (const int b : tracks.slots())
      EXPECT_EQ(is_senior(tracks.at(a), tracks.at(b)), a < b) << a << ' ' << b;
}

}  // namespace
}  // namespace wakeline::duplicates_test
