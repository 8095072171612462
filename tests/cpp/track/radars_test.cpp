// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Several radars in one picture.
#include <algorithm>
#include <limits>
#include <utility>

#include "support/malloc_fence.hpp"
#include "track/scene.hpp"

namespace wakeline::radars_test {
namespace {

using namespace test;

constexpr double kTurn = Beam::kTurn;

const Radar kFine{.range_std_m = 10.0,
                  .bearing_std_rad = deg(0.5),
                  .extent_std_m = 2.0,
                  .period_s = 2.5,
                  .max_speed_mps = 20.0};
const Radar kCoarse{.range_std_m = 25.0,
                    .bearing_std_rad = deg(1.2),
                    .extent_std_m = 2.0,
                    .period_s = 3.0,
                    .max_speed_mps = 20.0};

/// A radar on shore whose antenna is north at time 0.
struct Station {
  int number;
  Radar radar;
  OwnShip place = {};
  double detection = 0.9;
  double late_s = 0.0;  ///< of its clock
  int sectors = 16;     ///< of a turn

  [[nodiscard]] Vec<double, 2> position() const { return place.position<double>(); }
  [[nodiscard]] double end_s(int sector) const {
    return radar.period_s * (sector + 1) / sectors + late_s;
  }
};

/// The plots of some boats, in order: one a turn each, when the beam passes it.
std::vector<Plot> record(const Station& station, const std::vector<Boat>& boats, double to_s,
                         std::uint64_t seed) {
  Sea sea(1000 * seed + static_cast<std::uint64_t>(station.number), station.radar);
  std::vector<Plot> plots;
  const auto angle_rad = [&](const Boat& boat, double time_s) {
    const Vec<double, 2> d = boat.at(time_s) - station.position();
    return std::atan2(d[1], d[0]);
  };
  for (const Boat& boat : boats)
    for (double pass_rad = compass_angle(angle_rad(boat, 0.0));; pass_rad += kTurn) {
      double time_s = 0.0;
      for (int k = 0; k < 5; ++k) {
        time_s = pass_rad / kTurn * station.radar.period_s + station.late_s;
        pass_rad = Beam::unwrapped(angle_rad(boat, time_s), pass_rad);
      }
      if (time_s > to_s) break;
      const bool detected = sea.draw.uniform(0.0, 1.0) < station.detection;
      Plot plot = sea.plot(boat.at(time_s) - station.position(), time_s);
      plot.own = station.place;
      if (detected && station.radar.covers(plot.range_m, plot.bearing_rad)) plots.push_back(plot);
    }
  std::sort(plots.begin(), plots.end(),
            [](const Plot& a, const Plot& b) { return a.time_s < b.time_s; });
  return plots;
}

/// Feeds the sectors of some stations to a tracker, in the order of their ends; `f(time_s, report)`
/// after each.
template <class Function>
void watch(VesselTracker& tracker, const std::vector<Station>& stations,
           const std::vector<Boat>& boats, double from_s, double to_s, std::uint64_t seed,
           Function&& f) {
  struct Part {
    double end_s;
    const Station* station;
    int sector;
    std::vector<Plot> plots;
  };
  std::vector<Part> parts;
  for (const Station& station : stations) {
    const std::vector<Plot> plots = record(station, boats, to_s, seed);
    auto next = plots.begin();
    for (int sector = 0; station.end_s(sector) <= to_s; ++sector) {
      const double end_s = station.end_s(sector);
      const auto first = next;
      next =
          std::find_if(first, plots.end(), [&](const Plot& plot) { return plot.time_s > end_s; });
      if (end_s > from_s) parts.push_back({end_s, &station, sector, {first, next}});
    }
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.end_s < b.end_s; });
  for (const Part& part : parts) {
    const double width_rad = kTurn / part.station->sectors;
    const double from_rad = compass_angle(width_rad * part.sector);
    const ScanReport report = tracker.sector({part.station->number, from_rad, from_rad + width_rad,
                                              part.end_s, part.plots, part.station->place});
    EXPECT_EQ(report.status, Status::kOk);
    f(part.end_s, report);
  }
}

void nothing(double, const ScanReport&) {}

VesselTracker tracker_of(const std::vector<Radar>& radars) {
  return VesselTracker(radars, {}, vessel_imm(radars.front()));
}

std::vector<Boat> fleet(int count, std::uint64_t seed) {
  Draw draw(seed);
  std::vector<Boat> boats;
  while (static_cast<int>(boats.size()) < count) {
    const Boat boat{{draw.uniform(-4000.0, 4000.0), draw.uniform(1000.0, 7000.0)},
                    {draw.uniform(-8.0, 8.0), draw.uniform(-8.0, 8.0)}};
    if (std::all_of(boats.begin(), boats.end(), [&](const Boat& other) {
          return (other.start_m - boat.start_m).norm() > 600.0;
        }))
      boats.push_back(boat);
  }
  return boats;
}

/// How well a tracker has followed boats.
struct Score {
  double sum_m2 = 0.0;
  double missed = 0.0, matched = 0.0, extra = 0.0;

