// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Excluded areas (land) and stationary clutter.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "video/pictures.hpp"

namespace wakeline::masks_test {
namespace {

using test::Picture;

using Corner = Vec<double, 2>;

TEST(LandMask, ExcludesNothingByDefault) {
  EXPECT_FALSE(LandMask().excludes(1.0, 1000.0));
  EXPECT_FALSE(LandMask(360).excludes(1.0, 1000.0));
}

TEST(LandMask, SectorsGoAcrossNorth) {
  LandMask mask(3600);
  mask.exclude_sector(deg(350), deg(20), 500.0, 900.0);
  for (const double azimuth : {350.1, 359.9, 0.0, 10.0, 19.9, -5.0, 365.0})
    EXPECT_TRUE(mask.excludes(deg(azimuth), 700.0)) << azimuth;
  for (const double azimuth : {349.8, 20.2, 180.0})
    EXPECT_FALSE(mask.excludes(deg(azimuth), 700.0)) << azimuth;
  EXPECT_FALSE(mask.excludes(0.0, 499.0));
  EXPECT_FALSE(mask.excludes(0.0, 901.0));
}

TEST(LandMask, AWholeTurnIsASectorToo) {
  LandMask mask(360);
  mask.exclude_sector(deg(40), deg(400), 0.0, 50.0);
  for (int azimuth = 0; azimuth < 360; ++azimuth) EXPECT_TRUE(mask.excludes(deg(azimuth), 49.0));
}

TEST(LandMask, PolygonsAreThoseOfThePlane) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> anywhere(-1000.0, 1000.0);
  // A square, a hook that a ray may cross twice, and one with the antenna inside.
  const std::vector<std::vector<Corner>> polygons{
      {{100, 100}, {100, 600}, {600, 600}, {600, 100}},
      {{200, -800}, {200, 800}, {700, 800}, {700, 400}, {400, 400}, {400, -800}},
      {{-300, -300}, {400, -300}, {400, 500}, {-300, 500}}};
  const auto inside = [](const std::vector<Corner>& corners, const Corner& p) {
    bool in = false;
    for (std::size_t k = 0, l = corners.size() - 1; k < corners.size(); l = k++) {
      const Corner& a = corners[k];
      const Corner& b = corners[l];
      if ((a[1] > p[1]) != (b[1] > p[1]) &&
          p[0] < (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]) + a[0])
        in = !in;
    }
    return in;
  };
  for (const auto& polygon : polygons) {
    LandMask mask(8192);
    mask.exclude_polygon(polygon);
    int differing = 0;
    for (int trial = 0; trial < 20000; ++trial) {
      const Corner place(anywhere(random), anywhere(random));
      differing +=
          mask.excludes(std::atan2(place[1], place[0]), place.norm()) != inside(polygon, place);
    }
    EXPECT_LT(differing, 30);  // a direction is as wide as 1 m at its end
  }
}

TEST(LandMask, AreasAdd) {
  LandMask mask(360);
  mask.exclude_sector(0.0, deg(10), 100.0, 200.0);
  mask.exclude_sector(0.0, deg(10), 400.0, 500.0);
  mask.exclude_sector(0.0, deg(10), 150.0, 300.0);
  for (const double range_m : {120.0, 190.0, 250.0, 450.0})
    EXPECT_TRUE(mask.excludes(deg(5), range_m));
  for (const double range_m : {90.0, 350.0, 510.0}) EXPECT_FALSE(mask.excludes(deg(5), range_m));
}

TEST(LandMask, TakesItsCellsOutOfThePicture) {
  Picture<> picture{360, 200};
  test::add_ship(picture, 100, 60);
  test::add_ship(picture, 250, 120);
  LandMask mask(720);
  mask.exclude_sector(deg(80), deg(120), 500.0, 900.0);
  const auto plots = extract_plots(picture.image(), PlotExtractorSettings{}, 0.0, mask);
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_NEAR(plots[0].bearing_rad, deg(250), 1e-3);
  // A cell of which a part is excluded is excluded.
  LandMask edge(720);
  edge.exclude_sector(0.0, 2 * kPi<double>, 0.0, 100.0 + 50 * 10.0 + 0.1);
  std::vector<std::uint8_t> threshold(200, 7);
  edge.lift<std::uint8_t>(picture.sweep(30), threshold);
  EXPECT_EQ(threshold[50], 255);
  EXPECT_EQ(threshold[51], 7);
}

