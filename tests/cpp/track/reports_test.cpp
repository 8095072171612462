// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Vessels that report where they are.
#include <algorithm>
#include <functional>
#include <limits>
#include <string>

#include "support/malloc_fence.hpp"
#include "track/scene.hpp"

namespace wakeline::reports_test {
namespace {

using namespace test;

constexpr double kPeriod_s = 3.0;
const Radar kRadar{.range_std_m = 10.0,
                   .bearing_std_rad = deg(0.5),
                   .extent_std_m = 2.0,
                   .period_s = kPeriod_s,
                   .max_speed_mps = 20.0};

/// A vessel that reports by AIS, rightly unless `tamper` changes it.
struct Vessel {
  Boat boat;
  std::string identity = {};  ///< empty: it does not report
  double interval_s = 10.0;
  double latency_s = 2.0;
  bool seen = true;  ///< by the radar
  std::function<void(PositionReport&)> tamper = [](PositionReport&) {};
};

/// What is seen, and what is believed of it.
struct Scene {
  std::vector<Vessel> vessels;
  VesselTracker tracker = make_tracker({}, kRadar);
  Draw draw{1};
  Sea sea{2, kRadar};
  double time_s = 0.0;
  std::vector<Event> events = {};
  double squared_m2 = 0.0, squared_m2s2 = 0.0, matched = 0.0, identified = 0.0;

  void report(const Vessel& vessel, double of_s) {
    PositionReport one{.identity = vessel.identity,
                       .time_s = of_s,
                       .position_m = vessel.boat.at(of_s) + 5.0 * draw.normals<2>(),
                       .position_std_m = 5.0,
                       .velocity_mps = vessel.boat.velocity_mps + 0.2 * draw.normals<2>(),
                       .velocity_std_mps = 0.3};
    vessel.tamper(one);
    const ReportResult result = tracker.report(one);
    events.insert(events.end(), result.events.begin(), result.events.end());
  }

  void run(double until_s) {
    while (time_s < until_s) {
      const double before_s = time_s;
      time_s += kPeriod_s;
      std::vector<Plot> plots;
      for (const Vessel& vessel : vessels)
        if (vessel.seen && sea.draw.uniform(0.0, 1.0) < 0.9)
          plots.push_back(sea.swept(vessel.boat, before_s));
      const ScanReport scan = tracker.process(time_s, plots);
      events.insert(events.end(), scan.events.begin(), scan.events.end());
      for (const Vessel& vessel : vessels) {
        if (vessel.identity.empty()) continue;
        const double phase_s = static_cast<double>(&vessel - vessels.data());
        for (double of_s = phase_s; of_s + vessel.latency_s <= time_s; of_s += vessel.interval_s)
          if (of_s + vessel.latency_s > before_s) report(vessel, of_s);
      }
      score();
    }
  }

  void score() {
    if (time_s < 60.0) return;
    for (const Vessel& vessel : vessels) {
      const Track* track = track_at(tracker, vessel.boat.at(time_s), 200.0);
      if (track == nullptr) continue;
      const Gaussian<4> now = tracker.kinematics_at(*track, time_s);
      squared_m2 +=
          (Vec<double, 2>(now.mean[0], now.mean[2]) - vessel.boat.at(time_s)).squaredNorm();
      squared_m2s2 +=
          (Vec<double, 2>(now.mean[1], now.mean[3]) - vessel.boat.velocity_mps).squaredNorm();
      ++matched;
      identified += name_of(*track) == vessel.identity;
    }
  }

