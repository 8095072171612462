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

/// Tracks with the line through the last plots, many on a straight and few in a turn: a bank of
/// alpha-beta filters of growing memory, each through the last 2, 3, ... plots, and a fuzzy choice
/// of one of them in every scan.
///
/// Each plot is compared with what the lines through the plots before foretold. The residual of a
/// line over the mean one of the shortest line since the start, `sigma_hat_m`, is its ratio; from
/// the ratios a `FuzzyCriterion` makes the `quality`, 2 .. `max_plots`; the greater of the last two
/// (where it holds), rounded to the nearest whole number and halves to the even one, is the number
/// of plots that the line `chosen` goes through. That line is the estimate, and ahead in time the
/// prediction. As long as there are fewer plots those lines are judged that exist.
///
/// The covariance is that of the line's noise, and of an acceleration that began at the last plot
/// but one. In a missed scan nothing is judged, nor is by a plot of the time of the newest, which
/// joins it and which no line has foretold. One mode for each line. No matrix is inverted;
/// O(max_plots) a scan. Source: as `FuzzyCriterion`.
template <class ScalarType = double>
class FuzzyAlphaBeta
    : public LineEstimator<FuzzyAlphaBeta<ScalarType>, FuzzyCriterion::kMaxPlots, ScalarType> {
  using Base = LineEstimator<FuzzyAlphaBeta, FuzzyCriterion::kMaxPlots, ScalarType>;
  friend Base;

 public:
  using typename Base::Mask;
  using typename Base::Probability;
  using typename Base::Scalar;

  /// Throws `std::invalid_argument` when a parameter makes no sense.
  explicit FuzzyAlphaBeta(const FuzzyCriterion& criterion = {})
      : Base(validated(criterion).max_plots, 2, criterion.acceleration_std_mps2),
        criterion_(criterion) {
    choose(Scalar(2));
  }

  /// Saves or restores what is remembered; that of another criterion fails.
  void archive(Archive& fields) {
    fields.rules(criterion_);
    FuzzyAlphaBeta loaded = *this;
    loaded.archive_plots(fields);
    Judgement& last = loaded.judgement_;
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
    choose(judgement_.chosen);
    this->refresh();
  }

  /// One number for each line: 1 for that chosen.
  [[nodiscard]] const Probability& mode_probability() const noexcept { return probability_; }
  [[nodiscard]] const FuzzyCriterion& criterion() const noexcept { return criterion_; }

  /// Number of plots of the line chosen.
  [[nodiscard]] int chosen() const noexcept requires(kLanesOf<Scalar> == 1) {
    return static_cast<int>(judgement_.chosen);
  }
  /// Output of the criterion at the last plot, before it is held and rounded; NaN without one.
  [[nodiscard]] Scalar quality() const noexcept { return judgement_.quality; }
  /// Mean residual of the shortest line since the start, m; NaN before the first one.
  [[nodiscard]] Scalar sigma_hat_m() const noexcept { return judgement_.sigma_hat_m; }
  /// Of each line that was judged at the last plot: its residual over `sigma_hat_m`, clipped.
  [[nodiscard]] std::span<const Scalar> residual_ratios() const noexcept {
    return {judgement_.ratios.data(), judged()};
  }
  /// Of each rule of that judgement.
  [[nodiscard]] std::span<const Scalar> rule_strengths() const noexcept {
    return {judgement_.strengths.data(), judged() > 0 ? judged() + 1 : 0};
  }

 private:
  static constexpr auto kNone = std::numeric_limits<RealOf<Scalar>>::quiet_NaN();

  /// What the criterion saw at the last plot, and what it said.
  struct Judgement {
    std::array<Scalar, FuzzyCriterion::kMaxPlots> ratios{};
    std::array<Scalar, FuzzyCriterion::kMaxPlots> strengths{};
    Scalar lines = Scalar(0);  ///< that were judged
    Scalar scans = Scalar(0);  ///< that `sigma_hat_m` is the mean of
    Scalar sigma_hat_m = Scalar(kNone);
    Scalar quality = Scalar(kNone);
    Scalar chosen = Scalar(2);
  };

  void begin() noexcept {
    judgement_ = {};
    choose(Scalar(2));
  }

  void pass(Scalar) noexcept {}

  [[nodiscard]] const Judgement& judgement() const noexcept { return judgement_; }
  void set_judgement(const Mask& lanes, const Judgement& other) noexcept {
    const auto take = [&](Scalar& target, const Scalar& value) {
      target = select(lanes, value, target);
    };
    for (std::size_t k = 0; k < other.ratios.size(); ++k) {
      take(judgement_.ratios[k], other.ratios[k]);
      take(judgement_.strengths[k], other.strengths[k]);
    }
    take(judgement_.lines, other.lines);
    take(judgement_.scans, other.scans);
    take(judgement_.sigma_hat_m, other.sigma_hat_m);
    take(judgement_.quality, other.quality);
    take(judgement_.chosen, other.chosen);
  }

  /// Lines that were judged at the last plot, in any lane.
  [[nodiscard]] std::size_t judged() const noexcept {
    return static_cast<std::size_t>(double(greatest_of_lanes(judgement_.lines)));
  }

  /// How well the lines foretold a plot, and which of them follows from it.
  void judge(const Gaussian<2, Scalar>& plot, const Mask& lanes) noexcept {
    using std::min, std::sqrt;
    const Mask foretold = lanes && !this->bank_.joins();
    if (none(foretold)) return;
    Judgement next = judgement_;
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
    next.quality = criterion_.judge<Scalar>({next.ratios.data(), count},
                                            {next.strengths.data(), count + 1}, next.lines);
    const Mask holds = Mask(criterion_.hold) && before > next.quality;
    next.chosen = rounded(select(holds, before, next.quality));
    set_judgement(foretold, next);
  }

  /// The nearest whole number, halves to the even one.
  static Scalar rounded(Scalar number) noexcept {
    using std::nearbyint;
    if constexpr (kLanesOf<Scalar> == 1)
      return nearbyint(number);
    else
      return round_to_even(number);
  }

  /// Takes the line through so many plots, or the shortest.
  void choose(Scalar plots) noexcept {
    using std::max, std::min;
    const Scalar longest = this->bank_.lines_of_lanes() + Scalar(1);
    judgement_.chosen = max(min(plots, longest), Scalar(2));
    for (int k = 2; k <= criterion_.max_plots; ++k)
      probability_[k - 2] = select(judgement_.chosen == Scalar(k), Scalar(1), Scalar(0));
  }

  /// The belief from the line chosen.
  void settle() noexcept {
    choose(judgement_.chosen);
    Line<Scalar> line = this->lines_[0];
    for (std::size_t k = 1; k < static_cast<std::size_t>(this->bank_.lines()); ++k)
      if (const Mask here = judgement_.chosen == Scalar(k + 2); any(here))
        assign_where(here, line, this->lines_[k]);
    this->belief_ = line.belief(Scalar(criterion_.acceleration_std_mps2));
  }

  FuzzyCriterion criterion_;
  Probability probability_ = Probability::Zero(criterion_.max_plots - 1);
  Judgement judgement_;
};

}  // namespace wakeline
