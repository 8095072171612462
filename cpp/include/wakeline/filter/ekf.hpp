// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "wakeline/filter/belief.hpp"
#include "wakeline/filter/concept.hpp"
#include "wakeline/motion/pattern.hpp"
#include "wakeline/simd/flatten.hpp"

namespace wakeline {

/// The extended Kalman filter: motion and sensor linearised about the mean.
///
/// Covariances are updated as P - Wᵀ W with the whitened gain, which keeps them symmetric, and in
/// Joseph form where the prior is so much wider than the plot (after an hour without one) that the
/// difference would cancel; a negative variance in the result is rejected. F and Q of a linear
/// model are cached while the step stays the same. Where a sensor bends too much within the belief
/// (`BendingSensor`: a belief about the antenna itself), it is linearised about the reading instead
/// of the mean, and the innovation is that of the line. Source: Bar-Shalom, Li, Kirubarajan, 5.2.3
/// (linear), 10.3.3 (extended) and 10.5.2 (linearised anew, as the iterated filter).
template <class MotionType, class ScalarType = double>
class Ekf : public Belief<MotionType, ScalarType> {
  using Base = Belief<MotionType, ScalarType>;

 public:
  using Base::kComponents;
  using Base::kStates;
  using typename Base::Motion;
  using typename Base::Scalar;

  /// Throws `std::invalid_argument` when a parameter of the motion model is invalid.
  explicit Ekf(const MotionType& motion) : Base(motion) {
    if constexpr (requires { Motion::kPattern; }) require_pattern<Scalar>(motion);
  }

  /// x = f(x), P = F P Fᵀ + Q.
  WAKELINE_FLATTEN StatusOf<Scalar> predict(Scalar dt_s) noexcept {
    if (!this->started_) return Status::kNotStarted;
    return predict_from(this->belief_, dt_s);
  }

  /// The same under a known acceleration, [north, east]; see `Control`.
  StatusOf<Scalar> predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return Control::predict(*this, dt_s, acceleration_mps2);
  }

  /// Replaces the motion model, unchecked; the belief stays.
  void set_motion(const Motion& motion) noexcept {
    Base::set_motion(motion);
    if constexpr (LinearMotionModel<Motion>) kept_.step_s = Scalar(-1);
  }

