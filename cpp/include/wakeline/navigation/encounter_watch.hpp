// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Danger between any two of many vessels: which pairs come close, and one alarm for each encounter.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/navigation/closest_approach.hpp"
#include "wakeline/navigation/danger_limits.hpp"

namespace wakeline {

inline constexpr std::int64_t kOwnShip = 0;  ///< the number of own ship among watched vessels

/// A vessel at the time of an update: a track, own ship, or a vessel known by its reports.
struct WatchedVessel {
  std::int64_t id = kOwnShip;   ///< tracks have others
  Gaussian<4> kinematics = {};  ///< `[x, vx, y, vy]`
};

/// Own ship as a vessel with the velocity error of the limits. Its position has no error: plots are
/// measured from there, so that an error moves all tracks with it.
inline WatchedVessel own_vessel(const Vec<double, 4>& state, const DangerLimits& limits) noexcept {
  WatchedVessel own{kOwnShip, {state, Mat<double, 4, 4>::Zero()}};
  const double std_mps = limits.own_velocity_std_mps;
  own.kinematics.covariance(1, 1) = own.kinematics.covariance(3, 3) = std_mps * std_mps;
  return own;
}

/// The closest approach of two vessels.
struct Approach {
  std::int64_t first = 0, second = 0;  ///< the vessels, the smaller number first
  int zone = -1;                       ///< the zone whose limits apply; -1: the general ones
  double range_m = 0.0;
  double signed_cpa_m = 0.0;  ///< positive where they pass port to port
  double tcpa_s = 0.0;        ///< negative when past
  Mat<double, 2, 2> covariance = Mat<double, 2, 2>::Zero();  ///< of [signed_cpa_m, tcpa_s]
  double probability = 0.0;  ///< to come closer than the limit within the time limit
  Vec<double, 2> first_at_cpa_m = Vec<double, 2>::Zero();  ///< [north, east] at the closest point
  Vec<double, 2> second_at_cpa_m = Vec<double, 2>::Zero();

  [[nodiscard]] double cpa_m() const noexcept { return std::abs(signed_cpa_m); }

  void archive(Archive& fields) {
    fields(first);
    fields(second);
    fields(zone);
    fields(range_m);
    fields(signed_cpa_m);
    fields(tcpa_s);
    fields(covariance);
    fields(probability);
    fields(first_at_cpa_m);
    fields(second_at_cpa_m);
  }
};

/// A dangerous encounter of two vessels, from the first danger until it is over.
struct Encounter {
  std::int64_t id = 0;         ///< positive; never used again
  bool acknowledged = false;   ///< by the operator
  double begin_s = 0.0;        ///< first update with danger
  double last_s = 0.0;         ///< last update with danger
  double over_s = 0.0;         ///< update since which the danger is over; NaN while it is not
  double time_s = 0.0;         ///< last update that had both vessels
  Approach approach = {};      ///< at that time
  double least_range_m = 0.0;  ///< of all updates so far
  double least_range_s = 0.0;  ///< its time

  [[nodiscard]] bool dangerous() const noexcept { return std::isnan(over_s); }

