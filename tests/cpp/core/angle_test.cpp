// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/core/angle.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace wakeline::angle_test {
namespace {

template <class Scalar>
class Angle : public ::testing::Test {
 protected:
  static constexpr Scalar kEpsilon = std::numeric_limits<Scalar>::epsilon();
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Angle, Scalars, );

TYPED_TEST(Angle, WrappedIsTheSameAngleWithinHalfATurn) {
  using Scalar = TypeParam;
  for (int k = -400; k <= 400; ++k) {
    const Scalar angle = Scalar(k) * Scalar(0.0773);
    const Scalar wrapped = wrap_angle(angle);
    const Scalar rounding = 64 * this->kEpsilon;
    EXPECT_LE(std::abs(wrapped), kPi<Scalar>) << angle;
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), rounding) << angle;
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), rounding) << angle;
  }
}

// From an angle just within half a turn a whole turn was taken, and more than half was left.
TYPED_TEST(Angle, NextToHalfATurnIsWithinIt) {
  using Scalar = TypeParam;
  for (const Scalar half : {kPi<Scalar>, 3 * kPi<Scalar>}) {
    for (const Scalar angle :
         {std::nextafter(half, Scalar(0)), half, std::nextafter(half, 9 * half)}) {
      EXPECT_LE(std::abs(wrap_angle(angle)), kPi<Scalar>);
      EXPECT_LE(std::abs(wrap_angle(-angle)), kPi<Scalar>);
    }
  }
}

TYPED_TEST(Angle, WrappingLeavesAnAngleWithinHalfATurnAlone) {
  for (const double angle : {-3.14, -1.0, -1e-9, 0.0, 1e-9, 1.0, 3.14})
    EXPECT_EQ(wrap_angle(TypeParam(angle)), TypeParam(angle));
}

TYPED_TEST(Angle, CompassAngleIsTheSameAngleFromZeroToATurn) {
  using Scalar = TypeParam;
  for (int k = -400; k <= 400; ++k) {
    const Scalar angle = Scalar(k) * Scalar(0.0773);
    const Scalar compass = compass_angle(angle);
    EXPECT_GE(compass, Scalar(0)) << angle;
    EXPECT_LT(compass, 2 * kPi<Scalar>) << angle;
    EXPECT_NEAR(std::sin(compass), std::sin(angle), 64 * this->kEpsilon) << angle;
    EXPECT_NEAR(std::cos(compass), std::cos(angle), 64 * this->kEpsilon) << angle;
  }
  EXPECT_EQ(compass_angle(Scalar(-1e-30)),
            Scalar(0));  // rounds to a whole turn, which is not shown
  EXPECT_EQ(compass_angle(-std::numeric_limits<Scalar>::denorm_min()), Scalar(0));
}

TYPED_TEST(Angle, NotANumberStaysSo) {
  constexpr TypeParam kNan = std::numeric_limits<TypeParam>::quiet_NaN();
  constexpr TypeParam kInfinity = std::numeric_limits<TypeParam>::infinity();
  EXPECT_TRUE(std::isnan(wrap_angle(kNan)));
  EXPECT_TRUE(std::isnan(wrap_angle(kInfinity)));
  EXPECT_TRUE(std::isnan(compass_angle(kNan)));
}

// The first AngleMean of WPILib took the plain sum of unit vectors, whatever the weights.
TYPED_TEST(Angle, MeanOfUnequalWeightsAcrossTheSeam) {
  using Scalar = TypeParam;
  using Pair = Vec<Scalar, 2>;
  const Pair seam(Scalar(deg(359.0)), Scalar(deg(1.0)));
  EXPECT_NEAR(mean_angle<Scalar>(seam, Pair(0.5, 0.5)), 0.0, 8 * this->kEpsilon);
  EXPECT_NEAR(mean_angle<Scalar>(seam, Pair(0.75, 0.25)), deg(-0.5), 1e-5);
  EXPECT_NEAR(mean_angle<Scalar>(seam, Pair(Scalar(0.1), Scalar(0.9))), deg(0.8), 1e-5);
  const Pair south(Scalar(deg(179.0)), Scalar(deg(-179.0)));
  EXPECT_NEAR(std::abs(mean_angle<Scalar>(south, Pair(0.75, 0.25))), deg(179.5), 1e-5);
}

TYPED_TEST(Angle, MeanTurnsWithTheAnglesAndIgnoresTheScaleOfTheWeights) {
  using Scalar = TypeParam;
  using Triple = Vec<Scalar, 3>;
  const Triple angles = Vec<double, 3>(0.1, 0.7, -0.4).cast<Scalar>();
  const Triple weights = Vec<double, 3>(0.2, 0.5, 0.3).cast<Scalar>();
  const Scalar mean = mean_angle<Scalar>(angles, weights);
  for (int k = 0; k < 12; ++k) {
    const Scalar turn = Scalar(deg(30.0 * k));
    const Scalar turned = mean_angle<Scalar>(Triple(angles.array() + turn), Triple(7 * weights));
    EXPECT_NEAR(wrap_angle<Scalar>(turned - mean - turn), 0.0, 16 * this->kEpsilon);
  }
}

TEST(Units, DegreesAndKnots) {
  EXPECT_DOUBLE_EQ(deg(180.0), kPi<double>);
  EXPECT_DOUBLE_EQ(knots(3600.0), 1852.0);
}

}  // namespace
}  // namespace wakeline::angle_test
