// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/filter/augmented_ukf.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/navigation/usv_models.hpp"

namespace wakeline::augmented_ukf_test {
namespace {

using test::Draw;
using test::matrices_identical;
using test::matrices_near;
using Vec2 = Vec<double, 2>;

/// A vessel on a line whose acceleration is measured, with errors held over a step.
struct MeasuredAcceleration {
  static constexpr auto kComponents = ConstantVelocity::kComponents;
  static constexpr int kInputs = 2;

  Vec2 acceleration_mps2 = Vec2::Zero();
  double std_mps2 = 0.3;

  template <class S>
  Vec<S, 4> transition(const Vec<S, 4>& x, S dt_s) const noexcept {
    const Vec<S, 2> a = acceleration_mps2.cast<S>();
    Vec<S, 4> moved = x;
    for (const int axis : {0, 1}) {
      moved[2 * axis] += dt_s * (x[2 * axis + 1] + dt_s / 2 * a[axis]);
      moved[2 * axis + 1] += dt_s * a[axis];
    }
    return moved;
  }
  template <class S>
  Mat<S, 4, 4> jacobian(const Vec<S, 4>&, S dt_s) const noexcept {
    return ConstantVelocity{}.matrix(dt_s);
  }
  template <class S>
  Mat<S, 4, 4> process_noise(const Vec<S, 4>&, S dt_s) const noexcept {
    return ConstantVelocity{PiecewiseAcceleration{std_mps2}}.process_noise(dt_s);
  }
  template <class S>
  Mat<S, 4, 4> walk_noise(const Vec<S, 4>&, S) const noexcept {
    return Mat<S, 4, 4>::Zero();
  }
  [[nodiscard]] Vec2 input_std() const noexcept { return Vec2::Constant(std_mps2); }
  [[nodiscard]] MeasuredAcceleration disturbed(const Vec2& error) const noexcept {
    return {acceleration_mps2 + error, std_mps2};
  }
};

Gaussian<7> in_a_current() {
  Gaussian<7> belief;
  belief.mean << 10, -20, 0.4, 5, deg(0.3), 0.4, -0.2;
  const Vec<double, 7> std{8, 7, deg(1), 0.2, deg(0.5), 0.3, 0.3};
  belief.covariance = std.cwiseAbs2().asDiagonal();
  return belief;
}

// What the prediction is --------------------------------------------------------------------------

TEST(AugmentedUkf, IsTheKalmanFilterOnALinearMotion) {
  Draw draw(1);
  const MeasuredAcceleration motion{{0.2, -0.1}};
  for (const Unscented unscented : {Unscented{}, Unscented{0.5, 2, 1}, Unscented{1e-2, 2, 0}}) {
    AugmentedUkf<MeasuredAcceleration> augmented(motion, unscented);
    Ekf<MeasuredAcceleration> kalman(motion);
    const Gaussian<4> start{draw.normals<4>(), draw.definite<4>()};
    ASSERT_EQ(augmented.start(start), Status::kOk);
    ASSERT_EQ(kalman.start(start), Status::kOk);
    for (int k = 0; k < 30; ++k) {
      const double dt_s = draw.uniform(0.1, 3);
      ASSERT_EQ(augmented.predict(dt_s), Status::kOk);
      ASSERT_EQ(kalman.predict(dt_s), Status::kOk);
      const Vec2 z = kalman.estimate().mean(std::array{0, 2}) + draw.normals<2>();
      ASSERT_TRUE(augmented.update(Position{}, z));
      ASSERT_TRUE(kalman.update(Position{}, z));
      EXPECT_TRUE(matrices_near(augmented.estimate().mean, kalman.estimate().mean, {1e-9, 1e-9}));
      EXPECT_TRUE(matrices_near(augmented.estimate().covariance, kalman.estimate().covariance,
                                {1e-9, 1e-9}));
    }
  }
}

// The IMU's errors enter the inertial motion linearly where its acceleration is turned by the
// heading at the start: three more inputs are three more of kappa.
TEST(AugmentedUkf, IsAUkfOfPointsAsFarOutWhereErrorsEnterLinearly) {
  Draw draw(2);
  UsvBiasMotion motion{.turned_at = 0.0};
  motion.input = {{0.3, -0.2, 0.08}, {0.1, deg(2)}};
  AugmentedUkf<UsvBiasMotion> augmented(motion);
  Ukf<UsvBiasMotion> additive(motion, Unscented{.kappa = 3});
  Gaussian<8> start = motion.start_belief<double>({.heading_rad = 0.7});
  start.covariance(4, 4) = 0.2;
  ASSERT_EQ(augmented.start(start), Status::kOk);
  ASSERT_EQ(additive.start(start), Status::kOk);
  for (int k = 0; k < 5; ++k) {
    ASSERT_EQ(augmented.predict(1.5), Status::kOk);
    ASSERT_EQ(additive.predict(1.5), Status::kOk);
  }
  EXPECT_TRUE(matrices_near(augmented.estimate().mean, additive.estimate().mean, {1e-11, 1e-11}));
  EXPECT_TRUE(matrices_near(augmented.estimate().covariance, additive.estimate().covariance,
                            {1e-11, 1e-11}));
}

// Without an error of the readings there is the walk, once.
TEST(AugmentedUkf, AddsTheWalkOnce) {
  UsvCurrentMotion motion;
  motion.input = {{0, 0, 0.05}, {0, 0}};
  AugmentedUkf<UsvCurrentMotion> augmented(motion);
  Ukf<UsvCurrentMotion> additive(motion, Unscented{.kappa = 1});
  ASSERT_EQ(augmented.start(in_a_current()), Status::kOk);
  ASSERT_EQ(additive.start(in_a_current()), Status::kOk);
  ASSERT_EQ(augmented.predict(20.0), Status::kOk);
  ASSERT_EQ(additive.predict(20.0), Status::kOk);
  EXPECT_TRUE(matrices_near(augmented.estimate().mean, additive.estimate().mean, {1e-11, 1e-11}));
  EXPECT_TRUE(matrices_near(augmented.estimate().covariance, additive.estimate().covariance,
                            {1e-11, 1e-11}));
}

// Over a long step a large error of the gyro bends the way, and makes it shorter on average: of
// that additive noise knows nothing.
TEST(AugmentedUkf, HasTheMeanOfDrawsWhereErrorsBendTheWay) {
  constexpr int kDraws = 100000;
  constexpr double kStep = 10.0;
  UsvCurrentMotion motion;
  motion.input = {{0, 0, deg(2)}, {0, deg(3)}};
  AugmentedUkf<UsvCurrentMotion> augmented(motion);
  Ukf<UsvCurrentMotion> additive(motion);
  ASSERT_EQ(augmented.start(in_a_current()), Status::kOk);
  ASSERT_EQ(additive.start(in_a_current()), Status::kOk);
  ASSERT_EQ(augmented.predict(kStep), Status::kOk);
  ASSERT_EQ(additive.predict(kStep), Status::kOk);

  Draw draw(3);
  Vec<double, 7> mean = Vec<double, 7>::Zero();
  for (int k = 0; k < kDraws; ++k) {
    const Vec<double, 1> error = motion.input_std() * draw.normal();
    mean += motion.disturbed(error).transition(draw.of(in_a_current()), kStep) / kDraws;
  }
  const Vec<double, 7> std = augmented.estimate().covariance.diagonal().cwiseSqrt();
  const auto apart = [&](const auto& filter) {
    return (filter.estimate().mean - mean).cwiseQuotient(std).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(apart(augmented), 0.02);
  EXPECT_GT(apart(additive), 0.1);
}

// What every filter keeps -------------------------------------------------------------------------

TEST(AugmentedUkf, RejectsAnImpossibleStepAndStaysUnchanged) {
  AugmentedUkf<UsvCurrentMotion> filter{UsvCurrentMotion{}};
  EXPECT_EQ(filter.predict(1.0), Status::kNotStarted);
  ASSERT_EQ(filter.start(in_a_current()), Status::kOk);
  EXPECT_EQ(filter.predict(-1.0), Status::kNegativeTimeStep);
  EXPECT_EQ(filter.predict(std::numeric_limits<double>::quiet_NaN()), Status::kNotFinite);
  UsvCurrentMotion lost;
  lost.input.imu.yaw_rate_rad_s = std::numeric_limits<double>::infinity();
  filter.set_motion(lost);
  EXPECT_EQ(filter.predict(1.0), Status::kNotFinite);
  EXPECT_TRUE(matrices_identical(filter.estimate().mean, in_a_current().mean));
  EXPECT_TRUE(matrices_identical(filter.estimate().covariance, in_a_current().covariance));
  EXPECT_THROW(AugmentedUkf<UsvCurrentMotion>(UsvCurrentMotion{}, Unscented{.alpha = 0}),
               std::invalid_argument);

  Gaussian<7> indefinite = in_a_current();
  indefinite.covariance(0, 0) = -1;
  filter.set_motion(UsvCurrentMotion{});
  ASSERT_EQ(filter.assign(indefinite), Status::kOk);
  EXPECT_EQ(filter.predict(1.0), Status::kNotPositiveDefinite);
  EXPECT_TRUE(matrices_identical(filter.estimate().covariance, indefinite.covariance));
}

TEST(AugmentedUkf, UpdatesByItsOwnPredictionAndTouchesNoHeap) {
  AugmentedUkf<UsvCurrentMotion> filter{UsvCurrentMotion{}};
  Ukf<UsvCurrentMotion> fresh{UsvCurrentMotion{}};
  const test::NoHeap fence;
  bool fine = filter.start(in_a_current()) == Status::kOk;
  fine &= bool(filter.update(Position{}, Vec2(12, -21)));
  fine &= filter.predict(1.0) == Status::kOk;
  fine &= fresh.start(filter.estimate()) == Status::kOk;
  fine &= bool(filter.update(Position{}, Vec2(15, -20)));
  fine &= bool(fresh.update(Position{}, Vec2(15, -20)));
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_TRUE(fine);
  EXPECT_TRUE(matrices_identical(filter.estimate().mean, fresh.estimate().mean));
  EXPECT_TRUE(matrices_identical(filter.estimate().covariance, fresh.estimate().covariance));
}

}  // namespace
}  // namespace wakeline::augmented_ukf_test