  void archive(Archive& fields) {
    fields(id);
    fields(acknowledged);
    for (double* value : {&begin_s, &last_s, &over_s, &time_s, &least_range_m, &least_range_s})
      fields(*value);
    approach.archive(fields);
  }
};

/// Whether an encounter has become dangerous or is over.
enum class EncounterChange : std::uint8_t { kBegan, kEnded };

/// The beginning or the end of an encounter, and the encounter as it was then.
struct EncounterEvent {
  EncounterChange change;
  Encounter encounter;
};

/// The result of an update. The spans are valid until the next one.
struct EncounterReport {
  Status status = Status::kOk;
  std::span<const EncounterEvent> events;
  std::span<const Approach> approaches;  ///< all that can matter, dangerous or not
  int unwatched_vessels = 0;             ///< not finite, or beyond `max_vessels`
  int left_out = 0;  ///< approaches and encounters without room; a larger `max_vessels` helps
};

/// Finds the pairs of vessels that come dangerously close to each other, and follows each encounter
/// from its beginning to its end.
///
/// An approach can matter when
///
/// - the closest point is ahead, within the time limit;
/// - the probability of coming closer than the limit is at least `kLeastProbability`;
/// - the vessels move relative to each other, by three standard deviations;
/// - one of them is under way, its speed above `rest_speed_mps` by two standard deviations: moored,
///   berthed and anchored vessels are silent among themselves;
/// - neither is own ship with the other closer than `own_length_m`.
///
/// An encounter begins when such an approach has `alarm_probability`. While it lasts, a smaller
/// `clear_probability`, any relative motion and any time ahead keep it (`DangerLimits`). Limits are
/// those of the first zone that contains the middle between the vessels at their closest point,
/// else the general ones; an encounter keeps its limits.
///
/// Boxes about the ways of the vessels, sorted from west to east, leave few of the n² pairs. A pair
/// is left out only where no errors of position and velocity below k standard deviations bring the
/// vessels to the limit, k² = 2 ln(2 / P): by the Rayleigh distribution both are below with 1 - P,
/// P = `kLeastProbability`. All memory is taken by the constructor; `update` neither allocates nor
/// throws.
class EncounterWatch {
 public:
  static constexpr double kLeastProbability = 0.01;
  static constexpr int kPairsPerVessel = 20;  ///< room for approaches and encounters

  /// Throws `std::invalid_argument` for limits out of range and zones that are no polygons.
  explicit EncounterWatch(const DangerLimits& limits = {}, std::vector<DangerZone> zones = {},
                          int max_vessels = 1000)
      : limits_(validated(limits)),
        zones_(std::move(zones)),
        max_vessels_(room_for(max_vessels)),
        widest_(limits) {
    for (const DangerZone& zone : zones_) {
      const DangerLimits& own = validated(zone).limits;
      widest_.cpa_limit_m = std::max(widest_.cpa_limit_m, own.cpa_limit_m);
      widest_.tcpa_limit_s = std::max(widest_.tcpa_limit_s, own.tcpa_limit_s);
      widest_.rest_speed_mps = std::min(widest_.rest_speed_mps, own.rest_speed_mps);
    }
    const auto vessels = static_cast<std::size_t>(max_vessels), pairs = kPairsPerVessel * vessels;
    bodies_.reserve(vessels);
    by_id_.reserve(vessels);
    approaching_.resize(vessels);
    approaches_.reserve(pairs);
    encounters_.reserve(pairs);
    followed_.reserve(pairs);
    events_.reserve(2 * pairs);
  }

  EncounterWatch(EncounterWatch&&) noexcept = default;
  EncounterWatch& operator=(EncounterWatch&&) noexcept = default;

  /// Takes all vessels at a time, each with a different number. Rejects one that is before the last
  /// one.
  EncounterReport update(double time_s, std::span<const WatchedVessel> vessels) noexcept {
    EncounterReport report;
    approaches_.clear();
    events_.clear();
    report.status = !std::isfinite(time_s) ? Status::kNotFinite
                    : time_s < time_s_     ? Status::kNegativeTimeStep
                                           : Status::kOk;
    if (report.status != Status::kOk) return report;
    time_s_ = time_s;
    left_out_ = 0;
    followed_.assign(encounters_.size(), 0);
    report.unwatched_vessels = enter(vessels);
    for_each_close_pair([this](const Body& a, const Body& b) { assess(a, b); });
    follow_the_others();
    number_new();
    end_those_over();
    report.events = events_;
    report.approaches = approaches_;
    report.left_out = left_out_;
    return report;
  }

  /// The encounters that have not ended, in the order of their vessels' numbers.
  [[nodiscard]] std::span<const Encounter> encounters() const noexcept { return encounters_; }

