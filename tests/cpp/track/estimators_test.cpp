// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A tracker takes any estimator with the face of Imm, and any way to step many of them.
#include "track/scene.hpp"
#include "wakeline/filter/alpha_beta.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/multimodel/adaptive_grid_imm.hpp"
#include "wakeline/multimodel/mode_history.hpp"
#include "wakeline/multimodel/turning_chain.hpp"

namespace wakeline::estimators_test {
namespace {

using Turning = Ekf<CoordinatedTurn>;

const Turning kTurning{CoordinatedTurn{.noise = WhiteAcceleration{0.02}}};

/// Straight on for 20 scans, then a turn of 3 degrees a second to starboard.
Vec<double, 2> turning_boat(int scan) {
  const double speed = 8.0, rate = deg(3.0), time_s = 2.5 * scan, straight_s = 50.0;
  const double turned = rate * std::max(time_s - straight_s, 0.0);
  return {1200.0 + speed / rate * (1 - std::cos(turned)),
          -300.0 + speed * std::min(time_s, straight_s) + speed / rate * std::sin(turned)};
}

template <class Estimator>
void expect_to_hold(const Estimator& prototype) {
  TrackerConfig config;
  config.max_tracks = 8;
  Tracker<Estimator> tracker(test::kTestRadar, config, prototype);
  test::Sea sea(41);
  for (int scan = 0; scan < 60; ++scan) {
    std::vector<Plot> plots{sea.plot(turning_boat(scan), 2.5 * scan)};
    if (scan % 7 == 6) plots.clear();
    plots.push_back(sea.clutter(2.5 * scan, 3000.0));
    (void)tracker.process(2.5 * scan, plots);
  }
  int near = 0;
  tracker.for_each([&](const Track& track) {
    near += track.confirmed() && (track.position() - turning_boat(59)).norm() < 40.0;
  });
  EXPECT_EQ(near, 1);
}

/// A model of one's own, which knows nothing of packs.
struct Drifting {
  static constexpr auto kComponents = kKinematics;

  [[nodiscard]] Mat<double, 4, 4> matrix(double dt_s) const noexcept {
    Mat<double, 4, 4> f = Mat<double, 4, 4>::Identity();
    if (dt_s > 0.0) f(0, 1) = f(2, 3) = dt_s;
    return f;
  }
  [[nodiscard]] Mat<double, 4, 4> process_noise(double dt_s) const noexcept {
    return 0.2 * dt_s * Mat<double, 4, 4>::Identity();
  }
};

TEST(TrackerEstimators, OneOverModelsThatKnowNoPacks) {
  expect_to_hold(
      Imm(ModeChain<2>::from_sojourn_s({60.0, 60.0}), kTurning, Ekf<Drifting>(Drifting{})));
}

TEST(TrackerEstimators, TreeOfModeHistories) {
  const auto grid = TurnRateGrid::evenly(deg(4.0), 4);
  expect_to_hold(ModeHistory<Turning>({}, grid, turning_chain(grid), kTurning));
}

TEST(TrackerEstimators, MovingGrid) {
  expect_to_hold(AdaptiveGridImm(AdaptiveGrid{}, ModeChain<3>::staying(0.9), kTurning));
}

TEST(TrackerEstimators, ACopyContinuesBitForBitWithFiltersThatKeepMoreThanABelief) {
  const Imm prototype(ModeChain<2>::from_sojourn_s({60.0, 60.0}), AlphaBeta<>(GrowingMemory{}),
                      SquareRootUkf<ConstantVelocity>(ConstantVelocity{}));
  using EitherTracker = Tracker<std::remove_const_t<decltype(prototype)>>;
  TrackerConfig config;
  config.max_tracks = 8;
  EitherTracker tracker(test::kTestRadar, config, prototype);
  EitherTracker copy(test::kTestRadar, config, prototype);
  test::Sea sea(43);
  for (int scan = 0; scan < 40; ++scan) {
    const Plot plot = sea.plot(turning_boat(scan), 2.5 * scan);
    if (scan == 10) copy.copy_state_from(tracker);
    (void)tracker.process(2.5 * scan, {&plot, 1});
    if (scan >= 10) (void)copy.process(2.5 * scan, {&plot, 1});
  }
  EXPECT_EQ(tracker.size(), 1);
  EXPECT_TRUE(copy.save() == tracker.save());
}

TEST(TrackerEstimators, TracksInLanesAreThoseOfOneAfterTheOther) {
  TrackerConfig config;
  config.max_tracks = 80;
  const VesselImm prototype = vessel_imm(test::kTestRadar);
  test::VesselTracker in_lanes(test::kTestRadar, config, prototype);
  Tracker<VesselImm, OneByOne<VesselImm>> one_by_one(test::kTestRadar, config, prototype);
  test::Sea sea(42);
  std::vector<test::Boat> boats;
  for (int k = 0; k < 45; ++k)
    boats.push_back({{400.0 * (k % 7) - 1200.0, 350.0 * int(k / 7) + 500.0},
                     {sea.draw.uniform(-8.0, 8.0), sea.draw.uniform(-8.0, 8.0)}});
  for (int scan = 0; scan < 40; ++scan) {
    const double start_s = 2.5 * scan;
    std::vector<Plot> plots;
    for (const test::Boat& boat : boats)
      if (sea.draw.uniform(0.0, 1.0) < 0.9) plots.push_back(sea.swept(boat, start_s));
    for (int k = 0; k < 10; ++k) plots.push_back(sea.clutter(start_s, 3000.0));
    (void)in_lanes.process(start_s + 2.5, plots);
    (void)one_by_one.process(start_s + 2.5, plots);
  }
  ASSERT_GT(in_lanes.size(), 40);
  ASSERT_EQ(in_lanes.size(), one_by_one.size());
  in_lanes.for_each([&](const Track& track) {
    const Track* other = one_by_one.find(track.id);
    ASSERT_NE(other, nullptr) << track.id;
    EXPECT_EQ(track.status, other->status);
    EXPECT_EQ(track.time_s, other->time_s);
    EXPECT_EQ(track.hits, other->hits);
    EXPECT_NEAR(track.existence, other->existence, 1e-9);
    EXPECT_LT((track.kinematics.mean - other->kinematics.mean).norm(), 1e-6);
    EXPECT_TRUE(track.kinematics.covariance.isApprox(other->kinematics.covariance, 1e-8));
  });
}

}  // namespace
}  // namespace wakeline::estimators_test
