// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Many targets: whose plot is whose, two tracks on one target, and what happens when room is short.
#include <algorithm>
#include <cmath>

#include "track/scene.hpp"

namespace wakeline::many_test {
namespace {

using namespace test;

constexpr Association kAssociations[] = {Association::kProbabilistic, Association::kGlobalNearest,
                                         Association::kNearest};

/// Follows two boats, in every association, and expects that each keeps its number from the tenth
/// scan to the last.
void expect_each_keeps_its_number(const Boat& a, const Boat& b, int scans) {
  for (const Association association : kAssociations)
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE("association " + std::to_string(int(association)) + ", seed " +
                   std::to_string(seed));
      TrackerConfig config;
      config.association = association;
      Sea sea(seed);
      VesselTracker tracker = make_tracker(config);
      std::int64_t id_a = 0, id_b = 0;
      for (int k = 0; k < scans; ++k) {
        const double time_s = 2.5 * k;
        const std::vector<Plot> plots{sea.plot(a.at(time_s), time_s),
                                      sea.plot(b.at(time_s), time_s)};
        const ScanReport report = tracker.process(time_s, plots);
        if (k < 10) continue;
        if (report.plot_track_id[0] > 0 && k > 10) {
          EXPECT_NE(report.plot_track_id[0], report.plot_track_id[1]) << "scan " << k;
        }
        const bool first = k == 10, last = k == scans - 1;
        if (!first && !last) continue;
        const Track* track_a = track_at(tracker, a.at(time_s));
        const Track* track_b = track_at(tracker, b.at(time_s));
        ASSERT_NE(track_a, nullptr);
        ASSERT_NE(track_b, nullptr);
        EXPECT_NE(track_a->id, track_b->id);
        if (last) {
          EXPECT_EQ(track_a->id, id_a);
          EXPECT_EQ(track_b->id, id_b);
        }
        id_a = track_a->id;
        id_b = track_b->id;
      }
    }
}

TEST(Many, CrossingTargetsKeepTheirNumbers) {
  expect_each_keeps_its_number({{1000.0, -700.0}, {0.0, 10.0}}, {{1700.0, 0.0}, {-10.0, 0.0}}, 56);
  expect_each_keeps_its_number({{800.0, -700.0}, {0.0, 10.0}}, {{800.0, 700.0}, {0.0, -10.0}}, 56);
}

TEST(Many, CloseParallelTargetsDoNotShareANumber) {
  expect_each_keeps_its_number({{1000.0, -600.0}, {0.0, 8.0}}, {{1120.0, -600.0}, {0.0, 8.0}}, 60);
}

/// Scans of a ship of 80 m, seen at bow and stern, and of a boat that crosses 60 m ahead of her.
std::vector<std::vector<Plot>> ship_and_boat(std::uint64_t seed) {
  Sea sea(seed);
  const Boat bow{{1000.0, -400.0}, {0.0, 7.0}}, stern{{1000.0, -480.0}, {0.0, 7.0}};
  const Boat boat{{400.0, 80.0}, {10.0, 0.0}};
  std::vector<std::vector<Plot>> scans;
  for (int k = 0; k < 60; ++k) {
    std::vector<Plot> plots;
    for (const Boat& echo : {bow, stern, boat})
      if (sea.draw.uniform(0, 1) < 0.9) plots.push_back(sea.plot(echo.at(2.5 * k), 2.5 * k));
    scans.push_back(plots);
  }
  return scans;
}

TEST(Many, AShipThatGivesTwoPlotsHasOneTrackOfATrackerThatKnowsHerLength) {
  for (const double length_m : {0.0, 120.0})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      TrackerConfig config;
      config.vessel_length_m = length_m;
      VesselTracker tracker = make_tracker(config);
      std::set<std::int64_t> numbers;
      double time_s = 0.0;
      for (const std::vector<Plot>& plots : ship_and_boat(seed)) {
        (void)tracker.process(time_s, plots);
        time_s += 2.5;
        for (const Track* track : tracks_of(tracker, true)) numbers.insert(track->id);
      }
      EXPECT_EQ(numbers.size(), length_m > 0.0 ? 2u : 3u) << "seed " << seed;
      EXPECT_EQ(tracks_of(tracker, true).size(), numbers.size());
      const Track* ship = track_at(tracker, {1000.0, -440.0 + 7.0 * (time_s - 2.5)}, 60.0);
      ASSERT_NE(ship, nullptr);
      EXPECT_NEAR(ship->velocity()[1], 7.0, 1.5);
      EXPECT_NE(track_at(tracker, {400.0 + 10.0 * (time_s - 2.5), 80.0}, 40.0), nullptr);
    }
}

