// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/scan_plots.hpp"

#include <gtest/gtest.h>

#include <set>

#include "track/stages.hpp"

namespace wakeline::scan_plots_test {
namespace {

using namespace test;

TEST(ScanPlots, ArePositionsWithTheErrorsOfTheRadar) {
  const ScanPlots plots = scan_of({plot_at(1000.0, 0.0, 2.0)}, 2.5);
  ASSERT_EQ(plots.size(), 1);
  EXPECT_NEAR(plots[0].position.mean[0], 1000.0, 1.0);
  EXPECT_NEAR(plots[0].position.mean[1], 0.0, 1e-9);
  const double across_m = 1000.0 * kStageRadar.bearing_std_rad;
  EXPECT_NEAR(plots[0].position.covariance(0, 0), 8.0 * 8.0 + 2.0 * 2.0, 0.1);
  EXPECT_NEAR(plots[0].position.covariance(1, 1), across_m * across_m + 2.0 * 2.0, 0.5);
  EXPECT_EQ(plots[0].time_s, 2.0);
}

TEST(ScanPlots, KeepTheirIndexWhereOthersAreRejected) {
  const double nan = std::nan("");
  std::vector<Plot> input(6, plot_at(1000.0, 0.0, 2.0));
  input[0].range_m = nan;
  input[1].range_m = -1.0;
  input[3].bearing_rad = 1e300;
  input[4].time_s = -100.0;  // farther from the scan than the slack
  const ScanPlots plots = scan_of(input, 2.5);
  ASSERT_EQ(plots.size(), 2);
  EXPECT_EQ(plots[0].input, 2);
  EXPECT_EQ(plots[1].input, 5);
}

TEST(ScanPlots, OneAheadOfTheScanCountsAsOfItsTime) {
  const ScanPlots plots = scan_of({plot_at(0.0, 500.0, 4.0), plot_at(0.0, 500.0, 1.0)}, 2.5);
  EXPECT_EQ(plots[0].time_s, 2.5);
  EXPECT_EQ(plots.scan_s(), 2.5);
  EXPECT_EQ(plots.greatest_lag_s(2.5), 1.5);
  EXPECT_EQ(plots.greatest_lag_s(1.5), 1.0);
}

TEST(ScanPlots, OfABeyondTheCapacityAreLeftOut) {
  ScanPlots plots(3);
  plots.convert(kStageRadar, std::vector<Plot>(5, plot_at(100.0, 0.0, 0.0)), 0.0, 1.0);
  EXPECT_EQ(plots.size(), 3);
  plots.convert(kStageRadar, {}, 1.0, 1.0);
  EXPECT_EQ(plots.size(), 0) << "those of the scan before are gone";
}

TEST(ScanPlots, AreFoundByPosition) {
  std::vector<Plot> input;
  for (int k = 0; k < 50; ++k) input.push_back(plot_at(500.0 + 40.0 * k, -300.0 + 13.0 * k, 0.0));
  const ScanPlots plots = scan_of(input, 0.0);
  const Vec<double, 2> place(1500.0, 50.0);
  std::set<int> found, expected;
  plots.for_each_near(
      place, [](double) { return 200.0; }, [&](int k) { found.insert(k); });
  for (int k = 0; k < plots.size(); ++k)
    if ((plots[k].position.mean - place).cwiseAbs().maxCoeff() <= 200.0) expected.insert(k);
  EXPECT_EQ(found, expected);
  EXPECT_GT(expected.size(), 5u);
}

}  // namespace
}  // namespace wakeline::scan_plots_test
