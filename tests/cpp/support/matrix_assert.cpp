// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/matrix_assert.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <limits>

namespace wakeline::test::detail {
namespace {

/// How far a pair of numbers is outside the tolerance: not positive when they agree.
double excess(double actual, double expected, Tolerance tolerance) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (std::isnan(actual) || std::isnan(expected))
    return std::isnan(actual) && std::isnan(expected) ? 0.0 : kInfinity;
  if (std::isinf(actual) || std::isinf(expected)) return actual == expected ? 0.0 : kInfinity;
  const double scale = std::max(std::abs(actual), std::abs(expected));
  return std::abs(actual - expected) - (tolerance.absolute + tolerance.relative * scale);
}

/// Compares element by element; `excess_of(actual, expected)` is positive where a pair differs. The
/// message names the element with the largest excess.
template <class Excess>
testing::AssertionResult compare(const Elements& actual, const Elements& expected,
                                 const Excess& excess_of) {
  if (actual.rows != expected.rows || actual.cols != expected.cols) {
    return testing::AssertionFailure()
           << "the shapes differ: actual is " << actual.rows << " x " << actual.cols
           << ", expected is " << expected.rows << " x " << expected.cols;
  }
  double worst = 0.0;
  std::size_t at = 0, differing = 0;
  for (std::size_t k = 0; k < actual.values.size(); ++k) {
    const double excess = excess_of(actual.values[k], expected.values[k]);
    if (excess > 0.0) ++differing;
    if (excess > worst) {
      worst = excess;
      at = k;
    }
  }
  if (differing == 0) return testing::AssertionSuccess();
  const double is = actual.values[at], wanted = expected.values[at];
  const auto cols = std::size_t(actual.cols);
  auto failure = testing::AssertionFailure();
  failure << std::setprecision(17) << "element (" << at / cols << ", " << at % cols << ") is " << is
          << ", expected " << wanted << ", difference " << is - wanted << "; " << differing
          << " of " << actual.values.size() << " elements differ";
  for (const auto* matrix : {&actual, &expected}) {
    failure << (matrix == &actual ? "\nactual:" : "\nexpected:");
    for (std::size_t k = 0; k < matrix->values.size(); ++k)
      failure << (k % cols == 0 ? '\n' : ' ') << matrix->values[k];
  }
  return failure;
}

}  // namespace

testing::AssertionResult near(const Elements& actual, const Elements& expected,
                              Tolerance tolerance) {
  return compare(actual, expected,
                 [tolerance](double is, double wanted) { return excess(is, wanted, tolerance); });
}

testing::AssertionResult identical(const Elements& actual, const Elements& expected) {
  return compare(actual, expected, [](double is, double wanted) {
    return std::bit_cast<std::uint64_t>(is) == std::bit_cast<std::uint64_t>(wanted) ? 0.0 : 1.0;
  });
}

}  // namespace wakeline::test::detail
