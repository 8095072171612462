// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/fields.hpp"
#include "wakeline/measurement/concept.hpp"

namespace wakeline {

/// A position `[north m, east m]` whose two axes have different errors.
struct NorthEast {
  static constexpr const char* kName = "NorthEast";
  static constexpr const char* kSummary = "A position [north m, east m], one error an axis.";
  static constexpr int kMeasurements = 2;
  static constexpr auto kReads = kPosition;
  static constexpr bool kLinear = true;

  double north_std_m = 10.0;
  double east_std_m = 10.0;

  static constexpr auto fields() noexcept {
    using N = NorthEast;
    return field_table(
        field("north_std_m", &N::north_std_m, kPositive, "m", "Standard deviation of the north."),
        field("east_std_m", &N::east_std_m, kPositive, "m", "Standard deviation of the east."));
  }

  template <class Scalar>
  Gaussian<2, Scalar> observe(const Vec<Scalar, 2>& z) const noexcept {
    Gaussian<2, Scalar> reading{z, Mat<Scalar, 2, 2>::Zero()};
    reading.covariance(0, 0) = Scalar(north_std_m * north_std_m);
    reading.covariance(1, 1) = Scalar(east_std_m * east_std_m);
    return reading;
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

  void validate() const { validate_fields(*this); }
};

}  // namespace wakeline
