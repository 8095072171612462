// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "wakeline/core/utf8.hpp"
#include "wakeline/measurement/kinematic_fix.hpp"
#include "wakeline/simd/side_by_side.hpp"
#include "wakeline/track/association.hpp"
#include "wakeline/track/association_probabilities.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/duplicates.hpp"
#include "wakeline/track/identities.hpp"
#include "wakeline/track/life_cycle.hpp"
#include "wakeline/track/mode_positions.hpp"
#include "wakeline/track/partial_scan.hpp"
#include "wakeline/track/plot_likelihood.hpp"
#include "wakeline/track/radar_state.hpp"
#include "wakeline/track/time_alignment.hpp"
#include "wakeline/track/track_estimator.hpp"
#include "wakeline/track/track_gate.hpp"
#include "wakeline/track/track_list.hpp"
#include "wakeline/track/track_room.hpp"

namespace wakeline {

/// The result of a scan. The spans are valid until the next call.
struct [[nodiscard]] ScanReport {
  Status status = Status::kOk;
  std::span<const std::int64_t>
      plot_track_id;  ///< of each plot up to `max_plots` the track it belongs to, or 0
  std::span<const Event> events;
  /// Not finite, out of range, behind the antenna, of so many turns that the bearing is lost, of
  /// another time than the scan, or beyond `max_plots`.
  int rejected_plots = 0;
};

/// The result of a report. The events are valid until the next call.
struct [[nodiscard]] ReportResult {
  Status status = Status::kOk;  ///< `kGated`: it has changed no track
  std::int64_t track_id = 0;    ///< of the track that its vessel is believed to be; 0: none
  std::span<const Event> events;
};

/// Keeps tracks of all vessels that some radars see, scan by scan.
///
/// Each track is an estimator with a probability of existence, and of visibility to each radar.
/// It is updated by every radar that covers it; a miss counts in its life only where no other radar
/// has seen it within a period. `process` is the list of stages a scan goes through; each stage is
/// a header of this folder, with its input as arguments and its output its own. All memory is taken
/// by the constructor; `process` neither allocates nor throws. A tracker may be used from one
/// thread at a time; trackers share nothing. `Steps` predicts and updates the estimators of many
/// tracks at once. Sources: D. Mušicki, R. Evans, "Joint integrated probabilistic data
/// association", IEEE Trans. AES-40, 2004; J. L. Williams, R. A. Lau, IEEE Trans. AES-50, 2014;
/// Bar-Shalom, Li, Multitarget-Multisensor Tracking, 1995.
template <class Estimator, class Steps = SideBySide<Estimator>>
class Tracker {
  static_assert(TrackEstimator<Estimator>,
                "wakeline: a tracker needs an estimator of double with for_each_mode or "
                "evidence(sensor, z), and the update of several readings, as Imm has them (of one "
                "filter: an Imm of one model); see cpp/docs/concepts.md");
  static_assert(EstimatorSteps<Steps, Estimator>,
                "wakeline: the steps of a tracker need predict(span<PredictionStep>) and "
                "update(span<UpdateStep>), as SideBySide has them; see cpp/docs/concepts.md");

 public:
  /// Throws `std::invalid_argument` on a setting that makes no sense.
  Tracker(const Radar& radar, const TrackerConfig& config, const Estimator& prototype)
      : Tracker(std::span(&radar, 1), config, prototype) {}

  /// The same with several radars, `kMostRadars` at most, which are numbered from 0.
  Tracker(std::span<const Radar> radars, const TrackerConfig& config, const Estimator& prototype);

  static constexpr int kMostRadars = 16;

  Tracker(Tracker&&) noexcept = default;
  Tracker& operator=(Tracker&&) noexcept = default;

  /// Processes the plots of one scan, a whole turn of the first radar that ends at `time_s`: a
  /// track without a plot has missed it. Times of scan and plots are by the radar's clock;
  /// `time_s()`, tracks and events have true time (`Radar::time_offset_s`). Rejects a scan that is
  /// before the last one of its radar, or more than a period before that of another one
  /// (`kNegativeTimeStep`), or after `latest_time_s()` (`kNotFinite`): nothing changes.
  ScanReport process(double time_s, std::span<const Plot> plots) noexcept {
    return step(0, time_s, plots, nullptr);
  }

  /// Processes a part of the antenna's turn.
  ///
  /// Tracks whose gate the beam has passed are updated or have missed, once a turn; others, and
  /// plots that may be theirs, wait for the next sector, so that `plot_track_id` is 0 for these.
  /// Where sectors leave a gap, tracks are neither updated nor miss; a track that the beam has not
  /// passed for two periods coasts by time, a miss a period. A sector of no width lets time pass.
  /// One of a whole turn is `process`. Rejects a sector of a radar that is not known or from
  /// nowhere to nowhere (`kNotFinite`), or of a time that `process` rejects: nothing changes.
  ScanReport sector(const Sector& sector) noexcept {
    const double width_rad = Beam::width_rad(sector.from_rad, sector.to_rad);
    if (std::isnan(width_rad)) return rejected(Status::kNotFinite);
    return step(sector.radar, sector.time_s, sector.plots,
                Beam::is_turn(width_rad) ? nullptr : &sector);
  }

  /// Adds a radar and returns its number, the least that is free; takes memory. Throws
  /// `std::invalid_argument` on a setting that makes no sense, and when there are `kMostRadars`.
  int add_radar(const Radar& radar);

  /// Removes a radar and what was learned of it; tracks continue by the others. False when there is
  /// none of that number or it is the last one.
  bool remove_radar(int number) noexcept {
    if (!has_radar(number) || radars_in_use() == 1) return false;
    radars_[static_cast<std::size_t>(number)].in_use = false;
    at_hand_ = 0;
    while (!has_radar(at_hand_)) ++at_hand_;
    return true;
  }

  /// Changes the settings of a radar, such as the errors and the period of another range scale,
  /// and keeps all tracks. Throws `std::invalid_argument` on a setting that makes no sense and when
  /// there is no radar of that number.
  void set_radar(int number, const Radar& radar) {
    require(has_radar(number), "radar", "the number of a radar of this tracker", number);
    radars_[static_cast<std::size_t>(number)].radar = validated(radar);
  }

  [[nodiscard]] bool has_radar(int number) const noexcept {
    return number >= 0 && number < static_cast<int>(radars_.size()) &&
           radars_[static_cast<std::size_t>(number)].in_use;
  }

  /// One more than the largest number of a radar.
  [[nodiscard]] int radar_numbers() const noexcept { return static_cast<int>(radars_.size()); }

  /// The radar of that number, which is known.
  [[nodiscard]] const Radar& radar(int number = 0) const noexcept {
    return radars_[static_cast<std::size_t>(number)].radar;
  }

  /// The probability that a radar can see the target of a track; of those that can, the largest.
  [[nodiscard]] double visibility(const Track& track) const noexcept {
    double largest = 0.0;
    for (const RadarState& radar : radars_)
      if (radar.in_use) largest = std::max(largest, radar.look(track).visibility);
    return largest;
  }

  /// Takes the position that a vessel reports of itself.
  ///
  /// The report may be `kOldestReport_s` before the last scan or after it, and reports of one
  /// identity come in their order. It is of the track that its identity is believed to be, which is
  /// decided by where the reports of the identity are, one after the other, and of a new track
  /// where there is none near and the vessel has reported before. It updates the track only while
  /// they agree, so that an identity that is wrong, stolen or old drags no track away; events tell
  /// of it. A track that reports is kept while its vessel can be silent. Rejects what is not valid
  /// or later than that (`kNotFinite`), and what is older than that or than the last report of the
  /// same identity
  /// (`kNegativeTimeStep`): nothing changes. Takes the velocity where the estimator has a form for
  /// it, as `Imm` has.
  ReportResult report(const PositionReport& report) noexcept;

  static constexpr double kOldestReport_s = 120.0;

  /// Takes bearings or ranges of targets without the other part of their position.
  ///
  /// They update the confirmed tracks, start none, and tell of no misses. Values between several
  /// tracks are shared by their likelihoods. The time may be as far from the last scan as that of a
  /// report; the estimate of a later time takes them as its velocity says. Errors of such a sensor
  /// stay for a while: values that come faster than the antenna turns count as much as one a turn.
  /// `plot_track_id` is of each value up to `max_plots` the track it most probably belongs to.
  ScanReport partial(const PartialScan& scan) noexcept;

  /// The vessel that a track is believed to be by its reports, or null; `time_s` is that of its
  /// last report.
  [[nodiscard]] const Identity* identity_of(const Track& track) const noexcept {
    return track.identity < 0 ? nullptr : &identities_[track.identity];
  }

  /// How probable it is that a track is the vessel of `identity_of`; 0 without one.
  [[nodiscard]] double identity_probability(const Track& track) const noexcept {
    const Identity* identity = identity_of(track);
    if (identity == nullptr) return 0.0;
    for (const Identity::Candidate& candidate : identity->candidates)
      if (candidate.is(track)) return identity->probability(candidate);
    return 0.0;
  }

