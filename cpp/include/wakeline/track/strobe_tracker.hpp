// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/archive.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/filter/start.hpp"
#include "wakeline/gating/radius_gate.hpp"
#include "wakeline/gating/strobe_echo.hpp"
#include "wakeline/measurement/own_ship.hpp"
#include "wakeline/track/beam.hpp"
#include "wakeline/track/plot_likelihood.hpp"
#include "wakeline/track/radar.hpp"
#include "wakeline/track/strobe_config.hpp"
#include "wakeline/track/strobe_track.hpp"
#include "wakeline/track/track_estimator.hpp"
#include "wakeline/track/track_list.hpp"
#include "wakeline/video/land_mask.hpp"
#include "wakeline/video/plot_extractor.hpp"
#include "wakeline/video/recent_sweeps.hpp"
#include "wakeline/video/sweep.hpp"
#include "wakeline/video/video_plot.hpp"

namespace wakeline {

/// The result of a sweep. The spans are valid until the next call.
struct StrobeReport {
  SweepStatus status = SweepStatus::kOk;
  std::span<const StrobeReading> readings;  ///< of the strobes that the beam has just passed
  std::span<const Event> events;
};

/// Tracks vessels on radar video, each by a strobe.
///
/// A vessel is acquired by the operator (`designate`) or from an extracted plot (`acquire`). In
/// each turn a strobe is laid on the picture about the predicted position; as soon as the beam has
/// passed it, the centre of mass of the amplitudes inside updates the estimator (`strobe_echo`).
/// `lost_after` turns in a row without an echo end the track; a turn in which the strobe is outside
/// the picture, or in which there were no sweeps, is one of them.
///
/// - The strobe is a circle of `radius_m`. It grows by `growth` after a turn without an echo, up to
///   `max_radius_m`, and shrinks by `shrinkage` after one with an echo. The first one of a track is
///   larger by the way at the speed limit until the beam comes, and by two standard deviations of
///   the position.
/// - Where strobes overlap, a cell belongs to the nearest centre; see `strobe_echo` for echoes that
///   are shared. A tentative track claims nothing from a confirmed one.
/// - An echo that touches the edge of its strobe, fills it or is shared is measured and reported.
/// - Cells on land and in excluded areas are empty. Nothing is acquired there.
///
/// Azimuths, ranges and times are those of the radar; the tracker subtracts its offsets. Sweeps
/// follow each other clockwise, at any steps; a sector is a turn with a gap. The own ship that
/// carries the radar may move. All memory is taken by the constructor; from then on nothing but
/// `save` and `restore` allocates or throws. Use from one thread at a time.
///
/// Source: Grinyak, Trofimov, "Multi-model tracking of moving vessels with a fuzzy criterion of
/// maneuver detection". Arbitration, radii and acquisition are ours.
template <class Estimator, std::unsigned_integral Amplitude = std::uint8_t>
class StrobeTracker {
  static_assert(TrackEstimator<Estimator>,
                "wakeline: a strobe tracker needs an estimator of double as Tracker takes it; see "
                "cpp/docs/concepts.md");

 public:
  /// Throws `std::invalid_argument` on a setting that makes no sense.
  StrobeTracker(const Radar& radar, const StrobeTrackerConfig& config, const Estimator& prototype,
                LandMask land = {});

  StrobeTracker(StrobeTracker&&) noexcept = default;
  StrobeTracker& operator=(StrobeTracker&&) noexcept = default;

  /// Processes a sweep received by own ship. A sweep of a time before the last one is invalid, one
  /// that is not ahead of it counts as repeated.
  StrobeReport process(const Sweep<Amplitude>& sweep, const OwnShip& own = {}) noexcept;

  /// Starts a confirmed track at rest, by the operator's word. Returns its number, or 0 when there
  /// is no room, a number is not finite or out of range, the standard deviation not positive or the
  /// time more than a period after the last sweep. A tracker that is full deletes its newest
  /// tentative track, without an event.
  [[nodiscard]] std::int64_t designate(double time_s, double north_m, double east_m,
                                       double position_std_m, const OwnShip& own = {}) noexcept;

