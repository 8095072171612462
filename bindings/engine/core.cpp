// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/core/chi_square.hpp"

#include <pybind11/native_enum.h>

#include "support/types.hpp"
#include "wakeline/core/angle.hpp"

namespace wakeline::python {
namespace {

PyGaussian make_gaussian(const DoubleArray& mean, const DoubleArray& covariance) {
  PyGaussian belief;
  belief.mean = to_vector("mean", mean);
  belief.covariance = to_matrix("covariance", covariance, belief.mean.size(), belief.mean.size());
  return belief;
}

/// A number for one angle, an array for several.
py::object wrapped(const DoubleArray& angle_rad) {
  if (angle_rad.ndim() == 0) return py::float_(wrap_angle(*angle_rad.data()));
  py::array_t<double> result(shape_of(angle_rad));
  for (py::ssize_t k = 0; k < angle_rad.size(); ++k)
    result.mutable_data()[k] = wrap_angle(angle_rad.data()[k]);
  return result;
}

}  // namespace

void define_core(py::module_& parent) {
  py::module_ m =
      parent.def_submodule("core", "Beliefs, statuses, angles and the chi-square distribution.");
  py::register_exception<FilterError>(m, "FilterError", PyExc_RuntimeError).attr("__doc__") =
      "An estimator could not be started, predicted or updated; its belief is unchanged.";

  py::native_enum<Status>(m, "Status", "enum.IntEnum",
                          "Status of one step: a number, as in the `status` of a run.")
      .value("ok", Status::kOk, "success")
      .value("missed", Status::kMissed, "no measurement in this scan: predicted only")
      .value("not_started", Status::kNotStarted, "the estimator has no belief yet")
      .value("not_finite", Status::kNotFinite, "an input or a result is not finite")
      .value("not_positive_definite", Status::kNotPositiveDefinite,
             "a covariance is not positive definite")
      .value("negative_time_step", Status::kNegativeTimeStep, "the time step is negative")
      .value("gated", Status::kGated, "the measurement is outside the gate: predicted only")
      .finalize();
  // A number in arithmetic and comparisons, a word where it is shown.
  const py::object shown = m.attr("Status");
  shown.attr("__str__") = py::cpp_function([](const py::object& s) { return s.attr("name"); },
                                           py::name("__str__"), py::is_method(shown));
  shown.attr("__format__") = py::cpp_function(
      [](const py::object& s, const py::str& format) {
        const std::string text = format;
        const bool number = !text.empty() && std::string_view("bcdeEfFgGnoxX%").find(text.back()) !=
                                                 std::string_view::npos;
        const py::object value = number ? py::object(py::int_(s.cast<long>())) : s.attr("name");
        return value.attr("__format__")(format);
      },
      py::name("__format__"), py::is_method(shown), py::arg("format_spec"));

  py::class_<PyGaussian> gaussian(m, "Gaussian", R"(A Gaussian belief.

Parameters
----------
mean : (N,) array
covariance : (N, N) array
    Symmetric positive definite; checked when an estimator starts with it.

Raises
------
ValueError
    When the shapes do not fit.)");
  define_copies(gaussian);
  gaussian.def(py::init(&make_gaussian), py::arg("mean"), py::arg("covariance"))
      .def_property_readonly(
          "mean", [](const PyGaussian& g) { return to_array(g.mean); }, "(N,)")
      .def_property_readonly(
          "covariance", [](const PyGaussian& g) { return to_array(g.covariance); }, "(N, N)")
      .def("_arguments", [](const PyGaussian& g) {
        return Arguments().with("mean", g.mean).with("covariance", g.covariance);
      });

  py::class_<PyStep>(m, "Step", "Result of a measurement update; true if the reading was accepted.")
      .def("__bool__", [](const PyStep& s) { return s.status == Status::kOk; })
      .def_readonly("status", &PyStep::status, "accepted, or why the reading changed nothing")
      .def_property_readonly(
          "innovation", [](const PyStep& s) { return to_array(s.innovation); },
          "(M,) measured minus predicted, angles wrapped")
      .def_property_readonly(
          "innovation_covariance",
          [](const PyStep& s) { return to_array(s.innovation_covariance); }, "(M, M)")
      .def_readonly("nis", &PyStep::nis, "normalized innovation squared")
      .def_readonly("log_likelihood", &PyStep::log_likelihood, "of the reading, before the update")
      .def(py::pickle([](const PyStep& s) { return fields_of(s); },
                      [](const py::tuple& fields) { return step_of(fields); }))
      .def("__repr__", [](const PyStep& s) {
        const std::string found = ok(s.status) ? ", nis=" + text_of(s.nis) : "";
        return "<Step: " + std::string(to_string(s.status)) + found + ">";
      });

  m.def("wrap_angle", &wrapped, py::arg("angle_rad"),
        "The angle wrapped to [-pi, pi], rad; elementwise for an array.");
  m.def("chi_square_quantile", &chi_square_quantile, py::arg("probability"), py::arg("dof"),
        "Chi-square quantile of `probability` with `dof` degrees of freedom; NaN for invalid "
        "arguments.");
  m.def(
      "chi_square_probability", &chi_square_probability, py::arg("value"), py::arg("dof"),
      "Probability that a chi-square variable with `dof` degrees of freedom is below `value`; NaN "
      "for invalid arguments.");
}

}  // namespace wakeline::python
