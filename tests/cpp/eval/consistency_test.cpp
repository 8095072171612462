// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/eval/consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace wakeline::consistency_test {
namespace {

template <class Scalar>
class NeesOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(NeesOf, Scalars, );

TYPED_TEST(NeesOf, IsTheSquaredDistanceInSigmas) {
  using Vector = Vec<TypeParam, 2>;
  Mat<TypeParam, 2, 2> covariance = Vector(4, 25).asDiagonal();
  EXPECT_NEAR((nees<2, TypeParam>(Vector(2, 5), covariance)), 2.0, 1e-6);
  EXPECT_NEAR((nis<2, TypeParam>(Vector(2, 5), covariance)), 2.0, 1e-6);
  EXPECT_TRUE(std::isnan(nees<2, TypeParam>(Vector(2, 5), -covariance)));
  covariance(1, 1) = std::numeric_limits<TypeParam>::quiet_NaN();
  EXPECT_TRUE(std::isnan(nees<2, TypeParam>(Vector(2, 5), covariance)));
}

TYPED_TEST(NeesOf, IsNanForAnErrorThatIsNan) {
  using Scalar = TypeParam;
  const Mat<Scalar, 2, 2> covariance = Mat<Scalar, 2, 2>::Identity();
  for (const Scalar bad :
       {std::numeric_limits<Scalar>::infinity(), std::numeric_limits<Scalar>::quiet_NaN()})
    EXPECT_TRUE(std::isnan(nees<2>(Vec<Scalar, 2>(Scalar(0), bad), covariance))) << bad;
}

TEST(Nees, DoesNotChangeUnderALinearChangeOfCoordinates) {
  Mat<double, 3, 3> covariance;
  covariance << 4, 1, 0.5, 1, 3, -1, 0.5, -1, 6;
  Mat<double, 3, 3> change;
  change << 2, 0, 1, -1, 3, 0, 0.2, 0, 5;
  const Vec<double, 3> error(1.0, -2.0, 0.7);
  const Mat<double, 3, 3> changed = change * covariance * change.transpose();
  EXPECT_NEAR((nees<3, double>(error, covariance)), (nees<3, double>(change * error, changed)),
              1e-12);
}

/// Average NEES of drawn errors whose claimed covariance is `claim` times the true one.
ConsistencyAverage average_of_drawn(double claim, unsigned seed, int runs) {
  Mat<double, 4, 4> root;
  root << 9, 0, 0, 0, 1, 2, 0, 0, -2, 0.3, 8, 0, 0.5, 0, 1, 3;
  const Mat<double, 4, 4> covariance = claim * root * root.transpose();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  ConsistencyAverage average(4);
  for (int run = 0; run < runs; ++run) {
    Vec<double, 4> drawn;
    for (double& value : drawn) value = normal(random);
    average.add(nees<4, double>(root * drawn, covariance));
  }
  return average;
}

TEST(ConsistencyAverage, IsInItsBoundsWithTheStatedConfidence) {
  constexpr int trials = 1000;
  int inside = 0;
  for (unsigned trial = 0; trial < trials; ++trial) {
    const auto average = average_of_drawn(1.0, trial, 50);
    inside += average.bounds(0.95).contains(average.average()) ? 1 : 0;
  }
  EXPECT_NEAR(inside / static_cast<double>(trials), 0.95, 4.0 * std::sqrt(0.95 * 0.05 / trials));
}

TEST(ConsistencyAverage, ShowsWhetherAFilterIsTooSureOrTooModest) {
  const auto too_sure = average_of_drawn(0.5, 1, 200);
  const auto too_modest = average_of_drawn(2.0, 1, 200);
  EXPECT_GT(too_sure.average(), too_sure.bounds(0.99).upper);
  EXPECT_LT(too_modest.average(), too_modest.bounds(0.99).lower);
}

TEST(ConsistencyBounds, AgreeWithTheTextbookExample) {
  // Bar-Shalom, Li, Kirubarajan 2001, 5.4.2: 50 runs, two dof, 95 %: [1.5, 2.6] from χ²_100 = 74.2
  // and 129.6.
  const auto bounds = consistency_bounds(0.95, 2, 50);
  EXPECT_NEAR(bounds.lower, 74.222 / 50.0, 1e-4);
  EXPECT_NEAR(bounds.upper, 129.561 / 50.0, 1e-4);
}

TEST(ConsistencyBounds, NarrowAroundTheDofWithMoreRuns) {
  double width = 1e9;
  for (const double runs : {1.0, 10.0, 100.0, 10'000.0}) {
    const auto bounds = consistency_bounds(0.95, 4, runs);
    EXPECT_TRUE(bounds.contains(4.0));
    EXPECT_LT(bounds.upper - bounds.lower, width);
    width = bounds.upper - bounds.lower;
  }
  EXPECT_LT(width, 0.12);
}

TEST(ConsistencyBounds, ContainNothingWithoutAMeaning) {
  EXPECT_FALSE(consistency_bounds(0.0, 2, 10).contains(2.0));
  EXPECT_FALSE(consistency_bounds(1.0, 2, 10).contains(2.0));
  EXPECT_FALSE(consistency_bounds(0.95, 0, 10).contains(2.0));
  EXPECT_FALSE(ConsistencyAverage(2).bounds().contains(0.0));
  EXPECT_THROW(ConsistencyAverage(0), std::invalid_argument);
}

TEST(ConsistencyAverage, AFailedCovarianceCannotHide) {
  ConsistencyAverage average(2);
  average.add(2.0);
  average.add(std::nan(""));
  average.add(2.0);
  EXPECT_TRUE(std::isnan(average.average()));
  EXPECT_FALSE(average.bounds().contains(average.average()));
  EXPECT_EQ(average.samples(), 3);
}

}  // namespace
}  // namespace wakeline::consistency_test
