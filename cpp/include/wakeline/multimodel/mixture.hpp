// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What estimators that hold a mixture of Gaussian beliefs share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/scalar.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/multimodel/filter_bank.hpp"

namespace wakeline {

/// One of several readings that may be a target's own, and its weight before its likelihood.
template <class Sensor, class Scalar = double>
struct Alternative {
  Sensor sensor;
  Vec<Scalar, Sensor::kMeasurements> z;
  Scalar weight;
};

/// How likely a reading is under all modes, and how near it is to the mode that is nearest.
template <class Scalar = double>
struct Evidence {
  Scalar likelihood = Scalar(0);
  Scalar least_nis = std::numeric_limits<Scalar>::infinity();

  /// Adds a part of the mixture, by its innovation.
  template <int M>
  void add(Scalar weight, const Step<M, Scalar>& step) noexcept {
    if (!step) return;
    likelihood += weight * std::exp(step.log_likelihood);
    least_nis = std::min(least_nis, step.nis);
  }
};

/// Most readings that one update takes in; more are left out.
inline constexpr std::size_t kMaxAlternatives = 16;

/// The logarithm of zero.
template <class Scalar>
inline constexpr Scalar kImpossible = -std::numeric_limits<Scalar>::infinity();

/// Throws `std::invalid_argument` unless these are `modes` probabilities that sum to 1.
template <class Probability>
void require_distribution(const char* name, const Probability& probability, Eigen::Index modes) {
  for (Eigen::Index k = 0; k < probability.size(); ++k)
    require_probability(name, double(probability[k]));
  require(probability.size() == modes && std::abs(double(probability.sum()) - 1.0) <= 1e-6, name,
          "one number per mode that sum to 1", double(probability.sum()));
}

/// Bayes' rule for the parts of a mixture: weights become weight times likelihood over their sum.
/// Returns the logarithm of that sum; `kImpossible`, and nothing changed, where no part is
/// possible.
template <class Scalar>
Scalar reweigh(std::span<Scalar> weights, std::span<const Scalar> log_likelihood) noexcept {
  Scalar best = kImpossible<Scalar>;
  for (std::size_t k = 0; k < weights.size(); ++k)
    if (weights[k] > Scalar(0) && log_likelihood[k] > best) best = log_likelihood[k];
  if (best == kImpossible<Scalar>) return best;
  Scalar total = Scalar(0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    // Where the prior is zero the likelihood may be beyond exp: 0 times infinity is 0 here.
    weights[k] =
        select(weights[k] > Scalar(0), weights[k] * std::exp(log_likelihood[k] - best), Scalar(0));
    total += weights[k];
  }
  for (Scalar& weight : weights) weight /= total;
  return best + std::log(total);
}

/// The step of a mixture: the innovation of the moment-matched prediction, over the parts that
/// could be updated. Has no likelihood yet.
template <int M, class Scalar>
Step<M, Scalar> mixed_step(std::span<const Step<M, Scalar>> steps,
                           std::span<const Scalar> weights) noexcept {
  Scalar total = Scalar(0);
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (steps[k]) total += weights[k];
  Step<M, Scalar> mixed;
  mixed.status = Status::kOk;
  mixed.innovation_covariance.setZero();
  const auto counts = [&](std::size_t k) { return steps[k] && weights[k] > Scalar(0); };
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (counts(k)) mixed.innovation += weights[k] / total * steps[k].innovation;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (!counts(k)) continue;
    const Scalar weight = weights[k] / total;
    const Vec<Scalar, M> d = steps[k].innovation - mixed.innovation;
    for (int j = 0; j < M; ++j)
      for (int i = 0; i < M; ++i)
        mixed.innovation_covariance(i, j) +=
            weight * (steps[k].innovation_covariance(i, j) + d[i] * d[j]);
  }
  mixed.nis = Cholesky<M, Scalar>(mixed.innovation_covariance).squared_norm(mixed.innovation);
  return mixed;
}

/// Why no part of a mixture could be updated; one not started is at rest.
template <int M, class Scalar>
Status failure_of(std::span<const Step<M, Scalar>> steps) noexcept {
  for (const auto& step : steps)
    if (step.status != Status::kOk && step.status != Status::kNotStarted) return step.status;
  return Status::kNotFinite;
}

/// Replaces the belief of a filter, `before`, by the mixture of what each reading makes of it, and
/// returns the total weight of that. Adds to `share` what each reading has of it, times
/// `weight_of_filter`.
template <class Filter, class BeliefType, class Sensor, class Scalar>
Scalar absorb(Filter& filter, const BeliefType& before,
              std::span<const Alternative<Sensor, Scalar>> readings, Scalar none,
              Scalar weight_of_filter, std::span<Scalar> share) noexcept {
  std::array<BeliefType, kMaxAlternatives> after;
  std::array<Scalar, kMaxAlternatives> weight{};
  const std::size_t count = std::min(readings.size(), kMaxAlternatives);
  Scalar total = none;
  for (std::size_t k = 0; k < count; ++k) {
    const auto step = filter.update(readings[k].sensor, readings[k].z);
    if (step) {
      weight[k] = readings[k].weight * std::exp(step.log_likelihood);
      after[k] = filter.estimate();
      (void)filter.assign(before);
    }
    total += weight[k];
    share[k] += weight_of_filter * weight[k];
  }
  if (!(total > Scalar(0))) return Scalar(0);
  BeliefType mixture = zero_like(before);
  add_mean(mixture, none / total, before, before);
  for (std::size_t k = 0; k < count; ++k)
    if (weight[k] > Scalar(0)) add_mean(mixture, weight[k] / total, after[k], before);
  add_spread(mixture, none / total, before, before);
  for (std::size_t k = 0; k < count; ++k)
    if (weight[k] > Scalar(0)) add_spread(mixture, weight[k] / total, after[k], before);
  (void)filter.assign(mixture);
  return total;
}

}  // namespace wakeline
