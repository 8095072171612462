// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A turn of the antenna in sectors.
#include <algorithm>
#include <functional>
#include <limits>

#include "support/malloc_fence.hpp"
#include "track/scene.hpp"

namespace wakeline::sector_test {
namespace {

using namespace test;

constexpr double kTurn = Beam::kTurn;
const double kPeriod_s = kTestRadar.period_s;

/// Boats that circle own ship or pass it, some across north.
std::vector<Boat> boats() {
  return {{{1500.0, -150.0}, {-1.0, 4.0}}, {{2200.0, 200.0}, {2.0, -5.0}},
          {{-1800.0, 900.0}, {6.0, 3.0}},  {{300.0, 2500.0}, {0.0, -8.0}},
          {{-700.0, -1400.0}, {3.0, 9.0}}, {{-2600.0, -40.0}, {0.0, 1.0}},
          {{900.0, 1100.0}, {-7.0, -2.0}}};
}

/// Where own ship is.
using Course = std::function<OwnShip(double)>;
OwnShip at_rest(double) { return {}; }

/// The bearing of the beam, north at time 0, of an antenna that turns with the ship.
struct Antenna {
  Course own = at_rest;
  double turn_rate_rad_s = 0.0;  ///< of the ship
  double period_s = kPeriod_s;

