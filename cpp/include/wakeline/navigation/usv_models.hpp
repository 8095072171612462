// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Motion of own ship between two readings of its IMU. Headings are clockwise from north, body axes
// forward and starboard. Source: Evsyukov, Andreeva, Khanychev, "Sensor system information
// processing in unmanned navigation applications", equations (1)-(6).
#pragma once

#include <array>
#include <cmath>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/component.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Components of own ship's state in addition to position and velocity.
inline constexpr Component kHeading{static_cast<Component>(50)};            ///< rad
inline constexpr Component kForwardBias{static_cast<Component>(51)};        ///< m/s²
inline constexpr Component kStarboardBias{static_cast<Component>(52)};      ///< m/s²
inline constexpr Component kGyroBias{static_cast<Component>(53)};           ///< rad/s
inline constexpr Component kSpeedThroughWater{static_cast<Component>(54)};  ///< m/s
inline constexpr Component kCurrentNorth{static_cast<Component>(55)};       ///< m/s
inline constexpr Component kCurrentEast{static_cast<Component>(56)};        ///< m/s

/// One reading of an inertial measurement unit, gravity removed; held until the next one.
struct Imu {
  double forward_mps2 = 0.0;    ///< acceleration along the body
  double starboard_mps2 = 0.0;  ///< acceleration across it
  double yaw_rate_rad_s = 0.0;  ///< positive to starboard

  [[nodiscard]] bool finite() const noexcept {
    return std::isfinite(forward_mps2) && std::isfinite(starboard_mps2) &&
           std::isfinite(yaw_rate_rad_s);
  }
};

/// Standard deviations of one reading; its error is constant during a step.
struct ImuNoise {
  double acceleration_std_mps2 = 0.004;
  double yaw_rate_std_rad_s = deg(0.033);

  static constexpr auto fields() noexcept {
    using I = ImuNoise;
    return field_table(field("acceleration_std_mps2", &I::acceleration_std_mps2, kNotNegative,
                             "m/s²", "Standard deviation of a reading of an accelerometer."),
                       field("yaw_rate_std_rad_s", &I::yaw_rate_std_rad_s, kNotNegative, "rad/s",
                             "Standard deviation of a reading of the gyro."));
  }

  void validate() const { validate_fields(*this); }
};

/// Input of a step: a reading with its noise and biases or, without one, zero acceleration and turn
/// rate, which has noise but no bias (`bias_share` 0).
struct UsvInput {
  Imu imu;
  ImuNoise noise;
  double bias_share = 1.0;
  double gyro_share = 1.0;  ///< part of the gyro in the turn rate; the rest does not have its bias
};

/// Initial state of own ship, with standard deviations.
struct UsvStart {
  Vec<double, 2> position_m = Vec<double, 2>::Zero();    ///< [north, east]
  Vec<double, 2> velocity_mps = Vec<double, 2>::Zero();  ///< [north, east], over ground
  double heading_rad = 0.0;
  Vec<double, 2> position_std_m = Vec<double, 2>(8.0, 7.0);  ///< [north, east]
  double velocity_std_mps = 0.5;                             ///< per axis
  double heading_std_rad = deg(1.0);
};

/// Rotation by `heading_rad` from body axes to north and east (6).
template <class Scalar>
Mat<Scalar, 2, 2> body_to_north_east(Scalar heading_rad) noexcept {
  using std::cos;
  using std::sin;
  const Scalar c = cos(heading_rad), s = sin(heading_rad);
  Mat<Scalar, 2, 2> turn;
  turn << c, -s, s, c;
  return turn;
}

