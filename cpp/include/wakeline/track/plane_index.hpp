// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include "wakeline/core/types.hpp"
#include "wakeline/track/plane_slices.hpp"

namespace wakeline {

/// Points of the plane, found by where they are.
///
/// They lie in slices. Many of them, and those that are crowded in some slices, as with all in a
/// harbour but one far off, lie in strips instead: every √n of n points from south to north, sorted
/// from west to east, so that a search for the few points near a position takes about log n steps
/// for any distribution. Sorting takes n log n. Memory is taken by `reserve`.
class PlaneIndex {
 public:
  /// Takes memory for so many points.
  void reserve(int capacity) {
    const auto size = static_cast<std::size_t>(capacity);
    points_.reserve(size);
    slices_.reserve(std::min(capacity, PlaneSlices::kMost));
    south_m_.reserve(static_cast<std::size_t>(std::sqrt(double(capacity))) + 2);
  }

  void clear() noexcept {
    slices_.clear();
    points_.clear();
    south_m_.clear();
  }

  /// Adds a point, [north, east] m, which must be finite; it is found as `name`.
  void add(const Vec<double, 2>& position, int name) noexcept {
    points_.push_back({position, name});
  }

  /// Sorts the points; to be called when all are there.
  void sort() noexcept {
    if (points_.size() <= std::size_t{PlaneSlices::kMost}) {
      slices_.lay_out(points_);
      if (!slices_.is_crowded()) return;
      slices_.clear();
    }
    const std::ptrdiff_t size = std::ssize(points_);
    per_strip_ = static_cast<std::ptrdiff_t>(std::ceil(std::sqrt(double(size))));
    part(0, (size + per_strip_ - 1) / per_strip_);
    north_m_ = east_m_ = -kNowhere;
    west_m_ = kNowhere;
    for (std::ptrdiff_t first = 0; first < size; first += per_strip_) {
      const auto begin = points_.begin() + first;
      const auto end = points_.begin() + strip_end(first / per_strip_);
      std::sort(begin, end, [](const Place& a, const Place& b) {
        return a.position[1] < b.position[1] || (a.position[1] == b.position[1] && a.name < b.name);
      });
      double south_m = kNowhere;
      for (auto point = begin; point != end; ++point) {
        south_m = std::min(south_m, point->position[0]);
        north_m_ = std::max(north_m_, point->position[0]);
      }
      south_m_.push_back(south_m);
      west_m_ = std::min(west_m_, begin->position[1]);
      east_m_ = std::max(east_m_, std::prev(end)->position[1]);
    }
  }

  /// Calls `f(name)` for the points in the square of half side `reach_m` about a position, at most
  /// so many, `PlaneSlices::kMostNear` at most, about the nearest.
  template <class Function>
  void for_each_nearest(const Vec<double, 2>& position, double reach_m, int most,
                        Function&& function) const {
    const std::ptrdiff_t strips = std::ssize(south_m_);
    if (strips == 0)
      return slices_.for_each_nearest(position, std::span(&reach_m, 1), most, function);
    const double south = position[0] - reach_m;
    const double north = position[0] + reach_m;
    if (south_m_.front() > north || north_m_ < south || west_m_ - position[1] > reach_m ||
        position[1] - east_m_ > reach_m)
      return;
    std::array<int, kFew> found;
    if (const std::ptrdiff_t count = look_in_square(position, reach_m, found); count <= most) {
      for (std::ptrdiff_t k = 0; k < count; ++k) function(found[at(k)]);
      return;
    }
    std::ptrdiff_t up =
        first_not_below(south_m_.begin(), strips, position[0], [](double m) { return m; }) -
        south_m_.begin();
    std::ptrdiff_t down = up - 1;
    while (most > 0 && (up < strips || down >= 0)) {
      const double above_m = up < strips ? south_m_[at(up)] - position[0] : kNowhere;
      const double below_m = down < 0            ? kNowhere
                             : down + 1 < strips ? position[0] - south_m_[at(down + 1)]
                                                 : 0.0;
      if (!(std::min(above_m, below_m) <= reach_m)) return;
      visit_strip(above_m < below_m ? up++ : down--, position[1], reach_m, [&](const Place& point) {
        if (!(point.position[0] >= south && point.position[0] <= north)) return true;
        function(point.name);
        return --most > 0;
      });
    }
  }