  [[nodiscard]] double bearing_rad(double time_s) const {
    return (kTurn / period_s + turn_rate_rad_s) * time_s;
  }
  [[nodiscard]] double time_s(double bearing_rad) const {
    return bearing_rad / (kTurn / period_s + turn_rate_rad_s);
  }
};

/// The plots of all boats up to an angle of the beam, in order.
std::vector<Plot> record(const std::vector<Boat>& boats, const Antenna& antenna, double to_rad,
                         std::uint64_t seed, double detection = 1.0) {
  Sea sea(seed);
  std::vector<Plot> plots;
  for (const Boat& boat : boats) {
    const auto seen_rad = [&](double time_s) {
      const Vec<double, 2> d = boat.at(time_s) - antenna.own(time_s).position<double>();
      return std::atan2(d[1], d[0]);
    };
    for (double pass_rad = compass_angle(seen_rad(0.0)); pass_rad < to_rad; pass_rad += kTurn) {
      double time_s = antenna.time_s(pass_rad);
      for (int k = 0; k < 4; ++k) {
        pass_rad = Beam::unwrapped(seen_rad(time_s), pass_rad);
        time_s = antenna.time_s(pass_rad);
      }
      if (sea.draw.uniform(0.0, 1.0) > detection) continue;
      const OwnShip own = antenna.own(time_s);
      Plot plot = sea.plot(boat.at(time_s) - own.position<double>(), time_s);
      plot.own = own;
      plots.push_back(plot);
    }
  }
  std::sort(plots.begin(), plots.end(),
            [](const Plot& a, const Plot& b) { return a.time_s < b.time_s; });
  return plots;
}

/// Gives plots to a tracker sector by sector, whose ends are angles of the beam; `f(report, plots)`
/// after each.
template <class Function>
void feed(VesselTracker& tracker, const std::vector<Plot>& plots, const Antenna& antenna,
          const std::vector<double>& ends_rad, Function&& f, std::size_t first = 0) {
  std::size_t next = 0;
  const auto up_to = [&](double time_s) {
    const std::size_t begin = next;
    while (next < plots.size() && plots[next].time_s <= time_s) ++next;
    return std::span(plots).subspan(begin, next - begin);
  };
  double from_rad = 0.0;
  for (std::size_t k = 0; k < ends_rad.size(); ++k) {
    const double time_s = antenna.time_s(ends_rad[k]);
    const std::span<const Plot> seen = up_to(time_s);
    const double start_rad = compass_angle(from_rad);
    const Sector sector{0,      start_rad, start_rad + ends_rad[k] - from_rad,
                        time_s, seen,      antenna.own(time_s)};
    from_rad = ends_rad[k];
    if (k < first) continue;
    const ScanReport report = tracker.sector(sector);
    EXPECT_EQ(report.status, Status::kOk);
    f(report, seen);
  }
}

std::vector<double> even_ends(int sectors, int turns) {
  std::vector<double> ends_rad;
  for (int k = 1; k <= sectors * turns; ++k) ends_rad.push_back(kTurn * k / sectors);
  return ends_rad;
}

std::vector<double> uneven_ends(int turns) {
  Draw draw(11);
  std::vector<double> ends_rad{draw.uniform(0.01, 0.5)};
  while (ends_rad.back() < kTurn * turns)
    ends_rad.push_back(ends_rad.back() + draw.uniform(0.01, 1.5));
  return ends_rad;
}

/// Every boat has one track, which knows where it is.
void expect_all_tracked(const VesselTracker& tracker, const std::vector<Boat>& boats, double time_s,
                        double gate_m = 80.0) {
  EXPECT_EQ(tracks_of(tracker, false).size(), boats.size());
  for (const Boat& boat : boats) {
    int near = 0;
    for (const Track* track : tracks_of(tracker, true)) {
      const Gaussian<4> now = tracker.kinematics_at(*track, time_s);
      near += (Vec<double, 2>(now.mean[0], now.mean[2]) - boat.at(time_s)).norm() < gate_m;
    }
    EXPECT_EQ(near, 1) << boat.start_m.transpose();
  }
}

TEST(Sectors, AWholeTurnIsAScanBitForBit) {
  VesselTracker scans = make_tracker(), turns = make_tracker();
  const std::vector<Plot> plots = record(boats(), {}, 40 * kTurn, 1, 0.8);
  std::size_t next = 0;
  for (int k = 1; k <= 40; ++k) {
    const std::size_t begin = next;
    while (next < plots.size() && plots[next].time_s <= k * kPeriod_s) ++next;
    const auto seen = std::span(plots).subspan(begin, next - begin);
    const double from_rad = 0.1 * k;
    const ScanReport scan = scans.process(k * kPeriod_s, seen);
    const ScanReport turn = turns.sector({0, from_rad, from_rad + kTurn, k * kPeriod_s, seen});
    EXPECT_TRUE(std::ranges::equal(scan.plot_track_id, turn.plot_track_id));
    EXPECT_EQ(scan.events.size(), turn.events.size());
    ASSERT_EQ(scans.save(), turns.save()) << k;
  }
}

TEST(Sectors, OfAnyWidthGiveEachTargetOneUpdateATurnAndNoMiss) {
  constexpr int kTurns = 40;
  double turns_s = 0.0;  // when the last boat is confirmed where whole turns are given
  VesselTracker by_turns = make_tracker();
  feed(by_turns, record(boats(), {}, kTurns * kTurn, 2), {}, even_ends(1, kTurns),
       [&](const ScanReport& report, std::span<const Plot>) {
         for (const Event& event : events_of(report, TrackEvent::kConfirmed))
           turns_s = event.time_s;
       });
  for (const std::vector<double>& ends_rad :
       {even_ends(2, kTurns), even_ends(8, kTurns), even_ends(16, kTurns), even_ends(32, kTurns),
        even_ends(64, kTurns), uneven_ends(kTurns)}) {
    SCOPED_TRACE(ends_rad.size());
    VesselTracker tracker = make_tracker();
    const std::vector<Plot> plots = record(boats(), {}, (kTurns + 1) * kTurn, 2);
    Ledger ledger;
    std::map<std::int64_t, double> confirmed_s;
    double time_s = 0.0;
    feed(tracker, plots, {}, ends_rad, [&](const ScanReport& report, std::span<const Plot>) {
      ledger.note(report);
      ASSERT_EQ(ledger.ids, ids_of(tracker));
      EXPECT_EQ(report.rejected_plots, 0);
      for (const Event& event : report.events) {
        EXPECT_NE(event.kind, TrackEvent::kCoasting) << "track " << event.track_id;
        EXPECT_FALSE(event.kind == TrackEvent::kLost && event.track_id > 0);
        if (event.kind == TrackEvent::kConfirmed) confirmed_s[event.track_id] = event.time_s;
      }
      time_s = tracker.time_s();
      expect_sound(tracker);
    });
    expect_all_tracked(tracker, boats(), time_s);
    EXPECT_EQ(confirmed_s.size(), boats().size());
    for (const auto& [id, at_s] : confirmed_s) EXPECT_LE(at_s, turns_s + 0.5 * kPeriod_s) << id;
    for (const Track* track : tracks_of(tracker, true)) {
      EXPECT_EQ(track->hits, track->scans);
      EXPECT_GE(track->hits, kTurns - 1);
      EXPECT_LE(track->hits, kTurns + 1);
    }
  }
}

TEST(Sectors, AreAsAccurateAsTurns) {
  constexpr int kTurns = 60;
  const auto rmse = [&](int sectors) {
    double sum = 0.0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      VesselTracker tracker = make_tracker();
      int call = 0;
      feed(tracker, record(boats(), {}, kTurns * kTurn, seed, 0.9), {}, even_ends(sectors, kTurns),
           [&](const ScanReport&, std::span<const Plot>) {
             if (++call % sectors != 0 || call < 10 * sectors) return;
             for (const Boat& boat : boats()) {
               const Track* track = track_at(tracker, boat.at(tracker.time_s()), 200.0);
               if (track == nullptr) continue;
               sum += (track->position() - boat.at(track->time_s)).squaredNorm();
               ++count;
             }
           });
    }
    EXPECT_GE(count, 6 * 7 * 49);
    return std::sqrt(sum / count);
  };
  const double turns = rmse(1);
  for (const int sectors : {8, 32}) EXPECT_NEAR(rmse(sectors) / turns, 1.0, 0.05) << sectors;
}

TEST(Sectors, AnAntennaMayTurnAtAnotherRateThanItsPeriodSays) {
  for (const double periods : {0.25, 0.5, 2.5, 4.0, 6.0}) {
    const Antenna antenna{.period_s = periods * kPeriod_s};
    VesselTracker tracker = make_tracker();
    feed(tracker, record(boats(), antenna, 12 * kTurn, 7, 0.9), antenna, even_ends(16, 12),
         [](const ScanReport&, std::span<const Plot>) {});
    SCOPED_TRACE(periods);
    expect_all_tracked(tracker, boats(), 12 * antenna.period_s, 150.0);
  }
}

TEST(Sectors, ATrackIsUpdatedAsSoonAsTheBeamHasPassedItsGate) {
  constexpr int kSectors = 32, kTurns = 30;
  VesselTracker tracker = make_tracker();
  std::vector<double> wait_s;
  std::map<std::int64_t, double> before_s;
  feed(tracker, record(boats(), {}, kTurns * kTurn, 3), {}, even_ends(kSectors, kTurns),
       [&](const ScanReport&, std::span<const Plot>) {
         for (const Track* track : tracks_of(tracker, true)) {
           double& time_s = before_s[track->id];
           if (track->time_s > time_s) wait_s.push_back(tracker.time_s() - track->time_s);
           time_s = track->time_s;
         }
       });
  ASSERT_GE(wait_s.size(), 7u * (kTurns - 4));
  std::sort(wait_s.begin(), wait_s.end());
  EXPECT_LE(wait_s[wait_s.size() / 2], 0.1);
  EXPECT_LE(wait_s.back(), 0.5);
}

TEST(Sectors, OwnShipMovesAndTurns) {
  constexpr int kTurns = 40;
  for (const double turn_rate_rad_s : {-0.2, 0.2}) {
    const Antenna antenna{[](double time_s) {
                            return OwnShip{.north_m = 8.0 * time_s,
                                           .east_m = -5.0 * time_s,
                                           .vnorth_mps = 8.0,
                                           .veast_mps = -5.0};
                          },
                          turn_rate_rad_s};
    VesselTracker tracker = make_tracker();
    std::map<std::int64_t, int> coasting;
    feed(tracker, record(boats(), antenna, kTurns * kTurn, 4), antenna, even_ends(32, kTurns),
         [&](const ScanReport& report, std::span<const Plot>) {
           for (const Event& event : report.events)
             EXPECT_FALSE(event.kind == TrackEvent::kLost && event.track_id > 0);
         });
    expect_all_tracked(tracker, boats(), tracker.time_s());
  }
}

TEST(Sectors, ATargetThatIsNotSeenMissesOnceATurnAndIsLost) {
  VesselTracker tracker = make_tracker();
  const std::vector<Boat> one{boats()[2]};
  std::vector<Plot> plots = record(one, {}, 20 * kTurn, 5);
  std::vector<TrackEvent> story;
  int misses = 0, most = 0;
  feed(tracker, plots, {}, even_ends(16, 60), [&](const ScanReport& report, std::span<const Plot>) {
    for (const Event& event : report.events)
      if (event.track_id > 0) story.push_back(event.kind);
    const Track* track = tracker.find(1);
    if (track == nullptr) return;
    EXPECT_LE(track->misses - misses, 1);
    misses = track->misses;
    most = std::max(most, misses);
    EXPECT_LE(misses, std::max(0.0, (tracker.time_s() / kPeriod_s - 19.0)));
  });
  EXPECT_EQ(story, (std::vector<TrackEvent>{TrackEvent::kConfirmed, TrackEvent::kCoasting,
                                            TrackEvent::kLost}));
  EXPECT_GE(most, 8);
}

TEST(Sectors, ATargetWhoseGateReachesTheAntennaIsUpdatedAndMissesOnceATurn) {
  constexpr int kTurns = 60, kSeen = 50;
  const std::vector<Boat> near{{{60.0, 5.0}, {0.0, 0.1}}};
  for (const int sectors : {8, 32}) {
    VesselTracker tracker = make_tracker();
    int hits = 0, misses = 0;
    feed(tracker, record(near, {}, kSeen * kTurn, 7), {}, even_ends(sectors, kTurns),
         [&](const ScanReport&, std::span<const Plot>) {
           if (const Track* track = tracker.find(1)) {
             hits = std::max(hits, track->hits);
             misses = std::max(misses, track->misses);
           }
         });
    EXPECT_NEAR(hits, kSeen, 2) << sectors;
    EXPECT_NEAR(misses, kTurns - kSeen, 2) << sectors;
  }
}

TEST(Sectors, VesselsAllAroundOwnShipAreShownOnceEach) {
  std::vector<Boat> crowd;
  for (int k = 0; k < 24; ++k)
    crowd.push_back({(60.0 + 40.0 * (k % 5)) *
                         Vec<double, 2>(std::cos(kTurn * k / 24.0), std::sin(kTurn * k / 24.0)),
                     {0.0, 0.0}});
  const Antenna antenna;
  constexpr int kTurns = 20;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    VesselTracker tracker = make_tracker();
    int sectors = 0;
    feed(tracker, record(crowd, antenna, kTurn * kTurns, seed), antenna, even_ends(32, kTurns),
         [&](const ScanReport&, std::span<const Plot>) {
           if (++sectors < 32 * 12) return;
           EXPECT_LE(tracker.size(), 36) << "seed " << seed << ", sector " << sectors;
         });
    int shown = 0;
    tracker.for_each([&](const Track& track) { shown += track.shown(); });
    EXPECT_EQ(shown, 24);
  }
}

