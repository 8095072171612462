// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "wakeline/track/track.hpp"

namespace wakeline {

/// A bounded list of tracks, older ones first. A track keeps its slot, a number below the capacity,
/// as long as it lives. Memory is taken by the constructor.
template <class Track>
class TrackListOf {
 public:
  explicit TrackListOf(int capacity)
      : pool_(static_cast<std::size_t>(capacity)),
        in_use_(pool_.size(), 0),
        place_(pool_.size(), 0) {
    slots_.reserve(2 * pool_.size());  // with gaps
    vacant_.reserve(pool_.size());
    for (int slot = capacity; slot-- > 0;) vacant_.push_back(slot);
  }

  [[nodiscard]] int size() const noexcept {
    return static_cast<int>(pool_.size() - vacant_.size());
  }
  [[nodiscard]] bool full() const noexcept { return vacant_.empty(); }

  /// The slots in use, those of older tracks first; valid until a track is opened or removed.
  [[nodiscard]] std::span<const int> slots() const noexcept { return slots_; }
  [[nodiscard]] bool in_use(int slot) const noexcept {
    return in_use_[static_cast<std::size_t>(slot)] != 0;
  }

  /// The track of a slot in use.
  [[nodiscard]] Track& at(int slot) noexcept { return pool_[static_cast<std::size_t>(slot)]; }
  [[nodiscard]] const Track& at(int slot) const noexcept {
    return pool_[static_cast<std::size_t>(slot)];
  }

  /// Null when no track has that number.
  [[nodiscard]] Track* find(std::int64_t id) noexcept {
    const auto place = locate(id);
    return place == slots_.end() ? nullptr : &at(*place);
  }
  [[nodiscard]] const Track* find(std::int64_t id) const noexcept {
    const auto place = locate(id);
    return place == slots_.end() ? nullptr : &at(*place);
  }

  /// A new track at the end of the list, which must not be full.
  Track& open() noexcept {
    const int slot = vacant_.back();
    vacant_.pop_back();
    if (slots_.size() == slots_.capacity()) close_gaps();
    place_[static_cast<std::size_t>(slot)] = slots_.size();
    slots_.push_back(slot);
    in_use_[static_cast<std::size_t>(slot)] = 1;
    at(slot) = {};
    at(slot).slot = slot;
    return at(slot);
  }

  /// Removes the track of a slot in use.
  void remove(int slot) noexcept {
    vacate(slot);
    close_gaps();
  }

  /// The same for one of many: it leaves a gap in the list of slots, for `close_gaps`.
  void vacate(int slot) noexcept {
    const std::size_t place = place_[static_cast<std::size_t>(slot)];
    in_use_[static_cast<std::size_t>(slot)] = 0;
    vacant_.push_back(slot);
    slots_[place] = kGap;
    first_gap_ = std::min(first_gap_, place);
  }

  /// Makes the list of slots one without gaps.
  void close_gaps() noexcept {
    const auto first = std::min(first_gap_, slots_.size());
    slots_.erase(std::remove(slots_.begin() + std::ptrdiff_t(first), slots_.end(), kGap),
                 slots_.end());
    number_places(first);
    first_gap_ = kNoGap;
  }

  /// Takes the tracks of another list of the same capacity, each in its slot.
  void copy_from(const TrackListOf& other) noexcept {
    in_use_ = other.in_use_;
    place_ = other.place_;
    slots_ = other.slots_;
    vacant_ = other.vacant_;
    for_each_slot([&](int slot) { at(slot) = other.at(slot); });
  }

  /// Calls `f(slot)` for the slots in use, in the order of memory.
  template <class Function>
  void for_each_slot(Function&& function) const noexcept {
    for (std::size_t slot = 0; slot < in_use_.size(); ++slot)
      if (in_use_[slot] != 0) function(static_cast<int>(slot));
  }

  /// Saves or restores the tracks; fails when the bytes are not a list of this capacity.
  void archive(Archive& fields) {
    fields(slots_, pool_.size());
    fields(vacant_, pool_.size());
    if (!fields.ok() || !is_partition()) {
      fields.fail();
      return;
    }
    for (const int slot : slots_) {
      at(slot).archive(fields);
      at(slot).slot = slot;
    }
    number_places(0);
  }

 private:
  static constexpr int kGap = -1;
  static constexpr std::size_t kNoGap = std::numeric_limits<std::size_t>::max();

  void number_places(std::size_t first) noexcept {
    for (std::size_t place = first; place < slots_.size(); ++place)
      place_[static_cast<std::size_t>(slots_[place])] = place;
  }

  /// Whether each slot is either in use or vacant, once; notes which are in use.
  bool is_partition() noexcept {
    if (slots_.size() + vacant_.size() != pool_.size()) return false;
    std::fill(in_use_.begin(), in_use_.end(), char{2});
    for (const auto& [list, mark] : {std::pair(&slots_, char{1}), std::pair(&vacant_, char{0})})
      for (const int slot : *list) {
        if (slot < 0 || slot >= static_cast<int>(pool_.size())) return false;
        in_use_[static_cast<std::size_t>(slot)] = mark;
      }
    return std::find(in_use_.begin(), in_use_.end(), char{2}) == in_use_.end();
  }

  [[nodiscard]] std::vector<int>::const_iterator locate(std::int64_t id) const noexcept {
    return std::find_if(slots_.begin(), slots_.end(), [&](int slot) { return at(slot).id == id; });
  }

  std::vector<Track> pool_;
  std::vector<char> in_use_;        ///< by slot
  std::vector<std::size_t> place_;  ///< by slot, where it is in `slots_`
  std::vector<int> slots_;          ///< in use, of older tracks first; between removals with gaps
  std::vector<int> vacant_;
  std::size_t first_gap_ = kNoGap;  ///< place of the first gap
};

using TrackList = TrackListOf<Track>;

}  // namespace wakeline
