// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The stages of a scan, a whole turn or a sector of one radar.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "wakeline/gating/run_labels.hpp"
#include "wakeline/track/association.hpp"
#include "wakeline/track/association_probabilities.hpp"
#include "wakeline/track/duplicates.hpp"
#include "wakeline/track/life_cycle.hpp"
#include "wakeline/track/mode_positions.hpp"
#include "wakeline/track/picture.hpp"
#include "wakeline/track/plot_likelihood.hpp"

namespace wakeline {

/// Changes a picture by scans. `process` is the list of stages that a scan goes through; each is a
/// header of this folder, with its input as arguments and its output its own. All memory is taken
/// by the constructor.
template <class Estimator, class Steps>
class ScanStages {
 public:
  explicit ScanStages(Picture<Estimator, Steps>& picture)
      : picture_(picture),
        candidates_(picture.estimators.size()),
        propagation_(picture.config),
        assignment_(picture.config),
        duplicates_(picture.config, picture.gate.threshold()) {
    const std::size_t tracks = picture.estimators.size();
    const auto plots = static_cast<std::size_t>(picture.config.max_plots);
    for (std::vector<int>* slots : {&due_, &waiting_, &rivals_, &competing_, &met_})
      slots->reserve(tracks);
    touched_.reserve(2 * tracks);
    arcs_.reserve(tracks);
    is_candidate_.reserve(plots);
    is_contested_.reserve(plots);
    rival_plot_.reserve(plots);
    near_plot_.resize(tracks);
  }

  /// A whole turn of a radar where `sector` is null.
  ScanReport process(int radar, double time_s, std::span<const Plot> plots,
                     const Sector* sector) noexcept {
    if (!picture_.has_radar(radar)) return picture_.rejected(Status::kNotFinite);
    const RadarState& before = picture_.radars[static_cast<std::size_t>(radar)];
    time_s = before.radar.true_time_s(time_s);
    if (!std::isfinite(time_s) || time_s > picture_.latest_time_s())
      return picture_.rejected(Status::kNotFinite);
    if (before.started && time_s < before.time_s)
      return picture_.rejected(Status::kNegativeTimeStep);
    if (picture_.started && time_s < picture_.scan_time_s - before.radar.period_s)
      return picture_.rejected(Status::kNegativeTimeStep);
    if (sector != nullptr &&
        before.beam.goes_back(sector->from_rad, Beam::width_rad(sector->from_rad, sector->to_rad)))
      return picture_.rejected(Status::kNegativeTimeStep);
    picture_.clear_results();
    picture_.at_hand = radar;
    whole_turn_ = sector == nullptr;
    const double dt_s = state().started ? time_s - state().time_s : 0.0;
    picture_.scan_time_s = picture_.started ? std::max(picture_.scan_time_s, time_s) : time_s;
    if (!picture_.started) begin_looks();
    picture_.started = state().started = true;
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
    list_rivals();
    for_each_group(rivals_, [&](std::span<const int> slots) {
      predict(slots);
      find_candidates(slots, false);
    });
    associate();
    for_each_group(due_, [&](std::span<const int> slots) { update(slots); });

    confirm_and_delete();
    delete_duplicates();
    for (const int slot : touched_) picture_.number_confirmed(picture_.tracks.at(slot));
    state().clutter.learn(
        state().plots, state().ownership.clutter_probability(),
        state().ownership.free_probability(),
        [&](int slot) { return state().ownership.plot_of(slot); }, state().looks, due_);
    initiate();
    report_room();
    state().clutter.learn_free(state().plots, state().ownership.free_probability(), dt_s,
                               whole_turn_ ? 1.0 : dt_s / state().radar.period_s);

    report_owners(std::min(plots.size(), static_cast<std::size_t>(picture_.config.max_plots)));
    state().ownership.drop_settled(state().plots);
    state().plots.drop_settled();
    return {Status::kOk, picture_.plot_track_id, picture_.events,
            static_cast<int>(plots.size()) - taken};
  }

 private:
  static constexpr double kClockPeriods = 10.0;  ///< in which a plot of another time is in error
  static constexpr double kSilentPeriods = 2.0;  ///< after which a track coasts by time
  static constexpr std::size_t kGroup = 64;      ///< tracks that are stepped together
  static constexpr int kNoPlot = -1;

  /// Calls `f(slots)` for a few tracks at a time, which stay in the cache from stage to stage.
  template <class Function>
  void for_each_group(std::span<const int> slots, const Function& function) {
    for (std::size_t first = 0; first < slots.size(); first += kGroup)
      function(slots.subspan(first, std::min(kGroup, slots.size() - first)));
  }

