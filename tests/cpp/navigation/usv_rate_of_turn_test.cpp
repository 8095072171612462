// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A rate of turn beside the gyro that drives the steps: both have the noise of the gyro.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/core/chi_square.hpp"
#include "wakeline/filter/augmented_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/navigation/usv_navigator.hpp"

namespace wakeline::usv_rate_of_turn_test {
namespace {

using Vec2 = Vec<double, 2>;

Vec<double, 1> of(double z) { return Vec<double, 1>(z); }

constexpr double kGyroStd = deg(1.0), kRateStd = deg(0.1);
constexpr double kCompassStd = deg(1.0);

template <class Model>
Model noisy_gyro() {
  Model model;
  model.input.noise.yaw_rate_std_rad_s = kGyroStd;
  return model;
}

/// NEES of heading and gyro bias after a minute, with a rate of turn every so many steps and a
/// compass every seven.
template <class Navigator, class Model>
double nees_after_a_minute(test::Draw& draw, const Model& model, int every) {
  constexpr int kBias = index_of(Model::kComponents, kGyroBias);
  constexpr int kHeadingAt = index_of(Model::kComponents, kHeading);
  Navigator navigator(model, {.rejections = 0});
  const UsvStart start;
  double heading = start.heading_std_rad * draw.normal();
  const double bias = model.gyro_bias_std_rad_s * draw.normal();
  (void)navigator.start(start);
  for (int k = 1; k <= 60; ++k) {
    const double turn = deg(2) * std::sin(0.1 * k);
    heading += turn;
    Imu imu;
    imu.yaw_rate_rad_s = turn + bias + kGyroStd * draw.normal();
    auto leg = navigator.leg(1.0, imu);
    leg.input.noise.yaw_rate_std_rad_s = kGyroStd;
    EXPECT_EQ(navigator.predict(leg), Status::kOk);
    if (k % 7 == 0) {
      EXPECT_TRUE(navigator.update(Compass(kCompassStd),
                                   of(wrap_angle(heading + kCompassStd * draw.normal()))));
    }
    if (every > 0 && k % every == 0) {
      EXPECT_TRUE(navigator.update(RateOfTurn{.rate_std_rad_s = kRateStd,
                                              .gyro_rad_s = imu.yaw_rate_rad_s,
                                              .gyro_std_rad_s = kGyroStd},
                                   of(turn + kRateStd * draw.normal())));
    }
  }
  const auto& belief = navigator.estimate();
  const Vec2 error(wrap_angle(belief.mean[kHeadingAt] - heading), belief.mean[kBias] - bias);
  Mat<double, 2, 2> p;
  p << belief.covariance(kHeadingAt, kHeadingAt), belief.covariance(kHeadingAt, kBias),
      belief.covariance(kBias, kHeadingAt), belief.covariance(kBias, kBias);
  return Cholesky<2>(p).squared_norm(error);
}

template <class Navigator, class Model>
void expect_consistent(const Model& model) {
  for (const int every : {0, 1, 5}) {
    test::Draw draw(7);
    constexpr int kRuns = 250;
    double sum = 0.0;
    for (int run = 0; run < kRuns; ++run) sum += nees_after_a_minute<Navigator>(draw, model, every);
    EXPECT_GT(sum, chi_square_quantile(0.0005, 2 * kRuns)) << every;
    EXPECT_LT(sum, chi_square_quantile(0.9995, 2 * kRuns)) << every;
  }
}

TEST(RateOfTurnBesideTheGyro, LeavesHeadingAndBiasConsistentInAnEkf) {
  expect_consistent<UsvNavigator<UsvBiasMotion>>(noisy_gyro<UsvBiasMotion>());
}
TEST(RateOfTurnBesideTheGyro, LeavesHeadingAndBiasConsistentInAUkf) {
  expect_consistent<UsvNavigator<UsvBiasMotion, Ukf>>(noisy_gyro<UsvBiasMotion>());
}
TEST(RateOfTurnBesideTheGyro, LeavesHeadingAndBiasConsistentInAnAugmentedUkf) {
  expect_consistent<UsvNavigator<UsvBiasMotion, AugmentedUkf>>(noisy_gyro<UsvBiasMotion>());
}
TEST(RateOfTurnBesideTheGyro, LeavesHeadingAndBiasConsistentInACurrent) {
  expect_consistent<UsvNavigator<UsvCurrentMotion>>(noisy_gyro<UsvCurrentMotion>());
}

TEST(RateOfTurnBesideTheGyro, LeavesHeadingAndBiasConsistentWhereAStepHasItsOwnNoise) {
  UsvBiasMotion quieter = noisy_gyro<UsvBiasMotion>(), louder = quieter;
  quieter.input.noise.yaw_rate_std_rad_s = kGyroStd / 30;
  louder.input.noise.yaw_rate_std_rad_s = kGyroStd * 30;
  expect_consistent<UsvNavigator<UsvBiasMotion>>(quieter);
  expect_consistent<UsvNavigator<UsvBiasMotion>>(louder);
}

/// A minute as before, smoothed: sums of the NEES of heading and gyro bias, and of the squared
/// error of the heading as it was filtered and as it is smoothed, of five times in between.
template <class Navigator, class Model>
Vec<double, 3> smoothed(test::Draw& draw, const Model& model) {
  constexpr int kBias = index_of(Model::kComponents, kGyroBias);
  constexpr int kHeadingAt = index_of(Model::kComponents, kHeading);
  Navigator navigator(model, {.rejections = 0});
  const UsvStart start;
  std::vector<double> heading{start.heading_std_rad * draw.normal()};
  const double bias = model.gyro_bias_std_rad_s * draw.normal();
  (void)navigator.start(start);
  std::vector<typename Navigator::State> beliefs{navigator.estimate()};
  std::vector<typename Navigator::Leg> legs;
  for (int k = 1; k <= 60; ++k) {
    const double turn = deg(2) * std::sin(0.1 * k);
    heading.push_back(heading.back() + turn);
    Imu imu;
    imu.yaw_rate_rad_s = turn + bias + kGyroStd * draw.normal();
    legs.push_back(navigator.leg(1.0, imu));
    EXPECT_EQ(navigator.predict(legs.back()), Status::kOk);
    if (k % 7 == 0) {
      EXPECT_TRUE(navigator.update(Compass(kCompassStd),
                                   of(wrap_angle(heading.back() + kCompassStd * draw.normal()))));
    }
    const RateOfTurn indicator{kRateStd, imu.yaw_rate_rad_s, kGyroStd};
    const auto rate = of(turn + kRateStd * draw.normal());
    EXPECT_TRUE(navigator.update(indicator, rate));
    legs.back() = Navigator::turned_by(indicator, rate, legs.back());
    beliefs.push_back(navigator.estimate());
  }
  const auto filtered = beliefs;
  EXPECT_EQ(navigator.smooth(beliefs, legs), Status::kOk);
  Vec<double, 3> sums = Vec<double, 3>::Zero();
  for (const std::size_t k : {5U, 18U, 30U, 39U, 53U}) {
    const auto off = [&](const auto& belief) {
      return Vec2(wrap_angle(belief.mean[kHeadingAt] - heading[k]), belief.mean[kBias] - bias);
    };
    const Mat<double, kStatesOf<Model>, kStatesOf<Model>>& c = beliefs[k].covariance;
    Mat<double, 2, 2> p;
    p << c(kHeadingAt, kHeadingAt), c(kHeadingAt, kBias), c(kBias, kHeadingAt), c(kBias, kBias);
    sums += Vec<double, 3>(Cholesky<2>(p).squared_norm(off(beliefs[k])),
                           std::pow(off(filtered[k])[0], 2), std::pow(off(beliefs[k])[0], 2));
  }
  return sums;
}

template <class Navigator, class Model>
void expect_smooths(const Model& model) {
  test::Draw draw(7);
  constexpr int kRuns = 200;
  Vec<double, 3> sums = Vec<double, 3>::Zero();
  for (int run = 0; run < kRuns; ++run) sums += smoothed<Navigator>(draw, model);
  EXPECT_NEAR(sums[0] / (5 * kRuns), 2.0, 0.3);
  EXPECT_LT(sums[2], 0.8 * sums[1]);
}

TEST(RateOfTurnBesideTheGyro, IsSmoothedByAnEkf) {
  expect_smooths<UsvNavigator<UsvBiasMotion>>(noisy_gyro<UsvBiasMotion>());
}
TEST(RateOfTurnBesideTheGyro, IsSmoothedByAUkf) {
  expect_smooths<UsvNavigator<UsvBiasMotion, Ukf>>(noisy_gyro<UsvBiasMotion>());
}
TEST(RateOfTurnBesideTheGyro, IsSmoothedInACurrent) {
  expect_smooths<UsvNavigator<UsvCurrentMotion>>(noisy_gyro<UsvCurrentMotion>());
}

}  // namespace
}  // namespace wakeline::usv_rate_of_turn_test
