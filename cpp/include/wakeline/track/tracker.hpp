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
#include <tuple>
#include <utility>
#include <vector>

#include "wakeline/association/global_nearest_neighbour.hpp"
#include "wakeline/association/nearest_neighbour.hpp"
#include "wakeline/simd/side_by_side.hpp"
#include "wakeline/gating/chi_square_gate.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/track/claims.hpp"
#include "wakeline/track/clutter_map.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/duplicates.hpp"
#include "wakeline/track/echoes.hpp"
#include "wakeline/track/free_plots.hpp"
#include "wakeline/track/mode_places.hpp"
#include "wakeline/track/place_index.hpp"
#include "wakeline/track/radar.hpp"
#include "wakeline/track/start.hpp"
#include "wakeline/track/track_list.hpp"

namespace wakeline {

/// What a scan has brought. The spans are valid until the next call.
struct ScanReport {
  Status status = Status::kOk;
  std::span<const std::int64_t>
      plot_track_id;  ///< of each plot up to `max_plots` the track it belongs to, or 0
  std::span<const Event> events;
  /// Not finite, behind the antenna, of so many turns that the bearing is lost, of another time
  /// than the scan, or beyond `max_plots`.
  int refused_plots = 0;
};

/// What a track can be: an estimator of `double` with the whole face of `Imm`. An `Imm` of one
/// model is a single filter.
template <class Estimator>
concept TrackEstimator = std::copyable<Estimator> &&
    requires(Estimator estimator, const Estimator& constant, std::span<double> share,
             std::span<const Alternative<Fix>> readings, Archive& fields) {
  { estimator.start(Gaussian<4>{}) } -> std::same_as<Status>;
  { estimator.predict(1.0) } -> std::same_as<Status>;
  { estimator.update(readings, 1.0, share) } -> std::same_as<double>;
  { constant.evidence(Fix{}, Vec<double, 2>{}) } -> std::same_as<Evidence<double>>;
  constant.estimate();
  estimator.archive(fields);
};

/// Keeps tracks of all vessels a radar sees, scan by scan.
///
/// Each track is an estimator of `Estimator`'s kind with a probability of existence and of
/// visibility. A scan goes through: prediction to the time of the plots, gating, association,
/// update, confirmation and drop, removal of duplicates, and starts from plots that nobody claims.
/// All memory is taken by the constructor; `process` neither allocates nor throws. A tracker may be
/// used from one thread at a time; trackers share nothing. Sources: D. Mušicki, R. Evans, "Joint
/// integrated probabilistic data association" and its linear multitarget form, IEEE Trans. AES-40,
/// 2004, and IET RSN 2008 (existence, claims of other tracks); Bar-Shalom, Li 1995 (PDA, M of N).
template <class Estimator>
class Tracker {
  static_assert(TrackEstimator<Estimator>,
                "wakeline: a tracker needs an estimator of double with evidence(sensor, z) and the "
                "update of several readings, as Imm has them (of one filter: an Imm of one model); "
                "see cpp/docs/concepts.md");

 public:
  using TrackType = Track<Estimator>;

  /// Throws `std::invalid_argument` on a setting that makes no sense.
  Tracker(const Radar& radar, const TrackerConfig& config, const Estimator& prototype)
      : radar_(validated(radar)),
        config_(validated(config)),
        prototype_(prototype),
        gate_(ChiSquareGate{config.gate_probability}),
        map_(config.clutter_cell_m, config.clutter_memory_s),
        tracks_(config.max_tracks, prototype),
        claims_(static_cast<std::size_t>(config.max_tracks)),
        echoes_(config.max_plots),
        side_by_side_(prototype),
        places_(config.max_tracks),
        free_(config.max_plots),
        candidates_(config.max_tracks, config.max_tracks * Claims::kMost),
        global_(config.max_tracks, config.max_plots),
        nearest_(config.max_tracks, config.max_plots, config.max_tracks * Claims::kMost) {
    const auto tracks = static_cast<std::size_t>(config.max_tracks);
    const auto plots = static_cast<std::size_t>(config.max_plots);
    row_slot_.reserve(tracks);
    weak_.reserve(tracks);
    plot_track_id_.reserve(plots);
    events_.reserve(4 * tracks + plots);
  }

  Tracker(Tracker&&) noexcept = default;
  Tracker& operator=(Tracker&&) noexcept = default;

