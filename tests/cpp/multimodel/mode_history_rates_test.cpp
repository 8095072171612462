// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Trees whose hypotheses learn their own turn rates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/multimodel/mode_history.hpp"
#include "wakeline/multimodel/turning_chain.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline::mode_history_rates_test {
namespace {

using test::beliefs_identical;
using test::Draw;
using test::matrices_near;

using Learner = Ekf<CoordinatedTurnRate>;
using Tree = ModeHistory<Learner>;

const RangeBearing kRadar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
const TurnRateGrid kTriple{deg(-3.0), 0.0, deg(3.0)};
const PiecewiseAcceleration kNoise{0.02};

CoordinatedTurnRate learning(double prior_std_rad_s) {
  return {
      .noise = kNoise, .turn_rate_psd_rad2s3 = 0.0, .prior_turn_rate_std_rad_s = prior_std_rad_s};
}

template <class Scalar = double>
auto tree_of(double prior_std_rad_s, const HistoryTree& settings = {}) {
  using Filter = Ekf<CoordinatedTurnRate, Scalar>;
  return ModeHistory<Filter>(settings, kTriple, turning_chain(kTriple),
                             Filter(learning(prior_std_rad_s)));
}

/// The likeliest of those that a condition holds for.
Tree::Hypothesis likeliest_of(const Tree& tree, auto condition) {
  Tree::Hypothesis likeliest;
  for (const auto& one : tree.hypotheses())
    if (condition(one) && one.probability > likeliest.probability) likeliest = one;
  return likeliest;
}
Tree::Hypothesis likeliest_of(const Tree& tree) {
  return likeliest_of(tree, [](const auto&) { return true; });
}

Gaussian<4> steaming() {
  Gaussian<4> start;
  start.mean << 3000, 8, 0, 0;
  start.covariance = Vec<double, 4>(400, 4, 400, 4).asDiagonal();
  return start;
}

/// Straight for a minute, then on a circle; scans of 2.5 s.
Vec<double, 2> place(int scan, double turn_rate_rad_s) {
  const double straight_m = 8 * 2.5 * std::min(scan, 24);
  const double turned = turn_rate_rad_s * 2.5 * std::max(scan - 24, 0);
  const double radius_m = 8 / turn_rate_rad_s;
  return {3000 + straight_m + radius_m * std::sin(turned), radius_m * (1 - std::cos(turned))};
}

Vec<double, 2> plot(Draw& draw, int scan, double turn_rate_rad_s) {
  const Vec<double, 2> at = place(scan, turn_rate_rad_s);
  return test::plot_of<double>(at[0] + 10 * draw.normal(), at[1] + 10 * draw.normal());
}

/// Starts both trees and gives them the same scans, some of which are missed; `check(scan)` after
/// each that is not.
template <class One, class Other, class Missed, class Check>
void take_the_same(One& one, Other& other, unsigned seed, const Missed& missed,
                   const Check& check) {
  using Scalar = typename Other::Scalar;
  ASSERT_EQ(one.start(steaming()), Status::kOk);
  ASSERT_EQ(other.start(steaming().cast<Scalar>()), Status::kOk);
  Draw draw(seed);
  for (int scan = 1; scan < 40; ++scan) {
    ASSERT_EQ(one.predict(2.5), Status::kOk);
    ASSERT_EQ(other.predict(Scalar(2.5)), Status::kOk);
    if (missed(scan)) continue;
    const Vec<double, 2> z = plot(draw, scan, deg(2.4));
    ASSERT_TRUE(one.update(kRadar, z) && other.update(kRadar, z.cast<Scalar>()));
    check(scan);
  }
}

TEST(ModeHistoryOfRates, WithoutDoubtIsTheTreeOfKnownRates) {
  Tree learns = tree_of(1e-9);
  ModeHistory<Ekf<CoordinatedTurn>> knows(
      {}, kTriple, turning_chain(kTriple),
      Ekf<CoordinatedTurn>(CoordinatedTurn{.turn_rate_rad_s = 0.0, .noise = kNoise}));
  const auto none = [](int) { return false; };
  take_the_same(learns, knows, 81, none, [&](int scan) {
    EXPECT_TRUE(matrices_near(learns.estimate().mean.head<4>().eval(), knows.estimate().mean,
                              {.absolute = 1e-5, .relative = 1e-8}));
    EXPECT_TRUE(matrices_near(learns.mode_probability(), knows.mode_probability(),
                              {.absolute = 1e-6, .relative = 1e-6}));
    ASSERT_EQ(learns.hypotheses().size(), knows.hypotheses().size()) << "scan " << scan;
  });
}

TEST(ModeHistoryOfRates, EachRateHasItsOwnDeviation) {
  TurnRateGrid::Rates std_rad_s(3);
  std_rad_s << deg(0.4), deg(0.05), 1e-4;
  const Tree tree({}, kTriple, std_rad_s, turning_chain(kTriple), Learner(learning(deg(0.4))));
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(tree.bank().filter(k).motion().prior_turn_rate_rad_s, kTriple[k]);
    EXPECT_EQ(tree.bank().filter(k).motion().prior_turn_rate_std_rad_s, std_rad_s[k]);
  }
  for (const double wrong : {0.0, -1.0, std::nan("")}) {
    std_rad_s[2] = wrong;
    EXPECT_THROW(Tree({}, kTriple, std_rad_s, turning_chain(kTriple), Learner(learning(deg(0.4)))),
                 std::invalid_argument);
  }
}

