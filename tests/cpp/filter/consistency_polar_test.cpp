// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/consistency_laws.hpp"

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

}  // namespace
}  // namespace wakeline::consistency_polar_test