/// Gives plots to a tracker in even sectors, of which some are left out and whose ends are by so
/// much before the begin of the next; `f(report)` after each.
template <class Given, class Function>
void give_sectors(VesselTracker& tracker, const std::vector<Plot>& plots, int sectors, int turns,
                  const Given& given, const Function& f, double gap_rad = 0.0) {
  std::size_t next = 0;
  for (int k = 0; k < turns * sectors; ++k) {
    const double from_rad = kTurn * k / sectors, to_rad = kTurn * (k + 1) / sectors;
    const double time_s = Antenna{}.time_s(to_rad);
    const std::size_t begin = next;
    while (next < plots.size() && plots[next].time_s <= time_s) ++next;
    if (!given(k)) continue;
    const ScanReport report = tracker.sector(
        {0, from_rad, to_rad - gap_rad, time_s, std::span(plots).subspan(begin, next - begin)});
    EXPECT_EQ(report.status, Status::kOk);
    f(report);
  }
}

TEST(Sectors, ATargetInABlindSectorCoastsByTimeAndOthersAreUpdated) {
  VesselTracker tracker = make_tracker();
  const std::vector<Boat> two{boats()[2], boats()[3]};  // bearings of about 150 and 83 degrees
  const std::vector<Plot> plots = record(two, {}, 30 * kTurn, 6);
  std::vector<Event> events;
  give_sectors(
      tracker, plots, 16, 30,
      [](int k) { return k < 16 * 15 || k % 16 < 5 || k % 16 > 8; },  // not 112 to 202 degrees
      [&](const ScanReport& report) {
        events.insert(events.end(), report.events.begin(), report.events.end());
      });
  std::set<std::int64_t> coasting;
  for (const Event& event : events)
    if (event.kind == TrackEvent::kCoasting) {
      EXPECT_TRUE(coasting.insert(event.track_id).second);
      EXPECT_GE(event.time_s, 16.3 * kPeriod_s) << "two periods after the last look";
    }
  ASSERT_EQ(coasting.size(), 1u);
  tracker.for_each([&](const Track& track) {
    if (!track.confirmed()) return;
    const bool blind = coasting.contains(track.id);
    EXPECT_EQ(track.misses > 0, blind);
    EXPECT_GT(track.existence, 0.9) << "nobody has looked";
    EXPECT_TRUE(!blind || track.hits == 15) << track.hits;
  });
}

