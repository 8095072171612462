// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/gating/chi_square_gate.hpp"
#include "wakeline/gating/radius_gate.hpp"
#include "wakeline/gating/strobe_chord.hpp"
#include "wakeline/measurement/polar.hpp"

namespace wakeline {

/// The shape of a strobe: the region about a predicted position in which the echo of a target is
/// searched. A ray from the antenna intersects it in one interval. Positions are [north, east] from
/// the antenna, m.
///
/// - `contains(predicted_m, point_m) -> bool`;
/// - `half_angle_rad(predicted_m) -> double`: largest deviation of a bearing inside from the
///   prediction's bearing; pi for all round, NaN for an invalid shape;
/// - `chord(predicted_m, bearing_rad) -> StrobeChord`: the ranges inside on that bearing.
///
/// `RadiusGate` is the circle.
template <class Strobe>
concept StrobeShape = requires(const Strobe& strobe, const Vec<double, 2>& position,
                               double bearing_rad) {
  { strobe.contains(position, position) } -> std::convertible_to<bool>;
  { strobe.half_angle_rad(position) } -> std::convertible_to<double>;
  { strobe.chord(position, bearing_rad) } -> std::convertible_to<StrobeChord>;
};

/// The ellipse dᵀ S⁻¹ d <= γ about the prediction: the gate of an estimator applied to the picture.
struct CovarianceStrobe {
  Mat<double, 2, 2> innovation_covariance_m2 =
      Mat<double, 2, 2>::Identity();                ///< S, north and east
  double threshold = ChiSquareGate{}.threshold(2);  ///< γ

  /// Throws `std::invalid_argument` unless S is symmetric positive definite and γ positive.
  void validate() const {
    if (check(Gaussian<2>{.covariance = innovation_covariance_m2}) != Status::kOk)
      reject("innovation_covariance_m2 must be finite, symmetric and positive definite");
    require_positive("threshold", threshold);
  }

  [[nodiscard]] bool contains(const Vec<double, 2>& predicted_m,
                              const Vec<double, 2>& point_m) const noexcept {
    const Cholesky<2> factor(innovation_covariance_m2);
    return factor.ok() && factor.squared_norm(point_m - predicted_m) <= threshold;
  }

  [[nodiscard]] double half_angle_rad(const Vec<double, 2>& predicted_m) const noexcept {
    if (!(determinant() > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    const Mat<double, 2, 2>& s = innovation_covariance_m2;
    const double range = predicted_m.norm();
    const Vec<double, 2> u = towards(std::atan2(predicted_m[1], predicted_m[0]));
    const Vec<double, 2> across(-u[1], u[0]);
    return half_angle_of_box(range, std::sqrt(threshold * u.dot(s * u)),
                             std::sqrt(threshold * across.dot(s * across)));
  }

  /// (ρ u - p)ᵀ S⁻¹ (ρ u - p) <= γ, solved for ρ.
  [[nodiscard]] StrobeChord chord(const Vec<double, 2>& predicted_m,
                                  double bearing_rad) const noexcept {
    const Mat<double, 2, 2>& s = innovation_covariance_m2;
    const double det = determinant();
    const Vec<double, 2> u = towards(bearing_rad);
    const Vec<double, 2> v(s(1, 1) * u[0] - s(1, 0) * u[1],  // det S S⁻¹ u
                           s(0, 0) * u[1] - s(1, 0) * u[0]);
    const double uv = u.dot(v);
    const double miss = predicted_m[0] * u[1] - predicted_m[1] * u[0];
    return StrobeChord::about(v.dot(predicted_m) / uv,
                              std::sqrt(det * (threshold * uv - miss * miss)) / uv);
  }

 private:
  [[nodiscard]] double determinant() const noexcept {
    const Mat<double, 2, 2>& s = innovation_covariance_m2;
    return s(0, 0) * s(1, 1) - s(1, 0) * s(1, 0);
  }
};

/// A window of range and bearing about the prediction, as in a plot extractor. A prediction at the
/// antenna has bearing north.
struct RangeBearingWindow {
  double range_half_m = 100.0;
  double bearing_half_rad = deg(1.0);

  static constexpr auto fields() noexcept {
    using R = RangeBearingWindow;
    return field_table(field("range_half_m", &R::range_half_m, kPositive, "m",
                             "Half the length of the window along range."),
                       field("bearing_half_rad", &R::bearing_half_rad, above_to(0, kPi<double>),
                             "rad", "Half the width of the window in bearing, at most pi."));
  }

  /// Throws `std::invalid_argument` unless both are finite and positive, the bearing at most pi.
  void validate() const { validate_fields(*this); }

  [[nodiscard]] bool contains(const Vec<double, 2>& predicted_m,
                              const Vec<double, 2>& point_m) const noexcept {
    return std::abs(point_m.norm() - predicted_m.norm()) <= range_half_m &&
           holds_bearing(predicted_m, std::atan2(point_m[1], point_m[0]));
  }

  [[nodiscard]] double half_angle_rad(const Vec<double, 2>&) const noexcept {
    return range_half_m >= 0.0 ? bearing_half_rad : std::numeric_limits<double>::quiet_NaN();
  }

  [[nodiscard]] StrobeChord chord(const Vec<double, 2>& predicted_m,
                                  double bearing_rad) const noexcept {
    if (!holds_bearing(predicted_m, bearing_rad)) return {};
    return StrobeChord::about(predicted_m.norm(), range_half_m);
  }

 private:
  [[nodiscard]] bool holds_bearing(const Vec<double, 2>& predicted_m,
                                   double bearing_rad) const noexcept {
    const double off = wrap_angle(bearing_rad - std::atan2(predicted_m[1], predicted_m[0]));
    return std::abs(off) <= bearing_half_rad;
  }
};

}  // namespace wakeline
