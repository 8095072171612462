// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wakeline/track/track_list.hpp"

namespace wakeline {

/// Which track is deleted for a new one when a list is full: the weakest tentative one, of equals
/// the oldest. Memory is taken by the constructor.
class TrackRoom {
 public:
  explicit TrackRoom(int max_tracks) { weakest_.reserve(static_cast<std::size_t>(max_tracks)); }

  /// To be called when tracks or their existence have changed other than by `add` and `make_room`.
  void reset() noexcept { listed_ = false; }

  /// Whether a track of that existence has room, be it in place of a weaker one.
  bool has_room_for(double existence, const TrackList& tracks) noexcept {
    if (!tracks.full()) return true;
    if (!listed_) list(tracks);
    return !weakest_.empty() && weakest_.front().existence < existence;
  }

  /// The slot of the track to delete, after `has_room_for` of a full list.
  int make_room() noexcept {
    const int slot = weakest_.front().slot;
    std::pop_heap(weakest_.begin(), weakest_.end(), is_stronger);
    weakest_.pop_back();
    return slot;
  }

  /// Adds a new tentative track.
  void add(const Track& track) noexcept {
    if (!listed_) return;
    weakest_.push_back({track.existence, track.id, track.slot});
    std::push_heap(weakest_.begin(), weakest_.end(), is_stronger);
  }

 private:
  struct Tentative {
    double existence;
    std::int64_t id;
    int slot;
  };

  static bool is_stronger(const Tentative& a, const Tentative& b) noexcept {
    return a.existence > b.existence || (a.existence == b.existence && a.id < b.id);
  }

  void list(const TrackList& tracks) noexcept {
    weakest_.clear();
    for (const int slot : tracks.slots())
      if (const Track& track = tracks.at(slot); !track.confirmed())
        weakest_.push_back({track.existence, track.id, slot});
    std::make_heap(weakest_.begin(), weakest_.end(), is_stronger);
    listed_ = true;
  }

  std::vector<Tentative> weakest_;  ///< a heap, once listed
  bool listed_ = false;
};

}  // namespace wakeline
