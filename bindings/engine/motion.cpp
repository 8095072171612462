// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
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

/// What every motion model offers in Python.
template <class Motion>
void define_model(py::class_<Motion>& model) {
  constexpr int kStates = kStatesOf<Motion>;
  define_copies(model);
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

  py::class_<WhiteAcceleration> white(
      m, "WhiteAcceleration", "Continuous white acceleration per axis; Q is right for any dt.");
  define_copies(white);
  white
      .def(py::init([](double psd) { return WhiteAcceleration{psd}; }), py::kw_only(),
           py::arg("psd_m2s3") = WhiteAcceleration{}.psd_m2s3)
      .def_readonly("psd_m2s3", &WhiteAcceleration::psd_m2s3)
      .def("_arguments", [](const WhiteAcceleration& noise) {
        return Arguments().with("psd_m2s3", noise.psd_m2s3);
      });
  py::class_<PiecewiseAcceleration> piecewise(
      m, "PiecewiseAcceleration",
      "Acceleration drawn for each step, Q = G s² Gᵀ: the papers' form.");
  define_copies(piecewise);
  piecewise
      .def(py::init([](double std) { return PiecewiseAcceleration{std}; }), py::kw_only(),
           py::arg("std_mps2") = PiecewiseAcceleration{}.std_mps2)
      .def_readonly("std_mps2", &PiecewiseAcceleration::std_mps2)
      .def("_arguments", [](const PiecewiseAcceleration& noise) {
        return Arguments().with("std_mps2", noise.std_mps2);
      });
  py::class_<WhiteJerk> jerk(
      m, "WhiteJerk", "Continuous white jerk per axis, for states that hold an acceleration.");
  define_copies(jerk);
  jerk.def(py::init([](double psd) { return WhiteJerk{psd}; }), py::kw_only(),
           py::arg("psd_m2s5") = WhiteJerk{}.psd_m2s5)
      .def_readonly("psd_m2s5", &WhiteJerk::psd_m2s5)
      .def("_arguments",
           [](const WhiteJerk& noise) { return Arguments().with("psd_m2s5", noise.psd_m2s5); });
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

  py::class_<ConstantVelocity> cv(m, "ConstantVelocity",
                                  "Straight and steady: state [x, vx, y, vy] (m, m/s).");
  cv.def(py::init([](const ProcessNoise& noise) { return validated(ConstantVelocity{noise}); }),
         py::kw_only(),
         py::arg_v("noise", ProcessNoise(WhiteAcceleration{}), "WhiteAcceleration()"));
  cv.def("_arguments",
         [](const ConstantVelocity& motion) { return Arguments().with("noise", motion.noise); });
  define_model(cv);

  py::class_<WanderingCourse> wandering(m, "WanderingCourse",
                                        "Straight and nearly steady, with an acceleration that "
                                        "grows with the speed: state [x, vx, y, vy].");
  wandering.def(py::init([](double psd, double course_psd, double max_speed) {
                  return validated(WanderingCourse{psd, course_psd, max_speed});
                }),
                py::kw_only(), py::arg("psd_m2s3") = WanderingCourse{}.psd_m2s3,
                py::arg("course_psd_rad2s") = WanderingCourse{}.course_psd_rad2s,
                py::arg("max_speed_mps") = WanderingCourse{}.max_speed_mps);
  wandering.def("_arguments", [](const WanderingCourse& motion) {
    return Arguments()
        .with("psd_m2s3", motion.psd_m2s3)
        .with("course_psd_rad2s", motion.course_psd_rad2s)
        .with("max_speed_mps", motion.max_speed_mps);
  });
  define_model(wandering);

  py::class_<ConstantAcceleration> ca(
      m, "ConstantAcceleration",
      "Acceleration that stays: state [x, vx, ax, y, vy, ay] (m, m/s, m/s²).");
  ca.def(py::init([](const ProcessNoise& noise, double prior) {
           return validated(ConstantAcceleration{noise, prior});
         }),
         py::kw_only(), py::arg_v("noise", ProcessNoise(WhiteJerk{}), "WhiteJerk()"),
         py::arg("prior_accel_std_mps2") = ConstantAcceleration{}.prior_accel_std_mps2);
  ca.def("_arguments", [](const ConstantAcceleration& motion) {
    return Arguments()
        .with("noise", motion.noise)
        .with("prior_accel_std_mps2", motion.prior_accel_std_mps2);
  });
  define_model(ca);

  py::class_<CoordinatedTurn> ct(
      m, "CoordinatedTurn",
      "A steady turn at a known rate, positive to starboard: state [x, vx, y, vy].");
  ct.def(py::init([](double rate, const ProcessNoise& noise) {
           return validated(CoordinatedTurn{rate, noise});
         }),
         py::kw_only(), py::arg("turn_rate_rad_s") = 0.0,
         py::arg_v("noise", ProcessNoise(WhiteAcceleration{}), "WhiteAcceleration()"));
  ct.def_readonly("turn_rate_rad_s", &CoordinatedTurn::turn_rate_rad_s);
  ct.def("_arguments", [](const CoordinatedTurn& motion) {
    return Arguments().with("turn_rate_rad_s", motion.turn_rate_rad_s).with("noise", motion.noise);
  });
  define_model(ct);

  py::class_<CoordinatedTurnRate> ctr(
      m, "CoordinatedTurnRate",
      "A turn whose rate is part of the state and wanders: [x, vx, y, vy, omega] (m, m/s, rad/s); "
      "it returns to the prior rate within `turn_rate_time_s`, or never where that is 0.");
  ctr.def(
      py::init([](const ProcessNoise& noise, double psd, double prior, double course_psd,
                  double max_speed, double rate, double time) {
        return validated(CoordinatedTurnRate{noise, psd, prior, course_psd, max_speed, rate, time});
      }),
      py::kw_only(), py::arg_v("noise", ProcessNoise(WhiteAcceleration{}), "WhiteAcceleration()"),
      py::arg("turn_rate_psd_rad2s3") = CoordinatedTurnRate{}.turn_rate_psd_rad2s3,
      py::arg("prior_turn_rate_std_rad_s") = CoordinatedTurnRate{}.prior_turn_rate_std_rad_s,
      py::arg("course_psd_rad2s") = CoordinatedTurnRate{}.course_psd_rad2s,
      py::arg("max_speed_mps") = CoordinatedTurnRate{}.max_speed_mps,
      py::arg("prior_turn_rate_rad_s") = CoordinatedTurnRate{}.prior_turn_rate_rad_s,
      py::arg("turn_rate_time_s") = CoordinatedTurnRate{}.turn_rate_time_s);
  ctr.def("_arguments", [](const CoordinatedTurnRate& motion) {
    return Arguments()
        .with("noise", motion.noise)
        .with("turn_rate_psd_rad2s3", motion.turn_rate_psd_rad2s3)
        .with("prior_turn_rate_std_rad_s", motion.prior_turn_rate_std_rad_s)
        .with("course_psd_rad2s", motion.course_psd_rad2s)
        .with("max_speed_mps", motion.max_speed_mps)
        .with("prior_turn_rate_rad_s", motion.prior_turn_rate_rad_s)
        .with("turn_rate_time_s", motion.turn_rate_time_s);
  });
  define_model(ctr);

  py::class_<Singer> singer(
      m, "Singer", "Singer's maneuvering target: state [x, vx, ax, y, vy, ay] (m, m/s, m/s²).");
  singer.def(py::init([](double time, double std) {
               return validated(Singer{time, std});
             }),
             py::kw_only(), py::arg("maneuver_time_s") = Singer{}.maneuver_time_s,
             py::arg("accel_std_mps2") = Singer{}.accel_std_mps2);
  singer.def("_arguments", [](const Singer& motion) {
    return Arguments()
        .with("maneuver_time_s", motion.maneuver_time_s)
        .with("accel_std_mps2", motion.accel_std_mps2);
  });
  define_model(singer);
}

}  // namespace wakeline::python
