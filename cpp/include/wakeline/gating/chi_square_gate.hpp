// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/chi_square.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// The probability that a gate contains the target's plot; one setting for measurements of every
/// dimension.
struct ChiSquareGate {
  double probability = 0.99;

  static constexpr auto fields() noexcept {
    using C = ChiSquareGate;
    return field_table(field("probability", &C::probability, inside(0, 1), "1",
                             "Probability that the plot of a target is inside the gate."));
  }

  /// Largest normalised innovation squared (NIS) inside the gate for `dof` measured quantities. NaN
  /// when the setting is invalid or dof is not positive. Computed at each call; a hot loop keeps an
  /// `EllipsoidalGate`.
  [[nodiscard]] double threshold(int dof) const noexcept {
    return chi_square_quantile(probability, dof);
  }

  /// Throws `std::invalid_argument` unless 0 < probability < 1.
  void validate() const { validate_fields(*this); }
};

/// The gate of an M-dimensional measurement: the ellipsoid νᵀ S⁻¹ ν <= γ, P(χ²_M <= γ) = P_G.
///
/// Source: Bar-Shalom, Li, Multitarget-Multisensor Tracking, 1995, section 2.3.
template <int M, class Scalar = double>
class EllipsoidalGate {
 public:
  static_assert(M > 0, "a gate needs at least one measured quantity");

  /// Throws `std::invalid_argument` unless 0 < gate.probability < 1.
  explicit EllipsoidalGate(const ChiSquareGate& gate = {})
      : probability_(static_cast<Scalar>(gate.probability)),
        threshold_(static_cast<Scalar>(gate.threshold(M))) {
    gate.validate();
  }

  /// P_G.
  [[nodiscard]] Scalar probability() const noexcept { return probability_; }

  /// γ.
  [[nodiscard]] Scalar threshold() const noexcept { return threshold_; }

  /// True when a plot with this normalised innovation squared is inside; false for NaN.
  [[nodiscard]] auto contains(const Scalar& nis) const noexcept { return nis <= threshold_; }

  /// Volume in the units of the measurement: V = c_M √(γ^M det S), c_M the volume of the unit ball;
  /// the area π γ √det S for M = 2. NaN when S (M x M) is not positive definite.
  [[nodiscard]] Scalar volume(const Mat<Scalar, M, M>& innovation_covariance) const noexcept {
    using std::exp;
    using std::sqrt;
    const Cholesky<M, Scalar> cholesky(innovation_covariance);
    if (!cholesky.ok()) return std::numeric_limits<Scalar>::quiet_NaN();
    Scalar volume = exp(Scalar(0.5) * cholesky.log_determinant());
    // c_k = c_(k-2) 2π/k with c_0 = 1, c_1 = 2
    for (int k = M; k > 1; k -= 2)
      volume *= threshold_ * (Scalar(2) * kPi<Scalar> / static_cast<Scalar>(k));
    if constexpr (M % 2 == 1) volume *= Scalar(2) * sqrt(threshold_);
    return volume;
  }

 private:
  Scalar probability_;
  Scalar threshold_;
};

}  // namespace wakeline
