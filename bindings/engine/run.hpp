// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// `run`: whole recordings through an estimator, without Python between the steps.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "any_alpha_beta.hpp"
#include "any_lines.hpp"
#include "any_turn_grids.hpp"
#include "estimators.hpp"
#include "thread_share.hpp"
#include "wakeline/batch/run.hpp"

namespace wakeline::python {

class AnyModeHistory;

/// True for a multi-model estimator over filters composed at run time.
template <class>
inline constexpr bool kOverAnyFilters = false;
template <template <class> class Estimator>
inline constexpr bool kOverAnyFilters<Estimator<AnyFilterBank>> = true;

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
};

/// All runs, each begun with `belief_of(AnyBelief)`. Throws where one cannot start.
template <class Estimator, class Sensor, class BeliefOf = std::identity>
void run_all(const Estimator& prototype, const Sensor& sensor, const RunInput& in,
             const std::vector<AnyBelief>& starts, const RunOutput& out,
             const BeliefOf& belief_of = {}) {
  const ThreadShare threads(in.runs * in.scans);
  run_batch(
      [&](std::size_t run) {
        Estimator estimator = prototype;
        (void)estimator.start(belief_of(starts[starts.size() == 1 ? 0 : run]));
        return estimator;
      },
      sensor, in, out, Threads{threads.count()});
}

/// Throws FilterError where a run cannot start.
template <class Estimator>
void require_starts(Estimator estimator, const std::vector<AnyBelief>& starts) {
  for (std::size_t run = 0; run < starts.size(); ++run)
    if (const Status started = estimator.start(starts[run]); started != Status::kOk)
      throw FilterError("start of run " + std::to_string(run) + ": " + to_string(started));
}

/// All runs: by what sensor, of what readings, from where, and where the results go.
struct Runs {
  AnySensor sensor;
  const RunInput& in;
  const std::vector<AnyBelief>& starts;
  const RunOutput& out;
};

/// The runs in lanes of the widest instruction set of the processor. False, and nothing done, where
/// there is but one run or the estimator is not one that lanes are compiled for.
bool run_lanes(const AnyFilter& filter, const Runs& runs);
bool run_lanes(const AnyImm& imm, const Runs& runs);
bool run_lanes(const AnyAdaptiveGridImm& imm, const Runs& runs);
bool run_lanes(const AnySwitchingGridImm& imm, const Runs& runs);
bool run_lanes(const AnyLikelyModelSetImm& imm, const Runs& runs);
bool run_lanes(const AnyModeHistory& history, const Runs& runs);
bool run_lanes(const AnyBayesianAlphaBeta& lines, const Runs& runs);
bool run_lanes(const AnyFuzzyAlphaBeta& lines, const Runs& runs);
template <int Order>
bool run_lanes(const AnyAlphaBeta<Order>& filter, const Runs& runs);
template <class Estimator>
bool run_lanes(const Estimator&, const Runs&) {
  return false;
}

/// `run_all` of an estimator whose filters are all extended Kalman filters of known turn rates,
/// composed anew at compile time: the same bits, sooner. False, and nothing done, for any other.
template <class Estimator>
bool run_turns(const Estimator& prototype, const Runs& runs);

/// The beliefs that `start` means: one Gaussian for all runs or a sequence of R.
std::vector<AnyBelief> parse_starts(const py::object& start, std::size_t runs, int states);

/// The memory of an array (T, 2).
const double* per_scan(const char* name, const DoubleArray& array, std::size_t scans);

/// A scalar step or one per scan.
std::vector<double> parse_steps(const py::object& dt_s, std::size_t scans);

/// Throws where own ship moves under a sensor of range rates that takes her to be at rest.
template <class Sensor>
void require_own_velocity(const Sensor& sensor, const RunInput& in) {
  if constexpr (requires { sensor.range_rate_std_mps; }) {
    if (in.own_m == nullptr || in.own_mps != nullptr) return;
    if (sensor.own.vnorth_mps != 0.0 || sensor.own.veast_mps != 0.0) return;
    for (std::size_t k = 2; k < 2 * in.scans; ++k)
      if (in.own_m[k] != in.own_m[k - 2])
        throw py::value_error(
            "own_velocity_mps must be told where own_position_m moves and the sensor reads range "
            "rates, got None");
  }
}

/// All runs of an estimator, the soonest way there is.
struct RunSoonest {
  template <class Estimator, class Sensor>
  void operator()(const Estimator& prototype, const Sensor& sensor, const RunInput& in,
                  const std::vector<AnyBelief>& starts, const RunOutput& out) const {
    const Runs runs{sensor, in, starts, out};
    bool done = run_lanes(prototype, runs);
    if constexpr (kOverAnyFilters<Estimator>) done = done || run_turns(prototype, runs);
    if (!done) run_all(prototype, sensor, in, starts, out);
  }
};

