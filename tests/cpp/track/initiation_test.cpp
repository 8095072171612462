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
  TrackInitiation initiation{config};
  double beam_rad = 0.0;

  explicit Scene(const TrackerConfig& with = {}) : config(with) {}

  std::vector<TrackStart> scan(const std::vector<Plot>& plots, double time_s,
                               const Track* owner = nullptr, bool room = true) {
    ScanPlots scan(100);
    (void)scan.add(kStageRadar, plots, time_s, 25.0,
                   [&](const Plot& plot) { return beam_rad + plot.bearing_rad; });
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
        kStageRadar, scan, ownership, clutter, 0.8, beam_rad += 6.283185307179586, true,
        [&](double) { return room; }, [&](const TrackStart& start) { starts.push_back(start); });
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
}

/// The existence of the start from two plots that are so far apart, and scans, after some without.
double existence_of(double way_m, int scans, const TrackerConfig& config, int scans_before = 20) {
  Scene scene(config);
  for (int k = -scans_before; k < 0; ++k) (void)scene.scan({}, 2.5 * k);
  (void)scene.scan({plot_at(1000.0, 1.0, 0.0)}, 0.0);
  for (int k = 1; k < scans; ++k) (void)scene.scan({}, 2.5 * k);
  const auto starts = scene.scan({plot_at(1000.0 + way_m, 1.0, 2.5 * scans)}, 2.5 * scans);
  return starts.size() == 1 ? starts[0].existence : 0.0;
}

TEST(Initiation, ExistenceFallsWithTheDistanceTheMissesAndTheDensity) {
  const TrackerConfig rare{.birth_density_per_m2 = 1e-14};
  EXPECT_GT(existence_of(10.0, 1, rare), 1.5 * existence_of(50.0, 1, rare));
  EXPECT_GT(existence_of(10.0, 1, rare), 5.0 * existence_of(10.0, 2, rare));
  EXPECT_GT(existence_of(10.0, 2, rare), 0.0);
  EXPECT_EQ(existence_of(10.0, 3, rare), 0.0) << "only the two scans before are remembered";
  TrackerConfig dense = rare;
  dense.clutter_density_per_m2 *= 3.0;
  EXPECT_NEAR(existence_of(10.0, 1, rare) / existence_of(10.0, 1, dense), 9.0, 0.01)
      << "either plot may be clutter";
  TrackerConfig never = rare;
  never.birth_density_per_m2 = 0.0;
  EXPECT_EQ(existence_of(10.0, 1, never), 0.0);
}

TEST(Initiation, ExistenceIsThatOfAPoissonSea) {
  // A target is born with β in a unit of area and scan and seen with PD; clutter has ρ.
  const TrackerConfig config{.clutter_density_per_m2 = 1e-6, .birth_density_per_m2 = 1e-11};
  const double std_mps = config.start_speed_factor * kStageRadar.max_speed_mps / std::sqrt(2.0);
  const Gaussian<2> plot = kStageRadar.position(1000.0, 0.0, {});
  Mat<double, 2, 2> s = 2.0 * plot.covariance;
  s.diagonal().array() += std::pow(2.5 * std_mps, 2);
  const double likelihood =
      1.0 / (2.0 * std::numbers::pi * std::sqrt(s(0, 0) * s(1, 1) - s(0, 1) * s(1, 0)));
  const double odds = 1e-11 / 1e-6 * 0.8 * likelihood / 1e-6;
  EXPECT_NEAR(existence_of(0.0, 1, config) / (odds / (1.0 + odds)), 1.0, 1e-6);
}

TEST(Initiation, AsManyTargetsAreThereAtFirstAsAppearUntilOneLeaves) {
  constexpr double kPeriods = 1000.0;
  const TrackerConfig config{.birth_density_per_m2 = 1e-17,
                             .survival_time_s = kPeriods * kStageRadar.period_s};
  const auto after = [&](int scans) { return existence_of(10.0, 1, config, scans); };
  const double born = after(40);
  EXPECT_NEAR(after(0) / born, 0.8 * kPeriods, 0.01 * kPeriods);
  EXPECT_NEAR((after(1) - born) / (after(0) - born), 0.2, 1e-3) << "it has missed one in five";
  EXPECT_NEAR((after(3) - born) / (after(2) - born), 0.2, 1e-3);
  EXPECT_NEAR(after(20) / born, 1.0, 1e-3);
}

TEST(Initiation, APlotThatATrackOwnsStartsNone) {
  Scene scene;
  const Track owner = track_at(0, Vec<double, 4>::Zero(), Vec<double, 4>::Ones());
  (void)scene.scan({plot_at(1000.0, 1.0, 0.0)}, 0.0);
  EXPECT_TRUE(scene.scan({plot_at(1010.0, 1.0, 2.5)}, 2.5, &owner).empty());
  EXPECT_EQ(scene.scan({plot_at(1010.0, 1.0, 5.0)}, 5.0).size(), 1u)
      << "the one before that is free, and the one between is not counted";
  EXPECT_EQ(scene.scan({plot_at(1010.0, 1.0, 7.5)}, 7.5).size(), 1u);
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
