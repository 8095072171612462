// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What an operator does: designate, drop, rename.
#include <limits>
#include <string>

#include "track/scene.hpp"

namespace wakeline::operator_test {
namespace {

using namespace test;

const Boat kBoat{{1500.0, 800.0}, {-4.0, 6.0}};

void follow(VesselTracker& tracker, Sea& sea, int from, int to) {
  for (int k = from; k < to; ++k) {
    const Plot plot = sea.plot(kBoat.at(2.5 * k), 2.5 * k);
    (void)tracker.process(2.5 * k, {&plot, 1});
  }
}

TEST(Operator, DesignatesATargetBeforeTheFirstScan) {
  Sea sea(1);
  VesselTracker tracker = make_tracker();
  const std::int64_t id = tracker.designate(0.0, kBoat.at(0)[0], kBoat.at(0)[1], 30.0);
  EXPECT_EQ(id, 1);
  const Track* track = tracker.find(id);
  ASSERT_NE(track, nullptr);
  EXPECT_EQ(track->status, TrackStatus::kConfirmed);
  EXPECT_EQ(track->tentative_id, 0);
  EXPECT_EQ(track->speed_mps(), 0.0);
  EXPECT_NEAR(track->position_std_m(), 30.0, 1e-9);
  expect_sound(tracker);
  follow(tracker, sea, 1, 30);
  EXPECT_EQ(ids_of(tracker), std::set<std::int64_t>{1})
      << "it takes the boat's plots, and nothing else starts";
  EXPECT_LT((tracker.find(1)->position() - kBoat.at(2.5 * 29)).norm(), 60.0);
}

TEST(Operator, DesignatesWithAVelocity) {
  Sea sea(21);
  VesselTracker tracker = make_tracker();
  const Gaussian<2> velocity{{-4.0, 6.0}, 0.25 * Mat<double, 2, 2>::Identity()};
  ASSERT_EQ(tracker.designate(0.0, kBoat.at(0)[0], kBoat.at(0)[1], 30.0, velocity), 1);
  EXPECT_NEAR((tracker.find(1)->velocity() - kBoat.velocity_mps).norm(), 0.0, 0.5);
  follow(tracker, sea, 1, 10);
  EXPECT_LT((tracker.find(1)->velocity() - kBoat.velocity_mps).norm(), 2.0);
  const Gaussian<2> flat{{-4.0, 6.0}, Mat<double, 2, 2>::Zero()};
  EXPECT_EQ(tracker.designate(25.0, -900.0, 0.0, 30.0, flat), 0);
}

TEST(Operator, MergesTwoTracksOfOneVessel) {
  VesselTracker tracker = make_tracker();
  for (const double north_m : {500.0, 900.0})
    ASSERT_GT(tracker.designate(0.0, north_m, 0.0, 20.0), 0);
  (void)tracker.rename(2, "Mary");
  EXPECT_FALSE(tracker.merge(1, 1));
  EXPECT_FALSE(tracker.merge(1, 3));
  EXPECT_TRUE(tracker.merge(1, 2));
  EXPECT_EQ(ids_of(tracker), std::set<std::int64_t>{1});
  EXPECT_EQ(tracker.find(1)->label(), "Mary");
  EXPECT_FALSE(tracker.merge(1, 2));
}

TEST(Operator, MergingKeepsTheIdentityOfEither) {
  VesselTracker tracker = make_tracker();
  for (const double north_m : {500.0, 900.0})
    ASSERT_GT(tracker.designate(0.0, north_m, 0.0, 20.0), 0);
  for (const double time_s : {2.0, 4.0, 6.0})
    (void)tracker.report({.identity = "Mary", .time_s = time_s, .position_m = {900.0, 0.0}});
  ASSERT_EQ(tracker.find("ais", "Mary"), tracker.find(2));
  EXPECT_TRUE(tracker.merge(1, 2));
  EXPECT_EQ(tracker.find("ais", "Mary"), tracker.find(1));
  EXPECT_GT(tracker.identity_probability(*tracker.find(1)), 0.9);
}

TEST(Operator, DesignatingAheadOfTheClockHoldsUpNoScan) {
  Sea sea(2);
  VesselTracker tracker = make_tracker();
  ASSERT_EQ(tracker.designate(3.0, kBoat.at(3)[0], kBoat.at(3)[1], 30.0), 1);
  const Plot plot = sea.plot(kBoat.at(2.5), 2.5);
  EXPECT_EQ(tracker.process(2.5, {&plot, 1}).status, Status::kOk);
  follow(tracker, sea, 2, 20);
  EXPECT_NE(tracker.find(1), nullptr);
}

TEST(Operator, ATargetMissesNoScanBeforeItsTime) {
  VesselTracker tracker = make_tracker();
  (void)tracker.process(0.0, {});
  const double begin_s = 150.0;
  ASSERT_EQ(tracker.designate(begin_s, 500.0, 500.0, 20.0), 1);
  int coasting = 0, lost = 0;
  for (int k = 1; k < 90; ++k) {
    const double time_s = 2.5 * k;
    for (const Event& event : tracker.process(time_s, {}).events) {
      EXPECT_GE(time_s, begin_s);
      (event.kind == TrackEvent::kCoasting ? coasting : lost) += 1;
    }
  }
  EXPECT_EQ(coasting, 1);
  EXPECT_EQ(lost, 1);

  VesselTracker early = make_tracker();
  ASSERT_EQ(early.designate(1e9, 500.0, 500.0, 20.0), 1);
  for (int k = 1; k < 30; ++k) (void)early.process(2.5 * k, {});
  EXPECT_EQ(early.size(), 0) << "it was of another clock";
}

TEST(Operator, ATargetFarAheadOfTheClockIsNotDesignated) {
  VesselTracker tracker = make_tracker();
  EXPECT_EQ(tracker.designate(1.7e9, 500.0, 500.0, 20.0), 1) << "no clock yet";
  (void)tracker.drop(1);
  (void)tracker.process(100.0, {});
  const double latest_s = tracker.latest_time_s();
  EXPECT_EQ(latest_s, 3700.0);
  const auto before = tracker.save();
  for (const double time_s : {std::nextafter(latest_s, 1e9), 1e4, 1e300})
    EXPECT_EQ(tracker.designate(time_s, 500.0, 500.0, 20.0), 0) << time_s;
  EXPECT_EQ(tracker.save(), before);
  EXPECT_EQ(tracker.designate(latest_s, 500.0, 500.0, 20.0), 2);
  EXPECT_EQ(tracker.designate(20.0, 900.0, 500.0, 20.0), 3) << "before the scan";
}

TEST(Operator, ADesignatedTargetThatIsNotThereIsLost) {
  VesselTracker tracker = make_tracker();
  (void)tracker.process(0.0, {});
  ASSERT_EQ(tracker.designate(0.0, 500.0, 500.0, 20.0), 1);
  std::vector<TrackEvent> story;
  for (int k = 1; k < 30; ++k)
    for (const Event& event : tracker.process(2.5 * k, {}).events) {
      EXPECT_EQ(event.track_id, 1);
      EXPECT_EQ(event.tentative_id, 0);
      story.push_back(event.kind);
    }
  EXPECT_EQ(story, (std::vector<TrackEvent>{TrackEvent::kCoasting, TrackEvent::kLost}));
}

TEST(Operator, WhatMakesNoSenseIsNotDesignated) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  VesselTracker tracker = make_tracker();
  const auto before = tracker.save();
  for (const double bad : {kNan, kInf, -kInf}) {
    EXPECT_EQ(tracker.designate(bad, 0.0, 0.0, 10.0), 0);
    EXPECT_EQ(tracker.designate(0.0, bad, 0.0, 10.0), 0);
    EXPECT_EQ(tracker.designate(0.0, 0.0, bad, 10.0), 0);
    EXPECT_EQ(tracker.designate(0.0, 0.0, 0.0, bad), 0);
  }
  for (const double std : {0.0, -10.0, 1e200}) EXPECT_EQ(tracker.designate(0.0, 0.0, 0.0, std), 0);
  for (const double far : {1e10, -1e300, std::numeric_limits<double>::max()}) {
    EXPECT_EQ(tracker.designate(0.0, far, 0.0, 10.0), 0) << far;
    EXPECT_EQ(tracker.designate(0.0, 0.0, far, 10.0), 0) << far;
  }
  EXPECT_EQ(tracker.save(), before);
  EXPECT_EQ(tracker.process(1.0, {}).status, Status::kOk);
}

TEST(Operator, DesignatesIntoAFullTrackerOnlyOverTentativeTracks) {
  TrackerConfig config;
  config.max_tracks = 3;
  VesselTracker tracker = make_tracker(config);
  for (const double time_s : {0.0, 2.5}) {
    std::vector<Plot> plots;
    for (const double north : {1000.0, 2000.0, 3000.0})
      plots.push_back(exact_plot({north, 0.0}, time_s));
    (void)tracker.process(time_s, plots);
  }
  ASSERT_EQ(tracker.size(), 3);
  for (int k = 1; k <= 3; ++k) EXPECT_EQ(tracker.designate(2.5, -1000.0 * k, 0.0, 10.0), k);
  EXPECT_EQ(tracker.designate(2.5, -4000.0, 0.0, 10.0), 0);
  EXPECT_EQ(ids_of(tracker), (std::set<std::int64_t>{1, 2, 3}));
}

TEST(Operator, DropsATrackAndItsNumberForGood) {
  Sea sea(3);
  VesselTracker tracker = make_tracker();
  follow(tracker, sea, 0, 20);
  EXPECT_FALSE(tracker.drop(99));
  EXPECT_FALSE(tracker.drop(0));
  EXPECT_FALSE(tracker.drop(-1)) << "its number before it was confirmed";
  EXPECT_TRUE(tracker.drop(1));
  EXPECT_EQ(tracker.find(1), nullptr);
  EXPECT_FALSE(tracker.drop(1));
  EXPECT_EQ(tracker.size(), 0);
  follow(tracker, sea, 20, 40);
  EXPECT_EQ(ids_of(tracker), std::set<std::int64_t>{2});
}

TEST(Operator, RenamesATrack) {
  Sea sea(4);
  VesselTracker tracker = make_tracker();
  follow(tracker, sea, 0, 20);
  EXPECT_EQ(tracker.find(1)->label(), "");
  EXPECT_FALSE(tracker.rename(7, "nobody"));
  EXPECT_TRUE(tracker.rename(1, "pilot boat"));
  follow(tracker, sea, 20, 22);
  EXPECT_EQ(tracker.find(1)->label(), "pilot boat");
  EXPECT_TRUE(tracker.rename(1, "tug"));
  EXPECT_EQ(tracker.find(1)->label(), "tug");
  const std::string name(1000, 'x');
  EXPECT_TRUE(tracker.rename(1, name));
  EXPECT_EQ(tracker.find(1)->label(), name.substr(0, 31));
  EXPECT_TRUE(tracker.rename(1, ""));
  EXPECT_EQ(tracker.find(1)->label(), "");
}

TEST(Operator, ANewTrackHasNoNameOfAnOldOne) {
  TrackerConfig config;
  config.max_tracks = 1;
  VesselTracker tracker = make_tracker(config);
  ASSERT_EQ(tracker.designate(0.0, 100.0, 0.0, 10.0), 1);
  EXPECT_TRUE(tracker.rename(1, "old"));
  EXPECT_TRUE(tracker.drop(1));
  ASSERT_EQ(tracker.designate(0.0, 100.0, 0.0, 10.0), 2);
  EXPECT_EQ(tracker.find(2)->label(), "");
}

TEST(Operator, PointingAtATrackedVesselConfirmsTheTrackThatIsThere) {
  for (const int scans : {2, 3, 20}) {
    Sea sea(5);
    VesselTracker tracker = make_tracker();
    follow(tracker, sea, 0, scans);
    ASSERT_EQ(tracker.size(), 1);
    const std::int64_t before = tracks_of(tracker, false).front()->id;
    const Vec<double, 2> place = kBoat.at(2.5 * (scans - 1)) + Vec<double, 2>(15.0, -10.0);
    const double time_s = 2.5 * (scans - 1) + 0.7;
    EXPECT_EQ(tracker.designate(time_s, place[0], place[1], 30.0), 1) << scans;
    EXPECT_EQ(ids_of(tracker), std::set<std::int64_t>{1});
    EXPECT_EQ(tracker.find(1)->status, TrackStatus::kConfirmed);
    EXPECT_EQ(tracker.find(1)->tentative_id, before < 0 ? before : -1);
    EXPECT_GT(tracker.find(1)->speed_mps(), 0.0) << "the track that was there";
    follow(tracker, sea, scans, scans + 20);
    EXPECT_EQ(ids_of(tracker), std::set<std::int64_t>{1}) << scans;
  }
}

TEST(Operator, PointsAtTheNearerOfTwoAndNotAtOneFarOff) {
  VesselTracker tracker = make_tracker();
  const std::int64_t one = tracker.designate(0.0, 1000.0, 0.0, 10.0);
  const std::int64_t other = tracker.designate(0.0, 1060.0, 0.0, 10.0);
  EXPECT_EQ(one, 1);
  EXPECT_EQ(other, 2);
  EXPECT_EQ(tracker.designate(0.0, 1015.0, 0.0, 30.0), one);
  EXPECT_EQ(tracker.designate(0.0, 1045.0, 0.0, 30.0), other);
  EXPECT_EQ(tracker.designate(0.0, 1200.0, 0.0, 30.0), 3);
  EXPECT_EQ(tracker.designate(100.0, 1000.0, 0.0, 10.0), 4) << "of another time";
}

TEST(Operator, PointingAtAHeldVesselShowsItAgain) {
  Sea sea(6);
  VesselTracker tracker = make_tracker();
  follow(tracker, sea, 0, 20);
  double time_s = 47.5;
  for (int k = 0; k < 6; ++k) (void)tracker.process(time_s += 2.5, {});
  ASSERT_EQ(tracker.find(1)->status, TrackStatus::kHeld);
  EXPECT_EQ(tracker.designate(time_s, kBoat.at(time_s)[0], kBoat.at(time_s)[1], 50.0), 1);
  EXPECT_TRUE(tracker.find(1)->shown());
  EXPECT_EQ(tracker.size(), 1);
}

TEST(Operator, AVesselDroppedWithHushStaysSilentUntilItIsPointedAt) {
  Sea sea(7);
  VesselTracker tracker = make_tracker();
  follow(tracker, sea, 0, 20);
  EXPECT_FALSE(tracker.drop(9, true));
  EXPECT_TRUE(tracker.drop(1, true));
  for (int k = 20; k < 60; ++k) {
    const Plot plot = sea.plot(kBoat.at(2.5 * k), 2.5 * k);
    const ScanReport report = tracker.process(2.5 * k, {&plot, k % 7 == 0 ? 0u : 1u});
    EXPECT_TRUE(report.events.empty()) << k;
    for (const std::int64_t id : report.plot_track_id) EXPECT_EQ(id, 0);
    tracker.for_each([](const Track& track) { EXPECT_FALSE(track.shown()); });
  }
  VesselTracker restored = make_tracker();
  ASSERT_TRUE(restored.restore(tracker.save()));
  EXPECT_FALSE(restored.find(1)->shown());
  const Vec<double, 2> place = kBoat.at(2.5 * 59);
  EXPECT_EQ(tracker.designate(2.5 * 59, place[0], place[1], 30.0), 1);
  EXPECT_TRUE(tracker.find(1)->shown());
  EXPECT_TRUE(tracker.drop(1));
  EXPECT_EQ(tracker.size(), 0);
}

TEST(Operator, AHushedVesselThatIsGoneIsForgotten) {
  Sea sea(8);
  VesselTracker tracker = make_tracker();
  follow(tracker, sea, 0, 20);
  EXPECT_TRUE(tracker.drop(1, true));
  double time_s = 47.5;
  for (int k = 0; k < 30; ++k) EXPECT_TRUE(tracker.process(time_s += 2.5, {}).events.empty());
  EXPECT_EQ(tracker.size(), 0);
}

TEST(Operator, NamesAreUtf8) {
  VesselTracker tracker = make_tracker();
  ASSERT_EQ(tracker.designate(0.0, 100.0, 0.0, 10.0), 1);
  EXPECT_TRUE(tracker.rename(1, "F\u00e4hre 7"));
  for (const char* bytes : {"\xff", "a\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf5\x80\x80\x80"})
    EXPECT_FALSE(tracker.rename(1, bytes));
  EXPECT_EQ(tracker.find(1)->label(), "F\u00e4hre 7");
}

}  // namespace
}  // namespace wakeline::operator_test