  /// Takes in the plots of one scan, a whole turn of the antenna that ends at `time_s`: a track
  /// without a plot has missed it. Refuses a scan that lies before the last one.
  ScanReport process(double time_s, std::span<const Plot> plots) noexcept {
    events_.clear();
    plot_track_id_.clear();
    if (!std::isfinite(time_s)) return {Status::kNotFinite, {}, {}, 0};
    if (started_ && time_s < time_s_) return {Status::kNegativeTimeStep, {}, {}, 0};
    const double dt_s = started_ ? time_s - time_s_ : 0.0;
    time_s_ = time_s;
    started_ = true;
    const int refused = take(plots, dt_s);
    const Ageing ageing(config_, dt_s);
    // A few at a time, while they are in the cache.
    tracks_.template for_each_group<kGroup>([&](std::span<const int> slots) {
      for (const int slot : slots) tracks_.at(slot).age(ageing);
      advance(slots);
      for (const int slot : slots) {
        gate(tracks_.at(slot), claims_of(slot));
        stake(tracks_.at(slot), claims_of(slot));
      }
    });
    if (config_.association != Association::kProbabilistic) assign_plots();
    tracks_.template for_each_group<kGroup>([&](std::span<const int> slots) { update(slots); });
    judge();
    remove_duplicates();
    promote();
    learn_clutter();
    start_tracks();
    name_plots();
    return {Status::kOk, plot_track_id_, events_, refused};
  }

  /// Calls `f(track)` for every track, tentative ones too, older ones first.
  template <class Function>
  void for_each(Function&& function) const {
    tracks_.for_each(function);
  }

  [[nodiscard]] int size() const noexcept { return tracks_.size(); }

  /// The track of that number, or null.
  [[nodiscard]] const TrackType* find(std::int64_t id) const noexcept { return tracks_.find(id); }

  /// The belief of a track at a time that is not before its estimate; NaN for a time that is none
  /// or so far off that nothing can be said.
  [[nodiscard]] Gaussian<4> kinematics_at(const TrackType& track, double time_s) const noexcept {
    if (time_s <= track.time_s) return track.kinematics;
    Estimator ahead = track.estimator;
    if (ahead.predict(time_s - track.time_s) == Status::kOk) return kinematics_of(ahead.estimate());
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    return {Vec<double, 4>::Constant(kNaN), Mat<double, 4, 4>::Constant(kNaN)};
  }

  /// Until when a target can be designated: an hour after the last scan, or ever before the first
  /// one. A time further ahead is of another clock: the track would wait there, deaf to all plots.
  [[nodiscard]] double latest_designation_s() const noexcept {
    return started_ ? time_s_ + kLongestSilence_s : std::numeric_limits<double>::infinity();
  }

  /// The operator says that there is a target: a confirmed track at rest. Returns its number, or 0
  /// when there is no room, the position makes no sense or the time is too far ahead. Where the
  /// tracker is full, the weakest tentative track gives way, without an event.
  std::int64_t designate(double time_s, double north_m, double east_m,
                         double position_std_m) noexcept {
    if (!std::isfinite(time_s) || time_s > latest_designation_s()) return 0;
    if (!(position_std_m > 0.0)) return 0;
    const Gaussian<2> place{{north_m, east_m},
                            position_std_m * position_std_m * Mat<double, 2, 2>::Identity()};
    const Gaussian<4> belief =
        kinematics_from<double>(place, resting_velocity(), Mat<double, 2, 2>::Zero());
    weak_listed_ = false;
    TrackType* track = open_track(time_s, belief, kDesignatedExistence);
    if (track == nullptr) return 0;
    track->tentative_id = 0;
    track->scans = track->hits = config_.confirm_hits;
    track->status = TrackStatus::kConfirmed;
    track->id = next_id_++;
    return track->id;
  }

  /// Ends a track; false when there is none of that number.
  bool drop(std::int64_t id) noexcept { return tracks_.remove(id); }

  /// Names a track (31 bytes at most are kept, of UTF-8 whole letters); false when there is none of
  /// that number.
  bool rename(std::int64_t id, std::string_view name) noexcept {
    TrackType* track = tracks_.find(id);
    if (track == nullptr) return false;
    std::size_t length = std::min(name.size(), track->name.size() - 1);
    const auto inside_letter = [&](std::size_t k) { return (name[k] & 0xC0) == 0x80; };
    while (length > 0 && length < name.size() && inside_letter(length)) --length;
    track->name.fill('\0');
    std::copy_n(name.begin(), length, track->name.begin());
    return true;
  }

  /// The whole state, to be restored by a tracker with the same settings and models that is
  /// compiled for the same instruction set.
  [[nodiscard]] std::vector<std::byte> save() const {
    Archive fields;
    const_cast<Tracker*>(this)->archive(fields);  // writing changes nothing
    std::uint64_t sum = checksum(fields.bytes());
    fields(sum);
    return fields.bytes();
  }

