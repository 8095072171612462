// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Which tracks are sent when, and by which numbers: what all outputs have in common.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// A track as it is sent.
struct ReportedTrack {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::int64_t id = 0;
  double time_s = 0.0;             ///< of the estimate, since a midnight (UTC)
  Gaussian<4> kinematics = {};     ///< `[x, vx, y, vy]` at that time, north and east
  bool has_covariance = false;     ///< that of `kinematics` is known
  bool coasting = false;           ///< not seen when the radar looked last
  bool acquiring = false;          ///< acquired by the operator, its motion not yet known
  bool manual = false;             ///< acquired by the operator, also long ago
  double turn_rate_rad_s = kNone;  ///< to starboard; NaN when unknown
  double age_s = kNone;            ///< since the last plot; NaN when unknown
  std::array<char, 32> name{};     ///< zero-terminated

  void set_name(std::string_view text) noexcept {
    name = {};
    std::memcpy(name.data(), text.data(), std::min(text.size(), name.size() - 1));
  }
  [[nodiscard]] std::string_view label() const noexcept { return name.data(); }
  [[nodiscard]] Vec<double, 2> position() const noexcept {
    return {kinematics.mean[0], kinematics.mean[2]};
  }
  [[nodiscard]] Vec<double, 2> velocity() const noexcept {
    return {kinematics.mean[1], kinematics.mean[3]};
  }
};

/// Numbers from 0 on for tracks. One that is given back rests for `hold_off_s` before it is given
/// to another track; the next number is given first, so that each rests as long as it can.
class NumberPool {
 public:
  NumberPool(int count, double hold_off_s)
      : free_at_s_(static_cast<std::size_t>(count), kFree),
        track_of_(free_at_s_.size(), kNoTrack),
        hold_off_s_(hold_off_s) {
    require_not_negative("hold_off_s", hold_off_s);
  }

  [[nodiscard]] int count() const noexcept { return static_cast<int>(free_at_s_.size()); }

  /// A number for a track: the one that it had, if that rests; -1 when all are taken or rest.
  int take(std::int64_t track_id, double time_s) noexcept {
    const auto had = std::find(track_of_.begin(), track_of_.end(), track_id) - track_of_.begin();
    if (had < std::ssize(track_of_)) return given(static_cast<int>(had), track_id);
    const auto count = static_cast<int>(free_at_s_.size());
    for (int tried = 0; tried < count; ++tried) {
      next_ = next_ + 1 < count ? next_ + 1 : 0;
      if (free_at_s_[static_cast<std::size_t>(next_)] <= time_s) return given(next_, track_id);
    }
    return -1;
  }

  void give_back(int number, double time_s) noexcept {
    free_at_s_[static_cast<std::size_t>(number)] = time_s + hold_off_s_;
  }

  void archive(Archive& fields) {
    const std::size_t count = free_at_s_.size();
    fields(free_at_s_, count);
    fields(next_);
    fields(track_of_, count);
    if (free_at_s_.size() != count || track_of_.size() != count || next_ < 0 ||
        next_ >= static_cast<int>(count))
      fields.fail();
  }

 private:
  static constexpr double kFree = -std::numeric_limits<double>::infinity();
  static constexpr double kTaken = std::numeric_limits<double>::infinity();

  static constexpr std::int64_t kNoTrack = std::numeric_limits<std::int64_t>::min();

  int given(int number, std::int64_t track_id) noexcept {
    free_at_s_[static_cast<std::size_t>(number)] = kTaken;
    track_of_[static_cast<std::size_t>(number)] = track_id;
    return number;
  }

  std::vector<double> free_at_s_;
  std::vector<std::int64_t> track_of_;  ///< that had a number last
  double hold_off_s_;
  int next_ = 0;
};

/// The place of a report in those of a track.
struct ReportTurn {
  int number = 0;
  bool first = false;
  bool last = false;  ///< the track has ended: the estimate is the last one that was sent
};

