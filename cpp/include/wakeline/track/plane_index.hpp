// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <vector>

#include "wakeline/core/types.hpp"

namespace wakeline {

/// Points of the plane, found by where they are.
///
/// Every √n of n points, from south to north, make a strip, and each strip is sorted from west to
/// east. A search for the few points near a position takes about log n steps for any distribution
/// of the points, also with all in a harbour but one far off. Sorting takes n log n. Memory is
/// taken by the constructor.
class PlaneIndex {
 public:
  explicit PlaneIndex(int capacity) {
    const auto size = static_cast<std::size_t>(capacity);
    points_.reserve(size);
    south_m_.reserve(static_cast<std::size_t>(std::sqrt(double(capacity))) + 2);
  }

  void clear() noexcept {
    points_.clear();
    south_m_.clear();
  }

  /// Adds a point, [north, east] m, which must be finite; it is found as `name`.
  void add(const Vec<double, 2>& position, int name) noexcept {
    points_.push_back({position[0], position[1], name});
  }

  /// Sorts the points; to be called when all are there.
  void sort() noexcept {
    std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) {
      return a.north < b.north || (a.north == b.north && a.name < b.name);
    });
    north_m_ = west_m_ = east_m_ = 0.0;
    if (points_.empty()) return;
    north_m_ = points_.back().north;
    west_m_ = kNowhere, east_m_ = -kNowhere;
    const auto size = static_cast<std::ptrdiff_t>(points_.size());
    per_strip_ = std::max<std::ptrdiff_t>(
        1, static_cast<std::ptrdiff_t>(std::ceil(std::sqrt(double(size)))));
    for (std::ptrdiff_t first = 0; first < size; first += per_strip_) {
      south_m_.push_back(points_[static_cast<std::size_t>(first)].north);
      const auto begin = points_.begin() + first;
      std::sort(begin, points_.begin() + std::min(first + per_strip_, size),
                [](const Point& a, const Point& b) {
                  return a.east < b.east || (a.east == b.east && a.name < b.name);
                });
      west_m_ = std::min(west_m_, begin->east);
      east_m_ = std::max(east_m_, points_[at(std::min(first + per_strip_, size) - 1)].east);
    }
  }

  /// Calls `f(name)` for every point in the square of half side `reach_m` about a position; points
  /// of one place in the order of their names.
  template <class Function>
  void for_each_near(const Vec<double, 2>& position, double reach_m, Function&& function) const {
    const double south = position[0] - reach_m;
    const double north = position[0] + reach_m;
    const double west = position[1] - reach_m;
    const double east = position[1] + reach_m;
    auto strip =
        first_not_below(south_m_.begin(), std::ssize(south_m_), south, [](double m) { return m; }) -
        south_m_.begin();
    if (strip > 0) --strip;  // it may reach beyond its southernmost point
    for (; strip < std::ssize(south_m_) && south_m_[static_cast<std::size_t>(strip)] <= north;
         ++strip) {
      const auto end = points_.begin() + std::min((strip + 1) * per_strip_, std::ssize(points_));
      const auto begin = points_.begin() + strip * per_strip_;
      auto point = first_not_below(begin, end - begin, west, [](const Point& p) { return p.east; });
      for (; point != end && point->east <= east; ++point)
        if (point->north >= south && point->north <= north) function(point->name);
    }
  }

  /// Calls `f(name)` for the points in that square, from the nearest strip outwards and in each
  /// strip from the nearest point outwards, until it has been called so many times.
  template <class Function>
  void for_each_nearest(const Vec<double, 2>& position, double reach_m, int most,
                        Function&& function) const {
    const double south = position[0] - reach_m;
    const double north = position[0] + reach_m;
    const std::ptrdiff_t strips = std::ssize(south_m_);
    if (strips == 0 || south_m_.front() > north || north_m_ < south ||
        west_m_ - position[1] > reach_m || position[1] - east_m_ > reach_m)
      return;
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
      visit_strip(above_m < below_m ? up++ : down--, position[1], reach_m, [&](const Point& point) {
        if (!(point.north >= south && point.north <= north)) return true;
        function(point.name);
        return --most > 0;
      });
    }
  }

  [[nodiscard]] bool empty() const noexcept { return points_.empty(); }

 private:
  struct Point {
    double north;
    double east;
    int name;
  };

  static constexpr double kNowhere = std::numeric_limits<double>::infinity();

  static std::size_t at(std::ptrdiff_t index) noexcept { return static_cast<std::size_t>(index); }

  /// Calls `f(point)` for the points of a strip within reach, from the nearest to an east outwards,
  /// as long as it returns true.
  template <class Function>
  void visit_strip(std::ptrdiff_t strip, double east_m, double reach_m,
                   const Function& function) const {
    const auto begin = points_.begin() + strip * per_strip_;
    const auto end = points_.begin() + std::min((strip + 1) * per_strip_, std::ssize(points_));
    auto right = first_not_below(begin, end - begin, east_m, [](const Point& p) { return p.east; });
    auto left = right;
    while (right != end || left != begin) {
      const double right_m = right != end ? right->east - east_m : kNowhere;
      const double left_m = left != begin ? east_m - std::prev(left)->east : kNowhere;
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

  std::vector<Point> points_;    ///< strip by strip, each from west to east
  std::vector<double> south_m_;  ///< southernmost point of each strip
  std::ptrdiff_t per_strip_ = 1;
  double north_m_ = 0.0, west_m_ = 0.0, east_m_ = 0.0;  ///< of the outermost points
};

}  // namespace wakeline
