// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "support/numeric_jacobian.hpp"
#include "wakeline/measurement/bearing.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"

namespace wakeline::jacobians_test {
namespace {

using test::Draw;
using test::matrices_near;
using test::numeric_jacobian;

const OwnShip kOwn{.north_m = -400, .east_m = 250, .vnorth_mps = 6, .veast_mps = -3};

/// J of `sensor` is its numeric derivative at `x`.
template <class Sensor, int N>
testing::AssertionResult derivative_agrees(const Sensor& sensor, const Vec<double, N>& x,
                                           test::Tolerance tolerance) {
  return matrices_near(
      sensor.jacobian(x),
      numeric_jacobian([&](const Vec<double, N>& state) { return sensor.measure(state); }, x,
                       [&](const auto& a, const auto& b) { return sensor.residual(a, b); }),
      tolerance);
}

TEST(RangeBearing, JacobianIsTheDerivativeAllRound) {
  const RangeBearing radar{.bearing_offset_rad = 0.1, .own = kOwn};
  for (const double range : {5.0, 300.0, 40e3})
    for (int k = 0; k < 24; ++k) {
      const Vec<double, 2> x = kOwn.position<double>() + range * towards(deg(15.0 * k));
      EXPECT_TRUE(derivative_agrees(radar, x, {.absolute = 1e-7, .relative = 1e-6}))
          << range << ", " << k;
    }
}

TEST(RangeBearingDoppler, JacobianIsTheDerivativeAllRound) {
  const RangeBearingDoppler radar{.own = kOwn};
  for (const double range : {5.0, 300.0, 40e3})
    for (int k = 0; k < 24; ++k) {
      const Vec<double, 2> p = kOwn.position<double>() + range * towards(deg(15.0 * k));
      const Vec<double, 4> x(p[0], 8.0, p[1], -5.0);
      EXPECT_TRUE(derivative_agrees(radar, x, {.absolute = 1e-6, .relative = 1e-6}))
          << range << ", " << k;
    }
}

TEST(PartsOfPosition, AreThoseOfRangeAndBearingAllRound) {
  const RangeBearing radar{.range_std_m = 7,
                           .bearing_std_rad = 0.01,
                           .extent_std_m = 4,
                           .bearing_offset_rad = 0.1,
                           .own = kOwn};
  const Bearing bearing{
      .bearing_std_rad = 0.01, .extent_std_m = 4, .bearing_offset_rad = 0.1, .own = kOwn};
  const Range range{.range_std_m = 7, .extent_std_m = 4, .own = kOwn};
  for (const double range_m : {5.0, 300.0, 40e3})
    for (int k = 0; k < 24; ++k) {
      const Vec<double, 2> x = kOwn.position<double>() + range_m * towards(deg(15.0 * k));
      EXPECT_TRUE(derivative_agrees(bearing, x, {.absolute = 1e-7, .relative = 1e-6}));
      EXPECT_TRUE(derivative_agrees(range, x, {.absolute = 1e-7, .relative = 1e-6}));
      const Vec<double, 2> z = radar.measure(x);
      EXPECT_EQ(range.measure(x)[0], z[0]);
      EXPECT_EQ(bearing.measure(x)[0], z[1]);
      const Mat<double, 2, 2> r = radar.observe(z).covariance;
      EXPECT_NEAR(range.observe(Vec<double, 1>(z[0])).covariance(0, 0), r(0, 0), 1e-9);
      const auto seen = bearing.at_prediction(bearing.observe(Vec<double, 1>(z[1])),
                                              Gaussian<2>{x, Mat<double, 2, 2>::Identity()});
      EXPECT_NEAR(seen.covariance(0, 0), r(1, 1), 1e-9 * r(1, 1)) << "at the predicted range";
    }
}

TEST(LinearSensors, JacobianIsTheDerivative) {
  const Vec<double, 2> x(300, -200);
  EXPECT_TRUE(derivative_agrees(Position{}, x, {.absolute = 1e-9, .relative = 0}));
  EXPECT_TRUE(derivative_agrees(ConvertedRangeBearing{}, x, {.absolute = 1e-9, .relative = 0}));
}

TEST(RangeBearing, MeasuresFromOwnShipWithItsOffset) {
  const RangeBearing radar{.bearing_offset_rad = deg(2.0), .own = kOwn};
  const Vec<double, 2> target = kOwn.position<double>() + Vec<double, 2>(0, 1000);  // due east
  EXPECT_TRUE(matrices_near(radar.measure(target), Vec<double, 2>(1000, deg(92.0))))
      << "the radar reads 2 degrees too much";
  EXPECT_TRUE(matrices_near(radar.position(Vec<double, 2>(1000, deg(92.0))).mean, target,
                            {.absolute = 0.2, .relative = 0}))
      << "and the plot is put right again";
}

TEST(RangeBearingDoppler, RangeRateIsRelativeToOwnShip) {
  const RangeBearingDoppler radar{.own = kOwn};
  const Vec<double, 2> p = kOwn.position<double>() + Vec<double, 2>(500, 0);  // due north
  EXPECT_NEAR((radar.measure(Vec<double, 4>(p[0], 6, p[1], -3))[2]), 0.0, 1e-12) << "in company";
  EXPECT_NEAR((radar.measure(Vec<double, 4>(p[0], 10, p[1], 99))[2]), 4.0, 1e-12) << "opening";
  EXPECT_NEAR((radar.measure(Vec<double, 4>(p[0], -10, p[1], 99))[2]), -16.0, 1e-12) << "closing";
}

TEST(RangeBearingDoppler, IsARangeBearingWithARangeRate) {
  const OwnShip own{
      .north_m = 5, .position_std_m = 3, .velocity_std_mps = 0.3, .heading_std_rad = 0.02};
  const RangeBearing plain{.range_std_m = 7,
                           .bearing_std_rad = 0.01,
                           .extent_std_m = 4,
                           .bearing_offset_rad = 0.1,
                           .own = own};
  const RangeBearingDoppler radar{.range_std_m = 7,
                                  .bearing_std_rad = 0.01,
                                  .range_rate_std_mps = 0.4,
                                  .extent_std_m = 4,
                                  .bearing_offset_rad = 0.1,
                                  .own = own};
  const Vec<double, 3> z(900, 1.2, -4);
  EXPECT_TRUE(matrices_near(radar.observe(z).covariance.topLeftCorner<2, 2>(),
                            plain.observe(Vec<double, 2>(900, 1.2)).covariance, {0, 0}));
  EXPECT_NEAR(radar.observe(z).covariance(2, 2), 0.4 * 0.4 + 0.3 * 0.3, 1e-12);
  EXPECT_TRUE(matrices_near(radar.measure(Vec<double, 4>(100, 1, 200, 2)).head<2>(),
                            plain.measure(Vec<double, 2>(100, 200)), {0, 0}));
  EXPECT_TRUE(
      matrices_near(radar.position(z).mean, plain.position(Vec<double, 2>(900, 1.2)).mean, {0, 0}));
}

template <class Sensor>
void expect_wrapped_residuals(const Sensor& sensor) {
  using Z = Vec<double, Sensor::kMeasurements>;
  for (int a = -12; a <= 12; ++a)
    for (int b = -12; b <= 12; ++b) {
      Z first = Z::Zero(), second = Z::Zero();
      first[0] = 30;
      second[0] = 10;
      first[1] = 0.5 * a;
      second[1] = 0.5 * b;
      const Z residual = sensor.residual(first, second);
      EXPECT_EQ(residual[0], 20);
      EXPECT_LE(std::abs(residual[1]), kPi<double> + 1e-12);
      EXPECT_NEAR(std::sin(residual[1]), std::sin(first[1] - second[1]), 1e-12);
      EXPECT_NEAR(std::cos(residual[1]), std::cos(first[1] - second[1]), 1e-12);
    }
  Z west_of_south = Z::Zero(), east_of_south = Z::Zero();
  west_of_south[1] = deg(-179);
  east_of_south[1] = deg(179);
  EXPECT_NEAR(sensor.residual(west_of_south, east_of_south)[1], deg(2), 1e-12);
}

TEST(Residuals, OfBearingsWrap) {
  expect_wrapped_residuals(RangeBearing{});
  expect_wrapped_residuals(RangeBearingDoppler{});
}

template <class Scalar>
class AtTheRadar : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(AtTheRadar, Scalars, );

TYPED_TEST(AtTheRadar, EverythingIsFinite) {
  using Scalar = TypeParam;
  const OwnShip own{.north_m = 100, .east_m = 100, .position_std_m = 2};
  const RangeBearing radar{.extent_std_m = 5, .own = own};
  const RangeBearingDoppler doppler{.extent_std_m = 5, .own = own};
  for (const double distance : {0.0, 1e-30, 1e-5, 1e-3, 1.0}) {
    const Vec<Scalar, 2> x(Scalar(100), Scalar(100 + distance));
    const Vec<Scalar, 4> moving(x[0], Scalar(5), x[1], Scalar(-5));
    EXPECT_TRUE(is_finite(radar.measure(x)) && is_finite(radar.jacobian(x))) << distance;
    EXPECT_TRUE(is_finite(doppler.measure(moving)) && is_finite(doppler.jacobian(moving)))
        << distance;

    const Vec<Scalar, 2> z(Scalar(distance), Scalar(1));
    Vec<Scalar, 3> zd(Scalar(distance), Scalar(1), Scalar(3));
    EXPECT_TRUE(test::is_covariance(radar.observe(z).covariance)) << distance;
    EXPECT_TRUE(test::is_covariance(doppler.observe(zd).covariance)) << distance;
    EXPECT_TRUE(test::is_covariance(radar.position(z).covariance)) << distance;
    EXPECT_TRUE(test::is_covariance(doppler.position(zd).covariance)) << distance;
  }
}

}  // namespace
}  // namespace wakeline::jacobians_test
