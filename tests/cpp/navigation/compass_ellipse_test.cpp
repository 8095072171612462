// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/compass_ellipse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"

namespace wakeline::compass_ellipse_test {
namespace {

using test::Draw;
using Vec2 = Vec<double, 2>;
using Mat2 = Mat<double, 2, 2>;
constexpr double kTurn = 2 * kPi<double>;

/// Iron of a random vessel in a field of this strength.
CompassEllipse iron(Draw& draw, double field = 1.0) {
  CompassEllipse ellipse;
  ellipse.hard_iron = field * draw.uniform(0, 1.5) * draw.normals<2>();
  const double a = draw.uniform(0.7, 1.3), b = draw.uniform(-0.25, 0.25),
               c = draw.uniform(0.7, 1.3);
  ellipse.soft_iron << a, b, b, c;
  ellipse.soft_iron *= field;
  return ellipse;
}

CompassCalibration::Fit calibrated(const CompassEllipse& truth, int readings, double arc_rad,
                                   double noise, Draw& draw) {
  CompassCalibration calibration;
  const double start = draw.uniform(0, kTurn);
  for (int k = 0; k < readings; ++k) {
    const Vec2 field = truth.field(start + arc_rad * k / readings) + noise * draw.normals<2>();
    EXPECT_EQ(calibration.add(field), Status::kOk);
  }
  return calibration.fit();
}

double worst_heading_error(const CompassEllipse& truth, const CompassEllipse& fitted) {
  double worst = 0.0;
  for (double heading = 0; heading < kTurn; heading += deg(5))
    worst =
        std::max(worst, std::abs(wrap_angle(fitted.heading_rad(truth.field(heading)) - heading)));
  return worst;
}

TEST(CompassEllipse, GivesTheHeadingOfItsField) {
  Draw draw(1);
  for (int k = 0; k < 100; ++k) {
    const CompassEllipse ellipse = iron(draw, draw.uniform(1e-6, 50));
    EXPECT_LT(worst_heading_error(ellipse, ellipse), 1e-12);
  }
}

TEST(CompassEllipse, WithoutIronReadsTheFieldItself) {
  const CompassEllipse none;
  EXPECT_DOUBLE_EQ(none.heading_rad({20, 0}), 0.0);
  EXPECT_DOUBLE_EQ(none.heading_rad({0, -20}), kPi<double> / 2);  // north to port: headed east
}

TEST(CompassCalibration, RecoversTheIronOfATurnWithoutNoise) {
  Draw draw(2);
  for (int k = 0; k < 100; ++k) {
    const double field = std::exp(draw.uniform(-10, 5));  // any unit
    const CompassEllipse truth = iron(draw, field);
    const auto fit = calibrated(truth, 72, draw.uniform(0.6, 1.2) * kTurn, 0.0, draw);
    ASSERT_EQ(fit.status, Status::kOk);
    EXPECT_LT((fit.ellipse.hard_iron - truth.hard_iron).norm(), 1e-8 * field);
    EXPECT_LT((fit.ellipse.soft_iron - truth.soft_iron).norm(), 1e-8 * field);
    EXPECT_LT(fit.heading_std_rad, 1e-5);
  }
}

TEST(CompassCalibration, ErrsAsItReports) {
  Draw draw(3);
  constexpr int kRuns = 400;
  for (const double turns : {2.0, 0.5}) {
    double squares = 0.0;
    for (int k = 0; k < kRuns; ++k) {
      const CompassEllipse truth = iron(draw);
      const auto fit = calibrated(truth, 144, turns * kTurn, deg(1), draw);
      ASSERT_EQ(fit.status, Status::kOk);
      EXPECT_LT(fit.heading_std_rad, turns > 1 ? deg(1) : deg(10));
      const double ratio = worst_heading_error(truth, fit.ellipse) / fit.heading_std_rad;
      EXPECT_LT(ratio, 5) << turns;
      squares += ratio * ratio / kRuns;
    }
    EXPECT_GT(squares, 0.5) << turns;  // the worst of all headings is about that reported
    EXPECT_LT(squares, 4.0) << turns;
  }
}

TEST(CompassCalibration, IsBetterWithMoreReadingsAndALongerArc) {
  double before = std::numeric_limits<double>::infinity();
  for (const double arc : {0.3, 0.5, 0.7, 1.0}) {
    Draw draw(4);
    const CompassEllipse truth = iron(draw);
    const double std = calibrated(truth, 200, arc * kTurn, deg(1), draw).heading_std_rad;
    EXPECT_LT(std, before);
    before = std;
  }
  Draw draw(4);
  const CompassEllipse truth = iron(draw);
  const double std = calibrated(truth, 3200, kTurn, deg(1), draw).heading_std_rad;
  EXPECT_NEAR(std / before, 0.25, 0.05);
}

TEST(CompassCalibration, ReportsReadingsThatShowNoEllipse) {
  CompassCalibration calibration;
  EXPECT_EQ(calibration.fit().status, Status::kNotStarted);
  EXPECT_EQ(calibration.add({std::nan(""), 0}), Status::kNotFinite);
  for (int k = 0; k < 20; ++k) ASSERT_EQ(calibration.add({1.0, 0.5}), Status::kOk);  // no turn
  EXPECT_EQ(calibration.fit().status, Status::kNotPositiveDefinite);
  EXPECT_EQ(calibration.readings(), 20);
  CompassCalibration hyperbola;
  for (int k = -5; k <= 5; ++k)
    ASSERT_EQ(hyperbola.add({std::cosh(k / 4.), std::sinh(k / 4.)}), Status::kOk);
  EXPECT_NE(hyperbola.fit().status, Status::kOk);
}

TEST(CompassCalibration, WorksWithoutTheHeap) {
  Draw draw(5);
  const CompassEllipse truth = iron(draw);
  const test::NoHeap fence;
  EXPECT_EQ(calibrated(truth, 50, kTurn, 0.01, draw).status, Status::kOk);
  EXPECT_EQ(fence.allocations(), 0);
}

}  // namespace
}  // namespace wakeline::compass_ellipse_test
