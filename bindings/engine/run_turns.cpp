// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "any_turn_grids.hpp"
#include "run.hpp"

namespace wakeline::python {
namespace {

using TurnFilter = Ekf<CoordinatedTurn>;
using TurnBank = UniformBank<TurnFilter>;

/// The filters of the bank where all are such.
std::vector<TurnFilter> turn_filters(const AnyFilterBank& bank) {
  std::vector<TurnFilter> filters;
  for (int k = 0; k < bank.size(); ++k) {
    const auto* filter =
        std::get_if<TurnFilter>(&bank.filter(static_cast<std::size_t>(k)).variant());
    if (filter == nullptr) return {};
    filters.push_back(*filter);
  }
  return filters;
}

/// The same estimator over other filters.
template <template <class> class Estimator>
Estimator<TurnBank> over(const TurnBank& bank, const Estimator<AnyFilterBank>& any) {
  auto estimator = [&] {
    if constexpr (requires { any.grid(); })
      return Estimator<TurnBank>(any.grid(), any.chain(), bank);
    else
      return Estimator<TurnBank>(any.chain(), bank);
  }();
  estimator.set_initial_mode_probability(any.initial_mode_probability());
  return estimator;
}

}  // namespace

template <class Estimator>
bool run_turns(const Estimator& prototype, const Runs& runs) {
  const std::vector<TurnFilter> filters = turn_filters(prototype.bank());
  if (filters.empty()) return false;
  const auto estimator = over(TurnBank(std::span<const TurnFilter>(filters)), prototype);
  const auto to_fixed = [](const AnyBelief& belief) {
    return Gaussian<4>{belief.mean, belief.covariance};
  };
  std::visit(
      [&](const auto& sensor) {
        run_all(estimator, sensor, runs.in, runs.starts, runs.out, to_fixed);
      },
      runs.sensor);
  return true;
}

template bool run_turns(const AnyImm&, const Runs&);
template bool run_turns(const AnyAdaptiveGridImm&, const Runs&);
template bool run_turns(const AnySwitchingGridImm&, const Runs&);
template bool run_turns(const AnyLikelyModelSetImm&, const Runs&);

}  // namespace wakeline::python
