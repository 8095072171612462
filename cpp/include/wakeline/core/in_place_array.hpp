// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/environment.hpp"

#include <array>
#include <cstddef>
#include <new>
#include <span>
#include <type_traits>

namespace wakeline {

/// Storage for N values that are constructed in place, so that hot steps neither default-construct
/// nor copy them.
template <class T, std::size_t N>
class InPlaceArray {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  InPlaceArray() noexcept {}

  /// Address of value k, for placement new.
  [[nodiscard]] void* place(auto k) noexcept { return &values_[static_cast<std::size_t>(k)]; }

  /// The first `count` values, all of which must have been constructed.
  [[nodiscard]] std::span<const T> first(std::size_t count) const noexcept {
    return {values_.data(), count};
  }

 private:
  union {
    std::array<T, N> values_;
  };
};

}  // namespace wakeline
