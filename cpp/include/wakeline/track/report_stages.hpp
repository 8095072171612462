// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The stages of a report: which track its vessel is, and what that track learns of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "wakeline/measurement/kinematic_fix.hpp"
#include "wakeline/track/picture.hpp"

namespace wakeline {

/// Changes a picture by the positions that vessels report. All memory is taken by the constructor.
template <class Estimator, class Steps>
class ReportStages {
 public:
  explicit ReportStages(Picture<Estimator, Steps>& picture) : picture_(picture) {
    agreeing_.reserve(picture.estimators.size());
    evidence_.reserve(picture.estimators.size());
  }

  ReportResult process(const PositionReport& given) noexcept {
    picture_.clear_results();
    PositionReport report = given;
    if (!report.is_valid()) return {Status::kNotFinite, 0, {}};
    if (const Status status = picture_.status_of_time(report.time_s); status != Status::kOk)
      return {status, 0, {}};
    const int number = picture_.identities.find_or_add(report.source, report.identity);
    Identity& identity = picture_.identities[number];
    ReportClock clock = identity.clock;
    report.time_s = picture_.time_of(clock, report.time_s);
    if (!(report.time_s > identity.time_s)) return {Status::kNegativeTimeStep, 0, {}};
    identity.clock = clock;
    if (!identity.reported())
      if (const int slot = picture_.slot_of_identity(number); slot >= 0)
        picture_.tracks.at(slot).identity = -1;

    const bool jumped_before = identity.jumps();
    identity.note(report, state().radar.max_speed_mps);
    weigh_identity(report, identity);
    Track* track = identify(number);
    if (track == nullptr && !is_near_ && identity.in_a_row > 0) {
      track = start_reported(report, identity);
      if (track != nullptr) {
        (void)identify(number);
        note_report(identity, kSure, *track);
        return {Status::kOk, track->id, picture_.events};
      }
    }
    if (identity.jumps() && !jumped_before)
      picture_.announce(TrackEvent::kIdentityJumps, track, identity);
    if (track == nullptr) return {Status::kGated, 0, picture_.events};
    // Wrong reports that are taken draw their track away from its plots.
    if (!identity.is_doubted() && picture_.is_beside_plots(*track)) {
      identity.doubt();
      picture_.loosen(*track);
    }
    const bool agrees =
        std::find(agreeing_.begin(), agreeing_.end(), track->slot) != agreeing_.end() &&
        !identity.is_doubted();
    if (!agrees && !identity.disagrees)
      picture_.announce(TrackEvent::kIdentityDisagrees, track, identity);
    identity.disagrees = !agrees;
    const double probability = picture_.identity_probability(*track);
    if (!agrees || identity.jumps() || probability < kSure)
      return {Status::kGated, track->id, picture_.events};
    take_report(report, identity, probability, *track);
    return {Status::kOk, track->id, picture_.events};
  }

 private:
  /// Density of the vessels that a report may be of instead, per area.
  static constexpr double kOtherVessels_per_m2 = 1e-8;
  static constexpr double kOtherVelocities_per_m2s2 = 1e-3;  ///< the same of velocities
  static constexpr double kMostReportEvidence = 4.0;         ///< of a report, log odds
  static constexpr double kReportGate = 16.0;                ///< squared standard deviations
  static constexpr double kVelocityGate = 25.0;              ///< the same of the velocity
  static constexpr double kNarrow = 0.36;  ///< of both, where others or radars contradict it
  static constexpr double kUnseen = 0.1;   ///< of the velocity, an alteration not yet tracked
  static constexpr double kSure = 0.9;     ///< a report updates a track that it is of by this much

  [[nodiscard]] const RadarState& state() const noexcept { return picture_.state(); }

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
                picture_.alignment_over(track, late_s).added_m2(late_s)};
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
    const Mat<double, 4, 4> added = picture_.maneuver_covariance(track, late_s);
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

  /// The squared distance, in standard deviations, of a reported velocity from that of a track.
  [[nodiscard]] static double velocity_distance(const PositionReport& report,
                                                const Gaussian<4>& then) noexcept {
    const double report_m2s2 = report.velocity_std_mps * report.velocity_std_mps +
                               kUnseen * kUnseen * report.velocity_mps.squaredNorm();
    const Cholesky<2> factor(velocity_covariance(then) +
                             report_m2s2 * Mat<double, 2, 2>::Identity());
    const Vec<double, 2> velocity_mps(then.mean[1], then.mean[3]);
    return factor.ok() ? factor.squared_norm(report.velocity_mps - velocity_mps) : 0.0;
  }

