// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "wakeline/core/types.hpp"

namespace wakeline {

/// A point of the plane, of one of several layers in which points are looked for equally far.
struct Place {
  Vec<double, 2> position;  ///< [north, east] m
  int name;
  int layer = 0;
};

/// Points of the plane in slices of one width, across the axis where they are farther apart.
///
/// Laying out takes no sorting. A search looks at all points in the slices that it reaches, without
/// a branch for each, which a processor would guess wrong: few, unless it reaches far or the points
/// are crowded in some of the slices. Memory is taken by `reserve`.
class PlaneSlices {
 public:
  static constexpr int kMost = 1600;     ///< points: a search may have to look at all of them
  static constexpr int kMostNear = 128;  ///< points that a search can find

  void reserve(int capacity) {
    const auto size = static_cast<std::size_t>(capacity);
    along_m_.reserve(size);
    across_m_.reserve(size);
    layer_.reserve(size);
    name_.reserve(size);
    begin_.reserve(slices_of(size) + 2);
  }

  void clear() noexcept {
    along_m_.clear();
    across_m_.clear();
    layer_.clear();
    name_.clear();
    begin_.clear();
  }

  void lay_out(std::span<const Place> places) noexcept {
    constexpr double kNowhere = std::numeric_limits<double>::infinity();
    Vec<double, 2> least(kNowhere, kNowhere), greatest = -least;
    for (const Place& place : places) {
      least = least.cwiseMin(place.position);
      greatest = greatest.cwiseMax(place.position);
    }
    const Vec<double, 2> range_m = greatest - least;
    along_ = range_m[0] >= range_m[1] ? 0 : 1;
    last_ = static_cast<double>(slices_of(places.size()) - 1);
    first_m_ = least[along_];
    slices_per_m_ = range_m[along_] > 0.0 ? (last_ + 1.0) / range_m[along_] : 0.0;
    // While points come, `begin_[k + 1]` is where the next one of slice k goes; then where it ends.
    begin_.assign(slices_of(places.size()) + 2, 0);
    for (const Place& place : places) ++begin_[slice_of(place.position[along_]) + 2];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    along_m_.resize(places.size());
    across_m_.resize(places.size());
    layer_.resize(places.size());
    name_.resize(places.size());
    for (const Place& place : places) {
      const std::size_t k = begin_[slice_of(place.position[along_]) + 1]++;
      along_m_[k] = place.position[along_];
      across_m_[k] = place.position[1 - along_];
      layer_[k] = place.layer;
      name_[k] = place.name;
    }
  }

  /// Whether the slice of a point has many others in the mean.
  [[nodiscard]] bool is_crowded() const noexcept {
    constexpr std::size_t kMany = 24;
    std::size_t others = 0;
    for (std::size_t k = 1; k < begin_.size(); ++k) {
      const std::size_t points = begin_[k] - begin_[k - 1];
      others += points * points;
    }
    return others > kMany * name_.size();
  }

  /// Calls `f(name)` for the points that are no farther from a position than `reach_m` of their
  /// layer, north and east; of more than so many, `kMostNear` at most, for the nearest.
  template <class Function>
  void for_each_nearest(const Vec<double, 2>& position, std::span<const double> reach_m, int most,
                        Function&& function) const {
    if (name_.empty()) return;
    most = std::min(most, kMostNear);
    const double along_m = position[along_], across_m = position[1 - along_];
    const double widest_m = *std::max_element(reach_m.begin(), reach_m.end());
    std::array<std::size_t, 2 * std::size_t{kMostNear}> found;
    std::size_t count = 0;
    const auto keep_nearest = [&] {
      const auto apart_m = [&](std::size_t k) {
        return std::max(std::abs(along_m_[k] - along_m), std::abs(across_m_[k] - across_m));
      };
      std::nth_element(found.begin(), found.begin() + most, found.begin() + count,
                       [&](std::size_t a, std::size_t b) { return apart_m(a) < apart_m(b); });
      count = static_cast<std::size_t>(most);
    };
    const std::size_t end = begin_[slice_of(along_m + widest_m) + 1];
    for (std::size_t k = begin_[slice_of(along_m - widest_m)]; k < end;) {
      if (count > std::size_t{kMostNear}) keep_nearest();
      const std::size_t until = std::min(end, k + std::size_t{kMostNear});
      for (; k < until; ++k) {
        const double within_m = reach_m[static_cast<std::size_t>(layer_[k])];
        found[count] = k;
        count += std::size_t{std::abs(along_m_[k] - along_m) <= within_m} &
                 std::size_t{std::abs(across_m_[k] - across_m) <= within_m};
      }
    }
    if (count > static_cast<std::size_t>(most)) keep_nearest();
    for (std::size_t k = 0; k < count; ++k) function(name_[found[k]]);
  }

 private:
  static std::size_t slices_of(std::size_t points) noexcept { return points / 4 + 1; }

  /// The slice at a place along the axis; of one outside, or of none, the outermost.
  [[nodiscard]] std::size_t slice_of(double along_m) const noexcept {
    return static_cast<std::size_t>(
        std::min(std::max(0.0, (along_m - first_m_) * slices_per_m_), last_));
  }

  std::vector<double> along_m_, across_m_;  ///< of the points, slice by slice
  std::vector<int> layer_, name_;
  std::vector<std::size_t> begin_;  ///< of the slices, and the end
  int along_ = 0;                   ///< the axis across which the slices are: 0 north, 1 east
  double first_m_ = 0.0, slices_per_m_ = 0.0, last_ = 0.0;
};

}  // namespace wakeline
