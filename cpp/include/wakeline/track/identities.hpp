// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Vessels that report where they are, by AIS or GNSS, and which tracks they are.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/core/utf8.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// The position that a vessel reports of itself, such as by AIS.
struct PositionReport {
  std::string_view source = "ais";  ///< of 1 to 15 bytes: the same identity of two sources is two
  std::string_view identity = {};   ///< of 1 to 31 bytes, UTF-8
  double time_s = 0.0;              ///< of the position, true time
  Vec<double, 2> position_m = Vec<double, 2>::Zero();  ///< [north, east]
  double position_std_m = 10.0;                        ///< per axis
  Vec<double, 2> velocity_mps = Vec<double, 2>::Zero();
  double velocity_std_mps = 0.0;  ///< per axis; 0: the velocity is not known
  [[nodiscard]] bool has_velocity() const noexcept { return velocity_std_mps > 0.0; }

  /// Whether every number is finite, all but the time in range, and the texts are such.
  [[nodiscard]] bool is_valid() const noexcept {
    return !source.empty() && source.size() <= kMostSource && !identity.empty() &&
           identity.size() <= kMostIdentity && is_utf8(source) && is_utf8(identity) &&
           std::isfinite(time_s) && in_range(position_m) && position_std_m > 0.0 &&
           in_range(position_std_m) && in_range(velocity_mps) && velocity_std_mps >= 0.0 &&
           in_range(velocity_std_mps);
  }

  static constexpr std::size_t kMostSource = 15, kMostIdentity = 31;
};

/// Times of a source that reports, beside those of the scans.
///
/// A time far ahead of the last scan is that of a clock that is ahead, unless radars are silent:
/// then no scan comes between reports of a source that are as far apart, or that were not ahead. A
/// report ahead would take its track into the future, where no plot could correct it.
class ReportClock {
 public:
  /// The time of a report: that of the last scan where it is ahead by more than so much.
  [[nodiscard]] double operator()(double time_s, double scan_time_s, double most_s) noexcept {
    const bool is_silent =
        scan_time_s_ == scan_time_s && (!is_ahead_ || time_s - stated_s_ > most_s);
    is_ahead_ = time_s > scan_time_s + most_s && !is_silent;
    stated_s_ = time_s;
    scan_time_s_ = scan_time_s;
    return is_ahead_ ? scan_time_s : time_s;
  }

  void archive(Archive& fields) {
    fields(stated_s_);
    fields(scan_time_s_);
    fields(is_ahead_);
  }

 private:
  double stated_s_ = -std::numeric_limits<double>::infinity();     ///< of the last report
  double scan_time_s_ = -std::numeric_limits<double>::infinity();  ///< of the last scan before it
  bool is_ahead_ = false;                                          ///< it was
};

/// Whether reported positions move at the reported velocity.
///
/// A position is predicted from report to report by the mean of both velocities, and corrected by
/// each position. The prediction error shows a wrong velocity, in standard deviations; and so does
/// the sum of the last ones, of which each counts a fifth less than the one after it, where it is
/// small. A velocity may be smoothed: what it may lag behind in three seconds is allowed for.
class ReportedVelocity {
 public:
  /// Takes the next report, so long after the last one.
  void note(const PositionReport& report, double since_s) noexcept {
    const double report_m2 = report.position_std_m * report.position_std_m;
    reports_ = report.has_velocity() ? reports_ + 1 : 0;
    const Vec<double, 2> change_mps = report.velocity_mps - velocity_mps_;
    constexpr double kLag_s = 3.0;
    const double lag = 0.25 + (since_s > 0.0 ? kLag_s / since_s : 0.0);
    const double velocity_m2s2 =
        report.velocity_std_mps * report.velocity_std_mps + lag * lag * change_mps.squaredNorm();
    const double predicted_m2 = variance_m2_ + since_s * since_s * velocity_m2s2;
    const double total_m2 = predicted_m2 + report_m2;
    const Vec<double, 2> off_m =
        report.position_m - position_m_ - since_s * (velocity_mps_ + change_mps / 2);
    const Vec<double, 2> off = off_m / std::sqrt(total_m2);
    const double square = off.squaredNorm();
    const bool begins = reports_ < 2, follows = !begins && square <= kContradiction;
    if (begins)
      sum_.setZero();
    else
      sum_ = kMemory * sum_ + std::min(1.0, std::sqrt(kContradiction / square)) * off;
    squared_ = begins ? 0.0 : std::max(square, (1.0 - kMemory * kMemory) * sum_.squaredNorm());
    const double gain = follows ? predicted_m2 / total_m2 : 1.0;
    position_m_ = report.position_m - (1.0 - gain) * off_m;
    variance_m2_ = gain * report_m2;
    velocity_mps_ = report.velocity_mps;
  }

