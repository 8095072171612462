// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What every linear motion model must obey: F is a flow, F(a + b) = F(b) F(a), and Q is what the
// noise of a step adds up to, Q(a + b) = F(b) Q(a) F(b)' + Q(b). Together with Q(dt) / dt for a
// short step this determines Q.
#include <gtest/gtest.h>

#include <limits>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/core/angle.hpp"
#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/singer.hpp"

namespace wakeline::linear_laws_test {
namespace {

using test::covariance_difference;
using test::matrices_near;

template <class Scalar>
class LinearMotion : public ::testing::Test {
 protected:
  static constexpr double kEpsilon = std::numeric_limits<Scalar>::epsilon();

  /// Calls `f(model, name)` for models whose noise is white.
  template <class Function>
  static void for_models(const Function& f) {
    f(ConstantVelocity{.noise = WhiteAcceleration{0.3}}, "CV");
    f(ConstantAcceleration{.noise = WhiteJerk{0.02}}, "CA, white jerk");
    f(ConstantAcceleration{.noise = WhiteAcceleration{0.3}}, "CA, white acceleration");
    for (const double rate :
         {0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3, 0.01, 0.05, 0.3, -0.3, 2.0})
      f(CoordinatedTurn{.turn_rate_rad_s = rate, .noise = WhiteAcceleration{0.3}}, rate);
    for (const double tau : {0.01, 0.5, 2.0, 20.0, 1e3, 1e7})
      f(Singer{.maneuver_time_s = tau, .accel_std_mps2 = 0.5}, tau);
  }
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(LinearMotion, Scalars, );

constexpr double kSteps[][2] = {{0.0, 0.0}, {0.0, 2.5}, {2.5, 0.0}, {1e-3, 1e-3}, {0.02, 3.0},
                                {3.0, 0.4}, {1.0, 2.0}, {2.5, 2.5}, {0.5, 40.0},  {60.0, 60.0}};

TYPED_TEST(LinearMotion, TwoStepsAreOne) {
  using Scalar = TypeParam;
  this->for_models([&](const auto& model, auto name) {
    for (const auto& [first, second] : kSteps) {
      const Scalar a = Scalar(first), b = Scalar(second);
      const auto f = (model.matrix(b) * model.matrix(a)).eval();
      EXPECT_TRUE(matrices_near(model.matrix(Scalar(a + b)), f,
                                {.absolute = 60 * this->kEpsilon * std::max(1.0, first + second),
                                 .relative = 60 * this->kEpsilon}))
          << name << ", " << a << " + " << b;
    }
  });
}

TYPED_TEST(LinearMotion, NoiseOfTwoStepsAddsUp) {
  using Scalar = TypeParam;
  this->for_models([&](const auto& model, auto name) {
    for (const auto& [first, second] : kSteps) {
      const Scalar a = Scalar(first), b = Scalar(second);
      const auto f = model.matrix(b);
      const decltype(f) two = f * model.process_noise(a) * f.transpose() + model.process_noise(b);
      EXPECT_LT(covariance_difference(model.process_noise(Scalar(a + b)), two),
                2e4 * this->kEpsilon)
          << name << ", " << a << " + " << b;
    }
  });
}

TYPED_TEST(LinearMotion, NothingHappensInNoTime) {
  using Scalar = TypeParam;
  this->for_models([&](const auto& model, auto name) {
    const auto f = model.matrix(Scalar(0));
    EXPECT_TRUE(matrices_near(f, f.Identity(), {0, 0})) << name;
    EXPECT_TRUE(matrices_near(model.process_noise(Scalar(0)), f.Zero(), {0, 0})) << name;
  });
}

TYPED_TEST(LinearMotion, NoiseIsSymmetricSemidefiniteAndGrows) {
  using Scalar = TypeParam;
  this->for_models([&](const auto& model, auto name) {
    auto before = model.process_noise(Scalar(0)).diagonal().eval();
    for (const double dt : {1e-3, 0.1, 1.0, 2.5, 10.0, 60.0, 3600.0}) {
      const auto q = model.process_noise(Scalar(dt));
      EXPECT_TRUE(matrices_near(q, q.transpose(), {.absolute = 0, .relative = 8 * this->kEpsilon}))
          << name;
      EXPECT_TRUE(is_finite(q)) << name << ", " << dt;
      const auto root = semidefinite_root<q.RowsAtCompileTime, Scalar>(q);
      const std::decay_t<decltype(q)> rebuilt = root * root.transpose();
      EXPECT_LT(covariance_difference(rebuilt, q), 1e4 * this->kEpsilon) << name << ", " << dt;
      // Variances never shrink; of a Singer acceleration they end at s², which rounding may
      // undercut by its last bit.
      EXPECT_TRUE(((q.diagonal() - before).array() >= -this->kEpsilon * before.array()).all())
          << name << ", " << dt;
      before = q.diagonal();
    }
  });
}

/// Q(dt) / dt of a short step.
template <class Motion>
auto density(const Motion& motion) {
  constexpr double kShort = 1e-7;
  return (motion.process_noise(kShort) / kShort).eval();
}

TEST(ShortStep, BringsTheDensityOfTheNoiseWhereTheNoiseActs) {
  for (const double rate : {0.0, 1e-6, 0.2}) {
    Mat<double, 4, 4> expected = Mat<double, 4, 4>::Zero();
    expected(1, 1) = expected(3, 3) = 0.3;
    const CoordinatedTurn turn{.turn_rate_rad_s = rate, .noise = WhiteAcceleration{0.3}};
    EXPECT_TRUE(matrices_near(density(turn), expected, {.absolute = 1e-6, .relative = 1e-6}));
    EXPECT_TRUE(matrices_near(density(ConstantVelocity{.noise = WhiteAcceleration{0.3}}), expected,
                              {.absolute = 1e-6, .relative = 1e-6}));
  }
  Mat<double, 6, 6> jerk = Mat<double, 6, 6>::Zero();
  jerk(2, 2) = jerk(5, 5) = 0.02;
  EXPECT_TRUE(matrices_near(density(ConstantAcceleration{.noise = WhiteJerk{0.02}}), jerk,
                            {.absolute = 1e-6, .relative = 1e-6}));
  Mat<double, 6, 6> acceleration = Mat<double, 6, 6>::Zero();
  acceleration(1, 1) = acceleration(4, 4) = 0.3;
  EXPECT_TRUE(matrices_near(density(ConstantAcceleration{.noise = WhiteAcceleration{0.3}}),
                            acceleration, {.absolute = 1e-6, .relative = 1e-6}));
  const Singer singer{.maneuver_time_s = 8.0, .accel_std_mps2 = 0.5};
  Mat<double, 6, 6> maneuver = Mat<double, 6, 6>::Zero();
  maneuver(2, 2) = maneuver(5, 5) = 2 * 0.25 / 8.0;
  EXPECT_TRUE(matrices_near(density(singer), maneuver, {.absolute = 1e-6, .relative = 1e-6}));
}

TEST(Flow, MovesAsDocumented) {
  const Vec<double, 4> straight = ConstantVelocity{}.matrix(2.0) * Vec<double, 4>(10, 3, 20, -4);
  EXPECT_TRUE(matrices_near(straight, Vec<double, 4>(16, 3, 12, -4)));
  Vec<double, 6> x;
  x << 10, 3, 1, 20, -4, 2;
  Vec<double, 6> expected;
  expected << 18, 5, 1, 16, 0, 2;
  EXPECT_TRUE(matrices_near((ConstantAcceleration{}.matrix(2.0) * x).eval(), expected));
}

}  // namespace
}  // namespace wakeline::linear_laws_test
