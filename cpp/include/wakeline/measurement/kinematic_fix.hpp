// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/measurement/concept.hpp"

namespace wakeline {

/// Position and velocity `[north m, north m/s, east m, east m/s]` with their own covariance: what a
/// vessel reports of itself.
struct KinematicFix {
  static constexpr int kMeasurements = 4;
  static constexpr auto kReads = kKinematics;
  static constexpr bool kLinear = true;
  static constexpr bool kDirect = true;

  Mat<double, 4, 4> covariance = Mat<double, 4, 4>::Identity();

  template <class Scalar>
  Gaussian<4, Scalar> observe(const Vec<Scalar, 4>& z) const noexcept {
    return {z, covariance.cast<Scalar>()};
  }

  template <class Scalar>
  Vec<Scalar, 4> measure(const Vec<Scalar, 4>& kinematics) const noexcept {
    return kinematics;
  }

  template <class Scalar>
  Mat<Scalar, 4, 4> jacobian(const Vec<Scalar, 4>&) const noexcept {
    return Mat<Scalar, 4, 4>::Identity();
  }

  template <class Scalar>
  Vec<Scalar, 4> residual(const Vec<Scalar, 4>& a, const Vec<Scalar, 4>& b) const noexcept {
    return a - b;
  }
};

}  // namespace wakeline