  /// Goes on bit for bit where the saved tracker was. False, and nothing changed, when the bytes
  /// are not the state of such a tracker.
  [[nodiscard]] bool restore(std::span<const std::byte> bytes) {
    std::uint64_t sum = 0;
    if (bytes.size() < sizeof(sum)) return false;
    const std::span<const std::byte> state = bytes.first(bytes.size() - sizeof(sum));
    std::memcpy(&sum, bytes.data() + state.size(), sizeof(sum));
    if (sum != checksum(state)) return false;
    Tracker other(radar_, config_, prototype_);
    Archive fields(state);
    other.archive(fields);
    if (!fields.ok() || !fields.at_end()) return false;
    *this = std::move(other);
    return true;
  }

  [[nodiscard]] const Estimator& prototype() const noexcept { return prototype_; }
  [[nodiscard]] const Radar& radar() const noexcept { return radar_; }
  [[nodiscard]] const TrackerConfig& config() const noexcept { return config_; }

  /// Time of the last scan.
  [[nodiscard]] double time_s() const noexcept { return time_s_; }

 private:
  static constexpr double kCertain = 0.9999;  ///< no claim is more certain than this
  static constexpr double kDesignatedExistence = 0.999;
  /// A plot that many periods from its scan has a wrong clock.
  static constexpr double kClockPeriods = 10.0;
  static constexpr double kLongestSilence_s = 3600.0;  ///< of the radar, before a designation
  static constexpr int kStartScans = 2;  ///< so long apart the plots of a start may be at least
  static constexpr std::uint32_t kArchiveVersion = 4;
  static constexpr std::size_t kGroup = 32;  ///< tracks that take their steps together

  /// The plots of a track, each as two readings, and what share of it they have.
  struct Readings {
    std::array<Alternative<Fix>, 2 * Claims::kMost> fixes;
    std::array<double, 2 * Claims::kMost> share;
  };

  [[nodiscard]] Claims& claims_of(int slot) noexcept {
    return claims_[static_cast<std::size_t>(slot)];
  }

  [[nodiscard]] Gaussian<2> resting_velocity() const noexcept {
    const double factor = config_.start_speed_factor > 0.0 ? config_.start_speed_factor : 1.0;
    const double std = factor * radar_.max_speed_mps;
    return {Vec<double, 2>::Zero(), std * std / 2 * Mat<double, 2, 2>::Identity()};
  }

  /// Returns how many plots were refused.
  int take(std::span<const Plot> plots, double dt_s) noexcept {
    const std::size_t count = std::min(plots.size(), static_cast<std::size_t>(config_.max_plots));
    plot_track_id_.assign(count, 0);
    echoes_.take(radar_, plots.first(count), time_s_,
                 std::max(kClockPeriods * radar_.period_s, dt_s));
    // The map as it was when it had learned the scan before: a period later it has faded by one.
    learned_s_ = time_s_ - std::min(dt_s, radar_.period_s);
    for (Echo& echo : echoes_)
      echo.density =
          config_.clutter_density_per_m2 +
          config_.clutter_weight * map_.density(echo.position.mean, learned_s_, radar_.period_s);
    return static_cast<int>(plots.size()) - echoes_.size();
  }

  /// Time passes for some tracks: to the time of the plot nearest to where each should be, else to
  /// the scan's.
  void advance(std::span<const int> slots) noexcept {
    std::array<PredictionStep<Estimator>, kGroup> steps;
    std::array<TrackType*, kGroup> track_of;
    std::array<double, kGroup> time_of;
    std::size_t count = 0;
    for (const int slot : slots) {
      TrackType& track = tracks_.at(slot);
      const double time_s = expected_time_s(track);
      if (!(time_s > track.time_s)) continue;
      steps[count] = {&track.estimator, time_s - track.time_s};
      track_of[count] = &track;
      time_of[count++] = time_s;
    }
    side_by_side_.predict({steps.data(), count});
    for (std::size_t k = 0; k < count; ++k) {
      if (steps[k].status != Status::kOk) continue;
      track_of[k]->time_s = time_of[k];
      track_of[k]->kinematics = steps[k].kinematics;
    }
  }

  /// Time of the plot nearest to where a track should be, else of the scan.
  [[nodiscard]] double expected_time_s(const TrackType& track) const noexcept {
    if (echoes_.apart_s(time_s_) == 0.0) return time_s_;
    const double ahead_s = std::max(time_s_ - track.time_s, 0.0);
    const Vec<double, 2> expected = track.position() + ahead_s * track.velocity();
    const double own_m = 3.0 * track.position_std_m() + radar_.max_speed_mps * ahead_s;
    const auto reach_m = [&](double plot_m2) { return own_m + 3.0 * std::sqrt(plot_m2); };
    double least = std::numeric_limits<double>::infinity();
    double time_s = time_s_;
    echoes_.for_each_near(expected, reach_m, [&](int index) {
      const Echo& echo = echoes_[index];
      const double distance = (echo.position.mean - expected).squaredNorm();
      if (distance < least) {
        least = distance;
        time_s = echo.time_s;
      }
    });
    return time_s;
  }

