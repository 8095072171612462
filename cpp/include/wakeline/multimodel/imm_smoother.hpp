// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <variant>
#include <vector>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/principal_axes.hpp"
#include "wakeline/filter/rts_smoother.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline {

/// One scan of a recording processed by an Imm.
template <class Bank>
struct ImmScan {
  Imm<Bank> predicted;           ///< after `predict`
  Imm<Bank> updated;             ///< after the update, if there was one
  typename Bank::Scalar dt_s{};  ///< step to this scan
};

/// A belief revised by later readings, and how well it predicted them.
template <class BeliefType, class Scalar = double>
struct Revised {
  Status status = Status::kOk;
  BeliefType belief = {};
  Scalar log_evidence = Scalar(0);  ///< relative to the belief before the revision
};

/// The information of later readings, which turned the belief `before` into `after`, applied to a
/// third one, `prior`: its product with
///
///     L(x) = after(x) / before(x) = exp(-λ u² / 2 + h u),   λ = 1 / w - 1,   h = m / w,
///
/// along each axis u in which `before` is N(0, 1) and `after` is N(m, w). The readings put the
/// state at u = m / (1 - w); where `after` is hardly narrower than `before`, or wider as merged
/// beliefs may be, that is unbounded. For a prior that differs from `before` by a standard
/// deviation or more the position is limited to ten standard deviations, or twice m.
template <int N, class Scalar>
Revised<Gaussian<N, Scalar>, Scalar> revised(const Gaussian<N, Scalar>& prior,
                                             const Gaussian<N, Scalar>& before,
                                             const Gaussian<N, Scalar>& after) noexcept {
  using std::abs;
  using std::log;
  using Vector = Vec<Scalar, N>;
  using Matrix = Mat<Scalar, N, N>;
  Revised<Gaussian<N, Scalar>, Scalar> result;
  result.status = Status::kNotPositiveDefinite;
  const Cholesky<N, Scalar> root(before.covariance);
  if (!root.ok()) return result;
  const auto whitened = [&](const Matrix& covariance) -> Matrix {
    return root.template whiten<N>(root.template whiten_rows<N>(covariance));
  };
  const auto principal = principal_axes<N, Scalar>(whitened(after.covariance));
  const Vector& width = principal.variance;
  const Matrix& axes = principal.axes;
  // Narrower than that against the widest axis is rounding.
  const Scalar least = N * std::numeric_limits<Scalar>::epsilon() * width.maxCoeff();
  for (int k = 0; k < N; ++k)
    if (!(width[k] > least)) return result;
  const auto along_axes = [&](const Vector& mean) -> Vector {
    return product(axes, root.template whiten<1>(Vector(mean - before.mean)));
  };
  const Vector m = along_axes(after.mean);
  const Vector d = along_axes(prior.mean);
  const Matrix c = product_transposed(product(axes, whitened(prior.covariance)), axes);
  const Cholesky<N, Scalar> prior_root(c);
  if (!prior_root.ok()) return result;
  const Matrix& a = prior_root.lower();

  Vector lambda, pull;
  Scalar twice_evidence = Scalar(0);
  for (int k = 0; k < N; ++k) {
    const Scalar unlike = std::min(Scalar(abs(d[k]) + abs(c(k, k) - 1)), Scalar(1));
    const Scalar least_loss = std::min(Scalar(abs(m[k]) / 10), Scalar(0.5));
    const Scalar w = std::min(width[k], Scalar(1 - least_loss * unlike));
    const Scalar h = m[k] / w;
    lambda[k] = 1 / w - 1;
    pull[k] = h - lambda[k] * d[k];
    twice_evidence += (2 * d[k] - m[k]) * h - d[k] * d[k] * lambda[k] - log(w);
  }
  Matrix precision = Matrix::Identity();
  for (int column = 0; column < N; ++column)
    for (int row = 0; row < N; ++row)
      for (int k = 0; k < N; ++k) precision(row, column) += a(k, row) * lambda[k] * a(k, column);
  const Cholesky<N, Scalar> information(precision);
  if (!information.ok()) return result;
  const Matrix posterior_root = information.template whiten_rows<N>(a);
  const Matrix back = product_transposed(root.lower(), axes);
  const Matrix spread = product(back, posterior_root);
  Vector shift;
  for (int k = 0; k < N; ++k) {
    shift[k] = Scalar(0);
    for (int i = 0; i < N; ++i) shift[k] += posterior_root(i, k) * pull[i];
    twice_evidence += shift[k] * shift[k];
  }
  result.belief.mean = before.mean + product(back, d) + product(spread, shift);
  result.belief.covariance = product_transposed(spread, spread);
  mirror_lower<Scalar, N>(result.belief.covariance);
  result.log_evidence = (twice_evidence - information.log_determinant()) / 2;
  const bool finite = is_finite(result.belief.mean) && is_finite(result.belief.covariance) &&
                      std::isfinite(result.log_evidence);
  result.status = finite ? Status::kOk : Status::kNotFinite;
  return result;
}

