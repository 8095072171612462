// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/filter/rts_smoother.hpp"

#include "support/call_text.hpp"
#include "face.hpp"

namespace wakeline::python {

std::vector<AnyBelief> parse_starts(const py::object& start, std::size_t runs, int states) {
  const auto one = [&](const py::handle& item) {
    if (!py::isinstance<PyGaussian>(item))
      throw py::type_error("start must be a Gaussian or a sequence of them, got " +
                           py::str(py::type::of(item).attr("__name__")).cast<std::string>());
    return to_start("start", item.cast<const PyGaussian&>(), states);
  };
  if (!py::isinstance<py::sequence>(start)) return {one(start)};
  std::vector<AnyBelief> beliefs;
  for (const py::handle item : start) beliefs.push_back(one(item));
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

namespace {

// One Python class a filter, all over the same run-time composed filter.
struct PyKalman : AnyFilter {
  template <class Motion>
  explicit PyKalman(const Motion& motion) : AnyFilter(Ekf<Motion>(motion), true) {}
};
struct PyEkf : AnyFilter {
  template <class Motion>
  explicit PyEkf(const Motion& motion) : AnyFilter(Ekf<Motion>(motion)) {}
};
struct PyUkf : AnyFilter {
  template <class Motion>
  PyUkf(const Motion& motion, double alpha, double beta, double kappa)
      : AnyFilter(Ukf<Motion>(motion, Unscented{alpha, beta, kappa})) {}
};
struct PySquareRootUkf : AnyFilter {
  template <class Motion>
  PySquareRootUkf(const Motion& motion, double alpha, double beta, double kappa)
      : AnyFilter(SquareRootUkf<Motion>(motion, Unscented{alpha, beta, kappa})) {}
};

template <class Filter, class... Motions>
void define_plain(py::class_<Filter, AnyFilter>& filter) {
  define_copies(filter);
  (filter.def(py::init<const Motions&>(), py::arg("motion")), ...);
}

template <class Filter, class... Motions>
void define_unscented(py::class_<Filter, AnyFilter>& filter) {
  define_copies(filter);
  (filter.def(py::init<const Motions&, double, double, double>(), py::arg("motion"), py::kw_only(),
              py::arg("alpha") = Unscented{}.alpha, py::arg("beta") = Unscented{}.beta,
              py::arg("kappa") = Unscented{}.kappa),
   ...);
}

template <class Motion>
const char* class_of(const Ekf<Motion>&, bool linear) {
  return linear ? "Kalman" : "Ekf";
}
template <class Motion>
const char* class_of(const Ukf<Motion>&, bool) {
  return "Ukf";
}
template <class Motion>
const char* class_of(const SquareRootUkf<Motion>&, bool) {
  return "SquareRootUkf";
}

std::string filter_text(const AnyFilter& any) {
  return std::visit(
      [&](const auto& filter) {
        CallText call(class_of(filter, any.linear()));
        call.with("motion", filter.motion());
        if constexpr (requires { filter.unscented(); })
          call.with("alpha", filter.unscented().alpha)
              .with("beta", filter.unscented().beta)
              .with("kappa", filter.unscented().kappa);
        return call.text();
      },
      any.variant());
}

/// A plot that there is.
template <int M>
Vec<double, M> to_plot(const char* name, const DoubleArray& array) {
  const Vec<double, M> plot = to_vector<M>(name, array);
  for (const double number : plot) require_finite(name, number);
  return plot;
}

/// RTS smoothing of arrays (T, N) and (T, N, N).
py::tuple smooth_arrays(const AnyFilter& filter, const DoubleArray& mean,
                        const DoubleArray& covariance, const py::object& dt_s,
                        const std::optional<DoubleArray>& acceleration_mps2) {
  const py::ssize_t states = states_of(filter.layout());
  require_shape(mean.ndim() == 2 && mean.shape(1) == states, "mean",
                "(T, " + std::to_string(states) + ")", mean);
  const py::ssize_t scans = mean.shape(0);
  require_shape(covariance.ndim() == 3 && covariance.shape(0) == scans &&
                    covariance.shape(1) == states && covariance.shape(2) == states,
                "covariance", shape_text({scans, states, states}), covariance);
  const std::vector<double> steps = parse_steps(dt_s, static_cast<std::size_t>(scans));
  std::vector<Vec<double, 2>> known;
  if (acceleration_mps2) {
    const double* number = per_scan("acceleration_mps2", *acceleration_mps2, steps.size());
    for (std::size_t k = 0; k < steps.size(); ++k, number += 2)
      known.emplace_back(number[0], number[1]);
  }
  py::array_t<double> smooth_mean({scans, states});
  py::array_t<double> smooth_covariance({scans, states, states});
  if (scans == 0) return py::make_tuple(smooth_mean, smooth_covariance);
  std::visit(
      [&]<class Filter>(const Filter& model) {
        constexpr int kN = Filter::kStates;
        using RowMajor = Eigen::Matrix<double, kN, kN, Eigen::RowMajor>;
        std::vector<Gaussian<kN>> beliefs(static_cast<std::size_t>(scans));
        for (std::size_t k = 0; k < beliefs.size(); ++k) {
          beliefs[k].mean = Eigen::Map<const Vec<double, kN>>(mean.data() + k * kN);
          beliefs[k].covariance = Eigen::Map<const RowMajor>(covariance.data() + k * kN * kN);
        }
        {
          const py::gil_scoped_release release;
          require_ok(
              smooth_as(model, model.motion(), beliefs, std::span<const double>(steps).subspan(1),
                        std::span<const Vec<double, 2>>(known).subspan(known.empty() ? 0 : 1)),
              "smooth");
        }
        for (std::size_t k = 0; k < beliefs.size(); ++k) {
          Eigen::Map<Vec<double, kN>>(smooth_mean.mutable_data() + k * kN) = beliefs[k].mean;
          Eigen::Map<RowMajor>(smooth_covariance.mutable_data() + k * kN * kN) =
              beliefs[k].covariance;
        }
      },
      filter.variant());
  return py::make_tuple(smooth_mean, smooth_covariance);
}

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

void define_filter(py::module_& parent) {
  py::module_ m = parent.def_submodule("filter", "Estimators with one motion model.");

  py::class_<RunResult>(
      m, "RunResult",
      "What `run` returns: arrays over scans, and over runs where there are several.")
      .def_readonly("mean", &RunResult::mean, "(..., T, N)")
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
      .def(py::pickle(
          [](const RunResult& r) {
            return py::make_tuple(r.mean, r.covariance, r.mode_probability, r.turn_rate_rad_s,
                                  r.innovation, r.nis, r.log_likelihood, r.status);
          },
          [](const py::tuple& fields) {
            using Array = py::array_t<double>;
            return RunResult{fields[0].cast<Array>(),
                             fields[1].cast<Array>(),
                             fields[2],
                             fields[3],
                             fields[4].cast<Array>(),
                             fields[5].cast<Array>(),
                             fields[6].cast<Array>(),
                             fields[7].cast<py::array_t<std::uint8_t>>()};
          }))
      .def("__repr__", &result_text);

  py::class_<AnyFilter> filter(m, "Filter", "What Kalman, Ekf, Ukf and SquareRootUkf share.");
  define_face(filter);
  filter.def("__repr__", &filter_text);
  filter.def("smooth", &smooth_arrays, py::arg("mean"), py::arg("covariance"), py::arg("dt_s"),
             py::arg("acceleration_mps2") = py::none(),
             R"(Rauch-Tung-Striebel smoother over the results of `run`.

Parameters
----------
mean : (T, N) array
covariance : (T, N, N) array
dt_s : float or (T,) array
acceleration_mps2 : (T, 2) array, optional
    As for `run`.

Returns
-------
(mean, covariance)
    Smoothed, same shapes.

Raises
------
ValueError
    When a shape does not fit.
FilterError
    When a covariance is not positive definite, a number not finite or a step below zero.)");

  py::class_<PyKalman, AnyFilter> kalman(
      m, "Kalman", "The Kalman filter: linear motion and linear sensors, nothing approximated.");
  define_plain<PyKalman, ConstantVelocity, ConstantAcceleration, CoordinatedTurn, Singer>(kalman);
  py::class_<PyEkf, AnyFilter> ekf(
      m, "Ekf", "The extended Kalman filter: motion and sensor linearised about the mean.");
  define_plain<PyEkf, ConstantVelocity, ConstantAcceleration, CoordinatedTurn, CoordinatedTurnRate,
               Singer, WanderingCourse>(ekf);
  py::class_<PyUkf, AnyFilter> ukf(
      m, "Ukf", "The unscented Kalman filter, with the scaled transform's alpha, beta and kappa.");
  define_unscented<PyUkf, ConstantVelocity, ConstantAcceleration, CoordinatedTurn,
                   CoordinatedTurnRate, Singer, WanderingCourse>(ukf);
  py::class_<PySquareRootUkf, AnyFilter> square_root(
      m, "SquareRootUkf",
      "The unscented Kalman filter on a square root of the covariance, for long runs.");
  define_unscented<PySquareRootUkf, ConstantVelocity, ConstantAcceleration, CoordinatedTurn,
                   CoordinatedTurnRate, Singer, WanderingCourse>(square_root);

  m.def(
      "one_point",
      [](const py::object& sensor, const DoubleArray& z, double speed_std_mps) {
        return visit_sensor(sensor, [&]<class Sensor>(const Sensor& model) {
          constexpr int kM = Sensor::kMeasurements;
          require_positive("speed_std_mps", speed_std_mps);
          return PyGaussian::from(one_point(model, to_plot<kM>("z", z), speed_std_mps));
        });
      },
      py::arg("sensor"), py::arg("z"), py::arg("speed_std_mps"),
      "Start over [x, vx, y, vy] from one plot and a velocity of zero with that standard deviation "
      "per axis.");
  m.def(
      "two_point",
      [](const py::object& sensor, const DoubleArray& first, const DoubleArray& second,
         double dt_s) {
        require_positive("dt_s", dt_s);
        return visit_sensor(sensor, [&]<class Sensor>(const Sensor& model) {
          constexpr int kM = Sensor::kMeasurements;
          return PyGaussian::from(two_point<Sensor, double>(model, to_plot<kM>("first", first),
                                                            to_plot<kM>("second", second), dt_s));
        });
      },
      py::arg("sensor"), py::arg("first"), py::arg("second"), py::arg("dt_s"),
      "Start over [x, vx, y, vy] from two plots dt_s apart. The own ship of the sensor is where "
      "the second one was taken, to which it has come at its velocity.");

  define_alpha_beta(m);
  define_smoothers(m);
}

}  // namespace wakeline::python
