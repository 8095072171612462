// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

#include "wakeline/simd/scalar.hpp"

namespace wakeline {

/// Calls `f(k)` for each bit k that is set.
template <class Function>
void for_each_bit(unsigned bits, const Function& function) noexcept {
  for (; bits != 0; bits &= bits - 1) function(std::countr_zero(bits));
}

/// Writes the places of the entries with a positive weight, largest first, and returns their
/// number. `weights[r - begin]` are those of row r.
template <class Lanes>
int weightiest_first(std::span<const Lanes> weights, int begin, std::span<int> places) noexcept {
  constexpr int kLanes = kLanesOf<Lanes>;
  int count = 0;
  for (std::size_t r = 0; r < weights.size(); ++r)
    for_each_bit(bits_of(weights[r] > Lanes(0)), [&](int k) {
      const Lanes own = lane(weights[r], k);
      int before =
          std::popcount(bits_of(weights[r] > own) | (bits_of(weights[r] == own) & ((1u << k) - 1)));
      for (std::size_t q = 0; q < r; ++q) before += std::popcount(bits_of(weights[q] >= own));
      for (std::size_t q = r + 1; q < weights.size(); ++q)
        before += std::popcount(bits_of(weights[q] > own));
      places[static_cast<std::size_t>(before)] = (begin + static_cast<int>(r)) * kLanes + k;
      ++count;
    });
  return count;
}

/// Selects the most probable of many items, up to a capacity, without storing them all. Items are
/// presented twice: first to be counted by the size of their probability, then, after `cut`, to be
/// added; only those of the last size class are sorted. Ties keep the first.
template <class Item>
class Likeliest {
 public:
  using Scalar = decltype(Item::probability);

  explicit Likeliest(std::span<Item> room) noexcept : room_(room) {}

  void count(Scalar probability, int times) noexcept { of_size_[size_of(probability)] += times; }

  void cut() noexcept {
    std::size_t size = 0;
    const auto of = [this](std::size_t k) { return static_cast<std::size_t>(of_size_[k]); };
    for (; size + 1 < kSizes && larger_ + of(size) < room_.size(); ++size) larger_ += of(size);
    least_ = size + 1 < kSizes ? least_of(size) : Scalar(0);
    sure_ = size > 0 ? least_of(size - 1) : std::numeric_limits<Scalar>::infinity();
    count_ = larger_;
  }

  /// Less probable items need not be added.
  [[nodiscard]] Scalar least() const noexcept { return least_; }

  void add(const Item& item) noexcept {
    if (item.probability < sure_)
      add_to_last(item);
    else if (sure_count_ < larger_)
      room_[sure_count_++] = item;
  }

  [[nodiscard]] std::span<Item> items() const noexcept { return room_.first(count_); }

 private:
  using Bits = std::conditional_t<sizeof(Scalar) == 8, std::uint64_t, std::uint32_t>;
  static_assert(sizeof(Bits) == sizeof(Scalar));
  // Size classes from 1 down in eighths of a power of two: the exponent and three bits. The last
  // class has all smaller ones.
  static constexpr int kDropped = std::numeric_limits<Scalar>::digits - 1 - 3;
  static constexpr Bits kOne = std::bit_cast<Bits>(Scalar(1)) >> kDropped;
  static constexpr std::size_t kSizes = 256;

  static std::size_t size_of(Scalar probability) noexcept {
    return std::min<std::size_t>(kOne - (std::bit_cast<Bits>(probability) >> kDropped), kSizes - 1);
  }
  static Scalar least_of(std::size_t size) noexcept {
    return std::bit_cast<Scalar>((kOne - static_cast<Bits>(size)) << kDropped);
  }

  /// Adds to the last class, most probable first.
  void add_to_last(const Item& item) noexcept {
    const std::span<Item> last = items().subspan(larger_);
    const auto likelier = [](const Item& a, const Item& b) {
      return a.probability > b.probability;
    };
    const auto place = std::upper_bound(last.begin(), last.end(), item, likelier);
    if (count_ < room_.size())
      ++count_;
    else if (place == last.end())
      return;
    std::shift_right(place, items().end(), 1);
    *place = item;
  }

  std::span<Item> room_;
  std::array<int, kSizes> of_size_{};
  Scalar least_ = Scalar(0);
  Scalar sure_ = Scalar(0);     ///< items at least this probable are certain to be kept
  std::size_t larger_ = 0;      ///< number of items in classes above the last
  std::size_t sure_count_ = 0;  ///< number of these added so far
  std::size_t count_ = 0;
};

}  // namespace wakeline
