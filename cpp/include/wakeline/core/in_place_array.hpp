// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <new>
#include <span>
#include <type_traits>

namespace wakeline {

/// Room for N values, each of which is made where it stays: what hot steps return is neither
/// preceded by defaults nor copied.
template <class T, std::size_t N>
class InPlaceArray {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  InPlaceArray() noexcept {}

  /// Where value k is to be made, by a placement new.
  [[nodiscard]] void* place(auto k) noexcept { return &values_[static_cast<std::size_t>(k)]; }

  /// The first `count` values, all of which have been made.
  [[nodiscard]] std::span<const T> first(std::size_t count) const noexcept {
    return {values_.data(), count};
  }

 private:
  union {
    std::array<T, N> values_;
  };
};

}  // namespace wakeline
