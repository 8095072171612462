// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// From the first plots of a target to the end of its track.
#include <random>
#include <string>

#include "track/scene.hpp"

namespace wakeline::life_test {
namespace {

using namespace test;

const Boat kBoat{{1500.0, 800.0}, {-4.0, 6.0}};

TEST(Life, AStraightBoatIsConfirmedOnceAndKeepsItsNumber) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Sea sea(seed);
    VesselTracker tracker = make_tracker();
    Ledger ledger;
    int confirmed = 0;
    for (int k = 1; k <= 60; ++k) {
      const double time_s = 2.5 * k;
      const Plot plot = sea.plot(kBoat.at(time_s), time_s);
      const ScanReport report = tracker.process(time_s, {&plot, 1});
      ledger.note(report);
      ASSERT_EQ(report.status, Status::kOk);
      for (const Event& event : events_of(report, TrackEvent::kConfirmed)) {
        ++confirmed;
        EXPECT_EQ(event.track_id, 1);
        EXPECT_LT(event.tentative_id, 0);
        EXPECT_EQ(event.time_s, time_s);
      }
      if (k <= 2) {
        EXPECT_EQ(confirmed, 0) << "two plots are not enough";
      } else if (k >= 6) {
        ASSERT_EQ(confirmed, 1) << "seed " << seed << ", scan " << k;
        const Track* track = tracker.find(1);
        ASSERT_NE(track, nullptr);
        EXPECT_LT((track->position() - kBoat.at(time_s)).norm(), 80.0);
      }
    }
    EXPECT_EQ(ledger.ids, ids_of(tracker));
    EXPECT_LT(
        (Vec<double, 2>(tracker.find(1)->kinematics.mean[1], tracker.find(1)->kinematics.mean[3]) -
         kBoat.velocity_mps)
            .norm(),
        6.0);
  }
}

// What the clutter map learns of her first plots must not speak against her own next ones.
TEST(Life, AVesselAtAnchorThatIsSeenNowAndThenIsConfirmed) {
  const Vec<double, 2> middle_of_a_cell(3075.0, 75.0);
  int scans = 0;
  constexpr int kRuns = 60;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Sea sea(seed);
    VesselTracker tracker = make_tracker();
    int k = 0;
    for (bool confirmed = false; !confirmed; ++scans) {
      ASSERT_LE(++k, 60) << "seed " << seed;
      const Plot plot = sea.plot(middle_of_a_cell, 2.5 * k);
      const ScanReport report =
          tracker.process(2.5 * k, {&plot, sea.draw.uniform(0.0, 1.0) < 0.8 ? 1u : 0u});
      confirmed = !events_of(report, TrackEvent::kConfirmed).empty();
    }
  }
  EXPECT_LT(scans, 9 * kRuns);
}

// The posterior odds of a target, given plots that are false, are on average the prior ones.
TEST(Life, HoweverSureTheRadarIsATargetThatIsNotSeenIsVisibleWithAProbability) {
  TrackerConfig config;
  config.detection_probability = 1.0;
  config.gate_probability = 1.0 - 1e-15;
  const Plot plot = exact_plot({900.0, 400.0}, 0.0);
  VesselTracker tracker = make_tracker(config);
  (void)tracker.designate(0.0, 900.0, 400.0, 20.0);
  for (int k = 0; k < 40; ++k) {
    // Five looks without time between them for one plot.
    (void)tracker.process(2.5 * (k / 5), {&plot, k % 5 == 0 && k < 20 ? 1u : 0u});
    expect_sound(tracker);
  }
}

TEST(Life, FalsePlotsAloneAreNoEvidenceOnAverage) {
  constexpr double kDensity = 1e-4, kHalfSide_m = 300.0, kExistence = 0.999;
  constexpr int kScans = 2000;
  for (const double gate_probability : {0.5, 0.95})
    for (const double outlier_probability : {0.0, 0.2}) {
      const TrackerConfig config{.gate_probability = gate_probability,
                                 .clutter_density_per_m2 = kDensity,
                                 .outlier_probability = outlier_probability,
                                 .clutter_cell_m = 0.0,
                                 .visible_time_s = 0.0,
                                 .birth_density_per_m2 = 0.0,
                                 .survival_time_s = 1e12,
                                 .drop_position_std_m = 1e9,
                                 .drop_speed_factor = 1e6,
                                 .max_tracks = 1};
      Radar slow = kTestRadar;  // so that a gate holds no more plots than a track takes
      slow.max_speed_mps = 3.0;
      VesselTracker tracker = make_tracker(config, slow);
      Draw draw(1);
      std::poisson_distribution<int> count(kDensity * 4.0 * kHalfSide_m * kHalfSide_m);
      std::mt19937_64 random(1);
      double ratio = 0.0;
      for (int k = 1; k <= kScans; ++k) {
        const double time_s = 1e3 * k;
        const std::int64_t id = tracker.designate(time_s, 1500.0, 1000.0, 10.0);
        std::vector<Plot> plots(static_cast<std::size_t>(count(random)));
        for (Plot& plot : plots)
          plot = exact_plot({1500.0 + draw.uniform(-kHalfSide_m, kHalfSide_m),
                             1000.0 + draw.uniform(-kHalfSide_m, kHalfSide_m)},
                            time_s + 2.5);
        (void)tracker.process(time_s + 2.5, plots);
        const double existence = tracks_of(tracker, false).front()->existence;
        ratio += existence / (1.0 - existence) * (1.0 - kExistence) / kExistence / kScans;
        (void)tracker.drop(id);
      }
      EXPECT_NEAR(ratio, 1.0, 0.1) << gate_probability << ' ' << outlier_probability;
    }
}