TEST(LandMask, RejectsInvalidParameters) {
  LandMask mask(360);
  EXPECT_THROW(LandMask(0), std::invalid_argument);
  EXPECT_THROW(LandMask(65537), std::invalid_argument);
  EXPECT_THROW(mask.exclude_sector(0, 1, 10, 10), std::invalid_argument);
  EXPECT_THROW(mask.exclude_sector(0, 1, -1, 10), std::invalid_argument);
  EXPECT_THROW(mask.exclude_sector(std::nan(""), 1, 0, 10), std::invalid_argument);
  EXPECT_THROW(mask.exclude_sector(0, 1, 0, std::nan("")), std::invalid_argument);
  EXPECT_THROW(mask.exclude_polygon(std::array{Corner(0, 1), Corner(1, 1)}), std::invalid_argument);
  EXPECT_THROW(
      mask.exclude_polygon(std::array{Corner(0, 1), Corner(1, 1), Corner(1, std::nan(""))}),
      std::invalid_argument);
  EXPECT_THROW(LandMask().exclude_sector(0, 1, 0, 10), std::invalid_argument);
}

/// Turns at 2.5 s each of a picture that a function draws; plots of each turn.
template <class Draw>
std::vector<std::size_t> plots_by_turn(int turns, double time_constant_s, double factor,
                                       const Draw& draw, int rows = 360) {
  PlotExtractor<> extractor({.max_sweep_cells = 200}, {},
                            StaticClutterMap(rows, 200, time_constant_s, factor));
  std::vector<std::size_t> counts;
  for (int turn = 0; turn < turns; ++turn) {
    Picture<> picture{360, 200};
    draw(picture, turn);
    std::size_t count = 0;
    for (int k = 0; k < 360; ++k) {
      auto sweep = picture.sweep(k);
      sweep.time_s = 2.5 * (turn + k / 360.0);
      count += extractor.process(sweep).size();
    }
    counts.push_back(count);
  }
  return counts;
}

TEST(StaticClutterMap, WhatStaysVanishesAfterItsTime) {
  // With as many rows as sweeps, more, and fewer: then up to three turns later.
  constexpr double kTimeConstant = 60.0;
  constexpr double kFactor = 1.5;
  const auto buoy = [](Picture<>& picture, int) {
    for (int j = 100; j < 104; ++j) picture.at(j, 60) = picture.at(j, 61) = 200;
  };
  const double vanishes_s = kTimeConstant * std::log(kFactor / (kFactor - 1.0));
  for (const int rows : {360, 1000, 180, 90, 45}) {
    const auto seen = plots_by_turn(60, kTimeConstant, kFactor, buoy, rows);
    for (std::size_t turn = 0; turn < seen.size(); ++turn) {
      const double time_s = 2.5 * static_cast<double>(turn);
      if (std::fabs(time_s - vanishes_s) < (rows < 360 ? 8.0 : 2.6)) continue;
      EXPECT_EQ(seen[turn], time_s < vanishes_s ? 1u : 0u) << rows << " rows, turn " << turn;
    }
  }
}

TEST(StaticClutterMap, KnowsASweepAgainHoweverItsAzimuthIsRounded) {
  for (const double place : {100.0, 100.5}) {
    StaticClutterMap map(360, 1, 30.0);
    const std::vector<std::uint8_t> amplitude{200};
    std::vector<std::uint8_t> threshold{1};
    for (int turn = 0; turn < 50; ++turn)
      map.lift_and_learn<std::uint8_t>({.time_s = 2.5 * turn,
                                        .azimuth_rad = deg(place + 1e-9 * (turn % 3 - 1)),
                                        .azimuth_width_rad = deg(1),
                                        .cell_m = 10.0,
                                        .amplitude = amplitude},
                                       threshold);
    EXPECT_EQ(std::ranges::count_if(map.mean(), [](float m) { return m > 0; }), 1) << place;
  }
}

TEST(StaticClutterMap, WhatMovesStays) {
  const auto ship = [](Picture<>& picture, int turn) {
    test::add_ship(picture, 100 + 0.3 * turn, 20 + 1.5 * turn);
  };
  for (const std::size_t count : plots_by_turn(100, 120.0, 1.5, ship)) EXPECT_EQ(count, 1u);
}

