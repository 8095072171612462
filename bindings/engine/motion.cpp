// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/fields.hpp"
#include "support/types.hpp"
#include "wakeline/catalog/motions.hpp"

namespace wakeline::python {
namespace {

double time_step(double dt_s) {
  require_not_negative("dt_s", dt_s);
  return dt_s;
}

/// What every motion model offers in Python.
template <class Motion>
void define_model(py::class_<Motion>& model) {
  constexpr int kStates = kStatesOf<Motion>;
  model.def_property_readonly_static(
      "states", [](const py::object&) { return kStates; }, "number of states N");
  if constexpr (LinearMotionModel<Motion>) {
    model.def(
        "matrix",
        [](const Motion& motion, double dt_s) { return to_array(motion.matrix(time_step(dt_s))); },
        py::arg("dt_s"), "F(dt), (N, N).");
    model.def(
        "process_noise",
        [](const Motion& motion, double dt_s) {
          return to_array(motion.process_noise(time_step(dt_s)));
        },
        py::arg("dt_s"), "Q(dt), (N, N).");
  } else {
    model.def(
        "transition",
        [](const Motion& motion, const DoubleArray& x, double dt_s) {
          return to_array(motion.transition(to_vector<kStates>("x", x), time_step(dt_s)));
        },
        py::arg("x"), py::arg("dt_s"), "f(x, dt), (N,).");
    model.def(
        "jacobian",
        [](const Motion& motion, const DoubleArray& x, double dt_s) {
          return to_array(motion.jacobian(to_vector<kStates>("x", x), time_step(dt_s)));
        },
        py::arg("x"), py::arg("dt_s"), "df/dx, (N, N).");
    model.def(
        "process_noise",
        [](const Motion& motion, const DoubleArray& x, double dt_s) {
          return to_array(motion.process_noise(to_vector<kStates>("x", x), time_step(dt_s)));
        },
        py::arg("x"), py::arg("dt_s"), "Q(x, dt), (N, N).");
  }
}

}  // namespace

py::object AsPython<ProcessNoise>::of(const ProcessNoise& noise) {
  switch (noise.kind()) {
    case ProcessNoise::Kind::kWhiteAcceleration:
      return py::cast(WhiteAcceleration{noise.parameter()});
    case ProcessNoise::Kind::kPiecewiseAcceleration:
      return py::cast(PiecewiseAcceleration{noise.parameter()});
    case ProcessNoise::Kind::kWhiteJerk:
      return py::cast(WhiteJerk{noise.parameter()});
  }
  return py::none();
}

void define_motion(py::module_& parent) {
  py::module_ m = parent.def_submodule("motion", "Motion models.");

  define_struct<WhiteAcceleration>(
      m, "WhiteAcceleration", "Continuous white acceleration per axis; Q is consistent for any dt.",
      {.called = true});
  define_struct<PiecewiseAcceleration>(
      m, "PiecewiseAcceleration",
      "Acceleration constant over each step, Q = G s² Gᵀ: the papers' form.", {.called = true});
  define_struct<WhiteJerk>(m, "WhiteJerk",
                           "Continuous white jerk per axis, for states with an acceleration.",
                           {.called = true});
  py::class_<ProcessNoise> noise(m, "ProcessNoise", "One of the process-noise policies.");
  define_copies(noise);
  noise.def(py::init<WhiteAcceleration>(), py::arg("policy"))
      .def(py::init<PiecewiseAcceleration>(), py::arg("policy"))
      .def(py::init<WhiteJerk>(), py::arg("policy"))
      .def("_arguments",
           [](const ProcessNoise& noise) { return Arguments().with("policy", noise); });
  py::implicitly_convertible<WhiteAcceleration, ProcessNoise>();
  py::implicitly_convertible<PiecewiseAcceleration, ProcessNoise>();
  py::implicitly_convertible<WhiteJerk, ProcessNoise>();

  Motions::for_each([&]<class Motion>(std::type_identity<Motion>) {
    auto model = define_struct<Motion>(m, Motion::kName, Motion::kSummary, {.called = true});
    define_model(model);
  });
}

}  // namespace wakeline::python
