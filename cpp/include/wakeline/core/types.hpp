// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "wakeline/core/scalar.hpp"
#include "wakeline/core/unroll.hpp"

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

/// Takes `value` where the condition holds, lane by lane.
template <class Mask, class Scalar, int Rows, int Cols>
[[gnu::always_inline]] inline void assign_where(const Mask& condition,
                                                Mat<Scalar, Rows, Cols>& target,
                                                const Mat<Scalar, Rows, Cols>& value) noexcept {
  unroll<Rows * Cols>(
      [&](int k) { target.data()[k] = select(condition, value.data()[k], target.data()[k]); });
}

template <class Mask, int N, class Scalar>
[[gnu::always_inline]] inline void assign_where(const Mask& condition, Gaussian<N, Scalar>& target,
                                                const Gaussian<N, Scalar>& value) noexcept {
  assign_where(condition, target.mean, value.mean);
  assign_where(condition, target.covariance, value.covariance);
}

/// Number by number, as the hot steps write and read: a processor waits where a wide load follows
/// narrow stores.
template <int N, class Scalar>
[[gnu::always_inline]] inline void copy(const Gaussian<N, Scalar>& from,
                                        Gaussian<N, Scalar>& to) noexcept {
  unroll<N>([&](int k) { to.mean.data()[k] = from.mean.data()[k]; });
  unroll<N * N>([&](int k) { to.covariance.data()[k] = from.covariance.data()[k]; });
}

/// Copies the lower triangle onto the upper one, so that the matrix is symmetric to the last bit.
template <class Scalar, int N>
[[gnu::always_inline]] inline void mirror_lower(Mat<Scalar, N, N>& matrix) noexcept {
  unroll_lower<N>([&](int row, int column) { matrix(column, row) = matrix(row, column); });
}

}  // namespace wakeline
