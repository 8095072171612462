// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/track/scan_plots.hpp"

namespace wakeline::calibration_test {
namespace {

using test::Draw;
using test::NoHeap;

constexpr double kPeriod_s = 2.5;
const Radar kRadar{.range_std_m = 10.0, .bearing_std_rad = deg(0.5), .extent_std_m = 3.0};

/// A vessel on a steady course, or a circle.
struct Course {
  Vec<double, 2> start;
  double speed_mps, course_rad, turn_rad_s = 0.0;

  [[nodiscard]] Vec<double, 2> velocity(double time_s) const {
    const double c = course_rad + turn_rad_s * time_s;
    return {speed_mps * std::cos(c), speed_mps * std::sin(c)};
  }
  [[nodiscard]] Vec<double, 2> place(double time_s) const {
    if (turn_rad_s == 0.0) return start + time_s * velocity(0.0);
    const Vec<double, 2> a = velocity(0.0), b = velocity(time_s);
    return start + Vec<double, 2>(b[1] - a[1], a[0] - b[0]) / turn_rad_s;
  }
};

/// What is simulated.
struct Scene {
  double range_m = 40.0, bearing_rad = deg(2.0), time_s = 0.4;  // offsets of the radar
  int reported = 5, others = 6, clutter = 20;
  double minutes = 10.0;
  bool turning = true;
  double turned_rad = 0.0;      // the whole scene
  double reports_late_s = 0.0;  // arrival
  double clock_s = 0.0;         // of the reports
  double vessel_offset_m = 0.0;
  double size = 1.0;  // of ranges and speeds
};

Course some_course(Draw& draw, const Scene& scene) {
  const double bearing = draw.uniform(-kPi<double>, kPi<double>);
  const double range = scene.size * draw.uniform(1000, 6000);
  const double course = draw.uniform(-kPi<double>, kPi<double>);
  return {
      {range * std::cos(bearing + scene.turned_rad), range * std::sin(bearing + scene.turned_rad)},
      scene.size * draw.uniform(4.0, 14.0),
      course + scene.turned_rad,
      scene.turning ? deg(0.2) * draw.normal() : 0.0};
}

/// Reports and plots of a scene, in order of arrival.
Calibration observed(const Scene& scene, std::uint64_t seed, const CalibrationConfig& config = {}) {
  Draw draw(seed);
  Calibration calibration(kRadar, config);
  std::vector<Course> courses;
  std::vector<Vec<double, 2>> offsets;
  for (int k = 0; k < scene.reported + scene.others; ++k) {
    courses.push_back(some_course(draw, scene));
    offsets.push_back(scene.vessel_offset_m * draw.normals<2>());
  }
  double reported_s = 0.0;
  const auto report_until = [&](double time_s) {
    for (; reported_s <= time_s; reported_s += 10.0)
      for (int k = 0; k < scene.reported; ++k) {
        const Course& course = courses[static_cast<std::size_t>(k)];
        const Vec<double, 2> place = course.place(reported_s) + 3.0 * draw.normals<2>();
        const Vec<double, 2> way = course.velocity(reported_s) + 0.1 * draw.normals<2>();
        EXPECT_EQ(calibration.report(
                      {k, reported_s + scene.clock_s, place[0], place[1], way[0], way[1], 3.0}),
                  Status::kOk);
      }
  };
  for (double begin_s = 0.0; begin_s < 60.0 * scene.minutes; begin_s += kPeriod_s) {
    std::vector<Plot> plots;
    const auto see = [&](double time_s, double range_m, double bearing_rad) {
      plots.push_back({time_s + scene.time_s,
                       range_m + scene.range_m + 10.0 * draw.normal(),
                       wrap_angle(bearing_rad + scene.bearing_rad + deg(0.5) * draw.normal()),
                       {}});
    };
    for (std::size_t k = 0; k < courses.size(); ++k) {
      if (draw.uniform(0.0, 1.0) > 0.9) continue;
      const Vec<double, 2> first = courses[k].place(begin_s);
      const double time_s =
          begin_s + kPeriod_s * compass_angle(std::atan2(first[1], first[0]) - scene.turned_rad) /
                        (2.0 * kPi<double>);
      const Vec<double, 2> course = courses[k].velocity(time_s).normalized();
      const Vec<double, 2> place = courses[k].place(time_s) + offsets[k][0] * course +
                                   offsets[k][1] * Vec<double, 2>(-course[1], course[0]);
      see(time_s, place.norm(), std::atan2(place[1], place[0]));
    }
    for (int k = 0; k < scene.clutter; ++k)
      see(begin_s + draw.uniform(0.0, kPeriod_s), 8000.0 * std::sqrt(draw.uniform(0.0, 1.0)),
          draw.uniform(-kPi<double>, kPi<double>) + scene.turned_rad);
    report_until(begin_s - scene.reports_late_s);
    calibration.plots(plots);
  }
  report_until(60.0 * scene.minutes + 10.0);
  return calibration;
}

void expect_within_four_std(const CalibratedOffset& found, double truth) {
  EXPECT_TRUE(found.determined());
  EXPECT_LT(std::fabs(found.value - truth), 4.0 * found.std) << found.value << " of " << truth;
}

TEST(Calibration, FindsTheOffsetsOfARadarAmongVesselsWithoutReportsAndClutter) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
    const CalibrationResult found = observed({}, seed).solve();
    expect_within_four_std(found.range_m, 40.0);
    expect_within_four_std(found.bearing_rad, deg(2.0));
    expect_within_four_std(found.time_s, 0.4);
    EXPECT_NEAR(found.range_m.value, 40.0, 3.0);
    EXPECT_NEAR(found.bearing_rad.value, deg(2.0), deg(0.15));
    EXPECT_NEAR(found.time_s.value, 0.4, 0.25);
    EXPECT_EQ(found.vessels.size(), 5u);
  }
}

