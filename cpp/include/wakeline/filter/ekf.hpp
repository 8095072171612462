// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "wakeline/filter/belief.hpp"

namespace wakeline {

/// The extended Kalman filter: motion and sensor linearised about the mean.
///
/// Covariances are updated as P - Wᵀ W with the whitened gain, which keeps them symmetric, and in
/// Joseph form where a prior so much wider than the plot (after an hour without one) would make
/// that difference cancel. F and Q of a linear model are kept as long as the step stays the same.
/// Source: Bar-Shalom, Li, Kirubarajan, 5.2.3 (linear) and 10.3.3 (extended).
template <class MotionType, class ScalarType = double>
class Ekf : public Belief<MotionType, ScalarType> {
  using Base = Belief<MotionType, ScalarType>;

 public:
  using Base::kComponents;
  using Base::kStates;
  using typename Base::Motion;
  using typename Base::Scalar;

  explicit Ekf(const MotionType& motion) : Base(motion) {}

  /// x = f(x), P = F P Fᵀ + Q.
  Status predict(Scalar dt_s) noexcept {
    if (!this->started_) return Status::kNotStarted;
    if (const Status status = check_time_step(dt_s); status != Status::kOk) return status;
    const Vec<Scalar, kStates>& x = this->belief_.mean;
    if constexpr (LinearMotionModel<Motion>) {
      if (dt_s != kept_.step_s)
        kept_ = {dt_s, this->motion_.matrix(dt_s), this->motion_.process_noise(dt_s)};
      return move(kept_.f * x, kept_.f, kept_.q);
    } else {
      return move(this->motion_.transition(x, dt_s), this->motion_.jacobian(x, dt_s),
                  this->motion_.process_noise(x, dt_s));
    }
  }

  /// The same under a known acceleration, [north, east]; see `Control`.
  Status predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return Control::predict(*this, dt_s, acceleration_mps2);
  }

  /// Replaces the motion model, unchecked; the belief stays.
  void set_motion(const Motion& motion) noexcept {
    Base::set_motion(motion);
    kept_ = {};
  }

