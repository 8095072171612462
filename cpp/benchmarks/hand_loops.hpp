// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Filters of one track as one writes them down from the book for one problem: fixed-size Eigen, F
// and Q computed once, nothing checked.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "models.hpp"

namespace wakeline::bench {

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
        mean(start.mean),
        covariance(start.covariance),
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

}  // namespace wakeline::bench
