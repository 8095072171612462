// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What a start believes: the speed limit as a prior, and as a gate.
#include "wakeline/track/start.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "track/scene.hpp"
#include "wakeline/track/radar.hpp"

namespace wakeline::start_test {
namespace {

using test::matrices_near;

TEST(SpeedPrior, IsAKalmanUpdateWithAVelocityOfZero) {
  test::Draw draw(1);
  for (int k = 0; k < 100; ++k) {
    const Gaussian<4> belief{100.0 * draw.normals<4>(), 50.0 * draw.definite<4>()};
    const double std = draw.uniform(1.0, 30.0);
    Mat<double, 2, 4> h = Mat<double, 2, 4>::Zero();
    h(0, 1) = h(1, 3) = 1.0;
    const Mat<double, 2, 2> s =
        h * belief.covariance * h.transpose() + std * std * Mat<double, 2, 2>::Identity();
    const Mat<double, 2, 4> hp = h * belief.covariance;
    const Mat<double, 4, 2> gain = Cholesky<2>(s).solve<4>(hp).transpose();
    const Gaussian<4> actual = with_speed_prior(belief, std);
    EXPECT_TRUE(matrices_near(actual.mean, Vec<double, 4>(belief.mean - gain * h * belief.mean),
                              {.absolute = 1e-9, .relative = 1e-9}));
    EXPECT_TRUE(matrices_near(actual.covariance,
                              Mat<double, 4, 4>(belief.covariance - gain * h * belief.covariance),
                              {.absolute = 1e-9, .relative = 1e-9}));
    EXPECT_TRUE(Cholesky<4>(actual.covariance).ok());
  }
}

TEST(SpeedPrior, KnowsTheVelocityHoweverShortTheTimeBetweenTwoPlots) {
  const Mat<double, 2, 2> unit = Mat<double, 2, 2>::Identity();
  const Gaussian<2> first{{1000.0, 0.0}, 100.0 * unit}, second{{1004.0, -3.0}, 100.0 * unit};
  for (const double dt_s : {1e-3, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12}) {
    const Gaussian<4> belief = with_speed_prior(two_point<double>(first, second, dt_s), 20.0);
    // Without time between them they are two plots of one place, which tell nothing of a velocity.
    EXPECT_TRUE(matrices_near(belief.mean, Vec<double, 4>(1002.0, 0.0, -1.5, 0.0),
                              {.absolute = 0.02, .relative = 0}))
        << dt_s << " s\n"
        << belief.mean;
    EXPECT_TRUE(matrices_near(belief.covariance.diagonal().eval(),
                              Vec<double, 4>(50.0, 400.0, 50.0, 400.0),
                              {.absolute = 0, .relative = 1e-3}))
        << dt_s << " s\n"
        << belief.covariance;
    EXPECT_TRUE(Cholesky<4>(belief.covariance).ok()) << dt_s << " s";
  }
}

TEST(SpeedPrior, SlowsButNeverTurnsRound) {
  const Gaussian<2> first{{1000.0, 0.0}, 100.0 * Mat<double, 2, 2>::Identity()};
  const Gaussian<2> second{{1000.0, 60.0}, 100.0 * Mat<double, 2, 2>::Identity()};
  const Gaussian<4> belief = two_point<double>(first, second, 2.5);
  const Gaussian<4> slower = with_speed_prior(belief, 10.0);
  EXPECT_GT(slower.mean[3], 0.0);
  EXPECT_LT(slower.mean[3], belief.mean[3]);
  EXPECT_NEAR(slower.mean[1], 0.0, 1e-12);
  EXPECT_TRUE(matrices_near(with_speed_prior(belief, 1e9).mean, belief.mean,
                            {.absolute = 1e-6, .relative = 1e-9}));
}

TEST(SpeedGate, IsTheDistanceAndTheErrorAlongIt) {
  Mat<double, 2, 2> wide = Mat<double, 2, 2>::Zero();
  wide.diagonal() << 1.0, 10'000.0;  // 1 m north, 100 m east
  const auto reaches = [&](double north, double east, double sigmas) {
    return within_speed_limit({{0.0, 0.0}, wide}, {{north, east}, wide}, 2.0, 10.0, sigmas);
  };
  EXPECT_TRUE(reaches(19.9, 0.0, 0.0));
  EXPECT_FALSE(reaches(20.1, 0.0, 0.0));
  EXPECT_TRUE(reaches(24.1, 0.0, 3.0));  // 20 m + 3 sqrt(2) m
  EXPECT_FALSE(reaches(24.5, 0.0, 3.0));
  EXPECT_TRUE(reaches(0.0, 440.0, 3.0));
  EXPECT_FALSE(reaches(0.0, 450.0, 3.0));
  EXPECT_TRUE(reaches(0.0, 0.0, 0.0));
}

TEST(RadarPlots, HaveTheErrorsThatTheirCovarianceSays) {
  const Radar radar{.range_std_m = 20.0,
                    .bearing_std_rad = deg(2.0),
                    .extent_std_m = 5.0,
                    .bearing_offset_rad = deg(3.0)};
  const Vec<double, 2> truth(1200.0, -900.0);
  test::Draw draw(2);
  double nis = 0.0;
  Vec<double, 2> mean = Vec<double, 2>::Zero();
  constexpr int kDraws = 20'000;
  for (int k = 0; k < kDraws; ++k) {
    const Vec<double, 2> echo = truth + 5.0 * draw.normals<2>();
    const Gaussian<2> position =
        radar.position(echo.norm() + 20.0 * draw.normal(),
                       std::atan2(echo[1], echo[0]) + deg(3.0) + deg(2.0) * draw.normal(), {});
    const Vec<double, 2> error = position.mean - truth;
    mean += error / kDraws;
    nis += Cholesky<2>(position.covariance).whiten<1>(error).squaredNorm() / kDraws;
  }
  EXPECT_NEAR(nis, 2.0, 0.06);
  EXPECT_LT(mean.norm(), 2.0);
}

TEST(Start, IsAsDoubtfulAsPlotsThatMayBeWild) {
  const test::Boat boat{{1500.0, 800.0}, {5.0, -3.0}};
  const auto covariance_at_start = [&](double outlier_probability) {
    const TrackerConfig config{.outlier_probability = outlier_probability,
                               .outlier_scale = 4.0,
                               .start_speed_factor = 0.0};
    test::VesselTracker tracker(test::kTestRadar, config, vessel_imm(test::kTestRadar));
    for (const double time_s : {0.0, 2.5}) {
      const Plot plot = test::exact_plot(boat.at(time_s), time_s);
      EXPECT_EQ(tracker.process(time_s, {&plot, 1}).status, Status::kOk);
    }
    EXPECT_EQ(tracker.size(), 1);
    Mat<double, 4, 4> covariance = Mat<double, 4, 4>::Zero();
    tracker.for_each([&](const Track& track) { covariance = track.kinematics.covariance; });
    return covariance;
  };
  EXPECT_TRUE(matrices_near(covariance_at_start(0.2),
                            Mat<double, 4, 4>((0.8 + 0.2 * 16.0) * covariance_at_start(0.0)),
                            {.absolute = 0, .relative = 1e-9}));
}

}  // namespace
}  // namespace wakeline::start_test
