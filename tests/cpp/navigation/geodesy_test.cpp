// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/geodesy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"

namespace wakeline::geodesy_test {
namespace {

using test::Draw;

GeoPoint at(double latitude_deg, double longitude_deg) {
  return {deg(latitude_deg), deg(longitude_deg)};
}

GeoPoint anywhere(Draw& draw) {
  return {std::asin(draw.uniform(-1, 1)), draw.uniform(-kPi<double>, kPi<double>)};
}

/// Metres between two places that are close.
double gap_m(const GeoPoint& a, const GeoPoint& b) {
  const double north = meridian_radius_m(a.latitude_rad) * (b.latitude_rad - a.latitude_rad);
  const double east = prime_vertical_radius_m(a.latitude_rad) * std::cos(a.latitude_rad) *
                      wrap_angle(b.longitude_rad - a.longitude_rad);
  return std::hypot(north, east);
}

// Distances and azimuths by GeographicLib 2.1.
struct Known {
  GeoPoint from, to;
  double distance_m, course_deg, arrival_deg;
};
const Known kKnown[] = {
    {at(46.5, 30.7), at(46.9, 31.3), 63897.7452338, 45.683886034113, 46.120554237472},
    {at(50.7, -1.5), at(40.6, -73.8), 5515900.1429512, -72.067229602215, -127.426210273637},
    {at(-33.9, 18.4), at(-34.9, 138.5), 10170706.7284638, 134.823761641075, 45.870400660293},
    {at(10, 179.5), at(-5, -178), 1681749.5138653, 170.401572506280, 170.511583646053},
    {at(89.9, 10), at(89.95, -170), 16754.0968049, 0.0, 180.0},
    {at(0, 0), at(0, 90), 10018754.1713946, 90.0, 90.0},
    {at(50, 0), at(-49.3, 179.2), 19911146.7961082, 29.647713359469, 150.815559449673},
};

TEST(Geodesic, IsThatOfGeographicLib) {
  for (const Known& known : kKnown) {
    const GeoLine line = geodesic(known.from, known.to);
    ASSERT_TRUE(line.found);
    EXPECT_NEAR(line.distance_m, known.distance_m, 1e-4);
    // A degree of course is worth less the nearer the goal: 0.1 mm across, here or on the way.
    const double tolerance = 1e-4 / (6.4e6 * std::sin(known.distance_m / 6.4e6));
    EXPECT_NEAR(wrap_angle(line.course_rad - deg(known.course_deg)), 0.0, tolerance);
    EXPECT_NEAR(wrap_angle(line.arrival_course_rad - deg(known.arrival_deg)), 0.0, tolerance);
  }
}

TEST(Geodesic, LeadsWhereItCameFrom) {
  Draw draw(1);
  for (int k = 0; k < 5000; ++k) {
    const GeoPoint from = anywhere(draw), to = anywhere(draw);
    const GeoLine there = geodesic(from, to);
    if (there.distance_m > 19.8e6 || !there.found) continue;
    EXPECT_LT(gap_m(geodesic_destination(from, there.course_rad, there.distance_m), to), 1e-6);
    const GeoLine back = geodesic(to, from);
    EXPECT_NEAR(back.distance_m, there.distance_m, 1e-6);
    EXPECT_LT(std::abs(wrap_angle(back.course_rad - there.arrival_course_rad - kPi<double>)) *
                  std::sin(there.distance_m / 6.4e6),
              1e-12);
  }
}

TEST(Geodesic, OfShortStepsIsTheEllipsoidsCurvature) {
  Draw draw(2);
  for (int k = 0; k < 500; ++k) {
    const GeoPoint from{draw.uniform(-1.5, 1.5), draw.uniform(-3.2, 3.2)};
    const double course = draw.uniform(0, 6.28), distance = draw.uniform(0.01, 20.0);
    const GeoPoint to = geodesic_destination(from, course, distance);
    EXPECT_NEAR(gap_m(from, to), distance, 1e-5 * distance + 2e-9);
    EXPECT_NEAR(geodesic(from, to).distance_m, distance, 1e-6);
  }
}

TEST(Geodesic, ReportsWhereItDoesNotConverge) {
  for (const GeoPoint& to : {at(0.5, 179.7), at(0, 180), at(0.1, -179.9)}) {
    const GeoLine line = geodesic(at(0, 0), to);
    EXPECT_FALSE(line.found);
    EXPECT_TRUE(std::isnan(line.distance_m));
  }
  Draw draw(3);
  for (int k = 0; k < 2000; ++k) {  // a degree from the antipode it does
    const GeoPoint from = anywhere(draw);
    const GeoPoint antipode{-from.latitude_rad, from.longitude_rad + kPi<double>};
    const GeoPoint to =
        geodesic_destination(antipode, draw.uniform(0, 6.28), draw.uniform(111e3, 300e3));
    EXPECT_TRUE(geodesic(from, to).found);
  }
}

TEST(Geodesic, OfNanIsNotFound) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(geodesic({nan, 0.0}, at(1, 1)).found);
  EXPECT_FALSE(geodesic(at(1, 1), {0.0, nan}).found);
  EXPECT_FALSE(rhumb_line(at(1, 1), {0.0, nan}).found);
  EXPECT_TRUE(std::isnan(geodesic_destination(at(1, 1), nan, 1.0).latitude_rad));
  EXPECT_TRUE(std::isnan(rhumb_destination(at(1, 1), 1.0, nan).latitude_rad));
}

TEST(MeridianArc, IsThatOfGeographicLibAndComesBack) {
  EXPECT_NEAR(meridian_arc_m(deg(20)), 2212366.2541716, 1e-6);
  EXPECT_NEAR(meridian_arc_m(deg(45)), 4984944.3779777, 1e-6);
  EXPECT_NEAR(meridian_arc_m(deg(70)), 7768980.7277702, 1e-6);
  EXPECT_NEAR(meridian_arc_m(deg(90)), 10001965.7293127, 1e-6);
  for (double latitude = -1.5; latitude < 1.5; latitude += 0.01)
    EXPECT_NEAR(latitude_of_meridian_arc_rad(meridian_arc_m(latitude)), latitude, 1e-13);
}

TEST(RhumbLine, IsThePublishedOne) {
  // New York to Singapore: an example of GeographicLib's RhumbSolve.
  const GeoLine line = rhumb_line(at(40 + 38.0 / 60 + 23.0 / 3600, -(73 + 46.0 / 60 + 44.0 / 3600)),
                                  at(1 + 21.0 / 60 + 33.0 / 3600, 103 + 59.0 / 60 + 22.0 / 3600));
  EXPECT_NEAR(line.distance_m, 18523563.0423, 1e-3);
  EXPECT_NEAR(line.course_rad, deg(103.5828330034), 1e-11);
}

TEST(RhumbLine, LeadsWhereItCameFrom) {
  Draw draw(4);
  for (int k = 0; k < 5000; ++k) {
    const GeoPoint from{draw.uniform(-1.55, 1.55), draw.uniform(-3.1, 3.1)};
    const GeoPoint to = k % 2 ? GeoPoint{draw.uniform(-1.55, 1.55), draw.uniform(-3.1, 3.1)}
                              : GeoPoint{from.latitude_rad + 1e-4 * draw.normal(),
                                         from.longitude_rad + draw.uniform(-3, 3)};
    if (std::abs(to.latitude_rad) > 1.55) continue;
    const GeoLine line = rhumb_line(from, to);
    ASSERT_TRUE(line.found);
    EXPECT_LT(gap_m(rhumb_destination(from, line.course_rad, line.distance_m), to), 1e-4);
    EXPECT_NEAR(wrap_angle(rhumb_line(to, from).course_rad - line.course_rad - kPi<double>), 0.0,
                1e-9);
  }
}

TEST(RhumbLine, IsAParallelOrAMeridianWhereItRunsAlongOne) {
  const GeoLine east = rhumb_line(at(60, 170), at(60, -170));
  EXPECT_NEAR(east.course_rad, kPi<double> / 2, 1e-12);
  EXPECT_NEAR(east.distance_m, deg(20) * prime_vertical_radius_m(deg(60)) * std::cos(deg(60)),
              1e-6);
  const GeoLine south = rhumb_line(at(60, 10), at(-20, 10));
  EXPECT_NEAR(south.distance_m, geodesic(at(60, 10), at(-20, 10)).distance_m, 1e-4);
  EXPECT_NEAR(south.course_rad, kPi<double>, 1e-12);
  const GeoLine pole = rhumb_line(at(80, 10), at(90, -100));
  EXPECT_DOUBLE_EQ(pole.course_rad, 0.0);
  EXPECT_NEAR(pole.distance_m, meridian_arc_m(deg(90)) - meridian_arc_m(deg(80)), 1e-6);
}

TEST(RhumbLine, IsNeverShorterThanTheGeodesic) {
  Draw draw(5);
  for (int k = 0; k < 2000; ++k) {
    const GeoPoint from = anywhere(draw), to = anywhere(draw);
    const GeoLine shortest = geodesic(from, to);
    if (!shortest.found) continue;
    EXPECT_GE(rhumb_line(from, to).distance_m, shortest.distance_m - 1e-3);
  }
}

TEST(RhumbLine, EndsAtAPole) {
  EXPECT_TRUE(std::isnan(rhumb_destination(at(89, 0), 0.3, 200e3).latitude_rad));
}

TEST(LocalPlane, AndBackIsTheSamePlace) {
  Draw draw(6);
  for (int k = 0; k < 2000; ++k) {
    const LocalPlane plane(anywhere(draw));
    const Vec<double, 2> position(draw.uniform(-5e5, 5e5), draw.uniform(-5e5, 5e5));
    EXPECT_LT((plane.position_m(plane.place(position)) - position).norm(), 1e-6);
  }
  const LocalPlane pole(at(90, 25));
  EXPECT_LT((pole.position_m(pole.place({300.0, -400.0})) - Vec<double, 2>(300, -400)).norm(),
            1e-6);
}

TEST(LocalPlane, OfAReferenceOnTheDateLine) {
  const LocalPlane plane(at(46.5, 180));
  const Vec<double, 2> east = plane.position_m(at(46.5, -179.9));
  const Vec<double, 2> west = plane.position_m(at(46.5, 179.9));
  EXPECT_NEAR(east[1], -west[1], 1e-6);
  EXPECT_NEAR(east[1], deg(0.1) * prime_vertical_radius_m(deg(46.5)) * std::cos(deg(46.5)), 0.01);
}

TEST(LocalPlane, StretchesAcrossAsDocumented) {
  Draw draw(7);
  for (const double d : {50e3, 100e3, 300e3}) {
    for (int k = 0; k < 50; ++k) {
      const LocalPlane plane(GeoPoint{draw.uniform(-1.4, 1.4), 1.0});
      const double azimuth = draw.uniform(0, 6.28);
      const Vec<double, 2> out(std::cos(azimuth), std::sin(azimuth)), across(-out[1], out[0]);
      const GeoPoint a = plane.place(d * out - 100 * across),
                     b = plane.place(d * out + 100 * across);
      EXPECT_NEAR(200 / geodesic(a, b).distance_m - 1, d * d / (6 * 6371e3 * 6371e3),
                  0.05 * d * d / (6 * 6371e3 * 6371e3));
    }
  }
}

TEST(LocalPlane, TurnsCoursesByTheConvergenceOfMeridians) {
  const LocalPlane plane(at(60, 20));
  const GeoPoint place = at(60.2, 21);
  const double course = 1.2;
  const double turned = plane.plane_course_rad(course, place);
  EXPECT_NEAR(wrap_angle(turned - course), -deg(1) * std::sin(deg(60.1)), 1e-4);
  EXPECT_NEAR(plane.true_course_rad(turned, place), course, 1e-12);
  // A ship's wake on the plane points that way.
  const Vec<double, 2> wake =
      plane.position_m(geodesic_destination(place, course, 10.0)) - plane.position_m(place);
  EXPECT_NEAR(std::atan2(wake[1], wake[0]), turned, 1e-4);
}

TEST(LocalPlane, RejectsPositionsOffTheEarth) {
  EXPECT_THROW(LocalPlane(GeoPoint{1.6, 0.0}), std::invalid_argument);
  EXPECT_THROW(LocalPlane(GeoPoint{NAN, 0.0}), std::invalid_argument);
  EXPECT_THROW(LocalPlane(GeoPoint{0.0, INFINITY}), std::invalid_argument);
}

TEST(Geodesy, NeedsNoHeap) {
  const LocalPlane plane(at(46.5, 30.7));
  const test::NoHeap fence;
  EXPECT_TRUE(std::isfinite(plane.position_m(at(46.6, 30.9))[0]));
  EXPECT_TRUE(rhumb_line(at(46.6, 30.9), at(46.5, 30.7)).found);
  EXPECT_EQ(fence.allocations(), 0);
}

}  // namespace
}  // namespace wakeline::geodesy_test
