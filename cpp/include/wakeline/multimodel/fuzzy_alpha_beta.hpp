// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "wakeline/multimodel/fuzzy_criterion.hpp"
#include "wakeline/multimodel/line_estimator.hpp"

namespace wakeline {

/// Tracking with the line through the last plots, many on a straight and few in a turn: a bank of
/// growing-memory alpha-beta filters, through the last 2, 3, ... plots each, with a fuzzy choice of
/// one of them in every scan.
///
/// Each plot is compared with the predictions of the lines through the plots before it. The ratio
/// of a line is its residual divided by `sigma_hat_m`, the mean residual of the shortest line since
/// the start. From the ratios a `FuzzyCriterion` computes the `quality`, 2 .. `max_plots`; the
/// greater of the last two (with `hold`), rounded to the nearest integer, halves to even, is the
/// number of plots of the line `chosen`. That line is the estimate and, extrapolated, the
/// prediction. While there are fewer plots, only the existing lines are evaluated.
///
/// The covariance is that of the line's noise plus an acceleration that began at the last plot but
/// one. A missed scan is not evaluated, nor is a plot at the time of the newest one, which is
/// merged with it and was not predicted. One mode per line. No matrix is inverted; O(max_plots) per
/// scan. Source: as `FuzzyCriterion`.
template <class ScalarType = double>
class FuzzyAlphaBeta
    : public LineEstimator<FuzzyAlphaBeta<ScalarType>, FuzzyCriterion::kMaxPlots, ScalarType> {
  using Base = LineEstimator<FuzzyAlphaBeta, FuzzyCriterion::kMaxPlots, ScalarType>;
  friend Base;

 public:
  using typename Base::Mask;
  using typename Base::Probability;
  using typename Base::Scalar;

  /// Throws `std::invalid_argument` when a parameter is invalid.
  explicit FuzzyAlphaBeta(const FuzzyCriterion& criterion = {})
      : Base(validated(criterion).max_plots, 2, criterion.acceleration_std_mps2),
        criterion_(criterion) {
    choose(Scalar(2));
  }

  /// Saves or restores the state; fails with a different criterion.
  void archive(Archive& fields) {
    fields.rules(criterion_);
    FuzzyAlphaBeta loaded = *this;
    loaded.archive_plots(fields);
    Evaluation& last = loaded.evaluation_;
    fields(last.ratios);
    fields(last.strengths);
    fields(last.lines);
    fields(last.scans);
    fields(last.sigma_hat_m);
    fields(last.quality);
    fields(last.chosen);
    const auto within = [](Scalar number, int least, int most) {
      return number >= Scalar(least) && number <= Scalar(most) && number == std::floor(number);
    };
    if (!within(last.lines, 0, criterion_.max_plots - 1) || !(last.scans >= Scalar(0)) ||
        !within(last.chosen, 2, std::max(2, loaded.bank_.size())))
      fields.fail();
    if (!fields.loading() || !fields.ok()) return;
    *this = loaded;
    choose(evaluation_.chosen);
    this->refresh();
  }

  /// One probability for each line: 1 for the chosen one.
  [[nodiscard]] const Probability& mode_probability() const noexcept { return probability_; }
  [[nodiscard]] const FuzzyCriterion& criterion() const noexcept { return criterion_; }

  /// Number of plots of the chosen line.
  [[nodiscard]] int chosen() const noexcept requires(kLanesOf<Scalar> == 1) {
    return static_cast<int>(evaluation_.chosen);
  }
  /// Output of the criterion at the last plot, before hold and rounding; NaN without one.
  [[nodiscard]] Scalar quality() const noexcept { return evaluation_.quality; }
  /// Mean residual of the shortest line since the start, m; NaN before the first one.
  [[nodiscard]] Scalar sigma_hat_m() const noexcept { return evaluation_.sigma_hat_m; }
  /// Residual divided by `sigma_hat_m`, clipped, of each line evaluated at the last plot.
  [[nodiscard]] std::span<const Scalar> residual_ratios() const noexcept {
    return {evaluation_.ratios.data(), evaluated()};
  }
  /// Strength of each rule in that evaluation.
  [[nodiscard]] std::span<const Scalar> rule_strengths() const noexcept {
    return {evaluation_.strengths.data(), evaluated() > 0 ? evaluated() + 1 : 0};
  }

 private:
  static constexpr auto kNone = std::numeric_limits<RealOf<Scalar>>::quiet_NaN();

  /// Input and output of the criterion at the last plot.
  struct Evaluation {
    std::array<Scalar, FuzzyCriterion::kMaxPlots> ratios{};
    std::array<Scalar, FuzzyCriterion::kMaxPlots> strengths{};
    Scalar lines = Scalar(0);  ///< number of lines evaluated
    Scalar scans = Scalar(0);  ///< number of residuals averaged in `sigma_hat_m`
    Scalar sigma_hat_m = Scalar(kNone);
    Scalar quality = Scalar(kNone);
    Scalar chosen = Scalar(2);
  };

  void begin() noexcept {
    evaluation_ = {};
    choose(Scalar(2));
  }

  void pass(Scalar) noexcept {}

  [[nodiscard]] const Evaluation& evaluation() const noexcept { return evaluation_; }
  void set_evaluation(const Mask& lanes, const Evaluation& other) noexcept {
    const auto take = [&](Scalar& target, const Scalar& value) {
      target = select(lanes, value, target);
    };
    for (std::size_t k = 0; k < other.ratios.size(); ++k) {
      take(evaluation_.ratios[k], other.ratios[k]);
      take(evaluation_.strengths[k], other.strengths[k]);
    }
    take(evaluation_.lines, other.lines);
    take(evaluation_.scans, other.scans);
    take(evaluation_.sigma_hat_m, other.sigma_hat_m);
    take(evaluation_.quality, other.quality);
    take(evaluation_.chosen, other.chosen);
  }

  /// Number of lines evaluated at the last plot, in any lane.
  [[nodiscard]] std::size_t evaluated() const noexcept {
    return static_cast<std::size_t>(double(greatest_of_lanes(evaluation_.lines)));
  }

  /// Evaluates the predictions of a plot by the lines, and chooses a line.
  void evaluate(const Gaussian<2, Scalar>& plot, const Mask& lanes) noexcept {
    using std::min, std::sqrt;
    const Mask predicted = lanes && !this->bank_.joins();
    if (none(predicted)) return;
    Evaluation next = evaluation_;
    next.lines = this->bank_.lines_of_lanes();
    const auto count = static_cast<std::size_t>(this->bank_.lines());
    for (std::size_t k = 0; k < count; ++k) {
      const Vec<Scalar, 2> residual = plot.mean - this->lines_[k].position_m;
      const Scalar residual_m = sqrt(residual[0] * residual[0] + residual[1] * residual[1]);
      if (k == 0) {
        const Scalar before = select(next.scans == Scalar(0), Scalar(0), next.sigma_hat_m);
        next.scans += Scalar(1);
        next.sigma_hat_m = before + (residual_m - before) / next.scans;
      }
      const Scalar ratio = min(residual_m / next.sigma_hat_m, Scalar(criterion_.clip));
      next.ratios[k] = select(residual_m > Scalar(0), ratio, Scalar(0));
    }
    const Scalar before = next.quality;
    next.quality = criterion_.evaluate<Scalar>({next.ratios.data(), count},
                                            {next.strengths.data(), count + 1}, next.lines);
    const Mask holds = Mask(criterion_.hold) && before > next.quality;
    next.chosen = rounded(select(holds, before, next.quality));
    set_evaluation(predicted, next);
  }

  /// The nearest integer, halves to even.
  static Scalar rounded(Scalar number) noexcept {
    using std::nearbyint;
    if constexpr (kLanesOf<Scalar> == 1)
      return nearbyint(number);
    else
      return round_to_even(number);
  }

  /// Chooses the line through so many plots, or the shortest.
  void choose(Scalar plots) noexcept {
    using std::max, std::min;
    const Scalar longest = this->bank_.lines_of_lanes() + Scalar(1);
    evaluation_.chosen = max(min(plots, longest), Scalar(2));
    for (int k = 2; k <= criterion_.max_plots; ++k)
      probability_[k - 2] = select(evaluation_.chosen == Scalar(k), Scalar(1), Scalar(0));
  }

  /// Sets the belief to that of the chosen line.
  void update_belief() noexcept {
    choose(evaluation_.chosen);
    Line<Scalar> line = this->lines_[0];
    for (std::size_t k = 1; k < static_cast<std::size_t>(this->bank_.lines()); ++k)
      if (const Mask here = evaluation_.chosen == Scalar(k + 2); any(here))
        assign_where(here, line, this->lines_[k]);
    this->belief_ = line.belief(Scalar(criterion_.acceleration_std_mps2));
  }

  FuzzyCriterion criterion_;
  Probability probability_ = Probability::Zero(criterion_.max_plots - 1);
  Evaluation evaluation_;
};

}  // namespace wakeline
