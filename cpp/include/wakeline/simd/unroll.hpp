// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

namespace wakeline {

/// An integer known at compile time.
template <int I>
struct Index {
  static constexpr int value = I;
  constexpr operator int() const noexcept { return I; }  // NOLINT(google-explicit-constructor)
};

/// Calls `f(Index<0>{})` to `f(Index<N - 1>{})` without a loop, so that small matrices stay in
/// registers.
template <int N, class Function>
[[gnu::always_inline]] constexpr void unroll(const Function& function) noexcept {
  [&]<int... I>(std::integer_sequence<int, I...>) { (function(Index<I>{}), ...); }
  (std::make_integer_sequence<int, N>{});
}

/// Calls `f(row, column)` for each element of the lower triangle of an N x N matrix, column by
/// column.
template <int N, class Function>
[[gnu::always_inline]] constexpr void unroll_lower(const Function& function) noexcept {
  unroll<N>([&](auto column) {
    unroll<N - column.value>(
        [&](auto below) { function(Index<column.value + below.value>{}, column); });
  });
}

}  // namespace wakeline