/// The plots that the track of each boat has had after 20 turns in sectors, of which some are not
/// given and whose ends are by so much before the begin of the next.
std::vector<int> hits_in(int sectors, const std::function<bool(double turn)>& given,
                         double gap_rad = 0.0) {
  VesselTracker tracker = make_tracker();
  const std::vector<Plot> plots = record(boats(), {}, 20 * kTurn, 12);
  give_sectors(
      tracker, plots, sectors, 20, [&](int k) { return given(double(k) / sectors); },
      [](const ScanReport&) {}, gap_rad);
  std::vector<int> hits;
  for (const Boat& boat : boats()) {
    const Track* track = track_at(tracker, boat.at(20 * kPeriod_s), 80.0);
    hits.push_back(track == nullptr ? 0 : track->hits);
  }
  return hits;
}

// An extractor that takes longer than a sector gives plots with the next ones.
TEST(Sectors, WhosePlotsComeWithTheNextOneOrTwoLoseNoTrack) {
  const std::vector<int> in_time = hits_in(32, [](double) { return true; });
  const std::vector<Plot> plots = record(boats(), {}, 20 * kTurn, 12);
  for (const int late : {1, 2}) {
    constexpr int kSectors = 32;
    VesselTracker tracker = make_tracker();
    std::size_t next = 0;
    for (int k = 0; k < 20 * kSectors; ++k) {
      const double to_rad = kTurn * (k + 1) / kSectors, time_s = Antenna{}.time_s(to_rad);
      const double until_s = k < 5 * kSectors ? time_s  // in time at first
                                              : time_s - late * kPeriod_s / kSectors;
      const std::size_t begin = next;
      while (next < plots.size() && plots[next].time_s <= until_s) ++next;
      (void)tracker.sector({0, to_rad - kTurn / kSectors, to_rad, time_s,
                            std::span(plots).subspan(begin, next - begin)});
    }
    for (std::size_t k = 0; k < in_time.size(); ++k) {
      const Track* track = track_at(tracker, boats()[k].at(20 * kPeriod_s), 80.0);
      ASSERT_NE(track, nullptr) << k;
      EXPECT_GE(track->hits, in_time[k] - 4) << "until it is known";
      EXPECT_EQ(track->misses, 0);
    }
  }
}

