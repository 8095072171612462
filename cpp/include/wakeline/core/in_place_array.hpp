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

  /// Value k is what `make()` returns.
  template <class Make>
  [[gnu::always_inline]] void make(std::size_t k, const Make& make) noexcept {
    ::new (static_cast<void*>(&values_[k])) T(make());
  }

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
