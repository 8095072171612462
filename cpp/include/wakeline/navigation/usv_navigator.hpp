// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

#include "wakeline/core/fields.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/rts_smoother.hpp"
#include "wakeline/gating/chi_square_gate.hpp"
#include "wakeline/navigation/usv_models.hpp"
#include "wakeline/navigation/usv_sensors.hpp"

namespace wakeline {

/// When own ship's navigator rejects a reading.
struct UsvOutliers {
  ChiSquareGate gate = {0.999};
  int rejections = 10;

  static constexpr auto fields() noexcept {
    using U = UsvOutliers;
    return field_table(
        field("gate", &U::gate, "A reading outside this gate is rejected."),
        field(
            "rejections", &U::rejections, at_least(0), "readings",
            "Readings of one sensor in a row that are rejected before the next one is believed; 0: "
            "every reading is used as it is."));
  }

  void validate() const { validate_fields(*this); }
};

/// Result of a reading. A rejected one has status `kGated` and leaves the belief unchanged;
/// innovation and NIS are those before any widening. The NIS of an implausible one is infinite.
template <int M, class Scalar = double>
struct [[nodiscard]] UsvReading : Step<M, Scalar> {
  bool rejected = false;  ///< outside the gate
  bool widened = false;   ///< outside, but used after too many rejections
};

/// One time step and its input.
template <class Scalar = double>
struct UsvLeg {
  Scalar dt_s = Scalar(0);
  UsvInput input{};
};

/// Own ship's position, motion and heading from its IMU, corrected by any other sensors: fixes
/// (`Fix`), velocities over ground, compass, log, rate of turn, each at any time, after a step to
/// its time.
///
/// - Without readings it predicts and the covariance grows. Without the IMU too, a step assumes
///   zero acceleration and turn rate with the noise `unmeasured`, constant over the step: divide a
///   long time into several steps, or the next position determines the velocity too precisely.
/// - A reading outside the gate is rejected. After more than `rejections` of its kind in a row, the
///   belief is considered wrong: its covariance is widened by the most probable error that explains
///   the reading, P_ii += g_i², g = P Hᵀ (H P Hᵀ)⁻¹ v, and the reading is used. With 0 there is no
///   gate.
/// - It is not used when positions refute the readings: when positions fit the belief, and fit the
///   position integrated with the rejected readings so much worse that the accumulated difference
///   of NIS (CUSUM) is outside the gate. Velocities over ground then stay rejected until one is
///   inside the gate of 0.9. Compass and log change the current instead of position and velocity,
///   and are rejected where the current would increase and leave the gate of `current_std_mps`. The
///   refutation ends after three rejected positions in a row, after one that is used though it did
///   not fit, and after 15 s or three times the last interval without any. Likewise headings refute
///   rates of turn.
/// - An implausible reading, finite but more than a million standard deviations off (a thousand in
///   `float`) or so large that its last digit exceeds one standard deviation, is rejected however
///   often it occurs, and not counted. A belief widened to it would have no significant digits.
/// - Each fix counts as a measurement: a receiver with frozen output is not detected here; the
///   reader of a log does that (`recording.read_nmea` in Python).
/// - The heading of the estimate is in [-pi, pi].
///
/// Model: `UsvMotion`, `UsvBiasMotion` or `UsvCurrentMotion`; FilterType: `Ekf`, `Ukf` (additive
/// noise) or `AugmentedUkf` (the IMU's noise through the motion; the unscented parameters of both
/// are the fourth argument of the constructor). All agree for small turns between readings. Source:
/// Evsyukov, Andreeva, Khanychev, equations (1)-(25).
template <class Model, template <class, class> class FilterType = Ekf, class ScalarType = double>
class UsvNavigator {
 public:
  using Scalar = ScalarType;
  using Filter = FilterType<Model, Scalar>;
  using Leg = UsvLeg<Scalar>;
  static constexpr auto kComponents = Model::kComponents;
  static constexpr int kStates = kStatesOf<Model>;
  using State = Gaussian<kStates, Scalar>;

