// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace wakeline {

/// Has the processor fetch an object into its cache, ahead of the first use.
template <class Object>
inline void prefetch(const Object& object) noexcept {
  constexpr std::size_t kLine = 64;  // bytes of the cache
  const auto* bytes = reinterpret_cast<const std::byte*>(&object);
  for (std::size_t k = 0; k < sizeof(Object); k += kLine) __builtin_prefetch(bytes + k);
}

}  // namespace wakeline
