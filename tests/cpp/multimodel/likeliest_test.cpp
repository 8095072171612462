// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Choosing hypotheses by their probability, beside sorting them all.
#include "wakeline/multimodel/likeliest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/draw.hpp"
#include "wakeline/simd/pack_math.hpp"
#include "wakeline/multimodel/hypothesis_rows.hpp"

namespace wakeline::likeliest_test {
namespace {

using test::Draw;

struct Item {
  double probability;
  int number;
};

/// Probabilities of many sizes, some of them equal and some zero.
std::vector<Item> drawn(Draw& draw, int count) {
  std::vector<Item> items;
  for (int k = 0; k < count; ++k) {
    double probability = std::exp(-draw.uniform(0, 60));
    if (k > 0 && draw.uniform(0, 1) < 0.3)
      probability = items[static_cast<std::size_t>(draw.uniform(0, k))].probability;
    if (draw.uniform(0, 1) < 0.1) probability = 0.0;
    items.push_back({probability, k});
  }
  return items;
}

void stable_sort_by_probability(std::vector<Item>& items) {
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.probability > b.probability; });
}

TEST(Likeliest, AreThoseThatAStableSortPutsFirst) {
  Draw draw(91);
  for (int round = 0; round < 300; ++round) {
    const std::vector<Item> items = drawn(draw, 1 + static_cast<int>(draw.uniform(0, 120)));
    std::array<Item, 64> room;
    const auto most = static_cast<std::size_t>(draw.uniform(1, 65));
    Likeliest<Item> likeliest(std::span<Item>(room).first(most));
    for (const Item& item : items) likeliest.count(item.probability, 1);
    likeliest.cut();
    for (const Item& item : items)
      if (item.probability >= likeliest.least() && item.probability > 0.0) likeliest.add(item);

    std::vector<Item> sorted = items;
    std::erase_if(sorted, [](const Item& item) { return item.probability == 0.0; });
    stable_sort_by_probability(sorted);
    sorted.resize(std::min(sorted.size(), most));
    std::vector<int> expected, actual;
    for (const Item& item : sorted) expected.push_back(item.number);
    for (const Item& item : likeliest.items()) actual.push_back(item.number);
    std::sort(expected.begin(), expected.end());
    std::sort(actual.begin(), actual.end());
    ASSERT_EQ(actual, expected) << "round " << round;
  }
}

template <class Lanes>
void expect_weightiest_first() {
  constexpr int kLanes = kLanesOf<Lanes>;
  Draw draw(92);
  for (int round = 0; round < 100; ++round) {
    const std::vector<Item> items = drawn(draw, 5 * kLanes);
    std::array<Lanes, 5> weights;
    for (std::size_t r = 0; r < weights.size(); ++r)
      weights[r] = lanes_of<Lanes>(
          [&](int k) { return items[r * kLanes + static_cast<std::size_t>(k)].probability; });
    std::array<int, 5 * kLanes> places;
    const int begin = 3;
    const auto count = static_cast<std::size_t>(
        weightiest_first(std::span<const Lanes>(weights), begin, std::span<int>(places)));
    std::vector<Item> sorted = items;
    std::erase_if(sorted, [](const Item& item) { return item.probability == 0.0; });
    stable_sort_by_probability(sorted);
    ASSERT_EQ(count, sorted.size());
    for (std::size_t k = 0; k < count; ++k)
      EXPECT_EQ(places[k], begin * kLanes + sorted[k].number) << "round " << round << ", " << k;
  }
}

TEST(WeightiestFirst, IsAStableSort) {
  expect_weightiest_first<double>();
  expect_weightiest_first<Pack<double, 2>>();
  expect_weightiest_first<Pack<double, kNativeLanes<double>>>();
}

template <class Lanes>
void expect_the_likeliest_copied() {
  using Rows = HypothesisRows<2, Lanes, 40, 3>;
  Draw draw(93);
  for (int round = 0; round < 100; ++round) {
    Rows rows, kept;
    rows.clear();
    std::vector<Item> items;
    for (int mode = 0; mode < 3; ++mode) {
      const int count = static_cast<int>(draw.uniform(0, 13));
      for (int k = 0; k < count; ++k) {
        const double probability = std::exp(-draw.uniform(0, 60));
        const int number = static_cast<int>(items.size());
        items.push_back({probability, number});
        const int place = rows.append(mode);
        const auto lane = static_cast<std::size_t>(Rows::lane_of(place));
        rows.row_of(place).set_belief(
            Rows::lane_of(place), {Vec<double, 2>(number, mode), Mat<double, 2, 2>::Identity()});
        rows.row_of(place).probability[lane] = probability;
        rows.row_of(place).segment_s[lane] = number;
        rows.row_of(place).modes[lane] = static_cast<std::uint64_t>(mode);
      }
    }
    const int most = static_cast<int>(draw.uniform(1, 30));
    copy_likeliest(rows, most, kept);
    stable_sort_by_probability(items);
    items.resize(std::min(items.size(), static_cast<std::size_t>(most)));
    std::sort(items.begin(), items.end(),
              [](const Item& a, const Item& b) { return a.number < b.number; });
    ASSERT_EQ(static_cast<std::size_t>(kept.size()), items.size());
    auto expected = items.begin();
    for (const auto& row : kept.all())
      for (int k = 0; k < row.count; ++k, ++expected) {
        const auto lane = static_cast<std::size_t>(k);
        EXPECT_EQ(row.probability[lane], expected->probability);
        EXPECT_EQ(row.segment_s[lane], expected->number);
        EXPECT_EQ(row.belief(k).mean, (Vec<double, 2>(expected->number, row.mode)));
        EXPECT_EQ(row.belief(k).covariance, (Mat<double, 2, 2>::Identity()));
      }
  }
}

TEST(HypothesisRows, TheLikeliestAreCopiedInTheirOrder) {
  expect_the_likeliest_copied<double>();
  expect_the_likeliest_copied<Pack<double, 2>>();
  expect_the_likeliest_copied<Pack<double, kNativeLanes<double>>>();
}

TEST(HypothesisRows, LanesLeftOverRepeatABelief) {
  using Rows = HypothesisRows<2, Pack<double, 4>, 16, 2>;
  Rows rows;
  rows.clear();
  for (int k = 0; k < 5; ++k) {
    const int place = rows.append(1);
    rows.row_of(place).set_belief(Rows::lane_of(place),
                                  {Vec<double, 2>::Constant(k), Mat<double, 2, 2>::Identity()});
  }
  EXPECT_EQ(rows.size(), 5);
  EXPECT_TRUE(rows.of_mode(0).empty());
  ASSERT_EQ(rows.of_mode(1).size(), 2u);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(rows.of_mode(1)[0].belief(k).mean[0], k);
    EXPECT_EQ(rows.of_mode(1)[1].belief(k).mean[0], 4) << "lane " << k;
    EXPECT_EQ(rows.of_mode(1)[1].probability[static_cast<std::size_t>(k)], 0.0);
  }
}

}  // namespace
}  // namespace wakeline::likeliest_test
