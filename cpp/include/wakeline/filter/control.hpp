// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/component.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Gives a filter back what it was, in the lanes told.
template <class Filter>
void restore(Filter& filter, const Filter& before,
             const MaskOf<typename Filter::Scalar>& lanes) noexcept {
  if constexpr (kLanesOf<typename Filter::Scalar> == 1) {
    if (lanes) filter = before;
  } else if constexpr (requires { filter.assign_in(lanes, before); }) {
    filter.assign_in(lanes, before);
  } else {
    filter.assign_in(lanes, before.estimate());
  }
}

/// A known acceleration: of own ship, or commanded. It acts on a state that has moved already, x +=
/// G u, u = [north, east] (m/s²), and is constant during the step: G = [dt²/2; dt] per axis, and
/// [dt²/2; dt; 1] where the acceleration is a state. What a state does not hold is left out.
/// Source: paper A, equations (1)-(3).
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

  /// `filter.predict(dt_s)` under the acceleration; where that moves the state by what has no
  /// square, or is not finite, nothing changes.
  template <class Filter>
  static auto predict(Filter& filter, typename Filter::Scalar dt_s,
                      const Vec<typename Filter::Scalar, 2>& acceleration_mps2) noexcept {
    using Scalar = typename Filter::Scalar;
    const auto pushed = shift(Filter::kComponents, dt_s, acceleration_mps2);
    const Filter before = filter;
    StatusOf<Scalar> status = filter.predict(dt_s);
    if (none(ok(status))) return status;
    const decltype(pushed) moved = filter.mean() + pushed;
    assign_where(ok(status), filter.mean(), moved);
    const MaskOf<Scalar> squared = is_finite(moved) && has_squares(pushed);
    status = first_failure(status, ok_or(squared, Status::kNotFinite));
    if (!all(ok(status))) restore(filter, before, !ok(status));
    return status;
  }
};

}  // namespace wakeline
