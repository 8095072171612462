// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/rts_smoother.hpp"
#include "wakeline/gating/chi_square_gate.hpp"
#include "wakeline/navigation/usv_models.hpp"
#include "wakeline/navigation/usv_sensors.hpp"

namespace wakeline {

/// When own ship's navigator does not believe a reading.
struct UsvOutliers {
  ChiSquareGate gate{0.999};  ///< a reading whose NIS is outside is rejected
  int rejections = 10;        ///< of one kind in a row, before the next one is believed

  void validate() const {
    gate.validate();
    require(rejections >= 0, "rejections", "zero or more", rejections);
  }
};

/// What a reading has done. A rejected one has status `kMissed` and leaves the belief as it was;
/// innovation and NIS are those before any widening. The NIS of an absurd one is infinite.
template <int M, class Scalar = double>
struct [[nodiscard]] UsvReading : Step<M, Scalar> {
  bool rejected = false;  ///< outside the gate
  bool widened = false;   ///< outside, but believed after too many rejections
};

/// One step of time and what drove it.
template <class Scalar = double>
struct UsvLeg {
  Scalar dt_s = Scalar(0);
  UsvInput input{};
};

/// Own ship's position, motion and heading by her IMU, corrected by whatever else there is: fixes
/// (`Fix`), velocities over ground, compass, log, rate of turn, each whenever it comes, after a
/// step up to its time.
///
/// - Without readings it coasts and the covariance grows; without the IMU too, a step assumes no
///   acceleration and no turn, with the noise `unmeasured`.
/// - A reading outside the gate is rejected. When more than `rejections` of its kind in a row were,
///   it is the belief that is wrong: the states are widened by the likeliest error that would
///   explain the reading, P_ii += g_i², g = P Hᵀ (H P Hᵀ)⁻¹ v, and it is taken.
/// - An absurd reading, finite but more than a million standard deviations off (a thousand in
///   `float`) or so large that its last digit is more than one, says nothing of the belief: it is
///   rejected however often it comes, and not counted. A belief widened to it would have no digits
///   left.
/// - The heading of the estimate is in [-pi, pi].
///
/// Model: `UsvMotion`, `UsvBiasMotion` or `UsvCurrentMotion`; FilterType: `Ekf`, `Ukf` (additive
/// noise) or `AugmentedUkf` (the IMU's noise through the motion; the transform of both is the
/// fourth argument of the constructor). All agree where turns between readings are small. Source:
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

  /// The noise of the IMU is that of `model.input`; further arguments go to the filter. Throws
  /// `std::invalid_argument` when a parameter makes no sense.
  template <class... Options>
  explicit UsvNavigator(const Model& model = {}, const UsvOutliers& outliers = {},
                        const ImuNoise& unmeasured = {0.1, deg(2.0)}, const Options&... options)
      : filter_(model, options...),
        model_(model),
        unmeasured_(validated(unmeasured)),
        rejections_(validated(outliers).rejections),
        gate1_(outliers.gate),
        gate2_(outliers.gate) {}

  Status start(const UsvStart& start) noexcept {
    return this->start(model_.template start_belief<Scalar>(start));
  }

  Status start(const State& belief) noexcept {
    const Status status = filter_.start(belief);
    if (status != Status::kOk) return status;
    rejected_ = {};
    wrap();
    return status;
  }

  /// The step under a reading of the IMU, and the one without.
  [[nodiscard]] Leg leg(Scalar dt_s, const Imu& imu) const noexcept {
    return {dt_s, {imu, model_.input.noise, 1.0}};
  }
  [[nodiscard]] Leg leg(Scalar dt_s) const noexcept { return {dt_s, {{}, unmeasured_, 0.0}}; }

  Status predict(Scalar dt_s, const Imu& imu) noexcept { return predict(leg(dt_s, imu)); }
  Status predict(Scalar dt_s) noexcept { return predict(leg(dt_s)); }

  Status predict(const Leg& leg) noexcept {
    filter_.set_motion(driven(leg));
    const Status status = filter_.predict(leg.dt_s);
    if (status == Status::kOk) wrap();
    return status;
  }

