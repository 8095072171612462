// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/place_index.hpp"
#include "wakeline/track/track_list.hpp"

namespace wakeline {

/// Of two tracks on one target, whether `a` is the one to stay: confirmed before tentative, older
/// before younger, more probable before less probable.
inline bool is_senior(const Track& a, const Track& b) noexcept {
  if (a.confirmed() != b.confirmed()) return a.confirmed();
  if ((a.id > 0) != (b.id > 0)) return a.id > 0;
  if (a.id > 0) return a.id < b.id;
  return a.existence > b.existence || (a.existence == b.existence && a.id > b.id);
}

/// Whether two beliefs over `[x, vx, y, vy]` are of one target: the squared distance of their
/// positions and that of their velocities, in standard deviations of the difference, sum to less
/// than the limit.
inline bool same_target(const Gaussian<4>& a, const Gaussian<4>& b, double limit) noexcept {
  const Vec<double, 4> d = a.mean - b.mean;
  for (const int k : {0, 2})
    if (d[k] * d[k] > limit * (a.covariance(k, k) + b.covariance(k, k))) return false;
  double sum = 0.0;
  for (const int k : {0, 1}) {
    Mat<double, 2, 2> s;
    for (const int i : {0, 1})
      for (const int j : {0, 1})
        s(i, j) = a.covariance(k + 2 * i, k + 2 * j) + b.covariance(k + 2 * i, k + 2 * j);
    const Cholesky<2> factor(s);
    if (!factor.ok()) return false;
    sum += factor.squared_norm(Vec<double, 2>(d[k], d[k + 2]));
  }
  return sum < limit;
}

/// Whether another track may be of the same vessel as a known one that is shown, by another of its
/// echoes: nearer to it than its length, m, at a velocity whose squared distance, in standard
/// deviations of the difference, is at most the limit. `then` is the belief of the known one at the
/// time of the other. The velocity of a tentative track is of two
/// plots, each of which may be another echo, and is not compared.
inline bool same_vessel(const Track& known, const Gaussian<4>& then, const Track& other,
                        double length_m, double limit) noexcept {
  if (!known.active()) return false;
  const Vec<double, 2> position(then.mean[0], then.mean[2]);
  if (!((position - other.position()).squaredNorm() < length_m * length_m)) return false;
  if (!other.confirmed()) return true;
  const Cholesky<2> factor(known.velocity_covariance() + other.velocity_covariance());
  return factor.ok() && factor.squared_norm(known.velocity() - other.velocity()) <= limit;
}

/// Finds tracks that are on the same target as a senior one. Memory is taken by the constructor.
class Duplicates {
 public:
  Duplicates(const TrackerConfig& config, double velocity_threshold)
      : distance_(config.duplicate_distance),
        length_m_(config.vessel_length_m),
        scans_(config.duplicate_scans),
        velocity_threshold_(velocity_threshold),
        positions_(config.max_tracks),
        ends_(static_cast<std::size_t>(config.max_tracks), 0) {
    found_.reserve(ends_.size());
  }

  /// Which tracks of these slots are to be deleted, in order: tentative ones at once, those with a
  /// number after some scans in a row, which it counts. Valid until the next call.
  /// They are compared with the tracks of `others`, but not those whose times are more than two
  /// periods of the antenna apart. Two tracks that `seen_by_others(a, b)`, each by radars that do
  /// not see the other, are on one target as far apart as independent estimates of it are.
  template <class SeenByOthers>
  std::span<const int> find(TrackList& tracks, std::span<const int> slots,
                            std::span<const int> others, double period_s, int radars,
                            const SeenByOthers& seen_by_others) noexcept {
    longest_s_ = 2.0 * period_s;
    farthest_ = radars > 1 ? std::max(distance_, kSeenByOthers) : distance_;
    index(tracks, slots, others);
    found_.clear();
    for (const int slot : slots) {
      Track& track = tracks.at(slot);
      track.duplicate_scans =
          has_senior(tracks, track, seen_by_others) ? track.duplicate_scans + 1 : 0;
      const bool numbered = track.confirmed() && track.id > 0;
      if (track.duplicate_scans < (numbered ? scans_ : 1)) continue;
      ends_[static_cast<std::size_t>(slot)] = 1;
      found_.push_back(slot);
    }
    return found_;
  }

