// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/fields.hpp"
#include "support/types.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/singer.hpp"
#include "wakeline/motion/wandering_course.hpp"

namespace wakeline::python {
namespace {

double time_step(double dt_s) {
  require_not_negative("dt_s", dt_s);
  return dt_s;
}

/// A motion model in Python.
template <class Motion>
void define_model(py::handle scope, const char* name, const char* doc) {
  constexpr int kStates = kStatesOf<Motion>;
  py::class_<Motion> model = define_struct<Motion>(scope, name, doc);
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
  py::module_ m = parent.def_submodule("motion", "How a vessel moves.");

  define_struct<WhiteAcceleration>(
      m, "WhiteAcceleration", "Continuous white acceleration per axis; Q is right for any dt.");
  define_struct<PiecewiseAcceleration>(
      m, "PiecewiseAcceleration",
      "Acceleration drawn for each step, Q = G s² Gᵀ: the papers' form.");
  define_struct<WhiteJerk>(m, "WhiteJerk",
                           "Continuous white jerk per axis, for states that hold an acceleration.");
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

  define_model<ConstantVelocity>(m, "ConstantVelocity",
                                 "Straight and steady: state [x, vx, y, vy] (m, m/s).");
  define_model<WanderingCourse>(
      m, "WanderingCourse",
      "Straight and nearly steady, with an acceleration that grows with the speed: state [x, vx, "
      "y, vy].");
  define_model<ConstantAcceleration>(
      m, "ConstantAcceleration",
      "Constant acceleration: state [x, vx, ax, y, vy, ay] (m, m/s, m/s²).");
  define_model<CoordinatedTurn>(
      m, "CoordinatedTurn",
      "A steady turn at a known rate, positive to starboard: state [x, vx, y, vy].");
  define_model<CoordinatedTurnRate>(
      m, "CoordinatedTurnRate",
      "A turn whose rate is part of the state: [x, vx, y, vy, omega] (m, m/s, rad/s).");
  define_model<Singer>(m, "Singer",
                       "Singer's maneuvering target: state [x, vx, ax, y, vy, ay] (m, m/s, m/s²).");
}

}  // namespace wakeline::python
