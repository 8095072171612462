// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "lanes/lanes.hpp"
#include "support/arguments.hpp"
#include "thread_share.hpp"

namespace wakeline::python {
namespace {

AnyBelief parse_start(const py::handle& item, StateLayout layout) {
  if (!py::isinstance<PyGaussian>(item))
    throw py::type_error("start must be a Gaussian or a sequence of them, got " + class_name(item));
  return to_start("start", item.cast<const PyGaussian&>(), layout);
}

/// Throws where own ship moves under a sensor of range rates that has it at rest.
void require_own_velocity(const ReadingSensor& any, const RunInput& in) {
  const bool without = visit_reading(any, [](const auto& sensor) {
    if constexpr (requires { sensor.range_rate_std_mps; })
      return sensor.own.vnorth_mps == 0.0 && sensor.own.veast_mps == 0.0;
    else
      return false;
  });
  if (!without || in.own_m == nullptr || in.own_mps != nullptr) return;
  for (std::size_t k = 2; k < 2 * in.scans; ++k)
    if (in.own_m[k] != in.own_m[k - 2])
      throw py::value_error(
          "own_velocity_mps is required where own_position_m moves and the sensor reads range "
          "rates, got None");
}

/// In lanes of the widest instruction set of the processor, by what `kernel` says of the module
/// for it. 0, and nothing done, where there are none for the recordings.
template <class Kernel>
int run_in_lanes(const Recordings& all, const Kernel& kernel) {
  const LaneKernels* kernels = lane_kernels();
  const auto* const any = std::get_if<AnySensor>(&all.sensor);
  if (kernels == nullptr || all.in.runs < 2 || any == nullptr) return 0;
  return visit_numbers(*any, [&]<int M>(const AnySensorOf<M>& sensor) {
    if constexpr (M == 2) {
      const ThreadShare threads(all.in.runs * all.in.scans /
                                static_cast<std::size_t>(kernels->lanes));
      const LaneRecordings recordings{sensor, all.in, all.starts, all.out, threads.count()};
      if (kernel(*kernels, recordings)) return kernels->lanes;
    }
    return 0;
  });
}

/// A filter and a linear sensor, as lanes ask for them.
class FilterSteps : public LinearSteps {
 public:
  FilterSteps(const AnyFilter& filter, const RuntimeSensor& sensor)
      : filter_(filter), sensor_(sensor) {}

  void matrices(double dt_s, AnyBelief::Covariance& f,
                AnyBelief::Covariance& q) const noexcept override {
    std::visit(
        [&]<class Filter>(const Filter& filter) {
          if constexpr (std::is_same_v<Filter, CustomFilter>) {
            f = filter.motion()->jacobian(filter.estimate().mean, dt_s);
            q = filter.motion()->process_noise(filter.estimate().mean, dt_s);
          } else if constexpr (kIsLinear<Filter>) {
            const auto step = step_matrices(filter.motion(), dt_s);
            f = step.f;
            q = step.q;
          }
        },
        filter_.variant());
  }

  Step<kMostNumbers> update(AnyBelief& belief,
                            const Vec<double, kMostNumbers>& z) const noexcept override {
    AnyFilter one = filter_;
    (void)one.assign(belief);
    const Step<kMostNumbers> step = one.update(sensor_, z);
    belief = one.estimate();
    return step;
  }

  /// True over a linear motion model.
  static bool are_of(const AnyFilter& any) {
    return std::visit(
        []<class Filter>(const Filter& filter) {
          if constexpr (std::is_same_v<Filter, CustomFilter>)
            return filter.motion()->linear();
          else
            return kIsLinear<Filter>;
        },
        any.variant());
  }

 private:
  template <class Filter>
  static constexpr bool kIsLinear = requires {
    requires LinearMotionModel<typename Filter::Motion>;
  };

