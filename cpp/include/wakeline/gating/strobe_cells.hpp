// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "wakeline/core/amplitude_image.hpp"
#include "wakeline/core/angle.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/gating/strobe.hpp"

namespace wakeline {

/// Cells `first` to `last` of a sweep; empty when last < first.
struct CellSpan {
  int first = 0;
  int last = -1;
  bool cut = false;  ///< the strobe extends past the first or the last cell of the sweep

  [[nodiscard]] int size() const noexcept { return std::max(0, last - first + 1); }
  [[nodiscard]] bool holds(int cell) const noexcept { return first <= cell && cell <= last; }
};

/// The cells of a picture whose centres are inside a strobe, sweep by sweep: one span of cells for
/// each sweep within reach of the strobe. Keeps references.
template <PolarPicture Image, StrobeShape Strobe>
class StrobeCells {
 public:
  StrobeCells(const Image& image, const Strobe& strobe, const Vec<double, 2>& predicted_m) noexcept
      : image_(image), strobe_(strobe), predicted_m_(predicted_m), full_(image.full_circle()) {
    if constexpr (Image::kEvenSteps)
      find_rows();
    else
      rows_ = image.sweeps;
  }

  /// Number of sweeps that the strobe may reach; consecutive rows are adjacent sweeps of the
  /// picture.
  [[nodiscard]] int rows() const noexcept { return rows_; }

  /// The sweep of a row in 0 .. rows() - 1.
  [[nodiscard]] int sweep(int row) const noexcept { return (first_ + row) % image_.sweeps; }

  /// True when the last row is also adjacent to the first one.
  [[nodiscard]] bool closes() const noexcept { return full_ && rows_ == image_.sweeps; }

  /// The sweep `step` (1 or -1) away, or -1 at the end of the picture.
  [[nodiscard]] int beside(int sweep, int step) const noexcept {
    const int next = sweep + step;
    if (full_) return (next + image_.sweeps) % image_.sweeps;
    return next < image_.sweeps ? next : -1;
  }

  /// The cells of a sweep inside the strobe.
  [[nodiscard]] CellSpan span(int sweep) const noexcept {
    const StrobeChord chord = strobe_.chord(predicted_m_, image_.azimuth_rad(sweep));
    if (chord.empty()) return {};
    const double first = std::ceil(cell_at(chord.near_m));
    const double last = std::floor(cell_at(chord.far_m));
    const double end = image_.cells - 1.0;
    return {static_cast<int>(std::clamp(first, 0.0, end + 1.0)),
            static_cast<int>(std::clamp(last, -1.0, end)),
            first <= last && (first < 0.0 || last > end)};
  }

  /// True when the strobe extends past the first or the last sweep of a sector.
  [[nodiscard]] bool cut_sideways() const noexcept {
    return !full_ && (reaches(-1) || reaches(image_.sweeps));
  }

  /// True when the prediction is inside the picture.
  [[nodiscard]] bool prediction_in_picture() const noexcept {
    const double cell = cell_at(predicted_m_.norm());
    return cell >= -0.5 && cell <= image_.cells - 0.5 &&
           (full_ || std::abs(row_at_prediction() - middle()) <= 0.5 * image_.sweeps);
  }

 private:
  [[nodiscard]] bool reaches(int sweep) const noexcept {
    const CellSpan cells = span(sweep);
    return cells.cut || cells.size() > 0;
  }

  /// The cell at a range as a real number, integer at the centre of a cell.
  [[nodiscard]] double cell_at(double range_m) const noexcept {
    return (range_m - image_.start_range_m) / image_.cell_m - 0.5;
  }

  [[nodiscard]] double middle() const noexcept { return 0.5 * (image_.sweeps - 1); }

  /// The sweep at the prediction's bearing as a real number, the one nearest to the middle.
  [[nodiscard]] double row_at_prediction() const noexcept {
    const double bearing = std::atan2(predicted_m_[1], predicted_m_[0]);
    const double middle_azimuth = image_.first_azimuth_rad + middle() * image_.azimuth_step_rad;
    return middle() + wrap_angle(bearing - middle_azimuth) / image_.azimuth_step_rad;
  }

  void find_rows() noexcept {
    const double end = image_.sweeps - 1.0;
    const double row = row_at_prediction();
    // One more on each side, for rounding and for a full circle that is not a whole number of
    // steps.
    const double half = strobe_.half_angle_rad(predicted_m_) / image_.azimuth_step_rad + 1.0;
    const double half_turn = kPi<double> / image_.azimuth_step_rad;
    first_ = 0;
    rows_ = image_.sweeps;
    if (full_) {
      if (2.0 * half + 1.0 >= image_.sweeps) return;
      const int from = static_cast<int>(std::ceil(row - half));
      first_ = (from % image_.sweeps + image_.sweeps) % image_.sweeps;
      rows_ = static_cast<int>(std::floor(row + half)) - from + 1;
    } else if (std::abs(row - middle()) + half <=
               half_turn) {  // does not wrap around behind the sector
      first_ = static_cast<int>(std::clamp(std::ceil(row - half), 0.0, end));
      rows_ = static_cast<int>(std::clamp(std::floor(row + half), -1.0, end)) - first_ + 1;
      rows_ = std::max(rows_, 0);
    }
  }

  const Image& image_;
  const Strobe& strobe_;
  const Vec<double, 2>& predicted_m_;
  bool full_;
  int first_ = 0;
  int rows_ = 0;
};

}  // namespace wakeline