  /// Starts tentative tracks at plots of the turn at hand that are neither in a strobe nor
  /// excluded; returns their number. There is no event until they are confirmed or lost.
  int acquire(std::span<const VideoPlot> plots, const OwnShip& own = {}) noexcept;

  /// Calls `f(track)` for every track, tentative ones too, older ones first.
  template <class Function>
  void for_each(Function&& function) const {
    for (const int slot : tracks_.slots()) function(tracks_.at(slot));
  }

  [[nodiscard]] int size() const noexcept { return tracks_.size(); }

  /// The track of that number, or null.
  [[nodiscard]] const StrobeTrack* find(std::int64_t id) const noexcept { return tracks_.find(id); }

  /// The estimator of a track of this tracker.
  [[nodiscard]] const Estimator& estimator_of(const StrobeTrack& track) const noexcept {
    return estimators_[static_cast<std::size_t>(track.slot)];
  }

  /// The belief of a track of this tracker at a time, before its estimate at constant velocity; NaN
  /// where the time is not finite or so far ahead that the prediction fails.
  [[nodiscard]] Gaussian<4> kinematics_at(const StrobeTrack& track, double time_s) const noexcept {
    return wakeline::kinematics_at(track, estimator_of(track), time_s);
  }

  /// Deletes a track; false when there is none of that number.
  bool drop(std::int64_t id) noexcept {
    const StrobeTrack* track = tracks_.find(id);
    if (track != nullptr) tracks_.remove(track->slot);
    return track != nullptr;
  }

  /// Replaces the excluded areas from the next sweep on. Frees and allocates memory.
  void set_land(LandMask land) noexcept { land_ = std::move(land); }

  /// The whole state except the excluded areas, to be restored by a tracker with the same settings
  /// and models.
  [[nodiscard]] std::vector<std::byte> save() const {
    return saved_state([this](Archive& fields) {
      const_cast<StrobeTracker*>(this)->archive(fields);  // writing changes nothing
    });
  }

  /// Continues bit for bit from the saved tracker. False, and nothing changed, when the bytes are
  /// not the state of a tracker with the same settings and models.
  [[nodiscard]] bool restore(std::span<const std::byte> bytes) {
    StrobeTracker other(radar_, config_, prototype_, land_);
    if (!read_state(bytes, [&](Archive& fields) { other.archive(fields); })) return false;
    *this = std::move(other);
    return true;
  }

  [[nodiscard]] const Estimator& prototype() const noexcept { return prototype_; }
  [[nodiscard]] const Radar& radar() const noexcept { return radar_; }
  [[nodiscard]] const StrobeTrackerConfig& config() const noexcept { return config_; }
  [[nodiscard]] const LandMask& land() const noexcept { return land_; }

  /// Time of the last sweep.
  [[nodiscard]] double time_s() const noexcept { return time_s_; }

 private:
  static constexpr std::uint32_t kArchiveVersion = 1;
  static constexpr double kTurn = Beam::kTurn;
  static constexpr double kSameAzimuth = 1e-3;  ///< widths
  static constexpr double kGap = 1.5;           ///< widths
  /// Beside a strobe, in widths: the sweep there shows whether an echo continues outside.
  static constexpr double kMargin = 1.5;
  static constexpr int kEchoes = 64;  ///< that are distinguished in a strobe

  // The beam --------------------------------------------------------------------------------------

