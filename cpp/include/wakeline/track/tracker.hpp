// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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
#include "wakeline/measurement/fix.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/track/clutter_map.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/radar.hpp"
#include "wakeline/track/start.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// What a scan has brought. The spans are valid until the next call.
struct ScanReport {
  Status status = Status::kOk;
  std::span<const std::int64_t>
      plot_track_id;  ///< of each plot up to `max_plots` the track it belongs to, or 0
  std::span<const Event> events;
  int refused_plots =
      0;  ///< not finite, behind the antenna, of another time than the scan, or beyond `max_plots`
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
 public:
  using TrackType = Track<Estimator>;

  /// Throws `std::invalid_argument` on a setting that makes no sense.
  Tracker(const Radar& radar, const TrackerConfig& config, const Estimator& prototype)
      : radar_(validated(radar)),
        config_(validated(config)),
        prototype_(prototype),
        map_(config.clutter_cell_m, config.clutter_memory_s),
        candidates_(config.max_tracks, config.max_tracks * kPairs),
        global_(config.max_tracks, config.max_plots),
        nearest_(config.max_tracks, config.max_plots, config.max_tracks * kPairs) {
    const auto tracks = static_cast<std::size_t>(config.max_tracks);
    const auto plots = static_cast<std::size_t>(config.max_plots);
    pool_.assign(tracks, TrackType{.estimator = prototype});
    order_.reserve(tracks);
    vacant_.reserve(tracks);
    for (std::size_t k = tracks; k-- > 0;) vacant_.push_back(static_cast<int>(k));
    pairs_.resize(tracks);
    row_track_.reserve(tracks);
    echoes_.reserve(plots);
    by_north_.reserve(plots);
    plot_track_id_.reserve(plots);
    free_.reserve(plots);
    events_.reserve(4 * tracks + plots);
  }

  Tracker(Tracker&&) noexcept = default;
  Tracker& operator=(Tracker&&) noexcept = default;

  /// Takes in the plots of one scan, which ends at `time_s`. Refuses a scan that lies before the
  /// last one.
  ScanReport process(double time_s, std::span<const Plot> plots) noexcept {
    events_.clear();
    plot_track_id_.clear();
    if (!std::isfinite(time_s)) return {Status::kNotFinite, {}, {}, 0};
    if (started_ && time_s < time_s_) return {Status::kNegativeTimeStep, {}, {}, 0};
    const double dt_s = started_ ? time_s - time_s_ : 0.0;
    const int refused = take_plots(time_s, dt_s, plots);
    for (const int slot : order_) advance(pool_[at(slot)], time_s, dt_s);
    for (const int slot : order_) gate(slot);
    claim_plots();
    if (config_.association != Association::kProbabilistic) assign_plots();
    for (const int slot : order_) update(slot);
    judge(time_s);
    remove_duplicates(time_s);
    promote(time_s);
    learn_clutter(time_s);
    start_tracks(time_s);
    time_s_ = time_s;
    started_ = true;
    return {Status::kOk, plot_track_id_, events_, refused};
  }

  /// Calls `f(track)` for every track, tentative ones too, older ones first.
  template <class Function>
  void for_each(Function&& function) const {
    for (const int slot : order_) function(pool_[at(slot)]);
  }

  [[nodiscard]] int size() const noexcept { return static_cast<int>(order_.size()); }

  /// The track of that number, or null.
  [[nodiscard]] const TrackType* find(std::int64_t id) const noexcept {
    const auto place = locate(id);
    return place == order_.end() ? nullptr : &pool_[at(*place)];
  }

  /// The belief of a track at a time that is not before its estimate.
  [[nodiscard]] Gaussian<4> kinematics_at(const TrackType& track, double time_s) const noexcept {
    if (!(time_s > track.time_s)) return track.kinematics;
    Estimator ahead = track.estimator;
    (void)ahead.predict(time_s - track.time_s);
    return kinematics_of(ahead.estimate());
  }

