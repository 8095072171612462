// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/fields.hpp"
#include "support/types.hpp"
#include "wakeline/catalog/sensors.hpp"

namespace wakeline::python {
namespace {

/// What every sensor offers in Python.
template <class Sensor>
void define_sensor(py::class_<Sensor>& sensor) {
  constexpr int kM = Sensor::kMeasurements;
  sensor.def_property_readonly_static(
      "measurements", [](const py::object&) { return kM; }, "numbers per reading, M");
  sensor.def(
      "observe",
      [](const Sensor& s, const DoubleArray& z) {
        return PyGaussian::from(s.observe(to_vector<kM>("z", z)));
      },
      py::arg("z"), "The reading as value and covariance R, converted if the sensor is.");
  if constexpr (PositionSensor<Sensor>)
    sensor.def(
        "position",
        [](const Sensor& s, const DoubleArray& z) {
          return PyGaussian::from(s.position(to_vector<kM>("z", z)));
        },
        py::arg("z"), "The reading in north/east, m: mean (2,), covariance (2, 2).");
  sensor.def(
      "measure",
      [](const Sensor& s, const DoubleArray& x) {
        return to_array(s.measure(to_vector<kReadsOf<Sensor>>("x", x)));
      },
      py::arg("x"), "h of the components that the sensor reads ([x, y], or [x, vx, y, vy]), (M,).");
  sensor.def(
      "jacobian",
      [](const Sensor& s, const DoubleArray& x) {
        return to_array(s.jacobian(to_vector<kReadsOf<Sensor>>("x", x)));
      },
      py::arg("x"), "dh/dx of those components.");
}

}  // namespace

void define_measurement(py::module_& parent) {
  py::module_ m = parent.def_submodule("measurement", "Sensors.");

  define_struct<OwnShip>(m, "OwnShip",
                         "Where the antenna is when it measures, and how well that is known.",
                         {.writable = true});
  Joined<Sensors, PartSensors>::for_each([&]<class Sensor>(std::type_identity<Sensor>) {
    // Own ship moves, so that a sensor that has one can be written to.
    constexpr bool kMoves = requires(const Sensor& one) { one.own; };
    auto sensor = define_struct<Sensor>(m, Sensor::kName, Sensor::kSummary,
                                        {.writable = kMoves, .called = true});
    define_sensor(sensor);
  });

  m.def("conversion_bias_ratio", py::vectorize(&conversion_bias_ratio), py::arg("range_m"),
        py::arg("range_std_m"), py::arg("bearing_std_rad"),
        "r sb² / sr: twice the bias of the plain polar conversion, r sb² / 2, over the range "
        "error.");
  m.def("conversion_bias_matters", py::vectorize(&conversion_bias_matters), py::arg("range_m"),
        py::arg("range_std_m"), py::arg("bearing_std_rad"),
        "Whether the bias of the plain polar conversion matters: ratio above 0.4.");
}

}  // namespace wakeline::python
