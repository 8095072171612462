// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/video/sweep.hpp"

namespace wakeline {

/// When and where to a sweep was received. The angle of the beam is its azimuth, unwrapped: it
/// grows from revolution to revolution.
struct SweepPlace {
  double beam_rad;
  double time_s;
  double own_north_m;  ///< own ship
  double own_east_m;
};

/// The last of some sweeps as a `PolarPicture`, at the azimuths that they were received at. Does
/// not own the memory.
template <std::unsigned_integral Amplitude>
struct SweepWindow {
  static constexpr bool kEvenSteps = false;

  std::span<const Amplitude> amplitudes;  ///< a ring of rows of `stride` cells
  std::span<const SweepPlace> places;     ///< of the rows
  std::size_t first = 0;                  ///< row of sweep 0
  std::size_t stride = 0;
  int sweeps = 0;
  int cells = 0;
  double first_azimuth_rad = 0.0;
  double azimuth_step_rad = 0.0;  ///< width of a sweep
  double start_range_m = 0.0;
  double cell_m = 0.0;

  [[nodiscard]] static constexpr bool full_circle() noexcept { return false; }

  [[nodiscard]] std::span<const Amplitude> row(int sweep) const noexcept {
    return amplitudes.subspan(place(sweep) * stride, static_cast<std::size_t>(cells));
  }

  [[nodiscard]] double range_m(int cell) const noexcept {
    return start_range_m + (cell + 0.5) * cell_m;
  }

  /// Of sweeps before the first and after the last one, where the next ones would be.
  [[nodiscard]] double azimuth_rad(int sweep) const noexcept {
    const int inside = std::clamp(sweep, 0, sweeps - 1);
    return places[place(inside)].beam_rad + (sweep - inside) * azimuth_step_rad;
  }

 private:
  [[nodiscard]] std::size_t place(int sweep) const noexcept {
    return (first + static_cast<std::size_t>(sweep)) % places.size();
  }
};

/// The sweeps received last, at any steps of azimuth. Memory is taken by the constructor.
template <std::unsigned_integral Amplitude = std::uint8_t>
class RecentSweeps {
 public:
  /// Room for `sweeps` sweeps of at most `cells` cells.
  RecentSweeps(int sweeps, int cells)
      : stride_(static_cast<std::size_t>(cells)),
        places_(static_cast<std::size_t>(sweeps)),
        amplitudes_(places_.size() * stride_) {}

  /// True when a sweep has the start range and cell length of those before.
  [[nodiscard]] bool continues(const Sweep<Amplitude>& sweep) const noexcept {
    return sweep.start_range_m == start_range_m_ && sweep.cell_m == cell_m_;
  }

  /// Adds a sweep in place of the oldest one and returns the copy of its amplitudes, to be changed
  /// by the caller. One of another start range or cell length replaces all.
  std::span<Amplitude> add(const Sweep<Amplitude>& sweep, double beam_rad,
                           const Vec<double, 2>& own_m) noexcept {
    if (!continues(sweep)) size_ = cells_ = 0;
    newest_ = (newest_ + 1) % places_.size();
    size_ = std::min(size_ + 1, places_.size());
    places_[newest_] = {beam_rad, sweep.time_s, own_m[0], own_m[1]};
    width_rad_ = sweep.azimuth_width_rad;
    start_range_m_ = sweep.start_range_m;
    cell_m_ = sweep.cell_m;
    cells_ = std::max(cells_, sweep.amplitude.size());
    const std::span<Amplitude> row = std::span(amplitudes_).subspan(newest_ * stride_, stride_);
    std::ranges::fill(std::ranges::copy(sweep.amplitude, row.begin()).out, row.end(), Amplitude{0});
    return row.first(sweep.amplitude.size());
  }

  /// The sweeps from an angle of the beam on.
  [[nodiscard]] SweepWindow<Amplitude> from(double beam_rad) const noexcept {
    std::size_t count = 0;
    while (count < size_ && back(count).beam_rad >= beam_rad) ++count;
    const std::size_t first = count > 0 ? row_back(count - 1) : newest_;
    return {.amplitudes = amplitudes_,
            .places = places_,
            .first = first,
            .stride = stride_,
            .sweeps = static_cast<int>(count),
            .cells = static_cast<int>(cells_),
            .first_azimuth_rad = places_[first].beam_rad,
            .azimuth_step_rad = width_rad_,
            .start_range_m = start_range_m_,
            .cell_m = cell_m_};
  }

  /// When the beam had an angle, and where own ship was: between two sweeps interpolated; there
  /// must be one.
  [[nodiscard]] SweepPlace at(double beam_rad) const noexcept {
    std::size_t k = 0;
    while (k + 1 < size_ && back(k).beam_rad > beam_rad) ++k;
    const SweepPlace& before = back(k);
    if (k == 0 || before.beam_rad > beam_rad) return before;
    const SweepPlace& after = back(k - 1);
    const double share = (beam_rad - before.beam_rad) / (after.beam_rad - before.beam_rad);
    const auto between = [share](double a, double b) { return a + share * (b - a); };
    return {beam_rad, between(before.time_s, after.time_s),
            between(before.own_north_m, after.own_north_m),
            between(before.own_east_m, after.own_east_m)};
  }

  /// Saves or restores the sweeps.
  void archive(Archive& fields) {
    std::vector<SweepPlace> places;
    std::vector<Amplitude> amplitudes;
    for (std::size_t k = size_; k-- > 0 && !fields.loading();) {
      places.push_back(back(k));
      const auto row = std::span(amplitudes_).subspan(row_back(k) * stride_, stride_);
      amplitudes.insert(amplitudes.end(), row.begin(), row.end());
    }
    std::uint64_t cells = cells_;
    fields(places, places_.size());
    fields(amplitudes, amplitudes_.size());
    fields(cells);
    fields(width_rad_);
    fields(start_range_m_);
    fields(cell_m_);
    if (amplitudes.size() != places.size() * stride_ || cells > stride_) fields.fail();
    if (!fields.loading() || !fields.ok()) return;
    size_ = places.size();
    cells_ = static_cast<std::size_t>(cells);
    newest_ = size_ > 0 ? size_ - 1 : 0;
    std::ranges::copy(places, places_.begin());
    std::ranges::copy(amplitudes, amplitudes_.begin());
  }

 private:
  /// The row of the sweep `k` sweeps before the newest.
  [[nodiscard]] std::size_t row_back(std::size_t k) const noexcept {
    return (newest_ + places_.size() - k) % places_.size();
  }
  [[nodiscard]] const SweepPlace& back(std::size_t k) const noexcept {
    return places_[row_back(k)];
  }

  std::size_t stride_;
  std::vector<SweepPlace> places_;  ///< a ring
  std::vector<Amplitude> amplitudes_;
  std::size_t newest_ = 0;
  std::size_t size_ = 0;
  std::size_t cells_ = 0;  ///< of the longest sweep
  double width_rad_ = 0.0;
  double start_range_m_ = 0.0;
  double cell_m_ = 0.0;
};

}  // namespace wakeline
