// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The IMM of coordinated turns and position plots as one writes it by hand for packs, for one
// problem only: F and Q computed once, nothing checked, no missed scans, and of the step only the
// log-likelihood.
#pragma once

#include <cmath>

#include "batch_works.hpp"

namespace wakeline::bench {

/// As the book has it: full matrices, P - K S Kᵀ, a division wherever there is one in the formula.
template <int K, class Scalar>
class PlainLanes {
  using State = Vec<Scalar, 4>;
  using StateMatrix = Mat<Scalar, 4, 4>;
  using PlotMatrix = Mat<Scalar, 2, 2>;

 public:
  Scalar log_likelihood = Scalar(0);
  Vec<Scalar, K> probability = Vec<Scalar, K>::Constant(Scalar(1) / Scalar(K));
  State mean;
  StateMatrix covariance;

  explicit PlainLanes(const Gaussian<4, Scalar>& start)
      : chain_(transition<K>().template cast<Scalar>()) {
    for (int j = 0; j < K; ++j) {
      f_[j] = turning(j).matrix(Scalar(kStep_s));
      q_[j] = turning(j).process_noise(Scalar(kStep_s));
      x_[j] = start.mean;
      p_[j] = start.covariance;
    }
  }

  [[gnu::flatten]] void step(const Vec<Scalar, 2>& z) noexcept {
    using std::exp, std::log, std::sqrt;
    const Scalar r = RealOf<Scalar>(kFix.position_std_m * kFix.position_std_m);
    // Mixing
    const Vec<Scalar, K> expected = chain_.transpose() * probability;
    State x0[K];
    StateMatrix p0[K];
    for (int j = 0; j < K; ++j) {
      Vec<Scalar, K> w;
      for (int i = 0; i < K; ++i) w[i] = chain_(i, j) * probability[i] / expected[j];
      x0[j] = w[0] * x_[0];
      for (int i = 1; i < K; ++i) x0[j] += w[i] * x_[i];
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

      const Vec<Scalar, 2> v(z[0] - x_[j][0], z[1] - x_[j][2]);
      Mat<Scalar, 4, 2> pht;
      pht << p_[j].col(0), p_[j].col(2);
      PlotMatrix s;
      s << pht(0, 0) + r, pht(0, 1), pht(2, 0), pht(2, 1) + r;
      const Scalar determinant = s(0, 0) * s(1, 1) - s(0, 1) * s(1, 0);
      PlotMatrix s_inverse;
      s_inverse << s(1, 1) / determinant, -s(0, 1) / determinant, -s(1, 0) / determinant,
          s(0, 0) / determinant;
      const Mat<Scalar, 4, 2> gain = pht * s_inverse;
      x_[j] += gain * v;
      p_[j] -= gain * s * gain.transpose();
      likelihood[j] =
          exp(-v.dot(s_inverse * v) / 2) / (RealOf<Scalar>(2 * kPi<double>) * sqrt(determinant));
    }
    // Mode probabilities and combined estimate
    probability = expected.cwiseProduct(likelihood);
    const Scalar total = probability.sum();
    probability /= total;
    log_likelihood = log(total);
    mean = probability[0] * x_[0];
    for (int j = 1; j < K; ++j) mean += probability[j] * x_[j];
    covariance.setZero();
    for (int j = 0; j < K; ++j) {
      const State d = x_[j] - mean;
      covariance += probability[j] * (p_[j] + d * d.transpose());
    }
  }

 private:
  Mat<Scalar, K, K> chain_;
  StateMatrix f_[K], q_[K];
  State x_[K];
  StateMatrix p_[K];
};

// Loops of known length over small arrays live in registers only when they are unrolled.
#define WAKELINE_UNROLLED _Pragma("GCC unroll 8")

/// With what can be spared: only the lower triangle of a symmetric matrix, the products with F
/// without its zeros, closed forms with one root and no division, and second moments
/// M = P + (x - mean)(x - mean)ᵀ about the last estimate, which all mixtures share.
template <int K, class Scalar>
class TunedLanes {
  using Real = RealOf<Scalar>;
  struct Mode {
    Scalar x[4];     ///< mean
    Scalar p[4][4];  ///< lower triangle of the covariance
    Scalar d[4];     ///< mean less the estimate
    Scalar m[4][4];  ///< lower triangle of the second moments about the estimate
    Real f[4][4], q[4][4];
  };

