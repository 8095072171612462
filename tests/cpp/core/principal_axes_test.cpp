// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/core/principal_axes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"

namespace wakeline::principal_axes_test {
namespace {

using test::matrices_near;
using Matrix = Mat<double, 5, 5>;

/// A random symmetric matrix of the given rank, with units far apart in its rows.
Matrix symmetric(test::Draw& draw, int rank, double unit) {
  Matrix a = Matrix::Zero();
  for (int k = 0; k < rank; ++k) {
    Vec<double, 5> axis;
    for (int i = 0; i < 5; ++i) axis[i] = draw.normal() * std::pow(unit, i);
    a += (k % 2 == 0 ? 1.0 : -0.5) * product_transposed(axis, axis);
  }
  return a;
}

TEST(PrincipalAxes, ComposeTheMatrixAndAreOrthonormal) {
  test::Draw draw(3);
  for (int round = 0; round < 200; ++round) {
    const Matrix a = symmetric(draw, round % 6, round % 3 == 0 ? 1e-3 : 1.0);
    const auto [variance, axes] = principal_axes<5, double>(a);
    const double scale = a.cwiseAbs().maxCoeff();
    const Matrix composed = axes.transpose() * variance.asDiagonal() * axes;
    EXPECT_TRUE(matrices_near(composed, a, {.absolute = 1e-14 * scale}));
    EXPECT_TRUE(matrices_near(Matrix(axes * axes.transpose()), Matrix(Matrix::Identity()),
                              {.absolute = 1e-14}));
  }
}

TEST(PrincipalAxes, AreNotFiniteOfAMatrixThatIsNot) {
  Matrix a = Matrix::Identity();
  a(1, 2) = a(2, 1) = std::numeric_limits<double>::quiet_NaN();
  a(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(principal_axes<5>(a).variance.allFinite());
}

}  // namespace
}  // namespace wakeline::principal_axes_test
