// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "wakeline/core/angle.hpp"

namespace wakeline {

// The chi-square distribution for real degrees of freedom, accurate to about 1e-12 relative for
// dof <= 1e5.
//
// `std::lgamma` is avoided on purpose: it writes the global `signgam`, so two threads that use it
// race. Here the gamma function enters through Loader's Stirling error, which also keeps its
// accuracy for many degrees of freedom.

namespace detail {

/// ln Γ(a + 1) - [(a + 1/2) ln a - a + ln(2π)/2] for a > 0: by its series from a = 16 on, and below
/// that by the recurrence Γ(a + 2) = (a + 1) Γ(a + 1).
/// Source: C. Loader, Fast and Accurate Computation of Binomial Probabilities, 2000, section 3.
inline double stirling_error(double a) noexcept {
  double shift = 0.0;
  while (a < 16.0) {
    shift += (a + 0.5) * std::log1p(1.0 / a) - 1.0;
    a += 1.0;
  }
  constexpr double coefficients[] = {691.0 / 360360.0, 1.0 / 1188.0, 1.0 / 1680.0,
                                     1.0 / 1260.0,     1.0 / 360.0,  1.0 / 12.0};
  double series = 0.0;
  for (const double coefficient : coefficients) series = coefficient - series / (a * a);
  return shift + series / a;
}

/// x^a e^-x / Γ(a + 1) for a, x > 0, free of cancellation near x = a.
/// Source: Loader 2000, the saddle-point form, here for real a.
inline double poisson_term(double a, double x) noexcept {
  const double excess = (x - a) / a;
  const double deviance =
      std::abs(excess) < 0.5 ? a * (excess - std::log1p(excess)) : (x - a) - a * std::log(x / a);
  return std::exp(-stirling_error(a) - deviance) / std::sqrt(2.0 * kPi<double> * a);
}

/// Both tails of the gamma distribution with shape a at x, and the Poisson term they came from.
struct GammaTails {
  double lower;         ///< P(a, x), regularised lower incomplete gamma function
  double upper;         ///< Q(a, x) = 1 - P(a, x)
  double poisson_term;  ///< x^a e^-x / Γ(a + 1); the density at x is this times a / x
};

/// The same for a shape of 1e12 and more, for which the series below would need millions of terms
/// and from 1e16 on never end: nearly a normal distribution.
/// Source: N. M. Temme, SIAM J. Math. Anal. 10, 1979: the uniform expansion's first term.
inline GammaTails nearly_normal_tails(double a, double x) noexcept {
  const double u = (x - a) / a;
  const double deviance = std::abs(u) < 1e-3
                              ? u * u * (1.0 / 2.0 - u * (1.0 / 3.0 - u * (1.0 / 4.0 - u / 5.0)))
                              : u - std::log1p(u);
  const double eta = std::copysign(std::sqrt(2.0 * deviance), u);
  const double z = eta * std::sqrt(0.5 * a);
  const double scale = std::exp(-z * z) / (std::sqrt(2.0 * kPi<double>) * std::sqrt(a));
  const double skew = scale > 0.0 ? scale * (1.0 / 3.0 - eta / 12.0) : 0.0;
  return {0.5 * std::erfc(-z) + skew, 0.5 * std::erfc(z) - skew, scale};
}

/// P and Q for a > 0, 0 < x < inf: the series below x = a + 1, the continued fraction (modified
/// Lentz) above it, so that the smaller of the two is computed without cancellation.
/// Source: Abramowitz and Stegun, 6.5.29 and 6.5.31.
inline GammaTails gamma_tails(double a, double x) noexcept {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  if (a >= 1e12) return nearly_normal_tails(a, x);
  const double scale = poisson_term(a, x);
  if (x < a + 1.0) {
    double term = 1.0;
    double sum = 1.0;
    for (double n = a + 1.0; term > 0.25 * epsilon * sum; n += 1.0) {
      term *= x / n;
      sum += term;
    }
    const double lower = std::min(scale * sum, 1.0);
    return {lower, 1.0 - lower, scale};
  }
  constexpr int max_terms = 1'000'000;
  double b = x + 1.0 - a;
  double d = 1.0 / b;
  double c = std::numeric_limits<double>::max();
  double fraction = d;
  for (int n = 1; n < max_terms; ++n) {
    const double numerator = -n * (n - a);
    b += 2.0;
    d = 1.0 / (b + numerator * d);
    c = b + numerator / c;
    const double change = c * d;
    fraction *= change;
    if (std::abs(change - 1.0) < epsilon) break;
  }
  const double upper = std::min(scale * a * fraction, 1.0);
  return {1.0 - upper, upper, scale};
}

}  // namespace detail

/// P(X <= value) for X chi-square with `dof` > 0 degrees of freedom (real): P(dof/2, value/2).
/// NaN when an argument is not a number, or dof is not positive and finite.
inline double chi_square_probability(double value, double dof) noexcept {
  if (!(dof > 0.0) || std::isinf(dof) || std::isnan(value))
    return std::numeric_limits<double>::quiet_NaN();
  if (value <= 0.0) return 0.0;
  if (std::isinf(value)) return 1.0;
  if (dof == 2.0) return -std::expm1(-0.5 * value);
  return detail::gamma_tails(0.5 * dof, 0.5 * value).lower;
}

/// P(X > value), with full relative accuracy far out in the tail: the p-value of a NIS or NEES.
/// NaN when an argument is not a number, or dof is not positive and finite.
inline double chi_square_tail(double value, double dof) noexcept {
  if (!(dof > 0.0) || std::isinf(dof) || std::isnan(value))
    return std::numeric_limits<double>::quiet_NaN();
  if (value <= 0.0) return 1.0;
  if (std::isinf(value)) return 0.0;
  if (dof == 2.0) return std::exp(-0.5 * value);
  return detail::gamma_tails(0.5 * dof, 0.5 * value).upper;
}

/// The value x with P(X <= x) = probability for X chi-square with `dof` > 0 degrees of freedom
/// (real).
///
/// Closed form for two degrees of freedom; otherwise Newton's method on the logarithm of the
/// smaller tail, kept inside a bracket. Start: Wilson and Hilferty 1931, or the leading term of the
/// series far down the lower tail. 0 at probability 0, infinity at 1; NaN when probability is
/// outside [0, 1] or dof is not positive and finite.
inline double chi_square_quantile(double probability, double dof) noexcept {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(dof > 0.0) || std::isinf(dof) || !(probability >= 0.0 && probability <= 1.0))
    return std::numeric_limits<double>::quiet_NaN();
  if (probability == 0.0) return 0.0;
  if (probability == 1.0) return infinity;
  if (dof == 2.0) return -2.0 * std::log1p(-probability);

