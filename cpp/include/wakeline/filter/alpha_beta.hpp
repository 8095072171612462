// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <type_traits>
#include <variant>

#include "wakeline/filter/alpha_beta_gains.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/measurement/own_ship.hpp"
#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/motion/constant_velocity.hpp"

namespace wakeline {

/// The last plots of a target, for `AdaptiveGains`.
template <class Scalar>
struct RecentPlots {
  static constexpr int kMost = AdaptiveGains::kMostPlots;
  /// [north, east, time since the plot before], newest first.
  Mat<Scalar, 3, kMost> plots = Mat<Scalar, 3, kMost>::Zero();
  Scalar count = Scalar(0);

  void add(const Vec<Scalar, 2>& plot_m, Scalar gap_s) noexcept {
    for (int k = kMost - 1; k > 0; --k) plots.col(k) = plots.col(k - 1);
    plots.col(0) << plot_m, gap_s;
    count = counted(count + Scalar(1), kMost);
  }

  /// [alpha, beta] of (33) over the last `window` plots: one pass with the gains (27).
  [[nodiscard]] Vec<Scalar, 2> response(int window) const noexcept {
    using Two = Vec<Scalar, 2>;
    const Scalar size = counted(count, window);
    Two value = Two::Zero(), rate = Two::Zero();
    Two product = Two::Zero(), squared = Two::Zero();
    for (int k = window - 1; k >= 0; --k) {
      const Scalar n = at_least(size - Scalar(k), Scalar(1));  // the n-th plot of the window
      const Two gains = GrowingMemory{}.gains<2>(GainOccasion<Scalar>{.reading = n});
      const Scalar dt_s = plots(2, k);
      const auto later = dt_s > Scalar(0);
      const Scalar per_s = select(later, Scalar(1) / select(later, dt_s, Scalar(1)), Scalar(0));
      const Two predicted = value + rate * dt_s;
      const Two innovation = plots.col(k).template head<2>() - predicted;
      value = predicted + gains[0] * innovation;
      rate += gains[1] * per_s * innovation;
      const Scalar weight = select(n > Scalar(2), innovation.squaredNorm(), Scalar(0));
      const Two weights(weight, weight * per_s * per_s);
      product += gains.cwiseProduct(weights);
      squared += weights;
    }
    // The line through the first two plots, and where all lie on it.
    const Two begun = GrowingMemory{}.gains<2>(GainOccasion<Scalar>{.reading = counted(size, 2)});
    const auto ratio = [&](int k) {
      const auto judged = squared[k] > Scalar(0);
      return select(judged, product[k] / select(judged, squared[k], Scalar(1)), begun[k]);
    };
    return {ratio(0), ratio(1)};
  }

  void archive(Archive& fields) {
    fields(plots);
    fields(count);
    if (!(count >= Scalar(0))) fields.fail();
  }

  friend void assign_where(const MaskOf<Scalar>& condition, RecentPlots& target,
                           const RecentPlots& value) noexcept {
    for (int k = 0; k < 3 * kMost; ++k)
      target.plots.data()[k] = select(condition, value.plots.data()[k], target.plots.data()[k]);
    target.count = select(condition, value.count, target.count);
  }
};

/// A filter with scheduled gains: alpha-beta over `[x, vx, y, vy]` (`Order` 2), alpha-beta-gamma
/// over `[x, vx, ax, y, vy, ay]` (3).
///
///     x += alpha e,   vx += beta e / T,   ax += gamma e / (2 T²)
///
/// per axis, e the innovation in north and east and T the time since the last reading, missed scans
/// included. Where the plot is more accurate along the bearing than across, a schedule that depends
/// on its error has different gains along and across. Readings of about the same time, within an
/// eighth of the longest prediction before the first of them, share one T: over the short time
/// between two unsynchronised radars beta / T would be so large that errors grow with every gain. A
/// reading at the time of the start corrects the position only.
///
/// The covariance is the true one for these gains when plots and motion match the models: (I - K H)
/// P (I - K H)ᵀ + K R Kᵀ after an update, F P Fᵀ + Q after a prediction. NIS and likelihood follow
/// from it, so the filter can be compared with a Kalman filter or be a model of an `Imm`. Uses the
/// position of any `PositionSensor`.
template <int Order, class ScalarType = double>
class AlphaBetaFilter
    : public Ekf<std::conditional_t<Order == 2, ConstantVelocity, ConstantAcceleration>,
                 ScalarType> {
  static_assert(Order == 2 || Order == 3,
                "wakeline: an alpha-beta filter has 2 or 3 states an axis");
  using Base =
      Ekf<std::conditional_t<Order == 2, ConstantVelocity, ConstantAcceleration>, ScalarType>;

 public:
  using Base::kStates;
  using typename Base::Motion;
  using typename Base::Scalar;
  using Schedule = GainSchedule<Order>;

  /// Throws `std::invalid_argument` when a parameter is invalid.
  AlphaBetaFilter(const Schedule& schedule, const Motion& motion)
      : Base(motion), schedule_(checked(schedule)) {}

  /// With the process noise that corresponds to a tracking index, else the default noise of the
  /// motion model.
  explicit AlphaBetaFilter(const Schedule& schedule)
      : AlphaBetaFilter(schedule, motion_of(checked(schedule))) {}

  /// Starts with a belief over the state or over `[x, vx, y, vy]`, and restarts the schedule.
  template <class BeliefType>
  StatusOf<Scalar> start(const BeliefType& belief) noexcept {
    const StatusOf<Scalar> status = Base::start(belief);
    assign_where(ok(status), occasion_, Occasion{});
    return status;
  }

  StatusOf<Scalar> predict(Scalar dt_s) noexcept { return count(Base::predict(dt_s), dt_s); }

  /// The same under a known acceleration, [north, east]; see `Control`.
  StatusOf<Scalar> predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return count(Base::predict(dt_s, acceleration_mps2), dt_s);
  }

