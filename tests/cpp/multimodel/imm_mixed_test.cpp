// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Filters of different kinds and state sizes in one Imm.
#include <gtest/gtest.h>

#include "filter/cases.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::imm_mixed_test {
namespace {

using test::matrices_near;

const RangeBearing kRadar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};

auto mixed_imm() {
  return Imm{ModeChain<3>::from_sojourn_s({60.0, 30.0, 30.0}),
             Ekf{ConstantVelocity{.noise = WhiteAcceleration{0.01}}},
             Ukf{CoordinatedTurnRate{.noise = WhiteAcceleration{0.01},
                                     .prior_turn_rate_std_rad_s = deg(5)}},
             SquareRootUkf{ConstantAcceleration{.noise = WhiteJerk{0.01}}}};
}

TEST(MixedImm, HoldsAVesselThatTurns) {
  const RangeBearing radar{.range_std_m = 5, .bearing_std_rad = deg(0.05)};
  auto imm = mixed_imm();
  static_assert(decltype(imm.estimate())::kComponents == kKinematics, "what all have in common");
  Vec<double, 4> truth(3000, -4, 4000, 7);
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  test::Draw draw(71);
  double straight = 0.0, turning = 0.0, worst = 0.0;
  for (int scan = 0; scan < 80; ++scan) {
    const bool turns = scan >= 40 && scan < 55;
    truth = (CoordinatedTurn{.turn_rate_rad_s = turns ? deg(6) : 0.0}.matrix(2.5) * truth).eval();
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    const Vec<double, 2> exact = radar.measure(Vec<double, 2>(truth[0], truth[2]));
    ASSERT_TRUE(
        imm.update(radar, Vec<double, 2>(exact + draw.error(radar.observe(exact).covariance))));
    const auto belief = imm.estimate();
    ASSERT_TRUE((test::is_covariance<double, 4>(belief.covariance))) << scan;
    ASSERT_NEAR(imm.mode_probability().sum(), 1.0, 1e-12);
    if (scan > 10)
      worst = std::fmax(worst, std::hypot(belief.mean[0] - truth[0], belief.mean[2] - truth[2]));
    if (scan == 39) straight = imm.mode_probability()[0];
    if (scan == 54) turning = imm.mode_probability()[1] + imm.mode_probability()[2];
  }
  EXPECT_LT(worst, 20) << "a plot errs by 5 m along and 4 m across the bearing";
  EXPECT_GT(straight, 0.5);
  EXPECT_GT(turning, 0.8);
}

// A straight model says nothing of the turn rate: mixing with it leaves the turn rate what it was.
TEST(MixedImm, WhatOnlyOneModelHoldsItKeeps) {
  const ModeChain<2> chain(ModeChain<2>::Matrix{{0.7, 0.3}, {0.3, 0.7}});
  Imm imm{chain, Ekf{ConstantVelocity{}}, Ekf{CoordinatedTurnRate{}}};
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  test::Draw draw(72);
  Vec<double, 4> truth(3000, -4, 4000, 7);
  for (int scan = 0; scan < 10; ++scan) {
    truth = (CoordinatedTurn{.turn_rate_rad_s = deg(4)}.matrix(2.5) * truth).eval();
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    ASSERT_TRUE(imm.update(kRadar, kRadar.measure(Vec<double, 2>(truth[0], truth[2]))));
  }
  const Gaussian<5> before = imm.filter<1>().estimate();
  const Gaussian<4> estimate = imm.estimate();
  EXPECT_GT(std::abs(before.mean[4]), deg(0.5)) << "it has learnt the turn";
  ASSERT_EQ(imm.predict(0.0), Status::kOk);
  const Gaussian<5> after = imm.filter<1>().estimate();
  EXPECT_NEAR(after.mean[4], before.mean[4], 1e-12);
  EXPECT_NEAR(after.covariance(4, 4) / before.covariance(4, 4), 1.0, 1e-9);
  EXPECT_FALSE(matrices_near(after.mean.head<4>(), before.mean.head<4>())) << "the rest is mixed";
  // And what all hold keeps the moments of the mixture.
  EXPECT_TRUE(matrices_near(imm.estimate().mean, estimate.mean));
  EXPECT_LT(
      (test::covariance_difference<double, 4>(imm.estimate().covariance, estimate.covariance)),
      1e-12);
}