TEST(Calibration, OfManyScenesHasTheErrorThatItReports) {
  Vec<double, 3> squares = Vec<double, 3>::Zero();
  constexpr int kScenes = 30;
  for (int seed = 0; seed < kScenes; ++seed) {
    const CalibrationResult found =
        observed({.clutter = 5, .vessel_offset_m = 4.0}, 100 + static_cast<std::uint64_t>(seed))
            .solve();
    const Vec<double, 3> error{(found.range_m.value - 40.0) / found.range_m.std,
                               (found.bearing_rad.value - deg(2.0)) / found.bearing_rad.std,
                               (found.time_s.value - 0.4) / found.time_s.std};
    squares += error.cwiseAbs2() / kScenes;
  }
  for (const double square : squares) {
    EXPECT_GT(square, 0.1);
    EXPECT_LT(square, 2.0);
  }
}

TEST(Calibration, FindsLargeNegativeOffsets) {
  const CalibrationResult found =
      observed({.range_m = -250.0, .bearing_rad = deg(-6.0), .time_s = -1.0}, 7).solve();
  expect_within_four_std(found.range_m, -250.0);
  expect_within_four_std(found.bearing_rad, deg(-6.0));
  expect_within_four_std(found.time_s, -1.0);
}

TEST(Calibration, OfASceneThatIsTurnedIsTheSame) {
  const CalibrationResult one = observed({}, 3).solve();
  for (const double turned_rad : {1.0, 2.5, -2.0}) {
    const CalibrationResult other = observed({.turned_rad = turned_rad}, 3).solve();
    EXPECT_NEAR(one.bearing_rad.value, other.bearing_rad.value, 3.0 * one.bearing_rad.std);
    EXPECT_NEAR(one.range_m.value, other.range_m.value, 3.0 * one.range_m.std);
  }
}

TEST(Calibration, TakesReportsThatArriveLate) {
  const CalibrationResult in_time = observed({}, 4).solve();
  const CalibrationResult late = observed({.reports_late_s = 30.0}, 4).solve();
  EXPECT_NEAR(late.matches, in_time.matches, 0.05 * in_time.matches);
  expect_within_four_std(late.bearing_rad, deg(2.0));
}

