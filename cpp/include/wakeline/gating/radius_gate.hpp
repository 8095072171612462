// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/angle.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// A circular gate of fixed radius around a predicted position, as the trial-track stage of a
/// console uses it.
struct RadiusGate {
  double radius_m = 100.0;

  /// Throws `std::invalid_argument` unless the radius is finite and positive.
  void validate() const { require_positive("radius_m", radius_m); }

  /// Whether |plot - predicted| <= radius_m; both [north, east] in metres. A position that is not a
  /// number is outside.
  template <class Scalar>
  [[nodiscard]] auto contains(const Vec<Scalar, 2>& predicted_m,
                              const Vec<Scalar, 2>& plot_m) const noexcept {
    const Scalar radius = static_cast<Scalar>(radius_m);
    return (plot_m - predicted_m).squaredNorm() <= radius * radius;
  }

  /// π r², in square metres.
  [[nodiscard]] double area_m2() const noexcept { return kPi<double> * radius_m * radius_m; }
};

}  // namespace wakeline
