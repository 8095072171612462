// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/motion/singer.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"

namespace wakeline::singer_test {
namespace {

using test::covariance_difference;
using test::matrices_near;

template <class Scalar>
class SingerOf : public ::testing::Test {
 protected:
  static constexpr double kEpsilon = std::numeric_limits<Scalar>::epsilon();
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(SingerOf, Scalars, );

TYPED_TEST(SingerOf, OfEndlessManeuversIsConstantAccelerationOfWhiteJerk) {
  using Scalar = TypeParam;
  const double tau = 1e9, std = 100.0;
  const Singer singer{.maneuver_time_s = tau, .accel_std_mps2 = std};
  const ConstantAcceleration constant{.noise = WhiteJerk{2 * std * std / tau}};
  for (const double step : {1e-3, 0.1, 2.5, 60.0}) {
    const Scalar dt = Scalar(step);
    EXPECT_TRUE(matrices_near(singer.matrix(dt), constant.matrix(dt),
                              {.absolute = 0, .relative = 1e-7 + 8 * this->kEpsilon}));
    EXPECT_LT(covariance_difference(singer.process_noise(dt), constant.process_noise(dt)),
              2e-7 + 32 * this->kEpsilon);
  }
}

TYPED_TEST(SingerOf, OfShortManeuversIsConstantVelocityOfWhiteAcceleration) {
  using Scalar = TypeParam;
  const double tau = 1e-4, std = 50.0, dt = 2.5;
  const auto q = Singer{.maneuver_time_s = tau, .accel_std_mps2 = std}.process_noise(Scalar(dt));
  const double psd = 2 * std * std * tau;
  EXPECT_NEAR(double(q(1, 1)) / (psd * dt), 1.0, 1e-4);
  EXPECT_NEAR(double(q(0, 1)) / (psd * dt * dt / 2), 1.0, 1e-4);
  EXPECT_NEAR(double(q(0, 0)) / (psd * dt * dt * dt / 3), 1.0, 1e-3);
  EXPECT_NEAR(double(q(2, 2)) / (std * std), 1.0, 1e-6) << "the stationary variance";
}

TYPED_TEST(SingerOf, AccelerationForgetsItselfInTau) {
  using Scalar = TypeParam;
  const Singer singer{.maneuver_time_s = 8.0, .accel_std_mps2 = 0.5};
  const auto f = singer.matrix(Scalar(8));
  EXPECT_NEAR(f(2, 2), std::exp(-1.0), 8 * this->kEpsilon);
  EXPECT_NEAR(f(1, 2), 8 * (1 - std::exp(-1.0)), 64 * this->kEpsilon);
  EXPECT_NEAR(f(0, 2), 64 * std::exp(-1.0), 512 * this->kEpsilon);  // tau² (u - 1 + e^-u), u = 1
  // The stationary acceleration stays stationary.
  for (const double dt : {0.1, 8.0, 100.0}) {
    const Scalar keeps = singer.matrix(Scalar(dt))(2, 2);
    EXPECT_NEAR(keeps * keeps * 0.25 + singer.process_noise(Scalar(dt))(2, 2), 0.25,
                8 * this->kEpsilon);
  }
}

TYPED_TEST(SingerOf, QuadratureAndClosedFormMeetAtTau) {
  using Scalar = TypeParam;
  const Singer singer{.maneuver_time_s = 8.0, .accel_std_mps2 = 0.5};
  const Scalar below = Scalar(8);
  const Scalar above = std::nextafter(below, Scalar(9));
  EXPECT_TRUE(matrices_near(singer.matrix(below), singer.matrix(above),
                            {.absolute = 0, .relative = 32 * this->kEpsilon}));
  EXPECT_LT(covariance_difference(singer.process_noise(below), singer.process_noise(above)),
            1e3 * this->kEpsilon);
}

TYPED_TEST(SingerOf, ExponentialRemainders) {
  using Scalar = TypeParam;
  for (const double u : {0.0, 1e-12, 1e-4, 0.3, 1.0, 1.0001, 3.0, 80.0}) {
    const long double v = u;
    const double first = u == 0 ? 1.0 : double(-std::expm1(-v) / v);
    EXPECT_NEAR(double(exponential_remainder<0>(Scalar(u))), std::exp(-u), 8 * this->kEpsilon) << u;
    EXPECT_NEAR(double(exponential_remainder<1>(Scalar(u))) / first, 1.0, 8 * this->kEpsilon) << u;
    if (u >= 0.3 || u == 0.0) {  // where the closed form does not cancel
      const double second = u == 0 ? 0.5 : double((v + std::expm1(-v)) / (v * v));
      EXPECT_NEAR(double(exponential_remainder<2>(Scalar(u))) / second, 1.0, 16 * this->kEpsilon)
          << u;
    }
  }
}

}  // namespace
}  // namespace wakeline::singer_test