  [[nodiscard]] SweepStatus admit(const Sweep<Amplitude>& sweep, const OwnShip& own) noexcept {
    if (!sweep.valid() || !in_range(own.position<double>())) return SweepStatus::kInvalid;
    if (sweep.amplitude.size() > static_cast<std::size_t>(config_.max_sweep_cells))
      return SweepStatus::kTooLong;
    if (!running_) {
      beam_rad_ = mark_rad_ = sweep.azimuth_rad;
      mark_s_ = sweep.time_s;
      running_ = true;
      return SweepStatus::kOk;
    }
    const double dt_s = sweep.time_s - time_s_;
    if (dt_s < 0.0) return SweepStatus::kInvalid;
    // As many whole turns as the time between the sweeps takes.
    const double least_rad = wrap_angle(sweep.azimuth_rad - beam_rad_);
    const double turns = std::round((rate_rad_s_ * dt_s - least_rad) / kTurn);
    const double step_rad = least_rad + kTurn * std::max(0.0, turns);
    if (step_rad <= kSameAzimuth * sweep.azimuth_width_rad) return SweepStatus::kRepeated;
    beam_rad_ = Beam::unwrapped(sweep.azimuth_rad, beam_rad_ + step_rad);
    if (beam_rad_ - mark_rad_ >= kTurn && sweep.time_s > mark_s_) {
      rate_rad_s_ = (beam_rad_ - mark_rad_) / (sweep.time_s - mark_s_);
      mark_rad_ = beam_rad_;
      mark_s_ = sweep.time_s;
    }
    return !recent_.continues(sweep)                   ? SweepStatus::kGeometryChanged
           : step_rad > kGap * sweep.azimuth_width_rad ? SweepStatus::kGap
                                                       : SweepStatus::kOk;
  }

  /// When the beam will have an angle.
  [[nodiscard]] double time_at(double beam_rad) const noexcept {
    return time_s_ + (beam_rad - beam_rad_) / rate_rad_s_;
  }

  // Strobes ---------------------------------------------------------------------------------------

  /// A position as the radar sees it: from the antenna, with the offsets of range and bearing.
  [[nodiscard]] Vec<double, 2> on_picture(const Vec<double, 2>& position,
                                          const OwnShip& own) const noexcept {
    const Vec<double, 2> u = towards(radar_.bearing_offset_rad);
    const Vec<double, 2> d = position - own.position<double>();
    const double range_m = d.norm();
    const double longer =
        range_m > 0.0 ? std::max(0.0, 1.0 + radar_.range_offset_m / range_m) : 1.0;
    return longer * Vec<double, 2>(u[0] * d[0] - u[1] * d[1], u[1] * d[0] + u[0] * d[1]);
  }

  /// The angle at which the beam next passes a position.
  [[nodiscard]] double next_pass_rad(const Vec<double, 2>& position,
                                     const OwnShip& own) const noexcept {
    const Vec<double, 2> seen = on_picture(position, own);
    return beam_rad_ + compass_angle(std::atan2(seen[1], seen[0]) - beam_rad_);
  }

  /// Notes where the beam passes the strobe, about an angle of the beam.
  void aim(StrobeTrack& track, const OwnShip& own, double near_rad) const noexcept {
    const Vec<double, 2> centre = on_picture(track.strobe.centre_m, own);
    const double half_rad =
        RadiusGate{track.strobe.radius_m}.half_angle_rad(centre) + kMargin * width_rad_;
    track.pass_rad = Beam::unwrapped(std::atan2(centre[1], centre[0]), near_rad);
    track.from_rad = track.pass_rad - half_rad;
    track.due_rad = track.pass_rad + half_rad;
  }

  static Status advance(Estimator& estimator, double dt_s) noexcept {
    return dt_s > 0.0 ? estimator.predict(dt_s) : Status::kOk;
  }

  /// Lays the next strobe, which the beam will pass about that angle. False when the estimator
  /// cannot be predicted.
  bool lay(StrobeTrack& track, double radius_m, double near_rad, const OwnShip& own) noexcept {
    const double wait_s = std::max(0.0, time_at(near_rad) - track.time_s);
    ahead_ = estimators_[static_cast<std::size_t>(track.slot)];
    if (advance(ahead_, wait_s) != Status::kOk) return false;
    const Gaussian<4> predicted = kinematics_of(ahead_.estimate());
    if (!is_finite(predicted.mean)) return false;
    track.last = track.strobe;
    track.strobe = {{predicted.mean[0], predicted.mean[2]}, radius_m, track.time_s + wait_s};
    aim(track, own, near_rad);
    next_due_rad_ = std::min(next_due_rad_, track.due_rad);
    return true;
  }

