// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <tuple>
#include <type_traits>
#include <utility>

#include "wakeline/core/component.hpp"
#include "wakeline/core/state_belief.hpp"
#include "wakeline/filter/concept.hpp"

namespace wakeline {

/// Copies the mean and the lower triangle of a belief, which is what mixing reads.
template <auto Components, class Scalar, int N>
[[gnu::always_inline]] inline void keep_lower(const Gaussian<N, Scalar>& belief,
                                              StateBelief<Components, Scalar>& kept) noexcept {
  unroll<N>([&](int i) { kept.mean.data()[i] = belief.mean.data()[i]; });
  unroll_lower<N>([&](int i, int j) { kept.covariance(i, j) = belief.covariance(i, j); });
}

/// Completes a belief copied by `keep_lower`.
template <auto Components, class Scalar>
void complete(StateBelief<Components, Scalar>& kept) noexcept {
  mirror_lower<Scalar, StateBelief<Components, Scalar>::kStates>(kept.covariance);
}

/// `part`, a StateBelief or BeliefView, in the state of `own`: components that only `own` has are
/// taken from it, uncorrelated with the rest. Reads the lower triangle of `part`, in any order of
/// rows.
template <auto To, class Scalar, class Part>
decltype(auto) in_terms_of(const StateBelief<To, Scalar>& own, const Part& part) noexcept {
  constexpr auto kFrom = Part::kComponents;
  if constexpr (std::is_same_v<StateBelief<kFrom, Scalar>, StateBelief<To, Scalar>>) {
    return (part);
  } else {
    constexpr auto kRows = rows_of(kFrom, To);
    StateBelief<To, Scalar> belief = own;
    for (int j = 0; j < own.kStates; ++j) {
      if (kRows[j] >= 0) belief.mean[j] = part.mean[kRows[j]];
      for (int i = 0; i < own.kStates; ++i) {
        if (kRows[i] >= 0 && kRows[j] >= 0)
          belief.covariance(i, j) =
              part.covariance(std::max(kRows[i], kRows[j]), std::min(kRows[i], kRows[j]));
        else if (kRows[i] >= 0 || kRows[j] >= 0)
          belief.covariance(i, j) = Scalar(0);
      }
    }
    return belief;
  }
}

/// sum.mean += weight m.
template <auto To, class Scalar, class Part>
[[gnu::always_inline]] inline void add_mean(StateBelief<To, Scalar>& sum, Scalar weight,
                                            const Part& part,
                                            const StateBelief<To, Scalar>& own) noexcept {
  const auto& belief = in_terms_of(own, part);
  unroll<StateBelief<To, Scalar>::kStates>(
      [&](int i) { sum.mean.data()[i] += weight * belief.mean.data()[i]; });
}

/// sum.covariance += weight (P + d dᵀ), d = m - sum.mean.
template <auto To, class Scalar, class Part>
[[gnu::always_inline]] inline void add_spread(StateBelief<To, Scalar>& sum, Scalar weight,
                                              const Part& part,
                                              const StateBelief<To, Scalar>& own) noexcept {
  const auto& belief = in_terms_of(own, part);
  constexpr int kStates = StateBelief<To, Scalar>::kStates;
  Vec<Scalar, kStates> d;
  unroll<kStates>([&](int i) { d[i] = belief.mean.data()[i] - sum.mean.data()[i]; });
  unroll_lower<kStates>([&](int i, int j) {
    sum.covariance(i, j) += weight * (belief.covariance(i, j) + d[i] * d[j]);
  });
  mirror_lower<Scalar, kStates>(sum.covariance);
}

/// The mean and covariance of the mixture of a bank's beliefs, by weights that sum to one.
template <class Bank, class Weights>
[[gnu::always_inline]] inline auto moment_matched(const Bank& bank,
                                                  const Weights& weight) noexcept {
  auto sum = bank.empty_estimate();
  bank.for_each_belief([&](int k, const auto& belief) { add_mean(sum, weight[k], belief, sum); });
  bank.for_each_belief([&](int k, const auto& belief) { add_spread(sum, weight[k], belief, sum); });
  return decltype(sum)(sum);  // a copy, so that the sum stays in registers
}

/// Filters composed at compile time, of any kinds and state sizes, each with its belief before a
/// step.
///
/// A bank is the basis of a multi-model estimator: `size`, `for_each(f(k, filter, before))`,
/// `for_each_before(f(k, before))` and `empty_estimate`; a bank composed at run time has the same
/// interface.
template <class... Filters>
class FilterBank {
  static_assert(
      (BeliefFilter<Filters> && ...),
      "wakeline: each model of a bank must be a filter (start, assign, predict, estimate); see "
      "cpp/docs/concepts.md");

