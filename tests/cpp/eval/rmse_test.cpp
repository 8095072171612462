// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/eval/rmse.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/matrix_assert.hpp"

namespace wakeline {
namespace {

TEST(Rmse, IsTheRootOfTheMeanOfTheSquares) {
  std::mt19937_64 random(31);
  std::normal_distribution<double> normal(3.0, 5.0);
  Rmse<2> rmse;
  double squares = 0.0;
  Vec<double, 2> component_squares = Vec<double, 2>::Zero();
  constexpr int samples = 1000;
  for (int k = 0; k < samples; ++k) {
    const double north = normal(random);
    const Vec<double, 2> error(north, 2.0 * normal(random));
    rmse.add(error);
    squares += error.squaredNorm();
    component_squares += error.cwiseAbs2();
  }
  EXPECT_EQ(rmse.samples(), samples);
  EXPECT_NEAR(rmse.value(), std::sqrt(squares / samples), 1e-11);
  EXPECT_TRUE(test::matrices_near(rmse.by_component(), (component_squares / samples).cwiseSqrt()));
  EXPECT_NEAR(rmse.value(), rmse.by_component().norm(), 1e-11);
  EXPECT_NEAR(rmse.value(), std::hypot(rmse.bias().norm(), rmse.debiased()), 1e-11);
}

TEST(Rmse, DebiasedIgnoresAConstantOffset) {
  Rmse<2> plain;
  Rmse<2> offset;
  for (const double error : {-1.0, 0.5, 2.0, -1.5}) {
    plain.add({error, -error});
    offset.add({error + 1e7, -error - 3e7});
  }
  EXPECT_NEAR(plain.bias().norm(), 0.0, 1e-15);
  EXPECT_NEAR(offset.debiased(), plain.value(), 1e-7);
}

TEST(Rmse, OfOneErrorIsItsLengthAndOfNoneIsZero) {
  Rmse<3, float> rmse;
  EXPECT_EQ(rmse.value(), 0.0F);
  EXPECT_EQ(rmse.debiased(), 0.0F);
  rmse.add({2.0F, 3.0F, 6.0F});
  EXPECT_FLOAT_EQ(rmse.value(), 7.0F);
  EXPECT_EQ(rmse.debiased(), 0.0F);
  rmse.add({std::nanf(""), 0.0F, 0.0F});
  EXPECT_TRUE(std::isnan(rmse.value()));
}

}  // namespace
}  // namespace wakeline
