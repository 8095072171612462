// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/clutter_density.hpp"

#include <gtest/gtest.h>

#include "track/stages.hpp"

namespace wakeline::clutter_density_test {
namespace {

using namespace test;

const TrackerConfig kConfig{.clutter_density_per_m2 = 1e-7};

TEST(ClutterDensity, IsTheFloorWhereNothingIsLearned) {
  ClutterDensity clutter(kConfig);
  const ScanPlots plots = scan_of({plot_at(1000.0, 0.0, 0.0), plot_at(500.0, 500.0, 0.0)}, 0.0);
  clutter.evaluate(plots, 0.0, 2.5);
  for (const int plot : {0, 1}) EXPECT_EQ(clutter.without({}, plots, plot), 1e-7);
}

TEST(ClutterDensity, RisesWhereClutterIsLearnedAndOnlyThere) {
  ClutterDensity clutter(kConfig);
  const std::vector<double> clutter_probability{1.0, 0.0};
  for (int scan = 0; scan < 20; ++scan) {
    const ScanPlots plots =
        scan_of({plot_at(1000.0, 0.0, 2.5 * scan), plot_at(-900.0, 700.0, 2.5 * scan)}, 2.5 * scan);
    clutter.evaluate(plots, scan > 0 ? 2.5 : 0.0, 2.5);
    EXPECT_EQ(clutter.without({}, plots, 1), 1e-7) << "what a track owns is not learned";
    EXPECT_TRUE(scan == 0 || clutter.without({}, plots, 0) > 1e-7);
    clutter.learn(plots, clutter_probability, clutter_probability, [](int) { return -1; }, {}, {});
  }
}

TEST(ClutterDensity, OfATrackLeavesOutItsOwnPlots) {
  ClutterDensity clutter(kConfig);
  std::vector<Look> looks(1);
  const std::vector<int> slots{0};
  const std::vector<double> clutter_probability{0.7};
  for (int scan = 0; scan < 10; ++scan) {
    const ScanPlots plots = scan_of({plot_at(1000.0, 0.0, 2.5 * scan)}, 2.5 * scan);
    clutter.evaluate(plots, scan > 0 ? 2.5 : 0.0, 2.5);
    if (scan > 0) {
      EXPECT_GT(clutter.without({}, plots, 0), 2e-7);
      EXPECT_NEAR(clutter.without(looks[0].learned, plots, 0) / 1e-7, 1.0, 1e-6)
          << "all that was learned is its own";
    }
    clutter.learn(
        plots, clutter_probability, clutter_probability, [](int) { return 0; }, looks, slots);
  }
}

TEST(ClutterDensity, IsThatOfTheRangeWhereItIsLarger) {
  ClutterDensity clutter(kConfig);
  std::vector<Plot> plots;
  for (int k = 0; k < 100; ++k) plots.push_back({0.0, 3000.0, deg(3.6 * k), {}});
  const ScanPlots scan = scan_of(plots, 0.0);
  clutter.evaluate(scan, 0.0, 2.5);
  clutter.learn_free(scan, std::vector<double>(100, 1.0), 0.0, 1.0);
  for (const int plot : {0, 50}) EXPECT_GT(clutter.without({}, scan, plot), 2e-6);
}

}  // namespace
}  // namespace wakeline::clutter_density_test
