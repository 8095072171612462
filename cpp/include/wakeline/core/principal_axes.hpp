// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "wakeline/core/types.hpp"

namespace wakeline {

/// The eigenvalues and orthonormal eigenvectors of a symmetric matrix A: A = axesᵀ diag(variance)
/// axes.
template <int N, class Scalar = double>
struct PrincipalAxes {
  Vec<Scalar, N> variance;  ///< eigenvalues, in no order; NaN where A is not finite
  Mat<Scalar, N, N> axes;   ///< one eigenvector in each row
};

/// By cyclic Jacobi rotations, which reduce the elements outside the diagonal quadratically: about
/// six sweeps for the sizes of states. Source: Golub, Van Loan, Matrix Computations, 8.5.
template <int N, class Scalar>
PrincipalAxes<N, Scalar> principal_axes(Mat<Scalar, N, N> a) noexcept {
  using std::abs;
  using std::sqrt;
  constexpr int kSweeps = 30;
  PrincipalAxes<N, Scalar> result;
  Mat<Scalar, N, N>& axes = result.axes;
  axes.setIdentity();
  // Both matrices of a similarity turned by the angle of (cosine, sine) in the plane of p and q.
  const auto turn = [](Scalar* p, Scalar* q, int stride, Scalar cosine, Scalar sine) {
    for (int k = 0; k < N * stride; k += stride) {
      const Scalar of_p = p[k], of_q = q[k];
      p[k] = cosine * of_p - sine * of_q;
      q[k] = sine * of_p + cosine * of_q;
    }
  };
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    Scalar outside = Scalar(0), total = Scalar(0);
    for (int column = 0; column < N; ++column)
      for (int row = 0; row < N; ++row) {
        const Scalar square = a(row, column) * a(row, column);
        total += square;
        if (row != column) outside += square;
      }
    constexpr Scalar kEpsilon = std::numeric_limits<Scalar>::epsilon();
    if (!(outside > kEpsilon * kEpsilon * total)) break;
    for (int p = 0; p < N; ++p)
      for (int q = p + 1; q < N; ++q) {
        if (a(p, q) == Scalar(0)) continue;
        const Scalar cotangent = (a(q, q) - a(p, p)) / (2 * a(p, q));  // of twice the angle
        const Scalar root = abs(cotangent) + sqrt(cotangent * cotangent + Scalar(1));
        const Scalar tangent = (cotangent < Scalar(0) ? Scalar(-1) : Scalar(1)) / root;
        const Scalar cosine = Scalar(1) / sqrt(tangent * tangent + Scalar(1));
        const Scalar sine = tangent * cosine;
        turn(a.data() + N * p, a.data() + N * q, 1, cosine, sine);  // columns
        turn(a.data() + p, a.data() + q, N, cosine, sine);          // rows
        turn(axes.data() + p, axes.data() + q, N, cosine, sine);
      }
  }
  for (int k = 0; k < N; ++k) result.variance[k] = a(k, k);
  return result;
}

}  // namespace wakeline
