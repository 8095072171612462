// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/motion/pattern.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/matrix_assert.hpp"
#include "support/rejection.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/wandering_course.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline::pattern_test {
namespace {

using test::matrices_near;

/// Decaying velocities: its own matrix with an inherited pattern.
struct Damped : ConstantVelocity {
  template <class Scalar>
  Mat<Scalar, 4, 4> matrix(Scalar dt_s) const noexcept {
    Mat<Scalar, 4, 4> f = ConstantVelocity::matrix(dt_s);
    f(1, 1) = f(3, 3) = Scalar(0.5);
    return f;
  }
};

/// The same under its own.
struct DampedAsItSays : Damped {
  static constexpr Pattern<4> kPattern{"1x00 0x00 001x 000x"};
};

/// The same without a pattern.
struct DampedUntold : Damped {
  static constexpr Pattern<4> kPattern{};
};

TEST(Pattern, ThatIsWrongIsRejectedWithItsElement) {
  const std::string rejection = test::rejection_of([] { return Ekf{Damped{}}; });
  EXPECT_NE(
      rejection.find("it says 1 of element (1, 1) of the matrix, which for a step of 1 s is 0.5"),
      std::string::npos)
      << rejection;
}

/// Steady motion under a pattern that takes the step for 1.
struct OfOneSecond : ConstantVelocity {
  static constexpr Pattern<4> kPattern{"1100 0100 001x 0001"};
};

TEST(Pattern, OfAnElementThatIsTheStepIsRejected) {
  const std::string rejection = test::rejection_of([] { return Ekf{OfOneSecond{}}; });
  EXPECT_NE(
      rejection.find("it says 1 of element (0, 1) of the matrix, which for a step of 2 s is 2"),
      std::string::npos)
      << rejection;
}

/// A current that grows to the east: its own Jacobian with an inherited pattern.
struct Sheared : CoordinatedTurnRate {
  template <class Scalar>
  Mat<Scalar, 5, 5> jacobian(const Vec<Scalar, 5>& x, Scalar dt_s) const noexcept {
    Mat<Scalar, 5, 5> f = CoordinatedTurnRate::jacobian(x, dt_s);
    f(0, 2) = Scalar(0.01) * x[2] * dt_s;
    return f;
  }
};

/// The same under its own.
struct ShearedAsItSays : Sheared {
  static constexpr Pattern<5> kPattern{"1xxxx 0x0xx 0x1xx 0x0xx 0000x"};
};

TEST(Pattern, OfAWrongJacobianIsRejectedWithItsElement) {
  const std::string rejection = test::rejection_of([] { return Ekf{Sheared{}}; });
  EXPECT_NE(
      rejection.find("it says 0 of element (0, 2) of the Jacobian, which at [1, 2, ...] for a "
                     "step of 1 s is 0.03"),
      std::string::npos)
      << rejection;
  EXPECT_NO_THROW(Ekf{ShearedAsItSays{}});
  EXPECT_NO_THROW(Ekf{CoordinatedTurnRate{}});
  EXPECT_NO_THROW((Ekf<CoordinatedTurnRate, Pack<double, 2>>{CoordinatedTurnRate{}}));
  EXPECT_NO_THROW(Ekf{WanderingCourse{}});
}

TEST(Pattern, LeavesNothingOutThatCounts) {
  Ekf told{DampedAsItSays{}};
  Ekf untold{DampedUntold{}};
  Gaussian<4, double> belief;
  belief.mean << 100, 5, 200, -3;
  belief.covariance = Vec<double, 4>(25, 4, 36, 9).asDiagonal();
  ASSERT_TRUE(ok(told.start(belief)));
  ASSERT_TRUE(ok(untold.start(belief)));
  for (const double dt_s : {1.0, 2.0, 2.0, 0.5}) {
    const Mat<double, 4, 4> f = Damped{}.matrix(dt_s), q = Damped{}.process_noise(dt_s);
    belief = {f * belief.mean, f * belief.covariance * f.transpose() + q};
    ASSERT_TRUE(ok(told.predict(dt_s)));
    ASSERT_TRUE(ok(untold.predict(dt_s)));
    EXPECT_TRUE(matrices_near(told.estimate().mean, belief.mean, {0, 1e-14}));
    EXPECT_TRUE(matrices_near(untold.estimate().mean, belief.mean, {0, 1e-14}));
    EXPECT_TRUE(matrices_near(told.estimate().covariance, belief.covariance, {1e-13, 1e-13}));
    EXPECT_TRUE(matrices_near(untold.estimate().covariance, belief.covariance, {1e-13, 1e-13}));
  }
}

}  // namespace
}  // namespace wakeline::pattern_test