  /// The track of the vessel that reports under an identity, or null.
  [[nodiscard]] const Track* find(std::string_view source,
                                  std::string_view identity) const noexcept {
    const int number = identities_.find(source, identity);
    const int slot = number < 0 ? -1 : slot_of_identity(number);
    return slot < 0 ? nullptr : &tracks_.at(slot);
  }

  /// Calls `f(track)` for every track, tentative and hushed ones too, older ones first. Each has
  /// the estimate of its own time; `kinematics_at` has all at one.
  template <class Function>
  void for_each(Function&& function) const {
    for (const int slot : tracks_.slots()) function(tracks_.at(slot));
  }

  [[nodiscard]] int size() const noexcept { return tracks_.size(); }

  /// The track of that number, or null.
  [[nodiscard]] const Track* find(std::int64_t id) const noexcept { return tracks_.find(id); }

  /// The estimator of a track of this tracker.
  [[nodiscard]] const Estimator& estimator_of(const Track& track) const noexcept {
    return estimator_of(track.slot);
  }

  /// The belief of a track of this tracker as it is reported, at a time such as `time_s()`, before
  /// its estimate at constant velocity; NaN where the time is not finite or so far ahead that the
  /// prediction fails. To the covariance of the estimator, `Track::kinematics`, it adds errors that
  /// stay from scan to scan and alterations of course that do not show yet (`reported`).
  [[nodiscard]] Gaussian<4> kinematics_at(const Track& track, double time_s) const noexcept;

  /// Until when a scan is processed and a target can be designated: an hour after the last scan, or
  /// ever before the first one. A time further ahead is of another clock. After a longer silence
  /// of the radar a scan without plots is needed an hour after the last one.
  [[nodiscard]] double latest_time_s() const noexcept {
    return started_ ? time_s_ + kLongestSilence_s : std::numeric_limits<double>::infinity();
  }

  /// Confirms the track in whose gate the operator points, or starts a confirmed one at rest, or
  /// with the velocity given, [north, east].
  ///
  /// Returns its number, or 0 when there is no room, a number is not finite or out of range or the
  /// time is too far ahead. Of several tracks the nearest is confirmed, in standard deviations; it
  /// is hushed no more. Where the tracker is full, the weakest tentative track is deleted for a new
  /// one, without an event.
  [[nodiscard]] std::int64_t designate(double time_s, double north_m, double east_m,
                                       double position_std_m,
                                       const std::optional<Gaussian<2>>& velocity = {}) noexcept;

  /// Deletes a track; false when there is none of that number. With `hush` its vessel is followed
  /// in silence, so that it does not start again under another number: the track is not shown, has
  /// no events and no plots reported, until its vessel is lost, it is designated or dropped again.
  bool drop(std::int64_t id, bool hush = false) noexcept {
    Track* track = tracks_.find(id);
    if (track == nullptr) return false;
    if (hush)
      track->hushed = true;
    else
      tracks_.remove(track->slot);
    return true;
  }

  /// Says that two tracks are of one vessel: the second is deleted, and the first takes its name if
  /// it has none. False when there are no two of these numbers.
  bool merge(std::int64_t id, std::int64_t other_id) noexcept {
    Track* track = tracks_.find(id);
    Track* other = tracks_.find(other_id);
    if (track == nullptr || other == nullptr || track == other) return false;
    if (track->label().empty()) track->name = other->name;
    tracks_.remove(other->slot);
    return true;
  }

  /// Names a track (31 bytes at most are kept, of UTF-8 whole letters); false when there is none of
  /// that number or the name is not UTF-8.
  bool rename(std::int64_t id, std::string_view name) noexcept {
    Track* track = tracks_.find(id);
    if (track == nullptr || !is_utf8(name)) return false;
    track->name.fill('\0');
    std::copy_n(name.begin(), whole_letters(name, track->name.size() - 1), track->name.begin());
    return true;
  }

  /// The whole state, to be restored by a tracker with the same settings and models that is
  /// compiled for the same instruction set.
  [[nodiscard]] std::vector<std::byte> save() const;

  /// Continues bit for bit from the saved tracker. False, and nothing changed, when the bytes are
  /// not the state of a tracker with the same settings and models.
  [[nodiscard]] bool restore(std::span<const std::byte> bytes);

  /// Continues bit for bit from another tracker with the same settings and models, as `restore`
  /// does from what it saved, also with its radars. No memory is taken where there are as many.
  void copy_state_from(const Tracker& other) noexcept {
    radars_ = other.radars_;
    at_hand_ = other.at_hand_;
    partial_s_ = other.partial_s_;
    time_s_ = other.time_s_;
    started_ = other.started_;
    full_ = other.full_;
    next_id_ = other.next_id_;
    next_tentative_id_ = other.next_tentative_id_;
    identities_ = other.identities_;
    tracks_.copy_from(other.tracks_);
    tracks_.for_each_slot([&](int slot) { estimator_at(slot) = other.estimator_of(slot); });
  }

  [[nodiscard]] const Estimator& prototype() const noexcept { return prototype_; }
  [[nodiscard]] const TrackerConfig& config() const noexcept { return config_; }

  /// Whether there was a scan.
  [[nodiscard]] bool started() const noexcept { return started_; }

  /// Time of the last scan; 0 before the first.
  [[nodiscard]] double time_s() const noexcept { return time_s_; }

 private:
  static constexpr double kDesignatedExistence = 0.999;
  /// A plot that many periods from its scan has a wrong clock.
  static constexpr double kClockPeriods = 10.0;
  static constexpr double kLongestSilence_s = 3600.0;  ///< of the radar
  static constexpr double kPointedPeriods = 2.0;       ///< a track is pointed at within so many
  static constexpr std::uint32_t kArchiveVersion = 11;
  /// Vessels per area that an identity may be of when it is not of the track at hand.
  static constexpr double kOtherVessels_per_m2 = 1e-8;
  static constexpr double kOtherVelocities_per_m2s2 = 1e-3;  ///< the same of velocities
  static constexpr double kMostReportEvidence = 4.0;         ///< of a report, log odds
  static constexpr double kReportGate = 16.0;                ///< squared standard deviations
  static constexpr double kPartialGate = 9.0;                ///< the same of a bearing or range
  static constexpr double kPartialDetection = 0.7;           ///< a target in view gives one
  static constexpr double kLeastPartialPeriods = 0.01;       ///< between two scans of such a sensor
  static constexpr double kViewMemory = 0.98;                ///< from scan to scan of such a sensor
  static constexpr double kSure = 0.9;  ///< a report updates a track that it is of by this much
  static constexpr double kSilentPeriods = 2.0;  ///< after which a track coasts by time
  static constexpr std::size_t kGroup = 32;      ///< tracks that are stepped together

  /// Calls `f(slots)` for a few tracks at a time, which stay in the cache from stage to stage.
  template <class Function>
  void for_each_group(std::span<const int> slots, const Function& function) {
    for (std::size_t first = 0; first < slots.size(); first += kGroup)
      function(slots.subspan(first, std::min(kGroup, slots.size() - first)));
  }

  /// Of the radar at hand.
  RadarState& state() noexcept { return radars_[static_cast<std::size_t>(at_hand_)]; }
  [[nodiscard]] const RadarState& state() const noexcept {
    return radars_[static_cast<std::size_t>(at_hand_)];
  }
  Look& look_at(const Track& track) noexcept { return state().look(track); }

  [[nodiscard]] int radars_in_use() const noexcept {
    return static_cast<int>(std::count_if(radars_.begin(), radars_.end(),
                                          [](const RadarState& radar) { return radar.in_use; }));
  }

  /// The longest period of all radars.
  [[nodiscard]] double longest_period_s() const noexcept {
    double longest_s = 0.0;
    for (const RadarState& radar : radars_)
      if (radar.in_use) longest_s = std::max(longest_s, radar.radar.period_s);
    return longest_s;
  }

  static constexpr std::array<double, kMostPartialSensors> never() noexcept {
    std::array<double, kMostPartialSensors> times{};
    times.fill(-std::numeric_limits<double>::infinity());
    return times;
  }

  /// `kNotFinite` of a time too long after the last scan, `kNegativeTimeStep` of one too long
  /// before.
  [[nodiscard]] Status status_of_time(double time_s) const noexcept {
    if (started_ && time_s > time_s_ + kOldestReport_s) return Status::kNotFinite;
    if (started_ && time_s < time_s_ - kOldestReport_s) return Status::kNegativeTimeStep;
    return Status::kOk;
  }

  ScanReport rejected(Status status) noexcept {
    events_.clear();
    plot_track_id_.clear();
    return {status, {}, {}, 0};
  }

