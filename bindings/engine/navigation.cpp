// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <optional>
#include <tuple>

#include "support/each.hpp"
#include "support/fields.hpp"
#include "support/types.hpp"
#include "wakeline/navigation/dead_reckoning.hpp"
#include "wakeline/navigation/drift.hpp"
#include "wakeline/navigation/drift_forecast.hpp"
#include "wakeline/navigation/geodesy.hpp"
#include "wakeline/navigation/leeway.hpp"

namespace wakeline::python {

void define_closest_approach(py::module_& navigation);
void define_encounter_watch(py::module_& navigation);
void define_search(py::module_& navigation);
void define_usv_navigator(py::module_& navigation);
void define_waypoint_follower(py::module_& navigation);

namespace {

using Pair = std::tuple<Array, Array>;
using Triple = std::tuple<Array, Array, Array>;
using Vec2 = Vec<double, 2>;

/// A latitude that is none is most often one in degrees.
void require_latitudes(const DoubleArray& latitude_rad, const char* name = "latitude_rad") {
  for (py::ssize_t k = 0; k < latitude_rad.size(); ++k)
    if (std::abs(latitude_rad.data()[k]) > kPi<double> / 2)
      throw py::value_error(std::string(name) + " must be from -pi/2 to pi/2, got " +
                            std::to_string(latitude_rad.data()[k]));
}

Pair to_pair(const std::array<Array, 2>& arrays) { return {arrays[0], arrays[1]}; }

std::array<double, 2> to_array2(const GeoPoint& place) {
  return {place.latitude_rad, place.longitude_rad};
}

Gaussian<2> to_gaussian(const char* name, const PyGaussian& belief) {
  if (belief.mean.size() != 2)
    throw py::value_error(std::string(name) + " must be over [north, east], got " +
                          std::to_string(belief.mean.size()) + " states");
  return {belief.mean, belief.covariance};
}

/// One number or one a scan, as one a scan.
std::vector<double> per_scan_numbers(const char* name, const DoubleArray& array,
                                     py::ssize_t scans) {
  if (array.ndim() == 0) return std::vector<double>(std::size_t(scans), *array.data());
  require_shape(array.ndim() == 1 && array.shape(0) == scans, name, "() or " + shape_text({scans}),
                array);
  return {array.data(), array.data() + scans};
}

/// One vector or one a scan, as one a scan.
std::vector<Vec2> per_scan_vectors(const char* name, const DoubleArray& array, py::ssize_t scans) {
  for (py::ssize_t k = 0; k < array.size(); ++k) require_finite(name, array.data()[k]);
  const bool one = array.ndim() == 1 && array.shape(0) == 2;
  require_shape(one || (array.ndim() == 2 && array.shape(0) == scans && array.shape(1) == 2), name,
                "(2,) or " + shape_text({scans, 2}), array);
  std::vector<Vec2> vectors;
  for (py::ssize_t k = 0; k < scans; ++k) {
    const double* at = array.data() + (one ? 0 : 2 * k);
    vectors.emplace_back(at[0], at[1]);
  }
  return vectors;
}

void copy_belief(const Gaussian<2>& belief, py::ssize_t k, Array& mean, Array& covariance) {
  for (int i = 0; i < 2; ++i) {
    mean.mutable_data()[2 * k + i] = belief.mean[i];
    for (int j = 0; j < 2; ++j)
      covariance.mutable_data()[4 * k + 2 * i + j] = belief.covariance(i, j);
  }
}

// Geodesy -----------------------------------------------------------------------------------------

void define_geodesy(py::module_& m) {
  m.def(
      "geodesic",
      [](const DoubleArray& latitude, const DoubleArray& longitude, const DoubleArray& to_latitude,
         const DoubleArray& to_longitude) -> Triple {
        require_latitudes(latitude);
        require_latitudes(to_latitude, "to_latitude_rad");
        const auto arrays = each_of<3>(
            [](double a, double b, double c, double d) -> std::array<double, 3> {
              const GeoLine line = geodesic({a, b}, {c, d});
              return {line.distance_m, line.course_rad, line.arrival_course_rad};
            },
            latitude, longitude, to_latitude, to_longitude);
        return {arrays[0], arrays[1], arrays[2]};
      },
      py::arg("latitude_rad"), py::arg("longitude_rad"), py::arg("to_latitude_rad"),
      py::arg("to_longitude_rad"),
      R"(The shortest line between positions on the WGS84 ellipsoid, within 0.1 mm.

Parameters
----------
latitude_rad, longitude_rad, to_latitude_rad, to_longitude_rad : array_like
    Broadcast against each other.

Returns
-------
(distance_m, course_rad, arrival_course_rad)
    Courses clockwise from true north at departure and at the destination. NaN for nearly antipodal
    positions (within about 0.7 degrees), where the series does not converge.

Raises
------
ValueError
    When a latitude is beyond a pole.

References
----------
T. Vincenty, Direct and inverse solutions of geodesics on the ellipsoid, Survey Review XXIII 176, 1975.)");

  m.def(
      "geodesic_destination",
      [](const DoubleArray& latitude, const DoubleArray& longitude, const DoubleArray& course,
         const DoubleArray& distance) {
        require_latitudes(latitude);
        return to_pair(each_of<2>(
            [](double a, double b, double c, double d) {
              return to_array2(geodesic_destination({a, b}, c, d));
            },
            latitude, longitude, course, distance));
      },
      py::arg("latitude_rad"), py::arg("longitude_rad"), py::arg("course_rad"),
      py::arg("distance_m"),
      "(latitude_rad, longitude_rad) of the destinations of geodesics with an initial course.");

  m.def(
      "rhumb_line",
      [](const DoubleArray& latitude, const DoubleArray& longitude, const DoubleArray& to_latitude,
         const DoubleArray& to_longitude) {
        require_latitudes(latitude);
        require_latitudes(to_latitude, "to_latitude_rad");
        return to_pair(each_of<2>(
            [](double a, double b, double c, double d) -> std::array<double, 2> {
              const GeoLine line = rhumb_line({a, b}, {c, d});
              return {line.distance_m, line.course_rad};
            },
            latitude, longitude, to_latitude, to_longitude));
      },
      py::arg("latitude_rad"), py::arg("longitude_rad"), py::arg("to_latitude_rad"),
      py::arg("to_longitude_rad"),
      "(distance_m, course_rad) of lines of constant course on the ellipsoid, in the shorter "
      "direction; to or from a pole along the meridian.");

  m.def(
      "rhumb_destination",
      [](const DoubleArray& latitude, const DoubleArray& longitude, const DoubleArray& course,
         const DoubleArray& distance) {
        require_latitudes(latitude);
        return to_pair(each_of<2>(
            [](double a, double b, double c, double d) {
              return to_array2(rhumb_destination({a, b}, c, d));
            },
            latitude, longitude, course, distance));
      },
      py::arg("latitude_rad"), py::arg("longitude_rad"), py::arg("course_rad"),
      py::arg("distance_m"),
      "(latitude_rad, longitude_rad) of the destinations of rhumb lines; NaN beyond a pole.");

  py::class_<LocalPlane> plane(m, "LocalPlane",
                               R"(The plane of north and east around a reference position.

Distance and course from the reference along the geodesic, as polar coordinates (the azimuthal equidistant projection): distances
from the reference are exact to 0.1 mm. Across that direction, at a distance d, the plane is stretched by d² / (6 R²): 1e-5 at 50 km,
4e-5 at 100 km. Positions are keyword arguments in radians, because degrees would silently give another position.

Parameters
----------
latitude_rad, longitude_rad : float
    The reference.

Raises
------
ValueError
    When it is not on the earth.)");
  define_copies(plane);
  plane
      .def("_arguments",
           [](const LocalPlane& p) {
             return Arguments()
                 .with("latitude_rad", p.reference().latitude_rad)
                 .with("longitude_rad", p.reference().longitude_rad);
           })
      .def(py::init([](double latitude, double longitude) {
             return LocalPlane(GeoPoint{latitude, longitude});
           }),
           py::kw_only(), py::arg("latitude_rad"), py::arg("longitude_rad"))
      .def_property_readonly("latitude_rad",
                             [](const LocalPlane& p) { return p.reference().latitude_rad; })
      .def_property_readonly("longitude_rad",
                             [](const LocalPlane& p) { return p.reference().longitude_rad; })
      .def(
          "position_m",
          [](const LocalPlane& p, const DoubleArray& latitude, const DoubleArray& longitude) {
            require_latitudes(latitude);
            return each_vector(
                [&](double a, double b) {
                  return p.position_m({a, b});
                },
                latitude, longitude);
          },
          py::kw_only(), py::arg("latitude_rad"), py::arg("longitude_rad"),
          "[north, east] (..., 2) of positions (...); NaN near the antipode.")
      .def(
          "place",
          [](const LocalPlane& p, const DoubleArray& position_m) {
            const auto [north, east] = components("position_m", position_m);
            return to_pair(each_of<2>(
                [&](double n, double e) {
                  return to_array2(p.place({n, e}));
                },
                north, east));
          },
          py::arg("position_m"), "(latitude_rad, longitude_rad) (...) at [north, east] (..., 2).")
      .def(
          "plane_course_rad",
          [](const LocalPlane& p, const DoubleArray& course, const DoubleArray& latitude,
             const DoubleArray& longitude) {
            require_latitudes(latitude);
            return each(
                [&](double c, double a, double b) {
                  return p.plane_course_rad(c, {a, b});
                },
                course, latitude, longitude);
          },
          py::arg("true_course_rad"), py::kw_only(), py::arg("latitude_rad"),
          py::arg("longitude_rad"),
          "Directions on the plane of courses from true north at positions, with the convergence "
          "of "
          "meridians.")
      .def(
          "true_course_rad",
          [](const LocalPlane& p, const DoubleArray& course, const DoubleArray& latitude,
             const DoubleArray& longitude) {
            require_latitudes(latitude);
            return each(
                [&](double c, double a, double b) {
                  return p.true_course_rad(c, {a, b});
                },
                course, latitude, longitude);
          },
          py::arg("plane_course_rad"), py::kw_only(), py::arg("latitude_rad"),
          py::arg("longitude_rad"),
          "Courses from true north at positions, from directions on the plane.");
}

// Dead reckoning ----------------------------------------------------------------------------------

void define_dead_reckoning(py::module_& m) {
  m.def(
      "predict_position_m",
      [](const DoubleArray& position, const DoubleArray& velocity, const DoubleArray& dt_s,
         const DoubleArray& acceleration) {
        const auto [pn, pe] = components("position_m", position);
        const auto [vn, ve] = components("velocity_mps", velocity);
        const auto [an, ae] = components("acceleration_mps2", acceleration);
        return each_vector(
            [](double a, double b, double c, double d, double e, double f, double t) {
              return predict_position_m<double>(Vec2(a, b), Vec2(c, d), Vec2(e, f), t);
            },
            pn, pe, vn, ve, an, ae, dt_s);
      },
      py::arg("position_m"), py::arg("velocity_mps"), py::arg("dt_s"),
      py::arg("acceleration_mps2") =
          Array(std::vector<py::ssize_t>{2}, std::array{0.0, 0.0}.data()),
      "Positions (..., 2) after steps dt_s (...): p + v t + a t² / 2; (1), (2).");
  m.def(
      "predict_speed_mps",
      [](const DoubleArray& speed, const DoubleArray& acceleration, const DoubleArray& dt_s) {
        return each(predict_speed_mps, speed, acceleration, dt_s);
      },
      py::arg("speed_mps"), py::arg("acceleration_mps2"), py::arg("dt_s"), "v + a t; (5).");
  m.def(
      "predict_course_rad",
      [](const DoubleArray& course, const DoubleArray& rate, const DoubleArray& dt_s,
         const DoubleArray& acceleration) {
        return each(predict_course_rad, course, rate, dt_s, acceleration);
      },
      py::arg("course_rad"), py::arg("turn_rate_rad_s"), py::arg("dt_s"),
      py::arg("turn_acceleration_rad_s2") = 0.0, "K + w t + a t² / 2 in 0 .. 2 pi; (5), (10).");
  m.def(
      "predict_latitude_rad",
      [](const DoubleArray& latitude, const DoubleArray& rate, const DoubleArray& dt_s) {
        return each(predict_latitude_rad, latitude, rate, dt_s);
      },
      py::arg("latitude_rad"), py::arg("rate_rad_s"), py::arg("dt_s"), "Not across a pole; (6).");
  m.def(
      "predict_longitude_rad",
      [](const DoubleArray& longitude, const DoubleArray& rate, const DoubleArray& dt_s) {
        return each(predict_longitude_rad, longitude, rate, dt_s);
      },
      py::arg("longitude_rad"), py::arg("rate_rad_s"), py::arg("dt_s"), "In -pi .. pi; (6).");
  m.def(
      "predict_turn_rate_rad_s",
      [](const DoubleArray& rate, const DoubleArray& acceleration, const DoubleArray& dt_s) {
        return each(predict_turn_rate_rad_s, rate, acceleration, dt_s);
      },
      py::arg("turn_rate_rad_s"), py::arg("turn_acceleration_rad_s2"), py::arg("dt_s"),
      "w + a t; (9).");

  m.def(
      "velocity_mps",
      [](const DoubleArray& speed, const DoubleArray& course) {
        return each_vector(
            [](double v, double k) {
              return SpeedCourse{v, k}.velocity_mps();
            },
            speed, course);
      },
      py::arg("speed_mps"), py::arg("course_rad"), "[north, east] (..., 2) of speeds and courses.");
  m.def(
      "speed_course",
      [](const DoubleArray& velocity) {
        const auto [north, east] = components("velocity_mps", velocity);
        return to_pair(each_of<2>(
            [](double n, double e) -> std::array<double, 2> {
              const SpeedCourse motion = SpeedCourse::of({n, e});
              return {motion.speed_mps, motion.course_rad};
            },
            north, east));
      },
      py::arg("velocity_mps"), "(speed_mps, course_rad) of [north, east] (..., 2).");

  m.def(
      "over_ground",
      [](const DoubleArray& through_water, const DoubleArray& drift) {
        const auto [wn, we] = components("through_water", through_water);
        const auto [dn, de] = components("drift", drift);
        return each_vector([](double a, double b, double c,
                              double d) { return over_ground<double>(Vec2(a, b), Vec2(c, d)); },
                           wn, we, dn, de);
      },
      py::arg("through_water"), py::arg("drift"),
      R"(Motion over ground: the vector sum of motion through the water and drift; (3), (4) for accelerations.

Parameters
----------
through_water, drift : (..., 2) array
    [north, east], both in m/s or both in m/s²; broadcast against each other.

Returns
-------
(..., 2) array
    [north, east], in the same unit.

Raises
------
ValueError
    When an argument does not have pairs, or the shapes do not fit.)");

  const TotalDrift none;
  py::class_<TotalDrift>(m, "TotalDrift",
                         R"(Total drift of a vessel; (3).

Parameters
----------
wind_drift_mps, current_mps, residual_mps : (2,) array
    [north, east] m/s of leeway, of the current of tide, wind and waves, and of the residual.

Raises
------
ValueError
    When one is not a pair.)")
      .def(py::init([](const DoubleArray& wind_drift, const DoubleArray& current,
                       const DoubleArray& residual) {
             return TotalDrift{to_vector<2>("wind_drift_mps", wind_drift),
                               to_vector<2>("current_mps", current),
                               to_vector<2>("residual_mps", residual)};
           }),
           py::arg("wind_drift_mps") = to_array(none.wind_drift_mps),
           py::arg("current_mps") = to_array(none.current_mps),
           py::arg("residual_mps") = to_array(none.residual_mps))
      .def_property_readonly("wind_drift_mps",
                             [](const TotalDrift& d) { return to_array(d.wind_drift_mps); })
      .def_property_readonly("current_mps",
                             [](const TotalDrift& d) { return to_array(d.current_mps); })
      .def_property_readonly("residual_mps",
                             [](const TotalDrift& d) { return to_array(d.residual_mps); })
      .def(
          "velocity_mps", [](const TotalDrift& d) { return to_array(d.velocity_mps()); },
          "Their sum, [north, east] m/s.");

  m.def(
      "velocity_over_window_mps",
      [](const DoubleArray& time_s, const DoubleArray& latitude, const DoubleArray& longitude) {
        require_latitudes(latitude);
        const auto size = time_s.size();
        for (const auto& [name, array] :
             {std::pair{"time_s", &time_s}, std::pair{"latitude_rad", &latitude},
              std::pair{"longitude_rad", &longitude}})
          require_shape(array->ndim() == 1 && array->size() == size, name, shape_text({size}),
                        *array);
        std::vector<TimedPlace> window;
        for (py::ssize_t k = 0; k < size; ++k)
          window.push_back({time_s.data()[k], {latitude.data()[k], longitude.data()[k]}});
        return to_array(velocity_over_window_mps(window));
      },
      py::arg("time_s"), py::arg("latitude_rad"), py::arg("longitude_rad"),
      R"(Velocity over ground of a vessel on a rhumb line, by least squares from its first position; (7).

Parameters
----------
time_s, latitude_rad, longitude_rad : (N,) array
    The window.

Returns
-------
(2,) array
    [north, east] m/s; NaN with fewer than two times.)");
  m.def(
      "velocity_from_rates_mps",
      [](const DoubleArray& latitude_rate, const DoubleArray& longitude_rate,
         const DoubleArray& latitude) {
        require_latitudes(latitude);
        return each_vector(velocity_from_rates_mps, latitude_rate, longitude_rate, latitude);
      },
      py::arg("latitude_rate_rad_s"), py::arg("longitude_rate_rad_s"), py::arg("latitude_rad"),
      "[north, east] (..., 2) of rates of latitude and longitude, on the ellipsoid; (8).");

  m.def(
      "dead_reckon",
      [](const DoubleArray& latitude, const DoubleArray& longitude, const DoubleArray& speed,
         const DoubleArray& course, const DoubleArray& dt_s, const DoubleArray& drift_speed,
         const DoubleArray& drift_course) {
        require_latitudes(latitude);
        return to_pair(each_of<2>(
            [](double a, double b, double v, double k, double t, double vc, double kc) {
              const GeoPoint place = dead_reckon({a, b}, {v, k}, {vc, kc}, t);
              return std::abs(place.latitude_rad) <= kPi<double> / 2
                         ? to_array2(place)
                         : std::array<double, 2>{NAN, NAN};
            },
            latitude, longitude, speed, course, dt_s, drift_speed, drift_course));
      },
      py::arg("latitude_rad"), py::arg("longitude_rad"), py::arg("speed_mps"),
      py::arg("course_rad"), py::arg("dt_s"), py::arg("drift_speed_mps") = 0.0,
      py::arg("drift_course_rad") = 0.0,
      R"(Combined dead reckoning by speed, course and drift; (11).

Parameters
----------
latitude_rad, longitude_rad, speed_mps, course_rad, dt_s, drift_speed_mps, drift_course_rad : array_like
    Broadcast against each other; speed and course through the water.

Returns
-------
(latitude_rad, longitude_rad)
    By mid-latitude with the radii of the ellipsoid: within 0.1 m of the rhumb line over 20 km up to
    70 degrees. NaN beyond a pole.)");
}

// Leeway ------------------------------------------------------------------------------------------

void define_leeway(py::module_& m) {
  py::enum_<FloatingObject>(m, "FloatingObject", "Kind of floating object.")
      .value("buoy", FloatingObject::kBuoy)
      .value("dinghy", FloatingObject::kDinghy)
      .value("launch", FloatingObject::kLaunch)
      .value("ship", FloatingObject::kShip);
  m.def(
      "leeway_factor",
      [](FloatingObject object) {
        const LeewayFactor factor = leeway_factor(object);
        return py::make_tuple(factor.least, factor.greatest);
      },
      py::arg("object"), "Minimum and maximum leeway factor of an object; (12).");
  m.def(
      "wind_drift_mps",
      [](const DoubleArray& wind, const DoubleArray& factor) {
        const auto [north, east] = components("wind_mps", wind);
        return each_vector(
            [](double n, double e, double k) { return wind_drift_mps(Vec2(n, e), k); }, north, east,
            factor);
      },
      py::arg("wind_mps"), py::arg("factor"),
      "Drift (..., 2) of an object in a wind that blows to [north, east] (..., 2); (12), (13).");
  m.def(
      "wind_current_factor",
      [](const DoubleArray& wind_mps) { return each(wind_current_factor, wind_mps); },
      py::arg("wind_mps"),
      "The factor k of (14) by the wind speed: 0.04 at 2 m/s, 0.012 at 20 m/s, a power law "
      "between.");
  m.def(
      "wind_current_mps",
      [](const DoubleArray& wind, const DoubleArray& latitude, const DoubleArray& factor) {
        const auto [north, east] = components("wind_mps", wind);
        return each_vector([](double n, double e, double a,
                              double k) { return WindCurrent(a, k).velocity_mps(Vec2(n, e)); },
                           north, east, latitude, factor);
      },
      py::arg("wind_mps"), py::arg("latitude_rad"), py::kw_only(),
      py::arg("factor") = WindCurrent::kDefaultFactor,
      R"(The surface current of a steady wind; (14).

``V = k U / sqrt(sin |latitude|)``, 45 degrees to the right of the wind in the northern hemisphere, to the left in the southern.

Parameters
----------
wind_mps : (..., 2) array
    Direction and speed to which the wind blows, [north, east].
latitude_rad : array_like
factor : array_like
    k; observed values are from 0.04 (wind of 2 m/s) to 0.012 (20 m/s), see wind_current_factor.

Returns
-------
(..., 2) array
    [north, east] of the current.

Raises
------
ValueError
    Less than 20 degrees from the equator, where the formula is invalid.)");
  m.def(
      "stokes_drift_mps",
      [](const DoubleArray& height, const DoubleArray& length) {
        return each(
            [](double h, double l) {
              require_not_negative("wave_height_m", h);
              require_positive("wave_length_m", l);
              return stokes_drift_mps(h, l);
            },
            height, length);
      },
      py::arg("wave_height_m"), py::arg("wave_length_m"),
      "Speed of the surface drift with waves in deep water, in their direction; height from trough "
      "to crest; (15).");
}

// Drift, observed ---------------------------------------------------------------------------------

std::tuple<Array, Array> run_window(const DriftWindow<>& settings, const DoubleArray& dt_s,
                                    const DoubleArray& speed_mps, const DoubleArray& heading_rad,
                                    const DoubleArray& fix_m, const DoubleArray& fix_std_m) {
  require_shape(fix_m.ndim() == 2 && fix_m.shape(1) == 2, "fix_m", "(T, 2)", fix_m);
  const py::ssize_t scans = fix_m.shape(0);
  const std::vector<double> steps = per_scan_numbers("dt_s", dt_s, scans);
  const std::vector<double> speeds = per_scan_numbers("speed_mps", speed_mps, scans);
  const std::vector<double> headings = per_scan_numbers("heading_rad", heading_rad, scans);
  const std::vector<double> stds = per_scan_numbers("fix_std_m", fix_std_m, scans);
  DriftWindow<> window(settings.settings());
  Array mean({scans, py::ssize_t(2)}), covariance({scans, py::ssize_t(2), py::ssize_t(2)});
  for (py::ssize_t k = 0; k < scans; ++k) {
    const auto at = std::size_t(k);
    if (k > 0) require_ok_in(k, window.advance(steps[at], speeds[at], headings[at]), "advance");
    const Vec2 fix(fix_m.data()[2 * k], fix_m.data()[2 * k + 1]);
    if (!std::isnan(fix[0]) && !std::isnan(fix[1])) {
      require_positive("fix_std_m", stds[at]);
      require_ok_in(k, window.add({fix, stds[at] * stds[at] * Mat<double, 2, 2>::Identity()}),
                    "add");
    }
    copy_belief(window.drift(), k, mean, covariance);
  }
  return {mean, covariance};
}

PyGaussian from_marks(const DoubleArray& velocity, const DoubleArray& covariance) {
  require_shape(velocity.ndim() == 2 && velocity.shape(1) == 2 && velocity.shape(0) > 0,
                "relative_velocity_mps", "(M, 2)", velocity);
  const py::ssize_t marks = velocity.shape(0);
  require_shape(covariance.ndim() == 3 && covariance.shape(0) == marks &&
                    covariance.shape(1) == 2 && covariance.shape(2) == 2,
                "covariance", shape_text({marks, 2, 2}), covariance);
  std::vector<Gaussian<2>> seen;
  for (py::ssize_t k = 0; k < marks; ++k) {
    const double *v = velocity.data() + 2 * k, *c = covariance.data() + 4 * k;
    seen.push_back({{v[0], v[1]}, Mat<double, 2, 2>{{c[0], c[1]}, {c[2], c[3]}}});
    if (check(seen.back()) != Status::kOk)
      throw py::value_error("covariance must be symmetric positive definite for every mark, got " +
                            std::string(to_string(check(seen.back()))) + " for mark " +
                            std::to_string(k));
  }
  return PyGaussian::from(ground_velocity_from_marks(seen));
}

void define_drift(py::module_& m) {
  m.def(
      "drift_from_rates_mps",
      [](const DoubleArray& ground, const DoubleArray& speed, const DoubleArray& course) {
        const auto [north, east] = components("ground_velocity_mps", ground);
        return each_vector(
            [](double n, double e, double v, double k) {
              return drift_from_rates_mps(Vec2(n, e), {v, k});
            },
            north, east, speed, course);
      },
      py::arg("ground_velocity_mps"), py::arg("speed_mps"), py::arg("course_rad"),
      "Velocity over ground (..., 2) minus that through the water, (..., 2).");
  m.def(
      "water_velocity",
      [](double speed, double heading, double log_std, double heading_std) {
        require_finite("speed_mps", speed);
        require_finite("heading_rad", heading);
        require_not_negative("log_std_mps", log_std);
        require_not_negative("heading_std_rad", heading_std);
        return PyGaussian::from(water_velocity(speed, heading, log_std, heading_std));
      },
      py::arg("speed_mps"), py::arg("heading_rad"), py::kw_only(), py::arg("log_std_mps"),
      py::arg("heading_std_rad"),
      "Velocity through the water by log and compass, with the covariance of their errors.");
  m.def("ground_velocity_from_marks", &from_marks, py::arg("relative_velocity_mps"),
        py::arg("covariance"),
        R"(Own ship's velocity over ground from fixed marks tracked by radar.

Parameters
----------
relative_velocity_mps : (M, 2) array
    Of each mark relative to the ship, [north, east].
covariance : (M, 2, 2) array

Returns
-------
Gaussian
    Minus their mean, weighted by information.

Raises
------
ValueError
    When a covariance is not symmetric positive definite.)");
  m.def(
      "drift_between",
      [](const PyGaussian& ground, const PyGaussian& water) {
        return PyGaussian::from(
            drift_between(to_gaussian("over_ground", ground), to_gaussian("through_water", water)));
      },
      py::arg("over_ground"), py::arg("through_water"),
      "Drift from two velocities with independent errors.");
  m.def(
      "sea_stabilised_mps",
      [](const DoubleArray& relative, const DoubleArray& speed, const DoubleArray& course) {
        const auto [north, east] = components("relative_mps", relative);
        return each_vector(
            [](double n, double e, double v, double k) {
              return sea_stabilised_mps(Vec2(n, e), {v, k});
            },
            north, east, speed, course);
      },
      py::arg("relative_mps"), py::arg("own_speed_mps"), py::arg("own_course_rad"),
      "Velocities of targets through the water (..., 2) from those relative to own ship and own "
      "ship's by log and compass.");
  m.def(
      "ground_stabilised_mps",
      [](const DoubleArray& relative, const DoubleArray& speed, const DoubleArray& course,
         const DoubleArray& drift) {
        const auto [north, east] = components("relative_mps", relative);
        const auto [dn, de] = components("drift_mps", drift);
        return each_vector(
            [](double n, double e, double v, double k, double a, double b) {
              return ground_stabilised_mps(Vec2(n, e), {v, k}, Vec2(a, b));
            },
            north, east, speed, course, dn, de);
      },
      py::arg("relative_mps"), py::arg("own_speed_mps"), py::arg("own_course_rad"),
      py::arg("drift_mps"), "Velocities of targets over ground (..., 2); zero for a fixed mark.");

  const DriftWindowSettings defaults;
  py::class_<DriftWindow<>> window(
      m, "DriftWindow",
      R"(The drift of a vessel over a sliding window of fixes; (16)-(20).

The slope of the line through the differences of observed and reckoned positions, by least squares, with its covariance. The
differences have the errors of the fixes and the accumulated, independent errors of log and compass; without errors of log and
compass the line is the plain one. A constant error of the log or the compass counts as drift.

Parameters
----------
max_fixes : int
    Maximum number of fixes, 2 to 32.
log_std_mps, heading_std_rad : float
    Standard deviations of one reading of the log and of the compass.
alteration_mps : float
    Change of the velocity through the water since a fix that ends the line at that fix; 0: none does. The step is left out,
    another line with the same slope begins at the fix after it.

Raises
------
ValueError
    When a setting makes no sense.)");
  define_copies(window);
  window
      .def("_arguments",
           [](const DriftWindow<>& w) {
             return Arguments()
                 .with("max_fixes", w.settings().max_fixes)
                 .with("log_std_mps", w.settings().log_std_mps)
                 .with("heading_std_rad", w.settings().heading_std_rad)
                 .with("alteration_mps", w.settings().alteration_mps);
           })
      .def(py::init([](int fixes, double log_std, double heading_std, double alteration) {
             return DriftWindow<>({fixes, log_std, heading_std, alteration});
           }),
           py::kw_only(), py::arg("max_fixes") = defaults.max_fixes,
           py::arg("log_std_mps") = defaults.log_std_mps,
           py::arg("heading_std_rad") = defaults.heading_std_rad,
           py::arg("alteration_mps") = defaults.alteration_mps)
      .def("clear", &DriftWindow<>::clear, "Forget all fixes, e.g. after an alteration of course.")
      .def(
          "advance",
          [](DriftWindow<>& w, double dt_s, double speed, double heading) {
            require_ok(w.advance(dt_s, speed, heading), "advance");
          },
          py::arg("dt_s"), py::arg("speed_mps"), py::arg("heading_rad"),
          "Advance time with a speed through the water and a heading.")
      .def(
          "add",
          [](DriftWindow<>& w, const PyGaussian& fix) {
            require_ok(w.add(to_gaussian("fix", fix)), "add");
          },
          py::arg("fix"), "Process a fix at the present time, [north, east] m on a plane.")
      .def_property_readonly("size", &DriftWindow<>::size, "number of fixes")
      .def_property_readonly(
          "ready", &DriftWindow<>::ready,
          "whether there are two fixes of different times without an alteration in "
          "between")
      .def(
          "drift", [](const DriftWindow<>& w) { return PyGaussian::from(w.drift()); },
          "[north, east] m/s; zero with an infinite covariance until `ready`.")
      .def("run", &run_window, py::arg("dt_s"), py::arg("speed_mps"), py::arg("heading_rad"),
           py::arg("fix_m"), py::arg("fix_std_m"),
           R"(The drift after each of a series of fixes.

Parameters
----------
dt_s, speed_mps, heading_rad : float or (T,) array
    The step to a fix and the readings of log and compass in it; the first step is ignored.
fix_m : (T, 2) array
    NaN where a fix is missing.
fix_std_m : float or (T,) array
    Standard deviation of a fix per axis.

Returns
-------
(mean, covariance)
    (T, 2) and (T, 2, 2), as for `drift`.)");
}

// Drift, forecast ---------------------------------------------------------------------------------

void define_drift_forecast(py::module_& m) {
  define_struct<DriftModel>(
      m, "DriftModel",
      "How an object drifts: v = k U + C + r, U the wind, C the current, and what is not known of "
      "them; the leeway is that of a dinghy by default.")
      .def_static("of", &DriftModel::of, py::arg("object"),
                  "The model with the leeway of a kind of object.");

  m.def(
      "drift_forecast",
      [](const DriftModel& model_, const PyGaussian& start, const DoubleArray& dt_s,
         const DoubleArray& wind, const DoubleArray& current) -> Pair {
        DriftForecast forecast(model_, to_gaussian("start", start));
        const std::vector<double> steps =
            per_scan_numbers("dt_s", dt_s, dt_s.ndim() == 0 ? 1 : dt_s.shape(0));
        const auto scans = py::ssize_t(steps.size());
        const std::vector<Vec2> winds = per_scan_vectors("wind_mps", wind, scans);
        const std::vector<Vec2> currents = per_scan_vectors("current_mps", current, scans);
        Array mean({scans, py::ssize_t(2)}), covariance({scans, py::ssize_t(2), py::ssize_t(2)});
        for (py::ssize_t k = 0; k < scans; ++k) {
          const auto at = std::size_t(k);
          require_ok_in(k, forecast.advance(steps[at], winds[at], currents[at]), "drift_forecast");
          copy_belief(forecast.position(), k, mean, covariance);
        }
        return {mean, covariance};
      },
      py::arg("model"), py::arg("start"), py::arg("dt_s"), py::arg("wind_mps"),
      py::arg("current_mps"),
      R"(Forecast of the position of a drifting object, as a Gaussian.

Parameters
----------
model : DriftModel
start : Gaussian
    Over [north, east] m.
dt_s : float or (T,) array
    Steps.
wind_mps, current_mps : (2,) or (T, 2) array
    Velocity of air and water in each step, [north, east].

Returns
-------
(mean, covariance)
    (T, 2) and (T, 2, 2) after each step, exact for the model.)");

  m.def(
      "drift_particles",
      [](const DriftModel& model_, const PyGaussian& start, const DoubleArray& dt_s,
         const DoubleArray& wind, const DoubleArray& current, py::ssize_t count,
         std::uint64_t seed) {
        DriftForecast forecast(model_, to_gaussian("start", start));  // checks the arguments
        if (count < 1)
          throw py::value_error("count must be 1 or more, got " + std::to_string(count));
        const std::vector<double> steps =
            per_scan_numbers("dt_s", dt_s, dt_s.ndim() == 0 ? 1 : dt_s.shape(0));
        const auto scans = py::ssize_t(steps.size());
        const std::vector<Vec2> winds = per_scan_vectors("wind_mps", wind, scans);
        const std::vector<Vec2> currents = per_scan_vectors("current_mps", current, scans);
        for (py::ssize_t k = 0; k < scans; ++k) {
          const auto at = std::size_t(k);
          require_ok_in(k, forecast.advance(steps[at], winds[at], currents[at]), "drift_particles");
        }
        Array position({scans, count, py::ssize_t(2)});
        double* out = position.mutable_data();
        const py::gil_scoped_release no_python;
        for (py::ssize_t i = 0; i < count; ++i) {
          DriftParticle particle(model_, forecast.start(), seed, std::uint64_t(i));
          for (py::ssize_t k = 0; k < scans; ++k) {
            const auto at = std::size_t(k);
            particle.advance(steps[at], winds[at], currents[at]);
            Eigen::Map<Vec2>(out + 2 * (k * count + i)) = particle.position_m();
          }
        }
        return position;
      },
      py::arg("model"), py::arg("start"), py::arg("dt_s"), py::arg("wind_mps"),
      py::arg("current_mps"), py::kw_only(), py::arg("count") = 1000, py::arg("seed") = 0,
      R"(The same forecast as particles.

Parameters
----------
model, start, dt_s, wind_mps, current_mps
    As for `drift_forecast`.
count, seed : int
    Particle k of a seed does not depend on the count.

Returns
-------
(T, count, 2) array
    [north, east] m after each step.)");

  py::class_<UncertaintyEllipse>(
      m, "UncertaintyEllipse",
      "The area that contains a Gaussian position with a given probability.")
      .def(py::init([](const DoubleArray& covariance, double probability) {
             const Gaussian<2> belief{Vec2::Zero(), to_matrix("covariance", covariance, 2, 2)};
             if (!(probability > 0.0 && probability < 1.0))
               throw py::value_error("probability must be between 0 and 1, got " +
                                     std::to_string(probability));
             if (const Status status = check(belief); status != Status::kOk)
               throw py::value_error(
                   "covariance must be symmetric positive definite, got one that "
                   "is not: " +
                   std::string(to_string(status)));
             return UncertaintyEllipse::of(belief.covariance, probability);
           }),
           py::arg("covariance"), py::arg("probability") = 0.95)
      .def_readonly("semi_major_m", &UncertaintyEllipse::semi_major_m, "half of the long axis")
      .def_readonly("semi_minor_m", &UncertaintyEllipse::semi_minor_m, "half of the short axis")
      .def_readonly("major_axis_rad", &UncertaintyEllipse::major_axis_rad,
                    "direction of the long axis, 0 .. pi clockwise from north")
      .def_readonly("area_m2", &UncertaintyEllipse::area_m2, "of the ellipse");
}

}  // namespace

void define_navigation(py::module_& parent) {
  py::module_ m = parent.def_submodule("navigation", "Geodesy, dead reckoning, leeway and drift.");
  define_geodesy(m);
  define_dead_reckoning(m);
  define_leeway(m);
  define_drift(m);
  define_drift_forecast(m);
  define_closest_approach(m);
  define_encounter_watch(m);
  define_search(m);
  define_usv_navigator(m);
  define_waypoint_follower(m);
}

}  // namespace wakeline::python