  /// Of the radar at hand.
  [[nodiscard]] RadarState& state() const noexcept { return picture_.state(); }
  [[nodiscard]] Look& look_at(const Track& track) const noexcept { return state().look(track); }
  CandidatePlots& candidates_of(const Track& track) noexcept {
    return candidates_[static_cast<std::size_t>(track.slot)];
  }

  /// Moves the beam over a sector, or a whole turn without one, and takes the plots. Returns how
  /// many are taken.
  int sweep(const Sector* sector, std::span<const Plot> plots, double dt_s) noexcept {
    state().own.north_m += dt_s * state().own.vnorth_mps;
    state().own.east_m += dt_s * state().own.veast_mps;
    double half_rad = kPi<double>;
    if (sector != nullptr) {
      const double width_rad = Beam::width_rad(sector->from_rad, sector->to_rad);
      const auto [from_rad, passed_rad] = state().plot_lag.passed(sector->from_rad, width_rad);
      const double missed_rad =
          state().beam.sweep(from_rad, passed_rad, dt_s, state().radar.period_s);
      half_rad = width_rad / 2;
      if (missed_rad > 0.0)
        for (const int slot : picture_.tracks.slots()) state().meeting(slot).miss_turns(missed_rad);
    } else {
      state().beam.turn();
    }
    const double middle_rad = state().beam.angle_rad() - half_rad;
    const int taken = state().plots.add(
        state().radar, plots, state().time_s,
        std::max(kClockPeriods * state().radar.period_s, dt_s), [&](const Plot& plot) {
          return sector == nullptr ? middle_rad : Beam::unwrapped(plot.bearing_rad, middle_rad);
        });
    if (sector != nullptr) {
      const double begin_rad = Beam::unwrapped(sector->from_rad, middle_rad);
      for (int k = state().plots.size() - taken; k < state().plots.size(); ++k)
        state().plot_lag.learn(begin_rad - state().plots[k].beam_rad, 2.0 * half_rad);
    }
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
    if (whole_turn_) {
      for (const int slot : picture_.tracks.slots()) {
        state().meeting(slot) = {beam_rad - kPi<double>, beam_rad};
        if (may_be_seen(picture_.tracks.at(slot))) due_.push_back(slot);
      }
      return;
    }
    rival_plot_.resize(static_cast<std::size_t>(state().plots.size()));
    std::iota(rival_plot_.begin(), rival_plot_.end(), 0);
    for (const int slot : picture_.tracks.slots())
      if (beam_rad >= state().meeting(slot).look_rad) look_for(slot);
    defer();
  }

  /// Lists a track which the beam may have reached, if it is due or waits. One that may wait makes
  /// the plots near it rivals.
  void look_for(int slot) noexcept {
    Track& track = picture_.tracks.at(slot);
    const double beam_rad = state().beam.angle_rad();
    const GateSight sight(
        position_at_constant_velocity(track.kinematics, state().time_s - track.time_s),
        state().meeting(slot).passed_rad, picture_.gate.threshold(), state().radar, state().own);
    BeamArc arc = sight.arc(picture_.config.outlier_variance());
    if (arc.from_rad > beam_rad) {
      state().meeting(slot).look_rad = look_rad(track, arc);
      return;
    }
    const bool is_passed = arc.to_rad <= beam_rad;
    if (!is_passed) arc = sight.arc(1.0);
    const bool has_swept = state().beam.has_swept(arc);
    const bool may_wait = has_swept ? beam_rad < longest_wait_rad(arc) : !is_passed;
    int& plot = near_plot_[static_cast<std::size_t>(slot)];
    plot = may_wait ? join_near(track) : kNoPlot;
    const auto has_near = [&] { return may_wait ? plot != kNoPlot : has_plot_near(track); };
    if (!is_passed && !(has_swept && has_near())) {
      waiting_.push_back(slot);
    } else if ((has_swept && is_covered(track)) || has_near()) {
      due_.push_back(slot);
      arcs_.push_back(arc);
    } else {
      pass(track, arc);  // a part was left out
    }
  }

  /// Up to which angle of the beam a track may wait for others once the beam has passed its gate:
  /// half of the time that the beam needs to reach the gate again.
  [[nodiscard]] static double longest_wait_rad(const BeamArc& arc) noexcept {
    return arc.to_rad + (Beam::kTurn - (arc.to_rad - arc.from_rad)) / 2;
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
    state().meeting(track.slot) = {
        std::max(arc.centre_rad, state().beam.last_rad(arc.centre_rad) - Beam::kTurn),
        look_rad(track, arc) + Beam::kTurn};
  }

