// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What every estimator looks like in Python.
#pragma once

#include "run.hpp"

namespace wakeline::python {

/// Updates a filter or an Imm with a reading of a `RuntimeSensor`.
template <class Estimator>
PyStep update_reading(Estimator& estimator, RuntimeSensor& sensor, const DoubleArray& z,
                      const std::optional<DoubleArray>& covariance) {
  const int numbers = sensor.numbers();
  Vec<double, kMostNumbers> padded =
      Vec<double, kMostNumbers>::Constant(std::numeric_limits<double>::quiet_NaN());
  padded.head(numbers) = to_vector("z", z, numbers);
  if (covariance) {
    require_covariances(*covariance, z);
    sensor.set_covariance(covariance->data());
  }
  const auto step = [&] {
    if constexpr (std::is_same_v<Estimator, AnyEstimator>)
      return std::get<AnyImm>(estimator.variant()).update(sensor, padded);
    else
      return estimator.update(sensor, padded);
  }();
  raise_fault(estimator);
  raise_fault(sensor);
  require_ok(step.status, "update");
  return to_step(step, sensor, padded);
}

/// Adds start, predict, update, estimate, started and run to the class that estimators share.
/// `Estimator` is AnyFilter or AnyEstimator.
template <class Estimator>
void define_face(py::class_<Estimator>& face) {
  face.def(
          "start",
          [](Estimator& estimator, const PyGaussian& belief) {
            const StateLayout layout = run_layout(estimator).layout;
            require_ok(estimator.start(to_start("belief", belief, layout)), "start");
          },
          py::arg("belief"),
          "Begins with a belief over the state of the estimate or over [x, vx, y, vy].")
      .def(
          "predict",
          [](Estimator& estimator, double dt_s, const std::optional<DoubleArray>& acceleration) {
            const auto known = to_acceleration(acceleration);
            if constexpr (std::is_same_v<Estimator, AnyEstimator>)
              if (estimator.has_modes()) static_cast<AnyMixture&>(estimator).note_step(dt_s);
            const Status status = known ? estimator.predict(dt_s, *known) : estimator.predict(dt_s);
            raise_fault(estimator);
            require_ok(status, "predict");
          },
          py::arg("dt_s"), py::arg("acceleration_mps2") = py::none(),
          "Moves dt_s seconds on, under a known acceleration [north, east] where one is given; "
          "mode probabilities follow the chain.")
      .def(
          "update",
          [](Estimator& estimator, const py::object& object, const DoubleArray& z,
             const std::optional<DoubleArray>& covariance) {
            ReadingSensor any = to_reading_sensor(estimator, object, z, covariance.has_value());
            if (auto* const sensor = std::get_if<RuntimeSensor>(&any))
              return update_reading(estimator, *sensor, z, covariance);
            return visit_numbers(std::get<AnySensor>(any), [&]<int M>(const AnySensorOf<M>& one) {
              const auto step = estimator.update(one, to_vector<M>("z", z));
              raise_fault(estimator);
              require_ok(step.status, "update");
              return to_step(step);
            });
          },
          py::arg("sensor"), py::arg("z"), py::arg("covariance") = py::none(),
          R"(Corrects the belief by a reading; returns the Step.

Parameters
----------
sensor : sensor
z : (M,) array
    Numbers that are NaN are not measured: the others are used.
covariance : (M, M) array, optional
    Of this reading, instead of the sensor's: of a filter and an Imm.

Returns
-------
Step
    NaN where a number was missing; nis has as many degrees of freedom as there were numbers.

Raises
------
ValueError
    When a shape does not fit, or the sensor reads what the state does not have.
FilterError
    When the update fails.)")
      .def(
          "estimate",
          [](const Estimator& estimator) {
            if (!estimator.started()) require_ok(Status::kNotStarted, "estimate");
            return to_gaussian(estimator.estimate());
          },
          "The belief; of several models moment-matched, over the state where all share one, else "
          "over [x, vx, y, vy].")
      .def_property_readonly("started", &Estimator::started, "Whether it has a belief.");
  define_run(face, "run", &run<Estimator>, kRunDoc);
}

/// Adds filter_estimate to an estimator over filters.
template <class Kind, class... Options>
void define_filter_estimate(py::class_<PyEstimator<Kind>, Options...>& face) {
  face.def(
      "filter_estimate",
      [](const PyEstimator<Kind>& estimator, int index) {
        if (!estimator.started()) require_ok(Status::kNotStarted, "filter_estimate");
        const auto& bank = estimator.get().bank();
        if (index < 0 || index >= bank.size())
          throw py::index_error("index must be 0 to " + std::to_string(bank.size() - 1) + ", got " +
                                std::to_string(index));
        return to_gaussian(bank.filter(index).estimate());
      },
      py::arg("index"), "The belief of one of the filters, over its own state.");
}

/// Adds turn_rates_rad_s to an estimator whose models change theirs.
template <class Kind, class... Options>
void define_turn_rates(py::class_<PyEstimator<Kind>, Options...>& face) {
  face.def(
      "turn_rates_rad_s",
      [](const AnyEstimator& estimator) { return to_array(estimator.turn_rates_rad_s()); },
      "(K,) turn rates of the models, positive to starboard; NaN for one at rest.");
}

/// A class of estimators of one kind; `Base` is AnyMixture or AnyEstimator.
template <class Kind>
using EstimatorClass =
    py::class_<PyEstimator<Kind>,
               std::conditional_t<WeighsAlternatives<Kind>, AnyMixture, AnyEstimator>>;

}  // namespace wakeline::python