  [[nodiscard]] const Estimator& estimator_of(int slot) const noexcept {
    return estimators_[static_cast<std::size_t>(slot)];
  }

  /// The belief of the estimator of a track at a time.
  [[nodiscard]] Gaussian<4> belief_at(const Track& track, double time_s) const noexcept {
    return wakeline::kinematics_at(track, estimator_of(track), time_s);
  }

  Estimator& estimator_at(int slot) noexcept { return estimators_[static_cast<std::size_t>(slot)]; }
  CandidatePlots& candidates_of(const Track& track) noexcept {
    return candidates_[static_cast<std::size_t>(track.slot)];
  }

  ScanReport step(int radar, double time_s, std::span<const Plot> plots,
                  const Sector* sector) noexcept;

  /// Moves the beam over a sector, or a whole turn without one, and takes the plots. Returns how
  /// many are taken.
  int sweep(const Sector* sector, std::span<const Plot> plots, double dt_s) noexcept {
    state().own.north_m += dt_s * state().own.vnorth_mps;
    state().own.east_m += dt_s * state().own.veast_mps;
    double half_rad = kPi<double>;
    if (sector != nullptr) {
      const double width_rad = Beam::width_rad(sector->from_rad, sector->to_rad);
      state().beam.sweep(sector->from_rad, width_rad, dt_s, state().radar.period_s);
      half_rad = width_rad / 2;
    } else {
      state().beam.turn();
    }
    const double middle_rad = state().beam.angle_rad() - half_rad;
    const int taken = state().plots.add(
        state().radar, plots, state().time_s,
        std::max(kClockPeriods * state().radar.period_s, dt_s), [&](const Plot& plot) {
          return sector == nullptr ? middle_rad : Beam::unwrapped(plot.bearing_rad, middle_rad);
        });
    if (sector != nullptr && sector->own && in_range(sector->own->position<double>()))
      state().own = *sector->own;
    else if (taken > 0)
      state().own =
          plots[static_cast<std::size_t>(state().plots[state().plots.size() - 1].input)].own;
    return taken;
  }

  /// Lists the tracks that are due and those that wait. A track is due when the beam has passed its
  /// gate; where it has a plot in the gate without outliers, when the beam has passed that.
  void list_due() noexcept {
    due_.clear();
    waiting_.clear();
    arcs_.clear();
    const double beam_rad = state().beam.angle_rad();
    for (const int slot : tracks_.slots()) {
      Track& track = tracks_.at(slot);
      Look& look = look_at(track);
      if (whole_turn_) {
        look.passed_rad = beam_rad - kPi<double>;
        look.look_rad = beam_rad;
        if (may_be_seen(track)) due_.push_back(slot);
        continue;
      }
      if (beam_rad < look.look_rad) continue;
      BeamArc arc = arc_of(track, config_.outlier_variance());
      if (arc.from_rad > beam_rad) continue;
      if (arc.to_rad > beam_rad) {
        const BeamArc usual = arc_of(track, 1.0);
        if (!state().beam.has_swept(usual) || !has_plot_near(track)) {
          waiting_.push_back(slot);
          continue;
        }
        arc = usual;
      }
      if (state().beam.has_swept(arc) && may_be_seen(track)) {
        due_.push_back(slot);
        arcs_.push_back(arc);
      } else {
        pass(track, arc);  // a part was left out
      }
    }
    if (!whole_turn_) defer();
  }

  [[nodiscard]] BeamArc arc_of(const Track& track, double plot_factor) const noexcept {
    return gate_arc(track, state().look(track).passed_rad, state().time_s, gate_.threshold(),
                    plot_factor, state().radar, state().own);
  }

  /// Whether the radar covers the place where a track is now, or has a plot there all the same.
  [[nodiscard]] bool may_be_seen(const Track& track) const noexcept {
    return is_covered(track) || has_plot_near(track);
  }

  /// Whether the radar covers the place where a track is now. A miss outside says nothing.
  [[nodiscard]] bool is_covered(const Track& track) const noexcept {
    return state().radar.covers_all() ||
           state().covers(track.position() + (state().time_s - track.time_s) * track.velocity());
  }

  [[nodiscard]] bool has_plot_near(const Track& track) const noexcept {
    bool found = false;
    for_each_near(track, [&](int) { found = true; });
    return found;
  }

  /// Notes that the beam has passed a track.
  void pass(Track& track, const BeamArc& arc) noexcept {
    Look& look = look_at(track);
    look.passed_rad = std::max(arc.centre_rad, state().beam.last_rad(arc.centre_rad) - Beam::kTurn);
    look.look_rad = next_look_rad(track, arc);
  }

  /// Has tracks wait that compete for a plot with one that waits, so that association is of both;
  /// for half of the time that the beam needs to reach their gate again.
  void defer() noexcept {
    is_contested_.assign(static_cast<std::size_t>(state().plots.size()), 0);
    const auto contest = [&](int slot) {
      for_each_near(tracks_.at(slot),
                    [&](int plot) { is_contested_[static_cast<std::size_t>(plot)] = 1; });
    };
    for (const int slot : waiting_) contest(slot);
    for (bool changed = !waiting_.empty(); changed;) {
      changed = false;
      std::size_t left = 0;
      for (std::size_t k = 0; k < due_.size(); ++k) {
        const BeamArc& arc = arcs_[k];
        const double longest_rad = (Beam::kTurn - (arc.to_rad - arc.from_rad)) / 2;
        bool waits = false;
        if (state().beam.angle_rad() < arc.to_rad + longest_rad)
          for_each_near(tracks_.at(due_[k]), [&](int plot) {
            waits = waits || is_contested_[static_cast<std::size_t>(plot)] != 0;
          });
        if (waits) {
          contest(due_[k]);
          waiting_.push_back(due_[k]);
          changed = true;
        } else {
          arcs_[left] = arc;
          due_[left++] = due_[k];
        }
      }
      due_.resize(left);
      arcs_.resize(left);
    }
    for (std::size_t k = 0; k < due_.size(); ++k) pass(tracks_.at(due_[k]), arcs_[k]);
  }

  /// Calls `f(plot)` for the plots in the gate of a track, those of outliers left out.
  template <class Function>
  void for_each_near(const Track& track, const Function& function) const noexcept {
    const Gaussian<4> now = at_constant_velocity(track.kinematics, state().time_s - track.time_s);
    for_each_in_reach(now, [&](int index) {
      const ScanPlot& plot = state().plots[index];
      const Gaussian<4> then = at_constant_velocity(track.kinematics, plot.time_s - track.time_s);
      if (innovation_squared(then, plot.position.mean, plot.position.covariance) <=
          gate_.threshold())
        function(index);
    });
  }

  /// Where the beam may reach the gate of a track again, with room for what both do in a turn.
  [[nodiscard]] double next_look_rad(const Track& track, const BeamArc& arc) const noexcept {
    const double range_m = (track.position() - state().position()).norm();
    const double way_m = kPointedPeriods * state().radar.max_speed_mps * state().radar.period_s;
    const double way_rad = way_m < range_m ? std::asin(way_m / range_m) : kPi<double>;
    const double wide_rad = arc.to_rad - arc.from_rad + way_rad;
    return arc.centre_rad + Beam::kTurn - std::min(wide_rad, kPi<double>);
  }

  /// Has the tracks that were designated before the first scan begin with it.
  void begin_looks() noexcept {
    for (const int slot : tracks_.slots()) {
      tracks_.at(slot).looked_s = time_s_;
      for (RadarState& radar : radars_) radar.look(tracks_.at(slot)).looked_s = time_s_;
    }
  }

  /// Existence and visibility of the tracks that are due, as of now.
  void predict_existence() noexcept {
    double of_s = 0.0;
    ExistencePrediction prediction(config_, of_s);
    const auto over = [&](double dt_s) -> const ExistencePrediction& {
      if (dt_s != of_s) prediction = ExistencePrediction(config_, of_s = dt_s);
      return prediction;
    };
    const double now_s = state().time_s;
    for (const int slot : due_) {
      Track& track = tracks_.at(slot);
      if (!is_covered(track)) continue;
      Look& look = look_at(track);
      look.visibility = over(std::max(now_s - look.looked_s, 0.0)).visibility(look.visibility);
      track.existence = over(std::max(now_s - track.looked_s, 0.0)).existence(track.existence);
      look.looked_s = now_s;
      track.looked_s = std::max(track.looked_s, now_s);
    }
  }

