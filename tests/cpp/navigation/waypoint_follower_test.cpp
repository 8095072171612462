// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/waypoint_follower.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"

namespace wakeline::waypoint_follower_test {
namespace {

using test::Draw;
using Point = WaypointFollower::Point;

const Point kStill = Point::Zero();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Voyage {
  bool arrived = false;
  double largest_turn = 0.0;
  double cross_track_rms_m = 0.0;
  double nearest_obstacle_m = std::numeric_limits<double>::infinity();  ///< from its edge
};

/// A vessel that turns as commanded, in a current that it knows, or does not.
Voyage sail(const WaypointFollower& follower, const Point& current, bool knows_current,
            double heading, double dt_s = 1.0) {
  Voyage voyage;
  Point position = follower.route().front();
  int leg = 0, steps = 0;
  double squares = 0.0;
  for (; steps < 20'000 && !voyage.arrived; ++steps) {
    const Steering command =
        follower.steer(position, heading, knows_current ? current : kStill, dt_s, leg);
    EXPECT_EQ(command.status, Status::kOk);
    EXPECT_GE(command.leg, leg);
    leg = command.leg;
    voyage.arrived = leg == follower.legs();
    voyage.largest_turn = std::max(voyage.largest_turn, std::abs(command.turn_rate_rad_s));
    squares += command.cross_track_m * command.cross_track_m;
    const double speed = follower.guidance().speed_mps;
    heading = wrap_angle(heading + dt_s * command.turn_rate_rad_s);
    position += dt_s * (speed * Point(std::cos(heading), std::sin(heading)) + current);
    for (const Obstacle& obstacle : follower.obstacles())
      voyage.nearest_obstacle_m = std::min(
          voyage.nearest_obstacle_m,
          (position - Point(obstacle.north_m, obstacle.east_m)).norm() - obstacle.radius_m);
  }
  voyage.cross_track_rms_m = std::sqrt(squares / steps);
  return voyage;
}

TEST(WaypointFollower, KeepsToTheLineInStillWater) {
  const WaypointFollower follower({}, {{0, 0}, {300, 400}});
  const Voyage voyage = sail(follower, kStill, true, std::atan2(400, 300));
  EXPECT_TRUE(voyage.arrived);
  EXPECT_LT(voyage.cross_track_rms_m, 1e-9);
}

TEST(WaypointFollower, CorrectsForAKnownCurrent) {
  Draw draw(1);
  for (int k = 0; k < 50; ++k) {
    const WaypointFollower follower({}, {{0, 0}, {300, 400}});
    const double set = draw.uniform(0, 2 * kPi<double>), drift = draw.uniform(0.2, 0.7);
    const Point current = drift * Point(std::cos(set), std::sin(set));
    const double across = std::abs(0.6 * current[1] - 0.8 * current[0]);
    if (across < 0.1) continue;
    const double along_leg = std::atan2(400, 300);
    const Voyage with = sail(follower, current, true, along_leg);
    const Voyage without = sail(follower, current, false, along_leg);
    EXPECT_TRUE(with.arrived);
    EXPECT_LT(with.cross_track_rms_m, 2.0);  // of the turn into the current
    EXPECT_GT(without.cross_track_rms_m, 3 * with.cross_track_rms_m);
  }
}

TEST(WaypointFollower, PassesObstaclesAtTheirClearance) {
  const WaypointFollower follower({.clearance_m = 10}, {{0, 0}, {0, 400}},
                                  {{3, 150, 20}, {-5, 300, 15}});
  for (const double heading : {0.0, kPi<double> / 2}) {
    const Voyage voyage = sail(follower, kStill, true, heading);
    EXPECT_TRUE(voyage.arrived);
    EXPECT_GT(voyage.nearest_obstacle_m, 9.0);
    EXPECT_LT(voyage.nearest_obstacle_m, 12.0);
  }
}

TEST(WaypointFollower, NeverTurnsFasterThanItCan) {
  Draw draw(2);
  for (int k = 0; k < 50; ++k) {
    const double dt_s = draw.uniform(0.05, 2.0), limit = draw.uniform(0.05, 0.5);
    const WaypointGuidance guidance{.turn_rate_rad_s = limit, .accept_m = 1.2 / limit + 3};
    const WaypointFollower follower(guidance,
                                    {{0, 0}, 200 * draw.normals<2>(), 200 * draw.normals<2>()});
    const Voyage voyage = sail(follower, kStill, true, draw.uniform(-3, 3), dt_s);
    EXPECT_TRUE(voyage.arrived);
    EXPECT_LE(voyage.largest_turn, limit * (1 + 1e-12));
  }
}

TEST(WaypointFollower, TurnsTheShorterWay) {
  const WaypointFollower follower({}, {{0, 0}, {-100, 1}});  // just east of south
  EXPECT_GT(follower.steer({0, 0}, deg(170), kStill, 1, 0).turn_rate_rad_s, 0);
  EXPECT_LT(follower.steer({0, 0}, deg(-170), kStill, 1, 0).turn_rate_rad_s, 0);
}

TEST(WaypointFollower, ReportsTheSideOfItsLine) {
  const WaypointFollower follower({}, {{0, 0}, {100, 0}});  // to the north: east is to starboard
  EXPECT_DOUBLE_EQ(follower.steer({20, 7}, 0, kStill, 1, 0).cross_track_m, 7);
  EXPECT_DOUBLE_EQ(follower.steer({20, -7}, 0, kStill, 1, 0).cross_track_m, -7);
}

TEST(WaypointFollower, PointsUpIntoACurrentThatIsTooStrong) {
  const WaypointFollower follower({}, {{0, 0}, {100, 0}});
  EXPECT_DOUBLE_EQ(follower.steer({0, 0}, 0, {0, 5}, 1, 0).heading_rad, -kPi<double> / 2);
}

TEST(WaypointFollower, KeepsTheLegWhereAnInputIsMissing) {
  const WaypointFollower follower({}, {{0, 0}, {100, 0}, {100, 100}});
  for (const Steering& command :
       {follower.steer({kNaN, 0}, 0, kStill, 1, 1), follower.steer({0, 0}, kNaN, kStill, 1, 1),
        follower.steer({0, 0}, 0, {0, kNaN}, 1, 1), follower.steer({0, 0}, 0, kStill, 0, 1),
        follower.steer({0, 0}, 0, kStill, -1, 1)}) {
    EXPECT_NE(command.status, Status::kOk);
    EXPECT_EQ(command.leg, 1);
    EXPECT_EQ(command.turn_rate_rad_s, 0);
  }
}

TEST(WaypointFollower, RejectsARouteThatIsNone) {
  EXPECT_THROW(WaypointFollower({}, {{0, 0}}), std::invalid_argument);
  EXPECT_THROW(WaypointFollower({}, {{0, 0}, {0, kNaN}}), std::invalid_argument);
  EXPECT_THROW(WaypointFollower({}, {{0, 0}, {0, 1}}, {{0, 0, -1}}), std::invalid_argument);
  EXPECT_THROW(WaypointFollower({.speed_mps = 0}, {{0, 0}, {0, 1}}), std::invalid_argument);
}

TEST(WaypointFollower, SteersWithoutTheHeap) {
  const WaypointFollower follower({}, {{0, 0}, {100, 0}}, {{50, 1, 5}});
  const test::NoHeap fence;
  const Steering command = follower.steer({0, 0}, 0.1, {0.1, 0.2}, 1, 0);
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_EQ(command.status, Status::kOk);
}

}  // namespace
}  // namespace wakeline::waypoint_follower_test
