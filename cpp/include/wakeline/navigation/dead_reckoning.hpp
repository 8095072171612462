// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Dead reckoning: prediction of a vessel's position from its present motion.
//
// Source: I. M. Hannoshyna, T. V. Kalinichenko, P. V. Nikitin, Research of methods of forecasting
// the movement, search and tracking of sea objects; equations (1)-(11) in their corrected form, see
// cpp/docs/theory/dead_reckoning.md.
#pragma once

#include <cmath>
#include <span>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/navigation/geodesy.hpp"

namespace wakeline {

/// A velocity as speed and course.
struct SpeedCourse {
  double speed_mps = 0.0;
  double course_rad = 0.0;  ///< direction of motion, clockwise from true north

  /// From [north, east] m/s, course in 0 .. 2 pi.
  static SpeedCourse of(const Vec<double, 2>& velocity_mps) noexcept {
    return {std::hypot(velocity_mps[0], velocity_mps[1]),
            compass_angle(std::atan2(velocity_mps[1], velocity_mps[0]))};
  }

  /// [north, east] m/s.
  [[nodiscard]] Vec<double, 2> velocity_mps() const noexcept {
    return speed_mps * Vec<double, 2>(std::cos(course_rad), std::sin(course_rad));
  }
};

// Vectors: position, velocity, acceleration -------------------------------------------------------

/// (1): p + v t.
template <class Scalar>
Vec<Scalar, 2> predict_position_m(const Vec<Scalar, 2>& position_m,
                                  const Vec<Scalar, 2>& velocity_mps, Scalar dt_s) noexcept {
  return position_m + velocity_mps * dt_s;
}

/// (2): p + v t + a t² / 2.
template <class Scalar>
Vec<Scalar, 2> predict_position_m(const Vec<Scalar, 2>& position_m,
                                  const Vec<Scalar, 2>& velocity_mps,
                                  const Vec<Scalar, 2>& acceleration_mps2, Scalar dt_s) noexcept {
  return position_m + (velocity_mps + acceleration_mps2 * (dt_s / 2)) * dt_s;
}

/// The components of a vessel's drift, [north, east] m/s.
struct TotalDrift {
  Vec<double, 2> wind_drift_mps = Vec<double, 2>::Zero();  ///< leeway
  Vec<double, 2> current_mps = Vec<double, 2>::Zero();     ///< of tide, wind and waves
  Vec<double, 2> residual_mps = Vec<double, 2>::Zero();    ///< the remaining, unexplained part

  [[nodiscard]] Vec<double, 2> velocity_mps() const noexcept {
    return wind_drift_mps + current_mps + residual_mps;
  }
};

/// (3), and (4) for accelerations: motion over ground is motion through the water plus drift, as
/// vectors.
template <class Scalar>
Vec<Scalar, 2> over_ground(const Vec<Scalar, 2>& through_water,
                           const Vec<Scalar, 2>& drift) noexcept {
  return through_water + drift;
}

// One quantity at a time --------------------------------------------------------------------------

/// (5): speed under an acceleration along the course.
inline double predict_speed_mps(double speed_mps, double acceleration_mps2, double dt_s) noexcept {
  return speed_mps + acceleration_mps2 * dt_s;
}

/// (5), (10): K + w t + a t² / 2 with turn rate w and its derivative a, in 0 .. 2 pi.
inline double predict_course_rad(double course_rad, double turn_rate_rad_s, double dt_s,
                                 double turn_acceleration_rad_s2 = 0.0) noexcept {
  return compass_angle(course_rad +
                       (turn_rate_rad_s + turn_acceleration_rad_s2 * (dt_s / 2)) * dt_s);
}

/// (6); not valid across a pole.
inline double predict_latitude_rad(double latitude_rad, double rate_rad_s, double dt_s) noexcept {
  return latitude_rad + rate_rad_s * dt_s;
}

/// (6), in -pi .. pi.
inline double predict_longitude_rad(double longitude_rad, double rate_rad_s, double dt_s) noexcept {
  return wrap_angle(longitude_rad + rate_rad_s * dt_s);
}

/// (9).
inline double predict_turn_rate_rad_s(double turn_rate_rad_s, double turn_acceleration_rad_s2,
                                      double dt_s) noexcept {
  return turn_rate_rad_s + turn_acceleration_rad_s2 * dt_s;
}

// Over ground -------------------------------------------------------------------------------------

/// An observed position and its time.
struct TimedPlace {
  double time_s = 0.0;
  GeoPoint place;
};

/// (7): velocity over ground [north, east] m/s of a vessel on a rhumb line, by least squares
/// through its first position in a window:
///     V_N = sum(t dN) / sum(t²),  V_E = sum(t dE) / sum(t²).
/// NaN unless there are two different times.
inline Vec<double, 2> velocity_over_window_mps(std::span<const TimedPlace> window) noexcept {
  Vec<double, 2> moment = Vec<double, 2>::Zero();
  double time_squared = 0.0;
  for (const TimedPlace& at : window) {
    const double t = at.time_s - window.front().time_s;
    const GeoLine run = rhumb_line(window.front().place, at.place);
    moment += t * SpeedCourse{run.distance_m, run.course_rad}.velocity_mps();
    time_squared += t * t;
  }
  return moment / time_squared;
}

/// (8): velocity [north, east] m/s from the rates of latitude and longitude, on the ellipsoid.
inline Vec<double, 2> velocity_from_rates_mps(double latitude_rate_rad_s,
                                              double longitude_rate_rad_s,
                                              double latitude_rad) noexcept {
  return {latitude_rate_rad_s * meridian_radius_m(latitude_rad),
          longitude_rate_rad_s * prime_vertical_radius_m(latitude_rad) * std::cos(latitude_rad)};
}

/// (11): combined dead reckoning with speed, course and drift, in mid-latitude:
///     dlat = (V cos K + Vc cos Kc) t / M,  dlon = (V sin K + Vc sin Kc) t / (N cos(mid-latitude)),
/// M and N the radii of the ellipsoid (on the sphere of nautical miles both are one minute of arc
/// per mile). Within 0.1 m of the rhumb line over 20 km up to 70 degrees; not for use at a pole.
inline GeoPoint dead_reckon(const GeoPoint& from, const SpeedCourse& ship, const SpeedCourse& drift,
                            double dt_s) noexcept {
  const Vec<double, 2> run = dt_s * over_ground(ship.velocity_mps(), drift.velocity_mps());
  const double nearly_half = run[0] / (2 * meridian_radius_m(from.latitude_rad));
  const double dlat = run[0] / meridian_radius_m(from.latitude_rad + nearly_half);
  const double middle = from.latitude_rad + dlat / 2;
  const double dlon = run[1] / (prime_vertical_radius_m(middle) * std::cos(middle));
  return {from.latitude_rad + dlat, wrap_angle(from.longitude_rad + dlon)};
}

}  // namespace wakeline