TEST(StaticClutterMap, LearnsByTimeNotByTurns) {
  // The mean after T of a steady amplitude is (1 - 1/e) of it, at any speed of the antenna.
  for (const double period_s : {0.5, 3.0}) {
    StaticClutterMap map(36, 10, 30.0);
    const std::vector<std::uint8_t> amplitude(10, 100);
    std::vector<std::uint8_t> threshold(10);
    for (double time_s = 0.0; time_s < 30.0 + 1e-9; time_s += period_s)
      map.lift_and_learn<std::uint8_t>({.time_s = time_s,
                                        .azimuth_rad = deg(5),
                                        .azimuth_width_rad = deg(10),
                                        .cell_m = 10.0,
                                        .amplitude = amplitude},
                                       threshold);
    EXPECT_NEAR(map.mean()[3], 100 * (1 - std::exp(-1.0)), 1e-3);
    EXPECT_EQ(map.mean()[13], 0.0f);
  }
}

TEST(StaticClutterMap, LearnsWhereTheBeamNeverLeavesARow) {
  // All round with a single row, and to and fro, in a sector of three sweeps, within one of four.
  for (const int sweeps : {36, 3}) {
    StaticClutterMap map(sweeps == 36 ? 1 : 4, 1, 30.0);
    std::vector<std::uint8_t> threshold(1);
    for (int k = 0; k < 50 * sweeps; ++k) {
      const int sweep = k % sweeps;
      const std::vector<std::uint8_t> amplitude{static_cast<std::uint8_t>(sweep == 1 ? 100 : 40)};
      map.lift_and_learn<std::uint8_t>({.time_s = 3.0 * k / sweeps,
                                        .azimuth_rad = deg(10) * sweep,
                                        .azimuth_width_rad = deg(10),
                                        .cell_m = 10.0,
                                        .amplitude = amplitude},
                                       threshold);
    }
    EXPECT_NEAR(map.mean()[0], 100 * (1 - std::exp(-49 * 3.0 / 30.0)), 0.1) << sweeps;
  }
}

TEST(StaticClutterMap, ForgetsWhenTheGeometryChanges) {
  StaticClutterMap map(36, 10, 30.0);
  const std::vector<std::uint16_t> amplitude(12, 60000);
  std::vector<std::uint16_t> threshold(12);
  Sweep<std::uint16_t> sweep{.azimuth_width_rad = deg(10), .cell_m = 10.0, .amplitude = amplitude};
  for (int k = 0; k < 100; ++k, sweep.time_s += 3.0)
    map.lift_and_learn<std::uint16_t>(sweep, threshold);
  EXPECT_EQ(threshold[9], 65535);
  EXPECT_EQ(threshold[10], 0);  // beyond the map
  sweep.cell_m = 20.0;
  std::ranges::fill(threshold, std::uint16_t{5});
  map.lift_and_learn<std::uint16_t>(sweep, threshold);
  EXPECT_EQ(threshold[3], 5);
  EXPECT_EQ(map.mean()[3], 0.0f);
}

TEST(StaticClutterMap, TimeThatRunsBackLearnsNothing) {
  StaticClutterMap map(36, 10, 30.0);
  const std::vector<std::uint8_t> amplitude(10, 100);
  std::vector<std::uint8_t> threshold(10);
  Sweep<> sweep{.azimuth_width_rad = deg(10), .cell_m = 10.0, .amplitude = amplitude};
  for (int k = 0; k < 10; ++k, sweep.time_s -= 3.0)
    map.lift_and_learn<std::uint8_t>(sweep, threshold);
  EXPECT_EQ(map.mean()[3], 0.0f);
}

TEST(StaticClutterMap, RejectsInvalidParameters) {
  EXPECT_THROW(StaticClutterMap(0, 10, 30.0), std::invalid_argument);
  EXPECT_THROW(StaticClutterMap(36, 0, 30.0), std::invalid_argument);
  EXPECT_THROW(StaticClutterMap(36, -5, 30.0), std::invalid_argument);
  EXPECT_THROW(StaticClutterMap(36, 10, 0.0), std::invalid_argument);
  EXPECT_THROW(StaticClutterMap(36, 10, std::nan("")), std::invalid_argument);
  EXPECT_THROW(StaticClutterMap(36, 10, 30.0, 0.9), std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::masks_test