/// The scan in which an errorless boat, seen as in the pattern, is confirmed; 0: never.
int confirmation_scan(const TrackerConfig& config, const std::string& pattern) {
  VesselTracker tracker = make_tracker(config);
  int k = 0;
  for (const char seen : pattern) {
    const double time_s = 2.5 * ++k;
    const Plot plot = exact_plot(kBoat.at(time_s), time_s);
    const ScanReport report = tracker.process(time_s, {&plot, seen == '1' ? 1u : 0u});
    if (!events_of(report, TrackEvent::kConfirmed).empty()) return k;
  }
  return 0;
}

TEST(Life, TracksStartHoweverSoonTheyEnd) {
  for (const int coast_scans_max : {0, 1}) {
    TrackerConfig config;
    config.coast_scans_max = coast_scans_max;
    VesselTracker tracker = make_tracker(config);
    for (int k = 0; k < 12; ++k) {
      const double time_s = 1.01 * kTestRadar.period_s * k;
      const Plot plot = exact_plot({1500.0 + 4.0 * time_s, 800.0}, time_s);
      (void)tracker.process(time_s, std::span(&plot, 1));
    }
    EXPECT_EQ(ids_of(tracker), std::set<std::int64_t>{1}) << coast_scans_max;
  }
}

TEST(Life, ConfirmationNeedsMOfTheLastN) {
  TrackerConfig config;
  config.confirm_existence = 0.5;  // so that only the count decides
  config.clutter_cell_m = 0.0;
  EXPECT_EQ(confirmation_scan(config, "11111"), 3);
  EXPECT_EQ(confirmation_scan(config, "110000"), 0);
  EXPECT_EQ(confirmation_scan(config, "11011"), 4);
  config.confirm_hits = 5;
  EXPECT_EQ(confirmation_scan(config, "1111111"), 5);
  EXPECT_EQ(confirmation_scan(config, "110111111"), 8) << "four of five are not five of five";
  config.confirm_hits = 4;
  EXPECT_EQ(confirmation_scan(config, "11011"), 5);
  config.confirm_hits = config.confirm_window = 32;
  EXPECT_EQ(confirmation_scan(config, std::string(40, '1')), 32);
}

TEST(Life, ABoatIsHeldHoweverFarTheRadarSeesIt) {
  const Radar coarse;  // 1 degree, so 80 to 520 m across
  for (const double range_m : {4500.0, 10e3, 20e3, 30e3}) {
    Sea sea(7, coarse);
    VesselTracker tracker = make_tracker({}, coarse);
    const Boat boat{{range_m, 0.0}, {-3.0, 6.0}};
    Ledger ledger;
    for (int k = 1; k <= 60; ++k) {
      const double time_s = 3.0 * k;
      const Plot plot = sea.plot(boat.at(time_s), time_s);
      ledger.note(tracker.process(time_s, {&plot, k % 5 == 0 ? 0u : 1u}));
    }
    EXPECT_EQ(ledger.ids, std::set<std::int64_t>{1}) << range_m << " m: one track, never lost";
    EXPECT_NE(track_at(tracker, boat.at(180.0), 3.0 * coarse.bearing_std_rad * range_m), nullptr)
        << range_m;
  }
}

TEST(Life, ConfirmationNeedsExistence) {
  TrackerConfig config;
  config.confirm_existence = 1.0;
  EXPECT_EQ(confirmation_scan(config, std::string(40, '1')), 0);
}

