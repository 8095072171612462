// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Sensors of own ship other than position (which is a `Fix`).
#pragma once

#include "wakeline/core/angle.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/measurement/concept.hpp"
#include "wakeline/navigation/usv_models.hpp"

namespace wakeline {

/// A sensor that measures M components directly, each with its standard deviation.
template <Component... Reads>
struct DirectSensor {
  static constexpr int kMeasurements = sizeof...(Reads);
  static constexpr std::array kReads{Reads...};
  static constexpr bool kLinear = true;

  template <class Scalar>
  Vec<Scalar, kMeasurements> measure(const Vec<Scalar, kMeasurements>& x) const noexcept {
    return x;
  }

  template <class Scalar>
  Mat<Scalar, kMeasurements, kMeasurements> jacobian(
      const Vec<Scalar, kMeasurements>&) const noexcept {
    return Mat<Scalar, kMeasurements, kMeasurements>::Identity();
  }

  template <class Scalar>
  Vec<Scalar, kMeasurements> residual(const Vec<Scalar, kMeasurements>& a,
                                      const Vec<Scalar, kMeasurements>& b) const noexcept {
    return a - b;
  }

 protected:
  /// z with covariance std² I.
  template <class Scalar>
  static Gaussian<kMeasurements, Scalar> equally(const Vec<Scalar, kMeasurements>& z,
                                                 double std) noexcept {
    return {z, Scalar(std * std) * Mat<Scalar, kMeasurements, kMeasurements>::Identity()};
  }
};

/// A compass: true heading (rad), whose innovation is wrapped (10), (11).
struct Compass : DirectSensor<kHeading> {
  static constexpr bool kLinear = false;  // a residual that wraps is not linear

  double heading_std_rad = deg(1.0);

  explicit Compass(double heading_std = deg(1.0)) noexcept : heading_std_rad(heading_std) {}

  template <class Scalar>
  Gaussian<1, Scalar> observe(const Vec<Scalar, 1>& z) const noexcept {
    return equally(z, heading_std_rad);
  }

  template <class Scalar>
  Vec<Scalar, 1> residual(const Vec<Scalar, 1>& a, const Vec<Scalar, 1>& b) const noexcept {
    return Vec<Scalar, 1>(wrap_angle(Scalar(a[0] - b[0])));
  }

  void validate() const { require_positive("heading_std_rad", heading_std_rad); }
};

/// The velocity over ground of a GNSS receiver `[north, east]` m/s, for states that hold it.
struct GroundVelocity : DirectSensor<Component::kVnorth, Component::kVeast> {
  double velocity_std_mps = 0.1;  ///< per axis

  explicit GroundVelocity(double velocity_std = 0.1) noexcept : velocity_std_mps(velocity_std) {}

  template <class Scalar>
  Gaussian<2, Scalar> observe(const Vec<Scalar, 2>& z) const noexcept {
    return equally(z, velocity_std_mps);
  }

  void validate() const { require_positive("velocity_std_mps", velocity_std_mps); }
};

/// The same for states with speed through the water and current: s [cos heading, sin heading] + c.
struct GroundVelocityInCurrent {
  static constexpr int kMeasurements = 2;
  static constexpr std::array kReads{kCurrentNorth, kCurrentEast, kSpeedThroughWater, kHeading};

  double velocity_std_mps = 0.1;  ///< per axis

  explicit GroundVelocityInCurrent(double velocity_std = 0.1) noexcept
      : velocity_std_mps(velocity_std) {}

  template <class Scalar>
  Gaussian<2, Scalar> observe(const Vec<Scalar, 2>& z) const noexcept {
    return {z, Scalar(velocity_std_mps * velocity_std_mps) * Mat<Scalar, 2, 2>::Identity()};
  }

  template <class Scalar>
  Vec<Scalar, 2> measure(const Vec<Scalar, 4>& x) const noexcept {
    return x.template head<2>() + x[2] * body_to_north_east(x[3]).col(0);
  }

  template <class Scalar>
  Mat<Scalar, 2, 4> jacobian(const Vec<Scalar, 4>& x) const noexcept {
    const Mat<Scalar, 2, 2> turn = body_to_north_east(x[3]);
    Mat<Scalar, 2, 4> h;
    h << Mat<Scalar, 2, 2>::Identity(), turn.col(0), x[2] * turn.col(1);
    return h;
  }

  template <class Scalar>
  Vec<Scalar, 2> residual(const Vec<Scalar, 2>& a, const Vec<Scalar, 2>& b) const noexcept {
    return a - b;
  }

  void validate() const { require_positive("velocity_std_mps", velocity_std_mps); }
};

/// A speed log: speed through the water, m/s.
struct SpeedLog : DirectSensor<kSpeedThroughWater> {
  double speed_std_mps = 0.1;

