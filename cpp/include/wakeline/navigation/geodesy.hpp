// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Positions on the WGS84 ellipsoid, the shortest line between them (geodesic) and the line of
// constant course (rhumb line).
#pragma once

#include <cmath>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

inline constexpr double kEquatorialRadius_m = 6378137.0;
inline constexpr double kFlattening = 1.0 / 298.257223563;
inline constexpr double kEccentricitySquared = kFlattening * (2.0 - kFlattening);
inline constexpr double kPolarRadius_m = kEquatorialRadius_m * (1.0 - kFlattening);

/// A position at sea level, radians; longitude positive to the east.
struct GeoPoint {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;

  /// Throws `std::invalid_argument` when it is not on the earth.
  void validate() const {
    require(std::abs(latitude_rad) <= kPi<double> / 2, "latitude_rad", "from -pi/2 to pi/2",
            latitude_rad);
    require_finite("longitude_rad", longitude_rad);
  }
};

/// Distance and courses between two positions along a geodesic or a rhumb line.
struct GeoLine {
  double distance_m = NAN;
  double course_rad = NAN;  ///< at departure, 0 .. 2 pi clockwise from true north
  double arrival_course_rad =
      NAN;             ///< at the destination; equal to that at departure on a rhumb line
  bool found = false;  ///< false where the series does not converge or an input is not finite; the
                       ///< rest is then NaN
};

// The ellipsoid -----------------------------------------------------------------------------------

/// M, the radius of curvature along the meridian: dnorth = M dlatitude.
inline double meridian_radius_m(double latitude_rad) noexcept {
  const double s = std::sin(latitude_rad);
  const double w2 = 1.0 - kEccentricitySquared * s * s;
  return kEquatorialRadius_m * (1.0 - kEccentricitySquared) / (w2 * std::sqrt(w2));
}

/// N, the radius of curvature across the meridian: deast = N cos(latitude) dlongitude.
inline double prime_vertical_radius_m(double latitude_rad) noexcept {
  const double s = std::sin(latitude_rad);
  return kEquatorialRadius_m / std::sqrt(1.0 - kEccentricitySquared * s * s);
}

/// Distance along the meridian from the equator, positive to the north; within 1 micrometre.
/// Source: F. R. Helmert's series in n = f / (2 - f), to n⁴.
inline double meridian_arc_m(double latitude_rad) noexcept {
  constexpr double n = kFlattening / (2.0 - kFlattening);
  constexpr double n2 = n * n;
  const double p = latitude_rad;
  return kEquatorialRadius_m / (1.0 + n) *
         ((1.0 + n2 / 4 + n2 * n2 / 64) * p - (3.0 / 2) * n * (1.0 - n2 / 8) * std::sin(2 * p) +
          (15.0 / 16) * n2 * (1.0 - n2 / 4) * std::sin(4 * p) -
          (35.0 / 48) * n2 * n * std::sin(6 * p) + (315.0 / 512) * n2 * n2 * std::sin(8 * p));
}

/// The latitude at this distance along the meridian from the equator.
inline double latitude_of_meridian_arc_rad(double arc_m) noexcept {
  constexpr double n = kFlattening / (2.0 - kFlattening);
  constexpr double n2 = n * n;
  constexpr double mean_radius_m = kEquatorialRadius_m / (1.0 + n) * (1.0 + n2 / 4 + n2 * n2 / 64);
  const double m = arc_m / mean_radius_m;
  return m + (3.0 / 2 - 27.0 / 32 * n2) * n * std::sin(2 * m) +
         (21.0 / 16 - 55.0 / 32 * n2) * n2 * std::sin(4 * m) +
         (151.0 / 96) * n2 * n * std::sin(6 * m) + (1097.0 / 512) * n2 * n2 * std::sin(8 * m);
}

