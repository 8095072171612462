// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "wakeline/core/archive.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/multimodel/line_bank.hpp"
#include "wakeline/multimodel/mixture.hpp"
#include "wakeline/multimodel/mode_chain.hpp"

namespace wakeline {

/// Common part of the estimators that track with lines through the last plots: a start, the plots
/// and their lines, the interface of `Imm`.
///
/// Until there are enough plots for the shortest line, the estimate is the initial belief updated
/// by a Kalman filter; from then on only the plots count. Uses the position of any
/// `PositionSensor`; innovations are in north and east. Steps may be irregular. No heap.
///
/// `Derived` has `begin()` for a start, `pass(dt_s)` for a time step, `evaluate(plot, lanes)` for a
/// plot that the lines have predicted, before it is stored, `update_belief()`, which computes the
/// belief from the lines, and `evaluation()`, its state beside the plots.
template <class Derived, int Capacity, class ScalarType>
class LineEstimator {
 public:
  using Scalar = ScalarType;
  using Mask = MaskOf<Scalar>;
  static constexpr int kModels = kRuntimeModes;
  static constexpr auto kComponents = kKinematics;
  using Probability = ModeVector<Scalar, kModels>;
  using BeliefType = StateBelief<kComponents, Scalar>;
  using Bank = LineBank<Capacity, Scalar>;

  /// Starts with a belief over `[x, vx, y, vy]`. An invalid one changes nothing.
  StatusOf<Scalar> start(const Gaussian<4, Scalar>& belief) noexcept {
    const auto before = memory(bank_);
    const StatusOf<Scalar> status = first_.start(belief);
    if (none(ok(status))) return status;
    bank_.clear();
    derived().begin();
    refresh();
    if (!all(ok(status))) take_back(!ok(status), before);
    return status;
  }

  /// Extrapolates the lines.
  StatusOf<Scalar> predict(Scalar dt_s) noexcept { return move(dt_s); }

  /// The same under a known acceleration, [north, east]; see `Control`.
  StatusOf<Scalar> predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return move(dt_s, acceleration_mps2);
  }

  /// Evaluates the lines with a plot and stores it.
  template <class Sensor>
  Step<2, Scalar> update(const Sensor& sensor,
                         const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    const Step<2, Scalar> step = innovation(sensor, z);
    if (none(ok(step.status))) return step;
    const Mask lost = ok(step.status) && !take(sensor.position(z), ok(step.status));
    return any(lost) ? failed_where<2, Scalar>(lost, Status::kNotFinite, step) : step;
  }

  /// The innovation [north, east] of a plot and its likelihood, without an update.
  template <class Sensor>
  Step<2, Scalar> innovation(const Sensor& sensor,
                             const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    return compare(sensor, z).scored();
  }

  /// The same with the likelihood in two factors.
  template <class Sensor>
  Correction<2, Scalar> compare(const Sensor& sensor,
                                const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    static_assert(PositionSensor<Sensor>,
                  "wakeline: lines through plots need a sensor that fixes a position: position(z) "
                  "-> Gaussian<2>; see cpp/docs/concepts.md");
    Correction<2, Scalar> correction;
    if (!started()) return correction;
    Gaussian<2, Scalar> plot = sensor.position(z);
    reject_out_of_range(plot.mean);
    const Gaussian<2, Scalar> ahead = position();
    correction.innovation = plot.mean - ahead.mean;
    correction.innovation_covariance = ahead.covariance + plot.covariance;
    const Cholesky<2, Scalar> factor(correction.innovation_covariance);
    rate(correction, factor.template whiten<1>(correction.innovation), factor);
    return correction;
  }

  /// The likelihood of a reading, without an update.
  template <class Sensor>
  [[nodiscard]] Evidence<Scalar> evidence(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    Evidence<Scalar> evidence;
    evidence.add(Scalar(1), compare(sensor, z));
    return evidence;
  }

