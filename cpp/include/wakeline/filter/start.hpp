// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "wakeline/measurement/concept.hpp"
#include "wakeline/measurement/own_ship.hpp"
#include "wakeline/motion/concept.hpp"

namespace wakeline {

/// Belief over `[x, vx, y, vy]` from a position and a velocity with their cross-covariance.
template <class Scalar>
Gaussian<4, Scalar> kinematics_from(const Gaussian<2, Scalar>& position,
                                    const Gaussian<2, Scalar>& velocity,
                                    const Mat<Scalar, 2, 2>& position_velocity) noexcept {
  Gaussian<4, Scalar> belief;
  for (int i = 0; i < 2; ++i) {
    belief.mean[2 * i] = position.mean[i];
    belief.mean[2 * i + 1] = velocity.mean[i];
    for (int j = 0; j < 2; ++j) {
      belief.covariance(2 * i, 2 * j) = position.covariance(i, j);
      belief.covariance(2 * i + 1, 2 * j + 1) = velocity.covariance(i, j);
      belief.covariance(2 * i, 2 * j + 1) = position_velocity(i, j);
      belief.covariance(2 * j + 1, 2 * i) = position_velocity(i, j);
    }
  }
  return belief;
}

/// One-point start: the position of a plot, and zero velocity with standard deviation
/// `speed_std_mps` per axis.
template <PositionSensor Sensor, class Scalar>
Gaussian<4, Scalar> one_point(const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z,
                              std::type_identity_t<Scalar> speed_std_mps) noexcept {
  const Gaussian<2, Scalar> velocity{Vec<Scalar, 2>::Zero(),
                                     speed_std_mps * speed_std_mps * Mat<Scalar, 2, 2>::Identity()};
  return kinematics_from<Scalar>(start_position(sensor, z), velocity, Mat<Scalar, 2, 2>::Zero());
}

/// Two-point start from two positions dt apart: the second one and their difference over dt, with
/// covariance `[R2, R2/dt; R2/dt, (R1 + R2)/dt²]`. Source: Bar-Shalom, Li, Kirubarajan, 5.5.3.
template <class Scalar>
Gaussian<4, Scalar> two_point(const Gaussian<2, Scalar>& first, const Gaussian<2, Scalar>& second,
                              std::type_identity_t<Scalar> dt_s) noexcept {
  const Gaussian<2, Scalar> velocity{(second.mean - first.mean) / dt_s,
                                     (first.covariance + second.covariance) / (dt_s * dt_s)};
  return kinematics_from<Scalar>(second, velocity, second.covariance / dt_s);
}

/// Two-point start from two plots of one sensor. `sensor.own` is own ship at the second plot; its
/// position at the first one follows from its velocity.
template <PositionSensor Sensor, class Scalar>
Gaussian<4, Scalar> two_point(const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& first,
                              const Vec<Scalar, Sensor::kMeasurements>& second,
                              std::type_identity_t<Scalar> dt_s) noexcept {
  Gaussian<2, Scalar> before = start_position(sensor, first);
  if (const OwnShip* own = own_ship_of(sensor))
    before.mean -= dt_s * own->template velocity<Scalar>();
  return two_point<Scalar>(before, start_position(sensor, second), dt_s);
}

/// Extends a belief over `[x, vx, y, vy]` to the state of `motion`: the other components start with
/// the model's prior mean and variance.
template <MotionModel Motion, class Scalar>
Gaussian<kStatesOf<Motion>, Scalar> lift(const Motion& motion,
                                         const Gaussian<4, Scalar>& kinematics) noexcept {
  constexpr int kStates = kStatesOf<Motion>;
  Gaussian<kStates, Scalar> belief{Vec<Scalar, kStates>::Zero(),
                                   Mat<Scalar, kStates, kStates>::Zero()};
  int row = 0;
  for (const Component component : Motion::kComponents) {
    if (index_of(kKinematics, component) < 0) {
      belief.mean[row] = Scalar(prior_mean(motion, component));
      belief.covariance(row, row) = Scalar(prior_variance(motion, component));
    }
    ++row;
  }
  constexpr auto kRows = rows_of(Motion::kComponents, kKinematics);
  for (int i = 0; i < 4; ++i) {
    belief.mean[kRows[i]] = kinematics.mean[i];
    for (int j = 0; j < 4; ++j) belief.covariance(kRows[i], kRows[j]) = kinematics.covariance(i, j);
  }
  return belief;
}

}  // namespace wakeline
