// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Bugs that other trackers have shipped, pinned by the name of where they were found; those of one
// topic stand with it.
#include <gtest/gtest.h>

#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline {

// A member of a template that nothing calls need not compile (vortex `UKF_t::update`): all of them,
// in both scalars.
template class Ukf<CoordinatedTurnRate, double>;
template class Ukf<CoordinatedTurnRate, float>;
template class SquareRootUkf<CoordinatedTurnRate, double>;
template class SquareRootUkf<CoordinatedTurnRate, float>;
template Step<2, float> Ukf<CoordinatedTurnRate, float>::update(const Position&,
                                                                const Vec<float, 2>&) noexcept;
template Step<2, float> SquareRootUkf<CoordinatedTurnRate, float>::update(
    const Position&, const Vec<float, 2>&) noexcept;

namespace peer_traps_test {
namespace {

// mayara clones an estimator with fresh filters and old mode probabilities.
TEST(MayaraTrap, AStartAgainForgetsTheModesToo) {
  const auto calm = Ekf{ConstantVelocity{.noise = WhiteAcceleration{1e-4}}};
  const auto wild = Ekf{ConstantVelocity{.noise = WhiteAcceleration{10.0}}};
  const Imm fresh{ModeChain<2>::from_sojourn_s({60.0, 60.0}), calm, wild};
  const Gaussian<4> start{{0.0, 5.0, 0.0, 0.0}, 10.0 * Mat<double, 4, 4>::Identity()};
  const Position sensor{.position_std_m = 1.0};
  const auto see = [&](auto& imm) {
    ASSERT_EQ(imm.predict(2.0), Status::kOk);
    ASSERT_TRUE(imm.update(sensor, Vec<double, 2>(60.0, 40.0)));
  };
  Imm used = fresh;
  ASSERT_EQ(used.start(start), Status::kOk);
  see(used);
  ASSERT_GT(used.mode_probability()[1], 0.9) << "the jump should have moved the modes";

  Imm never_used = fresh;
  ASSERT_EQ(used.start(start), Status::kOk);
  ASSERT_EQ(never_used.start(start), Status::kOk);
  see(used);
  see(never_used);
  EXPECT_TRUE(test::matrices_identical(used.estimate().mean, never_used.estimate().mean));
  EXPECT_TRUE(test::matrices_identical(used.mode_probability(), never_used.mode_probability()));
}

// robot_localization factorises without asking whether that went well.
TEST(RobotLocalizationTrap, ACovarianceThatIsNotPositiveDefiniteIsRejectedNotUsed) {
  Ukf ukf{ConstantVelocity{}};
  Gaussian<4> indefinite;
  indefinite.covariance(0, 1) = indefinite.covariance(1, 0) = 2.0;
  EXPECT_EQ(ukf.start(indefinite), Status::kNotPositiveDefinite);
  EXPECT_EQ(ukf.predict(1.0), Status::kNotStarted);

  ASSERT_EQ(ukf.assign(indefinite), Status::kOk) << "unchecked by its contract";
  EXPECT_EQ(ukf.predict(1.0), Status::kNotPositiveDefinite);
  EXPECT_EQ(ukf.update(Position{}, Vec<double, 2>(0.0, 0.0)).status, Status::kNotPositiveDefinite);
  EXPECT_TRUE(test::matrices_identical(ukf.estimate().covariance, indefinite.covariance));
}

}  // namespace
}  // namespace peer_traps_test
}  // namespace wakeline