  const AnyFilter& filter_;
  const RuntimeSensor& sensor_;
};

/// The same of whole readings of a `LinearSensor`.
int run_linear_in_lanes(const AnyFilter& filter, const Recordings& all) {
  const LaneKernels* kernels = lane_kernels();
  const auto* const sensor = std::get_if<RuntimeSensor>(&all.sensor);
  if (kernels == nullptr || all.in.runs < 2 || all.in.covariance != nullptr || sensor == nullptr ||
      sensor->custom() == nullptr || !sensor->linear() || !FilterSteps::are_of(filter))
    return 0;
  const int numbers = sensor->numbers();
  if (has_partial(all.in.z, all.in.runs * all.in.scans, static_cast<std::size_t>(numbers),
                  kMostNumbers))
    return 0;

  const FilterSteps steps(filter, *sensor);
  const StateRows& rows = rows_of(filter.layout());
  const StateRows reads = sensor->reads();
  const ReadingJacobian of_read = sensor->jacobian(AnyBelief::Mean::Zero(reads.states));
  ReadingJacobian h = ReadingJacobian::Zero(numbers, rows.states);
  for (int k = 0; k < reads.states; ++k)
    h.col(rows.row_of(reads.components[static_cast<std::size_t>(k)])) = of_read.col(k);
  std::vector<AnyBelief> starts;
  AnyFilter one = filter;
  for (const AnyBelief& start : all.starts) {
    (void)one.start(start);
    starts.push_back(one.estimate());
  }
  const ThreadShare threads(all.in.runs * all.in.scans / static_cast<std::size_t>(kernels->lanes));
  kernels->run_linear({steps, filter.layout(), h, sensor->custom()->noise(), all.in, starts,
                       all.out, threads.count()});
  return kernels->lanes;
}

/// In this thread alone where steps call Python, which other threads would wait for.
template <class Estimator>
int run_each(const Estimator& estimator, const Recordings& recordings) {
  if (calls_python(estimator) || calls_python(recordings.sensor)) {
    run_one_by_one(estimator, recordings, 1);
    return 0;
  }
  const ThreadShare threads(recordings.in.runs * recordings.in.scans);
  run_one_by_one(estimator, recordings, threads.count());
  return 1;
}

/// The readings of a `RuntimeSensor` in rows of `kMostNumbers`, whose place their innovations take.
struct PaddedReadings {
  const double* z;
  std::size_t rows, numbers;
  std::vector<double> padded;

  PaddedReadings(const double* z_, std::size_t rows_, std::size_t numbers_)
      : z(z_),
        rows(rows_),
        numbers(numbers_),
        padded(rows * kMostNumbers, std::numeric_limits<double>::quiet_NaN()) {
    for (std::size_t row = 0; row < rows; ++row)
      std::copy_n(z + row * numbers, numbers, padded.data() + row * kMostNumbers);
  }

  /// NaN for missing numbers.
  void write_innovation(double* to) const {
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t m = 0; m < numbers; ++m) {
        const std::size_t k = row * numbers + m;
        to[k] = z[k] == z[k] ? padded[row * kMostNumbers + m] : z[k];
      }
  }
};

/// "<RunResult: 500 runs of 250 scans, 4 states, 3 models>".
std::string result_text(const RunResult& result) {
  const auto extent = [](const py::array& array, int from_the_end) {
    return array.shape(array.ndim() - from_the_end);
  };
  std::string text = "<RunResult: ";
  if (result.mean.ndim() == 3) text += many(result.mean.shape(0), "run") + " of ";
  text += many(extent(result.mean, 2), "scan") + ", " + many(extent(result.mean, 1), "state");
  if (!result.mode_probability.is_none())
    text += ", " + many(extent(py::array(result.mode_probability), 1), "model");
  return text + ">";
}

}  // namespace

std::vector<AnyBelief> parse_starts(const py::object& start, std::size_t runs, StateLayout layout) {
  if (!py::isinstance<py::sequence>(start)) return {parse_start(start, layout)};
  std::vector<AnyBelief> beliefs;
  for (const py::handle item : start) beliefs.push_back(parse_start(item, layout));
  if (beliefs.size() != runs)
    throw py::value_error("start must be one Gaussian or one per run (" + std::to_string(runs) +
                          "), got " + std::to_string(beliefs.size()));
  return beliefs;
}

