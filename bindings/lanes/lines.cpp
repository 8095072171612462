// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "job.hpp"
#include "wakeline/multimodel/bayesian_alpha_beta.hpp"
#include "wakeline/multimodel/fuzzy_alpha_beta.hpp"

namespace wakeline::python {
namespace {

template <class Sensors>
bool run_for(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  if (const auto* criterion = std::get_if<FuzzyCriterion>(&job.lines))
    return run_from<4, Sensors>(FuzzyAlphaBeta<Lanes>(*criterion), job, in, out, threads);
  const auto* weighing = std::get_if<LineWeighing>(&job.lines);
  return weighing != nullptr &&
         run_from<4, Sensors>(BayesianAlphaBeta<Lanes>(*weighing), job, in, out, threads);
}

}  // namespace

bool run_lines(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  return std::holds_alternative<RangeBearingDoppler>(job.sensor)
             ? run_for<DopplerSensor>(job, in, out, threads)
             : run_for<PlaneSensors>(job, in, out, threads);
}

}  // namespace wakeline::python
