// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// South of the radar bearings jump from pi to -pi. No filter may notice: the scene turned by 180
// degrees must give the estimate turned by 180 degrees.
#include <gtest/gtest.h>

#include "filter/cases.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"

namespace wakeline::seam_test {
namespace {

template <class Filter, class Sensor>
void expect_the_same_all_round(const Sensor& sensor) {
  using Motion = typename Filter::Motion;
  constexpr int N = Filter::kStates;
  Vec<double, N> sign = -Vec<double, N>::Ones();  // what a turn by 180 degrees does to the state
  if constexpr (holds(Filter::kComponents, std::array{Component::kTurnRate}))
    sign[index_of(Filter::kComponents, Component::kTurnRate)] = 1.0;
  Filter north{Motion{}}, south{Motion{}};
  Gaussian<4> start;  // crosses the bearing 0 within the ten scans
  start.mean << 1000, 0, -60, 5;
  start.covariance = Vec<double, 4>(900, 9, 900, 9).asDiagonal();
  ASSERT_EQ(north.start(start), Status::kOk);
  start.mean = -start.mean;
  ASSERT_EQ(south.start(start), Status::kOk);
  test::Draw draw(51);
  bool west = false, east = false;
  for (int scan = 0; scan < 10; ++scan) {
    ASSERT_EQ(north.predict(2.5), Status::kOk);
    ASSERT_EQ(south.predict(2.5), Status::kOk);
    Vec<double, Sensor::kMeasurements> z = Vec<double, Sensor::kMeasurements>::Zero();
    z[0] = 1000 + 10 * draw.normal();
    z[1] = std::atan2(-60 + 12.5 * scan, 1000) + deg(2) * draw.normal();
    auto turned = z;
    turned[1] = wrap_angle(z[1] + kPi<double>);
    (turned[1] < 0 ? west : east) = true;
    const auto expected = north.update(sensor, z);
    const auto step = south.update(sensor, turned);
    ASSERT_TRUE(expected);
    ASSERT_TRUE(step);
    EXPECT_TRUE(test::matrices_near(step.innovation, expected.innovation,
                                    {.absolute = 1e-9, .relative = 1e-9}));
    EXPECT_TRUE(test::matrices_near(south.estimate().mean.cwiseProduct(sign), north.estimate().mean,
                                    {.absolute = 1e-8, .relative = 1e-9}));
    const Mat<double, N, N> back =
        sign.asDiagonal() * south.estimate().covariance * sign.asDiagonal();
    EXPECT_LT(test::covariance_difference(back, Mat<double, N, N>(north.estimate().covariance)),
              1e-9);
  }
  EXPECT_TRUE(west && east) << "the plots lie on both sides of the seam";
}

TEST(Seam, IsNowhere) {
  const RangeBearing radar{.range_std_m = 10, .bearing_std_rad = deg(2)};
  expect_the_same_all_round<Ekf<ConstantVelocity>>(radar);
  expect_the_same_all_round<Ukf<ConstantVelocity>>(radar);
  expect_the_same_all_round<SquareRootUkf<ConstantVelocity>>(radar);
  expect_the_same_all_round<Ukf<CoordinatedTurnRate>>(radar);
  expect_the_same_all_round<SquareRootUkf<CoordinatedTurnRate>>(radar);
}

// Where the belief is as wide as the range is long, sigma points are all round the radar.
TEST(Seam, WideBeliefNearTheRadarStaysFinite) {
  const RangeBearing radar{.range_std_m = 10, .bearing_std_rad = deg(1)};
  for (const double north : {0.0, -1e-9, -30.0}) {
    Gaussian<4> wide;
    wide.mean << north, 0, 0, 0;
    wide.covariance = Vec<double, 4>(1e4, 9, 1e4, 9).asDiagonal();
    const auto survives = [&](auto filter) {
      ASSERT_EQ(filter.start(wide), Status::kOk);
      for (int scan = 0; scan < 5; ++scan) {
        ASSERT_EQ(filter.predict(2.5), Status::kOk);
        (void)filter.update(radar, Vec<double, 2>(0.0, kPi<double>));  // a plot at the radar itself
        ASSERT_TRUE(is_finite(filter.estimate().mean)) << north;
        ASSERT_TRUE((test::is_covariance<double, 4>(filter.estimate().covariance))) << north;
      }
    };
    survives(Ekf{ConstantVelocity{}});
    survives(Ukf{ConstantVelocity{}});
    survives(SquareRootUkf{ConstantVelocity{}});
  }
}

}  // namespace
}  // namespace wakeline::seam_test