  /// Finds the plots that a track may own.
  void gate(const TrackType& track, Claims& claims) noexcept {
    claims.clear();
    const double threshold = gate_.threshold();
    const auto& p = track.kinematics.covariance;
    modes_.take(track.estimator);
    const double own_m = 3.0 * std::sqrt(threshold * (p(0, 0) + p(2, 2)));
    const double apart_s = echoes_.apart_s(track.time_s);
    const double moved = apart_s * track.velocity().cwiseAbs().maxCoeff();
    const Mat<double, 2, 2> velocity_covariance = track.velocity_covariance();
    const double unrest_m2s3 = apart_s > radar_.period_s ? unrest(track, apart_s) : 0.0;
    const auto way_covariance = [&](double dt_s) -> Mat<double, 2, 2> {
      const double late_s = std::abs(dt_s) > radar_.period_s ? std::abs(dt_s) : 0.0;
      const double changed_m2 = late_s * late_s * late_s * unrest_m2s3;
      return dt_s * dt_s * velocity_covariance + changed_m2 * Mat<double, 2, 2>::Identity();
    };
    const double moved_m2 = way_covariance(apart_s).trace();
    const auto reach_m = [&](double plot_m2) {
      const double wild_m2 = config_.outlier_variance() * plot_m2 + moved_m2;
      // Generous: the widest mode of an estimator may be some times wider than the mixture.
      const double generous = own_m + std::sqrt(threshold * wild_m2);
      return std::min(generous, modes_.reach_m(track.position(), wild_m2, threshold)) + moved;
    };
    echoes_.for_each_near(track.position(), reach_m, [&](int index) {
      const Gaussian<2>& position = echoes_[index].position;
      // The plot moves along with the track from its own time to the track's, with a velocity that
      // is not known for certain.
      const double dt_s = track.time_s - echoes_[index].time_s;
      Claim claim{.echo = index,
                  .z = position.mean + dt_s * track.velocity(),
                  .moved_m2 = way_covariance(dt_s)};
      const Mat<double, 2, 2> wild_covariance =
          config_.outlier_variance() * position.covariance + claim.moved_m2;
      if (!modes_.may_own(claim.z, wild_covariance, threshold)) return;
      const Evidence<double> wild = evidence(track, claim.z, wild_covariance);
      if (!gate_.contains(wild.least_nis)) return;
      const Mat<double, 2, 2> covariance = position.covariance + claim.moved_m2;
      const Evidence<double> nominal = evidence(track, claim.z, covariance);
      claim.likelihood = (1.0 - config_.outlier_probability) * nominal.likelihood +
                         config_.outlier_probability * wild.likelihood;
      if (!claims.takes(claim.likelihood)) return;
      claim.density = density(echoes_[index], track.learned);
      claim.nis = squared_distance(track.kinematics, claim.z, covariance);
      claims.add(claim);
    });
  }

  /// How fast a place gets less certain than by the velocity as it is known, for that may change:
  /// m² of an axis over the cube of the time, m²/s³.
  [[nodiscard, gnu::noinline]] double unrest(const TrackType& track, double dt_s) const noexcept {
    Mat<double, 4, 4> straight = Mat<double, 4, 4>::Identity();
    straight(0, 1) = straight(2, 3) = dt_s;
    const Mat<double, 4, 4> covariance =
        kinematics_at(track, track.time_s + dt_s).covariance -
        straight * track.kinematics.covariance * straight.transpose();
    return std::max(0.0, (covariance(0, 0) + covariance(2, 2)) / 2) / (dt_s * dt_s * dt_s);
  }

  /// What the track at hand thinks of a plot.
  [[nodiscard]] Evidence<double> evidence(const TrackType& track, const Vec<double, 2>& z,
                                          const Mat<double, 2, 2>& r) const noexcept {
    return modes_.known() ? modes_.evidence(z, r) : track.estimator.evidence(Fix{r}, z);
  }

  /// The odds with which a track claims each of its plots, and their sum for each plot. To the
  /// others a claimed plot is as good as denser clutter (linear multitarget).
  void stake(const TrackType& track, Claims& claims) noexcept {
    double sum = missed(track);
    for (const Claim& claim : claims) sum += weight(track, claim);
    const double norm = 1.0 - track.existence + track.existence * sum;
    for (Claim& claim : claims) {
      const double owned = std::min(track.existence * weight(track, claim) / norm, kCertain);
      claim.odds = claim.likelihood * owned / (1.0 - owned);
      echoes_[claim.echo].odds += claim.odds;
    }
  }

