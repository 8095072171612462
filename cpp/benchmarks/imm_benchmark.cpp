// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// One step (predict, update, estimate) of an IMM with 3 or 5 coordinated turns of 4 states and a
// range-bearing EKF each, beside a hand-written loop of the same equations: textbook form,
// fixed-size Eigen, F and Q computed once. Both run along the same closed course; before the timing
// the loop is checked against ours.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "go_round.hpp"
#include "hand_loops.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace {

using namespace wakeline;
using namespace wakeline::bench;

template <class Scalar, int K>
auto started_imm(const Course<Scalar>& course) {
  auto started = imm<K, Scalar>();
  (void)started.start(course.start);
  return started;
}

/// Ours, and what the loop gives after the same steps: they must not differ by more than rounding.
template <class Scalar, int K>
bool agree(const Course<Scalar>& course) {
  const Scalar tolerance = sizeof(Scalar) > 4 ? Scalar(1e-12) : Scalar(2e-3);
  auto imm = started_imm<Scalar, K>(course);
  HandImm<K, Scalar> hand(course.start);
  Scalar error = 0;
  for (const auto& z : course.polar) {
    (void)imm.predict(Scalar(kStep_s));
    const auto step = imm.update(kRadar, z);
    const auto estimate = imm.estimate();
    hand.step(z);
    error = std::max(
        {error, relative_error(estimate.mean, hand.mean),
         relative_error(estimate.covariance, hand.covariance),
         relative_error(imm.mode_probability(), hand.probability),
         std::abs(step.log_likelihood - hand.log_likelihood) / std::abs(hand.log_likelihood)});
  }
  return error <= tolerance;
}

template <class Scalar, int K>
void ours(benchmark::State& state) {
  const Course<Scalar> course;
  if (!agree<Scalar, K>(course)) state.SkipWithError("differs from the hand-written loop");
  go_round(state, started_imm<Scalar, K>(course), course.polar, [](auto& imm, const auto& z) {
    benchmark::DoNotOptimize(imm.predict(Scalar(kStep_s)));
    benchmark::DoNotOptimize(imm.update(kRadar, z));
    benchmark::DoNotOptimize(imm.estimate());
  });
}

template <class Scalar, int K>
void hand_loop(benchmark::State& state) {
  const Course<Scalar> course;
  go_round(state, HandImm<K, Scalar>(course.start), course.polar,
           [](auto& hand, const auto& z) { hand.step(z); });
}

}  // namespace

BENCHMARK(hand_loop<double, 3>)->Name("imm3_step/hand_loop");
BENCHMARK(ours<double, 3>)->Name("imm3_step/scalar_double");
BENCHMARK(hand_loop<float, 3>)->Name("imm3_step/hand_loop_float");
BENCHMARK(ours<float, 3>)->Name("imm3_step/scalar_float");
BENCHMARK(hand_loop<double, 5>)->Name("imm5_step/hand_loop");
BENCHMARK(ours<double, 5>)->Name("imm5_step/scalar_double");
BENCHMARK(hand_loop<float, 5>)->Name("imm5_step/hand_loop_float");
BENCHMARK(ours<float, 5>)->Name("imm5_step/scalar_float");