TEST(Sectors, AfterASilenceOfSomeTurnsHaveTheirPlotsUsedAsOfTurns) {
  for (const int silent : {1, 2, 3, 5}) {
    const auto given = [&](double turn) { return turn < 10.0 || turn >= 10.0 + silent; };
    for (const int sectors : {2, 3, 16})
      EXPECT_EQ(hits_in(sectors, given), hits_in(1, given)) << silent << " " << sectors;
  }
}

TEST(Sectors, AfterASilenceOfPartsOfTurnsUseEveryPlotThatIsGiven) {
  const std::vector<int> all = hits_in(16, [](double) { return true; });
  for (const double silent : {0.5, 0.75, 1.5, 1.75}) {
    const std::vector<int> hits =
        hits_in(16, [&](double turn) { return turn < 10.0 || turn >= 10.0 + silent; });
    for (std::size_t k = 0; k < hits.size(); ++k)
      EXPECT_GE(hits[k], all[k] - static_cast<int>(std::ceil(silent))) << silent << " " << k;
  }
}

TEST(Sectors, OfOneArcOfTheTurnTrackWhatIsInIt) {
  for (const double arc : {0.35, 0.5, 0.75})
    for (const int sectors : {16, 64}) {
      const std::vector<int> hits =
          hits_in(sectors, [&](double turn) { return turn - std::floor(turn) < arc; });
      for (const std::size_t boat : {3u, 6u})  // at 83 and 51 degrees
        EXPECT_GE(hits[boat], 18) << arc << " " << sectors << " " << boat;
    }
}

