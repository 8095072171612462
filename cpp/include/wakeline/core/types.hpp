// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/environment.hpp"

#include <Eigen/Core>
#include <concepts>
#include <type_traits>

#include "wakeline/simd/scalar.hpp"
#include "wakeline/simd/unroll.hpp"

namespace wakeline {

/// Column vector of N scalars.
template <class Scalar, int N>
using Vec = Eigen::Matrix<Scalar, N, 1>;

/// Matrix of Rows x Cols scalars, column-major as in Eigen.
template <class Scalar, int Rows, int Cols>
using Mat = Eigen::Matrix<Scalar, Rows, Cols>;

/// An Eigen expression of the size of `Wanted`. (Convertibility alone does not check sizes: Eigen
/// reports a mismatch as an error inside the conversion.)
template <class Given, class Wanted>
concept SameSize =
    std::convertible_to<Given, Wanted> && std::remove_cvref_t<Given>::RowsAtCompileTime ==
    Wanted::RowsAtCompileTime&& std::remove_cvref_t<Given>::ColsAtCompileTime ==
    Wanted::ColsAtCompileTime;

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

/// Assigns `value` in the lanes where the condition holds.
template <class Mask, class Scalar, int Rows, int Cols>
[[gnu::always_inline]] inline void assign_where(const Mask& condition,
                                                Mat<Scalar, Rows, Cols>& target,
                                                const Mat<Scalar, Rows, Cols>& value) noexcept {
  unroll<Rows * Cols>(
      [&](int k) { target.data()[k] = select(condition, value.data()[k], target.data()[k]); });
}

/// Replaces a belief where the condition holds.
template <class Mask, int N, class Scalar>
[[gnu::always_inline]] inline void assign_where(const Mask& condition, Gaussian<N, Scalar>& target,
                                                const Gaussian<N, Scalar>& value) noexcept {
  assign_where(condition, target.mean, value.mean);
  assign_where(condition, target.covariance, value.covariance);
}

/// Copies element by element, as the hot steps write and read: a wide load after narrow stores
/// would stall the processor.
template <int N, class Scalar>
[[gnu::always_inline]] inline void copy(const Gaussian<N, Scalar>& from,
                                        Gaussian<N, Scalar>& to) noexcept {
  unroll<N>([&](int k) { to.mean.data()[k] = from.mean.data()[k]; });
  unroll<N * N>([&](int k) { to.covariance.data()[k] = from.covariance.data()[k]; });
}

/// True where mean and covariance are contiguous in memory, which all but unusual alignments are.
template <int N, class Real = double>
inline constexpr bool kInARow = sizeof(Gaussian<N, Real>) == N*(N + 1) * sizeof(Real);

/// The elements of a belief: mean, then covariance.
template <int N, class Belief>
struct NumbersOf {
  Belief& belief;
  auto& operator[](int k) const noexcept {
    return k < N ? belief.mean.data()[k] : belief.covariance.data()[k - N];
  }
};

/// Lane k of `to` is the belief `of_lane(k)`; `scatter_lanes` is the reverse for the first `count`
/// lanes.
template <int N, class Scalar, class OfLane>
[[gnu::always_inline]] inline void gather_lanes(const OfLane& of_lane,
                                                Gaussian<N, Scalar>& to) noexcept {
  if constexpr (kInARow<N, RealOf<Scalar>>) {
    gather_lanes<N*(N + 1)>([&](int k) { return of_lane(k).mean.data(); },
                            NumbersOf<N, Gaussian<N, Scalar>>{to});
  } else {
    gather_lanes<N>([&](int k) { return of_lane(k).mean.data(); }, to.mean.data());
    gather_lanes<N * N>([&](int k) { return of_lane(k).covariance.data(); }, to.covariance.data());
  }
}
/// Copies the first `count` lanes to the beliefs `of_lane(k)`.
template <int N, class Scalar, class OfLane>
[[gnu::always_inline]] inline void scatter_lanes(const Gaussian<N, Scalar>& from, int count,
                                                 const OfLane& of_lane) noexcept {
  if constexpr (kInARow<N, RealOf<Scalar>>) {
    scatter_lanes<N*(N + 1)>(NumbersOf<N, const Gaussian<N, Scalar>>{from}, count,
                             [&](int k) { return of_lane(k).mean.data(); });
  } else {
    scatter_lanes<N>(from.mean.data(), count, [&](int k) { return of_lane(k).mean.data(); });
    scatter_lanes<N * N>(from.covariance.data(), count,
                         [&](int k) { return of_lane(k).covariance.data(); });
  }
}

/// a b of small matrices, as loops: Eigen's product of two is some fifty templates to compile.
template <class Scalar, int Rows, int Inner, int Cols>
Mat<Scalar, Rows, Cols> product(const Mat<Scalar, Rows, Inner>& a,
                                const Mat<Scalar, Inner, Cols>& b) noexcept {
  Mat<Scalar, Rows, Cols> c;
  for (int column = 0; column < Cols; ++column)
    for (int row = 0; row < Rows; ++row) {
      Scalar sum = a(row, 0) * b(0, column);
      for (int k = 1; k < Inner; ++k) sum += a(row, k) * b(k, column);
      c(row, column) = sum;
    }
  return c;
}

/// a bᵀ.
template <class Scalar, int Rows, int Inner, int Cols>
Mat<Scalar, Rows, Cols> product_transposed(const Mat<Scalar, Rows, Inner>& a,
                                           const Mat<Scalar, Cols, Inner>& b) noexcept {
  Mat<Scalar, Rows, Cols> c;
  for (int column = 0; column < Cols; ++column)
    for (int row = 0; row < Rows; ++row) {
      Scalar sum = a(row, 0) * b(column, 0);
      for (int k = 1; k < Inner; ++k) sum += a(row, k) * b(column, k);
      c(row, column) = sum;
    }
  return c;
}

/// Copies the lower triangle to the upper one, so that the matrix is exactly symmetric.
template <class Scalar, int N>
[[gnu::always_inline]] inline void mirror_lower(Mat<Scalar, N, N>& matrix) noexcept {
  unroll_lower<N>([&](int row, int column) { matrix(column, row) = matrix(row, column); });
}

}  // namespace wakeline