  /// Has tracks wait that compete for a plot with one that waits, so that association is of both.
  void defer() noexcept {
    if (!waiting_.empty()) {
      is_contested_.assign(rival_plot_.size(), 0);
      for (const int slot : waiting_)
        if (const int plot = near_plot_[static_cast<std::size_t>(slot)]; plot != kNoPlot)
          is_contested_[static_cast<std::size_t>(first_rival_of(plot))] = 1;
      std::size_t left = 0;
      for (std::size_t k = 0; k < due_.size(); ++k) {
        const int plot = near_plot_[static_cast<std::size_t>(due_[k])];
        if (plot != kNoPlot && is_contested_[static_cast<std::size_t>(first_rival_of(plot))] != 0) {
          waiting_.push_back(due_[k]);
        } else {
          arcs_[left] = arcs_[k];
          due_[left++] = due_[k];
        }
      }
      due_.resize(left);
      arcs_.resize(left);
    }
    for (std::size_t k = 0; k < due_.size(); ++k) pass(picture_.tracks.at(due_[k]), arcs_[k]);
  }

  /// Makes the plots in the gate of a track rivals of each other; one of them, or `kNoPlot`.
  int join_near(const Track& track) noexcept {
    int first = kNoPlot;
    for_each_near(track, [&](int plot) {
      const int other = first_rival_of(plot);
      if (first == kNoPlot)
        first = other;
      else
        rival_plot_[static_cast<std::size_t>(other)] = first;
    });
    return first;
  }

  /// The one that all rivals of a plot have in common.
  int first_rival_of(int plot) noexcept {
    return detail::find_root(
        plot, [&](int rival) -> int& { return rival_plot_[static_cast<std::size_t>(rival)]; });
  }

  /// Calls `f(plot)` for the plots in the gate of a track, those of outliers left out.
  template <class Function>
  void for_each_near(const Track& track, const Function& function) const noexcept {
    for_each_in_strip(track, 1.0, 1.0, [&](int plot) {
      if (is_near(track, plot)) function(plot);
    });
  }

  /// Calls `f(plot)` for the plots that may be in the gate of a track, where the covariances of the
  /// track and of plots are larger by these factors.
  template <class Function>
  void for_each_in_strip(const Track& track, double track_factor, double plot_factor,
                         const Function& function) const noexcept {
    const ScanPlots& plots = state().plots;
    const double late_s = plots.greatest_lag_s(state().time_s);
    const auto position_before = [&](double before_s) {
      return position_at_constant_velocity(track.kinematics,
                                           state().time_s - before_s - track.time_s);
    };
    const Gaussian<2> now = position_before(0.0);
    const Vec<double, 2> sight = now.mean - plots.antenna();
    // Variances are largest at one end of the times of the plots.
    double own_m2 = now.covariance.trace();
    double along_m4 = sight.dot(now.covariance * sight);
    if (late_s > 0.0) {
      const Mat<double, 2, 2> before_m2 = position_before(late_s).covariance;
      own_m2 = std::max(own_m2, before_m2.trace());
      along_m4 = std::max(along_m4, sight.dot(before_m2 * sight));
    }
    const double way_m = late_s * track.velocity().cwiseAbs().maxCoeff();
    const double way_m2 = late_s * std::abs(sight.dot(track.velocity()));
    const double threshold = picture_.gate.threshold();
    const GateStrip strip{sight, now.mean, -way_m2, way_m2, track_factor * along_m4};
    const auto reach_m = [&](double plot_m2) {
      return std::sqrt(threshold * (track_factor * own_m2 + plot_factor * plot_m2)) + way_m;
    };
    plots.for_each_near(now.mean, reach_m, [&](int plot) {
      const Gaussian<2>& position = plots[plot].position;
      if (!strip.excludes(position.mean, plot_factor * position.covariance, threshold))
        function(plot);
    });
  }

  /// Whether a plot is in the gate of a track without outliers.
  [[nodiscard]] bool is_near(const Track& track, int index) const noexcept {
    const ScanPlot& plot = state().plots[index];
    const Gaussian<2> then =
        position_at_constant_velocity(track.kinematics, plot.time_s - track.time_s);
    return innovation_squared(then, plot.position.mean, plot.position.covariance) <=
           picture_.gate.threshold();
  }

