// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/gating/chi_square_gate.hpp"
#include "wakeline/gating/radius_gate.hpp"

namespace wakeline::gating_test {
namespace {

template <class Scalar>
class EllipsoidalGateOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(EllipsoidalGateOf, Scalars, );

TYPED_TEST(EllipsoidalGateOf, ThresholdIsTheQuantile) {
  const EllipsoidalGate<2, TypeParam> gate(ChiSquareGate{.probability = 0.99});
  EXPECT_NEAR(gate.threshold(), -2.0 * std::log(0.01), 1e-5);
  EXPECT_TRUE(gate.contains(gate.threshold()));
  EXPECT_FALSE(gate.contains(std::nextafter(gate.threshold(), TypeParam(100))));
  EXPECT_FALSE(gate.contains(std::numeric_limits<TypeParam>::quiet_NaN()));
}

TYPED_TEST(EllipsoidalGateOf, AreaIsPiGammaRootDeterminant) {
  const EllipsoidalGate<2, TypeParam> gate(ChiSquareGate{.probability = 0.9});
  Mat<TypeParam, 2, 2> covariance;
  covariance << 9, 2, 2, 4;
  const double expected = kPi<double> * static_cast<double>(gate.threshold()) * std::sqrt(32.0);
  EXPECT_NEAR(static_cast<double>(gate.volume(covariance)) / expected, 1.0, 1e-6);
  EXPECT_TRUE(std::isnan(gate.volume(-covariance)));
}

TEST(EllipsoidalGate, VolumeOfOneAndThreeDimensions) {
  const ChiSquareGate setting{.probability = 0.95};
  const EllipsoidalGate<1> interval(setting);
  EXPECT_NEAR(interval.volume(Mat<double, 1, 1>(4.0)), 2.0 * 2.0 * std::sqrt(interval.threshold()),
              1e-12);
  const EllipsoidalGate<3> ball(setting);
  EXPECT_NEAR(ball.volume(Mat<double, 3, 3>::Identity()),
              4.0 / 3.0 * kPi<double> * std::pow(ball.threshold(), 1.5), 1e-10);
}

TEST(EllipsoidalGate, HoldsItsShareOfTheTargetsPlots) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Mat<double, 2, 2> covariance;
  covariance << 9.0, -3.0, -3.0, 4.0;
  const Cholesky<2> cholesky(covariance);
  const EllipsoidalGate<2> gate(ChiSquareGate{.probability = 0.9});
  constexpr int draws = 20'000;
  int inside = 0;
  for (int k = 0; k < draws; ++k) {
    const double first = normal(random);
    const double second = normal(random);
    const Vec<double, 2> innovation = cholesky.lower() * Vec<double, 2>(first, second);
    inside += gate.contains(cholesky.whiten<1>(innovation).squaredNorm()) ? 1 : 0;
  }
  EXPECT_NEAR(inside / static_cast<double>(draws), 0.9, 4.0 * std::sqrt(0.09 / draws));
}

TEST(ChiSquareGate, RejectsWhatIsNoProbability) {
  for (const double probability : {0.0, 1.0, -0.5, 2.0, std::nan("")})
    EXPECT_THROW(EllipsoidalGate<2>(ChiSquareGate{.probability = probability}),
                 std::invalid_argument);
}

TEST(RadiusGate, IsACircleWithItsEdge) {
  const RadiusGate gate{.radius_m = 50.0};
  const Vec<double, 2> predicted(100.0, -20.0);
  for (int degree = 0; degree < 360; degree += 15) {
    const Vec<double, 2> direction(std::cos(deg(degree)), std::sin(deg(degree)));
    EXPECT_TRUE(gate.contains<double>(predicted, predicted + 49.999 * direction));
    EXPECT_FALSE(gate.contains<double>(predicted, predicted + 50.001 * direction));
  }
  EXPECT_TRUE(gate.contains<double>(predicted, predicted + Vec<double, 2>(30.0, 40.0)));
  EXPECT_FALSE(gate.contains<double>(predicted, Vec<double, 2>(std::nan(""), 0.0)));
  EXPECT_FALSE(gate.contains<float>(Vec<float, 2>(0, 0), Vec<float, 2>(0, 51)));
  EXPECT_DOUBLE_EQ(gate.area_m2(), kPi<double> * 2500.0);
  EXPECT_THROW(RadiusGate{.radius_m = 0.0}.validate(), std::invalid_argument);
  EXPECT_THROW(RadiusGate{.radius_m = std::nan("")}.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::gating_test
