// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>

#include "wakeline/core/require.hpp"
#include "wakeline/multimodel/filter_bank.hpp"
#include "wakeline/multimodel/mode_chain.hpp"

namespace wakeline {

/// A variant with each of several types once.
template <class Variant, class... Types>
struct VariantOf {
  using Type = Variant;
};
template <class... Held, class Next, class... Rest>
struct VariantOf<std::variant<Held...>, Next, Rest...>
    : std::conditional_t<(std::is_same_v<Next, Held> || ...),
                         VariantOf<std::variant<Held...>, Rest...>,
                         VariantOf<std::variant<Held..., Next>, Rest...>> {};

/// Filters chosen at run time, up to `Capacity`, each of one of the kinds `Filters`: the interface
/// of `FilterBank`, e.g. for a console that reads its models from its settings. Storage is in
/// place: no heap.
template <int Capacity, class... Filters>
class VariantBank {
 public:
  static_assert(Capacity >= 1 && Capacity <= kMaxModes);
  static constexpr int kModels = kRuntimeModes;
  using Scalar = typename FilterBank<Filters...>::Scalar;
  using Filter = std::variant<Filters...>;

  /// Components of the combined estimate: those of the kinds if all have the same, else position
  /// and velocity.
  static constexpr auto kComponents = FilterBank<Filters...>::kComponents;

  /// Throws `std::invalid_argument` unless there are 1 to `Capacity` filters.
  explicit VariantBank(std::span<const Filter> filters) : size_(static_cast<int>(filters.size())) {
    if (filters.empty()) reject("a bank needs filters, got none");
    if (filters.size() > kCapacity)
      reject("a bank has room for " + std::to_string(Capacity) + " filters, got " +
             std::to_string(filters.size()));
    for (std::size_t k = 0; k < filters.size(); ++k) slots_[k] = slot_of(filters[k]);
  }

  [[nodiscard]] int size() const noexcept { return size_; }

  template <class Function>
  void for_each(Function&& function) noexcept {
    for (int k = 0; k < size_; ++k)
      std::visit(
          [&]<class Kind>(Kind& filter) {
            function(k, filter, *std::get_if<BeliefOf<Kind>>(&slot(k).before));
          },
          slot(k).filter);
  }

  template <class Function>
  void for_each(Function&& function) const noexcept {
    for (int k = 0; k < size_; ++k)
      std::visit([&](const auto& filter) { function(k, filter); }, slot(k).filter);
  }

  /// Calls `f(k, belief)` with the current belief of each filter.
  template <class Function>
  void for_each_belief(Function&& function) const noexcept {
    for_each([&]<class Kind>(int k, const Kind& filter) {
      const auto& belief = filter.estimate();
      function(k, BeliefView<Kind::kComponents, Scalar>{belief.mean, belief.covariance});
    });
  }

  template <class Function>
  void for_each_before(Function&& function) const noexcept {
    for (int k = 0; k < size_; ++k)
      std::visit([&](const auto& before) { function(k, before); }, slot(k).before);
  }

  /// A zero belief over the components of the combined estimate.
  static StateBelief<kComponents, Scalar> empty_estimate() noexcept {
    return zero_like(StateBelief<kComponents, Scalar>{});
  }

  [[nodiscard]] const Filter& filter(int k) const noexcept { return slot(k).filter; }
  [[nodiscard]] Filter& filter(int k) noexcept { return slot(k).filter; }

 private:
  template <class Kind>
  using BeliefOf = StateBelief<Kind::kComponents, Scalar>;
  using Before = typename VariantOf<std::variant<>, BeliefOf<Filters>...>::Type;
  struct Slot {
    Filter filter;
    Before before;
  };
  static constexpr auto kCapacity = static_cast<std::size_t>(Capacity);

  static Slot slot_of(const Filter& filter) {
    return {filter,
            std::visit([]<class Kind>(const Kind&) -> Before { return BeliefOf<Kind>{}; }, filter)};
  }
  Slot& slot(int k) noexcept { return *slots_[static_cast<std::size_t>(k)]; }
  [[nodiscard]] const Slot& slot(int k) const noexcept {
    return *slots_[static_cast<std::size_t>(k)];
  }

  std::array<std::optional<Slot>, kCapacity> slots_;  ///< unused ones are not copied
  int size_;
};

}  // namespace wakeline
