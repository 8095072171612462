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
/// but one. In a missed scan nothing is judged. One mode for each line. No matrix is inverted;
/// O(max_plots) a scan. Source: as `FuzzyCriterion`.
template <class ScalarType = double>
class FuzzyAlphaBeta
    : public LineEstimator<FuzzyAlphaBeta<ScalarType>, FuzzyCriterion::kMaxPlots, ScalarType> {
  using Base = LineEstimator<FuzzyAlphaBeta, FuzzyCriterion::kMaxPlots, ScalarType>;
  friend Base;

 public:
  using typename Base::Probability;
  using typename Base::Scalar;

  /// Throws `std::invalid_argument` when a parameter makes no sense.
  explicit FuzzyAlphaBeta(const FuzzyCriterion& criterion = {})
      : Base(validated(criterion).max_plots, 2, criterion.acceleration_std_mps2),
        criterion_(criterion) {
    choose(2);
  }

  /// Saves or restores what is remembered; that of another criterion fails.
  void archive(Archive& fields) {
    FuzzyAlphaBeta loaded = *this;
    auto [max_plots, steepness, threshold, clip, t_norm, hold, acceleration] = criterion_;
    fields(max_plots);
    fields(steepness);
    fields(threshold);
    fields(clip);
    fields(t_norm);
    fields(hold);
    fields(acceleration);
    const FuzzyCriterion saved{max_plots, steepness, threshold, clip, t_norm, hold, acceleration};
    loaded.archive_plots(fields);
    fields(loaded.ratios_);
    fields(loaded.strengths_);
    fields(loaded.judged_);
    fields(loaded.scans_);
    fields(loaded.sigma_hat_m_);
    fields(loaded.quality_);
    fields(loaded.chosen_);
    if (saved != criterion_ || loaded.judged_ < 0 || loaded.judged_ >= max_plots ||
        loaded.scans_ < 0 || loaded.chosen_ < 2 ||
        loaded.chosen_ > std::max(2, loaded.bank_.size()))
      fields.fail();
    if (!fields.loading() || !fields.ok()) return;
    *this = loaded;
    choose(chosen_);
    this->refresh();
  }

  /// One number for each line: 1 for that chosen.
  [[nodiscard]] const Probability& mode_probability() const noexcept { return probability_; }
  [[nodiscard]] const FuzzyCriterion& criterion() const noexcept { return criterion_; }

  /// Number of plots of the line chosen.
  [[nodiscard]] int chosen() const noexcept { return chosen_; }
  /// Output of the criterion at the last plot, before it is held and rounded; NaN without one.
  [[nodiscard]] double quality() const noexcept { return quality_; }
  /// Mean residual of the shortest line since the start, m; NaN before the first one.
  [[nodiscard]] double sigma_hat_m() const noexcept { return sigma_hat_m_; }
  /// Of each line that was judged at the last plot: its residual over `sigma_hat_m`, clipped.
  [[nodiscard]] std::span<const double> residual_ratios() const noexcept {
    return {ratios_.data(), static_cast<std::size_t>(judged_)};
  }
  /// Of each rule of that judgement.
  [[nodiscard]] std::span<const double> rule_strengths() const noexcept {
    return {strengths_.data(), static_cast<std::size_t>(judged_ > 0 ? judged_ + 1 : 0)};
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  void begin() noexcept {
    judged_ = 0;
    scans_ = 0;
    sigma_hat_m_ = quality_ = kNone;
    choose(2);
  }

  void pass(Scalar) noexcept {}

  /// How well the lines foretold a plot, and which of them follows from it.
  void judge(const Gaussian<2, Scalar>& plot) noexcept {
    judged_ = this->bank_.lines();
    for (int k = 0; k < judged_; ++k) {
      const auto line = static_cast<std::size_t>(k);
      const double residual_m = double((plot.mean - this->lines_[line].position_m).norm());
      if (k == 0) {
        if (scans_ == 0) sigma_hat_m_ = 0.0;
        sigma_hat_m_ += (residual_m - sigma_hat_m_) / double(++scans_);
      }
      ratios_[line] = residual_m > 0.0 ? std::min(residual_m / sigma_hat_m_, criterion_.clip) : 0.0;
    }
    const double before = quality_;
    quality_ = criterion_.judge(residual_ratios(),
                                {strengths_.data(), static_cast<std::size_t>(judged_ + 1)});
    const double output = criterion_.hold && before > quality_ ? before : quality_;
    chosen_ = static_cast<int>(std::nearbyint(output));
  }

  /// Takes the line through so many plots, or the shortest.
  void choose(int plots) noexcept {
    chosen_ = std::clamp(plots, 2, std::max(2, this->bank_.size()));
    probability_ = Probability::Zero(criterion_.max_plots - 1);
    probability_[chosen_ - 2] = Scalar(1);
  }

  /// The belief from the line chosen.
  void settle() noexcept {
    choose(chosen_);
    this->belief_ = this->lines_[static_cast<std::size_t>(chosen_ - 2)].belief(
        Scalar(criterion_.acceleration_std_mps2));
  }

  FuzzyCriterion criterion_;
  Probability probability_;
  std::array<double, FuzzyCriterion::kMaxPlots> ratios_{};
  std::array<double, FuzzyCriterion::kMaxPlots> strengths_{};
  int judged_ = 0;          ///< lines at the last plot
  std::int64_t scans_ = 0;  ///< that `sigma_hat_m_` is the mean of
  double sigma_hat_m_ = kNone;
  double quality_ = kNone;
  int chosen_ = 2;
};

}  // namespace wakeline