TEST(Sectors, BetweenTheirFirstAndLastSweepsLeaveNoGap) {
  const auto all = [](double) { return true; };
  for (const int sectors : {8, 32, 64})
    for (const double gap_rad : {1e-5, kTurn / 4096, kTurn / 720})
      EXPECT_EQ(hits_in(sectors, all, gap_rad), hits_in(sectors, all)) << sectors << " " << gap_rad;
}

TEST(Sectors, ASilentRadarLetsTracksCoastByTime) {
  VesselTracker tracker = make_tracker();
  feed(tracker, record(boats(), {}, 20 * kTurn, 7), {}, even_ends(16, 20),
       [](const ScanReport&, std::span<const Plot>) {});
  const double begin_s = tracker.time_s();
  int coasting = 0;
  for (int k = 1; k <= 40; ++k) {
    const ScanReport report = tracker.sector({0, 0.0, 0.0, begin_s + 0.1 * k * kPeriod_s, {}});
    EXPECT_EQ(report.status, Status::kOk);
    coasting += static_cast<int>(events_of(report, TrackEvent::kCoasting).size());
    EXPECT_TRUE(k >= 10 || coasting == 0);
  }
  EXPECT_EQ(coasting, 7);
  for (const Track* track : tracks_of(tracker, true)) {
    EXPECT_LE(track->misses, 4);
  }
  const ScanReport late = tracker.sector({0, 0.0, 0.0, begin_s + 100.0 * kPeriod_s, {}});
  EXPECT_EQ(events_of(late, TrackEvent::kLost).size(), 7u);
}

TEST(Sectors, StateIsRestoredInTheMiddleOfATurn) {
  const std::vector<Plot> plots = record(boats(), {}, 20 * kTurn, 8, 0.8);
  const std::vector<double> ends_rad = uneven_ends(20);
  for (const std::size_t cut : {7u, 50u, 63u}) {
    VesselTracker tracker = make_tracker(), restored = make_tracker();
    std::vector<std::vector<std::byte>> states;
    std::size_t call = 0;
    feed(tracker, plots, {}, ends_rad, [&](const ScanReport&, std::span<const Plot>) {
      if (++call >= cut) states.push_back(tracker.save());
    });
    ASSERT_TRUE(restored.restore(states.front()));
    EXPECT_EQ(restored.save(), states.front());
    std::size_t next = 1;
    feed(
        restored, plots, {}, ends_rad,
        [&](const ScanReport&, std::span<const Plot>) {
          ASSERT_EQ(restored.save(), states[next++]) << next;
        },
        cut);
    EXPECT_EQ(next, states.size());
  }
}

