// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>
#include <utility>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/navigation/search/detection.hpp"
#include "wakeline/navigation/search/intercept.hpp"
#include "wakeline/navigation/search/leeway_table.hpp"

namespace wakeline::search_test {
namespace {

using Vec2 = Vec<double, 2>;

constexpr std::array kLaws{DetectionLaw::kDefiniteRange, DetectionLaw::kInverseCube,
                           DetectionLaw::kExponential};

TEST(LeewayTable, NamesEachKindOnce) {
  std::set<std::string_view> kinds;
  for (const Leeway& entry : kLeewayTable) {
    EXPECT_TRUE(kinds.insert(entry.kind).second) << entry.kind;
    EXPECT_EQ(find_leeway(entry.kind), &entry);
    EXPECT_FALSE(entry.summary.empty());
  }
  EXPECT_EQ(find_leeway("submarine"), nullptr);
}

TEST(LeewayTable, HasItsStandardDeviationAtTenMetresASecond) {
  const Leeway& raft = *find_leeway("liferaft");  // 3.52 %, -2.50 cm/s, 6.10 cm/s
  EXPECT_NEAR(raft.downwind.speed_mps(10.0, 0.0), 0.352 - 0.025, 1e-12);
  EXPECT_NEAR(raft.downwind.speed_mps(10.0, 1.0) - raft.downwind.speed_mps(10.0, 0.0), 0.061,
              1e-12);
}

TEST(LeewayTable, GoesDownwindAndToItsSide) {
  for (const Leeway& entry : kLeewayTable) {
    for (const double wind : {8.0, 20.0}) {
      const Vec2 ahead(0.6, -0.8), starboard(0.8, 0.6);
      const Vec2 right = entry.velocity_mps(wind * ahead, Vec2::Zero(), true);
      const Vec2 left = entry.velocity_mps(wind * ahead, Vec2::Zero(), false);
      EXPECT_GE(right.dot(ahead), 0.0) << entry.kind;
      EXPECT_NEAR(right.dot(ahead), left.dot(ahead), 1e-12) << entry.kind;
      EXPECT_GE(right.dot(starboard), left.dot(starboard)) << entry.kind;
    }
    EXPECT_EQ(entry.velocity_mps(Vec2::Zero(), Vec2::Ones(), true).norm(), 0.0);
  }
}

TEST(LeewayTable, KeepsTheFactorsOfThePaper) {
  const Vec2 wind(3, -4);
  for (const auto& [kind, object] :
       {std::pair{"buoy", FloatingObject::kBuoy}, std::pair{"dinghy", FloatingObject::kDinghy},
        std::pair{"launch", FloatingObject::kLaunch}, std::pair{"ship", FloatingObject::kShip}}) {
    const LeewayFactor k = leeway_factor(object);
    const Leeway& entry = *find_leeway(kind);
    EXPECT_TRUE(entry.velocity_mps(wind, Vec2::Zero(), true)
                    .isApprox(wind_drift_mps(wind, k.middle()), 1e-12));
    EXPECT_NEAR(entry.downwind.std_slope, k.std(), 1e-12);
  }
}

TEST(WindCurrentFactor, FallsFromTheSlowToTheFastWind) {
  EXPECT_NEAR(wind_current_factor(2.0), 0.04, 1e-12);
  EXPECT_NEAR(wind_current_factor(20.0), 0.012, 1e-12);
  EXPECT_EQ(wind_current_factor(0.0), wind_current_factor(2.0));
  EXPECT_EQ(wind_current_factor(40.0), wind_current_factor(20.0));
  for (double wind = 2.0; wind < 20.0; wind += 0.5) {
    EXPECT_GT(wind_current_factor(wind), wind_current_factor(wind + 0.5));
    EXPECT_LT(wind_current_factor(wind) * wind, wind_current_factor(wind + 0.5) * (wind + 0.5));
  }
}

TEST(Detection, IntegratesToTheSweepWidth) {
  const double width = 800.0, step = 1.0;
  for (const DetectionLaw law : kLaws) {
    double sum = 0.0;
    for (double x = 0.5; x < 4e5; x += step) sum += 2 * step * pass_probability(law, x, width);
    EXPECT_NEAR(sum, width, 2.0);
    EXPECT_EQ(pass_probability(law, 0.0, width), 1.0);
  }
}

TEST(Detection, OfALongLegIsThatOfThePass) {
  for (const DetectionLaw law : {DetectionLaw::kInverseCube, DetectionLaw::kExponential})
    for (const double x : {50.0, 400.0, 3000.0})
      EXPECT_NEAR(leg_potential(law, Vec2(x, -1e8), Vec2(x, 1e8), 700.0),
                  pass_potential(law, x, 700.0), 1e-9);
}

TEST(Detection, AddsUpOverThePartsOfALeg) {
  const Vec2 from(300, -2000), to(-500, 2500);
  for (const DetectionLaw law : {DetectionLaw::kInverseCube, DetectionLaw::kExponential}) {
    double sum = 0.0;
    for (int k = 0; k < 7; ++k)
      sum += leg_potential(law, from + k / 7.0 * (to - from), from + (k + 1) / 7.0 * (to - from),
                           900.0);
    EXPECT_NEAR(sum, leg_potential(law, from, to, 900.0), 1e-12);
  }
}

TEST(Detection, IsTheIntegralOfTheInverseCubeRate) {
  const double width = 600.0;
  const Vec2 from(250, -900), to(100, 1500);
  double sum = 0.0;
  const int steps = 200000;
  for (int k = 0; k < steps; ++k) {
    const Vec2 place = from + (k + 0.5) / steps * (to - from);
    sum += std::pow(place.norm(), -3.0);
  }
  const double rate = width * width / (8 * std::numbers::pi);
  EXPECT_NEAR(leg_potential(DetectionLaw::kInverseCube, from, to, width),
              rate * sum * (to - from).norm() / steps, 1e-6);
}

TEST(Detection, WithinTheDefiniteRangeIsCertain) {
  const auto potential = [](const Vec2& from, const Vec2& to) {
    return leg_potential(DetectionLaw::kDefiniteRange, from, to, 1000.0);
  };
  EXPECT_TRUE(std::isinf(potential(Vec2(499, -3000), Vec2(499, 3000))));
  EXPECT_EQ(potential(Vec2(501, -3000), Vec2(501, 3000)), 0.0);
  EXPECT_EQ(potential(Vec2(0, 501), Vec2(0, 3000)), 0.0);  // the pass, but not the leg, hits
  EXPECT_TRUE(std::isinf(potential(Vec2(0, 499), Vec2(0, 3000))));
}

TEST(Detection, OfParallelTracksIsTheMeanOverTheArea) {
  const double spacing = 1000.0;
  for (const DetectionLaw law : kLaws)
    for (const double coverage : {0.3, 0.8, 1.5}) {
      double found = 0.0;
      const int points = 2000;
      for (int k = 0; k < points; ++k) {
        const double place = (k + 0.5) / points * spacing;
        double potential = 0.0;
        for (int track = -400; track <= 400; ++track)
          potential += pass_potential(law, place - track * spacing, coverage * spacing);
        found += -std::expm1(-potential) / points;
      }
      if (law == DetectionLaw::kDefiniteRange) found = std::min(found, 1.0);
      EXPECT_NEAR(parallel_track_pod(law, coverage), found, 2e-3);
      EXPECT_GE(parallel_track_pod(law, coverage), random_search_pod(coverage));
      EXPECT_LE(parallel_track_pod(law, coverage), std::min(1.0, coverage) + 1e-9);
    }
}

Gaussian<4> object(double north, double vnorth, double east, double veast) {
  Gaussian<4> state{Vec<double, 4>(north, vnorth, east, veast), Mat<double, 4, 4>::Zero()};
  state.covariance.diagonal() << 400.0, 0.04, 900.0, 0.09;
  return state;
}

TEST(Intercept, MeetsTheObject) {
  const auto target = object(5000, -2, 3000, 4);
  const Vec2 unit(-1000, 500);
  const Intercept met = Intercept::of(target, unit, 9.0);
  ASSERT_TRUE(met.found);
  const Vec2 way = 9.0 * met.time_s * Vec2(std::cos(met.course_rad), std::sin(met.course_rad));
  EXPECT_TRUE((unit + way).isApprox(met.position_m.mean, 1e-9));
  EXPECT_NEAR(met.position_m.covariance(0, 0), 400 + 0.04 * met.time_s * met.time_s, 1e-6);
}

TEST(Intercept, OfTheSameSpeedNeedsAnApproachingObject) {
  EXPECT_TRUE(Intercept::of(object(1000, -3, 0, 4), Vec2::Zero(), 5.0).found);
  EXPECT_FALSE(Intercept::of(object(1000, 3, 0, 4), Vec2::Zero(), 5.0).found);
}

TEST(Intercept, IsNotFoundWhereTheObjectOutruns) {
  EXPECT_FALSE(Intercept::of(object(1000, 8, 0, 0), Vec2::Zero(), 5.0).found);
  EXPECT_TRUE(Intercept::of(object(1000, -8, 0, 0), Vec2::Zero(), 5.0).found);
  EXPECT_FALSE(Intercept::of(object(NAN, 0, 0, 0), Vec2::Zero(), 5.0).found);
}

TEST(Intercept, HasTheErrorsOfRandomObjects) {
  const auto target = object(8000, -1, 3000, 2);
  const Vec2 unit(0, 0);
  const Intercept met = Intercept::of(target, unit, 10.0);
  test::Draw draw(1);
  double time2 = 0.0, course2 = 0.0;
  const int runs = 20000;
  for (int k = 0; k < runs; ++k) {
    Gaussian<4> other = target;
    other.mean = draw.of(target);
    const Intercept one = Intercept::of(other, unit, 10.0);
    time2 += std::pow(one.time_s - met.time_s, 2) / runs;
    course2 += std::pow(one.course_rad - met.course_rad, 2) / runs;
  }
  EXPECT_NEAR(met.time_std_s, std::sqrt(time2), 0.05 * met.time_std_s);
  EXPECT_NEAR(met.course_std_rad, std::sqrt(course2), 0.05 * met.course_std_rad);
}

TEST(Search, DoesNotUseTheHeap) {
  const test::NoHeap fence;
  double sum = 0.0;
  for (const DetectionLaw law : kLaws)
    sum += leg_potential(law, Vec2(700, -100), Vec2(800, 50), 500) + parallel_track_pod(law, 0.8);
  sum += Intercept::of(object(1000, 1, 2000, 1), Vec2::Zero(), 5.0).time_s;
  sum += find_leeway("skiff")->velocity_mps(Vec2(5, 5), Vec2::Ones(), true).norm();
  EXPECT_GT(sum, 0.0);
  EXPECT_EQ(fence.allocations(), 0);
}

}  // namespace
}  // namespace wakeline::search_test