TEST(Life, PlotsAreGivenToTheirTrack) {
  Sea sea(3);
  VesselTracker tracker = make_tracker();
  for (int k = 1; k <= 40; ++k) {
    const double time_s = 2.5 * k;
    const std::vector<Plot> plots{sea.plot({-3000.0, 2000.0 - 300.0 * (k % 7)}, time_s),
                                  sea.plot(kBoat.at(time_s), time_s)};
    const ScanReport report = tracker.process(time_s, plots);
    ASSERT_EQ(report.plot_track_id.size(), 2u);
    EXPECT_EQ(report.plot_track_id[0], 0) << "an echo that jumps about is nobody's";
    EXPECT_TRUE(k > 1 || report.plot_track_id[1] == 0);
    EXPECT_TRUE(k < 6 || report.plot_track_id[1] == 1) << "scan " << k;
    for (const std::int64_t id : report.plot_track_id)
      EXPECT_TRUE(id == 0 || tracker.find(id) != nullptr) << id;
  }
}

/// One boat, seen in each of its first scans and then as the repeated pattern says, keeps one
/// number.
void expect_held(int first_scans, const std::string& pattern, double speed_mps,
                 std::uint64_t seed) {
  SCOPED_TRACE(pattern + " at " + std::to_string(speed_mps) + " m/s, seed " + std::to_string(seed));
  Sea sea(seed);
  VesselTracker tracker = make_tracker();
  const Boat boat{{200.0, -0.5 * speed_mps * 750.0}, {0.0, speed_mps}};
  bool confirmed = false;
  for (int k = 0; k < 300; ++k) {
    const double time_s = 2.5 * k;
    const Plot plot = sea.plot(boat.at(time_s), time_s);
    const bool seen = k < first_scans ||
                      pattern[static_cast<std::size_t>(k - first_scans) % pattern.size()] == '1';
    const ScanReport report = tracker.process(time_s, {&plot, seen ? 1u : 0u});
    for (const Event& event : report.events) {
      if (event.kind == TrackEvent::kConfirmed) {
        ASSERT_FALSE(confirmed) << "a second number in scan " << k;
        confirmed = true;
      }
      const bool kept = event.kind != TrackEvent::kLost || event.track_id < 0;
      ASSERT_TRUE(kept) << "lost in scan " << k;
    }
  }
  ASSERT_TRUE(confirmed);
  const Track* track = tracker.find(1);
  EXPECT_LT((track->position() - boat.at(track->time_s)).norm(), 150.0);
}

TEST(Life, ATargetSeenInFiveOfTenScansIsHeld) {
  for (const double speed_mps : {0.0, 3.0, 8.0, 15.0, 20.0})
    for (const int first_scans : {5, 10})
      for (const char* pattern : {"1010101010", "0000011111", "1110000011", "1111100000",
                                  "1110110000", "1100110010", "1101101000"})
        for (std::uint64_t seed = 1; seed <= 3; ++seed)
          expect_held(first_scans, pattern, speed_mps, seed);
}

TEST(Life, CoastsThenIsHeldThenLostOnce) {
  const TrackerConfig config;
  Sea sea(5);
  VesselTracker tracker = make_tracker(config);
  double time_s = 0.0;
  for (int k = 0; k < 20; ++k, time_s += 2.5) {
    const Plot plot = sea.plot(kBoat.at(time_s), time_s);
    EXPECT_TRUE(events_of(tracker.process(time_s, {&plot, 1}), TrackEvent::kCoasting).empty());
  }
  ASSERT_NE(tracker.find(1), nullptr);
  EXPECT_EQ(tracker.find(1)->status, TrackStatus::kConfirmed);
  const double patience = allowed_misses(config, *tracker.find(1));
  std::vector<TrackEvent> story;
  for (int missed = 1; missed <= 30; ++missed, time_s += 2.5) {
    for (const Event& event : tracker.process(time_s, {}).events) {
      EXPECT_EQ(event.track_id, 1);
      EXPECT_LT(event.tentative_id, 0);
      story.push_back(event.kind);
      EXPECT_EQ(event.reason,
                event.kind == TrackEvent::kLost ? LossReason::kMissed : LossReason::kNone);
    }
    const Track* track = tracker.find(1);
    if (track == nullptr) continue;
    EXPECT_LE(missed, patience);
    EXPECT_EQ(track->status, track->shown() ? TrackStatus::kCoasting : TrackStatus::kHeld);
    EXPECT_TRUE(missed > 2 || track->shown()) << "two misses in a row are not unlikely";
    EXPECT_TRUE(missed < 5 || !track->shown()) << "five are";
    EXPECT_EQ(track->time_s, time_s);
    EXPECT_TRUE(std::isnan(track->nis));
  }
  EXPECT_EQ(story, (std::vector<TrackEvent>{TrackEvent::kCoasting, TrackEvent::kLost}));
  EXPECT_EQ(tracker.size(), 0);
}

