// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Probabilities that a target exists and that the radar can see it. Source: D. Mušicki, R. Evans,
// IEEE Trans. AES-40, 2004, with existence as a Markov chain of three states: visible, hidden,
// gone.
#pragma once

#include <algorithm>
#include <cmath>

#include "wakeline/core/archive.hpp"
#include "wakeline/track/config.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// Detection of a target by the radar, given that it exists.
struct Detection {
  double detected;        ///< PD pv: it gives a plot
  double missed;          ///< 1 - PD PG pv: it gives none in its gate
  double visible_missed;  ///< pv (1 - PD PG): it gives none although it is visible

  /// With the probability PD that a visible target gives a plot and PG that it is in the gate.
  Detection(double detection_probability, double in_gate, double visibility) noexcept
      : detected(detection_probability * visibility),
        missed(1.0 - detection_probability * in_gate * visibility),
        visible_missed(visibility * (1.0 - detection_probability * in_gate)) {}
};

/// The probability PD that a visible target gives a plot, learned from the confirmed tracks.
///
/// It is the share of looks at them in which they had a plot, of about the last thousand looks. It
/// begins with the configured probability, which counts as twenty looks.
class DetectionProbability {
 public:
  explicit DetectionProbability(const TrackerConfig& config)
      : in_gate_(config.in_gate()), seen_(kPriorLooks * config.detection_probability) {
    evaluate();
  }

  /// Evaluates what has been learned; until the next time the value stays.
  void evaluate() noexcept { value_ = std::clamp(seen_ / looks_, kLeast, kMost); }

  [[nodiscard]] double value() const noexcept { return value_; }

  /// Learns a look at a confirmed target, which had a plot with that probability.
  void learn(double seen) noexcept {
    seen_ = kMemory * seen_ + seen;
    looks_ = kMemory * looks_ + 1.0;
  }

  /// Detection of a target of that visibility.
  [[nodiscard]] Detection of(double visibility) const noexcept {
    return {value_, in_gate_, visibility};
  }

  /// How many misses in a row a target that is there has with at least that probability.
  [[nodiscard]] double likely_misses(double probability) const noexcept {
    return std::log(probability) / std::log(1.0 - value_);
  }

  /// Saves or restores what has been learned.
  void archive(Archive& fields) {
    fields(seen_);
    fields(looks_);
    evaluate();
  }

 private:
  static constexpr double kPriorLooks = 20.0;
  static constexpr double kMemory = 0.999;
  static constexpr double kLeast = 0.2, kMost = 0.98;

  double in_gate_;
  double seen_;
  double looks_ = kPriorLooks;
  double value_;
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

  [[nodiscard]] double existence(double before) const noexcept { return before * survival; }
  [[nodiscard]] double visibility(double before) const noexcept {
    return long_run + (before - long_run) * memory;
  }
};

/// How well a scan fits a track, against there being no such target.
struct ScanLikelihood {
  double total;   ///< of all hypotheses of the track about its plots
  double none;    ///< the part of it that no plot is the target's
  bool assigned;  ///< the track was assigned one plot, and cannot have none
};

/// Bayes' rule for "the target exists" and "it is visible".
inline void update_existence(const TrackerConfig& config, const Detection& detection,
                             const ScanLikelihood& scan, Track& track,
                             double& visibility) noexcept {
  constexpr double kMostExistence = 0.99999;
  if (config.visible_time_s > 0.0) {
    const double seen = std::max(scan.total - scan.none, 0.0);  // their sum is rounded
    const double visible = scan.assigned ? seen : detection.visible_missed + seen;
    const double either = scan.assigned ? visible : visible + (1.0 - visibility);
    if (either > 0.0) visibility = visible / either;
  }
  const double exists = track.existence * scan.total;
  track.existence = std::min(exists / (1.0 - track.existence + exists), kMostExistence);
}

}  // namespace wakeline