  /// The operator says that there is a target: a confirmed track at rest. Returns its number, or 0
  /// when there is no room or the position makes no sense.
  std::int64_t designate(double time_s, double north_m, double east_m,
                         double position_std_m) noexcept {
    if (!std::isfinite(time_s) || !(position_std_m > 0.0)) return 0;
    const Gaussian<2> place{{north_m, east_m},
                            position_std_m * position_std_m * Mat<double, 2, 2>::Identity()};
    const Gaussian<4> belief =
        kinematics_from<double>(place, resting_velocity(), Mat<double, 2, 2>::Zero());
    TrackType* track = open_track(time_s, belief, kDesignatedExistence, time_s);
    if (track == nullptr) return 0;
    track->tentative_id = 0;
    track->scans = track->hits = config_.confirm_hits;
    track->status = TrackStatus::kConfirmed;
    track->id = next_id_++;
    return track->id;
  }

  /// Ends a track; false when there is none of that number.
  bool drop(std::int64_t id) noexcept {
    const auto place = locate(id);
    if (place == order_.end()) return false;
    vacant_.push_back(*place);
    order_.erase(place);
    return true;
  }

  /// Names a track (31 bytes at most are kept); false when there is none of that number.
  bool rename(std::int64_t id, std::string_view name) noexcept {
    const auto place = locate(id);
    if (place == order_.end()) return false;
    auto& label = pool_[at(*place)].name;
    label.fill('\0');
    std::copy_n(name.begin(), std::min(name.size(), label.size() - 1), label.begin());
    return true;
  }

  /// The whole state, to be restored by a tracker with the same settings.
  [[nodiscard]] std::vector<std::byte> save() const {
    Archive fields;
    const_cast<Tracker*>(this)->archive(fields);  // writing changes nothing
    std::uint64_t sum = checksum(fields.bytes());
    fields(sum);
    return fields.bytes();
  }

  /// Goes on bit for bit where the saved tracker was. False, and nothing changed, when the bytes
  /// are not the state of a tracker with the same settings.
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
  [[nodiscard]] double time_s() const noexcept { return time_s_; }

 private:
  static constexpr int kPairs = 8;            ///< most plots that one track looks at
  static constexpr double kCertain = 0.9999;  ///< no claim is more certain than this
  static constexpr double kDesignatedExistence = 0.999;
  static constexpr double kClockPeriods =
      10.0;  ///< a plot farther in time from its scan has a wrong clock
  static constexpr std::uint32_t kArchiveVersion = 1;

  /// A plot as a position, and what the tracks say of it.
  struct Echo {
    Gaussian<2> position;
    double time_s;
    double density;     ///< of false plots about it, per m²
    double odds = 0.0;  ///< of all tracks that claim it
    double free = 1.0;  ///< probability that it is no track's
    double best_claim = 0.5;
    int plot;
  };

  /// A plot in the gate of a track.
  struct Pair {
    int echo;
    Vec<double, 2> z;   ///< brought to the track's time
    double likelihood;  ///< under all modes, nominal and wild
    double odds;        ///< that it is this track's
    double nis;
  };

  struct Pairs {
    std::array<Pair, kPairs> pair;
    int count = 0;
    bool assigned = false;  ///< the one pair left is taken as certain
  };

  struct FreePlot {
    Gaussian<2> position;
    double time_s;
  };

  static std::size_t at(int index) noexcept { return static_cast<std::size_t>(index); }

  [[nodiscard]] auto locate(std::int64_t id) const noexcept {
    return std::find_if(order_.begin(), order_.end(),
                        [&](int slot) { return pool_[at(slot)].id == id; });
  }

  [[nodiscard]] double detection() const noexcept {
    return config_.detection_probability * config_.gate_probability;
  }

  [[nodiscard]] Gaussian<2> resting_velocity() const noexcept {
    const double factor = config_.start_speed_factor > 0.0 ? config_.start_speed_factor : 1.0;
    const double std = factor * radar_.max_speed_mps;
    return {Vec<double, 2>::Zero(), std * std / 2 * Mat<double, 2, 2>::Identity()};
  }

