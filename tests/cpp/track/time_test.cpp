// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A rotating antenna: each plot has its own time within the scan.
#include <functional>

#include "track/scene.hpp"

namespace wakeline::time_test {
namespace {

using namespace test;

/// Position RMSE of confirmed tracks against boats that pass on all sides, each at the time of its
/// track's estimate. `see` gives the plot of a boat in the scan that begins at a time.
double rmse(const std::function<Plot(Sea&, const Boat&, double)>& see) {
  double sum = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Sea sea(seed);
    VesselTracker tracker = make_tracker();
    std::vector<Boat> boats;
    for (int k = 0; k < 6; ++k) {
      const double side = deg(60.0 * k + 5.0 * static_cast<double>(seed));
      const Vec<double, 2> out = towards(side), along(-out[1], out[0]);
      boats.push_back({600.0 * out - 700.0 * along, 20.0 * along});
    }
    for (int k = 0; k < 28; ++k) {
      const double start_s = 2.5 * k;
      std::vector<Plot> plots;
      for (const Boat& boat : boats) plots.push_back(see(sea, boat, start_s));
      (void)tracker.process(start_s + 2.5, plots);
      if (k < 10) continue;
      for (const Track* track : tracks_of(tracker, true)) {
        double least = 1e4;
        for (const Boat& boat : boats)
          least = std::min(least, (track->position() - boat.at(track->time_s)).squaredNorm());
        sum += least;
        ++count;
      }
    }
  }
  EXPECT_GE(count, 12 * 6 * 17);
  return std::sqrt(sum / count);
}

TEST(RotatingAntenna, IsAsAccurateAsOneThatSeesAllAtOnce) {
  const double rotating =
      rmse([](Sea& sea, const Boat& boat, double start_s) { return sea.swept(boat, start_s); });
  const double at_once = rmse([](Sea& sea, const Boat& boat, double start_s) {
    return sea.plot(boat.at(start_s + 2.5), start_s + 2.5);
  });
  const double pretended = rmse([](Sea& sea, const Boat& boat, double start_s) {
    Plot plot = sea.swept(boat, start_s);
    plot.time_s = start_s + 2.5;
    return plot;
  });
  EXPECT_NEAR(rotating / at_once, 1.0, 0.06) << rotating << " m, " << at_once << " m";
  EXPECT_GT(pretended, 1.5 * rotating) << pretended << " m";
}

TEST(RotatingAntenna, TheEstimateIsOfThePlotsTime) {
  Sea sea(1);
  VesselTracker tracker = make_tracker();
  const Boat boat{{-500.0, -500.0}, {0.0, 10.0}};
  for (int k = 0; k < 20; ++k) {
    const Plot plot = sea.swept(boat, 2.5 * k);
    (void)tracker.process(2.5 * (k + 1), {&plot, 1});
    if (k < 2) continue;
    EXPECT_EQ(tracks_of(tracker, false).at(0)->time_s, plot.time_s);
  }
  const Track& track = *tracker.find(1);
  const Gaussian<4> later = tracker.kinematics_at(track, track.time_s + 10.0);
  EXPECT_NEAR(later.mean[0], track.kinematics.mean[0] + 10.0 * track.kinematics.mean[1], 5.0);
  EXPECT_NEAR(later.mean[2], track.kinematics.mean[2] + 10.0 * track.kinematics.mean[3], 5.0);
  EXPECT_GT(later.covariance(0, 0), track.kinematics.covariance(0, 0));
  EXPECT_TRUE(is_covariance(later.covariance));
  EXPECT_EQ(tracker.kinematics_at(track, track.time_s).mean, track.kinematics.mean);
  const Gaussian<4> back = tracker.kinematics_at(track, track.time_s - 1.0);
  EXPECT_NEAR(back.mean[0], track.kinematics.mean[0] - track.kinematics.mean[1], 1e-9);
  EXPECT_NEAR(back.mean[2], track.kinematics.mean[2] - track.kinematics.mean[3], 1e-9);
}

TEST(RotatingAntenna, AllTracksAreKnownAtTheTimeOfTheScan) {
  VesselTracker tracker = make_tracker();
  const std::vector<Boat> boats{{{1000.0, 0.0}, {15.0, 0.0}}, {{-1500.0, 300.0}, {0.0, 8.0}}};
  for (int k = 0; k < 20; ++k) {
    std::vector<Plot> plots;
    for (std::size_t n = 0; n < boats.size(); ++n) {
      const double seen_s = 2.5 * k + 0.5 * static_cast<double>(n);
      plots.push_back(exact_plot(boats[n].at(seen_s), seen_s));
    }
    (void)tracker.process(2.5 * k + 2.4, plots);
  }
  ASSERT_EQ(tracks_of(tracker, true).size(), 2u);
  for (const Track* track : tracks_of(tracker, true)) {
    const Gaussian<4> now = tracker.kinematics_at(*track, tracker.time_s());
    const Boat& boat = boats[track->position()[0] > 0.0 ? 0 : 1];
    EXPECT_LT((Vec<double, 2>(now.mean[0], now.mean[2]) - boat.at(tracker.time_s())).norm(), 3.0);
    EXPECT_GT((track->position() - boat.at(tracker.time_s())).norm(), 10.0);
  }
}

/// Error of the position of a boat in a steady turn, m, each of whose plots comes again so much
/// later; never where that is 0.
double rmse_with_plots_that_come_again(double late_s) {
  constexpr double kRate_rad_s = 0.05, kRadius_m = 160.0;
  const auto at = [&](double time_s) -> Vec<double, 2> {
    const double angle = kRate_rad_s * time_s;
    return {2000.0 + kRadius_m * std::cos(angle), 500.0 + kRadius_m * std::sin(angle)};
  };
  double squared = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Sea sea(seed), again(seed + 1000);
    VesselTracker tracker = make_tracker();
    for (int k = 0; k < 200; ++k) {
      const double time_s = 2.5 * k;
      std::vector<Plot> plots{sea.plot(at(time_s), time_s)};
      if (late_s > 0.0) plots.push_back(again.plot(at(time_s - late_s), time_s - late_s));
      (void)tracker.process(time_s, plots);
      const Track* track = track_at(tracker, at(time_s), 300.0);
      if (k < 20 || track == nullptr) continue;
      squared += (track->position() - at(track->time_s)).squaredNorm();
      ++count;
    }
  }
  EXPECT_GT(count, 1750);
  return std::sqrt(squared / count);
}