TEST(Calibration, OfOneVesselOnASteadyCourseIsNotDetermined) {
  const CalibrationResult found = observed({.reported = 1, .turning = false}, 5).solve();
  EXPECT_EQ(found.time_s.verdict, CalibrationVerdict::kPoorGeometry);
  const Radar applied = found.applied_to(kRadar);
  EXPECT_EQ(applied.time_offset_s, 0.0) << "what is not determined is not applied";
}

TEST(Calibration, OfVesselsOnOneBearingAtOneRangeRateHasNoRangeAndTime) {
  Draw draw(8);
  Calibration calibration(kRadar);
  for (int scan = 0; scan < 240; ++scan) {
    const double time_s = kPeriod_s * scan;
    std::vector<Plot> plots;
    for (int vessel = 0; vessel < 4; ++vessel) {
      const double range_m = 1000.0 + 800.0 * vessel + 5.0 * time_s;
      if (scan % 4 == 0) {
        EXPECT_EQ(calibration.report({vessel, time_s, range_m, 0.0, 5.0, 0.0, 3.0}), Status::kOk);
      }
      plots.push_back({time_s, range_m + 10.0 * draw.normal(), deg(0.5) * draw.normal(), {}});
    }
    calibration.plots(plots);
  }
  const CalibrationResult found = calibration.solve();
  EXPECT_GT(found.matches, 800.0);
  EXPECT_EQ(found.range_m.verdict, CalibrationVerdict::kPoorGeometry);
  EXPECT_EQ(found.time_s.verdict, CalibrationVerdict::kPoorGeometry);
}

TEST(Calibration, OfTwoVesselsHasTheBearingOnlyWhereTheyAreFar) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Scene far{.reported = 2, .clutter = 0};
    Scene near = far;
    near.size = 0.03;
    EXPECT_TRUE(observed(far, seed).solve().bearing_rad.determined());
    EXPECT_EQ(observed(near, seed).solve().bearing_rad.verdict, CalibrationVerdict::kPoorGeometry);
  }
}

TEST(Calibration, WithoutMatchesIsNotDetermined) {
  for (const CalibrationResult& found :
       {Calibration(kRadar).solve(), observed({.reported = 0}, 1).solve(),
        observed({.clock_s = 3600.0}, 1).solve()}) {
    EXPECT_EQ(found.range_m.verdict, CalibrationVerdict::kFewMatches);
    EXPECT_EQ(found.bearing_rad.verdict, CalibrationVerdict::kFewMatches);
    EXPECT_EQ(found.time_s.verdict, CalibrationVerdict::kFewMatches);
    EXPECT_EQ(found.applied_to(kRadar), kRadar);
  }
}

TEST(Calibration, OfReportsBesideOtherVesselsHasFewMatches) {
  // Reports five minutes old: what is in the gate is there by chance.
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const CalibrationResult found =
        observed({.clutter = 60, .turning = false, .clock_s = 300.0}, seed).solve();
    EXPECT_FALSE(found.bearing_rad.determined()) << found.matches << " matches";
  }
}

TEST(Calibration, ThinsItsMatchesWhenTheyAreTooMany) {
  const CalibrationResult found = observed({}, 6, {.max_matches = 300}).solve();
  EXPECT_LE(found.pairs.size(), 300u);
  EXPECT_GT(found.pairs.back().time_s - found.pairs.front().time_s, 500.0) << "of the whole time";
  EXPECT_NEAR(found.bearing_rad.value, deg(2.0), deg(0.3));
}

TEST(Calibration, TakesPlotsWithoutTheHeap) {
  Calibration calibration =
      observed({.minutes = 2.0}, 1, {.max_matches = 500, .max_waiting_plots = 300});
  const std::vector<Plot> plots(200, Plot{125.0, 2000.0, 1.0, {}});
  const NoHeap fence;
  for (int k = 0; k < 10; ++k) calibration.plots(plots);
  EXPECT_EQ(fence.allocations(), 0);
}

