// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "lanes.hpp"

#include <pybind11/pybind11.h>

#include <utility>

#include "job.hpp"
#include "wakeline/multimodel/adaptive_grid_imm.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/likely_model_set_imm.hpp"
#include "wakeline/multimodel/switching_grid_imm.hpp"

namespace wakeline::python {
namespace {

/// A filter of a known turn; `Rate` is `Lanes` where turn rates differ from run to run.
template <class Rate>
using Turn4 = Ekf<KnownTurn<Rate>, Lanes>;

/// A bank of as many as `Models` says at compile time.
template <class Rate, std::size_t... Models>
auto turn_bank(const LaneJob& job, std::index_sequence<Models...>) {
  return FilterBank(filter_of<Turn4<Rate>>(job.models[Models])...);
}

template <std::size_t Models>
bool run_few(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  const auto bank = turn_bank<double>(job, std::make_index_sequence<Models>{});
  return run_begun(Imm{ModeChain<int(Models)>(*job.chain), bank}, job, in, out, threads);
}

/// Whether all models are extended Kalman filters of known turns.
bool all_extended_turns(const LaneJob& job) {
  return all_over<CoordinatedTurn>(job, LaneFilter::kExtended);
}

bool run_structured(std::monostate, const LaneJob& job, const RunInput& in, const RunOutput& out,
                    int threads) {
  if (!all_extended_turns(job)) return run_mixed_imm(job, in, out, threads);
  switch (job.models.size()) {
    case 2:
      return run_few<2>(job, in, out, threads);
    case 3:
      return run_few<3>(job, in, out, threads);
    case 5:
      return run_few<5>(job, in, out, threads);
    default:
      return run_begun(Imm{*job.chain, bank_of<Turn4<double>>(job)}, job, in, out, threads);
  }
}

bool run_structured(const HistoryTree& tree, const LaneJob& job, const RunInput& in,
                    const RunOutput& out, int threads) {
  return run_mode_history(tree, job, in, out, threads);
}

bool run_structured(const AdaptiveGrid& grid, const LaneJob& job, const RunInput& in,
                    const RunOutput& out, int threads) {
  if (!all_extended_turns(job)) return run_unscented_turns(job, in, out, threads);
  const auto bank = turn_bank<Lanes>(job, std::make_index_sequence<3>{});
  return run_turning<AdaptiveGridImm>(grid, bank, job, in, out, threads);
}

bool run_structured(const SwitchingGrid& grid, const LaneJob& job, const RunInput& in,
                    const RunOutput& out, int threads) {
  if (!all_extended_turns(job)) return run_unscented_turns(job, in, out, threads);
  const auto bank = turn_bank<Lanes>(job, std::make_index_sequence<3>{});
  return run_turning<SwitchingGridImm>(grid, bank, job, in, out, threads);
}

bool run_structured(const LikelyModelSet& set, const LaneJob& job, const RunInput& in,
                    const RunOutput& out, int threads) {
  if (!all_extended_turns(job)) return run_unscented_turns(job, in, out, threads);
  const auto bank = bank_of<Turn4<Lanes>>(job);
  return run_turning<LikelyModelSetImm>(set, bank, job, in, out, threads);
}

bool run_mixture(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  return std::visit(
      [&](const auto& structure) { return run_structured(structure, job, in, out, threads); },
      job.structure);
}

bool run(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  if (job.models.empty()) return run_lines(job, in, out, threads);
  if (std::holds_alternative<RangeBearingDoppler>(job.sensor))
    return run_doppler(job, in, out, threads);
  if (job.chain != nullptr) return run_mixture(job, in, out, threads);
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
