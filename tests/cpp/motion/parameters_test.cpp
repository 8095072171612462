// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/singer.hpp"

namespace wakeline::parameters_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What `model.validate()` says, or nothing.
template <class Model>
std::string complaint(const Model& model) {
  try {
    model.validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

bool names(const std::string& message, const std::string& word) {
  return message.find(word) != std::string::npos;
}

TEST(MotionParameters, DefaultsAreValid) {
  EXPECT_EQ(complaint(ConstantVelocity{}), "");
  EXPECT_EQ(complaint(ConstantAcceleration{}), "");
  EXPECT_EQ(complaint(CoordinatedTurn{}), "");
  EXPECT_EQ(complaint(CoordinatedTurnRate{}), "");
  EXPECT_EQ(complaint(Singer{}), "");
}

TEST(MotionParameters, NoNoiseIsAllowed) {
  EXPECT_EQ(complaint(ConstantVelocity{.noise = WhiteAcceleration{0.0}}), "");
  EXPECT_EQ(complaint(CoordinatedTurnRate{.turn_rate_psd_rad2s3 = 0.0}), "");
}

TEST(MotionParameters, AWrongNoiseIsNamed) {
  for (const double bad : {-0.1, kNan, kInfinity}) {
    EXPECT_TRUE(names(complaint(ConstantVelocity{.noise = WhiteAcceleration{bad}}), "psd_m2s3"))
        << bad;
    EXPECT_TRUE(names(complaint(CoordinatedTurn{.noise = PiecewiseAcceleration{bad}}), "std_mps2"))
        << bad;
    EXPECT_TRUE(names(complaint(ConstantAcceleration{.noise = WhiteJerk{bad}}), "psd_m2s5")) << bad;
    EXPECT_TRUE(names(complaint(CoordinatedTurnRate{.noise = WhiteAcceleration{bad}}), "psd_m2s3"))
        << bad;
  }
}

TEST(MotionParameters, WhiteJerkNeedsAnAcceleration) {
  for (const std::string& message : {complaint(ConstantVelocity{.noise = WhiteJerk{}}),
                                     complaint(CoordinatedTurn{.noise = WhiteJerk{}}),
                                     complaint(CoordinatedTurnRate{.noise = WhiteJerk{}})})
    EXPECT_TRUE(names(message, "white jerk needs an acceleration in the state")) << message;
  EXPECT_EQ(complaint(ConstantAcceleration{.noise = WhiteJerk{}}), "");
}

TEST(MotionParameters, AWrongParameterIsNamedWithItsValue) {
  for (const double bad : {-1.0, 0.0, kNan, kInfinity}) {
    EXPECT_TRUE(names(complaint(Singer{.maneuver_time_s = bad}), "maneuver_time_s")) << bad;
    EXPECT_TRUE(names(complaint(Singer{.accel_std_mps2 = bad}), "accel_std_mps2")) << bad;
    EXPECT_TRUE(names(complaint(CoordinatedTurnRate{.prior_turn_rate_std_rad_s = bad}),
                      "prior_turn_rate_std_rad_s"))
        << bad;
    EXPECT_TRUE(
        names(complaint(ConstantAcceleration{.prior_accel_std_mps2 = bad}), "prior_accel_std_mps2"))
        << bad;
  }
  for (const double bad : {kNan, kInfinity})
    EXPECT_TRUE(names(complaint(CoordinatedTurn{.turn_rate_rad_s = bad}), "turn_rate_rad_s"))
        << bad;
  EXPECT_TRUE(
      names(complaint(CoordinatedTurnRate{.turn_rate_psd_rad2s3 = -2.5}), "turn_rate_psd_rad2s3"));
  EXPECT_TRUE(names(complaint(CoordinatedTurnRate{.turn_rate_psd_rad2s3 = -2.5}), "got -2.5"));
  for (const double bad : {-1.0, kNan, kInfinity})
    EXPECT_TRUE(names(complaint(CoordinatedTurnRate{.turn_rate_time_s = bad}), "turn_rate_time_s"))
        << bad;
}

TEST(MotionParameters, PriorOfWhatAStartDoesNotKnow) {
  EXPECT_DOUBLE_EQ(
      prior_variance(CoordinatedTurnRate{.prior_turn_rate_std_rad_s = 0.2}, Component::kTurnRate),
      0.04);
  EXPECT_DOUBLE_EQ(
      prior_variance(ConstantAcceleration{.prior_accel_std_mps2 = 3.0}, Component::kAeast), 9.0);
  EXPECT_DOUBLE_EQ(prior_variance(Singer{.accel_std_mps2 = 0.5}, Component::kAnorth), 0.25);
  EXPECT_DOUBLE_EQ(prior_variance(ConstantVelocity{}, Component::kUser), 1.0) << "no opinion";
}

}  // namespace
}  // namespace wakeline::parameters_test
