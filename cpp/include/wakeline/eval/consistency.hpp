// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "wakeline/core/chi_square.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Normalised estimation error squared eᵀ P⁻¹ e of an error (N) and its estimated covariance (N x
/// N); chi-square with N degrees of freedom for a consistent estimator. NaN when P is not positive
/// definite or an input is not finite. Source: Bar-Shalom, Li, Kirubarajan, Estimation with
/// Applications to Tracking and Navigation, 2001, section 5.4.2.
template <int N, class Scalar>
[[nodiscard]] Scalar nees(const Vec<Scalar, N>& error,
                          const Mat<Scalar, N, N>& covariance) noexcept {
  const Cholesky<N, Scalar> cholesky(covariance);
  if (!cholesky.ok() || !is_finite(error)) return std::numeric_limits<Scalar>::quiet_NaN();
  return cholesky.template whiten<1>(error).squaredNorm();
}

/// Normalised innovation squared νᵀ S⁻¹ ν, chi-square with M degrees of freedom when the filter is
/// consistent. The same formula, failure and source as `nees`; filters report it in each `Step`.
template <int M, class Scalar>
[[nodiscard]] Scalar nis(const Vec<Scalar, M>& innovation,
                         const Mat<Scalar, M, M>& innovation_covariance) noexcept {
  return nees<M, Scalar>(innovation, innovation_covariance);
}

/// Acceptance interval of an average.
struct ConsistencyBounds {
  double lower = 0.0;
  double upper = 0.0;

  [[nodiscard]] bool contains(double average) const noexcept {
    return lower <= average && average <= upper;
  }
};

/// Two-sided bounds of the average of `samples` independent NEES or NIS values with `dof` degrees
/// of freedom each, which a consistent filter meets with probability `confidence`: χ²_{R n}
/// quantiles at (1 ∓ confidence)/2, divided by R. A mean with weights w counts as R = (Σ w)² / Σ w²
/// samples. NaN unless 0 < confidence < 1, dof > 0 and samples > 0. Source: Bar-Shalom, Li,
/// Kirubarajan 2001, section 5.4.2.
[[nodiscard]] inline ConsistencyBounds consistency_bounds(double confidence, int dof,
                                                          double samples) noexcept {
  const double total_dof = static_cast<double>(dof) * samples;
  if (!(confidence > 0.0 && confidence < 1.0) || dof <= 0 || !(samples > 0.0))
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  const double tail = 0.5 * (1.0 - confidence);
  return {chi_square_quantile(tail, total_dof) / samples,
          chi_square_quantile(1.0 - tail, total_dof) / samples};
}

/// Running average of NEES or NIS values, and its acceptance interval for a consistent filter.
class ConsistencyAverage {
 public:
  /// `dof`: N for NEES, M for NIS. Throws `std::invalid_argument` unless positive.
  explicit ConsistencyAverage(int dof) : dof_(dof) { require_positive("dof", dof); }

  /// Adds one value. NaN, the result of a covariance that is not positive definite, makes the
  /// average NaN, so that the failure stays visible.
  void add(double value) noexcept {
    ++samples_;
    average_ += (value - average_) / static_cast<double>(samples_);
  }

  [[nodiscard]] long samples() const noexcept { return samples_; }

  /// Near `dof` for a consistent filter, above it for an over-confident one; zero before the first
  /// value.
  [[nodiscard]] double average() const noexcept { return average_; }

  /// The bounds for the number of values added, which must be independent, i.e. from different
  /// runs.
  [[nodiscard]] ConsistencyBounds bounds(double confidence = 0.95) const noexcept {
    return consistency_bounds(confidence, dof_, static_cast<double>(samples_));
  }

 private:
  int dof_;
  long samples_ = 0;
  double average_ = 0.0;
};

}  // namespace wakeline
