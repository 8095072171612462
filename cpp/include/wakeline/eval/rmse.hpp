// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/core/types.hpp"

namespace wakeline {

/// Root mean square error of an N-vector, gathered error by error in constant memory.
///
/// Keeps the mean and the summed squared deviations from it (Welford), so that a large constant
/// offset, as of a radar against GNSS, does not swamp the rest. All results are in the unit of the
/// error, and zero before the first one. An error that is not a number makes them NaN.
/// Source: B. P. Welford, Note on a Method for Calculating Corrected Sums of Squares, Technometrics
/// 4, 1962.
template <int N, class Scalar = double>
class Rmse {
 public:
  void add(const Vec<Scalar, N>& error) noexcept {
    ++samples_;
    const Vec<Scalar, N> before = error - bias_;
    bias_ += before / static_cast<Scalar>(samples_);
    squared_deviation_ += before.cwiseProduct(error - bias_);
  }

  [[nodiscard]] long samples() const noexcept { return samples_; }

  /// Mean error.
  [[nodiscard]] const Vec<Scalar, N>& bias() const noexcept { return bias_; }

  /// √(mean |e|²).
  [[nodiscard]] Scalar value() const noexcept {
    using std::sqrt;
    return sqrt(bias_.squaredNorm() + variance().sum());
  }

  /// √(mean |e - bias|²): what is left when the mean error is removed.
  [[nodiscard]] Scalar debiased() const noexcept {
    using std::sqrt;
    return sqrt(variance().sum());
  }

  /// √(mean e_k²) of each component k.
  [[nodiscard]] Vec<Scalar, N> by_component() const noexcept {
    return (bias_.cwiseAbs2() + variance()).cwiseSqrt();
  }

 private:
  [[nodiscard]] Vec<Scalar, N> variance() const noexcept {
    return squared_deviation_ / static_cast<Scalar>(samples_ > 0 ? samples_ : 1);
  }

  Vec<Scalar, N> bias_ = Vec<Scalar, N>::Zero();
  Vec<Scalar, N> squared_deviation_ = Vec<Scalar, N>::Zero();
  long samples_ = 0;
};

}  // namespace wakeline