  /// The strobes of other tracks on the same turn of the picture that overlap with that of a track.
  void list_rivals(const StrobeTrack& track, const OwnShip& own) noexcept {
    rivals_.clear();
    const Strobe& strobe = track.strobe;
    for (const int slot : tracks_.slots()) {
      const StrobeTrack& other = tracks_.at(slot);
      if (slot == track.slot || (track.confirmed() && !other.confirmed())) continue;
      const Strobe& its = other.strobe_at(strobe.time_s);
      const double reach_m = strobe.radius_m + its.radius_m;
      if (std::abs(its.time_s - strobe.time_s) < 0.5 * kTurn / rate_rad_s_ &&
          (its.centre_m - strobe.centre_m).squaredNorm() < reach_m * reach_m)
        rivals_.push_back({on_picture(its.centre_m, own), its.radius_m, is_senior(other, track)});
    }
  }

  [[nodiscard]] static bool is_senior(const StrobeTrack& a, const StrobeTrack& b) noexcept {
    if (a.confirmed() != b.confirmed()) return a.confirmed();
    return std::abs(a.id) < std::abs(b.id);
  }

  /// Reads the strobe that the beam has passed and lays the next one. False when the track is lost.
  bool read(StrobeTrack& track, const OwnShip& own) noexcept {
    const Strobe strobe = track.strobe;
    const Vec<double, 2> centre = on_picture(strobe.centre_m, own);
    list_rivals(track, own);
    const StrobeEcho echo = strobe_echo<kEchoes>(
        recent_.from(track.from_rad), RadiusGate{strobe.radius_m}, centre, echo_, rivals_);
    const double passed_rad =
        echo ? Beam::unwrapped(echo.bearing_rad, track.pass_rad) : track.pass_rad;
    const SweepPlace passed = recent_.at(passed_rad);
    const double time_s = std::max(passed.time_s, track.time_s);
    OwnShip then = own;
    then.north_m = passed.own_north_m;
    then.east_m = passed.own_east_m;
    LossReason reason = take(track, time_s, echo, then) ? LossReason::kNone : LossReason::kFailed;
    count(track, bool(echo));
    if (reason == LossReason::kNone) reason = reason_to_end(track);
    if (reason == LossReason::kNone &&
        !lay(track, config_.next_radius_m(strobe.radius_m, bool(echo)), track.pass_rad + kTurn,
             own))
      reason = LossReason::kFailed;
    if (readings_.size() < readings_.capacity())
      readings_.push_back({track.id, time_s, strobe.centre_m, strobe.radius_m, echo, seen_,
                           bool(echo) && echo.filled() >= config_.fill_share});
    if (reason != LossReason::kNone) announce(TrackEvent::kLost, track, reason);
    return reason == LossReason::kNone;
  }

  /// Brings the estimate to the time of the strobe and updates it by the echo, seen from `own`. An
  /// estimator that finds the echo impossible starts anew from it. False when it fails.
  bool take(StrobeTrack& track, double time_s, const StrobeEcho& echo,
            const OwnShip& own) noexcept {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    seen_ = {Vec<double, 2>::Constant(kNaN), Mat<double, 2, 2>::Constant(kNaN)};
    Estimator& estimator = estimators_[static_cast<std::size_t>(track.slot)];
    if (advance(estimator, time_s - track.time_s) != Status::kOk) return false;
    track.time_s = time_s;
    track.nis = kNaN;
    if (echo) {
      seen_ = radar_.position(echo.range_m, echo.bearing_rad, own);
      const Alternative<Fix> reading{Fix{seen_.covariance}, seen_.mean, 1.0};
      track.nis =
          innovation_squared(kinematics_of(estimator.estimate()), seen_.mean, seen_.covariance);
      double share = 0.0;
      if (!(estimator.update(std::span(&reading, 1), 0.0, std::span(&share, 1)) > 0.0) &&
          estimator.start(at_rest(seen_)) != Status::kOk)
        return false;
    }
    track.kinematics = kinematics_of(estimator.estimate());
    return is_finite(track.kinematics.mean);
  }

