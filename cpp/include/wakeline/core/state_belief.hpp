// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <type_traits>

#include "wakeline/core/component.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// A Gaussian belief with the component that each of its rows holds.
template <auto Components, class Scalar>
struct StateBelief : Gaussian<static_cast<int>(Components.size()), Scalar> {
  static constexpr auto kComponents = Components;
  static constexpr int kStates = static_cast<int>(Components.size());

  [[gnu::always_inline]] StateBelief& operator=(const Gaussian<kStates, Scalar>& belief) noexcept {
    copy<kStates, Scalar>(belief, *this);
    return *this;
  }
};

/// The same as a reference to the belief inside a filter.
template <auto Components, class Scalar>
struct BeliefView {
  static constexpr auto kComponents = Components;
  static constexpr int kStates = static_cast<int>(Components.size());
  const Vec<Scalar, kStates>& mean;
  const Mat<Scalar, kStates, kStates>& covariance;
};

/// Zero mean and covariance over the same components.
template <auto Components, class Scalar>
StateBelief<Components, Scalar> zero_like(const StateBelief<Components, Scalar>&) noexcept {
  StateBelief<Components, Scalar> zero;
  zero.mean.setZero();
  zero.covariance.setZero();
  return zero;
}

/// The marginal of a belief, whose rows hold `Components`, over the components `Wanted`. The lower
/// triangle of the covariance is read.
template <auto Wanted, auto Components, class BeliefType>
auto marginal(const BeliefType& belief) noexcept {
  static_assert(holds(Components, Wanted),
                "wakeline: this state does not hold position and velocity");
  using Scalar = typename std::remove_cvref_t<decltype(belief.mean)>::Scalar;
  constexpr int kN = static_cast<int>(Wanted.size());
  constexpr auto kRows = rows_of(Components, Wanted);
  Gaussian<kN, Scalar> part;
  for (int i = 0; i < kN; ++i) {
    part.mean[i] = belief.mean[kRows[i]];
    for (int j = 0; j < kN; ++j)
      part.covariance(i, j) =
          belief.covariance(std::max(kRows[i], kRows[j]), std::min(kRows[i], kRows[j]));
  }
  return part;
}

/// Position and velocity, `[x, vx, y, vy]`, of a belief that names its components.
template <class BeliefType>
requires requires { BeliefType::kComponents; }
auto kinematics_of(const BeliefType& belief) noexcept {
  return marginal<kKinematics, BeliefType::kComponents>(belief);
}

/// Position, [north, east], of a belief that names its components or has a `kinematics_of`.
template <class BeliefType>
auto position_of(const BeliefType& belief) noexcept {
  if constexpr (requires { BeliefType::kComponents; })
    return marginal<kPosition, BeliefType::kComponents>(belief);
  else
    return marginal<kPosition, kKinematics>(kinematics_of(belief));
}

}  // namespace wakeline
