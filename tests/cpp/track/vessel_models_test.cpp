// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the motion models of a tracker are for: small craft nearby, and ships miles away.
#include "track/scene.hpp"

namespace wakeline::vessel_models_test {
namespace {

using namespace test;

constexpr double kScan_s = 2.5;

/// A radar that knows less of a ship miles away than of a boat nearby.
const Radar kCoarse{.range_std_m = 23.0,
                    .bearing_std_rad = deg(0.2),
                    .extent_std_m = 20.0,
                    .period_s = kScan_s,
                    .max_speed_mps = 30.0};

VesselTracker tracker_of(const VesselModels& models) {
  return VesselTracker(kCoarse, {}, vessel_imm(kCoarse, models));
}

Vec<double, 2> velocity_of(const Track& track) {
  return {track.kinematics.mean[1], track.kinematics.mean[3]};
}

/// A ship on her course, which turns to starboard by 0.75 degrees a second for a minute from a time
/// on.
struct Ship {
  Vec<double, 2> start_m{11000.0, 9000.0};
  double speed_mps = 8.0;
  double turn_from_s = 1e9;

  [[nodiscard]] double course_rad(double time_s) const {
    return deg(200.0 + 0.75 * std::clamp(time_s - turn_from_s, 0.0, 60.0));
  }
  [[nodiscard]] Vec<double, 2> velocity_mps(double time_s) const {
    return speed_mps * Vec<double, 2>(std::cos(course_rad(time_s)), std::sin(course_rad(time_s)));
  }
  [[nodiscard]] Vec<double, 2> at(double time_s) const {
    constexpr double kStep_s = 0.5;
    Vec<double, 2> place_m = start_m;
    for (double t = 0.0; t < time_s; t += kStep_s)
      place_m += kStep_s * velocity_mps(t + 0.5 * kStep_s);
    return place_m;
  }
};

/// Follows a ship for so many scans; calls `see(time_s, track)` after each of them, the track null
/// where there is none near her.
template <class See>
void follow(VesselTracker& tracker, const Ship& ship, std::uint64_t seed, int scans, See&& see) {
  Sea sea(seed, kCoarse);
  for (int k = 0; k < scans; ++k) {
    const double time_s = kScan_s * k;
    const Plot plot = sea.plot(ship.at(time_s), time_s);
    ASSERT_EQ(tracker.process(time_s, {&plot, 1}).status, Status::kOk);
    see(time_s, track_at(tracker, ship.at(time_s), 500.0));
  }
}

/// Root mean square error of the velocity a minute after the first plot, over many runs.
double velocity_error_after_a_minute(const VesselModels& models) {
  constexpr int kRuns = 60;
  const Ship ship;
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    VesselTracker tracker = tracker_of(models);
    follow(tracker, ship, seed, 25, [&](double time_s, const Track* track) {
      if (time_s < 60.0) return;
      ASSERT_NE(track, nullptr) << "seed " << seed;
      sum += (velocity_of(*track) - ship.velocity_mps(time_s)).squaredNorm();
    });
  }
  return std::sqrt(sum / kRuns);
}

TEST(VesselModels, KnowTheVelocityOfAShipMilesAwayWithinAMinute) {
  const VesselModels craft{.cruising_probability = 0.0, .settling_s = 1e9};
  const double of_craft_mps = velocity_error_after_a_minute(craft);
  EXPECT_LT(velocity_error_after_a_minute({}), 0.65 * of_craft_mps);
  EXPECT_LT(velocity_error_after_a_minute(VesselModels::ships()), 0.6 * of_craft_mps);
}

TEST(VesselModels, TakeForAShipWhatCruisesAndForCraftWhatMovesLikeIt) {
  const auto cruising = [](double turn_from_s) {
    const Ship ship{.turn_from_s = turn_from_s};
    double probability = 0.0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      VesselTracker tracker = tracker_of({});
      follow(tracker, ship, seed, 74, [&](double time_s, const Track* track) {
        if (time_s < 180.0) return;
        ASSERT_NE(track, nullptr) << "seed " << seed;
        probability += tracker.estimator_of(*track).mode_probability()[0] / 30;
      });
    }
    return probability;
  };
  EXPECT_GT(cruising(1e9), 0.5);
  EXPECT_LT(cruising(120.0), 0.2);
}

TEST(VesselModels, LeaveAndSettleAsOftenAsTold) {
  const VesselModels models;
  const double step_s = 1e-3;
  const auto chance = models.chain().transition(step_s);
  EXPECT_NEAR(1.0 - chance(0, 0), step_s / models.cruising_sojourn_s, 1e-9);
  EXPECT_NEAR(chance(1, 0), step_s / models.settling_s, 1e-9);
  EXPECT_NEAR(chance(1, 2) + chance(1, 3), step_s / models.steady_sojourn_s, 1e-9);
  EXPECT_NEAR(1.0 - chance(2, 2), step_s / models.restless_sojourn_s, 1e-9);
  EXPECT_NEAR(1.0 - chance(3, 3), step_s / models.turning_sojourn_s, 1e-9);
  EXPECT_LT(chance(2, 0) + chance(3, 0), 1e-9) << "only a steady vessel is taken to cruise";
  for (const int agile : {4, 5, 6})
    EXPECT_NEAR(chance.row(agile).segment(1, 3).sum(), step_s / models.agile_time_s, 1e-9);
  EXPECT_NEAR(chance(4, 5) + chance(4, 6), step_s / models.weaving_sojourn_s, 1e-7);
  EXPECT_NEAR(chance(5, 4), step_s / models.agile_turn_sojourn_s, 1e-7);
  EXPECT_DOUBLE_EQ(chance(6, 4), chance(5, 4));
  EXPECT_DOUBLE_EQ(models.initial_mode_probability().sum(), 1.0);
}

