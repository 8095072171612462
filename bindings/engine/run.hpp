// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// `run`: whole recordings through an estimator, without Python between the steps.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "estimators.hpp"

namespace wakeline::python {

/// Arrays (..., T, ...) of one or R runs.
struct RunResult {
  py::array_t<double> mean;
  py::array_t<double> covariance;
  py::object mode_probability;  ///< None for a single filter
  py::object turn_rate_rad_s;   ///< None where no model changes its turn rate
  py::array_t<double> innovation;
  py::array_t<double> nis;
  py::array_t<double> log_likelihood;
  py::array_t<std::uint8_t> status;
  int lanes = 1;
};

/// The arguments of `run` as Python gives them.
struct RunArguments {
  DoubleArray z;
  py::object dt_s;
  py::object sensor;
  py::object start;
  std::optional<DoubleArray> own_position_m;
  std::optional<DoubleArray> own_velocity_mps;
  std::optional<DoubleArray> acceleration_mps2;
  std::optional<std::variant<RadiusGate, ChiSquareGate>> gate;
  std::optional<int> reopen_after;
  std::optional<DoubleArray> covariance;
};

/// Of an estimator, what `run` allocates its results by.
struct RunLayout {
  StateLayout layout;
  py::ssize_t models;  ///< 0 of a single filter
  bool turn_rates;     ///< models change theirs
};

RunLayout run_layout(const AnyFilter& filter);
RunLayout run_layout(const AnyEstimator& estimator);

/// Reads the arguments, allocates the results and calls `run_all`, which returns the lanes that it
/// took. Raises what a function of the sensor has raised.
RunResult run_recordings(const RunLayout& layout, const RunArguments& arguments,
                         const ReadingSensor& sensor,
                         const std::function<int(const Recordings&)>& run_all);

/// In lanes where the estimator has them for the sensor, else one after the other; returns the
/// number of lanes.
int run_all(const AnyFilter& filter, const Recordings& recordings);
int run_all(const AnyEstimator& estimator, const Recordings& recordings);

/// Throws FilterError where a run cannot start.
template <class Estimator>
void require_starts(Estimator estimator, const std::vector<AnyBelief>& starts) {
  for (std::size_t run = 0; run < starts.size(); ++run)
    if (const Status started = estimator.start(starts[run]); started != Status::kOk)
      throw FilterError("start of run " + std::to_string(run) + ": " + to_string(started));
}

/// Warns where the steps are uneven and the estimator's modes change once per prediction.
void warn_of_uneven_steps(const AnyEstimator& estimator, const py::object& dt_s);

template <class Estimator>
RunResult run(const Estimator& prototype, const RunArguments& arguments) {
  if constexpr (std::is_base_of_v<AnyEstimator, Estimator>)
    warn_of_uneven_steps(prototype, arguments.dt_s);
  const Estimator estimator = prototype;  // as another thread may change it meanwhile
  const ReadingSensor sensor =
      to_reading_sensor(estimator, arguments.sensor, arguments.z, arguments.covariance.has_value());
  RunResult result =
      run_recordings(run_layout(estimator), arguments, sensor, [&](const Recordings& recordings) {
        require_starts(estimator, recordings.starts);
        return run_all(estimator, recordings);
      });
  raise_fault(estimator);
  return result;
}

/// The beliefs that `start` means: one Gaussian for all runs or a sequence of R.
std::vector<AnyBelief> parse_starts(const py::object& start, std::size_t runs, StateLayout layout);

/// The memory of an array (T, 2).
const double* per_scan(const char* name, const DoubleArray& array, std::size_t scans);

/// A scalar step or one per scan.
std::vector<double> parse_steps(const py::object& dt_s, std::size_t scans);

/// Adds `name`, which has the arguments of `run` and calls `function(estimator, arguments)`.
template <class Estimator, class... Options, class Function>
void define_run(py::class_<Estimator, Options...>& face, const char* name, const Function& function,
                const char* doc) {
  face.def(
      name,
      [function](const Estimator& estimator, const DoubleArray& z, const py::object& dt_s,
                 const py::object& sensor, const py::object& start,
                 const std::optional<DoubleArray>& own_position_m,
                 const std::optional<DoubleArray>& own_velocity_mps,
                 const std::optional<DoubleArray>& acceleration_mps2,
                 const std::optional<std::variant<RadiusGate, ChiSquareGate>>& gate,
                 const std::optional<int>& reopen_after,
                 const std::optional<DoubleArray>& covariance) {
        return function(estimator, {z, dt_s, sensor, start, own_position_m, own_velocity_mps,
                                    acceleration_mps2, gate, reopen_after, covariance});
      },
      py::arg("z"), py::arg("dt_s"), py::arg("sensor"), py::arg("start"),
      py::arg("own_position_m") = py::none(), py::arg("own_velocity_mps") = py::none(),
      py::arg("acceleration_mps2") = py::none(), py::arg("gate") = py::none(),
      py::arg("reopen_after") = py::none(), py::arg("covariance") = py::none(), doc);
}

/// Adds `RunResult`.
void define_run_result(py::module_& m);

const char* const kRunDoc = R"(Run whole recordings.

Parameters
----------
z : (T, M) or (R, T, M) array
    Readings of one run or of R independent runs; a row of NaN is a missed scan. Of a row with some
    NaN the other numbers are used, by a filter and an Imm, with the plot as range and bearing.
dt_s : float or (T,) array
    Time before each reading, s; the first counts from the start.
sensor : RangeBearing, ConvertedRangeBearing, RangeBearingDoppler or Position
    Of a filter and an Imm also Bearing, Range, LinearSensor or FunctionSensor.
start : Gaussian or sequence of R of them
    Belief one step before the first reading, over the filter's state or over [x, vx, y, vy].
own_position_m : (T, 2) array, optional
    North and east of own ship at each reading.
own_velocity_mps : (T, 2) array, optional
    Its velocity over ground at each reading, which range rates are measured from.
acceleration_mps2 : (T, 2) array, optional
    Known acceleration, north and east, in the step before each reading.
gate : RadiusGate or ChiSquareGate, optional
    A reading outside is not used, and its status is `gated`: outside the circle about the predicted
    position, or with a larger normalized innovation squared (`nis`) than the ellipsoid's.
reopen_after : int, optional
    After so many readings outside the gate in a row, all are used until one is inside again: the
    target is elsewhere, not its readings. Default: never.
covariance : (T, M, M) or (R, T, M, M) array, optional
    Covariance of each reading, instead of the sensor's: of a filter and an Imm.

Returns
-------
RunResult
    mean (..., T, N), covariance (..., T, N, N), innovation (..., T, M), nis, log_likelihood and
    status (..., T); mode_probability (..., T, K) of multiple-model estimators and turn_rate_rad_s
    (..., T, K) of adaptive turn rates, else None. lanes: how many filters were stepped side by side in
    one register: recordings of a filter or an Imm, hypotheses of a ModeHistory. Those of a
    LinearMotion need the states of a linear model of the engine, and zeros in F where that has
    them; or, of a single filter, a LinearSensor and no covariance of each reading. It is 1 for a
    single recording, readings that lack a part, any other sensor than of a whole position and every
    other estimator, and 0 where each step calls functions in Python, which takes a hundred times as
    long.

Raises
------
ValueError
    When a shape does not fit, a covariance is not symmetric positive definite, the sensor reads
    what the state does not have, a sensor of range rates moves without `own_velocity_mps`, or
    `reopen_after` is without a gate or less than 1.
FilterError
    When an estimator cannot start. A later step that fails is reported in `status`: an invalid
    reading leaves the prediction, an invalid `dt_s` leaves the belief unchanged.)";

}  // namespace wakeline::python
