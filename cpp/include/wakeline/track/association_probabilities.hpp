// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "wakeline/measurement/fix.hpp"
#include "wakeline/multimodel/mixture.hpp"
#include "wakeline/track/association.hpp"
#include "wakeline/track/mode_positions.hpp"

namespace wakeline {

/// How probable it is that a plot is a target's own, given that the target exists and all plots.
struct AssociationProbabilities {
  std::array<double, CandidatePlots::kMost> of_candidate = {};
  double any = 0.0;  ///< that one of them is: 1 minus that of a missed detection
  int best = -1;     ///< the candidate with the largest probability, or -1
};

/// The candidates of one track as its estimator takes them: two readings each, one with the nominal
/// error and one with that of an outlier.
class TrackReadings {
 public:
  /// Lists the candidates that have a weight.
  void list(const CandidatePlots& candidates, const AssociationWeights& weights,
            double outlier_probability) noexcept {
    count_ = 0;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      if (!(weights.plot[k] > 0.0)) continue;
      const CandidatePlot& plot = candidates[k];
      candidate_[count_ / 2] = k;
      fixes_[count_++] = {Fix{plot.nominal_r}, plot.z,
                          (1.0 - outlier_probability) * weights.plot[k]};
      fixes_[count_++] = {Fix{plot.outlier_r}, plot.z, outlier_probability * weights.plot[k]};
    }
  }

  /// Has the update take so many plots for one: each reading with so many times its covariance, but
  /// as probable as with its own.
  void count_as_one(double plots, const ModePositions& modes) noexcept {
    for (Alternative<Fix>& reading : std::span(fixes_.data(), count_)) {
      Mat<double, 2, 2>& r = reading.sensor.covariance_m2;
      const double likelihood = modes.evidence(reading.z, r).likelihood;
      r *= plots;
      if (likelihood > 0.0) reading.weight *= likelihood / modes.evidence(reading.z, r).likelihood;
    }
  }

  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] std::span<const Alternative<Fix>> fixes() const noexcept {
    return {fixes_.data(), count_};
  }
  /// Where the update puts the probability of each reading.
  [[nodiscard]] std::span<double> share() noexcept { return {share_.data(), count_}; }

  /// The probabilities that the update has given, of each candidate.
  [[nodiscard]] AssociationProbabilities probabilities() const noexcept {
    AssociationProbabilities result;
    double largest = 0.0;
    for (std::size_t k = 0; k < count_; k += 2) {
      const std::size_t candidate = candidate_[k / 2];
      const double probability = share_[k] + share_[k + 1];
      result.of_candidate[candidate] = probability;
      result.any += probability;
      if (probability > largest) {
        largest = probability;
        result.best = static_cast<int>(candidate);
      }
    }
    return result;
  }

 private:
  static constexpr std::size_t kMost = 2 * CandidatePlots::kMost;
  static_assert(kMost <= kMaxAlternatives);

  std::array<Alternative<Fix>, kMost> fixes_;
  std::array<double, kMost> share_;
  std::array<std::size_t, CandidatePlots::kMost> candidate_;  ///< of each pair of readings
  std::size_t count_ = 0;
};

}  // namespace wakeline