/// Decides which tracks are sent.
///
/// A track is sent when its estimate is newer than the one sent last and `interval_s` has passed
/// since. A track that is no longer among those given is sent as the last report once, and its
/// number then rests. A track without a free number waits. Allocates only when more than 1024
/// tracks, and more than ever before, are sent.
class ReportSchedule {
 public:
  /// Throws `std::invalid_argument` when an interval is negative or not finite.
  ReportSchedule(int numbers, double interval_s, double hold_off_s)
      : pool_(numbers, hold_off_s), interval_s_(interval_s) {
    require_not_negative("interval_s", interval_s);
    sent_.reserve(static_cast<std::size_t>(std::min(numbers, 1024)));
  }

  /// Calls `send(track, turn)` for each track to be sent now, ended ones first. `tracks` are all
  /// that are shown. Tracks that are not finite, or 10 000 km away, are not sent.
  template <class Send>
  void update(double time_s, std::span<const ReportedTrack> tracks, Send&& send) noexcept {
    for (Sent& one : sent_) one.present = false;
    for (const ReportedTrack& track : tracks)
      if (Sent* one = find(track.id)) one->present = true;
    std::erase_if(sent_, [&](const Sent& one) {
      if (one.present) return false;
      send(one.track, ReportTurn{.number = one.number, .last = true});
      pool_.give_back(one.number, time_s);
      return true;
    });
    waiting_ = 0;
    for (const ReportedTrack& track : tracks) {
      if (!valid(track)) continue;
      Sent* one = find(track.id);
      const bool first = one == nullptr;
      if (first && (one = add(track.id, time_s)) == nullptr) continue;
      const double passed_s = time_s - one->time_s;
      if (!first &&
          (!(track.time_s > one->track.time_s) || (passed_s >= 0.0 && passed_s < interval_s_)))
        continue;
      one->time_s = time_s;
      one->track = track;
      send(track, ReportTurn{.number = one->number, .first = first});
    }
  }

  /// Tracks that had no number in the last update.
  [[nodiscard]] int waiting() const noexcept { return waiting_; }

  /// Calls `visit(id, number)` for each track that has a number.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (const Sent& one : sent_) visit(one.track.id, one.number);
  }

  void archive(Archive& fields) {
    pool_.archive(fields);
    auto count = static_cast<std::uint64_t>(sent_.size());
    fields(count);
    if (fields.loading()) {
      if (count > static_cast<std::uint64_t>(pool_.count())) return fields.fail();
      sent_.assign(static_cast<std::size_t>(count), Sent{});
    }
    for (Sent& one : sent_) one.archive(fields);
  }

 private:
  struct Sent {
    ReportedTrack track;  ///< as sent last
    double time_s = 0.0;
    int number = 0;
    bool present = true;

    void archive(Archive& fields) {
      fields(track.id);
      fields(track.time_s);
      fields(track.kinematics.mean);
      fields(track.kinematics.covariance);
      fields(track.has_covariance);
      fields(track.coasting);
      fields(track.acquiring);
      fields(track.manual);
      fields(track.turn_rate_rad_s);
      fields(track.age_s);
      fields(track.name);
      fields(time_s);
      fields(number);
    }
  };

  std::vector<Sent>::iterator place_of(std::int64_t id) noexcept {
    return std::lower_bound(sent_.begin(), sent_.end(), id,
                            [](const Sent& one, std::int64_t key) { return one.track.id < key; });
  }

  static bool valid(const ReportedTrack& track) noexcept {
    return std::isfinite(track.time_s) && track.kinematics.mean.cwiseAbs().maxCoeff() < 1e7 &&
           track.kinematics.mean.allFinite();
  }

  Sent* find(std::int64_t id) noexcept {
    const auto at = place_of(id);
    return at != sent_.end() && at->track.id == id ? &*at : nullptr;
  }

  Sent* add(std::int64_t id, double time_s) noexcept {
    const int number = pool_.take(id, time_s);
    if (number < 0) {
      ++waiting_;
      return nullptr;
    }
    Sent one;
    one.track.id = id;
    one.number = number;
    return &*sent_.insert(place_of(id), one);
  }

  NumberPool pool_;
  double interval_s_;
  std::vector<Sent> sent_;  ///< by `track.id`
  int waiting_ = 0;
};

}  // namespace wakeline