TEST(Calibration, RejectsWhatIsNotFiniteOrGoesBack) {
  Calibration calibration(kRadar, {.max_vessels = 1});
  const double nan = std::nan("");
  EXPECT_EQ(calibration.report({1, nan, 0.0, 0.0}), Status::kNotFinite);
  EXPECT_EQ(calibration.report({1, 0.0, 1e300, 0.0}), Status::kNotFinite);
  EXPECT_EQ(calibration.report({1, 10.0, 1000.0, 0.0}), Status::kOk);
  EXPECT_EQ(calibration.report({1, 10.0, 1000.0, 0.0}), Status::kNegativeTimeStep);
  EXPECT_EQ(calibration.report({2, 10.0, 1000.0, 0.0}), Status::kNotFinite) << "no room";
  EXPECT_EQ(calibration.report({1, 20.0, 1000.0, 0.0}), Status::kOk);
  ReferenceReport skew{1, 30.0, 1000.0, 0.0};
  skew.covariance << 1.0, 2.0, 2.0, 1.0;
  EXPECT_EQ(calibration.report(skew), Status::kNotFinite) << "no covariance";
  calibration.plots(std::vector<Plot>{{15.0, nan, 0.0, {}},
                                      {15.0, -1.0, 0.0, {}},
                                      {nan, 1e3, 0.0, {}},
                                      {15.0, 1010.0, 1e300, {}},
                                      {15.0, 1010.0, 0.01, {}}});
  EXPECT_EQ(calibration.solve().pairs.size(), 1u);
  EXPECT_THROW(Calibration(kRadar, {.max_gap_s = -1.0}), std::invalid_argument);
}

/// Offsets of range, bearing and time of one radar.
struct Errors {
  double range_m, bearing_rad, time_s;
};

constexpr Errors kThis{40.0, deg(2.0), 0.4}, kOther{-25.0, deg(-1.0), 0.1};

/// A radar at the origin and the tracks of another one, of eight vessels that both see.
CalibrationResult against_another(const Vec<double, 2>& antenna_m, std::uint64_t seed) {
  Draw draw(seed);
  Calibration calibration(kRadar);
  std::vector<Course> courses;
  for (int k = 0; k < 8; ++k) courses.push_back(some_course(draw, {}));
  for (double begin_s = 0.0; begin_s < 600.0; begin_s += kPeriod_s) {
    std::vector<Plot> plots;
    for (std::size_t k = 0; k < courses.size(); ++k) {
      const double tracked_s = begin_s + 0.1 * static_cast<double>(k);
      const Vec<double, 2> d = courses[k].place(tracked_s) - antenna_m;
      const double range_m = d.norm() + kOther.range_m + 4.0 * draw.normal();
      const double bearing_rad =
          std::atan2(d[1], d[0]) + kOther.bearing_rad + deg(0.2) * draw.normal();
      const Vec<double, 2> u{std::cos(bearing_rad), std::sin(bearing_rad)}, across{-u[1], u[0]};
      const Vec<double, 2> seen = antenna_m + range_m * u;
      const Vec<double, 2> way = courses[k].velocity(tracked_s) + 0.2 * draw.normals<2>();
      const double across_m = deg(0.2) * range_m;
      ReferenceReport report{static_cast<std::int64_t>(k),
                             tracked_s + kOther.time_s,
                             seen[0],
                             seen[1],
                             way[0],
                             way[1]};
      report.covariance =
          16.0 * u * u.transpose() + across_m * across_m * across * across.transpose();
      report.antenna_m = antenna_m;
      EXPECT_EQ(calibration.report(report), Status::kOk);
      const double time_s = begin_s + draw.uniform(0.0, kPeriod_s);
      const Vec<double, 2> place = courses[k].place(time_s);
      plots.push_back(
          {time_s + kThis.time_s,
           place.norm() + kThis.range_m + 10.0 * draw.normal(),
           std::atan2(place[1], place[0]) + kThis.bearing_rad + deg(0.5) * draw.normal(),
           {}});
    }
    std::sort(plots.begin(), plots.end(),
              [](const Plot& a, const Plot& b) { return a.time_s < b.time_s; });
    calibration.plots(plots);
  }
  return calibration.solve();
}

