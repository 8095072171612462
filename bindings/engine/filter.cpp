// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "face.hpp"
#include "support/types.hpp"
#include "wakeline/catalog/imm_smoother.hpp"

namespace wakeline {

// Compiled in imm_smoother.cpp.
extern template Status smooth_any_pair(const AnyFilter&, AnyBelief&, const AnyBelief&, double,
                                       std::span<const Vec<double, 2>>) noexcept;

}  // namespace wakeline

namespace wakeline::python {

namespace {

// One Python class a filter, all over the same run-time composed filter.
struct PyKalman : AnyFilter {};
struct PyEkf : AnyFilter {};
struct PyUkf : AnyFilter {};
struct PySquareRootUkf : AnyFilter {};

/// A motion model of the catalogue or a custom one.
template <class MotionList>
struct OrCustom;
template <class... Motion>
struct OrCustom<TypeList<Motion...>> {
  using Type = std::variant<Motion..., std::shared_ptr<PyMotion>>;
};
using MotionArgument = OrCustom<Motions>::Type;

/// Calls `of_catalog` or `of_custom` with a motion model.
template <class OfCatalog, class OfCustom>
AnyFilter filter_over(const MotionArgument& motion, const OfCatalog& of_catalog,
                      const OfCustom& of_custom) {
  return std::visit(
      [&]<class Motion>(const Motion& model) -> AnyFilter {
        if constexpr (std::is_same_v<Motion, std::shared_ptr<PyMotion>>)
          return of_custom(model);
        else
          return of_catalog(model);
      },
      motion);
}

/// A filter over a motion model, without other parameters.
template <class PyFilter, class Make>
void define_plain(py::class_<PyFilter, AnyFilter>& filter, const Make& make) {
  define_copies(filter);
  filter.def(py::init([make](const MotionArgument& motion) { return PyFilter{make(motion)}; }),
             py::arg("motion"));
}

/// One with the parameters of the unscented transform.
template <class SomeMotion, class PyFilter, class Make>
void define_unscented(py::class_<PyFilter, AnyFilter>& filter, const Make& make) {
  define_copies(filter);
  filter.def(py::init([make](const SomeMotion& motion, double alpha, double beta, double kappa) {
               return PyFilter{make(motion, Unscented{alpha, beta, kappa})};
             }),
             py::arg("motion"), py::kw_only(), py::arg("alpha") = Unscented{}.alpha,
             py::arg("beta") = Unscented{}.beta, py::arg("kappa") = Unscented{}.kappa);
}

Arguments filter_arguments(const AnyFilter& any) {
  return std::visit(
      []<class Filter>(const Filter& filter) {
        Arguments arguments;
        arguments.with("motion", filter.motion());
        if constexpr (std::is_same_v<Filter, CustomFilter>) {
          if (const Unscented* const unscented = filter.unscented())
            arguments.with("alpha", unscented->alpha)
                .with("beta", unscented->beta)
                .with("kappa", unscented->kappa);
        } else if constexpr (requires { filter.unscented(); })
          arguments.with("alpha", filter.unscented().alpha)
              .with("beta", filter.unscented().beta)
              .with("kappa", filter.unscented().kappa);
        return arguments;
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
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::vector<AnyBelief> beliefs;
  for (py::ssize_t k = 0; k < scans; ++k)
    beliefs.push_back(
        {filter.layout(), Eigen::Map<const Eigen::VectorXd>(mean.data() + k * states, states),
         Eigen::Map<const RowMajor>(covariance.data() + k * states * states, states, states)});
  {
    const py::gil_scoped_release release;
    for (std::size_t k = beliefs.size(); k-- > 1;) {
      const auto pushed = std::span<const Vec<double, 2>>(known).subspan(known.empty() ? 0 : k,
                                                                         known.empty() ? 0 : 1);
      const Status status = smooth_any_pair(filter, beliefs[k - 1], beliefs[k], steps[k], pushed);
      raise_fault(filter);
      require_ok(status, "smooth");
    }
  }
  for (py::ssize_t k = 0; k < scans; ++k) {
    const AnyBelief& belief = beliefs[static_cast<std::size_t>(k)];
    Eigen::Map<Eigen::VectorXd>(smooth_mean.mutable_data() + k * states, states) = belief.mean;
    Eigen::Map<RowMajor>(smooth_covariance.mutable_data() + k * states * states, states, states) =
        belief.covariance;
  }
  return py::make_tuple(smooth_mean, smooth_covariance);
}

/// The Python class of a filter.
template <class Motion>
py::object as_python(const AnyFilter& any, const Ekf<Motion>&) {
  return any.linear() ? py::cast(PyKalman{any}) : py::cast(PyEkf{any});
}
template <class Motion>
py::object as_python(const AnyFilter& any, const Ukf<Motion>&) {
  return py::cast(PyUkf{any});
}
template <class Motion>
py::object as_python(const AnyFilter& any, const SquareRootUkf<Motion>&) {
  return py::cast(PySquareRootUkf{any});
}
py::object as_python(const AnyFilter& any, const CustomFilter& filter) {
  if (filter.unscented() != nullptr) return py::cast(PyUkf{any});
  return any.linear() ? py::cast(PyKalman{any}) : py::cast(PyEkf{any});
}
py::object as_python(const AnyFilter&, const AlphaBeta<>& filter) {
  return py::cast(PyEstimator<AlphaBeta<>>(filter));
}

}  // namespace

py::object AsPython<AnyFilter>::of(const AnyFilter& any) {
  return std::visit([&](const auto& filter) { return as_python(any, filter); }, any.variant());
}

void define_filter(py::module_& parent) {
  py::module_ m = parent.def_submodule("filter", "Estimators with one motion model.");

  define_run_result(m);

  py::class_<AnyFilter> filter(m, "Filter", "Common base of Kalman, Ekf, Ukf and SquareRootUkf.");
  define_face(filter);
  filter.def("_arguments", &filter_arguments);
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
    When a covariance is not positive definite, a number not finite or a step negative.)");

  py::class_<PyKalman, AnyFilter> kalman(
      m, "Kalman", "The Kalman filter: exact for linear motion and linear sensors.");
  const auto reject_nonlinear = [](const char* type) {
    throw py::type_error(std::string("motion of Kalman must be linear, got ") + type +
                         ": use Ekf or Ukf");
  };
  define_plain(kalman, [reject_nonlinear](const MotionArgument& motion) {
    return filter_over(
        motion,
        [&]<class Motion>(const Motion& model) {
          if constexpr (LinearMotionModel<Motion>) {
            return any_kalman(model);
          } else {
            reject_nonlinear(Motion::kName);
            return any_filter<Ekf>(model);
          }
        },
        [&](const std::shared_ptr<PyMotion>& model) {
          if (!model->linear()) reject_nonlinear(model->type());
          return AnyFilter(CustomFilter(model), true);
        });
  });
  py::class_<PyEkf, AnyFilter> ekf(
      m, "Ekf", "The extended Kalman filter: motion and sensor linearized about the mean.");
  define_plain(ekf, [](const MotionArgument& motion) {
    return filter_over(
        motion, [](const auto& model) { return AnyFilter(Ekf(model)); },
        [](const std::shared_ptr<PyMotion>& model) { return AnyFilter(CustomFilter(model)); });
  });
  py::class_<PyUkf, AnyFilter> ukf(
      m, "Ukf", "The unscented Kalman filter, with the scaled transform's alpha, beta and kappa.");
  define_unscented<MotionArgument>(
      ukf, [](const MotionArgument& motion, const Unscented& unscented) {
        return filter_over(
            motion, [&](const auto& model) { return AnyFilter(Ukf(model, unscented)); },
            [&](const std::shared_ptr<PyMotion>& model) {
              return AnyFilter(CustomFilter(model, unscented));
            });
      });
  py::class_<PySquareRootUkf, AnyFilter> square_root(
      m, "SquareRootUkf",
      "The unscented Kalman filter with a square root of the covariance, for long runs.");
  define_unscented<AnyMotion>(square_root, [](const AnyMotion& motion, const Unscented& unscented) {
    return any_filter<SquareRootUkf>(motion, unscented);
  });

  py::class_<AnyEstimator> estimator(m, "Estimator",
                                     "What estimators of one or several models share.");
  define_face(estimator);

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
      "Belief over [x, vx, y, vy] from one plot and zero velocity with the given standard "
      "deviation "
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
      "Belief over [x, vx, y, vy] from two plots dt_s apart. The own ship of the sensor is that of "
      "the second plot; its velocity gives its position at the first.");

  define_alpha_beta(m);
  define_smoothers(m);
}

}  // namespace wakeline::python
