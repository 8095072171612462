// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What `ImmSmoother` asks of filters and beliefs that are chosen at run time.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <variant>

#include "wakeline/catalog/filters.hpp"
#include "wakeline/multimodel/imm_smoother.hpp"

namespace wakeline {

/// Calls `function` with a belief that knows its components at compile time.
template <class Function>
auto visit_layout(const AnyBelief& any, const Function& function) noexcept {
  const auto with = [&]<class Motion>(const Motion&) {
    StateBelief<Motion::kComponents, double> belief;
    belief = Gaussian<kStatesOf<Motion>>{any.mean, any.covariance};
    return function(belief);
  };
  using Result = decltype(with(ConstantVelocity{}));
  std::optional<Result> result;
  Motions::for_each([&]<class Motion>(std::type_identity<Motion>) {
    if (!result && any.layout == kLayoutOf<Motion>) result = with(Motion{});
  });
  return *result;
}

/// As of Gaussians; all three are of one layout.
inline Revised<AnyBelief> revised(const AnyBelief& prior, const AnyBelief& before,
                                  const AnyBelief& after) noexcept {
  return visit_layout(prior, [&]<int N>(const Gaussian<N>& belief) -> Revised<AnyBelief> {
    const auto result = wakeline::revised(belief, Gaussian<N>{before.mean, before.covariance},
                                          Gaussian<N>{after.mean, after.covariance});
    return {result.status, AnyBelief{prior.layout, result.belief.mean, result.belief.covariance},
            result.log_evidence};
  });
}

/// As of beliefs whose components are known at compile time.
inline AnyBelief carried_over(const AnyBelief& own, const AnyBelief& part) noexcept {
  if (own.layout == part.layout) return part;
  return visit_layout(own, [&](const auto& to) {
    return visit_layout(part, [&](const auto& from) {
      const auto belief = wakeline::carried_over(to, from);
      return AnyBelief{own.layout, belief.mean, belief.covariance};
    });
  });
}

/// As of the filter itself; under a known acceleration where one is given.
template <class FilterList>
Status smooth_any_pair(const AnyFilterOf<FilterList>& any, AnyBelief& belief,
                       const AnyBelief& later, double dt_s,
                       std::span<const Vec<double, 2>> acceleration_mps2) noexcept {
  return std::visit(
      [&]<class Filter>(const Filter& filter) {
        constexpr int kN = Filter::kStates;
        std::array<Gaussian<kN>, 2> pair{belief.template fixed<kN>(), later.template fixed<kN>()};
        const Status status =
            smooth_as(filter, filter.motion(), pair, std::span(&dt_s, 1), acceleration_mps2);
        belief.mean = pair[0].mean;
        belief.covariance = pair[0].covariance;
        return status;
      },
      any.variant());
}

template <class FilterList, class... Known>
Status smooth_pair(const AnyFilterOf<FilterList>& any, AnyBelief& belief, const AnyBelief& later,
                   double dt_s, const Known&... acceleration_mps2) noexcept {
  const std::array<Vec<double, 2>, sizeof...(Known)> known{acceleration_mps2...};
  return smooth_any_pair(any, belief, later, dt_s, std::span<const Vec<double, 2>>(known));
}

}  // namespace wakeline