  /// Where the beam may reach the gate of a track, with room for what both do in a turn.
  [[nodiscard]] double look_rad(const Track& track, const BeamArc& arc) const noexcept {
    const double range_m = (track.position() - state().position()).norm();
    const double way_m =
        picture_.kPointedPeriods * state().radar.max_speed_mps * state().radar.period_s;
    const double aside_m = std::sqrt(std::max(range_m * range_m - way_m * way_m, 0.0));
    const double way_rad = aside_m > 0.0 ? angle_of(way_m / aside_m) : kPi<double>;
    const double wide_rad = arc.to_rad - arc.from_rad + way_rad;
    return arc.centre_rad - std::min(wide_rad, kPi<double>);
  }

  /// Has the tracks that were designated before the first scan begin with it.
  void begin_looks() noexcept {
    for (const int slot : picture_.tracks.slots()) {
      picture_.tracks.at(slot).looked_s = picture_.scan_time_s;
      for (RadarState& radar : picture_.radars)
        radar.look(picture_.tracks.at(slot)).looked_s = picture_.scan_time_s;
    }
  }

  /// Existence and visibility of the tracks that are due, as of now.
  void predict_existence() noexcept {
    double of_s = 0.0;
    ExistencePrediction prediction(picture_.config, of_s);
    const auto over = [&](double dt_s) -> const ExistencePrediction& {
      if (dt_s != of_s) prediction = ExistencePrediction(picture_.config, of_s = dt_s);
      return prediction;
    };
    const double now_s = state().time_s;
    for (const int slot : due_) {
      Track& track = picture_.tracks.at(slot);
      if (!is_covered(track)) continue;
      Look& look = look_at(track);
      look.visibility = over(std::max(now_s - look.looked_s, 0.0)).visibility(look.visibility);
      track.existence = over(std::max(now_s - track.looked_s, 0.0)).existence(track.existence);
      look.looked_s = now_s;
      track.looked_s = std::max(track.looked_s, now_s);
    }
  }

  /// Lets tracks coast by time that the beam has not passed for long. Where it turns again
  /// after a silence they have no misses for that, as if it had passed them in a whole turn.
  void coast_by_time() noexcept {
    touched_.assign(due_.begin(), due_.end());
    const double period_s = picture_.longest_period_s();
    if (!(picture_.scan_time_s - picture_.looked_since_s > kSilentPeriods * period_s)) return;
    picture_.looked_since_s = picture_.scan_time_s;
    for (const int slot : picture_.tracks.slots()) {
      coast_by_time(picture_.tracks.at(slot), period_s);
      picture_.looked_since_s =
          std::min(picture_.looked_since_s, picture_.tracks.at(slot).looked_s);
    }
    const auto is_older = [&](int a, int b) {
      return picture_.tracks.at(a).birth > picture_.tracks.at(b).birth;
    };
    std::sort(touched_.begin(), touched_.end(), is_older);
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  }

  void coast_by_time(Track& track, double period_s) noexcept {
    const double silent_s = picture_.scan_time_s - track.looked_s;
    if (!(silent_s > kSilentPeriods * period_s) || picture_.is_awaited(track)) return;
    const double periods = std::floor(silent_s / period_s) - kSilentPeriods + 1.0;
    const bool hidden = is_hidden(track);
    // A hidden target is not seen, but is not missed by anyone: it coasts.
    const double misses = state().beam.resumes() ? 0.0
                          : hidden               ? (track.misses == 0 ? 1.0 : 0.0)
                                                 : periods;
    if (!(picture_.scan_time_s < track.seen_until_s))
      for (double k = 0.0; k < misses; ++k) track.count(false);
    track.looked_s += periods * period_s;
    const ExistencePrediction prediction(picture_.config, periods * period_s);
    track.existence = prediction.existence(track.existence);
    for (RadarState& radar : picture_.radars) {
      Look& look = radar.look(track);
      look.visibility = prediction.visibility(look.visibility);
      look.looked_s = std::max(look.looked_s, track.looked_s);
      look.misses += static_cast<int>(misses);
    }
    PredictionStep<Estimator> step{&picture_.estimator_at(track.slot),
                                   picture_.scan_time_s - track.time_s};
    picture_.steps.predict({&step, 1});
    if (misses > 0.0 || hidden) touched_.push_back(track.slot);
    track.nis = std::numeric_limits<double>::quiet_NaN();
    if (step.status != Status::kOk) return;
    track.time_s = picture_.scan_time_s;
    track.kinematics = step.kinematics;
  }

