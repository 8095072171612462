// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A tree with its hypotheses in lanes equals the tree of scalar filters.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/multimodel/mode_history.hpp"
#include "wakeline/multimodel/turning_chain.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline::mode_history_lanes_test {
namespace {

using test::Draw;
using test::matrices_near;

using Lanes = Pack<double, kNativeLanes<double>>;
using Many = ModeHistory<Ekf<CoordinatedTurn, Lanes>>;

const RangeBearing kRadar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
const test::Tolerance kRounding{.absolute = 1e-9, .relative = 1e-10};

/// Both trees over one kind of filter, to be stepped side by side.
template <template <class, class> class Filter, class Motion>
struct PairOver {
  ModeHistory<Filter<Motion, double>> one;
  ModeHistory<Filter<Motion, Lanes>> many;

  explicit PairOver(const HistoryTree& tree, int turns = 4)
      : PairOver(tree, TurnRateGrid::evenly(deg(4.0), turns), {}) {}

  void start() {
    ASSERT_EQ(one.start(test::five_km_off<double>()), Status::kOk);
    ASSERT_EQ(many.start(test::five_km_off<double>()), Status::kOk);
  }

  void expect_equal(int scan) const {
    ASSERT_EQ(many.hypotheses().size(), one.hypotheses().size()) << "scan " << scan;
    EXPECT_TRUE(matrices_near(many.estimate().mean, one.estimate().mean, kRounding)) << scan;
    EXPECT_TRUE(matrices_near(many.estimate().covariance, one.estimate().covariance, kRounding))
        << scan;
    EXPECT_TRUE(matrices_near(many.mode_probability(), one.mode_probability(), kRounding)) << scan;
    const auto expected = by_history(one), actual = by_history(many);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(actual[i].first, expected[i].first) << scan << ", " << i;
      EXPECT_NEAR(actual[i].second, expected[i].second, 1e-10) << scan << ", " << i;
    }
  }

 private:
  /// Last modes and probability of every hypothesis. (Rounding decides which of two similar ones
  /// comes first.)
  template <class Tree>
  static std::vector<std::pair<std::uint64_t, double>> by_history(const Tree& tree) {
    std::vector<std::pair<std::uint64_t, double>> histories;
    for (const auto& hypothesis : tree.hypotheses())
      histories.emplace_back(hypothesis.modes, hypothesis.probability);
    std::sort(histories.begin(), histories.end());
    return histories;
  }

  PairOver(const HistoryTree& tree, const TurnRateGrid& grid, const Motion& motion)
      : one(tree, grid, turning_chain(grid), Filter<Motion, double>(motion)),
        many(tree, grid, turning_chain(grid), Filter<Motion, Lanes>(motion)) {}
};
using Pair = PairOver<Ekf, CoordinatedTurn>;

Vec<double, 2> reading(Draw& draw) {
  return test::plot_of<double>(3000 + 40 * draw.normal(), 4000 + 40 * draw.normal());
}

template <class Trees>
void expect_equal_runs(Trees trees, int scans = 60) {
  trees.start();
  Draw draw(41);
  for (int scan = 0; scan < scans; ++scan) {
    const double dt = draw.uniform(1, 4);
    if (scan % 5 == 4) {
      const Vec<double, 2> push(draw.uniform(-1, 1), draw.uniform(-1, 1));
      ASSERT_EQ(trees.one.predict(dt, push), Status::kOk);
      ASSERT_EQ(trees.many.predict(dt, push), Status::kOk);
    } else {
      ASSERT_EQ(trees.one.predict(dt), Status::kOk);
      ASSERT_EQ(trees.many.predict(dt), Status::kOk);
    }
    trees.expect_equal(scan);
    if (scan % 6 == 5) continue;  // missed
    const Vec<double, 2> z = reading(draw);
    const auto expected = trees.one.update(kRadar, z);
    const auto step = trees.many.update(kRadar, z);
    ASSERT_TRUE(expected && step);
    EXPECT_TRUE(matrices_near(step.innovation, expected.innovation, kRounding));
    EXPECT_TRUE(
        matrices_near(step.innovation_covariance, expected.innovation_covariance, kRounding));
    EXPECT_NEAR(step.nis, expected.nis, 1e-9);
    EXPECT_NEAR(step.log_likelihood, expected.log_likelihood, 1e-9);
    trees.expect_equal(scan);
  }
}

TEST(ModeHistoryInLanes, IsThatOfOneFilterAfterTheOther) { expect_equal_runs(Pair({})); }

TEST(ModeHistoryInLanes, OfEveryFilterAndOfTurnRatesThatAreEstimated) {
  expect_equal_runs(PairOver<SquareRootUkf, CoordinatedTurn>({}));
  expect_equal_runs(PairOver<Ekf, CoordinatedTurnRate>({}));
  expect_equal_runs(PairOver<Ukf, CoordinatedTurnRate>({}));
}

TEST(ModeHistoryInLanes, OfNothingJoinedFillsEveryRow) {
  const HistoryTree whole{.max_hypotheses = 250,
                          .max_branches = 256,
                          .min_segment_s = 0.0,
                          .merge_distance = 0.0,
                          .sibling_distance = 0.0,
                          .negligible_probability = 0.0};
  expect_equal_runs(Pair(whole, 1), 4);
}