  /// Whether the last report fits those before; one alone shows nothing.
  [[nodiscard]] bool fits() const noexcept { return reports_ > 1 && squared_ <= kFit; }
  /// Whether it contradicts them.
  [[nodiscard]] bool contradicts() const noexcept { return squared_ > kContradiction; }

  void archive(Archive& fields) {
    fields(position_m_);
    fields(variance_m2_);
    fields(velocity_mps_);
    fields(sum_);
    fields(squared_);
    fields(reports_);
  }

 private:
  static constexpr double kFit = 9.0, kContradiction = 16.0;  ///< squared standard deviations
  static constexpr double kMemory = 0.8;                      ///< what the report before counts

  Vec<double, 2> position_m_ = Vec<double, 2>::Zero();
  double variance_m2_ = 0.0;  ///< per axis
  Vec<double, 2> velocity_mps_ = Vec<double, 2>::Zero();
  Vec<double, 2> sum_ = Vec<double, 2>::Zero();  ///< of what reports were off
  double squared_ = 0.0;                         ///< the greater of both, of the last report
  int reports_ = 0;                              ///< with a velocity, in a row
};

/// A vessel that reports, and what is believed of which track it is.
///
/// The reports of an identity are of one of a few tracks near them or of none. The logarithm of the
/// odds of each grows by log N(report; track) - log ρ with every report, where ρ is the density of
/// vessels that it may be of instead, in bounds: an identity that is stolen or wrong is let go of
/// after a few reports.
struct Identity {
  /// One of the tracks that it may be.
  struct Candidate {
    std::int64_t birth = 0;           ///< of the track
    int slot = -1;                    ///< -1: none
    double log_odds = kLeastLogOdds;  ///< against being of no track

    [[nodiscard]] bool is(const Track& track) const noexcept {
      return slot == track.slot && birth == track.birth;
    }

    void archive(Archive& fields) {
      fields(birth);
      fields(slot);
      fields(log_odds);
    }
  };

  static constexpr std::size_t kMostCandidates = 3;
  static constexpr double kLeastLogOdds = -8.0, kMostLogOdds = 6.0;
  static constexpr double kFirstDoubt_s = 240.0, kMostDoubt_s = 1920.0;

  std::array<char, PositionReport::kMostSource + 1> source = {};
  std::array<char, PositionReport::kMostIdentity + 1> name = {};
  ReportClock clock = {};
  double time_s = -std::numeric_limits<double>::infinity();  ///< of the last report
  double interval_s = 0.0;  ///< between the last two; 0 after the first
  Vec<double, 2> position_m = Vec<double, 2>::Zero();
  double position_std_m = 0.0;
  ReportedVelocity velocity = {};
  bool disagrees = false;  ///< its last report was far from the track that it is
  double doubted_until_s = -std::numeric_limits<double>::infinity();  ///< by radars
  double doubt_s = kFirstDoubt_s;  ///< for which it is doubted when radars contradict it next
  int leaps = 0;                   ///< reports where a vessel cannot run to, since it was steady
  int in_a_row = 0;                ///< reports between which a vessel can have run
  std::array<Candidate, kMostCandidates> candidates = {};

  [[nodiscard]] bool reported() const noexcept { return std::isfinite(time_s); }

  /// Whether it was lately where a vessel cannot run after its report before.
  [[nodiscard]] bool jumps() const noexcept { return leaps > 0; }

  /// Whether it is reported by several vessels: one wrong position is two leaps, there and back.
  [[nodiscard]] bool is_of_several() const noexcept { return leaps > 2; }

  /// Whether a report is where a vessel under the speed limit can be after the last one.
  [[nodiscard]] bool can_be_at(const PositionReport& report, double max_speed_mps) const noexcept {
    constexpr double kSigmas = 4.0;
    const double way_m = max_speed_mps * (report.time_s - time_s) +
                         kSigmas * (report.position_std_m + position_std_m);
    return reported() && (report.position_m - position_m).norm() <= way_m;
  }

  /// How long its silence is that of a vessel which is still there.
  [[nodiscard]] double patience_s() const noexcept {
    constexpr double kIntervals = 2.5, kLeast_s = 20.0, kFirst_s = 60.0, kMost_s = 480.0;
    return interval_s > 0.0 ? std::clamp(kIntervals * interval_s, kLeast_s, kMost_s) : kFirst_s;
  }

  /// Notes a report. An identity is steady again after as many in a row as it leapt.
  void note(const PositionReport& report, double max_speed_mps) noexcept {
    constexpr int kSteady = 2, kMostLeaps = 12;
    in_a_row = can_be_at(report, max_speed_mps) ? in_a_row + 1 : 0;
    if (reported() && in_a_row == 0) leaps = std::min(leaps + 1, kMostLeaps);
    if (in_a_row >= std::max(kSteady, leaps)) leaps = 0;
    interval_s = reported() ? report.time_s - time_s : 0.0;
    velocity.note(report, interval_s);
    time_s = report.time_s;
    position_m = report.position_m;
    position_std_m = report.position_std_m;
  }

