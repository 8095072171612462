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

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "models.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"

namespace {

using namespace wakeline;
using namespace wakeline::bench;

/// ln N(v; 0, S).
template <class Scalar>
Scalar log_normal(const Vec<Scalar, 2>& v, const Mat<Scalar, 2, 2>& s,
                  const Mat<Scalar, 2, 2>& s_inverse) {
  return -(v.dot(s_inverse * v) + std::log(s.determinant())) / 2 - std::log(2 * kPi<Scalar>);
}

/// Range and bearing of the position in a state `[x, vx, y, ...]`.
template <class State>
Vec<typename State::Scalar, 2> polar(const State& x) {
  return {std::sqrt(x[0] * x[0] + x[2] * x[2]), std::atan2(x[2], x[0])};
}

template <class Scalar>
Mat<Scalar, 2, 2> radar_covariance() {
  return Vec<Scalar, 2>(Scalar(kRadar.range_std_m * kRadar.range_std_m),
                        Scalar(kRadar.bearing_std_rad * kRadar.bearing_std_rad))
      .asDiagonal();
}

/// The Kalman filter as one writes it down from the book; with `Polar` the extended one.
template <bool Polar, class Scalar>
struct HandKalman {
  Vec<Scalar, 4> mean;
  Mat<Scalar, 4, 4> covariance;
  Scalar log_likelihood = Scalar(0);
  Mat<Scalar, 4, 4> f = kSteady.matrix(Scalar(kStep_s));
  Mat<Scalar, 4, 4> q = kSteady.process_noise(Scalar(kStep_s));
  Mat<Scalar, 2, 4> h = Mat<Scalar, 2, 4>::Zero();
  Mat<Scalar, 2, 2> r = radar_covariance<Scalar>();

  explicit HandKalman(const Gaussian<4, Scalar>& start)
      : mean(start.mean), covariance(start.covariance) {
    h(0, 0) = h(1, 2) = Scalar(1);
    if (!Polar)
      r = Scalar(kFix.position_std_m * kFix.position_std_m) * Mat<Scalar, 2, 2>::Identity();
  }

  void step(const Vec<Scalar, 2>& z) {
    mean = f * mean;
    covariance = f * covariance * f.transpose() + q;
    Vec<Scalar, 2> v;
    if constexpr (Polar) {
      const Vec<Scalar, 2> expected = polar(mean);
      const Scalar range = expected[0], range2 = range * range;
      h << mean[0] / range, 0, mean[2] / range, 0, -mean[2] / range2, 0, mean[0] / range2, 0;
      v = z - expected;
      v[1] = wrap_angle(v[1]);
    } else {
      v = z - h * mean;
    }
    const Mat<Scalar, 4, 2> pht = covariance * h.transpose();
    const Mat<Scalar, 2, 2> s = h * pht + r;
    const Mat<Scalar, 2, 2> s_inverse = s.inverse();
    const Mat<Scalar, 4, 2> gain = pht * s_inverse;
    mean += gain * v;
    covariance -= gain * s * gain.transpose();
    log_likelihood = log_normal(v, s, s_inverse);
  }
};

/// The unscented Kalman filter of the book, kappa = 0: 2 N points of equal weight and the centre
/// for the covariance.
template <class Scalar>
struct HandUkf {
  static constexpr int kN = 5;
  using Points = Mat<Scalar, kN, 2 * kN>;

  Vec<Scalar, kN> mean;
  Mat<Scalar, kN, kN> covariance;
  Scalar log_likelihood = Scalar(0);
  Mat<Scalar, 2, 2> r = radar_covariance<Scalar>();

  explicit HandUkf(const Gaussian<kN, Scalar>& start)
      : mean(start.mean), covariance(start.covariance) {}

  Points points() const {
    const Mat<Scalar, kN, kN> root =
        std::sqrt(Scalar(kN)) * covariance.llt().matrixL().toDenseMatrix();
    Points sigma;
    sigma << root.colwise() + mean, (-root).colwise() + mean;
    return sigma;
  }

  void step(const Vec<Scalar, 2>& z) {
    constexpr Scalar w = Scalar(1) / (2 * kN);
    constexpr Scalar w_centre = Scalar(2);  // 1 - alpha² + beta, alpha = 1, beta = 2
    const Mat<Scalar, kN, kN> q = kTurning.process_noise(mean, Scalar(kStep_s));
    Points sigma = points();
    for (int k = 0; k < 2 * kN; ++k)
      sigma.col(k) = kTurning.transition(Vec<Scalar, kN>(sigma.col(k)), Scalar(kStep_s));
    const Vec<Scalar, kN> centre = kTurning.transition(mean, Scalar(kStep_s));
    mean = w * sigma.rowwise().sum();
    const Points e = sigma.colwise() - mean;
    covariance =
        w * e * e.transpose() + w_centre * (centre - mean) * (centre - mean).transpose() + q;

    sigma = points();
    const Vec<Scalar, 2> at_mean = polar(mean);
    Mat<Scalar, 2, 2 * kN> y;
    for (int k = 0; k < 2 * kN; ++k) {
      y.col(k) = polar(Vec<Scalar, kN>(sigma.col(k))) - at_mean;
      y(1, k) = wrap_angle(y(1, k));
    }
    const Vec<Scalar, 2> shift = w * y.rowwise().sum();
    const Mat<Scalar, 2, 2 * kN> d = y.colwise() - shift;
    const Mat<Scalar, 2, 2> s = w * d * d.transpose() + w_centre * shift * shift.transpose() + r;
    const Mat<Scalar, kN, 2> cross = w * (sigma.colwise() - mean) * d.transpose();
    Vec<Scalar, 2> v = z - at_mean - shift;
    v[1] = wrap_angle(v[1]);
    const Mat<Scalar, 2, 2> s_inverse = s.inverse();
    const Mat<Scalar, kN, 2> gain = cross * s_inverse;
    mean += gain * v;
    covariance -= gain * s * gain.transpose();
    log_likelihood = log_normal(v, s, s_inverse);
  }
};

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
