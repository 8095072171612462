// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/time_alignment.hpp"

#include <gtest/gtest.h>

#include "support/matrix_assert.hpp"
#include "track/stages.hpp"

namespace wakeline::time_alignment_test {
namespace {

using namespace test;

Track moving_track() {
  Track track = track_at(0, {1000.0, 10.0, 0.0, -5.0}, {5.0, 2.0, 5.0, 3.0});
  track.time_s = 10.0;
  return track;
}

TEST(TimeAlignment, MovesAPlotWithTheVelocityOfTheTrack) {
  const TimeAlignment alignment(moving_track(), 2.5, 0.0);
  const ScanPlot plot{{{980.0, 12.0}, Mat<double, 2, 2>::Identity()}, 8.0, 0, 0.0, false};
  EXPECT_TRUE(matrices_near(alignment.at_prediction(plot).mean, Vec<double, 2>(1000.0, 2.0),
                            {.absolute = 1e-12, .relative = 0}));
  EXPECT_EQ(alignment.longest_way_m(2.0), 20.0);
}

TEST(TimeAlignment, ThePositionAtConstantVelocityIsThatOfTheWholeBelief) {
  Track track = moving_track();
  track.kinematics.covariance +=
      Vec<double, 4>(3.0, -1.0, 2.0, 0.5) * Vec<double, 4>(3.0, -1.0, 2.0, 0.5).transpose();
  for (const double dt_s : {-2.5, 0.0, 3.0}) {
    const Gaussian<2> position = position_at_constant_velocity(track.kinematics, dt_s);
    const Gaussian<2> of_all = position_in(at_constant_velocity(track.kinematics, dt_s));
    EXPECT_TRUE(matrices_near(position.mean, of_all.mean, {.absolute = 0, .relative = 1e-14}));
    EXPECT_TRUE(
        matrices_near(position.covariance, of_all.covariance, {.absolute = 0, .relative = 1e-14}));
  }
}

TEST(TimeAlignment, AddsTheErrorOfTheVelocityAndOfManeuversBeyondAPeriod) {
  const TimeAlignment alignment(moving_track(), 2.5, 0.5);
  EXPECT_EQ(alignment.added_m2(0.0), (Mat<double, 2, 2>::Zero()));
  for (const double dt_s : {-2.0, 2.0})
    EXPECT_TRUE(matrices_near(alignment.added_m2(dt_s).diagonal().eval(),
                              Vec<double, 2>(4.0 * 4.0, 4.0 * 9.0),
                              {.absolute = 1e-12, .relative = 0}));
  EXPECT_TRUE(matrices_near(alignment.added_m2(4.0).diagonal().eval(),
                            Vec<double, 2>(16.0 * 4.0 + 0.5 * 64.0, 16.0 * 9.0 + 0.5 * 64.0),
                            {.absolute = 1e-12, .relative = 0}));
}

TEST(ExpectedTime, IsThatOfTheNearestPlotElseOfTheScan) {
  Track track = moving_track();
  const ScanPlots near =
      scan_of({plot_at(1020.0, -12.0, 12.0), plot_at(1100.0, 100.0, 11.0)}, 12.5);
  EXPECT_EQ(expected_time_s(track, near, 25.0), 12.0);
  const ScanPlots far = scan_of({plot_at(-9000.0, 0.0, 12.0)}, 12.5);
  EXPECT_EQ(expected_time_s(track, far, 25.0), 12.5);
  EXPECT_EQ(expected_time_s(track, scan_of({}, 12.5), 25.0), 12.5);
}

}  // namespace
}  // namespace wakeline::time_alignment_test
