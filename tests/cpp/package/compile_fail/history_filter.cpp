// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A tree of mode histories over filters that remember more than a belief.
#include "wakeline/filter/alpha_beta.hpp"
#include "wakeline/multimodel/mode_history.hpp"

using namespace wakeline;

int main() {
#ifdef WAKELINE_COMPILE_FAIL
  const AlphaBeta<> filter{GrowingMemory{}};
#else
  const Ekf filter{ConstantVelocity{}};
#endif
  const UniformBank bank(filter, 2);
  const ModeHistory<std::decay_t<decltype(filter)>> histories(
      HistoryTree{}, ModeChain<kRuntimeModes>::from_sojourn_s({60.0, 30.0}), bank);
  return histories.started() ? 1 : 0;
}
