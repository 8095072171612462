// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What `ImmSmoother` asks of filters and beliefs that are chosen at run time.
#pragma once

#include <optional>
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

/// As of the filter itself.
template <class FilterList, class... Known>
Status smooth_pair(const AnyFilterOf<FilterList>& filter, AnyBelief& belief, const AnyBelief& later,
                   double dt_s, const Known&... acceleration_mps2) noexcept {
  return std::visit(
      [&]<class Filter>(const Filter& one) {
        StateBelief<Filter::kComponents, double> fixed;
        fixed = Gaussian<Filter::kStates>{belief.mean, belief.covariance};
        const Status status = wakeline::smooth_pair(
            one, fixed, Gaussian<Filter::kStates>{later.mean, later.covariance}, dt_s,
            acceleration_mps2...);
        belief.mean = fixed.mean;
        belief.covariance = fixed.covariance;
        return status;
      },
      filter.variant());
}

}  // namespace wakeline
