// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the bindings of filters, multi-model estimators and trackers share.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "any_filter.hpp"
#include "support/types.hpp"

namespace wakeline::python {

/// Filters from a sequence of them.
inline std::vector<AnyFilter> to_filters(const py::sequence& sequence) {
  std::vector<AnyFilter> filters;
  for (py::handle item : sequence) {
    if (!py::isinstance<AnyFilter>(item))
      throw py::type_error("filters must be Kalman, Ekf, Ukf or SquareRootUkf, got " +
                           py::str(py::type::of(item).attr("__name__")).cast<std::string>());
    filters.push_back(item.cast<const AnyFilter&>());
  }
  return filters;
}

inline PyGaussian to_gaussian(const AnyBelief& belief) { return {belief.mean, belief.covariance}; }

/// As a belief over the state layout of its size: 4, 5 or 6.
inline AnyBelief to_belief(const char* name, const PyGaussian& gaussian) {
  if (gaussian.mean.size() < 4 || gaussian.mean.size() > kMaxStates)
    throw py::value_error(std::string(name) + " must have a mean of 4, 5 or 6 states, got " +
                          std::to_string(gaussian.mean.size()));
  AnyBelief belief;
  belief.layout = gaussian.mean.size() == 4   ? StateLayout::kKinematics
                  : gaussian.mean.size() == 5 ? StateLayout::kTurn
                                              : StateLayout::kAcceleration;
  belief.mean = gaussian.mean;
  belief.covariance = gaussian.covariance;
  return belief;
}

/// The belief that an estimator of so many states starts with: over these, or over [x, vx, y, vy].
inline AnyBelief to_start(const char* name, const PyGaussian& gaussian, int states) {
  if (gaussian.mean.size() != 4 && gaussian.mean.size() != states)
    throw py::value_error(std::string(name) + " must have a mean of 4" +
                          (states == 4 ? "" : " or " + std::to_string(states)) + " states, got " +
                          std::to_string(gaussian.mean.size()));
  return to_belief(name, gaussian);
}

/// The sensors that estimators take.
using AnySensor = std::variant<RangeBearing, ConvertedRangeBearing, Position, RangeBearingDoppler>;

/// Whether a Python object is a `Class`. (`py::isinstance` looks the type up by its name each
/// time.)
template <class Class>
bool is_a(const py::handle& object) {
  static PyTypeObject* const type = reinterpret_cast<PyTypeObject*>(py::type::of<Class>().ptr());
  return PyObject_TypeCheck(object.ptr(), type) != 0;
}

/// Calls `function(sensor)` with the C++ sensor behind a Python one.
template <class Function>
auto visit_sensor(const py::handle& sensor, Function&& function) {
  if (is_a<RangeBearing>(sensor)) return function(sensor.cast<const RangeBearing&>());
  if (is_a<ConvertedRangeBearing>(sensor))
    return function(sensor.cast<const ConvertedRangeBearing&>());
  if (is_a<Position>(sensor)) return function(sensor.cast<const Position&>());
  if (is_a<RangeBearingDoppler>(sensor)) return function(sensor.cast<const RangeBearingDoppler&>());
  throw py::type_error(
      "sensor must be RangeBearing, ConvertedRangeBearing, Position or "
      "RangeBearingDoppler, got " +
      py::str(py::type::of(sensor).attr("__name__")).cast<std::string>());
}

/// Throws ValueError when a Kalman filter is given a sensor that is not linear.
template <class Sensor, class Estimator>
void require_linear(const Estimator& estimator) {
  if constexpr (requires { estimator.bank(); }) {
    for (int k = 0; k < estimator.bank().size(); ++k)
      require_linear<Sensor>(estimator.bank().filter(static_cast<std::size_t>(k)));
  } else if (estimator.linear() && !Sensor::kLinear) {
    throw py::value_error(
        "sensor must be linear for Kalman: use ConvertedRangeBearing or Position, or Ekf or Ukf");
  }
}

// What `run` and the faces ask of an estimator.

inline int states_of(const AnyFilter& filter) noexcept { return states_of(filter.layout()); }

template <class Estimator>
int states_of(const Estimator& estimator) noexcept {
  return estimator.estimate().states();
}

/// Number of models; 0 for a single filter.
template <class Estimator>
int models_of(const Estimator& estimator) noexcept {
  if constexpr (requires { estimator.mode_probability(); })
    return static_cast<int>(estimator.mode_probability().size());
  return 0;
}

/// A known acceleration, (2,) array or None.
inline std::optional<Vec<double, 2>> to_acceleration(const std::optional<DoubleArray>& array) {
  if (!array) return std::nullopt;
  return to_vector<2>("acceleration_mps2", *array);
}

/// `predict` with or without a known acceleration.
template <class Estimator>
Status predict(Estimator& estimator, double dt_s,
               const std::optional<Vec<double, 2>>& acceleration_mps2) noexcept {
  return acceleration_mps2 ? estimator.predict(dt_s, *acceleration_mps2) : estimator.predict(dt_s);
}

}  // namespace wakeline::python
