// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/component.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// A known acceleration: of own ship, or commanded. It is added after the motion, x += G u, u =
/// [north, east] (m/s²), constant during the step: G = [dt²/2; dt] per axis, and [dt²/2; dt; 1]
/// where the acceleration is a state. Components that the state does not have are skipped. Source:
/// paper A, equations (1)-(3).
struct Control {
  /// G u, one row for each component.
  template <class Scalar, std::size_t N>
  static Vec<Scalar, static_cast<int>(N)> shift(const std::array<Component, N>& components,
                                                Scalar dt_s,
                                                const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    Vec<Scalar, static_cast<int>(N)> shift = Vec<Scalar, static_cast<int>(N)>::Zero();
    const Scalar gain[] = {dt_s * dt_s / 2, dt_s, Scalar(1)};
    const Component rows[2][3] = {{Component::kNorth, Component::kVnorth, Component::kAnorth},
                                  {Component::kEast, Component::kVeast, Component::kAeast}};
    for (int axis = 0; axis < 2; ++axis)
      for (int order = 0; order < 3; ++order)
        if (const int row = index_of(components, rows[axis][order]); row >= 0)
          shift[row] = gain[order] * acceleration_mps2[axis];
    return shift;
  }

  /// `filter.predict(dt_s)`, then x += G u. An acceleration that is not `in_range` gives
  /// `kNotFinite` and changes nothing.
  template <class Filter>
  static auto predict(Filter& filter, typename Filter::Scalar dt_s,
                      const Vec<typename Filter::Scalar, 2>& acceleration_mps2) noexcept {
    using Scalar = typename Filter::Scalar;
    constexpr auto kNan = std::numeric_limits<RealOf<Scalar>>::quiet_NaN();
    const StatusOf<Scalar> status =
        filter.predict(select(in_range(acceleration_mps2), dt_s, Scalar(kNan)));
    if (none(ok(status))) return status;
    const auto moved = (filter.mean() + shift(Filter::kComponents, dt_s, acceleration_mps2)).eval();
    assign_where(ok(status), filter.mean(), moved);
    return status;
  }
};

}  // namespace wakeline
