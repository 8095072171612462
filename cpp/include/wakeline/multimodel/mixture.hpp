// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Common parts of the estimators that hold a mixture of Gaussian beliefs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/multimodel/filter_bank.hpp"
#include "wakeline/simd/scalar.hpp"

namespace wakeline {

/// One of several readings that may be the target's, and its weight before its likelihood.
template <class Sensor, class Scalar = double>
struct Alternative {
  Sensor sensor;
  Vec<Scalar, Sensor::kMeasurements> z;
  Scalar weight;
};

/// The likelihood of a reading under all modes, and its smallest NIS.
template <class Scalar = double>
struct Evidence {
  Scalar likelihood = Scalar(0);
  Scalar least_nis = std::numeric_limits<RealOf<Scalar>>::infinity();

  /// Adds a component of the mixture by its innovation.
  template <int M>
  void add(Scalar weight, const Correction<M, Scalar>& correction) noexcept {
    const Likelihood<Scalar> of_part = correction.likelihood();
    likelihood += weight * of_part.value();
    least_nis = select(of_part.nis < least_nis, of_part.nis, least_nis);
  }
};

/// Largest number of readings in one update; further ones are ignored.
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

/// Probabilities normalised exactly, in each lane, when their sum differs from 1 by more than
/// rounding: otherwise a mean of positions thousands of kilometres away would be metres off.
template <class Probability>
Probability made_distribution(Probability probability) noexcept {
  using std::abs;
  using Scalar = typename Probability::Scalar;
  using Real = RealOf<Scalar>;
  constexpr Real kRounding = std::max(Real(1e-9L), 16 * std::numeric_limits<Real>::epsilon());
  Scalar sum = Scalar(0);
  for (const Scalar& part : probability) sum += part;
  const Scalar scale = select(abs(sum - Scalar(1)) > Scalar(kRounding), sum, Scalar(1));
  for (Scalar& part : probability) part = part / scale;
  return probability;
}

/// Smaller weights and probabilities count as zero, because a division by them could overflow.
template <class Scalar>
inline constexpr RealOf<Scalar> kLeastWeight =
    std::numeric_limits<RealOf<Scalar>>::min() / std::numeric_limits<RealOf<Scalar>>::epsilon();

/// part / total, given scale = 1 / total; exactly 1 for the whole.
template <class Scalar>
Scalar part_of(Scalar part, Scalar total, Scalar scale) noexcept {
  return select(part == total, Scalar(1), part * scale);
}

/// Replaces the components of a reading that are not `in_range` by NaN, so that every model rejects
/// it with `kNotFinite`.
template <int M, class Scalar>
[[gnu::always_inline]] inline void reject_out_of_range(Vec<Scalar, M>& reading) noexcept {
  constexpr auto kNan = std::numeric_limits<RealOf<Scalar>>::quiet_NaN();
  for (int i = 0; i < M; ++i) reading[i] = select(in_range(reading[i]), reading[i], Scalar(kNan));
}

/// Bayes' rule for the components of a mixture: weights become weight times likelihood over their
/// sum. Returns the logarithm of that sum; `kImpossible`, and nothing changed, where no component
/// is possible. `likelihood_of(k)` is the likelihood of a component, of at most `Capacity`. When
/// the components are packs and `Scalar` is a number, all lanes of all components form one mixture.
template <std::size_t Capacity, class Scalar, class Part = Scalar, class LikelihoodOf>
Scalar reweigh(std::span<Part> weights, const LikelihoodOf& likelihood_of) noexcept {
  using std::exp, std::log;
  std::array<Part, Capacity> likely;
  Part nearest_part = std::numeric_limits<RealOf<Part>>::infinity();
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const Likelihood<Part> likelihood = likelihood_of(k);
    likely[k] = weights[k] * likelihood.peak;
    nearest_part = select(likely[k] > Part(kLeastWeight<Part>) && likelihood.nis < nearest_part,
                          likelihood.nis, nearest_part);
  }
  const Scalar nearest = least_to<Scalar>(nearest_part);
  Part sum = Part(0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    // Where the prior is zero exp may overflow: 0 times infinity is 0 here.
    const Part nearness = exp((Part(nearest) - likelihood_of(k).nis) / 2);
    likely[k] = select(likely[k] > Part(kLeastWeight<Part>), likely[k] * nearness, Part(0));
    sum += likely[k];
  }
  const Scalar total = sum_to<Scalar>(sum);
  const auto possible = total > Scalar(0);
  const Scalar scale = reciprocal(select(possible, total, Scalar(1)));
  for (std::size_t k = 0; k < weights.size(); ++k)
    weights[k] = select(possible, part_of(likely[k], Part(total), Part(scale)), weights[k]);
  return select(possible, log(total) - nearest / 2, Scalar(kImpossible<Scalar>));
}

