// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/waypoint_follower.hpp"

#include <cstdint>
#include <optional>
#include <vector>

#include "support/fields.hpp"
#include "support/types.hpp"
#include "wakeline/navigation/compass_ellipse.hpp"

namespace wakeline::python {

void define_waypoint_follower(py::module_& navigation);

namespace {

using Array = py::array_t<double>;
using Legs = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// Commands of any number of vessels.
struct PySteering {
  py::array_t<std::int64_t> leg;
  Array turn_rate_rad_s, heading_rad, cross_track_m;
};

std::vector<Vec<double, 2>> to_points(const char* name, const DoubleArray& points) {
  require_shape(points.ndim() == 2 && points.shape(1) == 2, name, "(N, 2)", points);
  std::vector<Vec<double, 2>> result;
  for (py::ssize_t k = 0; k < points.shape(0); ++k)
    result.emplace_back(points.at(k, 0), points.at(k, 1));
  return result;
}

WaypointFollower make_follower(const DoubleArray& route, const WaypointGuidance& guidance,
                               const std::optional<DoubleArray>& obstacles) {
  std::vector<Obstacle> discs;
  if (obstacles && obstacles->size() > 0) {
    require_shape(obstacles->ndim() == 2 && obstacles->shape(1) == 3, "obstacles", "(K, 3)",
                  *obstacles);
    for (py::ssize_t k = 0; k < obstacles->shape(0); ++k)
      discs.push_back({obstacles->at(k, 0), obstacles->at(k, 1), obstacles->at(k, 2)});
  }
  return {guidance, to_points("route_m", route), std::move(discs)};
}

Array discs_of(const WaypointFollower& follower) {
  Array discs({py::ssize_t(follower.obstacles().size()), py::ssize_t(3)});
  double* to = discs.mutable_data();
  for (const Obstacle& o : follower.obstacles())
    for (const double value : {o.north_m, o.east_m, o.radius_m}) *to++ = value;
  return discs;
}

Array route_of(const WaypointFollower& follower) {
  Array route({py::ssize_t(follower.route().size()), py::ssize_t(2)});
  double* to = route.mutable_data();
  for (const Vec<double, 2>& point : follower.route())
    for (const double value : point) *to++ = value;
  return route;
}

PySteering steer(const WaypointFollower& follower, const DoubleArray& position,
                 const DoubleArray& heading, const DoubleArray& current, double dt_s,
                 const Legs& leg) {
  require_positive("dt_s", dt_s);
  const std::vector<py::ssize_t> shape = shape_of(heading);
  std::vector<py::ssize_t> pairs = shape;
  pairs.push_back(2);
  require_shape(shape_of(position) == pairs, "position_m", shape_text(pairs), position);
  require_shape(shape_of(current) == pairs, "current_mps", shape_text(pairs), current);
  require_shape(shape_of(leg) == shape, "leg", shape_text(shape), leg);
  PySteering all{py::array_t<std::int64_t>(shape), Array(shape), Array(shape), Array(shape)};
  for (py::ssize_t k = 0; k < heading.size(); ++k) {
    const double *p = position.data() + 2 * k, *c = current.data() + 2 * k;
    const auto one = follower.steer({p[0], p[1]}, heading.data()[k], {c[0], c[1]}, dt_s,
                                    static_cast<int>(leg.data()[k]));
    if (one.status != Status::kOk)
      require_ok(one.status, ("steer of vessel " + std::to_string(k)).c_str());
    all.leg.mutable_data()[k] = one.leg;
    all.turn_rate_rad_s.mutable_data()[k] = one.turn_rate_rad_s;
    all.heading_rad.mutable_data()[k] = one.heading_rad;
    all.cross_track_m.mutable_data()[k] = one.cross_track_m;
  }
  return all;
}

void define_follower(py::module_& m) {
  define_struct<WaypointGuidance>(m, "WaypointGuidance", "How a vessel follows its waypoints.");

  py::class_<PySteering> steering(
      m, "Steering", "Commands for one step; every array has the shape (...) of the vessels.");
  define_pickle(steering, &PySteering::leg, &PySteering::turn_rate_rad_s, &PySteering::heading_rad,
                &PySteering::cross_track_m);
  steering
      .def_readonly("leg", &PySteering::leg,
                    "Leg that is followed; the number of legs after the last waypoint.")
      .def_readonly("turn_rate_rad_s", &PySteering::turn_rate_rad_s,
                    "Rate of turn in this step, positive to starboard.")
      .def_readonly("heading_rad", &PySteering::heading_rad, "Heading to be steered.")
      .def_readonly("cross_track_m", &PySteering::cross_track_m,
                    "Distance from the line of the leg, positive to starboard.");

  py::class_<WaypointFollower> follower(
      m, "WaypointFollower",
      R"(Leads vessels along waypoints, around obstacles and against the current.

In each step a vessel turns by clip(wrap(heading to steer - heading), -w T, w T), w the largest rate
of turn. The heading to steer is the bearing of the next waypoint or, where the straight line to it
is too close to an obstacle, of the tangent to the circle of clearance around the nearest such
obstacle, corrected for the current as far as the speed through the water allows, so that the course
over ground is that bearing. A waypoint is reached once it is closer than `accept_m`.

It holds the route; the leg, the progress along it, is the caller's, so that one follower serves any
number of vessels.

Parameters
----------
route_m : (N, 2) array
    [north, east]; the first point is where the route begins, leg k leads from point k to k + 1.
guidance : WaypointGuidance
obstacles : (K, 3) array, optional
    Discs to avoid: [north, east, radius] m.

Raises
------
ValueError
    When there are less than two points, a radius is not positive, or a number is not finite.

References
----------
P. S. Evsyukov, O. N. Andreeva, V. V. Khanychev, "Sensor system information processing in unmanned
navigation applications", the mission and (26).)");
  define_copies(follower);
  follower
      .def("_arguments",
           [](const WaypointFollower& f) {
             return Arguments()
                 .with("route_m", route_of(f))
                 .with("guidance", f.guidance())
                 .with("obstacles", discs_of(f));
           })
      .def(py::init(&make_follower), py::arg("route_m"), py::arg("guidance") = WaypointGuidance{},
           py::arg("obstacles") = py::none())
      .def_property_readonly("guidance", &WaypointFollower::guidance)
      .def_property_readonly("route_m", &route_of, "(N, 2) [north, east]")
      .def_property_readonly("obstacles", &discs_of, "(K, 3) [north, east, radius] m")
      .def_property_readonly("legs", &WaypointFollower::legs, "number of legs, N - 1")
      .def("steer", &steer, py::arg("position_m"), py::arg("heading_rad"), py::arg("current_mps"),
           py::arg("dt_s"), py::arg("leg"),
           R"(The commands for a step, from estimates of position, heading and current.

Parameters
----------
position_m : (..., 2) array
    [north, east].
heading_rad : (...) array
current_mps : (..., 2) array
    [north, east]; zero where it is not known.
dt_s : float
leg : (...) array of int
    The leg that was followed last; 0 at the start.

Returns
-------
Steering

Raises
------
ValueError
    When shapes do not fit or `dt_s` is not positive.
FilterError
    When a number is not finite, with the index of the vessel.)");
}

void define_compass(py::module_& m) {
  py::class_<CompassEllipse> ellipse(m, "CompassEllipse",
                                     R"(Hard and soft iron of a magnetic compass.

The field measured along the body [forward, starboard], in any unit, is S [cos ψ, -sin ψ] + b with ψ
the magnetic heading: over a turn an ellipse.

Parameters
----------
hard_iron : (2,) array
    b, its centre.
soft_iron : (2, 2) array
    S, symmetric and positive definite: the soft iron times the horizontal field of the earth.

Raises
------
ValueError
    When a number is not finite, or `soft_iron` is not symmetric and positive definite.)");
  define_copies(ellipse);
  ellipse
      .def("_arguments",
           [](const CompassEllipse& e) {
             return Arguments()
                 .with("hard_iron", to_array(e.hard_iron))
                 .with("soft_iron", to_array(e.soft_iron));
           })
      .def(py::init([](const DoubleArray& hard, const DoubleArray& soft) {
             const CompassEllipse e{to_vector("hard_iron", hard, 2),
                                    to_matrix("soft_iron", soft, 2, 2)};
             const double asymmetry = std::abs(e.soft_iron(0, 1) - e.soft_iron(1, 0));
             const bool definite = Cholesky<2>(e.soft_iron).ok();
             if (!e.hard_iron.allFinite() || !definite || asymmetry > 1e-9 * e.soft_iron.norm())
               throw py::value_error(
                   "hard_iron must be finite and soft_iron symmetric and positive definite, got " +
                   text_of(py::handle(hard)) + " and " + text_of(py::handle(soft)));
             return e;
           }),
           py::arg("hard_iron") = std::vector<double>{0.0, 0.0},
           py::arg("soft_iron") = std::vector<std::vector<double>>{{1.0, 0.0}, {0.0, 1.0}})
      .def_property_readonly("hard_iron",
                             [](const CompassEllipse& e) { return to_array(e.hard_iron); })
      .def_property_readonly("soft_iron",
                             [](const CompassEllipse& e) { return to_array(e.soft_iron); })
      .def(
          "field",
          [](const CompassEllipse& e, const DoubleArray& heading) {
            std::vector<py::ssize_t> shape = shape_of(heading);
            shape.push_back(2);
            Array field(shape);
            for (py::ssize_t k = 0; k < heading.size(); ++k)
              Eigen::Map<Vec<double, 2>>(field.mutable_data() + 2 * k) = e.field(heading.data()[k]);
            return field;
          },
          py::arg("heading_rad"), "The fields (..., 2) at magnetic headings (...).")
      .def(
          "heading_rad",
          [](const CompassEllipse& e, const DoubleArray& field) {
            const bool pairs = field.ndim() > 0 && field.shape(field.ndim() - 1) == 2;
            require_shape(pairs, "field", "(..., 2)", field);
            std::vector<py::ssize_t> shape = shape_of(field);
            shape.pop_back();
            Array heading(shape);
            for (py::ssize_t k = 0; k < heading.size(); ++k)
              heading.mutable_data()[k] =
                  e.heading_rad(Vec<double, 2>(field.data()[2 * k], field.data()[2 * k + 1]));
            return heading;
          },
          py::arg("field"), "Magnetic headings (...) in [-pi, pi] of measured fields (..., 2).");

  m.def(
      "calibrate_compass",
      [](const DoubleArray& field) {
        CompassCalibration calibration;
        for (const Vec<double, 2>& reading : to_points("field", field))
          static_cast<void>(calibration.add(reading));
        const CompassCalibration::Fit fit = calibration.fit();
        if (fit.status == Status::kNotStarted)
          throw py::value_error("field must have at least 6 finite readings, got " +
                                std::to_string(calibration.readings()));
        if (fit.status != Status::kOk)
          throw FilterError(
              "calibrate_compass: the readings show no ellipse; take them over a whole turn");
        return std::pair(fit.ellipse, fit.heading_std_rad);
      },
      py::arg("field"),
      R"(Hard and soft iron of a compass from the fields that it measures in a turn.

The ellipse of least squared algebraic distance. The turn may have any rate; a whole one is best. A
rotation of the soft iron, a constant error of all headings, cannot be found in a turn.

Parameters
----------
field : (n, 2) array
    [forward, starboard] in any unit; rows that are not finite are left out.

Returns
-------
(ellipse, heading_std_rad)
    A `CompassEllipse`, and the standard deviation that its error gives at the worst heading; a
    short arc shows in it.

Raises
------
ValueError
    When there are less than six readings.
FilterError
    When they show no ellipse.)");
}

}  // namespace

void define_waypoint_follower(py::module_& m) {
  define_follower(m);
  define_compass(m);
}

}  // namespace wakeline::python