  void count(StrobeTrack& track, bool seen) noexcept {
    track.hits += seen;
    track.misses = seen ? 0 : track.misses + 1;
    if (track.confirmed()) {
      if (track.misses == 1) announce(TrackEvent::kCoasting, track);
      track.status = seen ? TrackStatus::kConfirmed : TrackStatus::kCoasting;
    } else if (seen && track.hits >= config_.confirm_hits) {
      track.status = TrackStatus::kConfirmed;
      track.id = next_id_++;
      announce(TrackEvent::kConfirmed, track);
    }
  }

  /// Why a track ends, or `kNone`.
  [[nodiscard]] LossReason reason_to_end(const StrobeTrack& track) const noexcept {
    if (track.misses >= (track.confirmed() ? config_.lost_after : 1)) return LossReason::kMissed;
    const bool is_known = track.misses == 0 && track.hits >= config_.confirm_hits;
    return is_known && exceeds_speed(track.kinematics, radar_.max_speed_mps, kSpeedSigmas)
               ? LossReason::kTooFast
               : LossReason::kNone;
  }

  void announce(TrackEvent kind, const StrobeTrack& track,
                LossReason reason = LossReason::kNone) noexcept {
    if (events_.size() < events_.capacity())
      events_.push_back({kind, track.id, track.tentative_id, time_s_, reason});
  }

  // Acquisition -----------------------------------------------------------------------------------

  [[nodiscard]] Gaussian<4> at_rest(const Gaussian<2>& position) const noexcept {
    const double variance = radar_.max_speed_mps * radar_.max_speed_mps / 2;
    return kinematics_from<double>(
        position, {Vec<double, 2>::Zero(), variance * Mat<double, 2, 2>::Identity()},
        Mat<double, 2, 2>::Zero());
  }

  /// A track at rest, whose strobe the beam passes about that angle; null when there is no room or
  /// the estimator cannot start.
  StrobeTrack* open(const Gaussian<2>& position, double time_s, double near_rad,
                    const OwnShip& own) noexcept {
    if (tracks_.full()) return nullptr;
    StrobeTrack& track = tracks_.open();
    Estimator& estimator = estimators_[static_cast<std::size_t>(track.slot)];
    estimator = prototype_;
    track.time_s = time_s;
    track.kinematics = at_rest(position);
    const double error_m = 2.0 * std::sqrt(position.covariance.trace() / 2.0);
    track.strobe = {position.mean, error_m, time_s};  // as read
    const double radius_m = first_radius_m(track, config_.radius_m + error_m, near_rad);
    if (estimator.start(track.kinematics) == Status::kOk && lay(track, radius_m, near_rad, own))
      return &track;
    tracks_.remove(track.slot);
    return nullptr;
  }

  /// The radius of the first strobe: larger by the way until the beam comes.
  [[nodiscard]] double first_radius_m(const StrobeTrack& track, double sure_m,
                                      double near_rad) const noexcept {
    const double wait_s = running_ ? std::max(0.0, time_at(near_rad) - track.time_s) : 0.0;
    return std::min(config_.max_radius_m, sure_m + radar_.max_speed_mps * wait_s);
  }