  /// Whether a track is where none of the radars sees, and one of them turns.
  [[nodiscard]] bool is_hidden(const Track& track) const noexcept {
    const Vec<double, 2> position =
        track.position() + (picture_.scan_time_s - track.time_s) * track.velocity();
    bool turns = false;
    for (const RadarState& radar : picture_.radars) {
      if (!radar.in_use || !radar.started) continue;
      if (radar.covers(position)) return false;
      turns |= picture_.scan_time_s - radar.time_s <= kSilentPeriods * radar.radar.period_s;
    }
    return turns;
  }

  /// Has the plots of the last turn wait that may be of a track which waits, or ahead of the beam,
  /// and lists the tracks that wait and have a plot near them that is a candidate of one that is
  /// due.
  void list_rivals() noexcept {
    rivals_.clear();
    if (!waiting_.empty()) {
      is_candidate_.assign(static_cast<std::size_t>(state().plots.size()), 0);
      for (const int slot : due_)
        for (const CandidatePlot& plot : candidates_of(picture_.tracks.at(slot)))
          is_candidate_[static_cast<std::size_t>(plot.plot)] = 1;
    }
    const double turn_ago_rad = state().beam.angle_rad() - Beam::kTurn;
    for (const int slot : waiting_) {
      const Track& track = picture_.tracks.at(slot);
      bool is_rival = false;
      for_each_in_strip(
          track, TrackGate::kWidestMode, picture_.gate.generous_factor(), [&](int plot) {
            if (state().plots[plot].beam_rad > turn_ago_rad) state().plots.keep(plot);
            is_rival = is_rival ||
                       (is_candidate_[static_cast<std::size_t>(plot)] != 0 && is_near(track, plot));
          });
      if (is_rival) rivals_.push_back(slot);
    }
    for (int plot = 0; plot < state().plots.size(); ++plot)
      if (state().plots[plot].beam_rad > state().beam.angle_rad()) state().plots.keep(plot);
  }

  /// Predicts tracks, each to the time of its plot.
  void predict(std::span<const int> slots) noexcept {
    std::array<PredictionStep<Estimator>, kGroup> steps;
    std::array<Track*, kGroup> track_of;
    std::array<double, kGroup> time_of;
    std::size_t count = 0;
    for (const int slot : slots) {
      const Track& track = picture_.tracks.at(slot);
      const double time_s = expected_time_s(track, state().plots, state().radar.max_speed_mps);
      if (!(time_s > track.time_s)) continue;
      steps[count] = {&picture_.estimator_at(slot), time_s - track.time_s};
      track_of[count] = &picture_.tracks.at(slot);
      time_of[count++] = time_s;
    }
    picture_.steps.predict({steps.data(), count});
    for (std::size_t k = 0; k < count; ++k) {
      if (steps[k].status != Status::kOk) continue;
      track_of[k]->time_s = time_of[k];
      track_of[k]->kinematics = steps[k].kinematics;
    }
  }

  /// Gates of tracks, and the likelihoods of the plots inside.
  void find_candidates(std::span<const int> slots, bool due) noexcept {
    for (const int slot : slots) {
      const Track& track = picture_.tracks.at(slot);
      CandidatePlots& candidates = candidates_of(track);
      modes_.read(picture_.estimator_at(slot));
      const TimeAlignment alignment(
          track, state().radar.period_s,
          picture_.maneuver_m2s3(track, state().plots.greatest_lag_s(track.time_s)));
      candidates.choose(picture_.gate.validate(track, modes_, alignment, state().plots),
                        look_at(track).learned, modes_, picture_.config.outlier_probability,
                        state().clutter, state().plots);
      // What a track that waits may own as an outlier is not known before it is due.
      if (!due)
        candidates.keep_if([&](const CandidatePlot& plot) {
          return innovation_squared(track.kinematics, plot.z, plot.nominal_r) <=
                 picture_.gate.threshold();
        });
      candidates.thin(state().ownership.free_probability());
      if (picture_.config.association == Association::kProbabilistic)
        propagation_.claim(track, detection_of(track), candidates);
    }
  }

  /// Assigns plots to tracks, where each may have one at most.
  void associate() noexcept {
    competing_.assign(due_.begin(), due_.end());
    competing_.insert(competing_.end(), rivals_.begin(), rivals_.end());
    if (picture_.config.association == Association::kProbabilistic)
      propagation_.propagate(competing_);
    else
      assignment_.assign(state().detection_probability, state().looks, picture_.tracks, competing_,
                         candidates_, state().plots.size());
  }

