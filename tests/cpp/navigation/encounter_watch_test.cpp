// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/encounter_watch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "support/rejection.hpp"
#include "wakeline/core/angle.hpp"

namespace wakeline::encounter_watch_test {
namespace {

using Vec2 = Vec<double, 2>;
using Vec4 = Vec<double, 4>;
using Mat4 = Mat<double, 4, 4>;
using Pair = std::pair<std::int64_t, std::int64_t>;

Mat4 errors(double position_std, double velocity_std) {
  const double p = position_std * position_std, v = velocity_std * velocity_std;
  return Vec4(p, v, p, v).asDiagonal();
}

WatchedVessel vessel(std::int64_t id, const Vec2& position, const Vec2& velocity,
                     double position_std = 5.0, double velocity_std = 0.1) {
  return {
      id,
      {{position[0], velocity[0], position[1], velocity[1]}, errors(position_std, velocity_std)}};
}

/// The vessels after a time, straight on.
std::vector<WatchedVessel> later(std::vector<WatchedVessel> vessels, double dt_s) {
  for (WatchedVessel& one : vessels) {
    Vec4& x = one.kinematics.mean;
    x[0] += dt_s * x[1];
    x[2] += dt_s * x[3];
  }
  return vessels;
}

/// Vessels of every kind in a square: under way, at anchor, well and badly known.
std::vector<WatchedVessel> traffic(test::Draw& draw, int count, double side_m) {
  std::vector<WatchedVessel> vessels;
  for (int k = 0; k < count; ++k) {
    const double course = draw.uniform(-4, 4);
    const double speed = draw.uniform(0, 1) < 0.3 ? draw.uniform(0, 0.4) : draw.uniform(0.6, 12);
    const double position_std = draw.uniform(1, 60), velocity_std = draw.uniform(0.02, 1.0);
    WatchedVessel one = vessel(3 * k + 1, {draw.uniform(0, side_m), draw.uniform(0, side_m)},
                               speed * Vec2(std::cos(course), std::sin(course)));
    const Vec4 std(position_std, velocity_std, position_std, velocity_std);
    one.kinematics.covariance = std.asDiagonal() * draw.definite<4>() * std.asDiagonal();
    vessels.push_back(one);
  }
  return vessels;
}

/// The approaches that can matter by the words of the class, of all pairs.
std::map<Pair, Approach> by_brute_force(const std::vector<WatchedVessel>& vessels,
                                        const DangerLimits& limits) {
  std::map<Pair, Approach> found;
  for (const WatchedVessel& a : vessels)
    for (const WatchedVessel& b : vessels) {
      if (a.id >= b.id) continue;
      const Vec4 relative = b.kinematics.mean - a.kinematics.mean;
      const Mat4 covariance = a.kinematics.covariance + b.kinematics.covariance;
      const ClosestApproach closest({relative, covariance});
      const Vec4 along(0, relative[1], 0, relative[3]);
      const double speed2 = along.squaredNorm(), variance = along.dot(covariance * along) / speed2;
      const auto under_way = [&](const WatchedVessel& one) {
        const auto& p = one.kinematics.covariance;
        const double worst = (p(1, 1) + p(3, 3)) / 2 + std::hypot((p(1, 1) - p(3, 3)) / 2, p(1, 3));
        return std::hypot(one.kinematics.mean[1], one.kinematics.mean[3]) >
               limits.rest_speed_mps + 2.0 * std::sqrt(worst);
      };
      if (!(speed2 > 9.0 * variance) || !(under_way(a) || under_way(b)) || closest.tcpa_s() < 0.0 ||
          closest.tcpa_s() > limits.tcpa_limit_s)
        continue;
      const double p = closest.probability(limits.cpa_limit_m, limits.tcpa_limit_s);
      if (p < EncounterWatch::kLeastProbability) continue;
      Approach& one = found[{a.id, b.id}];
      one.range_m = std::hypot(relative[0], relative[2]);
      one.signed_cpa_m = closest.signed_cpa_m();
      one.tcpa_s = closest.tcpa_s();
      one.covariance = closest.covariance();
      one.probability = p;
    }
  return found;
}

TEST(EncounterWatch, FindsOfAllPairsThoseThatCanMatter) {
  test::Draw draw(1);
  for (const double side_m : {2e3, 2e4, 1e5})
    for (const DangerLimits& limits :
         {DangerLimits{}, DangerLimits{.cpa_limit_m = 100, .tcpa_limit_s = 300},
          DangerLimits{.cpa_limit_m = 5000, .tcpa_limit_s = 60}}) {
      const std::vector<WatchedVessel> vessels = traffic(draw, 150, side_m);
      const auto all = by_brute_force(vessels, limits);
      EncounterWatch watch(limits);
      const EncounterReport report = watch.update(0.0, vessels);
      ASSERT_EQ(report.left_out, 0);
      EXPECT_EQ(report.approaches.size(), all.size());
      for (const Approach& one : report.approaches) {
        const auto found = all.find({one.first, one.second});
        ASSERT_NE(found, all.end()) << one.first << " " << one.second;
        EXPECT_DOUBLE_EQ(one.range_m, found->second.range_m);
        EXPECT_EQ(one.signed_cpa_m, found->second.signed_cpa_m);
        EXPECT_EQ(one.tcpa_s, found->second.tcpa_s);
        EXPECT_EQ(one.covariance, found->second.covariance);
        EXPECT_EQ(one.probability, found->second.probability);
      }
      const auto dangers = std::count_if(all.begin(), all.end(), [&](const auto& one) {
        return one.second.probability >= limits.alarm_probability;
      });
      EXPECT_EQ(std::ssize(watch.encounters()), dangers);
    }
}

TEST(EncounterWatch, DoesNotDependOnTheOrderOfTheVessels) {
  test::Draw draw(2);
  std::vector<WatchedVessel> vessels = traffic(draw, 100, 1e4);
  EncounterWatch a, b;
  (void)a.update(0.0, vessels);
  std::reverse(vessels.begin(), vessels.end());
  (void)b.update(0.0, vessels);
  ASSERT_EQ(a.encounters().size(), b.encounters().size());
  ASSERT_GT(a.encounters().size(), 10u);
  for (std::size_t k = 0; k < a.encounters().size(); ++k) {
    EXPECT_EQ(a.encounters()[k].id, b.encounters()[k].id);
    EXPECT_EQ(a.encounters()[k].approach.probability, b.encounters()[k].approach.probability);
  }
}

TEST(EncounterWatch, GivesTheProbabilityOfManyDraws) {
  test::Draw draw(3);
  for (int k = 0; k < 12; ++k) {
    const double limit_m = draw.uniform(200, 1000), after_s = draw.uniform(100, 1100);
    const double miss_m = draw.uniform(0, 2 * limit_m);
    std::vector<WatchedVessel> vessels{
        vessel(1, {0, 0}, {4, 0}, draw.uniform(5, 60), draw.uniform(0.05, 0.3)),
        vessel(2, {9 * after_s, miss_m}, {-5, 0}, draw.uniform(5, 60), draw.uniform(0.05, 0.3))};
    EncounterWatch watch({.cpa_limit_m = limit_m});
    const EncounterReport report = watch.update(0.0, vessels);
    if (report.approaches.empty()) continue;
    int near = 0;
    constexpr int kDraws = 10000;
    for (int i = 0; i < kDraws; ++i) {
      const Vec4 x = draw.of(vessels[1].kinematics) - draw.of(vessels[0].kinematics);
      const Vec2 p(x[0], x[2]), v(x[1], x[3]);
      const double t = std::clamp(-p.dot(v) / v.squaredNorm(), 0.0, 1200.0);
      near += (p + t * v).norm() < limit_m;
    }
    EXPECT_NEAR(report.approaches[0].probability, near / double(kDraws), 0.02);
    const Vec2 at_cpa_m =
        report.approaches[0].second_at_cpa_m - report.approaches[0].first_at_cpa_m;
    EXPECT_NEAR(at_cpa_m.norm(), report.approaches[0].cpa_m(), 1e-6);
  }
}

/// One encounter from its beginning to its end.
struct Story {
  int began = 0, ended = 0;
  double begin_s = NAN, last_s = NAN, end_s = NAN;
};

/// What is reported of a pair while it moves straight on, its estimates with noise.
Story story_of(const std::vector<WatchedVessel>& start, double end_s, const DangerLimits& limits,
               double noise_mps = 0.0, std::uint64_t seed = 1) {
  test::Draw draw(seed);
  EncounterWatch watch(limits);
  Story story;
  for (double t = 0.0; t <= end_s; t += 3.0) {
    std::vector<WatchedVessel> now = later(start, t);
    for (WatchedVessel& one : now)
      for (const int axis : {1, 3}) one.kinematics.mean[axis] += noise_mps * draw.normal();
    for (const EncounterEvent& event : watch.update(t, now).events) {
      if (event.change == EncounterChange::kBegan) {
        ++story.began;
        story.begin_s = t;
      } else {
        ++story.ended;
        story.last_s = event.encounter.last_s;
        story.end_s = t;
      }
    }
  }
  return story;
}

TEST(EncounterWatch, AnEncounterIsOneFromFirstDangerToThePassing) {
  for (const double noise_mps : {0.0, 0.1, 0.3})
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const std::vector<WatchedVessel> pair{
          vessel(4, {0, 0}, {5, 0}, 10, std::max(noise_mps, 0.05)),
          vessel(7, {20000, 300}, {-5, 0}, 10, std::max(noise_mps, 0.05))};
      const Story story = story_of(pair, 3000, {}, noise_mps, seed);
      EXPECT_EQ(story.began, 1);
      EXPECT_EQ(story.ended, 1);
      EXPECT_NEAR(story.begin_s, 2000 - 1200, 150);  // TCPA within the limit
      EXPECT_NEAR(story.last_s, 2000, 15);
      EXPECT_NEAR(story.end_s, story.last_s + 63, 4);
    }
}

TEST(EncounterWatch, AnEncounterBeginsNotBeforeItsClosestPointIsWithinTheTimeLimit) {
  DangerLimits limits;
  EncounterWatch watch(limits);
  const std::vector<WatchedVessel> pair{vessel(1, {0, 0}, {5, 0}), vessel(2, {20000, 0}, {-5, 0})};
  for (double t = 0.0; t <= 900.0; t += 1.0)
    for (const EncounterEvent& event : watch.update(t, later(pair, t)).events)
      EXPECT_LE(event.encounter.approach.tcpa_s, limits.tcpa_limit_s);
  EXPECT_EQ(watch.encounters().size(), 1u);
}

TEST(EncounterWatch, NeverFlickers) {
  test::Draw draw(5);
  DangerLimits limits{.clear_hold_s = 30.0};
  EncounterWatch watch(limits);
  double ended_s = -1e9, begin_s = NAN;
  bool open = false;
  int begins = 0;
  for (double t = 0.0; t < 6000.0; t += 2.0) {  // a ship far off, badly known, about the limit
    const std::vector<WatchedVessel> pair{
        vessel(1, {0, 0}, {5, 0}),
        vessel(2, {6000, 900 + 500 * draw.normal()}, {-5, 0.5 * draw.normal()}, 50, 0.3)};
    for (const EncounterEvent& event : watch.update(t, pair).events) {
      if (event.change == EncounterChange::kBegan) {
        EXPECT_FALSE(open);
        EXPECT_GT(t, ended_s);
        EXPECT_GE(event.encounter.approach.probability, limits.alarm_probability);
        begin_s = t;
        ++begins;
      } else {
        EXPECT_TRUE(open);
        EXPECT_GE(t - event.encounter.over_s, limits.clear_hold_s);
        EXPECT_GE(t - begin_s, limits.clear_hold_s);
        ended_s = t;
      }
      open = event.change == EncounterChange::kBegan;
    }
    EXPECT_EQ(std::ssize(watch.encounters()), int(open));
  }
  EXPECT_GE(begins, 1);
  EXPECT_LE(begins, 6000.0 / limits.clear_hold_s);
}

TEST(EncounterWatch, VesselsAtRestAreSilentAmongThemselves) {
  test::Draw draw(6);
  EncounterWatch watch;
  for (double t = 0.0; t < 3600.0; t += 3.0) {  // a target at rest 1000 m off, the limit 926 m
    std::vector<WatchedVessel> moored{vessel(kOwnShip, {0, 0}, {0, 0}, 0, 0.2)};
    for (int k = 1; k <= 5; ++k)
      moored.push_back(vessel(k, {1000.0 - 190 * k + 5 * draw.normal(), 5 * draw.normal()},
                              {0.12 * draw.normal(), 0.12 * draw.normal()}, 5, 0.12));
    EXPECT_TRUE(watch.update(t, moored).events.empty());
  }
  EXPECT_TRUE(watch.encounters().empty());
}

TEST(EncounterWatch, AVesselBoundForAMooredOneIsADanger) {
  const std::vector<WatchedVessel> pair{vessel(1, {0, 0}, {0, 0}), vessel(2, {3000, 0}, {-4, 0})};
  const Story story = story_of(pair, 900, {});
  EXPECT_EQ(story.began, 1);
  EXPECT_EQ(story.ended, 1);
}

TEST(EncounterWatch, AnEncounterEndsWhenTheVesselIsBerthed) {
  EncounterWatch watch({.cpa_limit_m = 200});
  for (double t = 0.0; t <= 900.0; t += 3.0) {
    const double speed = std::max(0.0, 4.0 - 0.01 * t);  // stops 200 m on, at 400 s
    const double way = t < 400 ? 4.0 * t - 0.005 * t * t : 800.0;
    (void)watch.update(
        t, std::vector{vessel(1, {0, 0}, {0, 0}), vessel(2, {830 - way, 0}, {-speed, 0})});
    if (t == 300.0) {
      EXPECT_EQ(watch.encounters().size(), 1u);
    }
  }
  EXPECT_TRUE(watch.encounters().empty());
}

TEST(EncounterWatch, VesselsThatKeepTogetherAreSilent) {
  test::Draw draw(7);
  EncounterWatch watch;
  int begins = 0;
  for (double t = 0.0; t < 3600.0; t += 3.0) {  // a tow, and own ship's own echo
    std::vector<WatchedVessel> ships{
        vessel(kOwnShip, {5 * t, 0}, {5, 0}, 0, 0.2),
        vessel(1, {5 * t - 12, 3}, {5 + 0.2 * draw.normal(), 0.2 * draw.normal()}, 5, 0.2),
        vessel(2, {5 * t - 3000, 500}, {5 + 0.1 * draw.normal(), 0}, 5, 0.1),
        vessel(3, {5 * t - 3200, 500}, {5 + 0.1 * draw.normal(), 0}, 5, 0.1)};
    for (const EncounterEvent& event : watch.update(t, ships).events) {
      begins += event.change == EncounterChange::kBegan;
      EXPECT_NE(event.encounter.approach.first, kOwnShip);
    }
  }
  EXPECT_LE(begins, 3);  // velocities three deviations apart, once in a while
  for (const Encounter& one : watch.encounters()) EXPECT_GT(one.last_s, 3500.0);
}

TEST(EncounterWatch, AnEchoCloseToOwnShipIsItsOwnEvenInATurn) {
  EncounterWatch watch;
  for (double t = 0.0; t < 120.0; t += 3.0) {  // own ship turns, its track lags behind
    const double course = deg(2.0) * t, lag = deg(2.0) * (t - 9.0);
    const Vec2 own(1000 * std::sin(course), 1000 * (1 - std::cos(course)));
    (void)watch.update(
        t, std::vector{vessel(kOwnShip, own, 5 * Vec2(std::cos(course), std::sin(course)), 0, 0.1),
                       vessel(1, own + Vec2(12, 4), 5 * Vec2(std::cos(lag), std::sin(lag)))});
    EXPECT_TRUE(watch.encounters().empty()) << t;
  }
  const std::vector<WatchedVessel> abreast{vessel(1, {0, 0}, {5, 0.5}),
                                           vessel(2, {0, 20}, {5, -0.5})};
  EXPECT_EQ(story_of(abreast, 9, {}).began, 1);  // of two others it is a danger
}

TEST(EncounterWatch, ALostVesselEndsItsEncountersAfterTheHoldTime) {
  EncounterWatch watch({.clear_hold_s = 20});
  const std::vector<WatchedVessel> pair{vessel(1, {0, 0}, {5, 0}), vessel(2, {5000, 0}, {-5, 0})};
  (void)watch.update(0.0, pair);
  ASSERT_EQ(watch.encounters().size(), 1u);
  const std::span<const WatchedVessel> alone(pair.data(), 1);
  (void)watch.update(10.0, alone);
  (void)watch.update(29.0, alone);
  EXPECT_EQ(watch.encounters().size(), 1u);
  EXPECT_FALSE(watch.encounters()[0].dangerous());
  (void)watch.update(29.5, later(pair, 29.5));  // seen again
  EXPECT_TRUE(watch.encounters()[0].dangerous());
  (void)watch.update(40.0, alone);
  const EncounterReport report = watch.update(60.0, alone);
  ASSERT_EQ(report.events.size(), 1u);
  EXPECT_EQ(report.events[0].change, EncounterChange::kEnded);
  EXPECT_EQ(report.events[0].encounter.last_s, 29.5);
  EXPECT_EQ(report.events[0].encounter.id, 1);
}

TEST(EncounterWatch, LimitsAreThoseOfTheZoneOfTheClosestPoint) {
  const DangerZone harbor{"harbor",
                          {{2000, -500}, {4000, -500}, {4000, 500}, {2000, 500}},
                          {.cpa_limit_m = 50, .tcpa_limit_s = 120}};
  const std::vector<WatchedVessel> pairs{
      vessel(1, {0, 0}, {4, 0}),     vessel(2, {6000, 100}, {-4, 0}),     // 100 m in the harbor
      vessel(3, {2900, 20}, {4, 0}), vessel(4, {3300, 20}, {-4, 0}),      // head on in it
      vessel(5, {0, -9000}, {4, 0}), vessel(6, {6000, -8900}, {-4, 0})};  // 100 m outside
  EncounterWatch everywhere, by_zone({}, {harbor});
  (void)everywhere.update(0.0, pairs);
  (void)by_zone.update(0.0, pairs);
  std::map<Pair, int> zones;
  for (const Encounter& one : by_zone.encounters())
    zones[{one.approach.first, one.approach.second}] = one.approach.zone;
  EXPECT_EQ(zones.count({1, 2}), 0u);
  EXPECT_EQ(zones.at({3, 4}), 0);
  EXPECT_EQ(zones.at({5, 6}), -1);
  EXPECT_GT(everywhere.encounters().size(), by_zone.encounters().size());
}

TEST(EncounterWatch, IsAcknowledgedOnce) {
  EncounterWatch watch;
  const std::vector<WatchedVessel> pair{vessel(1, {0, 0}, {5, 0}), vessel(2, {5000, 0}, {-5, 0})};
  (void)watch.update(0.0, pair);
  EXPECT_FALSE(watch.acknowledge(2));
  EXPECT_TRUE(watch.acknowledge(1));
  (void)watch.update(3.0, later(pair, 3.0));
  EXPECT_TRUE(watch.encounters()[0].acknowledged);
  EXPECT_EQ(watch.encounters()[0].id, 1);
}

TEST(EncounterWatch, TakesNoMemory) {
  test::Draw draw(8);
  const std::vector<WatchedVessel> vessels = traffic(draw, 200, 2e4);
  EncounterWatch watch({}, {}, 200);
  const test::NoHeap fence;
  std::size_t events = 0;
  for (double t = 0.0; t < 100.0; t += 20.0) {
    const std::span<const WatchedVessel> some(vessels.data(), t > 50.0 ? 70u : 200u);
    events += watch.update(t, some).events.size();
  }
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_GT(events, 50u);
  static_assert(noexcept(watch.update(0.0, vessels)));
}

TEST(EncounterWatch, SaysWhatItHadNoRoomFor) {
  test::Draw draw(9);
  std::vector<WatchedVessel> vessels;
  for (int k = 0; k < 100; ++k) {  // all of them to one point
    const double bearing = draw.uniform(-4, 4);
    const Vec2 out(std::cos(bearing), std::sin(bearing));
    vessels.push_back(vessel(k + 1, 3000 * out, -5 * out));
  }
  vessels[3].kinematics.mean[0] = NAN;
  vessels[4].kinematics.covariance(1, 1) = HUGE_VAL;
  EncounterWatch roomy({}, {}, 1000), narrow({}, {}, 60);
  EXPECT_EQ(roomy.update(0.0, vessels).unwatched_vessels, 2);
  const EncounterReport report = narrow.update(0.0, vessels);
  EXPECT_EQ(report.unwatched_vessels, 40);
  EXPECT_EQ(std::ssize(narrow.encounters()), 60 * EncounterWatch::kPairsPerVessel);
  EXPECT_GT(report.left_out, 0);
}

TEST(EncounterWatch, RejectsATimeThatGoesBack) {
  EncounterWatch watch;
  EXPECT_EQ(watch.update(10.0, {}).status, Status::kOk);
  EXPECT_EQ(watch.update(9.0, {}).status, Status::kNegativeTimeStep);
  EXPECT_EQ(watch.update(NAN, {}).status, Status::kNotFinite);
  EXPECT_EQ(watch.update(10.0, {}).status, Status::kOk);
}

TEST(EncounterWatch, GoesOnFromItsSavedState) {
  test::Draw draw(10);
  const std::vector<WatchedVessel> vessels = traffic(draw, 80, 1e4);
  EncounterWatch saved, read, other({.cpa_limit_m = 500});
  (void)saved.update(0.0, vessels);
  ASSERT_FALSE(saved.encounters().empty());
  (void)saved.acknowledge(saved.encounters()[0].id);
  const std::vector<std::byte> bytes = saved.save();
  EXPECT_FALSE(other.restore(bytes));
  EXPECT_FALSE(read.restore(std::span(bytes).first(bytes.size() - 1)));
  ASSERT_TRUE(read.restore(bytes));
  EXPECT_EQ(read.save(), bytes);
  for (const double t : {30.0, 60.0, 90.0}) {
    (void)saved.update(t, later(vessels, t));
    (void)read.update(t, later(vessels, t));
  }
  EXPECT_EQ(read.save(), saved.save());
}

TEST(EncounterWatch, RejectsLimitsThatMakeNoSense) {
  EXPECT_THROW(EncounterWatch({.cpa_limit_m = -1}), std::invalid_argument);
  EXPECT_THROW(EncounterWatch({.alarm_probability = 0.2}), std::invalid_argument);
  EXPECT_THROW(EncounterWatch({}, {{"line", {{0, 0}, {1, 1}}, {}}}), std::invalid_argument);
  EXPECT_THROW(EncounterWatch({}, {{"hole", {{0, 0}, {1, NAN}, {1, 1}}, {}}}),
               std::invalid_argument);
  EXPECT_THROW(EncounterWatch({}, {}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::encounter_watch_test