std::vector<double> parse_steps(const py::object& dt_s, std::size_t scans) {
  const DoubleArray array = dt_s.is_none() ? DoubleArray() : DoubleArray::ensure(dt_s);
  if (!array || dt_s.is_none())
    throw py::type_error("dt_s must be a number or an array, got " +
                         py::repr(dt_s).cast<std::string>());
  if (array.ndim() == 0) return std::vector<double>(scans, *array.data());
  require_shape(array.ndim() == 1 && array.shape(0) == static_cast<py::ssize_t>(scans), "dt_s",
                "() or " + shape_text({static_cast<py::ssize_t>(scans)}), array);
  return {array.data(), array.data() + scans};
}

const double* per_scan(const char* name, const DoubleArray& array, std::size_t scans) {
  const auto rows = static_cast<py::ssize_t>(scans);
  require_shape(array.ndim() == 2 && array.shape(0) == rows && array.shape(1) == 2, name,
                shape_text({rows, 2}), array);
  return array.data();
}

bool changes_per_prediction(const AnyEstimator& estimator) {
  const auto once = [](const auto& chain) {
    if (chain.continuous()) return false;
    const Eigen::MatrixXd one = chain.transition(1.0);
    return !(one * one).isApprox(one, 1e-9);
  };
  return std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.chain(); })
          return once(kind.chain());
        else if constexpr (requires { kind.variant(); })
          return std::visit([&](const auto& one) { return once(one.chain()); }, kind.variant());
        else
          return false;
      },
      estimator.variant());
}