  void add(const VesselTracker& tracker, const std::vector<Boat>& boats, double time_s) {
    std::vector<Vec<double, 2>> at;
    tracker.for_each([&](const Track& track) {
      if (!track.shown()) return;
      const Gaussian<4> now = tracker.kinematics_at(track, time_s);
      at.push_back({now.mean[0], now.mean[2]});
    });
    double found = 0.0;
    for (const Boat& boat : boats) {
      double least_m = 200.0;
      for (const Vec<double, 2>& place : at)
        least_m = std::min(least_m, (place - boat.at(time_s)).norm());
      if (least_m < 200.0) {
        sum_m2 += least_m * least_m;
        ++found;
      } else {
        ++missed;
      }
    }
    matched += found;
    extra += std::max(static_cast<double>(at.size()) - found, 0.0);
  }
  void add(const Score& other) {
    sum_m2 += other.sum_m2;
    missed += other.missed;
    matched += other.matched;
    extra += other.extra;
  }
  [[nodiscard]] double rms_m() const { return std::sqrt(sum_m2 / matched); }
};

Score score_of(const std::vector<Station>& stations, const std::vector<Boat>& boats,
               std::uint64_t seed) {
  std::vector<Radar> radars;
  std::vector<Station> numbered = stations;
  for (Station& station : numbered) {
    station.number = static_cast<int>(radars.size());
    radars.push_back(station.radar);
  }
  VesselTracker tracker = tracker_of(radars);
  Score score;
  double next_s = 30.0;
  watch(tracker, numbered, boats, 0.0, 150.0, seed, [&](double time_s, const ScanReport&) {
    if (time_s < next_s) return;
    next_s += 2.5;
    score.add(tracker, boats, time_s);
  });
  return score;
}

TEST(Radars, TwoAreBetterThanTheBetterAloneAndShowEachVesselOnce) {
  const Station fine{0, kFine}, coarse{1, kCoarse, {.north_m = 2000.0}};
  Score alone, other, both;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const std::vector<Boat> boats = fleet(12, seed);
    alone.add(score_of({fine}, boats, seed));
    other.add(score_of({coarse}, boats, seed));
    both.add(score_of({fine, coarse}, boats, seed));
  }
  EXPECT_LT(both.rms_m(), 0.95 * std::min(alone.rms_m(), other.rms_m()));
  EXPECT_LE(both.missed, std::min(alone.missed, other.missed));
  EXPECT_LT(both.extra, 0.005 * both.matched) << "a vessel is shown twice";
}

TEST(Radars, ARadarThatDoesNotCoverATrackLeavesItAlone) {
  Radar blind = kCoarse;
  blind.max_range_m = 1000.0;
  const std::vector<Boat> boats = fleet(8, 3);
  VesselTracker alone = tracker_of({kFine}), both = tracker_of({kFine, blind});
  const Station fine{0, kFine}, short_sighted{1, blind, {.east_m = -2000.0}};
  watch(alone, {fine}, boats, 0.0, 60.0, 3, nothing);
  watch(both, {fine, short_sighted}, boats, 0.0, 60.0, 3, nothing);
  const std::vector<const Track*> expected = tracks_of(alone, true);
  const std::vector<const Track*> tracks = tracks_of(both, true);
  ASSERT_EQ(tracks.size(), expected.size());
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    EXPECT_EQ(tracks[k]->kinematics.mean, expected[k]->kinematics.mean);
    EXPECT_EQ(tracks[k]->existence, expected[k]->existence);
    EXPECT_EQ(tracks[k]->misses, expected[k]->misses);
  }
}

