// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/strobe_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "support/malloc_fence.hpp"
#include "wakeline/multimodel/bayesian_alpha_beta.hpp"
#include "wakeline/multimodel/fuzzy_alpha_beta.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline::strobe_tracker_test {
namespace {

using Point = Vec<double, 2>;
constexpr double kTurn = 2 * kPi<double>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const Radar kRadar{.range_std_m = 3.0,
                   .bearing_std_rad = deg(0.1),
                   .extent_std_m = 0.0,
                   .period_s = 2.4,
                   .max_speed_mps = 20.0};

/// A vessel: where it is, and how bright. Its echo is smooth.
struct Vessel {
  std::function<Point(double)> at;
  double peak = 200.0;
  double range_sigma_m = 6.0;
  double bearing_sigma_rad = deg(0.35);
};

Vessel straight(const Point& start_m, const Point& velocity_mps) {
  return {[=](double time_s) -> Point { return start_m + time_s * velocity_mps; }};
}

/// What a radar sees of vessels: 720 sweeps a turn, cells of 6 m from 300 m on.
class Sea {
 public:
  static constexpr int kSweeps = 720;
  static constexpr int kCells = 400;

  explicit Sea(std::vector<Vessel> vessels) : vessels(std::move(vessels)) {}

  static constexpr double kStep = kTurn / kSweeps;
  static double time_s(int k) { return kRadar.period_s * k / kSweeps; }

  /// Sweep k, valid until the next one.
  Sweep<> sweep(int k) {
    row_.assign(kCells, 0);
    const double azimuth = kStep * (k % kSweeps);
    for (const Vessel& vessel : vessels) {
      const Point seen = vessel.at(time_s(k)) - own.position<double>();
      const double off = wrap_angle(azimuth - std::atan2(seen[1], seen[0]) - bearing_offset_rad) /
                         vessel.bearing_sigma_rad;
      for (int cell = 0; cell < kCells && std::abs(off) < 3.0; ++cell) {
        const double along = (300.0 + 6.0 * (cell + 0.5) - seen.norm()) / vessel.range_sigma_m;
        const double a = vessel.peak * std::exp(-0.5 * (along * along + off * off));
        auto& there = row_[static_cast<std::size_t>(cell)];
        if (a >= 10.0) there = std::max(there, static_cast<std::uint8_t>(a));
      }
    }
    return {.time_s = time_s(k),
            .azimuth_rad = azimuth,
            .azimuth_width_rad = kStep,
            .start_range_m = 300.0,
            .cell_m = 6.0,
            .amplitude = row_};
  }

  std::vector<Vessel> vessels;
  OwnShip own{};
  double bearing_offset_rad = 0.0;

 private:
  std::vector<std::uint8_t> row_;
};

/// What a tracker reported over some sweeps.
struct Log {
  std::vector<StrobeReading> readings;
  std::vector<Event> events;

