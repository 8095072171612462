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

/// Variance (rad²) of the direction in which an antenna sees a target at d with covariance P: that
/// across the line of sight over d², d not zero.
inline double direction_variance_rad2(const Vec<double, 2>& d,
                                      const Mat<double, 2, 2>& p) noexcept {
  const double square = d.squaredNorm();
  const Vec<double, 2> across(-d[1], d[0]);
  return across.dot(p * across) / (square * square);
}

/// atan2(y, x), by its series where it is below 0.2, to 1e-9.
inline double small_angle(double y, double x) noexcept {
  if (!(std::fabs(y) < 0.2 * x)) return std::atan2(y, x);
  const double t = y / x, tt = t * t;
  return t * (1.0 - tt * (1.0 / 3 - tt * (1.0 / 5 - tt * (1.0 / 7 - tt * (1.0 / 9 - tt / 11)))));
}

/// The errors of an unbiased converted plot, by where its target is predicted.
///
/// The covariance of such a plot depends on the bearing. Evaluated at the bearing as read it is
/// correlated with the error of that, which pulls estimates outwards by about r sb² (7 m at 24 km
/// with 1 degree); evaluated at the prediction it is not. With d ~ N(m, P) the target relative to
/// the antenna and M = E[d dᵀ] = m mᵀ + P,
///
///     R = sinh(sb²) (tr M + sr²) I - (1 - exp(-sb²)) M + exp(-sb²) sr² M / tr M + se² I
///
/// is the mean over the prediction of the exact covariance (in the third term, of its factors).
/// Source: S. V. Bordonaro, P. Willett, Y. Bar-Shalom, "Decorrelated unbiased converted measurement
/// Kalman filter", IEEE Trans. AES-50, 2014, written without angles.
struct ConvertedErrors {
  double range_var_m2 = 0.0;
  double spread = 0.0;           ///< exp(sb²) - 1
  double isotropic_m2 = 0.0;     ///< se²
  double range_bearing_m = 0.0;  ///< covariance of range and bearing, m rad
  double antenna_north_m = 0.0;
  double antenna_east_m = 0.0;

  /// The plot as read (north/east) beside the prediction of its target: with its covariance there,
  /// and moved outwards by r s²/2, with the standard deviation s of the direction after the update,
  /// s² = p sb² / (p + sb²) for the variance p of the predicted one, because the target is on
  /// average so much less far along the line of sight. Where p > 4 sb² the plot knows the direction
  /// better: with the covariance as read, at the range as read (`PolarErrors::start_position`).
  template <class Scalar>
  [[gnu::always_inline]] Gaussian<2, Scalar> at(const Gaussian<2, Scalar>& reading,
                                                const Gaussian<2, Scalar>& target) const noexcept {
    constexpr double kLeast_m2 = 1e-6, kVague = 4.0;
    const double shrink = spread / (1.0 + spread);  // 1 - exp(-sb²)
    const double turned = (spread + shrink) / 2.0;  // sinh(sb²)
    const Mat<Scalar, 2, 2>& p = target.covariance;
    const Scalar x = target.mean[0] - Scalar(antenna_north_m);
    const Scalar y = target.mean[1] - Scalar(antenna_east_m);
    const Scalar xx = x * x + p(0, 0), xy = x * y + p(1, 0), yy = y * y + p(1, 1);
    const Scalar square = at_least(xx + yy, Scalar(kLeast_m2));
    const Scalar inverse = reciprocal(square);
    const Scalar isotropic = Scalar(turned) * square + Scalar(turned * range_var_m2 + isotropic_m2);
    const Scalar along = Scalar((1.0 - shrink) * range_var_m2) * inverse - Scalar(shrink);
    const Scalar across_m4 = x * x * p(1, 1) + y * y * p(0, 0) - Scalar(2) * x * y * p(1, 0);
    const Scalar distance2 = x * x + y * y;
    const auto known = across_m4 <= Scalar(kVague * spread) * distance2 * distance2;
    const Scalar outwards =
        Scalar(0.5 * spread) * across_m4 * reciprocal(across_m4 + Scalar(spread) * square * square);
    const Scalar inwards = Scalar(1.0 / std::sqrt(1.0 + spread) - 1.0);
    Scalar nn = isotropic + along * xx, ne = along * xy, ee = isotropic + along * yy;
    if (range_bearing_m != 0.0) {
      const Scalar common = Scalar(range_bearing_m) * inverse_sqrt(square);
      nn -= Scalar(2) * common * x * y;
      ne += common * (x * x - y * y);
      ee += Scalar(2) * common * x * y;
    }
    const Mat<Scalar, 2, 2>& r = reading.covariance;
    Gaussian<2, Scalar> plot;
    const Scalar read_x = reading.mean[0] - Scalar(antenna_north_m);
    const Scalar read_y = reading.mean[1] - Scalar(antenna_east_m);
    plot.mean << reading.mean[0] + select(known, outwards * x, inwards * read_x),
        reading.mean[1] + select(known, outwards * y, inwards * read_y);
    plot.covariance(0, 0) = select(known, nn, r(0, 0));
    plot.covariance(1, 1) = select(known, ee, r(1, 1));
    plot.covariance(1, 0) = plot.covariance(0, 1) = select(known, ne, r(1, 0));
    return plot;
  }