  /// Density of false plots about an echo, but for those that are the target's own.
  [[nodiscard]] double density(const Echo& echo, const LearnedPlots& own) const noexcept {
    const double of_own = config_.clutter_weight *
                          map_.density_of(own, echo.position.mean, learned_s_, radar_.period_s);
    return std::max(echo.density - of_own, config_.clutter_density_per_m2);
  }

  /// PD pv: that a target gives a plot.
  [[nodiscard]] double detected(const TrackType& track) const noexcept {
    return config_.detection_probability * track.visibility;
  }

  /// 1 - PD PG pv: that it gives none in its gate.
  [[nodiscard]] double missed(const TrackType& track) const noexcept {
    return 1.0 - config_.detection() * track.visibility;
  }

  /// PD pv g / rho: how much likelier the plot is as the track's than as clutter.
  [[nodiscard]] double weight(const TrackType& track, const Claim& claim) const noexcept {
    return detected(track) * claim.likelihood / claim.density;
  }

  /// Leaves each track at most one plot: confirmed tracks choose before tentative ones.
  void assign_plots() noexcept {
    for (const bool confirmed : {true, false}) {
      candidates_.clear(echoes_.size());
      row_slot_.clear();
      tracks_.for_each([&](const TrackType& track, int slot) {
        if (track.confirmed() != confirmed) return;
        row_slot_.push_back(slot);
        candidates_.start_row(0.0);
        for (const Claim& claim : claims_of(slot))
          if (echoes_[claim.echo].free > 0.0)
            candidates_.add(claim.echo, -std::log(weight(track, claim) / missed(track)));
      });
      const Assignment<double>& assignment = solved();
      for (std::size_t row = 0; row < row_slot_.size(); ++row) {
        Claims& claims = claims_of(row_slot_[row]);
        claims.keep_only(assignment.column_of_row()[row]);
        for (Claim& claim : claims) {
          claim.odds = echoes_[claim.echo].odds;  // nobody else claims it any more
          echoes_[claim.echo].free = 0.0;
        }
      }
    }
  }

  /// The assignment of the candidates, which always fit.
  const Assignment<double>& solved() noexcept {
    if (config_.association == Association::kGlobalNearest) {
      (void)global_.solve(candidates_);
      return global_.assignment();
    }
    (void)nearest_.solve(candidates_);
    return nearest_.assignment();
  }

  /// Takes the plots in: state, existence and visibility of some tracks.
  void update(std::span<const int> slots) noexcept {
    std::array<UpdateStep<Estimator>, kGroup> steps;
    std::array<UpdateStep<Estimator>*, kGroup> step_of{};  ///< null of a track without plots
    std::size_t count = 0;
    for (std::size_t k = 0; k < slots.size(); ++k) {
      TrackType& track = tracks_.at(slots[k]);
      const Claims& claims = claims_of(slots[k]);
      if (claims.empty()) continue;
      Readings& readings = readings_[k];
      const std::size_t fixes = list_readings(track, claims, readings);
      step_of[k] = &steps[count++];
      *step_of[k] = {&track.estimator,
                     {readings.fixes.data(), fixes},
                     none_of(track, claims),
                     {readings.share.data(), fixes}};
    }
    side_by_side_.update({steps.data(), count});
    for (std::size_t k = 0; k < slots.size(); ++k) {
      TrackType& track = tracks_.at(slots[k]);
      const Claims& claims = claims_of(slots[k]);
      const double none = none_of(track, claims);
      double total = none;
      if (step_of[k] != nullptr) {
        track.kinematics = step_of[k]->kinematics;
        if (step_of[k]->total > 0.0) total = step_of[k]->total;
      }
      if (total > 0.0 && !(claims.empty() && awaited(track)))
        track.weigh(config_, total, none, claims.certain());
      settle(track, slots[k], claims, readings_[k].share.data());
    }
  }

  /// What it weighs that none of its plots is the track's.
  [[nodiscard]] double none_of(const TrackType& track, const Claims& claims) const noexcept {
    return claims.certain() ? 0.0 : missed(track);
  }