template <class Estimator, class RunAll = RunSoonest>
RunResult run(const Estimator& prototype, const DoubleArray& z, const py::object& dt_s,
              const py::object& sensor, const py::object& start,
              const std::optional<DoubleArray>& own_position_m,
              const std::optional<DoubleArray>& own_velocity_mps,
              const std::optional<DoubleArray>& acceleration_mps2,
              const std::optional<RadiusGate>& gate) {
  return visit_sensor(sensor, [&]<class Sensor>(const Sensor& given) {
    constexpr int kM = Sensor::kMeasurements;
    require_linear<Sensor>(prototype);
    const Sensor model = given;  // as other threads may change both meanwhile
    const Estimator estimator = prototype;
    const bool many = z.ndim() == 3;
    require_shape((z.ndim() == 2 || many) && z.shape(z.ndim() - 1) == kM, "z",
                  "(T, " + std::to_string(kM) + ") or (R, T, " + std::to_string(kM) + ")", z);
    RunInput in;
    in.runs = many ? static_cast<std::size_t>(z.shape(0)) : 1;
    in.scans = static_cast<std::size_t>(z.shape(many ? 1 : 0));
    in.z = z.data();
    const std::vector<double> steps_s = parse_steps(dt_s, in.scans);
    in.dt_s = steps_s.data();
    const std::vector<AnyBelief> starts = parse_starts(start, in.runs, states_of(estimator));
    in.gate = gate ? &*gate : nullptr;
    const auto of_own_ship = [&](const char* name, const std::optional<DoubleArray>& array) {
      if constexpr (!requires { model.own; })
        if (array)
          throw py::value_error(std::string(name) + " must be None for a sensor without own ship");
      return array ? per_scan(name, *array, in.scans) : nullptr;
    };
    in.own_m = of_own_ship("own_position_m", own_position_m);
    in.own_mps = of_own_ship("own_velocity_mps", own_velocity_mps);
    require_own_velocity(model, in);
    if (acceleration_mps2)
      in.acceleration_mps2 = per_scan("acceleration_mps2", *acceleration_mps2, in.scans);

    const py::ssize_t states = states_of(prototype);
    const py::ssize_t models = models_of(prototype);
    std::vector<py::ssize_t> shape;
    if (many) shape.push_back(z.shape(0));
    shape.push_back(z.shape(many ? 1 : 0));
    const auto with = [&](std::initializer_list<py::ssize_t> more) {
      std::vector<py::ssize_t> extended = shape;
      extended.insert(extended.end(), more);
      return extended;
    };
    RunResult result{py::array_t<double>(with({states})),
                     py::array_t<double>(with({states, states})),
                     py::none(),
                     py::none(),
                     py::array_t<double>(with({kM})),
                     py::array_t<double>(shape),
                     py::array_t<double>(shape),
                     py::array_t<std::uint8_t>(shape)};
    py::array_t<double> modes(with({models}));
    if (models > 0) result.mode_probability = modes;
    py::array_t<double> rates(with({kHasTurnRates<Estimator> ? models : 0}));
    if (kHasTurnRates<Estimator>) result.turn_rate_rad_s = rates;
    const RunOutput out{static_cast<std::size_t>(states),
                        static_cast<std::size_t>(models),
                        result.mean.mutable_data(),
                        result.covariance.mutable_data(),
                        modes.mutable_data(),
                        rates.mutable_data(),
                        result.innovation.mutable_data(),
                        result.nis.mutable_data(),
                        result.log_likelihood.mutable_data(),
                        result.status.mutable_data()};
    {
      const py::gil_scoped_release release;
      require_starts(estimator, starts);
      RunAll{}(estimator, model, in, starts, out);
    }
    return result;
  });
}

const char* const kRunDoc = R"(Runs whole recordings.

Parameters
----------
z : (T, M) or (R, T, M) array
    Readings of one run or of R independent ones; a row of NaN is a missed scan.
dt_s : float or (T,) array
    Time before each reading, s; the first counts from the start.
sensor : RangeBearing, ConvertedRangeBearing, RangeBearingDoppler or Position
start : Gaussian or sequence of R of them
    Belief one step before the first reading, over the filter's state or over [x, vx, y, vy].
own_position_m : (T, 2) array, optional
    North and east of own ship at each reading.
own_velocity_mps : (T, 2) array, optional
    Her velocity over ground at each reading, which range rates are measured from.
acceleration_mps2 : (T, 2) array, optional
    Known acceleration, north and east, in the step before each reading.
gate : RadiusGate, optional
    A reading farther from the predicted position is missed.

Returns
-------
RunResult
    mean (..., T, N), covariance (..., T, N, N), innovation (..., T, M), nis, log_likelihood and
    status (..., T); mode_probability (..., T, K) of several models and turn_rate_rad_s (..., T, K)
    of models that change theirs, else None.

Raises
------
ValueError
    When a shape does not fit, or a sensor of range rates moves and its velocity is not told.
FilterError
    When an estimator cannot start. A step that fails later is marked in `status`: a reading that
    cannot be taken leaves the prediction, a `dt_s` that cannot leaves all as it was.)";

}  // namespace wakeline::python
