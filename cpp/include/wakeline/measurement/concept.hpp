// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <concepts>

#include "wakeline/core/component.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

template <class Sensor>
inline constexpr int kReadsOf = static_cast<int>(Sensor::kReads.size());

/// A sensor that tells how much it reads and reports.
template <class Sensor>
concept TellsSizes = requires {
  Sensor::kReads.size();
  Sensor::kMeasurements;
};

/// A sensor that reports z = h(x_r) + v, v ~ N(0, R), of those state components `kReads` that it
/// reads.
///
/// - `kReads`: a `std::array<Component, N>`; `kMeasurements`: M;
/// - `observe(z) -> Gaussian<M>`: the reading as value and covariance R, corrected and converted
/// where need be;
/// - `measure(x_r) -> Vec<M>`: h; `jacobian(x_r) -> Mat<M, N>`: dh/dx_r;
/// - `residual(a, b) -> Vec<M>`: a - b, angles wrapped;
/// all of them templated on the scalar.
template <class Sensor>
concept MeasurementModel = TellsSizes<Sensor> &&
    requires(const Sensor& sensor, const Vec<double, Sensor::kMeasurements>& z,
             const Vec<double, kReadsOf<Sensor>>& x) {
  { sensor.observe(z) } -> std::convertible_to<Gaussian<Sensor::kMeasurements>>;
  { sensor.measure(x) } -> SameSize<Vec<double, Sensor::kMeasurements>>;
  { sensor.jacobian(x) } -> SameSize<Mat<double, Sensor::kMeasurements, kReadsOf<Sensor>>>;
  { sensor.residual(z, z) } -> SameSize<Vec<double, Sensor::kMeasurements>>;
};

/// A sensor whose `measure` is linear and says so with `static constexpr bool kLinear = true`.
template <class Sensor>
concept LinearMeasurementModel = MeasurementModel<Sensor> && Sensor::kLinear;

/// True of a sensor whose `measure` gives what it reads, as it says with `static constexpr bool
/// kDirect = true`: its `jacobian` is the identity.
template <class Sensor>
inline constexpr bool kIsDirect = false;
template <class Sensor>
requires requires { requires Sensor::kDirect; }
inline constexpr bool kIsDirect<Sensor> = true;

/// A sensor that fixes a position: `position(z) -> Gaussian<2>`, north and east in metres.
template <class Sensor>
concept PositionSensor = MeasurementModel<Sensor> &&
    requires(const Sensor& sensor, const Vec<double, Sensor::kMeasurements>& z) {
  { sensor.position(z) } -> std::convertible_to<Gaussian<2>>;
};

}  // namespace wakeline