  /// Whether a position seen in the turn at hand is in a strobe.
  [[nodiscard]] bool is_tracked(const Vec<double, 2>& position, double time_s) const noexcept {
    return std::ranges::any_of(tracks_.slots(), [&](int slot) {
      const Strobe& strobe = tracks_.at(slot).strobe_at(time_s);
      return std::abs(strobe.time_s - time_s) < 0.5 * kTurn / rate_rad_s_ &&
             (position - strobe.centre_m).squaredNorm() <= strobe.radius_m * strobe.radius_m;
    });
  }

  /// Deletes the newest tentative track of a full list; false when there is none.
  bool make_room() noexcept {
    const std::span<const int> slots = tracks_.slots();
    const auto newest = std::find_if(slots.rbegin(), slots.rend(),
                                     [&](int slot) { return !tracks_.at(slot).confirmed(); });
    if (newest == slots.rend()) return false;
    tracks_.remove(*newest);
    return true;
  }

  /// Saves or restores; the settings are compared, not restored.
  void archive(Archive& fields) {
    fields.rules(kArchiveVersion, fingerprint(prototype_), radar_, config_);
    if (!fields.ok()) return;
    fields(time_s_);
    fields(running_);
    fields(beam_rad_);
    fields(width_rad_);
    fields(rate_rad_s_);
    fields(mark_rad_);
    fields(mark_s_);
    fields(next_due_rad_);
    fields(next_id_);
    fields(next_tentative_id_);
    recent_.archive(fields);
    tracks_.archive(fields);
    if (!fields.ok()) return;
    for (const int slot : tracks_.slots())
      estimators_[static_cast<std::size_t>(slot)].archive(fields);
  }

  static constexpr double kNever = std::numeric_limits<double>::infinity();

  Radar radar_;
  StrobeTrackerConfig config_;
  StrobeSettings echo_;
  Estimator prototype_;
  LandMask land_;

  TrackListOf<StrobeTrack> tracks_;
  std::vector<Estimator> estimators_;  ///< by slot
  RecentSweeps<Amplitude> recent_;
  std::int64_t next_id_ = 1;
  std::int64_t next_tentative_id_ = -1;

  bool running_ = false;  ///< there was a sweep
  double time_s_ = 0.0;
  double beam_rad_ = 0.0;   ///< unwrapped
  double width_rad_ = 0.0;  ///< of the last sweep
  double rate_rad_s_;       ///< of the antenna, over its last turn
  double mark_rad_ = 0.0;   ///< where that turn ended
  double mark_s_ = 0.0;
  double next_due_rad_ = kNever;  ///< not later than any strobe is due