  /// Converts the plots; sorts them by north for the search. Returns how many were refused.
  int take_plots(double time_s, double dt_s, std::span<const Plot> plots) noexcept {
    echoes_.clear();
    by_north_.clear();
    largest_variance_ = 0.0;
    const double slack_s = std::max(kClockPeriods * radar_.period_s, dt_s);
    const std::size_t count = std::min(plots.size(), static_cast<std::size_t>(config_.max_plots));
    plot_track_id_.assign(count, 0);
    int refused = static_cast<int>(plots.size() - count);
    for (std::size_t k = 0; k < count; ++k) {
      const Plot& plot = plots[k];
      const Gaussian<2> position = radar_.position(plot.range_m, plot.bearing_rad, plot.own);
      const bool usable = std::fabs(plot.time_s - time_s) <= slack_s && plot.range_m >= 0.0 &&
                          is_finite(position.mean) && Cholesky<2>(position.covariance).ok();
      if (!usable) {
        ++refused;
        continue;
      }
      const double density =
          config_.clutter_density_per_m2 +
          config_.clutter_weight * map_.density(position.mean, time_s, radar_.period_s);
      by_north_.push_back(static_cast<int>(echoes_.size()));
      echoes_.push_back({position, plot.time_s, density, 0.0, 1.0, 0.5, static_cast<int>(k)});
      largest_variance_ = std::max(largest_variance_, position.covariance.trace());
    }
    std::sort(by_north_.begin(), by_north_.end(), [&](int a, int b) {
      const double north_a = echoes_[at(a)].position.mean[0];
      const double north_b = echoes_[at(b)].position.mean[0];
      return north_a < north_b || (north_a == north_b && a < b);
    });
    return refused;
  }

  /// Calls `f(echo index)` for every plot at most `reach_m` north or south of a position.
  template <class Function>
  void for_each_near(const Vec<double, 2>& position, double reach_m, Function&& function) const {
    auto place = std::lower_bound(
        by_north_.begin(), by_north_.end(), position[0] - reach_m,
        [&](int echo, double north) { return echoes_[at(echo)].position.mean[0] < north; });
    for (; place != by_north_.end(); ++place) {
      const Vec<double, 2>& plot = echoes_[at(*place)].position.mean;
      if (plot[0] > position[0] + reach_m) break;
      if (std::fabs(plot[1] - position[1]) <= reach_m) function(*place);
    }
  }

  /// Time passes for a track: to the time of the plot nearest to where it should be, else to the
  /// scan's.
  void advance(TrackType& track, double scan_time_s, double dt_s) noexcept {
    track.existence *= std::exp(-dt_s / config_.survival_time_s);
    if (config_.visible_time_s > 0.0) {
      const double hide = 1.0 / config_.visible_time_s;
      const double show = 1.0 / config_.hidden_time_s;
      const double settled = show / (hide + show);
      track.visibility = settled + (track.visibility - settled) * std::exp(-(hide + show) * dt_s);
    }
    const double ahead_s = std::max(scan_time_s - track.time_s, 0.0);
    const Vec<double, 2> expected =
        track.position() +
        ahead_s * Vec<double, 2>(track.kinematics.mean[1], track.kinematics.mean[3]);
    const double reach =
        3.0 * track.position_std_m() + 3.0 * std::sqrt(largest_variance_) + 5.0 * ahead_s;
    double least = std::numeric_limits<double>::infinity();
    double time_s = scan_time_s;
    for_each_near(expected, reach, [&](int echo) {
      const double distance = (echoes_[at(echo)].position.mean - expected).squaredNorm();
      if (distance < least) {
        least = distance;
        time_s = echoes_[at(echo)].time_s;
      }
    });
    if (time_s > track.time_s && track.estimator.predict(time_s - track.time_s) == Status::kOk) {
      track.time_s = time_s;
      track.kinematics = kinematics_of(track.estimator.estimate());
    }
  }