  /// The noise of the IMU is that of `model.input`; further arguments are passed to the filter.
  /// Throws `std::invalid_argument` when a parameter is invalid.
  template <class... Options>
  explicit UsvNavigator(const Model& model = {}, const UsvOutliers& outliers = {},
                        const ImuNoise& unmeasured = {0.1, deg(2.0)}, const Options&... options)
      : filter_(model, options...),
        model_(model),
        unmeasured_(validated(unmeasured)),
        rejections_(validated(outliers).rejections),
        gates1_{EllipsoidalGate<1, Scalar>(outliers.gate),
                EllipsoidalGate<1, Scalar>(narrower(outliers.gate))},
        gates2_{EllipsoidalGate<2, Scalar>(outliers.gate),
                EllipsoidalGate<2, Scalar>(narrower(outliers.gate))} {}

  Status start(const UsvStart& start) noexcept {
    return this->start(model_.template start_belief<Scalar>(start));
  }

  Status start(const State& belief) noexcept {
    const Status status = filter_.start(belief);
    if (status != Status::kOk) return status;
    rejected_ = {};
    evidence_ = reading_error_ = silent_s_ = pause_s_ = {};
    off_.setZero();
    strayed_.setZero();
    by_gyro_.setZero();
    wrap();
    return status;
  }

  /// The step with a reading of the IMU; the overload without one assumes none.
  [[nodiscard]] Leg leg(Scalar dt_s, const Imu& imu) const noexcept {
    return {dt_s, {imu, model_.input.noise, 1.0}};
  }
  [[nodiscard]] Leg leg(Scalar dt_s) const noexcept { return {dt_s, {{}, unmeasured_, 0.0}}; }

  Status predict(Scalar dt_s, const Imu& imu) noexcept { return predict(leg(dt_s, imu)); }
  Status predict(Scalar dt_s) noexcept { return predict(leg(dt_s)); }

  Status predict(const Leg& leg) noexcept {
    const Model motion = driven(leg);
    const State before = estimate();
    filter_.set_motion(motion);
    const Status status = filter_.predict(leg.dt_s);
    if (status != Status::kOk) return status;
    note_gyro(leg, motion, before);
    strayed_ += leg.dt_s * off_;
    for (Scalar& silent_s : silent_s_) silent_s += leg.dt_s;
    forget_silent();
    wrap();
    return status;
  }

  /// Updates the belief with the reading z of a sensor, unless it is an outlier.
  template <class Sensor>
  UsvReading<Sensor::kMeasurements, Scalar> update(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    UsvReading<Sensor::kMeasurements, Scalar> reading{filter_.innovation(as_taken(sensor), z)};
    if (is_implausible(reading, z)) {
      reading.nis = std::numeric_limits<Scalar>::infinity();
      return rejected(reading);
    }
    if (!reading) return reading;
    constexpr int kKind = kKindOf<Sensor>;
    const State before = estimate();
    pause_s_[kKind] = std::exchange(silent_s_[kKind], Scalar(0));
    if constexpr (kSplitsWay<Sensor>) reading_error_[kKind] = reading.innovation[0];
    const bool fits = rejections_ == 0 || gate<Sensor>().contains(reading.nis);
    if (!fits && (rejected_[kKind] < rejections_ || !widen(sensor, reading.innovation))) {
      rejected_[kKind] = std::min(rejected_[kKind] + 1, rejections_);
      off_.col(kKind) = off<Sensor>(reading.innovation);
      if (rejected_[kKind] >= std::min(kFew, rejections_)) clear_refuted<Sensor>();
      return rejected(reading);
    }
    reading.status = filter_.update(as_taken(sensor), z).status;
    reading.widened = !fits && bool(reading);
    if (!reading) {
      (void)filter_.assign(before);
      return reading;
    }
    if constexpr (kErrsWithStep<Sensor>) by_gyro_.setZero();
    rejected_[kKind] = 0;
    clear_evidence(kKind);
    if (fits)
      update_evidence<Sensor>(before, reading);
    else
      clear_refuted<Sensor>();
    wrap();
    return reading;
  }

  /// A step revised with a rate of turn measured beside its gyro, z: turned by the
  /// information-weighted mean of both. The difference, gyro minus indicator, measures the gyro's
  /// bias with a noise that is independent of that of the mean.
  [[nodiscard]] static Leg turned_by(const RateOfTurn& sensor, const Vec<Scalar, 1>& z,
                                     Leg leg) noexcept {
    double& gyro_std = leg.input.noise.yaw_rate_std_rad_s;
    const double gyro = gyro_std * gyro_std, rate = sensor.rate_std_rad_s * sensor.rate_std_rad_s;
    const double share = rate / (rate + gyro);
    leg.input.imu.yaw_rate_rad_s += (1.0 - share) * (double(z[0]) - leg.input.imu.yaw_rate_rad_s);
    leg.input.gyro_share = share;
    gyro_std *= std::sqrt(share);
    return leg;
  }

