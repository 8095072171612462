// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "mode_history.hpp"

namespace wakeline::python {

bool run_mode_history(const HistoryTree& tree, const LaneJob& job, const RunInput& in,
                      const RunOutput& out, int threads) {
  return run_history_of<Ekf<CoordinatedTurn, Lanes>>(tree, job, in, out, threads) ||
         run_history_of<Ekf<CoordinatedTurnRate, Lanes>>(tree, job, in, out, threads) ||
         run_unscented_history(tree, job, in, out, threads);
}

}  // namespace wakeline::python
