// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/place_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/draw.hpp"

namespace wakeline::place_index_test {
namespace {

struct Place {
  Vec<double, 2> position;
  double variance_m2;
};

PlaceIndex index_of(const std::vector<Place>& places) {
  PlaceIndex index(static_cast<int>(places.size()));
  for (std::size_t k = 0; k < places.size(); ++k)
    index.add(places[k].position, places[k].variance_m2, static_cast<int>(k));
  index.sort();
  return index;
}

double reach_m(double variance_m2) { return 50.0 + 4.0 * std::sqrt(variance_m2); }

std::vector<int> found_near(const PlaceIndex& index, const Vec<double, 2>& position) {
  std::vector<int> names;
  index.for_each_nearest(position, reach_m, PlaneSlices::kMostNear,
                         [&](int name) { names.push_back(name); });
  std::sort(names.begin(), names.end());
  return names;
}

bool within(const Place& place, const Vec<double, 2>& position, double reach) {
  return (place.position - position).cwiseAbs().maxCoeff() <= reach;
}

TEST(PlaceIndex, FindsAllThatReachAndLittleMore) {
  test::Draw draw(9);
  for (const int size : {1, 2, 30, 250, 600}) {
    std::vector<Place> places;
    for (int k = 0; k < size; ++k) {  // standard deviations from 1 m to 100 km
      places.push_back(
          {4000.0 * draw.normals<2>(), std::pow(10.0, draw.uniform(0.0, k % 2 == 0 ? 4.0 : 10.0))});
      if (k % 7 == 3) places[std::size_t(k)].position = places[std::size_t(k) - 1].position;
      if (k == 377) places[std::size_t(k)].position *= 1e9;  // at the end of the world
    }
    places[0].variance_m2 = 0.0;
    const PlaceIndex index = index_of(places);
    for (int k = 0; k < 200; ++k) {
      const Vec<double, 2> position = k % 3 == 0 ? places[std::size_t(k % size)].position
                                                 : Vec<double, 2>(4000.0 * draw.normals<2>());
      const std::vector<int> names = found_near(index, position);
      for (std::size_t i = 0; i < places.size(); ++i) {
        const bool found = std::binary_search(names.begin(), names.end(), static_cast<int>(i));
        const double variance = places[i].variance_m2;
        EXPECT_TRUE(found || !within(places[i], position, reach_m(variance)));
        // Of one layer none has more than 16 times the variance of another, but of the outermost
        // two.
        const bool inner = variance >= 256.0 && variance < 0x1p24;
        EXPECT_TRUE(!found || !inner || within(places[i], position, reach_m(16.0 * variance)));
      }
    }
  }
}

TEST(PlaceIndex, OfFewPlacesNoneLeftOutIsNearer) {
  test::Draw draw(2);
  std::vector<Place> places;
  for (int k = 0; k < 60; ++k) places.push_back({draw.normals<2>(), 1.0});
  const auto apart = [&](int name) {
    return places[static_cast<std::size_t>(name)].position.cwiseAbs().maxCoeff();
  };
  std::vector<int> names;
  index_of(places).for_each_nearest(Vec<double, 2>::Zero(), reach_m, 7,
                                    [&](int name) { names.push_back(name); });
  EXPECT_EQ(names.size(), 7u);
  double farthest = 0.0;
  for (const int name : names) farthest = std::max(farthest, apart(name));
  for (int k = 0; k < 60; ++k)
    EXPECT_TRUE(apart(k) >= farthest || std::find(names.begin(), names.end(), k) != names.end());
}

TEST(PlaceIndex, NothingIsNearWhatIsNoPlace) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const std::size_t size : {2u, 1000u}) {
    const PlaceIndex index = index_of(std::vector<Place>(size, {{1.0, 1.0}, 1.0}));
    EXPECT_TRUE(found_near(index, {kNan, 0.0}).empty());
    EXPECT_TRUE(found_near(index, {0.0, kNan}).empty());
  }
}

TEST(PlaceIndex, IsNotWidenedByAPlaceThatIsKnownBadly) {
  test::Draw draw(10);
  std::vector<Place> places;
  for (int k = 0; k < 1000; ++k) places.push_back({5000.0 * draw.normals<2>(), 100.0});
  const std::vector<int> before = found_near(index_of(places), {0.0, 0.0});
  places.push_back({{2e5, 0.0}, 1e8});
  std::vector<int> after = found_near(index_of(places), {0.0, 0.0});
  EXPECT_LT(before.size(), 20u);
  EXPECT_EQ(after, before);
}

TEST(PlaceIndex, ForgetsWhenCleared) {
  PlaceIndex index = index_of({{{0.0, 0.0}, 1.0}, {{0.0, 0.0}, 1e9}});
  EXPECT_EQ(found_near(index, {0.0, 0.0}).size(), 2u);
  index.clear();
  index.sort();
  EXPECT_TRUE(found_near(index, {0.0, 0.0}).empty());
}

}  // namespace
}  // namespace wakeline::place_index_test
