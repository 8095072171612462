// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the tests of single stages share: tracks and plots by hand.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "wakeline/track/plot_likelihood.hpp"

namespace wakeline::test {

inline const Radar kStageRadar{.range_std_m = 8.0,
                               .bearing_std_rad = deg(0.5),
                               .extent_std_m = 2.0,
                               .period_s = 2.5,
                               .max_speed_mps = 25.0};

/// A plot of a position, seen from the origin without error.
inline Plot plot_at(double north_m, double east_m, double time_s) {
  return {time_s, std::hypot(north_m, east_m), std::atan2(east_m, north_m), {}};
}

/// The plots as the stage behind the first takes them.
inline ScanPlots scan_of(const std::vector<Plot>& plots, double time_s) {
  ScanPlots scan(100);
  scan.convert(kStageRadar, plots, time_s, 25.0);
  return scan;
}

inline Track track_at(int slot, const Vec<double, 4>& mean, const Vec<double, 4>& std) {
  Track track;
  track.slot = slot;
  track.id = -1 - slot;
  track.existence = 0.9;
  track.kinematics.mean = mean;
  track.kinematics.covariance = std.cwiseAbs2().asDiagonal();
  return track;
}

/// A candidate without a place, for what weighs numbers only.
inline CandidatePlot candidate(int plot, double likelihood, double clutter_per_m2) {
  CandidatePlot candidate{};
  candidate.plot = plot;
  candidate.z = {0.0, 0.0};
  candidate.nominal_r = candidate.outlier_r = Mat<double, 2, 2>::Identity();
  candidate.likelihood = likelihood;
  candidate.clutter_per_m2 = clutter_per_m2;
  return candidate;
}

inline CandidatePlots candidates_of(const std::vector<CandidatePlot>& plots) {
  CandidatePlots candidates;
  for (const CandidatePlot& plot : plots) candidates.add(plot);
  return candidates;
}

}  // namespace wakeline::test