  /// Doubts it as radars contradict its last report, each time for twice as long.
  void doubt() noexcept {
    doubted_until_s = time_s + doubt_s;
    doubt_s = std::min(2.0 * doubt_s, kMostDoubt_s);
  }
  [[nodiscard]] bool is_doubted() const noexcept { return time_s < doubted_until_s; }

  /// The probability of each candidate: of its odds against those of the others and of none.
  [[nodiscard]] double probability(const Candidate& candidate) const noexcept {
    double sum = 1.0;
    for (const Candidate& other : candidates)
      if (other.slot >= 0) sum += std::exp(other.log_odds);
    return candidate.slot < 0 ? 0.0 : std::exp(candidate.log_odds) / sum;
  }

  /// The likeliest track, or null when there is none.
  [[nodiscard]] const Candidate* likeliest() const noexcept {
    const Candidate* best = nullptr;
    for (const Candidate& candidate : candidates)
      if (candidate.slot >= 0 && (best == nullptr || candidate.log_odds > best->log_odds))
        best = &candidate;
    return best;
  }

  /// What was believed of one track is believed of another.
  void hand_over(const Track& from, const Track& to) noexcept {
    for (Candidate& candidate : candidates)
      if (candidate.is(to)) candidate = {};
    for (Candidate& candidate : candidates)
      if (candidate.is(from)) candidate = {to.birth, to.slot, candidate.log_odds};
  }

  /// Adds evidence for a track; an unlikely candidate makes room for it.
  void weigh(const Track& track, double log_ratio) noexcept {
    Candidate* place = &candidates[0];
    for (Candidate& candidate : candidates) {
      if (candidate.is(track)) {
        candidate.log_odds =
            std::clamp(candidate.log_odds + log_ratio, kLeastLogOdds, kMostLogOdds);
        return;
      }
      if (place->slot >= 0 && (candidate.slot < 0 || candidate.log_odds < place->log_odds))
        place = &candidate;
    }
    if (place->slot < 0 || log_ratio > place->log_odds)
      *place = {track.birth, track.slot, std::clamp(log_ratio, kLeastLogOdds, kMostLogOdds)};
  }

  void archive(Archive& fields) {
    fields(source);
    fields(name);
    clock.archive(fields);
    fields(time_s);
    fields(interval_s);
    fields(position_m);
    fields(position_std_m);
    velocity.archive(fields);
    fields(disagrees);
    fields(doubted_until_s);
    fields(doubt_s);
    fields(leaps);
    fields(in_a_row);
    for (Candidate& candidate : candidates) candidate.archive(fields);
  }
};

/// The identities that have reported, at most a fixed number. Memory is taken by the constructor.
class Identities {
 public:
  explicit Identities(int capacity) : capacity_(static_cast<std::size_t>(capacity)) {
    identities_.reserve(capacity_);
  }

  /// The number of the one of that source and name; -1 where it has not reported.
  [[nodiscard]] int find(std::string_view source, std::string_view name) const noexcept {
    const auto is_it = [&](const Identity& one) {
      return name == one.name.data() && source == one.source.data();
    };
    const auto found = std::find_if(identities_.begin(), identities_.end(), is_it);
    return found == identities_.end() ? -1 : static_cast<int>(found - identities_.begin());
  }

  /// The same, added where it has not reported; the one that has been silent for longest makes
  /// room.
  int find_or_add(std::string_view source, std::string_view name) noexcept {
    const int known = find(source, name);
    if (known >= 0) return known;
    Identity one;
    std::copy(source.begin(), source.end(), one.source.begin());
    std::copy(name.begin(), name.end(), one.name.begin());
    if (identities_.size() < capacity_) {
      identities_.push_back(one);
      return static_cast<int>(identities_.size()) - 1;
    }
    const auto silent =
        std::min_element(identities_.begin(), identities_.end(),
                         [](const Identity& a, const Identity& b) { return a.time_s < b.time_s; });
    *silent = one;
    return static_cast<int>(silent - identities_.begin());
  }

  [[nodiscard]] Identity& operator[](int number) noexcept {
    return identities_[static_cast<std::size_t>(number)];
  }
  [[nodiscard]] const Identity& operator[](int number) const noexcept {
    return identities_[static_cast<std::size_t>(number)];
  }
  [[nodiscard]] auto begin() const noexcept { return identities_.begin(); }
  [[nodiscard]] auto end() const noexcept { return identities_.end(); }

  void archive(Archive& fields) {
    auto count = static_cast<std::uint64_t>(identities_.size());
    fields(count);
    if (count > capacity_) fields.fail();
    if (!fields.ok()) return;
    identities_.resize(static_cast<std::size_t>(count));
    for (Identity& identity : identities_) identity.archive(fields);
  }

 private:
  std::size_t capacity_;
  std::vector<Identity> identities_;
};

}  // namespace wakeline