  [[nodiscard]] Detection detection_of(const Track& track) const noexcept {
    return state().detection_probability.of(state().look(track).visibility);
  }

  [[nodiscard]] AssociationWeights weights_of(const Track& track,
                                              const Detection& detection) noexcept {
    return picture_.config.association == Association::kProbabilistic
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
      const Track& track = picture_.tracks.at(slots[k]);
      weights[k] = weights_of(track, detection_of(track));
      readings_[k].list(candidates_of(track), weights[k], picture_.config.outlier_probability);
      if (readings_[k].empty()) continue;
      const double plots = state().radar.plots_as_one(state().time_s - look_at(track).seen_s);
      if (plots > 1.0) {
        modes_.read(picture_.estimator_at(slots[k]));
        readings_[k].count_as_one(plots, modes_);
      }
      steps[count] = {&picture_.estimator_at(slots[k]), readings_[k].fixes(), weights[k].none,
                      readings_[k].share()};
      step_of[k] = &steps[count++];
    }
    picture_.steps.update({steps.data(), count});
    for (std::size_t k = 0; k < slots.size(); ++k) {
      Track& track = picture_.tracks.at(slots[k]);
      const Detection detection = detection_of(track);
      const AssociationProbabilities probabilities = readings_[k].probabilities();
      note_best_plot(track, probabilities);
      ScanLikelihood scan{weights[k].none, weights[k].none, weights[k].assigned};
      if (step_of[k] != nullptr) {
        track.kinematics = step_of[k]->kinematics;
        if (step_of[k]->total > 0.0) scan.total = step_of[k]->total;
        note_errors(track, probabilities);
      }
      const bool may_miss = !picture_.is_awaited(track) && is_covered(track);
      if (scan.total > 0.0 && (may_miss || !readings_[k].empty()))
        update_existence(picture_.config, detection, scan, track, look_at(track).visibility);
      state().ownership.add(track, candidates_of(track), weights[k], probabilities);
      const bool seen = is_seen(probabilities);
      if (!seen && !may_miss) continue;
      const bool shared = !seen && seen_alone(detection_of(track), candidates_of(track)) > 0.5;
      note_look(track, seen, shared);
      if (!shared && is_sure(track)) state().detection_probability.learn(probabilities.any);
    }
  }

  /// The radar whose misses decide how long a track is shown and kept. Of those that look at a
  /// confirmed one it is the slowest: what hides a target from a fast radar lasts for many of its
  /// scans, which count together as little as one look.
  [[nodiscard]] const RadarState& radar_that_counts(const Track& track) const noexcept {
    const RadarState* slowest = &state();
    if (!track.confirmed()) return *slowest;
    for (const RadarState& other : picture_.radars) {
      const double period_s = other.radar.period_s;
      if (other.in_use && other.started && period_s > slowest->radar.period_s &&
          state().time_s - other.look(track).looked_s < kSilentPeriods * period_s &&
          other.covers(track.position()))
        slowest = &other;
    }
    return *slowest;
  }

  /// Counts a look of the radar at hand, unless it is a miss of a track that another sensor sees,
  /// or whose misses another radar counts.
  void note_look(Track& track, bool seen, bool shared) noexcept {
    constexpr double kPeriods = 0.9;  // before the same radar looks again
    const double now_s = state().time_s;
    Look& look = look_at(track);
    look.misses = seen ? 0 : look.misses + 1;
    if (seen) look.seen_s = now_s;
    if (seen || (!(now_s < track.seen_until_s) && &radar_that_counts(track) == &state()))
      track.count(seen, shared);
    if (seen) track.looked_s = std::max(track.looked_s, now_s);
    if (seen && picture_.radars.size() > 1)
      track.seen_until_s = std::max(track.seen_until_s, now_s + kPeriods * state().radar.period_s);
  }

  /// Whether a track is of a target that is there, so that its misses are those of the radar.
  [[nodiscard]] bool is_sure(const Track& track) const noexcept {
    constexpr int kScans = 8, kMisses = 6;
    return track.confirmed() && track.scans > kScans && state().look(track).misses < kMisses;
  }

  [[nodiscard]] static bool is_seen(const AssociationProbabilities& probabilities) noexcept {
    return probabilities.any > 0.5;
  }