  /// The innovation [north, east] of a plot and its likelihood, without an update.
  template <class Sensor>
  Step<2, Scalar> innovation(const Sensor& sensor,
                             const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    check_fixes_position<Sensor>();
    return Base::compare(Fix{}, sensor.position(z)).scored();
  }

  /// The innovation of an observed position and its likelihood in two factors, without an update.
  template <class Sensor>
  Correction<2, Scalar> compare(const Sensor&, const Gaussian<2, Scalar>& reading) const noexcept {
    check_reads_position<Sensor>();
    return Base::compare(Fix{}, reading);
  }

  /// Updates the belief with a plot.
  template <class Sensor>
  Step<2, Scalar> update(const Sensor& sensor,
                         const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    check_fixes_position<Sensor>();
    return take(sensor, sensor.position(z)).scored();
  }

  /// The same with an observed position; the likelihood in two factors.
  template <class Sensor>
  Correction<2, Scalar> correct(const Sensor& sensor, const Gaussian<2, Scalar>& reading) noexcept {
    check_reads_position<Sensor>();
    return take(sensor, reading);
  }

  /// Saves or restores the belief and the state of the schedule.
  void archive(Archive& fields) {
    AlphaBetaFilter loaded = *this;
    Occasion& occasion = loaded.occasion_;
    static_cast<Base&>(loaded).archive(fields);
    fields(occasion.reading);
    fields(occasion.elapsed_s);
    fields(occasion.step_s);
    fields(occasion.since_s);
    fields(occasion.since_step_s);
    fields(occasion.taken);
    occasion.recent.archive(fields);
    if (!(occasion.reading >= Scalar(1)) || !(occasion.elapsed_s >= Scalar(0)) ||
        !(occasion.step_s >= Scalar(0)) || !(occasion.since_s >= Scalar(0)) ||
        !(occasion.since_step_s >= Scalar(0)))
      fields.fail();
    if (fields.loading() && fields.ok()) *this = loaded;
  }

  [[nodiscard]] const Schedule& schedule() const noexcept { return schedule_; }

  /// State of the schedule: the number of the current reading, the time since the one before, and
  /// whether it has been taken. Saved and restored where an update is tried only.
  struct Occasion {
    Scalar reading = Scalar(1);
    Scalar elapsed_s = Scalar(0);
    Scalar step_s = Scalar(0);        ///< the longest prediction of that time
    Scalar since_s = Scalar(0);       ///< since it was taken
    Scalar since_step_s = Scalar(0);  ///< the longest prediction since
    MaskOf<Scalar> taken = false;     ///< the reading has been taken; a later one is the next
    RecentPlots<Scalar> recent;       ///< empty unless gains are adaptive

    friend void assign_where(const MaskOf<Scalar>& condition, Occasion& target,
                             const Occasion& value) noexcept {
      target.reading = select(condition, value.reading, target.reading);
      target.elapsed_s = select(condition, value.elapsed_s, target.elapsed_s);
      target.step_s = select(condition, value.step_s, target.step_s);
      target.since_s = select(condition, value.since_s, target.since_s);
      target.since_step_s = select(condition, value.since_step_s, target.since_step_s);
      target.taken = (condition && value.taken) || (!condition && target.taken);
      assign_where(condition, target.recent, value.recent);
    }
  };
  [[nodiscard]] const Occasion& memory() const noexcept { return occasion_; }
  void recall(const Occasion& occasion) noexcept { occasion_ = occasion; }

