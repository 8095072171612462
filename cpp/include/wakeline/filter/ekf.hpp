// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "wakeline/filter/belief.hpp"

namespace wakeline {

/// The extended Kalman filter: motion and sensor linearised about the mean.
///
/// Covariances are updated as P - Wᵀ W with the whitened gain, which keeps them symmetric, and in Joseph form where a
/// prior so much wider than the plot (after an hour without one) would make that difference cancel. F and Q of a linear
/// model are kept as long as the step stays the same.
/// Source: Bar-Shalom, Li, Kirubarajan, 5.2.3 (linear) and 10.3.3 (extended).
template <class MotionType, class ScalarType = double>
class Ekf : public Belief<MotionType, ScalarType> {
  using Base = Belief<MotionType, ScalarType>;

 public:
  using typename Base::Motion;
  using typename Base::Scalar;
  using Base::kComponents;
  using Base::kStates;

  explicit Ekf(const MotionType& motion) : Base(motion) {}

  /// x = f(x), P = F P Fᵀ + Q.
  Status predict(Scalar dt_s) noexcept {
    if (!this->started_) return Status::kNotStarted;
    if (const Status status = check_time_step(dt_s); status != Status::kOk) return status;
    Gaussian<kStates, Scalar> next;
    if constexpr (LinearMotionModel<Motion>) {
      if (dt_s != kept_.step_s) kept_ = {dt_s, this->motion_.matrix(dt_s), this->motion_.process_noise(dt_s)};
      next.mean.noalias() = kept_.f * this->belief_.mean;
      next.covariance = propagated(kept_.f, kept_.q);
    } else {
      const Vec<Scalar, kStates>& x = this->belief_.mean;
      next.mean = this->motion_.transition(x, dt_s);
      next.covariance =
          propagated(this->motion_.jacobian(x, dt_s), this->motion_.process_noise(x, dt_s));
    }
    if (!is_finite(next.mean) || !is_finite(next.covariance.diagonal())) return Status::kNotFinite;
    this->belief_ = next;
    return Status::kOk;
  }

  /// The innovation of a reading and its likelihood, without taking it.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> innovation(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    return Innovation<Sensor>(*this, sensor, z).step;
  }

  /// Corrects the belief by the reading z of a sensor.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    constexpr int kM = Sensor::kMeasurements;
    const Innovation<Sensor> innovation(*this, sensor, z);
    if (!innovation.step) return innovation.step;
    Gaussian<kStates, Scalar>& belief = this->belief_;
    const Mat<Scalar, kM, kStates> gain =
        innovation.factor.template whiten<kStates>(innovation.hp);  // L⁻¹ H P
    const Mat<Scalar, kStates, kStates> posterior = belief.covariance - gain.transpose() * gain;
    belief.mean.noalias() += gain.transpose() * innovation.whitened;
    belief.covariance =
        cancels(belief.covariance, posterior)
            ? joseph<Sensor>(innovation.h, innovation.factor.template solve<kStates>(innovation.hp),
                             innovation.r)
            : posterior;
    return innovation.step;
  }

 private:
  /// All of an update but the correction.
  template <class Sensor>
  struct Innovation {
    static constexpr int kM = Sensor::kMeasurements;
    static constexpr int kReads = kReadsOf<Sensor>;
    static constexpr auto kRows = rows_read<Sensor>(kComponents);

    Step<kM, Scalar> step;
    Mat<Scalar, kM, kReads> h;
    Mat<Scalar, kM, kStates> hp;  ///< H P
    Mat<Scalar, kM, kM> r;
    Cholesky<kM, Scalar> factor;  ///< of S
    Vec<Scalar, kM> whitened;     ///< L⁻¹ v

    Innovation(const Ekf& filter, const Sensor& sensor, const Vec<Scalar, kM>& z) noexcept {
      check_sensor<Sensor, Ekf>();
      if (!filter.started_) return;
      const Gaussian<kStates, Scalar>& belief = filter.belief_;
      Vec<Scalar, kReads> read;
      for (int k = 0; k < kReads; ++k) read[k] = belief.mean[kRows[k]];
      const Gaussian<kM, Scalar> reading = sensor.observe(z);
      r = reading.covariance;
      h = sensor.jacobian(read);
      hp.noalias() = h.col(0) * belief.covariance.row(kRows[0]);
      for (int k = 1; k < kReads; ++k) hp.noalias() += h.col(k) * belief.covariance.row(kRows[k]);
      step.innovation = sensor.residual(reading.mean, sensor.measure(read));
      step.innovation_covariance = r;
      for (int k = 0; k < kReads; ++k)
        step.innovation_covariance.noalias() += hp.col(kRows[k]) * h.col(k).transpose();
      factor.compute(step.innovation_covariance);
      step.status = Status::kNotPositiveDefinite;
      if (!factor.ok()) return;
      whitened = factor.template whiten<1>(step.innovation);
      score(step, whitened, factor);
    }
  };

 private:
  Mat<Scalar, kStates, kStates> propagated(const Mat<Scalar, kStates, kStates>& f,
                                           const Mat<Scalar, kStates, kStates>& q) const noexcept {
    const Mat<Scalar, kStates, kStates> fp = f * this->belief_.covariance;
    Mat<Scalar, kStates, kStates> p = q;
    p.noalias() += fp * f.transpose();
    mirror_lower<Scalar, kStates>(p);
    return p;
  }

  /// True when the posterior variance is lost in the rounding of the prior one.
  static bool cancels(const Mat<Scalar, kStates, kStates>& prior,
                      const Mat<Scalar, kStates, kStates>& posterior) noexcept {
    constexpr Scalar kSafe = sizeof(Scalar) > 4 ? Scalar(1e-8) : Scalar(1e-3);
    return !(posterior.diagonal().array() > kSafe * prior.diagonal().array()).all();
  }

  /// (I - K H) P (I - K H)ᵀ + K R Kᵀ.
  template <class Sensor, int M, int Reads>
  Mat<Scalar, kStates, kStates> joseph(const Mat<Scalar, M, Reads>& h,
                                       const Mat<Scalar, M, kStates>& gain_transposed,
                                       const Mat<Scalar, M, M>& r) const noexcept {
    constexpr auto kRows = rows_read<Sensor>(kComponents);
    const Mat<Scalar, kStates, M> gain = gain_transposed.transpose();
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

/// The Kalman filter: an Ekf whose motion model and sensors are linear, so that nothing is approximated.
template <class MotionType, class ScalarType = double>
class Kalman : public Ekf<MotionType, ScalarType> {
  static_assert(!MotionModel<MotionType> || LinearMotionModel<MotionType>,
                "wakeline: Kalman needs a linear motion model (matrix(dt_s)); use Ekf or Ukf");

 public:
  using Scalar = ScalarType;

  explicit Kalman(const MotionType& motion) : Ekf<MotionType, ScalarType>(motion) {}

  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    static_assert(LinearMeasurementModel<Sensor>,
                  "wakeline: Kalman needs a linear sensor (kLinear = true); use ConvertedRangeBearing, or Ekf or Ukf");
    return Ekf<MotionType, ScalarType>::update(sensor, z);
  }
};

}  // namespace wakeline
