// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <type_traits>
#include <vector>

namespace wakeline::test {

/// Two numbers agree when |actual - expected| <= absolute + relative * max(|actual|, |expected|).
struct Tolerance {
  double absolute = 1e-12;
  double relative = 1e-12;
};

namespace detail {

/// A matrix of any type, so that one function compares them all.
struct Elements {
  Eigen::Index rows, cols;
  std::vector<double> values;  // row by row

  template <class Matrix>
  explicit Elements(const Matrix& matrix) : rows(matrix.rows()), cols(matrix.cols()) {
    for (Eigen::Index row = 0; row < rows; ++row)
      for (Eigen::Index col = 0; col < cols; ++col)
        values.push_back(static_cast<double>(matrix(row, col)));
  }
};

testing::AssertionResult near(const Elements& actual, const Elements& expected,
                              Tolerance tolerance);
testing::AssertionResult identical(const Elements& actual, const Elements& expected);

}  // namespace detail

/// `EXPECT_TRUE(matrices_near(actual, expected, {.absolute = 1e-9, .relative = 0.0}))`. NaN agrees
/// with NaN only, and an infinity with itself only. The message names the element that is furthest
/// outside the tolerance.
template <class A, class B>
testing::AssertionResult matrices_near(const Eigen::DenseBase<A>& actual,
                                       const Eigen::DenseBase<B>& expected,
                                       Tolerance tolerance = {}) {
  return detail::near(detail::Elements(actual.eval()), detail::Elements(expected.eval()),
                      tolerance);
}

/// `EXPECT_TRUE(matrices_identical(restored, saved))`: bit for bit, so that 0.0 differs from -0.0,
/// and a NaN equals the same NaN.
template <class A, class B>
testing::AssertionResult matrices_identical(const Eigen::DenseBase<A>& actual,
                                            const Eigen::DenseBase<B>& expected) {
  static_assert(std::is_same_v<typename A::Scalar, typename B::Scalar>,
                "bits of different scalar types never compare");
  return detail::identical(detail::Elements(actual.eval()), detail::Elements(expected.eval()));
}

}  // namespace wakeline::test
