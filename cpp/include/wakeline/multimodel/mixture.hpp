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
  Scalar least_nis = std::numeric_limits<RealOf<Scalar>>::infinity();

  /// Adds a part of the mixture, by its innovation.
  template <int M>
  void add(Scalar weight, const Correction<M, Scalar>& correction) noexcept {
    const Likelihood<Scalar> of_part = correction.likelihood();
    likelihood += weight * of_part.value();
    least_nis = select(of_part.nis < least_nis, of_part.nis, least_nis);
  }
};

/// Most readings that one update takes in; more are left out.
inline constexpr std::size_t kMaxAlternatives = 16;

/// The logarithm of zero.
template <class Scalar>
inline constexpr RealOf<Scalar> kImpossible = -std::numeric_limits<RealOf<Scalar>>::infinity();

/// Throws `std::invalid_argument` unless these are `modes` probabilities that sum to 1, in every
/// lane.
template <class Probability>
void require_distribution(const char* name, const Probability& probability, Eigen::Index modes) {
  for (int of_lane = 0; of_lane < kLanesOf<typename Probability::Scalar>; ++of_lane) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < probability.size(); ++k) {
      const double part = double(lane(probability[k], of_lane));
      require_probability(name, part);
      sum += part;
    }
    require(probability.size() == modes && std::abs(sum - 1.0) <= 1e-6, name,
            "one number per mode that sum to 1", sum);
  }
}

/// Its part of a total, times 1 / total; what is all of it is 1 to the last bit.
template <class Scalar>
Scalar part_of(Scalar part, Scalar total, Scalar scale) noexcept {
  return select(part == total, Scalar(1), part * scale);
}

/// Bayes' rule for the parts of a mixture: weights become weight times likelihood over their sum.
/// Returns the logarithm of that sum; `kImpossible`, and nothing changed, where no part is
/// possible. `likelihood_of(k)` gives that of a part, of which there are at most `Capacity`.
template <std::size_t Capacity, class Scalar, class LikelihoodOf>
Scalar reweigh(std::span<Scalar> weights, const LikelihoodOf& likelihood_of) noexcept {
  using std::exp, std::log;
  std::array<Scalar, Capacity> likely;
  Scalar nearest = std::numeric_limits<RealOf<Scalar>>::infinity();
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const Likelihood<Scalar> likelihood = likelihood_of(k);
    likely[k] = weights[k] * likelihood.peak;
    nearest = select(likely[k] > Scalar(0) && likelihood.nis < nearest, likelihood.nis, nearest);
  }
  Scalar total = Scalar(0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    // Where the prior is zero the likelihood may be beyond exp: 0 times infinity is 0 here.
    const Scalar nearness = exp((nearest - likelihood_of(k).nis) / 2);
    likely[k] = select(likely[k] > Scalar(0), likely[k] * nearness, Scalar(0));
    total += likely[k];
  }
  const auto possible = total > Scalar(0);
  const Scalar scale = reciprocal(select(possible, total, Scalar(1)));
  for (std::size_t k = 0; k < weights.size(); ++k)
    weights[k] = select(possible, part_of(likely[k], total, scale), weights[k]);
  return select(possible, log(total) - nearest / 2, Scalar(kImpossible<Scalar>));
}

/// The step of a mixture: the innovation of the moment-matched prediction, over the parts that
/// could be updated. Has no likelihood yet.
template <int M, class Scalar>
Step<M, Scalar> mixed_step(std::span<const Correction<M, Scalar>> parts,
                           std::span<const Scalar> weights) noexcept {
  const auto weight_of = [&](std::size_t k) {
    return select(ok(parts[k].status), weights[k], Scalar(0));
  };
  Scalar total = Scalar(0);
  for (std::size_t k = 0; k < parts.size(); ++k) total += weight_of(k);
  const Scalar scale = reciprocal(total);
  const auto add = [](Scalar& sum, Scalar weight, Scalar part) {
    sum += select(weight > Scalar(0), weight * part, Scalar(0));
  };
  Step<M, Scalar> mixed;
  mixed.status = Status::kOk;
  mixed.innovation_covariance.setZero();
  for (std::size_t k = 0; k < parts.size(); ++k)
    for (int i = 0; i < M; ++i)
      add(mixed.innovation[i], part_of(weight_of(k), total, scale), parts[k].innovation[i]);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Scalar weight = part_of(weight_of(k), total, scale);
    const Vec<Scalar, M> d = parts[k].innovation - mixed.innovation;
    for (int j = 0; j < M; ++j)
      for (int i = j; i < M; ++i)
        add(mixed.innovation_covariance(i, j), weight,
            parts[k].innovation_covariance(i, j) + d[i] * d[j]);
  }
  for (int j = 1; j < M; ++j)
    for (int i = 0; i < j; ++i)
      mixed.innovation_covariance(i, j) = mixed.innovation_covariance(j, i);
  mixed.nis = Cholesky<M, Scalar>(mixed.innovation_covariance).squared_norm(mixed.innovation);
  return mixed;
}

/// Why no part of a mixture could be updated; one not started is at rest.
template <int M, class Scalar>
StatusOf<Scalar> failure_of(std::span<const Correction<M, Scalar>> parts) noexcept {
  StatusOf<Scalar> failure = Status::kOk;
  for (const auto& part : parts)
    if (!(all(part.status == Status::kNotStarted))) failure = first_failure(failure, part.status);
  return first_failure(failure, Status::kNotFinite);
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
    const auto& [sensor, z, before_likelihood] = readings[k];
    if (const auto correction = filter.correct(sensor, sensor.observe(z))) {
      weight[k] = before_likelihood * correction.likelihood().value();
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