TEST(LatePlots, AreBelievedAsFarAsTheVelocityIsKnown) {
  const double without = rmse_with_plots_that_come_again(0.0);
  for (const double late_s : {2.5, 10.0, 20.0})
    EXPECT_LT(rmse_with_plots_that_come_again(late_s), 1.45 * without) << late_s << " s";
}

TEST(BearingOffset, IsTakenOut) {
  Radar skewed = kTestRadar;
  skewed.bearing_offset_rad = deg(2.0);
  VesselTracker straight = make_tracker(), corrected = make_tracker({}, skewed);
  Sea sea(9);
  const Boat boat{{1500.0, 800.0}, {-4.0, 6.0}};
  for (int k = 0; k < 30; ++k) {
    const double time_s = 2.5 * k;
    Plot plot = sea.plot(boat.at(time_s), time_s);
    (void)straight.process(time_s, {&plot, 1});
    plot.bearing_rad += deg(2.0);
    (void)corrected.process(time_s, {&plot, 1});
  }
  ASSERT_NE(straight.find(1), nullptr);
  ASSERT_NE(corrected.find(1), nullptr);
  EXPECT_LT((straight.find(1)->kinematics.mean - corrected.find(1)->kinematics.mean).norm(), 1e-6);
}

TEST(MovingOwnShip, MakesNoDifference) {
  VesselTracker at_rest = make_tracker(), moving = make_tracker();
  const Boat boat{{1500.0, 800.0}, {-4.0, 6.0}};
  for (int k = 0; k < 30; ++k) {
    const double time_s = 2.5 * k;
    const Plot plot = exact_plot(boat.at(time_s), time_s);
    (void)at_rest.process(time_s, {&plot, 1});
    const Vec<double, 2> own(8.0 * time_s, -3.0 * time_s);
    Plot relative = exact_plot(boat.at(time_s) - own, time_s);
    relative.own = {.north_m = own[0], .east_m = own[1]};
    (void)moving.process(time_s, {&relative, 1});
  }
  ASSERT_NE(at_rest.find(1), nullptr);
  ASSERT_NE(moving.find(1), nullptr);
  EXPECT_LT((at_rest.find(1)->position() - moving.find(1)->position()).norm(), 1.0);
}

}  // namespace
}  // namespace wakeline::time_test
