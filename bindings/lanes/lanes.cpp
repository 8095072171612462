// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "lanes.hpp"

#include <pybind11/pybind11.h>

#include <algorithm>

#include "wakeline/core/pack_math.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/multimodel/adaptive_grid_imm.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/likely_model_set_imm.hpp"
#include "wakeline/multimodel/mode_history.hpp"
#include "wakeline/multimodel/switching_grid_imm.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"

namespace wakeline::python {
namespace {

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

/// A filter of a known turn; `Rate` is `Lanes` where turn rates differ from run to run.
template <class Rate>
using Turn4 = Ekf<KnownTurn<Rate>, Lanes>;

template <class Rate>
Turn4<Rate> turn_filter(const LaneJob& job, std::size_t k) {
  const auto& motion = std::get<CoordinatedTurn>(job.models[k].motion);
  return Turn4<Rate>({motion.turn_rate_rad_s, motion.noise});
}

/// One that learns its turn rate.
Ekf<CoordinatedTurnRate, Lanes> learning_filter(const LaneJob& job, std::size_t k) {
  return Ekf<CoordinatedTurnRate, Lanes>(std::get<CoordinatedTurnRate>(job.models[k].motion));
}

/// As many as the job has.
template <class Filter>
UniformBank<Filter> bank_of(Filter (*filter)(const LaneJob&, std::size_t), const LaneJob& job) {
  std::vector<Filter> filters;
  for (std::size_t k = 0; k < job.models.size(); ++k) filters.push_back(filter(job, k));
  return UniformBank<Filter>(std::span<const Filter>(filters));
}

/// A number that is known.
template <class Rate, std::size_t... Models>
auto turn_bank(const LaneJob& job, std::index_sequence<Models...>) {
  return FilterBank(turn_filter<Rate>(job, Models)...);
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

template <std::size_t Models>
bool run_few(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  const auto bank = turn_bank<double>(job, std::make_index_sequence<Models>{});
  return run_begun(Imm{ModeChain<int(Models)>(*job.chain), bank}, job, in, out, threads);
}

bool run_structured(std::monostate, const LaneJob& job, const RunInput& in, const RunOutput& out,
                    int threads) {
  switch (job.models.size()) {
    case 2:
      return run_few<2>(job, in, out, threads);
    case 3:
      return run_few<3>(job, in, out, threads);
    case 5:
      return run_few<5>(job, in, out, threads);
    default:
      return run_begun(Imm{*job.chain, bank_of(&turn_filter<double>, job)}, job, in, out, threads);
  }
}

/// Whether all models are extended Kalman filters of one motion.
template <class Motion>
bool all_over(const LaneJob& job) {
  return std::ranges::all_of(job.models, [](const LaneModel& model) {
    return !model.unscented && std::holds_alternative<Motion>(model.motion);
  });
}

bool run_structured(const HistoryTree& tree, const LaneJob& job, const RunInput& in,
                    const RunOutput& out, int threads) {
  const auto run_over = [&](const auto& bank) {
    return run_begun(ModeHistory(tree, *job.chain, bank), job, in, out, threads);
  };
  return all_over<CoordinatedTurnRate>(job) ? run_over(bank_of(&learning_filter, job))
                                            : run_over(bank_of(&turn_filter<double>, job));
}

/// An estimator whose models change their turn rates by some rules.
template <template <class> class Estimator, class Rules, class Bank>
bool run_turning(const Rules& rules, const Bank& bank, const LaneJob& job, const RunInput& in,
                 const RunOutput& out, int threads) {
  const ModeChain<Bank::kModels> chain(*job.chain);
  return run_begun(Estimator<Bank>(rules, chain, bank), job, in, out, threads);
}

bool run_structured(const AdaptiveGrid& grid, const LaneJob& job, const RunInput& in,
                    const RunOutput& out, int threads) {
  const auto bank = turn_bank<Lanes>(job, std::make_index_sequence<3>{});
  return run_turning<AdaptiveGridImm>(grid, bank, job, in, out, threads);
}

bool run_structured(const SwitchingGrid& grid, const LaneJob& job, const RunInput& in,
                    const RunOutput& out, int threads) {
  const auto bank = turn_bank<Lanes>(job, std::make_index_sequence<3>{});
  return run_turning<SwitchingGridImm>(grid, bank, job, in, out, threads);
}

bool run_structured(const LikelyModelSet& set, const LaneJob& job, const RunInput& in,
                    const RunOutput& out, int threads) {
  const auto bank = bank_of(&turn_filter<Lanes>, job);
  return run_turning<LikelyModelSetImm>(set, bank, job, in, out, threads);
}

bool run_mixture(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  const bool learns =
      std::holds_alternative<HistoryTree>(job.structure) && all_over<CoordinatedTurnRate>(job);
  if (!learns && !all_over<CoordinatedTurn>(job)) return false;
  return std::visit(
      [&](const auto& structure) { return run_structured(structure, job, in, out, threads); },
      job.structure);
}

bool run(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  if (job.chain != nullptr) return run_mixture(job, in, out, threads);
  const LaneModel& model = job.models.front();
  return std::visit(
      [&]<class Motion>(const Motion& motion) {
        constexpr int kStates = kStatesOf<Motion>;
        if (model.unscented)
          return run_from<kStates>(Ukf<Motion, Lanes>(motion, model.transform), job, in, out,
                                   threads);
        return run_from<kStates>(Ekf<Motion, Lanes>(motion), job, in, out, threads);
      },
      model.motion);
}

class Vessels : public VesselLanes {
 public:
  explicit Vessels(const VesselImm& prototype) : side_by_side_(prototype) {}
  void predict(std::span<PredictionStep<VesselImm>> steps) noexcept override {
    side_by_side_.predict(steps);
  }
  void update(std::span<UpdateStep<VesselImm>> steps) noexcept override {
    side_by_side_.update(steps);
  }

 private:
  SideBySide<VesselImm> side_by_side_;
};

std::unique_ptr<VesselLanes> vessels(const VesselImm& prototype) {
  return std::make_unique<Vessels>(prototype);
}

}  // namespace
}  // namespace wakeline::python

PYBIND11_MODULE(WAKELINE_LANES_MODULE, m) {
  static constexpr wakeline::python::LaneKernels kKernels{
      &wakeline::python::run, &wakeline::python::vessels, wakeline::kNativeLanes<double>};
  m.doc() = "Runs as lanes, for one instruction set.";
  m.attr("kernels") = pybind11::capsule(static_cast<const void*>(&kKernels), "wakeline.lanes");
}
