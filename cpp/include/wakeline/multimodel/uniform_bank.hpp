// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <string>

#include "wakeline/multimodel/filter_bank.hpp"
#include "wakeline/multimodel/mode_chain.hpp"

namespace wakeline {

/// Filters of one kind: the interface of `FilterBank`, with a number of filters that may be given
/// at run time (K = kRuntimeModes, at most kMaxModes); filters may then be inactive. A filter that
/// is inactive in all lanes is skipped by every `for_each`. Storage is in place: no heap.
template <class Filter, int K = kRuntimeModes>
class UniformBank {
  static_assert(
      BeliefFilter<Filter>,
      "wakeline: each model of a bank must be a filter (start, assign, predict, estimate); see "
      "cpp/docs/concepts.md");

 public:
  static constexpr int kModels = K;
  static constexpr auto kComponents = Filter::kComponents;
  using Scalar = typename Filter::Scalar;

  /// `size` copies of `prototype`. Throws `std::invalid_argument` when the size is out of range.
  explicit UniformBank(const Filter& prototype, int size = K)
      : slots_(filled(prototype)), size_(size) {
    active_.fill(true);
    check_size();
  }

  /// Throws `std::invalid_argument` unless there are K filters, or 1 to kMaxModes.
  explicit UniformBank(std::span<const Filter> filters)
      : slots_(filled(filters.empty() ? (reject("a bank needs filters, got none"), filters.front())
                                      : filters.front())),
        size_(static_cast<int>(filters.size())) {
    active_.fill(true);
    check_size();
    for (std::size_t k = 0; k < filters.size(); ++k) slots_[k].filter = filters[k];
  }

  [[nodiscard]] int size() const noexcept {
    if constexpr (kMayRest)
      return size_;
    else
      return K;
  }
  [[nodiscard]] MaskOf<Scalar> active(int k) const noexcept requires(K == kRuntimeModes) {
    return active_[static_cast<std::size_t>(k)];
  }
  void set_active(int k, const MaskOf<Scalar>& active) noexcept requires(K == kRuntimeModes) {
    active_[static_cast<std::size_t>(k)] = active;
  }

  template <class Function>
  void for_each(Function&& function) noexcept {
    for (int k = 0; k < size(); ++k)
      if (Slot& s = slot(k); in_use(k)) function(k, s.filter, s.before);
  }

  template <class Function>
  void for_each(Function&& function) const noexcept {
    for (int k = 0; k < size(); ++k)
      if (const Slot& s = slot(k); in_use(k)) function(k, s.filter);
  }

  /// Calls `f(k, belief)` with the current belief of each filter.
  template <class Function>
  void for_each_belief(Function&& function) const noexcept {
    for_each([&](int k, const Filter& filter) {
      const auto& belief = filter.estimate();
      function(k, BeliefView<kComponents, Scalar>{belief.mean, belief.covariance});
    });
  }

  template <class Function>
  void for_each_before(Function&& function) const noexcept {
    for (int k = 0; k < size(); ++k)
      if (const Slot& s = slot(k); in_use(k)) function(k, s.before);
  }

  /// A zero belief over the components of the combined estimate.
  static StateBelief<kComponents, Scalar> empty_estimate() noexcept {
    return zero_like(StateBelief<kComponents, Scalar>{});
  }

  template <int Index>
  const Filter& get() const noexcept {
    return slot(Index).filter;
  }
  [[nodiscard]] const Filter& filter(int k) const noexcept { return slot(k).filter; }
  [[nodiscard]] Filter& filter(int k) noexcept { return slot(k).filter; }

 private:
  struct Slot {
    Filter filter;
    StateBelief<kComponents, Scalar> before = {};
  };
  static constexpr bool kMayRest = K == kRuntimeModes;
  static constexpr std::size_t kCapacity = static_cast<std::size_t>(kModeCapacity<K>);

  static std::array<Slot, kCapacity> filled(const Filter& prototype) {
    return [&]<std::size_t... Index>(std::index_sequence<Index...>) {
      return std::array<Slot, kCapacity>{((void)Index, Slot{prototype})...};
    }
    (std::make_index_sequence<kCapacity>{});
  }

  void check_size() const {
    if (K == kRuntimeModes ? size_ < 1 || size_ > kMaxModes : size_ != K)
      reject("a bank needs " +
             (K == kRuntimeModes ? "1 to " + std::to_string(kMaxModes) : std::to_string(K)) +
             " filters, got " + std::to_string(size_));
  }

  [[nodiscard]] bool in_use(int k) const noexcept {
    if constexpr (kMayRest)
      return any(active(k));
    else
      return true;
  }

  Slot& slot(int k) noexcept { return slots_[static_cast<std::size_t>(k)]; }
  const Slot& slot(int k) const noexcept { return slots_[static_cast<std::size_t>(k)]; }

  std::array<Slot, kCapacity> slots_;
  std::array<MaskOf<Scalar>, kMayRest ? kCapacity : 0> active_;
  int size_;
};

}  // namespace wakeline