  /// Lets tracks coast by time that the beam has not passed for long; returns none that is due.
  void coast_by_time() noexcept {
    touched_.assign(touched_.size(), 0);
    for (const int slot : due_) touched_[static_cast<std::size_t>(slot)] = 1;
    const double period_s = longest_period_s();
    for (const int slot : tracks_.slots()) {
      Track& track = tracks_.at(slot);
      const double silent_s = time_s_ - track.looked_s;
      if (!(silent_s > kSilentPeriods * period_s) || is_awaited(track)) continue;
      const double periods = std::floor(silent_s / period_s) - kSilentPeriods + 1.0;
      if (!(time_s_ < track.seen_until_s))
        for (double k = 0.0; k < periods; ++k) track.count(false);
      track.looked_s += periods * period_s;
      const ExistencePrediction prediction(config_, periods * period_s);
      track.existence = prediction.existence(track.existence);
      for (RadarState& radar : radars_) {
        Look& look = radar.look(track);
        look.visibility = prediction.visibility(look.visibility);
        look.looked_s = std::max(look.looked_s, track.looked_s);
        look.misses += static_cast<int>(periods);
      }
      PredictionStep<Estimator> step{&estimator_at(slot), time_s_ - track.time_s};
      steps_.predict({&step, 1});
      touched_[static_cast<std::size_t>(slot)] = 1;
      track.nis = std::numeric_limits<double>::quiet_NaN();
      if (step.status != Status::kOk) continue;
      track.time_s = time_s_;
      track.kinematics = step.kinematics;
    }
  }

  /// Has the plots wait that may be of a track which waits, or ahead of the beam, and lists the
  /// tracks that wait and have a candidate in common with one that is due.
  void list_rivals() noexcept {
    rivals_.clear();
    if (!waiting_.empty()) {
      is_candidate_.assign(static_cast<std::size_t>(state().plots.size()), 0);
      for (const int slot : due_)
        for (const CandidatePlot& plot : candidates_of(tracks_.at(slot)))
          is_candidate_[static_cast<std::size_t>(plot.plot)] = 1;
    }
    for (const int slot : waiting_) {
      const Track& track = tracks_.at(slot);
      const Gaussian<4> now = at_constant_velocity(track.kinematics, state().time_s - track.time_s);
      bool is_rival = false;
      for_each_in_reach(now, [&](int plot) {
        state().plots.keep(plot);
        is_rival = is_rival || is_candidate_[static_cast<std::size_t>(plot)] != 0;
      });
      if (is_rival) rivals_.push_back(slot);
    }
    for (int plot = 0; plot < state().plots.size(); ++plot)
      if (std::max(state().plots[plot].beam_rad, state().plots[plot].wait_until_rad) >
          state().beam.angle_rad())
        state().plots.keep(plot);
  }

  /// Leaves a track the plots of one turn.
  ///
  /// Where the plots of a turn have one time, as in recordings, and the gate of a track is on both
  /// sides of where a turn ends, plots of two turns are in it. Those half a period after the first
  /// wait for the next turn.
  void choose_turn(const Track& track) noexcept {
    state().plots.hide_after(std::numeric_limits<double>::infinity());
    const double half_period_s = 0.5 * state().radar.period_s;
    if (!(state().time_s - state().plots.earliest_s() > half_period_s)) return;
    const Gaussian<4> now = at_constant_velocity(track.kinematics, state().time_s - track.time_s);
    double first_s = state().time_s;
    for_each_in_reach(now,
                      [&](int plot) { first_s = std::min(first_s, state().plots[plot].time_s); });
    for_each_in_reach(now, [&](int plot) {
      if (state().plots[plot].time_s > first_s + half_period_s)
        state().plots.keep_until(plot, state().beam.angle_rad() + Beam::kTurn);
    });
    state().plots.hide_after(first_s + half_period_s);
  }

  /// Calls `f(plot)` for the plots that may be in the gate of a belief, about.
  template <class Function>
  void for_each_in_reach(const Gaussian<4>& now, const Function& function) const noexcept {
    state().plots.for_each_near(
        {now.mean[0], now.mean[2]}, [&](double plot_m2) { return gate_reach_m(now, plot_m2); },
        function);
  }

  /// How far a plot of such a variance may be from a belief and in its gate, about.
  [[nodiscard]] double gate_reach_m(const Gaussian<4>& belief, double plot_m2) const noexcept {
    const double own_m2 = belief.covariance(0, 0) + belief.covariance(2, 2);
    return std::sqrt(gate_.threshold() * (own_m2 + config_.outlier_variance() * plot_m2));
  }

  /// Predicts tracks, each to the time of its plot.
  void predict(std::span<const int> slots) noexcept {
    std::array<PredictionStep<Estimator>, kGroup> steps;
    std::array<Track*, kGroup> track_of;
    std::array<double, kGroup> time_of;
    std::size_t count = 0;
    for (const int slot : slots) {
      const Track& track = tracks_.at(slot);
      if (!whole_turn_) choose_turn(track);
      const double time_s = expected_time_s(track, state().plots, state().radar.max_speed_mps);
      if (!(time_s > track.time_s)) continue;
      steps[count] = {&estimator_at(slot), time_s - track.time_s};
      track_of[count] = &tracks_.at(slot);
      time_of[count++] = time_s;
    }
    steps_.predict({steps.data(), count});
    for (std::size_t k = 0; k < count; ++k) {
      if (steps[k].status != Status::kOk) continue;
      track_of[k]->time_s = time_of[k];
      track_of[k]->kinematics = steps[k].kinematics;
    }
  }

  /// Gates of tracks, and the likelihoods of the plots inside.
  void find_candidates(std::span<const int> slots, bool due) noexcept {
    for (const int slot : slots) {
      const Track& track = tracks_.at(slot);
      CandidatePlots& candidates = candidates_of(track);
      if (!whole_turn_) choose_turn(track);
      modes_.read(estimator_at(slot));
      const TimeAlignment alignment(
          track, state().radar.period_s,
          maneuver_m2s3(track, state().plots.greatest_lag_s(track.time_s)));
      candidates.choose(gate_.validate(track, modes_, alignment, state().plots),
                        look_at(track).learned, modes_, config_.outlier_probability,
                        state().clutter, state().plots);
      // What a track that waits may own as an outlier is not known before it is due.
      if (!due)
        candidates.keep_if([&](const CandidatePlot& plot) {
          return innovation_squared(track.kinematics, plot.z, plot.nominal_r) <= gate_.threshold();
        });
      candidates.thin(state().ownership.free_probability());
      if (config_.association == Association::kProbabilistic)
        propagation_.claim(track, detection_of(track), candidates);
    }
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
    Estimator ahead = estimator_of(track);
    PredictionStep<Estimator> step{&ahead, dt_s};
    steps_.predict({&step, 1});
    if (step.status != Status::kOk) return Mat<double, 4, 4>::Zero();
    return step.kinematics.covariance - at_constant_velocity(track.kinematics, dt_s).covariance;
  }

  /// Assigns plots to tracks, where each may have one at most.
  void associate() noexcept {
    competing_.assign(due_.begin(), due_.end());
    competing_.insert(competing_.end(), rivals_.begin(), rivals_.end());
    if (config_.association == Association::kProbabilistic)
      propagation_.propagate(competing_);
    else
      assignment_.assign(state().detection_probability, state().looks, tracks_, competing_,
                         candidates_, state().plots.size());
  }

  [[nodiscard]] Detection detection_of(const Track& track) const noexcept {
    return state().detection_probability.of(state().look(track).visibility);
  }

  [[nodiscard]] AssociationWeights weights_of(const Track& track,
                                              const Detection& detection) noexcept {
    return config_.association == Association::kProbabilistic
               ? propagation_.weights(track, detection, candidates_of(track))
               : assignment_.weights(track, detection, candidates_of(track));
  }

  /// Updates estimators, existence and visibility of tracks, and adds to the ownership of plots.
  void update(std::span<const int> slots) noexcept {
    std::array<AssociationWeights, kGroup> weights;
    std::array<UpdateStep<Estimator>, kGroup> steps;
    std::array<const UpdateStep<Estimator>*, kGroup> step_of{};  ///< null of a track without plots
    std::size_t count = 0;
    for (std::size_t k = 0; k < slots.size(); ++k) {
      const Track& track = tracks_.at(slots[k]);
      weights[k] = weights_of(track, detection_of(track));
      readings_[k].list(candidates_of(track), weights[k], config_.outlier_probability);
      if (readings_[k].empty()) continue;
      steps[count] = {&estimator_at(slots[k]), readings_[k].fixes(), weights[k].none,
                      readings_[k].share()};
      step_of[k] = &steps[count++];
    }
    steps_.update({steps.data(), count});
    for (std::size_t k = 0; k < slots.size(); ++k) {
      Track& track = tracks_.at(slots[k]);
      const Detection detection = detection_of(track);
      const AssociationProbabilities probabilities = readings_[k].probabilities();
      note_best_plot(track, probabilities);
      ScanLikelihood scan{weights[k].none, weights[k].none, weights[k].assigned};
      if (step_of[k] != nullptr) {
        track.kinematics = step_of[k]->kinematics;
        if (step_of[k]->total > 0.0) scan.total = step_of[k]->total;
        note_errors(track, probabilities);
      }
      const bool may_miss = !is_awaited(track) && is_covered(track);
      if (scan.total > 0.0 && (may_miss || !readings_[k].empty()))
        update_existence(config_, detection, scan, track, look_at(track).visibility);
      state().ownership.add(track, candidates_of(track), weights[k], probabilities);
      const bool seen = probabilities.any > 0.5;
      if (!seen && !may_miss) continue;
      const bool shared = !seen && seen_alone(detection_of(track), candidates_of(track)) > 0.5;
      note_look(track, seen, shared);
      if (!shared && is_sure(track)) state().detection_probability.learn(probabilities.any);
    }
  }