TEST(Radars, AHiddenTargetIsShownForAsLongAsTheSlowestRadarAloneShowsIt) {
  Radar fast = kFine;
  fast.period_s = 0.5;
  const std::vector<Boat> boats = fleet(8, 9);
  const Station slow{0, kFine}, quick{1, fast};
  const auto shown = [](const VesselTracker& tracker) {
    const std::vector<const Track*> tracks = tracks_of(tracker, true);
    return std::count_if(tracks.begin(), tracks.end(),
                         [](const Track* track) { return track->shown(); });
  };
  VesselTracker both = tracker_of({kFine, fast});
  watch(both, {slow, quick}, boats, 0.0, 60.0, 9, nothing);
  watch(both, {slow, quick}, {}, 60.0, 60.0 + 2 * kFine.period_s, 9, nothing);
  EXPECT_EQ(shown(both), std::ssize(boats)) << "two misses of the slow one, ten of the fast one";
  watch(both, {slow, quick}, {}, 60.0 + 2 * kFine.period_s, 60.0 + 6 * kFine.period_s, 9, nothing);
  EXPECT_EQ(shown(both), 0);
}

// One that turns but does not cover a target says nothing of it, and does not stand in for the one
// that has fallen silent.
TEST(Radars, TargetsOfASilentOneCoastUntilTheyAreLostWhetherAnotherTurnsOrNot) {
  Radar blind = kCoarse;
  blind.max_range_m = 10.0;
  for (const int sectors : {1, 16}) {
    VesselTracker tracker = tracker_of({kFine, blind});
    const std::vector<Boat> boats = fleet(8, 3);
    const Station seeing{.number = 0, .radar = kFine, .detection = 1.0, .sectors = sectors};
    const Station turning{
        .number = 1, .radar = blind, .place = {.east_m = -2000.0}, .sectors = sectors};
    watch(tracker, {seeing, turning}, boats, 0.0, 60.0, 3, nothing);
    const auto count = [&](TrackStatus status) {
      const std::vector<const Track*> tracks = tracks_of(tracker, true);
      return std::count_if(tracks.begin(), tracks.end(),
                           [&](const Track* track) { return track->status == status; });
    };
    EXPECT_EQ(count(TrackStatus::kConfirmed), std::ssize(boats));
    watch(tracker, {turning}, boats, 60.0, 60.0 + 4 * kCoarse.period_s, 3, nothing);
    EXPECT_EQ(count(TrackStatus::kConfirmed), 0) << "none is seen";
    EXPECT_EQ(count(TrackStatus::kCoasting), std::ssize(boats));
    watch(tracker, {turning}, boats, 60.0 + 4 * kCoarse.period_s, 240.0, 3, nothing);
    EXPECT_EQ(tracks_of(tracker, true).size(), 0u);
  }
}

TEST(Radars, OneThatHasNotBegunDoesNotCountMisses) {
  Radar slow = kFine;
  slow.period_s = 60.0;
  const std::vector<Boat> boats = fleet(8, 9);
  VesselTracker alone = tracker_of({kFine}), both = tracker_of({kFine, slow});
  for (VesselTracker* tracker : {&alone, &both}) {
    watch(*tracker, {{0, kFine}}, boats, 0.0, 40.0, 9, nothing);
    watch(*tracker, {{0, kFine}}, {}, 40.0, 40.0 + 3 * kFine.period_s, 9, nothing);
  }
  const std::vector<const Track*> expected = tracks_of(alone, true), tracks = tracks_of(both, true);
  ASSERT_EQ(tracks.size(), expected.size());
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    EXPECT_GE(tracks[k]->misses, 2);
    EXPECT_EQ(tracks[k]->misses, expected[k]->misses);
  }
}