TEST(Many, OfTwoTracksOnOneTargetTheOlderNumberStays) {
  const Boat boat{{1200.0, 500.0}, {3.0, -2.0}};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Sea sea(seed);
    VesselTracker tracker = make_tracker();
    std::int64_t second = 0;
    int ended = 0;
    for (int k = 0; k < 40; ++k) {
      const double time_s = 2.5 * k;
      const Plot plot = sea.plot(boat.at(time_s), time_s);
      for (const Event& event : events_of(tracker.process(time_s, {&plot, 1}), TrackEvent::kLost))
        if (event.track_id > 0) {
          EXPECT_EQ(event.track_id, second);
          ++ended;
        }
      if (k == 15) {
        const Track* first = tracker.find(1);
        ASSERT_NE(first, nullptr);
        // Two periods before it would be taken as the first.
        const double before_s = time_s - 2.1 * kTestRadar.period_s;
        second = tracker.designate(before_s, boat.at(before_s)[0], boat.at(before_s)[1], 15.0);
        ASSERT_EQ(second, 2);
      }
    }
    EXPECT_EQ(ended, 1);
    EXPECT_NE(tracker.find(1), nullptr);
    EXPECT_EQ(tracker.find(second), nullptr);
  }
}

/// Boats at rest on a grid, far from each other.
std::vector<Plot> fleet(Sea& sea, int count, double time_s) {
  std::vector<Plot> plots;
  for (int k = 0; k < count; ++k) {
    const Vec<double, 2> place(600.0 * (k % 8) - 2000.0, 600.0 * (k / 8) + 500.0);
    plots.push_back(sea.plot(place, time_s));
  }
  return plots;
}

TEST(Room, MoreTargetsThanTracks) {
  TrackerConfig config;
  config.max_tracks = 10;
  Sea sea(1);
  VesselTracker tracker = make_tracker(config);
  Ledger ledger;
  std::set<std::int64_t> confirmed;
  for (int k = 0; k < 60; ++k) {
    const double time_s = 2.5 * k;
    const ScanReport report = tracker.process(time_s, fleet(sea, 40, time_s));
    ledger.note(report);
    EXPECT_EQ(ledger.ids, ids_of(tracker)) << "scan " << k;
    ASSERT_LE(tracker.size(), 10);
    for (const std::int64_t id : confirmed) EXPECT_NE(tracker.find(id), nullptr) << "displaced";
    for (const Event& event : events_of(report, TrackEvent::kConfirmed))
      confirmed.insert(event.track_id);
    for (const std::int64_t id : report.plot_track_id) {
      EXPECT_TRUE(id == 0 || tracker.find(id) != nullptr) << id;
    }
  }
  EXPECT_EQ(confirmed.size(), 10u);
}