  explicit SpeedLog(double speed_std = 0.1) noexcept : speed_std_mps(speed_std) {}

  template <class Scalar>
  Gaussian<1, Scalar> observe(const Vec<Scalar, 1>& z) const noexcept {
    return equally(z, speed_std_mps);
  }

  void validate() const { require_positive("speed_std_mps", speed_std_mps); }
};

/// A rate-of-turn indicator beside the gyro that drives the steps: the gyro minus the indicator is
/// the gyro's bias, with the noise of both. The gyro's noise has also turned the heading: where
/// this reading drove the last step, a `UsvNavigator` corrects the heading accordingly.
struct RateOfTurn {
  static constexpr int kMeasurements = 1;
  static constexpr std::array kReads{kGyroBias};

  double rate_std_rad_s = deg(0.1);
  double gyro_rad_s = 0.0;  ///< the gyro's reading at the same time
  double gyro_std_rad_s = ImuNoise{}.yaw_rate_std_rad_s;

  template <class Scalar>
  Gaussian<1, Scalar> observe(const Vec<Scalar, 1>& z) const noexcept {
    const double variance = rate_std_rad_s * rate_std_rad_s + gyro_std_rad_s * gyro_std_rad_s;
    return {z, Mat<Scalar, 1, 1>(Scalar(variance))};
  }

  template <class Scalar>
  Vec<Scalar, 1> measure(const Vec<Scalar, 1>& bias) const noexcept {
    return Vec<Scalar, 1>(Scalar(gyro_rad_s) - bias[0]);
  }

  template <class Scalar>
  Mat<Scalar, 1, 1> jacobian(const Vec<Scalar, 1>&) const noexcept {
    return Mat<Scalar, 1, 1>(Scalar(-1));
  }

  template <class Scalar>
  Vec<Scalar, 1> residual(const Vec<Scalar, 1>& a, const Vec<Scalar, 1>& b) const noexcept {
    return a - b;
  }

  void validate() const {
    require_positive("rate_std_rad_s", rate_std_rad_s);
    require_finite("gyro_rad_s", gyro_rad_s);
    require_not_negative("gyro_std_rad_s", gyro_std_rad_s);
  }
};

/// A sensor of one number whose noise v is correlated with the belief: cov(x - x̂, v) = P y.
/// Equivalent to a sensor with the additional term y·(x - x̂) and independent noise of variance R -
/// yᵀ P y: its gain is (P Hᵀ + C) / S, S = H P Hᵀ + R + H C + Cᵀ Hᵀ, C = P y. Source: Bar-Shalom,
/// Li, Kirubarajan, chapter 8 (correlated noises).
template <class Sensor, auto Components>
struct ErringTogether {
  static constexpr int kStates = static_cast<int>(Components.size());
  static constexpr int kMeasurements = 1;
  static constexpr auto kReads = Components;

  Sensor sensor;
  Vec<double, kStates> believed;  ///< x̂
  Vec<double, kStates> weight;    ///< y
  double common_variance;         ///< yᵀ P y

  template <class Scalar>
  Gaussian<1, Scalar> observe(const Vec<Scalar, 1>& z) const noexcept {
    Gaussian<1, Scalar> reading = sensor.observe(z);
    reading.covariance(0, 0) -= Scalar(common_variance);
    return reading;
  }

  template <class Scalar>
  Vec<Scalar, 1> measure(const Vec<Scalar, kStates>& x) const noexcept {
    const Vec<Scalar, kStates> error = x - believed.template cast<Scalar>();
    return sensor.measure(read(x)) + Vec<Scalar, 1>(weight.template cast<Scalar>().dot(error));
  }

  template <class Scalar>
  Mat<Scalar, 1, kStates> jacobian(const Vec<Scalar, kStates>& x) const noexcept {
    Mat<Scalar, 1, kStates> h = weight.transpose().template cast<Scalar>();
    const Mat<Scalar, 1, kReadsOf<Sensor>> own = sensor.jacobian(read(x));
    for (int k = 0; k < kReadsOf<Sensor>; ++k) h[kRows[k]] += own[k];
    return h;
  }

  template <class Scalar>
  Vec<Scalar, 1> residual(const Vec<Scalar, 1>& a, const Vec<Scalar, 1>& b) const noexcept {
    return sensor.residual(a, b);
  }

 private:
  static constexpr auto kRows = rows_of(Components, Sensor::kReads);

  template <class Scalar>
  static Vec<Scalar, kReadsOf<Sensor>> read(const Vec<Scalar, kStates>& x) noexcept {
    Vec<Scalar, kReadsOf<Sensor>> rows;
    for (int k = 0; k < kReadsOf<Sensor>; ++k) rows[k] = x[kRows[k]];
    return rows;
  }
};

}  // namespace wakeline
