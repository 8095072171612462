// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What every estimator looks like in Python.
#pragma once

#include "run.hpp"

namespace wakeline::python {

/// Adds start, predict, update, estimate, started and run; mode_probability, models,
/// turn_rates_rad_s and filter_estimate where the estimator has them.
///
/// The estimator has the face of `Imm` over AnyBelief: `start(AnyBelief)`, `predict(dt_s)`,
/// `predict(dt_s, acceleration)`, `update(sensor, z)`, `estimate()` and `started()`. `Options` are
/// those of the py::class_.
template <class Estimator, class... Options>
void define_face(py::class_<Estimator, Options...>& face) {
  define_copies(face);
  face.def(
          "start",
          [](Estimator& estimator, const PyGaussian& belief) {
            require_ok(estimator.start(to_start("belief", belief, states_of(estimator))), "start");
          },
          py::arg("belief"),
          "Begins with a belief over the state of the estimate or over [x, vx, y, vy].")
      .def(
          "predict",
          [](Estimator& estimator, double dt_s, const std::optional<DoubleArray>& acceleration) {
            require_ok(predict(estimator, dt_s, to_acceleration(acceleration)), "predict");
          },
          py::arg("dt_s"), py::arg("acceleration_mps2") = py::none(),
          "Moves dt_s seconds on, under a known acceleration [north, east] where one is given; "
          "mode probabilities follow the chain.")
      .def(
          "update",
          [](Estimator& estimator, const py::object& sensor, const DoubleArray& z) {
            return visit_sensor(sensor, [&]<class Sensor>(const Sensor& model) {
              require_linear<Sensor>(estimator);
              constexpr int kM = Sensor::kMeasurements;
              const auto step = estimator.update(model, to_vector<kM>("z", z));
              require_ok(step.status, "update");
              return to_step(step);
            });
          },
          py::arg("sensor"), py::arg("z"), "Corrects the belief by a reading; returns the Step.")
      .def(
          "estimate",
          [](const Estimator& estimator) {
            if (!estimator.started()) require_ok(Status::kNotStarted, "estimate");
            return to_gaussian(estimator.estimate());
          },
          "The belief; of several models moment-matched, over the state where all share one, else "
          "over [x, vx, y, vy].")
      .def_property_readonly("started", &Estimator::started)
      .def("run", &run<Estimator>, py::arg("z"), py::arg("dt_s"), py::arg("sensor"),
           py::arg("start"), py::arg("own_position_m") = py::none(),
           py::arg("own_velocity_mps") = py::none(), py::arg("acceleration_mps2") = py::none(),
           py::arg("gate") = py::none(), kRunDoc);
  if constexpr (requires(const Estimator& estimator) { estimator.mode_probability(); })
    face.def(
            "mode_probability",
            [](const Estimator& estimator) { return to_array(estimator.mode_probability()); },
            "(K,)")
        .def_property_readonly("models", &models_of<Estimator>);
  if constexpr (kHasTurnRates<Estimator>)
    face.def(
        "turn_rates_rad_s",
        [](const Estimator& estimator) { return to_array(estimator.turn_rates_rad_s()); },
        "(K,) turn rates of the models, positive to starboard; NaN for one at rest.");
  if constexpr (requires(const Estimator& estimator) { estimator.bank(); })
    face.def(
        "filter_estimate",
        [](const Estimator& estimator, int index) {
          if (!estimator.started()) require_ok(Status::kNotStarted, "filter_estimate");
          const int models = estimator.bank().size();
          if (index < 0 || index >= models)
            throw py::index_error("index must be 0 to " + std::to_string(models - 1) + ", got " +
                                  std::to_string(index));
          return to_gaussian(estimator.bank().filter(static_cast<std::size_t>(index)).estimate());
        },
        py::arg("index"), "The belief of one of the filters, over its own state.");
}

}  // namespace wakeline::python
