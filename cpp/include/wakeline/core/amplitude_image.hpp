// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// A polar radar picture in the caller's memory: sweeps in clockwise order, each a row of the
/// amplitudes of its range cells from the antenna outwards. Does not own the memory.
template <std::unsigned_integral Amplitude = std::uint8_t>
struct AmplitudeImage {
  static constexpr bool kEvenSteps = true;

  const Amplitude* amplitudes = nullptr;  ///< (sweeps, cells), row-major
  int sweeps = 0;
  int cells = 0;
  double first_azimuth_rad = 0.0;  ///< centre of sweep 0, clockwise from north
  double azimuth_step_rad = 0.0;   ///< angle between the centres of consecutive sweeps; positive
  double start_range_m = 0.0;      ///< near edge of cell 0
  double cell_m = 0.0;             ///< length of a cell

  /// True when the last sweep is adjacent to sweep 0.
  [[nodiscard]] bool full_circle() const noexcept {
    return (sweeps + 0.5) * azimuth_step_rad > 2 * kPi<double>;
  }

  [[nodiscard]] std::span<const Amplitude> row(int sweep) const noexcept {
    return {amplitudes + static_cast<std::ptrdiff_t>(sweep) * cells,
            static_cast<std::size_t>(cells)};
  }

  /// Range of the centre of a cell, m.
  [[nodiscard]] double range_m(int cell) const noexcept {
    return start_range_m + (cell + 0.5) * cell_m;
  }

  /// Azimuth of the centre of a sweep, rad.
  [[nodiscard]] double azimuth_rad(int sweep) const noexcept {
    return first_azimuth_rad + sweep * azimuth_step_rad;
  }

  /// Position [north, east] of the centre of a cell relative to the antenna, m.
  [[nodiscard]] Vec<double, 2> position(int sweep, int cell) const noexcept {
    const double azimuth = azimuth_rad(sweep);
    return range_m(cell) * Vec<double, 2>(std::cos(azimuth), std::sin(azimuth));
  }
};

/// A polar picture: an `AmplitudeImage`, or sweeps at uneven steps with the same members.
template <class Image>
concept PolarPicture = requires(const Image& image, int k) {
  { Image::kEvenSteps } -> std::convertible_to<bool>;
  { image.sweeps } -> std::convertible_to<int>;
  { image.cells } -> std::convertible_to<int>;
  { image.first_azimuth_rad } -> std::convertible_to<double>;
  { image.azimuth_step_rad } -> std::convertible_to<double>;
  { image.start_range_m } -> std::convertible_to<double>;
  { image.cell_m } -> std::convertible_to<double>;
  { image.full_circle() } -> std::same_as<bool>;
  { image.azimuth_rad(k) } -> std::same_as<double>;
  { image.range_m(k) } -> std::same_as<double>;
  image.row(k).data();
};

/// The type of its amplitudes.
template <PolarPicture Image>
using AmplitudeOf =
    std::remove_const_t<typename decltype(std::declval<const Image&>().row(0))::element_type>;

}  // namespace wakeline