void warn_of_steps(const AnyEstimator& estimator, const std::string& steps) {
  if (!changes_per_prediction(estimator)) return;
  const std::string text =
      "the ModeChain has no period, so that its modes change once per "
      "prediction whatever " +
      steps + ": give period_s, or use ModeChain.from_sojourn_s";
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

void AnyMixture::note_step(double dt_s) {
  if (warned_ || !(dt_s > 0.0)) return;
  if (first_step_s_ == 0.0) first_step_s_ = dt_s;
  if (!are_uneven(std::min(dt_s, first_step_s_), std::max(dt_s, first_step_s_))) return;
  warned_ = true;
  warn_of_steps(*this, "the steps, here " + number_text(first_step_s_) + " s and " +
                           number_text(dt_s) + " s");
}

void warn_of_uneven_steps(const AnyEstimator& estimator, const py::object& dt_s) {
  const DoubleArray steps = DoubleArray::ensure(dt_s);
  if (!steps || steps.size() < 2) return;
  const auto [shortest, longest] = std::minmax_element(steps.data(), steps.data() + steps.size());
  if (are_uneven(*shortest, *longest))
    warn_of_steps(estimator, "the steps, here of " + number_text(*shortest) + " s to " +
                                 number_text(*longest) + " s");
}

RunLayout run_layout(const AnyFilter& filter) { return {filter.layout(), 0, false}; }

RunLayout run_layout(const AnyEstimator& estimator) {
  return {estimator.estimate().layout, estimator.mode_probability().size(),
          estimator.turn_rates_rad_s().size() > 0};
}

void require_covariances(const DoubleArray& covariance, const DoubleArray& z) {
  std::vector<py::ssize_t> shape = shape_of(z);
  const py::ssize_t numbers = shape.back();
  shape.push_back(numbers);
  require_shape(shape_of(covariance) == shape, "covariance", shape_text(shape), covariance);
  for (py::ssize_t row = 0; row < z.size() / numbers; ++row) {
    const double* const reading = z.data() + row * numbers;
    if (std::all_of(reading, reading + numbers, [](double one) { return one != one; })) continue;
    const double* const c = covariance.data() + row * numbers * numbers;
    const auto at = [&](int i, int j) { return c[numbers * i + j]; };
    const auto rows = static_cast<int>(numbers);
    if (asymmetry(rows, at) || !RuntimeCholesky(rows, at).ok)
      throw py::value_error(
          "covariance must be symmetric positive definite, which that of reading " +
          std::to_string(row) + " is not");
  }
}

RunResult run_recordings(const RunLayout& layout, const RunArguments& arguments,
                         const ReadingSensor& sensor,
                         const std::function<int(const Recordings&)>& run_all) {
  const DoubleArray& z = arguments.z;
  const py::ssize_t numbers = visit_reading(sensor, []<class Sensor>(const Sensor& one) {
    if constexpr (DeclaresSizes<Sensor>)
      return py::ssize_t{Sensor::kMeasurements};
    else
      return py::ssize_t{one.numbers()};
  });
  const bool many = z.ndim() == 3;
  require_shape((z.ndim() == 2 || many) && z.shape(z.ndim() - 1) == numbers, "z",
                "(T, " + std::to_string(numbers) + ") or (R, T, " + std::to_string(numbers) + ")",
                z);
  RunInput in;
  in.runs = many ? static_cast<std::size_t>(z.shape(0)) : 1;
  in.scans = static_cast<std::size_t>(z.shape(many ? 1 : 0));
  in.z = z.data();
  const auto* const readings = std::get_if<RuntimeSensor>(&sensor);
  std::optional<PaddedReadings> padded;
  if (readings != nullptr) {
    padded.emplace(z.data(), in.runs * in.scans, static_cast<std::size_t>(numbers));
    in.z = padded->padded.data();
  }
  if (arguments.covariance) {
    require_covariances(*arguments.covariance, z);
    in.covariance = arguments.covariance->data();
  }
  const std::vector<double> steps_s = parse_steps(arguments.dt_s, in.scans);
  in.dt_s = steps_s.data();
  const std::vector<AnyBelief> starts = parse_starts(arguments.start, in.runs, layout.layout);
  if (arguments.gate) {
    in.gate = std::get_if<RadiusGate>(&*arguments.gate);
    in.nis_gate = std::get_if<ChiSquareGate>(&*arguments.gate);
    if (readings != nullptr && in.gate != nullptr)
      throw py::value_error(
          "gate must be a ChiSquareGate for readings that are not whole positions, or have their "
          "own covariance, got a RadiusGate");
  }
  if (arguments.reopen_after) {
    if (!arguments.gate) throw py::value_error("reopen_after needs a gate, got None");
    require(*arguments.reopen_after >= 1, "reopen_after", "at least 1", *arguments.reopen_after);
    in.reopen_after = *arguments.reopen_after;
  }
  const bool carried = visit_reading(sensor, [](const auto& one) {
    return requires { one.own; };
  });
  const auto of_own_ship = [&](const char* name, const std::optional<DoubleArray>& array) {
    if (array && !carried)
      throw py::value_error(std::string(name) + " must be None for a sensor without own ship");
    return array ? per_scan(name, *array, in.scans) : nullptr;
  };
  in.own_m = of_own_ship("own_position_m", arguments.own_position_m);
  in.own_mps = of_own_ship("own_velocity_mps", arguments.own_velocity_mps);
  require_own_velocity(sensor, in);
  if (arguments.acceleration_mps2)
    in.acceleration_mps2 = per_scan("acceleration_mps2", *arguments.acceleration_mps2, in.scans);

  const py::ssize_t states = states_of(layout.layout);
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
                   py::array_t<double>(with({numbers})),
                   py::array_t<double>(shape),
                   py::array_t<double>(shape),
                   py::array_t<std::uint8_t>(shape)};
  py::array_t<double> modes(with({layout.models}));
  if (layout.models > 0) result.mode_probability = modes;
  py::array_t<double> rates(with({layout.turn_rates ? layout.models : 0}));
  if (layout.turn_rates) result.turn_rate_rad_s = rates;
  const RunOutput out{static_cast<std::size_t>(states),
                      static_cast<std::size_t>(layout.models),
                      result.mean.mutable_data(),
                      result.covariance.mutable_data(),
                      modes.mutable_data(),
                      layout.turn_rates ? rates.mutable_data() : nullptr,
                      padded ? padded->padded.data() : result.innovation.mutable_data(),
                      result.nis.mutable_data(),
                      result.log_likelihood.mutable_data(),
                      result.status.mutable_data()};
  {
    const py::gil_scoped_release release;
    result.lanes = run_all({sensor, in, starts, out});
  }
  if (readings != nullptr) {
    raise_fault(*readings);
    padded->write_innovation(result.innovation.mutable_data());
  }
  return result;
}

