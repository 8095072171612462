// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "mixed_imm.hpp"

namespace wakeline::python {
namespace {

bool run_single(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  const LaneModel& model = job.models.front();
  const auto run_one = [&](const auto& filter) {
    return run_from<std::decay_t<decltype(filter)>::kStates, DopplerSensor>(filter, job, in, out,
                                                                            threads);
  };
  return std::visit(
      [&]<class Motion>(const Motion&) {
        switch (model.filter) {
          case LaneFilter::kExtended:
            return run_one(filter_of<Ekf<Motion, Lanes>>(model));
          case LaneFilter::kUnscented:
            return run_one(filter_of<Ukf<Motion, Lanes>>(model));
          default:
            return false;
        }
      },
      model.motion);
}

bool run_imm(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  if (all_over<CoordinatedTurn>(job, LaneFilter::kExtended))
    return run_begun<DopplerSensor>(Imm{*job.chain, bank_of<Ekf<CoordinatedTurn, Lanes>>(job)}, job,
                                    in, out, threads);
  return run_mixed<DopplerSensor, Ekf<CoordinatedTurn, Lanes>, Ekf<WanderingCourse, Lanes>,
                   Ekf<CoordinatedTurnRate, Lanes>, Ekf<ConstantAcceleration, Lanes>,
                   Ekf<Singer, Lanes>, Ukf<CoordinatedTurnRate, Lanes>>(job, in, out, threads);
}

}  // namespace

// Each sensor takes as long to compile as what there is for it: square-root filters, estimators
// over turn rates that change and trees are run one recording after the other.
bool run_doppler(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  if (job.chain == nullptr) return run_single(job, in, out, threads);
  return std::holds_alternative<std::monostate>(job.structure) && run_imm(job, in, out, threads);
}

}  // namespace wakeline::python
