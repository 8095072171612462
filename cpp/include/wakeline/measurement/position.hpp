// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/fields.hpp"
#include "wakeline/measurement/concept.hpp"

namespace wakeline {

/// A position `[north m, east m]` with the same error in every direction.
struct Position {
  static constexpr const char* kName = "Position";
  static constexpr const char* kSummary = "A position [north m, east m] with an isotropic error.";
  static constexpr int kMeasurements = 2;
  static constexpr auto kReads = kPosition;
  static constexpr bool kLinear = true;
  static constexpr bool kDirect = true;

  double position_std_m = 10.0;

  static constexpr auto fields() noexcept {
    using P = Position;
    return field_table(field("position_std_m", &P::position_std_m, kPositive, "m",
                             "Standard deviation of the position, per axis."));
  }

  template <class Scalar>
  Gaussian<2, Scalar> observe(const Vec<Scalar, 2>& z) const noexcept {
    return {z, Scalar(variance(kPositive, position_std_m)) * Mat<Scalar, 2, 2>::Identity()};
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
