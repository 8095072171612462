// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Times and plots that make no sense, and a long scene with all of them.
#include <limits>

#include "track/scene.hpp"

namespace wakeline::bad_input_test {
namespace {

using namespace test;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
const Boat kBoat{{1500.0, 800.0}, {-4.0, 6.0}};

/// A tracker that has followed the boat for 20 scans, the last at 50 s.
VesselTracker followed(Sea& sea) {
  VesselTracker tracker = make_tracker();
  for (int k = 1; k <= 20; ++k) {
    const Plot plot = sea.plot(kBoat.at(2.5 * k), 2.5 * k);
    (void)tracker.process(2.5 * k, {&plot, 1});
  }
  EXPECT_NE(tracker.find(1), nullptr);
  return tracker;
}

TEST(BadTime, ChangesNothing) {
  Sea sea(1);
  VesselTracker tracker = followed(sea);
  const auto before = tracker.save();
  const Plot plot = exact_plot(kBoat.at(52.5), 52.5);
  const std::pair<double, Status> cases[] = {
      {49.9, Status::kNegativeTimeStep}, {-1e300, Status::kNegativeTimeStep},
      {kNan, Status::kNotFinite},        {kInf, Status::kNotFinite},
      {-kInf, Status::kNotFinite},       {50.0 + 3600.1, Status::kNotFinite},
      {1e9, Status::kNotFinite},         {1e300, Status::kNotFinite}};
  for (const auto& [time_s, status] : cases) {
    const ScanReport report = tracker.process(time_s, {&plot, 1});
    EXPECT_EQ(report.status, status) << time_s;
    EXPECT_TRUE(report.plot_track_id.empty());
    EXPECT_TRUE(report.events.empty());
    EXPECT_EQ(tracker.save(), before) << time_s;
  }
}

TEST(BadTime, AScanAtTheSameTimeIsTaken) {
  Sea sea(2);
  VesselTracker tracker = followed(sea);
  for (int k = 0; k < 5; ++k) {
    const Plot plot = sea.plot(kBoat.at(50.0), 50.0);
    EXPECT_EQ(tracker.process(50.0, {&plot, 1}).status, Status::kOk);
    expect_sound(tracker);
  }
  EXPECT_EQ(ids_of(tracker), std::set<std::int64_t>{1})
      << "nothing starts from two plots of one moment";
  EXPECT_LT((tracker.find(1)->position() - kBoat.at(50.0)).norm(), 60.0);
}

TEST(BadTime, AfterAnHourOldTracksAreLostAndNewOnesStart) {
  Sea sea(3);
  VesselTracker tracker = followed(sea);
  Ledger ledger;
  ledger.ids = ids_of(tracker);
  double time_s = 50.0 + 3600.0;
  bool again = false;
  for (int k = 0; k < 12; ++k, time_s += 2.5) {
    const Boat other{{-700.0, 900.0}, {2.0, 2.0}};
    const Plot plot = sea.plot(other.at(2.5 * k), time_s);
    const ScanReport report = tracker.process(time_s, {&plot, 1});
    EXPECT_EQ(report.status, Status::kOk);
    ledger.note(report);
    expect_sound(tracker);
    if (k == 0) {
      const std::vector<Event> lost = events_of(report, TrackEvent::kLost);
      ASSERT_EQ(lost.size(), 1u);
      EXPECT_EQ(lost[0].track_id, 1);
    }
    for (const Event& event : events_of(report, TrackEvent::kConfirmed)) {
      EXPECT_EQ(event.track_id, 2);
      again = true;
    }
  }
  EXPECT_TRUE(again);
  EXPECT_EQ(ledger.ids, ids_of(tracker));
}

TEST(BadTime, APlotWithAWildClockHarmsNoTrack) {
  for (const double wrong_s : {1e9, -1e9, 1e300, 60.0 + 86400.0}) {
    Sea sea(4);
    VesselTracker tracker = followed(sea);
    for (int k = 21; k <= 30; ++k) {
      std::vector<Plot> plots{sea.plot(kBoat.at(2.5 * k), 2.5 * k)};
      if (k < 24) plots[0].time_s = wrong_s;
      const ScanReport report = tracker.process(2.5 * k, plots);
      EXPECT_EQ(report.rejected_plots, k < 24 ? 1 : 0) << wrong_s;
      expect_sound(tracker);
    }
    ASSERT_NE(tracker.find(1), nullptr) << wrong_s;
    EXPECT_EQ(tracker.find(1)->status, TrackStatus::kConfirmed);
  }
}

TEST(BadTime, APlotAheadOfItsScanThrowsNoTrackIntoTheFuture) {
  for (const double ahead_s : {5.0, 10.0, 20.0})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      Sea sea(seed);
      VesselTracker tracker = followed(sea);
      for (int k = 21; k <= 30; ++k) {
        Plot plot = sea.plot(kBoat.at(2.5 * k), 2.5 * k);
        if (k == 21) plot.time_s += ahead_s;
        (void)tracker.process(2.5 * k, {&plot, 1});
        ASSERT_NE(tracker.find(1), nullptr);
        EXPECT_EQ(tracker.find(1)->time_s, 2.5 * k);
        EXPECT_LT((tracker.find(1)->position() - kBoat.at(2.5 * k)).norm(), 60.0) << ahead_s;
      }
    }
}

TEST(BadPlots, AreRejectedCountedAndLeaveNoTrace) {
  Sea sea(5);
  VesselTracker clean = followed(sea);
  Sea same(5);
  VesselTracker tracker = followed(same);
  std::vector<Plot> bad(21, exact_plot(kBoat.at(52.5), 52.5));
  bad[0].range_m = kNan;
  bad[1].range_m = kInf;
  bad[2].range_m = -1.0;
  bad[3].range_m = -kInf;
  bad[4].range_m = 1e300;
  bad[5].bearing_rad = kNan;
  bad[6].bearing_rad = kInf;
  bad[7].time_s = kNan;
  bad[8].time_s = -kInf;
  bad[9].own.north_m = kNan;
  bad[10].own.east_m = kInf;
  bad[11].own.heading_std_rad = kNan;
  bad[12].own.position_std_m = kNan;
  bad[13].own.position_std_m = kInf;
  bad[14].own.heading_std_rad = kInf;
  bad[15].range_m = std::numeric_limits<double>::max();
  bad[16].bearing_rad = 1e300;
  bad[17].bearing_rad = -1e15;
  bad[18].own.north_m = 1e308;
  bad[19].own.east_m = -2e9;
  bad[20].own.position_std_m = 1e150;
  for (int k = 21; k <= 30; ++k) {
    std::vector<Plot> plots = bad;
    for (Plot& plot : plots)
      if (std::isfinite(plot.time_s)) plot.time_s = 2.5 * k;
    const Plot good = sea.plot(kBoat.at(2.5 * k), 2.5 * k);
    plots.insert(plots.begin() + 7, good);
    const ScanReport report = tracker.process(2.5 * k, plots);
    EXPECT_EQ(report.status, Status::kOk);
    EXPECT_EQ(report.rejected_plots, 21);
    ASSERT_EQ(report.plot_track_id.size(), 22u);
    for (std::size_t n = 0; n < 22; ++n) EXPECT_EQ(report.plot_track_id[n], n == 7 ? 1 : 0);
    (void)clean.process(2.5 * k, {&good, 1});
    EXPECT_EQ(tracker.save(), clean.save());
  }
}

TEST(BadPlots, AtTheRadarItselfAreTaken) {
  VesselTracker tracker = make_tracker();
  for (int k = 0; k < 20; ++k) {
    const Plot plot{.time_s = 2.5 * k, .range_m = 0.0, .bearing_rad = 0.3 * k};
    EXPECT_EQ(tracker.process(2.5 * k, {&plot, 1}).rejected_plots, 0);
    expect_sound(tracker);
  }
  ASSERT_NE(tracker.find(1), nullptr);
  EXPECT_LT(tracker.find(1)->position().norm(), 10.0);
}

TEST(BadPlots, ManyOnOneSpotAreOneTarget) {
  Sea sea(6);
  VesselTracker tracker = make_tracker();
  for (int k = 0; k < 20; ++k) {
    const std::vector<Plot> plots(3, sea.plot(kBoat.at(2.5 * k), 2.5 * k));
    EXPECT_EQ(tracker.process(2.5 * k, plots).status, Status::kOk);
    expect_sound(tracker);
  }
  int confirmed = 0;
  tracker.for_each([&](const Track& track) { confirmed += track.confirmed(); });
  EXPECT_EQ(confirmed, 1);
  ASSERT_NE(tracker.find(1), nullptr);
  EXPECT_LT((tracker.find(1)->position() - kBoat.at(47.5)).norm(), 60.0);
}

TEST(BadPlots, ACrowdOnOneSpotTakesNoMoreTracksThanThereAre) {
  Sea sea(6);
  TrackerConfig config;
  config.max_tracks = 60;
  VesselTracker tracker = make_tracker(config);
  for (int k = 0; k < 10; ++k) {
    const std::vector<Plot> plots(50, sea.plot(kBoat.at(2.5 * k), 2.5 * k));
    EXPECT_EQ(tracker.process(2.5 * k, plots).status, Status::kOk);
    expect_sound(tracker);
    EXPECT_EQ(tracker.size(), k == 0 ? 0 : 60);
  }
}

TEST(EmptyScans, AreNoTrouble) {
  VesselTracker tracker = make_tracker();
  for (int k = 0; k < 10; ++k) {
    const ScanReport report = tracker.process(2.5 * k, {});
    EXPECT_EQ(report.status, Status::kOk);
    EXPECT_TRUE(report.events.empty());
    EXPECT_TRUE(report.plot_track_id.empty());
  }
  EXPECT_EQ(tracker.size(), 0);
}

/// A scene of turning boats, clutter, bad plots, gaps and crowded moments; everything in every
/// track stays sound, and events tell the whole story.
void survive(Association association, std::uint64_t seed, bool rotating) {
  SCOPED_TRACE("association " + std::to_string(int(association)) + ", seed " +
               std::to_string(seed));
  TrackerConfig config;
  config.association = association;
  config.max_tracks = 60;
  Sea sea(seed);
  Draw& draw = sea.draw;
  VesselTracker tracker = make_tracker(config);
  Ledger ledger;
  std::vector<Boat> boats;
  for (int k = 0; k < 12; ++k)
    boats.push_back(
        {{draw.uniform(-3000, 3000), draw.uniform(-3000, 3000)}, 8.0 * draw.normals<2>()});
  double time_s = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double chance = draw.uniform(0, 1);
    const double dt_s = chance < 0.02   ? 0.0
                        : chance < 0.03 ? 600.0
                        : chance < 0.06 ? draw.uniform(0, 60)
                                        : 2.5;
    time_s += dt_s;
    std::vector<Plot> plots;
    for (Boat& boat : boats) {
      boat.start_m += dt_s * boat.velocity_mps;
      if (draw.uniform(0, 1) < 0.2) boat.velocity_mps = 8.0 * draw.normals<2>();
      if (boat.start_m.norm() > 5000.0) boat.start_m *= -0.5;
      if (draw.uniform(0, 1) > 0.8) continue;
      Plot plot = sea.plot(boat.start_m, time_s);
      if (rotating) plot.time_s -= draw.uniform(0, 2.5);
      plots.push_back(plot);
    }
    const int clutter = chance > 0.98 ? 300 : 15;
    for (int n = 0; n < clutter; ++n) plots.push_back(sea.clutter(time_s, 4000.0));
    int bad = 0;
    if (chance > 0.9) {
      plots.push_back({time_s, kNan, 0.0, {}});
      plots.push_back({time_s, 1e9 * draw.uniform(0, 1), 1e9, {}});
      ++bad;
    }
    const ScanReport report = tracker.process(time_s, plots);
    ASSERT_EQ(report.status, Status::kOk);
    EXPECT_EQ(report.rejected_plots, bad);
    ledger.note(report);
    ASSERT_EQ(ledger.ids, ids_of(tracker)) << "scan " << k;
    ASSERT_EQ(report.plot_track_id.size(), plots.size());
    for (const std::int64_t id : report.plot_track_id)
      ASSERT_TRUE(id == 0 || tracker.find(id) != nullptr)
          << "a plot of track " << id << " which is no more, scan " << k;
    for (const Event& event : report.events) {
      ASSERT_EQ(event.time_s, time_s);
      ASSERT_TRUE(event.kind != TrackEvent::kConfirmed ||
                  tracker.find(event.track_id)->status == TrackStatus::kConfirmed)
          << "confirmed in a scan in which it was not seen";
    }
    expect_sound(tracker);
    for (const Track* track : tracks_of(tracker, true))
      ASSERT_FALSE(exceeds_speed(track->kinematics, kTestRadar.max_speed_mps, kSpeedSigmas));
    if (testing::Test::HasFailure()) return;
  }
}

TEST(Fuzz, EveryNumberStaysSound) {
  survive(Association::kProbabilistic, 1, false);
  survive(Association::kGlobalNearest, 1, true);
}

TEST(Fuzz, OfMoreSeedsTheyDoSo) {
  for (std::uint64_t seed = 2; seed <= 4; ++seed)
    survive(Association::kProbabilistic, seed, seed % 2 == 0);
  survive(Association::kGlobalNearest, 2, false);
  for (std::uint64_t seed = 1; seed <= 2; ++seed)
    survive(Association::kNearest, seed, seed % 2 == 0);
}

}  // namespace
}  // namespace wakeline::bad_input_test
