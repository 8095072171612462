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

/// A sensor that declares the sizes of what it reads and reports.
template <class Sensor>
concept DeclaresSizes = requires {
  Sensor::kReads.size();
  Sensor::kMeasurements;
};

/// A measurement model: z = h(x_r) + v, v ~ N(0, R), of the state components `kReads`.
///
/// - `kReads`: a `std::array<Component, N>`; `kMeasurements`: M;
/// - `observe(z) -> Gaussian<M>`: the reading and its covariance R, corrected and converted where
///   needed;
/// - `measure(x_r) -> Vec<M>`: h; `jacobian(x_r) -> Mat<M, N>`: dh/dx_r;
/// - `residual(a, b) -> Vec<M>`: a - b, angles wrapped.
///
/// All functions are templated on the scalar.
template <class Sensor>
concept MeasurementModel = DeclaresSizes<Sensor> &&
    requires(const Sensor& sensor, const Vec<double, Sensor::kMeasurements>& z,
             const Vec<double, kReadsOf<Sensor>>& x) {
  { sensor.observe(z) } -> std::convertible_to<Gaussian<Sensor::kMeasurements>>;
  { sensor.measure(x) } -> SameSize<Vec<double, Sensor::kMeasurements>>;
  { sensor.jacobian(x) } -> SameSize<Mat<double, Sensor::kMeasurements, kReadsOf<Sensor>>>;
  { sensor.residual(z, z) } -> SameSize<Vec<double, Sensor::kMeasurements>>;
};

/// A sensor that declares its `measure` linear with `static constexpr bool kLinear = true`.
template <class Sensor>
concept LinearMeasurementModel = MeasurementModel<Sensor> && Sensor::kLinear;

/// A sensor whose h may bend so much within a belief that the derivatives at its mean are useless,
/// as those of range and bearing do about the antenna:
///
/// - `bends(belief, r)`: where it does, for a belief over x_r and a reading of this covariance;
/// - `moved_to(x_r, z)`: the components x_r with those that the reading z determines.
///
/// There an `Ekf` takes h and its derivatives at the second.
template <class Sensor>
concept BendingSensor = requires(const Sensor& sensor, const Vec<double, Sensor::kMeasurements>& z,
                                 const Vec<double, kReadsOf<Sensor>>& x) {
  {
    sensor.bends(Gaussian<kReadsOf<Sensor>>{x, {}},
                 Mat<double, Sensor::kMeasurements, Sensor::kMeasurements>{})
    } -> std::convertible_to<bool>;
  { sensor.moved_to(x, z) } -> SameSize<Vec<double, kReadsOf<Sensor>>>;
};

/// A sensor whose errors depend on where its target is, as those of a converted plot do:
/// `at_prediction(reading, x_r) -> Gaussian<M>` is an observed reading beside the prediction of the
/// components it reads, mean and covariance. Filters correct by that.
template <class Sensor>
concept SensorAtPrediction = requires(const Sensor& sensor,
                                      const Gaussian<Sensor::kMeasurements>& reading,
                                      const Gaussian<kReadsOf<Sensor>>& x) {
  { sensor.at_prediction(reading, x) } -> std::convertible_to<Gaussian<Sensor::kMeasurements>>;
};

/// True for a sensor that declares with `static constexpr bool kDirect = true` that `measure`
/// returns the components it reads: its `jacobian` is the identity.
template <class Sensor>
inline constexpr bool kIsDirect = false;
template <class Sensor>
requires requires { requires Sensor::kDirect; }
inline constexpr bool kIsDirect<Sensor> = true;

/// A sensor that measures a position: `position(z) -> Gaussian<2>`, north and east in metres.
template <class Sensor>
concept PositionSensor = requires(const Sensor& sensor,
                                  const Vec<double, Sensor::kMeasurements>& z) {
  { sensor.position(z) } -> std::convertible_to<Gaussian<2>>;
};

/// The position from which a reading starts an estimate: `start_position(z)` of a sensor that has
/// it, else `position(z)`. They differ where lines of sight are bent: a converted plot is right on
/// average for one target, a start for all targets that give the plot.
template <PositionSensor Sensor, class Scalar>
Gaussian<2, Scalar> start_position(const Sensor& sensor,
                                   const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
  if constexpr (requires { sensor.start_position(z); })
    return sensor.start_position(z);
  else
    return sensor.position(z);
}

/// A sensor chosen at run time, whose measurement model `visit_model` gives.
template <class Sensor>
concept SensorVariant = requires(const Sensor& sensor) {
  sensor.variant();
};

/// Calls `function` with the measurement model of a sensor: the sensor itself, or what one that is
/// chosen at run time is.
template <class Sensor, class Function>
[[gnu::always_inline]] inline decltype(auto) with_model(const Sensor& sensor,
                                                        Function&& function) noexcept {
  if constexpr (SensorVariant<Sensor>)
    return sensor.visit_model(function);
  else
    return function(sensor);
}

}  // namespace wakeline