 public:
  Scalar log_likelihood = Scalar(0);
  Vec<Scalar, K> probability = Vec<Scalar, K>::Constant(Scalar(1) / Scalar(K));
  Vec<Scalar, 4> mean;
  Mat<Scalar, 4, 4> covariance;

  explicit TunedLanes(const Gaussian<4, Scalar>& start)
      : mean(start.mean), covariance(start.covariance) {
    for (int j = 0; j < K; ++j) {
      const Mat<double, 4, 4> f = turning(j).matrix(kStep_s);
      const Mat<double, 4, 4> q = turning(j).process_noise(kStep_s);
      for (int row = 0; row < 4; ++row) {
        mode_[j].d[row] = Scalar(0);
        for (int column = 0; column < 4; ++column) {
          mode_[j].m[row][column] = start.covariance(row, column);
          mode_[j].f[row][column] = Real(f(row, column));
          mode_[j].q[row][column] = Real(q(row, column));
        }
      }
      for (int i = 0; i < K; ++i) chain_[i][j] = Real(transition<K>()(i, j));
    }
  }

  [[gnu::flatten]] void step(const Vec<Scalar, 2>& z) noexcept {
    using std::log;
    Scalar likely[K];
    WAKELINE_UNROLLED
    for (int j = 0; j < K; ++j) {
      Scalar weight[K];
      WAKELINE_UNROLLED
      for (int i = 0; i < K; ++i) weight[i] = Scalar(chain_[i][j]) * probability[i];
      likely[j] = sum(weight);
      const Scalar scale = reciprocal(likely[j]);
      WAKELINE_UNROLLED
      for (int i = 0; i < K; ++i) weight[i] *= scale;
      mix(mode_[j], weight);
    }
    WAKELINE_UNROLLED
    for (int j = 0; j < K; ++j) {
      predict(mode_[j]);
      likely[j] *= update(mode_[j], z);
    }
    const Scalar total = sum(likely);
    const Scalar scale = reciprocal(total);
    WAKELINE_UNROLLED
    for (int j = 0; j < K; ++j) probability[j] = likely[j] * scale;
    log_likelihood = log(total);
    combine();
  }

 private:
  static Scalar sum(const Scalar (&of)[K]) noexcept {
    Scalar total = of[0];
    WAKELINE_UNROLLED
    for (int i = 1; i < K; ++i) total += of[i];
    return total;
  }

  /// x = estimate + o and P = sum of w M less o oᵀ, with the offset o = sum of w d.
  void mix(Mode& mode, const Scalar (&weight)[K]) noexcept {
    Scalar offset[4];
    WAKELINE_UNROLLED
    for (int row = 0; row < 4; ++row) {
      offset[row] = weight[0] * mode_[0].d[row];
      WAKELINE_UNROLLED
      for (int i = 1; i < K; ++i) offset[row] += weight[i] * mode_[i].d[row];
      mode.x[row] = mean[row] + offset[row];
      WAKELINE_UNROLLED
      for (int column = 0; column <= row; ++column) {
        Scalar element = weight[0] * mode_[0].m[row][column];
        WAKELINE_UNROLLED
        for (int i = 1; i < K; ++i) element += weight[i] * mode_[i].m[row][column];
        mode.p[row][column] = element - offset[row] * offset[column];
      }
    }
  }

  /// Row i of F times v, where the rows of F are 1 a 0 b, 0 c 0 d, 0 e 1 f, 0 g 0 h.
  static Scalar row_times(const Mode& mode, int i, const Scalar (&v)[4]) noexcept {
    const Scalar turned = Scalar(mode.f[i][1]) * v[1] + Scalar(mode.f[i][3]) * v[3];
    return i % 2 == 0 ? v[i] + turned : turned;
  }