TEST(ModeHistoryInLanes, PseudoBayesOfFirstAndSecondOrder) {
  expect_equal_runs(Pair(HistoryTree::pseudo_bayes(1, 9)));
  expect_equal_runs(Pair(HistoryTree::pseudo_bayes(2, 9)));
}

TEST(ModeHistoryInLanes, WeightsReadingsTheSameWay) {
  Pair trees{HistoryTree{}};
  trees.start();
  Draw draw(43);
  for (int scan = 0; scan < 20; ++scan) {
    ASSERT_EQ(trees.one.predict(2.5), Status::kOk);
    ASSERT_EQ(trees.many.predict(2.5), Status::kOk);
    std::array<Alternative<RangeBearing>, 3> readings;
    for (auto& alternative : readings) alternative = {kRadar, reading(draw), 0.3};
    const auto seen = trees.one.evidence(kRadar, readings[0].z);
    const auto evidence = trees.many.evidence(kRadar, readings[0].z);
    EXPECT_NEAR(evidence.likelihood, seen.likelihood, 1e-10 * seen.likelihood);
    EXPECT_NEAR(evidence.least_nis, seen.least_nis, 1e-9);
    std::array<double, 3> share, expected_share;
    const double expected_total = trees.one.update<RangeBearing>(readings, 1e-6, expected_share);
    const double total = trees.many.update<RangeBearing>(readings, 1e-6, share);
    EXPECT_NEAR(total, expected_total, 1e-10 * expected_total);
    for (std::size_t k = 0; k < share.size(); ++k) EXPECT_NEAR(share[k], expected_share[k], 1e-10);
    trees.expect_equal(scan);
  }
}

TEST(ModeHistoryInLanes, AStepThatFailsChangesNothing) {
  Pair trees{HistoryTree{}};
  Many& tree = trees.many;
  EXPECT_EQ(tree.predict(1.0), Status::kNotStarted);
  EXPECT_EQ(tree.update(kRadar, test::plot_of<double>(3000, 4000)).status, Status::kNotStarted);
  trees.start();
  ASSERT_EQ(tree.predict(2.0), Status::kOk);
  const auto before = tree.estimate();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(tree.update(kRadar, {nan, 0.0}).status, Status::kNotFinite);
  EXPECT_EQ(tree.predict(-1.0), Status::kNegativeTimeStep);
  EXPECT_EQ(tree.predict(1e200), Status::kNotFinite);
  std::array<Alternative<RangeBearing>, 1> absurd{{{kRadar, {nan, nan}, 1.0}}};
  std::array<double, 1> share;
  EXPECT_EQ(tree.update<RangeBearing>(absurd, 0.0, share), 0.0);
  EXPECT_TRUE(test::beliefs_identical<4>(tree.estimate(), before));
}

TEST(ModeHistoryInLanes, ContinuesFromItsArchiveWithTheSameBits) {
  Pair trees{HistoryTree{}}, others{HistoryTree{}};
  trees.start();
  Draw draw(44);
  const auto scan = [](Many& tree, const Vec<double, 2>& z) {
    ASSERT_EQ(tree.predict(2.5), Status::kOk);
    ASSERT_TRUE(tree.update(kRadar, z));
  };
  for (int k = 0; k < 8; ++k) scan(trees.many, reading(draw));
  Archive writing;
  trees.many.archive(writing);
  Archive reading_back(writing.bytes());
  others.many.archive(reading_back);
  ASSERT_TRUE(reading_back.ok() && reading_back.at_end());
  for (int k = 0; k < 5; ++k) {
    const Vec<double, 2> z = reading(draw);
    scan(trees.many, z);
    scan(others.many, z);
    EXPECT_TRUE(test::beliefs_identical<4>(others.many.estimate(), trees.many.estimate()));
  }
}

TEST(ModeHistoryInLanes, AnArchiveWithoutAnyProbabilityIsDamaged) {
  Pair trees{HistoryTree{}};
  trees.start();
  Archive writing;
  trees.many.archive(writing);
  const auto before = trees.many.estimate();
  std::vector<std::byte> bytes = writing.bytes();
  for (const auto& hypothesis : trees.many.hypotheses()) {
    const auto wanted = std::as_bytes(std::span(&hypothesis.probability, 1));
    const auto found = std::search(bytes.begin(), bytes.end(), wanted.begin(), wanted.end());
    ASSERT_NE(found, bytes.end());
    std::fill_n(found, sizeof(double), std::byte{0});
  }
  Archive damaged(bytes);
  trees.many.archive(damaged);
  EXPECT_FALSE(damaged.ok());
  EXPECT_TRUE(test::beliefs_identical<4>(trees.many.estimate(), before));
}

TEST(ModeHistoryInLanes, DoesNotTouchTheHeap) {
  Pair trees{HistoryTree{}};
  trees.start();
  const test::NoHeap fence;
  bool good = true;
  for (int scan = 0; scan < 10; ++scan) {
    good = trees.many.predict(2.5) == Status::kOk && good;
    good = static_cast<bool>(trees.many.update(kRadar, test::plot_of<double>(2990, 4010))) && good;
  }
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_TRUE(good);
}

}  // namespace
}  // namespace wakeline::mode_history_lanes_test
