// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/eval/gospa.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include "support/malloc_fence.hpp"

namespace wakeline::gospa_test {
namespace {

using Points = std::vector<Vec<double, 2>>;

SetDistance between(const Points& targets, const Points& tracks, Gospa::Options options = {}) {
  Gospa gospa(options, static_cast<int>(targets.size()), static_cast<int>(tracks.size()));
  return gospa.between<2, double>(targets, tracks);
}

Points draw_points(std::size_t count, double spread_m, std::mt19937_64& random) {
  std::uniform_real_distribution<double> coordinate(0.0, spread_m);
  Points points(count);
  for (auto& point : points) {
    const double north = coordinate(random);
    point = {north, coordinate(random)};
  }
  return points;
}

/// min over all pairings of Σ d^p of the pairs + `unpaired` per point of either set left over.
double exhaustive(const Points& targets, const Points& tracks, double order, double unpaired,
                  std::size_t target, std::vector<bool>& used) {
  if (target == targets.size())
    return unpaired * static_cast<double>(std::count(used.begin(), used.end(), false));
  double best = unpaired + exhaustive(targets, tracks, order, unpaired, target + 1, used);
  for (std::size_t track = 0; track < tracks.size(); ++track) {
    if (used[track]) continue;
    used[track] = true;
    best = std::min(best, std::pow((targets[target] - tracks[track]).norm(), order) +
                              exhaustive(targets, tracks, order, unpaired, target + 1, used));
    used[track] = false;
  }
  return best;
}

/// OSPA as it is defined: the best full pairing of the smaller set, distances cut at c, c for the
/// rest.
double exhaustive_ospa(const Points& targets, const Points& tracks, const Gospa::Options& options) {
  const Points& fewer = targets.size() < tracks.size() ? targets : tracks;
  const Points& more = targets.size() < tracks.size() ? tracks : targets;
  if (more.empty()) return 0.0;
  std::vector<std::size_t> order(more.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  double best = 1e300;
  do {
    double sum = 0.0;
    for (std::size_t k = 0; k < more.size(); ++k) {
      const double distance = k < fewer.size() ? (fewer[k] - more[order[k]]).norm() : 1e300;
      sum += std::pow(std::min(distance, options.cutoff_m), options.order);
    }
    best = std::min(best, sum);
  } while (std::next_permutation(order.begin(), order.end()));
  return std::pow(best / static_cast<double>(more.size()), 1.0 / options.order);
}

TEST(Gospa, AgreesWithExhaustiveSearch) {
  std::mt19937_64 random(41);
  std::uniform_int_distribution<std::size_t> size(0, 5);
  for (int trial = 0; trial < 600; ++trial) {
    const Gospa::Options options{.cutoff_m = 20.0 + trial % 50, .order = 1.0 + trial % 3};
    const Points targets = draw_points(size(random), 100.0, random);
    const Points tracks = draw_points(size(random), 100.0, random);
    const auto result = between(targets, tracks, options);
    const double half = 0.5 * std::pow(options.cutoff_m, options.order);
    std::vector<bool> used(tracks.size());
    const double expected = exhaustive(targets, tracks, options.order, half, 0, used);
    EXPECT_NEAR(std::pow(result.gospa_m, options.order), expected, 1e-9 * (1.0 + expected));
    EXPECT_NEAR(result.localisation + result.missed + result.false_tracks, expected,
                1e-9 * (1.0 + expected));
    EXPECT_NEAR(result.ospa_m, exhaustive_ospa(targets, tracks, options), 1e-9);
  }
}

TEST(Gospa, IsAMetric) {
  std::mt19937_64 random(42);
  std::uniform_int_distribution<std::size_t> size(0, 6);
  for (int trial = 0; trial < 2000; ++trial) {
    const Gospa::Options options{.cutoff_m = 40.0, .order = 1.0 + trial % 2};
    const Points a = draw_points(size(random), 100.0, random);
    const Points b = draw_points(size(random), 100.0, random);
    const Points c = draw_points(size(random), 100.0, random);
    const auto ab = between(a, b, options);
    const auto ba = between(b, a, options);
    const auto bc = between(b, c, options);
    const auto ac = between(a, c, options);
    EXPECT_EQ(between(a, a, options).gospa_m, 0.0);
    EXPECT_EQ(between(a, a, options).ospa_m, 0.0);
    EXPECT_NEAR(ab.gospa_m, ba.gospa_m, 1e-9);
    EXPECT_NEAR(ab.ospa_m, ba.ospa_m, 1e-9);
    EXPECT_EQ(ab.missed, ba.false_tracks);
    EXPECT_LE(ac.gospa_m, ab.gospa_m + bc.gospa_m + 1e-9);
    EXPECT_LE(ac.ospa_m, ab.ospa_m + bc.ospa_m + 1e-9);
    EXPECT_LE(ab.ospa_m, options.cutoff_m + 1e-9);
  }
}

TEST(Gospa, DecomposesIntoItsThreeParts) {
  const Points targets = {{0.0, 0.0}, {1000.0, 0.0}};
  const Points tracks = {{3.0, 4.0}, {0.0, 500.0}, {0.0, 900.0}};
  const auto result = between(targets, tracks, {.cutoff_m = 10.0, .order = 2.0});
  EXPECT_EQ(result.pairs, 1);
  EXPECT_DOUBLE_EQ(result.localisation, 25.0);
  EXPECT_DOUBLE_EQ(result.missed, 50.0);
  EXPECT_DOUBLE_EQ(result.false_tracks, 100.0);
  EXPECT_DOUBLE_EQ(result.gospa_m, std::sqrt(175.0));
  EXPECT_DOUBLE_EQ(result.ospa_m, std::sqrt(225.0 / 3.0));
}

TEST(Gospa, KeepsTheLocalisationOfTinyErrorsBesideManyMisses) {
  Points targets = {{0.0, 0.0}};
  for (int k = 1; k < 40; ++k) targets.push_back({1e6 * k, 0.0});
  const auto result = between(targets, {{1e-6, 0.0}}, {.cutoff_m = 1e4, .order = 2.0});
  EXPECT_NEAR(result.localisation / 1e-12, 1.0, 1e-12);
}

TEST(Gospa, TreatsEmptySets) {
  EXPECT_EQ(between({}, {}).gospa_m, 0.0);
  EXPECT_EQ(between({}, {}).ospa_m, 0.0);
  const auto missed = between({{1.0, 2.0}}, {}, {.cutoff_m = 8.0, .order = 2.0});
  EXPECT_DOUBLE_EQ(missed.gospa_m, std::sqrt(32.0));
  EXPECT_DOUBLE_EQ(missed.ospa_m, 8.0);
  EXPECT_EQ(missed.false_tracks, 0.0);
}

TEST(Gospa, PairsNothingAtTheCutoffNorWithoutADistance) {
  const Points origin = {{0.0, 0.0}};
  EXPECT_EQ(between(origin, {{0.0, 50.0}}).pairs, 0);
  EXPECT_EQ(between(origin, {{0.0, 49.999}}).pairs, 1);
  EXPECT_EQ(between(origin, {{0.0, std::nan("")}}).pairs, 0);
  EXPECT_DOUBLE_EQ(between(origin, {{0.0, 50.0}}).gospa_m, 50.0);
}

TEST(Gospa, PointsAndDistancesAgree) {
  std::mt19937_64 random(43);
  const Points targets = draw_points(7, 150.0, random);
  const Points tracks = draw_points(9, 150.0, random);
  Eigen::MatrixXd distance(7, 9);
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 9; ++j)
      distance(i, j) =
          (targets[static_cast<std::size_t>(i)] - tracks[static_cast<std::size_t>(j)]).norm();
  Gospa gospa({}, 7, 9);
  EXPECT_EQ(gospa.between(distance).gospa_m, between(targets, tracks).gospa_m);
  EXPECT_EQ(gospa.assignment().column_of_row().size(), 7u);

  std::vector<Gospa::Pair> pairs;
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 9; ++j)
      if (distance(i, j) < 50.0) pairs.push_back({i, j, distance(i, j)});
  const int count = static_cast<int>(pairs.size());
  const auto sparse = Gospa({}, 7, 9, count).between(7, 9, pairs);
  EXPECT_EQ(sparse.gospa_m, gospa.between(distance).gospa_m);
  EXPECT_EQ(sparse.ospa_m, gospa.between(distance).ospa_m);
  EXPECT_TRUE(std::isnan(Gospa({}, 7, 9, count - 1).between(7, 9, pairs).gospa_m));
}

TEST(Gospa, AUsedWorkspaceNeedsNoHeapAndRejectsLargerSets) {
  std::mt19937_64 random(44);
  const Points points = draw_points(12, 100.0, random);
  Gospa gospa({}, 11, 12);
  test::NoHeap fence;
  const auto result = gospa.between<2, double>(std::span(points).first(11), points);
  const auto too_many = gospa.between<2, double>(points, points);
  const long allocations = fence.allocations();
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(result.pairs, 11);
  EXPECT_TRUE(std::isnan(too_many.gospa_m));
}

TEST(Gospa, RejectsSettingsWithoutAMeaning) {
  EXPECT_THROW(Gospa({.cutoff_m = 0.0, .order = 2.0}, 1, 1), std::invalid_argument);
  EXPECT_THROW(Gospa({.cutoff_m = 5.0, .order = 0.5}, 1, 1), std::invalid_argument);
  EXPECT_THROW(Gospa({.cutoff_m = 50.0, .order = 200.0}, 1, 1), std::invalid_argument);
  EXPECT_THROW(Gospa({.cutoff_m = 0.3, .order = 1000.0}, 1, 1), std::invalid_argument);
  EXPECT_THROW(Gospa({}, -1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::gospa_test
