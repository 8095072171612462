// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/reported.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"

namespace wakeline::reported_test {
namespace {

using test::Draw;

/// NIS of a plot whose errors are as stated.
double nis(Draw& draw) {
  const double a = draw.normal(), b = draw.normal();
  return a * a + b * b;
}

double share_of(std::uint64_t seed, int looks, double scale) {
  Draw draw(seed);
  PersistentErrors errors;
  for (int k = 0; k < looks; ++k) errors.learn(scale * nis(draw));
  return errors.share();
}

TEST(PersistentErrors, AreNoneBeforeALookAndWhereErrorsAreAsStated) {
  EXPECT_EQ(PersistentErrors{}.share(), 0.0);
  for (const int looks : {20, 100, 1000}) {
    double sum = 0.0;
    constexpr int kRadars = 200;
    for (std::uint64_t seed = 0; seed < kRadars; ++seed) sum += share_of(seed, looks, 1.0);
    EXPECT_LT(sum / kRadars, 0.01) << looks;
  }
}

TEST(PersistentErrors, AreWhatInnovationsDoNotShow) {
  for (const double shown : {0.5, 0.3}) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < 50; ++seed) sum += share_of(seed, 500, shown) / 50;
    EXPECT_NEAR(sum, 1.0 / shown - 1.0, 0.1 / shown) << shown;
  }
}

TEST(PersistentErrors, AreWhatInnovationsShowBeyondTheStatedErrors) {
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) sum += share_of(seed, 500, 2.0) / 50;
  EXPECT_NEAR(sum, 1.0, 0.1);
}

// An outlier in ten does not hide that the others are half of what is stated.
TEST(PersistentErrors, AreLearnedBesideOutliers) {
  Draw draw(4);
  PersistentErrors errors;
  for (int k = 0; k < 1000; ++k) errors.learn(k % 10 == 0 ? 1e6 : 0.4 * nis(draw));
  EXPECT_GT(errors.share(), 0.8);
  EXPECT_LT(errors.share(), 2.5);
}

// Targets of one range, seen in directions that err by s: what the line of sight leaves out.
TEST(BentLineOfSight, HasTheMeanSquareOfItsDepth) {
  constexpr double kRange_m = 40e3, kStd_rad = 0.03;
  const Vec<double, 2> u = towards(1.0), across(-u[1], u[0]);
  const double s_m = kRange_m * kStd_rad;
  const Mat<double, 2, 2> p = s_m * s_m * across * across.transpose() + 9.0 * u * u.transpose();
  Draw draw(6);
  double square = 0.0;
  constexpr int kDraws = 20'000;
  for (int k = 0; k < kDraws; ++k) {
    const double depth_m = kRange_m * (1.0 - std::cos(kStd_rad * draw.normal()));
    square += depth_m * depth_m / kDraws;
  }
  const Mat<double, 2, 2> bent = bent_m2(kRange_m * u, p);
  EXPECT_NEAR(u.dot(bent * u) / square, 1.0, 0.05);
  EXPECT_NEAR(across.dot(bent * across), 0.0, 1e-6);
  EXPECT_EQ(bent_m2({1.0, 2.0}, p), (Mat<double, 2, 2>::Zero())) << "about the antenna itself";
}

TEST(Reported, AddsWhatStaysAndATurnThatDoesNotShow) {
  Draw draw(7);
  const Gaussian<4> belief{{100.0, 6.0, -50.0, 8.0}, draw.definite<4>()};
  Mat<double, 2, 2> stays;
  stays << 9.0, 2.0, 2.0, 4.0;
  const Gaussian<4> found = reported(belief, stays);
  EXPECT_EQ(found.mean, belief.mean);
  const Mat<double, 4, 4> more = found.covariance - belief.covariance;
  const Vec<double, 4> along(0.0, 0.6, 0.0, 0.8), aside(0.0, -0.8, 0.0, 0.6);
  EXPECT_NEAR(along.dot(more * along), 0.0, 1e-12);
  EXPECT_NEAR(std::sqrt(aside.dot(more * aside)) / 10.0, 0.055, 1e-12);
  EXPECT_NEAR(more(0, 0), 9.0, 1e-12);
  EXPECT_NEAR(more(0, 2), 2.0, 1e-12);
  EXPECT_NEAR(more(2, 2), 4.0, 1e-12);
  EXPECT_TRUE(Cholesky<4>(found.covariance).ok());
}

}  // namespace
}  // namespace wakeline::reported_test