TEST(TurningChain, LeadsToEachTurnByItsWeight) {
  const TurnRateGrid grid{deg(-2.0), deg(-1.0), 0.0, deg(1.0)};
  ModeVector<double, kRuntimeModes> weight(4);
  weight << 1.0, 3.0, 7.0, 4.0;
  const TurnHabits habits{
      .straight_sojourn_s = 50, .turn_sojourn_s = 80, .straighten_probability = 0.6};
  const auto g = *turning_chain(grid, habits, weight).generator_per_s();
  EXPECT_TRUE(matrices_near(g.rowwise().sum().eval(), Vec<double, 4>::Zero(), {.absolute = 1e-15}));
  EXPECT_NEAR(g(2, 0), 1.0 / 8 / 50, 1e-15);  // a straight: 1, 3 and 4 of 8
  EXPECT_NEAR(g(2, 1), 3.0 / 8 / 50, 1e-15);
  EXPECT_NEAR(g(0, 2), 0.6 / 80, 1e-15);
  EXPECT_NEAR(g(0, 1), 0.4 * 3.0 / 7 / 80, 1e-15);  // a turn to another: 3 and 4 of 7
  EXPECT_NEAR(g(0, 3), 0.4 * 4.0 / 7 / 80, 1e-15);
  const auto alike = turning_chain(grid, habits, ModeVector<double, kRuntimeModes>::Ones(4));
  EXPECT_EQ(*turning_chain(grid, habits).generator_per_s(), *alike.generator_per_s());
  weight[1] = 0.0;
  EXPECT_THROW(turning_chain(grid, habits, weight), std::invalid_argument);
  weight[1] = 1.0;
  weight[2] = 0.0;  // that of the straight does not matter
  EXPECT_NO_THROW(turning_chain(grid, habits, weight));
}

TEST(ModeHistoryOfRates, OfOneModeIsItsFilterBitForBit) {
  const ModeChain<kRuntimeModes> one(ModeChain<kRuntimeModes>::Matrix::Ones(1, 1));
  Learner filter(learning(deg(1.0)));
  Tree tree({}, one, Tree::Bank(filter, 1));
  Gaussian<5> known{Vec<double, 5>::Zero(), Mat<double, 5, 5>::Identity() * 1e-4};
  known.mean << 3000, 8, 0, 0, deg(2.0);
  known.covariance.topLeftCorner<4, 4>() = steaming().covariance;
  ASSERT_EQ(tree.start(known), Status::kOk);
  ASSERT_EQ(filter.start(known), Status::kOk);
  Draw draw(82);
  for (int scan = 1; scan < 30; ++scan) {
    ASSERT_EQ(tree.predict(2.5), Status::kOk);
    ASSERT_EQ(filter.predict(2.5), Status::kOk);
    const Vec<double, 2> z = plot(draw, scan, deg(2.4));
    ASSERT_TRUE(tree.update(kRadar, z) && filter.update(kRadar, z));
    ASSERT_TRUE(beliefs_identical<5>(tree.estimate(), filter.estimate())) << "scan " << scan;
  }
}

