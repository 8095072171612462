// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/clutter_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace wakeline::clutter_map_test {
namespace {

using Place = Vec<double, 2>;
constexpr double kCell = 100.0;
constexpr double kMemory = 60.0;
constexpr double kPeriod = 2.5;
constexpr double kRounding = 2e-7;  // of a float

/// The integral of the density over the plane (m²), as a sum on a fine grid about a place.
double total(const ClutterMap& map, const Place& about, double time_s) {
  constexpr double kStep = 5.0;
  double sum = 0.0;
  for (double n = -3 * kCell; n < 3 * kCell; n += kStep)
    for (double e = -3 * kCell; e < 3 * kCell; e += kStep)
      sum += map.density(about + Place(n, e), time_s, kPeriod) * kStep * kStep;
  return sum;
}

TEST(ClutterMap, OnePlotWeighsTheSameWhereverItLies) {
  const double per_scan = 1.0 - std::exp(-kPeriod / kMemory);
  for (const Place& place :
       {Place(50.0, 50.0), Place(20.0, 90.0), Place(-730.0, 1234.5), Place(0.0, 0.0)}) {
    ClutterMap map(kCell, kMemory);
    map.add(place, 0.0, 0.7);
    EXPECT_NEAR(total(map, place, 0.0), 0.7 * per_scan, 0.01 * per_scan);
  }
}

TEST(ClutterMap, SharesAPlotBilinearly) {
  ClutterMap map(kCell, kMemory);
  map.add({75.0, 50.0}, 0.0, 1.0);  // a quarter of a cell north of a centre
  const double near = map.density({50.0, 50.0}, 0.0, kPeriod);
  EXPECT_GT(near, 0.0);
  EXPECT_NEAR(map.density({150.0, 50.0}, 0.0, kPeriod) / near, 1.0 / 3.0, kRounding);
  EXPECT_NEAR(map.density({100.0, 50.0}, 0.0, kPeriod) / near, 2.0 / 3.0, kRounding);
  EXPECT_EQ(map.density({250.0, 50.0}, 0.0, kPeriod), 0.0);
  EXPECT_EQ(map.density({50.0, 150.0}, 0.0, kPeriod), 0.0);
}

// What a map has learned of one target alone is all that it holds.
TEST(ClutterMap, KnowsThePartOfATargetsOwnPlots) {
  for (const Place& place : {Place(50.0, 50.0), Place(-20.0, 190.0), Place(-730.0, 1234.5)}) {
    ClutterMap map(kCell, kMemory);
    LearnedPlots learned;
    for (const double time_s : {0.0, 7.0, 30.0}) {
      map.add(place, time_s, 0.7);
      map.remember(place, time_s, 0.7, learned);
    }
    for (double off_m = -250.0; off_m <= 250.0; off_m += 12.5) {
      const Place position = place + Place(off_m, 30.0 - off_m / 2);
      const double density = map.density(position, 40.0, kPeriod);
      EXPECT_NEAR(map.density_of(learned, position, 40.0, kPeriod), density, kRounding * density);
    }
    EXPECT_GT(map.density_of(learned, place, 40.0, kPeriod), 0.0);
  }
  EXPECT_EQ(ClutterMap(0.0, kMemory).density_of({Place(0, 0), 1.0, 0.0}, Place(0, 0), 0.0, kPeriod),
            0.0);
}

TEST(ClutterMap, CountsTheSameFromAnyTimeOn) {
  const auto density_after = [](double begin_s) {
    ClutterMap map(kCell, kMemory);
    for (const double time_s : {0.0, 100.0, 130.0}) map.add({50.0, 50.0}, begin_s + time_s, 1.0);
    return map.density({50.0, 50.0}, begin_s + 150.0, kPeriod);
  };
  const double expected = density_after(0.0);
  for (const double begin_s : {-1e9, -4000.0, -70.0, 5.9e3, 1.7e9})
    EXPECT_NEAR(density_after(begin_s), expected, 1e-6 * expected);
}

TEST(ClutterMap, ForgetsOverALongPause) {
  ClutterMap map(kCell, kMemory);
  map.add({50.0, 50.0}, 0.0, 1.0);
  map.add({5000.0, 50.0}, 150.0 * kMemory, 1.0);
  const double later_s = 150.0 * kMemory + 10.0;
  EXPECT_LT(map.density({50.0, 50.0}, later_s, kPeriod), 1e-40);
  ClutterMap fresh(kCell, kMemory);
  fresh.add({5000.0, 50.0}, 150.0 * kMemory, 1.0);
  EXPECT_EQ(map.density({5000.0, 50.0}, later_s, kPeriod),
            fresh.density({5000.0, 50.0}, later_s, kPeriod));
}

// Sectors ask for a period ago, when the plots of the last sector had not come.
TEST(ClutterMap, NoPlotCountsForMuchMoreThanWhenItCame) {
  for (const double memory_s : {0.001, 1.0, 60.0}) {
    ClutterMap map(kCell, memory_s);
    map.add({50.0, 50.0}, 100.0, 1.0);
    LearnedPlots learned;
    map.remember({50.0, 50.0}, 100.0, 1.0, learned);
    const double when_it_came = map.density({50.0, 50.0}, 100.0, kPeriod);
    const double before_s = map.no_sooner_s(97.5);
    const double before = map.density({50.0, 50.0}, before_s, kPeriod);
    EXPECT_LE(before, 1.2 * when_it_came);
    EXPECT_NEAR(map.density_of(learned, {50.0, 50.0}, before_s, kPeriod), before,
                kRounding * before);
  }
}

TEST(ClutterMap, FadesWithItsMemory) {
  ClutterMap map(kCell, kMemory);
  map.add({50.0, 50.0}, 10.0, 1.0);
  const double fresh = map.density({50.0, 50.0}, 10.0, kPeriod);
  EXPECT_NEAR(map.density({50.0, 50.0}, 10.0 + kMemory, kPeriod) / fresh, std::exp(-1.0),
              kRounding);
  EXPECT_LT(map.density({50.0, 50.0}, 10.0 + 100 * kMemory, kPeriod), 1e-40);
}

TEST(ClutterMap, APlotInEveryScanIsADensityOfOnePerCell) {
  ClutterMap map(kCell, kMemory);
  double time_s = 0.0;
  for (int k = 0; k < 1000; ++k) map.add({150.0, -250.0}, time_s += kPeriod, 1.0);
  EXPECT_NEAR(map.density({150.0, -250.0}, time_s, kPeriod) * kCell * kCell, 1.0, 1e3 * kRounding);
}

TEST(ClutterMap, IsOffWithoutACell) {
  ClutterMap map(0.0, kMemory);
  EXPECT_FALSE(map.enabled());
  map.add({50.0, 50.0}, 0.0, 1.0);
  EXPECT_EQ(map.density({50.0, 50.0}, 0.0, kPeriod), 0.0);
}

TEST(ClutterMap, NoPlaceIsTooFarOff) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  ClutterMap map(kCell, kMemory);
  for (const double n : {1e300, -1e300, 1e12, kInf, -kInf, kNan, 0.0})
    for (const double e : {1e300, -1e300, kInf, kNan, 0.0}) {
      map.add({n, e}, 0.0, 1.0);
      const double density = map.density({n, e}, 0.0, kPeriod);
      EXPECT_TRUE(std::isfinite(density) && density >= 0.0) << n << ", " << e << ": " << density;
    }
}