/// The smoothed belief before a prediction, given the smoothed one after it.
template <class Filter, auto Components, class... Known>
Status smooth_pair(const Filter& filter, StateBelief<Components, typename Filter::Scalar>& belief,
                   const Gaussian<Filter::kStates, typename Filter::Scalar>& later,
                   typename Filter::Scalar dt_s, const Known&... acceleration_mps2) noexcept {
  using Scalar = typename Filter::Scalar;
  std::array<Gaussian<Filter::kStates, Scalar>, 2> pair{belief, later};
  const std::array<Vec<Scalar, 2>, sizeof...(Known)> known{acceleration_mps2...};
  const Status status = smooth_as(filter, filter.motion(), pair, std::span(&dt_s, 1), known);
  belief = pair[0];
  return status;
}

/// `own` conditioned on `part` for the components that both have; the other components follow by
/// their correlation in `own`. Source: R. C. Jeffrey, The Logic of Decision (Jeffrey's rule).
template <auto To, class Scalar, class Part>
StateBelief<To, Scalar> carried_over(const StateBelief<To, Scalar>& own,
                                     const Part& part) noexcept {
  constexpr auto kRows = rows_of(Part::kComponents, To);
  constexpr int kN = StateBelief<To, Scalar>::kStates;
  constexpr int kShared = [&] {
    int shared = 0;
    for (int i = 0; i < kN; ++i) shared += kRows[i] >= 0;
    return shared;
  }();
  Vec<Scalar, kShared> shift;
  Mat<Scalar, kShared, kShared> before, change;
  Mat<Scalar, kN, kShared> with_shared;
  for (int i = 0, a = 0; i < kN; ++i) {
    if (kRows[i] < 0) continue;
    shift[a] = part.mean[kRows[i]] - own.mean[i];
    with_shared.col(a) = own.covariance.col(i);
    for (int j = 0, b = 0; j < kN; ++j) {
      if (kRows[j] < 0) continue;
      before(a, b) = own.covariance(i, j);
      change(a, b) = part.covariance(kRows[i], kRows[j]) - before(a, b);
      ++b;
    }
    ++a;
  }
  StateBelief<To, Scalar> result = own;
  const Cholesky<kShared, Scalar> factor(before);
  if (!factor.ok()) return result;
  const Mat<Scalar, kN, kShared> gain = factor.unwhiten_rows(factor.whiten_rows(with_shared));
  result.mean += product(gain, shift);
  result.covariance += product_transposed(product(gain, change), gain);
  mirror_lower<Scalar, kN>(result.covariance);
  return result;
}

/// For a belief over the same components, that belief.
template <auto Components, class Scalar>
StateBelief<Components, Scalar> carried_over(const StateBelief<Components, Scalar>&,
                                             const BeliefView<Components, Scalar>& part) noexcept {
  StateBelief<Components, Scalar> result;
  result = Gaussian<StateBelief<Components, Scalar>::kStates, Scalar>{part.mean, part.covariance};
  return result;
}

/// Smooths a recording processed by an Imm, backwards.
///
/// A mode i followed by a mode j is a transition. The prediction of each transition is revised by
/// what later readings say of mode j (`revised`), carried back to its start by the filter's own
/// smoother, and weighted by how well it predicted the later readings, which identifies the
/// transition that an Imm loses in mixing. The transitions from a mode are merged into its smoothed
/// belief. Components that only one of the two modes has enter a transition as in mixing, and are
/// carried back by `carried_over`. K² predictions and smoothings per scan, and memory for the
/// recording. Sources: R. E. Helmick, W. D. Blair, S. A. Hoffman, IEEE Trans. IT-41, 1995
/// (transitions weighted from both sides); N. Nadarajah, R. Tharmarasa, M. McDonald, T.
/// Kirubarajan, IEEE Trans. AES-48, 2012 (Rauch-Tung-Striebel smoothers).
template <class BankType>
class ImmSmoother {
 public:
  using Bank = BankType;
  using Scalar = typename Bank::Scalar;

  /// Replaces the beliefs of the filters of `scans[k].updated` and its mode probabilities by
  /// smoothed ones, which `estimate()` then uses. `acceleration_mps2` is empty or has one per scan.
  /// Returns the first failure, with that scan and all before it unchanged.
  static Status smooth(std::span<ImmScan<Bank>> scans,
                       std::span<const Vec<Scalar, 2>> acceleration_mps2 = {}) {
    for (std::size_t k = scans.size(); k-- > 1;) {
      const auto known =
          acceleration_mps2.empty() ? acceleration_mps2 : acceleration_mps2.subspan(k, 1);
      const Status status = smooth(scans[k - 1].updated, scans[k], known);
      if (status != Status::kOk) return status;
    }
    return Status::kOk;
  }

  /// The same of the Imm after one scan, given the smoothed one after the next; `acceleration_mps2`
  /// is that between them, if known.
  static Status smooth(Imm<Bank>& now, const ImmScan<Bank>& next,
                       std::span<const Vec<Scalar, 2>> acceleration_mps2 = {}) {
    return acceleration_mps2.empty() ? step(now, next) : step(now, next, acceleration_mps2[0]);
  }

