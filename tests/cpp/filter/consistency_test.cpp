// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/consistency_laws.hpp"

namespace wakeline::consistency_test {
namespace {

using test::expect_consistent;
using test::lifted;

TEST(Consistency, LinearMotionAndSensor) {
  const Position sensor{.position_std_m = 20};
  const ConstantVelocity straight{.noise = WhiteAcceleration{0.1}};
  const CoordinatedTurn turning{.turn_rate_rad_s = 0.05, .noise = PiecewiseAcceleration{0.1}};
  expect_consistent(Kalman{straight}, sensor, lifted<4>(straight), 400, 20, 2.5);
  expect_consistent(Ekf{turning}, sensor, lifted<4>(turning), 400, 20, 2.5);
  const ConstantAcceleration accelerating{.noise = WhiteJerk{1e-3}, .prior_accel_std_mps2 = 0.3};
  expect_consistent(Ukf{accelerating}, sensor, lifted<6>(accelerating), 400, 20, 2.5);
  const Singer singer{.maneuver_time_s = 15, .accel_std_mps2 = 0.3};
  expect_consistent(SquareRootUkf{singer}, sensor, lifted<6>(singer), 400, 20, 2.5);
}

}  // namespace
}  // namespace wakeline::consistency_test