TEST(MixedImm, OfOneKindEstimatesItsWholeState) {
  Imm imm{ModeChain<2>::from_sojourn_s({30.0, 30.0}), Ekf{CoordinatedTurnRate{}},
          Ukf{CoordinatedTurnRate{}}};
  static_assert(decltype(imm.estimate())::kStates == 5);
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(imm.predict(2.5), Status::kOk);
  EXPECT_GT(imm.estimate().covariance(4, 4), 0.0);
}

/// `CoordinatedTurnRate` with positions first.
struct PositionsFirst {
  static constexpr std::array kComponents{Component::kNorth, Component::kEast, Component::kVnorth,
                                          Component::kVeast, Component::kTurnRate};

  CoordinatedTurnRate turn;

  template <class Scalar>
  Vec<Scalar, 5> transition(const Vec<Scalar, 5>& x, Scalar dt_s) const noexcept {
    return swapped(turn.transition(swapped(x), dt_s));
  }
  template <class Scalar>
  Mat<Scalar, 5, 5> jacobian(const Vec<Scalar, 5>& x, Scalar dt_s) const noexcept {
    return of_swapped(turn.jacobian(swapped(x), dt_s));
  }
  template <class Scalar>
  Mat<Scalar, 5, 5> process_noise(const Vec<Scalar, 5>& x, Scalar dt_s) const noexcept {
    return of_swapped(turn.process_noise(swapped(x), dt_s));
  }
  double prior_variance(Component component) const noexcept {
    return turn.prior_variance(component);
  }

 private:
  template <class Scalar>
  static Vec<Scalar, 5> swapped(const Vec<Scalar, 5>& x) noexcept {
    return {x[0], x[2], x[1], x[3], x[4]};
  }
  template <class Scalar>
  static Mat<Scalar, 5, 5> of_swapped(Mat<Scalar, 5, 5> matrix) noexcept {
    matrix.row(1).swap(matrix.row(2));
    matrix.col(1).swap(matrix.col(2));
    return matrix;
  }
};

TEST(MixedImm, TheOrderOfAStateDoesNotMatter) {
  const auto chain = ModeChain<3>::from_sojourn_s({20.0, 10.0, 10.0});
  const Ekf straight{ConstantVelocity{}};
  const Ekf pushed{Singer{}};
  Imm usual{chain, straight, Ekf{CoordinatedTurnRate{}}, pushed};
  Imm own{chain, straight, Ekf{PositionsFirst{}}, pushed};
  ASSERT_EQ(usual.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(own.start(test::five_km_off<double>()), Status::kOk);
  for (int scan = 0; scan < 10; ++scan) {
    const auto plot = test::plot_of<double>(3000 - 10 * scan, 4000 + 15 * scan);
    ASSERT_EQ(usual.predict(2.5), Status::kOk);
    ASSERT_EQ(own.predict(2.5), Status::kOk);
    ASSERT_TRUE(usual.update(kRadar, plot));
    ASSERT_TRUE(own.update(kRadar, plot));
    ASSERT_TRUE(matrices_near(own.mode_probability(), usual.mode_probability()));
    ASSERT_TRUE(matrices_near(own.estimate().mean, usual.estimate().mean));
    ASSERT_LT((test::covariance_difference<double, 4>(own.estimate().covariance,
                                                      usual.estimate().covariance)),
              1e-9);
  }
}

TEST(MixedImm, InFloat) {
  Imm imm{ModeChain<2>::from_sojourn_s({60.0, 30.0}),
          Ekf<ConstantVelocity, float>{ConstantVelocity{}},
          Ukf<CoordinatedTurnRate, float>{CoordinatedTurnRate{}}};
  ASSERT_EQ(imm.start(test::five_km_off<float>()), Status::kOk);
  for (int scan = 0; scan < 100; ++scan) {
    ASSERT_EQ(imm.predict(2.5f), Status::kOk);
    if (scan % 3 != 0) {
      ASSERT_TRUE(imm.update(kRadar, test::plot_of<float>(3000, 4000)));
    }
    ASSERT_NEAR(imm.mode_probability().sum(), 1.0f, 1e-5f);
    ASSERT_TRUE((test::is_covariance<float, 4>(imm.estimate().covariance))) << scan;
  }
}

}  // namespace
}  // namespace wakeline::imm_mixed_test
