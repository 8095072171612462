// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "wakeline/multimodel/mode_chain.hpp"
#include "wakeline/multimodel/turn_rate_grid.hpp"

namespace wakeline {

/// How a vessel goes from one turn rate to another.
struct TurnHabits {
  double straight_sojourn_s = 55.0;      ///< mean time on a straight
  double turn_sojourn_s = 75.0;          ///< mean time in a turn
  double straighten_probability = 0.75;  ///< that a turn ends in a straight, not in another turn
};

/// The chain between the turn rates of a grid, in continuous time: a straight leads to
/// every turn with equal probability, a turn that does not straighten to every other turn. The
/// straightest rate of the grid is the straight. Throws `std::invalid_argument` when a parameter
/// makes no sense.
inline ModeChain<kRuntimeModes> turning_chain(const TurnRateGrid& grid_rad_s,
                                              const TurnHabits& habits = {}) {
  require_positive("straight_sojourn_s", habits.straight_sojourn_s);
  require_positive("turn_sojourn_s", habits.turn_sojourn_s);
  require_probability("straighten_probability", habits.straighten_probability);
  const int modes = grid_rad_s.size();
  const int straight = grid_rad_s.straightest();
  const double straightens = modes > 2 ? habits.straighten_probability : 1.0;
  ModeVector<double, kRuntimeModes> sojourn_s =
      ModeVector<double, kRuntimeModes>::Constant(modes, habits.turn_sojourn_s);
  sojourn_s[straight] = habits.straight_sojourn_s;
  ModeChain<kRuntimeModes>::Matrix next = ModeChain<kRuntimeModes>::Matrix::Constant(
      modes, modes, (1.0 - straightens) / std::max(modes - 2, 1));
  next.col(straight).setConstant(straightens);
  next.row(straight).setConstant(1.0 / (modes - 1));
  next.diagonal().setZero();
  return ModeChain<kRuntimeModes>::from_sojourn_s(sojourn_s, next);
}

}  // namespace wakeline
