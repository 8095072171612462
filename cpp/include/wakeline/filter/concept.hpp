// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// A filter with one model: owns its belief and is started, predicted and updated.
///
/// `assign(belief)` replaces the belief like `start`, without checks, as mixing requires.
/// `update(sensor, z)` is a template on the sensor and therefore not part of the concept.
template <class Filter>
concept BeliefFilter = requires(Filter filter, const Filter& constant,
                                const Gaussian<Filter::kStates, typename Filter::Scalar>& belief,
                                typename Filter::Scalar dt_s) {
  Filter::kComponents.size();
  { filter.start(belief) } -> std::same_as<StatusOf<typename Filter::Scalar>>;
  { filter.assign(belief) } -> std::same_as<StatusOf<typename Filter::Scalar>>;
  { filter.predict(dt_s) } -> std::same_as<StatusOf<typename Filter::Scalar>>;
  {
    constant.estimate()
    } -> std::convertible_to<Gaussian<Filter::kStates, typename Filter::Scalar>>;
  { constant.started() } -> std::same_as<bool>;
  constant.motion();
};

/// True for a filter with a `predict_from(belief, dt_s)` that assigns and predicts in one step.
/// False for classes derived from it, which may predict differently.
template <class Filter>
inline constexpr bool kPredictsInOneStep = false;

/// Checks at compile time that the filter can be predicted under a known acceleration.
template <class Filter>
constexpr void check_takes_acceleration() noexcept {
  using Scalar = typename Filter::Scalar;
  static_assert(
      requires(Filter & filter, Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) {
        filter.predict(dt_s, acceleration_mps2);
      },
      "wakeline: known accelerations and run_batch need predict(dt_s, acceleration_mps2) of each "
      "filter; see cpp/docs/concepts.md");
}

/// Assigns a belief, unchecked, and predicts it, under a known acceleration if one is given. The
/// filter's previous belief is lost when this fails.
template <class Filter, class BeliefType, class... Known>
[[gnu::always_inline]] inline StatusOf<typename Filter::Scalar> predict_from(
    Filter& filter, const BeliefType& belief, typename Filter::Scalar dt_s,
    const Known&... acceleration_mps2) noexcept {
  if constexpr (kPredictsInOneStep<Filter> && sizeof...(Known) == 0) {
    return filter.predict_from(belief, dt_s);
  } else {
    if constexpr (sizeof...(Known) > 0) check_takes_acceleration<Filter>();
    const auto begun = filter.assign(belief);
    return first_failure(begun, filter.predict(dt_s, acceleration_mps2...));
  }
}

}  // namespace wakeline
