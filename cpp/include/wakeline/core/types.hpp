// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace wakeline {

/// Column vector of N scalars.
template <class Scalar, int N>
using Vec = Eigen::Matrix<Scalar, N, 1>;

/// Matrix of Rows x Cols scalars, column-major as Eigen has it.
template <class Scalar, int Rows, int Cols>
using Mat = Eigen::Matrix<Scalar, Rows, Cols>;

/// A Gaussian belief: mean (N) and covariance (N x N, symmetric positive definite).
template <int N, class Scalar = double>
struct Gaussian {
  Vec<Scalar, N> mean = Vec<Scalar, N>::Zero();
  Mat<Scalar, N, N> covariance = Mat<Scalar, N, N>::Identity();

  template <class Other>
  Gaussian<N, Other> cast() const {
    return {mean.template cast<Other>(), covariance.template cast<Other>()};
  }
};

/// Copies the lower triangle onto the upper one, so that the matrix is symmetric to the last bit.
template <class Scalar, int N>
void mirror_lower(Mat<Scalar, N, N>& matrix) noexcept {
  for (int column = 1; column < N; ++column)
    for (int row = 0; row < column; ++row) matrix(row, column) = matrix(column, row);
}

}  // namespace wakeline