TEST(ModeHistoryOfRates, ASwitchTakesUpThePriorOfItsMode) {
  HistoryTree settings;
  settings.switch_time_spread = 0.0;
  Tree tree = tree_of(deg(0.5), settings);
  ASSERT_EQ(tree.start(steaming()), Status::kOk);
  Draw draw(83);
  for (int scan = 1; scan < 12; ++scan) {
    ASSERT_EQ(tree.predict(2.5), Status::kOk);
    ASSERT_TRUE(tree.update(kRadar, plot(draw, scan, deg(2.4))));
  }
  const auto likeliest = likeliest_of(tree);
  ASSERT_EQ(tree.predict(2.5), Status::kOk);
  int switches = 0;
  for (const auto& one : tree.hypotheses()) {
    if (one.segment_s != 2.5 || (one.modes >> 4 & 0xF) != (likeliest.modes & 0xF)) continue;
    EXPECT_NEAR(one.belief.mean[4], kTriple[one.mode()], 1e-15);
    const double std_rad_s = one.mode() == 1 ? deg(0.05) : deg(0.5);  // a straight is straight
    EXPECT_NEAR(one.belief.covariance(4, 4), std_rad_s * std_rad_s, 1e-15);
    ++switches;
  }
  EXPECT_GT(switches, 0);
  const auto one = likeliest_of(tree, [](const auto& any) { return any.segment_s == 2.5; });
  Learner filter = tree.bank().filter(one.mode());
  ASSERT_EQ(filter.start(Gaussian<4>{likeliest.belief.mean.head<4>(),
                                     likeliest.belief.covariance.topLeftCorner<4, 4>()}),
            Status::kOk);
  ASSERT_EQ(filter.predict(2.5), Status::kOk);
  EXPECT_TRUE(
      matrices_near(one.belief.mean, filter.estimate().mean, {.absolute = 1e-9, .relative = 1e-12}))
      << "the likeliest of them came from the likeliest hypothesis";
  EXPECT_TRUE(matrices_near(one.belief.covariance, filter.estimate().covariance,
                            {.absolute = 1e-9, .relative = 1e-12}));
}

TEST(ModeHistoryOfRates, LearnsARateBesideTheGrid) {
  for (const double rate : {deg(1.9), deg(-3.8)}) {
    Tree tree = tree_of(deg(0.8));
    ASSERT_EQ(tree.start(steaming()), Status::kOk);
    Draw draw(84);
    for (int scan = 1; scan < 64; ++scan) {
      ASSERT_EQ(tree.predict(2.5), Status::kOk);
      ASSERT_TRUE(tree.update(kRadar, plot(draw, scan, rate)));
    }
    const auto likeliest = likeliest_of(tree).belief;
    const double std_rad_s = std::sqrt(likeliest.covariance(4, 4));
    EXPECT_NEAR(likeliest.mean[4], rate, 4 * std_rad_s);
    EXPECT_LT(std_rad_s, deg(0.2)) << "and it knows that it does";
  }
}

TEST(ModeHistoryOfRates, InLanesIsTheSame) {
  Tree alone = tree_of(deg(0.8));
  auto lanes = tree_of<Pack<double, kNativeLanes<double>>>(deg(0.8));
  const auto every_seventh = [](int scan) { return scan % 7 == 0; };
  take_the_same(alone, lanes, 85, every_seventh, [&](int) {
    EXPECT_TRUE(matrices_near(lanes.estimate().mean, alone.estimate().mean,
                              {.absolute = 1e-7, .relative = 1e-9}));
    EXPECT_TRUE(matrices_near(lanes.mode_probability(), alone.mode_probability(),
                              {.absolute = 1e-8, .relative = 1e-8}));
  });
}

TEST(ModeHistoryOfRates, DoesNotTouchTheHeap) {
  Tree tree = tree_of(deg(0.8));
  const test::NoHeap fence;
  bool good = tree.start(steaming()) == Status::kOk;
  for (int scan = 1; scan < 6; ++scan) {
    good = tree.predict(2.5) == Status::kOk && good;
    good = tree.predict(2.5) == Status::kOk && good;  // a scan was missed
    good =
        static_cast<bool>(tree.update(kRadar, test::plot_of<double>(3000 + 40 * scan, 3))) && good;
  }
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_TRUE(good);
}

/// A quiet mode and a restless one, of one prior rate.
Tree of_two_noises(const HistoryTree& settings) {
  std::vector<Learner> filters(2, Learner(learning(deg(3.0))));
  CoordinatedTurnRate restless = learning(deg(3.0));
  restless.turn_rate_psd_rad2s3 = 1e-4;
  filters[1] = Learner(restless);
  const ModeChain<kRuntimeModes> chain(ModeChain<kRuntimeModes>::Matrix{{0.9, 0.1}, {0.2, 0.8}});
  return Tree(settings, chain, Tree::Bank(std::span<const Learner>(filters)));
}

