// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Course and time by which a search unit meets a moving object.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Least time t in which a unit of speed u meets an object at p + v t relative to where the unit is
/// now: |p + v t| = u t. Errors are of first order in the state of the object.
struct Intercept {
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  bool found = false;  ///< false where the object outruns the unit or a number is not finite; the
                       ///< rest is then NaN
  double time_s = kNaN;
  double course_rad = kNaN;  ///< 0 .. 2 pi clockwise from north
  double time_std_s = kNaN;
  double course_std_rad = kNaN;
  Gaussian<2> position_m{Vec<double, 2>::Constant(kNaN),
                         Mat<double, 2, 2>::Constant(kNaN)};  ///< of the object at that time

  /// `object` over [x, vx, y, vy] in the plane of north and east, `unit_m` in that plane.
  static Intercept of(const Gaussian<4>& object, const Vec<double, 2>& unit_m,
                      double speed_mps) noexcept {
    using Vec2 = Vec<double, 2>;
    const Vec2 start(object.mean[0], object.mean[2]), v(object.mean[1], object.mean[3]);
    const Vec2 p = start - unit_m;
    const double u2 = speed_mps * speed_mps;
    // (v² - u²) t² + 2 p·v t + p² = 0, for the least positive t, without cancellation.
    const double a = v.squaredNorm() - u2, half_b = p.dot(v), c = p.squaredNorm();
    const double discriminant = half_b * half_b - a * c;
    Intercept result;
    if (!(discriminant >= 0.0) || !std::isfinite(discriminant)) return result;
    const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    const double nowhere = std::numeric_limits<double>::infinity();
    double t = c > 0.0 ? nowhere : 0.0;
    for (const double root : {q / a, c / q})
      if (root > 0.0) t = std::min(t, root);
    if (!(t < nowhere)) return result;
    const Vec2 way = p + t * v;
    Mat<double, 2, 4> at_time = Mat<double, 2, 4>::Zero();
    at_time(0, 0) = at_time(1, 2) = 1.0;
    at_time(0, 1) = at_time(1, 3) = t;
    result.found = true;
    result.time_s = t;
    result.course_rad = compass_angle(std::atan2(way[1], way[0]));
    result.position_m = {start + t * v, at_time * object.covariance * at_time.transpose()};
    // f = |way|² - u² t²: dt = -way·d / (way·v - u² t), d the error of the object at t.
    const double slope = way.dot(v) - u2 * t;
    const Eigen::Matrix<double, 1, 2> by_time = -way.transpose() / slope;
    const Vec2 abeam(-way[1], way[0]);
    const Eigen::Matrix<double, 1, 2> by_course =
        (abeam.transpose() + abeam.dot(v) * by_time) / way.squaredNorm();
    const auto std_of = [&](const Eigen::Matrix<double, 1, 2>& by) {
      return std::sqrt(std::max(0.0, (by * result.position_m.covariance * by.transpose()).value()));
    };
    result.time_std_s = std_of(by_time);
    result.course_std_rad = std_of(by_course);
    return result;
  }
};

}  // namespace wakeline