  /// Marks an encounter as known to the operator; false when none has that number.
  bool acknowledge(std::int64_t id) noexcept {
    const auto found = std::find_if(encounters_.begin(), encounters_.end(),
                                    [&](const Encounter& one) { return one.id == id; });
    if (found != encounters_.end()) found->acknowledged = true;
    return found != encounters_.end();
  }

  [[nodiscard]] const DangerLimits& limits() const noexcept { return limits_; }
  [[nodiscard]] const std::vector<DangerZone>& zones() const noexcept { return zones_; }
  [[nodiscard]] int max_vessels() const noexcept { return max_vessels_; }

  /// The limits of an approach.
  [[nodiscard]] const DangerLimits& limits_of(int zone) const noexcept {
    return zone < 0 ? limits_ : zones_[static_cast<std::size_t>(zone)].limits;
  }

  /// The whole state, to be restored by a watch with the same limits, zones and room.
  [[nodiscard]] std::vector<std::byte> save() const {
    Archive fields;
    const_cast<EncounterWatch*>(this)->archive(fields);  // writing changes nothing
    std::uint64_t sum = checksum(fields.bytes());
    fields(sum);
    return fields.bytes();
  }

  /// Continues from the saved watch. False, and nothing changed, when the bytes are not the state
  /// of a watch with the same limits, zones and room.
  [[nodiscard]] bool restore(std::span<const std::byte> bytes) {
    std::uint64_t sum = 0;
    if (bytes.size() < sizeof(sum)) return false;
    const std::span<const std::byte> state = bytes.first(bytes.size() - sizeof(sum));
    std::memcpy(&sum, bytes.data() + state.size(), sizeof(sum));
    if (sum != checksum(state)) return false;
    EncounterWatch other(limits_, zones_, max_vessels_);
    Archive fields(state);
    other.archive(fields);
    if (!fields.ok() || !fields.at_end()) return false;
    *this = std::move(other);
    return true;
  }

 private:
  using Vec2 = Vec<double, 2>;

  static constexpr double kMovingSigmas = 3.0;       ///< of a relative motion that can be a danger
  static constexpr double kStillMovingSigmas = 1.0;  ///< of one that still is
  static constexpr double kUnderWaySigmas = 2.0;     ///< of a speed that is one
  static constexpr std::uint32_t kArchiveVersion = 1;

  /// A vessel of this update, and the box that its way within the time limit may reach.
  struct Body {
    Vec2 low_m, high_m;  ///< corners [north, east] of the box, half the distance limit too
    Vec2 position_m, velocity_mps;
    double position_m2, velocity_m2s2;  ///< largest variances of all directions
    double speed_mps, speed_std_mps;    ///< over ground; the error of the worst direction
    bool rests;                         ///< perhaps, by the smallest of all rest speeds
    int known = 0;  ///< the first encounter of a pair of which it has the smaller number
    const WatchedVessel* vessel;
  };

  /// The motion of one vessel relative to another.
  struct RelativeMotion {
    Vec2 position_m, velocity_mps;
    double speed2, closing;  ///< -p·v; tcpa is closing / speed²

    RelativeMotion(const Body& a, const Body& b) noexcept
        : position_m(b.position_m - a.position_m),
          velocity_mps(b.velocity_mps - a.velocity_mps),
          speed2(velocity_mps.squaredNorm()),
          closing(-position_m.dot(velocity_mps)) {}

    /// Whether the closest point is ahead, and within a time.
    [[nodiscard]] bool is_ahead(double limit_s) const noexcept {
      return (closing >= 0.0) & (closing <= limit_s * speed2);
    }
  };

