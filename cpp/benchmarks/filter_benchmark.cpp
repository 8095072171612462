// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// One step (predict, update) of one-model filters, beside hand-written loops of the same equations:
// textbook form, fixed-size Eigen, F and Q computed once. Both run along the same closed course;
// before the timing the loop is checked against ours.
//
//   kf_step         Kalman filter, 4 states, a position
//   ekf_polar_step  extended Kalman filter, 4 states, range and bearing
//   ukf5_step       unscented Kalman filter, 5 states (turn rate in the state), range and bearing

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "go_round.hpp"
#include "hand_loops.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"

namespace {

using namespace wakeline;
using namespace wakeline::bench;

template <class Scalar, class Filter, class Hand, class Sensor>
void check(benchmark::State& state, Filter filter, Hand hand, const Sensor& sensor,
           const std::vector<Vec<Scalar, 2>>& plots) {
  Scalar error = 0;
  for (const auto& z : plots) {
    (void)filter.predict(Scalar(kStep_s));
    const auto step = filter.update(sensor, z);
    hand.step(z);
    error = std::max({error, relative_error(filter.estimate().mean, hand.mean),
                      relative_error(filter.estimate().covariance, hand.covariance),
                      std::abs(step.log_likelihood / hand.log_likelihood - 1)});
  }
  if (!(error <= Scalar(1e-11))) state.SkipWithError("differs from the hand-written loop");
}

template <class Filter, class Sensor, class Plots>
void run_ours(benchmark::State& state, const Filter& started, const Sensor& sensor,
              const Plots& plots) {
  go_round(state, started, plots, [&](Filter& filter, const auto& z) {
    benchmark::DoNotOptimize(filter.predict(kStep_s));
    benchmark::DoNotOptimize(filter.update(sensor, z));
  });
}

template <class Hand, class Plots>
void run_hand(benchmark::State& state, const Hand& started, const Plots& plots) {
  go_round(state, started, plots, [](Hand& hand, const auto& z) { hand.step(z); });
}

const Course<double>& course() {
  static const Course<double> course;
  return course;
}

template <class Filter>
Filter started(const typename Filter::Motion& motion) {
  Filter filter(motion);
  (void)filter.start(course().start);
  return filter;
}

void kf_ours(benchmark::State& state) {
  const auto filter = started<Kalman<ConstantVelocity>>(kSteady);
  check<double>(state, filter, HandKalman<false, double>(course().start), kFix, course().position);
  run_ours(state, filter, kFix, course().position);
}
void kf_hand(benchmark::State& state) {
  run_hand(state, HandKalman<false, double>(course().start), course().position);
}

void ekf_ours(benchmark::State& state) {
  const auto filter = started<Ekf<ConstantVelocity>>(kSteady);
  check<double>(state, filter, HandKalman<true, double>(course().start), kRadar, course().polar);
  run_ours(state, filter, kRadar, course().polar);
}
void ekf_hand(benchmark::State& state) {
  run_hand(state, HandKalman<true, double>(course().start), course().polar);
}

void ukf_ours(benchmark::State& state) {
  const auto filter = started<Ukf<CoordinatedTurnRate>>(kTurning);
  check<double>(state, filter, HandUkf<double>(filter.estimate()), kRadar, course().polar);
  run_ours(state, filter, kRadar, course().polar);
}
void ukf_hand(benchmark::State& state) {
  run_hand(state, HandUkf<double>(started<Ukf<CoordinatedTurnRate>>(kTurning).estimate()),
           course().polar);
}

}  // namespace

BENCHMARK(kf_hand)->Name("kf_step/hand_loop");
BENCHMARK(kf_ours)->Name("kf_step/scalar_double");
BENCHMARK(ekf_hand)->Name("ekf_polar_step/hand_loop");
BENCHMARK(ekf_ours)->Name("ekf_polar_step/scalar_double");
BENCHMARK(ukf_hand)->Name("ukf5_step/hand_loop");
BENCHMARK(ukf_ours)->Name("ukf5_step/scalar_double");
