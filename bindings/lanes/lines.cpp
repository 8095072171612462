// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "job.hpp"
#include "wakeline/multimodel/bayesian_alpha_beta.hpp"
#include "wakeline/multimodel/fuzzy_alpha_beta.hpp"

namespace wakeline::python {

bool run_lines(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  if (const auto* criterion = std::get_if<FuzzyCriterion>(&job.lines))
    return run_from<4>(FuzzyAlphaBeta<Lanes>(*criterion), job, in, out, threads);
  const auto* weighing = std::get_if<LineWeighing>(&job.lines);
  return weighing != nullptr &&
         run_from<4>(BayesianAlphaBeta<Lanes>(*weighing), job, in, out, threads);
}

}  // namespace wakeline::python
