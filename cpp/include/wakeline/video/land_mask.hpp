// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/video/azimuth_rows.hpp"
#include "wakeline/video/sweep.hpp"

namespace wakeline {

/// Areas about the antenna without detections: land, own wake, a blind sector. For each of
/// `azimuths` directions it stores the exact excluded ranges, independent of the cell length; a
/// cell partly inside is excluded.
///
/// Excluded cells still are training cells of others: close to a shore the ordered statistic
/// detects more boats than cell averaging.
///
/// A default-constructed mask excludes nothing. On a moving ship the mask is rebuilt with its
/// motion.
class LandMask {
 public:
  LandMask() = default;

  /// `azimuths` directions per revolution. Throws `std::invalid_argument` unless 1 to 65536.
  explicit LandMask(int azimuths) {
    require(azimuths >= 1 && azimuths <= 65536, "azimuths", "1 to 65536", azimuths);
    excluded_.resize(static_cast<std::size_t>(azimuths));
  }

  [[nodiscard]] int azimuths() const noexcept { return static_cast<int>(excluded_.size()); }

  /// Excludes the ranges from `near_m` to `far_m` in the directions clockwise from
  /// `from_azimuth_rad` to `to_azimuth_rad`; a full circle when these differ by one. Throws
  /// `std::invalid_argument` for ranges that are negative or not in order, for azimuths that are
  /// not finite, and when the mask has no directions.
  void exclude_sector(double from_azimuth_rad, double to_azimuth_rad, double near_m, double far_m) {
    require_directions();
    require_finite("from_azimuth_rad", from_azimuth_rad);
    require_finite("to_azimuth_rad", to_azimuth_rad);
    require_not_negative("near_m", near_m);
    require(far_m > near_m, "far_m", "above near_m", far_m);
    const double turn = 2 * kPi<double>;
    const bool whole = std::fabs(to_azimuth_rad - from_azimuth_rad) >= turn - 1e-9;
    const double width = whole ? turn : compass_angle(to_azimuth_rad - from_azimuth_rad);
    const double from = compass_angle(from_azimuth_rad);
    const int first = rows().count_to(from);
    const int last = rows().count_to(from + width - 1e-9);
    for (int row = first; row <= std::min(last, first + azimuths() - 1); ++row)
      exclude(row % azimuths(), {near_m, far_m});
  }

  /// Excludes the inside of a polygon with corners [north, east] in m from the antenna, which may
  /// be inside. Directions are tested at their middles. Throws `std::invalid_argument` for fewer
  /// than 3 corners, corners that are not finite, and when the mask has no directions.
  void exclude_polygon(std::span<const Vec<double, 2>> corners_m) {
    require_directions();
    require(corners_m.size() >= 3, "corners_m", "3 or more corners",
            static_cast<double>(corners_m.size()));
    for (const auto& corner : corners_m) {
      require_finite("corners_m", corner[0]);
      require_finite("corners_m", corner[1]);
    }
    std::vector<double> shore_m;
    for (int row = 0; row < azimuths(); ++row) {
      crossings(corners_m, rows().middle(row), shore_m);
      for (std::size_t k = 0; k + 1 < shore_m.size(); k += 2)
        exclude(row, {shore_m[k], shore_m[k + 1]});
    }
  }

  /// True when a position is excluded.
  [[nodiscard]] bool excludes(double azimuth_rad, double range_m) const noexcept {
    if (excluded_.empty() || !std::isfinite(azimuth_rad)) return false;
    return std::ranges::any_of(excluded_[rows().of(azimuth_rad)], [&](const Ranges& ranges) {
      return ranges.near_m <= range_m && range_m < ranges.far_m;
    });
  }

  /// Raises the thresholds of excluded cells to the largest amplitude, which none exceeds.
  template <class Amplitude>
  void lift(const Sweep<Amplitude>& sweep, std::span<Amplitude> threshold) const noexcept {
    set(sweep, threshold, std::numeric_limits<Amplitude>::max());
  }

  /// Sets the amplitudes of excluded cells, of a copy of the sweep's, to zero.
  template <class Amplitude>
  void blank(const Sweep<Amplitude>& sweep, std::span<Amplitude> amplitude) const noexcept {
    set(sweep, amplitude, Amplitude{0});
  }

 private:
  struct Ranges {
    double near_m;
    double far_m;
  };

  template <class Amplitude>
  void set(const Sweep<Amplitude>& sweep, std::span<Amplitude> cell_values,
           Amplitude value) const noexcept {
    if (excluded_.empty()) return;
    const double cells = static_cast<double>(cell_values.size());
    const auto cell = [&](double range_m) noexcept {
      return std::clamp((range_m - sweep.start_range_m) / sweep.cell_m, 0.0, cells);
    };
    for (const Ranges& ranges : excluded_[rows().of(sweep.azimuth_rad)]) {
      const auto first = static_cast<std::size_t>(cell(ranges.near_m));
      const auto last = static_cast<std::size_t>(std::ceil(cell(ranges.far_m)));
      for (std::size_t i = first; i < last; ++i) cell_values[i] = value;
    }
  }

  void require_directions() const {
    require(!excluded_.empty(), "azimuths", "1 to 65536 to exclude an area", 0);
  }

  [[nodiscard]] detail::AzimuthRows rows() const noexcept {
    return detail::AzimuthRows(azimuths());
  }

  /// Adds ranges, merged with overlapping ones.
  void exclude(int row, Ranges added) {
    auto& list = excluded_[static_cast<std::size_t>(row)];
    std::erase_if(list, [&](const Ranges& known) {
      if (known.far_m < added.near_m || added.far_m < known.near_m) return false;
      added = {std::min(known.near_m, added.near_m), std::max(known.far_m, added.far_m)};
      return true;
    });
    list.push_back(added);
  }

  /// The ranges at which a ray from the antenna crosses the polygon, in order; from 0 when the
  /// antenna is inside.
  static void crossings(std::span<const Vec<double, 2>> corners_m, double azimuth_rad,
                        std::vector<double>& ranges_m) {
    const Vec<double, 2> ray(std::cos(azimuth_rad), std::sin(azimuth_rad));
    const auto right_of_ray = [&](const Vec<double, 2>& p) {
      return ray[0] * p[1] - ray[1] * p[0];
    };
    ranges_m.clear();
    for (std::size_t k = 0; k < corners_m.size(); ++k) {
      const Vec<double, 2>& from = corners_m[k];
      const Vec<double, 2>& to = corners_m[(k + 1) % corners_m.size()];
      const double a = right_of_ray(from);
      const double b = right_of_ray(to);
      if ((a >= 0) == (b >= 0)) continue;
      const double range_m = ray.dot(from + a / (a - b) * (to - from));
      if (range_m > 0) ranges_m.push_back(range_m);
    }
    if (ranges_m.size() % 2 == 1) ranges_m.push_back(0.0);
    std::ranges::sort(ranges_m);
  }

  std::vector<std::vector<Ranges>> excluded_;
};

}  // namespace wakeline
