// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Recordings through an estimator over packs of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "lanes.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline::python {

using Lanes = Pack<double, kNativeLanes<double>>;

/// A filter over packs with the same parameters, over a motion model.
template <class Motion, class Old>
Ekf<Motion, Lanes> in_lanes(const Ekf<Old>&, const Motion& motion) {
  return Ekf<Motion, Lanes>(motion);
}
template <class Motion, class Old>
Ukf<Motion, Lanes> in_lanes(const Ukf<Old>& filter, const Motion& motion) {
  return Ukf<Motion, Lanes>(motion, filter.unscented());
}
template <class Motion, class Old>
SquareRootUkf<Motion, Lanes> in_lanes(const SquareRootUkf<Old>& filter, const Motion& motion) {
  return SquareRootUkf<Motion, Lanes>(motion, filter.unscented());
}

/// The starts of the recordings `first`, `first + 1`, ...
template <int N, class Scalar>
Gaussian<N, Scalar> gather_starts(const std::vector<AnyBelief>& starts,
                                  std::size_t first) noexcept {
  const auto of_lane = [&](int lane) -> const AnyBelief& {
    return starts[std::min(first + static_cast<std::size_t>(lane), starts.size() - 1)];
  };
  Gaussian<N, Scalar> belief;
  gather_lanes<N>([&](int lane) { return of_lane(lane).mean.data(); }, belief.mean.data());
  gather_lanes<N * N>([&](int lane) { return of_lane(lane).covariance.data(); },
                      belief.covariance.data());
  return belief;
}

/// Runs an estimator of N states. False, and nothing done, where the starts are neither all over
/// its state nor all over position and velocity.
template <int N, class Estimator>
bool run_from(const Estimator& prototype, const LaneRecordings& recordings) {
  const auto& starts = recordings.starts;
  for (const AnyBelief& start : starts)
    if (start.layout != starts.front().layout) return false;
  const bool lifted = starts.front().states() != N;
  if (lifted && starts.front().layout != StateLayout::kKinematics) return false;
  const auto begin = [&](std::size_t first) {
    using Scalar = typename Estimator::Scalar;
    Estimator estimator = prototype;
    if constexpr (N != 4) {
      if (lifted) {
        (void)estimator.start(gather_starts<4, Scalar>(starts, first));
        return estimator;
      }
    }
    (void)estimator.start(gather_starts<N, Scalar>(starts, first));
    return estimator;
  };
  run_batch(begin, recordings.sensor, recordings.in, recordings.out, Threads{recordings.threads});
  return true;
}

bool run_filter(const AnyFilter& filter, const LaneRecordings& recordings);
bool run_imm(const AnyImm& imm, const LaneRecordings& recordings);
void run_linear(const LinearRecordings& recordings);
bool run_history(const AnyModeHistory& history, const LaneRecordings& recordings);

}  // namespace wakeline::python
