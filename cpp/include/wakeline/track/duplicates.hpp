// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
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
/// deviations of the difference, is at most the limit. The velocity of a tentative track is of two
/// plots, each of which may be another echo, and is not compared.
inline bool same_vessel(const Track& known, const Track& other, double length_m,
                        double limit) noexcept {
  if (!known.active()) return false;
  if (!((known.position() - other.position()).squaredNorm() < length_m * length_m)) return false;
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
  std::span<const int> find(TrackList& tracks, std::span<const int> slots) noexcept {
    index(tracks);
    found_.clear();
    for (const int slot : slots) {
      Track& track = tracks.at(slot);
      track.duplicate_scans = has_senior(tracks, track) ? track.duplicate_scans + 1 : 0;
      const bool numbered = track.confirmed() && track.id > 0;
      if (track.duplicate_scans < (numbered ? scans_ : 1)) continue;
      ends_[static_cast<std::size_t>(slot)] = 1;
      found_.push_back(slot);
    }
    return found_;
  }

 private:
  void index(const TrackList& tracks) noexcept {
    positions_.clear();
    for (const int slot : tracks.slots()) {
      const Track& track = tracks.at(slot);
      ends_[static_cast<std::size_t>(slot)] = 0;
      if (is_finite(track.position())) positions_.add(track.position(), widest_m2(track), slot);
    }
    positions_.sort();
  }

  /// Variance of the position along the axis where it is larger.
  static double widest_m2(const Track& track) noexcept {
    return std::max(track.kinematics.covariance(0, 0), track.kinematics.covariance(2, 2));
  }

  /// Whether a senior track, which is not to be deleted itself, is on the same target.
  [[nodiscard]] bool has_senior(const TrackList& tracks, const Track& track) const noexcept {
    // `same_target` calls no two tracks farther apart one; a little more for rounding.
    const auto reach_m = [&](double other_m2) {
      const double same_m = std::sqrt(distance_ * (widest_m2(track) + other_m2));
      return 1.001 * std::max(same_m, length_m_);
    };
    bool found = false;
    positions_.for_each_near(track.position(), reach_m, [&](int slot) {
      const Track& other = tracks.at(slot);
      found = found || (&other != &track && ends_[static_cast<std::size_t>(slot)] == 0 &&
                        is_senior(other, track) &&
                        (same_target(other.kinematics, track.kinematics, distance_) ||
                         same_vessel(other, track, length_m_, velocity_threshold_)));
    });
    return found;
  }

  double distance_;
  double length_m_;
  int scans_;
  double velocity_threshold_;
  PlaceIndex positions_;
  std::vector<char> ends_;  ///< by slot, whether it is among those found
  std::vector<int> found_;
};

}  // namespace wakeline
