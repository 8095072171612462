// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>

#include "wakeline/core/require.hpp"
#include "wakeline/simd/scalar.hpp"

namespace wakeline {

/// A number of modes given at run time, up to `kMaxModes`.
inline constexpr int kRuntimeModes = Eigen::Dynamic;
inline constexpr int kMaxModes = 16;

template <int K>
inline constexpr int kModeCapacity = K == kRuntimeModes ? kMaxModes : K;

template <class Scalar, int K>
using ModeVector = Eigen::Matrix<Scalar, K, 1, 0, kModeCapacity<K>, 1>;
template <class Scalar, int K>
using ModeMatrix = Eigen::Matrix<Scalar, K, K, 0, kModeCapacity<K>, kModeCapacity<K>>;

/// The Markov chain of the modes of a multi-model estimator: `chain(i, j) = P(mode j now | mode i
/// before)`; rows sum to 1.
///
/// Given as a matrix, it is applied once per prediction, independent of the time step (the papers'
/// form). Given as a matrix with its period, or as mean sojourn times, it is a chain in continuous
/// time: P(dt) = exp(G dt), so that two steps of dt equal one of 2 dt. Source: Bar-Shalom, Li,
/// Kirubarajan, 11.6.2; for continuous time any text on Markov chains.
template <int K>
class ModeChain {
 public:
  using Matrix = ModeMatrix<double, K>;

  /// One transition per prediction. Throws `std::invalid_argument` unless every row is a
  /// distribution.
  explicit ModeChain(const Matrix& per_prediction) : matrix_(per_prediction) {
    require_stochastic(matrix_);
  }

  /// The same chain with the number of modes as a template parameter or at run time. Throws unless
  /// there are K of them.
  template <int Other>
  requires(Other != K) explicit ModeChain(const ModeChain<Other>& chain)
      : matrix_(chain.matrix_), continuous_(chain.continuous_) {
    if (K != kRuntimeModes && chain.modes() != K)
      reject("a chain of " + std::to_string(K) + " modes was given one of " +
             std::to_string(chain.modes()));
  }

  /// The continuous-time chain with this transition over `period_s`. Throws also when there is
  /// none, or only one that rarely stays during the period: where an eigenvalue is about 0, or
  /// differs from 1 by 1 or more.
  ModeChain(const Matrix& over_period, double period_s) : ModeChain(over_period) {
    require_positive("period_s", period_s);
    matrix_ = logarithm(over_period) / period_s;
    continuous_ = true;
    clip_generator(period_s, over_period);
  }

  /// The chain that stays in mode k for `sojourn_s[k]` seconds on average and leaves to each other
  /// mode with the same probability.
  static ModeChain from_sojourn_s(const ModeVector<double, K>& sojourn_s) {
    const Eigen::Index modes = sojourn_s.size();
    Matrix next = Matrix::Constant(modes, modes, 1.0 / static_cast<double>(modes - 1));
    next.diagonal().setZero();
    return from_sojourn_s(sojourn_s, next);
  }

  /// The same with `next(i, j) = P(to mode j | leaves mode i)`: each row a distribution, zero on
  /// the diagonal.
  static ModeChain from_sojourn_s(const ModeVector<double, K>& sojourn_s, const Matrix& next) {
    const Eigen::Index modes = sojourn_s.size();
    require_modes("mean sojourn times", modes);
    if (next.rows() != modes || next.cols() != modes)
      reject("from_sojourn_s needs one row and column of `next` for each of " +
             std::to_string(modes) + " modes, got " + std::to_string(next.rows()) + " x " +
             std::to_string(next.cols()));
    if (modes > 1) require_stochastic(next);
    Matrix generator = Matrix::Zero(modes, modes);
    for (Eigen::Index i = 0; i < modes; ++i) {
      require_positive("every time of sojourn_s", sojourn_s[i]);
      require(modes == 1 || next(i, i) == 0.0, "the diagonal of `next`", "zero", next(i, i));
      for (Eigen::Index j = 0; j < modes && modes > 1; ++j)
        generator(i, j) = (i == j ? -1.0 : next(i, j)) / sojourn_s[i];
    }
    return ModeChain(Generator{generator});
  }

  static ModeChain from_sojourn_s(std::initializer_list<double> sojourn_s) {
    require_modes("mean sojourn times", static_cast<Eigen::Index>(sojourn_s.size()));
    ModeVector<double, K> times(static_cast<Eigen::Index>(sojourn_s.size()));
    Eigen::Index k = 0;
    for (const double time : sojourn_s) times[k++] = time;
    return from_sojourn_s(times);
  }

  /// The continuous-time chain of a generator G (1/s): `G(i, j)` is the rate from mode i to mode j,
  /// rows sum to 0. Throws `std::invalid_argument` for any other matrix.
  static ModeChain from_generator(const Matrix& generator_per_s) {
    require_generator(generator_per_s);
    return ModeChain(Generator{generator_per_s});
  }

