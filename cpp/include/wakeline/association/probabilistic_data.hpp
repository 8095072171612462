// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "wakeline/core/fields.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Probabilistic data association (PDA): the probability of each gated plot to be the target's, and
/// that no plot is.
///
/// With N(ν_i; 0, S_i) the Gaussian likelihood of plot i and λ the clutter density,
///
///     β_0 ∝ 1 - P_D P_G        no plot is the target's
///     β_i ∝ P_D N(ν_i; 0, S_i) / λ
///
/// Source: Bar-Shalom, Li, Multitarget-Multisensor Tracking, 1995, section 3.4 (parametric PDA).
struct ProbabilisticData {
  double detection_probability = 0.9;
  double gate_probability = 0.99;
  double clutter_density = 1e-6;

  static constexpr auto fields() noexcept {
    using P = ProbabilisticData;
    return field_table(
        field("detection_probability", &P::detection_probability, kProbability, "1",
              "Probability P_D that the target is detected."),
        field("gate_probability", &P::gate_probability, kProbability, "1",
              "Probability P_G that its plot is inside the gate."),
        field("clutter_density", &P::clutter_density, kNotNegative, "1/volume",
              "False plots λ per unit of measurement volume, per m² for a position: Poisson, the "
              "parametric form."));
  }

  /// Throws `std::invalid_argument` when a probability is outside [0, 1] or the density is
  /// negative.
  void validate() const { validate_fields(*this); }

  /// The non-parametric form for an unknown clutter density: λ = m / V, m plots in a gate of volume
  /// V > 0.
  [[nodiscard]] ProbabilisticData with_clutter_from(int plots_in_gate,
                                                    double gate_volume) const noexcept {
    ProbabilisticData adapted = *this;
    adapted.clutter_density = plots_in_gate / gate_volume;
    return adapted;
  }

  /// β from ln N(ν_i; 0, S_i) of the n plots in the gate.
  ///
  /// `probability` has n + 1 elements that sum to 1: [0] for no plot, [i + 1] for plot i. When all
  /// weights are zero (no clutter, certain detection, no plot with positive likelihood), [0] is 1.
  /// kNotFinite, and nothing written, when a log-likelihood is NaN or +infinity, a setting is
  /// invalid, or `probability` does not have n + 1 elements.
  template <class Scalar>
  Status association_probability(std::span<const Scalar> log_likelihood,
                                 std::span<Scalar> probability) const noexcept {
    using std::exp;
    using std::log;
    constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
    const std::size_t plots = log_likelihood.size();
    if (probability.size() != plots + 1) return Status::kNotFinite;

    // Weights times λ, so that zero clutter (λ = 0) needs no special case.
    const Scalar log_none = static_cast<Scalar>(
        std::log((1.0 - detection_probability * gate_probability) * clutter_density));
    const Scalar log_detection = static_cast<Scalar>(std::log(detection_probability));
    Scalar largest = log_none;
    const auto is_probability = [](double p) { return p >= 0.0 && p <= 1.0; };
    bool valid = is_probability(detection_probability) && is_probability(gate_probability) &&
                 clutter_density >= 0.0 && log_none < infinity;
    for (const Scalar& value : log_likelihood) {
      valid = valid && value < infinity;
      largest = std::max(largest, log_detection + value);
    }
    if (!valid) return Status::kNotFinite;
    if (plots == 0 || !(largest > -infinity)) {
      std::fill(probability.begin(), probability.end(), Scalar(0));
      probability[0] = Scalar(1);
      return Status::kOk;
    }

    probability[0] = exp(log_none - largest);
    Scalar sum = probability[0];
    for (std::size_t i = 0; i < plots; ++i) {
      probability[i + 1] = exp(log_detection + log_likelihood[i] - largest);
      sum += probability[i + 1];
    }
    for (Scalar& value : probability) value /= sum;
    return Status::kOk;
  }
};

/// The combined innovation of all gated plots, the input of the PDA update.
template <int M, class Scalar = double>
struct CombinedInnovation {
  Scalar none_probability = Scalar(1);           ///< β_0
  Vec<Scalar, M> mean = Vec<Scalar, M>::Zero();  ///< ν = Σ β_i ν_i
  /// Σ β_i ν_i ν_iᵀ - ν νᵀ, positive semidefinite.
  Mat<Scalar, M, M> spread = Mat<Scalar, M, M>::Zero();
};

/// Combines n innovations (angles wrapped) by their n + 1 association probabilities, [0] for no
/// plot.
///
/// The spread is summed about the mean, Σ_{i>=0} β_i (ν_i - ν)(ν_i - ν)ᵀ with ν_0 = 0, so that
/// rounding cannot make it indefinite. Source: Bar-Shalom, Li 1995, section 3.4.
template <int M, class Scalar>
CombinedInnovation<M, Scalar> combine_innovations(std::span<const Vec<Scalar, M>> innovations,
                                                  std::span<const Scalar> probability) noexcept {
  CombinedInnovation<M, Scalar> combined;
  combined.none_probability = probability[0];
  for (std::size_t i = 0; i < innovations.size(); ++i)
    combined.mean += probability[i + 1] * innovations[i];
  combined.spread = probability[0] * combined.mean * combined.mean.transpose();
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    const Vec<Scalar, M> deviation = innovations[i] - combined.mean;
    combined.spread += probability[i + 1] * deviation * deviation.transpose();
  }
  return combined;
}

/// The moment-matched PDA posterior of an N-state belief.
///
///     x = x⁻ + K ν
///     P = β_0 P⁻ + (1 - β_0) P⁺ + K (spread of innovations) Kᵀ
///
/// `predicted` is x⁻, P⁻; `updated_covariance` is P⁺, the filter's covariance after an update with
/// one certain plot; `gain` is K (N x M). With β_1 = 1 the result is that update. Source:
/// Bar-Shalom, Li 1995, section 3.4.
template <int N, int M, class Scalar>
Gaussian<N, Scalar> probabilistic_data_update(
    const Gaussian<N, Scalar>& predicted, const Mat<Scalar, N, N>& updated_covariance,
    const Mat<Scalar, N, M>& gain, const CombinedInnovation<M, Scalar>& combined) noexcept {
  const Scalar none = combined.none_probability;
  Gaussian<N, Scalar> posterior;
  posterior.mean = predicted.mean + gain * combined.mean;
  posterior.covariance = none * predicted.covariance + (Scalar(1) - none) * updated_covariance;
  posterior.covariance += gain * combined.spread * gain.transpose();
  mirror_lower(posterior.covariance);
  return posterior;
}

}  // namespace wakeline