  /// Finds the plots that a track may own, the likeliest first.
  void gate(int slot) noexcept {
    const TrackType& track = pool_[at(slot)];
    Pairs& pairs = pairs_[at(slot)];
    pairs.count = 0;
    pairs.assigned = false;
    const double threshold = -2.0 * std::log1p(-config_.gate_probability);
    const double wild_variance =
        config_.wild_probability > 0.0 ? config_.wild_scale * config_.wild_scale : 1.0;
    // Generous: the widest mode of an estimator may be some times wider than the mixture.
    const double reach = 3.0 * std::sqrt(threshold * (track.kinematics.covariance(0, 0) +
                                                      track.kinematics.covariance(2, 2))) +
                         std::sqrt(threshold * wild_variance * largest_variance_);
    for_each_near(track.position(), reach, [&](int index) {
      const Echo& echo = echoes_[at(index)];
      Pair pair{index, brought_to(track, echo), 0.0, 0.0, 0.0};
      const Fix nominal{echo.position.covariance};
      const Fix wild{wild_variance * echo.position.covariance};
      const Evidence<double> wide = track.estimator.evidence(wild, pair.z);
      if (!(wide.least_nis <= threshold)) return;
      pair.likelihood =
          (1.0 - config_.wild_probability) * track.estimator.evidence(nominal, pair.z).likelihood +
          config_.wild_probability * wide.likelihood;
      pair.nis = squared_distance(track, pair.z, echo.position.covariance);
      insert(pairs, pair);
    });
  }

  /// A plot moved along with the track from its own time to the track's.
  static Vec<double, 2> brought_to(const TrackType& track, const Echo& echo) noexcept {
    const double dt_s = track.time_s - echo.time_s;
    return echo.position.mean +
           dt_s * Vec<double, 2>(track.kinematics.mean[1], track.kinematics.mean[3]);
  }

  static double squared_distance(const TrackType& track, const Vec<double, 2>& z,
                                 const Mat<double, 2, 2>& r) noexcept {
    const auto& p = track.kinematics.covariance;
    Mat<double, 2, 2> s = r;
    s(0, 0) += p(0, 0);
    s(0, 1) += p(0, 2);
    s(1, 0) += p(2, 0);
    s(1, 1) += p(2, 2);
    const Cholesky<2> factor(s);
    return factor.ok() ? factor.whiten<1>(Vec<double, 2>(z - track.position())).squaredNorm()
                       : std::numeric_limits<double>::infinity();
  }

  /// Keeps the `kPairs` likeliest pairs, in order.
  static void insert(Pairs& pairs, const Pair& pair) noexcept {
    if (pairs.count == kPairs && !(pair.likelihood > pairs.pair[kPairs - 1].likelihood)) return;
    int place = std::min(pairs.count, kPairs - 1);
    for (; place > 0 && pair.likelihood > pairs.pair[at(place - 1)].likelihood; --place)
      pairs.pair[at(place)] = pairs.pair[at(place - 1)];
    pairs.pair[at(place)] = pair;
    pairs.count = std::min(pairs.count + 1, kPairs);
  }

  /// The odds with which each track claims each of its plots, and their sum for each plot. To the
  /// others a claimed plot is as good as denser clutter (linear multitarget).
  void claim_plots() noexcept {
    for (const int slot : order_) {
      const TrackType& track = pool_[at(slot)];
      Pairs& pairs = pairs_[at(slot)];
      const double detected = detection() * track.visibility;
      double sum = 1.0 - detected;
      for (int k = 0; k < pairs.count; ++k) sum += weight(track, pairs.pair[at(k)]);
      const double norm = 1.0 - track.existence + track.existence * sum;
      for (int k = 0; k < pairs.count; ++k) {
        Pair& pair = pairs.pair[at(k)];
        const double claim = std::min(track.existence * weight(track, pair) / norm, kCertain);
        pair.odds = pair.likelihood * claim / (1.0 - claim);
        echoes_[at(pair.echo)].odds += pair.odds;
      }
    }
  }