TEST(Radars, PlotsOfCorrelatedErrorsCountForAsManyAsTheyAreWorth) {
  Radar correlated = kFine;
  correlated.correlation_time_s = 5.0;
  EXPECT_EQ(kFine.plots_as_one(0.1), 1.0);
  EXPECT_NEAR(correlated.plots_as_one(0.5), 2 * 5.0 / 0.5, 0.1) << "2 tau / dt when dense";
  EXPECT_NEAR(correlated.plots_as_one(50.0), 1.0, 1e-3);

  // Echoes that wander along the hull, seen twice a second.
  Radar lidar{.range_std_m = 1.0,
              .bearing_std_rad = deg(0.1),
              .extent_std_m = 4.0,
              .period_s = 0.5,
              .max_speed_mps = 20.0};
  const std::vector<Boat> boats = fleet(8, 11);
  const auto velocity_error_mps = [&](const Radar& radar) {
    VesselTracker tracker = tracker_of({radar});
    Draw draw(12);
    std::vector<Vec<double, 2>> off_m(boats.size(), Vec<double, 2>::Zero());
    const double stays = std::exp(-radar.period_s / 5.0);
    double sum = 0.0, count = 0.0;
    for (double time_s = 0.0; time_s < 120.0; time_s += radar.period_s) {
      std::vector<Plot> plots;
      for (std::size_t k = 0; k < boats.size(); ++k) {
        off_m[k] = stays * off_m[k] + 4.0 * std::sqrt(1.0 - stays * stays) * draw.normals<2>();
        plots.push_back(exact_plot(boats[k].at(time_s) + off_m[k], time_s));
      }
      EXPECT_EQ(tracker.process(time_s, plots).status, Status::kOk);
      if (time_s < 30.0) continue;
      for (const Boat& boat : boats)
        if (const Track* track = track_at(tracker, boat.at(time_s))) {
          sum += (track->velocity() - boat.velocity_mps).squaredNorm();
          count += 1.0;
        }
    }
    EXPECT_GT(count, 0.95 * 180.0 * static_cast<double>(boats.size()));
    return std::sqrt(sum / count);
  };
  const double as_independent_mps = velocity_error_mps(lidar);
  lidar.correlation_time_s = 5.0;
  EXPECT_LT(velocity_error_mps(lidar), 0.7 * as_independent_mps);
}

TEST(Radars, HandOverFromOneCoverageToAnotherKeepsTheNumber) {
  Radar west = kFine, east = kCoarse;
  west.max_range_m = east.max_range_m = 3000.0;
  VesselTracker tracker = tracker_of({west, east});
  const std::vector<Boat> boats{{{0.0, 1500.0}, {0.0, 12.0}}, {{600.0, 4800.0}, {0.0, -12.0}}};
  std::set<std::int64_t> shown;
  watch(tracker, {{0, west}, {1, east, {.east_m = 5000.0}}}, boats, 0.0, 240.0, 4,
        [&](double tt, const ScanReport& report) {
          nothing(tt, report);
          EXPECT_TRUE(events_of(report, TrackEvent::kLost).empty());
          for (const Track* track : tracks_of(tracker, true)) shown.insert(track->id);
        });
  EXPECT_EQ(shown.size(), boats.size());
}

TEST(Radars, OneThatFallsSilentOrComesBackLosesNoTrack) {
  VesselTracker tracker = tracker_of({kFine, kCoarse});
  const Station fine{0, kFine}, coarse{1, kCoarse, {.north_m = 1500.0}};
  const std::vector<Boat> boats = fleet(8, 5);
  watch(tracker, {fine, coarse}, boats, 0.0, 60.0, 5, nothing);
  const std::set<std::int64_t> before = ids_of(tracker);
  ASSERT_EQ(tracks_of(tracker, true).size(), boats.size());
  watch(tracker, {coarse}, boats, 60.0, 120.0, 6, nothing);
  watch(tracker, {fine, coarse}, boats, 120.0, 160.0, 7, nothing);
  for (const Boat& boat : boats) {
    const Track* track = track_at(tracker, boat.at(160.0));
    ASSERT_NE(track, nullptr);
    EXPECT_TRUE(before.contains(track->id));
  }
}

