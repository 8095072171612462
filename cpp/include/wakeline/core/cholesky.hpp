// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// The checked Cholesky factorisation A = L Lᵀ of a symmetric N x N matrix. Only the lower triangle
/// of A is read.
///
/// All covariances in the library are factorised here. `ok()` is false when A is not positive
/// definite or not finite; the other members must not be used then. With packs each lane has its
/// own factorisation. No heap, no exceptions.
template <int N, class Scalar = double>
class Cholesky {
 public:
  Cholesky() = default;
  explicit Cholesky(const Mat<Scalar, N, N>& matrix) noexcept { compute(matrix); }

  /// Factorises another matrix.
  void compute(const Mat<Scalar, N, N>& matrix) noexcept {
    ok_ = true;
    unroll_lower<N>([&](int row, int column) {
      if (row > column) lower_(column, row) = Scalar(0);
    });
    if constexpr (N == 2) {
      compute_2x2(matrix(0, 0), matrix(1, 0), matrix(1, 1));
    } else {
      unroll<N>([&](auto column) {
        constexpr int kColumn = column.value;
        const Scalar* of_column = lower_.data() + kColumn;
        const Scalar pivot =
            less_products<kColumn, N>(matrix(kColumn, kColumn), of_column, of_column);
        ok_ = ok_ && is_variance(pivot);
        inverse_diagonal_[kColumn] = inverse_sqrt(pivot);
        lower_(kColumn, kColumn) = pivot * inverse_diagonal_[kColumn];
        unroll<N - 1 - kColumn>([&](int below) __attribute__((always_inline)) {
          const int row = kColumn + 1 + below;
          lower_(row, kColumn) =
              less_products<kColumn, N>(matrix(row, kColumn), lower_.data() + row, of_column) *
              inverse_diagonal_[kColumn];
        });
      });
    }
  }

  [[nodiscard]] MaskOf<Scalar> ok() const noexcept { return ok_; }

  /// L, with zeros above its diagonal.
  const Mat<Scalar, N, N>& lower() const noexcept { return lower_; }

  /// L⁻¹ B: whitens the columns of B, so that Bᵀ A⁻¹ B = (L⁻¹ B)ᵀ (L⁻¹ B).
  template <int Cols>
  Mat<Scalar, N, Cols> whiten(const Mat<Scalar, N, Cols>& right) const noexcept {
    Mat<Scalar, N, Cols> whitened;
    unroll<N>([&](auto row) {
      constexpr int kRow = row.value;
      unroll<Cols>([&](int column) __attribute__((always_inline)) {
        whitened(kRow, column) = less_products<kRow, 1>(right(kRow, column), lower_.data() + kRow,
                                                        whitened.data() + N * column) *
                                 inverse_diagonal_[kRow];
      });
    });
    return whitened;
  }

  /// vᵀ A⁻¹ v.
  Scalar squared_norm(const Vec<Scalar, N>& v) const noexcept {
    Scalar norm = Scalar(0);
    const Vec<Scalar, N> whitened = whiten<1>(v);
    for (int row = 0; row < N; ++row) norm += whitened[row] * whitened[row];
    return norm;
  }

  /// vᵀ A⁻¹ v with a different v in each lane and the matrix of one lane.
  template <class Lanes>
  Lanes squared_norms(const Vec<Lanes, N>& v, int of_lane) const noexcept {
    Lanes whitened[N];
    Lanes norm = Lanes(0);
    unroll<N>([&](auto row) {
      constexpr int kRow = row.value;
      Lanes sum = v[kRow];
      unroll<kRow>([&](int k) { sum -= Lanes(lane(lower_(kRow, k), of_lane)) * whitened[k]; });
      whitened[kRow] = sum * Lanes(lane(inverse_diagonal_[kRow], of_lane));
      norm += whitened[kRow] * whitened[kRow];
    });
    return norm;
  }

  /// B L⁻ᵀ: whitens the rows of B.
  template <int Rows>
  Mat<Scalar, Rows, N> whiten_rows(const Mat<Scalar, Rows, N>& left) const noexcept {
    Mat<Scalar, Rows, N> whitened;
    unroll<N>([&](auto column) {
      constexpr int kColumn = column.value;
      unroll<Rows>([&](int row) __attribute__((always_inline)) {
        whitened(row, kColumn) =
            less_products<kColumn, Rows>(left(row, kColumn), lower_.data() + kColumn,
                                         whitened.data() + row) *
            inverse_diagonal_[kColumn];
      });
    });
    return whitened;
  }

  /// W L⁻¹: turns whitened rows W = B L⁻ᵀ into B A⁻¹.
  template <int Rows>
  Mat<Scalar, Rows, N> unwhiten_rows(Mat<Scalar, Rows, N> left) const noexcept {
    for (int column = N - 1; column >= 0; --column)
      for (int row = 0; row < Rows; ++row) {
        Scalar sum = left(row, column);
        for (int k = column + 1; k < N; ++k) sum -= lower_(k, column) * left(row, k);
        left(row, column) = sum * inverse_diagonal_[column];
      }
    return left;
  }

  /// A⁻¹ B.
  template <int Cols>
  Mat<Scalar, N, Cols> solve(const Mat<Scalar, N, Cols>& right) const noexcept {
    Mat<Scalar, N, Cols> x = whiten<Cols>(right);
    for (int column = 0; column < Cols; ++column)
      for (int row = N - 1; row >= 0; --row) {
        Scalar sum = x(row, column);
        for (int k = row + 1; k < N; ++k) sum -= lower_(k, row) * x(k, column);
        x(row, column) = sum * inverse_diagonal_[row];
      }
    return x;
  }