  /// x = F x, P = F P Fᵀ + Q.
  static void predict(Mode& mode) noexcept {
    Scalar x[4], fp[4][4];
    WAKELINE_UNROLLED
    for (int row = 0; row < 4; ++row) x[row] = row_times(mode, row, mode.x);
    WAKELINE_UNROLLED
    for (int row = 0; row < 4; ++row) mode.x[row] = x[row];
    WAKELINE_UNROLLED
    for (int column = 0; column < 4; ++column) {
      Scalar of_p[4];
      WAKELINE_UNROLLED
      for (int k = 0; k < 4; ++k) of_p[k] = k < column ? mode.p[column][k] : mode.p[k][column];
      WAKELINE_UNROLLED
      for (int row = 0; row < 4; ++row) fp[row][column] = row_times(mode, row, of_p);
    }
    WAKELINE_UNROLLED
    for (int row = 0; row < 4; ++row) WAKELINE_UNROLLED
    for (int column = 0; column <= row; ++column)
      mode.p[row][column] = Scalar(mode.q[row][column]) + row_times(mode, column, fp[row]);
  }

  /// Corrects a mode and returns its likelihood.
  static Scalar update(Mode& mode, const Vec<Scalar, 2>& z) noexcept {
    using std::exp;
    constexpr Real kVariance = Real(kFix.position_std_m * kFix.position_std_m);
    auto& p = mode.p;
    const Scalar s00 = p[0][0] + kVariance, s10 = p[2][0], s11 = p[2][2] + kVariance;
    const Scalar inverse_root = inverse_sqrt(s00 * s11 - s10 * s10);
    const Scalar inverse_determinant = inverse_root * inverse_root;
    const Scalar i00 = s11 * inverse_determinant, i10 = -s10 * inverse_determinant,
                 i11 = s00 * inverse_determinant;
    const Scalar north = z[0] - mode.x[0], east = z[1] - mode.x[2];
    const Scalar nis = (i00 * north + (i10 + i10) * east) * north + i11 * east * east;
    const Scalar by_north[4] = {p[0][0], p[1][0], p[2][0], p[3][0]};
    const Scalar by_east[4] = {p[2][0], p[2][1], p[2][2], p[3][2]};
    Scalar gain_north[4], gain_east[4];
    WAKELINE_UNROLLED
    for (int row = 0; row < 4; ++row) {
      gain_north[row] = by_north[row] * i00 + by_east[row] * i10;
      gain_east[row] = by_north[row] * i10 + by_east[row] * i11;
      mode.x[row] += gain_north[row] * north + gain_east[row] * east;
    }
    WAKELINE_UNROLLED
    for (int row = 0; row < 4; ++row) WAKELINE_UNROLLED
    for (int column = 0; column <= row; ++column)
      p[row][column] -= gain_north[row] * by_north[column] + gain_east[row] * by_east[column];
    return Real(0.5 / kPi<double>) * inverse_root * exp(Real(-0.5) * nis);
  }

  void combine() noexcept {
    WAKELINE_UNROLLED
    for (int row = 0; row < 4; ++row) {
      mean[row] = probability[0] * mode_[0].x[row];
      WAKELINE_UNROLLED
      for (int j = 1; j < K; ++j) mean[row] += probability[j] * mode_[j].x[row];
      WAKELINE_UNROLLED
      for (int j = 0; j < K; ++j) mode_[j].d[row] = mode_[j].x[row] - mean[row];
      WAKELINE_UNROLLED
      for (int column = 0; column <= row; ++column) {
        Scalar element = Scalar(0);
        WAKELINE_UNROLLED
        for (int j = 0; j < K; ++j) {
          Mode& mode = mode_[j];
          mode.m[row][column] = mode.p[row][column] + mode.d[row] * mode.d[column];
          element += probability[j] * mode.m[row][column];
        }
        covariance(row, column) = covariance(column, row) = element;
      }
    }
  }

  Real chain_[K][K];
  Mode mode_[K];
};

#undef WAKELINE_UNROLLED

}  // namespace wakeline::bench