  [[nodiscard]] const State& estimate() const noexcept { return filter_.estimate(); }
  [[nodiscard]] bool started() const noexcept { return filter_.started(); }
  [[nodiscard]] const Model& model() const noexcept { return model_; }

  /// Rauch-Tung-Striebel smoother of a log, with additive noise, in place: `legs[k]` is the step
  /// from belief k, after all readings of its time, to belief k + 1, and is `turned_by` a rate of
  /// turn used there. Returns the first failure, with that belief and all before it left as
  /// filtered. A widening is not modelled; its jump is spread over time.
  Status smooth(std::span<State> beliefs, std::span<const Leg> legs) const noexcept {
    for (std::size_t k = beliefs.size(); k-- > 1;) {
      const Leg& leg = legs[k - 1];
      const Model motion = driven(leg);
      std::array pair{beliefs[k - 1], beliefs[k]};
      const Scalar expected = motion.transition(pair[0].mean, leg.dt_s)[kHeadingRow];
      Scalar& heading = pair[1].mean[kHeadingRow];
      heading =
          expected + wrap_angle(Scalar(
                         heading - expected));  // the equivalent angle nearest to the expected one
      const Status status = smooth_as(filter_, motion, pair, std::span(&leg.dt_s, 1));
      if (status != Status::kOk) return status;
      pair[0].mean[kHeadingRow] = wrap_angle(pair[0].mean[kHeadingRow]);
      beliefs[k - 1] = pair[0];
    }
    return Status::kOk;
  }

  /// Saves or restores the belief and the state of rejections.
  void archive(Archive& fields) {
    filter_.archive(fields);
    fields(rejected_);
    fields(evidence_);
    fields(reading_error_);
    fields(silent_s_);
    fields(pause_s_);
    fields(off_);
    fields(strayed_);
    fields(by_gyro_);
    fields(predicted_);
    fields(gyro_rad_s_);
    fields(gyro_std_rad_s_);
  }

 private:
  static constexpr int kNorthRow = index_of(kComponents, Component::kNorth);
  static constexpr int kHeadingRow = index_of(kComponents, kHeading);
  static constexpr int kGyroBiasRow = index_of(kComponents, kGyroBias);
  static constexpr int kSpeedRow = index_of(kComponents, kSpeedThroughWater);
  static constexpr int kCurrentRow = index_of(kComponents, kCurrentNorth);
  static constexpr bool kHasCurrent = kCurrentRow >= 0;

  template <class Sensor>
  static constexpr int kKindOf = rows_read<Sensor>(kComponents)[0];

  /// True for a sensor of a rate of change of what another one measures: velocity, rate of turn.
  template <class Sensor>
  static constexpr bool kIsRate =
      Sensor::kReads[0] == Component::kVnorth || Sensor::kReads[0] == kCurrentNorth ||
      Sensor::kReads[0] == kGyroBias;

  /// True for a sensor of a part of the velocity through the water, which with the current gives
  /// the velocity over ground: compass, log.
  template <class Sensor>
  static constexpr bool kSplitsWay = kHasCurrent&& Sensor::kMeasurements == 1 &&
                                     (kKindOf<Sensor> == kHeadingRow ||
                                      kKindOf<Sensor> == kSpeedRow);

  /// True for a sensor whose readings can refute others: a position, or a heading.
  template <class Sensor>
  static constexpr bool kIsJudge =
      kKindOf<Sensor> == kNorthRow ? Sensor::kMeasurements == 2
                                   : kKindOf<Sensor> == kHeadingRow&& Sensor::kMeasurements == 1;

  /// True for a sensor whose noise also drove the last step.
  template <class Sensor>
  static constexpr bool kErrsWithStep = std::is_same_v<Sensor, RateOfTurn>&& kGyroBiasRow >= 0;