  /// PD pv g / rho: how much likelier the plot is as the track's than as clutter.
  double weight(const TrackType& track, const Pair& pair) const noexcept {
    return config_.detection_probability * track.visibility * pair.likelihood /
           echoes_[at(pair.echo)].density;
  }

  /// Leaves each track at most one plot: confirmed tracks choose before tentative ones.
  void assign_plots() noexcept {
    for (const bool confirmed : {true, false}) {
      candidates_.clear(static_cast<int>(echoes_.size()));
      row_track_.clear();
      for (const int slot : order_) {
        if (pool_[at(slot)].confirmed() != confirmed) continue;
        row_track_.push_back(slot);
        candidates_.start_row(0.0);
        const Pairs& pairs = pairs_[at(slot)];
        const double missed = 1.0 - detection() * pool_[at(slot)].visibility;
        for (int k = 0; k < pairs.count; ++k) {
          const Pair& pair = pairs.pair[at(k)];
          if (echoes_[at(pair.echo)].free > 0.0)
            candidates_.add(pair.echo, -std::log(weight(pool_[at(slot)], pair) / missed));
        }
      }
      const bool solved = config_.association == Association::kGlobalNearest
                              ? global_.solve(candidates_)
                              : nearest_.solve(candidates_);
      const auto columns = config_.association == Association::kGlobalNearest
                               ? global_.assignment().column_of_row()
                               : nearest_.assignment().column_of_row();
      for (std::size_t row = 0; row < row_track_.size() && solved; ++row)
        keep_only(pairs_[at(row_track_[row])], columns[row]);
    }
  }

  void keep_only(Pairs& pairs, int echo) noexcept {
    const auto end = pairs.pair.begin() + pairs.count;
    const auto kept =
        std::find_if(pairs.pair.begin(), end, [&](const Pair& pair) { return pair.echo == echo; });
    pairs.assigned = kept != end;
    pairs.count = pairs.assigned ? 1 : 0;
    if (!pairs.assigned) return;
    pairs.pair[0] = *kept;
    pairs.pair[0].odds = echoes_[at(echo)].odds;  // nobody else claims it any more
    echoes_[at(echo)].free = 0.0;
  }

  /// Takes the plots in: state, existence and visibility.
  void update(int slot) noexcept {
    TrackType& track = pool_[at(slot)];
    Pairs& pairs = pairs_[at(slot)];
    const double seen = detection() * track.visibility;
    const double none = pairs.assigned ? 0.0 : 1.0 - seen;
    std::array<Alternative<Fix>, 2 * kPairs> readings;
    std::array<double, 2 * kPairs> share{};
    const std::size_t count = list_readings(track, pairs, readings);
    double total = none;
    if (count > 0) {
      const double sum =
          track.estimator.update(std::span<const Alternative<Fix>>(readings.data(), count), none,
                                 std::span<double>(share.data(), count));
      if (sum > 0.0) total = sum;
    }
    if (total > 0.0) weigh_existence(track, total, none, pairs.assigned);

    double claimed = 0.0;
    track.nis = std::numeric_limits<double>::quiet_NaN();
    double best = 0.0;
    for (int k = 0; k < pairs.count; ++k) {
      const double claim = share[at(2 * k)] + share[at(2 * k + 1)];
      claimed += claim;
      if (claim > best) {
        best = claim;
        track.nis = pairs.pair[at(k)].nis;
      }
      claim_echo(track, echoes_[at(pairs.pair[at(k)].echo)],
                 std::min(claim, 1.0) * track.existence);
    }
    track.kinematics = kinematics_of(track.estimator.estimate());
    track.count(claimed > 0.5);
  }

