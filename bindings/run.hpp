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

#include "estimators.hpp"
#include "wakeline/gating/radius_gate.hpp"

namespace wakeline::python {

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

/// The measurements, steps and own positions of all runs, as plain memory.
struct RunInput {
  std::size_t runs, scans, measurements;
  const double* z;
  std::vector<double> dt_s;              ///< (T)
  const double* own = nullptr;           ///< (T, 2) or null
  const double* acceleration = nullptr;  ///< (T, 2) or null
  std::vector<AnyBelief> start;          ///< 1 or R
  std::optional<RadiusGate> gate;        ///< a reading outside is missed
};

template <class Sensor>
Sensor seen_from(const Sensor& sensor, const double* own) noexcept {
  Sensor moved = sensor;
  if constexpr (requires { moved.own; }) {
    if (own != nullptr) {
      moved.own.north_m = own[0];
      moved.own.east_m = own[1];
    }
  }
  return moved;
}

/// North and east of an estimate in any layout.
template <class Belief>
Vec<double, 2> position_of(const Belief& belief) noexcept {
  return {belief.mean[0], belief.mean[belief.mean.size() == 6 ? 3 : 2]};
}

/// True when the estimate expects the reading within the gate, or there is none.
template <class Estimator, class Sensor>
bool within(const std::optional<RadiusGate>& gate, const Estimator& estimator, const Sensor& sensor,
            const Vec<double, Sensor::kMeasurements>& z) noexcept {
  return !gate ||
         gate->contains<double>(position_of(estimator.estimate()), sensor.position(z).mean);
}

/// Memory of the results, `states` and `models` to a scan.
struct RunOutput {
  std::size_t states, models;
  double *mean, *covariance, *modes, *rates, *innovation, *nis, *log_likelihood;
  std::uint8_t* status;
};

template <class Estimator, class Sensor>
void run_one(Estimator& estimator, const Sensor& sensor, const RunInput& in, std::size_t run,
             const RunOutput& out) noexcept {
  constexpr int kM = Sensor::kMeasurements;
  const auto [states, models] = std::pair(out.states, out.models);
  for (std::size_t scan = 0; scan < in.scans; ++scan) {
    const std::size_t row = run * in.scans + scan;
    const Vec<double, kM> z = Eigen::Map<const Vec<double, kM>>(in.z + row * kM);
    std::optional<Vec<double, 2>> acceleration;
    if (in.acceleration != nullptr)
      acceleration = Vec<double, 2>(in.acceleration[2 * scan], in.acceleration[2 * scan + 1]);
    Status status = predict(estimator, in.dt_s[scan], acceleration);
    double nis = std::numeric_limits<double>::quiet_NaN();
    double log_likelihood = nis;
    Vec<double, kM> innovation = Vec<double, kM>::Constant(nis);
    if (status == Status::kOk) {
      const Sensor seen = seen_from(sensor, in.own ? in.own + 2 * scan : nullptr);
      if (z.array().isNaN().all() || !within(in.gate, estimator, seen, z)) {
        status = Status::kMissed;
      } else {
        const auto step = estimator.update(seen, z);
        status = step.status;
        if (step) {
          // Some take no more than the position out of a reading.
          innovation.template head<decltype(step.innovation)::RowsAtCompileTime>() =
              step.innovation;
          nis = step.nis;
          log_likelihood = step.log_likelihood;
        }
      }
    }
    const auto belief = estimator.estimate();
    for (std::size_t i = 0; i < states; ++i) {
      const auto a = static_cast<Eigen::Index>(i);
      out.mean[row * states + i] = belief.mean[a];
      for (std::size_t j = 0; j < states; ++j)
        out.covariance[(row * states + i) * states + j] =
            belief.covariance(a, static_cast<Eigen::Index>(j));
    }
    for (std::size_t k = 0; k < models; ++k) {
      const auto mode = static_cast<Eigen::Index>(k);
      if constexpr (requires { estimator.mode_probability(); })
        out.modes[row * models + k] = estimator.mode_probability()[mode];
      if constexpr (kHasTurnRates<Estimator>)
        out.rates[row * models + k] = estimator.turn_rates_rad_s()[mode];
    }
    Eigen::Map<Vec<double, kM>>(out.innovation + row * kM) = innovation;
    out.nis[row] = nis;
    out.log_likelihood[row] = log_likelihood;
    out.status[row] = static_cast<std::uint8_t>(status);
  }
}

/// All runs, one after the other, each begun with `belief_of(AnyBelief)`. Throws where one cannot
/// start.
template <class Estimator, class Sensor, class BeliefOf = std::identity>
void run_all(Estimator estimator, const Sensor& sensor, const RunInput& in, const RunOutput& out,
             const BeliefOf& belief_of = {}) {
  for (std::size_t r = 0; r < in.runs; ++r) {
    const Status started = estimator.start(belief_of(in.start[in.start.size() == 1 ? 0 : r]));
    if (started != Status::kOk)
      throw FilterError("start of run " + std::to_string(r) + ": " + to_string(started));
    run_one(estimator, sensor, in, r, out);
  }
}

/// `run_all` of an estimator whose filters are all extended Kalman filters of known turn rates,
/// composed anew at compile time: the same bits, sooner. False, and nothing done, for any other.
template <class Estimator>
bool run_turns(const Estimator& prototype, const AnySensor& sensor, const RunInput& in,
               const RunOutput& out);

/// The beliefs that `start` means: one Gaussian for all runs or a sequence of R.
std::vector<AnyBelief> parse_starts(const py::object& start, std::size_t runs, int states);

/// The memory of an array (T, 2).
const double* per_scan(const char* name, const DoubleArray& array, std::size_t scans);

/// A scalar step or one per scan.
std::vector<double> parse_steps(const py::object& dt_s, std::size_t scans);

template <class Estimator>
RunResult run(const Estimator& prototype, const DoubleArray& z, const py::object& dt_s,
              const py::object& sensor, const py::object& start,
              const std::optional<DoubleArray>& own_position_m,
              const std::optional<DoubleArray>& acceleration_mps2,
              const std::optional<RadiusGate>& gate) {
  return visit_sensor(sensor, [&]<class Sensor>(const Sensor& model) {
    constexpr int kM = Sensor::kMeasurements;
    require_linear<Sensor>(prototype);
    const bool many = z.ndim() == 3;
    require_shape((z.ndim() == 2 || many) && z.shape(z.ndim() - 1) == kM, "z",
                  "(T, " + std::to_string(kM) + ") or (R, T, " + std::to_string(kM) + ")", z);
    RunInput in{};
    in.runs = many ? static_cast<std::size_t>(z.shape(0)) : 1;
    in.scans = static_cast<std::size_t>(z.shape(many ? 1 : 0));
    in.measurements = kM;
    in.z = z.data();
    in.dt_s = parse_steps(dt_s, in.scans);
    in.start = parse_starts(start, in.runs, states_of(prototype));
    in.gate = gate;
    if (own_position_m) {
      if constexpr (!requires { model.own; })
        throw py::value_error("own_position_m must be None for a sensor without own ship");
      in.own = per_scan("own_position_m", *own_position_m, in.scans);
    }
    if (acceleration_mps2)
      in.acceleration = per_scan("acceleration_mps2", *acceleration_mps2, in.scans);

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
      bool done = false;
      if constexpr (kOverAnyFilters<Estimator>) done = run_turns(prototype, model, in, out);
      if (!done) run_all(prototype, model, in, out);
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
acceleration_mps2 : (T, 2) array, optional
    Known acceleration, north and east, in the step before each reading.
gate : RadiusGate, optional
    A reading farther from the predicted position is missed.

Returns
-------
RunResult
    mean (..., T, N), covariance (..., T, N, N), mode_probability and turn_rate_rad_s (..., T, K),
    innovation (..., T, M), nis, log_likelihood and status (..., T).

Raises
------
ValueError
    When a shape does not fit.
FilterError
    When an estimator cannot start. A step that fails later is marked in `status` and changes nothing.)";

}  // namespace wakeline::python
