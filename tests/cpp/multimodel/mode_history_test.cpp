// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/multimodel/mode_history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/turning_chain.hpp"

namespace wakeline::mode_history_test {
namespace {

using test::beliefs_identical;
using test::Draw;
using test::matrices_identical;
using test::matrices_near;

using Filter = Ekf<CoordinatedTurn>;
using Tree = ModeHistory<Filter>;
using Chain = ModeChain<kRuntimeModes>;

const RangeBearing kRadar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
const TurnRateGrid kPair{0.0, deg(3.0)};
const TurnRateGrid kTriple{deg(-3.0), 0.0, deg(3.0)};

Filter turning(double rate_rad_s = 0.0) {
  return Filter{
      CoordinatedTurn{.turn_rate_rad_s = rate_rad_s, .noise = PiecewiseAcceleration{0.1}}};
}

/// Nothing joins and nothing is cut.
HistoryTree whole(int branches = 256) {
  return {.max_hypotheses = branches - 1,
          .max_branches = branches,
          .min_segment_s = 0.0,
          .merge_distance = 0.0,
          .sibling_distance = 0.0,
          .switch_time_spread = 0.0,
          .negligible_probability = 0.0};
}

Chain asymmetric() { return Chain(Chain::Matrix{{0.9, 0.1}, {0.4, 0.6}}); }

Vec<double, 2> reading(Draw& draw) {
  return test::plot_of<double>(3000 + 40 * draw.normal(), 4000 + 40 * draw.normal());
}

TEST(ModeHistory, OfOneModeIsItsFilterBitForBit) {
  const Chain one(Chain::Matrix::Ones(1, 1));
  Tree tree({}, one, Tree::Bank(turning(deg(1.0)), 1));
  Filter filter = turning(deg(1.0));
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(filter.start(test::five_km_off<double>()), Status::kOk);
  Draw draw(71);
  for (int scan = 0; scan < 30; ++scan) {
    const double dt = draw.uniform(0, 5);
    ASSERT_EQ(tree.predict(dt), Status::kOk);
    ASSERT_EQ(filter.predict(dt), Status::kOk);
    if (scan % 4 != 3) {
      const Vec<double, 2> z = reading(draw);
      const auto step = tree.update(kRadar, z);
      const auto expected = filter.update(kRadar, z);
      ASSERT_TRUE(step && expected);
      EXPECT_EQ(step.nis, expected.nis);
      EXPECT_EQ(step.log_likelihood, expected.log_likelihood);
    }
    ASSERT_TRUE(beliefs_identical<4>(tree.estimate(), filter.estimate())) << "scan " << scan;
    EXPECT_EQ(tree.hypotheses().size(), 1u);
  }
}

/// One filter for each sequence of modes: what Bayes' rule says, at the price of K to the power of
/// the number of scans.
class Enumeration {
 public:
  Enumeration(const TurnRateGrid& grid, const Chain& chain, const Vec<double, -1>& initial)
      : chain_(chain) {
    for (int k = 0; k < grid.size(); ++k) {
      rates_.push_back(grid[k]);
      histories_.push_back({turning(grid[k]), k, initial[k]});
      (void)histories_.back().filter.start(test::five_km_off<double>());
    }
  }

  /// The logarithm of the likelihood of z; all histories continue.
  double scan(double dt, const Vec<double, 2>& z) {
    const auto p = chain_.transition(dt);
    std::vector<History> next;
    double total = 0.0;
    for (const History& history : histories_)
      for (int mode = 0; mode < int(rates_.size()); ++mode) {
        Filter filter = turning(rates_[std::size_t(mode)]);
        (void)filter.assign(history.filter.estimate());
        (void)filter.predict(dt);
        const auto step = filter.update(kRadar, z);
        const double joint = history.weight * p(history.mode, mode) * std::exp(step.log_likelihood);
        next.push_back({filter, mode, joint});
        total += joint;
      }
    for (History& history : next) history.weight /= total;
    histories_ = next;
    return std::log(total);
  }

  Gaussian<4> estimate() const {
    Gaussian<4> sum;
    sum.mean.setZero();
    sum.covariance.setZero();
    for (const auto& h : histories_) sum.mean += h.weight * h.filter.estimate().mean;
    for (const auto& h : histories_) {
      const Vec<double, 4> d = h.filter.estimate().mean - sum.mean;
      sum.covariance += h.weight * (h.filter.estimate().covariance + d * d.transpose());
    }
    return sum;
  }