  /// Notes what a track keeps of its most probable plot, before the track takes the updated belief.
  void note_best_plot(Track& track, const AssociationProbabilities& probabilities) noexcept {
    track.nis = std::numeric_limits<double>::quiet_NaN();
    if (probabilities.best < 0) return;
    const CandidatePlot& best = candidates_of(track)[std::size_t(probabilities.best)];
    const Vec<double, 2> innovation =
        whitened_innovation(position_in(track.kinematics), best.z, best.nominal_r);
    track.nis = innovation.squaredNorm();
    if (is_seen(probabilities)) {
      track.consistency.add(innovation);
      look_at(track).note(innovation);
    }
    track.plot_m2 = state().plots[best.plot].position.covariance.trace() / 2;
  }

  /// Learns from the errors of its most probable plot, and notes what the track's are by them.
  void note_errors(Track& track, const AssociationProbabilities& probabilities) noexcept {
    if (probabilities.best < 0) return;
    const auto at = static_cast<std::size_t>(probabilities.best);
    const CandidatePlot& best = candidates_of(track)[at];
    LearnedErrors& errors = state().learned_errors;
    constexpr double kCertain = 0.7;
    if (is_sure(track) && probabilities.of_candidate[at] > kCertain)
      errors.learn(track.nis, look_at(track).product);
    const ConvertedErrors& of_plot = state().plots[best.plot].errors;
    const Vec<double, 2> antenna_m(of_plot.antenna_north_m, of_plot.antenna_east_m);
    const Mat<double, 2, 2> position_m2 = position_in(track.kinematics).covariance;
    track.stays_m2 = bent_m2(track.position() - antenna_m, position_m2);
    track.errors_scale = 1.0;
    // Where errors are said to be correlated, plots have counted for less already.
    if (state().radar.correlation_time_s > 0.0) return;
    track.stays_m2 += errors.stays() * (best.nominal_r + position_m2);
    track.errors_scale = errors.scale(position_m2.trace() / best.nominal_r.trace());
    // This radar alone does not make better what other sensors see, too.
    if (track.time_s < track.seen_until_s) track.errors_scale = std::max(track.errors_scale, 1.0);
  }

  void confirm_and_delete() noexcept {
    const auto shown_misses = [&](const RadarState& radar) {
      return radar.detection_probability.likely_misses(picture_.config.shown_probability);
    };
    const double shown_misses_at_hand = shown_misses(state());
    for (const int slot : touched_) {
      Track& track = picture_.tracks.at(slot);
      const RadarState& counts = radar_that_counts(track);
      if (confirm_or_coast(picture_.config, counts.radar,
                           &counts == &state() ? shown_misses_at_hand : shown_misses(counts),
                           track))
        picture_.announce(TrackEvent::kCoasting, track);
      LossReason reason = reason_to_delete(picture_.config, counts.radar, track);
      if (reason == LossReason::kUncertain && picture_.scan_time_s < track.seen_until_s)
        reason = LossReason::kNone;  // its vessel will report
      if (reason != LossReason::kNone) lose(track, reason);
    }
    forget_lost();
  }

  void delete_duplicates() noexcept {
    list_met();
    const auto seen_by_others = [&](const Track& a, const Track& b) {
      return are_seen_by_others(a, b);
    };
    for (const int slot : duplicates_.find(picture_.tracks, due_, met_, picture_.longest_period_s(),
                                           picture_.radars_in_use(), seen_by_others))
      lose(picture_.tracks.at(slot), LossReason::kDuplicate);
    forget_lost();
  }

  /// Lists the tracks whose gate the beam has met where it met those of the tracks that are due: a
  /// duplicate of one is in its gate.
  void list_met() noexcept {
    const double beam_rad = state().beam.angle_rad();
    double begin_rad = beam_rad;
    for (const int slot : due_) {
      const Meeting& meeting = state().meeting(slot);
      begin_rad = std::min(begin_rad, meeting.look_rad - Beam::kTurn);
    }
    met_.resize(picture_.tracks.slots().size());
    std::size_t count = 0;
    for (const int slot : picture_.tracks.slots()) {
      const Meeting& meeting = state().meeting(slot);
      met_[count] = slot;  // without a branch, which a processor would often guess wrong
      count += std::size_t{whole_turn_} | std::size_t{meeting.look_rad <= beam_rad} |
               std::size_t{meeting.end_rad() >= begin_rad};
    }
    met_.resize(count);
  }