  [[nodiscard]] std::vector<StrobeReading> of(std::int64_t id) const {
    std::vector<StrobeReading> its;
    for (const StrobeReading& reading : readings)
      if (reading.track_id == id) its.push_back(reading);
    return its;
  }
  [[nodiscard]] int count(TrackEvent kind) const {
    return static_cast<int>(std::ranges::count(events, kind, &Event::kind));
  }
};

template <class Tracker>
Log run(Tracker& tracker, Sea& sea, int first, int last) {
  Log log;
  for (int k = first; k < last; ++k) {
    const StrobeReport report = tracker.process(sea.sweep(k), sea.own);
    log.readings.insert(log.readings.end(), report.readings.begin(), report.readings.end());
    log.events.insert(log.events.end(), report.events.begin(), report.events.end());
  }
  return log;
}

using Fuzzy = StrobeTracker<FuzzyAlphaBeta<>>;
using Bayesian = StrobeTracker<BayesianAlphaBeta<>>;

Bayesian make_tracker(const StrobeTrackerConfig& config = {}, const Radar& radar = kRadar,
                      LandMask land = {}) {
  return Bayesian(radar, config, BayesianAlphaBeta<>{}, std::move(land));
}

double error_m(const StrobeTrack& track, const Vessel& vessel) {
  return (track.position() - vessel.at(track.time_s)).norm();
}

constexpr int kSweeps = Sea::kSweeps;

// One vessel

template <class Estimator>
void expect_follows(const Estimator& estimator) {
  const Point middle(900.0, 200.0);
  const auto circle = [=](double time_s) -> Point {
    return middle + 350.0 * towards(0.3 + 8.0 / 350.0 * time_s);
  };
  Sea sea({{circle}});
  StrobeTracker<Estimator> tracker(kRadar, {}, estimator);
  const std::int64_t id = tracker.designate(0.0, circle(0.0)[0], circle(0.0)[1], 10.0);
  ASSERT_EQ(id, 1);
  const Log log = run(tracker, sea, 0, 40 * kSweeps);
  ASSERT_NE(tracker.find(id), nullptr);
  EXPECT_EQ(tracker.find(id)->misses, 0);
  EXPECT_NEAR(static_cast<double>(log.readings.size()), 40.0, 1.0);
  EXPECT_LT(error_m(*tracker.find(id), sea.vessels[0]), 4.0);
  EXPECT_NEAR(tracker.find(id)->speed_mps(), 8.0, 1.5);
  for (const StrobeReading& reading : log.readings) {
    EXPECT_TRUE(reading.echo);
    EXPECT_LT((reading.position_m.mean - circle(reading.time_s)).norm(), 2.0);
  }
}

TEST(StrobeTracker, FollowsACircleWithTheFuzzyBank) { expect_follows(FuzzyAlphaBeta<>{}); }
TEST(StrobeTracker, FollowsACircleWithTheBayesianBank) { expect_follows(BayesianAlphaBeta<>{}); }
TEST(StrobeTracker, FollowsACircleWithAnImm) { expect_follows(vessel_imm(kRadar)); }

TEST(StrobeTracker, ReadsAStrobeWhenTheBeamHasPassedIt) {
  Sea sea({straight({900.0, -50.0}, {0.0, 9.0})});  // across north
  Bayesian tracker = make_tracker();
  (void)tracker.designate(0.0, 900.0, -50.0, 5.0);
  double before_s = -0.01 * kRadar.period_s;
  for (int k = 0; k < 12 * kSweeps; ++k) {
    for (const StrobeReading& reading : tracker.process(sea.sweep(k)).readings) {
      const double half = RadiusGate{reading.radius_m}.half_angle_rad(reading.predicted_m);
      const double edge = std::atan2(reading.predicted_m[1], reading.predicted_m[0]) + half;
      const double behind = wrap_angle(Sea::kStep * (k % kSweeps) - edge) / Sea::kStep;
      EXPECT_GE(behind, 1.0);
      EXPECT_LE(behind, 2.6);
      EXPECT_LT(std::abs(reading.time_s - Sea::time_s(k)), 0.1 * kRadar.period_s);
      EXPECT_NEAR(reading.time_s - before_s, kRadar.period_s, 0.02 * kRadar.period_s);
      before_s = reading.time_s;  // once a turn, though north is crossed
    }
  }
  EXPECT_GT(before_s, 10.9 * kRadar.period_s);
}

TEST(StrobeTracker, MeasuresWhatAStrobeOnThePictureMeasures) {
  Sea sea({straight({700.0, 500.0}, {5.0, -3.0}), straight({760.0, 480.0}, {5.0, -3.0})});
  const StrobeTrackerConfig config{
      .least_amplitude = 30, .pedestal = 10, .several = EchoChoice::kAll};
  Bayesian tracker = make_tracker(config);
  (void)tracker.designate(0.0, 700.0, 500.0, 10.0);
  for (int turn = 0; turn < 5; ++turn) {
    std::vector<std::uint8_t> picture;
    std::vector<StrobeReading> readings;
    for (int k = turn * kSweeps; k < (turn + 1) * kSweeps; ++k) {
      const Sweep<> sweep = sea.sweep(k);
      picture.insert(picture.end(), sweep.amplitude.begin(), sweep.amplitude.end());
      for (const StrobeReading& reading : tracker.process(sweep).readings)
        readings.push_back(reading);
    }
    ASSERT_EQ(readings.size(), 1u);
    const AmplitudeImage<> image{picture.data(), kSweeps, Sea::kCells, 0.0, Sea::kStep, 300.0, 6.0};
    const StrobeEcho whole = strobe_echo(image, RadiusGate{readings[0].radius_m},
                                         readings[0].predicted_m, config.echo());
    EXPECT_EQ(readings[0].echo.status, whole.status);
    EXPECT_EQ(readings[0].echo.strobe_cells, whole.strobe_cells);
    EXPECT_EQ(readings[0].echo.cells, whole.cells);
    EXPECT_NEAR(readings[0].echo.range_m, whole.range_m, 1e-9);
    EXPECT_NEAR(wrap_angle(readings[0].echo.bearing_rad - whole.bearing_rad), 0.0, 1e-12);
  }
}

TEST(StrobeTracker, AStrobeGrowsWithMissesAndShrinksAgainAndThreeMissesLose) {
  const StrobeTrackerConfig config{.radius_m = 30.0, .max_radius_m = 60.0};
  Sea sea({straight({900.0, 300.0}, {4.0, 4.0})});
  Bayesian tracker = make_tracker(config);
  const std::int64_t id = tracker.designate(0.0, 900.0, 300.0, 2.0);
  const auto turns = [&](int first, int last, double peak) {
    sea.vessels[0].peak = peak;
    return run(tracker, sea, first * kSweeps, last * kSweeps);
  };
  Log log = turns(0, 8, 200.0);
  EXPECT_EQ(log.of(id).back().radius_m, 30.0);
  double radius_m = log.of(id).front().radius_m;
  EXPECT_GT(radius_m, 30.0);
  for (const StrobeReading& reading : log.of(id)) {
    EXPECT_EQ(reading.radius_m, radius_m);
    radius_m = config.next_radius_m(radius_m, true);
  }
  log = turns(8, 10, 0.0);
  ASSERT_EQ(log.readings.size(), 2u);
  EXPECT_EQ(log.count(TrackEvent::kCoasting), 1);
  EXPECT_EQ(log.readings[1].radius_m, 45.0);
  EXPECT_EQ(tracker.find(id)->strobe.radius_m, 60.0);
  EXPECT_EQ(tracker.find(id)->status, TrackStatus::kCoasting);
  log = turns(10, 12, 200.0);
  EXPECT_EQ(tracker.find(id)->misses, 0);
  EXPECT_EQ(log.readings[1].radius_m, 36.0);
  log = turns(12, 15, 0.0);
  EXPECT_EQ(log.readings.size(), 3u);
  EXPECT_EQ(log.count(TrackEvent::kLost), 1);
  EXPECT_EQ(tracker.size(), 0);
}

TEST(StrobeTracker, ReportsAnEchoThatFillsItsStrobeOrTouchesTheEdge) {
  Vessel ship = straight({900.0, 0.0}, {0.0, 0.0});
  ship.range_sigma_m = 40.0;
  ship.bearing_sigma_rad = deg(3.0);
  Sea sea({ship, straight({-900.0, 0.0}, {0.0, 0.0})});
  const StrobeTrackerConfig config{.radius_m = 25.0, .max_radius_m = 25.0};
  Bayesian tracker = make_tracker(config);
  const std::int64_t big = tracker.designate(0.0, 900.0, 0.0, 5.0);
  const std::int64_t small = tracker.designate(0.0, -900.0, 0.0, 5.0);
  const Log log = run(tracker, sea, 0, 4 * kSweeps);
  for (const StrobeReading& reading : log.of(big)) {
    EXPECT_TRUE(reading.fills);
    EXPECT_TRUE(reading.echo.touches_edge);
  }
  for (const StrobeReading& reading : log.of(small)) {
    EXPECT_FALSE(reading.fills);
    EXPECT_FALSE(reading.echo.touches_edge);
  }
}

// Several vessels

TEST(StrobeTracker, VesselsThatPassCloseKeepTheirStrobes) {
  for (const double distance_m : {60.0, 40.0}) {
    Sea sea({straight({900.0, -250.0}, {0.0, 6.0}),
             straight({900.0 + distance_m, 250.0}, {0.0, -6.0})});
    Bayesian tracker = make_tracker();
    std::vector<std::int64_t> ids;
    for (const Vessel& vessel : sea.vessels)
      ids.push_back(tracker.designate(0.0, vessel.at(0.0)[0], vessel.at(0.0)[1], 5.0));
    (void)run(tracker, sea, 0, 32 * kSweeps);
    for (std::size_t k = 0; k < 2; ++k) {
      ASSERT_NE(tracker.find(ids[k]), nullptr) << distance_m;
      EXPECT_LT(error_m(*tracker.find(ids[k]), sea.vessels[k]), 6.0) << distance_m;
    }
  }
}

TEST(StrobeTracker, AnEchoOfTwoVesselsIsSharedAndReported) {
  Sea sea({straight({900.0, -100.0}, {0.0, 6.0}), straight({921.0, -100.0}, {0.0, 6.0})});
  Bayesian tracker = make_tracker();
  std::vector<std::int64_t> ids;
  for (const Vessel& vessel : sea.vessels)
    ids.push_back(tracker.designate(0.0, vessel.at(0.0)[0], vessel.at(0.0)[1], 2.0));
  const Log log = run(tracker, sea, 0, 16 * kSweeps);
  for (std::size_t k = 0; k < 2; ++k) {
    ASSERT_NE(tracker.find(ids[k]), nullptr);
    EXPECT_LT(error_m(*tracker.find(ids[k]), sea.vessels[k]), 6.0);
    for (const StrobeReading& reading : log.of(ids[k])) EXPECT_TRUE(reading.echo.shared);
  }
}

TEST(StrobeTracker, OfTwoTracksAtOnePlaceTheOlderOneHasTheEcho) {
  Sea sea({straight({900.0, -100.0}, {0.0, 6.0})});
  Bayesian tracker = make_tracker();
  const std::int64_t older = tracker.designate(0.0, 900.0, -100.0, 5.0);
  const std::int64_t younger = tracker.designate(0.0, 900.0, -100.0, 5.0);
  (void)run(tracker, sea, 0, 4 * kSweeps);
  ASSERT_NE(tracker.find(older), nullptr);
  EXPECT_EQ(tracker.find(older)->misses, 0);
  EXPECT_EQ(tracker.find(younger), nullptr);
}

TEST(StrobeTracker, AcquiresEachVesselOnceFromPlots) {
  Sea sea({straight({900.0, -250.0}, {0.0, 9.0}), straight({-600.0, 800.0}, {-7.0, 0.0}),
           straight({900.0, -150.0}, {0.0, 9.0})});
  PlotExtractor<> extractor({.max_sweep_cells = Sea::kCells});
  Bayesian tracker = make_tracker();
  std::map<std::int64_t, std::int64_t> confirmed;
  int started = 0;
  for (int k = 0; k < 30 * kSweeps; ++k) {
    const Sweep<> sweep = sea.sweep(k);
    for (const Event& event : tracker.process(sweep).events) {
      EXPECT_EQ(event.kind, TrackEvent::kConfirmed);
      EXPECT_LT(event.tentative_id, 0);
      confirmed[event.track_id] = event.tentative_id;
    }
    started += tracker.acquire(extractor.process(sweep));
  }
  EXPECT_EQ(started, 3);
  EXPECT_EQ(confirmed.size(), 3u);
  EXPECT_EQ(tracker.size(), 3);
  for (const Vessel& vessel : sea.vessels) {
    double nearest_m = 1e9;
    tracker.for_each([&](const StrobeTrack& track) {
      nearest_m = std::min(nearest_m, error_m(track, vessel));
      EXPECT_GE(track.hits, 27);
    });
    EXPECT_LT(nearest_m, 5.0);
  }
}

TEST(StrobeTracker, AFalsePlotEndsAtItsFirstMiss) {
  Sea sea({});
  Bayesian tracker = make_tracker();
  (void)run(tracker, sea, 0, 100);
  const VideoPlot plot{.time_s = Sea::time_s(95), .range_m = 900.0, .bearing_rad = 95 * Sea::kStep};
  EXPECT_EQ(tracker.acquire({&plot, 1}), 1);
  EXPECT_EQ(tracker.acquire({&plot, 1}), 0) << "the same plot again";
  const Log log = run(tracker, sea, 100, 2 * kSweeps);
  EXPECT_EQ(log.readings.size(), 1u);
  EXPECT_EQ(log.count(TrackEvent::kLost), 1);
  EXPECT_EQ(tracker.size(), 0);
}

// Where nothing is to be seen

TEST(StrobeTracker, ExcludedAreasAreEmpty) {
  LandMask land(720);
  land.exclude_polygon(
      std::vector<Point>{{800.0, 0.0}, {1000.0, 0.0}, {1000.0, 400.0}, {800.0, 400.0}});
  Sea sea({straight({900.0, -200.0}, {0.0, 10.0})});
  Bayesian tracker = make_tracker({}, kRadar, land);
  const std::int64_t id = tracker.designate(0.0, 900.0, -200.0, 5.0);
  (void)run(tracker, sea, 0, 6 * kSweeps);
  EXPECT_NE(tracker.find(id), nullptr);
  (void)run(tracker, sea, 6 * kSweeps, 16 * kSweeps);
  EXPECT_EQ(tracker.find(id), nullptr);
  const double bearing = std::atan2(150.0, 900.0);
  const VideoPlot ashore{.time_s = tracker.time_s(), .range_m = 912.0, .bearing_rad = bearing};
  EXPECT_EQ(tracker.acquire({&ashore, 1}), 0);
}

TEST(StrobeTracker, ATurnWithoutSweepsIsAMiss) {
  Sea sea({straight({900.0, 100.0}, {0.0, 2.0})});
  Bayesian tracker = make_tracker();
  const std::int64_t id = tracker.designate(0.0, 900.0, 100.0, 5.0);
  (void)run(tracker, sea, 0, 5 * kSweeps);
  EXPECT_EQ(tracker.find(id)->misses, 0);
  (void)run(tracker, sea, 7 * kSweeps, 7 * kSweeps + 1);
  EXPECT_EQ(tracker.find(id)->misses, 2);
  (void)run(tracker, sea, 7 * kSweeps + 1, 8 * kSweeps);
  EXPECT_EQ(tracker.find(id)->misses, 0);
  (void)run(tracker, sea, 30 * kSweeps, 30 * kSweeps + 1);
  EXPECT_EQ(tracker.find(id), nullptr);
}

TEST(StrobeTracker, ASectorIsATurnWithAGap) {
  Sea sea({straight({900.0, 400.0}, {3.0, -4.0})});
  Bayesian tracker = make_tracker();
  const std::int64_t id = tracker.designate(0.0, 900.0, 400.0, 5.0);
  std::size_t readings = 0;
  for (int k = 0; k < 12 * kSweeps; ++k) {
    const int row = k % kSweeps;
    if (row < 20 || row > 90) continue;
    readings += tracker.process(sea.sweep(k)).readings.size();
  }
  EXPECT_EQ(readings, 12u);
  EXPECT_LT(error_m(*tracker.find(id), sea.vessels[0]), 4.0);
}

TEST(StrobeTracker, RejectsSweepsOfNoRadarAndChangesNothing) {
  Sea sea({straight({900.0, 100.0}, {0.0, 2.0})});
  Bayesian tracker = make_tracker({.max_sweep_cells = Sea::kCells});
  EXPECT_GT(tracker.designate(0.0, 900.0, 100.0, 5.0), 0);
  (void)run(tracker, sea, 0, 500);
  const std::vector<std::byte> before = tracker.save();
  const Sweep<> last = sea.sweep(499);
  EXPECT_EQ(tracker.process(last).status, SweepStatus::kRepeated);
  Sweep<> odd = sea.sweep(500);
  odd.time_s = kNan;
  EXPECT_EQ(tracker.process(odd).status, SweepStatus::kInvalid);
  odd.time_s = last.time_s - 0.1;
  EXPECT_EQ(tracker.process(odd).status, SweepStatus::kInvalid);
  odd = sea.sweep(500);
  EXPECT_EQ(tracker.process(odd, {.north_m = kNan}).status, SweepStatus::kInvalid);
  const std::vector<std::uint8_t> longer(Sea::kCells + 1);
  odd.amplitude = longer;
  EXPECT_EQ(tracker.process(odd).status, SweepStatus::kTooLong);
  EXPECT_EQ(tracker.save(), before);
  EXPECT_EQ(tracker.process(sea.sweep(500)).status, SweepStatus::kOk);
  EXPECT_EQ(tracker.process(sea.sweep(510)).status, SweepStatus::kGap);
}

TEST(StrobeTracker, RejectsWhatMakesNoSense) {
  EXPECT_THROW(make_tracker({.radius_m = 0.0}), std::invalid_argument);
  EXPECT_THROW(make_tracker({.radius_m = 50.0, .max_radius_m = 40.0}), std::invalid_argument);
  EXPECT_THROW(make_tracker({.growth = 0.9}), std::invalid_argument);
  EXPECT_THROW(make_tracker({.shrinkage = 1.1}), std::invalid_argument);
  EXPECT_THROW(make_tracker({.least_amplitude = 0}), std::invalid_argument);
  EXPECT_THROW(make_tracker({}, {.period_s = 0.0}), std::invalid_argument);
  Bayesian tracker = make_tracker({.max_tracks = 1});
  EXPECT_EQ(tracker.designate(0.0, kNan, 0.0, 5.0), 0);
  EXPECT_EQ(tracker.designate(0.0, 900.0, 0.0, 0.0), 0);
  EXPECT_EQ(tracker.designate(0.0, 900.0, 0.0, 5.0), 1);
  EXPECT_EQ(tracker.designate(0.0, -900.0, 0.0, 5.0), 0) << "no room";
  EXPECT_FALSE(tracker.drop(2));
  EXPECT_TRUE(tracker.drop(1));
  EXPECT_EQ(tracker.designate(0.0, -900.0, 0.0, 5.0), 2);
}

// The radar on board

TEST(StrobeTracker, OwnShipMovesAndItsRadarIsTurned) {
  Radar radar = kRadar;
  radar.bearing_offset_rad = deg(4.0);
  Sea sea({straight({900.0, 300.0}, {-4.0, 2.0})});
  sea.bearing_offset_rad = radar.bearing_offset_rad;
  Bayesian tracker = make_tracker({}, radar);
  const std::int64_t id = tracker.designate(0.0, 900.0, 300.0, 5.0);
  std::size_t readings = 0;
  for (int k = 0; k < 30 * kSweeps; ++k) {
    sea.own = {.north_m = 10.0 * Sea::time_s(k), .east_m = -6.0 * Sea::time_s(k)};
    readings += tracker.process(sea.sweep(k), sea.own).readings.size();
  }
  EXPECT_NEAR(static_cast<double>(readings), 30.0, 1.0);
  ASSERT_NE(tracker.find(id), nullptr);
  EXPECT_LT(error_m(*tracker.find(id), sea.vessels[0]), 3.0);
  EXPECT_NEAR(tracker.find(id)->kinematics.mean[1], -4.0, 0.4);
  EXPECT_NEAR(tracker.find(id)->kinematics.mean[3], 2.0, 0.4);
}

// Memory and state

TEST(StrobeTracker, AThousandStrobesNeedNoHeap) {
  std::vector<Point> places;
  for (int k = 0; k < 1000; ++k)
    places.push_back((400.0 + 2.0 * (k % 1000)) * towards(kTurn * k / 1000.0));
  Sea sea({});
  for (int k = 0; k < 1000; k += 50)
    sea.vessels.push_back(straight(places[static_cast<std::size_t>(k)], {1.0, -1.0}));
  std::vector<std::vector<std::uint8_t>> rows;
  std::vector<Sweep<>> sweeps;
  for (int k = 0; k < 4 * kSweeps; ++k) {
    const Sweep<> sweep = sea.sweep(k);
    rows.emplace_back(sweep.amplitude.begin(), sweep.amplitude.end());
    sweeps.push_back(sweep);
  }
  for (std::size_t k = 0; k < sweeps.size(); ++k) sweeps[k].amplitude = rows[k];
  Bayesian tracker = make_tracker();
  PlotExtractor<> extractor({.max_sweep_cells = Sea::kCells});
  int readings = 0, lost = 0;
  {
    const test::NoHeap fence;
    for (const Point& place : places) ASSERT_GT(tracker.designate(0.0, place[0], place[1], 5.0), 0);
    for (const Sweep<>& sweep : sweeps) {
      const StrobeReport report = tracker.process(sweep);
      readings += static_cast<int>(report.readings.size());
      for (const Event& event : report.events) lost += event.kind == TrackEvent::kLost;
      (void)tracker.acquire(extractor.process(sweep));
    }
    EXPECT_EQ(fence.allocations(), 0);
  }
  EXPECT_GT(readings, 2500);
  EXPECT_GT(lost, 800);
  EXPECT_GE(tracker.size(), 20);
}

TEST(StrobeTracker, ContinuesBitForBitFromASavedState) {
  Sea sea({straight({900.0, -250.0}, {0.0, 6.0}), straight({-700.0, 300.0}, {2.0, 6.0})});
  PlotExtractor<> extractor({.max_sweep_cells = Sea::kCells});
  Bayesian tracker = make_tracker();
  const std::int64_t id = tracker.designate(0.0, 900.0, -250.0, 5.0);
  const int amid = 6 * kSweeps + 678;  // within the first vessel's strobe
  for (int k = 0; k < amid; ++k) {
    (void)tracker.process(sea.sweep(k));
    (void)tracker.acquire(extractor.process(sea.sweep(k)));
  }
  const std::vector<std::byte> state = tracker.save();
  Bayesian other = make_tracker();
  ASSERT_TRUE(other.restore(state));
  EXPECT_EQ(other.save(), state);
  for (int k = amid; k < 9 * kSweeps; ++k) {
    (void)tracker.process(sea.sweep(k));
    (void)other.process(sea.sweep(k));
  }
  EXPECT_EQ(other.save(), tracker.save());
  EXPECT_EQ(other.find(id)->misses, 0);
  EXPECT_EQ(other.size(), 2);

  const std::vector<std::byte> good = other.save();
  EXPECT_FALSE(make_tracker({.radius_m = 44.0}).restore(state));
  EXPECT_FALSE(Fuzzy(kRadar, {}, FuzzyAlphaBeta<>{}).restore(state));
  for (const std::size_t at : {std::size_t{5}, state.size() / 2, state.size() - 1}) {
    std::vector<std::byte> damaged = state;
    damaged[at] ^= std::byte{1};
    EXPECT_FALSE(other.restore(damaged));
  }
  EXPECT_FALSE(other.restore({state.data(), state.size() / 2}));
  EXPECT_FALSE(other.restore({}));
  EXPECT_EQ(other.save(), good);
}

}  // namespace
}  // namespace wakeline::strobe_tracker_test
