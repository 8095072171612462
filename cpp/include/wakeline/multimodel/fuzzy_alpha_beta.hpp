// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "wakeline/core/archive.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/multimodel/fuzzy_criterion.hpp"
#include "wakeline/multimodel/line_bank.hpp"
#include "wakeline/multimodel/mixture.hpp"
#include "wakeline/multimodel/mode_chain.hpp"

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
/// Until there are two plots, the belief that it was started with is the estimate, as a Kalman
/// filter keeps it: a start needs no plots, and from then on the plots alone count. The covariance
/// is that of the line's noise, and of an acceleration that began at the last plot but one.
///
/// Takes the position out of any sensor that fixes one, and measures innovations in north and east.
/// Steps may be irregular; in a missed scan nothing is judged. Has the face of `Imm`, with one mode
/// for each line. No matrix is inverted; O(max_plots) a scan, no heap. Source: as `FuzzyCriterion`.
template <class ScalarType = double>
class FuzzyAlphaBeta {
 public:
  using Scalar = ScalarType;
  static constexpr int kModels = kRuntimeModes;
  static constexpr auto kComponents = kKinematics;
  using Probability = ModeVector<Scalar, kModels>;
  using BeliefType = StateBelief<kComponents, Scalar>;
  using Bank = LineBank<FuzzyCriterion::kMaxPlots, Scalar>;

  /// Throws `std::invalid_argument` when a parameter makes no sense.
  explicit FuzzyAlphaBeta(const FuzzyCriterion& criterion = {})
      : criterion_(validated(criterion)),
        first_(ConstantVelocity{PiecewiseAcceleration{criterion.acceleration_std_mps2}}),
        bank_(criterion.max_plots) {
    choose(2);
  }

  /// Begins with a belief over `[x, vx, y, vy]`. Where it is none nothing changes.
  Status start(const Gaussian<4, Scalar>& belief) noexcept {
    if (const Status status = first_.start(belief); status != Status::kOk) return status;
    bank_.clear();
    judged_ = 0;
    scans_ = 0;
    sigma_hat_m_ = quality_ = kNone;
    choose(2);
    belief_ = first_.estimate();
    return Status::kOk;
  }

  /// Moves on along the line chosen.
  Status predict(Scalar dt_s) noexcept { return move(dt_s); }

