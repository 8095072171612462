// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline::test {

/// Random numbers of one seed, the same in every run.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  double normal() { return normal_(random_); }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  template <int N>
  Vec<double, N> normals() {
    Vec<double, N> draws;
    for (int k = 0; k < N; ++k) draws[k] = normal();
    return draws;
  }

  /// One draw of N(0, covariance), which may be semidefinite.
  template <int N>
  Vec<double, N> error(const Mat<double, N, N>& covariance) {
    return semidefinite_root<N, double>(covariance) * normals<N>();
  }

  /// One draw of N(mean, covariance).
  template <int N>
  Vec<double, N> of(const Gaussian<N>& belief) {
    return belief.mean + error<N>(belief.covariance);
  }

  /// A well-conditioned symmetric positive definite matrix.
  template <int N>
  Mat<double, N, N> definite() {
    Mat<double, N, N> a;
    for (int k = 0; k < N; ++k) a.col(k) = normals<N>();
    return a * a.transpose() + 0.1 * Mat<double, N, N>::Identity();
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

/// The largest difference of two covariances, each element in units of the standard deviations of
/// its row and column: what a tolerance means for matrices whose elements differ by orders of
/// magnitude.
template <class Scalar, int N>
double covariance_difference(const Mat<Scalar, N, N>& actual, const Mat<Scalar, N, N>& expected) {
  double worst = 0.0;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      const double scale =
          std::sqrt(static_cast<double>(expected(i, i)) * static_cast<double>(expected(j, j)));
      const double difference = std::abs(static_cast<double>(actual(i, j) - expected(i, j)));
      if (difference > 0.0 || std::isnan(difference)) worst = std::fmax(worst, difference / scale);
      if (std::isnan(difference)) return difference;
    }
  return worst;
}

/// Finite, symmetric to the last bit, and positive definite.
template <class Scalar, int N>
bool is_covariance(const Mat<Scalar, N, N>& matrix) {
  return is_finite(matrix) && matrix == matrix.transpose() && Cholesky<N, Scalar>(matrix).ok();
}

}  // namespace wakeline::test
