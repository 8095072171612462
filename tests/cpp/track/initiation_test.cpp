// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/initiation.hpp"

#include <gtest/gtest.h>

#include "track/stages.hpp"

namespace wakeline::initiation_test {
namespace {

using namespace test;

/// Initiation over scans, with all plots free unless given otherwise.
struct Scene {
  TrackerConfig config;
  ClutterDensity clutter{config};
  PlotOwnership ownership{config};
  TrackInitiation initiation{kStageRadar, config};
  double beam_rad = 0.0;

  explicit Scene(const TrackerConfig& with = {}) : config(with) {}

  std::vector<TrackStart> scan(const std::vector<Plot>& plots, double time_s,
                               const Track* owner = nullptr, bool room = true) {
    const ScanPlots scan = scan_of(plots, time_s);
    clutter.evaluate(scan, 2.5, 2.5);
    ownership.clear(scan.size());
    if (owner != nullptr) {
      AssociationProbabilities certain;
      certain.of_candidate[0] = certain.any = 1.0;
      certain.best = 0;
      ownership.add(*owner, candidates_of({candidate(0, 1e-3, 1e-6)}), {}, certain);
    }
    std::vector<TrackStart> starts;
    initiation.initiate(
        scan, ownership, clutter, beam_rad += 6.283185307179586, true, [&](double) { return room; },
        [&](const TrackStart& start) { starts.push_back(start); });
    return starts;
  }
};

TEST(Initiation, StartsFromTwoPlotsWithinTheSpeedLimit) {
  Scene scene;
  EXPECT_TRUE(scene.scan({plot_at(1000.0, 0.0, 0.0)}, 0.0).empty()) << "one plot is no start";
  const auto starts = scene.scan({plot_at(1020.0, 0.0, 2.5), plot_at(1500.0, 0.0, 2.5)}, 2.5);
  ASSERT_EQ(starts.size(), 1u) << "500 m in 2.5 s is too fast";
  EXPECT_NEAR(starts[0].belief.mean[0], 1020.0, 10.0);
  EXPECT_GT(starts[0].belief.mean[1], 3.0);
  EXPECT_LT(starts[0].belief.mean[1], 8.0) << "tempered by the speed limit";
  EXPECT_EQ(starts[0].time_s, 2.5);
  EXPECT_NEAR(starts[0].existence, scene.config.initial_existence, 1e-6) << "no clutter is known";
}

TEST(Initiation, APlotThatATrackOwnsStartsNone) {
  Scene scene;
  const Track owner = track_at(0, Vec<double, 4>::Zero(), Vec<double, 4>::Ones());
  (void)scene.scan({plot_at(1000.0, 0.0, 0.0)}, 0.0);
  EXPECT_TRUE(scene.scan({plot_at(1010.0, 0.0, 2.5)}, 2.5, &owner).empty());
  EXPECT_TRUE(scene.scan({plot_at(1010.0, 0.0, 5.0)}, 5.0).empty())
      << "nor does it when the next is free";
  EXPECT_EQ(scene.scan({plot_at(1010.0, 0.0, 7.5)}, 7.5).size(), 1u);
}

TEST(Initiation, NothingStartsWithoutRoom) {
  Scene scene;
  (void)scene.scan({plot_at(1000.0, 0.0, 0.0)}, 0.0);
  EXPECT_TRUE(scene.scan({plot_at(1010.0, 0.0, 2.5)}, 2.5, nullptr, false).empty());
}

TEST(Initiation, TwoPlotsOfOneMomentOrTooFarApartInTimeStartNone) {
  Scene scene;
  (void)scene.scan({plot_at(1000.0, 0.0, 0.0)}, 0.0);
  EXPECT_TRUE(scene.scan({plot_at(1000.0, 0.0, 0.0)}, 0.0).empty());
  const double longest_s = scene.config.coast_scans_max * kStageRadar.period_s;
  EXPECT_TRUE(scene.scan({plot_at(1000.0, 0.0, longest_s + 0.1)}, longest_s + 0.1).empty());
}

}  // namespace
}  // namespace wakeline::initiation_test
