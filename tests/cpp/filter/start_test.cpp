// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/filter/start.hpp"

#include <gtest/gtest.h>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/core/chi_square.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"
#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/motion/coordinated_turn.hpp"

namespace wakeline::start_test {
namespace {

using test::Draw;
using test::matrices_identical;
using test::matrices_near;

TEST(TwoPoint, ErrorsAreThoseItClaims) {
  // Far enough for a wide ellipse, precise enough for the conversion to be linear.
  const RangeBearing radar{.range_std_m = 20, .bearing_std_rad = deg(0.5)};
  const double dt = 2.5;
  const Vec<double, 4> truth(3000, -8, -4000, 6);
  Draw draw(21);
  constexpr int kRuns = 20'000;
  double nees = 0.0;
  Mat<double, 4, 4> scatter = Mat<double, 4, 4>::Zero(), claimed = Mat<double, 4, 4>::Zero();
  for (int run = 0; run < kRuns; ++run) {
    const auto plot = [&](double age) {
      const Vec<double, 2> position(truth[0] - age * truth[1], truth[2] - age * truth[3]);
      return Vec<double, 2>(radar.measure(position) +
                            draw.error(radar.observe(radar.measure(position)).covariance));
    };
    const Vec<double, 2> first = plot(dt);
    const Vec<double, 2> second = plot(0.0);
    const Gaussian<4> belief = two_point(radar, first, second, dt);
    const Vec<double, 4> error = belief.mean - truth;
    const Cholesky<4> cholesky(belief.covariance);
    ASSERT_TRUE(cholesky.ok());
    nees += cholesky.whiten<1>(error).squaredNorm() / kRuns;
    scatter += error * error.transpose() / kRuns;
    claimed += belief.covariance / kRuns;
  }
  EXPECT_NEAR(nees, 4.0, 5 * std::sqrt(8.0 / kRuns));
  // Each element of the scatter, correlations included, within five of its standard errors.
  EXPECT_LT(test::covariance_difference(scatter, claimed), 5 * std::sqrt(2.0 / kRuns));
}

TEST(Starts, TakeNumbersOfAnyKindForSpeedsAndSteps) {
  const RangeBearing radar;
  const Vec<double, 2> z(3000, 0.3);
  EXPECT_EQ(one_point(radar, z, 5).covariance(1, 1), 25.0);
  EXPECT_EQ(one_point(radar, z.cast<float>().eval(), 5.0).covariance(1, 1), 25.0F);
  const Gaussian<2> fix = radar.position(z);
  EXPECT_TRUE(
      matrices_identical(two_point(fix, fix, 3).covariance, two_point(radar, z, z, 3).covariance));
}

// A plot is right on average for one target when it is too far out by r sb²/2, and a target about
// one plot is too near by as much. A start between both has its range right.
TEST(Starts, AreAtTheRangeAsRead) {
  const OwnShip own{.north_m = 500, .east_m = -300};
  const double bearing_rad = 0.3, range_m = 30e3;
  const Vec<double, 2> z(range_m, bearing_rad);
  const auto expect_as_read = [&](const auto& sensor, const auto& reading) {
    const Gaussian<4> belief = one_point(sensor, reading, 10.0);
    EXPECT_TRUE(matrices_near(Vec<double, 2>(belief.mean[0], belief.mean[2]),
                              (own.position<double>() + range_m * towards(bearing_rad)).eval(),
                              {.absolute = 1e-6}));
    EXPECT_EQ(belief.covariance(0, 0), sensor.position(reading).covariance(0, 0));
  };
  expect_as_read(RangeBearing{.bearing_std_rad = deg(3), .own = own}, z);
  expect_as_read(ConvertedRangeBearing{.bearing_std_rad = deg(3), .own = own}, z);
  expect_as_read(ConvertedRangeBearing{.bearing_std_rad = deg(3), .unbiased = false, .own = own},
                 z);
  expect_as_read(RangeBearingDoppler{.bearing_std_rad = deg(3), .own = own},
                 Vec<double, 3>(range_m, bearing_rad, 0.0));
}

TEST(TwoPoint, IsTheFormulaOfTwoFixes) {
  Draw draw(22);
  const Gaussian<2> first{draw.normals<2>(), draw.definite<2>()},
      second{draw.normals<2>(), draw.definite<2>()};
  const double dt = 3.0;
  const Gaussian<4> belief = two_point(first, second, dt);
  const Vec<double, 2> velocity = (second.mean - first.mean) / dt;
  EXPECT_TRUE(matrices_near(
      belief.mean, Vec<double, 4>(second.mean[0], velocity[0], second.mean[1], velocity[1])));
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double r1 = first.covariance(i, j), r2 = second.covariance(i, j);
      EXPECT_NEAR(belief.covariance(2 * i, 2 * j), r2, 1e-12);
      EXPECT_NEAR(belief.covariance(2 * i, 2 * j + 1), r2 / dt, 1e-12);
      EXPECT_NEAR(belief.covariance(2 * i + 1, 2 * j + 1), (r1 + r2) / (dt * dt), 1e-12);
    }
  EXPECT_TRUE(test::is_covariance(belief.covariance));
}

TEST(TwoPoint, OwnShipWasElsewhereAtTheFirstPlot) {
  const Vec<double, 4> truth(3000, -8, -4000, 6);
  const double dt = 2.5;
  RangeBearing radar{.own = {.north_m = 200, .east_m = 100, .vnorth_mps = 9, .veast_mps = -4}};
  const Vec<double, 2> second = radar.measure(Vec<double, 2>(truth[0], truth[2]));
  RangeBearing earlier = radar;
  earlier.own.north_m -= dt * radar.own.vnorth_mps;
  earlier.own.east_m -= dt * radar.own.veast_mps;
  const Vec<double, 2> first =
      earlier.measure(Vec<double, 2>(truth[0] - dt * truth[1], truth[2] - dt * truth[3]));
  const Gaussian<4> belief = two_point(radar, first, second, dt);
  const Gaussian<4> wanted =
      two_point(earlier.start_position(first), radar.start_position(second), dt);
  EXPECT_TRUE(matrices_near(belief.mean, wanted.mean, {.absolute = 1e-9}));
  EXPECT_TRUE(matrices_near(belief.covariance, wanted.covariance));
  EXPECT_NEAR(belief.mean[1], truth[1], 0.5);
  EXPECT_NEAR(belief.mean[3], truth[3], 0.5);
}

TEST(TwoPoint, OfTwoPlotsAtOneTimeIsRejectedByTheStart) {
  const RangeBearing radar;
  Ekf ekf{CoordinatedTurn{}};
  for (const double separation : {0.0, 10.0})
    EXPECT_EQ(ekf.start(two_point(radar, Vec<double, 2>(1000, 1),
                                  Vec<double, 2>(1000 + separation, 1), 0.0)),
              Status::kNotFinite);
  EXPECT_FALSE(ekf.started());
}

// An unscented filter keeps the factor of its covariance for the next step.
TEST(Assign, OfTheSameBeliefChangesNoBit) {
  const RangeBearing radar{.range_std_m = 20, .bearing_std_rad = deg(0.5)};
  const auto expect_same = [&](auto filter) {
    Gaussian<4> begin;
    begin.mean << 3000, -8, 4000, 6;
    begin.covariance.diagonal() << 400, 9, 400, 9;
    ASSERT_EQ(filter.start(begin), Status::kOk);
    auto assigned = filter;
    Draw draw(24);
    for (int scan = 0; scan < 20; ++scan) {
      ASSERT_EQ(filter.predict(2.5), Status::kOk);
      (void)assigned.assign(Gaussian(assigned.estimate()));
      ASSERT_EQ(assigned.predict(2.5), Status::kOk);
      const Vec<double, 2> z(5000 + 20 * draw.normal(), 0.93 + 0.01 * draw.normal());
      ASSERT_TRUE(filter.update(radar, z));
      (void)assigned.assign(Gaussian(assigned.estimate()));
      ASSERT_TRUE(assigned.update(radar, z));
      EXPECT_TRUE(matrices_identical(assigned.estimate().mean, filter.estimate().mean));
      EXPECT_TRUE(matrices_identical(assigned.estimate().covariance, filter.estimate().covariance));
    }
    // What replaces the belief replaces the factor, too.
    ASSERT_EQ(filter.start(begin), Status::kOk);
    ASSERT_EQ(assigned.start(begin), Status::kOk);
    EXPECT_EQ(filter.update(radar, Vec<double, 2>(5000, 0.93)).nis,
              assigned.compare(radar, radar.observe(Vec<double, 2>(5000, 0.93))).nis);
    EXPECT_FALSE(matrices_identical(assigned.estimate().covariance, filter.estimate().covariance));
  };
  expect_same(Ukf<CoordinatedTurnRate>(CoordinatedTurnRate{}));
  expect_same(Ekf<CoordinatedTurnRate>(CoordinatedTurnRate{}));
}

TEST(OnePoint, IsThePlotAtRest) {
  const RangeBearing radar{.range_std_m = 20, .bearing_std_rad = deg(1), .own = {.north_m = 100}};
  const Vec<double, 2> z(1000, 0.5);
  const Gaussian<4> belief = one_point(radar, z, 7.0);
  const Gaussian<2> fix = radar.start_position(z);
  EXPECT_TRUE(matrices_near(belief.mean, Vec<double, 4>(fix.mean[0], 0, fix.mean[1], 0), {0, 0}));
  EXPECT_EQ(belief.covariance(0, 2), fix.covariance(0, 1));
  EXPECT_EQ(belief.covariance(1, 1), 49.0);
  EXPECT_EQ(belief.covariance(0, 1), 0.0);
  EXPECT_TRUE(test::is_covariance(belief.covariance));
}

TEST(Lift, GivesTheUnknownComponentsTheModelsPrior) {
  const Gaussian<4> kinematics{Draw(23).normals<4>(), Draw(23).definite<4>()};
  const CoordinatedTurnRate turning{.prior_turn_rate_std_rad_s = 0.2};
  const Gaussian<5> five = lift(turning, kinematics);
  EXPECT_TRUE(matrices_near(five.mean.head<4>(), kinematics.mean, {0, 0}));
  EXPECT_TRUE(matrices_near(five.covariance.topLeftCorner<4, 4>(), kinematics.covariance, {0, 0}));
  EXPECT_EQ(five.mean[4], 0.0);
  EXPECT_DOUBLE_EQ(five.covariance(4, 4), 0.04);
  EXPECT_TRUE((five.covariance.row(4).head<4>().array() == 0.0).all());

  const Gaussian<6> six = lift(ConstantAcceleration{.prior_accel_std_mps2 = 3}, kinematics);
  const int rows[] = {0, 1, 3, 4};  // x, vx, y, vy of [x, vx, ax, y, vy, ay]
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(six.mean[rows[i]], kinematics.mean[i]);
    for (int j = 0; j < 4; ++j)
      EXPECT_EQ(six.covariance(rows[i], rows[j]), kinematics.covariance(i, j));
  }
  EXPECT_EQ(six.covariance(2, 2), 9.0);
  EXPECT_EQ(six.covariance(5, 5), 9.0);
  EXPECT_TRUE(test::is_covariance(six.covariance));
}

TEST(Lift, HappensInAStartWithFourComponents) {
  const Gaussian<4> kinematics{Draw(24).normals<4>(), Draw(24).definite<4>()};
  Ekf ekf{CoordinatedTurnRate{}};
  ASSERT_EQ(ekf.start(kinematics), Status::kOk);
  EXPECT_TRUE(matrices_near(ekf.estimate().covariance,
                            lift(CoordinatedTurnRate{}, kinematics).covariance, {0, 0}));
}

}  // namespace
}  // namespace wakeline::start_test
