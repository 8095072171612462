// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "wakeline/simd/side_by_side.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/identities.hpp"
#include "wakeline/track/radar_state.hpp"
#include "wakeline/track/results.hpp"
#include "wakeline/track/time_alignment.hpp"
#include "wakeline/track/track_estimator.hpp"
#include "wakeline/track/track_gate.hpp"
#include "wakeline/track/track_list.hpp"
#include "wakeline/track/track_room.hpp"

namespace wakeline {

/// What a tracker knows: its radars, the vessels that report, and the tracks with their estimators.
/// Scans, reports and bearings or ranges alone change it. All memory is taken by the constructor.
template <class Estimator, class Steps>
struct Picture {
  static_assert(TrackEstimator<Estimator>,
                "wakeline: a tracker needs an estimator of double with for_each_mode or "
                "evidence(sensor, z), and the update of several readings, as Imm has them (of one "
                "filter: an Imm of one model); see cpp/docs/concepts.md");
  static_assert(EstimatorSteps<Steps, Estimator>,
                "wakeline: the steps of a tracker need predict(span<PredictionStep>) and "
                "update(span<UpdateStep>), as SideBySide has them; see cpp/docs/concepts.md");

  static constexpr double kSurelyExists = 0.999;       ///< a target that was designated or reports
  static constexpr double kLongestSilence_s = 3600.0;  ///< of the radar
  static constexpr double kPointedPeriods = 2.0;       ///< a track is pointed at within so many
  static constexpr std::uint32_t kArchiveVersion = 23;

  Picture(std::span<const Radar> of, const TrackerConfig& with, const Estimator& made_of)
      : config(validated(with)),
        prototype(made_of),
        started_as(made_of),
        steps(made_of),
        identities(2 * config.max_tracks),
        tracks(config.max_tracks),
        estimators(static_cast<std::size_t>(config.max_tracks), made_of),
        gate(config),
        room(config.max_tracks) {
    require(!of.empty(), "radars", "one Radar at least", 0);
    for (const Radar& radar : of) add_radar(radar);
    const auto plots = static_cast<std::size_t>(config.max_plots);
    plot_track_id.reserve(plots);
    events.reserve(4 * estimators.size() + plots + 1);
  }

  TrackerConfig config;
  Estimator prototype;
  Estimator started_as;  ///< the last one that a track has started with
  Steps steps;
  std::vector<RadarState> radars;  ///< by number
  int at_hand = 0;                 ///< number of the radar of this call
  Identities identities;
  TrackList tracks;
  std::vector<Estimator> estimators;  ///< by slot
  TrackGate gate;
  TrackRoom room;
  double scan_time_s = 0.0;  ///< of the last scan of any radar
  /// No `looked_s` of a track is before it: spares sectors the search for silent tracks.
  double looked_since_s = -std::numeric_limits<double>::infinity();
  bool started = false;
  bool full = false;  ///< since the event that says so
  std::int64_t next_id = 1;
  std::int64_t next_tentative_id = -1;
  std::int64_t newest_before = 0;  ///< number of the newest tentative track before this scan
  std::array<double, kMostPartialSensors> partial_time_s = never();  ///< when each gave values last
  std::array<ReportClock, kMostPartialSensors> partial_clock = {};
  // What the last call has given
  std::vector<std::int64_t> plot_track_id;
  std::vector<Event> events;

  int add_radar(const Radar& radar) {
    auto place = std::find_if(radars.begin(), radars.end(),
                              [](const RadarState& known) { return !known.in_use; });
    require(place != radars.end() || radars.size() < kMostRadars, "radar", "at most 16 radars",
            static_cast<int>(radars.size()) + 1);
    static_assert(kMostRadars == 16);
    RadarState of_radar(validated(radar), config);
    place = place == radars.end() ? radars.insert(place, std::move(of_radar))
                                  : (*place = std::move(of_radar), place);
    for (const int slot : tracks.slots()) place->open(tracks.at(slot), scan_time_s);
    return static_cast<int>(place - radars.begin());
  }

  [[nodiscard]] bool has_radar(int number) const noexcept {
    return number >= 0 && number < static_cast<int>(radars.size()) &&
           radars[static_cast<std::size_t>(number)].in_use;
  }