 private:
  using Gain = Mat<Scalar, kStates, 2>;
  using AxisGain = Vec<Scalar, Order>;

  /// Part of a step within which readings count as simultaneous: with small steps between larger
  /// ones, errors grow under stable gains (`stable_gains`) from about a twelfth on.
  static constexpr double kOneTime = 1.0 / 8;

  static const Schedule& checked(const Schedule& schedule) {
    std::visit([](const auto& gains) { gains.template validate<Order>(); }, schedule);
    return schedule;
  }

  static Motion motion_of(const Schedule& schedule) noexcept {
    Motion motion;
    if (const auto* index = std::get_if<TrackingIndex>(&schedule))
      motion.noise = PiecewiseAcceleration{index->accel_std_mps2};
    return motion;
  }

  StatusOf<Scalar> count(const StatusOf<Scalar>& status, Scalar dt_s) noexcept {
    const Scalar passed_s = select(ok(status), dt_s, Scalar(0));
    const Scalar before_s = select(occasion_.taken, Scalar(0), passed_s);
    const Scalar after_s = passed_s - before_s;
    occasion_.elapsed_s += before_s;
    occasion_.step_s = at_least(occasion_.step_s, before_s);
    occasion_.since_s += after_s;
    occasion_.since_step_s = at_least(occasion_.since_step_s, after_s);
    return status;
  }

  /// Starts a reading: the next one where it is later than those before.
  void begin() noexcept {
    const auto later = occasion_.since_s > Scalar(kOneTime) * occasion_.step_s;
    const auto next = occasion_.taken && later;
    occasion_.reading += select(next, Scalar(1), Scalar(0));
    occasion_.elapsed_s = select(next, occasion_.since_s, occasion_.elapsed_s);
    occasion_.step_s = select(next, occasion_.since_step_s, occasion_.step_s);
    occasion_.since_s = select(next, Scalar(0), occasion_.since_s);
    occasion_.since_step_s = select(next, Scalar(0), occasion_.since_step_s);
    occasion_.taken = occasion_.taken && !later;
  }

  template <class Sensor>
  static constexpr void check_fixes_position() noexcept {
    static_assert(
        PositionSensor<Sensor>,
        "wakeline: an alpha-beta filter needs a sensor that fixes a position: position(z) "
        "-> Gaussian<2>; see cpp/docs/concepts.md");
  }

  template <class Sensor>
  static constexpr void check_reads_position() noexcept {
    static_assert(kIsDirect<Sensor> && Sensor::kReads == kPosition,
                  "wakeline: among several models an alpha-beta filter needs a sensor whose "
                  "readings are positions: ConvertedRangeBearing, Position or Fix");
  }

  /// Changes nothing where the result is not finite.
  template <class Sensor>
  Correction<2, Scalar> take(const Sensor& sensor, const Gaussian<2, Scalar>& plot) noexcept {
    Correction<2, Scalar> correction = Base::compare(Fix{}, plot);
    if (none(ok(correction.status))) return correction;
    begin();
    RecentPlots<Scalar> recent = occasion_.recent;
    const Gain k = gain(plot.covariance, range(sensor, plot.mean), response(plot.mean, recent));
    Gaussian<kStates, Scalar> next = this->belief_;
    shift(next.mean, k, correction.innovation);
    correct_covariance(next.covariance, k, plot.covariance);
    correction.status = first_failure(
        correction.status,
        ok_or(is_finite(next.mean) && is_finite(next.covariance), Status::kNotFinite));
    const MaskOf<Scalar> taken = ok(correction.status);
    assign_where(taken, this->belief_, next);
    if (adaptive_gains() != nullptr) assign_where(taken, occasion_.recent, recent);
    occasion_.taken = occasion_.taken || taken;
    return correction;
  }

  const AdaptiveGains* adaptive_gains() const noexcept {
    if constexpr (Order == 2)
      return std::get_if<AdaptiveGains>(&schedule_);
    else
      return nullptr;
  }

  /// [alpha, beta] of (33) with a plot, which is added to `recent` unless it is of the same time as
  /// the newest; ones for schedules that do not adapt.
  Vec<Scalar, 2> response(const Vec<Scalar, 2>& plot_m,
                          RecentPlots<Scalar>& recent) const noexcept {
    const AdaptiveGains* adaptive = adaptive_gains();
    if (adaptive == nullptr) return Vec<Scalar, 2>::Ones();
    RecentPlots<Scalar> more = recent;
    more.add(plot_m, occasion_.elapsed_s);
    assign_where(!occasion_.taken, recent, more);
    return recent.response(adaptive->window);
  }