  /// Tells the plots, and counts, how far they are a track's, by the shares of their readings.
  void settle(TrackType& track, int slot, const Claims& claims, const double* share) noexcept {
    double owned = 0.0;
    double best = 0.0;
    track.best_echo = -1;
    track.nis = std::numeric_limits<double>::quiet_NaN();
    for (const Claim& claim : claims) {
      const double owns = share[0] + share[1];
      share += 2;
      owned += owns;
      if (owns > best) {
        best = owns;
        track.best_echo = claim.echo;
        track.nis = claim.nis;
        track.plot_m2 = echoes_[claim.echo].position.covariance.trace() / 2;
      }
      settle(track, slot, echoes_[claim.echo], std::min(owns, 1.0));
    }
    if (owned > 0.5 || !awaited(track)) track.count(owned > 0.5);
  }

  /// Whether a track was designated for a time to which the scans have not come yet: until then it
  /// misses none.
  [[nodiscard]] bool awaited(const TrackType& track) const noexcept {
    return track.time_s > time_s_ && track.time_s <= latest_designation_s();
  }

  /// Each plot as two readings, of the nominal and of the wild error.
  [[nodiscard]] std::size_t list_readings(const TrackType& track, const Claims& claims,
                                          Readings& readings) const noexcept {
    std::size_t count = 0;
    for (const Claim& claim : claims) {
      const Echo& echo = echoes_[claim.echo];
      const double claimed_by_others = std::max(echo.odds - claim.odds, 0.0);
      const double weight = detected(track) / (claim.density + claimed_by_others);
      const Mat<double, 2, 2>& nominal_m2 = echo.position.covariance;
      readings.fixes[count++] = {Fix{nominal_m2 + claim.moved_m2}, claim.z,
                                 (1.0 - config_.outlier_probability) * weight};
      readings.fixes[count++] = {Fix{config_.outlier_variance() * nominal_m2 + claim.moved_m2},
                                 claim.z, config_.outlier_probability * weight};
    }
    return count;
  }

  /// A plot is a track's with that probability, if there is a target.
  void settle(const TrackType& track, int slot, Echo& echo, double owns) noexcept {
    const double probability = owns * track.existence;
    echo.stray *= 1.0 - owns;
    echo.free *= 1.0 - probability;
    if (probability > echo.best_claim) {
      echo.best_claim = probability;
      echo.best_slot = slot;
      echo.best_track_id = track.id;
    }
  }

  /// Confirms tracks, lets them coast, and drops those without a future.
  void judge() noexcept {
    const auto hopeless = [&](TrackType& track) {
      const bool was_confirmed = track.confirmed();
      if (was_confirmed || track.confirmable(config_))
        track.status = track.misses == 0                     ? TrackStatus::kConfirmed
                       : track.misses <= config_.shown_scans ? TrackStatus::kCoasting
                                                             : TrackStatus::kHeld;
      if (was_confirmed && track.misses == 1) announce(TrackEvent::kCoasting, track);
      return track.hopeless(config_, radar_);
    };
    tracks_.remove_if(hopeless, [&](const TrackType& track) { lose(track); });
  }

  /// Of two tracks on one target the senior one stays.
  void remove_duplicates() noexcept {
    index_tracks();
    const auto settled_duplicate = [&](TrackType& track) {
      const bool duplicate = has_senior(track);
      track.duplicate_scans = duplicate ? track.duplicate_scans + 1 : 0;
      const bool numbered = track.confirmed() && track.id > 0;
      return track.duplicate_scans >= (numbered ? config_.duplicate_scans : 1);
    };
    tracks_.remove_if(settled_duplicate, [&](const TrackType& track) { lose(track); });
  }

  void index_tracks() noexcept {
    places_.clear();
    tracks_.for_each([&](const TrackType& track, int slot) {
      if (!is_finite(track.position())) return;  // near nothing
      places_.add(track.position(), widest_m2(track), slot);
    });
    places_.sort();
  }

  /// Variance of the position along the axis where it is larger.
  static double widest_m2(const TrackType& track) noexcept {
    return std::max(track.kinematics.covariance(0, 0), track.kinematics.covariance(2, 2));
  }

  /// Whether a senior track is on the same target.
  [[nodiscard]] bool has_senior(const TrackType& track) const noexcept {
    // No farther apart can two tracks be that `same_target` calls one; a little more for rounding.
    const auto reach_m = [&](double other_m2) {
      const double alike_m = std::sqrt(config_.duplicate_distance * (widest_m2(track) + other_m2));
      return 1.001 * std::max(alike_m, config_.vessel_length_m);
    };
    bool found = false;
    places_.for_each_near(track.position(), reach_m, [&](int slot) {
      const TrackType& other = tracks_.at(slot);
      found =
          found || (&other != &track && !tracks_.ended(other) && senior(other, track) &&
                    (same_target(other.kinematics, track.kinematics, config_.duplicate_distance) ||
                     same_vessel(other, track, config_.vessel_length_m, gate_.threshold())));
    });
    return found;
  }

