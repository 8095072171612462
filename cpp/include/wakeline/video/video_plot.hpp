// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/types.hpp"

namespace wakeline {

/// An echo of radar video as a measurement.
///
/// With amplitudes a of its cells, W = sum a, range and bearing are the means with weights a / W.
/// With their weighted spread S (2 x 2, of range and bearing) and the effective number of cells n =
/// W² / sum a², the covariance is
///
///     R = S / n + diag(cell², width²) / 12 :
///
/// the error of a mean of n cells with fluctuating amplitudes, and the quantisation by cells and
/// sweeps. A single cell has a uniform error; the middle of a smooth echo many cells long is more
/// accurate than this. Common errors of a radar (its alignment) and the motion of echoes over a
/// hull are not included.
struct VideoPlot {
  double time_s = 0.0;  ///< amplitude-weighted too
  double range_m = 0.0;
  double bearing_rad = 0.0;  ///< clockwise from north, 0 to 2 pi
  Mat<double, 2, 2> covariance = Mat<double, 2, 2>::Identity();  ///< of range_m and bearing_rad

  double range_extent_m = 0.0;      ///< from the near edge of its first cell to the far edge
  double bearing_extent_rad = 0.0;  ///< from the edge of its first sweep to that of its last
  double peak_amplitude = 0.0;
  double total_amplitude = 0.0;  ///< W
  int cells = 0;                 ///< number above their thresholds

  bool touches_first_cell = false;
  bool touches_last_cell = false;
  /// May be a part of an echo: it was closed at `max_sweeps` or continues one that was, or the
  /// sweeps before or after it are missing.
  bool cut = false;
};

}  // namespace wakeline