 public:
  static constexpr int kModels = sizeof...(Filters);
  using Scalar = typename std::tuple_element_t<0, std::tuple<Filters...>>::Scalar;
  static_assert((std::is_same_v<Scalar, typename Filters::Scalar> && ...),
                "wakeline: the filters of a bank must share one scalar type");

  /// Components of the combined estimate: those of the filters if all have the same, else position
  /// and velocity.
  static constexpr auto kComponents = [] {
    constexpr auto kFirst = std::tuple_element_t<0, std::tuple<Filters...>>::kComponents;
    if constexpr ((std::is_same_v<StateBelief<Filters::kComponents, Scalar>,
                                  StateBelief<kFirst, Scalar>> &&
                   ...))
      return kFirst;
    else
      return kKinematics;
  }();

  explicit FilterBank(const Filters&... filters) : slots_{Slot<Filters>{filters, {}}...} {}

  static constexpr int size() noexcept { return kModels; }

  template <class Function>
  void for_each(Function&& function) noexcept {
    visit(*this, [&](int k, auto& slot) { function(k, slot.filter, slot.before); });
  }

  template <class Function>
  void for_each(Function&& function) const noexcept {
    visit(*this, [&](int k, const auto& slot) { function(k, slot.filter); });
  }

  /// Calls `f(k, belief)` with the current belief of each filter.
  template <class Function>
  void for_each_belief(Function&& function) const noexcept {
    visit(*this, [&]<class Filter>(int k, const Slot<Filter>& slot) {
      const auto& belief = slot.filter.estimate();
      function(k, BeliefView<Filter::kComponents, Scalar>{belief.mean, belief.covariance});
    });
  }

  template <class Function>
  void for_each_before(Function&& function) const noexcept {
    visit(*this, [&](int k, const auto& slot) { function(k, slot.before); });
  }

  /// A zero belief over the components of the combined estimate.
  static StateBelief<kComponents, Scalar> empty_estimate() noexcept {
    return zero_like(StateBelief<kComponents, Scalar>{});
  }

  template <int Index>
  const auto& get() const noexcept {
    return std::get<Index>(slots_).filter;
  }
  template <int Index>
  auto& get() noexcept {
    return std::get<Index>(slots_).filter;
  }

 private:
  template <class Filter>
  struct Slot {
    Filter filter;
    StateBelief<Filter::kComponents, typename Filter::Scalar> before;
  };

  template <class Self, class Function>
  static void visit(Self& self, Function&& function) noexcept {
    if constexpr (kAlike) {
      for (int k = 0; k < kModels; ++k) function(k, self.slots_[static_cast<std::size_t>(k)]);
    } else {
      [&]<std::size_t... Index>(std::index_sequence<Index...>) {
        (function(static_cast<int>(Index), std::get<Index>(self.slots_)), ...);
      }
      (std::make_index_sequence<sizeof...(Filters)>{});
    }
  }

  // Filters of one kind are visited in a loop: the unrolled step of all of them exceeds the
  // instruction cache.
  using First = std::tuple_element_t<0, std::tuple<Filters...>>;
  static constexpr bool kAlike = (std::is_same_v<First, Filters> && ...);
  std::conditional_t<kAlike, std::array<Slot<First>, kModels>, std::tuple<Slot<Filters>...>> slots_;
};

}  // namespace wakeline