  /// Numbers the tracks that were confirmed in this scan.
  void promote() noexcept {
    tracks_.for_each([&](TrackType& track) {
      if (!track.confirmed() || track.id > 0) return;
      track.id = next_id_++;
      announce(TrackEvent::kConfirmed, track);
    });
  }

  /// Tells whose the plots are, by the numbers that the tracks have now.
  void name_plots() noexcept {
    for (const Echo& echo : echoes_) {
      if (echo.best_slot < 0) continue;
      const TrackType& track = tracks_.at(echo.best_slot);
      const bool same = track.id == echo.best_track_id || track.tentative_id == echo.best_track_id;
      if (same && !tracks_.ended(track))
        plot_track_id_[static_cast<std::size_t>(echo.plot)] = track.id;
    }
  }

  /// What not even a tentative track takes for its own is clutter. Each remembers what was learned
  /// of its own plots, so that they do not speak against it.
  void learn_clutter() noexcept {
    for (const Echo& echo : echoes_) map_.add(echo.position.mean, time_s_, echo.stray);
    tracks_.for_each([&](TrackType& track) {
      if (track.best_echo < 0) return;
      const Echo& echo = echoes_[track.best_echo];
      map_.remember(echo.position.mean, time_s_, echo.stray, track.learned);
    });
  }

  /// A free plot and one of the scan before, near enough for the speed limit, start a tentative
  /// track.
  void start_tracks() noexcept {
    const double longest_s = std::max(config_.coast_scans_max, kStartScans) * radar_.period_s;
    weak_listed_ = false;
    newest_before_ = next_tentative_id_ + 1;
    for (const Echo& echo : echoes_) {
      if (!(echo.free > config_.free_plot) || !has_room_for(existence_of_start(echo))) continue;
      free_.for_each_before(echo, radar_.max_speed_mps, config_.start_gate_sigma, longest_s,
                            [&](const FreePlot& earlier) { start_track(earlier, echo); });
    }
    free_.replace(echoes_, config_.free_plot);
    tracks_.for_each([&](const TrackType& track) {
      if (is_new(track)) announce(TrackEvent::kStarted, track);
    });
    newest_before_ = next_tentative_id_ + 1;
  }

  /// Whether a track has started in this scan: tentative tracks count downwards.
  [[nodiscard]] bool is_new(const TrackType& track) const noexcept {
    return track.id < newest_before_;
  }

  [[nodiscard]] double existence_of_start(const Echo& echo,
                                          const LearnedPlots& own = {}) const noexcept {
    return config_.initial_existence * config_.clutter_density_per_m2 / density(echo, own);
  }

  /// With the covariance of nominal and wild errors together.
  [[nodiscard]] Gaussian<2> as_it_may_err(const Gaussian<2>& plot) const noexcept {
    const double w = config_.outlier_probability;
    return {plot.mean, (1.0 - w + w * config_.outlier_variance()) * plot.covariance};
  }

  void start_track(const FreePlot& earlier, const Echo& echo) noexcept {
    LearnedPlots own{earlier.position.mean, 1.0, earlier.time_s};
    const double existence = existence_of_start(echo, own);
    if (!has_room_for(existence)) return;
    Gaussian<4> belief =
        two_point<double>(as_it_may_err(earlier.position), as_it_may_err(echo.position),
                          echo.time_s - earlier.time_s);
    if (config_.start_speed_factor > 0.0)
      belief = with_speed_prior(belief, std::sqrt(resting_velocity().covariance(0, 0)));
    TrackType* track = open_track(echo.time_s, belief, existence);
    if (track == nullptr) return;
    map_.remember(echo.position.mean, time_s_, echo.stray, own);
    track->learned = own;
    track->history = 3u;
  }

  /// A new tentative track of two plots; null when it cannot start or there is no room.
  TrackType* open_track(double time_s, const Gaussian<4>& belief, double existence) noexcept {
    if (!has_room_for(existence)) return nullptr;
    Estimator estimator = prototype_;
    if (estimator.start(belief) != Status::kOk) return nullptr;
    if (tracks_.full()) make_room();
    const int slot = tracks_.open();
    TrackType& track = tracks_.at(slot);
    track.estimator = estimator;
    track.id = track.tentative_id = next_tentative_id_--;
    track.name.fill('\0');
    track.status = TrackStatus::kTentative;
    track.time_s = time_s;
    track.kinematics = belief;
    track.plot_m2 = track.position_variance_m2();
    track.existence = existence;
    track.visibility = 1.0;
    track.nis = std::numeric_limits<double>::quiet_NaN();
    track.scans = track.hits = 2;
    track.misses = track.duplicate_scans = 0;
    track.history = 0;
    track.learned = {};
    track.best_echo = -1;
    if (weak_listed_) {
      weak_.push_back({existence, track.id, slot});
      std::push_heap(weak_.begin(), weak_.end(), stronger);
    }
    return &track;
  }

