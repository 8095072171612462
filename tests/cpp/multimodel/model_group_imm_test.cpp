// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// An IMM with a group of models beside the plain ones without and with that group.
#include "wakeline/multimodel/model_group_imm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "filter/cases.hpp"
#include "wakeline/measurement/position.hpp"

namespace wakeline::model_group_imm_test {
namespace {

using test::beliefs_identical;
using test::Draw;
using test::matrices_near;

using Straight = Ekf<ConstantVelocity>;
using Turning = Ekf<CoordinatedTurnRate>;
using Grouped =
    ModelGroupImm<FilterBank<Straight, Turning>, FilterBank<Straight, Turning, Straight, Straight>>;

const Position kFix{.position_std_m = 15.0};

/// Calm, turning, and a group of two that stays together, of which that share leaves the calm.
Grouped grouped(double share = 0.05, double calm = 0.9) {
  ModeChain<4>::Matrix generator_per_s;
  generator_per_s << -0.01, 0.01 * (1.0 - share), 0.008 * share, 0.002 * share,  //
      0.02, -0.02001, 0.00001, 0.0,                                              //
      0.0, 0.001, -0.101, 0.1,                                                   //
      0.0, 0.001, 0.2, -0.201;
  const auto straight = [](double psd_m2s3) {
    return Ekf{ConstantVelocity{WhiteAcceleration{psd_m2s3}}};
  };
  Grouped::All all(ModeChain<4>::from_generator(generator_per_s), straight(0.001),
                   Ekf{CoordinatedTurnRate{}}, straight(0.3), straight(20.0));
  const double others = 1.0 - calm;
  all.set_initial_mode_probability(
      {calm, others * (1.0 - share), 0.8 * others * share, 0.2 * others * share});
  return Grouped(all);
}

Gaussian<4> start() {
  Gaussian<4> belief{{100.0, 8.0, -50.0, 0.0}, Mat<double, 4, 4>::Zero()};
  belief.covariance.diagonal() << 200.0, 4.0, 200.0, 4.0;
  return belief;
}

/// A fix of a target that goes straight, and after `alters_s` another way.
Vec<double, 2> fix_at(double time_s, double alters_s, Draw& draw) {
  const double way_m = time_s > alters_s ? 12.0 * (time_s - alters_s) : 0.0;
  return {100.0 + 8.0 * time_s + 15.0 * draw.normal(), -50.0 + way_m + 15.0 * draw.normal()};
}

TEST(ModelGroupImm, IsTheImmOfItsCoreWhileTheGroupRests) {
  Grouped imm = grouped(0.001);
  Grouped::Core core(imm.all().chain().first<2>(), imm.all().filter<0>(), imm.all().filter<1>());
  core.set_initial_mode_probability(imm.core().initial_mode_probability());
  EXPECT_TRUE(core.initial_mode_probability().isApprox(Vec<double, 2>(0.9, 0.1), 1e-14));
  ASSERT_EQ(imm.start(start()), Status::kOk);
  ASSERT_EQ(core.start(start()), Status::kOk);
  Draw draw(1);
  for (int k = 1; k <= 40; ++k) {
    ASSERT_EQ(imm.predict(2.5), core.predict(2.5));
    const Vec<double, 2> z = fix_at(2.5 * k, 1e9, draw);
    ASSERT_EQ(imm.update(kFix, z).nis, core.update(kFix, z).nis);
    ASSERT_FALSE(imm.joined());
    ASSERT_TRUE(beliefs_identical<4>(imm.estimate(), core.estimate())) << "scan " << k;
  }
}

TEST(ModelGroupImm, KeepsItsEstimateWhereTheGroupJoins) {
  const test::Tolerance rounding{.absolute = 1e-9, .relative = 1e-9};
  int joins = 0, rests = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Draw draw(seed);
    Grouped imm = grouped();
    ASSERT_EQ(imm.start(start()), Status::kOk);
    for (int k = 1; k <= 150; ++k) {
      const auto before = imm.estimate();
      const bool joined = imm.joined();
      imm.choose_models(2.5);
      const Grouped::Probability probability = imm.mode_probability();
      EXPECT_NEAR(probability.sum(), 1.0, 1e-12);
      if (imm.joined() && !joined) {
        ++joins;
        EXPECT_GT(probability.tail<2>().sum(), Grouped::kJoining);
        EXPECT_TRUE(matrices_near(imm.estimate().mean, before.mean, rounding));
        EXPECT_TRUE(matrices_near(imm.estimate().covariance, before.covariance, rounding));
      }
      rests += !imm.joined() && joined;
      EXPECT_TRUE(imm.joined() || probability.tail<2>().sum() == 0.0);
      ASSERT_EQ(imm.predict(2.5), Status::kOk);
      ASSERT_TRUE(imm.update(kFix, fix_at(2.5 * k, 75.0, draw)));
    }
  }
  EXPECT_GT(joins, 10);
  EXPECT_GT(rests, 10);
}

TEST(ModelGroupImm, IsTheImmOfAllOnceTheGroupHasJoined) {
  Grouped imm = grouped(0.5, 0.1);
  ASSERT_EQ(imm.start(start()), Status::kOk);
  imm.choose_models(2.5);
  ASSERT_TRUE(imm.joined());
  EXPECT_NEAR(imm.mode_probability()[2], 0.8 * 0.5 * 0.9, 1e-12);
  Grouped::All all = imm.all();
  Draw draw(3);
  for (int k = 1; k <= 20; ++k) {
    const Vec<double, 2> z = fix_at(2.5 * k, 0.0, draw) + Vec<double, 2>(60.0 * (k % 2), 0.0);
    ASSERT_EQ(imm.predict(2.5), all.predict(2.5));
    ASSERT_EQ(imm.update(kFix, z).nis, all.update(kFix, z).nis);
    ASSERT_TRUE(beliefs_identical<4>(imm.estimate(), all.estimate())) << "scan " << k;
  }
}

TEST(ModelGroupImm, JoinsNotAtOnceWhereItHasNotFitted) {
  Grouped imm = grouped(0.05, 0.01);
  ASSERT_EQ(imm.start(start()), Status::kOk);
  Draw draw(4);
  int joins = 0, rests = 0;
  for (int k = 1; k <= 200; ++k) {
    const bool joined = imm.joined();
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    joins += imm.joined() && !joined;
    rests += !imm.joined() && joined;
    const double angle = 0.05 * 2.5 * k;  // a steady turn, which the core knows
    ASSERT_TRUE(imm.update(kFix, {100.0 + 160.0 * std::sin(angle) + 5.0 * draw.normal(),
                                  110.0 - 160.0 * std::cos(angle) + 5.0 * draw.normal()}));
  }
  EXPECT_GE(rests, 1);
  EXPECT_LE(joins, 4);
}

TEST(ModelGroupImm, NeverUsesAGroupWithoutAShare) {
  Grouped imm = grouped(0.0, 0.2);
  ASSERT_EQ(imm.start(start()), Status::kOk);
  ASSERT_EQ(imm.predict(2.5), Status::kOk);
  EXPECT_FALSE(imm.joined());
}

TEST(ModelGroupImm, RejectsAChainWithoutTime) {
  const Grouped::All all(ModeChain<4>::staying(0.9), grouped().all().filter<0>(),
                         grouped().all().filter<1>(), grouped().all().filter<2>(),
                         grouped().all().filter<3>());
  EXPECT_THROW(Grouped{all}, std::invalid_argument);
}

TEST(ModelGroupImm, ACopyOfTheStateGoesTheSameWay) {
  Draw draw(5);
  Grouped imm = grouped();
  ASSERT_EQ(imm.start(start()), Status::kOk);
  int joined = 0;
  for (int k = 1; k <= 60; ++k) {
    Grouped copy = grouped(), restored = grouped();
    copy.copy_state_from(imm);
    Archive saved;
    imm.archive(saved);
    Archive loaded(saved.bytes());
    restored.archive(loaded);
    ASSERT_TRUE(loaded.ok() && loaded.at_end());
    ASSERT_TRUE(copy.started() && restored.started());
    const Vec<double, 2> z = fix_at(2.5 * k, 60.0, draw);
    for (Grouped* one : {&imm, &copy, &restored}) {
      ASSERT_EQ(one->predict(2.5), Status::kOk);
      ASSERT_TRUE(one->update(kFix, z));
    }
    joined += imm.joined();
    for (const Grouped* one : {&copy, &restored}) {
      ASSERT_EQ(one->joined(), imm.joined());
      ASSERT_TRUE(beliefs_identical<4>(one->estimate(), imm.estimate())) << "scan " << k;
    }
  }
  EXPECT_GT(joined, 5);
  EXPECT_LT(joined, 60);
}

TEST(ModelGroupImm, AStepThatFailsChangesNothing) {
  Grouped imm = grouped(0.5, 0.1);
  ASSERT_EQ(imm.start(start()), Status::kOk);
  ASSERT_EQ(imm.predict(2.5), Status::kOk);
  for (const double dt_s : {-1.0, std::nan(""), HUGE_VAL}) {
    const auto before = imm.estimate();
    EXPECT_NE(imm.predict(dt_s), Status::kOk);
    EXPECT_TRUE(imm.joined());
    EXPECT_TRUE(beliefs_identical<4>(imm.estimate(), before));
  }
}

TEST(ModeChain, OfTheFirstModesLeavesEachAtTheSameRate) {
  const ModeChain<4>::Matrix all = *grouped().all().chain().generator_per_s();
  const ModeChain<3>::Matrix part = *grouped().all().chain().first<3>().generator_per_s();
  EXPECT_TRUE(part.rowwise().sum().isZero(1e-15));
  EXPECT_EQ(part.diagonal(), all.diagonal().head<3>());
  EXPECT_NEAR(part(0, 1) / part(0, 2), all(0, 1) / all(0, 2), 1e-9);
  const ModeChain<2> stepwise(ModeChain<3>::staying(0.8).first<2>());
  EXPECT_NEAR(stepwise.transition(1.0)(0, 0), 0.8, 1e-15);
  EXPECT_NEAR(stepwise.transition(1.0)(0, 1), 0.2, 1e-15);
  ModeChain<3>::Matrix away_per_s = ModeChain<3>::Matrix::Zero();
  away_per_s.row(0) << -0.5, 0.0, 0.5;
  EXPECT_EQ((*ModeChain<3>::from_generator(away_per_s).first<2>().generator_per_s())(0, 1), 0.5);
}

}  // namespace
}  // namespace wakeline::model_group_imm_test
