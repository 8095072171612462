// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The filters of one model, those that read range and bearing, and the banks of lines.
#include "batch_timing.hpp"

namespace {

using namespace wakeline;
using namespace wakeline::bench;

template <class Scalar>
void kf(benchmark::State& state) {
  ours<Scalar>(state, kalman<Scalar>(), kFix, Work::kKalman);
}
template <class Scalar>
void ekf_polar(benchmark::State& state) {
  ours<Scalar>(state, polar_ekf<Scalar>(), kRadar, Work::kPolarEkf);
}
template <class Scalar>
void ukf5(benchmark::State& state) {
  ours<Scalar>(state, ukf<Scalar>(), kRadar, Work::kUkf5);
}
template <class Scalar>
void imm3_polar(benchmark::State& state) {
  ours<Scalar>(state, imm<3, Scalar>(), kRadar, Work::kImm3Polar);
}
template <class Scalar>
void imm5_polar(benchmark::State& state) {
  ours<Scalar>(state, imm<5, Scalar>(), kRadar, Work::kImm5Polar);
}
template <class Scalar>
void fuzzy(benchmark::State& state) {
  ours<Scalar>(state, FuzzyAlphaBeta<Scalar>(), kFix, Work::kFuzzy);
}
template <class Scalar>
void bayesian(benchmark::State& state) {
  ours<Scalar>(state, BayesianAlphaBeta<Scalar>(), kFix, Work::kBayesian);
}

}  // namespace

BENCHMARK(kf<Lanes<double>>)->Name("kf_step/batch_double")->Apply(best_of);
BENCHMARK(kf<double>)->Name("kf_step/scalar_double")->Apply(best_of);
BENCHMARK(kf<Lanes<float>>)->Name("kf_step/batch_float")->Apply(best_of);
BENCHMARK(ekf_polar<Lanes<double>>)->Name("ekf_polar_step/batch_double")->Apply(best_of);
BENCHMARK(ekf_polar<double>)->Name("ekf_polar_step/scalar_double")->Apply(best_of);
BENCHMARK(ekf_polar<Lanes<float>>)->Name("ekf_polar_step/batch_float")->Apply(best_of);
BENCHMARK(ukf5<Lanes<double>>)->Name("ukf5_step/batch_double")->Apply(best_of);
BENCHMARK(ukf5<double>)->Name("ukf5_step/scalar_double")->Apply(best_of);
BENCHMARK(ukf5<Lanes<float>>)->Name("ukf5_step/batch_float")->Apply(best_of);
BENCHMARK(imm3_polar<Lanes<double>>)->Name("imm3_polar_step/batch_double")->Apply(best_of);
BENCHMARK(imm3_polar<double>)->Name("imm3_polar_step/scalar_double")->Apply(best_of);
BENCHMARK(imm3_polar<Lanes<float>>)->Name("imm3_polar_step/batch_float")->Apply(best_of);
BENCHMARK(imm5_polar<Lanes<double>>)->Name("imm5_polar_step/batch_double")->Apply(best_of);
BENCHMARK(imm5_polar<double>)->Name("imm5_polar_step/scalar_double")->Apply(best_of);
BENCHMARK(fuzzy<Lanes<double>>)->Name("fuzzy_alpha_beta_step/batch_double")->Apply(best_of);
BENCHMARK(fuzzy<double>)->Name("fuzzy_alpha_beta_step/scalar_double")->Apply(best_of);
BENCHMARK(fuzzy<Lanes<float>>)->Name("fuzzy_alpha_beta_step/batch_float")->Apply(best_of);
BENCHMARK(bayesian<Lanes<double>>)->Name("bayesian_alpha_beta_step/batch_double")->Apply(best_of);
BENCHMARK(bayesian<double>)->Name("bayesian_alpha_beta_step/scalar_double")->Apply(best_of);
BENCHMARK(bayesian<Lanes<float>>)->Name("bayesian_alpha_beta_step/batch_float")->Apply(best_of);