  [[nodiscard]] std::string name_of(const Track& track) const {
    const Identity* identity = tracker.identity_of(track);
    return identity == nullptr ? "" : identity->name.data();
  }
  [[nodiscard]] int count(TrackEvent kind) const {
    return static_cast<int>(std::count_if(events.begin(), events.end(),
                                          [&](const Event& e) { return e.kind == kind; }));
  }
  [[nodiscard]] double rms_m() const { return std::sqrt(squared_m2 / matched); }
  [[nodiscard]] double rms_mps() const { return std::sqrt(squared_m2s2 / matched); }
};

std::vector<Vessel> fleet(int count, std::uint64_t seed) {
  Draw draw(seed);
  std::vector<Vessel> vessels;
  while (static_cast<int>(vessels.size()) < count) {
    const Boat boat{{draw.uniform(-5000.0, 5000.0), draw.uniform(1500.0, 6000.0)},
                    {draw.uniform(-7.0, 7.0), draw.uniform(-7.0, 7.0)}};
    if (std::all_of(vessels.begin(), vessels.end(), [&](const Vessel& other) {
          return (other.boat.start_m - boat.start_m).norm() > 500.0;
        }))
      vessels.push_back({boat});
  }
  return vessels;
}

std::vector<Vessel> all_reporting(int count, std::uint64_t seed) {
  std::vector<Vessel> vessels = fleet(count, seed);
  for (std::size_t k = 0; k < vessels.size(); ++k)
    vessels[k].identity = std::to_string(257000000 + k);
  return vessels;
}

TEST(Reports, MakePositionAndVelocityAboutTwiceAsGood) {
  Scene alone{fleet(12, 1)}, with{all_reporting(12, 1)};
  alone.run(240.0);
  with.run(240.0);
  EXPECT_LT(with.rms_m(), 0.55 * alone.rms_m());
  EXPECT_LT(with.rms_mps(), 0.5 * alone.rms_mps());
  EXPECT_EQ(with.identified, with.matched);
  EXPECT_EQ(with.count(TrackEvent::kIdentified), 12) << "once each";
  EXPECT_EQ(with.count(TrackEvent::kIdentityDisagrees), 0);
}

TEST(Reports, OfAMinuteAgoAndOfThreeMinutesIntervalsDoNoHarm) {
  for (const auto& [latency_s, interval_s] : {std::pair(60.0, 10.0), {20.0, 30.0}, {2.0, 180.0}}) {
    Scene alone{fleet(10, 2)}, with{all_reporting(10, 2)};
    for (Vessel& vessel : with.vessels) {
      vessel.latency_s = latency_s;
      vessel.interval_s = interval_s;
    }
    alone.run(300.0);
    with.run(300.0);
    EXPECT_LT(with.rms_m(), 1.05 * alone.rms_m()) << latency_s << " " << interval_s;
    EXPECT_LT(with.rms_mps(), 1.05 * alone.rms_mps()) << latency_s << " " << interval_s;
  }
}

/// Where all vessels lie in one of these ways, tracks are as good as by radar alone.
void expect_no_drag(const std::vector<Vessel>& vessels,
                    const std::vector<std::function<void(PositionReport&)>>& lies) {
  Scene alone{vessels};
  alone.run(240.0);
  for (std::size_t lie = 0; lie < lies.size(); ++lie) {
    Scene with{vessels};
    for (std::size_t k = 0; k < with.vessels.size(); ++k) {
      with.vessels[k].identity = std::to_string(k);
      with.vessels[k].tamper = lies[lie];
    }
    with.run(240.0);
    EXPECT_LT(with.rms_m(), 1.05 * alone.rms_m()) << lie;
    EXPECT_LT(with.rms_mps(), 1.05 * alone.rms_mps()) << lie;
  }
}

TEST(Reports, ThatLieDragNoTrackOfTheRadar) {
  const std::vector<std::function<void(PositionReport&)>> lies{
      [](PositionReport& r) { r.position_m[0] += 3704.0; },  // 2 NM from its echo
      [](PositionReport& r) {
        r.position_m = {2000.0, 2000.0};
      },  // it stands
      [](PositionReport& r) { r.position_m.setZero(), r.velocity_mps.setZero(); },
      [](PositionReport& r) {  // half of the time
        if (std::fmod(r.time_s, 20.0) < 10.0) r.position_m[1] += 1000.0;
      },
      [](PositionReport& r) {  // it begins rightly
        if (r.time_s > 90.0) r.position_m[1] += 8.0 * (r.time_s - 90.0);
      }};
  expect_no_drag(fleet(6, 3), lies);
}

// Before the radar sees them they make tracks that stand where they say, of which the plots beside
// may be outliers, one by one.
TEST(Reports, OfAPlaceBesideTheirEchoesDragNoTrackForLong) {
  const auto run = [](Scene& scene) {
    for (Vessel& vessel : scene.vessels) vessel.seen = false;
    scene.run(30.0);
    for (Vessel& vessel : scene.vessels) vessel.seen = true;
    scene.run(400.0);
  };
  Scene radar{fleet(20, 41)}, both{all_reporting(20, 41)};
  for (Vessel& vessel : both.vessels)
    vessel.tamper = [](PositionReport& one) { one.position_m[1] += 100.0; };
  run(radar);
  run(both);
  EXPECT_LT(both.rms_m(), 1.3 * radar.rms_m());
  EXPECT_GE(both.count(TrackEvent::kIdentityDisagrees), 10);
}

TEST(Reports, OfAVelocityAtWhichTheirPositionsDoNotMoveDragNoTrackOfTheRadar) {
  std::vector<Vessel> vessels = fleet(20, 3);
  std::erase_if(vessels, [](const Vessel& one) { return one.boat.velocity_mps.norm() < 3.0; });
  const std::vector<std::function<void(PositionReport&)>> lies{
      [](PositionReport& r) { r.velocity_mps.setZero(); },
      [](PositionReport& r) { r.velocity_mps = -r.velocity_mps; },
      [](PositionReport& r) {
        r.velocity_mps = {-r.velocity_mps[1], r.velocity_mps[0]};
      },
      [](PositionReport& r) {  // the position stands after a while
        if (r.time_s > 60.0) r.position_m -= (r.time_s - 60.0) * r.velocity_mps;
      }};
  expect_no_drag(vessels, lies);
}

/// What an honest vessel on a circle reports, its velocity smoothed so long.
PositionReport on_circle(double time_s, double speed_mps, double rate, double lag_s, Draw& draw) {
  const auto heading = [&](double at_s) {
    return Vec<double, 2>(std::cos(rate * at_s), std::sin(rate * at_s));
  };
  const double radius_m = speed_mps / rate;
  const Vec<double, 2> place(std::sin(rate * time_s), 1.0 - std::cos(rate * time_s));
  return {.identity = "honest",
          .time_s = time_s,
          .position_m = radius_m * place + 5.0 * draw.normals<2>(),
          .position_std_m = 5.0,
          .velocity_mps = speed_mps * heading(time_s - lag_s) + 0.2 * draw.normals<2>(),
          .velocity_std_mps = 0.3};
}

TEST(ReportedVelocity, OfAVesselThatTurnsIsNotContradicted) {
  for (const auto& [speed_mps, rate_deg, every_s, lag_s] :
       {std::tuple(8.0, 3.0, 2.0, 0.0), std::tuple(8.0, 3.0, 2.0, 2.0),
        std::tuple(8.0, 2.0, 10.0, 0.0), std::tuple(15.0, 3.0, 10.0, 1.0)}) {
    Draw draw(5);
    ReportedVelocity velocity;
    int fits = 0, contradicts = 0;
    for (int k = 0; k < 300; ++k) {
      velocity.note(on_circle(every_s * k, speed_mps, deg(rate_deg), lag_s, draw), every_s);
      fits += velocity.fits();
      contradicts += velocity.contradicts();
    }
    EXPECT_GT(fits, 270) << rate_deg << " " << lag_s;
    EXPECT_LT(contradicts, 6) << rate_deg << " " << lag_s;
  }
}

TEST(Reports, OfAnotherVelocityThanATrackMovesOnReportsAloneByItsPositions) {
  Scene scene{fleet(3, 3)};
  for (Vessel& vessel : scene.vessels) {
    vessel.identity = std::to_string(&vessel - scene.vessels.data());
    vessel.seen = false;
    vessel.tamper = [](PositionReport& r) { r.velocity_mps.setZero(); };
  }
  scene.run(240.0);
  for (const Vessel& vessel : scene.vessels) {
    const Track* track = scene.tracker.find("ais", vessel.identity);
    ASSERT_NE(track, nullptr);
    const Gaussian<4> now = scene.tracker.kinematics_at(*track, 240.0);
    const Vec<double, 2> velocity_mps(now.mean[1], now.mean[3]);
    EXPECT_LT((velocity_mps - vessel.boat.velocity_mps).norm(), 1.5);
  }
}

TEST(Reports, AnIdentityThatLeavesItsEchoIsTold) {
  Scene scene{all_reporting(4, 4)};
  scene.run(90.0);
  const Track* track = scene.tracker.find("ais", scene.vessels[0].identity);
  ASSERT_NE(track, nullptr);
  const std::int64_t id = track->id;
  scene.vessels[0].tamper = [](PositionReport& r) { r.position_m[0] += 2000.0; };
  scene.run(150.0);
  EXPECT_EQ(scene.count(TrackEvent::kIdentityJumps), 1);
  EXPECT_EQ(scene.count(TrackEvent::kIdentityDisagrees), 1);
  EXPECT_EQ(scene.count(TrackEvent::kIdentityLost), 1);
  ASSERT_NE(scene.tracker.find(id), nullptr);
  EXPECT_EQ(scene.tracker.find(id)->identity, -1);
  const Track* reported = scene.tracker.find("ais", scene.vessels[0].identity);
  ASSERT_NE(reported, nullptr) << "where it says that it is";
  EXPECT_NE(reported->id, id);
}

TEST(Reports, OneIdentityOfTwoVesselsIsOnNeither) {
  std::vector<Vessel> vessels = all_reporting(2, 5);
  vessels[1].identity = vessels[0].identity;
  Scene alone{fleet(2, 5)}, scene{vessels};
  alone.run(240.0);
  scene.run(240.0);
  EXPECT_GE(scene.count(TrackEvent::kIdentityJumps), 1);
  EXPECT_EQ(scene.tracker.find("ais", vessels[0].identity), nullptr);
  EXPECT_EQ(scene.identified, 0.0) << "from a minute on";
  EXPECT_LT(scene.rms_m(), 1.05 * alone.rms_m());
  EXPECT_EQ(tracks_of(scene.tracker, true).size(), 2u);
}

TEST(Reports, TwoIdentitiesOfOneVesselAreTold) {
  std::vector<Vessel> vessels = all_reporting(1, 6);
  vessels.push_back(vessels[0]);
  vessels[1].identity = "another";
  vessels[1].seen = false;
  Scene scene{vessels};
  scene.run(120.0);
  EXPECT_GE(scene.count(TrackEvent::kIdentityShared), 1);
  EXPECT_EQ(tracks_of(scene.tracker, true).size(), 1u);
}

TEST(Reports, SwappedIdentitiesFollowTheirReports) {
  std::vector<Vessel> vessels = all_reporting(2, 7);
  Scene scene{vessels};
  scene.run(90.0);
  std::swap(scene.vessels[0].identity, scene.vessels[1].identity);
  scene.run(200.0);
  for (const Vessel& vessel : scene.vessels) {
    const Track* track = track_at(scene.tracker, vessel.boat.at(scene.time_s));
    ASSERT_NE(track, nullptr);
    EXPECT_EQ(scene.name_of(*track), vessel.identity);
  }
}

TEST(Reports, ATrackLivesOnReportsAloneAndTheRadarTakesItOver) {
  std::vector<Vessel> vessels = all_reporting(3, 8);
  for (Vessel& vessel : vessels) vessel.seen = false;
  vessels[2].interval_s = 180.0;
  Scene scene{vessels};
  scene.run(400.0);
  EXPECT_EQ(tracks_of(scene.tracker, true).size(), 3u);
  const std::set<std::int64_t> before = ids_of(scene.tracker);
  for (Vessel& vessel : scene.vessels) vessel.seen = true;
  scene.run(500.0);
  for (const Vessel& vessel : scene.vessels) {
    const Track* track = track_at(scene.tracker, vessel.boat.at(scene.time_s));
    ASSERT_NE(track, nullptr);
    EXPECT_TRUE(before.contains(track->id));
    EXPECT_EQ(scene.name_of(*track), vessel.identity);
  }
  EXPECT_EQ(tracks_of(scene.tracker, true).size(), 3u);
  for (Vessel& vessel : scene.vessels) {
    vessel.seen = false;
    vessel.identity.clear();
  }
  scene.run(1200.0);
  EXPECT_EQ(scene.tracker.size(), 0) << "none of them is there any more";
}

TEST(Reports, ThatMakeNoSenseAreRejectedAndChangeNothing) {
  Scene scene{all_reporting(2, 9)};
  scene.run(60.0);
  const std::vector<std::byte> before = scene.tracker.save();
  const PositionReport good{.identity = "x", .time_s = 60.0, .position_m = {1.0, 2.0}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string longest(200, 'x');
  for (const auto& spoil : std::vector<std::function<void(PositionReport&)>>{
           [&](PositionReport& r) { r.position_m[0] = nan; },
           [&](PositionReport& r) { r.position_std_m = 0.0; },
           [&](PositionReport& r) { r.velocity_mps[1] = 1e300; },
           [&](PositionReport& r) { r.velocity_std_mps = -1.0; },
           [&](PositionReport& r) { r.identity = longest; },
           [&](PositionReport& r) { r.identity = ""; },
           [&](PositionReport& r) { r.identity = "\xff"; },
           [&](PositionReport& r) { r.source = longest; },
           [&](PositionReport& r) { r.time_s = 1e5; }}) {
    PositionReport bad = good;
    spoil(bad);
    EXPECT_EQ(scene.tracker.report(bad).status, Status::kNotFinite);
  }
  PositionReport old = good;
  old.time_s = 60.0 - 3600.0;
  EXPECT_EQ(scene.tracker.report(old).status, Status::kNegativeTimeStep) << "an hour old";
  EXPECT_EQ(scene.tracker.save(), before);
  PositionReport again = good;
  (void)scene.tracker.report(again);
  EXPECT_EQ(scene.tracker.report(again).status, Status::kNegativeTimeStep) << "the same again";
}

TEST(Reports, AreSavedWithTheTrackerAndTakeNoMemory) {
  Scene scene{all_reporting(5, 10)};
  scene.run(120.0);
  Scene restored{scene.vessels};
  ASSERT_TRUE(restored.tracker.restore(scene.tracker.save()));
  restored.draw = scene.draw;
  restored.sea = scene.sea;
  restored.time_s = scene.time_s;
  for (Scene* one : {&scene, &restored}) one->run(200.0);
  EXPECT_EQ(scene.tracker.save(), restored.tracker.save());
  const PositionReport fresh{.identity = "new", .time_s = 200.0, .position_m = {1.0, 2.0}};
  const NoHeap fence;
  PositionReport later = fresh;
  for (int k = 0; k < 5; ++k) {
    later.time_s = 200.0 + k;
    (void)scene.tracker.report(later);
  }
  EXPECT_EQ(fence.allocations(), 0);
}

}  // namespace
}  // namespace wakeline::reports_test