  /// Counts a look of the radar at hand, unless it is a miss of a track that another sensor sees.
  void note_look(Track& track, bool seen, bool shared) noexcept {
    constexpr double kPeriods = 0.9;  // before the same radar looks again
    const double now_s = state().time_s;
    Look& look = look_at(track);
    look.misses = seen ? 0 : look.misses + 1;
    if (seen || !(now_s < track.seen_until_s)) track.count(seen, shared);
    if (seen) track.looked_s = std::max(track.looked_s, now_s);
    if (seen && radars_.size() > 1)
      track.seen_until_s = std::max(track.seen_until_s, now_s + kPeriods * state().radar.period_s);
  }

  /// Whether a track is of a target that is there, so that its misses are those of the radar.
  [[nodiscard]] bool is_sure(const Track& track) const noexcept {
    constexpr int kScans = 8, kMisses = 6;
    return track.confirmed() && track.scans > kScans && state().look(track).misses < kMisses;
  }

  /// Notes what a track keeps of its most probable plot, before the track takes the updated belief.
  void note_best_plot(Track& track, const AssociationProbabilities& probabilities) noexcept {
    track.nis = std::numeric_limits<double>::quiet_NaN();
    if (probabilities.best < 0) return;
    const CandidatePlot& best = candidates_of(track)[std::size_t(probabilities.best)];
    track.nis = innovation_squared(track.kinematics, best.z, best.nominal_r);
    track.plot_m2 = state().plots[best.plot].position.covariance.trace() / 2;
  }

  /// Notes what stays of the errors of its most probable plot, and learns from it.
  void note_errors(Track& track, const AssociationProbabilities& probabilities) noexcept {
    if (probabilities.best < 0) return;
    const auto at = static_cast<std::size_t>(probabilities.best);
    const CandidatePlot& best = candidates_of(track)[at];
    PersistentErrors& errors = state().persistent_errors;
    constexpr double kCertain = 0.7;
    if (is_sure(track) && probabilities.of_candidate[at] > kCertain) errors.learn(track.nis);
    const ConvertedErrors& of_plot = state().plots[best.plot].errors;
    const Vec<double, 2> antenna_m(of_plot.antenna_north_m, of_plot.antenna_east_m);
    const Mat<double, 2, 2> position_m2 = position_in(track.kinematics).covariance;
    track.stays_m2 = errors.share() * (best.nominal_r + position_m2) +
                     bent_m2(track.position() - antenna_m, position_m2);
  }

  /// Whether a track was designated for a time to which the scans have not come yet: until then it
  /// misses none.
  [[nodiscard]] bool is_awaited(const Track& track) const noexcept {
    return track.time_s > time_s_ && track.time_s <= latest_time_s();
  }

  void confirm_and_delete() noexcept {
    const double shown_misses =
        state().detection_probability.likely_misses(config_.shown_probability);
    tracks_.remove_if([&](Track& track) {
      if (touched_[static_cast<std::size_t>(track.slot)] == 0) return false;
      if (confirm_or_coast(config_, state().radar, shown_misses, track))
        announce(TrackEvent::kCoasting, track);
      LossReason reason = reason_to_delete(config_, state().radar, track);
      if (reason == LossReason::kUncertain && time_s_ < track.seen_until_s)
        reason = LossReason::kNone;  // its vessel will report
      if (reason != LossReason::kNone) announce(TrackEvent::kLost, track, reason);
      return reason != LossReason::kNone;
    });
    std::erase_if(due_, [&](int slot) { return !tracks_.in_use(slot); });
  }

  void delete_duplicates() noexcept {
    for (const int slot : duplicates_.find(tracks_, due_, longest_period_s())) {
      announce(TrackEvent::kLost, tracks_.at(slot), LossReason::kDuplicate);
      tracks_.vacate(slot);
    }
    tracks_.close_gaps();
    std::erase_if(due_, [&](int slot) { return !tracks_.in_use(slot); });
  }

  /// Numbers the tracks that were confirmed in this scan.
  void number_confirmed() noexcept {
    for (const int slot : tracks_.slots()) {
      Track& track = tracks_.at(slot);
      if (!track.confirmed() || track.id > 0) continue;
      track.id = next_id_++;
      announce(TrackEvent::kConfirmed, track);
    }
  }

  /// Starts tentative tracks.
  void initiate() noexcept {
    newest_before_ = next_tentative_id_ + 1;
    room_.reset();
    state().initiation.initiate(
        state().radar, state().plots, state().ownership, state().clutter,
        state().detection_probability.value(), state().beam.angle_rad(), whole_turn_,
        [&](double existence) { return room_.has_room_for(existence, tracks_); },
        [&](const TrackStart& start) {
          Track* track = open(start);
          if (track == nullptr) return;
          track->history = 3u;
          Look& look = look_at(*track);
          look.passed_rad = look.look_rad = start.beam_rad;
          look.learned = start.learned;
        });
    tracks_.close_gaps();
    for (const int slot : tracks_.slots())
      if (is_new(tracks_.at(slot))) announce(TrackEvent::kStarted, tracks_.at(slot));
    newest_before_ = next_tentative_id_ + 1;
  }

  /// Whether a track has started in this scan: tentative tracks count downwards.
  [[nodiscard]] bool is_new(const Track& track) const noexcept { return track.id < newest_before_; }

  /// A new tentative track, for which there is room; null when its estimator cannot start.
  Track* open(const TrackStart& start) noexcept {
    Estimator estimator = prototype_;
    if (estimator.start(start.belief) != Status::kOk) return nullptr;
    if (tracks_.full()) {
      const int weakest = room_.make_room();
      if (!is_new(tracks_.at(weakest)))
        announce(TrackEvent::kLost, tracks_.at(weakest), LossReason::kDisplaced);
      tracks_.vacate(weakest);
    }
    Track& track = tracks_.open();
    estimator_at(track.slot) = estimator;
    track.id = track.tentative_id = track.birth = next_tentative_id_--;
    track.time_s = start.time_s;
    track.looked_s = time_s_;
    track.kinematics = start.belief;
    track.plot_m2 = track.position_variance_m2();
    track.existence = track.start_existence = start.existence;
    track.scans = track.hits = 2;
    for (RadarState& radar : radars_) radar.open(track, time_s_);
    room_.add(track);
    return &track;
  }

  /// Makes a track one that the operator has seen.
  void confirm_designated(Track& track) noexcept {
    track.existence = std::max(track.existence, kDesignatedExistence);
    track.hits = std::max(track.hits, config_.confirm_hits);
    track.scans = std::max(track.scans, track.hits);
    track.misses = 0;
    track.hushed = false;
    track.status = TrackStatus::kConfirmed;
    if (track.id <= 0) track.id = next_id_++;
  }

  /// Moves what was measured so long ago along with a track.
  [[nodiscard]] TimeAlignment alignment_over(const Track& track, double late_s) noexcept {
    const double period_s = longest_period_s();
    return {track, period_s, late_s > period_s ? maneuver_m2s3(track, late_s) : 0.0};
  }

  /// Of the position of a report, per axis, with the extent of the vessel.
  [[nodiscard]] double variance_m2(const PositionReport& report) const noexcept {
    const double extent_m = state().radar.extent_std_m;
    return report.position_std_m * report.position_std_m + extent_m * extent_m;
  }

  /// The position of a report so long after it, as a track moves.
  [[nodiscard]] Gaussian<2> reported_position(const PositionReport& report, const Track& track,
                                              double late_s) noexcept {
    return {report.position_m + late_s * track.velocity(),
            variance_m2(report) * Mat<double, 2, 2>::Identity() +
                alignment_over(track, late_s).added_m2(late_s)};
  }