  /// Of the radar at hand.
  RadarState& state() noexcept { return radars[static_cast<std::size_t>(at_hand)]; }
  [[nodiscard]] const RadarState& state() const noexcept {
    return radars[static_cast<std::size_t>(at_hand)];
  }

  [[nodiscard]] int radars_in_use() const noexcept {
    return static_cast<int>(std::count_if(radars.begin(), radars.end(),
                                          [](const RadarState& radar) { return radar.in_use; }));
  }

  /// The longest period of all radars.
  [[nodiscard]] double longest_period_s() const noexcept {
    double longest_s = 0.0;
    for (const RadarState& radar : radars)
      if (radar.in_use)
        longest_s = std::max({longest_s, radar.radar.period_s, radar.beam.turn_s()});
    return longest_s;
  }

  /// Up to this time scans and marks of the operator are taken; infinite before the first scan.
  [[nodiscard]] double latest_time_s() const noexcept {
    return started ? scan_time_s + kLongestSilence_s : std::numeric_limits<double>::infinity();
  }

  /// Whether a time is as near to the last scan; any is before the first one.
  [[nodiscard]] bool is_near_now(double time_s) const noexcept {
    return !started || std::abs(time_s - scan_time_s) <= kLongestSilence_s;
  }

  /// `kNotFinite` of a time too long after the last scan, `kNegativeTimeStep` of one too long
  /// before.
  [[nodiscard]] Status status_of_time(double time_s) const noexcept {
    if (started && time_s > scan_time_s + kOldestReport_s) return Status::kNotFinite;
    if (started && time_s < scan_time_s - kOldestReport_s) return Status::kNegativeTimeStep;
    return Status::kOk;
  }

  /// The time of a report of a source.
  [[nodiscard]] double time_of(ReportClock& clock, double time_s) const noexcept {
    constexpr double kPeriods = 1.5;
    return started ? clock(time_s, scan_time_s, kPeriods * longest_period_s()) : time_s;
  }

  /// Nothing changes, for that reason.
  ScanReport rejected(Status status) noexcept {
    clear_results();
    return {status, {}, {}, 0};
  }

  /// Begins a call.
  void clear_results() noexcept {
    events.clear();
    plot_track_id.clear();
  }

  [[nodiscard]] const Estimator& estimator_of(int slot) const noexcept {
    return estimators[static_cast<std::size_t>(slot)];
  }
  Estimator& estimator_at(int slot) noexcept { return estimators[static_cast<std::size_t>(slot)]; }

  /// The belief of the estimator of a track at a time.
  [[nodiscard]] Gaussian<4> belief_at(const Track& track, double time_s) const noexcept {
    return wakeline::kinematics_at(track, estimator_of(track.slot), time_s);
  }

  /// Predicts a track to a time after its own.
  void predict_to(Track& track, double time_s) noexcept {
    if (!(time_s > track.time_s)) return;
    PredictionStep<Estimator> step{&estimator_at(track.slot), time_s - track.time_s};
    steps.predict({&step, 1});
    if (step.status != Status::kOk) return;
    track.time_s = time_s;
    track.kinematics = step.kinematics;
  }

  /// How fast a position gets less certain than by its velocity as it is known, as the target may
  /// maneuver: m² per axis over the cube of the time. 0 where all plots are of the track's period.
  [[nodiscard]] double maneuver_m2s3(const Track& track, double dt_s) noexcept {
    if (!(dt_s > state().radar.period_s)) return 0.0;
    const Mat<double, 4, 4> added = maneuver_covariance(track, dt_s);
    return std::max(0.0, (added(0, 0) + added(2, 2)) / 2) / (dt_s * dt_s * dt_s);
  }

  /// What maneuvers add to the covariance of a track over a time, by its models; zero where it
  /// cannot be predicted.
  [[nodiscard]] Mat<double, 4, 4> maneuver_covariance(const Track& track, double dt_s) noexcept {
    Estimator ahead = estimator_of(track.slot);
    PredictionStep<Estimator> step{&ahead, dt_s};
    steps.predict({&step, 1});
    if (step.status != Status::kOk) return Mat<double, 4, 4>::Zero();
    return step.kinematics.covariance - at_constant_velocity(track.kinematics, dt_s).covariance;
  }