  /// Each plot as two readings, of the nominal and of the wild error.
  std::size_t list_readings(const TrackType& track, const Pairs& pairs,
                            std::array<Alternative<Fix>, 2 * kPairs>& readings) const noexcept {
    std::size_t count = 0;
    for (int k = 0; k < pairs.count; ++k) {
      const Pair& pair = pairs.pair[at(k)];
      const Echo& echo = echoes_[at(pair.echo)];
      const double claimed_by_others = std::max(echo.odds - pair.odds, 0.0);
      const double weight =
          config_.detection_probability * track.visibility / (echo.density + claimed_by_others);
      const double wild = config_.wild_scale * config_.wild_scale;
      readings[count++] = {Fix{echo.position.covariance}, pair.z,
                           (1.0 - config_.wild_probability) * weight};
      readings[count++] = {Fix{wild * echo.position.covariance}, pair.z,
                           config_.wild_probability * weight};
    }
    return count;
  }

  /// Bayes' rule for "the target exists" and for "it is visible", given how well the scan fits the
  /// track.
  void weigh_existence(TrackType& track, double total, double none, bool assigned) const noexcept {
    if (config_.visible_time_s > 0.0) {
      const double fit = (total - none) / track.visibility;
      const double if_visible = assigned ? fit : 1.0 - detection() + fit;
      const double if_hidden = assigned ? 0.0 : 1.0;
      const double visible = track.visibility * if_visible;
      track.visibility = visible / (visible + (1.0 - track.visibility) * if_hidden);
    }
    const double exists = track.existence * total;
    track.existence = std::min(exists / (1.0 - track.existence + exists), 0.99999);
  }

  void claim_echo(const TrackType& track, Echo& echo, double claim) noexcept {
    echo.free *= 1.0 - claim;
    if (claim > echo.best_claim) {
      echo.best_claim = claim;
      plot_track_id_[at(echo.plot)] = track.id;
    }
  }

  /// Confirms tracks, lets them coast, and drops those without a future.
  void judge(double time_s) noexcept {
    remove_if(time_s, [&](TrackType& track) {
      const bool was_confirmed = track.confirmed();
      if (was_confirmed || track.confirmable(config_))
        track.status = track.misses == 0                     ? TrackStatus::kConfirmed
                       : track.misses <= config_.shown_scans ? TrackStatus::kCoasting
                                                             : TrackStatus::kHeld;
      if (was_confirmed && track.misses == 1) announce(TrackEvent::kCoasting, track, time_s);
      return track.hopeless(config_, radar_);
    });
  }

  /// Of two tracks on one target the senior one stays.
  void remove_duplicates(double time_s) noexcept {
    remove_if(time_s, [&](TrackType& track) {
      const bool duplicate = std::any_of(order_.begin(), order_.end(), [&](int slot) {
        const TrackType& other = pool_[at(slot)];
        const bool gone = other.existence < 0.0;
        return &other != &track && !gone && senior(other, track) && same_target(other, track);
      });
      track.duplicate_scans = duplicate ? track.duplicate_scans + 1 : 0;
      const bool settled = track.confirmed() && track.id > 0;
      return track.duplicate_scans >= (settled ? config_.duplicate_scans : 1);
    });
  }

  static bool senior(const TrackType& a, const TrackType& b) noexcept {
    if (a.confirmed() != b.confirmed()) return a.confirmed();
    if ((a.id > 0) != (b.id > 0)) return a.id > 0;
    if (a.id > 0) return a.id < b.id;
    return a.existence > b.existence || (a.existence == b.existence && a.id > b.id);
  }

  /// Squared distance of position and of velocity, each in standard deviations of the difference,
  /// under the limit.
  bool same_target(const TrackType& a, const TrackType& b) const noexcept {
    const Vec<double, 4> d = a.kinematics.mean - b.kinematics.mean;
    const Mat<double, 4, 4> s = a.kinematics.covariance + b.kinematics.covariance;
    if (d[0] * d[0] > config_.duplicate_distance * s(0, 0) ||
        d[2] * d[2] > config_.duplicate_distance * s(2, 2))
      return false;
    double sum = 0.0;
    for (const int k : {0, 1}) {
      Mat<double, 2, 2> block;
      block << s(k, k), s(k, k + 2), s(k + 2, k), s(k + 2, k + 2);
      const Cholesky<2> factor(block);
      if (!factor.ok()) return false;
      sum += factor.whiten<1>(Vec<double, 2>(d[k], d[k + 2])).squaredNorm();
    }
    return sum < config_.duplicate_distance;
  }

