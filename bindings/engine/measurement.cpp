// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/types.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"

namespace wakeline::python {
namespace {

/// The arguments of all radars.
template <class Sensor>
Arguments polar_arguments(const Sensor& sensor) {
  return Arguments()
      .with("range_std_m", sensor.range_std_m)
      .with("bearing_std_rad", sensor.bearing_std_rad)
      .with("extent_std_m", sensor.extent_std_m)
      .with("bearing_offset_rad", sensor.bearing_offset_rad)
      .with("own", sensor.own);
}

/// What every sensor offers in Python.
template <class Sensor>
void define_sensor(py::class_<Sensor>& sensor) {
  constexpr int kM = Sensor::kMeasurements;
  define_copies(sensor);
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

/// A number of own ship that can be read and, where it makes sense, set.
void define_number(py::class_<OwnShip>& own_ship, const char* name, double OwnShip::*number) {
  own_ship.def_property(
      name, [number](const OwnShip& own) { return own.*number; },
      [number](OwnShip& own, double value) {
        OwnShip changed = own;
        changed.*number = value;
        own = validated(changed);
      });
}

const char* const kPolarParameters = R"(

Parameters
----------
range_std_m, bearing_std_rad : float
    Standard deviations of the radar.
extent_std_m : float
    Wander of the echo over the vessel's hull, per axis.
bearing_offset_rad : float
    Bearing read minus true bearing.
own : OwnShip
    Where the antenna is, and how well that and the heading are known.)";

}  // namespace

void define_measurement(py::module_& parent) {
  py::module_ m = parent.def_submodule("measurement", "What a sensor reports.");

  py::class_<OwnShip> own_ship(
      m, "OwnShip", "Where the antenna is when it measures, and how well that is known.");
  define_number(own_ship, "north_m", &OwnShip::north_m);
  define_number(own_ship, "east_m", &OwnShip::east_m);
  define_number(own_ship, "vnorth_mps", &OwnShip::vnorth_mps);
  define_number(own_ship, "veast_mps", &OwnShip::veast_mps);
  define_number(own_ship, "position_std_m", &OwnShip::position_std_m);
  define_number(own_ship, "velocity_std_mps", &OwnShip::velocity_std_mps);
  define_number(own_ship, "heading_std_rad", &OwnShip::heading_std_rad);
  define_copies(own_ship);
  own_ship
      .def(py::init([](double north, double east, double vnorth, double veast, double position,
                       double velocity, double heading) {
             return validated(OwnShip{north, east, vnorth, veast, position, velocity, heading});
           }),
           py::kw_only(), py::arg("north_m") = 0.0, py::arg("east_m") = 0.0,
           py::arg("vnorth_mps") = 0.0, py::arg("veast_mps") = 0.0, py::arg("position_std_m") = 0.0,
           py::arg("velocity_std_mps") = 0.0, py::arg("heading_std_rad") = 0.0)
      .def("_arguments", [](const OwnShip& own) {
        return Arguments()
            .with("north_m", own.north_m)
            .with("east_m", own.east_m)
            .with("vnorth_mps", own.vnorth_mps)
            .with("veast_mps", own.veast_mps)
            .with("position_std_m", own.position_std_m)
            .with("velocity_std_mps", own.velocity_std_mps)
            .with("heading_std_rad", own.heading_std_rad);
      });

  const std::string polar =
      std::string("A plot [range m, bearing rad] for Ekf and Ukf.") + kPolarParameters;
  py::class_<RangeBearing> range_bearing(m, "RangeBearing", polar.c_str());
  range_bearing
      .def(py::init(
               [](double range, double bearing, double extent, double offset, const OwnShip& own) {
                 return validated(RangeBearing{range, bearing, extent, offset, own});
               }),
           py::kw_only(), py::arg("range_std_m") = RangeBearing{}.range_std_m,
           py::arg("bearing_std_rad") = RangeBearing{}.bearing_std_rad,
           py::arg("extent_std_m") = 0.0, py::arg("bearing_offset_rad") = 0.0,
           py::arg_v("own", OwnShip{}, "OwnShip()"))
      .def_readonly("range_std_m", &RangeBearing::range_std_m)
      .def_readonly("bearing_std_rad", &RangeBearing::bearing_std_rad)
      .def_readonly("extent_std_m", &RangeBearing::extent_std_m)
      .def_readonly("bearing_offset_rad", &RangeBearing::bearing_offset_rad)
      .def_readwrite("own", &RangeBearing::own)
      .def("_arguments", [](const RangeBearing& sensor) { return polar_arguments(sensor); });
  define_sensor(range_bearing);

  const std::string converted =
      std::string(
          "A plot [range m, bearing rad] turned into north/east with its own covariance: linear.") +
      kPolarParameters +
      "\nunbiased : bool\n    Correct mean and covariance for the curvature of the bearing error.";
  py::class_<ConvertedRangeBearing> converted_range_bearing(m, "ConvertedRangeBearing",
                                                            converted.c_str());
  converted_range_bearing
      .def(py::init([](double range, double bearing, bool unbiased, double extent, double offset,
                       const OwnShip& own) {
             return validated(ConvertedRangeBearing{range, bearing, unbiased, extent, offset, own});
           }),
           py::kw_only(), py::arg("range_std_m") = ConvertedRangeBearing{}.range_std_m,
           py::arg("bearing_std_rad") = ConvertedRangeBearing{}.bearing_std_rad,
           py::arg("unbiased") = true, py::arg("extent_std_m") = 0.0,
           py::arg("bearing_offset_rad") = 0.0, py::arg_v("own", OwnShip{}, "OwnShip()"))
      .def_readonly("range_std_m", &ConvertedRangeBearing::range_std_m)
      .def_readonly("bearing_std_rad", &ConvertedRangeBearing::bearing_std_rad)
      .def_readonly("unbiased", &ConvertedRangeBearing::unbiased)
      .def_readonly("extent_std_m", &ConvertedRangeBearing::extent_std_m)
      .def_readonly("bearing_offset_rad", &ConvertedRangeBearing::bearing_offset_rad)
      .def_readwrite("own", &ConvertedRangeBearing::own)
      .def("_arguments", [](const ConvertedRangeBearing& sensor) {
        return polar_arguments(sensor).with("unbiased", sensor.unbiased);
      });
  define_sensor(converted_range_bearing);

  const std::string doppler =
      std::string("A plot [range m, bearing rad, range rate m/s], the rate as own ship sees it.") +
      kPolarParameters + "\nrange_rate_std_mps : float\n    Standard deviation of the range rate.";
  py::class_<RangeBearingDoppler> range_bearing_doppler(m, "RangeBearingDoppler", doppler.c_str());
  range_bearing_doppler
      .def(py::init([](double range, double bearing, double rate, double extent, double offset,
                       const OwnShip& own) {
             return validated(RangeBearingDoppler{range, bearing, rate, extent, offset, own});
           }),
           py::kw_only(), py::arg("range_std_m") = RangeBearingDoppler{}.range_std_m,
           py::arg("bearing_std_rad") = RangeBearingDoppler{}.bearing_std_rad,
           py::arg("range_rate_std_mps") = RangeBearingDoppler{}.range_rate_std_mps,
           py::arg("extent_std_m") = 0.0, py::arg("bearing_offset_rad") = 0.0,
           py::arg_v("own", OwnShip{}, "OwnShip()"))
      .def_readonly("range_std_m", &RangeBearingDoppler::range_std_m)
      .def_readonly("bearing_std_rad", &RangeBearingDoppler::bearing_std_rad)
      .def_readonly("range_rate_std_mps", &RangeBearingDoppler::range_rate_std_mps)
      .def_readonly("extent_std_m", &RangeBearingDoppler::extent_std_m)
      .def_readonly("bearing_offset_rad", &RangeBearingDoppler::bearing_offset_rad)
      .def_readwrite("own", &RangeBearingDoppler::own)
      .def("_arguments", [](const RangeBearingDoppler& sensor) {
        return polar_arguments(sensor).with("range_rate_std_mps", sensor.range_rate_std_mps);
      });
  define_sensor(range_bearing_doppler);

  py::class_<Position> position(
      m, "Position", "A position [north m, east m] with equal error in every direction.");
  position
      .def(py::init([](double std) { return validated(Position{std}); }), py::kw_only(),
           py::arg("position_std_m") = Position{}.position_std_m)
      .def_readonly("position_std_m", &Position::position_std_m)
      .def("_arguments", [](const Position& sensor) {
        return Arguments().with("position_std_m", sensor.position_std_m);
      });
  define_sensor(position);

  m.def("conversion_bias_ratio", py::vectorize(&conversion_bias_ratio), py::arg("range_m"),
        py::arg("range_std_m"), py::arg("bearing_std_rad"),
        "r sb² / sr: twice the bias of the plain polar conversion, r sb² / 2, over the range "
        "error.");
  m.def("conversion_bias_matters", py::vectorize(&conversion_bias_matters), py::arg("range_m"),
        py::arg("range_std_m"), py::arg("bearing_std_rad"),
        "True when the plain polar conversion is biased enough to matter: ratio above 0.4.");
}

}  // namespace wakeline::python
