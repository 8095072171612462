// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/clutter_rings.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/draw.hpp"
#include "track/stages.hpp"

namespace wakeline::clutter_rings_test {
namespace {

using namespace test;

constexpr double kPrior_per_m2 = 1e-7;

/// Adds plots evenly spread between two ranges.
void spread(Draw& draw, int count, double from_m, double to_m, std::vector<Plot>& plots) {
  for (int k = 0; k < count; ++k) {
    const double squared_m2 = draw.uniform(from_m * from_m, to_m * to_m);
    plots.push_back({0.0, std::sqrt(squared_m2), draw.uniform(0.0, 2.0 * std::numbers::pi), {}});
  }
}

/// Learns scans in which there are so many false plots within 1 km, and so many from there to 6 km.
ClutterRings learned(int scans, int near, int far, double false_probability = 1.0) {
  ClutterRings rings(kPrior_per_m2, 60.0);
  Draw draw(5);
  ScanPlots scan(2000);
  for (int k = 0; k < scans; ++k) {
    std::vector<Plot> plots;
    spread(draw, near, 0.0, 1000.0, plots);
    spread(draw, far, 1000.0, 6000.0, plots);
    scan.convert(kStageRadar, plots, 0.0, 1.0);
    rings.learn(scan, std::vector<double>(plots.size(), false_probability), k > 0 ? 2.5 : 0.0, 1.0);
  }
  return rings;
}

TEST(ClutterRings, AreAtThePriorWithoutFalsePlots) {
  EXPECT_EQ(ClutterRings(kPrior_per_m2, 60.0).density(3000.0), kPrior_per_m2);
  const ClutterRings rings = learned(50, 5, 50, 0.0);
  for (const double range_m : {0.0, 300.0, 3000.0, 5900.0, 60e3})
    EXPECT_EQ(rings.density(range_m), kPrior_per_m2);
}

TEST(ClutterRings, FindEvenClutterFromTheFirstScanOn) {
  const double even_per_m2 = 1000.0 / (std::numbers::pi * 6000.0 * 6000.0);
  for (const int scans : {1, 3, 20, 200}) {
    const ClutterRings rings = learned(scans, 28, 972);
    for (const double range_m : {700.0, 1800.0, 3500.0, 5000.0, 5900.0})
      EXPECT_NEAR(rings.density(range_m) / even_per_m2, 1.0, scans < 20 ? 0.5 : 0.25)
          << range_m << " m after " << scans;
  }
}

TEST(ClutterRings, FindSeaClutterWhereItIs) {
  const ClutterRings rings = learned(40, 60, 60);
  EXPECT_NEAR(rings.density(600.0) / (60.0 / (std::numbers::pi * 1e6)), 1.0, 0.25);
  EXPECT_NEAR(rings.density(4500.0) / (60.0 / (std::numbers::pi * 35e6)), 1.0, 0.25);
}

// Sea clutter of one eighth of the compass, seen by an antenna that is not at the origin.
TEST(ClutterRings, FindSeaClutterUpwind) {
  constexpr double kRange_m = 600.0, kEighth_rad = std::numbers::pi / 4.0;
  constexpr int kPlots = 60;
  const OwnShip own{.north_m = 4000.0, .east_m = -7000.0};
  const auto plot_at = [&](double bearing_rad) {
    ScanPlots scan(1);
    scan.convert(kStageRadar, std::vector<Plot>{{0.0, kRange_m - 50.0, bearing_rad, own}}, 0.0,
                 1.0);
    return scan[0];
  };
  for (int upwind = 0; upwind < 8; ++upwind) {
    ClutterRings rings(kPrior_per_m2, 60.0);
    Draw draw(7);
    ScanPlots scan(100);
    for (int k = 0; k < 40; ++k) {
      std::vector<Plot> plots;
      spread(draw, kPlots, 0.0, kRange_m, plots);
      for (Plot& plot : plots) {
        plot.bearing_rad = kEighth_rad * draw.uniform(upwind, upwind + 1);
        plot.own = own;
      }
      scan.convert(kStageRadar, plots, 0.0, 1.0);
      rings.learn(scan, std::vector<double>(plots.size(), 1.0), 2.5, 1.0);
    }
    const double there_per_m2 = kPlots / (kEighth_rad / 2.0 * kRange_m * kRange_m);
    for (int eighth = 0; eighth < 8; ++eighth) {
      const double density = rings.density(plot_at(kEighth_rad * (eighth + 0.5)));
      if (eighth == upwind)
        EXPECT_NEAR(density / there_per_m2, 1.0, 0.25);
      else
        EXPECT_EQ(density, rings.density(kRange_m - 50.0)) << eighth << " of " << upwind;
    }
  }
}

TEST(ClutterRings, ForgetWhatIsPast) {
  ClutterRings rings = learned(40, 60, 60);
  ScanPlots scan(10);
  scan.convert(kStageRadar, std::vector<Plot>{{0.0, 6000.0, 1.0, {}}}, 0.0, 1.0);
  for (int k = 0; k < 200; ++k) rings.learn(scan, std::vector<double>{0.0}, 2.5, 1.0);
  EXPECT_EQ(rings.density(600.0), kPrior_per_m2);
}

TEST(ClutterRings, AFewPlotsNearTheAntennaAreNoDenseClutter) {
  ClutterRings rings(kPrior_per_m2, 60.0);
  ScanPlots scan(10);
  scan.convert(kStageRadar, std::vector<Plot>{{0.0, 400.0, 1.0, {}}, {0.0, 500.0, 2.0, {}}}, 0.0,
               1.0);
  rings.learn(scan, std::vector<double>{1.0, 1.0}, 0.0, 1.0);
  EXPECT_LT(rings.density(400.0), 10.0 * kPrior_per_m2);
}

TEST(ClutterRings, PartsOfATurnAreAsGoodAsTheWhole) {
  ClutterRings whole(kPrior_per_m2, 60.0), parts(kPrior_per_m2, 60.0);
  Draw draw(6);
  for (int turn = 0; turn < 20; ++turn) {
    std::vector<Plot> all;
    spread(draw, 80, 0.0, 6000.0, all);
    ScanPlots scan(2000);
    scan.convert(kStageRadar, all, 0.0, 1.0);
    whole.learn(scan, std::vector<double>(all.size(), 1.0), 2.5, 1.0);
    for (const int part : {0, 1, 2, 3}) {
      scan.convert(kStageRadar, std::span(all).subspan(20 * std::size_t(part), 20), 0.0, 1.0);
      parts.learn(scan, std::vector<double>(20, 1.0), 0.625, 0.25);
    }
  }
  for (const double range_m : {2000.0, 3500.0, 5500.0})
    EXPECT_NEAR(parts.density(range_m) / whole.density(range_m), 1.0, 0.1);
}

}  // namespace
}  // namespace wakeline::clutter_rings_test