/// The ordinate of the Mercator projection, in which a rhumb line is straight: psi = asinh(tan
/// latitude) - e atanh(e sin latitude).
inline double isometric_latitude_rad(double latitude_rad) noexcept {
  const double e = std::sqrt(kEccentricitySquared);
  return std::asinh(std::tan(latitude_rad)) - e * std::atanh(e * std::sin(latitude_rad));
}

// The rhumb line ----------------------------------------------------------------------------------

namespace detail {

inline bool is_pole(double latitude_rad) noexcept {
  return kPi<double> / 2 - std::abs(latitude_rad) < 1e-12;
}

/// Metres of meridian arc per radian of isometric latitude between two latitudes: the mean of N
/// cos(latitude). Simpson's rule for near ones, where the difference quotient would cancel.
inline double metres_per_isometric_rad(double from_rad, double to_rad) noexcept {
  const double middle = (from_rad + to_rad) / 2;
  if (std::abs(to_rad - from_rad) > 1e-3 * std::cos(middle))
    return (meridian_arc_m(to_rad) - meridian_arc_m(from_rad)) /
           (isometric_latitude_rad(to_rad) - isometric_latitude_rad(from_rad));
  const auto arc = [](double p) { return meridian_radius_m(p); };
  const auto isometric = [](double p) {
    return meridian_radius_m(p) / (prime_vertical_radius_m(p) * std::cos(p));
  };
  return (arc(from_rad) + 4 * arc(middle) + arc(to_rad)) /
         (isometric(from_rad) + 4 * isometric(middle) + isometric(to_rad));
}

}  // namespace detail

/// Distance and course of the rhumb line, the shorter way round. At a pole, where the longitude is
/// undefined, it is the meridian.
inline GeoLine rhumb_line(const GeoPoint& from, const GeoPoint& to) noexcept {
  const bool along_meridian =
      detail::is_pole(from.latitude_rad) || detail::is_pole(to.latitude_rad);
  const double q = detail::metres_per_isometric_rad(from.latitude_rad, to.latitude_rad);
  const double north = meridian_arc_m(to.latitude_rad) - meridian_arc_m(from.latitude_rad);
  const double east = along_meridian ? 0.0 : q * wrap_angle(to.longitude_rad - from.longitude_rad);
  const double course = compass_angle(std::atan2(east, north));
  const double distance = std::hypot(north, east);
  if (!std::isfinite(distance)) return {};
  return {distance, course, course, true};
}

/// Destination of a rhumb line. NaN when it would pass a pole, around which it spirals without end.
inline GeoPoint rhumb_destination(const GeoPoint& from, double course_rad,
                                  double distance_m) noexcept {
  const double arc = meridian_arc_m(from.latitude_rad) + distance_m * std::cos(course_rad);
  const double latitude = latitude_of_meridian_arc_rad(arc);
  if (!(std::abs(latitude) <= kPi<double> / 2)) return {NAN, NAN};
  const double q = detail::metres_per_isometric_rad(from.latitude_rad, latitude);
  return {latitude, wrap_angle(from.longitude_rad + distance_m * std::sin(course_rad) / q)};
}

// The geodesic ------------------------------------------------------------------------------------

namespace detail {

/// The auxiliary sphere of a geodesic that crosses the equator at an azimuth alpha: series for
/// distance and longitude. Source: T. Vincenty, Direct and inverse solutions of geodesics on the
/// ellipsoid, Survey Review XXIII 176, 1975, with the coefficients of his note of 1976.
struct Vincenty {
  double sin_alpha = 0.0;
  double cos2_alpha = 1.0;

  /// Coefficients A, B of the distance.
  double a = 1.0;
  double b = 0.0;

  explicit Vincenty(double sin_alpha_) noexcept
      : sin_alpha(sin_alpha_), cos2_alpha(1.0 - sin_alpha_ * sin_alpha_) {
    constexpr double ep2 = kEccentricitySquared / (1.0 - kEccentricitySquared);
    const double root = std::sqrt(1.0 + ep2 * cos2_alpha);
    const double k1 = (root - 1.0) / (root + 1.0);
    a = (1.0 + k1 * k1 / 4) / (1.0 - k1);
    b = k1 * (1.0 - 3.0 / 8 * k1 * k1);
  }

