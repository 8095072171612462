// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "job.hpp"
#include "wakeline/multimodel/bayesian_alpha_beta.hpp"
#include "wakeline/multimodel/fuzzy_alpha_beta.hpp"

namespace wakeline::python {
namespace {

auto estimator_of(const FuzzyCriterion& criterion) { return FuzzyAlphaBeta<Lanes>(criterion); }

auto estimator_of(const LineWeighing& weighing) { return BayesianAlphaBeta<Lanes>(weighing); }

template <int Order>
auto estimator_of(const LaneAlphaBeta<Order>& filter) {
  return AlphaBetaFilter<Order, Lanes>(filter.gains, filter.motion);
}

template <class Sensors>
bool run_for(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  return std::visit(
      [&]<class Lines>(const Lines& lines) {
        if constexpr (std::is_same_v<Lines, std::monostate>) {
          return false;
        } else {
          const auto estimator = estimator_of(lines);
          constexpr int kStates = decltype(estimator.estimate().mean)::RowsAtCompileTime;
          return run_from<kStates, Sensors>(estimator, job, in, out, threads);
        }
      },
      job.lines);
}

}  // namespace

bool run_lines(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  return std::holds_alternative<RangeBearingDoppler>(job.sensor)
             ? run_for<DopplerSensor>(job, in, out, threads)
             : run_for<PlaneSensors>(job, in, out, threads);
}

}  // namespace wakeline::python
