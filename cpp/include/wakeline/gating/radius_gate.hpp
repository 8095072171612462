// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/gating/strobe_chord.hpp"
#include "wakeline/measurement/polar.hpp"

namespace wakeline {

/// A circular gate of fixed radius about a predicted position, as used for tentative tracks; on
/// radar video a strobe.
struct RadiusGate {
  double radius_m = 100.0;

  static constexpr auto fields() noexcept {
    using R = RadiusGate;
    return field_table(
        field("radius_m", &R::radius_m, kPositive, "m", "Radius about the predicted position."));
  }

  /// Throws `std::invalid_argument` unless the radius is finite and positive.
  void validate() const { validate_fields(*this); }

  /// True when |plot - predicted| <= radius_m; both [north, east] in metres. False for NaN.
  template <class Scalar>
  [[nodiscard]] auto contains(const Vec<Scalar, 2>& predicted_m,
                              const Vec<Scalar, 2>& plot_m) const noexcept {
    const Scalar radius = static_cast<Scalar>(radius_m);
    return (plot_m - predicted_m).squaredNorm() <= radius * radius;
  }

  /// Half the angle that the gate subtends at the antenna, rad; NaN when the radius is negative or
  /// NaN.
  [[nodiscard]] double half_angle_rad(const Vec<double, 2>& predicted_m) const noexcept {
    return half_angle_of_box(predicted_m.norm(), radius_m, radius_m);
  }

  /// The part of the ray from the antenna at `bearing_rad` inside the gate: |ρ u - p| <= r.
  [[nodiscard]] StrobeChord chord(const Vec<double, 2>& predicted_m,
                                  double bearing_rad) const noexcept {
    const Vec<double, 2> u = towards(bearing_rad);
    const double miss =
        predicted_m[0] * u[1] - predicted_m[1] * u[0];  // distance of the ray from the centre
    return StrobeChord::about(u.dot(predicted_m), std::sqrt(radius_m * radius_m - miss * miss));
  }

  /// π r², in square metres.
  [[nodiscard]] double area_m2() const noexcept { return kPi<double> * radius_m * radius_m; }
};

}  // namespace wakeline