  /// The innovation of a reading and its likelihood, without taking it.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> innovation(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    Step<Sensor::kMeasurements, Scalar> step;
    const Innovation<Sensor> innovation(*this, sensor, z, step);
    if (step) score(step, innovation.whitened, innovation.factor);
    return step;
  }

  /// Corrects the belief by the reading z of a sensor.
  template <class Sensor>
  [[gnu::flatten]] Step<Sensor::kMeasurements, Scalar> update(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    constexpr int kM = Sensor::kMeasurements;
    Step<kM, Scalar> step;
    const Innovation<Sensor> innovation(*this, sensor, z, step);
    if (!step) return step;
    Gaussian<kStates, Scalar>& belief = this->belief_;
    const Mat<Scalar, kStates, kM> gain = innovation.factor.whiten_rows(innovation.ph);  // P Hᵀ L⁻ᵀ
    const Mat<Scalar, kStates, kStates> posterior = belief.covariance - gain * gain.transpose();
    belief.mean.noalias() += gain * innovation.whitened;
    if (cancels<Scalar, kStates>(belief.covariance, posterior)) [[unlikely]]
      belief.covariance = joseph(sensor, innovation.h, innovation.factor.unwhiten_rows(gain), z);
    else
      belief.covariance = posterior;
    score(step, innovation.whitened, innovation.factor);  // last: nothing waits for the logarithm
    return step;
  }

 private:
  /// All of an update but the correction.
  template <class Sensor>
  struct Innovation {
    static constexpr int kM = Sensor::kMeasurements;
    static constexpr int kReads = kReadsOf<Sensor>;
    static constexpr auto kRows = rows_read<Sensor>(kComponents);

    Mat<Scalar, kM, kReads> h;
    Mat<Scalar, kStates, kM> ph;  ///< P Hᵀ
    Cholesky<kM, Scalar> factor;  ///< of S
    Vec<Scalar, kM> whitened;     ///< L⁻¹ v

    /// Fills all of `step` but the likelihood, too.
    Innovation(const Ekf& filter, const Sensor& sensor, const Vec<Scalar, kM>& z,
               Step<kM, Scalar>& step) noexcept {
      check_sensor<Sensor, Ekf>();
      if (!filter.started_) return;
      const Gaussian<kStates, Scalar>& belief = filter.belief_;
      Vec<Scalar, kReads> read;
      for (int k = 0; k < kReads; ++k) read[k] = belief.mean[kRows[k]];
      const Gaussian<kM, Scalar> reading = sensor.observe(z);
      // First, because an arc tangent takes as long as all that follows, which the processor does
      // meanwhile.
      step.innovation = sensor.residual(reading.mean, sensor.measure(read));
      h = sensor.jacobian(read);
      for (int m = 0; m < kM; ++m) {
        ph.col(m) = h(m, 0) * belief.covariance.col(kRows[0]);
        for (int k = 1; k < kReads; ++k) ph.col(m) += h(m, k) * belief.covariance.col(kRows[k]);
      }
      for (int n = 0; n < kM; ++n)
        for (int m = n; m < kM; ++m) {
          Scalar s = reading.covariance(m, n);
          for (int k = 0; k < kReads; ++k) s += h(m, k) * ph(kRows[k], n);
          step.innovation_covariance(m, n) = step.innovation_covariance(n, m) = s;
        }
      factor.compute(step.innovation_covariance);
      if (!factor.ok()) {
        step.status = refusal<Scalar, kM>(step.innovation_covariance);
        return;
      }
      whitened = factor.template whiten<1>(step.innovation);
      rate(step, whitened);
    }
  };

  /// Takes x and F P Fᵀ + Q as the belief, when they are finite.
  [[gnu::flatten]] Status move(const Vec<Scalar, kStates>& x,
                               const Mat<Scalar, kStates, kStates>& f,
                               const Mat<Scalar, kStates, kStates>& q) noexcept {
    Gaussian<kStates, Scalar>& belief = this->belief_;
    const Mat<Scalar, kStates, kStates> fp = f * belief.covariance;
    Mat<Scalar, kStates, kStates> p = q;
    p.noalias() += fp * f.transpose();
    if (!is_finite(x) || !is_finite(p.diagonal())) return Status::kNotFinite;
    belief.mean = x;
    belief.covariance = p;
    mirror_lower<Scalar, kStates>(belief.covariance);
    return Status::kOk;
  }

  /// (I - K H) P (I - K H)ᵀ + K R Kᵀ.
  template <class Sensor, int M, int Reads>
  [[gnu::cold, gnu::noinline]] Mat<Scalar, kStates, kStates> joseph(
      const Sensor& sensor, const Mat<Scalar, M, Reads>& h, const Mat<Scalar, kStates, M>& gain,
      const Vec<Scalar, M>& z) const noexcept {
    constexpr auto kRows = rows_read<Sensor>(kComponents);
    const Mat<Scalar, M, M> r = sensor.observe(z).covariance;
    Mat<Scalar, kStates, kStates> rest = Mat<Scalar, kStates, kStates>::Identity();
    for (int k = 0; k < Reads; ++k) rest.col(kRows[k]) -= gain * h.col(k);
    Mat<Scalar, kStates, kStates> p =
        rest * this->belief_.covariance * rest.transpose() + gain * r * gain.transpose();
    mirror_lower<Scalar, kStates>(p);
    return p;
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

/// The Kalman filter: an Ekf whose motion model and sensors are linear, so that nothing is
/// approximated.
template <class MotionType, class ScalarType = double>
class Kalman : public Ekf<MotionType, ScalarType> {
  static_assert(!MotionModel<MotionType> || LinearMotionModel<MotionType>,
                "wakeline: Kalman needs a linear motion model (matrix(dt_s)); use Ekf or Ukf");

 public:
  using Scalar = ScalarType;

  explicit Kalman(const MotionType& motion) : Ekf<MotionType, ScalarType>(motion) {}

  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(const Sensor& sensor,
                                             const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    static_assert(LinearMeasurementModel<Sensor>,
                  "wakeline: Kalman needs a linear sensor (kLinear = true); use "
                  "ConvertedRangeBearing, or Ekf or Ukf");
    return Ekf<MotionType, ScalarType>::update(sensor, z);
  }
};

}  // namespace wakeline