  /// The chain that stays with the given probability per prediction and leaves to each other mode
  /// with the same probability: the papers' 0.9 and 0.1 / (K - 1).
  static ModeChain staying(double stay_probability, Eigen::Index modes = K) {
    require_probability("stay_probability", stay_probability);
    require(modes >= 2 && modes <= kModeCapacity<K>, "modes", "2 to 16", double(modes));
    Matrix matrix =
        Matrix::Constant(modes, modes, (1.0 - stay_probability) / static_cast<double>(modes - 1));
    matrix.diagonal().setConstant(stay_probability);
    return ModeChain(matrix);
  }

  /// The chain of the first `Count` modes: what leads from one of them to the others leads to the
  /// rest of the first instead, in proportion, or alike where nothing else does.
  template <int Count>
  requires(K != kRuntimeModes && Count > 1 && Count < K)
      [[nodiscard]] ModeChain<Count> first() const {
    typename ModeChain<Count>::Matrix matrix = matrix_.template topLeftCorner<Count, Count>();
    for (Eigen::Index i = 0; i < Count; ++i) {
      const double stays = matrix(i, i), leaves = (continuous_ ? 0.0 : 1.0) - stays;
      matrix(i, i) = 0.0;
      if (const double known = matrix.row(i).sum(); known > 0.0)
        matrix.row(i) *= leaves / known;
      else
        matrix.row(i).setConstant(leaves / (Count - 1));
      matrix(i, i) = stays;
    }
    if (continuous_) return ModeChain<Count>(typename ModeChain<Count>::Generator{matrix});
    return ModeChain<Count>(matrix);
  }

  [[nodiscard]] Eigen::Index modes() const noexcept { return matrix_.rows(); }

  /// True when the transition depends on the time step.
  [[nodiscard]] bool continuous() const noexcept { return continuous_; }

  /// G (1/s) of a continuous-time chain.
  [[nodiscard]] std::optional<Matrix> generator_per_s() const {
    return continuous_ ? std::optional(matrix_) : std::nullopt;
  }

  /// Powers of J = I + G / (fastest rate), the transition of one jump of the uniformised chain.
  class Jumps {
   public:
    explicit Jumps(const ModeChain& chain) noexcept
        : fastest_per_s_(chain.continuous_ ? -chain.matrix_.diagonal().minCoeff() : 0.0) {
      const Matrix identity = Matrix::Identity(chain.modes(), chain.modes());
      power_.fill(identity);
      if (!(fastest_per_s_ > 0.0)) return;
      const Matrix jump = identity + chain.matrix_ / fastest_per_s_;
      for (std::size_t n = 1; n < power_.size(); ++n) power_[n] = product(power_[n - 1], jump);
    }

   private:
    friend class ModeChain;
    double fastest_per_s_;
    std::array<Matrix, 19> power_;  ///< 1 / 18! is the rounding of 1
  };

  /// P(dt), row-stochastic.
  [[nodiscard]] Matrix transition(double dt_s) const noexcept {
    return continuous_ ? exponential(dt_s, Jumps(*this)) : matrix_;
  }

  /// That of each lane, with the powers of this chain.
  template <class Scalar>
  requires(kLanesOf<Scalar> > 1)
      [[nodiscard]] ModeMatrix<Scalar, K> transition(Scalar dt_s,
                                                     const Jumps& jumps) const noexcept {
    if (continuous_) return exponential(dt_s, jumps);
    return matrix_.template cast<Scalar>();
  }

 private:
  template <int>
  friend class ModeChain;

  struct Generator {
    Matrix matrix;
  };
  explicit ModeChain(const Generator& generator) : matrix_(generator.matrix), continuous_(true) {
    if (!matrix_.allFinite()) reject("every rate of the generator of a mode chain must be finite");
  }

  /// Throws unless there are K modes, or 1 to kMaxModes.
  static void require_modes(const std::string& what, Eigen::Index count) {
    constexpr int kLeast = K == kRuntimeModes ? 1 : K;
    if (count >= kLeast && count <= kModeCapacity<K>) return;
    reject("a mode chain needs " +
           (K == kRuntimeModes ? "1 to " + std::to_string(kMaxModes) : std::to_string(K)) + " " +
           what + ", got " + std::to_string(count));
  }

  static void require_square(const Matrix& matrix) {
    require_modes("modes", matrix.rows());
    if (matrix.rows() != matrix.cols())
      reject("a mode chain needs a square matrix, got " + std::to_string(matrix.rows()) + " x " +
             std::to_string(matrix.cols()));
  }