  /// Moves what was measured so long ago along with a track.
  [[nodiscard]] TimeAlignment alignment_over(const Track& track, double late_s) noexcept {
    const double period_s = longest_period_s();
    return {track, period_s, late_s > period_s ? maneuver_m2s3(track, late_s) : 0.0};
  }

  /// Whether one of the radars has lately seen the target of a track.
  [[nodiscard]] bool is_seen_by_radar(const Track& track) const noexcept {
    return std::any_of(radars.begin(), radars.end(),
                       [&](const RadarState& radar) { return sees(radar, track); });
  }

  /// Whether all radars that have lately seen the target of a track see it beside the track. One
  /// whose errors are correlated may do so by chance, and does not count.
  [[nodiscard]] bool is_beside_plots(const Track& track) const noexcept {
    bool beside = false;
    for (const RadarState& radar : radars) {
      if (radar.radar.correlation_time_s > 0.0 || !sees(radar, track)) continue;
      if (!radar.look(track).is_beside()) return false;
      beside = true;
    }
    return beside;
  }

  [[nodiscard]] bool sees(const RadarState& radar, const Track& track) const noexcept {
    constexpr double kPeriods = 4.0;
    return radar.in_use && radar.started &&
           scan_time_s - radar.look(track).seen_s <= kPeriods * radar.radar.period_s;
  }

  /// Whether a track was designated for a time to which the scans have not come yet: until then it
  /// misses none.
  [[nodiscard]] bool is_awaited(const Track& track) const noexcept {
    return track.time_s > scan_time_s && track.time_s <= latest_time_s();
  }

  /// The track nearest to a position at a time, in standard deviations, if it is in its gate; null
  /// without one.
  Track* track_at(const Gaussian<2>& position, double time_s) noexcept {
    Track* nearest = nullptr;
    double least = gate.threshold();
    for (const int slot : tracks.slots()) {
      Track& track = tracks.at(slot);
      const double dt_s = time_s - track.time_s;
      if (std::abs(dt_s) > kPointedPeriods * longest_period_s()) continue;
      const double distance =
          innovation_squared(position_at_constant_velocity(track.kinematics, dt_s), position.mean,
                             position.covariance);
      if (distance <= least) {
        least = distance;
        nearest = &track;
      }
    }
    return nearest;
  }

  /// Makes a track less certain that is beside its plots, so that they take it to where they are.
  void loosen(Track& track) noexcept {
    constexpr double kPlots = 4.0, kTime_s = 20.0;
    Gaussian<4> belief = track.kinematics;
    for (const int k : {0, 2}) {
      belief.covariance(k, k) += kPlots * track.plot_m2;
      belief.covariance(k + 1, k + 1) += track.plot_m2 / (kTime_s * kTime_s);
    }
    if (started_as.start(belief) != Status::kOk) return;
    copy_state(started_as, estimator_at(track.slot));
    track.kinematics = belief;
  }

  /// A new tentative track, for which there is room; null when its estimator cannot start.
  Track* open(const TrackStart& start) noexcept {
    if (started_as.start(start.belief) != Status::kOk) return nullptr;
    if (tracks.full()) {
      const int weakest = room.make_room();
      if (!is_new(tracks.at(weakest)))
        announce(TrackEvent::kLost, tracks.at(weakest), LossReason::kDisplaced);
      tracks.vacate(weakest);
    }
    Track& track = tracks.open();
    copy_state(started_as, estimator_at(track.slot));
    track.id = track.tentative_id = track.birth = next_tentative_id--;
    track.time_s = start.time_s;
    track.looked_s = scan_time_s;
    track.kinematics = start.belief;
    track.plot_m2 = track.position_variance_m2();
    track.existence = track.start_existence = start.existence;
    track.scans = track.hits = 2;
    for (RadarState& radar : radars) radar.open(track, scan_time_s);
    room.add(track);
    return &track;
  }

  /// Whether a track has started in this scan: tentative tracks count downwards.
  [[nodiscard]] bool is_new(const Track& track) const noexcept { return track.id < newest_before; }

