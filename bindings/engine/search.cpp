// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "support/each.hpp"
#include "support/option.hpp"
#include "support/types.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/navigation/search/detection.hpp"
#include "wakeline/navigation/search/intercept.hpp"
#include "wakeline/navigation/search/leeway_table.hpp"

namespace wakeline::python {

void define_search(py::module_& navigation);

namespace {

using Vec2 = Vec<double, 2>;

const Leeway& leeway_of(const std::string& kind) {
  if (const Leeway* entry = find_leeway(kind)) return *entry;
  std::string known;
  for (const Leeway& entry : kLeewayTable)
    known += (known.empty() ? "" : ", ") + std::string(entry.kind);
  throw py::value_error("kind must be one of " + known + ", got " + quoted(kind));
}

py::dict leeway_kinds() {
  py::dict kinds;
  for (const Leeway& entry : kLeewayTable) kinds[py::str(entry.kind)] = py::str(entry.summary);
  return kinds;
}

py::dict leeway_lines(const std::string& kind) {
  const Leeway& entry = leeway_of(kind);
  const auto numbers = [](const LeewayLine& line) {
    return py::make_tuple(line.slope, line.offset_mps, line.std_slope, line.std_offset_mps);
  };
  py::dict lines;
  lines["downwind"] = numbers(entry.downwind);
  lines["right"] = numbers(entry.right);
  lines["left"] = numbers(entry.left);
  return lines;
}

Array leeway_mps(const std::string& kind, const DoubleArray& wind, const DoubleArray& error,
                 const DoubleArray& to_right) {
  const Leeway& entry = leeway_of(kind);
  const auto [north, east] = components("wind_mps", wind);
  const auto [downwind, crosswind] = components("error", error);
  return each_vector(
      [&](double n, double e, double d, double c, double right) {
        return entry.velocity_mps(Vec2(n, e), Vec2(d, c), right != 0.0);
      },
      north, east, downwind, crosswind, to_right);
}

/// Positions at given times of objects that are known at the times of a grid, straight in between.
class Between {
 public:
  Between(const DoubleArray& grid_s, const DoubleArray& time_s) {
    const double* first = grid_s.data();
    const double* last = first + grid_s.size();
    for (py::ssize_t k = 0; k < time_s.size(); ++k) {
      const double t = time_s.data()[k];
      if (!(t >= first[0] && t <= last[-1]))
        throw py::value_error("time_s must be within object_time_s, got " + std::to_string(t));
      const auto after =
          std::clamp<py::ssize_t>(std::upper_bound(first, last, t) - first, 1, grid_s.size() - 1);
      row_.push_back(after - 1);
      share_.push_back((t - first[after - 1]) / (first[after] - first[after - 1]));
    }
  }

  /// The position at time k on a track of [north, east].
  Vec2 operator()(const double* track_m, std::size_t k) const {
    const double* before = track_m + 2 * row_[k];
    return {before[0] + share_[k] * (before[2] - before[0]),
            before[1] + share_[k] * (before[3] - before[1])};
  }