  /// 1 / sqrt(det A).
  Scalar inverse_root_determinant() const noexcept {
    Scalar product = inverse_diagonal_[0];
    for (int k = 1; k < N; ++k) product *= inverse_diagonal_[k];
    return product;
  }

  /// ln det A.
  Scalar log_determinant() const noexcept {
    using std::log;
    return Scalar(-2) * log(inverse_root_determinant());
  }

 private:
  /// The sum less the products of the first `Count` elements of a row of L and those of another
  /// vector, `Stride` apart.
  template <int Count, int Stride>
  [[gnu::always_inline]] static Scalar less_products(Scalar sum, const Scalar* of_row,
                                                     const Scalar* other) noexcept {
    unroll<Count>([&](int k)
                      __attribute__((always_inline)) { sum -= of_row[N * k] * other[Stride * k]; });
    return sum;
  }

  static MaskOf<Scalar> is_variance(Scalar pivot) noexcept {
    return pivot > Scalar(0) && pivot <= Scalar(std::numeric_limits<RealOf<Scalar>>::max());
  }

  /// Closed form with two independent square roots; two dependent ones would take most of the time
  /// of an update.
  void compute_2x2(Scalar a, Scalar b, Scalar c) noexcept {
    const Scalar determinant = a * c - b * b;
    ok_ = is_variance(a) && is_variance(determinant);
    const Scalar inverse_root = inverse_sqrt(determinant);
    inverse_diagonal_[0] = inverse_sqrt(a);
    lower_(0, 0) = a * inverse_diagonal_[0];
    inverse_diagonal_[1] = lower_(0, 0) * inverse_root;
    lower_(1, 0) = b * inverse_diagonal_[0];
    lower_(1, 1) = determinant * inverse_root * inverse_diagonal_[0];
  }

  Mat<Scalar, N, N> lower_;
  Vec<Scalar, N> inverse_diagonal_;
  MaskOf<Scalar> ok_ = false;
};

/// A root G with G Gᵀ = A of a positive semidefinite matrix, such as process noise: a Cholesky
/// factorisation that skips directions without variance. Not finite where A is not finite.
template <int N, class Scalar>
Mat<Scalar, N, N> semidefinite_root(const Mat<Scalar, N, N>& matrix) noexcept {
  using std::sqrt;
  Mat<Scalar, N, N> root = Mat<Scalar, N, N>::Zero();
  for (int column = 0; column < N; ++column) {
    Scalar pivot = matrix(column, column);
    for (int k = 0; k < column; ++k) pivot -= root(column, k) * root(column, k);
    const Scalar variance = matrix(column, column);
    const MaskOf<Scalar> without =
        pivot <= RealOf<Scalar>(8) * std::numeric_limits<RealOf<Scalar>>::epsilon() * variance &&
        variance <= Scalar(std::numeric_limits<RealOf<Scalar>>::max());
    if (all(without)) continue;
    const Scalar diagonal = sqrt(select(without, Scalar(1), pivot));
    root(column, column) = select(without, Scalar(0), diagonal);
    for (int row = column + 1; row < N; ++row) {
      Scalar sum = matrix(row, column);
      for (int k = 0; k < column; ++k) sum -= root(row, k) * root(column, k);
      root(row, column) = select(without, Scalar(0), Scalar(sum / diagonal));
    }
  }
  return root;
}

/// True when every element is finite.
template <class Derived>
MaskOf<typename Derived::Scalar> is_finite(const Eigen::MatrixBase<Derived>& matrix) noexcept {
  using Scalar = typename Derived::Scalar;
  // 0 x is NaN for an infinite or NaN x, and a sum with a NaN is NaN. Two sums, as each addition
  // waits for the one before.
  Scalar even = Scalar(0), odd = Scalar(0);
  for (int column = 0; column < matrix.cols(); ++column)
    for (int row = 0; row < matrix.rows(); ++row)
      (row % 2 == 0 ? even : odd) += matrix.derived().coeff(row, column) * Scalar(0);
  return even + odd == Scalar(0);
}

/// `kOk` when the mean is `in_range` and the covariance finite, symmetric and positive definite;
/// else the first of `kNotFinite` and `kNotPositiveDefinite` that applies.
template <int N, class Scalar>
StatusOf<Scalar> check(const Gaussian<N, Scalar>& belief) noexcept {
  using std::abs;
  Scalar largest = abs(belief.covariance(0, 0));
  for (int k = 1; k < N; ++k) largest = at_least(Scalar(abs(belief.covariance(k, k))), largest);
  const Scalar tolerance =
      RealOf<Scalar>(64) * std::numeric_limits<RealOf<Scalar>>::epsilon() * largest;
  MaskOf<Scalar> valid = true;
  for (int column = 1; column < N; ++column)
    for (int row = 0; row < column; ++row)
      valid = valid &&
              abs(belief.covariance(row, column) - belief.covariance(column, row)) <= tolerance;
  valid = valid && Cholesky<N, Scalar>(belief.covariance).ok();
  const auto finite = in_range(belief.mean) && is_finite(belief.covariance);
  return first_failure(ok_or(finite, Status::kNotFinite),
                       ok_or(valid, Status::kNotPositiveDefinite));
}

}  // namespace wakeline
