// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Laws of the estimators whose turn models change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <random>
#include <span>

#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"
#include "support/rejection.hpp"
#include "wakeline/multimodel/adaptive_grid_imm.hpp"
#include "wakeline/multimodel/likely_model_set_imm.hpp"
#include "wakeline/multimodel/switching_grid_imm.hpp"

namespace wakeline::turn_grids_test {
namespace {

using test::matrices_identical;
using test::matrices_near;
using test::rejection_of;

using Filter = Ekf<CoordinatedTurn>;
using Rates = ModeVector<double, kRuntimeModes>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const RangeBearing kRadar{.range_std_m = 20, .bearing_std_rad = deg(0.3)};
const auto kThree = ModeChain<3>::staying(0.9);
const auto kFive = ModeChain<kRuntimeModes>::staying(0.9, 5);

Filter turn(double rate_rad_s = 0.0) {
  return Filter{
      CoordinatedTurn{.turn_rate_rad_s = rate_rad_s, .noise = PiecewiseAcceleration{0.02}}};
}

AdaptiveGridImm<UniformBank<Filter, 3>> adaptive(const AdaptiveGrid& grid = {}) {
  return {grid, kThree, turn()};
}
SwitchingGridImm<UniformBank<Filter, 3>> switching(const SwitchingGrid& grid = {}) {
  return {grid, kThree, turn()};
}
LikelyModelSetImm<UniformBank<Filter>> likely(const LikelyModelSet& set = {}) {
  return {set, kFive, turn()};
}

/// Plots of a vessel that goes straight, turns to starboard, and hard to port; `side` -1 mirrors
/// it.
std::vector<Vec<double, 2>> plots(double side = 1.0) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  Vec<double, 2> at(3000, side * 200);
  double course = 0.3;
  std::vector<Vec<double, 2>> z;
  for (int k = 0; k < 120; ++k) {
    course += deg(k < 30 ? 0.0 : k < 70 ? 2.0 : -3.5) * 3.0;
    at += 3.0 * 9.0 * Vec<double, 2>(std::cos(course), side * std::sin(course));
    z.push_back(RangeBearing{}.measure(at) +
                Vec<double, 2>(20 * normal(random), side * deg(0.3) * normal(random)));
  }
  return z;
}

Gaussian<4> beginning(double side = 1.0) {
  Gaussian<4> belief{{3000, 9 * std::cos(0.3), side * 200, side * 9 * std::sin(0.3)},
                     Mat<double, 4, 4>::Zero()};
  belief.covariance.diagonal() << 400, 4, 400, 4;
  return belief;
}

template <class A, class B>
testing::AssertionResult same_bits(const A& a, const B& b) {
  if (const auto same = matrices_identical(a.estimate().mean, b.estimate().mean); !same)
    return same;
  if (const auto same = matrices_identical(a.estimate().covariance, b.estimate().covariance); !same)
    return same;
  for (Eigen::Index k = 0; k < a.mode_probability().size(); ++k)
    if (a.mode_probability()[k] != b.mode_probability()[k])
      return testing::AssertionFailure() << "mode " << k;
  return testing::AssertionSuccess();
}

/// Both through the same readings: the same bits.
template <class A, class B>
void expect_equal(A a, B b) {
  ASSERT_EQ(a.start(beginning()), Status::kOk);
  ASSERT_EQ(b.start(beginning()), Status::kOk);
  for (const auto& z : plots()) {
    ASSERT_EQ(a.predict(3.0), b.predict(3.0));
    ASSERT_EQ(a.update(kRadar, z).log_likelihood, b.update(kRadar, z).log_likelihood);
    ASSERT_TRUE(same_bits(a, b));
  }
}

template <class Estimator>
void run(Estimator& estimator, std::span<const Vec<double, 2>> readings) {
  for (const auto& z : readings) {
    ASSERT_EQ(estimator.predict(3.0), Status::kOk);
    ASSERT_TRUE(estimator.update(kRadar, z));
  }
}

Imm<UniformBank<Filter>> fixed(std::initializer_list<double> rates_rad_s, double straight) {
  std::vector<Filter> filters;
  for (const double rate : rates_rad_s) filters.push_back(turn(rate));
  const auto modes = static_cast<Eigen::Index>(filters.size());
  Imm<UniformBank<Filter>> imm(ModeChain<kRuntimeModes>::staying(0.9, modes),
                               UniformBank<Filter>(std::span<const Filter>(filters)));
  Rates initial = Rates::Constant(modes, (1.0 - straight) / double(modes - 1));
  initial[modes / 2] = straight;
  imm.set_initial_mode_probability(initial);
  return imm;
}

// What they are where nothing moves ---------------------------------------------------------------

TEST(AdaptiveGrid, ThatDoesNotMoveIsAnImm) {
  const AdaptiveGrid grid{.max_turn_rate_rad_s = deg(2.0),
                          .initial_turn_rates_rad_s = AdaptiveGrid::Rates{-deg(2.0), 0, deg(2.0)},
                          .kept_spacing_rad_s = deg(2.0),
                          .least_move_rad_s = 0.0,
                          .centre_threshold = 0.0};
  expect_equal(adaptive(grid), fixed({-deg(2.0), 0, deg(2.0)}, 0.9));
}

TEST(SwitchingGrid, OfThreeRatesIsAnImm) {
  for (const auto carry : {SwitchCarry::kSlot, SwitchCarry::kIdentity})
    for (const auto rule : {SwitchRule::kSymmetric, SwitchRule::kLiteral})
      expect_equal(
          switching({.grid_rad_s = {-deg(2.0), 0, deg(2.0)}, .rule = rule, .carry = carry}),
          fixed({-deg(2.0), 0, deg(2.0)}, 0.9));
}

TEST(LikelyModelSet, WithoutThresholdsIsAnImm) {
  const double step = deg(4.0) / 2;
  expect_equal(likely({.unlikely_threshold = 0.0, .likely_threshold = 0.0}),
               fixed({-deg(4.0), -step, 0, step, deg(4.0)}, 0.9));
}

// What they do ------------------------------------------------------------------------------------

TEST(AdaptiveGrid, FollowsTheTurn) {
  auto estimator = adaptive();
  ASSERT_EQ(estimator.start(beginning()), Status::kOk);
  const auto z = plots();
  run(estimator, std::span(z).first(65));
  EXPECT_GT(estimator.turn_rates_rad_s()[1], deg(0.7));
  run(estimator, std::span(z).subspan(65));
  EXPECT_LT(estimator.turn_rates_rad_s()[1], -deg(1.5));
}

TEST(AdaptiveGrid, KeepsItsSpacingInsideTheMaximum) {
  auto estimator = adaptive();
  ASSERT_EQ(estimator.start(beginning()), Status::kOk);
  for (const auto& z : plots()) {
    run(estimator, {&z, 1});
    const auto& w = estimator.turn_rates_rad_s();
    for (int side = 0; side < 2; ++side)
      EXPECT_GE(w[side + 1] - w[side], std::min(deg(2.5), deg(5.0) - std::abs(w[1])) - 1e-12);
    EXPECT_LE(w.cwiseAbs().maxCoeff(), deg(5.0));
  }
}

TEST(SwitchingGrid, FollowsTheTurn) {
  for (const auto carry : {SwitchCarry::kSlot, SwitchCarry::kIdentity}) {
    auto estimator = switching({.grid_rad_s = TurnRateGrid::evenly(deg(4.0), 4), .carry = carry});
    ASSERT_EQ(estimator.start(beginning()), Status::kOk);
    const auto z = plots();
    run(estimator, std::span(z).first(65));
    EXPECT_GT(estimator.centre(), 4);
    run(estimator, std::span(z).subspan(65));
    EXPECT_LT(estimator.centre(), 4);
    EXPECT_EQ(estimator.turn_rates_rad_s()[1], deg(4.0) * (estimator.centre() - 4) / 4);
  }
}

TEST(LikelyModelSet, RestsTheUnlikely) {
  auto estimator = likely({.unlikely_threshold = 0.1, .likely_threshold = 0.3});
  ASSERT_EQ(estimator.start(beginning()), Status::kOk);
  int resting = 0;
  bool to_starboard = false, to_port = false;
  for (const auto& z : plots()) {
    run(estimator, {&z, 1});
    const Rates& w = estimator.turn_rates_rad_s();
    const auto& mu = estimator.mode_probability();
    EXPECT_NEAR(mu.sum(), 1.0, 1e-12);
    for (int k = 0; k < 5; ++k) {
      resting += std::isnan(w[k]);
      EXPECT_EQ(std::isnan(w[k]), !estimator.bank().active(k));
      if (std::isnan(w[k]))
        EXPECT_EQ(mu[k], 0.0);
      else
        EXPECT_EQ(w[k], deg(4.0) * (k - 2) / 2);
    }
    to_starboard = to_starboard || mu[3] > 0.5;
    to_port = to_port || mu[0] > 0.5;
  }
  EXPECT_GT(resting, 100);
  EXPECT_TRUE(to_starboard && to_port);
}

template <class A, class B>
void expect_same_filters(const A& a, const B& b) {
  for (int k = 0; k < 5; ++k) {
    const auto& x = a.bank().filter(k).estimate();
    const auto& y = b.bank().filter(k).estimate();
    EXPECT_TRUE(matrices_identical(x.mean, y.mean)) << "model " << k;
    EXPECT_TRUE(matrices_identical(x.covariance, y.covariance)) << "model " << k;
  }
}

TEST(LikelyModelSet, KeepsWhatModelsWentToRestWith) {
  auto estimator = likely({.unlikely_threshold = 0.1, .likely_threshold = 0.3});
  ASSERT_EQ(estimator.start(beginning()), Status::kOk);
  int joined = 0;
  for (const auto& z : plots()) {
    const auto before = estimator;
    EXPECT_EQ(estimator.predict(3.0, {kNan, 0.0}), Status::kNotFinite);
    expect_same_filters(estimator, before);

    Archive saved;
    estimator.archive(saved);
    auto restored = likely({.unlikely_threshold = 0.1, .likely_threshold = 0.3});
    Archive loading(saved.bytes());
    restored.archive(loading);
    expect_same_filters(restored, estimator);

    run(estimator, {&z, 1});
    for (int k = 0; k < 5; ++k)
      joined += std::isnan(before.turn_rates_rad_s()[k]) && estimator.bank().active(k);
  }
  EXPECT_GT(joined, 3);
}

TEST(LikelyModelSet, KeepsTheMostProbableAndItsNeighbours) {
  const LikelyModelSet set{.unlikely_threshold = 0.5, .likely_threshold = 1.0};
  const Rates all = set.grid_rad_s.rates_rad_s();
  const Rates next = set.chosen(all, Vec<double, 5>(0.1, 0.1, 0.2, 0.4, 0.2));
  EXPECT_TRUE(std::isnan(next[0]) && std::isnan(next[1]));
  for (int k = 2; k < 5; ++k) EXPECT_EQ(next[k], all[k]);
  const Rates back = set.chosen(next, Vec<double, 5>(0, 0, 0.6, 0.4, 0));
  EXPECT_TRUE(std::isnan(back[0]) && std::isnan(back[4]));
  for (int k = 1; k < 4; ++k) EXPECT_EQ(back[k], all[k]);
}

// Laws of all -------------------------------------------------------------------------------------

template <class Build>
class TurnGrids : public testing::Test {};

struct Adaptive {
  static auto build() { return adaptive(); }
};
struct LiteralAdaptive {
  static auto build() {
    return adaptive({.kept_spacing_rad_s = 0,
                     .least_move_rad_s = 0,
                     .centre_threshold = 0.3,
                     .centre_gain = 1});
  }
};
struct SwitchingBySlot {
  static auto build() { return switching({.threshold = 0.4, .carry = SwitchCarry::kSlot}); }
};
struct Switching {
  static auto build() { return switching(); }
};
struct Likely {
  static auto build() { return likely({.unlikely_threshold = 0.1, .likely_threshold = 0.3}); }
};
using All = testing::Types<Adaptive, LiteralAdaptive, SwitchingBySlot, Switching, Likely>;
TYPED_TEST_SUITE(TurnGrids, All);

TYPED_TEST(TurnGrids, BeforeAStartTheModesAreThoseThatItBeginsWith) {
  auto estimator = TypeParam::build();
  const Rates before = estimator.mode_probability();
  EXPECT_TRUE(matrices_identical(before, Rates(estimator.initial_mode_probability())));
  EXPECT_EQ(before[before.size() / 2], 0.9);
  ASSERT_EQ(estimator.start(beginning()), Status::kOk);
  EXPECT_TRUE(matrices_identical(before, Rates(estimator.mode_probability())));
}

TYPED_TEST(TurnGrids, MirroredReadingsGiveMirroredEstimates) {
  auto there = TypeParam::build();
  auto mirror = TypeParam::build();
  ASSERT_EQ(there.start(beginning()), Status::kOk);
  ASSERT_EQ(mirror.start(beginning(-1)), Status::kOk);
  const auto z = plots(), mirrored = plots(-1);
  for (std::size_t k = 0; k < z.size(); ++k) {
    run(there, {&z[k], 1});
    run(mirror, {&mirrored[k], 1});
    const Vec<double, 4> wanted = Vec<double, 4>(1, 1, -1, -1).cwiseProduct(there.estimate().mean);
    ASSERT_TRUE(matrices_near(mirror.estimate().mean, wanted, {.absolute = 1e-6})) << "scan " << k;
    ASSERT_TRUE(matrices_near(mirror.mode_probability(), there.mode_probability().reverse(),
                              {.absolute = 1e-8}));
    ASSERT_TRUE(matrices_near(mirror.turn_rates_rad_s(), -there.turn_rates_rad_s().reverse(),
                              {.absolute = 1e-9}));
  }
}

TYPED_TEST(TurnGrids, MissedScansRelaxTheModesAndLeaveTheRates) {
  auto estimator = TypeParam::build();
  ASSERT_EQ(estimator.start(beginning()), Status::kOk);
  const auto z = plots();
  run(estimator, std::span(z).first(45));
  ASSERT_EQ(estimator.predict(3.0), Status::kOk);
  const Rates rates = estimator.turn_rates_rad_s();
  Rates wanted = estimator.mode_probability();
  const double active = double(rates.size() - rates.array().isNaN().count());
  for (int k = 0; k < 10; ++k) {
    ASSERT_EQ(estimator.predict(3.0), Status::kOk);
    ASSERT_TRUE(matrices_identical(Rates(estimator.turn_rates_rad_s()), rates));
    for (Eigen::Index m = 0; m < wanted.size(); ++m)
      if (!std::isnan(rates[m])) wanted[m] = 0.9 * wanted[m] + 0.1 / (active - 1) * (1 - wanted[m]);
    ASSERT_TRUE(matrices_near(estimator.mode_probability(), wanted, {.absolute = 1e-12}));
  }
}

TYPED_TEST(TurnGrids, AStepThatFailsLeavesEverything) {
  auto estimator = TypeParam::build();
  EXPECT_EQ(estimator.predict(1.0), Status::kNotStarted);
  EXPECT_EQ(estimator.update(kRadar, {1000, 0}).status, Status::kNotStarted);
  ASSERT_EQ(estimator.start(beginning()), Status::kOk);
  for (const auto& z : plots()) {
    run(estimator, {&z, 1});
    const auto before = estimator;
    EXPECT_NE(estimator.predict(-1.0), Status::kOk);
    EXPECT_NE(estimator.predict(kNan), Status::kOk);
    EXPECT_NE(estimator.predict(1e300), Status::kOk);  // moves the grid, then fails
    EXPECT_NE(estimator.predict(3.0, {kNan, 0.0}), Status::kOk);
    EXPECT_FALSE(estimator.update(kRadar, {kNan, 1.0}));
    EXPECT_NE(
        estimator.start(Gaussian<4>{Vec<double, 4>::Constant(kNan), before.estimate().covariance}),
        Status::kOk);
    ASSERT_TRUE(same_bits(estimator, before));
    ASSERT_TRUE(
        matrices_identical(Rates(estimator.turn_rates_rad_s()), Rates(before.turn_rates_rad_s())));
  }
  auto untouched = TypeParam::build();
  ASSERT_EQ(untouched.start(beginning()), Status::kOk);
  const auto z = plots();
  run(untouched, z);
  EXPECT_TRUE(same_bits(estimator, untouched));
}

TYPED_TEST(TurnGrids, AnArchiveContinuesWithTheSameBits) {
  auto estimator = TypeParam::build();
  ASSERT_EQ(estimator.start(beginning()), Status::kOk);
  const auto z = plots();
  for (std::size_t k = 0; k < z.size(); ++k) {
    run(estimator, {&z[k], 1});
    if (k % 20 != 5) continue;
    Archive saved;
    estimator.archive(saved);
    auto restored = TypeParam::build();
    Archive loading(saved.bytes());
    restored.archive(loading);
    ASSERT_TRUE(loading.ok() && loading.at_end());
    ASSERT_TRUE(matrices_identical(Rates(restored.turn_rates_rad_s()),
                                   Rates(estimator.turn_rates_rad_s())));
    auto on = estimator;
    run(on, std::span(z).subspan(k + 1));
    run(restored, std::span(z).subspan(k + 1));
    ASSERT_TRUE(same_bits(restored, on)) << "scan " << k;

    auto bytes = saved.bytes();
    const Rates rates = estimator.turn_rates_rad_s();
    const auto of_rates = std::as_bytes(std::span(rates.data(), std::size_t(rates.size())));
    const auto place = std::search(bytes.begin(), bytes.end(), of_rates.begin(), of_rates.end());
    ASSERT_NE(place, bytes.end());
    std::fill_n(place, of_rates.size(), std::byte{0x7f});  // no turn rates
    Archive spoilt(bytes);
    auto rejected = TypeParam::build();
    rejected.archive(spoilt);
    EXPECT_FALSE(spoilt.ok());
  }
}

TEST(TurnGrid, AnArchiveIsOfItsRules) {
  const auto expect_rejected = [](auto estimator, auto... others) {
    ASSERT_EQ(estimator.start(beginning()), Status::kOk);
    Archive saved;
    estimator.archive(saved);
    const auto restores = [&](auto other) {
      Archive loading(saved.bytes());
      other.archive(loading);
      return loading.ok() && loading.at_end();
    };
    EXPECT_TRUE(restores(estimator));
    EXPECT_FALSE((restores(others) || ...));
  };
  expect_rejected(adaptive(), adaptive({.max_turn_rate_rad_s = deg(5.5)}),
                  adaptive({.min_spacing_rad_s = deg(2.1)}),
                  adaptive({.kept_spacing_rad_s = deg(3.1)}), adaptive({.least_move_rad_s = 0.0}),
                  adaptive({.centre_threshold = 0.7}), adaptive({.centre_gain = 0.4}),
                  adaptive({.unlikely_threshold = 0.2}), adaptive({.likely_threshold = 0.8}));
  expect_rejected(
      switching(), switching({.threshold = 0.7}), switching({.rule = SwitchRule::kLiteral}),
      switching({.carry = SwitchCarry::kSlot}),
      switching({.grid_rad_s = TurnRateGrid::evenly(deg(5.0), 3), .initial_centre = 2}));
  expect_rejected(likely(), likely({.unlikely_threshold = 0.04}), likely({.likely_threshold = 0.2}),
                  likely({.grid_rad_s = TurnRateGrid::evenly(deg(4.1), 2)}));
}

TYPED_TEST(TurnGrids, AStartForgets) {
  auto estimator = TypeParam::build();
  const auto z = plots();
  ASSERT_EQ(estimator.start(beginning()), Status::kOk);
  run(estimator, z);
  ASSERT_EQ(estimator.start(beginning()), Status::kOk);
  run(estimator, z);
  auto fresh = TypeParam::build();
  ASSERT_EQ(fresh.start(beginning()), Status::kOk);
  run(fresh, z);
  EXPECT_TRUE(same_bits(estimator, fresh));
}

TYPED_TEST(TurnGrids, TouchNoHeap) {
  auto estimator = TypeParam::build();
  const auto z = plots();
  const test::NoHeap fence;
  bool good = estimator.start(beginning()) == Status::kOk;
  for (const auto& reading : z) {
    good = estimator.predict(3.0) == Status::kOk && good;
    good = estimator.update(kRadar, reading) && good;
    good = estimator.estimate().mean.allFinite() && good;
  }
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_TRUE(good);
}

TYPED_TEST(TurnGrids, OneReadingAmongSeveralIsThatReading) {
  auto one = TypeParam::build();
  auto several = TypeParam::build();
  ASSERT_EQ(one.start(beginning()), Status::kOk);
  ASSERT_EQ(several.start(beginning()), Status::kOk);
  for (const auto& z : plots()) {
    run(one, {&z, 1});
    ASSERT_EQ(several.predict(3.0), Status::kOk);
    const Alternative<RangeBearing> reading{kRadar, z, 1.0};
    double share = 0;
    ASSERT_GT(several.update(std::span(&reading, 1), 0.0, std::span(&share, 1)), 0.0);
    EXPECT_NEAR(share, 1.0, 1e-12);
    ASSERT_TRUE(matrices_near(several.estimate().mean, one.estimate().mean, {.absolute = 1e-6}));
    ASSERT_TRUE(matrices_near(Rates(several.turn_rates_rad_s()), Rates(one.turn_rates_rad_s()),
                              {.absolute = 1e-9}));
  }
}

// A known acceleration ----------------------------------------------------------------------------

TYPED_TEST(TurnGrids, AKnownAccelerationPushesEveryModel) {
  auto pushed = TypeParam::build();
  auto free = TypeParam::build();
  ASSERT_EQ(pushed.start(beginning()), Status::kOk);
  ASSERT_EQ(free.start(beginning()), Status::kOk);
  ASSERT_EQ(pushed.predict(3.0, {0.2, -0.1}), Status::kOk);
  ASSERT_EQ(free.predict(3.0), Status::kOk);
  EXPECT_TRUE(
      matrices_near(pushed.estimate().mean,
                    Vec<double, 4>(free.estimate().mean + Vec<double, 4>(0.9, 0.6, -0.45, -0.3)),
                    {.absolute = 1e-9}));
  EXPECT_TRUE(
      matrices_near(pushed.estimate().covariance, free.estimate().covariance, {.absolute = 1e-6}));
}

// Invalid input -----------------------------------------------------------------------------------

TEST(TurnGrid, RejectsInvalidGrids) {
  EXPECT_THROW(TurnRateGrid({0.1, 0.0}), std::invalid_argument);
  EXPECT_THROW(TurnRateGrid({0.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(TurnRateGrid({0.0}), std::invalid_argument);
  EXPECT_THROW(TurnRateGrid({0.0, kNan}), std::invalid_argument);
  std::vector<double> forty(40);
  for (std::size_t k = 0; k < forty.size(); ++k) forty[k] = 0.001 * double(k);
  EXPECT_THROW(TurnRateGrid(std::span<const double>(forty)), std::invalid_argument);
  EXPECT_THROW(TurnRateGrid::evenly(0.0, 2), std::invalid_argument);
  EXPECT_THROW(TurnRateGrid::evenly(1.0, 8), std::invalid_argument);
  EXPECT_THROW(TurnRateGrid::evenly(1.0, std::numeric_limits<int>::max()), std::invalid_argument);
}

TEST(TurnGrid, ReportsWhatWasExpectedAndWhatCame) {
  EXPECT_EQ(rejection_of([] { return TurnRateGrid({0.0}); }),
            "grid_rad_s must have 2 to 16 turn rates, got 1");
  EXPECT_EQ(rejection_of([] {
              return switching({.grid_rad_s = {0.0, 0.1}});
            }),
            "grid_rad_s must have 3 to 16 turn rates, got 2");
  EXPECT_EQ(
      rejection_of([] {
        return adaptive({.max_turn_rate_rad_s = 0.10000001,
                         .initial_turn_rates_rad_s = AdaptiveGrid::Rates{-0.10000002, 0.0, 0.1}});
      }),
      "every rate of initial_turn_rates_rad_s must be within max_turn_rate_rad_s, "
      "0.10000001 to either side, got -0.10000002");
  EXPECT_EQ(rejection_of([] {
              return LikelyModelSetImm<UniformBank<Filter>>(
                  {}, ModeChain<kRuntimeModes>::staying(0.9, 3), turn());
            }),
            "chain must have 5 modes, one for each model, got 3");
}

TEST(AdaptiveGrid, RejectsInvalidParameters) {
  using Three = AdaptiveGrid::Rates;
  EXPECT_THROW(adaptive({.max_turn_rate_rad_s = 0}), std::invalid_argument);
  EXPECT_THROW(adaptive({.initial_turn_rates_rad_s = Three{-deg(6.0), 0, deg(1.0)}}),
               std::invalid_argument);
  EXPECT_THROW(adaptive({.initial_turn_rates_rad_s = Three{deg(1.0), 0, -deg(1.0)}}),
               std::invalid_argument);
  EXPECT_THROW(adaptive({.min_spacing_rad_s = 0}), std::invalid_argument);
  EXPECT_THROW(adaptive({.kept_spacing_rad_s = -0.1}), std::invalid_argument);
  EXPECT_THROW(adaptive({.centre_threshold = 1.1}), std::invalid_argument);
  EXPECT_THROW(adaptive({.centre_gain = kNan}), std::invalid_argument);
  EXPECT_THROW(adaptive({.unlikely_threshold = 0.8, .likely_threshold = 0.2}),
               std::invalid_argument);
  EXPECT_THROW(
      (AdaptiveGridImm<UniformBank<Filter>>(AdaptiveGrid{}, kFive, UniformBank<Filter>(turn(), 5))),
      std::invalid_argument);
}

TEST(SwitchingGrid, RejectsInvalidParameters) {
  EXPECT_THROW(switching({.grid_rad_s = {0.0, 0.1}}), std::invalid_argument);
  EXPECT_THROW(switching({.threshold = -0.1}), std::invalid_argument);
  EXPECT_THROW(switching({.initial_centre = 0}), std::invalid_argument);
  EXPECT_THROW(switching({.initial_centre = 4}), std::invalid_argument);
}

TEST(LikelyModelSet, RejectsInvalidParameters) {
  EXPECT_THROW(likely({.unlikely_threshold = 0.4, .likely_threshold = 0.3}), std::invalid_argument);
  EXPECT_THROW(likely({.likely_threshold = 1.5}), std::invalid_argument);
  EXPECT_THROW(likely({.initial_straight_probability = kNan}), std::invalid_argument);
  EXPECT_THROW(likely({.grid_rad_s = {0.0, 0.1}}), std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::turn_grids_test
