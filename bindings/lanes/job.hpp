// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A job of lanes over an estimator that has been composed for it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>
#include <variant>
#include <vector>

#include "lanes.hpp"
#include "wakeline/simd/pack_math.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"

namespace wakeline::python {

using Lanes = Pack<double, kNativeLanes<double>>;

template <class>
inline constexpr LaneFilter kFilterOf = LaneFilter::kExtended;
template <class Motion>
inline constexpr LaneFilter kFilterOf<Ukf<Motion, Lanes>> = LaneFilter::kUnscented;
template <class Motion>
inline constexpr LaneFilter kFilterOf<SquareRootUkf<Motion, Lanes>> = LaneFilter::kSquareRoot;

/// The motion of a model; over `KnownTurn<Lanes>` the turn rate may come to differ from run to run.
template <class Motion>
Motion motion_of(const LaneModel& model) {
  if constexpr (std::is_same_v<Motion, KnownTurn<Lanes>>) {
    const auto& turn = std::get<CoordinatedTurn>(model.motion);
    return {turn.turn_rate_rad_s, turn.noise};
  } else {
    return std::get<Motion>(model.motion);
  }
}

template <class Filter>
Filter filter_of(const LaneModel& model) {
  if constexpr (kFilterOf<Filter> == LaneFilter::kExtended)
    return Filter(motion_of<typename Filter::Motion>(model));
  else
    return Filter(motion_of<typename Filter::Motion>(model), model.transform);
}

/// A bank of as many filters as the job has models.
template <class Filter>
UniformBank<Filter> bank_of(const LaneJob& job) {
  std::vector<Filter> filters;
  for (const LaneModel& model : job.models) filters.push_back(filter_of<Filter>(model));
  return UniformBank<Filter>(std::span<const Filter>(filters));
}

/// Whether all models are filters of one kind over a motion.
template <class Motion>
bool all_over(const LaneJob& job, LaneFilter filter) {
  return std::ranges::all_of(job.models, [&](const LaneModel& model) {
    return model.filter == filter && std::holds_alternative<Motion>(model.motion);
  });
}

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

/// The sensors of two numbers.
struct PlaneSensors {
  template <class Run>
  static void visit(const LaneJob& job, const Run& run) {
    if (const auto* polar = std::get_if<RangeBearing>(&job.sensor))
      run(*polar);
    else if (const auto* converted = std::get_if<ConvertedRangeBearing>(&job.sensor))
      run(AnyDirect(*converted));
    else
      run(AnyDirect(std::get<Position>(job.sensor)));
  }
};

/// The sensor of three.
struct DopplerSensor {
  template <class Run>
  static void visit(const LaneJob& job, const Run& run) {
    run(std::get<RangeBearingDoppler>(job.sensor));
  }
};

/// Runs an estimator of N states, for whichever of the sensors it is.
template <int N, class Sensors = PlaneSensors, class Estimator>
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
    Sensors::visit(
        job, [&](const auto& sensor) { run_batch(begin_at, sensor, in, out, Threads{threads}); });
  };
  if (job.starts.front().states == N)
    run(begin(Index<N>{}));
  else if (job.starts.front().states == 4)
    run(begin(Index<4>{}));
  else
    return false;
  return true;
}

/// The same of an estimator of several models.
template <class Sensors = PlaneSensors, class Estimator>
bool run_begun(Estimator estimator, const LaneJob& job, const RunInput& in, const RunOutput& out,
               int threads) {
  typename Estimator::Probability initial = estimator.initial_mode_probability();
  for (std::size_t k = 0; k < job.models.size(); ++k)
    initial[static_cast<Eigen::Index>(k)] = job.initial_mode_probability[k];
  estimator.set_initial_mode_probability(initial);
  constexpr int kStates = decltype(estimator.estimate())::kStates;
  return run_from<kStates, Sensors>(estimator, job, in, out, threads);
}

/// The same of one whose models change their turn rates by some rules.
template <template <class> class Estimator, class Rules, class Bank>
bool run_turning(const Rules& rules, const Bank& bank, const LaneJob& job, const RunInput& in,
                 const RunOutput& out, int threads) {
  const ModeChain<Bank::kModels> chain(*job.chain);
  return run_begun(Estimator<Bank>(rules, chain, bank), job, in, out, threads);
}

// Each of these does nothing, and returns false, where its models are not of kinds that are
// compiled together, or where the starts are not all over position and velocity or all over the
// state of the estimate.

/// An Imm over filters of different kinds.
bool run_mixed_imm(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads);

/// An estimator that draws lines, for any sensor.
bool run_lines(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads);

/// An estimator over turn rates that change, of unscented or square-root filters of known turns.
bool run_unscented_turns(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads);

/// What there is for a sensor of range rates.
bool run_doppler(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads);

/// A ModeHistory.
bool run_mode_history(const HistoryTree& tree, const LaneJob& job, const RunInput& in,
                      const RunOutput& out, int threads);

}  // namespace wakeline::python