/// Own ship driven by acceleration and turn rate: state `[px, py, vx, vy, heading]`, with biases
/// `[..., forward bias, starboard bias, gyro bias]` appended.
///
///     w = w_imu - b_w,   a = R(heading + s T w) (a_imu - b),
///     p += T v + T²/2 a,   v += T a,   heading += T w.
///
/// The acceleration is constant over a step and rotated by the heading in its middle, s = 1/2. In
/// the paper, (1)-(6), it is the heading at the start, s = 0, which in a steady turn has a
/// systematic error of half of each step's turn.
template <bool Biases>
struct UsvInertialMotion {
  static constexpr int kN = Biases ? 8 : 5;
  static constexpr int kInputs = 3;  ///< readings that drive it
  static constexpr auto kComponents = [] {
    if constexpr (Biases)
      return std::array{Component::kNorth, Component::kEast, Component::kVnorth, Component::kVeast,
                        kHeading,          kForwardBias,     kStarboardBias,     kGyroBias};
    else
      return std::array{Component::kNorth, Component::kEast, Component::kVnorth, Component::kVeast,
                        kHeading};
  }();

  double acceleration_bias_std_mps2 = 0.05;
  double gyro_bias_std_rad_s = deg(0.5);
  double acceleration_bias_walk_mps2 = 1e-6;
  double gyro_bias_walk_rad_s = 1e-6;
  double turned_at = 0.5;

  static constexpr auto fields() noexcept {
    using M = UsvInertialMotion;
    return field_table(
        field("acceleration_bias_std_mps2", &M::acceleration_bias_std_mps2, kPositive, "m/s²",
              "Standard deviation of the biases of the accelerometers at the start."),
        field("gyro_bias_std_rad_s", &M::gyro_bias_std_rad_s, kPositive, "rad/s",
              "Standard deviation of the bias of the gyro at the start."),
        field("acceleration_bias_walk_mps2", &M::acceleration_bias_walk_mps2, kNotNegative, "m/s²",
              "Standard deviation of what a bias of the accelerometers gains in 1 s."),
        field("gyro_bias_walk_rad_s", &M::gyro_bias_walk_rad_s, kNotNegative, "rad/s",
              "Standard deviation of what the bias of the gyro gains in 1 s."),
        field("turned_at", &M::turned_at, between(0, 1), "1",
              "Where in a step the heading is taken that turns its acceleration: 0.5 is the "
              "middle, 0 the start."));
  }
  UsvInput input{};  ///< of the present step

  /// f(x, dt).
  template <class Scalar>
  Vec<Scalar, kN> transition(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    const Vec<Scalar, 2> a = body_axes(x, dt_s) * body_acceleration(x);
    Vec<Scalar, kN> moved = x;
    moved.template segment<2>(0) += dt_s * x.template segment<2>(2) + dt_s * dt_s / 2 * a;
    moved.template segment<2>(2) += dt_s * a;
    moved[4] += dt_s * turn_rate(x);
    return moved;
  }

  /// df/dx.
  template <class Scalar>
  Mat<Scalar, kN, kN> jacobian(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    const Mat<Scalar, 2, 2> axes = body_axes(x, dt_s);
    Mat<Scalar, kN, kN> f = Mat<Scalar, kN, kN>::Identity();
    f(0, 2) = f(1, 3) = dt_s;
    f.template block<4, 1>(0, 4) = by_heading(x, dt_s);
    if constexpr (Biases) {
      const Scalar share = Scalar(input.bias_share);
      f.template block<2, 2>(0, 5) = -share * dt_s * dt_s / 2 * axes;
      f.template block<2, 2>(2, 5) = -share * dt_s * axes;
      f.template block<5, 1>(0, 7) = -share * Scalar(input.gyro_share) * by_yaw_rate(x, dt_s);
    }
    return f;
  }

  /// Q: the error of the IMU, constant over the step, and the random walk of the biases.
  template <class Scalar>
  Mat<Scalar, kN, kN> process_noise(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    const Scalar a_std = Scalar(input.noise.acceleration_std_mps2);
    const Scalar w_std = Scalar(input.noise.yaw_rate_std_rad_s);
    const Vec<Scalar, 2> g = a_std * Vec<Scalar, 2>(dt_s * dt_s / 2, dt_s);
    Mat<Scalar, kN, kN> q = walk_noise(x, dt_s);
    for (const int axis : {0, 1}) {
      q(axis, axis) = g[0] * g[0];
      q(axis, axis + 2) = q(axis + 2, axis) = g[0] * g[1];
      q(axis + 2, axis + 2) = g[1] * g[1];
    }
    const Vec<Scalar, 5> by_gyro = w_std * by_yaw_rate(x, dt_s);
    q.template topLeftCorner<5, 5>() += by_gyro * by_gyro.transpose();
    return q;
  }