  using Pair = Vec<Scalar, 2>;
  static constexpr int kFew = 3;                   ///< misfits in a row that are significant
  static constexpr Scalar kMostEvidence = 40;      ///< limited so that a few misfits cancel it
  static constexpr double kTogether_s = 2.0;       ///< between readings of compass and log
  static constexpr double kSilence_s = 15.0;       ///< after which others are no longer refuted
  static constexpr double kBackProbability = 0.9;  ///< of the gate of refuted rates
  static constexpr Scalar kDigit = std::numeric_limits<Scalar>::epsilon();
  static constexpr Scalar kFarthestStds = kDigit < 1e-10F ? 1e6F : 1e3F;

  [[nodiscard]] Model driven(const Leg& leg) const noexcept {
    Model model = model_;
    model.input = leg.input;
    return model;
  }

  /// Stores the effect of the gyro noise in a step: its covariance with the state's error is its
  /// variance times df/d(rate of turn), the negative effect of a gyro bias.
  void note_gyro(const Leg& leg, const Model& motion, const State& before) noexcept {
    by_gyro_.setZero();
    if constexpr (kGyroBiasRow >= 0) {
      if (leg.input.bias_share != 1.0) return;
      const double std = leg.input.noise.yaw_rate_std_rad_s;
      by_gyro_ = -Scalar(std * std) * motion.jacobian(before.mean, leg.dt_s).col(kGyroBiasRow);
      by_gyro_[kGyroBiasRow] += Scalar(std * std);
      predicted_ = estimate().covariance;
      gyro_rad_s_ = leg.input.imu.yaw_rate_rad_s;
      gyro_std_rad_s_ = std;
    }
  }

  /// A sensor as passed to the filter. Readings since the step leave y = P⁻¹ C unchanged, because
  /// they reduce C = cov(x - x̂, v) and P alike.
  template <class Sensor>
  [[nodiscard]] auto as_taken(const Sensor& sensor) const noexcept {
    if constexpr (kErrsWithStep<Sensor>) {
      ErringTogether<Sensor, kComponents> taken{sensor, estimate().mean.template cast<double>(),
                                                Vec<double, kStates>::Zero(), 0.0};
      const Cholesky<kStates, Scalar> factor(predicted_);
      if (by_gyro_.isZero(0) || sensor.gyro_rad_s != gyro_rad_s_ || !factor.ok()) return taken;
      const double share = std::min(1.0, sensor.gyro_std_rad_s / gyro_std_rad_s_);
      const Vec<Scalar, kStates> weight =
          Scalar(share * share) * factor.template solve<1>(by_gyro_);
      taken.weight = weight.template cast<double>();
      taken.common_variance = double(weight.dot(estimate().covariance * weight));
      return taken;
    } else {
      return sensor;
    }
  }

  static ChiSquareGate narrower(const ChiSquareGate& gate) noexcept {
    return {std::min(gate.probability, kBackProbability)};
  }

  template <class Sensor>
  [[nodiscard]] const auto& gate() const noexcept {
    constexpr int kM = Sensor::kMeasurements;
    static_assert(kM == 1 || kM == 2,
                  "wakeline: the navigator takes readings of one or two numbers");
    const std::size_t which = kIsRate<Sensor> && refuted(kKindOf<Sensor>);
    if constexpr (kM == 1)
      return gates1_[which];
    else
      return gates2_[which];
  }

  template <class Reading>
  static Reading rejected(Reading reading) noexcept {
    reading.rejected = true;
    reading.status = Status::kGated;
    return reading;
  }

  /// True when a reading is finite but implausible.
  template <int M>
  static bool is_implausible(const Step<M, Scalar>& step, const Vec<Scalar, M>& z) noexcept {
    if (step.status == Status::kNotStarted || !is_finite(z)) return false;
    for (int k = 0; k < M; ++k) {
      const Scalar std = std::sqrt(step.innovation_covariance(k, k));
      if (std::abs(step.innovation[k]) > kFarthestStds * std || std::abs(z[k]) * kDigit > std)
        return true;
    }
    return false;
  }

  void wrap() noexcept {
    const Scalar heading = estimate().mean[kHeadingRow];
    if (heading >= -kPi<Scalar> && heading <= kPi<Scalar>) return;
    State belief = estimate();
    belief.mean[kHeadingRow] = wrap_angle(heading);
    (void)filter_.assign(belief);
  }

