// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/clutter_patches.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "support/draw.hpp"
#include "track/scene.hpp"
#include "track/stages.hpp"

namespace wakeline::clutter_patches_test {
namespace {

using namespace test;

using Place = Vec<double, 2>;
constexpr double kCell = 525.0;
constexpr double kMemory = 20.0;
constexpr double kPeriod = 2.5;
constexpr double kOfRange = 1e-6;

/// Plots evenly spread over a disk.
struct Disk {
  Place center_m;
  double radius_m;
  int plots;

  void add(Draw& draw, double time_s, std::vector<Plot>& scan) const {
    for (int k = 0; k < plots; ++k) {
      const double r = radius_m * std::sqrt(draw.uniform(0.0, 1.0));
      const double angle = draw.uniform(0.0, 2.0 * std::numbers::pi);
      scan.push_back(exact_plot(center_m + r * Place(std::cos(angle), std::sin(angle)), time_s));
    }
  }
  [[nodiscard]] double per_m2() const { return plots / (std::numbers::pi * radius_m * radius_m); }
};

/// Learns so many scans, each in so many parts.
ClutterPatches learned(const Disk& disk, int scans, double free_probability = 1.0, int parts = 1) {
  ClutterPatches patches(kCell, kMemory, 100);
  Draw draw(7);
  ScanPlots scan(100);
  const double dt_s = kPeriod / parts;
  for (int k = 0; k < scans; ++k) {
    std::vector<Plot> plots;
    disk.add(draw, 0.0, plots);
    const std::size_t each = plots.size() / static_cast<std::size_t>(parts);
    for (int part = 0; part < parts; ++part) {
      const double time_s = kPeriod * k + dt_s * (part + 1);
      const auto first = plots.begin() + static_cast<std::ptrdiff_t>(each) * part;
      std::vector<Plot> some(first, first + static_cast<std::ptrdiff_t>(each));
      for (Plot& plot : some) plot.time_s = time_s;
      scan.convert(kStageRadar, some, time_s, kPeriod);
      patches.learn(scan, std::vector<double>(some.size(), free_probability), dt_s, 1.0 / parts);
    }
  }
  return patches;
}

/// The density at a place a scan later.
double density(ClutterPatches& patches, const Place& place, int scans,
               const LearnedPlots& own = {}) {
  const double time_s = kPeriod * (scans + 1);
  const ScanPlots scan = scan_of({exact_plot(place, time_s)}, time_s);
  patches.evaluate(scan, kPeriod);
  return patches.density(own, scan, 0, kOfRange);
}

const Disk kRain{{2800.0, 2800.0}, 1000.0, 60};

TEST(ClutterPatches, AreFoundUpToTheirEdgeAndNowhereElse) {
  ClutterPatches patches = learned(kRain, 20);
  for (const Place& off : {Place(0.0, 0.0), Place(900.0, 0.0), Place(-650.0, 650.0)}) {
    const double ratio = density(patches, kRain.center_m + off, 20) / kRain.per_m2();
    EXPECT_GT(ratio, 0.7);
    EXPECT_LT(ratio, 1.5);
  }
  for (const Place& place : {Place(-2800.0, 2800.0), Place(2800.0, 600.0)})
    EXPECT_EQ(density(patches, place, 20), kOfRange);
}

TEST(ClutterPatches, ArePlotsThatNobodyOwns) {
  ClutterPatches patches = learned(kRain, 20, 0.0);
  EXPECT_EQ(density(patches, kRain.center_m, 20), kOfRange);
}

// All plots of the first scans are free: those of ships at anchor, too.
TEST(ClutterPatches, CountTheFirstScansForLess) {
  double before = kOfRange;
  for (const int scans : {1, 2, 4, 8}) {
    ClutterPatches patches = learned(kRain, scans);
    const double now = density(patches, kRain.center_m, scans);
    EXPECT_GT(now, before);
    before = now;
  }
  ClutterPatches patches = learned(kRain, 1);
  EXPECT_LT(density(patches, kRain.center_m, 1), 3.0 * kOfRange);
  EXPECT_GT(before, 0.5 * kRain.per_m2());
}

TEST(ClutterPatches, LeaveOutTheOwnPlotsOfATarget) {
  const Disk echo{{2000.0, -1500.0}, 1.0, 1};
  ClutterPatches patches = learned(echo, 20);
  LearnedPlots own;
  for (int k = 0; k < 20; ++k) {
    const double time_s = kPeriod * (k + 1);
    patches.remember(scan_of({exact_plot(echo.center_m, time_s)}, time_s), 0, 1.0, own);
  }
  EXPECT_GT(density(patches, echo.center_m, 20), 1.2 * kOfRange);
  EXPECT_NEAR(density(patches, echo.center_m, 20, own) / kOfRange, 1.0, 1e-6);
}

TEST(ClutterPatches, AreTheSameByPartsOfATurn) {
  ClutterPatches turns = learned(kRain, 30), parts = learned(kRain, 30, 1.0, 4);
  EXPECT_NEAR(density(parts, kRain.center_m, 30) / density(turns, kRain.center_m, 30), 1.0, 0.1);
}

/// What is shown from the 40th scan on of a patch that moves and of a boat that begins in it.
struct Shown {
  double false_tracks = 0.0;  ///< a scan
  double boats = 0.0;         ///< share of scans
};

Shown shown(const Disk& rain, const Place& velocity_mps) {
  constexpr int kRuns = 3, kFirst = 40, kScans = 60;
  Shown mean;
  for (int run = 0; run < kRuns; ++run) {
    VesselTracker tracker = make_tracker();
    Sea sea(static_cast<std::uint64_t>(run + 1));
    const Boat boat{rain.center_m + Place(-200.0, 100.0), {4.0, -3.0}};
    for (int k = 0; k < kScans; ++k) {
      const double time_s = kPeriod * (k + 1);
      std::vector<Plot> plots;
      Disk{rain.center_m + time_s * velocity_mps, rain.radius_m, rain.plots}.add(sea.draw, time_s,
                                                                                 plots);
      Disk{{0.0, 0.0}, 6000.0, 20}.add(sea.draw, time_s, plots);
      if (k > 10) plots.push_back(sea.plot(boat.at(time_s), time_s));
      (void)tracker.process(time_s, plots);
      if (k < kFirst) continue;
      constexpr double kShare = 1.0 / (kRuns * (kScans - kFirst));
      bool seen = false;
      tracker.for_each([&](const Track& track) {
        if (!track.active()) return;
        const bool is_boat = (track.position() - boat.at(track.time_s)).norm() < 100.0;
        seen = seen || is_boat;
        if (!is_boat) mean.false_tracks += kShare;
      });
      if (seen) mean.boats += kShare;
    }
  }
  return mean;
}

TEST(ClutterPatches, ShowNoFalseTracksAndKeepTheBoat) {
  const Disk rain{{2000.0, 2000.0}, 600.0, 30};  // 2.7e-5 per m²
  for (const Place& velocity_mps : {Place(0.0, 0.0), Place(-6.0, 8.0)}) {
    const Shown mean = shown(rain, velocity_mps);
    EXPECT_LE(mean.false_tracks, 1.0) << velocity_mps.transpose();
    EXPECT_GE(mean.boats, 0.9) << velocity_mps.transpose();
  }
}

}  // namespace
}  // namespace wakeline::clutter_patches_test