  /// The random walk of the biases only.
  template <class Scalar>
  Mat<Scalar, kN, kN> walk_noise(const Vec<Scalar, kN>&, Scalar dt_s) const noexcept {
    Mat<Scalar, kN, kN> q = Mat<Scalar, kN, kN>::Zero();
    if constexpr (Biases) {
      const Scalar a_walk = Scalar(acceleration_bias_walk_mps2);
      const Scalar w_walk = Scalar(gyro_bias_walk_rad_s);
      q(5, 5) = q(6, 6) = dt_s * a_walk * a_walk;
      q(7, 7) = dt_s * w_walk * w_walk;
    }
    return q;
  }

  /// Standard deviations of the IMU's errors: [forward, starboard (m/s²), yaw rate (rad/s)].
  [[nodiscard]] Vec<double, kInputs> input_std() const noexcept {
    const double a_std = input.noise.acceleration_std_mps2;
    return {a_std, a_std, input.noise.yaw_rate_std_rad_s};
  }

  /// The same motion with these errors added to the IMU's readings.
  [[nodiscard]] UsvInertialMotion disturbed(const Vec<double, kInputs>& error) const noexcept {
    UsvInertialMotion motion = *this;
    motion.input.imu.forward_mps2 += error[0];
    motion.input.imu.starboard_mps2 += error[1];
    motion.input.imu.yaw_rate_rad_s += error[2];
    return motion;
  }

  template <class Scalar>
  [[nodiscard]] Gaussian<kN, Scalar> start_belief(const UsvStart& start) const noexcept {
    Gaussian<kN> belief;
    Vec<double, kN> std;
    belief.mean.template head<5>() << start.position_m, start.velocity_mps, start.heading_rad;
    std.template head<5>() << start.position_std_m, start.velocity_std_mps, start.velocity_std_mps,
        start.heading_std_rad;
    if constexpr (Biases)
      std.template tail<3>() << acceleration_bias_std_mps2, acceleration_bias_std_mps2,
          gyro_bias_std_rad_s;
    belief.covariance = std.cwiseAbs2().asDiagonal();
    return belief.template cast<Scalar>();
  }

  void validate() const {
    validate_fields(*this);
    input.noise.validate();
  }

 private:
  /// R of the heading that rotates the acceleration.
  template <class Scalar>
  [[nodiscard]] Mat<Scalar, 2, 2> body_axes(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    return body_to_north_east(Scalar(x[4] + Scalar(turned_at) * dt_s * turn_rate(x)));
  }

  /// Derivatives of position and velocity by that heading.
  template <class Scalar>
  [[nodiscard]] Vec<Scalar, 4> by_heading(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    const Vec<Scalar, 2> a = body_axes(x, dt_s) * body_acceleration(x), across(-a[1], a[0]);
    Vec<Scalar, 4> gain;
    gain << dt_s * dt_s / 2 * across, dt_s * across;
    return gain;
  }

  /// Derivatives of position, velocity and heading by the turn rate.
  template <class Scalar>
  [[nodiscard]] Vec<Scalar, 5> by_yaw_rate(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    Vec<Scalar, 5> gain;
    gain << Scalar(turned_at) * dt_s * by_heading(x, dt_s), dt_s;
    return gain;
  }

  template <class Scalar>
  [[nodiscard]] Vec<Scalar, 2> body_acceleration(const Vec<Scalar, kN>& x) const noexcept {
    Vec<Scalar, 2> a(Scalar(input.imu.forward_mps2), Scalar(input.imu.starboard_mps2));
    if constexpr (Biases) a -= Scalar(input.bias_share) * x.template segment<2>(5);
    return a;
  }

  template <class Scalar>
  [[nodiscard]] Scalar turn_rate(const Vec<Scalar, kN>& x) const noexcept {
    Scalar rate = Scalar(input.imu.yaw_rate_rad_s);
    if constexpr (Biases) rate -= Scalar(input.bias_share * input.gyro_share) * x[7];
    return rate;
  }
};

