// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/filter/unscented.hpp"

namespace wakeline {

/// The unscented Kalman filter. Sigma points are drawn anew for the update, from the predicted
/// belief. Covariances are updated as P - K S Kᵀ, and from the points themselves where a prior so
/// much wider than the plot would make that difference cancel. Source: S. J. Julier, J. K. Uhlmann,
/// Proc. IEEE 92, 2004; parameters as in `Unscented`.
template <class MotionType, class ScalarType = double>
class Ukf : public Belief<MotionType, ScalarType> {
  using Base = Belief<MotionType, ScalarType>;

 public:
  using Base::kComponents;
  using Base::kStates;
  using typename Base::Motion;
  using typename Base::Scalar;
  static constexpr int kPoints = 2 * kStates;

  explicit Ukf(const MotionType& motion, const Unscented& unscented = {})
      : Base(motion), unscented_(unscented) {
    unscented.validate(kStates);
  }

  [[nodiscard]] const Unscented& unscented() const noexcept { return unscented_; }

  /// The moments of the moved sigma points, and Q.
  Status predict(Scalar dt_s) noexcept {
    if (!this->started_) return Status::kNotStarted;
    if (const Status status = check_time_step(dt_s); status != Status::kOk) return status;
    const Cholesky<kStates, Scalar> root(this->belief_.covariance);
    if (!root.ok()) return Status::kNotPositiveDefinite;
    const Vec<Scalar, kStates>& x = this->belief_.mean;
    const MovedPoints<Scalar, kStates> moved(this->motion_, dt_s, x, points(root));
    Gaussian<kStates, Scalar> next =
        unscented_moments(unscented_, kStates, moved.centre, moved.differences);
    next.covariance += process_noise(this->motion_, x, dt_s);
    mirror_lower<Scalar, kStates>(next.covariance);
    if (const Status status = check(next); status != Status::kOk) return status;
    this->belief_ = next;
    return Status::kOk;
  }

  /// The same under a known acceleration, [north, east]; see `Control`.
  Status predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return Control::predict(*this, dt_s, acceleration_mps2);
  }

  /// The innovation of a reading and its likelihood, without taking it.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> innovation(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    return Ukf(*this).update(sensor, z);
  }

  /// Corrects the belief by the reading z of a sensor.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(const Sensor& sensor,
                                             const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    check_sensor<Sensor, Ukf>();
    constexpr int kM = Sensor::kMeasurements;
    if (!this->started_) return failed_step<kM, Scalar>(Status::kNotStarted);
    const Cholesky<kStates, Scalar> root(this->belief_.covariance);
    if (!root.ok()) return failed_step<kM, Scalar>(Status::kNotPositiveDefinite);

    const Gaussian<kM, Scalar> reading = sensor.observe(z);
    const Mat<Scalar, kStates, kPoints> sigma = points(root);
    const MeasuredPoints<Scalar, kM, kPoints> images(sensor, kComponents, this->belief_.mean,
                                                     sigma);
    Gaussian<kM, Scalar> predicted =
        unscented_moments(unscented_, kStates, images.centre, images.differences);

    Step<kM, Scalar> step;
    step.innovation = sensor.residual(reading.mean, predicted.mean);
    step.innovation_covariance = predicted.covariance + reading.covariance;
    const Cholesky<kM, Scalar> factor(step.innovation_covariance);
    if (!factor.ok())
      return failed_step<kM, Scalar>(refusal<Scalar, kM>(step.innovation_covariance));
    const Vec<Scalar, kM> whitened = factor.template whiten<1>(step.innovation);
    score(step, whitened, factor);
    if (!step) return step;

    const Mat<Scalar, kStates, kPoints> spread = sigma.colwise() - this->belief_.mean;
    const Mat<Scalar, kM, kStates> cross =
        unscented_.template weight<Scalar>(kStates) * images.differences * spread.transpose();
    const Mat<Scalar, kM, kStates> gain = factor.template whiten<kStates>(cross);
    Gaussian<kStates, Scalar> next = this->belief_;
    next.mean.noalias() += gain.transpose() * whitened;
    next.covariance.noalias() -= gain.transpose() * gain;
    if (cancels<Scalar, kStates>(this->belief_.covariance, next.covariance))
      next.covariance = joseph(spread, images.differences, factor.template solve<kStates>(cross),
                               reading.covariance);
    if (!Cholesky<kStates, Scalar>(next.covariance).ok())
      return failed_step<kM, Scalar>(Status::kNotPositiveDefinite);
    this->belief_ = next;
    return step;
  }

 private:
  /// P - K S Kᵀ as what the points keep of their spread, Σ w (e_x - K e_z)(e_x - K e_z)ᵀ, with K of
  /// the rest of S.
  template <int M>
  Mat<Scalar, kStates, kStates> joseph(const Mat<Scalar, kStates, kPoints>& spread,
                                       const Mat<Scalar, M, kPoints>& differences,
                                       const Mat<Scalar, M, kStates>& gain_transposed,
                                       const Mat<Scalar, M, M>& r) const noexcept {
    const Scalar w = unscented_.template weight<Scalar>(kStates);
    const Vec<Scalar, M> shift = w * differences.rowwise().sum();
    const Mat<Scalar, kStates, kPoints> kept = spread - gain_transposed.transpose() * differences;
    const Mat<Scalar, M, M> rest =
        r + unscented_.template centre_correction<Scalar>() * shift * shift.transpose();
    Mat<Scalar, kStates, kStates> p =
        w * kept * kept.transpose() + gain_transposed.transpose() * rest * gain_transposed;
    mirror_lower<Scalar, kStates>(p);
    return p;
  }

  Mat<Scalar, kStates, kPoints> points(const Cholesky<kStates, Scalar>& root) const noexcept {
    return sigma_points<Scalar, kStates>(this->belief_.mean, root.lower(),
                                         unscented_.template spread<Scalar>(kStates));
  }

  Unscented unscented_;
};

}  // namespace wakeline