  /// The same along the line of sight and across it, for a target whose direction is known: range
  /// and bearing keep their own errors, so that one that is many standard deviations off in bearing
  /// is none off in range. With the bearing δ from the predicted direction, whose standard
  /// deviation is s, and K = s² / (s² + sb²)
  ///
  ///     along = r (1 - K² δ²/2), variance sr² + r² s⁴ (1 - K²)/2;  across = r δ, variance r² sb²
  ///
  /// to second order: an update that moves the target across by r K δ leaves it on its circle. By
  /// `at` where s is above 0.1 rad or 2 sb.
  [[nodiscard]] Gaussian<2> in_sight(const Gaussian<2>& reading,
                                     const Gaussian<2>& target) const noexcept {
    constexpr double kStraight_rad2 = 0.01;
    const Vec<double, 2> antenna(antenna_north_m, antenna_east_m);
    const Vec<double, 2> d = target.mean - antenna;
    const double square = d.squaredNorm();
    const double s2 = direction_variance_rad2(d, target.covariance);
    if (!(s2 <= std::min(kStraight_rad2, 4.0 * spread))) return at(reading, target);
    const Vec<double, 2> u = d / std::sqrt(square), across(-u[1], u[0]);
    const Vec<double, 2> seen = reading.mean - antenna;
    const double range_m = std::sqrt(seen.squaredNorm() / (1.0 + spread));
    const double apart_rad = small_angle(across.dot(seen), u.dot(seen));
    const double gain = s2 / (s2 + spread);
    const double bent = range_m * s2;
    const double along_m2 = range_var_m2 + bent * bent * (1.0 - gain * gain) / 2.0;
    const double turned = gain * apart_rad;
    Gaussian<2> plot{antenna + range_m * ((1.0 - turned * turned / 2.0) * u + apart_rad * across),
                     oriented_covariance<double>(u, along_m2, range_m * range_m * spread)};
    plot.covariance.diagonal().array() += isotropic_m2;
    const double common_m2 = range_m * range_bearing_m;
    plot.covariance += common_m2 * (u * across.transpose() + across * u.transpose());
    return plot;
  }
};

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

  /// The same errors of a plot converted without bias.
  [[nodiscard]] ConvertedErrors converted() const noexcept {
    return {range_variance_m2(),
            std::expm1(bearing_variance_rad2()),
            isotropic_variance_m2(),
            0.0,
            own.north_m,
            own.east_m};
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

  /// The same for an estimate that starts with the plot: at the range as read, r exp(-sb²/2) (the
  /// mean of a target about the plot) moved outwards by r sb²/2 as `ConvertedErrors::at` does.
  template <class Scalar>
  Gaussian<2, Scalar> start_position(Scalar range_m, Scalar bearing_rad,
                                     bool unbiased) const noexcept {
    Gaussian<2, Scalar> start = position(range_m, bearing_rad, unbiased);
    start.mean = own.position<Scalar>() +
                 range_m * towards(Scalar(bearing_rad - Scalar(bearing_offset_rad)));
    return start;
  }
};

/// The fields of a sensor of bearings.
template <class Sensor>
constexpr auto bearing_fields() noexcept {
  using S = Sensor;
  return field_table(
      field("bearing_std_rad", &S::bearing_std_rad, kAngleStd, "rad",
            "Standard deviation of the bearing."),
      field("extent_std_m", &S::extent_std_m, kNotNegative, "m",
            "Standard deviation of the echo's position on the hull, per axis."),
      field("bearing_offset_rad", &S::bearing_offset_rad, kFinite, "rad",
            "Measured minus true bearing."),
      field("own", &S::own,
            "Position of the antenna, with its standard deviation and that of the heading."));
}

/// The fields that every radar sensor has.
template <class Sensor>
constexpr auto radar_fields() noexcept {
  using S = Sensor;
  return field_table(
      field("range_std_m", &S::range_std_m, kPositive, "m", "Standard deviation of the range."),
      bearing_fields<S>());
}

}  // namespace wakeline