/// The paper's five states, for an IMU with known and removed biases.
using UsvMotion = UsvInertialMotion<false>;

/// Eight states: the IMU's three biases are estimated.
using UsvBiasMotion = UsvInertialMotion<true>;

/// Own ship by its speed through the water in a current, turned by the gyro: state `[px, py,
/// heading, speed, gyro bias, current north, current east]`. The accelerometer is not used.
///
///     p += T (s [cos, sin](heading + T w / 2) + c),   heading += T w,   w = w_imu - b_w.
///
/// Speed, current and bias are random walks. More accurate than the inertial model while the speed
/// is nearly constant, less while it changes.
struct UsvCurrentMotion {
  static constexpr int kN = 7;
  static constexpr int kInputs = 1;  ///< readings that drive it
  static constexpr std::array kComponents{Component::kNorth,  Component::kEast, kHeading,
                                          kSpeedThroughWater, kGyroBias,        kCurrentNorth,
                                          kCurrentEast};

  double gyro_bias_std_rad_s = deg(0.5);
  double current_std_mps = 0.5;
  double speed_walk_mps = 0.03;
  double current_walk_mps = 0.002;
  double gyro_bias_walk_rad_s = 1e-6;

  static constexpr auto fields() noexcept {
    using M = UsvCurrentMotion;
    return field_table(
        field("gyro_bias_std_rad_s", &M::gyro_bias_std_rad_s, kPositive, "rad/s",
              "Standard deviation of the bias of the gyro at the start."),
        field("current_std_mps", &M::current_std_mps, kPositive, "m/s",
              "Standard deviation of the current at the start, per axis."),
        field("speed_walk_mps", &M::speed_walk_mps, kNotNegative, "m/s",
              "Standard deviation of what the speed through water gains in 1 s."),
        field("current_walk_mps", &M::current_walk_mps, kNotNegative, "m/s",
              "Standard deviation of what the current gains in 1 s, per axis."),
        field("gyro_bias_walk_rad_s", &M::gyro_bias_walk_rad_s, kNotNegative, "rad/s",
              "Standard deviation of what the bias of the gyro gains in 1 s."));
  }
  UsvInput input{};  ///< of the present step

  /// f(x, dt).
  template <class Scalar>
  Vec<Scalar, kN> transition(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    Vec<Scalar, kN> moved = x;
    moved.template head<2>() += dt_s * (x[3] * ahead(x, dt_s) + x.template tail<2>());
    moved[2] += dt_s * turn_rate(x);
    return moved;
  }

  /// df/dx.
  template <class Scalar>
  Mat<Scalar, kN, kN> jacobian(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    const Vec<Scalar, 2> u = ahead(x, dt_s);
    const Vec<Scalar, 2> p_by_heading = dt_s * x[3] * Vec<Scalar, 2>(-u[1], u[0]);
    const Scalar share = Scalar(input.bias_share * input.gyro_share);
    Mat<Scalar, kN, kN> f = Mat<Scalar, kN, kN>::Identity();
    f.template block<2, 1>(0, 2) = p_by_heading;
    f.template block<2, 1>(0, 3) = dt_s * u;
    f.template block<2, 1>(0, 4) = -share * dt_s / 2 * p_by_heading;
    f(0, 5) = f(1, 6) = dt_s;
    f(2, 4) = -share * dt_s;
    return f;
  }

  /// Q: the error of the gyro, constant over the step, which rotates heading and path, and the
  /// random walks.
  template <class Scalar>
  Mat<Scalar, kN, kN> process_noise(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    const Scalar turned = dt_s * Scalar(input.noise.yaw_rate_std_rad_s);
    const Vec<Scalar, 2> u = ahead(x, dt_s);
    const Vec<Scalar, 3> by_gyro =
        turned * Vec<Scalar, 3>(-dt_s / 2 * x[3] * u[1], dt_s / 2 * x[3] * u[0], Scalar(1));
    Mat<Scalar, kN, kN> q = walk_noise(x, dt_s);
    q.template topLeftCorner<3, 3>() += by_gyro * by_gyro.transpose();
    return q;
  }