  /// The same of position and velocity, moved by the velocity that it reports. What the target may
  /// have maneuvered since makes it less certain, by the models of the track.
  [[nodiscard]] Gaussian<4> reported_kinematics(const PositionReport& report, const Track& track,
                                                double late_s) noexcept {
    const double position_m2 = variance_m2(report);
    const double velocity_m2s2 = report.velocity_std_mps * report.velocity_std_mps;
    Gaussian<4> then;
    then.mean << report.position_m[0], report.velocity_mps[0], report.position_m[1],
        report.velocity_mps[1];
    then.covariance =
        Vec<double, 4>(position_m2, velocity_m2s2, position_m2, velocity_m2s2).asDiagonal();
    if (!(late_s > 0.0)) return then;
    Gaussian<4> now = at_constant_velocity(then, late_s);
    const Mat<double, 4, 4> added = maneuver_covariance(track, late_s);
    const double added_m2 = std::max((added(0, 0) + added(2, 2)) / 2, 0.0);
    const double added_m2s2 = std::max((added(1, 1) + added(3, 3)) / 2, 0.0);
    const double most = 0.99 * std::sqrt(added_m2 * added_m2s2);
    const double common = std::clamp((added(0, 1) + added(2, 3)) / 2, -most, most);
    for (const int k : {0, 2}) {
      now.covariance(k, k) += added_m2;
      now.covariance(k + 1, k + 1) += added_m2s2;
      now.covariance(k, k + 1) += common;
      now.covariance(k + 1, k) += common;
    }
    return now;
  }

  /// Whether a track may be the one that reports, about: so far a vessel runs off its course.
  [[nodiscard]] bool is_about(const Track& track, const PositionReport& report) const noexcept {
    constexpr double kSigmas = 8.0;
    const double dt_s = report.time_s - track.time_s;
    const double off_m = (track.position() + dt_s * track.velocity() - report.position_m).norm();
    return off_m <=
           kSigmas * (track.position_std_m() + report.position_std_m + state().radar.extent_std_m) +
               state().radar.max_speed_mps * std::abs(dt_s);
  }

  /// Weighs all tracks by a report, and notes which of them it agrees with, in `due_`. Where it
  /// fits several, the better ones gain as much on the others as their likelihoods differ.
  void weigh_identity(const PositionReport& report, Identity& identity) noexcept {
    due_.clear();
    evidence_.assign(tracks_.slots().size(), -std::numeric_limits<double>::infinity());
    for (Identity::Candidate& candidate : identity.candidates)
      if (candidate.slot >= 0 &&
          !(tracks_.in_use(candidate.slot) && candidate.is(tracks_.at(candidate.slot))))
        candidate = {};
    double best = 0.0;
    for (std::size_t k = 0; k < evidence_.size(); ++k) {
      const Track& track = tracks_.at(tracks_.slots()[k]);
      if (!is_about(track, report)) continue;
      const Gaussian<2> then = position_in(belief_at(track, report.time_s));
      const Gaussian<2> fix = reported_position(report, track, 0.0);
      const Cholesky<2> factor(fix.covariance + then.covariance);
      if (!factor.ok()) continue;
      const double distance = factor.squared_norm(fix.mean - then.mean);
      evidence_[k] = -0.5 * (distance + factor.log_determinant()) -
                     std::log(2.0 * kPi<double> * kOtherVessels_per_m2);
      best = std::max(best, evidence_[k]);
      if (distance <= kReportGate) due_.push_back(track.slot);
    }
    const double excess = std::max(best - kMostReportEvidence, 0.0);
    for (std::size_t k = 0; k < evidence_.size(); ++k) {
      const Track& track = tracks_.at(tracks_.slots()[k]);
      const double evidence = std::max(evidence_[k] - excess, -kMostReportEvidence);
      const bool known = std::any_of(identity.candidates.begin(), identity.candidates.end(),
                                     [&](const auto& candidate) { return candidate.is(track); });
      if (known || evidence > 0.0) identity.weigh(track, evidence);
    }
  }

  /// Predicts a track to a time after its own.
  void predict_to(Track& track, double time_s) noexcept {
    if (!(time_s > track.time_s)) return;
    PredictionStep<Estimator> step{&estimator_at(track.slot), time_s - track.time_s};
    steps_.predict({&step, 1});
    if (step.status != Status::kOk) return;
    track.time_s = time_s;
    track.kinematics = step.kinematics;
  }

  /// The slot of the track that has an identity; -1 where none has.
  [[nodiscard]] int slot_of_identity(int number) const noexcept {
    for (const int slot : tracks_.slots())
      if (tracks_.at(slot).identity == number) return slot;
    return -1;
  }

  /// Gives the identity to the track that it is believed to be; null when there is none.
  Track* identify(int number) noexcept {
    Identity& identity = identities_[number];
    const int slot = slot_of_identity(number);
    Track* before = slot < 0 ? nullptr : &tracks_.at(slot);
    const Identity::Candidate* best = identity.likeliest();
    Track* now =
        best != nullptr && identity.probability(*best) > 0.5 ? &tracks_.at(best->slot) : nullptr;
    if (now == before) return now;
    if (before != nullptr) {
      before->identity = -1;
      announce(TrackEvent::kIdentityLost, before, identity);
    }
    if (now == nullptr) return nullptr;
    if (now->identity >= 0) {
      announce(TrackEvent::kIdentityShared, now, identity);
      if (identity_probability(*now) >= identity.probability(*best)) return nullptr;
    }
    now->identity = number;
    announce(TrackEvent::kIdentified, now, identity);
    return now;
  }

  /// Updates a track by a report of its vessel, which it is with that probability.
  void take_report(const PositionReport& report, const Identity& identity, double probability,
                   Track& track) noexcept {
    predict_to(track, report.time_s);
    Estimator& estimator = estimator_at(track.slot);
    const double late_s = track.time_s - report.time_s;
    const auto update = [&]<class Sensor>(const Alternative<Sensor>& reading) {
      double share = 0.0;
      (void)estimator.update(std::span(&reading, 1), 1.0 - probability, std::span(&share, 1));
    };
    const auto update_position = [&] {
      const Gaussian<2> now = reported_position(report, track, late_s);
      update(Alternative<Fix>{Fix{now.covariance}, now.mean, probability / kOtherVessels_per_m2});
    };
    if constexpr (requires(std::span<const Alternative<KinematicFix>> reading,
                           std::span<double> share) { estimator.update(reading, 1.0, share); }) {
      if (report.has_velocity()) {
        const Gaussian<4> now = reported_kinematics(report, track, late_s);
        update(Alternative<KinematicFix>{
            KinematicFix{now.covariance}, now.mean,
            probability / (kOtherVessels_per_m2 * kOtherVelocities_per_m2s2)});
      } else {
        update_position();
      }
    } else {
      update_position();
    }
    track.kinematics = kinematics_of(estimator.estimate());
    note_report(identity, probability, track);
  }

  /// The vessel of a track is there, and may be silent for a while.
  void note_report(const Identity& identity, double probability, Track& track) noexcept {
    track.existence = 1.0 - (1.0 - track.existence) * (1.0 - probability);
    track.count(true);
    track.seen_until_s = std::max(track.seen_until_s, identity.time_s + identity.patience_s());
    track.status = TrackStatus::kConfirmed;
    if (track.id <= 0) number_confirmed();
  }

  /// Starts a track of a vessel that reports where no radar has seen it.
  Track* start_reported(const PositionReport& report, Identity& identity) noexcept {
    Gaussian<2> velocity = state().initiation.prior_velocity(state().radar);
    if (report.has_velocity())
      velocity = {report.velocity_mps, report.velocity_std_mps * report.velocity_std_mps *
                                           Mat<double, 2, 2>::Identity()};
    const Gaussian<2> position{report.position_m, report.position_std_m * report.position_std_m *
                                                      Mat<double, 2, 2>::Identity()};
    room_.reset();
    if (!room_.has_room_for(kDesignatedExistence, tracks_)) return nullptr;
    newest_before_ = next_tentative_id_ + 1;
    Track* track = open({kinematics_from<double>(position, velocity, Mat<double, 2, 2>::Zero()),
                         report.time_s,
                         state().beam.angle_rad(),
                         kDesignatedExistence,
                         {}});
    tracks_.close_gaps();
    newest_before_ = next_tentative_id_ + 1;
    if (track == nullptr) return nullptr;
    announce(TrackEvent::kStarted, *track);
    identity.weigh(*track, Identity::kMostLogOdds);
    return track;
  }

  /// Reports whose the plots are, by the numbers that the tracks have now.
  void report_owners(std::size_t count) noexcept {
    plot_track_id_.assign(count, 0);
    for (int plot = 0; plot < state().plots.size(); ++plot) {
      const PlotOwnership::Owner& owner = state().ownership.owner(plot);
      if (state().plots[plot].input < 0 || owner.slot < 0 || !tracks_.in_use(owner.slot)) continue;
      const Track& track = tracks_.at(owner.slot);
      if (track.hushed) continue;
      if (track.id == owner.track_id || track.tentative_id == owner.track_id)
        plot_track_id_[static_cast<std::size_t>(state().plots[plot].input)] = track.id;
    }
  }

  /// Reports that `max_tracks` is reached, once until there is room again.
  void report_room() noexcept {
    if (tracks_.full() && !full_ && events_.size() < events_.capacity())
      events_.push_back({TrackEvent::kFull, 0, 0, time_s_});
    full_ = tracks_.full();
  }