  /// P becomes (I - K H) P (I - K H)ᵀ + K R Kᵀ.
  static void correct_covariance(Mat<Scalar, kStates, kStates>& p, const Gain& k,
                                 const Mat<Scalar, 2, 2>& r) noexcept {
    Gain rest = -k;  // columns 0 and Order of I - K H; the others are those of I
    rest(0, 0) += Scalar(1);
    rest(Order, 1) += Scalar(1);
    Mat<Scalar, kStates, kStates> a;  // (I - K H) P
    unroll<kStates * kStates>([&](auto at) {
      constexpr int i = at.value % kStates, j = at.value / kStates;
      const Scalar sum = rest(i, 0) * p(0, j) + rest(i, 1) * p(Order, j);
      a(i, j) = i % Order == 0 ? sum : sum + p(i, j);
    });
    unroll_lower<kStates>([&](auto row, auto column) {
      constexpr int i = row.value, j = column.value;
      const Scalar sum = a(i, 0) * rest(j, 0) + a(i, Order) * rest(j, 1) +
                         (k(i, 0) * r(0, 0) + k(i, 1) * r(1, 0)) * k(j, 0) +
                         (k(i, 0) * r(1, 0) + k(i, 1) * r(1, 1)) * k(j, 1);
      p(i, j) = p(j, i) = j % Order == 0 ? sum : sum + a(i, j);
    });
  }

  template <class Sensor>
  static Scalar range(const Sensor& sensor, const Vec<Scalar, 2>& plot) noexcept {
    using std::sqrt;
    if (const OwnShip* own = own_ship_of(sensor))
      return sqrt((plot - own->template position<Scalar>()).squaredNorm());
    return sqrt(plot.squaredNorm());
  }

  /// [alpha, beta / T, gamma / (2 T²)] for a plot error of `std_m`.
  [[nodiscard]] AxisGain axis_gain(Scalar std_m, Scalar range_m,
                                   const Vec<Scalar, 2>& response) const noexcept {
    const GainOccasion<Scalar> occasion{occasion_.reading, occasion_.elapsed_s, std_m, range_m,
                                        response};
    AxisGain gain = std::visit(
        [&](const auto& schedule) -> AxisGain { return schedule.template gains<Order>(occasion); },
        schedule_);
    const auto later = occasion.elapsed_s > Scalar(0);
    const Scalar per_s =
        select(later, Scalar(1) / select(later, occasion.elapsed_s, Scalar(1)), Scalar(0));
    gain[1] *= per_s;
    if constexpr (Order == 3) gain[2] *= per_s * per_s / 2;
    return gain;
  }

  /// K: the gains along the short axis of R, plus the difference of those along the long axis.
  [[nodiscard]] Gain gain(const Mat<Scalar, 2, 2>& r, Scalar range_m,
                          const Vec<Scalar, 2>& response) const noexcept {
    using std::sqrt;
    const Scalar half_sum = (r(0, 0) + r(1, 1)) / 2;
    const Scalar half_difference = (r(0, 0) - r(1, 1)) / 2;
    const Scalar spread = sqrt(half_difference * half_difference + r(1, 0) * r(1, 0));
    const Scalar longest = half_sum + spread;  // variances along the axes of R
    const Scalar product = r(0, 0) * r(1, 1) - r(1, 0) * r(1, 0);
    const Scalar shortest = select(product > Scalar(0), product / longest, Scalar(0));
    const AxisGain along = axis_gain(sqrt(shortest), range_m, response);
    const auto uneven = spread > Scalar(0);
    Mat<Scalar, 2, 2> onto_long = Mat<Scalar, 2, 2>::Zero();  // projection on the long axis
    AxisGain more = AxisGain::Zero();
    if (any(uneven)) {
      const Scalar scale = Scalar(1) / select(uneven, 2 * spread, Scalar(1));
      const auto onto = [&](Scalar part) { return select(uneven, part * scale, Scalar(0)); };
      onto_long << onto(longest - r(1, 1)), onto(r(1, 0)), onto(r(1, 0)), onto(longest - r(0, 0));
      more = axis_gain(sqrt(longest), range_m, response) - along;
    }
    Gain k;
    for (int axis = 0; axis < 2; ++axis) {
      k.col(axis).template head<Order>() = onto_long(0, axis) * more;
      k.col(axis).template tail<Order>() = onto_long(1, axis) * more;
      k.col(axis).template segment<Order>(Order * axis) += along;
    }
    return k;
  }

  Schedule schedule_;
  Occasion occasion_;
};

/// Over `[x, vx, y, vy]`.
template <class Scalar = double>
using AlphaBeta = AlphaBetaFilter<2, Scalar>;

/// Over `[x, vx, ax, y, vy, ay]`.
template <class Scalar = double>
using AlphaBetaGamma = AlphaBetaFilter<3, Scalar>;

}  // namespace wakeline