  /// The innovation of a reading and its likelihood, without an update.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> innovation(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    return compare(sensor, sensor.observe(z)).scored();
  }

  /// The same for an observed reading, with the likelihood in two factors.
  template <class Sensor>
  WAKELINE_FLATTEN Correction<Sensor::kMeasurements, Scalar> compare(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements, Scalar>& reading) const noexcept {
    if (!this->started_)
      return failed_correction<Sensor::kMeasurements, Scalar>(Status::kNotStarted);
    return Innovation<Sensor>(*this, sensor, seen(sensor, reading));
  }

  /// Updates the belief with the reading z of a sensor.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(const Sensor& sensor,
                                             const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    // Without a lambda between, which GCC 12 does not always inline `correct` through.
    if constexpr (SensorVariant<Sensor>)
      return with_model(
          sensor, [&](const auto& model) { return correct(model, sensor.observe(z)).scored(); });
    else
      return correct(sensor, sensor.observe(z)).scored();
  }

  /// The same with an observed reading; the likelihood in two factors.
  template <class Sensor>
  WAKELINE_FLATTEN Correction<Sensor::kMeasurements, Scalar> correct(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements, Scalar>& observed) noexcept {
    constexpr int kM = Sensor::kMeasurements;
    if (!this->started_) return failed_correction<kM, Scalar>(Status::kNotStarted);
    decltype(auto) reading = seen(sensor, observed);
    Innovation<Sensor> innovation(*this, sensor, reading);
    Correction<kM, Scalar> correction = innovation;
    const auto taken = ok(innovation.status);
    if (none(taken)) return correction;
    Gaussian<kStates, Scalar>& belief = this->belief_;
    Mat<Scalar, kStates, kM> gain = innovation.factor.whiten_rows(innovation.ph);  // P Hᵀ L⁻ᵀ
    Gaussian<kStates, Scalar> next = belief;
    shift(next.mean, gain, innovation.whitened);
    subtract_gram(next.covariance, gain);
    const auto lost = cancels<Scalar, kStates>(belief.covariance, next.covariance);
    if (all(taken) && none(lost)) [[likely]] {
      copy(next, belief);
    } else {
      Gaussian<kStates, Scalar> posterior = next;  // a copy, so that `next` stays in registers
      correction.status =
          first_failure(correction.status, take_with_care(posterior, sensor, reading, taken, lost));
    }
    return correction;
  }

 private:
  /// An observed reading beside the belief.
  template <class Sensor>
  [[gnu::always_inline]] decltype(auto) seen(
      const Sensor& sensor,
      const Gaussian<Sensor::kMeasurements, Scalar>& observed) const noexcept {
    if constexpr (SensorAtPrediction<Sensor>)
      return at_prediction<kComponents>(sensor, observed, this->belief_);
    else
      return (observed);
  }

  template <class Filter, class BeliefType, class... Known>
  friend StatusOf<typename Filter::Scalar> predict_from(Filter& filter, const BeliefType& belief,
                                                        typename Filter::Scalar dt_s,
                                                        const Known&... acceleration_mps2) noexcept;

  /// Predicts from the given belief, unchecked. In lanes that fail the filter's own belief stays.
  [[gnu::always_inline]] StatusOf<Scalar> predict_from(const Gaussian<kStates, Scalar>& belief,
                                                       Scalar dt_s) noexcept {
    this->started_ = true;
    const StatusOf<Scalar> forward = check_time_step(dt_s);
    if (none(ok(forward))) return forward;
    const Vec<Scalar, kStates>& x = belief.mean;
    if constexpr (LinearMotionModel<Motion>) {
      if (any(dt_s != kept_.step_s)) [[unlikely]]
        keep(this->motion_, dt_s);
      const Patterned<kPatternOf<Motion>, Scalar, kStates> f{kept_.f};
      return move(forward, f * x, f, belief.covariance, kept_.q);
    } else {
      Mat<Scalar, kStates, kStates> jacobian = this->motion_.jacobian(x, dt_s);
      return move(forward, this->motion_.transition(x, dt_s),
                  Patterned<kPatternOf<Motion>, Scalar, kStates>{jacobian}, belief.covariance,
                  this->motion_.process_noise(x, dt_s));
    }
  }

  /// A correction and the intermediate results that an update needs. Locals of this type are not
  /// const, because GCC keeps const ones in memory.
  template <class Sensor>
  struct Innovation : Correction<Sensor::kMeasurements, Scalar> {
    static_assert((check_sensor<Sensor, Ekf>(), true));
    static constexpr int kM = Sensor::kMeasurements;
    static constexpr int kReads = kReadsOf<Sensor>;
    static constexpr auto kRows = rows_read<Sensor>(kComponents);

    Mat<Scalar, kM, kReads> h;
    Mat<Scalar, kStates, kM> ph;  ///< P Hᵀ
    Cholesky<kM, Scalar> factor;  ///< of S
    Vec<Scalar, kM> whitened;     ///< L⁻¹ v

    Innovation(const Ekf& filter, const Sensor& sensor,
               const Gaussian<kM, Scalar>& reading) noexcept {
      const Gaussian<kStates, Scalar>& belief = filter.belief_;
      Vec<Scalar, kReads> read;
      unroll<kReads>([&](int k) { read[k] = belief.mean[kRows[k]]; });
      // First, because an arc tangent takes as long as all the rest, which the processor computes
      // meanwhile.
      this->innovation = sensor.residual(reading.mean, sensor.measure(read));
      h = sensor.jacobian(read);
      if constexpr (BendingSensor<Sensor>) {
        Gaussian<kReads, Scalar> at{read, {}};
        unroll<kReads * kReads>([&](auto k) {
          constexpr int i = k.value % kReads, j = k.value / kReads;
          at.covariance(i, j) = belief.covariance(kRows[i], kRows[j]);
        });
        const MaskOf<Scalar> bends = sensor.bends(at, reading.covariance);
        if (any(bends)) [[unlikely]] {
          const Line line = line_at_reading(sensor, read, Vec<Scalar, kM>(reading.mean));
          assign_where(bends, this->innovation, line.innovation);
          assign_where(bends, h, line.h);
        }
      }
      this->innovation_covariance = reading.covariance;
      project<Sensor, kRows>(belief.covariance, h, ph, this->innovation_covariance);
      factor.compute(this->innovation_covariance);
      whitened = factor.template whiten<1>(this->innovation);
      rate(*this, whitened, factor);
    }

   private:
    struct Line {
      Vec<Scalar, kM> innovation;
      Mat<Scalar, kM, kReads> h;
    };

    /// z - h(a) - H(a) (x - a) and H(a), with a the reading's place. By value, so that what the hot
    /// path passes stays in registers.
    [[gnu::cold, gnu::noinline]] static Line line_at_reading(const Sensor& sensor,
                                                             Vec<Scalar, kReads> x,
                                                             Vec<Scalar, kM> z) noexcept {
      const Vec<Scalar, kReads> a = sensor.moved_to(x, z);
      Line line{sensor.residual(z, sensor.measure(a)), sensor.jacobian(a)};
      for (int m = 0; m < kM; ++m)
        for (int k = 0; k < kReads; ++k) line.innovation[m] += line.h(m, k) * (a[k] - x[k]);
      return line;
    }
  };

  /// Assigns x and F P Fᵀ + Q as the belief, where they are finite.
  [[gnu::always_inline]] StatusOf<Scalar> move(
      const StatusOf<Scalar>& forward, const Vec<Scalar, kStates>& x,
      const Patterned<kPatternOf<Motion>, Scalar, kStates>& f,
      const Mat<Scalar, kStates, kStates>& p, const Mat<Scalar, kStates, kStates>& q) noexcept {
    Gaussian<kStates, Scalar>& belief = this->belief_;
    Mat<Scalar, kStates, kStates> fp = f.transposed_product(p);
    Gaussian<kStates, Scalar> next;
    unroll_lower<kStates>([&](auto row, auto column) {
      constexpr int i = row.value, j = column.value;
      next.covariance(i, j) = next.covariance(j, i) = q(i, j) + f.template congruence<i, j>(fp);
    });
    unroll<kStates>([&](int i) { next.mean[i] = x[i]; });
    Scalar sum = Scalar(0);
    unroll<kStates>([&](int i) { sum += next.mean[i] + next.covariance(i, i); });
    const MaskOf<Scalar> finite = sum - sum == Scalar(0);
    const MaskOf<Scalar> moved = ok(forward) && finite;
    if (all(moved)) [[likely]]
      copy(next, belief);
    else
      assign_where(moved, belief, next);
    return first_failure(forward, ok_or(finite, Status::kNotFinite));
  }

  /// Handles the rare cases of an update: lanes that are not taken, and a posterior P - W Wᵀ that
  /// has lost its digits. Rejects a posterior with a negative variance. Recomputes the innovation,
  /// so that the hot one stays in registers.
  template <class Sensor>
  [[gnu::cold, gnu::noinline]] StatusOf<Scalar> take_with_care(
      Gaussian<kStates, Scalar>& posterior, const Sensor& sensor,
      const Gaussian<Sensor::kMeasurements, Scalar>& reading, const MaskOf<Scalar>& taken,
      const MaskOf<Scalar>& lost) noexcept {
    if (any(lost)) {
      const Innovation<Sensor> innovation(*this, sensor, reading);
      assign_where(lost, posterior.covariance, joseph(innovation, reading.covariance));
    }
    MaskOf<Scalar> sound = true;
    for (int i = 0; i < kStates; ++i) sound = sound && posterior.covariance(i, i) >= Scalar(0);
    assign_where(taken && sound, this->belief_, posterior);
    return ok_or(sound, Status::kNotPositiveDefinite);
  }

  /// (I - K H) P (I - K H)ᵀ + K R Kᵀ.
  template <class Sensor, int M>
  Mat<Scalar, kStates, kStates> joseph(const Innovation<Sensor>& innovation,
                                       const Mat<Scalar, M, M>& r) const noexcept {
    const Mat<Scalar, kStates, M> gain =
        innovation.factor.unwhiten_rows(innovation.factor.whiten_rows(innovation.ph));
    Mat<Scalar, kStates, kStates> rest = Mat<Scalar, kStates, kStates>::Identity();
    for (int k = 0; k < innovation.kReads; ++k)
      for (int i = 0; i < kStates; ++i)
        for (int m = 0; m < M; ++m) rest(i, innovation.kRows[k]) -= gain(i, m) * innovation.h(m, k);
    Mat<Scalar, kStates, kStates> p =
        product_transposed(product(rest, this->belief_.covariance), rest);
    const Mat<Scalar, kStates, kStates> of_noise = product_transposed(product(gain, r), gain);
    for (int k = 0; k < p.size(); ++k) p.data()[k] += of_noise.data()[k];
    mirror_lower<Scalar, kStates>(p);
    return p;
  }

  /// Computes F and Q of a linear model: the elements of F that its pattern leaves open, and the
  /// lower triangle of Q.
  template <LinearMotionModel Linear>
  [[gnu::noinline]] WAKELINE_FLATTEN void keep(const Linear& motion, Scalar dt_s) noexcept {
    StepMatrices<kStates, Scalar> matrices = step_matrices(motion, dt_s);
    unroll<kStates * kStates>([&](auto k) {
      constexpr int i = k.value % kStates, j = k.value / kStates;
      if constexpr (kPatternOf<Motion>.element[i][j] == 'x') kept_.f(i, j) = matrices.f(i, j);
    });
    unroll_lower<kStates>([&](int i, int j) { kept_.q(i, j) = matrices.q(i, j); });
    kept_.step_s = dt_s;
  }

  /// F and Q of the last step.
  struct Transition {
    Scalar step_s = Scalar(-1);
    Mat<Scalar, kStates, kStates> f = Mat<Scalar, kStates, kStates>::Zero();
    Mat<Scalar, kStates, kStates> q = Mat<Scalar, kStates, kStates>::Zero();
  };
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<LinearMotionModel<Motion>, Transition, Nothing> kept_;
};

