// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/plane_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace wakeline::plane_index_test {
namespace {

using Place = Vec<double, 2>;

std::vector<int> found_nearest(const PlaneIndex& index, const Place& place, double reach_m,
                               int most = std::numeric_limits<int>::max()) {
  std::vector<int> names;
  index.for_each_nearest(place, reach_m, most, [&](int name) { names.push_back(name); });
  return names;
}

/// Looks at every point.
std::vector<int> near(const std::vector<Place>& points, const Place& place, double reach_m) {
  std::vector<int> names;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const bool inside = points[k][0] >= place[0] - reach_m && points[k][0] <= place[0] + reach_m &&
                        points[k][1] >= place[1] - reach_m && points[k][1] <= place[1] + reach_m;
    if (inside) names.push_back(static_cast<int>(k));
  }
  return names;
}

PlaneIndex index_of_points(const std::vector<Place>& points) {
  PlaneIndex index;
  index.reserve(static_cast<int>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) index.add(points[k], static_cast<int>(k));
  index.sort();
  return index;
}

TEST(PlaneIndex, FindsWhatLookingAtEveryPointFinds) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const std::size_t size : {0u, 1u, 2u, 3u, 17u, 100u, 1000u}) {
    std::vector<Place> points;
    for (std::size_t k = 0; k < size; ++k) {
      points.emplace_back(100.0 * normal(random), 300.0 * normal(random));
      if (k % 7 == 3) points.back() = points[k - 1];                   // of one place
      if (k % 11 == 5) points.back()[0] = points[k - 1][0];            // of one latitude
      if (k % 50 == 20) points.back() *= 1e9;                          // at the end of the world
      if (k % 13 == 0) points.back() = points.back().array().round();  // on a grid
    }
    const PlaneIndex index = index_of_points(points);
    for (int k = 0; k < 200; ++k) {
      const Place place = k % 3 == 0 && size > 0
                              ? points[static_cast<std::size_t>(k) % size]
                              : Place(100 * normal(random), 300 * normal(random));
      const double reach_m = std::fabs(50.0 * normal(random)) * (k % 5 == 0 ? 0.0 : 1.0);
      std::vector<int> names = found_nearest(index, place, reach_m);
      std::sort(names.begin(), names.end());
      EXPECT_EQ(names, near(points, place, reach_m));
      const std::vector<int> few = found_nearest(index, place, reach_m, 5);
      EXPECT_EQ(few.size(), std::min<std::size_t>(5, names.size()));
      for (const int name : few) EXPECT_TRUE(std::binary_search(names.begin(), names.end(), name));
    }
    EXPECT_EQ(found_nearest(index, {0.0, 0.0}, std::numeric_limits<double>::infinity()).size(),
              size);
  }
}

TEST(PlaneIndex, FindsPointsThatAreSpreadEvenly) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-2000.0, 2000.0);
  for (const std::size_t size : {300u, 1500u, 4000u}) {
    std::vector<Place> points;
    for (std::size_t k = 0; k < size; ++k) points.emplace_back(uniform(random), uniform(random));
    const PlaneIndex index = index_of_points(points);
    for (int k = 0; k < 200; ++k) {
      const Place place(1.1 * uniform(random), 1.1 * uniform(random));
      std::vector<int> names = found_nearest(index, place, 200.0);
      std::sort(names.begin(), names.end());
      EXPECT_EQ(names, near(points, place, 200.0));
    }
  }
}

TEST(PlaneIndex, OfManyInSlicesNoneLeftOutIsNearer) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(-300.0, 300.0);
  std::vector<Place> points;
  for (int k = 0; k < 1500; ++k) points.emplace_back(uniform(random), uniform(random));
  const PlaneIndex index = index_of_points(points);
  for (const int most : {1, 32, PlaneSlices::kMostNear}) {
    const Place place(uniform(random), uniform(random));
    std::vector<double> apart_m, found_m;
    for (const Place& point : points) apart_m.push_back((point - place).cwiseAbs().maxCoeff());
    for (const int name : found_nearest(index, place, 1e9, most))
      found_m.push_back(apart_m[static_cast<std::size_t>(name)]);
    std::sort(apart_m.begin(), apart_m.end());
    std::sort(found_m.begin(), found_m.end());
    apart_m.resize(static_cast<std::size_t>(most));
    EXPECT_EQ(found_m, apart_m);
  }
}

TEST(PlaneIndex, TheNearestOfAGridAreNear) {
  std::vector<Place> points;
  for (int k = 0; k < 2500; ++k) points.emplace_back(k / 50, k % 50);
  const PlaneIndex index = index_of_points(points);
  const std::vector<int> names = found_nearest(index, {20.1, 30.1}, 25.0, 60);
  EXPECT_EQ(names.size(), 60u);
  for (const int name : names)
    EXPECT_LT((points[static_cast<std::size_t>(name)] - Place(20.1, 30.1)).cwiseAbs().maxCoeff(),
              26.0);
  EXPECT_EQ(names.front(), 20 * 50 + 30);
}

TEST(PlaneIndex, NothingIsNearWhatIsNoPlace) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const std::size_t size : {2u, 100u}) {
    const PlaneIndex index = index_of_points(std::vector<Place>(size, Place(1.0, 1.0)));
    EXPECT_TRUE(found_nearest(index, {kNan, 0.0}, 10.0, 9).empty());
    EXPECT_TRUE(found_nearest(index, {0.0, kNan}, 10.0, 9).empty());
    EXPECT_TRUE(found_nearest(index, {0.0, 0.0}, kNan, 9).empty());
  }
}

TEST(PlaneIndex, ForgetsWhenCleared) {
  for (const int size : {1, 100}) {
    PlaneIndex index;
    index.reserve(size);
    for (int k = 0; k < size; ++k) index.add({0.0, 0.0}, k);
    index.sort();
    index.clear();
    index.sort();
    EXPECT_TRUE(found_nearest(index, {0.0, 0.0}, 1.0).empty());
  }
}

}  // namespace
}  // namespace wakeline::plane_index_test