  Estimator ahead_;   ///< for predictions
  Gaussian<2> seen_;  ///< the position of the echo at hand
  std::vector<RivalStrobe> rivals_;
  std::vector<int> due_;  ///< slots
  std::vector<StrobeReading> readings_;
  std::vector<Event> events_;
};

// Not inline, so that a program with `extern template class StrobeTracker<...>` does not compile
// them.

template <class Estimator, std::unsigned_integral Amplitude>
StrobeTracker<Estimator, Amplitude>::StrobeTracker(const Radar& radar,
                                                   const StrobeTrackerConfig& config,
                                                   const Estimator& prototype, LandMask land)
    : radar_(validated(radar)),
      config_(validated(config)),
      echo_(config.echo()),
      prototype_(prototype),
      land_(std::move(land)),
      tracks_(config.max_tracks),
      estimators_(static_cast<std::size_t>(config.max_tracks), prototype),
      recent_(config.max_strobe_sweeps, config.max_sweep_cells),
      rate_rad_s_(kTurn / radar.period_s),
      ahead_(prototype) {
  rivals_.reserve(estimators_.size());
  due_.reserve(estimators_.size());
  readings_.reserve(2 * estimators_.size());
  events_.reserve(2 * estimators_.size());
}

template <class Estimator, std::unsigned_integral Amplitude>
StrobeReport StrobeTracker<Estimator, Amplitude>::process(const Sweep<Amplitude>& given,
                                                          const OwnShip& own) noexcept {
  readings_.clear();
  events_.clear();
  Sweep<Amplitude> sweep = given;
  sweep.time_s = radar_.true_time_s(given.time_s);
  const bool first = !running_;
  const SweepStatus status = admit(sweep, own);
  if (rejected(status)) return {status, {}, {}};
  time_s_ = sweep.time_s;
  width_rad_ = sweep.azimuth_width_rad;
  land_.blank(sweep, recent_.add(sweep, beam_rad_, own.position<double>()));

  due_.clear();
  if (first || beam_rad_ >= next_due_rad_) {
    next_due_rad_ = kNever;
    for (const int slot : tracks_.slots()) {
      StrobeTrack& track = tracks_.at(slot);
      if (first) {  // designated before there was a beam
        const double near_rad = next_pass_rad(track.position(), own);
        if (!lay(track, first_radius_m(track, track.strobe.radius_m, near_rad), near_rad, own))
          track.due_rad = beam_rad_;
      } else if (beam_rad_ >= track.due_rad) {
        aim(track, own, track.pass_rad);  // own ship may have moved
      }
      if (beam_rad_ >= track.due_rad) due_.push_back(slot);
      next_due_rad_ = std::min(next_due_rad_, track.due_rad);
    }
  }
  for (const int slot : due_) {
    StrobeTrack& track = tracks_.at(slot);
    bool kept = true;
    while (kept && beam_rad_ >= track.due_rad) kept = read(track, own);
    if (!kept) tracks_.remove(slot);
  }
  if (!due_.empty()) {
    next_due_rad_ = kNever;
    for (const int slot : tracks_.slots())
      next_due_rad_ = std::min(next_due_rad_, tracks_.at(slot).due_rad);
  }
  return {status, readings_, events_};
}

template <class Estimator, std::unsigned_integral Amplitude>
std::int64_t StrobeTracker<Estimator, Amplitude>::designate(double time_s, double north_m,
                                                            double east_m, double position_std_m,
                                                            const OwnShip& own) noexcept {
  if (!std::isfinite(time_s) || !(position_std_m > 0.0)) return 0;
  if (running_ && time_s > time_s_ + radar_.period_s) return 0;
  const Gaussian<2> position{{north_m, east_m},
                             position_std_m * position_std_m * Mat<double, 2, 2>::Identity()};
  if (!in_range(position.mean) || !in_range(position_std_m) || !in_range(own.position<double>()))
    return 0;
  if (tracks_.full() && !make_room()) return 0;
  StrobeTrack* track = open(position, time_s, next_pass_rad(position.mean, own), own);
  if (track == nullptr) return 0;
  track->status = TrackStatus::kConfirmed;
  track->id = next_id_++;
  return track->id;
}

template <class Estimator, std::unsigned_integral Amplitude>
int StrobeTracker<Estimator, Amplitude>::acquire(std::span<const VideoPlot> plots,
                                                 const OwnShip& own) noexcept {
  int started = 0;
  for (const VideoPlot& plot : plots) {
    if (!running_ || land_.excludes(plot.bearing_rad, plot.range_m)) continue;
    const Gaussian<2> position = radar_.position(plot.range_m, plot.bearing_rad, own);
    const double plot_s = radar_.true_time_s(plot.time_s);
    if (!in_range(position.mean) || !(plot_s <= time_s_) || is_tracked(position.mean, plot_s))
      continue;
    const double passed_rad =
        Beam::unwrapped(plot.bearing_rad, beam_rad_ - rate_rad_s_ * (time_s_ - plot_s));
    double near_rad = passed_rad + kTurn;
    while (near_rad < beam_rad_) near_rad += kTurn;
    StrobeTrack* track = open(position, plot_s, near_rad, own);
    if (track == nullptr) continue;
    track->id = track->tentative_id = next_tentative_id_--;
    track->hits = 1;
    ++started;
  }
  return started;
}

}  // namespace wakeline
