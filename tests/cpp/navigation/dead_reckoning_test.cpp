// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/dead_reckoning.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/draw.hpp"

namespace wakeline::dead_reckoning_test {
namespace {

using test::Draw;
using Vec2 = Vec<double, 2>;

constexpr double kMile_m = 1852.0;

TEST(DeadReckoning, OfAVectorIsASumOfSteps) {
  Draw draw(1);
  for (int k = 0; k < 100; ++k) {
    const Vec2 p = draw.normals<2>(), v = draw.normals<2>(), a = draw.normals<2>();
    const double s = draw.uniform(0, 10), t = draw.uniform(0, 10);
    EXPECT_LT((predict_position_m<double>(predict_position_m<double>(p, v, s), v, t) -
               predict_position_m<double>(p, v, s + t))
                  .norm(),
              1e-12);
    const Vec2 halfway = predict_position_m<double>(p, v, a, s);
    EXPECT_LT((predict_position_m<double>(halfway, v + a * s, a, t) -
               predict_position_m<double>(p, v, a, s + t))
                  .norm(),
              1e-11);
  }
}

TEST(DeadReckoning, OfACourseIsASumOfStepsThroughNorth) {
  const double rate = deg(1.0), growth = deg(0.1);
  const double first = predict_course_rad(deg(355), rate, 4.0, growth);
  const double later = predict_turn_rate_rad_s(rate, growth, 4.0);
  EXPECT_NEAR(predict_course_rad(first, later, 6.0, growth),
              predict_course_rad(deg(355), rate, 10.0, growth), 1e-12);
  EXPECT_NEAR(predict_course_rad(deg(355), rate, 10.0, growth), deg(10), 1e-12);
  EXPECT_NEAR(predict_course_rad(deg(359), rate, 2.0), deg(1), 1e-12);
  EXPECT_NEAR(predict_course_rad(deg(1), -rate, 2.0), deg(359), 1e-12);
}

TEST(DeadReckoning, OfALongitudeGoesThroughTheDateLine) {
  EXPECT_NEAR(predict_longitude_rad(deg(179.9), deg(0.1), 3.0), deg(-179.8), 1e-12);
  EXPECT_NEAR(predict_latitude_rad(deg(46), deg(0.1), 3.0), deg(46.3), 1e-12);
  EXPECT_DOUBLE_EQ(predict_speed_mps(5.0, -0.1, 10.0), 4.0);
}

TEST(DeadReckoning, AddsVectorsNotSpeeds) {
  const SpeedCourse ship{5.0, 0.0}, current{5.0, deg(120)};
  const SpeedCourse ground =
      SpeedCourse::of(over_ground<double>(ship.velocity_mps(), current.velocity_mps()));
  EXPECT_NEAR(ground.speed_mps, 5.0, 1e-12);
  EXPECT_NEAR(ground.course_rad, deg(60), 1e-12);
  const TotalDrift drift{{1, 0}, {0, 2}, {0.5, 0.5}};
  EXPECT_EQ(drift.velocity_mps(), Vec2(1.5, 2.5));
}

TEST(CombinedDeadReckoning, IsTheRhumbLineWithinADecimetre) {
  Draw draw(2);
  for (int k = 0; k < 2000; ++k) {
    const GeoPoint from{deg(draw.uniform(-70, 70)), draw.uniform(-3.2, 3.2)};
    const SpeedCourse ship{draw.uniform(0, 10), draw.uniform(0, 6.28)};
    const SpeedCourse drift{draw.uniform(0, 1), draw.uniform(0, 6.28)};
    const SpeedCourse ground = SpeedCourse::of(ship.velocity_mps() + drift.velocity_mps());
    const double dt = 20e3 / ground.speed_mps;
    const GeoPoint mid = dead_reckon(from, ship, drift, dt);
    const GeoPoint rhumb = rhumb_destination(from, ground.course_rad, 20e3);
    EXPECT_LT(geodesic(mid, rhumb).distance_m, 0.1);
  }
}

TEST(CombinedDeadReckoning, GoesAMinuteAMile) {
  const GeoPoint north = dead_reckon({deg(46.5), 0}, {knots(12), 0.0}, {0, 0}, 3600.0);
  EXPECT_NEAR(north.latitude_rad, deg(46.5 + 12.0 / 60), deg(0.01 / 60));
  const GeoPoint east =
      dead_reckon({deg(60), deg(179.9)}, {knots(10), deg(90)}, {knots(2), deg(90)}, 3600.0);
  EXPECT_NEAR(wrap_angle(east.longitude_rad - deg(179.9)), deg(24.0 / 60), deg(0.15 / 60));
  EXPECT_LT(east.longitude_rad, 0.0);
}

TEST(VelocityOverWindow, IsThatOfARhumbLine) {
  for (const double course : {deg(5), deg(89.999), deg(180), deg(271)}) {
    const GeoPoint from{deg(46.5), deg(179.99)};
    std::array<TimedPlace, 5> window;
    for (std::size_t k = 0; k < window.size(); ++k) {
      const double t = 30.0 * double(k * k);  // uneven
      window[k] = {1e9 + t, rhumb_destination(from, course, 6.0 * t)};
    }
    const SpeedCourse ground = SpeedCourse::of(velocity_over_window_mps(window));
    EXPECT_NEAR(ground.speed_mps, 6.0, 1e-6);
    EXPECT_NEAR(ground.course_rad, course, 1e-6);
  }
}

TEST(VelocityOverWindow, NeedsTwoTimes) {
  const std::array<TimedPlace, 2> same{{{5.0, {0.8, 0.1}}, {5.0, {0.8, 0.1}}}};
  EXPECT_TRUE(std::isnan(velocity_over_window_mps(same)[0]));
  EXPECT_TRUE(std::isnan(velocity_over_window_mps({})[0]));
}

TEST(VelocityFromRates, UndoesDeadReckoning) {
  const SpeedCourse ship{6.0, deg(250)};
  const GeoPoint from{deg(-55), 1.0};
  const double dt = 1.0;
  const GeoPoint to = dead_reckon(from, ship, {0, 0}, dt);
  const Vec2 back = velocity_from_rates_mps((to.latitude_rad - from.latitude_rad) / dt,
                                            (to.longitude_rad - from.longitude_rad) / dt,
                                            (from.latitude_rad + to.latitude_rad) / 2);
  EXPECT_LT((back - ship.velocity_mps()).norm(), 1e-6);
  EXPECT_NEAR(velocity_from_rates_mps(deg(1.0 / 60) / 3600, 0, deg(45))[0], kMile_m / 3600, 1e-3);
}

}  // namespace
}  // namespace wakeline::dead_reckoning_test