  static int room_for(int max_vessels) {
    require(max_vessels >= 1 && max_vessels <= 100'000, "max_vessels", "1 to 100000", max_vessels);
    return max_vessels;
  }

  /// Largest variance of all directions.
  static double largest_variance(double xx, double xy, double yy) noexcept {
    return (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy);
  }

  /// Sorts the vessels by the west sides of their boxes, and by number. Returns how many it could
  /// not take.
  int enter(std::span<const WatchedVessel> vessels) noexcept {
    bodies_.clear();
    for (const WatchedVessel& vessel : vessels) {
      const auto& [mean, p] = vessel.kinematics;
      if (bodies_.size() == bodies_.capacity()) break;
      if (!is_finite(mean) || !is_finite(p)) continue;
      Body body;
      body.vessel = &vessel;
      body.position_m = {mean[0], mean[2]};
      body.velocity_mps = {mean[1], mean[3]};
      body.position_m2 = largest_variance(p(0, 0), p(0, 2), p(2, 2));
      body.velocity_m2s2 = largest_variance(p(1, 1), p(1, 3), p(3, 3));
      body.speed_mps = body.velocity_mps.norm();
      body.speed_std_mps = std::sqrt(body.velocity_m2s2);
      body.rests = !is_under_way(body, widest_, kUnderWaySigmas);
      const double horizon_s = widest_.tcpa_limit_s;
      const double around_m =
          widest_.cpa_limit_m / 2 +
          sigmas_ * (std::sqrt(body.position_m2) + std::sqrt(body.velocity_m2s2) * horizon_s);
      const Vec2 last_m = body.position_m + horizon_s * body.velocity_mps;
      body.low_m = body.position_m.cwiseMin(last_m).array() - around_m;
      body.high_m = body.position_m.cwiseMax(last_m).array() + around_m;
      if (is_finite(body.low_m) && is_finite(body.high_m)) bodies_.push_back(body);
    }
    std::sort(bodies_.begin(), bodies_.end(), [](const Body& a, const Body& b) {
      return std::pair(a.low_m[1], a.vessel->id) < std::pair(b.low_m[1], b.vessel->id);
    });
    by_id_.resize(bodies_.size());
    std::iota(by_id_.begin(), by_id_.end(), 0);
    std::sort(by_id_.begin(), by_id_.end(),
              [&](int a, int b) { return body_at(a).vessel->id < body_at(b).vessel->id; });
    int known = 0;
    for (const int k : by_id_) {
      Body& body = bodies_[static_cast<std::size_t>(k)];
      while (known < std::ssize(encounters_) &&
             encounter_at(known).approach.first < body.vessel->id)
        ++known;
      body.known = known;
    }
    return static_cast<int>(vessels.size() - bodies_.size());
  }

  /// Calls `f(a, b)` once for each pair of vessels that may come close: of the boxes that begin
  /// before another ends, from west to east, those that approach it.
  template <class Function>
  void for_each_close_pair(const Function& f) noexcept {
    for (auto a = bodies_.begin(); a != bodies_.end(); ++a) {
      auto end = approaching_.begin();
      for (auto b = a + 1; b != bodies_.end() && b->low_m[1] <= a->high_m[1]; ++b) {
        *end = &*b;
        end += come_closer(*a, *b);
      }
      for (auto b = approaching_.begin(); b != end; ++b)
        if (can_come_close(*a, **b)) f(*a, **b);
    }
  }

  /// Whether boxes meet in north, and the vessels come closer. Without branches, for there are many
  /// pairs.
  [[nodiscard]] bool come_closer(const Body& a, const Body& b) const noexcept {
    const bool south = a.low_m[0] <= b.high_m[0], north = b.low_m[0] <= a.high_m[0];
    const bool ahead = RelativeMotion(a, b).is_ahead(widest_.tcpa_limit_s);
    const bool rest = a.rests & b.rests;
    return south & north & ahead & !rest;
  }

  /// Whether errors below k standard deviations can bring two vessels to the limit: whether
  ///
  ///     |p + v t| - k (σp + σv t) <= L    at the t where the left side is smallest.
  [[nodiscard]] bool can_come_close(const Body& a, const Body& b) const noexcept {
    const double horizon_s = widest_.tcpa_limit_s;
    const RelativeMotion motion(a, b);
    const double error_m = sigmas_ * std::sqrt(a.position_m2 + b.position_m2);
    const double drift_mps = sigmas_ * std::sqrt(a.velocity_m2s2 + b.velocity_m2s2);
    const double reach_m = widest_.cpa_limit_m + error_m;
    const double miss = motion.position_m[0] * motion.velocity_mps[1] -
                        motion.position_m[1] * motion.velocity_mps[0];  // cpa times speed
    const double farthest_m = reach_m + drift_mps * horizon_s;
    if (miss * miss > farthest_m * farthest_m * motion.speed2) return false;
    double t = horizon_s;
    if (const double faster2 = motion.speed2 - drift_mps * drift_mps; faster2 > 0.0)
      t = std::min(
          t, (motion.closing + std::abs(miss) * drift_mps / std::sqrt(faster2)) / motion.speed2);
    return (motion.position_m + t * motion.velocity_mps).norm() <= reach_m + drift_mps * t;
  }

  /// Whether the relative motion is larger than that many of its standard deviations: |v|⁴ > k² vᵀ
  /// P v.
  static bool moves(const Body& a, const Body& b, double sigmas) noexcept {
    const RelativeMotion motion(a, b);
    const auto &p = a.vessel->kinematics.covariance, &q = b.vessel->kinematics.covariance;
    const double vx = motion.velocity_mps[0], vy = motion.velocity_mps[1];
    const double variance = vx * vx * (p(1, 1) + q(1, 1)) + 2 * vx * vy * (p(1, 3) + q(1, 3)) +
                            vy * vy * (p(3, 3) + q(3, 3));
    constexpr double kRest2 = ClosestApproach::kRest_mps * ClosestApproach::kRest_mps;
    return motion.speed2 > kRest2 && motion.speed2 * motion.speed2 > sigmas * sigmas * variance;
  }

  /// Whether a vessel is faster than one at rest, by that many standard deviations.
  static bool is_under_way(const Body& body, const DangerLimits& limits,
                           double sigmas = 0.0) noexcept {
    return body.speed_mps > limits.rest_speed_mps + sigmas * body.speed_std_mps;
  }

  /// Whether an approach can matter, its probability apart.
  static bool can_matter(const Body& a, const Body& b, const DangerLimits& limits) noexcept {
    const RelativeMotion motion(a, b);
    const bool own = a.vessel->id == kOwnShip || b.vessel->id == kOwnShip;
    return a.vessel->id != b.vessel->id && motion.is_ahead(limits.tcpa_limit_s) &&
           moves(a, b, kMovingSigmas) &&
           (is_under_way(a, limits, kUnderWaySigmas) || is_under_way(b, limits, kUnderWaySigmas)) &&
           !(own && motion.position_m.squaredNorm() < limits.own_length_m * limits.own_length_m);
  }

  /// The first zone that contains the middle between two vessels at their closest point, or -1.
  [[nodiscard]] int zone_of(const Body& a, const Body& b) const noexcept {
    if (zones_.empty()) return -1;
    const RelativeMotion motion(a, b);
    const double tcpa_s = motion.closing / motion.speed2;
    const Vec2 middle_m =
        (a.position_m + b.position_m) / 2 + tcpa_s * (a.velocity_mps + b.velocity_mps) / 2;
    for (std::size_t k = 0; k < zones_.size(); ++k)
      if (zones_[k].contains(middle_m)) return static_cast<int>(k);
    return -1;
  }

  [[nodiscard]] Approach approach_of(const Body& a, const Body& b, int zone) const noexcept {
    if (a.vessel->id > b.vessel->id) return approach_of(b, a, zone);
    const DangerLimits& limits = limits_of(zone);
    const ClosestApproach closest = closest_approach(a.vessel->kinematics, b.vessel->kinematics);
    Approach approach;
    approach.first = a.vessel->id;
    approach.second = b.vessel->id;
    approach.zone = zone;
    approach.range_m = (b.position_m - a.position_m).norm();
    approach.signed_cpa_m = closest.signed_cpa_m();
    approach.tcpa_s = closest.tcpa_s();
    approach.covariance = closest.covariance();
    approach.probability = closest.probability(limits.cpa_limit_m, limits.tcpa_limit_s);
    approach.first_at_cpa_m = a.position_m + closest.tcpa_s() * a.velocity_mps;
    approach.second_at_cpa_m = b.position_m + closest.tcpa_s() * b.velocity_mps;
    return approach;
  }

  /// Lists the approach of two vessels where it can matter; follows their encounter, or begins one.
  void assess(const Body& a, const Body& b) noexcept {
    const int known = find(a, b);
    const int zone = known < 0 ? zone_of(a, b) : encounter_at(known).approach.zone;
    const DangerLimits& limits = limits_of(zone);
    const bool matters = can_matter(a, b, limits);
    if (!matters && known < 0) return;
    const Approach approach = approach_of(a, b, zone);
    if (known >= 0) follow(known, a, b, approach);
    if (!matters || approach.probability < kLeastProbability) return;
    if (approaches_.size() < approaches_.capacity())
      approaches_.push_back(approach);
    else
      ++left_out_;
    if (known < 0 && approach.probability >= limits.alarm_probability) begin(approach);
  }

  void begin(const Approach& approach) noexcept {
    if (encounters_.size() == encounters_.capacity()) {
      ++left_out_;
      return;
    }
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    encounters_.push_back({.begin_s = time_s_,
                           .last_s = time_s_,
                           .over_s = kNaN,
                           .time_s = time_s_,
                           .approach = approach,
                           .least_range_m = approach.range_m,
                           .least_range_s = time_s_});
  }

  /// Takes the approach of this update into an encounter.
  void follow(int known, const Body& a, const Body& b, const Approach& approach) noexcept {
    Encounter& one = encounter_at(known);
    followed_[static_cast<std::size_t>(known)] = 1;
    one.time_s = time_s_;
    one.approach = approach;
    if (approach.range_m < one.least_range_m) {
      one.least_range_m = approach.range_m;
      one.least_range_s = time_s_;
    }
    const DangerLimits& limits = limits_of(approach.zone);
    const bool dangerous =
        approach.tcpa_s >= 0.0 && (is_under_way(a, limits) || is_under_way(b, limits)) &&
        moves(a, b, kStillMovingSigmas) && approach.probability >= limits.clear_probability;
    if (dangerous) {
      one.last_s = time_s_;
      one.over_s = std::numeric_limits<double>::quiet_NaN();
    } else if (one.dangerous()) {
      one.over_s = time_s_;
    }
  }

  /// Follows the encounters of pairs that were not among the close ones, or were not there.
  void follow_the_others() noexcept {
    for (int k = 0; k < static_cast<int>(followed_.size()); ++k) {
      if (followed_[static_cast<std::size_t>(k)] != 0) continue;
      const Approach& before = encounter_at(k).approach;
      const Body *a = body_of(before.first), *b = body_of(before.second);
      if (a != nullptr && b != nullptr)
        follow(k, *a, *b, approach_of(*a, *b, before.zone));
      else if (encounter_at(k).dangerous())
        encounter_at(k).over_s = time_s_;
    }
  }

  /// Numbers the encounters that have begun, and moves them to their places among the others.
  void number_new() noexcept {
    auto older = encounters_.begin() + std::ssize(followed_), to = encounters_.end();
    std::sort(older, to,
              [](const Encounter& a, const Encounter& b) { return pair_of(a) < pair_of(b); });
    for (auto one = older; one != to; ++one) {
      one->id = next_id_++;
      events_.push_back({EncounterChange::kBegan, *one});
    }
    for (auto event = events_.rbegin(); event != events_.rend(); ++event) {
      const Encounter& one = event->encounter;
      while (older != encounters_.begin() && pair_of(one) < pair_of(*(older - 1))) *--to = *--older;
      *--to = one;
    }
  }

  void end_those_over() noexcept {
    const auto ends = [&](const Encounter& one) {
      const double hold_s = limits_of(one.approach.zone).clear_hold_s;
      if (!(time_s_ - one.over_s >= hold_s)) return false;
      events_.push_back({EncounterChange::kEnded, one});
      return true;
    };
    encounters_.erase(std::remove_if(encounters_.begin(), encounters_.end(), ends),
                      encounters_.end());
  }

  static std::pair<std::int64_t, std::int64_t> pair_of(const Encounter& one) noexcept {
    return {one.approach.first, one.approach.second};
  }

  /// The encounter of two vessels that was there before this update, or -1.
  [[nodiscard]] int find(const Body& a, const Body& b) const noexcept {
    if (b.vessel->id < a.vessel->id) return find(b, a);
    for (int k = a.known; k < std::ssize(followed_); ++k) {
      const auto& [first, second] = pair_of(encounters_[static_cast<std::size_t>(k)]);
      if (first != a.vessel->id || second > b.vessel->id) break;
      if (second == b.vessel->id) return k;
    }
    return -1;
  }

  /// The vessel of that number in this update, or null.
  [[nodiscard]] const Body* body_of(std::int64_t id) const noexcept {
    const auto found = std::lower_bound(by_id_.begin(), by_id_.end(), id, [&](int k, auto wanted) {
      return body_at(k).vessel->id < wanted;
    });
    return found != by_id_.end() && body_at(*found).vessel->id == id ? &body_at(*found) : nullptr;
  }

  [[nodiscard]] const Body& body_at(int k) const noexcept {
    return bodies_[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] Encounter& encounter_at(int k) noexcept {
    return encounters_[static_cast<std::size_t>(k)];
  }

  /// Saves or restores; the limits are compared, not restored.
  void archive(Archive& fields) {
    fields.rules(kArchiveVersion, limits_, max_vessels_, zones_.size());
    for (const DangerZone& zone : zones_) {
      fields.rules(zone.limits, zone.outline_m.size());
      for (const Vec2& corner : zone.outline_m) fields.rules(corner[0], corner[1]);
    }
    fields(time_s_);
    fields(next_id_);
    auto count = static_cast<std::uint64_t>(encounters_.size());
    fields(count);
    if (!fields.ok() || count > encounters_.capacity()) {
      fields.fail();
      return;
    }
    encounters_.resize(static_cast<std::size_t>(count));
    for (Encounter& one : encounters_) {
      one.archive(fields);
      const int zone = one.approach.zone;
      if (zone < -1 || zone >= static_cast<int>(zones_.size())) fields.fail();
    }
  }

  DangerLimits limits_;
  std::vector<DangerZone> zones_;
  int max_vessels_;
  DangerLimits widest_;  ///< of all limits: the largest distance and time, the smallest rest speed
  double sigmas_ = std::sqrt(2.0 * std::log(2.0 / kLeastProbability));  ///< k of the class

  double time_s_ = -std::numeric_limits<double>::infinity();
  std::int64_t next_id_ = 1;
  std::vector<Encounter> encounters_;  ///< in the order of their pairs, but for new ones

  // Of this update
  std::vector<Body> bodies_;  ///< from west to east
  std::vector<int> by_id_;
  std::vector<const Body*> approaching_;  ///< room for those that approach one vessel
  std::vector<char> followed_;
  std::vector<Approach> approaches_;
  std::vector<EncounterEvent> events_;
  int left_out_ = 0;
};

}  // namespace wakeline
