// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A job of lanes over an estimator that has been composed for it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <variant>
#include <vector>

#include "lanes.hpp"
#include "wakeline/core/pack_math.hpp"
#include "wakeline/measurement/fix.hpp"

namespace wakeline::python {

using Lanes = Pack<double, kNativeLanes<double>>;

/// A position fixed by whatever sensor.
struct AnyDirect : Fix {
  std::variant<ConvertedRangeBearing, Position> sensor;
  OwnShip own = {};

  explicit AnyDirect(const Position& position) : sensor(position) {}
  explicit AnyDirect(const ConvertedRangeBearing& converted)
      : sensor(converted), own(converted.own) {}

  template <class Scalar>
  Gaussian<2, Scalar> observe(const Vec<Scalar, 2>& z) const noexcept {
    if (const auto* converted = std::get_if<ConvertedRangeBearing>(&sensor)) {
      ConvertedRangeBearing carried = *converted;
      carried.own = own;
      return carried.observe(z);
    }
    return std::get_if<Position>(&sensor)->observe(z);
  }
  template <class Scalar>
  Gaussian<2, Scalar> position(const Vec<Scalar, 2>& z) const noexcept {
    return observe(z);
  }
};

/// The starts of the runs `first`, `first + 1`, ...
template <int N, class Scalar>
Gaussian<N, Scalar> gather(const std::vector<LaneStart>& starts, std::size_t first) noexcept {
  const auto of_lane = [&](int lane) -> const LaneStart& {
    return starts[std::min(first + static_cast<std::size_t>(lane), starts.size() - 1)];
  };
  Gaussian<N, Scalar> belief;
  gather_lanes<N>([&](int lane) { return of_lane(lane).mean; }, belief.mean.data());
  gather_lanes<N * N>([&](int lane) { return of_lane(lane).covariance; }, belief.covariance.data());
  return belief;
}

template <int N, class Estimator>
bool run_from(const Estimator& prototype, const LaneJob& job, const RunInput& in,
              const RunOutput& out, int threads) {
  for (const LaneStart& start : job.starts)
    if (start.states != job.starts.front().states) return false;
  const auto begin = [&]<int States>(Index<States>) {
    return [&](std::size_t first) {
      Estimator estimator = prototype;
      (void)estimator.start(gather<States, typename Estimator::Scalar>(job.starts, first));
      return estimator;
    };
  };
  const auto run = [&](const auto& begin_at) {
    if (const auto* polar = std::get_if<RangeBearing>(&job.sensor))
      run_batch(begin_at, *polar, in, out, Threads{threads});
    else if (const auto* converted = std::get_if<ConvertedRangeBearing>(&job.sensor))
      run_batch(begin_at, AnyDirect(*converted), in, out, Threads{threads});
    else
      run_batch(begin_at, AnyDirect(std::get<Position>(job.sensor)), in, out, Threads{threads});
  };
  if (job.starts.front().states == N)
    run(begin(Index<N>{}));
  else if (job.starts.front().states == 4)
    run(begin(Index<4>{}));
  else
    return false;
  return true;
}

template <class Estimator>
bool run_begun(Estimator estimator, const LaneJob& job, const RunInput& in, const RunOutput& out,
               int threads) {
  typename Estimator::Probability initial = estimator.initial_mode_probability();
  for (std::size_t k = 0; k < job.models.size(); ++k)
    initial[static_cast<Eigen::Index>(k)] = job.initial_mode_probability[k];
  estimator.set_initial_mode_probability(initial);
  return run_from<decltype(estimator.estimate())::kStates>(estimator, job, in, out, threads);
}

/// An Imm over filters of different kinds. False, and nothing done, where there are too many, where
/// they are not of kinds that are compiled together, or where the starts are not all over position
/// and velocity or all over the state of the estimate.
bool run_mixed_imm(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads);

/// An estimator that draws lines.
bool run_lines(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads);

}  // namespace wakeline::python