  /// The track nearest to a position at a time, in standard deviations, if it is in its gate; null
  /// without one.
  Track* track_at(const Gaussian<2>& position, double time_s) noexcept {
    Track* nearest = nullptr;
    double least = gate_.threshold();
    for (const int slot : tracks_.slots()) {
      Track& track = tracks_.at(slot);
      const double dt_s = time_s - track.time_s;
      if (std::abs(dt_s) > kPointedPeriods * longest_period_s()) continue;
      const double distance = innovation_squared(at_constant_velocity(track.kinematics, dt_s),
                                                 position.mean, position.covariance);
      if (distance <= least) {
        least = distance;
        nearest = &track;
      }
    }
    return nearest;
  }

  /// The vessel that is believed to be on a track has changed, or what it reports.
  void announce(TrackEvent kind, const Track* track, const Identity& identity) noexcept {
    if (events_.size() < events_.capacity() && (track == nullptr || !track->hushed))
      events_.push_back({kind, track == nullptr ? 0 : track->id,
                         track == nullptr ? 0 : track->tentative_id, time_s_, LossReason::kNone,
                         identity.name});
  }

  void announce(TrackEvent kind, const Track& track,
                LossReason reason = LossReason::kNone) noexcept {
    if (events_.size() < events_.capacity() && !track.hushed)
      events_.push_back({kind, track.id, track.tentative_id, time_s_, reason});
  }

  /// Saves or restores; the settings are compared, not restored.
  void archive(Archive& fields) {
    std::uint32_t version = kArchiveVersion;
    std::uint64_t models = fingerprint(prototype_);
    const std::uint64_t own_models = models;
    fields(version);
    fields(models);
    if (version != kArchiveVersion || models != own_models) fields.fail();
    fields.rules(config_);
    auto count = static_cast<std::uint64_t>(radars_.size());
    fields(count);
    if (count != radars_.size()) fields.fail();
    if (!fields.ok()) return;
    for (const RadarState& radar : radars_) {
      bool in_use = radar.in_use;
      fields(in_use);
      if (in_use != radar.in_use) fields.fail();
      if (radar.in_use) fields.rules(radar.radar);
    }
    if (!fields.ok()) return;
    fields(at_hand_);
    if (!has_radar(at_hand_)) fields.fail();
    if (!fields.ok()) return;
    fields(partial_s_);
    fields(time_s_);
    fields(started_);
    fields(full_);
    fields(next_id_);
    fields(next_tentative_id_);
    identities_.archive(fields);
    tracks_.archive(fields);
    if (!fields.ok()) return;
    for (RadarState& radar : radars_)
      if (radar.in_use) radar.archive(fields, tracks_.slots());
    if (!fields.ok()) return;
    for (const int slot : tracks_.slots()) estimator_at(slot).archive(fields);
  }

  TrackerConfig config_;
  Estimator prototype_;
  Steps steps_;

  std::vector<RadarState> radars_;  ///< by number
  int at_hand_ = 0;                 ///< number of the radar of this call

  Identities identities_;
  TrackList tracks_;
  std::vector<Estimator> estimators_;  ///< by slot
  double time_s_ = 0.0;                ///< of the last scan of any radar
  bool started_ = false;
  bool full_ = false;  ///< since the event that says so
  std::int64_t next_id_ = 1;
  std::int64_t next_tentative_id_ = -1;
  std::int64_t newest_before_ = 0;  ///< number of the newest tentative track before this scan

  bool whole_turn_ = true;      ///< of this call
  std::vector<int> due_;        ///< slots of the tracks whose gate the beam has passed
  std::vector<int> waiting_;    ///< and of those whose gate it is in
  std::vector<int> rivals_;     ///< of these that have a candidate in common with one that is due
  std::vector<int> competing_;  ///< both
  std::array<double, kMostPartialSensors> partial_s_ = never();  ///< when each gave values last
  std::vector<PartOfPosition> parts_;     ///< what such a sensor sees of the tracks at hand
  std::vector<double> value_likelihood_;  ///< by value of a partial scan, of all tracks
  std::vector<double> value_best_;        ///< and of the likeliest
  std::vector<double> evidence_;          ///< by place in the list of tracks, of a report
  std::vector<char> touched_;             ///< by slot: whether this call has counted for the track
  std::vector<BeamArc> arcs_;             ///< of the tracks that are due
  std::vector<char> is_contested_;        ///< by plot: a track that waits competes for it
  std::vector<char> is_candidate_;        ///< by plot: of a track that is due

