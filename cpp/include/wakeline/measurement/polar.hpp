// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/measurement/own_ship.hpp"
#include "wakeline/simd/scalar.hpp"

namespace wakeline {

/// Unit vector [north, east] in the direction of a bearing.
template <class Scalar>
Vec<Scalar, 2> towards(Scalar bearing_rad) noexcept {
  using std::cos, std::sin;
  return {cos(bearing_rad), sin(bearing_rad)};
}

/// Covariance with variance `along` (m²) in the direction `u` and `across` (m²) perpendicular to
/// it.
template <class Scalar>
Mat<Scalar, 2, 2> oriented_covariance(const Vec<Scalar, 2>& u, Scalar along,
                                      Scalar across) noexcept {
  const Scalar nn = along * u[0] * u[0] + across * u[1] * u[1];
  const Scalar ne = (along - across) * u[0] * u[1];
  const Scalar ee = along * u[1] * u[1] + across * u[0] * u[0];
  Mat<Scalar, 2, 2> covariance;
  covariance << nn, ne, ne, ee;
  return covariance;
}

/// Polar plot to north/east relative to the antenna, first order: [r cos b, r sin b], covariance
/// sr² along the bearing and (r sb)² across it. Source: Bar-Shalom, Li, Kirubarajan, 10.4.2; paper
/// A, equation (6).
template <class Scalar>
Gaussian<2, Scalar> convert_plain(Scalar range_m, Scalar bearing_rad, double range_var_m2,
                                  double bearing_var_rad2) noexcept {
  using Real = RealOf<Scalar>;
  const Vec<Scalar, 2> u = towards(bearing_rad);
  return {range_m * u,
          oriented_covariance<Scalar>(u, Scalar(Real(range_var_m2)),
                                      range_m * range_m * Scalar(Real(bearing_var_rad2)))};
}

/// exp(x) - 1 of what is the same from step to step. Unlike `std::expm1`, which sets `errno`, the
/// compiler takes it out of a loop.
[[gnu::const, gnu::noinline]] inline double expm1_of_constant(double x) noexcept {
  return std::expm1(x);
}

/// Unbiased conversion of a polar plot to north/east relative to the antenna: the plain point times
/// exp(sb²/2), with its exact mean covariance given the plot. Unlike the plain conversion its
/// variance across the bearing is positive at zero range. Source: M. Longbin, S. Xiaoquan, Z. Yiyu,
/// S. Z. Kang, Y. Bar-Shalom, "Unbiased converted measurements for tracking", IEEE Trans. AES-34,
/// 1998, equations (10) and (12), written along and across the bearing to avoid cancellation.
template <class Scalar>
Gaussian<2, Scalar> convert_unbiased(Scalar range_m, Scalar bearing_rad, double range_var_m2,
                                     double bearing_var_rad2) noexcept {
  const auto constant = [](double x) { return Scalar(RealOf<Scalar>(x)); };
  const Vec<Scalar, 2> u = towards(bearing_rad);
  const Scalar range2 = range_m * range_m;
  const double shrink = expm1_of_constant(-2 * bearing_var_rad2);  // exp(-2 sb²) - 1
  const Scalar along = range2 * constant(expm1_of_constant(bearing_var_rad2) + shrink / 2) +
                       constant(range_var_m2 * (1 + shrink / 2));
  const Scalar across = (range2 + constant(range_var_m2)) * constant(-shrink / 2);
  return {constant(1 + expm1_of_constant(bearing_var_rad2 / 2)) * range_m * u,
          oriented_covariance<Scalar>(u, along, across)};
}

/// r sb² / sr: twice the bias r sb² / 2 of the plain conversion, relative to the range error.
inline double conversion_bias_ratio(double range_m, double range_std_m,
                                    double bearing_std_rad) noexcept {
  return range_m * bearing_std_rad * bearing_std_rad / range_std_m;
}

/// True when the bias of the plain conversion is significant: r sb² / sr > 0.4. Source: Bar-Shalom,
/// Li, Kirubarajan, 10.4.3, equation (10.4.3-19).
inline bool conversion_bias_matters(double range_m, double range_std_m,
                                    double bearing_std_rad) noexcept {
  return conversion_bias_ratio(range_m, range_std_m, bearing_std_rad) > 0.4;
}

/// Errors of a radar measurement of range and bearing: of the radar, of the echo and of own ship.
///
/// The echo of a vessel moves about its hull with `extent_std_m` per axis, which adds to own ship's
/// position error; own ship's heading error adds to the bearing error. `bearing_offset_rad` is
/// measured minus true bearing.
struct PolarErrors {
  double range_std_m;
  double bearing_std_rad;
  double extent_std_m;
  double bearing_offset_rad;
  OwnShip own;

  /// Variance per axis (m²) independent of range: echo extent and own position.
  [[nodiscard]] double isotropic_variance_m2() const noexcept {
    return variance(kNotNegative, extent_std_m) + own.position_std_m * own.position_std_m;
  }

  [[nodiscard]] double range_variance_m2() const noexcept {
    return variance(kPositive, range_std_m);
  }

  /// Variance of the true bearing (rad²): radar and heading.
  [[nodiscard]] double bearing_variance_rad2() const noexcept {
    return variance(kAngleStd, bearing_std_rad) + own.heading_std_rad * own.heading_std_rad;
  }

  /// Plot `[range, bearing]` to north/east in the plane, with all errors.
  template <class Scalar>
  Gaussian<2, Scalar> position(Scalar range_m, Scalar bearing_rad, bool unbiased) const noexcept {
    const Scalar bearing = bearing_rad - Scalar(bearing_offset_rad);
    const double range_var = range_variance_m2();
    const double bearing_var = bearing_variance_rad2();
    Gaussian<2, Scalar> fix = unbiased ? convert_unbiased(range_m, bearing, range_var, bearing_var)
                                       : convert_plain(range_m, bearing, range_var, bearing_var);
    fix.mean += own.position<Scalar>();
    fix.covariance.diagonal().array() += Scalar(isotropic_variance_m2());
    return fix;
  }
};

/// The fields that every radar sensor has.
template <class Sensor>
constexpr auto radar_fields() noexcept {
  using S = Sensor;
  return field_table(
      field("range_std_m", &S::range_std_m, kPositive, "m", "Standard deviation of the range."),
      field("bearing_std_rad", &S::bearing_std_rad, kAngleStd, "rad",
            "Standard deviation of the bearing."),
      field("extent_std_m", &S::extent_std_m, kNotNegative, "m",
            "Standard deviation of the echo's position on the hull, per axis."),
      field("bearing_offset_rad", &S::bearing_offset_rad, kFinite, "rad",
            "Measured minus true bearing."),
      field("own", &S::own,
            "Position of the antenna, with its standard deviation and that of the heading."));
}

}  // namespace wakeline
