// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the bindings of estimators over a grid of turn rates share.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "catalog.hpp"
#include "support/types.hpp"
#include "wakeline/multimodel/turn_rate_grid.hpp"

namespace wakeline::python {

using Chain = ModeChain<kRuntimeModes>;

/// `count` filters like `filter`, which must have a known turn rate.
inline AnyFilterBank turning_bank(const AnyFilter& filter, int count) {
  if (!filter.turns())
    throw py::value_error("filter must be one over CoordinatedTurn, whose turn rate can change");
  return AnyFilterBank(std::vector<AnyFilter>(static_cast<std::size_t>(count), filter));
}

/// The chain given, or the one that stays with that probability.
inline Chain chain_of(const std::optional<Chain>& chain, double stay_probability, int modes) {
  return chain ? *chain : Chain::staying(stay_probability, modes);
}

/// A filter as a bank of them is given it: its turn rate does not matter.
inline AnyFilter without_turn(AnyFilter filter) {
  filter.set_turn_rate(0.0);
  return filter;
}

/// Of `least` rates or more.
inline TurnRateGrid to_grid(const DoubleArray& rates, int least = 2) {
  const Eigen::VectorXd vector = to_vector("grid_rad_s", rates);
  TurnRateGrid::require_count(vector.size(), least);
  return TurnRateGrid(
      std::span<const double>(vector.data(), static_cast<std::size_t>(vector.size())));
}

template <class Estimator>
Estimator with_initial(Estimator estimator, const std::optional<DoubleArray>& initial) {
  if (initial)
    estimator.set_initial_mode_probability(
        to_vector("initial_mode_probability", *initial, estimator.mode_probability().size()));
  return estimator;
}

}  // namespace wakeline::python