TEST(Sectors, TakeNoHeap) {
  TrackerConfig config;
  config.max_tracks = 20;
  config.max_plots = 40;
  std::vector<Plot> plots = record(boats(), {}, 20 * kTurn, 9, 0.8);
  Sea sea(10);
  for (int k = 0; k < 3000; ++k) {
    Plot plot = sea.clutter(0.0, 3000.0);
    plot.time_s = Antenna{}.time_s(kTurn * (k / 150) + compass_angle(plot.bearing_rad));
    plots.push_back(plot);
  }
  std::sort(plots.begin(), plots.end(),
            [](const Plot& a, const Plot& b) { return a.time_s < b.time_s; });
  VesselTracker tracker = make_tracker(config);
  std::vector<Sector> sectors;
  std::size_t next = 0;
  for (const double to_rad : even_ends(32, 20)) {
    const double time_s = Antenna{}.time_s(to_rad);
    const std::size_t begin = next;
    while (next < plots.size() && plots[next].time_s <= time_s) ++next;
    sectors.push_back({0, to_rad - kTurn / 32, to_rad, time_s,
                       std::span<const Plot>(plots).subspan(begin, next - begin)});
  }
  int good = 0;
  const test::NoHeap fence;
  for (const Sector& sector : sectors) good += tracker.sector(sector).status == Status::kOk;
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_EQ(good, 640);
}

TEST(Sectors, ThatMakeNoSenseAreRejectedAndChangeNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  VesselTracker tracker = make_tracker();
  feed(tracker, record(boats(), {}, 5 * kTurn, 1), {}, even_ends(8, 5),
       [](const ScanReport&, std::span<const Plot>) {});
  const double time_s = tracker.time_s();
  const auto before = tracker.save();
  const Plot plot = exact_plot({1000.0, 0.0}, time_s);
  const std::pair<Sector, Status> cases[] = {
      {{1, 0.0, 0.5, time_s + 0.2, {&plot, 1}}, Status::kNotFinite},
      {{-1, 0.0, 0.5, time_s + 0.2, {&plot, 1}}, Status::kNotFinite},
      {{0, kNan, 0.5, time_s + 0.2, {&plot, 1}}, Status::kNotFinite},
      {{0, 0.0, 1e300, time_s + 0.2, {&plot, 1}}, Status::kNotFinite},
      {{0, 0.0, 7.0, time_s + 0.2, {&plot, 1}}, Status::kNotFinite},
      {{0, 7.0, 0.0, time_s + 0.2, {&plot, 1}}, Status::kNotFinite},
      {{0, 0.0, 0.5, time_s - 0.1, {&plot, 1}}, Status::kNegativeTimeStep},
      {{0, 0.0, 0.5, time_s + 4000.0, {&plot, 1}}, Status::kNotFinite},
      {{0, 0.0, 0.5, kNan, {&plot, 1}}, Status::kNotFinite}};
  for (const auto& [sector, status] : cases) {
    EXPECT_EQ(tracker.sector(sector).status, status) << sector.from_rad << ' ' << sector.to_rad;
    EXPECT_EQ(tracker.save(), before);
  }
}

TEST(Sectors, ThatOverlapOrAreGivenTwiceGiveNoSecondUpdate) {
  VesselTracker tracker = make_tracker();
  const std::vector<Plot> plots = record(boats(), {}, 30 * kTurn, 12);
  std::size_t next = 0;
  for (int k = 0; k < 16 * 30; ++k) {
    const double to_rad = kTurn * (k + 1) / 16, time_s = Antenna{}.time_s(to_rad);
    const std::size_t begin = next;
    while (next < plots.size() && plots[next].time_s <= time_s) ++next;
    const auto seen = std::span(plots).subspan(begin, next - begin);
    // Half as wide again as what is new, and now and then the same once more, without plots.
    ASSERT_EQ(tracker.sector({0, kTurn * (k - 0.5) / 16, to_rad, time_s, seen}).status,
              Status::kOk);
    if (k % 5 == 0) (void)tracker.sector({0, kTurn * k / 16, to_rad, time_s, {}});
    expect_sound(tracker);
  }
  expect_all_tracked(tracker, boats(), tracker.time_s());
  for (const Track* track : tracks_of(tracker, true)) {
    EXPECT_LE(track->scans, 31);
    EXPECT_EQ(track->misses, 0);
  }
}