TEST(Calibration, AgainstAnotherRadarAtTheSamePlaceFindsTheDifferences) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const CalibrationResult found = against_another({0.0, 0.0}, seed);
    expect_within_four_std(found.range_m, kThis.range_m - kOther.range_m);
    expect_within_four_std(found.bearing_rad, kThis.bearing_rad - kOther.bearing_rad);
    expect_within_four_std(found.time_s, kThis.time_s - kOther.time_s);
    EXPECT_EQ(found.other_range_m.verdict, CalibrationVerdict::kPoorGeometry);
    EXPECT_EQ(found.other_bearing_rad.verdict, CalibrationVerdict::kPoorGeometry);
  }
}

TEST(Calibration, AgainstARadarElsewhereFindsTheOffsetsOfBoth) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const CalibrationResult found = against_another({3000.0, -2000.0}, seed);
    expect_within_four_std(found.range_m, kThis.range_m - kOther.range_m);
    expect_within_four_std(found.bearing_rad, kThis.bearing_rad - kOther.bearing_rad);
    expect_within_four_std(found.time_s, kThis.time_s - kOther.time_s);
    expect_within_four_std(found.other_range_m, kOther.range_m);
    expect_within_four_std(found.other_bearing_rad, kOther.bearing_rad);
  }
}

TEST(Calibration, OfManyPairsOfRadarsHasTheErrorThatItReports) {
  Vec<double, 5> squares = Vec<double, 5>::Zero();
  constexpr int kScenes = 20;
  for (int seed = 0; seed < kScenes; ++seed) {
    const CalibrationResult found =
        against_another({-1500.0, 3500.0}, 200 + static_cast<std::uint64_t>(seed));
    const auto off = [](const CalibratedOffset& one, double truth) {
      return (one.value - truth) / one.std;
    };
    const Vec<double, 5> error{off(found.range_m, kThis.range_m - kOther.range_m),
                               off(found.bearing_rad, kThis.bearing_rad - kOther.bearing_rad),
                               off(found.time_s, kThis.time_s - kOther.time_s),
                               off(found.other_range_m, kOther.range_m),
                               off(found.other_bearing_rad, kOther.bearing_rad)};
    squares += error.cwiseAbs2() / kScenes;
  }
  for (const double square : squares) {
    EXPECT_GT(square, 0.1);
    EXPECT_LT(square, 2.0);
  }
}

TEST(Radar, OffsetsAreSubtractedFromPlots) {
  const std::vector<Plot> plots{{101.0, 1000.0, 0.5, {}}, {102.0, 20.0, -3.0, {}}};
  std::vector<Plot> moved = plots;
  Radar radar = kRadar;
  radar.range_offset_m = 32.0;
  radar.bearing_offset_rad = 0.25;
  radar.time_offset_s = -0.5;
  for (Plot& plot : moved) {
    plot.range_m += radar.range_offset_m;
    plot.bearing_rad += radar.bearing_offset_rad;
    plot.time_s += radar.time_offset_s;
  }
  moved.push_back({101.0, 31.0, 0.0, {}});  // nearer than the offset
  ScanPlots expected(5), found(5);
  expected.convert(kRadar, plots, 102.5, 10.0);
  found.convert(radar, moved, 102.5, 10.0);
  ASSERT_EQ(found.size(), expected.size());
  for (int k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].time_s, expected[k].time_s);
    EXPECT_EQ(found[k].position.mean, expected[k].position.mean);
    EXPECT_EQ(found[k].position.covariance, expected[k].position.covariance);
  }
}

}  // namespace
}  // namespace wakeline::calibration_test
