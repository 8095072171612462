// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The three loops over every cell of every sweep, in portable form and, for 8 bits, with the vector
// instructions of every 64-bit x86. Both give the same bits.
#pragma once

#include "wakeline/core/environment.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace wakeline::detail {

#ifdef __SSE2__
template <class Number>
[[nodiscard]] __m128i load(const Number* from) noexcept {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
}
template <class Number>
void store(Number* to, __m128i lanes) noexcept {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), lanes);
}
#endif

/// sums[i] = a_0 + … + a_{i-1} for i = 0 … N, modulo the range of Sum.
template <class Amplitude, class Sum>
void running_sums(std::span<const Amplitude> amplitude, Sum* __restrict sums) noexcept {
  const Amplitude* __restrict a = amplitude.data();
  const std::size_t cells = amplitude.size();
  std::size_t i = 0;
  Sum sum = sums[0] = 0;
#ifdef __SSE2__
  if constexpr (sizeof(Amplitude) == 1 && sizeof(Sum) == 2) {
    // Eight lanes are summed in three steps of doubling distance; then the previous sum is added.
    __m128i before = _mm_setzero_si128();
    const auto add_up = [&](__m128i lanes) noexcept {
      lanes = _mm_add_epi16(lanes, _mm_slli_si128(lanes, 2));
      lanes = _mm_add_epi16(lanes, _mm_slli_si128(lanes, 4));
      lanes = _mm_add_epi16(lanes, _mm_slli_si128(lanes, 8));
      const __m128i all = _mm_shuffle_epi32(_mm_shufflehi_epi16(lanes, 0xFF), 0xFF);
      lanes = _mm_add_epi16(lanes, before);
      before = _mm_add_epi16(before, all);
      return lanes;
    };
    for (; i + 16 <= cells; i += 16) {
      const __m128i zero = _mm_setzero_si128();
      const __m128i bytes = load(a + i);
      store(sums + i + 1, add_up(_mm_unpacklo_epi8(bytes, zero)));
      store(sums + i + 9, add_up(_mm_unpackhi_epi8(bytes, zero)));
    }
    sum = sums[i];
  }
#endif
  for (; i < cells; ++i) sums[i + 1] = sum = static_cast<Sum>(sum + a[i]);
}

/// Thresholds from running sums over two windows of `train` cells, the second of which starts
/// `ahead` cells after the first,
///
///     threshold[i] = clamp(weight (sums[i + train] - sums[i] +
///                                  sums[i + ahead + train] - sums[i + ahead]) / 2^16,
///                          floor, largest amplitude).
template <class Amplitude, class Sum, class Product>
void mean_thresholds(const Sum* __restrict sums, int train, int ahead, std::uint16_t weight,
                     Amplitude floor, int cells, Amplitude* __restrict threshold) noexcept {
  const Sum* __restrict end = sums + train;
  const Sum* __restrict second = sums + ahead;
  const Sum* __restrict second_end = second + train;
  int i = 0;
#ifdef __SSE2__
  if constexpr (sizeof(Amplitude) == 1 && sizeof(Sum) == 2) {
    const __m128i weights = _mm_set1_epi16(static_cast<short>(weight));
    const __m128i floors = _mm_set1_epi8(static_cast<char>(floor));
    const auto levels = [&](int at) noexcept {
      const __m128i first_window = _mm_sub_epi16(load(end + at), load(sums + at));
      const __m128i second_window = _mm_sub_epi16(load(second_end + at), load(second + at));
      const __m128i level = _mm_mulhi_epu16(_mm_add_epi16(first_window, second_window), weights);
      return _mm_sub_epi16(level, _mm_subs_epu16(level, _mm_set1_epi16(255)));
    };
    for (; i + 16 <= cells; i += 16)
      store(threshold + i, _mm_max_epu8(_mm_packus_epi16(levels(i), levels(i + 8)), floors));
  }
#endif
  for (; i < cells; ++i) {
    const auto sum = static_cast<Sum>(end[i] - sums[i] + second_end[i] - second[i]);
    const auto level = static_cast<Sum>(Product{sum} * weight >> 16);
    threshold[i] = std::max(
        static_cast<Amplitude>(std::min<Sum>(level, std::numeric_limits<Amplitude>::max())), floor);
  }
}

inline constexpr int kBlock = 64;

/// Bit i is set when amplitude i exceeds threshold i; at most 64 cells.
template <class Amplitude>
[[nodiscard]] std::uint64_t exceeding(const Amplitude* amplitude, const Amplitude* threshold,
                                      int cells) noexcept {
  std::uint64_t bits = 0;
  for (int i = 0; i < cells; ++i) bits |= std::uint64_t{amplitude[i] > threshold[i]} << i;
  return bits;
}

/// The same for 64 cells.
template <class Amplitude>
[[nodiscard]] std::uint64_t exceeding(const Amplitude* amplitude,
                                      const Amplitude* threshold) noexcept {
#ifdef __SSE2__
  // Bytes of ones where the amplitude does not exceed the threshold: their difference saturates at
  // 0.
  const auto below = [&](int i) noexcept {
    const __m128i zero = _mm_setzero_si128();
    if constexpr (sizeof(Amplitude) == 1) {
      return _mm_cmpeq_epi8(_mm_subs_epu8(load(amplitude + i), load(threshold + i)), zero);
    } else {
      const __m128i low = _mm_subs_epu16(load(amplitude + i), load(threshold + i));
      const __m128i high = _mm_subs_epu16(load(amplitude + i + 8), load(threshold + i + 8));
      return _mm_packs_epi16(_mm_cmpeq_epi16(low, zero), _mm_cmpeq_epi16(high, zero));
    }
  };
  std::uint64_t bits = 0;
  for (int i = 0; i < kBlock; i += 16)
    bits |= std::uint64_t{static_cast<std::uint16_t>(_mm_movemask_epi8(below(i)))} << i;
  return ~bits;
#else
  bool any = false;  // most blocks are empty, and compilers vectorise this loop
  for (int i = 0; i < kBlock; ++i) any |= amplitude[i] > threshold[i];
  return any ? exceeding(amplitude, threshold, kBlock) : 0;
#endif
}

}  // namespace wakeline::detail
