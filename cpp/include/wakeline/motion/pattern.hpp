// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "wakeline/core/require.hpp"
#include "wakeline/motion/concept.hpp"

namespace wakeline {

/// The elements of an N x N transition matrix that are the same for every step: '0', '1', or 'x'
/// for any value, row by row, e.g. `Pattern<2>{"1x 01"}`.
template <int N>
struct Pattern {
  char element[N][N] = {};

  constexpr Pattern(const char (&rows)[N * (N + 1)]) {
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) element[i][j] = rows[i * (N + 1) + j];
  }

  /// True when it contains only these three characters.
  [[nodiscard]] constexpr bool is_valid() const noexcept {
    for (const auto& row : element)
      for (const char one : row)
        if (one != '0' && one != '1' && one != 'x') return false;
    return true;
  }

  /// All elements unknown.
  constexpr Pattern() {
    for (auto& row : element)
      for (char& any : row) any = 'x';
  }
};

/// The `kPattern` that a motion model declares for its matrix or Jacobian.
template <class Motion>
inline constexpr Pattern<kStatesOf<Motion>> kPatternOf = {};
template <class Motion>
requires requires { Motion::kPattern; }
inline constexpr Pattern<kStatesOf<Motion>> kPatternOf<Motion> = Motion::kPattern;

/// Throws `std::invalid_argument`: an element is not what the pattern says.
[[noreturn]] inline void reject_pattern(int row, int column, double wanted, double got,
                                        const char* where, double step_s) {
  reject("the kPattern of this motion model must be true: it says " + number_text(wanted) +
         " of element (" + std::to_string(row) + ", " + std::to_string(column) + ") of the " +
         where + " for a step of " + number_text(step_s) + " s is " + number_text(got));
}

/// Throws `std::invalid_argument` unless the matrix of a linear model, or the Jacobian of a
/// nonlinear one at [1, 2, …], has the declared pattern, which may be wrong for an inherited one.
/// Checked for steps of 1 s and 2 s, because an element equal to the step looks like 1 in the
/// first.
template <class Scalar, class Motion>
void require_pattern(const Motion& motion) {
  constexpr int kN = kStatesOf<Motion>;
  const char* const where =
      LinearMotionModel<Motion> ? "matrix, which" : "Jacobian, which at [1, 2, ...]";
  Vec<Scalar, kN> x;
  for (int i = 0; i < kN; ++i) x[i] = Scalar(i + 1);
  for (const double step_s : {1.0, 2.0}) {
    const Mat<Scalar, kN, kN> f = transition_jacobian(motion, x, Scalar(step_s));
    for (int i = 0; i < kN; ++i)
      for (int j = 0; j < kN; ++j) {
        const char said = kPatternOf<Motion>.element[i][j];
        const double wanted = said == '1';
        if (said != 'x' && any(f(i, j) != Scalar(wanted)))
          reject_pattern(i, j, wanted, double(lane(f(i, j), 0)), where, step_s);
      }
  }
}

/// Products with a transition matrix, without the terms that its pattern declares zero.
template <auto kPattern, class Scalar, int N>
struct Patterned {
  static_assert(
      kPattern.is_valid(),
      "wakeline: the kPattern of this motion model has elements other than 0, 1 and x; see "
      "cpp/docs/concepts.md");

  const Mat<Scalar, N, N>& f;

  /// F v.
  [[gnu::always_inline]] Vec<Scalar, N> operator*(const Vec<Scalar, N>& v) const noexcept {
    Vec<Scalar, N> product;
    unroll<N>([&](auto i) { product[i.value] = row_times<i.value>(v); });
    return product;
  }

  /// (F P)ᵀ of a symmetric P, the input of `congruence`.
  [[gnu::always_inline]] Mat<Scalar, N, N> transposed_product(
      const Mat<Scalar, N, N>& p) const noexcept {
    Mat<Scalar, N, N> transposed;
    unroll<N * N>([&](auto k) {
      transposed.data()[k.value] = row_times<k.value / N>(&p.data()[N * (k.value % N)]);
    });
    return transposed;
  }

  /// Element (I, J) of F P Fᵀ, given (F P)ᵀ.
  template <int I, int J>
  [[gnu::always_inline]] Scalar congruence(const Mat<Scalar, N, N>& transposed) const noexcept {
    return row_times<J>(&transposed.data()[N * I]);
  }

 private:
  static constexpr int first_in_row(int row) noexcept {
    for (int k = 0; k < N; ++k)
      if (kPattern.element[row][k] != '0') return k;
    return 0;
  }

  template <int I, int K, class Vector>
  [[gnu::always_inline]] Scalar term(const Vector& v) const noexcept {
    if constexpr (kPattern.element[I][K] == '1')
      return v[K];
    else
      return f(I, K) * v[K];
  }

  /// Row I of F times v.
  template <int I, class Vector>
  [[gnu::always_inline]] Scalar row_times(const Vector& v) const noexcept {
    constexpr int kFirst = first_in_row(I);
    Scalar sum = term<I, kFirst>(v);
    unroll<N>([&](auto k) {
      if constexpr (k.value > kFirst && kPattern.element[I][k.value] != '0')
        sum += term<I, k.value>(v);
    });
    return sum;
  }
};

}  // namespace wakeline