/// A boat that goes straight for 25 s and turns for 12.5 s, to either side in turn, at 6 degrees a
/// second.
Vec<double, 2> weaving_velocity_mps(double time_s) {
  constexpr double kLeg_s = 25.0, kTurn_s = 12.5, kSpeed_mps = 15.0;
  const double leg = std::floor(time_s / (kLeg_s + kTurn_s));
  const double turning_s = std::max(time_s - leg * (kLeg_s + kTurn_s) - kLeg_s, 0.0);
  const bool to_port = std::fmod(leg, 2.0) == 1.0;
  const double course_rad = deg(6.0) * (to_port ? kTurn_s - turning_s : turning_s);
  return kSpeed_mps * Vec<double, 2>(std::cos(course_rad), std::sin(course_rad));
}

TEST(VesselModels, ExpectACraftThatWeavesToTurnAgain) {
  const auto error_m = [](const VesselModels& models, double& agile) {
    constexpr double kStep_s = 0.1, kFrom_s = 100.0;
    constexpr int kScans = 100;
    double squared = 0.0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      Sea sea(seed, kCoarse);
      VesselTracker tracker = tracker_of(models);
      Vec<double, 2> place_m(3000.0, 2000.0);
      double time_s = 0.0;
      for (int k = 0; k < kScans; ++k) {
        for (; time_s < kScan_s * k - kStep_s / 2; time_s += kStep_s)
          place_m += kStep_s * weaving_velocity_mps(time_s + kStep_s / 2);
        const Plot plot = sea.plot(place_m, kScan_s * k);
        EXPECT_EQ(tracker.process(kScan_s * k, {&plot, 1}).status, Status::kOk);
        const Track* track = track_at(tracker, place_m, 500.0);
        if (time_s < kFrom_s || track == nullptr) continue;
        ++count;
        squared += (track->position() - place_m).squaredNorm();
        agile += tracker.estimator_of(*track).mode_probability().tail<3>().sum();
      }
    }
    agile /= count;
    return std::sqrt(squared / count);
  };
  double agile = 0.0, none = 0.0;
  const double with_m = error_m({}, agile), without_m = error_m({.agile_probability = 0.0}, none);
  EXPECT_LT(with_m, 0.9 * without_m);
  EXPECT_GT(agile, 0.8);
  EXPECT_EQ(none, 0.0);
}

TEST(VesselModelsOfShips, HoldAShipThatAltersHerCourse) {
  const Ship ship{.turn_from_s = 120.0};
  double squared = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    VesselTracker tracker = tracker_of(VesselModels::ships());
    follow(tracker, ship, seed, 144, [&](double time_s, const Track* track) {
      if (time_s < 30.0) return;
      ASSERT_NE(track, nullptr) << "seed " << seed << ", " << time_s << " s";
      EXPECT_EQ(track->id, 1);
      if (time_s >= 355.0)
        squared += (velocity_of(*track) - ship.velocity_mps(time_s)).squaredNorm() / (20 * 2);
    });
  }
  EXPECT_LT(std::sqrt(squared), 1.0) << "three minutes after the turn";
}

TEST(VesselModels, AVesselAtAnchorStaysAtRestForHours) {
  constexpr int kScans = 3000;
  for (const double period_s : {1.0, 2.5, 6.0}) {
    Radar radar = kTestRadar;
    radar.period_s = period_s;
    Sea sea(1, radar);
    VesselTracker tracker = make_tracker({}, radar);
    double squared = 0.0;
    for (int k = 1; k <= kScans; ++k) {
      const double time_s = period_s * k;
      std::vector<Plot> plots;
      if (sea.draw.uniform(0, 1) < 0.9) plots.push_back(sea.plot({1500.0, 300.0}, time_s));
      ASSERT_EQ(tracker.process(time_s, plots).status, Status::kOk);
      if (k < 30) continue;
      const Track* track = tracker.find(1);
      ASSERT_NE(track, nullptr) << period_s << " s, scan " << k;
      squared += track->velocity().squaredNorm() / kScans;
    }
    EXPECT_LT(std::sqrt(squared), 0.5) << period_s << " s";
  }
}

TEST(VesselModels, BelieveInNoVesselThatGoesFullCircleBetweenTwoScans) {
  const RangeBearing sensor{.range_std_m = 60.0, .bearing_std_rad = deg(0.5)};
  const Boat boat{{6000.0, 3000.0}, {-3.0, 4.0}};
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Draw draw(seed);
    VesselImm imm = vessel_imm(Radar{});
    const auto read = [&](double time_s) -> Vec<double, 2> {
      const Plot plot = exact_plot(boat.at(time_s), time_s);
      return {plot.range_m + 60.0 * draw.normal(), plot.bearing_rad + deg(0.5) * draw.normal()};
    };
    const Gaussian<4> start = one_point(sensor, read(0.0), 10.0);
    ASSERT_EQ(imm.start(start), Status::kOk);
    for (int k = 1; k <= 100; ++k) {
      ASSERT_EQ(imm.predict(3.0), Status::kOk);
      ASSERT_EQ(imm.update(sensor, read(3.0 * k)).status, Status::kOk);
      const Vec<double, 4> mean = imm.estimate().mean;
      ASSERT_LT(std::hypot(mean[1], mean[3]), 60.0) << "seed " << seed << ", scan " << k;
    }
  }
}

}  // namespace
}  // namespace wakeline::vessel_models_test
