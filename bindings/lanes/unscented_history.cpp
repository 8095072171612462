// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "mode_history.hpp"

namespace wakeline::python {
namespace {

template <class Motion>
bool run_filters_over(const HistoryTree& tree, const LaneJob& job, const RunInput& in,
                      const RunOutput& out, int threads) {
  return run_history_of<Ukf<Motion, Lanes>>(tree, job, in, out, threads) ||
         run_history_of<SquareRootUkf<Motion, Lanes>>(tree, job, in, out, threads);
}

}  // namespace

bool run_unscented_history(const HistoryTree& tree, const LaneJob& job, const RunInput& in,
                           const RunOutput& out, int threads) {
  return run_filters_over<CoordinatedTurn>(tree, job, in, out, threads) ||
         run_filters_over<CoordinatedTurnRate>(tree, job, in, out, threads);
}

}  // namespace wakeline::python
