// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>

#include "wakeline/catalog/type_list.hpp"
#include "wakeline/motion/concept.hpp"
#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/singer.hpp"
#include "wakeline/motion/wandering_course.hpp"

namespace wakeline {

/// The motion models that can be chosen at run time. A new one is its header and a line here.
using Motions = TypeList<ConstantVelocity, WanderingCourse, ConstantAcceleration, CoordinatedTurn,
                         CoordinatedTurnRate, Singer>;

/// One of them.
using AnyMotion = AsVariant<Motions>;

template <class Motion>
struct IsLinear : std::bool_constant<LinearMotionModel<Motion>> {};

/// One of those that are linear.
using AnyLinearMotion = AsVariant<Selected<IsLinear, Motions>>;

/// The greatest number of states among the motion models.
inline constexpr int kMaxStates = []<class... Motion>(TypeList<Motion...>) {
  return std::max({4, kStatesOf<Motion>...});
}(Motions{});

/// What each row of a state of one of the motion models holds.
struct StateRows {
  int states = 0;
  std::array<Component, static_cast<std::size_t>(kMaxStates)> components = {};

  template <std::size_t N>
  static constexpr StateRows of(const std::array<Component, N>& components) noexcept {
    StateRows rows{.states = static_cast<int>(N)};
    std::copy(components.begin(), components.end(), rows.components.begin());
    return rows;
  }
  [[nodiscard]] constexpr int row_of(Component component) const noexcept {
    for (int i = 0; i < states; ++i)
      if (components[static_cast<std::size_t>(i)] == component) return i;
    return -1;
  }
  constexpr bool operator==(const StateRows&) const = default;
};

/// The state layouts of the motion models: 0 is `[x, vx, y, vy]`.
enum class StateLayout : std::uint8_t { kKinematics };

struct StateLayouts {
  int count = 0;
  std::array<StateRows, static_cast<std::size_t>(Motions::kSize + 1)> rows = {};
};

inline constexpr StateLayouts kStateLayouts = [] {
  StateLayouts layouts;
  const auto add = [&](const StateRows& rows) {
    const auto end = layouts.rows.begin() + layouts.count;
    if (std::find(layouts.rows.begin(), end, rows) == end)
      layouts.rows[static_cast<std::size_t>(layouts.count++)] = rows;
  };
  add(StateRows::of(kKinematics));
  Motions::for_each(
      [&]<class Motion>(std::type_identity<Motion>) { add(StateRows::of(Motion::kComponents)); });
  return layouts;
}();

constexpr const StateRows& rows_of(StateLayout layout) noexcept {
  return kStateLayouts.rows[static_cast<std::size_t>(layout)];
}

constexpr int states_of(StateLayout layout) noexcept { return rows_of(layout).states; }

/// The layout of one of the motion models.
template <class Motion>
inline constexpr StateLayout kLayoutOf = [] {
  constexpr StateRows kRows = StateRows::of(Motion::kComponents);
  int layout = 0;
  while (layout < kStateLayouts.count && rows_of(StateLayout(layout)) != kRows) ++layout;
  return StateLayout(layout);
}();

}  // namespace wakeline
