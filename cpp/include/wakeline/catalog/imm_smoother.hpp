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

/// Calls `function` with a belief that knows its components at compile time, those of a motion
/// model of the catalogue.
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
  if (!is_of_catalog(prior.layout)) {
    const auto result = wakeline::revised(filled_up(prior), filled_up(before), filled_up(after));
    return {result.status, cut_to(prior.layout, result.belief), result.log_evidence};
  }
  return visit_layout(prior, [&]<int N>(const Gaussian<N>& belief) -> Revised<AnyBelief> {
    const auto result = wakeline::revised(belief, Gaussian<N>{before.mean, before.covariance},
                                          Gaussian<N>{after.mean, after.covariance});
    return {result.status, AnyBelief{prior.layout, result.belief.mean, result.belief.covariance},
            result.log_evidence};
  });
}

/// `carried_over` where one of the beliefs is of a motion model made at run time.
inline AnyBelief carried_over_rows(const AnyBelief& own, const AnyBelief& part) noexcept {
  const auto row = rows_between(part.layout, own.layout);
  const auto shared = [&](int i) {
    return i < own.states() && row[static_cast<std::size_t>(i)] >= 0;
  };
  const auto from = [&](int i) { return row[static_cast<std::size_t>(i)]; };
  using Matrix = Mat<double, kMaxStates, kMaxStates>;
  Matrix before = Matrix::Identity(), change = Matrix::Zero(), with_shared = Matrix::Zero();
  Vec<double, kMaxStates> shift = Vec<double, kMaxStates>::Zero();
  for (int i = 0; i < own.states(); ++i) {
    if (!shared(i)) continue;
    shift[i] = part.mean[from(i)] - own.mean[i];
    with_shared.col(i).head(own.states()) = own.covariance.col(i);
    for (int j = 0; j < own.states(); ++j)
      if (shared(j)) {
        before(i, j) = own.covariance(i, j);
        change(i, j) = part.covariance(from(i), from(j)) - before(i, j);
      }
  }
  const Cholesky<kMaxStates> factor(before);
  if (!factor.ok()) return own;
  const Matrix gain = factor.unwhiten_rows(factor.whiten_rows(with_shared));
  Gaussian<kMaxStates> result = filled_up(own);
  result.mean += product(gain, shift);
  result.covariance += product_transposed(product(gain, change), gain);
  mirror_lower<double, kMaxStates>(result.covariance);
  return cut_to(own.layout, result);
}

/// As of beliefs whose components are known at compile time.
inline AnyBelief carried_over(const AnyBelief& own, const AnyBelief& part) noexcept {
  if (own.layout == part.layout) return part;
  if (!is_of_catalog(own.layout) || !is_of_catalog(part.layout))
    return carried_over_rows(own, part);
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
        if constexpr (std::is_same_v<Filter, CustomFilter>) {
          return filter.smooth(belief, later, dt_s, acceleration_mps2);
        } else {
          constexpr int kN = Filter::kStates;
          std::array<Gaussian<kN>, 2> pair{belief.template fixed<kN>(), later.template fixed<kN>()};
          const Status status =
              smooth_as(filter, filter.motion(), pair, std::span(&dt_s, 1), acceleration_mps2);
          belief.mean = pair[0].mean;
          belief.covariance = pair[0].covariance;
          return status;
        }
      },
      any.variant());
}

/// Smooths a belief by the later one of the same filter.
template <class FilterList, class... Known>
Status smooth_pair(const AnyFilterOf<FilterList>& any, AnyBelief& belief, const AnyBelief& later,
                   double dt_s, const Known&... acceleration_mps2) noexcept {
  const std::array<Vec<double, 2>, sizeof...(Known)> known{acceleration_mps2...};
  return smooth_any_pair(any, belief, later, dt_s, std::span<const Vec<double, 2>>(known));
}

}  // namespace wakeline
