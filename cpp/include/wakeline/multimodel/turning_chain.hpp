// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/fields.hpp"
#include "wakeline/multimodel/mode_chain.hpp"
#include "wakeline/multimodel/turn_rate_grid.hpp"

namespace wakeline {

/// Statistics of a vessel's turns.
struct TurnHabits {
  double straight_sojourn_s = 40.0;
  double turn_sojourn_s = 70.0;
  double straighten_probability = 0.85;

  static constexpr auto fields() noexcept {
    using T = TurnHabits;
    return field_table(
        field("straight_sojourn_s", &T::straight_sojourn_s, kTime, "s", "Mean time on a straight."),
        field("turn_sojourn_s", &T::turn_sojourn_s, kTime, "s", "Mean time in a turn."),
        field("straighten_probability", &T::straighten_probability, kProbability, "1",
              "Probability that a turn ends in a straight and not in another turn."));
  }
};

/// The continuous-time chain between the turn rates of a grid. A straight is followed by a turn,
/// and a turn that does not end in a straight by another turn, with probabilities proportional to
/// the weights. The straightest rate of the grid is the straight; its weight is ignored. Throws
/// `std::invalid_argument` when a parameter is invalid.
inline ModeChain<kRuntimeModes> turning_chain(const TurnRateGrid& grid_rad_s,
                                              const TurnHabits& habits,
                                              const ModeVector<double, kRuntimeModes>& weight) {
  validate_fields(habits);
  grid_rad_s.require_for_each("grid_weight", weight.size());
  const int modes = grid_rad_s.size();
  const int straight = grid_rad_s.straightest();
  for (int k = 0; k < modes; ++k)
    if (k != straight) require_positive("every weight of a turn in grid_weight", weight[k]);
  const double straightens = modes > 2 ? habits.straighten_probability : 1.0;
  ModeVector<double, kRuntimeModes> sojourn_s =
      ModeVector<double, kRuntimeModes>::Constant(modes, habits.turn_sojourn_s);
  sojourn_s[straight] = habits.straight_sojourn_s;
  ModeChain<kRuntimeModes>::Matrix next = ModeChain<kRuntimeModes>::Matrix::Zero(modes, modes);
  for (int from = 0; from < modes; ++from) {
    const auto leads = [&](int to) { return to != straight && to != from; };
    double all = 0.0;
    for (int to = 0; to < modes; ++to)
      if (leads(to)) all += weight[to];
    const double turns = from == straight ? 1.0 : 1.0 - straightens;
    for (int to = 0; to < modes; ++to)
      if (leads(to)) next(from, to) = turns * weight[to] / all;
    if (from != straight) next(from, straight) = straightens;
  }
  return ModeChain<kRuntimeModes>::from_sojourn_s(sojourn_s, next);
}

/// The same with equal weights.
inline ModeChain<kRuntimeModes> turning_chain(const TurnRateGrid& grid_rad_s,
                                              const TurnHabits& habits = {}) {
  return turning_chain(grid_rad_s, habits,
                       ModeVector<double, kRuntimeModes>::Ones(grid_rad_s.size()));
}

}  // namespace wakeline