  /// Difference of the velocity over ground, or of the rate of turn in the first row, from the
  /// belief if the reading were right.
  template <class Sensor, int M>
  [[nodiscard]] Pair off(const Vec<Scalar, M>& innovation) const noexcept {
    Pair off = Pair::Zero();
    if constexpr (kSplitsWay<Sensor>) {
      auto revised = estimate().mean;
      revised[kKindOf<Sensor>] += innovation[0];
      off = Model::way_mps(revised) - Model::way_mps(estimate().mean);
    } else if constexpr (kIsRate<Sensor>) {
      off.template head<M>() = innovation;
    }
    return off;
  }

  /// The kind whose readings refute those of `kind`: headings for rates of turn, else positions.
  static constexpr int refuting_kind(std::size_t kind) noexcept {
    return int(kind) == kGyroBiasRow ? kHeadingRow : kNorthRow;
  }

  template <class Sensor>
  static constexpr bool refutes(std::size_t other) noexcept {
    return kIsJudge<Sensor> && refuting_kind(other) == kKindOf<Sensor>;
  }

  /// Accumulates, for each rejected kind, how much worse a used reading would fit had they been
  /// right (CUSUM), and resets its dead-reckoned state to the belief.
  template <class Sensor, int M>
  void update_evidence(const State& before, const Step<M, Scalar>& reading) noexcept {
    if constexpr (kIsJudge<Sensor>) {
      constexpr int kRow = kKindOf<Sensor>;
      const Cholesky<M, Scalar> factor(reading.innovation_covariance);
      const Mat<Scalar, M, M> covariance = before.covariance.template block<M, M>(kRow, kRow);
      for (std::size_t other = 0; other < kStates; ++other) {
        if (!refutes<Sensor>(other) || rejected_[other] == 0) continue;
        const Vec<Scalar, M> strayed = strayed_.col(int(other)).template head<M>();
        Vec<Scalar, M> innovation = reading.innovation - strayed;
        if constexpr (kRow == kHeadingRow) innovation[0] = wrap_angle(Scalar(innovation[0]));
        const Scalar nis = factor.template whiten<1>(innovation).squaredNorm();
        evidence_[other] =
            std::clamp(evidence_[other] + nis - reading.nis, Scalar(0), kMostEvidence);
        strayed_.col(int(other)).template head<M>() -=
            covariance * factor.template solve<1>(strayed);
      }
    }
  }

  [[nodiscard]] bool refuted(int kind) const noexcept {
    return !gates2_[0].contains(evidence_[static_cast<std::size_t>(kind)]);
  }

  /// Clears the evidence against a kind.
  void clear_evidence(std::size_t kind) noexcept {
    evidence_[kind] = Scalar(0);
    off_.col(int(kind)).setZero();
    strayed_.col(int(kind)).setZero();
  }

  /// The same for all kinds that readings of a sensor can refute.
  template <class Sensor>
  void clear_refuted() noexcept {
    for (std::size_t other = 0; other < kStates; ++other)
      if (refutes<Sensor>(other)) clear_evidence(other);
  }

  /// Clears kinds that are silent, or whose refuting kind is: it cannot show when they are right
  /// again.
  void forget_silent() noexcept {
    for (std::size_t kind = 0; kind < kStates; ++kind)
      if (is_silent(kind) || is_silent(std::size_t(refuting_kind(kind)))) clear_evidence(kind);
  }

  [[nodiscard]] bool is_silent(std::size_t kind) const noexcept {
    return silent_s_[kind] > std::max(Scalar(kSilence_s), Scalar(kFew) * pause_s_[kind]);
  }

  /// Widens the belief for a repeatedly rejected reading; false where it is refuted.
  template <class Sensor, int M>
  bool widen(const Sensor& sensor, const Vec<Scalar, M>& innovation) noexcept {
    if (refuted(kKindOf<Sensor>)) {
      if constexpr (kIsRate<Sensor>) return false;
      if constexpr (kSplitsWay<Sensor>) return adjust_current(kKindOf<Sensor>);
    }
    doubt_all(sensor, innovation);
    return true;
  }

  /// Sets heading or speed through the water to the readings, or both where both are rejected.
  bool adjust_current(int row) noexcept {
    const int other = row == kHeadingRow ? kSpeedRow : kHeadingRow;
    const auto k = static_cast<std::size_t>(other);
    const bool both = rejected_[k] >= rejections_ && silent_s_[k] <= Scalar(kTogether_s);
    return adjust_current(std::array{row}) || (both && adjust_current(std::array{row, other}));
  }