  /// Weighs all tracks by a report, and notes which of them it agrees with, in `agreeing_`. Where
  /// it fits several, the better ones gain as much on the others as their likelihoods differ.
  void weigh_identity(const PositionReport& report, Identity& identity) noexcept {
    agreeing_.clear();
    is_near_ = false;
    evidence_.assign(picture_.tracks.slots().size(), -std::numeric_limits<double>::infinity());
    for (Identity::Candidate& candidate : identity.candidates)
      if (candidate.slot >= 0 && !(picture_.tracks.in_use(candidate.slot) &&
                                   candidate.is(picture_.tracks.at(candidate.slot))))
        candidate = {};
    double best = 0.0;
    for (std::size_t k = 0; k < evidence_.size(); ++k) {
      const Track& track = picture_.tracks.at(picture_.tracks.slots()[k]);
      if (!is_about(track, report)) continue;
      const Gaussian<4> belief = picture_.belief_at(track, report.time_s);
      const Gaussian<2> then = position_in(belief);
      const Gaussian<2> fix = reported_position(report, track, 0.0);
      const Cholesky<2> factor(fix.covariance + then.covariance);
      if (!factor.ok()) continue;
      const double distance = factor.squared_norm(fix.mean - then.mean);
      evidence_[k] = -0.5 * (distance + factor.log_determinant()) -
                     std::log(2.0 * kPi<double> * kOtherVessels_per_m2);
      is_near_ = is_near_ || distance <= kReportGate;
      // Where the radar sees the target, a report that may be wrong is better left out.
      const bool seen = picture_.is_seen_by_radar(track);
      const bool doubted = seen && (identity.disagrees || identity.velocity.contradicts());
      const double narrow = doubted ? kNarrow : 1.0;
      const bool differs = seen && report.has_velocity() &&
                           velocity_distance(report, belief) > narrow * kVelocityGate;
      if (differs && identity.velocity.fits()) evidence_[k] = std::min(evidence_[k], 0.0);
      best = std::max(best, evidence_[k]);
      if (distance <= narrow * kReportGate && !differs) agreeing_.push_back(track.slot);
    }
    const double excess = std::max(best - kMostReportEvidence, 0.0);
    for (std::size_t k = 0; k < evidence_.size(); ++k) {
      const Track& track = picture_.tracks.at(picture_.tracks.slots()[k]);
      const double evidence = std::max(evidence_[k] - excess, -kMostReportEvidence);
      const bool known = std::any_of(identity.candidates.begin(), identity.candidates.end(),
                                     [&](const auto& candidate) { return candidate.is(track); });
      if (known || evidence > 0.0) identity.weigh(track, evidence);
    }
  }

  /// Gives the identity to the track that it is believed to be; null when there is none, or several
  /// vessels report it.
  Track* identify(int number) noexcept {
    Identity& identity = picture_.identities[number];
    const int slot = picture_.slot_of_identity(number);
    Track* before = slot < 0 ? nullptr : &picture_.tracks.at(slot);
    const Identity::Candidate* best = identity.likeliest();
    Track* now = best != nullptr && identity.probability(*best) > 0.5 && !identity.is_of_several()
                     ? &picture_.tracks.at(best->slot)
                     : nullptr;
    if (now == before) return now;
    if (before != nullptr) {
      before->identity = -1;
      picture_.announce(TrackEvent::kIdentityLost, before, identity);
    }
    if (now == nullptr) return nullptr;
    if (now->identity >= 0) {
      picture_.announce(TrackEvent::kIdentityShared, now, identity);
      if (picture_.identity_probability(*now) >= identity.probability(*best)) return nullptr;
    }
    now->identity = number;
    picture_.announce(TrackEvent::kIdentified, now, identity);
    return now;
  }

  /// Updates a track by a report of its vessel, which it is with that probability.
  void take_report(const PositionReport& report, const Identity& identity, double probability,
                   Track& track) noexcept {
    picture_.predict_to(track, report.time_s);
    Estimator& estimator = picture_.estimator_at(track.slot);
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
      if (identity.velocity.fits()) {
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
    picture_.number_confirmed(track);
  }

  /// Starts a track of a vessel that reports where no radar has seen it.
  Track* start_reported(const PositionReport& report, Identity& identity) noexcept {
    Gaussian<2> velocity = state().initiation.prior_velocity(state().radar);
    if (identity.velocity.fits())
      velocity = {report.velocity_mps, report.velocity_std_mps * report.velocity_std_mps *
                                           Mat<double, 2, 2>::Identity()};
    const Gaussian<2> position{report.position_m, report.position_std_m * report.position_std_m *
                                                      Mat<double, 2, 2>::Identity()};
    picture_.room.reset();
    if (!picture_.room.has_room_for(Picture<Estimator, Steps>::kSurelyExists, picture_.tracks))
      return nullptr;
    picture_.newest_before = picture_.next_tentative_id + 1;
    Track* track =
        picture_.open({kinematics_from<double>(position, velocity, Mat<double, 2, 2>::Zero()),
                       report.time_s,
                       state().beam.angle_rad(),
                       Picture<Estimator, Steps>::kSurelyExists,
                       {}});
    picture_.tracks.close_gaps();
    picture_.newest_before = picture_.next_tentative_id + 1;
    if (track == nullptr) return nullptr;
    picture_.announce(TrackEvent::kStarted, *track);
    identity.weigh(*track, Identity::kMostLogOdds);
    return track;
  }

  Picture<Estimator, Steps>& picture_;
  std::vector<int> agreeing_;     ///< slots of the tracks with which the report at hand agrees
  bool is_near_ = false;          ///< its position is in the gate of one
  std::vector<double> evidence_;  ///< of it, by place in the list of tracks
};

}  // namespace wakeline
