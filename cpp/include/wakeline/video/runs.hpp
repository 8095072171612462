// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "wakeline/video/kernels.hpp"

namespace wakeline::detail {

/// Calls `visit(first, last)` for every run of consecutive cells above their thresholds.
template <class Amplitude, class Visit>
void for_each_run(std::span<const Amplitude> amplitude, const Amplitude* threshold,
                  Visit&& visit) noexcept {
  const int cells = static_cast<int>(amplitude.size());
  int open = -1;  // first cell of a run that reaches the end of the block before
  for (int base = 0; base < cells; base += kBlock) {
    const Amplitude* a = amplitude.data() + base;
    std::uint64_t bits = cells - base >= kBlock ? exceeding(a, threshold + base)
                                                : exceeding(a, threshold + base, cells - base);
    if (open >= 0) {
      if (bits == ~std::uint64_t{0}) continue;
      visit(open, base + std::countr_one(bits) - 1);
      open = -1;
      bits &= bits + 1;
    }
    while (bits != 0) {
      const int first = std::countr_zero(bits);
      const std::uint64_t after = bits + (std::uint64_t{1} << first);  // 0: the run continues
      if (after == 0) {
        open = base + first;
        break;
      }
      visit(base + first, base + std::countr_zero(after & ~bits) - 1);
      bits &= after;
    }
  }
  if (open >= 0) visit(open, cells - 1);
}

}  // namespace wakeline::detail