TEST(ModeHistoryOfRates, WhereModesDoNotGuessTheRateASwitchKeepsIt) {
  Gaussian<5> known{Vec<double, 5>::Zero(), Mat<double, 5, 5>::Identity() * 1e-8};
  known.mean << 3000, 8, 0, 0, deg(5.0);
  known.covariance.topLeftCorner<4, 4>() = steaming().covariance;
  for (const int order : {0, 1, 2}) {
    Tree tree = of_two_noises(order == 0 ? HistoryTree{} : HistoryTree::pseudo_bayes(order, 2));
    ASSERT_EQ(tree.start(known), Status::kOk);
    for (int scan = 0; scan < 3; ++scan) ASSERT_EQ(tree.predict(2.5), Status::kOk);
    for (const auto& one : tree.hypotheses()) EXPECT_NEAR(one.belief.mean[4], deg(5.0), 1e-12);
  }
}

TEST(ModeHistoryOfRates, InFloatIsTheSameToItsDigits) {
  Tree one = tree_of(deg(0.8));
  auto other = tree_of<float>(deg(0.8));
  const auto two_in_a_row = [](int scan) { return scan % 9 > 6; };
  take_the_same(one, other, 86, two_in_a_row, [&](int scan) {
    const Vec<double, 5> apart = other.estimate().mean.cast<double>() - one.estimate().mean;
    EXPECT_LT(apart.head<4>().norm(), 1.0) << scan;
    EXPECT_LT(std::abs(apart[4]), 1e-3) << scan;
  });
}

TEST(ModeHistoryOfRates, ContinuesFromItsArchiveWithTheSameBits) {
  Tree tree = tree_of(deg(0.8)), other = tree;
  ASSERT_EQ(tree.start(steaming()), Status::kOk);
  Draw draw(87);
  for (int scan = 1; scan < 30; ++scan) {
    ASSERT_EQ(tree.predict(2.5), Status::kOk);
    ASSERT_TRUE(tree.update(kRadar, plot(draw, scan, deg(2.4))));
  }
  Archive writing;
  tree.archive(writing);
  Archive reading(writing.bytes());
  other.archive(reading);
  ASSERT_TRUE(reading.ok() && reading.at_end());
  for (int scan = 30; scan < 36; ++scan) {
    ASSERT_EQ(tree.predict(2.5), Status::kOk);
    ASSERT_EQ(other.predict(2.5), Status::kOk);
    if (scan < 33) continue;  // missed
    const Vec<double, 2> z = plot(draw, scan, deg(2.4));
    ASSERT_TRUE(tree.update(kRadar, z) && other.update(kRadar, z));
    EXPECT_TRUE(beliefs_identical<5>(other.estimate(), tree.estimate()));
  }
}

TEST(ModeHistoryOfRates, EvidenceIsTheLikelihoodOfTheUpdate) {
  Tree tree = tree_of(deg(0.8));
  ASSERT_EQ(tree.start(steaming()), Status::kOk);
  ASSERT_EQ(tree.predict(2.5), Status::kOk);
  const Vec<double, 2> z = test::plot_of<double>(3025, -4);
  const auto evidence = tree.evidence(kRadar, z);
  const auto step = tree.update(kRadar, z);
  EXPECT_NEAR(std::log(evidence.likelihood), step.log_likelihood, 1e-9);
}

TEST(ModeHistoryOfRates, OneBeliefForAllModesIsRejected) {
  EXPECT_THROW(tree_of(deg(0.8), HistoryTree::pseudo_bayes(1, 3)), std::invalid_argument);
  EXPECT_NO_THROW(tree_of(deg(0.8), HistoryTree::pseudo_bayes(2, 3)));
}

TEST(CoordinatedTurnRate, StartsAboutItsPriorRate) {
  CoordinatedTurnRate motion = learning(deg(1.0));
  motion.prior_turn_rate_rad_s = deg(-2.0);
  Learner filter(motion);
  ASSERT_EQ(filter.start(steaming()), Status::kOk);
  EXPECT_EQ(filter.estimate().mean[4], deg(-2.0));
  EXPECT_EQ(filter.estimate().covariance(4, 4), deg(1.0) * deg(1.0));
  EXPECT_EQ(filter.estimate().mean.head<4>(), steaming().mean);
  motion.prior_turn_rate_rad_s = std::nan("");
  EXPECT_THROW(Learner{motion}, std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::mode_history_rates_test
