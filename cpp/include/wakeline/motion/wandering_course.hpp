// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/fields.hpp"
#include "wakeline/motion/concept.hpp"
#include "wakeline/motion/pattern.hpp"
#include "wakeline/motion/process_noise.hpp"

namespace wakeline {

/// Density (m²/s³) of the acceleration caused by course wander at speed v (m/s): white noise of
/// density q on the turn rate accelerates the velocity with density q v². Speeds are limited to
/// `max_speed_mps`.
template <class Scalar>
Scalar course_wander_psd(double course_psd_rad2s, double max_speed_mps, Scalar vx,
                         Scalar vy) noexcept {
  const Scalar limit = Scalar(max_speed_mps * max_speed_mps);
  const Scalar speed2 = vx * vx + vy * vy;
  return Scalar(course_psd_rad2s) * select(speed2 < limit, speed2, limit);
}

/// Nearly constant velocity with noise that grows with the speed: state `[x, vx, y, vy]`, noise
/// density `psd_m2s3 + course_psd_rad2s v²` in every direction, so that one tuning serves both fast
/// boats, which turn hard, and slow ships.
struct WanderingCourse {
  static constexpr const char* kName = "WanderingCourse";
  static constexpr const char* kSummary =
      "Nearly constant velocity with course noise that grows with the speed: state [x, vx, y, vy].";
  static constexpr auto kComponents = kKinematics;
  static constexpr bool kForPacks = true;
  static constexpr Pattern<4> kPattern{"1x00 0100 001x 0001"};

  double psd_m2s3 = 0.01;
  double course_psd_rad2s = 0.01;
  double max_speed_mps = 30.0;

  static constexpr auto fields() noexcept {
    using W = WanderingCourse;
    return field_table(
        field("psd_m2s3", &W::psd_m2s3, kNotNegative, "m²/s³",
              "Power spectral density of the acceleration at rest."),
        field("course_psd_rad2s", &W::course_psd_rad2s, kNotNegative, "rad²/s",
              "Power spectral density of the course noise, which grows with the speed."),
        field("max_speed_mps", &W::max_speed_mps, kPositive, "m/s",
              "Speed up to which the course noise grows."));
  }

  /// f(x, dt).
  template <class Scalar>
  Vec<Scalar, 4> transition(const Vec<Scalar, 4>& x, Scalar dt_s) const noexcept {
    return {x[0] + dt_s * x[1], x[1], x[2] + dt_s * x[3], x[3]};
  }

  /// df/dx, 4 x 4.
  template <class Scalar>
  Mat<Scalar, 4, 4> jacobian(const Vec<Scalar, 4>&, Scalar dt_s) const noexcept {
    Mat<Scalar, 4, 4> f = Mat<Scalar, 4, 4>::Identity();
    f(0, 1) = f(2, 3) = dt_s;
    return f;
  }

  /// Q(x, dt), 4 x 4.
  template <class Scalar>
  Mat<Scalar, 4, 4> process_noise(const Vec<Scalar, 4>& x, Scalar dt_s) const noexcept {
    const Scalar density =
        Scalar(psd_m2s3) + course_wander_psd(course_psd_rad2s, max_speed_mps, x[1], x[3]);
    Mat<Scalar, 4, 4> q = Mat<Scalar, 4, 4>::Zero();
    q.template topLeftCorner<2, 2>() = q.template bottomRightCorner<2, 2>() =
        density * ProcessNoise(WhiteAcceleration{1.0}).of_velocity_axis(dt_s);
    return q;
  }

  void validate() const { validate_fields(*this); }
};

}  // namespace wakeline