  /// Numbers a track if it has just been confirmed.
  void number_confirmed(Track& track) noexcept {
    if (!track.confirmed() || track.id > 0) return;
    track.id = next_id++;
    announce(TrackEvent::kConfirmed, track);
  }

  /// Makes a track one that the operator has seen.
  void confirm_designated(Track& track) noexcept {
    track.existence = std::max(track.existence, kSurelyExists);
    track.hits = std::max(track.hits, config.confirm_hits);
    track.scans = std::max(track.scans, track.hits);
    track.misses = 0;
    track.hushed = false;
    track.status = TrackStatus::kConfirmed;
    if (track.id <= 0) track.id = next_id++;
  }

  /// The probability that a track is of the vessel whose identity it has; 0 where it has none.
  [[nodiscard]] double identity_probability(const Track& track) const noexcept {
    if (track.identity < 0) return 0.0;
    const Identity& identity = identities[track.identity];
    for (const Identity::Candidate& candidate : identity.candidates)
      if (candidate.is(track)) return identity.probability(candidate);
    return 0.0;
  }

  /// The slot of the track that has an identity; -1 where none has.
  [[nodiscard]] int slot_of_identity(int number) const noexcept {
    for (const int slot : tracks.slots())
      if (tracks.at(slot).identity == number) return slot;
    return -1;
  }

  /// The vessel that is believed to be on a track has changed, or what it reports.
  void announce(TrackEvent kind, const Track* track, const Identity& identity) noexcept {
    if (events.size() < events.capacity() && (track == nullptr || !track->hushed))
      events.push_back({kind, track == nullptr ? 0 : track->id,
                        track == nullptr ? 0 : track->tentative_id, scan_time_s, LossReason::kNone,
                        identity.name});
  }

  void announce(TrackEvent kind, const Track& track,
                LossReason reason = LossReason::kNone) noexcept {
    if (events.size() < events.capacity() && !track.hushed)
      events.push_back({kind, track.id, track.tentative_id, scan_time_s, reason});
  }

  /// Takes all but the settings of a picture with the same.
  void copy_state_from(const Picture& other) noexcept {
    radars = other.radars;
    at_hand = other.at_hand;
    partial_time_s = other.partial_time_s;
    partial_clock = other.partial_clock;
    scan_time_s = other.scan_time_s;
    looked_since_s = other.looked_since_s;
    started = other.started;
    full = other.full;
    next_id = other.next_id;
    next_tentative_id = other.next_tentative_id;
    identities = other.identities;
    tracks.copy_from(other.tracks);
    tracks.for_each_slot(
        [&](int slot) { copy_state(other.estimator_of(slot), estimator_at(slot)); });
  }

  /// Saves or restores; the settings are compared, not restored.
  void archive(Archive& fields) {
    fields.rules(kArchiveVersion, fingerprint(prototype), config, radars.size());
    for (const RadarState& radar : radars) {
      fields.rules(radar.in_use);
      if (radar.in_use) fields.rules(radar.radar);
    }
    if (!fields.ok()) return;
    fields(at_hand);
    if (!has_radar(at_hand)) fields.fail();
    if (!fields.ok()) return;
    fields(partial_time_s);
    for (ReportClock& clock : partial_clock) clock.archive(fields);
    fields(scan_time_s);
    fields(started);
    fields(full);
    fields(next_id);
    fields(next_tentative_id);
    identities.archive(fields);
    tracks.archive(fields);
    if (!fields.ok()) return;
    for (RadarState& radar : radars)
      if (radar.in_use) radar.archive(fields, tracks.slots());
    if (!fields.ok()) return;
    for (const int slot : tracks.slots()) estimator_at(slot).archive(fields);
  }

 private:
  /// Of an estimator with the same parameters; where it can, without these.
  static void copy_state(const Estimator& from, Estimator& to) noexcept {
    if constexpr (requires { to.copy_state_from(from); })
      to.copy_state_from(from);
    else if constexpr (requires { InLanes<Estimator, double>::of(from); })
      to.gather([&](int) -> const Estimator& { return from; });
    else
      to = from;
  }

  static constexpr std::array<double, kMostPartialSensors> never() noexcept {
    std::array<double, kMostPartialSensors> times{};
    times.fill(-std::numeric_limits<double>::infinity());
    return times;
  }
};

}  // namespace wakeline
