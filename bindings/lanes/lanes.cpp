// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "lanes.hpp"

#include <pybind11/pybind11.h>

#include <algorithm>

#include "job.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/multimodel/adaptive_grid_imm.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/likely_model_set_imm.hpp"
#include "wakeline/multimodel/mode_history.hpp"
#include "wakeline/multimodel/switching_grid_imm.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"

namespace wakeline::python {
namespace {

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

/// A bank of as many filters as the job has models.
template <class Filter>
UniformBank<Filter> bank_of(Filter (*filter)(const LaneJob&, std::size_t), const LaneJob& job) {
  std::vector<Filter> filters;
  for (std::size_t k = 0; k < job.models.size(); ++k) filters.push_back(filter(job, k));
  return UniformBank<Filter>(std::span<const Filter>(filters));
}

/// A bank of as many as `Models` says at compile time.
template <class Rate, std::size_t... Models>
auto turn_bank(const LaneJob& job, std::index_sequence<Models...>) {
  return FilterBank(turn_filter<Rate>(job, Models)...);
}

template <std::size_t Models>
bool run_few(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  const auto bank = turn_bank<double>(job, std::make_index_sequence<Models>{});
  return run_begun(Imm{ModeChain<int(Models)>(*job.chain), bank}, job, in, out, threads);
}

/// Whether all models are extended Kalman filters of one motion.
template <class Motion>
bool all_over(const LaneJob& job) {
  return std::ranges::all_of(job.models, [](const LaneModel& model) {
    return model.filter == LaneFilter::kExtended && std::holds_alternative<Motion>(model.motion);
  });
}

bool run_structured(std::monostate, const LaneJob& job, const RunInput& in, const RunOutput& out,
                    int threads) {
  if (!all_over<CoordinatedTurn>(job)) return run_mixed_imm(job, in, out, threads);
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

/// Whether lanes are compiled for the structure over these models.
bool has_kernel(const LaneJob& job) {
  return all_over<CoordinatedTurn>(job) || std::holds_alternative<std::monostate>(job.structure) ||
         (std::holds_alternative<HistoryTree>(job.structure) && all_over<CoordinatedTurnRate>(job));
}

bool run_mixture(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  if (!has_kernel(job)) return false;
  return std::visit(
      [&](const auto& structure) { return run_structured(structure, job, in, out, threads); },
      job.structure);
}

bool run(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  if (job.chain != nullptr) return run_mixture(job, in, out, threads);
  if (job.models.empty()) return run_lines(job, in, out, threads);
  const LaneModel& model = job.models.front();
  return std::visit(
      [&]<class Motion>(const Motion& motion) {
        constexpr int kStates = kStatesOf<Motion>;
        const auto run_one = [&](const auto& filter) {
          return run_from<kStates>(filter, job, in, out, threads);
        };
        switch (model.filter) {
          case LaneFilter::kUnscented:
            return run_one(Ukf<Motion, Lanes>(motion, model.transform));
          case LaneFilter::kSquareRoot:
            return run_one(SquareRootUkf<Motion, Lanes>(motion, model.transform));
          default:
            return run_one(Ekf<Motion, Lanes>(motion));
        }
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