  // The stages of a scan, in order
  ModePositions modes_;  ///< of the track at hand
  TrackGate gate_;
  std::vector<CandidatePlots> candidates_;  ///< by slot
  BeliefPropagation propagation_;
  PlotAssignment assignment_;
  std::array<TrackReadings, kGroup> readings_;  ///< of the tracks at hand
  Duplicates duplicates_;
  TrackRoom room_;
  std::vector<std::int64_t> plot_track_id_;
  std::vector<Event> events_;
};

// Not inline, so that a program with `extern template class Tracker<...>` does not compile them.

template <class Estimator, class Steps>
Tracker<Estimator, Steps>::Tracker(std::span<const Radar> radars, const TrackerConfig& config,
                                   const Estimator& prototype)
    : config_(validated(config)),
      prototype_(prototype),
      steps_(prototype),
      identities_(2 * config.max_tracks),
      tracks_(config.max_tracks),
      estimators_(static_cast<std::size_t>(config.max_tracks), prototype),
      gate_(config),
      candidates_(static_cast<std::size_t>(config.max_tracks)),
      propagation_(config),
      assignment_(config),
      duplicates_(config, gate_.threshold()),
      room_(config.max_tracks) {
  require(!radars.empty(), "radars", "one Radar at least", 0);
  for (const Radar& radar : radars) add_radar(radar);
  const auto plots = static_cast<std::size_t>(config.max_plots);
  for (std::vector<int>* slots : {&due_, &waiting_, &rivals_, &competing_})
    slots->reserve(estimators_.size());
  touched_.resize(estimators_.size());
  arcs_.reserve(estimators_.size());
  evidence_.reserve(estimators_.size());
  parts_.reserve(estimators_.size());
  value_likelihood_.reserve(plots);
  value_best_.reserve(plots);
  is_candidate_.reserve(plots);
  is_contested_.reserve(plots);
  plot_track_id_.reserve(plots);
  events_.reserve(4 * estimators_.size() + plots + 1);
}

template <class Estimator, class Steps>
int Tracker<Estimator, Steps>::add_radar(const Radar& radar) {
  auto place = std::find_if(radars_.begin(), radars_.end(),
                            [](const RadarState& known) { return !known.in_use; });
  require(place != radars_.end() || radars_.size() < kMostRadars, "radar",
          "at most kMostRadars radars", static_cast<int>(radars_.size()) + 1);
  RadarState state(validated(radar), config_);
  place = place == radars_.end() ? radars_.insert(place, std::move(state))
                                 : (*place = std::move(state), place);
  for (const int slot : tracks_.slots()) place->open(tracks_.at(slot), time_s_);
  return static_cast<int>(place - radars_.begin());
}

template <class Estimator, class Steps>
ScanReport Tracker<Estimator, Steps>::step(int radar, double time_s, std::span<const Plot> plots,
                                           const Sector* sector) noexcept {
  if (!has_radar(radar)) return rejected(Status::kNotFinite);
  const RadarState& before = radars_[static_cast<std::size_t>(radar)];
  time_s = before.radar.true_time_s(time_s);
  if (!std::isfinite(time_s) || time_s > latest_time_s()) return rejected(Status::kNotFinite);
  if (before.started && time_s < before.time_s) return rejected(Status::kNegativeTimeStep);
  if (started_ && time_s < time_s_ - before.radar.period_s)
    return rejected(Status::kNegativeTimeStep);
  events_.clear();
  plot_track_id_.clear();
  at_hand_ = radar;
  whole_turn_ = sector == nullptr;
  const double dt_s = state().started ? time_s - state().time_s : 0.0;
  time_s_ = started_ ? std::max(time_s_, time_s) : time_s;
  if (!started_) begin_looks();
  started_ = state().started = true;
  state().time_s = time_s;

  const int taken = sweep(sector, plots, dt_s);
  state().detection_probability.evaluate();
  state().clutter.evaluate(state().plots, whole_turn_ ? dt_s : state().radar.period_s,
                           state().radar.period_s);
  propagation_.clear(state().plots.size());
  state().ownership.extend(state().plots.size());

  list_due();
  predict_existence();
  coast_by_time();
  for_each_group(due_, [&](std::span<const int> slots) {
    predict(slots);
    find_candidates(slots, true);
  });
  state().plots.hide_after(std::numeric_limits<double>::infinity());
  list_rivals();
  for_each_group(rivals_, [&](std::span<const int> slots) {
    predict(slots);
    find_candidates(slots, false);
  });
  state().plots.hide_after(std::numeric_limits<double>::infinity());
  associate();
  for_each_group(due_, [&](std::span<const int> slots) { update(slots); });

  confirm_and_delete();
  delete_duplicates();
  number_confirmed();
  state().clutter.learn(
      state().plots, state().ownership.clutter_probability(),
      [&](int slot) { return state().ownership.plot_of(slot); }, state().looks, due_);
  initiate();
  report_room();
  state().clutter.learn_rings(state().plots, state().ownership.free_probability(), dt_s,
                              whole_turn_ ? 1.0 : dt_s / state().radar.period_s);

  report_owners(std::min(plots.size(), static_cast<std::size_t>(config_.max_plots)));
  state().ownership.drop_settled(state().plots);
  state().plots.drop_settled();
  return {Status::kOk, plot_track_id_, events_, static_cast<int>(plots.size()) - taken};
}

template <class Estimator, class Steps>
Gaussian<4> Tracker<Estimator, Steps>::kinematics_at(const Track& track,
                                                     double time_s) const noexcept {
  return reported(belief_at(track, time_s), track.stays_m2);
}

template <class Estimator, class Steps>
std::int64_t Tracker<Estimator, Steps>::designate(
    double time_s, double north_m, double east_m, double position_std_m,
    const std::optional<Gaussian<2>>& velocity) noexcept {
  if (!std::isfinite(time_s) || time_s > latest_time_s()) return 0;
  const Gaussian<2> position{{north_m, east_m},
                             position_std_m * position_std_m * Mat<double, 2, 2>::Identity()};
  if (!in_range(position.mean) || !(position_std_m > 0.0) || !in_range(position_std_m)) return 0;
  if (velocity && !(in_range(velocity->mean) && in_range(std::sqrt(velocity->covariance.trace())) &&
                    Cholesky<2>(velocity->covariance).ok()))
    return 0;
  if (Track* known = track_at(position, time_s)) {
    confirm_designated(*known);
    return known->id;
  }
  const Gaussian<4> belief = kinematics_from<double>(
      position, velocity.value_or(state().initiation.prior_velocity(state().radar)),
      Mat<double, 2, 2>::Zero());
  room_.reset();
  if (!room_.has_room_for(kDesignatedExistence, tracks_)) return 0;
  Track* track = open({belief, time_s, state().beam.angle_rad(), kDesignatedExistence, {}});
  tracks_.close_gaps();
  if (track == nullptr) return 0;
  track->tentative_id = 0;
  track->scans = track->hits = 0;
  confirm_designated(*track);
  return track->id;
}

template <class Estimator, class Steps>
ReportResult Tracker<Estimator, Steps>::report(const PositionReport& report) noexcept {
  events_.clear();
  plot_track_id_.clear();
  if (!report.is_valid()) return {Status::kNotFinite, 0, {}};
  if (const Status status = status_of_time(report.time_s); status != Status::kOk)
    return {status, 0, {}};
  const int number = identities_.find_or_add(report.source, report.identity);
  Identity& identity = identities_[number];
  if (!(report.time_s > identity.time_s)) return {Status::kNegativeTimeStep, 0, {}};
  if (!identity.reported())
    if (const int slot = slot_of_identity(number); slot >= 0) tracks_.at(slot).identity = -1;

  const bool jumped_before = identity.jumps;
  identity.note(report, state().radar.max_speed_mps);
  weigh_identity(report, identity);
  Track* track = identify(number);
  if (track == nullptr && due_.empty() && identity.in_a_row > 0) {
    track = start_reported(report, identity);
    if (track != nullptr) {
      (void)identify(number);
      note_report(identity, kSure, *track);
      return {Status::kOk, track->id, events_};
    }
  }
  if (identity.jumps && !jumped_before) announce(TrackEvent::kIdentityJumps, track, identity);
  if (track == nullptr) return {Status::kGated, 0, events_};
  const bool agrees = std::find(due_.begin(), due_.end(), track->slot) != due_.end();
  if (!agrees && !identity.disagrees) announce(TrackEvent::kIdentityDisagrees, track, identity);
  identity.disagrees = !agrees;
  const double probability = identity_probability(*track);
  if (!agrees || identity.jumps || probability < kSure) return {Status::kGated, track->id, events_};
  take_report(report, identity, probability, *track);
  return {Status::kOk, track->id, events_};
}

template <class Estimator, class Steps>
ScanReport Tracker<Estimator, Steps>::partial(const PartialScan& given) noexcept {
  PartialScan scan = given;
  if (!scan.is_valid()) return rejected(Status::kNotFinite);
  if (const Status status = status_of_time(scan.time_s); status != Status::kOk)
    return rejected(status);
  double& before_s = partial_s_[static_cast<std::size_t>(scan.sensor)];
  const double periods = std::abs(scan.time_s - before_s) / longest_period_s();
  scan.std /= std::sqrt(std::clamp(periods, kLeastPartialPeriods, 1.0));
  before_s = std::max(before_s, scan.time_s);
  events_.clear();
  const std::span<const double> values =
      scan.values.first(std::min(scan.values.size(), static_cast<std::size_t>(config_.max_plots)));
  plot_track_id_.assign(values.size(), 0);
  const double extent_m = state().radar.extent_std_m;
  // How likely each value is by all tracks, and by the one by which it is likeliest.
  value_likelihood_.assign(values.size(), 0.0);
  value_best_.assign(values.size(), 0.0);
  due_.clear();
  parts_.clear();
  for (const int slot : tracks_.slots()) {
    const Track& track = tracks_.at(slot);
    if (!track.active()) continue;
    const PartOfPosition& part =
        parts_.emplace_back(scan, position_in(belief_at(track, scan.time_s)), extent_m);
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!(part.squared_distance(values[k]) <= kPartialGate)) continue;
      const double likelihood = part.likelihood(values[k]);
      value_likelihood_[k] += likelihood;
      if (likelihood > value_best_[k]) {
        value_best_[k] = likelihood;
        plot_track_id_[k] = track.id;
      }
    }
    due_.push_back(slot);
  }
  const auto others_than = [&](const PartOfPosition& part, std::size_t k) {
    return std::max(value_likelihood_[k] - part.likelihood(values[k]), 0.0) + scan.false_per_unit;
  };
  for (std::size_t place = 0; place < due_.size(); ++place) {
    const int slot = due_[place];
    Track& track = tracks_.at(slot);
    const PartOfPosition& part = parts_[place];
    double ratio = 0.0;  // of the values to being false or another target's
    for (std::size_t k = 0; k < values.size(); ++k)
      if (part.squared_distance(values[k]) <= kPartialGate)
        ratio += part.likelihood(values[k]) / others_than(part, k);
    double& in_view = track.in_view[static_cast<std::size_t>(scan.sensor)];
    const double detection = kPartialDetection * in_view;
    const double seen = in_view * (1.0 - kPartialDetection + kPartialDetection * ratio);
    in_view = kViewMemory * seen / (seen + 1.0 - in_view) + (1.0 - kViewMemory) * 0.5;
    if (ratio == 0.0) continue;
    predict_to(track, scan.time_s);
    const double late_s = track.time_s - scan.time_s;
    const TimeAlignment alignment = alignment_over(track, late_s);
    std::array<Alternative<Fix>, kMaxAlternatives> readings;
    std::array<double, kMaxAlternatives> share;
    std::size_t count = 0;
    for (std::size_t k = 0; k < values.size() && count < readings.size(); ++k) {
      if (!(part.squared_distance(values[k]) <= kPartialGate)) continue;
      const Gaussian<2> fix = part.fix(values[k]);
      readings[count++] = {Fix{fix.covariance + alignment.added_m2(late_s)},
                           fix.mean + late_s * track.velocity(),
                           detection * part.per_fix() / others_than(part, k)};
    }
    Estimator& estimator = estimator_at(slot);
    (void)estimator.update(std::span<const Alternative<Fix>>(readings.data(), count),
                           1.0 - detection, std::span(share.data(), count));
    track.kinematics = kinematics_of(estimator.estimate());
  }
  return {Status::kOk, plot_track_id_, events_,
          static_cast<int>(scan.values.size() - values.size())};
}

template <class Estimator, class Steps>
std::vector<std::byte> Tracker<Estimator, Steps>::save() const {
  return saved_state([this](Archive& fields) {
    const_cast<Tracker*>(this)->archive(fields);  // writing changes nothing
  });
}

template <class Estimator, class Steps>
bool Tracker<Estimator, Steps>::restore(std::span<const std::byte> bytes) {
  std::vector<Radar> radars;
  for (const RadarState& radar : radars_) radars.push_back(radar.radar);
  Tracker other(radars, config_, prototype_);
  for (std::size_t k = 0; k < radars_.size(); ++k) other.radars_[k].in_use = radars_[k].in_use;
  if (!read_state(bytes, [&](Archive& fields) { other.archive(fields); })) return false;
  *this = std::move(other);
  return true;
}

}  // namespace wakeline