  /// Probabilistic data association, as in `Imm`. The stored plot has the mean and covariance of
  /// the target's position over all hypotheses: at one of the readings, or where it was predicted.
  /// When the hypothesis of no reading is the most probable one, the scan counts as missed, so that
  /// no line is fitted to predictions.
  template <class Sensor>
  Scalar update(std::span<const Alternative<Sensor, Scalar>> readings, Scalar none,
                std::span<Scalar> share) noexcept requires(kLanesOf<Scalar> == 1) {
    for (Scalar& part : share) part = Scalar(0);
    if (!started()) return Scalar(0);
    Scalar owned = Scalar(0);
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const auto step = compare(readings[k].sensor, readings[k].z);
      if (step) share[k] = readings[k].weight * step.likelihood().value();
      owned += share[k];
    }
    const Scalar total = none + owned;
    const bool possible = total > Scalar(0) && std::isfinite(total);
    for (Scalar& part : share) part = possible ? part / total : Scalar(0);
    if (!possible) return Scalar(0);
    if (owned <= none || take(joined(readings, none / total, share), true)) return total;
    for (Scalar& part : share) part = Scalar(0);
    return Scalar(0);
  }

  [[nodiscard]] const BeliefType& estimate() const noexcept { return belief_; }
  [[nodiscard]] bool started() const noexcept { return first_.started(); }
  /// True once there are enough plots for a line.
  [[nodiscard]] Mask ready() const noexcept { return bank_.holds(least_plots_); }
  /// The lines through the last 2, 3, ... plots, at present.
  [[nodiscard]] std::span<const Line<Scalar>> lines() const noexcept {
    return {lines_.data(), static_cast<std::size_t>(bank_.lines())};
  }

 protected:
  /// The initial belief, with `acceleration_std_mps2` per axis, is used until there are
  /// `least_plots`.
  LineEstimator(int max_plots, int least_plots, double acceleration_std_mps2)
      : first_(ConstantVelocity{PiecewiseAcceleration{acceleration_std_mps2}}),
        bank_(max_plots),
        least_plots_(least_plots) {}

  /// Saves or restores the start and the plots; `refresh` must follow.
  void archive_plots(Archive& fields) {
    first_.archive(fields);
    bank_.archive(fields);
  }

  /// Recomputes the lines and the belief at present.
  void refresh() noexcept {
    bank_.fit(lines_);
    const Mask tracks = ready();
    if (any(tracks)) derived().update_belief();
    if (!all(tracks)) assign_where<Mask, 4, Scalar>(!tracks, belief_, first_.estimate());
  }

  Ekf<ConstantVelocity, Scalar> first_;  ///< the belief before there is a line
  Bank bank_;
  typename Bank::Lines lines_;  ///< at present
  BeliefType belief_;

 private:
  int least_plots_;

  Derived& derived() noexcept { return static_cast<Derived&>(*this); }

  /// The state changed by a step; of the plots only those that a step changes.
  template <class Plots>
  struct Memory {
    Gaussian<4, Scalar> first;
    Plots plots;
    std::remove_cvref_t<decltype(std::declval<const Derived&>().evaluation())> evaluation;
  };

  template <class Plots>
  [[nodiscard]] Memory<Plots> memory(const Plots& plots) const noexcept {
    return {first_.estimate(), plots, static_cast<const Derived&>(*this).evaluation()};
  }

  /// Restores the previous state in the given lanes.
  template <class Plots>
  void take_back(const Mask& lanes, const Memory<Plots>& before) noexcept {
    first_.assign_in(lanes, before.first);
    bank_.take_back(lanes, before.plots);
    derived().set_evaluation(lanes, before.evaluation);
    refresh();
  }

  template <class... Known>
  StatusOf<Scalar> move(Scalar dt_s, const Known&... acceleration_mps2) noexcept {
    if (!started()) return Status::kNotStarted;
    StatusOf<Scalar> status = check_time_step(dt_s);
    if (none(ok(status))) return status;
    const auto before = memory(bank_.before_change(acceleration_mps2...));
    bank_.advance(dt_s, acceleration_mps2...);
    derived().pass(dt_s);
    if (const Mask tracks = ready(); !all(tracks)) {
      const StatusOf<Scalar> moved = first_.predict(dt_s, acceleration_mps2...);
      status = first_failure(status, select(tracks, StatusOf<Scalar>(Status::kOk), moved));
    }
    refresh();
    status = first_failure(status, ok_or(is_sound(), Status::kNotFinite));
    if (!all(ok(status))) take_back(!ok(status), before);
    return status;
  }

  /// Evaluates and stores a plot in the given lanes. False, and nothing changed, where the belief
  /// would not be finite.
  Mask take(const Gaussian<2, Scalar>& plot, const Mask& lanes) noexcept {
    auto before = memory(bank_.before_change());
    const Mask tracks = ready();
    if (any(lanes && tracks)) derived().evaluate(plot, lanes && tracks);
    if (any(lanes && !tracks)) {
      Gaussian<2, Scalar> reading = plot;
      constexpr auto kNone = std::numeric_limits<RealOf<Scalar>>::quiet_NaN();
      for (int i = 0; i < 2; ++i)
        reading.mean[i] = select(lanes && !tracks, plot.mean[i], Scalar(kNone));
      (void)first_.correct(Fix{}, reading);
    }
    before.plots.entered = bank_.add(plot, lanes);
    refresh();
    const Mask sound = is_sound();
    if (!all(sound)) take_back(!sound, before);
    return sound;
  }

  [[nodiscard]] Mask is_sound() const noexcept {
    return is_finite(belief_.mean) && is_finite(belief_.covariance);
  }

  /// The position part of the belief.
  [[nodiscard]] Gaussian<2, Scalar> position() const noexcept {
    Gaussian<2, Scalar> position;
    position.mean = {belief_.mean[0], belief_.mean[2]};
    position.covariance << belief_.covariance(0, 0), belief_.covariance(0, 2),
        belief_.covariance(2, 0), belief_.covariance(2, 2);
    return position;
  }

  /// The readings and, with probability `none`, the prediction, combined into one plot.
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
};

}  // namespace wakeline
