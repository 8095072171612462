// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>

#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// A one-model estimator: owns its belief, and is started, predicted and updated.
///
/// `assign(belief)` replaces the belief as `start` does, without checking that it is one: what
/// mixing needs. `update(sensor, z)` is a template on the sensor and therefore not part of the
/// concept.
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

/// True of a filter whose own `predict_from(belief, dt_s)` is to be assigned the belief and to
/// predict it, in one step. Not of what is derived from such a filter, as that may predict
/// otherwise.
template <class Filter>
inline constexpr bool kPredictsInOneStep = false;

/// Refuses what cannot be predicted under a known acceleration.
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

/// Begins a filter anew with a belief, unchecked, and predicts it, under a known acceleration where
/// one is told. Its own belief is lost where this fails.
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
