// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Probabilities that a target exists and that the radar can see it. Source: D. Mušicki, R. Evans,
// IEEE Trans. AES-40, 2004, with existence as a Markov chain of three states: visible, hidden,
// gone.
#pragma once

#include <algorithm>
#include <cmath>

#include "wakeline/track/config.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// Detection of a target by the radar, given that it exists.
struct Detection {
  double detected;  ///< PD pv: it gives a plot
  double missed;    ///< 1 - PD PG pv: it gives none in its gate

  Detection(const TrackerConfig& config, double visibility) noexcept
      : detected(config.detection_probability * visibility),
        missed(1.0 - config.detection() * visibility) {}
};

/// What a time step does to existence and visibility, the same for all tracks: a target may leave,
/// be hidden from the radar, or be seen again.
struct ExistencePrediction {
  double survival;        ///< probability that a target stays
  double long_run = 0.0;  ///< probability of being visible in the long run
  double memory = 1.0;    ///< what is left of the difference to it

  ExistencePrediction(const TrackerConfig& config, double dt_s) noexcept
      : survival(std::exp(-dt_s / config.survival_time_s)) {
    if (!(config.visible_time_s > 0.0)) return;
    const double hide = 1.0 / config.visible_time_s;
    const double show = 1.0 / config.hidden_time_s;
    long_run = show / (hide + show);
    memory = std::exp(-(hide + show) * dt_s);
  }

  void predict(Track& track) const noexcept {
    track.existence *= survival;
    track.visibility = long_run + (track.visibility - long_run) * memory;
  }
};

/// How well a scan fits a track, against there being no such target.
struct ScanLikelihood {
  double total;   ///< of all hypotheses of the track about its plots
  double none;    ///< the part of it that no plot is the target's
  bool assigned;  ///< the track was assigned one plot, and cannot have none
};

/// Bayes' rule for "the target exists" and "it is visible".
inline void update_existence(const TrackerConfig& config, const ScanLikelihood& scan,
                             Track& track) noexcept {
  constexpr double kMostExistence = 0.99999;
  if (config.visible_time_s > 0.0) {
    const double seen = std::max(scan.total - scan.none, 0.0);  // their sum is rounded
    const double visible =
        scan.assigned ? seen : track.visibility * (1.0 - config.detection()) + seen;
    const double either = scan.assigned ? visible : visible + (1.0 - track.visibility);
    if (either > 0.0) track.visibility = visible / either;
  }
  const double exists = track.existence * scan.total;
  track.existence = std::min(exists / (1.0 - track.existence + exists), kMostExistence);
}

}  // namespace wakeline