TEST(Sectors, OfAnAntennaThatTurnsAnticlockwiseAreRejectedBeforeTheySumToATurn) {
  VesselTracker tracker = make_tracker();
  int rejected = 0;
  for (int k = 0; k < 16; ++k) {
    const double to_rad = compass_angle(-kTurn * k / 16);
    const Sector sector{0, to_rad - kTurn / 16, to_rad, (k + 1) / 16.0 * kPeriod_s};
    const ScanReport report = tracker.sector(sector);
    rejected += report.status == Status::kNegativeTimeStep;
    EXPECT_TRUE(report.status == Status::kOk || rejected > 0);
  }
  EXPECT_GT(rejected, 1);
  EXPECT_EQ(tracker.sector({0, 1.0, 1.0, 2 * kPeriod_s}).status, Status::kOk) << "time passes";
}

TEST(Sectors, APlotOutsideItsSectorIsNotLost) {
  VesselTracker tracker = make_tracker();
  const std::vector<Boat> one{boats()[2]};
  const std::vector<Plot> plots = record(one, {}, 30 * kTurn, 13);
  for (int k = 0; k < 30; ++k) {
    // Given a sector early, while the beam has a sixteenth to go.
    const double to_rad = kTurn * k + compass_angle(plots[std::size_t(k)].bearing_rad) - 0.2;
    const double time_s = Antenna{}.time_s(to_rad);
    const double from_rad = k == 0 ? 0.0 : kTurn * (k - 1) + 5.0;
    Plot early = plots[std::size_t(k)];
    early.time_s = time_s;
    ASSERT_EQ(tracker.sector({0, from_rad, to_rad, time_s, {&early, 1}}).status, Status::kOk);
    ASSERT_EQ(
        tracker.sector({0, to_rad, kTurn * k + 5.0, Antenna{}.time_s(kTurn * k + 5.0), {}}).status,
        Status::kOk);
  }
  ASSERT_EQ(tracks_of(tracker, true).size(), 1u);
  EXPECT_GE(tracks_of(tracker, true).front()->hits, 29);
}

TEST(PlotCovariance, TakesThePlaceOfTheRadarsErrors) {
  const OwnShip own{.north_m = 100.0, .position_std_m = 3.0, .heading_std_rad = 0.01};
  Plot plot{1.0, 2000.0, 0.7, own};
  const Gaussian<2> of_radar = kTestRadar.position(plot);
  plot.covariance << 64.0, 0.0, 0.0, deg(0.5) * deg(0.5);  // as the radar's
  EXPECT_LT((kTestRadar.position(plot).mean - of_radar.mean).norm(), 1e-9);
  EXPECT_LT((kTestRadar.position(plot).covariance - of_radar.covariance).norm(), 1e-6);
  // A common error of range and bearing, against the mean of plots drawn with it.
  plot.own = {};
  plot.covariance << 100.0, 0.03, 0.03, 1e-4 / 4;
  const Gaussian<2> fix = kTestRadar.position(plot);
  Mat<double, 2, 2> root = Mat<double, 2, 2>::Zero();
  root << 10.0, 0.0, 0.003, std::sqrt(1e-4 / 4 - 9e-6);
  Draw draw(1);
  Mat<double, 2, 2> spread = Mat<double, 2, 2>::Zero();
  constexpr int kDraws = 40000;
  for (int k = 0; k < kDraws; ++k) {
    const Vec<double, 2> z = Vec<double, 2>(2000.0, 0.7) + root * draw.normals<2>();
    const Vec<double, 2> d =
        z[0] * towards(z[1]) + kTestRadar.extent_std_m * draw.normals<2>() - 2000.0 * towards(0.7);
    spread += d * d.transpose() / kDraws;
  }
  EXPECT_LT((fix.covariance - spread).norm(), 0.05 * spread.norm());
}

}  // namespace
}  // namespace wakeline::sector_test