  /// Distance over A b minus the arc `sigma`; `m` is the cosine of twice the arc from the equator
  /// to its middle.
  [[nodiscard]] double excess(double sin_sigma, double cos_sigma, double m) const noexcept {
    return b * sin_sigma *
           (m + b / 4 *
                    (cos_sigma * (2 * m * m - 1) -
                     b / 6 * m * (4 * sin_sigma * sin_sigma - 3) * (4 * m * m - 3)));
  }

  /// Longitude on the sphere minus that on the ellipsoid.
  [[nodiscard]] double longitude_excess(double sigma, double sin_sigma, double cos_sigma,
                                        double m) const noexcept {
    constexpr double f = kFlattening;
    const double c = f / 16 * cos2_alpha * (4 + f * (4 - 3 * cos2_alpha));
    return (1 - c) * f * sin_alpha *
           (sigma + c * sin_sigma * (m + c * cos_sigma * (2 * m * m - 1)));
  }
};

/// Sine and cosine of the latitude on the auxiliary sphere.
struct ReducedLatitude {
  double sine;
  double cosine;

  explicit ReducedLatitude(double latitude_rad) noexcept
      : sine((1.0 - kFlattening) * std::sin(latitude_rad)), cosine(std::cos(latitude_rad)) {
    const double norm = std::hypot(sine, cosine);
    sine /= norm;
    cosine /= norm;
  }
};

inline constexpr int kMaxVincentySteps = 200;
inline constexpr double kVincentyTolerance_rad = 1e-14;

}  // namespace detail

/// Distance and courses of the shortest line between two positions, within 0.1 mm.
///
/// Vincenty's iteration. It does not converge, and returns `found` = false, for nearly antipodal
/// positions (within about 0.7 degrees).
inline GeoLine geodesic(const GeoPoint& from, const GeoPoint& to) noexcept {
  const detail::ReducedLatitude u1(from.latitude_rad), u2(to.latitude_rad);
  const double longitude = wrap_angle(to.longitude_rad - from.longitude_rad);
  double lambda = longitude;  // difference in longitude on the auxiliary sphere
  for (int step = 0; step < detail::kMaxVincentySteps; ++step) {
    const double sin_lambda = std::sin(lambda), cos_lambda = std::cos(lambda);
    const double across = u2.cosine * sin_lambda;
    const double along = u1.cosine * u2.sine - u1.sine * u2.cosine * cos_lambda;
    const double sin_sigma = std::hypot(across, along);
    const double cos_sigma = u1.sine * u2.sine + u1.cosine * u2.cosine * cos_lambda;
    if (sin_sigma == 0.0 && cos_sigma > 0.0) return {0.0, 0.0, 0.0, true};
    const double sigma = std::atan2(sin_sigma, cos_sigma);
    const detail::Vincenty series(u1.cosine * u2.cosine * sin_lambda / sin_sigma);
    const double m = series.cos2_alpha > 1e-15
                         ? cos_sigma - 2 * u1.sine * u2.sine / series.cos2_alpha
                         : 0.0;  // along the equator
    const double next = longitude + series.longitude_excess(sigma, sin_sigma, cos_sigma, m);
    if (!(std::abs(next) <= kPi<double>)) return {};
    const bool settled = std::abs(next - lambda) <= detail::kVincentyTolerance_rad;
    lambda = next;
    if (!settled) continue;
    const double distance =
        kPolarRadius_m * series.a * (sigma - series.excess(sin_sigma, cos_sigma, m));
    const double arrival =
        std::atan2(u1.cosine * sin_lambda, u1.cosine * u2.sine * cos_lambda - u1.sine * u2.cosine);
    return {distance, compass_angle(std::atan2(across, along)), compass_angle(arrival), true};
  }
  return {};
}

