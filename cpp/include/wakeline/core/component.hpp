// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/environment.hpp"

#include <array>
#include <cstddef>

namespace wakeline {

/// The quantity in a row of a state vector. A sensor names the components that it reads, a motion
/// model those of its state; user-defined components start at `kUser`.
enum class Component : int {
  kNorth,     ///< x, m
  kVnorth,    ///< vx, m/s
  kAnorth,    ///< ax, m/s²
  kEast,      ///< y, m
  kVeast,     ///< vy, m/s
  kAeast,     ///< ay, m/s²
  kTurnRate,  ///< omega, rad/s, positive to starboard
  kUser = 100,
};

/// Position and velocity `[x, vx, y, vy]`, which every vessel model has.
inline constexpr std::array kKinematics{Component::kNorth, Component::kVnorth, Component::kEast,
                                        Component::kVeast};

/// Position `[x, y]`.
inline constexpr std::array kPosition{Component::kNorth, Component::kEast};

/// Row of `component` in a state laid out as `components`, or -1.
template <std::size_t N>
constexpr int index_of(const std::array<Component, N>& components, Component component) noexcept {
  for (std::size_t k = 0; k < N; ++k)
    if (components[k] == component) return static_cast<int>(k);
  return -1;
}

/// Rows of a state, indexed as Eigen indexes.
template <std::size_t N>
struct Rows {
  int row[N];
  constexpr int operator[](int k) const noexcept { return row[k]; }
};

/// Row of each `wanted` component in a state laid out as `components`; -1 for a missing one.
template <std::size_t N, std::size_t M>
constexpr Rows<M> rows_of(const std::array<Component, N>& components,
                          const std::array<Component, M>& wanted) noexcept {
  Rows<M> rows{};
  for (std::size_t k = 0; k < M; ++k) rows.row[k] = index_of(components, wanted[k]);
  return rows;
}

/// True when a state laid out as `components` has all of `wanted`.
template <std::size_t N, std::size_t M>
constexpr bool holds(const std::array<Component, N>& components,
                     const std::array<Component, M>& wanted) noexcept {
  for (const Component component : wanted)
    if (index_of(components, component) < 0) return false;
  return true;
}

/// True when no component occurs twice.
template <std::size_t N>
constexpr bool differ(const std::array<Component, N>& components) noexcept {
  for (std::size_t k = 0; k < N; ++k)
    if (index_of(components, components[k]) != static_cast<int>(k)) return false;
  return true;
}

}  // namespace wakeline
