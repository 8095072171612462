// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Guidance of a vessel along waypoints by its estimated position and heading. Source: Evsyukov,
// Andreeva, Khanychev, "Sensor system information processing in unmanned navigation applications",
// section on the mission, (26).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// How a vessel follows its waypoints.
struct WaypointGuidance {
  double speed_mps = 1.0;
  double turn_rate_rad_s = deg(5.0);
  double accept_m = 10.0;
  double clearance_m = 10.0;

  static constexpr auto fields() noexcept {
    using W = WaypointGuidance;
    return field_table(
        field("speed_mps", &W::speed_mps, kPositive, "m/s",
              "Speed through the water, from which the correction for the current follows."),
        field("turn_rate_rad_s", &W::turn_rate_rad_s, kPositive, "rad/s", "Largest rate of turn."),
        field("accept_m", &W::accept_m, kPositive, "m",
              "A waypoint closer than this is reached. Above the radius of the largest turn, or a "
              "vessel that misses the waypoint may circle around it."),
        field("clearance_m", &W::clearance_m, kNotNegative, "m",
              "Distance that is kept from the edge of an obstacle."));
  }

  void validate() const { validate_fields(*this); }
};

/// A disc to avoid.
struct Obstacle {
  double north_m = 0.0;
  double east_m = 0.0;
  double radius_m = 1.0;

  static constexpr auto fields() noexcept {
    using O = Obstacle;
    return field_table(field("north_m", &O::north_m, kFinite, "m", "North of its centre."),
                       field("east_m", &O::east_m, kFinite, "m", "East of its centre."),
                       field("radius_m", &O::radius_m, kPositive, "m", "Its radius."));
  }

  void validate() const { validate_fields(*this); }
};

/// The command for one step.
struct [[nodiscard]] Steering {
  Status status = Status::kOk;   ///< if not `kOk`, the leg is unchanged and the rate of turn zero
  int leg = 0;                   ///< that is followed; the number of legs after the last waypoint
  double turn_rate_rad_s = 0.0;  ///< for this step, positive to starboard
  double heading_rad = 0.0;      ///< to be steered; the turn leads to it
  double cross_track_m = 0.0;    ///< distance from the line of the leg, positive to starboard
};

/// Leads a vessel along waypoints, around obstacles and against the current. In each step it turns
/// by
///
///     clip(wrap(heading to steer - heading), -w T, w T),    w the largest rate of turn.
///
/// The heading to steer is the bearing of the next waypoint or, where the straight line to it is
/// too close to an obstacle, that of the tangent to the circle of clearance around the nearest such
/// obstacle, corrected for the current c at a speed s through the water so that the course over
/// ground is that bearing β:
///
///     heading = β - arcsin((c_e cos β - c_n sin β) / s),
///
/// as far as s allows. A waypoint is reached once it is closer than `accept_m` (26). The paper's
/// rule of three rates of turn has no dead band and no wrapping; the paper does not correct for the
/// current (give zero for that).
///
/// It holds the route; progress along it is the number of the leg, which the caller keeps, so that
/// one follower serves any number of vessels.
class WaypointFollower {
 public:
  using Point = Vec<double, 2>;  ///< [north, east] m

  /// The route begins at its first point; leg k leads from point k to point k + 1. Throws
  /// `std::invalid_argument` when there are less than two points, or a number is invalid.
  WaypointFollower(const WaypointGuidance& guidance, std::vector<Point> route,
                   std::vector<Obstacle> obstacles = {})
      : guidance_(validated(guidance)), route_(std::move(route)), obstacles_(std::move(obstacles)) {
    require(route_.size() >= 2, "points of the route", "at least 2",
            static_cast<double>(route_.size()));
    for (const Point& point : route_)
      require(in_range(point), "a point of the route", "finite and at most 1e9 m",
              in_range(point[0]) ? point[1] : point[0]);
    for (const Obstacle& obstacle : obstacles_) validate_fields(obstacle);
  }

  [[nodiscard]] const WaypointGuidance& guidance() const noexcept { return guidance_; }
  [[nodiscard]] const std::vector<Point>& route() const noexcept { return route_; }
  [[nodiscard]] const std::vector<Obstacle>& obstacles() const noexcept { return obstacles_; }
  [[nodiscard]] int legs() const noexcept { return static_cast<int>(route_.size()) - 1; }

  /// The command for a step of `dt_s` from the (estimated) position, heading and current, on a leg.
  /// A number that is not `in_range`, or a time step that is not positive, gives its status.
  Steering steer(const Point& position_m, double heading_rad, const Point& current_mps, double dt_s,
                 int leg) const noexcept {
    Steering command{check_time_step(dt_s), std::clamp(leg, 0, legs()), 0.0, heading_rad, 0.0};
    if (!in_range(position_m) || !in_range(heading_rad) || !in_range(current_mps) || dt_s == 0.0)
      command.status = first_failure(command.status, Status::kNotFinite);
    if (command.status != Status::kOk) return command;
    while (command.leg < legs() && (next(command.leg) - position_m).norm() < guidance_.accept_m)
      ++command.leg;
    command.cross_track_m = cross_track_m(position_m, std::min(command.leg, legs() - 1));
    if (command.leg == legs()) return command;
    command.heading_rad = against(current_mps, bearing(position_m, next(command.leg)));
    const double most = guidance_.turn_rate_rad_s * dt_s;
    command.turn_rate_rad_s =
        std::clamp(wrap_angle(command.heading_rad - heading_rad), -most, most) / dt_s;
    return command;
  }

  /// The distance from the line through a leg, positive to starboard of it.
  [[nodiscard]] double cross_track_m(const Point& position_m, int leg) const noexcept {
    const Point from = route_[static_cast<std::size_t>(leg)], off = position_m - from;
    const Point along = (next(leg) - from).normalized();
    return along[0] * off[1] - along[1] * off[0];
  }

 private:
  [[nodiscard]] const Point& next(int leg) const noexcept {
    return route_[static_cast<std::size_t>(leg) + 1];
  }

  static double bearing_of(const Point& offset) noexcept {
    return std::atan2(offset[1], offset[0]);
  }

  /// The bearing of a waypoint, or the tangent past the nearest obstacle in between.
  [[nodiscard]] double bearing(const Point& position_m, const Point& waypoint_m) const noexcept {
    const double direct = bearing_of(waypoint_m - position_m);
    const double reach = (waypoint_m - position_m).norm();
    double nearest = std::numeric_limits<double>::infinity(), result = direct;
    for (const Obstacle& obstacle : obstacles_) {
      const Point to = Point(obstacle.north_m, obstacle.east_m) - position_m;
      const double distance = to.norm(), keep = obstacle.radius_m + guidance_.clearance_m;
      const double off = wrap_angle(direct - bearing_of(to));
      const double along = distance * std::cos(off), across = distance * std::abs(std::sin(off));
      if (along <= 0 || along >= reach || across >= keep || distance >= nearest) continue;
      nearest = distance;
      result = bearing_of(to) + std::copysign(std::asin(std::min(keep / distance, 1.0)), off);
    }
    return result;
  }

  /// The heading whose course over ground in a current is a bearing.
  [[nodiscard]] double against(const Point& current_mps, double bearing_rad) const noexcept {
    const double across =
        current_mps[1] * std::cos(bearing_rad) - current_mps[0] * std::sin(bearing_rad);
    return bearing_rad - std::asin(std::clamp(across / guidance_.speed_mps, -1.0, 1.0));
  }

  WaypointGuidance guidance_;
  std::vector<Point> route_;
  std::vector<Obstacle> obstacles_;
};

}  // namespace wakeline
