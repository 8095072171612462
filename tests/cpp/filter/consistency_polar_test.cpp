// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/consistency_laws.hpp"
#include "wakeline/measurement/bearing.hpp"

namespace wakeline::consistency_polar_test {
namespace {

using test::expect_consistent;
using test::lifted;

// 5 km at half a degree: 44 m across, curved by 0.2 m.
TEST(Consistency, PolarPlotsOfAFarVessel) {
  const RangeBearing radar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
  const ConstantVelocity motion{.noise = WhiteAcceleration{0.1}};
  expect_consistent(Ekf{motion}, radar, lifted<4>(motion), 400, 20, 2.5);
  expect_consistent(Ukf{motion}, radar, lifted<4>(motion), 400, 20, 2.5);
  expect_consistent(SquareRootUkf{motion}, radar, lifted<4>(motion), 400, 20, 2.5);
}

// Gentle turns: where the turn rate wanders by 2 degrees a second in a minute, an Ekf is
// over-confident by half.
TEST(Consistency, TurnRateInTheState) {
  const RangeBearing radar{.range_std_m = 15, .bearing_std_rad = deg(0.3)};
  const CoordinatedTurnRate motion{.noise = WhiteAcceleration{0.02},
                                   .turn_rate_psd_rad2s3 = 1e-6,
                                   .prior_turn_rate_std_rad_s = deg(0.5)};
  {
    SCOPED_TRACE("Ekf");
    expect_consistent(Ekf{motion}, radar, lifted<5>(motion), 400, 30, 2.5);
  }
  {
    SCOPED_TRACE("Ukf");
    expect_consistent(Ukf{motion}, radar, lifted<5>(motion), 400, 30, 2.5);
  }
  {
    SCOPED_TRACE("SquareRootUkf");
    expect_consistent(SquareRootUkf{motion}, radar, lifted<5>(motion), 400, 30, 2.5);
  }
}

TEST(Consistency, DopplerFromAMovingShip) {
  const RangeBearingDoppler radar{
      .range_std_m = 15,
      .bearing_std_rad = deg(0.5),
      .range_rate_std_mps = 0.3,
      .own = {.north_m = 100, .east_m = -200, .vnorth_mps = 8, .veast_mps = -3}};
  const ConstantVelocity motion{.noise = WhiteAcceleration{0.05}};
  expect_consistent(Ekf{motion}, radar, lifted<4>(motion), 400, 20, 2.5);
  expect_consistent(Ukf{motion}, radar, lifted<4>(motion), 400, 20, 2.5);
}

/// A belief whose mean is so far from the antenna, and so uncertain.
Gaussian<4> about_antenna(double north_m, double position_std_m) {
  Gaussian<4> start;
  start.mean[0] = north_m;
  start.covariance.diagonal() << position_std_m * position_std_m, 9.0,
      position_std_m * position_std_m, 9.0;
  return start;
}

// At the antenna the derivatives of range and bearing are none, beside it they are useless.
TEST(Consistency, EkfThatStartsAtTheAntenna) {
  const ConstantVelocity motion{.noise = WhiteAcceleration{0.01}};
  const RangeBearing radar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
  const RangeBearingDoppler doppler{
      .range_std_m = 15, .bearing_std_rad = deg(0.5), .range_rate_std_mps = 0.5};
  for (const double north_m : {0.0, 5e-4, 1.0, 3000.0, 6000.0, 9000.0}) {
    SCOPED_TRACE(north_m);
    expect_consistent(Ekf{motion}, radar, about_antenna(north_m, 3000.0), 200, 20, 2.5);
    expect_consistent(Ekf{motion}, doppler, about_antenna(north_m, 3000.0), 200, 20, 2.5);
  }
}

// Bearings from a fixed place leave the range as uncertain as it was, however many they are.
TEST(Consistency, BearingsAloneOfATargetWithoutARange) {
  const ConstantVelocity motion{.noise = WhiteAcceleration{0.001}};
  const Bearing finder{.bearing_std_rad = deg(0.5)};
  Gaussian<4> start = about_antenna(5000.0, 1300.0);
  start.covariance(2, 2) = 50.0 * 50.0;
  expect_consistent(Ekf{motion}, finder, start, 300, 60, 2.5);
  expect_consistent(Ukf{motion}, finder, start, 300, 60, 2.5);
}

// A plot at no range at all has no place to be linearised about either.
TEST(Consistency, EkfAtTheAntennaTakesAPlotThere) {
  Ekf filter{ConstantVelocity{}};
  const RangeBearing radar{};
  ASSERT_EQ(filter.start(about_antenna(0.0, 1000.0)), Status::kOk);
  for (int k = 0; k < 5; ++k) {
    ASSERT_EQ(filter.predict(3.0), Status::kOk);
    ASSERT_TRUE(filter.update(radar, Vec<double, 2>(0.0, 0.3)));
  }
  EXPECT_LT(filter.estimate().mean.norm(), 5 * radar.range_std_m);
  EXPECT_LT(filter.estimate().covariance(0, 0), 1e4);
}

}  // namespace
}  // namespace wakeline::consistency_polar_test