 private:
  std::vector<py::ssize_t> row_;
  std::vector<double> share_;
};

Array detection_potential(const std::string& law_word, double sweep_width_m,
                          const DoubleArray& time_s, const DoubleArray& unit_m,
                          const DoubleArray& object_time_s, const DoubleArray& object_m) {
  const auto law = to_option<DetectionLaw>("law", law_word);
  require_positive("sweep_width_m", sweep_width_m);
  require_shape(time_s.ndim() == 1, "time_s", "(K,)", time_s);
  const py::ssize_t steps = time_s.size(), times = object_time_s.size();
  require_shape(object_time_s.ndim() == 1 && times >= 2, "object_time_s", "(T,), T at least 2",
                object_time_s);
  require_shape(shape_of(unit_m) == std::vector<py::ssize_t>{steps, 2}, "unit_m",
                shape_text({steps, 2}), unit_m);
  require_shape(object_m.ndim() == 3 && object_m.shape(1) == times && object_m.shape(2) == 2,
                "object_m", "(n, " + std::to_string(times) + ", 2)", object_m);
  const Between position(object_time_s, time_s);
  const py::ssize_t count = object_m.shape(0);
  Array result(count);
  double* sums = result.mutable_data();
  const double *unit = unit_m.data(), *objects = object_m.data();
  const py::gil_scoped_release release;
  for (py::ssize_t i = 0; i < count; ++i) {
    const double* track = objects + 2 * times * i;
    Vec2 before = Vec2::Zero();
    sums[i] = 0.0;
    for (py::ssize_t k = 0; k < steps; ++k) {
      const Vec2 now = position(track, std::size_t(k)) - Vec2(unit[2 * k], unit[2 * k + 1]);
      if (k > 0) sums[i] += leg_potential(law, before, now, sweep_width_m);
      before = now;
    }
  }
  return result;
}

}  // namespace

void define_search(py::module_& m) {
  m.def(
      "leeway_kinds", &leeway_kinds,
      "Kinds of search objects with a line about each: those of Allen's table, and those of (12).");
  m.def("leeway_lines", &leeway_lines, py::arg("kind"),
        R"(Leeway of a kind of object as lines over the wind speed W.

Each of ``downwind``, ``right`` and ``left`` is (slope, offset_mps, std_slope, std_offset_mps) of
``slope W + offset + e (std_slope W + std_offset)``; crosswind components are positive to the right.

Raises
------
ValueError
    When there is no such kind.)");
  m.def("leeway_mps", &leeway_mps, py::arg("kind"), py::arg("wind_mps"), py::kw_only(),
        py::arg("error"), py::arg("to_right"),
        R"(Leeway of objects of a kind; Allen and Plourde 1999, Breivik and Allen 2008.

Parameters
----------
kind : str
    One of `leeway_kinds()`.
wind_mps : (..., 2) array
    Velocity of the air, [north, east].
error : (..., 2) array
    Standard normal errors [downwind, crosswind] of the objects, which last.
to_right : (...) array of bool
    Whether each drifts to the right of the wind direction, else to the left.

Returns
-------
(..., 2) array
    Velocity through the water, [north, east]; zero in a calm.

Raises
------
ValueError
    When there is no such kind, or the shapes do not fit.)");
  m.def(
      "pass_probability",
      [](const std::string& law, const DoubleArray& lateral_range_m,
         const DoubleArray& sweep_width_m) {
        const auto option = to_option<DetectionLaw>("law", law);
        return each(
            [option](double x, double w) {
              require_positive("sweep_width_m", w);
              return pass_probability(option, x, w);
            },
            lateral_range_m, sweep_width_m);
      },
      py::arg("law"), py::arg("lateral_range_m"), py::arg("sweep_width_m"),
      R"(Probability of detection of an object that a unit passes on a straight line; Koopman.

With x the lateral range and W the sweep width: ``definite_range`` 1 up to W/2, ``inverse_cube``
1 - exp(-W²/(4 pi x²)), ``exponential`` exp(-2 |x|/W). The integral over x is W.)");
  m.def(
      "parallel_track_pod",
      [](const std::string& law, const DoubleArray& coverage) {
        const auto option = to_option<DetectionLaw>("law", law);
        return each(
            [option](double c) {
              require_not_negative("coverage", c);
              return parallel_track_pod(option, c);
            },
            coverage);
      },
      py::arg("law"), py::arg("coverage"),
      R"(Probability of detection (POD) in an area swept by even parallel tracks.

Coverage C is sweep width / track spacing: min(1, C) for ``definite_range``, erf(sqrt(pi) C / 2) for
``inverse_cube``, the mean over the area for ``exponential``.)");
  m.def(
      "random_search_pod",
      [](const DoubleArray& coverage) {
        return each(
            [](double c) {
              require_not_negative("coverage", c);
              return random_search_pod(c);
            },
            coverage);
      },
      py::arg("coverage"), "POD of random search with a coverage C: 1 - exp(-C), of any law.");
  m.def("detection_potential", &detection_potential, py::arg("law"), py::arg("sweep_width_m"),
        py::arg("time_s"), py::arg("unit_m"), py::arg("object_time_s"), py::arg("object_m"),
        R"(-log of the probability that a unit on its route misses each of n drifting objects.

Potentials of several routes add up; the probability of detection is 1 - exp(-potential). A part of
a pass counts by its share of the potential of the whole pass, exact for the inverse cube law.

Parameters
----------
law : str
    ``definite_range``, ``inverse_cube`` or ``exponential``.
sweep_width_m : float
time_s : (K,) array
    Times of the unit's positions; motion is straight in between.
unit_m : (K, 2) array
    [north, east].
object_time_s : (T,) array
    Times of the objects' positions, in order; those of the unit are within them.
object_m : (n, T, 2) array

Returns
-------
(n,) array

Raises
------
ValueError
    When the law is unknown, the sweep width is not positive, a shape or a time does not fit.)");

  py::class_<Intercept>(m, "Intercept", "Where and when a search unit meets a moving object.")
      .def_readonly("found", &Intercept::found,
                    "False where the object outruns the unit; the rest is then NaN.")
      .def_readonly("time_s", &Intercept::time_s, "From now.")
      .def_readonly("course_rad", &Intercept::course_rad, "Of the unit.")
      .def_readonly("time_std_s", &Intercept::time_std_s, "Standard deviation, first order.")
      .def_readonly("course_std_rad", &Intercept::course_std_rad,
                    "Standard deviation, first order.")
      .def_property_readonly(
          "position_m", [](const Intercept& self) { return to_array(self.position_m.mean); },
          "(2,), [north, east] of the object at that time.")
      .def_property_readonly(
          "covariance_m2",
          [](const Intercept& self) { return to_array(self.position_m.covariance); },
          "(2, 2) of the position.");
  m.def(
      "intercept",
      [](const PyGaussian& object, const DoubleArray& unit_m, double speed_mps) {
        if (object.mean.size() != 4)
          throw py::value_error("object must have 4 components [x, vx, y, vy], got " +
                                std::to_string(object.mean.size()));
        require_positive("speed_mps", speed_mps);
        return Intercept::of({object.mean, object.covariance}, to_vector<2>("unit_m", unit_m),
                             speed_mps);
      },
      py::arg("object"), py::arg("unit_m"), py::arg("speed_mps"),
      R"(Least time in which a unit of a speed meets an object at constant velocity.

Parameters
----------
object : Gaussian
    Over [x, vx, y, vy] in the plane of north and east.
unit_m : (2,) array
    Present position of the unit in that plane.
speed_mps : float

Returns
-------
Intercept

Raises
------
ValueError
    When a shape does not fit or the speed is not positive.)");
}

}  // namespace wakeline::python