  const double a = 0.5 * dof;
  const bool lower_tail = probability <= 0.5;
  const double tail = lower_tail ? probability : 1.0 - probability;

  // Normal quantile of the smaller tail, Abramowitz and Stegun 26.2.22, for the Wilson-Hilferty
  // start.
  const double t = std::sqrt(-2.0 * std::log(tail));
  const double normal = t - (2.30753 + 0.27061 * t) / (1.0 + t * (0.99229 + 0.04481 * t));
  const double cube_root =
      1.0 - 1.0 / (9.0 * a) + (lower_tail ? -normal : normal) / (3.0 * std::sqrt(a));
  const double log_gamma_a1 =
      detail::stirling_error(a) + (a + 0.5) * std::log(a) - a + 0.5 * std::log(2.0 * kPi<double>);
  const double series_start = std::exp((std::log(probability) + log_gamma_a1) / a);
  double x = a * cube_root * cube_root * cube_root;
  if (!(cube_root > 0.0) || series_start < 0.2 * (a + 1.0)) x = series_start;

  double low = 0.0;
  double high = infinity;
  constexpr int max_iterations = 200;
  for (int iteration = 0; iteration < max_iterations && x > 0.0; ++iteration) {
    const detail::GammaTails at = detail::gamma_tails(a, x);
    const bool too_high = lower_tail ? at.lower > tail : at.upper < tail;
    (too_high ? high : low) = x;
    const double step =
        lower_tail ? x * std::expm1(std::log(tail / at.lower) * at.lower / (a * at.poisson_term))
                   : x * std::log(at.upper / tail) * at.upper / (a * at.poisson_term);
    double next = x + step;
    if (!(next > low && next < high)) next = std::isinf(high) ? 2.0 * low : 0.5 * (low + high);
    const bool settled = std::abs(next - x) <= 2.0 * std::numeric_limits<double>::epsilon() * x;
    x = next;
    if (settled) break;
  }
  return 2.0 * x;
}

}  // namespace wakeline