TEST(ClutterMap, ForgetsTheWeakerWhenItIsFull) {
  ClutterMap map(kCell, kMemory);
  const auto flood = [&](double weight) {
    for (int n = 0; n < 400; ++n)
      for (int e = 0; e < 400; ++e)
        map.add({kCell * (n + 100.5), kCell * (e + 100.5)}, 0.0, weight);
  };
  map.add({50.0, 50.0}, 0.0, 1.0);
  const double before = map.density({50.0, 50.0}, 0.0, kPeriod);
  flood(0.5);
  EXPECT_EQ(map.density({50.0, 50.0}, 0.0, kPeriod), before);
  flood(2.0);
  EXPECT_EQ(map.density({50.0, 50.0}, 0.0, kPeriod), 0.0);
}

TEST(ClutterMap, SavesAndRestores) {
  ClutterMap map(kCell, kMemory), copy(kCell, kMemory), off(0.0, kMemory);
  for (int k = 0; k < 50; ++k) map.add({37.0 * k, -11.0 * k}, k, 0.3);
  Archive out;
  map.archive(out);
  Archive in(out.bytes());
  copy.archive(in);
  EXPECT_TRUE(in.ok() && in.at_end());
  for (int k = 0; k < 200; ++k)
    EXPECT_EQ(copy.density({9.0 * k, -3.0 * k}, 60.0, kPeriod),
              map.density({9.0 * k, -3.0 * k}, 60.0, kPeriod));
  Archive again(out.bytes());
  off.archive(again);
  EXPECT_FALSE(again.ok()) << "a map that is off takes no cells";
  Archive nothing;
  off.archive(nothing);
  Archive none(nothing.bytes());
  copy.archive(none);
  EXPECT_FALSE(none.ok());
  EXPECT_GE(copy.density({0.0, 0.0}, 0.0, kPeriod), 0.0);
}

}  // namespace
}  // namespace wakeline::clutter_map_test