  /// Corrects the belief by the reading z of a sensor, unless it is an outlier.
  template <class Sensor>
  UsvReading<Sensor::kMeasurements, Scalar> update(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    UsvReading<Sensor::kMeasurements, Scalar> reading{filter_.innovation(sensor, z)};
    if (is_absurd(reading, z)) {
      reading.nis = std::numeric_limits<Scalar>::infinity();
      return rejected(reading);
    }
    if (!reading) return reading;
    int& in_a_row = rejected_[static_cast<std::size_t>(rows_read<Sensor>(kComponents)[0])];
    if (gate<Sensor::kMeasurements>().contains(reading.nis)) {
      reading.status = filter_.update(sensor, z).status;
    } else if (in_a_row < rejections_) {
      ++in_a_row;
      return rejected(reading);
    } else {
      const State before = estimate();
      widen(sensor, reading.innovation);
      reading.status = filter_.update(sensor, z).status;
      reading.widened = bool(reading);
      if (!reading) (void)filter_.assign(before);
    }
    if (!reading) return reading;
    in_a_row = 0;
    wrap();
    return reading;
  }

  [[nodiscard]] const State& estimate() const noexcept { return filter_.estimate(); }
  [[nodiscard]] bool started() const noexcept { return filter_.started(); }
  [[nodiscard]] const Model& model() const noexcept { return model_; }

  /// Rauch-Tung-Striebel smoother of a log, with additive noise, in place: `legs[k]` leads from
  /// belief k, as it was after all readings of its time, to belief k + 1. Returns the first
  /// failure, with that belief and all before it left as filtered. It knows nothing of a widening,
  /// whose jump it spreads.
  Status smooth(std::span<State> beliefs, std::span<const Leg> legs) const noexcept {
    for (std::size_t k = beliefs.size(); k-- > 1;) {
      const Leg& leg = legs[k - 1];
      const Model motion = driven(leg);
      std::array pair{beliefs[k - 1], beliefs[k]};
      const Scalar expected = motion.transition(pair[0].mean, leg.dt_s)[kHeadingRow];
      Scalar& heading = pair[1].mean[kHeadingRow];
      heading = expected + wrap_angle(Scalar(heading - expected));  // the same turn of the circle
      const Status status = wakeline::smooth<Model, Scalar>(motion, pair, std::span(&leg.dt_s, 1));
      if (status != Status::kOk) return status;
      pair[0].mean[kHeadingRow] = wrap_angle(pair[0].mean[kHeadingRow]);
      beliefs[k - 1] = pair[0];
    }
    return Status::kOk;
  }

  /// Saves or restores belief and counts of rejections.
  void archive(Archive& fields) {
    filter_.archive(fields);
    fields(rejected_);
  }

 private:
  static constexpr int kHeadingRow = index_of(kComponents, kHeading);
  static constexpr Scalar kDigit = std::numeric_limits<Scalar>::epsilon();
  static constexpr Scalar kFarthestStds = kDigit < 1e-10F ? 1e6F : 1e3F;

  [[nodiscard]] Model driven(const Leg& leg) const noexcept {
    Model model = model_;
    model.input = leg.input;
    return model;
  }

  template <int M>
  [[nodiscard]] const auto& gate() const noexcept {
    static_assert(M == 1 || M == 2, "wakeline: the navigator takes readings of one or two numbers");
    if constexpr (M == 1)
      return gate1_;
    else
      return gate2_;
  }

  template <class Reading>
  static Reading rejected(Reading reading) noexcept {
    reading.rejected = true;
    reading.status = Status::kMissed;
    return reading;
  }

  /// Whether a reading is finite, but too far or too large to be one.
  template <int M>
  static bool is_absurd(const Step<M, Scalar>& step, const Vec<Scalar, M>& z) noexcept {
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

  /// P_ii += g_i², g = P Hᵀ (H P Hᵀ)⁻¹ v: of what the belief itself takes for the likeliest error
  /// behind the innovation. After a silence that is of the velocity or the current that the
  /// position comes from, too.
  template <class Sensor, int M>
  void widen(const Sensor& sensor, const Vec<Scalar, M>& innovation) noexcept {
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
        factor.whiten_rows(ph) * factor.template whiten<1>(innovation);
    belief.covariance.diagonal() += error.cwiseAbs2();
    (void)filter_.assign(belief);
  }

  Filter filter_;
  Model model_;
  ImuNoise unmeasured_;
  int rejections_;
  EllipsoidalGate<1, Scalar> gate1_;
  EllipsoidalGate<2, Scalar> gate2_;
  std::array<int, kStates> rejected_{};  ///< in a row, by the first state that the sensor reads
};

}  // namespace wakeline
