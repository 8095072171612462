// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/environment.hpp"

namespace wakeline {

/// An integer known at compile time.
template <int I>
struct Index {
  static constexpr int value = I;
  constexpr operator int() const noexcept { return I; }  // NOLINT(google-explicit-constructor)
};

/// Calls `f(Index<0>{})` to `f(Index<N - 1>{})` without a loop, so that small matrices stay in
/// registers. Written out, because a pack of indices costs the compiler three templates per use.
template <int N, int First = 0, class Function>
[[gnu::always_inline]] constexpr void unroll(const Function& function) noexcept {
  if constexpr (First < N) function(Index<First>{});
  if constexpr (First + 1 < N) function(Index<First + 1>{});
  if constexpr (First + 2 < N) function(Index<First + 2>{});
  if constexpr (First + 3 < N) function(Index<First + 3>{});
  if constexpr (First + 4 < N) function(Index<First + 4>{});
  if constexpr (First + 5 < N) function(Index<First + 5>{});
  if constexpr (First + 6 < N) unroll<N, First + 6>(function);
}

/// Calls `f(row, column)` for each element of the lower triangle of an N x N matrix, column by
/// column.
template <int N, int Column = 0, int Row = Column, class Function>
[[gnu::always_inline]] constexpr void unroll_lower(const Function& function) noexcept {
  if constexpr (Row < N) function(Index<Row>{}, Index<Column>{});
  if constexpr (Row + 1 < N) function(Index<Row + 1>{}, Index<Column>{});
  if constexpr (Row + 2 < N) function(Index<Row + 2>{}, Index<Column>{});
  if constexpr (Row + 3 < N) function(Index<Row + 3>{}, Index<Column>{});
  if constexpr (Row + 4 < N)
    unroll_lower<N, Column, Row + 4>(function);
  else if constexpr (Column + 1 < N)
    unroll_lower<N, Column + 1>(function);
}

}  // namespace wakeline