  /// Numbers the tracks that were confirmed in this scan.
  void promote(double time_s) noexcept {
    for (const int slot : order_) {
      TrackType& track = pool_[at(slot)];
      if (!track.confirmed() || track.id > 0) continue;
      const std::int64_t before = track.id;
      track.id = next_id_++;
      std::replace(plot_track_id_.begin(), plot_track_id_.end(), before, track.id);
      announce(TrackEvent::kConfirmed, track, time_s);
    }
  }

  void learn_clutter(double time_s) noexcept {
    for (const Echo& echo : echoes_) map_.add(echo.position.mean, time_s, echo.free);
  }

  /// A free plot and one of the scan before, near enough for the speed limit, start a tentative
  /// track.
  void start_tracks(double time_s) noexcept {
    double earliest_s = std::numeric_limits<double>::infinity();
    double largest_variance = 0.0;
    for (const FreePlot& plot : free_) {
      earliest_s = std::min(earliest_s, plot.time_s);
      largest_variance = std::max(largest_variance, plot.position.covariance.trace());
    }
    for (const Echo& echo : echoes_) {
      if (!(echo.free > config_.free_plot)) continue;
      const double reach =
          radar_.max_speed_mps * std::max(echo.time_s - earliest_s, 0.0) +
          config_.start_gate_sigma * std::sqrt(largest_variance + echo.position.covariance.trace());
      const double north = echo.position.mean[0];
      auto place = std::lower_bound(
          free_.begin(), free_.end(), north - reach,
          [](const FreePlot& plot, double limit) { return plot.position.mean[0] < limit; });
      for (; place != free_.end() && place->position.mean[0] <= north + reach; ++place) {
        const FreePlot& earlier = *place;
        const double dt_s = echo.time_s - earlier.time_s;
        if (!(dt_s > 0.0) || !within_speed_limit(earlier.position, echo.position, dt_s,
                                                 radar_.max_speed_mps, config_.start_gate_sigma))
          continue;
        Gaussian<4> belief = two_point<double>(earlier.position, echo.position, dt_s);
        if (config_.start_speed_factor > 0.0)
          belief = with_speed_prior(belief, std::sqrt(resting_velocity().covariance(0, 0)));
        TrackType* track = open_track(
            echo.time_s, belief,
            config_.initial_existence * config_.clutter_density_per_m2 / echo.density, time_s);
        if (track != nullptr) track->history = 3u;
        if (track != nullptr) announce(TrackEvent::kStarted, *track, time_s);
      }
    }
    free_.clear();
    for (const int index : by_north_)
      if (const Echo& echo = echoes_[at(index)]; echo.free > config_.free_plot)
        free_.push_back({echo.position, echo.time_s});
  }

  /// A new tentative track of two plots; null when it cannot start or there is no room.
  TrackType* open_track(double time_s, const Gaussian<4>& belief, double existence,
                        double scan_time_s) noexcept {
    Estimator estimator = prototype_;
    if (estimator.start(belief) != Status::kOk) return nullptr;
    if (vacant_.empty() && !make_room(scan_time_s, existence)) return nullptr;
    const int slot = vacant_.back();
    TrackType& track = pool_[at(slot)];
    track.estimator = estimator;
    vacant_.pop_back();
    order_.push_back(slot);
    track.id = track.tentative_id = next_tentative_id_--;
    track.name.fill('\0');
    track.status = TrackStatus::kTentative;
    track.time_s = time_s;
    track.kinematics = belief;
    track.existence = existence;
    track.visibility = 1.0;
    track.nis = std::numeric_limits<double>::quiet_NaN();
    track.scans = track.hits = 2;
    track.misses = track.duplicate_scans = 0;
    track.history = 0;
    return &track;
  }

