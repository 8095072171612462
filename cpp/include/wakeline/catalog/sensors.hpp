// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>
#include <variant>

#include "wakeline/catalog/type_list.hpp"
#include "wakeline/measurement/bearing.hpp"
#include "wakeline/measurement/concept.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"

namespace wakeline {

/// The sensors that can be chosen at run time. A new one is its header and a line here.
using Sensors = TypeList<RangeBearing, ConvertedRangeBearing, Position, RangeBearingDoppler>;

/// One of them.
using AnySensor = AsVariant<Sensors>;

/// The sensors that measure a part of a position, each one number; see `RuntimeSensor`.
using PartSensors = TypeList<Bearing, Range>;

/// What a filter corrects by for a sensor: of a direct one only the reading matters, unless its
/// errors are those at the prediction, so that a converted plot serves all direct ones.
template <class Sensor>
decltype(auto) model_of(const Sensor& sensor) noexcept {
  if constexpr (kIsDirect<Sensor> && !SensorAtPrediction<Sensor>)
    return ConvertedRangeBearing{.unbiased = false};
  else
    return (sensor);
}

/// One of the sensors that report M numbers, chosen at run time. It observes as that sensor does;
/// what a filter corrects by is the model that `visit_model` gives, which is a converted plot for
/// all direct sensors: of others than that only the reading matters.
template <int M>
class AnySensorOf {
  template <class Sensor>
  struct Reports : std::bool_constant<Sensor::kMeasurements == M> {};

 public:
  static constexpr int kMeasurements = M;
  using Variant = AsVariant<Selected<Reports, Sensors>>;

  template <class Sensor>
  requires(Sensor::kMeasurements == M)
      // NOLINTNEXTLINE(google-explicit-constructor): each of them is one.
      AnySensorOf(const Sensor& sensor)
      : sensor_(sensor) {}

  template <class Scalar>
  Gaussian<M, Scalar> observe(const Vec<Scalar, M>& z) const noexcept {
    return std::visit([&](const auto& sensor) -> Gaussian<M, Scalar> { return sensor.observe(z); },
                      sensor_);
  }

  template <class Scalar>
  Gaussian<2, Scalar> position(const Vec<Scalar, M>& z) const noexcept {
    return std::visit([&](const auto& sensor) -> Gaussian<2, Scalar> { return sensor.position(z); },
                      sensor_);
  }

  template <class Scalar>
  Gaussian<2, Scalar> start_position(const Vec<Scalar, M>& z) const noexcept {
    return std::visit(
        [&](const auto& sensor) -> Gaussian<2, Scalar> {
          return wakeline::start_position(sensor, z);
        },
        sensor_);
  }

  template <class Function>
  decltype(auto) visit_model(Function&& function) const noexcept {
    return std::visit(
        [&]<class Sensor>(const Sensor& sensor) { return function(model_of(sensor)); }, sensor_);
  }

  /// Own ship that carries it, null of a sensor without one.
  [[nodiscard]] OwnShip* own_ship() noexcept {
    return std::visit([](auto& sensor) { return own_ship_of(sensor); }, sensor_);
  }
  [[nodiscard]] const OwnShip* own_ship() const noexcept {
    return std::visit([](const auto& sensor) { return own_ship_of(sensor); }, sensor_);
  }

  [[nodiscard]] const Variant& variant() const noexcept { return sensor_; }

 private:
  Variant sensor_;
};

}  // namespace wakeline
