// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "wakeline/track/track.hpp"

namespace wakeline {

/// A bounded list of tracks, older ones first. Tracks stay where they are in memory, and memory is
/// taken by the constructor.
template <class Estimator>
class TrackList {
 public:
  using TrackType = Track<Estimator>;

  TrackList(int capacity, const Estimator& prototype)
      : pool_(static_cast<std::size_t>(capacity), TrackType{.estimator = prototype}) {
    order_.reserve(pool_.size());
    vacant_.reserve(pool_.size());
    for (int slot = capacity; slot-- > 0;) vacant_.push_back(slot);
  }

  [[nodiscard]] int size() const noexcept { return static_cast<int>(order_.size()); }
  [[nodiscard]] bool full() const noexcept { return vacant_.empty(); }

  /// Calls `f(track)`, or `f(track, slot)` with a number below the capacity that stays the track's.
  template <class Function>
  void for_each(Function&& function) {
    for (const int slot : order_) call(function, at(slot), slot);
  }
  template <class Function>
  void for_each(Function&& function) const {
    for (const int slot : order_) call(function, at(slot), slot);
  }

  /// Calls `f(slots)` for every `Size` tracks or, at the end, fewer.
  template <std::size_t Size, class Function>
  void for_each_group(Function&& function) {
    const std::span<const int> slots(order_);
    for (std::size_t first = 0; first < slots.size(); first += Size)
      function(slots.subspan(first, std::min(Size, slots.size() - first)));
  }

  /// The track of that slot, be it in use or not.
  [[nodiscard]] TrackType& at(int slot) noexcept { return pool_[static_cast<std::size_t>(slot)]; }
  [[nodiscard]] const TrackType& at(int slot) const noexcept {
    return pool_[static_cast<std::size_t>(slot)];
  }

  [[nodiscard]] const TrackType* find(std::int64_t id) const noexcept {
    const auto place = locate(id);
    return place == order_.end() ? nullptr : &at(*place);
  }
  [[nodiscard]] TrackType* find(std::int64_t id) noexcept {
    const auto place = locate(id);
    return place == order_.end() ? nullptr : &at(*place);
  }

  /// Room for a track, at the end of the list; there must be some. Returns its slot.
  int open() noexcept {
    const int slot = vacant_.back();
    vacant_.pop_back();
    order_.push_back(slot);
    return slot;
  }

  /// Ends a track; false when there is none of that number.
  bool remove(std::int64_t id) noexcept {
    const auto place = locate(id);
    if (place == order_.end()) return false;
    remove_slot(*place);
    return true;
  }

  /// Ends the track of a slot in use.
  void remove_slot(int slot) noexcept {
    at(slot).existence = kEnded;
    vacant_.push_back(slot);
    order_.erase(std::find(order_.begin(), order_.end(), slot));
  }

  /// Ends the tracks for which the predicate holds, asked in order, after a farewell;
  /// `ended()` tells those that are gone already.
  template <class Predicate, class Farewell>
  void remove_if(Predicate&& predicate, Farewell&& farewell) noexcept {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const int slot = order_[k];
      TrackType& track = at(slot);
      if (predicate(track)) {
        farewell(track);
        vacant_.push_back(slot);
        track.existence = kEnded;
      } else {
        order_[kept++] = slot;
      }
    }
    order_.resize(kept);
  }

  [[nodiscard]] static bool ended(const TrackType& track) noexcept {
    return track.existence == kEnded;
  }

  /// Saves or restores the tracks; fails when the bytes are not a list of this capacity.
  void archive(Archive& fields) {
    fields(order_, pool_.size());
    fields(vacant_, pool_.size());
    const auto valid = [&](int slot) { return slot >= 0 && slot < static_cast<int>(pool_.size()); };
    if (!fields.ok() || order_.size() + vacant_.size() != pool_.size() ||
        !std::all_of(order_.begin(), order_.end(), valid) ||
        !std::all_of(vacant_.begin(), vacant_.end(), valid)) {
      fields.fail();
      return;
    }
    for (const int slot : order_) at(slot).archive(fields);
  }

 private:
  static constexpr double kEnded = -1.0;

  template <class Function, class SomeTrack>
  static void call(Function& function, SomeTrack& track, int slot) {
    if constexpr (std::is_invocable_v<Function&, SomeTrack&, int>)
      function(track, slot);
    else
      function(track);
  }

  [[nodiscard]] auto locate(std::int64_t id) const noexcept {
    return std::find_if(order_.begin(), order_.end(), [&](int slot) { return at(slot).id == id; });
  }

  std::vector<TrackType> pool_;
  std::vector<int> order_;   ///< slots of the pool in use, older tracks first
  std::vector<int> vacant_;  ///< the others
};

}  // namespace wakeline