  /// Gives up the weakest tentative track if it is weaker than a new one would be.
  bool make_room(double time_s, double existence) noexcept {
    auto weakest = order_.end();
    for (auto place = order_.begin(); place != order_.end(); ++place) {
      const TrackType& track = pool_[at(*place)];
      if (!track.confirmed() && track.existence < existence &&
          (weakest == order_.end() || track.existence < pool_[at(*weakest)].existence))
        weakest = place;
    }
    if (weakest == order_.end()) return false;
    end(*weakest, time_s);
    order_.erase(weakest);
    return true;
  }

  /// The end of a track: its plots are nobody's, its slot is free.
  void end(int slot, double time_s) noexcept {
    const TrackType& track = pool_[at(slot)];
    announce(TrackEvent::kLost, track, time_s);
    std::replace(plot_track_id_.begin(), plot_track_id_.end(), track.id, std::int64_t{0});
    vacant_.push_back(slot);
  }

  template <class Predicate>
  void remove_if(double time_s, Predicate&& predicate) noexcept {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const int slot = order_[k];
      TrackType& track = pool_[at(slot)];
      if (predicate(track)) {
        end(slot, time_s);
        track.existence = -1.0;
      } else {
        order_[kept++] = slot;
      }
    }
    order_.resize(kept);
  }

  void announce(TrackEvent kind, const TrackType& track, double time_s) noexcept {
    if (events_.size() < events_.capacity())
      events_.push_back({kind, track.id, track.tentative_id, time_s});
  }

  /// FNV-1a, 64 bits.
  static std::uint64_t checksum(std::span<const std::byte> bytes) noexcept {
    std::uint64_t sum = 0xCBF29CE484222325u;
    for (const std::byte byte : bytes)
      sum = (sum ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001B3u;
    return sum;
  }

  void archive(Archive& fields) {
    std::uint32_t version = kArchiveVersion;
    fields(version);
    Radar radar = radar_;
    TrackerConfig config = config_;
    const auto each = [&](auto&... field) { (fields(field), ...); };
    std::apply(each, radar.settings());
    std::apply(each, config.settings());
    const bool same = version == kArchiveVersion && radar.settings() == radar_.settings() &&
                      config.settings() == config_.settings();
    if (!same) fields.fail();
    if (!fields.ok()) return;
    fields(time_s_);
    fields(started_);
    fields(next_id_);
    fields(next_tentative_id_);
    fields(order_, pool_.size());
    fields(vacant_, pool_.size());
    map_.archive(fields);
    auto waiting = static_cast<std::uint64_t>(free_.size());
    fields(waiting);
    if (waiting > static_cast<std::uint64_t>(config_.max_plots)) fields.fail();
    if (!fields.ok()) return;
    free_.resize(static_cast<std::size_t>(waiting));
    for (FreePlot& plot : free_) {
      fields(plot.position.mean);
      fields(plot.position.covariance);
      fields(plot.time_s);
    }
    for (const int slot : order_) {
      if (slot < 0 || slot >= static_cast<int>(pool_.size())) {
        fields.fail();
        return;
      }
      pool_[at(slot)].archive(fields);
    }
  }

  Radar radar_;
  TrackerConfig config_;
  Estimator prototype_;
  ClutterMap map_;
  std::vector<TrackType> pool_;
  std::vector<int> order_;    ///< slots of the pool in use, older tracks first
  std::vector<int> vacant_;   ///< the others
  std::vector<Pairs> pairs_;  ///< by slot
  std::vector<Echo> echoes_;
  std::vector<int> by_north_;
  std::vector<FreePlot> free_;  ///< of the scan before, from south to north
  std::vector<std::int64_t> plot_track_id_;
  std::vector<Event> events_;
  std::vector<int> row_track_;
  Candidates<double> candidates_;
  GlobalNearestNeighbour<double> global_;
  NearestNeighbour<double> nearest_;
  double largest_variance_ = 0.0;
  double time_s_ = 0.0;
  bool started_ = false;
  std::int64_t next_id_ = 1;
  std::int64_t next_tentative_id_ = -1;
};

}  // namespace wakeline