  static void require_stochastic(const Matrix& matrix) {
    require_square(matrix);
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j)
        require_probability("every element of the mode chain", matrix(i, j));
      if (const double sum = matrix.row(i).sum(); !(std::abs(sum - 1.0) <= 1e-9)) {
        reject("row " + std::to_string(i) + " of the mode chain must sum to 1, sums to " +
               number_text(sum) + " (rows: mode before; columns: mode now)");
      }
    }
  }

  static void require_generator(const Matrix& matrix) {
    require_square(matrix);
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j)
        if (i != j)
          require_not_negative("every rate of the generator off its diagonal", matrix(i, j));
      const double sum = matrix.row(i).sum();
      require(std::abs(sum) <= 1e-9 * std::abs(matrix(i, i)), "the sum of a row of the generator",
              "0", sum);
    }
  }

  /// ln P = -Σ (I - P)ⁿ / n, which converges when every eigenvalue of P differs from 1 by less than
  /// 1, as for a chain that mostly stays.
  static Matrix logarithm(const Matrix& p) {
    const Matrix x = Matrix::Identity(p.rows(), p.cols()) - p;
    Matrix power = x;
    Matrix sum = -x;
    for (int n = 2; n < 100'000 && power.cwiseAbs().maxCoeff() > 1e-17; ++n) {
      power = product(power, x);
      sum -= power / n;
    }
    return sum;
  }

  /// Rejects a logarithm that is not a generator; clips rounding errors.
  void clip_generator(double period_s, const Matrix& over_period) {
    bool valid = matrix_.allFinite();
    for (Eigen::Index i = 0; i < modes() && valid; ++i) {
      for (Eigen::Index j = 0; j < modes(); ++j) {
        if (i == j) continue;
        valid = valid && matrix_(i, j) * period_s > -1e-9;
        matrix_(i, j) = std::max(matrix_(i, j), 0.0);
      }
      matrix_(i, i) = 0.0;
      matrix_(i, i) = -row_sum(matrix_, i);
    }
    if (!valid || !(transition(period_s) - over_period).isZero(1e-9))
      reject(
          "this matrix is not the transition of a continuous-time chain over its period, or of one "
          "that rarely stays over it; leave out the period to apply it once per prediction");
  }

  // Sums in loops, so that their order does not depend on whether K is a template parameter.

  template <class Scalar>
  static Scalar row_sum(const ModeMatrix<Scalar, K>& matrix, Eigen::Index row) noexcept {
    Scalar sum = Scalar(0);
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) sum += matrix(row, j);
    return sum;
  }

  template <class Scalar, class Right>
  static ModeMatrix<Scalar, K> product(const ModeMatrix<Scalar, K>& a,
                                       const ModeMatrix<Right, K>& b) noexcept {
    ModeMatrix<Scalar, K> result = ModeMatrix<Scalar, K>::Zero(a.rows(), a.cols());
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      for (Eigen::Index k = 0; k < a.cols(); ++k)
        for (Eigen::Index i = 0; i < a.rows(); ++i) result(i, j) += a(i, k) * b(k, j);
    return result;
  }

  /// exp(G dt) = Σ e⁻ʳ rⁿ / n! Jⁿ, where r is the mean number of jumps in the step
  /// (uniformisation, whose terms are all positive), over a step halved until r is at most 1, then
  /// squared.
  template <class Scalar>
  static ModeMatrix<Scalar, K> exponential(Scalar dt_s, const Jumps& jumps) noexcept {
    using Result = ModeMatrix<Scalar, K>;
    using Real = RealOf<Scalar>;
    Result sum = jumps.power_[0].template cast<Scalar>();
    if (!(jumps.fastest_per_s_ > 0.0)) return sum;
    constexpr Real kMost = std::numeric_limits<Real>::max();
    Scalar mean = Scalar(jumps.fastest_per_s_) * dt_s;
    mean = select(mean < Scalar(kMost), mean, Scalar(kMost));
    mean = select(dt_s > Scalar(0), mean, Scalar(0));
    Scalar halvings = Scalar(0);
    for (auto is_long = mean > Scalar(1); any(is_long); is_long = mean > Scalar(1)) {
      halvings += select(is_long, Scalar(1), Scalar(0));
      mean *= select(is_long, Scalar(0.5), Scalar(1));
    }
    constexpr Real kRounding = std::numeric_limits<Real>::epsilon() / 4;
    Scalar share = Scalar(1);
    for (std::size_t n = 1; n < jumps.power_.size() && any(share > Scalar(kRounding)); ++n) {
      share *= mean / Scalar(Real(n));
      const Matrix& power = jumps.power_[n];
      for (Eigen::Index i = 0; i < sum.size(); ++i)
        sum.data()[i] += share * Scalar(power.data()[i]);
    }
    normalize_rows(sum);
    for (Scalar n = Scalar(0); any(n < halvings); n += Scalar(1)) {
      Result squared = product(sum, sum);
      normalize_rows(squared);
      for (Eigen::Index i = 0; i < sum.size(); ++i)
        sum.data()[i] = select(n < halvings, squared.data()[i], sum.data()[i]);
    }
    return sum;
  }

  template <class Scalar>
  static void normalize_rows(ModeMatrix<Scalar, K>& matrix) noexcept {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      const Scalar scale = Scalar(1) / row_sum(matrix, i);
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) matrix(i, j) *= scale;
    }
  }

  Matrix matrix_;  ///< transition per prediction, or the generator G (1/s)
  bool continuous_ = false;
};

}  // namespace wakeline