template <class Motion, class Scalar>
inline constexpr bool kPredictsInOneStep<Ekf<Motion, Scalar>> = true;

/// The Kalman filter: an Ekf with a linear motion model and linear sensors, so that nothing is
/// linearised.
template <class MotionType, class ScalarType = double>
class Kalman : public Ekf<MotionType, ScalarType> {
  static_assert(!MotionModel<MotionType> || LinearMotionModel<MotionType>,
                "wakeline: Kalman needs a linear motion model (matrix(dt_s)); use Ekf or Ukf");
  using Base = Ekf<MotionType, ScalarType>;

 public:
  using Scalar = ScalarType;

  explicit Kalman(const MotionType& motion) : Base(motion) {}

  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> innovation(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    check_linear<Sensor>();
    return Base::innovation(sensor, z);
  }

  template <class Sensor>
  [[gnu::always_inline]] Correction<Sensor::kMeasurements, Scalar> compare(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements, Scalar>& reading) const noexcept {
    check_linear<Sensor>();
    return Base::compare(sensor, reading);
  }

  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(const Sensor& sensor,
                                             const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    check_linear<Sensor>();
    return Base::update(sensor, z);
  }

  template <class Sensor>
  [[gnu::always_inline]] Correction<Sensor::kMeasurements, Scalar> correct(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements, Scalar>& reading) noexcept {
    check_linear<Sensor>();
    return Base::correct(sensor, reading);
  }

 private:
  template <class Sensor>
  static constexpr void check_linear() noexcept {
    static_assert(LinearMeasurementModel<Sensor>,
                  "wakeline: Kalman needs a linear sensor (kLinear = true); use "
                  "ConvertedRangeBearing, or Ekf or Ukf");
  }
};

template <class Motion, class Scalar>
inline constexpr bool kPredictsInOneStep<Kalman<Motion, Scalar>> = true;

}  // namespace wakeline
