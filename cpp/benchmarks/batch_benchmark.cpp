// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// Steps (predict, update, estimate) in the lanes of packs, built once for each instruction set:
//
//   imm3_step, imm5_step    IMM of coordinated turns, 4 states, a position
//   imm3_polar_step, ...    the same, range and bearing
//   kf_step                 Kalman filter, 4 states, a position
//   ekf_polar_step          extended Kalman filter, 4 states, range and bearing
//   ukf5_step               unscented Kalman filter, 5 states, range and bearing
//   fuzzy_alpha_beta_step, bayesian_alpha_beta_step
//                           lines through up to 10 plots, a position
//   mode_history100_scan    a scan of a tree of 100 hypotheses, which stand in the lanes
//   imm3_run                `run_batch` over 500 recordings of 250 scans, all results kept
//   fma_peak                what the machine could do: independent multiplications and additions
//
// `ns_a_step` is the time of one lane, `flops` the sums and products that the template does in one
// step, `of_peak` their share of the measured peak. Beside it run the same template over plain
// numbers and, of the IMM, two hand-written loops over packs, checked against ours.

#include <string>

#include "batch_timing.hpp"
#include "hand_lanes.hpp"

namespace {

using namespace wakeline;
using namespace wakeline::bench;

/// Element by element, of one lane.
template <class Scalar, int Rows, int Cols>
Mat<RealOf<Scalar>, Rows, Cols> in_lane(const Mat<Scalar, Rows, Cols>& of, int k) {
  Mat<RealOf<Scalar>, Rows, Cols> one;
  for (Eigen::Index i = 0; i < of.size(); ++i) one.data()[i] = lane(of.data()[i], k);
  return one;
}

/// Ours, and what the loop gives after the same steps: they must not differ by more than rounding.
template <int K, class Scalar, class Hand>
bool agrees(Hand hand, const LaneCourse<Scalar>& course) {
  using Real = RealOf<Scalar>;
  const Real tolerance = sizeof(Real) > 4 ? Real(1e-11) : Real(5e-3);
  auto filter = imm<K, Scalar>();
  (void)filter.start(course.start);
  Real error = 0;
  for (const auto& z : course.position) {
    const auto step = take(filter, kFix, z);
    const auto estimate = filter.estimate();
    hand.step(z);
    for (int k = 0; k < kLanesOf<Scalar>; ++k)
      error = std::max(
          {error, relative_error(in_lane(estimate.mean, k), in_lane(hand.mean, k)),
           relative_error(in_lane(estimate.covariance, k), in_lane(hand.covariance, k)),
           relative_error(in_lane(filter.mode_probability(), k), in_lane(hand.probability, k)),
           std::abs(lane(step.log_likelihood, k) / lane(hand.log_likelihood, k) - 1)});
  }
  return error <= tolerance;
}

template <int K, class Scalar, class Hand, Work kWork>
void by_hand(benchmark::State& state) {
  static const LaneCourse<Scalar> course;
  const Hand started(course.start);
  if (!agrees<K, Scalar>(started, course)) state.SkipWithError("differs from ours");
  const double seconds = seconds_of([&] {
    go_round(state, started, course.position, [](Hand& hand, const auto& z) { hand.step(z); });
  });
  tell_arithmetic<Scalar>(state, arithmetic_of(kWork), tell_time<Scalar>(state, seconds));
}

template <int K, class Scalar>
void imm_step(benchmark::State& state) {
  ours<Scalar>(state, imm<K, Scalar>(), kFix, K == 3 ? Work::kImm3 : Work::kImm5);
}

template <class Real>
void fma_peak(benchmark::State& state) {
  Real result = 1;
  double operations = 0.0;
  for (auto _ : state) {
    operations += multiply_and_add(result);
    benchmark::DoNotOptimize(result);
  }
  state.counters["GFLOP"] = benchmark::Counter(1e-9 * operations, benchmark::Counter::kIsRate);
}

template <int K>
void add_imm(const std::string& name) {
  const auto add = [&](const char* who, auto* function) {
    best_of(benchmark::RegisterBenchmark((name + who).c_str(), function));
  };
  constexpr Work kTuned = K == 3 ? Work::kImm3Tuned : Work::kImm5Tuned;
  constexpr Work kPlain = K == 3 ? Work::kImm3Plain : Work::kImm5Plain;
  using Packs = Lanes<double>;
  using FloatPacks = Lanes<float>;
  add("/batch_double", imm_step<K, Packs>);
  add("/hand_lanes", by_hand<K, Packs, TunedLanes<K, Packs>, kTuned>);
  add("/hand_lanes_plain", by_hand<K, Packs, PlainLanes<K, Packs>, kPlain>);
  add("/scalar_double", imm_step<K, double>);
  add("/batch_float", imm_step<K, FloatPacks>);
  add("/hand_lanes_float", by_hand<K, FloatPacks, TunedLanes<K, FloatPacks>, kTuned>);
}

const bool kAdded = [] {
  add_imm<3>("imm3_step");
  add_imm<5>("imm5_step");
  return true;
}();

}  // namespace

BENCHMARK(fma_peak<double>)->Name("fma_peak/double")->Apply(best_of);
BENCHMARK(fma_peak<float>)->Name("fma_peak/float")->Apply(best_of);