  double probability(int mode) const {
    double sum = 0.0;
    for (const auto& h : histories_) sum += h.mode == mode ? h.weight : 0.0;
    return sum;
  }

 private:
  struct History {
    Filter filter;
    int mode;
    double weight;
  };
  Chain chain_;
  std::vector<double> rates_;
  std::vector<History> histories_;
};

void expect_enumeration(Tree tree, const TurnRateGrid& grid, const Chain& chain, int scans) {
  Vec<double, -1> initial = tree.mode_probability();
  Enumeration all(grid, chain, initial);
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  Draw draw(72);
  for (int scan = 0; scan < scans; ++scan) {
    const Vec<double, 2> z = reading(draw);
    const double dt = 2.0 + scan;
    ASSERT_EQ(tree.predict(dt), Status::kOk);
    const auto step = tree.update(kRadar, z);
    ASSERT_TRUE(step);
    EXPECT_NEAR(step.log_likelihood, all.scan(dt, z), 1e-9);
    EXPECT_TRUE(matrices_near(tree.estimate().mean, all.estimate().mean,
                              {.absolute = 1e-8, .relative = 1e-10}));
    EXPECT_LT((test::covariance_difference<double, 4>(tree.estimate().covariance,
                                                      all.estimate().covariance)),
              1e-9);
    for (int mode = 0; mode < grid.size(); ++mode)
      EXPECT_NEAR(tree.mode_probability()[mode], all.probability(mode), 1e-10);
  }
}

TEST(ModeHistory, ThatIsNeverCutIsTheSumOverAllHistories) {
  expect_enumeration(Tree(whole(), kPair, asymmetric(), turning()), kPair, asymmetric(), 6);
  const Chain chain = turning_chain(kTriple);
  expect_enumeration(Tree(whole(), kTriple, chain, turning()), kTriple, chain, 4);
}

TEST(ModeHistory, PseudoBayesOfAnOrderBeyondTheScansIsTheSumOverAllHistories) {
  expect_enumeration(Tree(HistoryTree::pseudo_bayes(8, 2), kPair, asymmetric(), turning()), kPair,
                     asymmetric(), 7);
}

/// GPB1 and GPB2 as the book has them: each filter sets out from the one estimate, or from that of
/// each mode.
Gaussian<4> moment_matched(const std::vector<Gaussian<4>>& parts, const std::vector<double>& w) {
  Gaussian<4> sum;
  sum.mean.setZero();
  sum.covariance.setZero();
  for (std::size_t k = 0; k < parts.size(); ++k) sum.mean += w[k] * parts[k].mean;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Vec<double, 4> d = parts[k].mean - sum.mean;
    sum.covariance += w[k] * (parts[k].covariance + d * d.transpose());
  }
  return sum;
}

void expect_pseudo_bayes(int order) {
  const Chain chain = asymmetric();
  const auto p = chain.transition(2.5);
  Tree tree(HistoryTree::pseudo_bayes(order, 2), kPair, chain, turning());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  std::vector<Gaussian<4>> of_mode(2, test::five_km_off<double>());
  std::vector<double> mu{0.9, 0.1};
  Draw draw(73);
  for (int scan = 0; scan < 12; ++scan) {
    const Vec<double, 2> z = reading(draw);
    ASSERT_EQ(tree.predict(2.5), Status::kOk);
    ASSERT_TRUE(tree.update(kRadar, z));

    const std::vector<Gaussian<4>> from =
        order == 1 ? std::vector<Gaussian<4>>(2, moment_matched(of_mode, mu)) : of_mode;
    std::vector<Gaussian<4>> next;
    std::vector<double> weight;
    for (int j = 0; j < 2; ++j) {
      std::vector<Gaussian<4>> parts;
      std::vector<double> parts_weight;
      double sum = 0.0;
      for (int i = 0; i < 2; ++i) {
        Filter filter = turning(kPair[j]);
        ASSERT_EQ(filter.start(from[std::size_t(i)]), Status::kOk);
        ASSERT_EQ(filter.predict(2.5), Status::kOk);
        const auto step = filter.update(kRadar, z);
        parts.push_back(filter.estimate());
        parts_weight.push_back(p(i, j) * mu[std::size_t(i)] * std::exp(step.log_likelihood));
        sum += parts_weight.back();
      }
      for (double& part : parts_weight) part /= sum;
      next.push_back(moment_matched(parts, parts_weight));
      weight.push_back(sum);
    }
    for (std::size_t j = 0; j < 2; ++j) mu[j] = weight[j] / (weight[0] + weight[1]);
    of_mode = next;
    EXPECT_NEAR(tree.mode_probability()[0], mu[0], 1e-10) << "scan " << scan;
    const Gaussian<4> estimate = moment_matched(of_mode, mu);
    EXPECT_TRUE(
        matrices_near(tree.estimate().mean, estimate.mean, {.absolute = 1e-8, .relative = 1e-10}));
    EXPECT_LT(
        (test::covariance_difference<double, 4>(tree.estimate().covariance, estimate.covariance)),
        1e-9);
    EXPECT_EQ(tree.hypotheses().size(), 2u);
  }
}

TEST(ModeHistory, PseudoBayesOfFirstAndSecondOrder) {
  expect_pseudo_bayes(1);
  expect_pseudo_bayes(2);
}

TEST(ModeHistory, MissedScansRelaxTheModesAlongTheChain) {
  for (const int order : {0, 1, 2}) {
    const HistoryTree settings = order == 0 ? whole() : HistoryTree::pseudo_bayes(order, 2);
    Tree tree(settings, kPair, asymmetric(), turning());
    ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
    Vec<double, 2> expected(0.9, 0.1);
    for (int miss = 0; miss < 6; ++miss) {
      expected = (asymmetric().transition(2.5).transpose() * expected).eval();
      ASSERT_EQ(tree.predict(2.5), Status::kOk);
      EXPECT_NEAR(tree.mode_probability()[0], expected[0], 1e-12) << "order " << order;
    }
  }
}

TEST(ModeHistory, SwitchesWithTheTimeThatHasPassed) {
  const Chain chain = Chain::from_sojourn_s({60.0, 15.0});
  Tree tree(whole(), kPair, chain, turning());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  for (const double dt : {1.0, 0.5, 3.0}) ASSERT_EQ(tree.predict(dt), Status::kOk);
  const Vec<double, 2> expected = chain.transition(4.5).transpose() * Vec<double, 2>(0.9, 0.1);
  EXPECT_NEAR(tree.mode_probability()[0], expected[0], 1e-12);
}

TEST(ModeHistory, ASegmentLastsItsLeastTime) {
  HistoryTree settings = whole();
  settings.min_segment_s = 9.0;
  Tree tree(settings, kPair, asymmetric(), turning());
  tree.set_initial_mode_probability(Vec<double, 2>(1.0, 0.0));
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(tree.predict(3.0), Status::kOk);  // a vessel may turn at once, for 9 s at least
  EXPECT_NEAR(tree.mode_probability()[1], 0.1, 1e-12);
  for (const double left : {0.9 * 0.9, 0.9 * 0.9 * 0.9}) {
    ASSERT_EQ(tree.predict(3.0), Status::kOk);
    EXPECT_NEAR(tree.mode_probability()[0], left, 1e-12) << "none comes back yet";
  }
  ASSERT_EQ(tree.predict(3.0), Status::kOk);
  EXPECT_NEAR(tree.mode_probability()[0], std::pow(0.9, 4) + 0.1 * 0.4, 1e-12);
}

// A cut that keeps one of two hypotheses of the same probability cannot know port from starboard;
// this tree is not cut.
TEST(ModeHistory, KnowsNoDifferenceOfPortAndStarboard) {
  const Chain chain = turning_chain(kTriple);
  HistoryTree settings;
  settings.max_branches = 256;
  settings.max_hypotheses = 80;
  settings.min_segment_s = 15.0;
  Tree tree(settings, kTriple, chain, turning()), mirrored = tree;
  Gaussian<4> start;
  start.mean << 3000, 8, 0, 0;
  start.covariance = Vec<double, 4>(400, 4, 400, 4).asDiagonal();
  ASSERT_EQ(tree.start(start), Status::kOk);
  ASSERT_EQ(mirrored.start(start), Status::kOk);
  Draw draw(74);
  for (int scan = 0; scan < 20; ++scan) {
    const double turned = deg(3.0) * 2.5 * std::max(scan - 8, 0);  // straight, then on a circle
    const double north = 3000 + 20 * std::min(scan, 8) + 153 * std::sin(turned) + draw.normal();
    const double east = 153 * (1 - std::cos(turned)) + draw.normal();
    ASSERT_EQ(tree.predict(2.5), Status::kOk);
    ASSERT_EQ(mirrored.predict(2.5), Status::kOk);
    ASSERT_TRUE(tree.update(kRadar, test::plot_of<double>(north, east)));
    ASSERT_TRUE(mirrored.update(kRadar, test::plot_of<double>(north, -east)));
    const Vec<double, 4> sign(1, 1, -1, -1);
    EXPECT_TRUE(matrices_near(mirrored.estimate().mean,
                              tree.estimate().mean.cwiseProduct(sign).eval(),
                              {.absolute = 1e-6, .relative = 1e-8}));
    EXPECT_NEAR(mirrored.mode_probability()[0], tree.mode_probability()[2], 1e-8);
  }
  EXPECT_GT(tree.mode_probability()[2], 0.5) << "and it has seen the turn";
}

TEST(ModeHistory, StaysWithinItsBoundsOverALongRun) {
  HistoryTree settings;
  settings.max_hypotheses = 20;
  settings.max_branches = 35;
  Tree tree(settings, TurnRateGrid::evenly(deg(4.0), 4),
            turning_chain(TurnRateGrid::evenly(deg(4.0), 4)), turning());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  Draw draw(75);
  for (int scan = 0; scan < 1500; ++scan) {
    ASSERT_EQ(tree.predict(draw.uniform(0, 10)), Status::kOk);
    EXPECT_LE(tree.hypotheses().size(), 35u);
    if (draw.uniform(0, 1) < 0.7) {
      (void)tree.update(kRadar, reading(draw));
      EXPECT_LE(tree.hypotheses().size(), 20u);
    }
    ASSERT_NEAR(tree.mode_probability().sum(), 1.0, 1e-12);
    ASSERT_TRUE((test::is_covariance<double, 4>(tree.estimate().covariance))) << "scan " << scan;
    double sum = 0.0;
    for (const auto& hypothesis : tree.hypotheses()) {
      ASSERT_GE(hypothesis.probability, 0.0);
      sum += hypothesis.probability;
    }
    ASSERT_NEAR(sum, 1.0, 1e-12);
  }
}

TEST(ModeHistory, JoiningKeepsTheMoments) {
  HistoryTree loose = whole(), joining = whole();
  joining.merge_distance = joining.sibling_distance = std::numeric_limits<double>::infinity();
  Tree a(loose, kTriple, turning_chain(kTriple), turning());
  Tree b(joining, kTriple, turning_chain(kTriple), turning());
  ASSERT_EQ(a.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(b.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(a.predict(2.5), Status::kOk);
  ASSERT_EQ(b.predict(2.5), Status::kOk);
  ASSERT_TRUE(a.update(kRadar, test::plot_of<double>(2990, 4020)));
  ASSERT_TRUE(b.update(kRadar, test::plot_of<double>(2990, 4020)));
  EXPECT_EQ(a.hypotheses().size(), 9u);
  EXPECT_EQ(b.hypotheses().size(), 3u) << "one for each mode";
  EXPECT_TRUE(matrices_near(a.estimate().mean, b.estimate().mean));
  EXPECT_LT(
      (test::covariance_difference<double, 4>(a.estimate().covariance, b.estimate().covariance)),
      1e-12);
  EXPECT_TRUE(matrices_near(a.mode_probability(), b.mode_probability()));
}

TEST(ModeHistory, EvidenceIsTheLikelihoodOfTheUpdate) {
  Tree tree({}, kTriple, turning_chain(kTriple), turning());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  Draw draw(76);
  for (int scan = 0; scan < 10; ++scan) {
    ASSERT_EQ(tree.predict(2.5), Status::kOk);
    const Vec<double, 2> z = reading(draw);
    const auto before = tree.estimate();
    const auto evidence = tree.evidence(kRadar, z);
    EXPECT_TRUE(beliefs_identical<4>(tree.estimate(), before)) << "it only looks";
    const Alternative<RangeBearing> only{kRadar, z, 1.0};
    Tree other = tree;
    double share = 0.0;
    const double total =
        other.update<RangeBearing>(std::span(&only, 1), 0.0, std::span<double>(&share, 1));
    const auto step = tree.update(kRadar, z);
    ASSERT_TRUE(step);
    EXPECT_NEAR(std::log(evidence.likelihood), step.log_likelihood, 1e-9);
    EXPECT_NEAR(std::log(total), step.log_likelihood, 1e-9) << "one reading, certain to be its own";
    EXPECT_NEAR(share, 1.0, 1e-12);
    EXPECT_TRUE(matrices_near(other.estimate().mean, tree.estimate().mean,
                              {.absolute = 1e-8, .relative = 1e-10}));
  }
}

TEST(ModeHistory, ReadingsThatAreNotItsOwnChangeNothing) {
  Tree tree({}, kTriple, turning_chain(kTriple), turning());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(tree.predict(2.5), Status::kOk);
  const Gaussian<4> before = tree.estimate();
  std::span<const Alternative<RangeBearing>> none;
  EXPECT_NEAR(tree.update<RangeBearing>(none, 0.3, {}), 0.3, 1e-12);
  EXPECT_TRUE(matrices_near(tree.estimate().mean, before.mean));
  EXPECT_LT((test::covariance_difference<double, 4>(tree.estimate().covariance, before.covariance)),
            1e-12);
}

TEST(ModeHistory, AStepThatFailsChangesNothing) {
  Tree tree({}, kTriple, turning_chain(kTriple), turning());
  EXPECT_EQ(tree.predict(1.0), Status::kNotStarted);
  EXPECT_EQ(tree.update(kRadar, test::plot_of<double>(3000, 4000)).status, Status::kNotStarted);
  Gaussian<4> impossible = test::five_km_off<double>();
  impossible.covariance(0, 0) = -1;
  EXPECT_EQ(tree.start(impossible), Status::kNotPositiveDefinite);
  EXPECT_FALSE(tree.started());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(tree.predict(2.5), Status::kOk);
  ASSERT_TRUE(tree.update(kRadar, test::plot_of<double>(2990, 4020)));
  const Gaussian<4> before = tree.estimate();
  const auto modes = tree.mode_probability();
  const auto expect_unchanged = [&](const char* what) {
    EXPECT_TRUE(beliefs_identical<4>(tree.estimate(), before)) << what;
    EXPECT_TRUE(matrices_identical(tree.mode_probability(), modes)) << what;
  };
  const double nan = std::nan("");
  EXPECT_EQ(tree.start(impossible), Status::kNotPositiveDefinite);
  expect_unchanged("a start");
  EXPECT_EQ(tree.predict(-1.0), Status::kNegativeTimeStep);
  EXPECT_EQ(tree.predict(nan), Status::kNotFinite);
  EXPECT_EQ(tree.predict(1e200), Status::kNotFinite);
  EXPECT_EQ(tree.predict(1.0, Vec<double, 2>(nan, 0.0)), Status::kNotFinite);
  expect_unchanged("a prediction");
  EXPECT_EQ(tree.update(kRadar, Vec<double, 2>(nan, 1.0)).status, Status::kNotFinite);
  expect_unchanged("an update");
  const Alternative<RangeBearing> bad{kRadar, Vec<double, 2>(nan, 1.0), 1.0};
  double share = 1.0;
  EXPECT_EQ(tree.update<RangeBearing>(std::span(&bad, 1), 0.0, std::span<double>(&share, 1)), 0.0);
  expect_unchanged("an impossible association");
}

// What histories of other gains make of it differs by more than has a square.
template <class Model, class Sensor>
void expect_that_it_is_a_plot_or_leaves_the_prediction(const Model& model, const Sensor& sensor,
                                                       const Vec<double, 2>& far) {
  ModeHistory<Ekf<Model>> tree({}, kTriple, turning_chain(kTriple), Ekf{model});
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  for (int scan = 0; scan < 4; ++scan) ASSERT_EQ(tree.predict(3.0), Status::kOk);
  const auto before = tree.estimate();
  if (const auto step = tree.update(sensor, far); !step) {
    EXPECT_EQ(step.status, Status::kNotFinite) << far;
    EXPECT_TRUE(beliefs_identical<Model::kComponents.size()>(tree.estimate(), before)) << far;
  }
  for (int scan = 0; scan < 8; ++scan) {
    EXPECT_TRUE(is_finite(tree.estimate().mean)) << far;
    EXPECT_TRUE(is_finite(tree.estimate().covariance)) << far;
    EXPECT_EQ(tree.predict(3.0), Status::kOk) << far;
    if (scan > 3) (void)tree.update(Position{10.0}, Vec<double, 2>(3000.0, 4000.0));
  }
}

TEST(ModeHistory, APlotWithoutASquareLeavesThePrediction) {
  const Position position{.position_std_m = 10.0};
  for (int power = 140; power <= 308; power += 12) {
    const double far_m = std::pow(10.0, power);
    for (const Vec<double, 2>& z : {Vec<double, 2>(far_m, 0.0), Vec<double, 2>(far_m, far_m)}) {
      expect_that_it_is_a_plot_or_leaves_the_prediction(CoordinatedTurn{}, position, z);
      expect_that_it_is_a_plot_or_leaves_the_prediction(CoordinatedTurnRate{}, position, z);
    }
    const Vec<double, 2> ahead(far_m, std::atan2(4.0, 3.0));
    expect_that_it_is_a_plot_or_leaves_the_prediction(CoordinatedTurn{}, kRadar, ahead);
    expect_that_it_is_a_plot_or_leaves_the_prediction(CoordinatedTurnRate{}, kRadar, ahead);
  }
}

TEST(ModeHistory, HistoriesNearUnderflowDoNotAffectProbableOnes) {
  // Of what one plot far off leaves to some of them a reciprocal is beyond numbers.
  const Position sensor{.position_std_m = 2.0};
  for (double away_m = 500.0; away_m < 1000.0; away_m += 20.0) {
    Tree tree(HistoryTree::pseudo_bayes(6, 2), kPair, Chain(Chain::Matrix{{0.9, 0.1}, {0.1, 0.9}}),
              turning());
    Gaussian<4> start;
    start.mean << 0.0, 10.0, 0.0, 0.0;
    ASSERT_EQ(tree.start(start), Status::kOk);
    for (int scan = 1; scan <= 8; ++scan) {
      ASSERT_EQ(tree.predict(3.0), Status::kOk) << away_m;
      const Vec<double, 2> z(30.0 * scan, scan == 5 ? away_m : 0.0);
      ASSERT_EQ(tree.update(sensor, z).status, Status::kOk) << away_m;
      ASSERT_TRUE(is_finite(tree.estimate().mean)) << away_m;
      ASSERT_TRUE(is_finite(tree.estimate().covariance)) << away_m;
    }
  }
}

TEST(ModeHistory, KeepsTheLikeliestHoweverUnlikely) {
  const auto grid = TurnRateGrid::evenly(deg(3.5), 7);
  HistoryTree settings = whole();
  settings.negligible_probability = 0.0099;
  Tree tree(settings, grid, Chain(Chain::Matrix::Constant(15, 15, 1.0 / 15)), turning());
  tree.set_initial_mode_probability(Tree::Probability::Constant(15, 1.0 / 15));
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(tree.predict(0.0), Status::kOk);
  ASSERT_TRUE(tree.update(kRadar, test::plot_of<double>(3000, 4000)));
  EXPECT_GE(tree.hypotheses().size(), 1u);
  EXPECT_NEAR(tree.mode_probability().sum(), 1.0, 1e-12);
}

TEST(ModeHistory, AChainThatNeverStaysLeaves) {
  Tree tree({.max_hypotheses = 2, .max_branches = 3, .min_segment_s = 0.0}, kPair,
            Chain(Chain::Matrix{{0.0, 1.0}, {1.0, 0.0}}), turning());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(tree.predict(3.0), Status::kOk);
  EXPECT_TRUE(is_finite(tree.estimate().mean));
  EXPECT_NEAR(tree.mode_probability().sum(), 1.0, 1e-12);
}

TEST(ModeHistory, AChainPerPredictionAppliesInNoTimeToo) {
  Tree tree(whole(), kTriple, Chain(Chain::Matrix::Constant(3, 3, 1.0 / 3)), turning());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  for (int k = 0; k < 3; ++k) ASSERT_EQ(tree.predict(0.0), Status::kOk);
  EXPECT_TRUE(
      matrices_near(tree.mode_probability(), Tree::Probability::Constant(3, 1.0 / 3).eval()));
}

TEST(ModeHistory, APredictionThatFailsAfterMissedScansChangesNothing) {
  Tree tree({}, kTriple, turning_chain(kTriple), turning());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  for (int miss = 0; miss < 8; ++miss) ASSERT_EQ(tree.predict(3.0), Status::kOk);
  const auto before = tree.estimate();
  const auto count = tree.hypotheses().size();
  EXPECT_EQ(tree.predict(1e300), Status::kNotFinite);
  EXPECT_TRUE(beliefs_identical<4>(tree.estimate(), before));
  EXPECT_EQ(tree.hypotheses().size(), count);
}

TEST(ModeHistory, ADamagedArchiveChangesNothing) {
  Tree tree({}, kTriple, turning_chain(kTriple), turning());
  Archive of_none;
  tree.archive(of_none);
  EXPECT_NEAR(tree.mode_probability().sum(), 1.0, 1e-12) << "to save changes nothing";
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  Archive writing;
  tree.archive(writing);
  const auto before = tree.estimate();
  for (const std::size_t at : {std::size_t(1), std::size_t(4), writing.bytes().size() - 1}) {
    std::vector<std::byte> bytes = writing.bytes();
    bytes[at] = std::byte{0xFF};
    if (at + 1 == bytes.size()) bytes.resize(at - 40);
    Archive damaged(bytes);
    tree.archive(damaged);
    EXPECT_FALSE(damaged.ok()) << at;
    EXPECT_TRUE(beliefs_identical<4>(tree.estimate(), before)) << at;
  }
}

TEST(ModeHistory, AnArchiveOfATreeWithOtherParametersIsRejected) {
  Tree tree({}, kTriple, turning_chain(kTriple), turning());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  Archive writing;
  tree.archive(writing);
  for (const HistoryTree& rules :
       {HistoryTree{.max_hypotheses = 70}, HistoryTree{.max_branches = 95},
        HistoryTree{.min_segment_s = 6.6}, HistoryTree{.merge_distance = 1.8},
        HistoryTree{.sibling_distance = 11.0}, HistoryTree{.switch_time_spread = 0.2},
        HistoryTree{.negligible_probability = 3e-7}}) {
    Tree other(rules, kTriple, turning_chain(kTriple), turning());
    Archive reading(writing.bytes());
    other.archive(reading);
    EXPECT_FALSE(reading.ok());
    EXPECT_FALSE(other.started());
  }
}

TEST(ModeHistory, ContinuesFromItsArchiveWithTheSameBits) {
  Tree tree({}, kTriple, turning_chain(kTriple), turning());
  ASSERT_EQ(tree.start(test::five_km_off<double>()), Status::kOk);
  Draw draw(77);
  const auto scan = [&](Tree& one, const Vec<double, 2>& z) {
    ASSERT_EQ(one.predict(2.5), Status::kOk);
    ASSERT_TRUE(one.update(kRadar, z));
  };
  for (int k = 0; k < 8; ++k) scan(tree, reading(draw));
  Archive writing;
  tree.archive(writing);
  Tree other({}, kTriple, turning_chain(kTriple), turning());
  Archive reading_back(writing.bytes());
  other.archive(reading_back);
  ASSERT_TRUE(reading_back.ok() && reading_back.at_end());
  for (int k = 0; k < 5; ++k) {
    const Vec<double, 2> z = reading(draw);
    scan(tree, z);
    scan(other, z);
    EXPECT_TRUE(beliefs_identical<4>(other.estimate(), tree.estimate()));
    EXPECT_TRUE(matrices_identical(other.mode_probability(), tree.mode_probability()));
  }
}

TEST(ModeHistory, DoesNotTouchTheHeap) {
  Tree tree({}, kTriple, turning_chain(kTriple), turning());
  const Alternative<RangeBearing> one{kRadar, test::plot_of<double>(2990, 4010), 0.5};
  const test::NoHeap fence;
  bool good = tree.start(test::five_km_off<double>()) == Status::kOk;
  double position = 0.0, share = 0.0;
  for (int scan = 0; scan < 6; ++scan) {
    good = tree.predict(2.5 + scan) == Status::kOk && good;
    good = static_cast<bool>(tree.update(kRadar, test::plot_of<double>(2990, 4010))) && good;
    good = tree.evidence(kRadar, one.z).likelihood > 0.0 && good;
    good = tree.update<RangeBearing>(std::span(&one, 1), 0.5, std::span<double>(&share, 1)) > 0.0 &&
           good;
    position += tree.estimate().mean[0];
  }
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_TRUE(good);
  EXPECT_GT(position, 0.0);
}

TEST(ModeHistory, InvalidParametersAreRejected) {
  const Chain chain = turning_chain(kTriple);
  const auto with = [&](HistoryTree tree) { return Tree(tree, kTriple, chain, turning()); };
  EXPECT_THROW(with({.max_hypotheses = 0}), std::invalid_argument);
  EXPECT_THROW(with({.max_hypotheses = 2}), std::invalid_argument) << "fewer than modes";
  EXPECT_THROW(with({.max_hypotheses = 100, .max_branches = 99}), std::invalid_argument);
  EXPECT_THROW(with({.max_branches = 257}), std::invalid_argument) << "beyond the capacity";
  EXPECT_THROW(with({.max_hypotheses = 3, .max_branches = 2, .pseudo_bayes_order = 1}),
               std::invalid_argument);
  EXPECT_THROW(with({.min_segment_s = -1.0}), std::invalid_argument);
  EXPECT_THROW(with({.merge_distance = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(with({.merge_distance = 2.0, .sibling_distance = 1.0}), std::invalid_argument);
  EXPECT_THROW(with({.switch_time_spread = -0.1}), std::invalid_argument);
  EXPECT_THROW(with({.switch_time_spread = 1.1}), std::invalid_argument) << "more than the scan";
  EXPECT_THROW(with({.negligible_probability = 0.5}), std::invalid_argument);
  EXPECT_THROW(Tree({}, kPair, chain, turning()), std::invalid_argument)
      << "three modes, two rates";
  EXPECT_THROW(HistoryTree::pseudo_bayes(0, 3), std::invalid_argument);
  EXPECT_THROW(with(HistoryTree::pseudo_bayes(6, 3)), std::invalid_argument);
  EXPECT_THROW(turning_chain(kTriple, {.straighten_probability = 1.5}), std::invalid_argument);
  EXPECT_THROW(turning_chain(kTriple, {.turn_sojourn_s = 0.0}), std::invalid_argument);
  EXPECT_THROW(with({.max_hypotheses = 3, .max_branches = 3}), std::invalid_argument)
      << "no room for a switch";
  EXPECT_NO_THROW(with({.max_hypotheses = 3, .max_branches = 4}));
  EXPECT_THROW(HistoryTree::pseudo_bayes(2, 0), std::invalid_argument);
}

TEST(TurningChain, LeavesWithTheGivenProbabilities) {
  const TurnHabits habits{
      .straight_sojourn_s = 50.0, .turn_sojourn_s = 20.0, .straighten_probability = 0.8};
  const TurnRateGrid grid = TurnRateGrid::evenly(deg(2.0), 2);
  const double dt = 1e-4;
  const auto p = turning_chain(grid, habits).transition(dt);
  EXPECT_NEAR((1.0 - p(2, 2)) / dt, 1.0 / 50.0, 1e-6);
  EXPECT_NEAR((1.0 - p(0, 0)) / dt, 1.0 / 20.0, 1e-6);
  EXPECT_NEAR(p(2, 0) / dt, 1.0 / 50.0 / 4.0, 1e-6);
  EXPECT_NEAR(p(0, 2) / dt, 0.8 / 20.0, 1e-6);
  EXPECT_NEAR(p(0, 1) / dt, 0.2 / 20.0 / 3.0, 1e-6);
  const auto two = turning_chain(TurnRateGrid{0.0, deg(3.0)}, habits).transition(dt);
  EXPECT_NEAR(two(1, 0) / dt, 1.0 / 20.0, 1e-6) << "nothing else to turn to";
}

}  // namespace
}  // namespace wakeline::mode_history_test
