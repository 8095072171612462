// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <type_traits>

#include "wakeline/catalog/type_list.hpp"
#include "wakeline/core/require.hpp"
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

/// The greatest number of states of a motion model that is chosen at run time, or made then.
inline constexpr int kMaxStates = []<class... Motion>(TypeList<Motion...>) {
  return std::max({9, kStatesOf<Motion>...});
}(Motions{});

/// Room for as many: an even number, so that Eigen aligns vectors and matrices of it.
inline constexpr int kStateRoom = kMaxStates + kMaxStates % 2;

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

/// The state layouts of the motion models: 0 is `[x, vx, y, vy]`. Models made at run time have
/// others; see `CustomLayouts`.
enum class StateLayout : std::uint8_t { kKinematics };

/// The layouts of all motion models, each once.
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

/// The layouts of models made at run time, which follow those of the catalogue.
class CustomLayouts {
 public:
  static constexpr int kMost = 64;

  /// The layout with these rows, added if it is new. Throws `std::invalid_argument` when there are
  /// `kMost` others.
  static StateLayout of(const StateRows& rows) {
    for (int k = 0; k < kStateLayouts.count; ++k)
      if (kStateLayouts.rows[static_cast<std::size_t>(k)] == rows) return StateLayout(k);
    Table& all = table();
    const std::lock_guard hold(all.mutex);
    const int count = all.count;
    const auto end = all.rows.begin() + count;
    const auto found = std::find(all.rows.begin(), end, rows);
    const auto layout = StateLayout(kStateLayouts.count + (found - all.rows.begin()));
    if (found != end) return layout;
    if (count == kMost)
      reject("custom motion models must have at most " + std::to_string(kMost) +
             " different states in one program");
    *found = rows;
    all.count = count + 1;
    return layout;
  }

  static const StateRows& rows(StateLayout layout) noexcept {
    return table().rows[static_cast<std::size_t>(static_cast<int>(layout) - kStateLayouts.count)];
  }

 private:
  struct Table {
    std::mutex mutex;
    int count = 0;
    std::array<StateRows, static_cast<std::size_t>(kMost)> rows = {};
  };
  static Table& table() noexcept {
    static Table all;
    return all;
  }
};

/// True for the layout of a motion model of the catalogue.
constexpr bool is_of_catalog(StateLayout layout) noexcept {
  return static_cast<int>(layout) < kStateLayouts.count;
}

/// The components of a layout, in their order.
constexpr const StateRows& rows_of(StateLayout layout) noexcept {
  return is_of_catalog(layout) ? kStateLayouts.rows[static_cast<std::size_t>(layout)]
                               : CustomLayouts::rows(layout);
}

/// The number of components of a layout.
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
