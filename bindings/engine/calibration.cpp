// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/calibration.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "support/columns.hpp"
#include "support/fields.hpp"
#include "support/option.hpp"
#include "support/thread_lock.hpp"
#include "support/types.hpp"

namespace wakeline::python {

void define_calibration(py::module_& track);

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A calibration that several threads may use.
struct PyCalibration : Calibration, ThreadLock {
  using Calibration::Calibration;
};

int add_reports(PyCalibration& calibration, std::int64_t vessel, const DoubleArray& time_s,
                const DoubleArray& north_m, const DoubleArray& east_m,
                const DoubleArray& vnorth_mps, const DoubleArray& veast_mps,
                const DoubleArray& position_std_m, const std::optional<DoubleArray>& covariance,
                const DoubleArray& antenna_north_m, const DoubleArray& antenna_east_m) {
  require_shape(time_s.ndim() <= 1, "time_s", "(n,)", time_s);
  const py::ssize_t rows = time_s.size();
  const DoubleArray north = column("north_m", north_m, rows);
  const DoubleArray east = column("east_m", east_m, rows);
  const DoubleArray vnorth = column("vnorth_mps", vnorth_mps, rows);
  const DoubleArray veast = column("veast_mps", veast_mps, rows);
  const DoubleArray std = column("position_std_m", position_std_m, rows);
  const DoubleArray antenna_north = column("antenna_north_m", antenna_north_m, rows);
  const DoubleArray antenna_east = column("antenna_east_m", antenna_east_m, rows);
  if (covariance)
    require_shape(covariance->ndim() == 3 && covariance->shape(0) == rows &&
                      covariance->shape(1) == 2 && covariance->shape(2) == 2,
                  "covariance", shape_text({rows, 2, 2}), *covariance);
  const auto hold = calibration.hold();
  int left_out = 0;
  for (py::ssize_t k = 0; k < rows; ++k) {
    ReferenceReport report{.vessel = vessel,
                           .time_s = time_s.data()[k],
                           .north_m = north.data()[k],
                           .east_m = east.data()[k],
                           .vnorth_mps = vnorth.data()[k],
                           .veast_mps = veast.data()[k],
                           .position_std_m = std.data()[k],
                           .antenna_m = {antenna_north.data()[k], antenna_east.data()[k]}};
    if (covariance)
      report.covariance = Eigen::Map<const Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>(
          covariance->data() + 4 * k);
    if (!ok(calibration.report(report))) ++left_out;
  }
  return left_out;
}

void add_plots(PyCalibration& calibration, const DoubleArray& time_s, const DoubleArray& range_m,
               const DoubleArray& bearing_rad, const DoubleArray& own_north_m,
               const DoubleArray& own_east_m, const DoubleArray& own_vnorth_mps,
               const DoubleArray& own_veast_mps, double own_position_std_m,
               double heading_std_rad) {
  require_shape(range_m.ndim() == 1, "range_m", "(n,)", range_m);
  const py::ssize_t rows = range_m.size();
  const DoubleArray time = column("time_s", time_s, rows);
  const DoubleArray bearing = column("bearing_rad", bearing_rad, rows);
  const DoubleArray north = column("own_north_m", own_north_m, rows);
  const DoubleArray east = column("own_east_m", own_east_m, rows);
  const DoubleArray vnorth = column("own_vnorth_mps", own_vnorth_mps, rows);
  const DoubleArray veast = column("own_veast_mps", own_veast_mps, rows);
  require(own_position_std_m >= 0.0, "own_position_std_m", "not negative", own_position_std_m);
  require(heading_std_rad >= 0.0, "heading_std_rad", "not negative", heading_std_rad);
  std::vector<Plot> plots(static_cast<std::size_t>(rows));
  for (std::size_t k = 0; k < plots.size(); ++k)
    plots[k] = {time.data()[k], range_m.data()[k], bearing.data()[k],
                OwnShip{.north_m = north.data()[k],
                        .east_m = east.data()[k],
                        .vnorth_mps = vnorth.data()[k],
                        .veast_mps = veast.data()[k],
                        .position_std_m = own_position_std_m,
                        .heading_std_rad = heading_std_rad}};
  const auto hold = calibration.hold();
  const py::gil_scoped_release release;
  calibration.plots(plots);
}

CalibrationResult solve(const PyCalibration& calibration) {
  const auto hold = calibration.hold();
  const py::gil_scoped_release release;
  return calibration.solve();
}

/// A member of each row.
template <class Row, class Value>
auto column_of_member(std::vector<Row> CalibrationResult::*rows, Value Row::*member) {
  return [rows, member](const CalibrationResult& result) {
    return column_of<Value>(result.*rows, [&](const Row& row) { return row.*member; });
  };
}

py::tuple offset_state(const CalibratedOffset& one) {
  return py::make_tuple(one.value, one.std, word_of(one.verdict));
}

CalibratedOffset offset_of(const py::tuple& state) {
  return {state[0].cast<double>(), state[1].cast<double>(),
          to_option<CalibrationVerdict>("verdict", state[2].cast<std::string>())};
}

}  // namespace

