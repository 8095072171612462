// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/fields.hpp"
#include "support/types.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"

namespace wakeline::python {
namespace {

/// A sensor in Python. Own ship moves, so that a sensor that has one can be written to.
template <class Sensor>
void define_sensor(py::handle scope, const char* name, const char* doc) {
  constexpr int kM = Sensor::kMeasurements;
  constexpr bool kMoves = requires(const Sensor& one) { one.own; };
  py::class_<Sensor> sensor = define_struct<Sensor>(scope, name, doc, {.writable = kMoves});
  sensor.def_property_readonly_static(
      "measurements", [](const py::object&) { return kM; }, "numbers per reading, M");
  sensor.def(
      "observe",
      [](const Sensor& s, const DoubleArray& z) {
        return PyGaussian::from(s.observe(to_vector<kM>("z", z)));
      },
      py::arg("z"), "The reading as value and covariance R, converted where the sensor is.");
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
      py::arg("x"), "h of the components the sensor reads ([x, y], or [x, vx, y, vy]), (M,).");
  sensor.def(
      "jacobian",
      [](const Sensor& s, const DoubleArray& x) {
        return to_array(s.jacobian(to_vector<kReadsOf<Sensor>>("x", x)));
      },
      py::arg("x"), "dh/dx of those components.");
}

}  // namespace

void define_measurement(py::module_& parent) {
  py::module_ m = parent.def_submodule("measurement", "What a sensor reports.");

  define_struct<OwnShip>(m, "OwnShip",
                         "Where the antenna is when it measures, and how well that is known.",
                         {.writable = true});
  define_sensor<RangeBearing>(m, "RangeBearing", "A plot [range m, bearing rad] for Ekf and Ukf.");
  define_sensor<ConvertedRangeBearing>(
      m, "ConvertedRangeBearing",
      "A plot [range m, bearing rad] converted to north/east with its covariance: linear.");
  define_sensor<RangeBearingDoppler>(
      m, "RangeBearingDoppler",
      "A plot [range m, bearing rad, range rate m/s], the rate as own ship sees it.");
  define_sensor<Position>(m, "Position",
                          "A position [north m, east m] with equal error in every direction.");

  m.def("conversion_bias_ratio", py::vectorize(&conversion_bias_ratio), py::arg("range_m"),
        py::arg("range_std_m"), py::arg("bearing_std_rad"),
        "r sb² / sr: twice the bias of the plain polar conversion, r sb² / 2, over the range "
        "error.");
  m.def("conversion_bias_matters", py::vectorize(&conversion_bias_matters), py::arg("range_m"),
        py::arg("range_std_m"), py::arg("bearing_std_rad"),
        "True when the plain polar conversion is biased enough to matter: ratio above 0.4.");
}

}  // namespace wakeline::python