TEST(Radars, AreAddedRemovedAndChangedWhileTracksGoOn) {
  VesselTracker tracker = tracker_of({kFine});
  const Station fine{0, kFine};
  const std::vector<Boat> boats = fleet(8, 8);
  watch(tracker, {fine}, boats, 0.0, 50.0, 1, nothing);
  const std::set<std::int64_t> before = ids_of(tracker);
  EXPECT_EQ(tracker.add_radar(kCoarse), 1);
  const Station coarse{1, kCoarse};
  watch(tracker, {fine, coarse}, boats, 50.0, 80.0, 2, nothing);
  EXPECT_TRUE(tracker.remove_radar(0));
  EXPECT_FALSE(tracker.remove_radar(0)) << "there is none of that number";
  EXPECT_FALSE(tracker.remove_radar(1)) << "it is the last one";
  EXPECT_FALSE(tracker.has_radar(0));
  EXPECT_NE(tracker.process(81.0, {}).status, Status::kOk);
  watch(tracker, {coarse}, boats, 80.0, 110.0, 3, nothing);
  Radar scale = kCoarse;  // another range scale
  scale.range_std_m = 5.0;
  scale.period_s = 1.5;
  tracker.set_radar(1, scale);
  EXPECT_EQ(tracker.radar(1), scale);
  EXPECT_THROW(tracker.set_radar(0, scale), std::invalid_argument);
  watch(tracker, {{1, scale}}, boats, 111.0, 140.0, 4, nothing);
  for (const Boat& boat : boats) {
    const Track* track = track_at(tracker, boat.at(140.0));
    ASSERT_NE(track, nullptr);
    EXPECT_TRUE(before.contains(track->id));
  }
  EXPECT_EQ(tracker.add_radar(kFine), 0) << "the least number that is free";
}

TEST(Radars, AreSavedAndRestoredBitForBit) {
  const Station fine{0, kFine}, coarse{1, kCoarse, {.north_m = 1500.0}};
  const std::vector<Boat> boats = fleet(10, 9);
  VesselTracker tracker = tracker_of({kFine, kCoarse}), restored = tracker_of({kFine, kCoarse});
  watch(tracker, {fine, coarse}, boats, 0.0, 37.0, 1, nothing);
  ASSERT_TRUE(restored.restore(tracker.save()));
  for (VesselTracker* one : {&tracker, &restored})
    watch(*one, {fine, coarse}, boats, 37.0, 70.0, 2, nothing);
  EXPECT_EQ(tracker.save(), restored.save());
  VesselTracker other = tracker_of({kFine, kFine});
  EXPECT_FALSE(other.restore(tracker.save())) << "its radars are others";
}

TEST(Radars, ASectorOfAnUnknownOneOrFromLongAgoIsRejected) {
  VesselTracker tracker = tracker_of({kFine, kCoarse});
  EXPECT_EQ(tracker.sector({0, 0.0, 1.0, 100.0}).status, Status::kOk);
  const std::vector<std::byte> before = tracker.save();
  for (const int number : {-1, 2})
    EXPECT_EQ(tracker.sector({number, 0.0, 1.0, 101.0}).status, Status::kNotFinite);
  EXPECT_EQ(tracker.sector({1, 0.0, 1.0, 96.9}).status, Status::kNegativeTimeStep);
  EXPECT_EQ(tracker.save(), before);
  EXPECT_EQ(tracker.sector({1, 0.0, 1.0, 97.1}).status, Status::kOk) << "within its period";
  EXPECT_EQ(tracker.time_s(), 100.0);
}

TEST(Radars, TheirSectorsTakeNoMemory) {
  VesselTracker tracker = tracker_of({kFine, kCoarse});
  const Station fine{0, kFine}, coarse{1, kCoarse};
  const std::vector<Boat> boats = fleet(10, 10);
  watch(tracker, {fine, coarse}, boats, 0.0, 40.0, 1, nothing);
  const std::vector<Plot> plots{exact_plot(boats[0].at(40.1), 40.1)};
  const NoHeap fence;
  for (int k = 0; k < 40; ++k)
    (void)tracker.sector({k % 2, 0.4 * k, 0.4 * k + 0.4, 40.2 + 0.1 * k, plots});
  EXPECT_EQ(fence.allocations(), 0);
}

}  // namespace
}  // namespace wakeline::radars_test