 private:
  static constexpr double kNowhere = std::numeric_limits<double>::infinity();
  static constexpr std::size_t kFew = 64;  ///< points that a square has

  /// Has no point of the strips from one to another north of one of a later strip.
  void part(std::ptrdiff_t first, std::ptrdiff_t last) noexcept {
    if (last - first < 2) return;
    const std::ptrdiff_t middle = (first + last) / 2;
    std::nth_element(points_.begin() + first * per_strip_, points_.begin() + middle * per_strip_,
                     points_.begin() + strip_end(last - 1), [](const Place& a, const Place& b) {
                       return a.position[0] < b.position[0] ||
                              (a.position[0] == b.position[0] && a.name < b.name);
                     });
    part(first, middle);
    part(middle, last);
  }

  [[nodiscard]] std::ptrdiff_t strip_end(std::ptrdiff_t strip) const noexcept {
    return std::min((strip + 1) * per_strip_, std::ssize(points_));
  }

  static std::size_t at(std::ptrdiff_t index) noexcept { return static_cast<std::size_t>(index); }

  /// Lists the names of the points in a square and returns how many there are, or a number above
  /// all where there are too many.
  std::ptrdiff_t look_in_square(const Vec<double, 2>& position, double reach_m,
                                std::array<int, kFew>& names) const noexcept {
    const double south = position[0] - reach_m, north = position[0] + reach_m;
    const double west = position[1] - reach_m, east = position[1] + reach_m;
    const std::ptrdiff_t strips = std::ssize(south_m_);
    const auto first_inside =
        first_not_below(south_m_.begin(), strips, south, [](double m) { return m; });
    std::ptrdiff_t strip = std::max(first_inside - south_m_.begin() - 1, std::ptrdiff_t{0});
    std::ptrdiff_t count = 0;
    for (; strip < strips && south_m_[at(strip)] <= north; ++strip) {
      const auto end = points_.begin() + strip_end(strip);
      const auto begin = points_.begin() + strip * per_strip_;
      auto point =
          first_not_below(begin, end - begin, west, [](const Place& p) { return p.position[1]; });
      for (; point != end && point->position[1] <= east; ++point) {
        if (count == std::ssize(names)) return std::numeric_limits<std::ptrdiff_t>::max();
        names[at(count)] = point->name;
        count += std::ptrdiff_t{point->position[0] >= south} &
                 std::ptrdiff_t{point->position[0] <= north};
      }
    }
    return count;
  }

  /// Calls `f(point)` for the points of a strip within reach, from the nearest to an east outwards,
  /// as long as it returns true.
  template <class Function>
  void visit_strip(std::ptrdiff_t strip, double east_m, double reach_m,
                   const Function& function) const {
    const auto begin = points_.begin() + strip * per_strip_;
    const auto end = points_.begin() + strip_end(strip);
    auto right =
        first_not_below(begin, end - begin, east_m, [](const Place& p) { return p.position[1]; });
    auto left = right;
    while (right != end || left != begin) {
      const double right_m = right != end ? right->position[1] - east_m : kNowhere;
      const double left_m = left != begin ? east_m - std::prev(left)->position[1] : kNowhere;
      if (!(std::min(right_m, left_m) <= reach_m)) return;
      if (!function(right_m <= left_m ? *right++ : *--left)) return;
    }
  }

  /// The first of `size` sorted elements whose `key` is not below a limit. In steps without a
  /// branch, which a processor would guess wrong every other time.
  template <class Iterator, class Key>
  static Iterator first_not_below(Iterator first, std::ptrdiff_t size, double limit,
                                  const Key& key) noexcept {
    while (size > 0) {
      const std::ptrdiff_t half = (size + 1) / 2;
      first += key(first[half - 1]) < limit ? half : 0;
      size -= half;
    }
    return first;
  }

  PlaneSlices slices_;
  std::vector<Place> points_;    ///< strip by strip, each from west to east
  std::vector<double> south_m_;  ///< southernmost point of each strip; none of slices
  std::ptrdiff_t per_strip_ = 1;
  double north_m_ = 0.0, west_m_ = 0.0, east_m_ = 0.0;  ///< of the outermost points
};

}  // namespace wakeline