void define_calibration(py::module_& m) {
  define_struct<CalibrationConfig>(m, "CalibrationConfig", "Parameters of `Calibration`.");

  py::class_<CalibratedOffset> offset(
      m, "CalibratedOffset",
      "One offset of a radar, measured minus true, or less that of the "
      "other radar.");
  offset
      .def_readonly("value", &CalibratedOffset::value,
                    "m, rad or s; NaN without any plot of a reported vessel")
      .def_readonly("std", &CalibratedOffset::std, "its standard deviation")
      .def_property_readonly(
          "verdict", [](const CalibratedOffset& one) { return word_of(one.verdict); },
          "'determined', 'few matches' (too few plots of reported vessels, or no more than by "
          "chance), 'poor geometry' (the standard deviation is above the limit) or 'near gate' (an "
          "offset is above 0.8 of its gate)")
      .def_property_readonly("determined", &CalibratedOffset::determined,
                             "whether the value is good enough to be applied")
      .def(py::pickle(&offset_state, &offset_of))
      .def("__repr__", [](const CalibratedOffset& one) {
        return "<CalibratedOffset: " + std::to_string(one.value) + " +- " +
               std::to_string(one.std) + ", " + word_of(one.verdict) + ">";
      });

  using R = CalibrationResult;
  using V = CalibrationVessel;
  using P = CalibrationMatch;
  py::class_<R> result(m, "CalibrationResult", R"(Offsets of a radar, and what they were found from.

`vessel_*` are columns of the vessels with a plot, `pair_*` of all pairs of plot and vessel in the
gate.)");
  result.def_readonly("range_m", &R::range_m, "CalibratedOffset of the range, m")
      .def_readonly("bearing_rad", &R::bearing_rad, "CalibratedOffset of the bearing, rad")
      .def_readonly("time_s", &R::time_s, "CalibratedOffset of the radar's clock, s")
      .def_readonly("other_range_m", &R::other_range_m,
                    "CalibratedOffset of the range of the other radar, where the reports are its "
                    "tracks, m")
      .def_readonly("other_bearing_rad", &R::other_bearing_rad, "the same of its bearing, rad")
      .def_property_readonly(
          "covariance", [](const R& one) { return to_array(one.covariance); },
          "(3, 3) of range, bearing and time offset")
      .def_readonly("matches", &R::matches, "number of plots of reported vessels")
      .def_readonly("range_scale", &R::range_scale,
                    "errors of range found over those expected of radar and reports")
      .def_readonly("bearing_scale", &R::bearing_scale, "the same of bearings")
      .def_readonly("correlation_scans", &R::correlation_scans,
                    "number of plots of a vessel that count as one, for their errors are alike")
      .def_readonly("vessel_offset_std_m", &R::vessel_offset_std_m,
                    "standard deviation of the constant offsets of the vessels, per axis")
      .def("applied_to", &R::applied_to, py::arg("radar"),
           "The parameters of a radar with the offsets that were determined.");
  const auto row = [&](const char* name, auto rows, auto member, const char* doc) {
    result.def_property_readonly(name, column_of_member(rows, member), doc);
  };
  row("vessel_id", &R::vessels, &V::vessel, "(v,) number of each vessel");
  row("vessel_matches", &R::vessels, &V::matches, "(v,) number of its plots");
  row("vessel_along_m", &R::vessels, &V::along_offset_m,
      "(v,) its echo minus its reported position, along its course");
  row("vessel_across_m", &R::vessels, &V::across_offset_m, "(v,) the same, to starboard");
  row("pair_vessel", &R::pairs, &P::vessel, "(n,) number of the vessel");
  row("pair_time_s", &R::pairs, &P::time_s, "(n,) time of the plot, by the radar's clock");
  row("pair_range_m", &R::pairs, &P::range_m, "(n,) range of the reported position");
  row("pair_bearing_rad", &R::pairs, &P::bearing_rad, "(n,) bearing of the reported position");
  row("pair_range_error_m", &R::pairs, &P::range_error_m, "(n,) plot minus reported position");
  row("pair_bearing_error_rad", &R::pairs, &P::bearing_error_rad, "(n,) the same");
  row("pair_range_rest_m", &R::pairs, &P::range_rest_m,
      "(n,) the same without the offsets of radar and vessel");
  row("pair_bearing_rest_rad", &R::pairs, &P::bearing_rest_rad, "(n,) the same");
  row("pair_probability", &R::pairs, &P::probability,
      "(n,) probability that the plot is the vessel's");
  result.def("__repr__", [](const R& one) {
    return "<CalibrationResult: " + std::to_string(std::lround(one.matches)) + " matches of " +
           std::to_string(one.vessels.size()) + " vessels; range " + word_of(one.range_m.verdict) +
           ", bearing " + word_of(one.bearing_rad.verdict) + ", time " +
           word_of(one.time_s.verdict) + ">";
  });

  py::class_<PyCalibration> calibration(m, "Calibration",
                                        R"(Range, bearing and time offset of a radar from reports.

Plots of vessels whose positions are known by their reports (AIS, GNSS) or by the tracks of another
radar give the three offsets with their standard deviations, by robust weighted least squares. Each vessel's echo may have a constant
offset from the reported position, which is estimated, too. An offset is determined only if there
are enough matches and its standard deviation is below the limit. Memory is bounded.

A plot is compared with the reports before and after it. Reports and plots are given as they come, or
all plots first, of which the last `max_waiting_plots` wait for reports; of a vessel only the last
two reports are kept, so that one given long before the plots of its time is compared with none.

Parameters
----------
radar : Radar, optional
    Its errors; its offsets are not used.
config : CalibrationConfig, optional

Raises
------
ValueError
    When a parameter is out of range.)");
  define_arguments(calibration);
  calibration
      .def(py::init<const Radar&, const CalibrationConfig&>(),
           py::arg_v("radar", Radar{}, "Radar()"),
           py::arg_v("config", CalibrationConfig{}, "CalibrationConfig()"))
      .def("add_reports", &add_reports, py::arg("vessel"), py::arg("time_s"), py::kw_only(),
           py::arg("north_m"), py::arg("east_m"), py::arg("vnorth_mps") = kUnknown,
           py::arg("veast_mps") = kUnknown, py::arg("position_std_m") = 5.0,
           py::arg("covariance") = py::none(), py::arg("antenna_north_m") = kUnknown,
           py::arg("antenna_east_m") = kUnknown,
           R"(Take position reports of one vessel, or its track by another radar.

Parameters
----------
vessel : int
    Its number, such as the MMSI.
time_s : (n,) array or float
north_m, east_m : (n,) array or float
vnorth_mps, veast_mps : (n,) array or float, optional
    Velocity, NaN where unknown. With velocities, positions between reports are on a cubic.
position_std_m : (n,) array or float
    Standard deviation per axis of the part that differs from report to report.
covariance : (n, 2, 2) array, optional
    Of [north, east] by a track, in place of `position_std_m`.
antenna_north_m, antenna_east_m : (n,) array or float
    Antenna of the other radar. Its offsets are then taken for unknown, and the offsets that are
    found are those of this radar less those of that one. NaN: the positions are reported.

Returns
-------
int
    Number of reports left out: not finite, of a covariance that is none, not after the last one of the vessel, or of one vessel
    too many.

Raises
------
ValueError
    When a shape does not fit.)")
      .def("add_plots", &add_plots, py::arg("time_s"), py::kw_only(), py::arg("range_m"),
           py::arg("bearing_rad"), py::arg("own_north_m") = 0.0, py::arg("own_east_m") = 0.0,
           py::arg("own_vnorth_mps") = 0.0, py::arg("own_veast_mps") = 0.0,
           py::arg("own_position_std_m") = 0.0, py::arg("heading_std_rad") = 0.0,
           R"(Take plots; those that are not finite are left out.

Parameters
----------
time_s : (n,) array or float
    By the radar's clock.
range_m, bearing_rad : (n,) array
    As measured.
own_north_m, own_east_m, own_vnorth_mps, own_veast_mps : (n,) array or float
    Own ship at the times of the plots as if these were true, as its own log gives it: the place
    where it was when the plot was taken is found with the time offset.
own_position_std_m, heading_std_rad : float
    Standard deviations of own ship's position per axis, and of its heading.

Raises
------
ValueError
    When a shape does not fit or a standard deviation is negative.)")
      .def("solve", &solve, "CalibrationResult from all that was given so far.")
      .def_property_readonly("radar", [](const PyCalibration& one) { return Radar(one.radar()); })
      .def_property_readonly(
          "config", [](const PyCalibration& one) { return CalibrationConfig(one.config()); })
      .def("_arguments", [](const PyCalibration& one) {
        return Arguments()
            .with("radar", Radar(one.radar()))
            .with("config", CalibrationConfig(one.config()));
      });
}

}  // namespace wakeline::python