TEST(Room, TheWeakestTentativeTrackGivesWay) {
  TrackerConfig config;
  config.max_tracks = 1;
  config.clutter_cell_m = 0.0;
  VesselTracker tracker = make_tracker(config);
  const Vec<double, 2> here(1000.0, 0.0), there(-1000.0, 0.0);
  const auto scan = [&](double time_s, std::vector<Vec<double, 2>> places) {
    std::vector<Plot> plots;
    for (const auto& place : places) plots.push_back(exact_plot(place, time_s));
    return tracker.process(time_s, plots);
  };
  (void)scan(0.0, {here});
  EXPECT_EQ(events_of(scan(2.5, {here}), TrackEvent::kStarted).size(), 1u);
  EXPECT_EQ(tracker.size(), 1);
  const std::int64_t first = tracks_of(tracker, false)[0]->id;
  (void)scan(5.0, {there});  // the first is missed: weaker than a new one
  const ScanReport report = scan(7.5, {there});
  ASSERT_EQ(tracker.size(), 1);
  EXPECT_EQ(tracker.find(first), nullptr);
  const std::int64_t second = tracks_of(tracker, false)[0]->id;
  EXPECT_EQ(events_of(report, TrackEvent::kStarted).size(), 1u);
  const std::vector<Event> lost = events_of(report, TrackEvent::kLost);
  ASSERT_EQ(lost.size(), 1u) << "a track that gives way is announced";
  EXPECT_EQ(lost[0].reason, LossReason::kDisplaced);
  EXPECT_EQ(lost[0].track_id, first);
  for (int k = 4; k < 10; ++k) (void)scan(2.5 * k, {there});
  ASSERT_NE(tracker.find(1), nullptr);
  EXPECT_EQ(tracker.find(1)->tentative_id, second);
  for (int k = 10; k < 14; ++k) (void)scan(2.5 * k, {here});  // no room beside a confirmed one
  EXPECT_EQ(ids_of(tracker), std::set<std::int64_t>{1});
}

TEST(Room, WhoFollowsTheEventsKnowsAllTracksHoweverManyGiveWay) {
  TrackerConfig config;
  config.max_tracks = 2;
  config.max_plots = 20;
  config.clutter_memory_s = 6000.0;
  VesselTracker tracker = make_tracker(config);
  std::set<std::int64_t> known;
  std::size_t most_started = 0;
  const auto scan = [&](double time_s, int places) {
    std::vector<Plot> plots;
    for (int n = 0; n < places; ++n)
      plots.push_back(exact_plot({1000.0 + 1500.0 * n, 0.0}, time_s));
    const ScanReport report = tracker.process(time_s, plots);
    for (const Event& event : report.events) {
      if (event.kind == TrackEvent::kStarted) {
        EXPECT_TRUE(known.insert(event.track_id).second);
      } else if (event.kind == TrackEvent::kLost) {
        EXPECT_EQ(known.erase(event.track_id), 1u);
      }
    }
    most_started = std::max(most_started, events_of(report, TrackEvent::kStarted).size());
    EXPECT_EQ(ids_of(tracker), known) << time_s;
  };
  // The farther off the less clutter is learned, so that each plot is worth more than those before.
  double time_s = 0.0;
  for (int k = 0; k < 20; ++k) scan(time_s += 100.0, 20 - k);
  scan(time_s += 100.0, 20);
  scan(time_s + 2.5, 20);
  EXPECT_EQ(most_started, 2u);
}

TEST(Room, ANewTrackThatCannotStartDisplacesNobody) {
  TrackerConfig config;
  config.max_tracks = 1;
  VesselTracker tracker = make_tracker(config);
  for (const double time_s : {0.0, 2.5}) {
    const Plot plot = exact_plot({1000.0, 0.0}, time_s);
    (void)tracker.process(time_s, {&plot, 1});
  }
  ASSERT_EQ(tracker.size(), 1);
  const std::set<std::int64_t> before = ids_of(tracker);
  EXPECT_EQ(tracker.designate(2.5, 0.0, 0.0, std::nan("")), 0);
  EXPECT_EQ(ids_of(tracker), before);
}

TEST(Room, MorePlotsThanAreTaken) {
  TrackerConfig config;
  config.max_plots = 20;
  Sea sea(2);
  VesselTracker tracker = make_tracker(config);
  for (int k = 0; k < 10; ++k) {
    const double time_s = 2.5 * k;
    const ScanReport report = tracker.process(time_s, fleet(sea, 24, time_s));
    EXPECT_EQ(report.status, Status::kOk);
    EXPECT_EQ(report.rejected_plots, 4);
    EXPECT_EQ(report.plot_track_id.size(), 20u);
  }
  EXPECT_EQ(tracks_of(tracker, true).size(), 20u);
}