 private:
  /// Indexes the tracks that may be on the target of one of the slots.
  void index(const TrackList& tracks, std::span<const int> slots,
             std::span<const int> others) noexcept {
    positions_.clear();
    way_m_ = 0.0;
    if (slots.empty()) return;
    constexpr double kNowhere = std::numeric_limits<double>::infinity();
    double begin_s = kNowhere, end_s = -kNowhere;
    for (const int slot : slots) {
      const Track& track = tracks.at(slot);
      begin_s = std::min(begin_s, track.time_s);
      end_s = std::max(end_s, track.time_s);
    }
    for (const int slot : others) {
      const Track& track = tracks.at(slot);
      ends_[static_cast<std::size_t>(slot)] = 0;
      positions_.add(track.position(), widest_m2(track), slot);
      way_m_ = std::max(
          way_m_, track.velocity().cwiseAbs().maxCoeff() *
                      std::min(std::max(end_s - track.time_s, track.time_s - begin_s), longest_s_));
    }
    positions_.sort();
  }

  /// Tracks of one time whose variances sum to that are not on one target farther apart, squared; a
  /// little more for rounding.
  [[nodiscard]] double reach_m2(double variance_m2) const noexcept {
    return 1.002 * std::max(farthest_ * variance_m2, length_m_ * length_m_);
  }

  /// Variance of the position along the axis where it is larger.
  static double widest_m2(const Track& track) noexcept {
    return std::max(track.kinematics.covariance(0, 0), track.kinematics.covariance(2, 2));
  }

  /// Whether a senior track, which is not to be deleted itself, is on the same target.
  template <class SeenByOthers>
  [[nodiscard]] bool has_senior(const TrackList& tracks, const Track& track,
                                const SeenByOthers& seen_by_others) const noexcept {
    const auto reach = [&](double other_m2) {
      return std::sqrt(reach_m2(widest_m2(track) + other_m2)) + way_m_;
    };
    bool found = false;
    positions_.for_each_nearest(track.position(), reach, PlaneSlices::kMostNear, [&](int slot) {
      const Track& other = tracks.at(slot);
      if (found || &other == &track || ends_[static_cast<std::size_t>(slot)] != 0 ||
          !is_senior(other, track))
        return;
      const double dt_s = track.time_s - other.time_s;
      if (std::abs(dt_s) > longest_s_) return;
      const Gaussian<2> there = position_at_constant_velocity(other.kinematics, dt_s);
      if ((there.mean - track.position()).cwiseAbs2().maxCoeff() >
          reach_m2(there.covariance.diagonal().maxCoeff() + widest_m2(track)))
        return;
      const Gaussian<4> then =
          dt_s == 0.0 ? other.kinematics : at_constant_velocity(other.kinematics, dt_s);
      found = same_target(then, track.kinematics, distance_) ||
              (farthest_ > distance_ && seen_by_others(track, other) &&
               same_target(then, track.kinematics, farthest_)) ||
              same_vessel(other, then, track, length_m_, velocity_threshold_);
    });
    return found;
  }

  static constexpr double kSeenByOthers = 9.5;  ///< of four degrees of freedom 95 %

  double longest_s_ = 0.0;  ///< between the times of two tracks that are compared
  double distance_;
  double farthest_ = 0.0;  ///< that two tracks on one target are apart, as `distance_`
  double length_m_;
  int scans_;
  double velocity_threshold_;
  PlaceIndex positions_;
  double way_m_ = 0.0;      ///< of the fastest indexed track between the times of two
  std::vector<char> ends_;  ///< by slot, whether it is among those found
  std::vector<int> found_;
};

}  // namespace wakeline