/// The step of a mixture: the innovation of the moment-matched prediction, over the components that
/// could be updated; without the likelihood. Packs as in `reweigh`.
template <int M, class Scalar, class Part>
Step<M, Scalar> mixed_step(std::span<const Correction<M, Part>> parts,
                           std::span<const std::type_identity_t<Part>> weights) noexcept {
  const auto weight_of = [&](std::size_t k) {
    return select(ok(parts[k].status) && weights[k] > Part(kLeastWeight<Part>), weights[k],
                  Part(0));
  };
  Part sum = Part(0);
  for (std::size_t k = 0; k < parts.size(); ++k) sum += weight_of(k);
  const Scalar total = sum_to<Scalar>(sum);
  const Scalar scale = reciprocal(total);
  const auto share_of = [&](std::size_t k) {
    return part_of(weight_of(k), Part(total), Part(scale));
  };
  const auto add = [](Part& to, Part weight, Part part) {
    to += select(weight > Part(0), weight * part, Part(0));
  };
  Vec<Part, M> innovation = Vec<Part, M>::Zero();
  for (std::size_t k = 0; k < parts.size(); ++k)
    for (int i = 0; i < M; ++i) add(innovation[i], share_of(k), parts[k].innovation[i]);
  Step<M, Scalar> mixed;
  mixed.status = Status::kOk;
  for (int i = 0; i < M; ++i) mixed.innovation[i] = sum_to<Scalar>(innovation[i]);
  Mat<Part, M, M> covariance = Mat<Part, M, M>::Zero();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    Vec<Part, M> d;
    for (int i = 0; i < M; ++i) d[i] = parts[k].innovation[i] - Part(mixed.innovation[i]);
    for (int j = 0; j < M; ++j)
      for (int i = j; i < M; ++i)
        add(covariance(i, j), share_of(k), parts[k].innovation_covariance(i, j) + d[i] * d[j]);
  }
  unroll_lower<M>([&](int i, int j) {
    mixed.innovation_covariance(i, j) = mixed.innovation_covariance(j, i) =
        sum_to<Scalar>(covariance(i, j));
  });
  mixed.nis = Cholesky<M, Scalar>(mixed.innovation_covariance).squared_norm(mixed.innovation);
  return mixed;
}

/// The status when no component could be updated; inactive ones (not started) are ignored.
template <int M, class Scalar>
StatusOf<Scalar> failure_of(std::span<const Correction<M, Scalar>> parts) noexcept {
  StatusOf<Scalar> failure = Status::kOk;
  for (const auto& part : parts)
    if (!(all(part.status == Status::kNotStarted))) failure = first_failure(failure, part.status);
  return first_failure(failure, Status::kNotFinite);
}

/// The state of a filter beside its belief: the position in a gain schedule. Empty for most
/// filters.
struct NoMemory {};
/// Nothing to replace.
template <class Mask>
void assign_where(const Mask&, NoMemory&, const NoMemory&) noexcept {}

/// What a filter remembers besides its belief.
template <class Filter>
auto memory_of(const Filter& filter) noexcept {
  if constexpr (requires { filter.memory(); })
    return filter.memory();
  else
    return NoMemory{};
}

/// Gives a filter what it remembered.
template <class Filter, class Memory>
void recall(Filter& filter, const Memory& memory) noexcept {
  if constexpr (requires { filter.recall(memory); }) filter.recall(memory);
}

/// Replaces the belief of a filter, `before`, by the mixture of its updates with each reading, and
/// returns the total weight. Adds the contribution of each reading, times `weight_of_filter`, to
/// `share`. Packs as in `reweigh`.
template <class Filter, class BeliefType, class Sensor, class Scalar, class Part>
Part absorb(Filter& filter, const BeliefType& before,
            std::span<const Alternative<Sensor, Scalar>> readings, Scalar none,
            Part weight_of_filter, std::span<Scalar> share) noexcept {
  const std::size_t count = std::min(readings.size(), kMaxAlternatives);
  if (count == 0) return Part(none);
  // In one pass, by sums about the mean before the update.
  BeliefType origin = before;
  origin.covariance.setZero();
  BeliefType mixture = zero_like(before), spread = origin;
  const auto add = [&](Part weight, const auto& belief) {
    add_mean(mixture, weight, belief, before);
    add_spread(spread, weight, belief, before);
  };
  Part total = Part(none);
  add(total, before);
  auto memory = memory_of(filter);
  const auto memory_before = memory;
  for (std::size_t k = 0; k < count; ++k) {
    const auto& [sensor, z, before_likelihood] = readings[k];
    const auto correction = filter.correct(sensor, sensor.observe(z).template cast<Part>());
    const Part weight = select(ok(correction.status),
                               Part(before_likelihood) * correction.likelihood().value(), Part(0));
    if (any(weight > Part(0))) {
      BeliefType after;
      after = filter.estimate();
      add(weight, after);
      assign_where(weight > Part(0), memory, memory_of(filter));
    }
    (void)filter.assign(before);
    recall(filter, memory_before);
    total += weight;
    share[k] += sum_to<Scalar>(weight_of_filter * weight);
  }
  const auto possible = total > Part(kLeastWeight<Part>);
  if (!any(possible)) return Part(0);
  const Part scale = reciprocal(select(possible, total, Part(1)));
  mixture.mean *= scale;
  mixture.covariance = scale * spread.covariance;
  add_spread(mixture, Part(-1), origin, before);
  if constexpr (kLanesOf < Part >> 1)
    assign_where<MaskOf<Part>, BeliefType::kStates, Part>(!possible, mixture, before);
  (void)filter.assign(mixture);
  recall(filter, memory);
  return select(possible, total, Part(0));
}

}  // namespace wakeline