  /// Whether each of two tracks is seen by a radar, and none sees both.
  [[nodiscard]] bool are_seen_by_others(const Track& a, const Track& b) const noexcept {
    constexpr int kMisses = 2;
    bool a_is_seen = false, b_is_seen = false;
    for (const RadarState& radar : picture_.radars) {
      if (!radar.in_use) continue;
      const Look &at_a = radar.look(a), &at_b = radar.look(b);
      if (std::max(at_a.misses, at_b.misses) < kMisses) return false;
      a_is_seen = a_is_seen || (at_a.misses == 0 && std::isfinite(at_a.seen_s));
      b_is_seen = b_is_seen || (at_b.misses == 0 && std::isfinite(at_b.seen_s));
    }
    return a_is_seen && b_is_seen;
  }

  void lose(const Track& track, LossReason reason) noexcept {
    picture_.announce(TrackEvent::kLost, track, reason);
    picture_.tracks.vacate(track.slot);
  }

  /// Takes lost tracks from all lists.
  void forget_lost() noexcept {
    picture_.tracks.close_gaps();
    for (std::vector<int>* slots : {&due_, &touched_})
      std::erase_if(*slots, [&](int slot) { return !picture_.tracks.in_use(slot); });
  }

  /// Starts tentative tracks.
  void initiate() noexcept {
    picture_.newest_before = picture_.next_tentative_id + 1;
    picture_.room.reset();
    state().initiation.initiate(
        state().radar, state().plots, state().ownership, state().clutter,
        state().detection_probability.value(), state().beam.angle_rad(), whole_turn_,
        [&](double existence) { return picture_.room.has_room_for(existence, picture_.tracks); },
        [&](const TrackStart& start) {
          Track* track = picture_.open(start);
          if (track == nullptr) return;
          track->history = 3u;
          Look& look = look_at(*track);
          state().meeting(track->slot) = {start.beam_rad, start.beam_rad};
          look.learned = start.learned;
          look.seen_s = start.time_s;
        });
    picture_.tracks.close_gaps();
    const std::span<const int> slots = picture_.tracks.slots();
    const auto is_before = [&](int slot) { return !picture_.is_new(picture_.tracks.at(slot)); };
    for (auto slot = std::find_if(slots.rbegin(), slots.rend(), is_before).base();
         slot != slots.end(); ++slot)
      picture_.announce(TrackEvent::kStarted, picture_.tracks.at(*slot));
    picture_.newest_before = picture_.next_tentative_id + 1;
  }

  /// Reports whose the plots are, by the numbers that the tracks have now.
  void report_owners(std::size_t count) noexcept {
    picture_.plot_track_id.assign(count, 0);
    for (int plot = 0; plot < state().plots.size(); ++plot) {
      const PlotOwnership::Owner& owner = state().ownership.owner(plot);
      if (state().plots[plot].input < 0 || owner.slot < 0 || !picture_.tracks.in_use(owner.slot))
        continue;
      const Track& track = picture_.tracks.at(owner.slot);
      if (track.hushed) continue;
      if (track.id == owner.track_id || track.tentative_id == owner.track_id)
        picture_.plot_track_id[static_cast<std::size_t>(state().plots[plot].input)] = track.id;
    }
  }

  /// Reports that `max_tracks` is reached, once until there is room again.
  void report_room() noexcept {
    if (picture_.tracks.full() && !picture_.full &&
        picture_.events.size() < picture_.events.capacity())
      picture_.events.push_back({TrackEvent::kFull, 0, 0, picture_.scan_time_s});
    picture_.full = picture_.tracks.full();
  }

  Picture<Estimator, Steps>& picture_;
  bool whole_turn_ = true;       ///< of this call
  std::vector<int> due_;         ///< slots of the tracks whose gate the beam has passed
  std::vector<int> waiting_;     ///< and of those whose gate it is in
  std::vector<int> rivals_;      ///< of these that have a candidate in common with one that is due
  std::vector<int> competing_;   ///< both
  std::vector<int> touched_;     ///< of the tracks for which this call has counted
  std::vector<int> met_;         ///< of the tracks that may be duplicates of one that is due
  std::vector<BeamArc> arcs_;    ///< of the tracks that are due
  std::vector<int> near_plot_;   ///< by slot: a plot in the gate of a track, or `kNoPlot`
  std::vector<int> rival_plot_;  ///< by plot: a rival of it, or itself
  std::vector<char> is_contested_;  ///< by plot without another rival: a track waits for one of all
  std::vector<char> is_candidate_;  ///< by plot: of a track that is due

  ModePositions modes_;                     ///< of the track at hand
  std::vector<CandidatePlots> candidates_;  ///< by slot
  BeliefPropagation propagation_;
  PlotAssignment assignment_;
  std::array<TrackReadings, kGroup> readings_;  ///< of the tracks at hand
  Duplicates duplicates_;
};

}  // namespace wakeline