 private:
  using Estimator = Imm<Bank>;
  using Matrix = ModeMatrix<Scalar, Bank::kModels>;

  /// A mode with a filter whose kind is chosen at run time.
  template <class Filter>
  struct ModeOf {
    int k;
    operator int() const noexcept { return k; }
  };

  /// Calls `f(k)` for each mode, with a constant where filters are of different kinds, or with a
  /// `ModeOf` of its kind.
  template <class Function>
  static void for_each_mode(const Bank& bank, const Function& function) {
    if constexpr (requires { bank.filter(0).index(); })
      for (int k = 0; k < bank.size(); ++k)
        std::visit([&]<class Filter>(const Filter&) { function(ModeOf<Filter>{k}); },
                   bank.filter(k));
    else if constexpr (requires { bank.filter(0); })
      for (int k = 0; k < bank.size(); ++k) function(k);
    else
      unroll<Bank::kModels>([&](auto k) { function(k); });
  }

  template <class SomeBank, class Mode>
  static auto& filter_of(SomeBank& bank, Mode k) {
    if constexpr (requires { bank.filter(k); })
      return bank.filter(k);
    else
      return bank.template get<Mode::value>();
  }

  template <class SomeBank, class Filter>
  static auto& filter_of(SomeBank& bank, ModeOf<Filter> k) {
    return std::get<Filter>(bank.filter(k));
  }

  /// The belief of a filter with its components.
  template <class Filter>
  static auto belief_of(const Filter& filter) {
    if constexpr (requires { Filter::kComponents; }) {
      StateBelief<Filter::kComponents, Scalar> belief;
      belief = filter.estimate();
      return belief;
    } else {
      return filter.estimate();
    }
  }

  template <class... Known>
  static Status step(Estimator& now, const ImmScan<Bank>& next, const Known&... acceleration_mps2) {
    if (const Status status = check_time_step(next.dt_s); status != Status::kOk) return status;
    const int modes = now.bank_.size();
    std::vector<Estimator> ways(static_cast<std::size_t>(modes), now);
    Matrix weight = now.chain_.transition(double(next.dt_s)).template cast<Scalar>();
    Status hindered = Status::kOk;
    const auto done = [&](Status status) {
      hindered = first_failure(hindered, status);
      return status == Status::kOk;
    };
    for_each_mode(now.bank_, [&](auto from) {
      const auto belief = belief_of(filter_of(now.bank_, from));
      for_each_mode(now.bank_, [&](auto to) {
        using std::log;
        const int i = from, j = to;
        const Scalar predicted = next.predicted.probability_[j];
        const Scalar prior = now.probability_[i] * weight(i, j) * next.updated.probability_[j];
        weight(i, j) = log(Scalar(0));
        if (!(prior > Scalar(0)) || !(predicted > Scalar(0))) return;
        auto& filter = filter_of(ways[static_cast<std::size_t>(i)].bank_, to);
        const auto own = belief_of(filter);
        auto start = zero_like(own);
        add_mean(start, Scalar(1), belief, own);
        add_spread(start, Scalar(1), belief, own);
        if (!done(predict_from(filter, start, next.dt_s, acceleration_mps2...))) return;
        const auto later =
            revised(belief_of(filter), belief_of(filter_of(next.predicted.bank_, to)),
                    belief_of(filter_of(next.updated.bank_, to)));
        if (done(later.status) &&
            done(smooth_pair(filter, start, later.belief, next.dt_s, acceleration_mps2...)) &&
            done(filter.assign(start)))
          weight(i, j) = log(prior / predicted) + later.log_evidence;
      });
    });
    return join(now, ways, weight) ? Status::kOk : first_failure(hindered, Status::kNotFinite);
  }

  /// Merges the transitions from each mode, given the logarithms of their weights. False where
  /// there is none.
  static bool join(Estimator& now, const std::vector<Estimator>& ways, Matrix& weight) {
    using std::exp;
    const Scalar greatest = weight.maxCoeff();
    if (!(greatest > -std::numeric_limits<Scalar>::infinity())) return false;
    for (Scalar& each : weight.reshaped()) each = exp(each - greatest);
    weight /= weight.sum();
    for_each_mode(now.bank_, [&](auto from) {
      const int i = from;
      auto& filter = filter_of(now.bank_, from);
      const Scalar total = weight.row(i).sum();
      now.probability_[i] = total;
      if (!(total > Scalar(0))) return;
      const auto own = belief_of(filter);
      auto joint = zero_like(own);
      const Bank& bank = ways[static_cast<std::size_t>(i)].bank_;
      bank.for_each_belief([&](int j, const auto& belief) {
        if (weight(i, j) > Scalar(0))
          add_mean(joint, Scalar(weight(i, j) / total), carried_over(own, belief), own);
      });
      bank.for_each_belief([&](int j, const auto& belief) {
        if (weight(i, j) > Scalar(0))
          add_spread(joint, Scalar(weight(i, j) / total), carried_over(own, belief), own);
      });
      (void)filter.assign(joint);
    });
    return true;
  }
};

}  // namespace wakeline