  /// The same for these rows. Position and velocity over ground stay: the current takes the
  /// difference, and its covariance grows by as much. False where the current would be stronger
  /// than now and implausible for the model.
  template <std::size_t N>
  bool adjust_current(const std::array<int, N>& rows) noexcept {
    const State now = estimate();
    State revised = now;
    for (const int row : rows) {
      const Scalar reading_error = reading_error_[static_cast<std::size_t>(row)];
      revised.mean[row] += reading_error;
      revised.covariance.row(row).setZero();
      revised.covariance.col(row).setZero();
      revised.covariance(row, row) = square(reading_error);
    }
    const Vec<Scalar, 2> current = Model::current_left(now.mean, revised.mean);
    const Vec<Scalar, 2> before = now.mean.template tail<2>();
    const Scalar strength = current.squaredNorm();
    const bool expected = gates2_[0].contains(strength / square(Scalar(model_.current_std_mps)));
    if (!expected && strength > before.squaredNorm()) return false;
    revised.mean.template tail<2>() = current;
    revised.covariance.template bottomRightCorner<2, 2>() +=
        (current - before) * (current - before).transpose();
    by_gyro_.setZero();
    return filter_.assign(revised) == Status::kOk;
  }

  static Scalar square(Scalar x) noexcept { return x * x; }

  /// P_ii += g_i², g = P Hᵀ (H P Hᵀ)⁻¹ v: the most probable error of the belief that explains the
  /// innovation. After a silence also that of the velocity or the current from which the position
  /// results.
  template <class Sensor, int M>
  void doubt_all(const Sensor& sensor, const Vec<Scalar, M>& innovation) noexcept {
    constexpr auto kRows = rows_read<Sensor>(kComponents);
    State belief = estimate();
    Vec<Scalar, kReadsOf<Sensor>> read;
    for (int k = 0; k < kReadsOf<Sensor>; ++k) read[k] = belief.mean[kRows[k]];
    Mat<Scalar, kStates, M> ph;
    Mat<Scalar, M, M> expected = Mat<Scalar, M, M>::Zero();
    project<Sensor, kRows>(belief.covariance, sensor.jacobian(read), ph, expected);
    const Cholesky<M, Scalar> factor(expected);
    if (!factor.ok()) return;
    const Vec<Scalar, kStates> error =
        product(factor.whiten_rows(ph), Vec<Scalar, M>(factor.template whiten<1>(innovation)));
    for (int i = 0; i < kStates; ++i) belief.covariance(i, i) += square(error[i]);
    (void)filter_.assign(belief);
    by_gyro_.setZero();
  }

  Filter filter_;
  Vec<Scalar, kStates> by_gyro_ = Vec<Scalar, kStates>::Zero();  ///< cov(x - x̂, v) after the step
  Mat<Scalar, kStates, kStates> predicted_ = Mat<Scalar, kStates, kStates>::Identity();
  double gyro_rad_s_ = 0.0;      ///< input of the last step
  double gyro_std_rad_s_ = 0.0;  ///< its noise then
  Model model_;
  ImuNoise unmeasured_;
  int rejections_;
  std::array<EllipsoidalGate<1, Scalar>, 2> gates1_;  ///< the second for refuted rates
  std::array<EllipsoidalGate<2, Scalar>, 2> gates2_;  ///< the first also for evidence
  // By kind of sensor, i.e. the first state that it reads:
  std::array<int, kStates> rejected_{};     ///< in a row, up to `rejections_`
  std::array<Scalar, kStates> evidence_{};  ///< against the rejected ones, as a difference of NIS
  std::array<Scalar, kStates> reading_error_{};  ///< last error of heading or speed
  std::array<Scalar, kStates> silent_s_{};       ///< since the last reading
  std::array<Scalar, kStates> pause_s_{};        ///< between the last two
  Mat<Scalar, 2, kStates> off_ =
      Mat<Scalar, 2, kStates>::Zero();  ///< rejected rates minus the belief
  Mat<Scalar, 2, kStates> strayed_ =
      off_;  ///< displacement from the belief, had the rejected ones been right
};

}  // namespace wakeline
