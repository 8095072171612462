// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "support/numeric_jacobian.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline::turn_test {
namespace {

using test::covariance_difference;
using test::matrices_near;
using test::numeric_jacobian;

template <class Scalar>
class TurnOf : public ::testing::Test {
 protected:
  static constexpr double kEpsilon = std::numeric_limits<Scalar>::epsilon();
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(TurnOf, Scalars, );

TYPED_TEST(TurnOf, AtZeroRateIsConstantVelocity) {
  using Scalar = TypeParam;
  for (const ProcessNoise noise :
       {ProcessNoise(WhiteAcceleration{0.3}), ProcessNoise(PiecewiseAcceleration{0.3})}) {
    const CoordinatedTurn turn{.turn_rate_rad_s = 0.0, .noise = noise};
    const ConstantVelocity straight{.noise = noise};
    for (const double step : {0.0, 0.1, 2.5, 60.0, 3600.0}) {
      const Scalar dt = Scalar(step);
      EXPECT_TRUE(matrices_near(turn.matrix(dt), straight.matrix(dt), {0, 0}));
      EXPECT_LE(covariance_difference(turn.process_noise(dt), straight.process_noise(dt)),
                4 * this->kEpsilon);
    }
  }
}

TYPED_TEST(TurnOf, StumpffsFunctionsAreWhatTheyAreCalled) {
  using Scalar = TypeParam;
  const double bound = 8 * this->kEpsilon;
  for (const double angle : {0.1, 0.3, 0.799, 0.801, 1.5, 3.0, 6.0, 40.0})
    for (const double sign : {-1.0, 1.0}) {
      const Stumpff<Scalar> c{Scalar(sign * angle)};
      const long double theta = Scalar(sign * angle), half_sine = std::sin(theta / 2);
      const long double sinc = std::sin(theta) / theta, versine = 2 * half_sine * half_sine;
      EXPECT_NEAR(c.c0, double(std::cos(theta)), bound);
      EXPECT_NEAR(c.c1, double(sinc), bound);
      EXPECT_NEAR(double(c.c2 * theta * theta), double(versine), bound);
      EXPECT_NEAR(double(c.c3 * theta * theta), double(1 - sinc), bound);
    }
  const Stumpff<Scalar> none(Scalar(0));
  EXPECT_EQ(none.c0, Scalar(1));
  EXPECT_EQ(none.c1, Scalar(1));
  EXPECT_EQ(none.c2, Scalar(1.0 / 2));
  EXPECT_EQ(none.c3, Scalar(1.0 / 6));
}

TEST(Stumpff, OfALaneDoNotKnowItsNeighbours) {
  using Lanes = Pack<double, 2>;
  for (const double angle : {0.1, -0.79, 0.81, -3.0}) {
    const Stumpff<Lanes> alone{Lanes(angle)};
    for (const double neighbour : {0.0, 0.5, 1.0, 1e9}) {
      const Stumpff<Lanes> c(lanes_of<Lanes>([&](int k) { return k == 0 ? angle : neighbour; }));
      EXPECT_EQ(c.c0[0], alone.c0[0]);
      EXPECT_EQ(c.c1[0], alone.c1[0]);
      EXPECT_EQ(c.c2[0], alone.c2[0]);
      EXPECT_EQ(c.c3[0], alone.c3[0]);
    }
  }
}

TYPED_TEST(TurnOf, PassesThroughZeroRateWithoutAStep) {
  using Scalar = TypeParam;
  // Neighbouring rates, across the threshold at which the formulas change, too.
  for (const double threshold : {1e-12, 0.02, 0.8})
    for (const double sign : {-1.0, 1.0}) {
      const double rate = sign * threshold / 2.0;  // the angle of a step of 2 s
      const Turn<Scalar> below(Scalar(rate * (1 - 1e-6)), Scalar(2));
      const Turn<Scalar> above(Scalar(rate * (1 + 1e-6)), Scalar(2));
      EXPECT_TRUE(
          matrices_near(below.matrix(), above.matrix(),
                        {.absolute = 8e-6 * threshold + 40 * this->kEpsilon, .relative = 0}));
      EXPECT_TRUE(
          matrices_near(below.rate_derivatives(), above.rate_derivatives(),
                        {.absolute = 8e-6 * threshold + 200 * this->kEpsilon, .relative = 0}));
      EXPECT_LT(covariance_difference(below.noise(WhiteAcceleration{1.0}),
                                      above.noise(WhiteAcceleration{1.0})),
                8e-6 * threshold + 200 * this->kEpsilon);
    }
  for (const double rate : {1e-300, 1e-30, 1e-15, 1e-9}) {
    const Turn<Scalar> slow(Scalar(rate), Scalar(2)), straight(Scalar(0), Scalar(2));
    EXPECT_TRUE(matrices_near(slow.matrix(), straight.matrix(),
                              {.absolute = 4 * rate + 4 * this->kEpsilon, .relative = 0}));
    EXPECT_TRUE(matrices_near(slow.rate_derivatives(), straight.rate_derivatives(),
                              {.absolute = 8 * rate + 4 * this->kEpsilon, .relative = 0}));
  }
}

TYPED_TEST(TurnOf, IsACircleToStarboard) {
  using Scalar = TypeParam;
  const double rate = deg(6.0);
  const CoordinatedTurn turn{.turn_rate_rad_s = rate};
  Vec<Scalar, 4> x(0, 10, 0, 0);  // northward at 10 m/s
  const Scalar radius = Scalar(10.0 / rate);
  for (int k = 1; k <= 24; ++k) {
    x = (turn.matrix(Scalar(2.5)) * x).eval();
    const Scalar course = Scalar(k * 2.5 * rate);
    const Scalar rounding = Scalar(2e3 * this->kEpsilon);
    EXPECT_NEAR(x[1], 10 * std::cos(course), rounding);
    EXPECT_NEAR(x[3], 10 * std::sin(course), rounding);  // east first: starboard
    EXPECT_NEAR(std::hypot(x[0], x[2] - radius), radius, 10 * rounding);
  }
  EXPECT_NEAR(x[0], 0, 2e4 * this->kEpsilon) << "a full circle";
  EXPECT_NEAR(x[2], 0, 2e4 * this->kEpsilon);
}

TEST(CoordinatedTurn, PiecewiseNoiseIsThePapersWhateverTheTurn) {
  const double dt = 3.0, std = 0.05;
  Mat<double, 4, 2> gain = Mat<double, 4, 2>::Zero();
  gain(0, 0) = gain(2, 1) = dt * dt / 2;
  gain(1, 0) = gain(3, 1) = dt;
  const Mat<double, 4, 4> expected = std * std * gain * gain.transpose();
  for (const double rate : {0.0, 0.05, -0.2})
    EXPECT_TRUE(matrices_near(
        CoordinatedTurn{.turn_rate_rad_s = rate, .noise = PiecewiseAcceleration{std}}.process_noise(
            dt),
        expected, {.absolute = 0, .relative = 1e-14}));
}

// The rates include zero, both sides of the thresholds of the series, and a half turn a step.
constexpr double kRates[] = {0.0,    1e-300,  1e-13, 1e-7,  -1e-7, 1e-4, 7.9e-2,
                             8.1e-2, -8.1e-2, 0.05,  0.319, 0.321, -0.3, 1.2};

TEST(CoordinatedTurnRate, JacobianIsTheDerivative) {
  for (const CoordinatedTurnRate& motion :
       {CoordinatedTurnRate{},
        CoordinatedTurnRate{.prior_turn_rate_rad_s = 0.1, .turn_rate_time_s = 20.0}})
    for (const double rate : kRates)
      for (const double dt : {0.1, 2.5, 10.0}) {
        Vec<double, 5> x;
        x << 500, 7, -300, -4, rate;
        const auto move = [&](const Vec<double, 5>& state) { return motion.transition(state, dt); };
        // Central differences over h = 6e-6 of values near 1000: rounding 1000 eps / h = 4e-8,
        // times dt of truncation.
        EXPECT_TRUE(matrices_near(motion.jacobian(x, dt), numeric_jacobian(move, x),
                                  {.absolute = 3e-7, .relative = 1e-7}))
            << "rate " << rate << ", dt " << dt;
      }
}

TEST(CoordinatedTurnRate, FloatJacobianIsThatOfDouble) {
  const CoordinatedTurnRate motion;
  for (const double rate : kRates)
    for (const double dt : {0.0, 0.1, 2.5, 10.0}) {
      Vec<double, 5> x;
      x << 500, 7, -300, -4, rate;
      EXPECT_TRUE(matrices_near(motion.jacobian(Vec<float, 5>(x.cast<float>()), float(dt)),
                                motion.jacobian(x, dt).cast<float>().eval(),
                                {.absolute = 1e-3, .relative = 1e-4}))
          << "rate " << rate << ", dt " << dt;
    }
}

TYPED_TEST(TurnOf, RateOfTheStateMovesAsTheKnownRate) {
  using Scalar = TypeParam;
  for (const double rate : kRates) {
    Vec<Scalar, 5> x;
    x << Scalar(500), Scalar(7), Scalar(-300), Scalar(-4), Scalar(rate);
    const Vec<Scalar, 5> moved = CoordinatedTurnRate{}.transition(x, Scalar(2.5));
    const Vec<Scalar, 4> known =
        CoordinatedTurn{.turn_rate_rad_s = double(x[4])}.matrix(Scalar(2.5)) * x.template head<4>();
    EXPECT_TRUE(matrices_near(moved.template head<4>(), known, {0, 0}));
    EXPECT_EQ(moved[4], x[4]);
  }
}

TYPED_TEST(TurnOf, NoiseOfTheRateActsAcrossTheCourse) {
  using Scalar = TypeParam;
  const CoordinatedTurnRate motion{.noise = WhiteAcceleration{0.0}, .turn_rate_psd_rad2s3 = 1e-3};
  for (const double rate : kRates) {
    Vec<Scalar, 5> x;
    x << Scalar(0), Scalar(6), Scalar(0), Scalar(8), Scalar(rate);
    const Mat<Scalar, 5, 5> q = motion.process_noise(x, Scalar(2));
    EXPECT_NEAR(q(4, 4), 2e-3, 1e-9);
    const Scalar along = q(1, 1) * 36 + 2 * q(1, 3) * 48 + q(3, 3) * 64;
    EXPECT_NEAR(along, 0.0, 1e-4) << "a turn does not change the speed";
    EXPECT_NEAR(q(1, 1) + q(3, 3), 100 * 1e-3 * 8.0 / 3.0, 1e-6) << "v² q dt³/3";
    const auto root = semidefinite_root<5, Scalar>(q);
    EXPECT_LT(covariance_difference(Mat<Scalar, 5, 5>(root * root.transpose()), q),
              1e3 * this->kEpsilon);
  }
}

TYPED_TEST(TurnOf, ARateThatReturnsForgetsItself) {
  using Scalar = TypeParam;
  constexpr double kTime = 40.0, kPsd = 1e-3, kPrior = 0.1;
  const CoordinatedTurnRate motion{.noise = WhiteAcceleration{0.0},
                                   .turn_rate_psd_rad2s3 = kPsd,
                                   .prior_turn_rate_rad_s = kPrior,
                                   .turn_rate_time_s = kTime};
  Vec<Scalar, 5> x;
  x << Scalar(0), Scalar(6), Scalar(0), Scalar(8), Scalar(0.3);
  for (const double dt : {0.0, 0.01, 0.039, 0.041, 2.5, 40.0, 3600.0}) {
    const double left = std::exp(-dt / kTime);
    EXPECT_NEAR(motion.transition(x, Scalar(dt))[4], kPrior + 0.2 * left, 4 * this->kEpsilon);
    const Mat<Scalar, 5, 5> q = motion.process_noise(x, Scalar(dt));
    const double variance = -kPsd * kTime / 2 * std::expm1(-2 * dt / kTime);
    EXPECT_NEAR(q(4, 4), variance, std::max(1e-8, 1e3 * this->kEpsilon) * variance) << dt;
    const auto root = semidefinite_root<5, Scalar>(q);
    EXPECT_LT(covariance_difference(Mat<Scalar, 5, 5>(root * root.transpose()), q),
              1e3 * this->kEpsilon);
  }
}

TYPED_TEST(TurnOf, ARateThatReturnsTurnsByWhatItIsMeanwhile) {
  using Scalar = TypeParam;
  const CoordinatedTurnRate motion{.prior_turn_rate_rad_s = 0.01, .turn_rate_time_s = 20.0};
  Vec<Scalar, 5> x;
  x << Scalar(0), Scalar(6), Scalar(0), Scalar(8), Scalar(0.15);
  for (const double dt : {0.01, 0.019, 0.021, 2.5, 30.0, 600.0}) {
    Vec<Scalar, 5> in_steps = x;
    for (int k = 0; k < 10; ++k) in_steps = motion.transition(in_steps, Scalar(dt / 10));
    const Vec<Scalar, 5> at_once = motion.transition(x, Scalar(dt));
    const double turned = 0.01 * dt - 0.14 * 20.0 * std::expm1(-dt / 20.0);
    const double course = std::atan2(8.0, 6.0) + turned;
    const double bound = 100 * this->kEpsilon * (1 + turned);
    EXPECT_NEAR(at_once[1], 10 * std::cos(course), 10 * bound) << dt;
    EXPECT_NEAR(at_once[3], 10 * std::sin(course), 10 * bound) << dt;
    EXPECT_NEAR(in_steps[1], at_once[1], 10 * bound) << dt;
    EXPECT_NEAR(in_steps[3], at_once[3], 10 * bound) << dt;
  }
}

TYPED_TEST(TurnOf, WithoutNoiseOfTheRateIsTheNoiseOfTheTurn) {
  using Scalar = TypeParam;
  const CoordinatedTurnRate motion{.noise = WhiteAcceleration{0.4}, .turn_rate_psd_rad2s3 = 0.0};
  for (const double rate : kRates) {
    Vec<Scalar, 5> x;
    x << Scalar(0), Scalar(6), Scalar(0), Scalar(8), Scalar(rate);
    const Mat<Scalar, 5, 5> q = motion.process_noise(x, Scalar(2));
    const CoordinatedTurn known{.turn_rate_rad_s = double(x[4]), .noise = WhiteAcceleration{0.4}};
    EXPECT_TRUE(
        matrices_near(q.template topLeftCorner<4, 4>(), known.process_noise(Scalar(2)), {0, 0}));
    EXPECT_TRUE((q.row(4).array() == Scalar(0)).all());
  }
}

/// A turn with a custom process noise.
struct OwnNoise : CoordinatedTurn {
  template <class Scalar>
  Mat<Scalar, 4, 4> process_noise(Scalar) const noexcept {
    return Scalar(7) * Mat<Scalar, 4, 4>::Identity();
  }
};

TEST(CoordinatedTurn, BothMatricesTogetherAreEachAlone) {
  for (const double rate : {0.0, 1e-9, 0.02, -0.3}) {
    const CoordinatedTurn turn{.turn_rate_rad_s = rate, .noise = WhiteAcceleration{0.3}};
    const auto both = step_matrices(turn, 2.5);
    EXPECT_EQ(both.f, turn.matrix(2.5)) << rate;
    EXPECT_EQ(both.q, turn.process_noise(2.5)) << rate;
    const OwnNoise own{turn};
    EXPECT_EQ(step_matrices(own, 2.5).q, own.process_noise(2.5)) << "not what it inherits";
  }
}

}  // namespace
}  // namespace wakeline::turn_test