  /// The same under a known acceleration, [north, east]; see `Control`.
  Status predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return move(dt_s, acceleration_mps2);
  }

  /// Judges the lines by a plot, remembers it and chooses.
  template <class Sensor>
  Step<2, Scalar> update(const Sensor& sensor,
                         const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    const Step<2, Scalar> step = innovation(sensor, z);
    if (step) take(sensor.position(z));
    return step;
  }

  /// The innovation of a plot, north and east, and its likelihood, without taking it.
  template <class Sensor>
  Step<2, Scalar> innovation(const Sensor& sensor,
                             const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    static_assert(PositionSensor<Sensor>,
                  "wakeline: FuzzyAlphaBeta needs a sensor that fixes a position: position(z) -> "
                  "Gaussian<2>; see cpp/docs/concepts.md");
    Step<2, Scalar> step;
    if (!started()) return step;
    const Gaussian<2, Scalar> plot = sensor.position(z);
    const Gaussian<2, Scalar> ahead = position();
    step.innovation = plot.mean - ahead.mean;
    step.innovation_covariance = ahead.covariance + plot.covariance;
    const Cholesky<2, Scalar> factor(step.innovation_covariance);
    if (factor.ok())
      score(step, factor.template whiten<1>(step.innovation), factor);
    else
      step.status = refusal<Scalar, 2>(step.innovation_covariance);
    return step;
  }

  /// What the line chosen thinks of a reading, without taking it.
  template <class Sensor>
  [[nodiscard]] Evidence<Scalar> evidence(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    Evidence<Scalar> evidence;
    evidence.add(Scalar(1), innovation(sensor, z));
    return evidence;
  }

  /// Probabilistic data association, as of `Imm`. The plot that is remembered has the mean and the
  /// covariance of where the target is by all hypotheses: at one of the readings, or where it was
  /// predicted. Where it is rather none of the readings, the scan counts as missed, so that no
  /// line is drawn through predictions.
  template <class Sensor>
  Scalar update(std::span<const Alternative<Sensor, Scalar>> readings, Scalar none,
                std::span<Scalar> share) noexcept {
    for (Scalar& part : share) part = Scalar(0);
    if (!started()) return Scalar(0);
    Scalar owned = Scalar(0);
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const auto step = innovation(readings[k].sensor, readings[k].z);
      if (step) share[k] = readings[k].weight * std::exp(step.log_likelihood);
      owned += share[k];
    }
    const Scalar total = none + owned;
    const bool possible = total > Scalar(0) && std::isfinite(total);
    for (Scalar& part : share) part = possible ? part / total : Scalar(0);
    if (!possible) return Scalar(0);
    if (owned > none) take(joined(readings, none / total, share));
    return total;
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
    loaded.first_.archive(fields);
    loaded.bank_.archive(fields);
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
    settle();
  }

  [[nodiscard]] const BeliefType& estimate() const noexcept { return belief_; }
  /// One number for each line: 1 for that chosen.
  [[nodiscard]] const Probability& mode_probability() const noexcept { return probability_; }
  [[nodiscard]] const FuzzyCriterion& criterion() const noexcept { return criterion_; }
  [[nodiscard]] bool started() const noexcept { return first_.started(); }

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
  /// The lines through the last 2, 3, ... plots, at present.
  [[nodiscard]] std::span<const Line<Scalar>> lines() const noexcept {
    return {lines_.data(), static_cast<std::size_t>(bank_.lines())};
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  template <class... Known>
  Status move(Scalar dt_s, const Known&... acceleration_mps2) noexcept {
    if (!started()) return Status::kNotStarted;
    if (const Status status = check_time_step(dt_s); status != Status::kOk) return status;
    const Bank before = bank_;
    bank_.advance(dt_s, acceleration_mps2...);
    Status status = Status::kOk;
    if (bank_.lines() == 0) status = first_.predict(dt_s, acceleration_mps2...);
    if (status == Status::kOk) settle();
    if (status == Status::kOk && !(is_finite(belief_.mean) && is_finite(belief_.covariance)))
      status = Status::kNotFinite;
    if (status != Status::kOk) {
      bank_ = before;
      settle();
    }
    return status;
  }

  /// The position part of the belief.
  [[nodiscard]] Gaussian<2, Scalar> position() const noexcept {
    Gaussian<2, Scalar> position;
    position.mean = {belief_.mean[0], belief_.mean[2]};
    position.covariance << belief_.covariance(0, 0), belief_.covariance(0, 2),
        belief_.covariance(2, 0), belief_.covariance(2, 2);
    return position;
  }

  /// The readings and, with probability `none`, the prediction as one plot.
  template <class Sensor>
  [[nodiscard]] Gaussian<2, Scalar> joined(std::span<const Alternative<Sensor, Scalar>> readings,
                                           Scalar none,
                                           std::span<const Scalar> share) const noexcept {
    const Gaussian<2, Scalar> ahead = position();
    Gaussian<2, Scalar> plot{none * ahead.mean, Mat<Scalar, 2, 2>::Zero()};
    const auto each = [&](auto&& add) {
      for (std::size_t k = 0; k < readings.size(); ++k)
        if (share[k] > Scalar(0)) add(share[k], readings[k].sensor.position(readings[k].z));
    };
    const auto spread = [&](Scalar weight, const Gaussian<2, Scalar>& part) {
      const Vec<Scalar, 2> d = part.mean - plot.mean;
      plot.covariance += weight * (part.covariance + d * d.transpose());
    };
    each([&](Scalar weight, const Gaussian<2, Scalar>& part) { plot.mean += weight * part.mean; });
    spread(none, ahead);
    each(spread);
    return plot;
  }

  void take(const Gaussian<2, Scalar>& plot) noexcept {
    if (bank_.lines() > 0)
      judge(plot.mean);
    else
      (void)first_.update(Fix{plot.covariance.template cast<double>()}, plot.mean);
    bank_.add(plot);
    choose(chosen_);
    settle();
  }

  /// How well the lines foretold a plot, and which of them follows from it.
  void judge(const Vec<Scalar, 2>& plot) noexcept {
    judged_ = bank_.lines();
    for (int k = 0; k < judged_; ++k) {
      const auto line = static_cast<std::size_t>(k);
      const double residual_m = double((plot - lines_[line].position_m).norm());
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
    chosen_ = std::clamp(plots, 2, std::max(2, bank_.size()));
    probability_ = Probability::Zero(criterion_.max_plots - 1);
    probability_[chosen_ - 2] = Scalar(1);
  }

  /// The lines, and the belief from that chosen, at present.
  void settle() noexcept {
    bank_.fit(lines_);
    if (bank_.lines() > 0)
      belief_ = lines_[static_cast<std::size_t>(chosen_ - 2)].belief(
          Scalar(criterion_.acceleration_std_mps2));
    else
      belief_ = first_.estimate();
  }

  FuzzyCriterion criterion_;
  Ekf<ConstantVelocity, Scalar> first_;  ///< the belief before there is a line
  Bank bank_;
  typename Bank::Lines lines_;  ///< at present
  BeliefType belief_;
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
