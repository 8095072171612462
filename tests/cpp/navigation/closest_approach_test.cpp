// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/closest_approach.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/core/angle.hpp"

namespace wakeline::closest_approach_test {
namespace {

using Vec2 = Vec<double, 2>;
using Vec4 = Vec<double, 4>;
using Mat4 = Mat<double, 4, 4>;

constexpr double kMile_m = 1852.0;

Vec4 state(const Vec2& position, const Vec2& velocity) {
  return {position[0], velocity[0], position[1], velocity[1]};
}

Vec2 polar(double length, double angle_rad) {
  return length * Vec2(std::cos(angle_rad), std::sin(angle_rad));
}

/// Independent errors of position and velocity per axis.
Mat4 errors(double position_std, double velocity_std) {
  const double p = position_std * position_std, v = velocity_std * velocity_std;
  return Vec4(p, v, p, v).asDiagonal();
}

/// Least distance between now and a horizon.
double least_distance(const Vec4& relative, double horizon_s) {
  const Vec2 p(relative[0], relative[2]), v(relative[1], relative[3]);
  if (v.isZero(0.0)) return p.norm();
  const double t = std::clamp(-p.dot(v) / v.squaredNorm(), 0.0, horizon_s);
  return (p + v * t).norm();
}

Gaussian<4> random_ship(test::Draw& draw) {
  const Vec4 scale(2000, 8, 2000, 8);
  Mat4 covariance = draw.definite<4>();
  covariance =
      Vec4(30, 0.3, 30, 0.3).asDiagonal() * covariance * Vec4(30, 0.3, 30, 0.3).asDiagonal();
  return {scale.cwiseProduct(draw.normals<4>()), covariance};
}

void expect_same(const ClosestApproach& a, const ClosestApproach& b) {
  EXPECT_NEAR(a.signed_cpa_m(), b.signed_cpa_m(), 1e-7);
  EXPECT_NEAR(a.tcpa_s(), b.tcpa_s(), 1e-7 * (1 + std::abs(a.tcpa_s())));
  EXPECT_LT(test::covariance_difference(a.covariance(), b.covariance()), 1e-9);
  EXPECT_NEAR(a.probability(500, 1200), b.probability(500, 1200), 1e-9);
}

// The four scenarios of IMO A.823(19): course and speed of own ship, range and bearing of the
// target, its relative course and speed, and what follows from them.
struct Scenario {
  double own_speed_kn, range_nm, bearing_deg, relative_course_deg, relative_speed_kn, cpa_nm,
      tcpa_min;
};
constexpr Scenario kA823[] = {{10, 8, 0, 180, 20, 0, 24},
                              {10, 1, 0, 90, 10, 1, 0},
                              {5, 8, 45, 225, 20, 0, 24},
                              {25, 8, 45, 225, 20, 0, 24}};

TEST(ClosestApproach, OfTheScenariosOfA823) {
  for (const Scenario& s : kA823) {
    const Vec2 own_velocity(knots(s.own_speed_kn), 0);
    const Vec2 relative = polar(knots(s.relative_speed_kn), deg(s.relative_course_deg));
    const Vec2 place = polar(s.range_nm * kMile_m, deg(s.bearing_deg));
    const auto approach =
        closest_approach(state(Vec2::Zero(), own_velocity), state(place, own_velocity + relative));
    EXPECT_NEAR(approach.cpa_m() / kMile_m, s.cpa_nm, 1e-9);
    EXPECT_NEAR(approach.tcpa_s() / 60, s.tcpa_min, 1e-9);
    EXPECT_EQ(approach.cpa_std_m(), 0.0);
    EXPECT_EQ(approach.probability(1.01 * kMile_m), 1.0);
  }
}

TEST(ClosestApproach, IsTheLeastDistanceOfAll) {
  test::Draw draw(1);
  for (int k = 0; k < 200; ++k) {
    const Vec4 own = random_ship(draw).mean, target = random_ship(draw).mean;
    const auto approach = closest_approach(own, target);
    const auto distance = [&](double t) {
      const Vec4 r = target - own;
      return std::hypot(r[0] + r[1] * t, r[2] + r[3] * t);
    };
    const double t = approach.tcpa_s();
    EXPECT_NEAR(distance(t), approach.cpa_m(), 1e-6);
    EXPECT_GE(distance(t + 1), approach.cpa_m());
    EXPECT_GE(distance(t - 1), approach.cpa_m());
  }
}

TEST(ClosestApproach, ComesNearerByTheClockAndIsThenPast) {
  const Vec4 own = state({0, 0}, {5, 0}), target = state({6000, 300}, {-5, 0});
  for (double t = 0; t <= 1200; t += 100) {
    const Vec4 later = state({6000 - 5 * t, 300}, {-5, 0});
    const Vec4 own_later = state({5 * t, 0}, {5, 0});
    const auto approach = closest_approach(own_later, later);
    EXPECT_NEAR(approach.tcpa_s(), closest_approach(own, target).tcpa_s() - t, 1e-9);
    EXPECT_NEAR(approach.cpa_m(), 300, 1e-9);
    EXPECT_EQ(approach.probability(400), approach.tcpa_s() >= 0 ? 1.0 : 0.0) << t;
  }
}

TEST(ClosestApproach, HasASignForTheSideOfThePassing) {
  const Vec4 own = state({0, 0}, {5, 0});
  const auto to_port = closest_approach(own, state({6000, -300}, {-5, 0}));
  const auto to_starboard = closest_approach(own, state({6000, 300}, {-5, 0}));
  EXPECT_NEAR(to_port.signed_cpa_m(), 300, 1e-9);
  EXPECT_NEAR(to_starboard.signed_cpa_m(), -300, 1e-9);
}

TEST(ClosestApproach, IsTheSameFromBothShips) {
  test::Draw draw(2);
  for (int k = 0; k < 100; ++k) {
    const Gaussian<4> a = random_ship(draw), b = random_ship(draw);
    expect_same(closest_approach(a, b), closest_approach(b, a));
  }
}

TEST(ClosestApproach, DoesNotDependOnTheFrame) {
  test::Draw draw(3);
  for (int k = 0; k < 100; ++k) {
    const Gaussian<4> own = random_ship(draw), target = random_ship(draw);
    const double c = std::cos(0.1 * k), s = std::sin(0.1 * k);
    Mat4 turn;
    turn << c, 0, -s, 0, 0, c, 0, -s, s, 0, c, 0, 0, s, 0, c;
    const Vec4 shift = state({-5e4, 2e4}, {3, -7});  // a place and a current
    const auto moved = [&](const Gaussian<4>& ship) {
      return Gaussian<4>{turn * ship.mean + shift, turn * ship.covariance * turn.transpose()};
    };
    expect_same(closest_approach(own, target), closest_approach(moved(own), moved(target)));
  }
}

TEST(ClosestApproach, HasTheErrorsOfItsDerivatives) {
  test::Draw draw(4);
  for (int k = 0; k < 50; ++k) {
    const Gaussian<4> relative = random_ship(draw);
    Mat<double, 2, 4> jacobian;
    for (int i = 0; i < 4; ++i) {
      const double h = i % 2 ? 1e-5 : 1e-2;
      Gaussian<4> up = relative, down = relative;
      up.mean[i] += h;
      down.mean[i] -= h;
      const ClosestApproach a(up), b(down);
      jacobian.col(i) =
          Vec2(a.signed_cpa_m() - b.signed_cpa_m(), a.tcpa_s() - b.tcpa_s()) / (2 * h);
    }
    const Mat<double, 2, 2> expected = jacobian * relative.covariance * jacobian.transpose();
    const ClosestApproach approach(relative);
    EXPECT_LT(test::covariance_difference(approach.covariance(), expected), 1e-4);
    EXPECT_NEAR(approach.cpa_std_m(), std::sqrt(approach.covariance()(0, 0)), 1e-12);
    EXPECT_NEAR(approach.tcpa_std_s(), std::sqrt(approach.covariance()(1, 1)), 1e-12);
  }
}

TEST(ClosestApproach, OfShipsAtRelativeRestIsTheRangeNow) {
  const Vec4 own = state({0, 0}, {4, 3}), target = state({300, -400}, {4, 3});
  const auto known = closest_approach(own, target);
  EXPECT_TRUE(known.at_rest());
  EXPECT_EQ(known.cpa_m(), 500.0);
  EXPECT_EQ(known.tcpa_s(), 0.0);
  EXPECT_EQ(known.probability(501), 1.0);
  EXPECT_EQ(known.probability(499), 0.0);
  const auto unsure =
      closest_approach(Gaussian<4>{own, errors(0, 0)}, Gaussian<4>{target, errors(30, 0)});
  EXPECT_NEAR(unsure.cpa_std_m(), 30, 1e-9);
  EXPECT_NEAR(unsure.probability(500), 0.5, 0.02);
  EXPECT_LT(unsure.probability(500), 0.5);  // a disc curves away
  const auto together = closest_approach(own, own);
  EXPECT_EQ(together.cpa_m(), 0.0);
  EXPECT_EQ(together.probability(1), 1.0);
}

TEST(ClosestApproach, HasNoErrorWhereOnlyTheWayAlongIsUncertain) {
  test::Draw draw(9);
  for (int k = 0; k < 300; ++k) {
    const Vec2 ahead = polar(1.0, draw.uniform(-4, 4));
    const Vec2 position = polar(draw.uniform(100, 3000), draw.uniform(-4, 4));
    const Vec4 error = state(30.0 * ahead, 0.5 * ahead);
    const Vec4 mean = state(position, draw.uniform(2, 10) * ahead);
    const ClosestApproach moving({mean, error * error.transpose()});
    EXPECT_NEAR(moving.cpa_std_m(), 0.0, 1e-3);
    EXPECT_GT(moving.tcpa_std_s(), 0.0);
    const double p = moving.probability(500, 600);
    const int draws = 2000;
    int near = 0;
    for (int i = 0; i < draws; ++i) near += least_distance(mean + draw.normal() * error, 600) < 500;
    EXPECT_NEAR(p, near / double(draws), 0.1) << k;
    const Vec4 aside = state(30.0 * Vec2(-position[1], position[0]) / position.norm(), {0, 0});
    const ClosestApproach resting({state(position, {0, 0}), aside * aside.transpose()});
    EXPECT_NEAR(resting.cpa_std_m(), 0.0, 1e-3);
    EXPECT_EQ(resting.probability(position.norm() / 2), 0.0);
  }
}

// Probability -------------------------------------------------------------------------------------

/// How far it is from the share of many draws that come closer than the limit.
double probability_error(const Gaussian<4>& relative, double limit_m, double horizon_s,
                         int draws = 40000) {  // standard deviation at most 0.0025
  test::Draw draw(5);
  const Mat4 root = semidefinite_root<4, double>(relative.covariance);
  int near = 0;
  for (int k = 0; k < draws; ++k)
    near += least_distance(relative.mean + root * draw.normals<4>(), horizon_s) < limit_m;
  return std::abs(ClosestApproach(relative).probability(limit_m, horizon_s) - near / double(draws));
}

Gaussian<4> passing(double miss_m, double after_s, double position_std, double velocity_std) {
  const Vec2 v = polar(10.0, deg(200));
  const Vec2 n = polar(1.0, deg(290));
  return {state(miss_m * n - after_s * v, v), errors(position_std, velocity_std)};
}

/// The worst error over misses and times, the closest point now, past and beyond the horizon too.
double worst_error(double velocity_std) {
  double worst = 0.0;
  for (const double miss : {0.0, 500.0, 926.0, 1500.0, 3000.0})
    for (const double after : {-300.0, 0.0, 200.0, 600.0, 1200.0, 1500.0})
      worst =
          std::fmax(worst, probability_error(passing(miss, after, 30, velocity_std), 926, 1200));
  return worst;
}

TEST(ProbabilityOfPassing, IsThatOfManyDrawsHoweverTheVelocityErrs) {  // of 10 m/s
  for (const double std : {0.0, 0.1, 0.5, 2.0, 10.0, 50.0})
    EXPECT_LT(worst_error(std), 0.012) << std;
}

/// A target of any range, motion and errors, often bound for own ship, sometimes at rest.
Gaussian<4> any_target(test::Draw& draw, double limit_m) {
  const auto of_any_size = [&](double low, double high) {
    return std::exp(draw.uniform(std::log(low), std::log(high)));
  };
  const double range = limit_m * of_any_size(0.1, 20), sight = draw.uniform(-4, 4);
  const double speed = draw.uniform(0, 4) < 1 ? 0.0 : of_any_size(0.05, 20);
  const double course =
      draw.uniform(0, 2) < 1
          ? draw.uniform(-4, 4)
          : sight + kPi<double> + draw.uniform(-1, 1) * std::min(1.5, 2 * limit_m / range);
  const double position_std = of_any_size(1, 1000), velocity_std = of_any_size(0.01, 5);
  const Vec4 std(position_std, velocity_std, position_std, velocity_std);
  return {state(polar(range, sight), polar(speed, course)),
          std.asDiagonal() * draw.definite<4>() * std.asDiagonal()};
}

TEST(ProbabilityOfPassing, IsThatOfManyDrawsForTargetsOfAnyKind) {
  test::Draw draw(12);
  constexpr int kTargets = 150;
  double sum2 = 0.0;
  for (int k = 0; k < kTargets; ++k) {
    const double limit_m = draw.uniform(100, 2000);
    Gaussian<4> relative = any_target(draw, limit_m);
    for (const int row : {0, 1, 2, 3})  // of some the place, of others the velocity is known
      if ((k % 5 == 1 && row % 2 == 0) || (k % 5 == 2 && row % 2 == 1)) {
        relative.covariance.row(row).setZero();
        relative.covariance.col(row).setZero();
      }
    const double horizon_s = k % 2 ? ClosestApproach::kForever_s : draw.uniform(30, 5000);
    const double error = probability_error(relative, limit_m, horizon_s, 20000);
    EXPECT_LT(error, 0.025) << k;
    sum2 += error * error;
  }
  EXPECT_LT(std::sqrt(sum2 / kTargets), 0.006);
}

TEST(ProbabilityOfPassing, AtTheLimitIsThatOfManyDrawsHoweverManyDirectionsAreSummed) {
  test::Draw draw(16);
  constexpr int kTargets = 40;
  for (const double sigmas : {7.0, 14.0, 40.0}) {  // of the velocity
    double sum2 = 0.0;
    for (int k = 0; k < kTargets; ++k) {
      const double limit_m = draw.uniform(100, 2000), position_std = draw.uniform(2, 60);
      const double velocity_std = draw.uniform(0.05, 0.4), sight = draw.uniform(-4, 4);
      const double range_m = limit_m + draw.uniform(-4, 4) * position_std;
      Gaussian<4> relative{
          state(polar(range_m, sight), polar(sigmas * velocity_std, draw.uniform(-4, 4))),
          errors(position_std, velocity_std)};
      for (const int axis : {0, 2})  // of a track
        relative.covariance(axis, axis + 1) = relative.covariance(axis + 1, axis) =
            0.5 * position_std * velocity_std;
      const double error = probability_error(relative, limit_m, draw.uniform(5, 1200));
      EXPECT_LT(error, 0.03) << sigmas << " " << k;
      sum2 += error * error;
    }
    EXPECT_LT(std::sqrt(sum2 / kTargets), 0.006) << sigmas;
  }
}

// Of a target at rest, seen at the same velocity in all directions, those come in that head for the
// disc: arcsin(L / R) / pi of all, and by a horizon H those of them that are fast enough.
TEST(ProbabilityOfPassing, IsTheShareOfHeadingsForATargetAtRest) {
  for (const double range : {506.0, 520.0, 600.0, 1000.0, 3000.0})
    for (const double std_mps : {0.01, 1.0}) {
      const ClosestApproach resting({state(polar(range, 0.7), {0, 0}), errors(0.0, std_mps)});
      EXPECT_NEAR(resting.probability(500), std::asin(500 / range) / kPi<double>, 0.01) << range;
      const double fast = std::exp(-0.5 * std::pow((range - 500) / (100 * std_mps), 2));
      EXPECT_LT(resting.probability(500, 100), 0.01 + fast * std::asin(500 / range) / kPi<double>)
          << range;
    }
}

TEST(ProbabilityOfPassing, OfErrorsThatAreAllOneIsRight) {
  test::Draw draw(13);
  double sum2 = 0.0;
  for (int k = 0; k < 60; ++k) {
    Gaussian<4> relative = any_target(draw, 500);
    const Vec4 error = relative.covariance.diagonal().cwiseSqrt().cwiseProduct(draw.normals<4>());
    relative.covariance = error * error.transpose();
    const double off = probability_error(relative, 500, 1200, 10000);
    EXPECT_LT(off, 0.1) << k;
    sum2 += off * off;
  }
  EXPECT_LT(std::sqrt(sum2 / 60), 0.02);
}

TEST(ProbabilityOfPassing, IsOneForEveryLimitAndHorizon) {
  test::Draw draw(14);
  for (int k = 0; k < 200; ++k) {
    const ClosestApproach approach(any_target(draw, 500));
    for (const double limit : {0.0, 1e-300, 1e-9, 1.0, 1e9, 1e200, HUGE_VAL})
      for (const double horizon : {0.0, 1e-300, 1.0, 1e9, 1e300, HUGE_VAL}) {
        const double p = approach.probability(limit, horizon);
        EXPECT_TRUE(p >= 0.0 && p <= 1.0) << limit << " " << horizon << " " << p;
        EXPECT_TRUE(limit > 1e-9 || p < 1e-6) << p;
        EXPECT_TRUE(limit < 1e9 || p > 1 - 1e-6) << p;
      }
    EXPECT_NEAR(approach.probability(500), approach.probability(500, 1e12), 0.015);
  }
}

TEST(ProbabilityOfPassing, IsThatOfManyDrawsForTargetsThatComeAndGo) {
  test::Draw draw(11);
  for (int k = 0; k < 60; ++k) {
    const double limit_m = draw.uniform(100, 1000), speed = draw.uniform(1, 10);
    const double sight = draw.uniform(-4, 4), across = draw.uniform(-1, 1);
    const double course = k % 3 == 0 ? sight : sight + deg(180) + 0.5 * across;
    const Gaussian<4> relative{
        state(polar(limit_m * draw.uniform(0, 4), sight), polar(speed, course)),
        errors(draw.uniform(5, 50), 0.1 * speed)};
    EXPECT_LT(probability_error(relative, limit_m, draw.uniform(60, 1200)), 0.04) << k;
  }
  const Gaussian<4> going{state({600, 0}, {10, 0}), errors(10, 1)};  // never comes back
  EXPECT_LT(ClosestApproach(going).probability(570), 0.002);
}

TEST(ProbabilityOfPassing, IsThatOfADiscForATargetThatIsNearNow) {
  const auto at_rest = [](double std) {
    return ClosestApproach({Vec4::Zero(), errors(std, 0.0)}).probability(100.0);
  };
  for (const double std : {20.0, 60.0, 100.0, 400.0})  // Rayleigh's distribution
    EXPECT_NEAR(at_rest(std), 1.0 - std::exp(-0.5 * 1e4 / (std * std)), 1e-3) << std;

  test::Draw draw(8);
  for (int k = 0; k < 20; ++k) {
    Gaussian<4> near{state(polar(draw.uniform(0, 150), draw.uniform(-4, 4)),
                           polar(draw.uniform(1, 8), draw.uniform(-4, 4))),
                     errors(0.0, 0.05)};
    const Vec2 along = polar(draw.uniform(5, 150), draw.uniform(-4, 4));
    const Vec4 longer = state(along, {0, 0}),
               shorter = state({-along[1] / 4, along[0] / 4}, {0, 0});
    near.covariance += longer * longer.transpose() + shorter * shorter.transpose();
    EXPECT_LT(probability_error(near, 100, 60), 0.02) << k;
  }
}

TEST(ProbabilityOfPassing, GrowsWithTheLimitAndTheHorizon) {
  test::Draw draw(6);
  for (int k = 0; k < 100; ++k) {
    const auto approach = closest_approach(random_ship(draw), random_ship(draw));
    double before = 0.0;
    for (double limit = 0; limit < 2e4; limit += 500) {
      const double p = approach.probability(limit, 900);
      EXPECT_GE(p, before - 1e-3);  // of the slices
      EXPECT_LE(p, 1.0 + 1e-12);
      before = p;
    }
    EXPECT_EQ(approach.probability(0), 0.0);
  }
  const ClosestApproach coming(passing(0, 600, 30, 0.1));
  EXPECT_LT(coming.probability(926, 300), 0.01);
  EXPECT_GT(coming.probability(926, 900), 0.99);
  EXPECT_NEAR(coming.probability(926), coming.probability(926, 1e6), 1e-9);
}

TEST(ClosestApproach, OfNanIsNan) {
  const Vec4 own = state({0, 0}, {5, 0});
  for (int k = 0; k < 4; ++k) {
    Vec4 target = state({1000, 200}, {-5, 1});
    target[k] = NAN;
    const auto approach = closest_approach(own, target);
    EXPECT_TRUE(std::isnan(approach.cpa_m()));
    EXPECT_TRUE(std::isnan(approach.tcpa_s()));
    EXPECT_TRUE(std::isnan(approach.probability(500, 1200)));
  }
  // Of ships at relative rest, too, of which the place or the velocity is not finite.
  for (const double wrong : {double(NAN), HUGE_VAL})
    for (int k = 0; k < 4; ++k) {
      Vec4 together = state({1000, 200}, {5, 0});
      together[k] = wrong;
      const auto approach = closest_approach(own, together);
      EXPECT_TRUE(std::isnan(approach.cpa_m())) << k;
      EXPECT_TRUE(std::isnan(approach.tcpa_s())) << k;
      EXPECT_TRUE(std::isnan(approach.cpa_std_m())) << k;
      EXPECT_TRUE(std::isnan(approach.tcpa_std_s())) << k;
      EXPECT_TRUE(std::isnan(approach.probability(500, 1200))) << k;
    }
  const ClosestApproach near({state({400, 0}, {-1, 0}), errors(50, 0.1)});
  ASSERT_GT(near.probability(500, 600), 0.5);
  EXPECT_TRUE(std::isnan(near.probability(NAN, 600)));
  EXPECT_TRUE(std::isnan(near.probability(500, NAN)));
}

TEST(ClosestApproach, IsFoundWithoutTheHeap) {
  test::Draw draw(7);
  const Gaussian<4> own = random_ship(draw), target = random_ship(draw);
  static_assert(noexcept(closest_approach(own, target)));
  const test::NoHeap fence;
  const auto approach = closest_approach(own, target);
  const double p = approach.probability(926, 1200);
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_GE(p, 0.0);
}

}  // namespace
}  // namespace wakeline::closest_approach_test