/// Destination of a geodesic, within 0.1 mm; `course_rad` is that at departure.
inline GeoPoint geodesic_destination(const GeoPoint& from, double course_rad,
                                     double distance_m) noexcept {
  const detail::ReducedLatitude u1(from.latitude_rad);
  const double sin_course = std::sin(course_rad), cos_course = std::cos(course_rad);
  const detail::Vincenty series(u1.cosine * sin_course);
  const double sigma1 = std::atan2(u1.sine, u1.cosine * cos_course);
  const double whole = distance_m / (kPolarRadius_m * series.a);
  double sigma = whole;
  double sin_sigma = 0.0, cos_sigma = 1.0, m = 0.0;
  for (int step = 0; step < detail::kMaxVincentySteps; ++step) {
    m = std::cos(2 * sigma1 + sigma);
    sin_sigma = std::sin(sigma);
    cos_sigma = std::cos(sigma);
    const double next = whole + series.excess(sin_sigma, cos_sigma, m);
    const bool settled = std::abs(next - sigma) <= detail::kVincentyTolerance_rad;
    sigma = next;
    if (settled) break;
  }
  const double down = u1.sine * sin_sigma - u1.cosine * cos_sigma * cos_course;
  const double latitude = std::atan2(u1.sine * cos_sigma + u1.cosine * sin_sigma * cos_course,
                                     (1.0 - kFlattening) * std::hypot(series.sin_alpha, down));
  const double lambda =
      std::atan2(sin_sigma * sin_course, u1.cosine * cos_sigma - u1.sine * sin_sigma * cos_course);
  return {latitude, wrap_angle(from.longitude_rad + lambda -
                               series.longitude_excess(sigma, sin_sigma, cos_sigma, m))};
}

// The plane ---------------------------------------------------------------------------------------

/// The plane of north and east about a reference: distance and course from it along the geodesic,
/// as polar coordinates (the azimuthal equidistant projection).
///
/// Distances and directions from the reference are accurate to 0.1 mm wherever `geodesic`
/// converges. Across, at a distance d, the plane is stretched by d² / (6 R²): 1e-5 at 50 km, 4e-5
/// at 100 km.
class LocalPlane {
 public:
  /// Throws `std::invalid_argument` when the reference is not on the earth.
  explicit LocalPlane(const GeoPoint& reference) : reference_(reference) { reference.validate(); }

  [[nodiscard]] const GeoPoint& reference() const noexcept { return reference_; }

  /// North and east of a position, m; NaN near the antipode.
  [[nodiscard]] Vec<double, 2> position_m(const GeoPoint& place) const noexcept {
    const GeoLine line = geodesic(reference_, place);
    return {line.distance_m * std::cos(line.course_rad),
            line.distance_m * std::sin(line.course_rad)};
  }

  /// The position at [north, east] m.
  [[nodiscard]] GeoPoint place(const Vec<double, 2>& position_m) const noexcept {
    return geodesic_destination(reference_, std::atan2(position_m[1], position_m[0]),
                                std::hypot(position_m[0], position_m[1]));
  }

  /// The direction on the plane of a true course at a position: meridians converge.
  [[nodiscard]] double plane_course_rad(double true_course_rad,
                                        const GeoPoint& place) const noexcept {
    const GeoLine line = geodesic(reference_, place);
    return compass_angle(true_course_rad + line.course_rad - line.arrival_course_rad);
  }

  /// The true course at a position of a direction on the plane.
  [[nodiscard]] double true_course_rad(double plane_course_rad,
                                       const GeoPoint& place) const noexcept {
    const GeoLine line = geodesic(reference_, place);
    return compass_angle(plane_course_rad - line.course_rad + line.arrival_course_rad);
  }

 private:
  GeoPoint reference_;
};

}  // namespace wakeline