TEST(Room, TenThousandPlotsInAScan) {
  for (const Association association : kAssociations) {
    TrackerConfig config;
    config.association = association;
    Sea sea(3);
    VesselTracker tracker = make_tracker(config);
    const Boat boat{{1500.0, 800.0}, {-4.0, 6.0}};
    for (int k = 0; k < 12; ++k) {
      const double time_s = 2.5 * k;
      std::vector<Plot> plots{sea.plot(boat.at(time_s), time_s)};
      const bool flood = k == 9 || k == 10;
      while (flood && plots.size() < 10'000) plots.push_back(sea.clutter(time_s, 20'000.0));
      const ScanReport report = tracker.process(time_s, plots);
      EXPECT_EQ(report.status, Status::kOk);
      EXPECT_EQ(report.rejected_plots, 0);
      EXPECT_EQ(report.plot_track_id.size(), plots.size());
    }
    expect_sound(tracker);
    EXPECT_NE(tracker.find(1), nullptr) << "the boat that was there before";
  }
}

/// Scans of shown tracks in the second half of all, among the echoes of a breaking shoal.
int tracks_of_a_shoal(double clutter_cell_m, std::uint64_t seed) {
  TrackerConfig config;
  config.clutter_cell_m = clutter_cell_m;
  Sea sea(seed);
  VesselTracker tracker = make_tracker(config);
  int late = 0;
  for (int k = 0; k < 400; ++k) {
    const double time_s = 2.5 * k;
    std::vector<Plot> plots;
    for (int n = 0; n < 4; ++n)
      plots.push_back(exact_plot(
          {900.0 + sea.draw.uniform(-150, 150), 500.0 + sea.draw.uniform(-150, 150)}, time_s));
    (void)tracker.process(time_s, plots);
    if (k < 200) continue;
    tracker.for_each([&](const Track& track) { late += track.shown(); });
  }
  return late;
}

TEST(Many, TheClutterMapQuietensAShoal) {
  int without = 0, with = 0;
  constexpr int kShoals = 20;
  for (std::uint64_t seed = 4; seed < 4 + kShoals; ++seed) {
    without += tracks_of_a_shoal(0.0, seed);
    with += tracks_of_a_shoal(150.0, seed);
  }
  EXPECT_GE(without, 200 * kShoals) << "the scene is not hard enough to show anything";
  EXPECT_LE(3 * with, 2 * without) << with;
}

/// The probability of existence that a start among false plots has, one of which came in every scan
/// before, in a cell of the map.
double existence_of_a_start(double clutter_density_per_m2, double cell_m, double memory_s) {
  VesselTracker tracker = make_tracker({.clutter_density_per_m2 = clutter_density_per_m2,
                                        .clutter_cell_m = cell_m,
                                        .clutter_memory_s = memory_s,
                                        .birth_density_per_m2 = 1e-22});
  constexpr double kRange_m = 60e3;  // where the cell is a small part of its ring
  double existence = 0.0;
  for (int k = 0; k <= 1001;
       ++k) {  // on three spots in turn, too far apart for a start; at last not
    const double spot_m = k == 1001 ? k - 1 : k;
    Plot plot = exact_plot({kRange_m + 400.0 * std::fmod(spot_m, 3.0), 0.0}, 2.5 * k);
    plot.own = OwnShip{.north_m = cell_m / 2 - kRange_m, .east_m = cell_m / 2};
    (void)tracker.process(2.5 * k, {&plot, 1});
    EXPECT_EQ(tracker.size(), k == 1001 ? 1 : 0);
  }
  tracker.for_each([&](const Track& track) { existence = track.existence; });
  return existence;
}

TEST(Many, AFalsePlotInEveryScanIsADensityOfOnePerCellButForTheStartsOwn) {
  constexpr double kCell = 40'000.0;
  for (const double memory_s : {2.5, 10.0, 60.0}) {
    const double of_others = std::exp(-2.5 / memory_s);  // all but the plot before
    const double known = existence_of_a_start(of_others / (kCell * kCell), 0.0, memory_s);
    EXPECT_NEAR(existence_of_a_start(1e-12, kCell, memory_s) / known, 1.0, 0.06)
        << memory_s << " s";
  }
}

}  // namespace
}  // namespace wakeline::many_test
