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

namespace detail {

/// `std::tuple<std::array<A, 2>, std::array<B, 1>>` of A, A, B.
template <class Done, class... Types>
struct RunsOf;

template <class... Done>
struct RunsOf<std::tuple<Done...>> {
  using Type = std::tuple<Done...>;
};

template <class... Done, class First, class... Others>
struct RunsOf<std::tuple<Done...>, First, Others...>
    : RunsOf<std::tuple<Done...>, std::array<First, 1>, Others...> {};

template <class... Done, class One, std::size_t N, class... Others>
struct RunsOf<std::tuple<Done...>, std::array<One, N>, One, Others...>
    : RunsOf<std::tuple<Done...>, std::array<One, N + 1>, Others...> {};

template <class... Done, class One, std::size_t N, class... Others>
struct RunsOf<std::tuple<Done...>, std::array<One, N>, Others...>
    : RunsOf<std::tuple<Done..., std::array<One, N>>, Others...> {};

}  // namespace detail

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

  explicit FilterBank(const Filters&... filters)
      : runs_(made_runs(std::tie(filters...), std::make_index_sequence<kRuns>{})) {}

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
    return slot<Index, 0>(*this).filter;
  }
  template <int Index>
  auto& get() noexcept {
    return slot<Index, 0>(*this).filter;
  }

 private:
  template <class Filter>
  struct Slot {
    Filter filter;
    StateBelief<Filter::kComponents, typename Filter::Scalar> before;
  };

  // The step of a run is a loop: unrolled, the steps of all filters exceed the instruction cache.
  using Runs = typename detail::RunsOf<std::tuple<>, Slot<Filters>...>::Type;
  static constexpr int kRuns = int{std::tuple_size_v<Runs>};

  template <std::size_t Run>
  static constexpr std::size_t kSize = std::tuple_size_v<std::tuple_element_t<Run, Runs>>;

  template <std::size_t... Run>
  static Runs made_runs(const std::tuple<const Filters&...>& filters, std::index_sequence<Run...>) {
    const auto sizes = []<std::size_t... Before>(std::index_sequence<Before...>) {
      return (std::size_t{0} + ... + kSize<Before>);
    };
    return Runs(made_run<sizes(std::make_index_sequence<Run>{})>(
        filters, std::make_index_sequence<kSize<Run>>{})...);
  }

  template <std::size_t First, std::size_t... Index>
  static auto made_run(const std::tuple<const Filters&...>& filters,
                       std::index_sequence<Index...>) {
    return std::array{Slot<std::remove_cvref_t<decltype(std::get<First + Index>(filters))>>{
        std::get<First + Index>(filters), {}}...};
  }

  template <class Self, class Function>
  static void visit(Self& self, const Function& function) noexcept {
    std::apply(
        [&](auto&... runs) {
          int k = 0;
          const auto visit_run = [&](auto& run) {
            for (auto& slot : run) function(k++, slot);
          };
          (visit_run(runs), ...);
        },
        self.runs_);
  }

  template <std::size_t Index, std::size_t Run, class Self>
  static auto& slot(Self& self) noexcept {
    auto& run = std::get<Run>(self.runs_);
    if constexpr (Index < kSize<Run>)
      return run[Index];
    else
      return slot<Index - kSize<Run>, Run + 1>(self);
  }

  Runs runs_;
};

}  // namespace wakeline