  /// Whether there is room for a new track, be it that of a weaker tentative one.
  bool has_room_for(double existence) noexcept {
    if (!tracks_.full()) return true;
    if (!weak_listed_) list_weak();
    return !weak_.empty() && weak_.front().existence < existence;
  }

  /// Gives up the weakest tentative track, of equals the oldest. One that has started in this scan
  /// has never been told of.
  void make_room() noexcept {
    const int slot = weak_.front().slot;
    std::pop_heap(weak_.begin(), weak_.end(), stronger);
    weak_.pop_back();
    if (!is_new(tracks_.at(slot))) lose(tracks_.at(slot));
    tracks_.remove_slot(slot);
  }

  /// A tentative track that may have to make room.
  struct Weak {
    double existence;
    std::int64_t id;
    int slot;
  };

  static bool stronger(const Weak& a, const Weak& b) noexcept {
    return a.existence > b.existence || (a.existence == b.existence && a.id < b.id);
  }

  /// Heaps up the tentative tracks, the weakest on top, once for all starts of a scan.
  void list_weak() noexcept {
    weak_.clear();
    tracks_.for_each([&](const TrackType& track, int slot) {
      if (!track.confirmed()) weak_.push_back({track.existence, track.id, slot});
    });
    std::make_heap(weak_.begin(), weak_.end(), stronger);
    weak_listed_ = true;
  }

  void lose(const TrackType& track) noexcept { announce(TrackEvent::kLost, track); }

  void announce(TrackEvent kind, const TrackType& track) noexcept {
    if (events_.size() < events_.capacity())
      events_.push_back({kind, track.id, track.tentative_id, time_s_});
  }

  /// Tells estimators of different models or chains apart, by what they make of a slow start and of
  /// fast ones, two time steps and a reading.
  [[nodiscard]] std::uint64_t fingerprint() const {
    Archive fields;
    const Alternative<Fix> reading{Fix{}, {101.0, 199.0}, 1.0};
    for (const double speed_mps : {5.0, 15.0, 40.0, 200.0}) {
      Estimator estimator = prototype_;
      double share = 0.0;
      (void)estimator.start(
          Gaussian<4>{{100.0, speed_mps, 200.0, -3.0}, Mat<double, 4, 4>::Identity()});
      for (const double dt_s : {1.0, 2.5}) (void)estimator.predict(dt_s);
      (void)estimator.update(std::span(&reading, 1), 1.0, std::span(&share, 1));
      estimator.archive(fields);
    }
    return checksum(fields.bytes());
  }

  /// Saves or restores; the settings are compared, not taken.
  void archive(Archive& fields) {
    std::uint32_t version = kArchiveVersion;
    std::uint64_t models = fingerprint();
    const std::uint64_t own_models = models;
    fields(version);
    fields(models);
    if (version != kArchiveVersion || models != own_models) fields.fail();
    fields.rules(radar_, config_);
    if (!fields.ok()) return;
    fields(time_s_);
    fields(started_);
    fields(next_id_);
    fields(next_tentative_id_);
    map_.archive(fields);
    free_.archive(fields);
    tracks_.archive(fields);
  }

  Radar radar_;
  TrackerConfig config_;
  Estimator prototype_;
  EllipsoidalGate<2> gate_;
  ClutterMap map_;
  TrackList<Estimator> tracks_;
  std::vector<Claims> claims_;  ///< by slot of the list
  Echoes echoes_;
  ModePlaces modes_;  ///< of the track at hand
  SideBySide<Estimator> side_by_side_;
  std::array<Readings, kGroup> readings_;  ///< of the tracks at hand
  PlaceIndex places_;                      ///< of the tracks, by slot
  FreePlots free_;                         ///< of the scan before
  std::vector<std::int64_t> plot_track_id_;
  std::vector<Event> events_;
  std::vector<int> row_slot_;  ///< of the rows of `candidates_`
  std::vector<Weak> weak_;     ///< a heap of the tentative tracks, if `weak_listed_`
  bool weak_listed_ = false;
  Candidates<double> candidates_;
  GlobalNearestNeighbour<double> global_;
  NearestNeighbour<double> nearest_;
  double time_s_ = 0.0;
  double learned_s_ = 0.0;  ///< of the map, at this scan
  bool started_ = false;
  std::int64_t next_id_ = 1;
  std::int64_t next_tentative_id_ = -1;
  std::int64_t newest_before_ = 0;  ///< of the tentative tracks, the number before this scan
};

}  // namespace wakeline
