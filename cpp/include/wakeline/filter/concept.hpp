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

}  // namespace wakeline
