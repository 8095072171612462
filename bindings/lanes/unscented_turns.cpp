// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "job.hpp"
#include "wakeline/multimodel/adaptive_grid_imm.hpp"
#include "wakeline/multimodel/likely_model_set_imm.hpp"
#include "wakeline/multimodel/switching_grid_imm.hpp"

namespace wakeline::python {
namespace {

// The number of models is told at run time, so that all rules share the steps of one Imm: beside
// sigma points it costs nothing.
template <class Filter>
bool run_over(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  if (!all_over<CoordinatedTurn>(job, kFilterOf<Filter>)) return false;
  const UniformBank<Filter> bank = bank_of<Filter>(job);
  if (const auto* grid = std::get_if<AdaptiveGrid>(&job.structure))
    return run_turning<AdaptiveGridImm>(*grid, bank, job, in, out, threads);
  if (const auto* grid = std::get_if<SwitchingGrid>(&job.structure))
    return run_turning<SwitchingGridImm>(*grid, bank, job, in, out, threads);
  if (const auto* set = std::get_if<LikelyModelSet>(&job.structure))
    return run_turning<LikelyModelSetImm>(*set, bank, job, in, out, threads);
  return false;
}

}  // namespace

bool run_unscented_turns(const LaneJob& job, const RunInput& in, const RunOutput& out,
                         int threads) {
  return run_over<Ukf<KnownTurn<Lanes>, Lanes>>(job, in, out, threads) ||
         run_over<SquareRootUkf<KnownTurn<Lanes>, Lanes>>(job, in, out, threads);
}

}  // namespace wakeline::python