int run_all(const AnyFilter& filter, const Recordings& recordings) {
  int lanes = run_in_lanes(recordings, [&](const LaneKernels& kernels, const LaneRecordings& all) {
    return kernels.run_filter(filter, all);
  });
  if (lanes == 0) lanes = run_linear_in_lanes(filter, recordings);
  return lanes > 0 ? lanes : run_each(filter, recordings);
}

int run_all(const AnyEstimator& estimator, const Recordings& recordings) {
  const int lanes =
      run_in_lanes(recordings, [&](const LaneKernels& kernels, const LaneRecordings& all) {
        if (const auto* imm = std::get_if<AnyImm>(&estimator.variant()))
          return kernels.run_imm(*imm, all);
        if (const auto* history = std::get_if<AnyModeHistory>(&estimator.variant()))
          return kernels.run_history(*history, all);
        return false;
      });
  return lanes > 0 ? lanes : run_each(estimator, recordings);
}

void define_run_result(py::module_& m) {
  py::class_<RunResult> result(
      m, "RunResult",
      "What `run` returns: arrays over scans, and over runs where there are several.");
  define_pickle(result, &RunResult::mean, &RunResult::covariance, &RunResult::mode_probability,
                &RunResult::turn_rate_rad_s, &RunResult::innovation, &RunResult::nis,
                &RunResult::log_likelihood, &RunResult::status, &RunResult::lanes);
  result.def_readonly("mean", &RunResult::mean, "(..., T, N)")
      .def_readonly("covariance", &RunResult::covariance, "(..., T, N, N)")
      .def_readonly("mode_probability", &RunResult::mode_probability,
                    "(..., T, K), None for a single filter")
      .def_readonly("turn_rate_rad_s", &RunResult::turn_rate_rad_s,
                    "(..., T, K), of the models in each scan, NaN for one at rest; None where they "
                    "do not change")
      .def_readonly("innovation", &RunResult::innovation,
                    "(..., T, M), measured minus predicted; NaN where there was no update")
      .def_readonly("nis", &RunResult::nis, "(..., T), NaN where there was no update")
      .def_readonly("log_likelihood", &RunResult::log_likelihood, "(..., T)")
      .def_readonly("status", &RunResult::status, "(..., T) values of Status")
      .def_readonly("lanes", &RunResult::lanes,
                    "how many filters were stepped side by side in one register: recordings, or "
                    "hypotheses of a ModeHistory; 1 for one after the other; 0 where steps called "
                    "Python")
      .def("__repr__", &result_text);
  // Of optional libraries, which only Python knows.
  const auto in_python = [](const char* function) {
    return [function](const py::object& self, const std::optional<DoubleArray>& time_s) {
      const py::object times = time_s ? py::object(*time_s) : py::none();
      return py::module_::import("wakeline._frames").attr(function)(self, times);
    };
  };
  result
      .def("to_pandas", in_python("run_table"), py::arg("time_s") = py::none(),
           R"(A `pandas.DataFrame` with a row per scan, and per run where there are several.

The index is the time of a scan, or its number without `time_s`, after the number of the run. The
columns are mean_1 to mean_N, std_1 to std_N (of the state), mode_1 to mode_K, turn_rate_1 to
turn_rate_K, innovation_1 to innovation_M, nis, log_likelihood and status.

Raises
------
ImportError
    When pandas is not installed.
ValueError
    When `time_s` does not have one time per scan.)")
      .def("to_xarray", in_python("run_dataset"), py::arg("time_s") = py::none(),
           R"(An `xarray.Dataset` of all arrays, with dimensions run, scan, state, mode and reading.

The coordinate of scan is `time_s`, where given.

Raises
------
ImportError
    When xarray is not installed.
ValueError
    When `time_s` does not have one time per scan.)");
}

}  // namespace wakeline::python