TEST(Life, ATrackThatIsSeenAgainCoastsAgain) {
  Sea sea(6);
  VesselTracker tracker = make_tracker();
  int coasting = 0;
  for (int k = 0; k < 40; ++k) {
    const double time_s = 2.5 * k;
    const Plot plot = sea.plot(kBoat.at(time_s), time_s);
    const bool seen = k < 10 || (k % 10 != 3 && k % 10 != 4);
    const ScanReport report = tracker.process(time_s, {&plot, seen ? 1u : 0u});
    for (const Event& event : events_of(report, TrackEvent::kCoasting)) {
      EXPECT_EQ(event.track_id, 1);
      EXPECT_EQ(k % 10, 3);
      ++coasting;
    }
  }
  EXPECT_EQ(coasting, 3);
  EXPECT_EQ(tracker.find(1)->status, TrackStatus::kConfirmed);
}

TEST(Life, NothingAboveTheSpeedLimitIsEverConfirmed) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Sea sea(seed);
    VesselTracker tracker = make_tracker();
    const Boat plane{{-4000.0, 1000.0}, {60.0, 10.0}};
    for (int k = 0; k < 60; ++k) {
      const double time_s = 2.5 * k;
      const Plot plot = sea.plot(plane.at(time_s), time_s);
      const ScanReport report = tracker.process(time_s, {&plot, 1});
      EXPECT_TRUE(events_of(report, TrackEvent::kConfirmed).empty());
    }
    EXPECT_TRUE(tracks_of(tracker, true).empty());
  }
}

/// A boat that has the speed of 15 m/s but for 50 s; the limit is 25 m/s.
ScanReport sprint(VesselTracker& tracker, Sea& sea, int k, double speed_mps, double& north_m) {
  north_m += 2.5 * (k >= 25 && k < 45 ? speed_mps : 15.0);
  const Plot plot = sea.plot({north_m, 0.0}, 2.5 * k);
  return tracker.process(2.5 * k, {&plot, 1});
}

TEST(Life, ATrackAboveTheSpeedLimitIsHeldUntilItIsCertainlyTooFastAndThenLostForThatReason) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const double speed_mps : {25.5, 33.0}) {
      Sea sea(seed);
      VesselTracker tracker = make_tracker();
      double north_m = 500.0;
      std::vector<Event> lost;
      for (int k = 0; k < 60; ++k) {
        const ScanReport report = sprint(tracker, sea, k, speed_mps, north_m);
        for (const Event& event : events_of(report, TrackEvent::kLost))
          if (event.track_id > 0) lost.push_back(event);
      }
      ASSERT_EQ(lost.size(), speed_mps > 30.0 ? 1u : 0u) << seed << ' ' << speed_mps;
      for (const Event& event : lost) EXPECT_EQ(event.reason, LossReason::kTooFast);
      EXPECT_EQ(ids_of(tracker), std::set<std::int64_t>{speed_mps > 30.0 ? 2 : 1});
    }
  }
}

TEST(Life, AFullTrackerSaysSoOnce) {
  TrackerConfig config;
  config.max_tracks = 3;
  VesselTracker tracker = make_tracker(config);
  std::vector<int> full;
  for (int k = 0; k < 40; ++k) {
    std::vector<Plot> plots;
    for (int n = 0; n < (k < 10 ? 5 : k < 30 ? 1 : 5); ++n)
      plots.push_back(exact_plot({1000.0 * n + 500.0, 300.0}, 2.5 * k));
    for (const Event& event : tracker.process(2.5 * k, plots).events)
      if (event.kind == TrackEvent::kFull) full.push_back(k);
  }
  EXPECT_EQ(full, (std::vector<int>{1, 31}));
}

TEST(Life, AnEchoThatWandersOverItsSpotIsOneTrackAtRest) {
  Sea sea(8);
  VesselTracker tracker = make_tracker();
  std::set<std::int64_t> ids;
  for (int k = 0; k < 200; ++k) {
    const double time_s = 2.5 * k;
    std::vector<Plot> plots{sea.plot(kBoat.at(time_s), time_s)};
    if (sea.draw.uniform(0, 1) < 0.9) plots.push_back(sea.plot({-900.0, 300.0}, time_s));
    (void)tracker.process(time_s, plots);
    for (const Track* track : tracks_of(tracker, true)) ids.insert(track->id);
  }
  EXPECT_EQ(ids.size(), 2u);
  const Track* rock = track_at(tracker, {-900.0, 300.0});
  ASSERT_NE(rock, nullptr);
  EXPECT_LT(rock->speed_mps(), 3.0);
}

}  // namespace
}  // namespace wakeline::life_test
