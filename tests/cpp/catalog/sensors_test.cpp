// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/catalog/sensors.hpp"

#include <gtest/gtest.h>

#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"

namespace wakeline::sensors_test {
namespace {

using test::matrices_identical;

/// A filter after one reading.
template <class Sensor>
Gaussian<4> updated(const Sensor& sensor, const Vec<double, Sensor::kMeasurements>& z) {
  Ekf<ConstantVelocity> filter{ConstantVelocity{}};
  Gaussian<4> start;
  start.mean << 4000.0, 3.0, 3000.0, -2.0;
  start.covariance = Vec<double, 4>(1e4, 25.0, 1e4, 25.0).asDiagonal();
  EXPECT_EQ(filter.start(start), Status::kOk);
  EXPECT_EQ(filter.update(sensor, z).status, Status::kOk);
  return filter.estimate();
}

TEST(AnySensorOf, UpdatesAsItsSensorDoes) {
  const OwnShip own{.north_m = 30.0, .east_m = -20.0, .vnorth_mps = 1.0, .veast_mps = 2.0};
  const auto expect_alike = [](const auto& sensor, const auto& z) {
    constexpr int kM = std::decay_t<decltype(sensor)>::kMeasurements;
    const Gaussian<4> typed = updated(sensor, z), any = updated(AnySensorOf<kM>(sensor), z);
    EXPECT_TRUE(matrices_identical(typed.mean, any.mean));
    EXPECT_TRUE(matrices_identical(typed.covariance, any.covariance));
  };
  const Vec<double, 2> plot(5010.0, 0.64);
  expect_alike(RangeBearing{.own = own}, plot);
  expect_alike(ConvertedRangeBearing{.own = own}, plot);
  expect_alike(Position{}, Vec<double, 2>(4010.0, 2990.0));
  expect_alike(RangeBearingDoppler{.own = own}, Vec<double, 3>(5010.0, 0.64, 1.5));
}

TEST(AnySensorOf, IsCarriedByOwnShip) {
  AnySensorOf<2> polar{RangeBearing{}};
  ASSERT_NE(own_ship_of(polar), nullptr);
  own_ship_of(polar)->north_m = 100.0;
  EXPECT_EQ(std::get<RangeBearing>(polar.variant()).own.north_m, 100.0);
  const AnySensorOf<2> position{Position{}};
  EXPECT_EQ(own_ship_of(position), nullptr);
}

}  // namespace
}  // namespace wakeline::sensors_test
