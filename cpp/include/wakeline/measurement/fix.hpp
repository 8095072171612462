// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/measurement/concept.hpp"

namespace wakeline {

/// A position `[north m, east m]` with its own covariance: a converted plot or a GNSS fix.
struct Fix {
  static constexpr int kMeasurements = 2;
  static constexpr auto kReads = kPosition;
  static constexpr bool kLinear = true;
  static constexpr bool kDirect = true;

  Mat<double, 2, 2> covariance_m2 = Mat<double, 2, 2>::Identity();

  template <class Scalar>
  Gaussian<2, Scalar> observe(const Vec<Scalar, 2>& z) const noexcept {
    return {z, covariance_m2.cast<Scalar>()};
  }

  template <class Scalar>
  Vec<Scalar, 2> measure(const Vec<Scalar, 2>& position) const noexcept {
    return position;
  }

  template <class Scalar>
  Mat<Scalar, 2, 2> jacobian(const Vec<Scalar, 2>&) const noexcept {
    return Mat<Scalar, 2, 2>::Identity();
  }

  template <class Scalar>
  Vec<Scalar, 2> residual(const Vec<Scalar, 2>& a, const Vec<Scalar, 2>& b) const noexcept {
    return a - b;
  }

  template <class Scalar>
  Gaussian<2, Scalar> position(const Vec<Scalar, 2>& z) const noexcept {
    return observe(z);
  }
};

}  // namespace wakeline