  /// The random walks of speed, current and bias only, with their effect on the position.
  template <class Scalar>
  Mat<Scalar, kN, kN> walk_noise(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    const Scalar s = Scalar(speed_walk_mps * speed_walk_mps);
    const Scalar c = Scalar(current_walk_mps * current_walk_mps);
    const Scalar b = Scalar(gyro_bias_walk_rad_s * gyro_bias_walk_rad_s);
    const Scalar squared = dt_s * dt_s / 2, cubed = dt_s * dt_s * dt_s / 3;
    const Vec<Scalar, 2> u = ahead(x, dt_s);
    Mat<Scalar, kN, kN> q = Mat<Scalar, kN, kN>::Zero();
    q.template topLeftCorner<2, 2>() =
        cubed * (s * u * u.transpose() + c * Mat<Scalar, 2, 2>::Identity());
    q.template block<2, 1>(0, 3) = squared * s * u;
    q.template block<1, 2>(3, 0) = squared * s * u.transpose();
    for (const int axis : {0, 1}) {
      q(axis, axis + 5) = q(axis + 5, axis) = squared * c;
      q(axis + 5, axis + 5) = dt_s * c;
    }
    q(3, 3) = dt_s * s;
    q(4, 4) = dt_s * b;
    return q;
  }

  /// Standard deviation of the gyro's error, rad/s.
  [[nodiscard]] Vec<double, kInputs> input_std() const noexcept {
    return Vec<double, kInputs>(input.noise.yaw_rate_std_rad_s);
  }

  /// The same motion with this error added to the gyro's reading.
  [[nodiscard]] UsvCurrentMotion disturbed(const Vec<double, kInputs>& error) const noexcept {
    UsvCurrentMotion motion = *this;
    motion.input.imu.yaw_rate_rad_s += error[0];
    return motion;
  }

  /// Velocity through the water.
  template <class Scalar>
  static Vec<Scalar, 2> way_mps(const Vec<Scalar, kN>& x) noexcept {
    return x[3] * body_to_north_east(x[2]).col(0);
  }

  /// The current that remains of the velocity over ground of one state with the heading and the
  /// speed through the water of another.
  template <class Scalar>
  static Vec<Scalar, 2> current_left(const Vec<Scalar, kN>& over_ground,
                                     const Vec<Scalar, kN>& through_water) noexcept {
    return over_ground.template tail<2>() + way_mps(over_ground) - way_mps(through_water);
  }

  /// The speed is the start's velocity along its heading; the current starts at zero.
  template <class Scalar>
  [[nodiscard]] Gaussian<kN, Scalar> start_belief(const UsvStart& start) const noexcept {
    const double speed_mps = body_to_north_east(start.heading_rad).col(0).dot(start.velocity_mps);
    Gaussian<kN> belief;
    Vec<double, kN> std;
    belief.mean.template head<4>() << start.position_m, start.heading_rad, speed_mps;
    std << start.position_std_m, start.heading_std_rad, start.velocity_std_mps, gyro_bias_std_rad_s,
        current_std_mps, current_std_mps;
    belief.covariance = std.cwiseAbs2().asDiagonal();
    return belief.template cast<Scalar>();
  }

  void validate() const {
    validate_fields(*this);
    input.noise.validate();
  }

 private:
  template <class Scalar>
  [[nodiscard]] Scalar turn_rate(const Vec<Scalar, kN>& x) const noexcept {
    return Scalar(input.imu.yaw_rate_rad_s) - Scalar(input.bias_share * input.gyro_share) * x[4];
  }

  /// Unit vector of the heading in the middle of the step.
  template <class Scalar>
  [[nodiscard]] Vec<Scalar, 2> ahead(const Vec<Scalar, kN>& x, Scalar dt_s) const noexcept {
    return body_to_north_east(Scalar(x[2] + dt_s / 2 * turn_rate(x))).col(0);
  }
};

}  // namespace wakeline
