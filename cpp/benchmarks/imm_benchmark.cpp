// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT

// One step (predict, update, estimate) of an IMM with 3 or 5 coordinated turns of 4 states and a
// range-bearing EKF each, beside a hand-written loop of the same equations: textbook form,
// fixed-size Eigen, F and Q computed once. Both run along the same closed course; before the timing
// the loop is checked against ours.

#include <benchmark/benchmark.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "models.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace {

using namespace wakeline;
using namespace wakeline::bench;

/// The IMM as one writes it down from the book for one problem.
template <int K, class Scalar>
class HandImm {
  using State = Vec<Scalar, 4>;
  using StateMatrix = Mat<Scalar, 4, 4>;
  using Plot2 = Vec<Scalar, 2>;
  using PlotMatrix = Mat<Scalar, 2, 2>;

 public:
  Scalar log_likelihood = Scalar(0);
  Vec<Scalar, K> probability;
  State mean;
  StateMatrix covariance;

  explicit HandImm(const Gaussian<4, Scalar>& start)
      : probability(Vec<Scalar, K>::Constant(Scalar(1) / K)),
        chain_(transition<K>().template cast<Scalar>()) {
    for (int j = 0; j < K; ++j) {
      f_[j] = turning(j).matrix(Scalar(kStep_s));
      q_[j] = turning(j).process_noise(Scalar(kStep_s));
      x_[j] = start.mean;
      p_[j] = start.covariance;
    }
    r_ << Scalar(kRadar.range_std_m * kRadar.range_std_m), 0, 0,
        Scalar(kRadar.bearing_std_rad * kRadar.bearing_std_rad);
  }

  void step(const Plot2& z) {
    // Mixing
    const Vec<Scalar, K> expected = chain_.transpose() * probability;
    State x0[K];
    StateMatrix p0[K];
    for (int j = 0; j < K; ++j) {
      Vec<Scalar, K> w;
      for (int i = 0; i < K; ++i) w[i] = chain_(i, j) * probability[i] / expected[j];
      x0[j].setZero();
      for (int i = 0; i < K; ++i) x0[j] += w[i] * x_[i];
      p0[j].setZero();
      for (int i = 0; i < K; ++i) {
        const State d = x_[i] - x0[j];
        p0[j] += w[i] * (p_[i] + d * d.transpose());
      }
    }
    // Filters
    Vec<Scalar, K> likelihood;
    for (int j = 0; j < K; ++j) {
      x_[j] = f_[j] * x0[j];
      p_[j] = f_[j] * p0[j] * f_[j].transpose() + q_[j];

      const Scalar range2 = x_[j][0] * x_[j][0] + x_[j][2] * x_[j][2];
      const Scalar range = std::sqrt(range2);
      Mat<Scalar, 2, 4> h;
      h << x_[j][0] / range, 0, x_[j][2] / range, 0, -x_[j][2] / range2, 0, x_[j][0] / range2, 0;
      Plot2 v(z[0] - range, z[1] - std::atan2(x_[j][2], x_[j][0]));
      v[1] = wrap_angle(v[1]);
      const Mat<Scalar, 4, 2> pht = p_[j] * h.transpose();
      const PlotMatrix s = h * pht + r_;
      const PlotMatrix s_inverse = s.inverse();
      const Mat<Scalar, 4, 2> gain = pht * s_inverse;
      x_[j] += gain * v;
      p_[j] -= gain * s * gain.transpose();
      likelihood[j] =
          std::exp(-v.dot(s_inverse * v) / 2) / (2 * kPi<Scalar> * std::sqrt(s.determinant()));
    }
    // Mode probabilities and combined estimate
    probability = expected.cwiseProduct(likelihood);
    const Scalar total = probability.sum();
    probability /= total;
    log_likelihood = std::log(total);
    mean.setZero();
    for (int j = 0; j < K; ++j) mean += probability[j] * x_[j];
    covariance.setZero();
    for (int j = 0; j < K; ++j) {
      const State d = x_[j] - mean;
      covariance += probability[j] * (p_[j] + d * d.transpose());
    }
  }

 private:
  Mat<Scalar, K, K> chain_;
  StateMatrix f_[K], q_[K];
  PlotMatrix r_;
  State x_[K];
  StateMatrix p_[K];
};

template <class Scalar, int... Modes>
auto make_imm(std::integer_sequence<int, Modes...>) {
  constexpr int kModes = sizeof...(Modes);
  return Imm{ModeChain<kModes>(transition<kModes>()),
             Ekf<CoordinatedTurn, Scalar>(turning(Modes))...};
}

template <class Scalar, int K>
auto started_imm(const Course<Scalar>& course) {
  auto imm = make_imm<Scalar>(std::make_integer_sequence<int, K>{});
  (void)imm.start(course.start);
  return imm;
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
