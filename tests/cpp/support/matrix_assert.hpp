// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <limits>
#include <type_traits>

namespace wakeline::test {

/// Two numbers agree when |actual - expected| <= absolute + relative * max(|actual|, |expected|).
struct Tolerance {
  double absolute = 1e-12;
  double relative = 1e-12;
};

namespace detail {

/// How far a pair of numbers is outside the tolerance: not positive when they agree. NaN agrees
/// with NaN only, and an infinity with itself only.
inline double excess(double actual, double expected, Tolerance tolerance) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (std::isnan(actual) || std::isnan(expected))
    return std::isnan(actual) && std::isnan(expected) ? 0.0 : kInfinity;
  if (std::isinf(actual) || std::isinf(expected)) return actual == expected ? 0.0 : kInfinity;
  const double scale = std::max(std::abs(actual), std::abs(expected));
  return std::abs(actual - expected) - (tolerance.absolute + tolerance.relative * scale);
}

/// The same bits: 0.0 differs from -0.0, and a NaN equals the same NaN.
template <class Scalar>
bool identical(Scalar actual, Scalar expected) {
  if constexpr (std::is_same_v<Scalar, double>) {
    return std::bit_cast<std::uint64_t>(actual) == std::bit_cast<std::uint64_t>(expected);
  } else if constexpr (std::is_same_v<Scalar, float>) {
    return std::bit_cast<std::uint32_t>(actual) == std::bit_cast<std::uint32_t>(expected);
  } else {
    return actual == expected;
  }
}

/// Compares element by element; `excess_of(actual, expected)` is positive where a pair differs. The
/// message names the element with the largest excess.
template <class Actual, class Expected, class Excess>
testing::AssertionResult compare(const Actual& actual, const Expected& expected,
                                 const Excess& excess_of) {
  if (actual.rows() != expected.rows() || actual.cols() != expected.cols()) {
    return testing::AssertionFailure()
           << "the shapes differ: actual is " << actual.rows() << " x " << actual.cols()
           << ", expected is " << expected.rows() << " x " << expected.cols();
  }
  double worst = 0.0;
  Eigen::Index worst_row = 0;
  Eigen::Index worst_col = 0;
  Eigen::Index differing = 0;
  for (Eigen::Index row = 0; row < actual.rows(); ++row) {
    for (Eigen::Index col = 0; col < actual.cols(); ++col) {
      const double excess = excess_of(actual(row, col), expected(row, col));
      if (excess > 0.0) ++differing;
      if (excess > worst) {
        worst = excess;
        worst_row = row;
        worst_col = col;
      }
    }
  }
  if (differing == 0) return testing::AssertionSuccess();
  const double is = static_cast<double>(actual(worst_row, worst_col));
  const double wanted = static_cast<double>(expected(worst_row, worst_col));
  return testing::AssertionFailure()
         << std::setprecision(17) << "element (" << worst_row << ", " << worst_col << ") is " << is
         << ", expected " << wanted << ", difference " << is - wanted << "; " << differing << " of "
         << actual.size() << " elements differ\nactual:\n"
         << actual << "\nexpected:\n"
         << expected;
}

}  // namespace detail

/// `EXPECT_TRUE(matrices_near(actual, expected, {.absolute = 1e-9, .relative = 0.0}))`
template <class A, class B>
testing::AssertionResult matrices_near(const Eigen::DenseBase<A>& actual,
                                       const Eigen::DenseBase<B>& expected,
                                       Tolerance tolerance = {}) {
  return detail::compare(
      actual.derived().eval(), expected.derived().eval(), [tolerance](auto is, auto wanted) {
        return detail::excess(static_cast<double>(is), static_cast<double>(wanted), tolerance);
      });
}

/// `EXPECT_TRUE(matrices_identical(restored, saved))`: bit for bit.
template <class A, class B>
testing::AssertionResult matrices_identical(const Eigen::DenseBase<A>& actual,
                                            const Eigen::DenseBase<B>& expected) {
  static_assert(std::is_same_v<typename A::Scalar, typename B::Scalar>,
                "bits of different scalar types never compare");
  return detail::compare(
      actual.derived().eval(), expected.derived().eval(),
      [](auto is, auto wanted) { return detail::identical(is, wanted) ? 0.0 : 1.0; });
}

}  // namespace wakeline::test
