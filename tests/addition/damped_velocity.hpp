// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/core/fields.hpp"
#include "wakeline/motion/concept.hpp"
#include "wakeline/motion/process_noise.hpp"

namespace wakeline {

/// A velocity that decays: v' = v exp(-dt / T), x' = x + v T (1 - exp(-dt / T)).
struct DampedVelocity {
  static constexpr const char* kName = "DampedVelocity";
  static constexpr const char* kSummary = "Decaying velocity: state [x, vx, y, vy] (m, m/s).";
  static constexpr auto kComponents = kKinematics;

  double decay_time_s = 100.0;
  ProcessNoise noise = WhiteAcceleration{};

  static constexpr auto fields() noexcept {
    using D = DampedVelocity;
    return field_table(field("decay_time_s", &D::decay_time_s, kPositive, "s",
                             "Time in which the velocity falls to 1/e."),
                       field("noise", &D::noise, "Process noise."));
  }

  template <class Scalar>
  Mat<Scalar, 4, 4> matrix(Scalar dt_s) const noexcept {
    using std::exp;
    const Scalar kept = exp(-dt_s / Scalar(decay_time_s));
    Mat<Scalar, 4, 4> f = Mat<Scalar, 4, 4>::Identity();
    f(0, 1) = f(2, 3) = Scalar(decay_time_s) * (Scalar(1) - kept);
    f(1, 1) = f(3, 3) = kept;
    return f;
  }

  template <class Scalar>
  Mat<Scalar, 4, 4> process_noise(Scalar dt_s) const noexcept {
    Mat<Scalar, 4, 4> q = Mat<Scalar, 4, 4>::Zero();
    q.template topLeftCorner<2, 2>() = q.template bottomRightCorner<2, 2>() =
        noise.of_velocity_axis(dt_s);
    return q;
  }

  void validate() const {
    validate_fields(*this);
    noise.validate(false);
  }
};

}  // namespace wakeline
