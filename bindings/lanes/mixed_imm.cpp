// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <span>
#include <type_traits>
#include <vector>

#include "job.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/variant_bank.hpp"

namespace wakeline::python {
namespace {

/// Models of a bank; more are run one recording after the other.
constexpr int kMostModels = 6;

template <class Filter>
Filter filter_of(const typename Filter::Motion& motion, const LaneModel& model) {
  if constexpr (std::is_constructible_v<Filter, const typename Filter::Motion&, const Unscented&>)
    return Filter(motion, model.transform);
  else
    return Filter(motion);
}

/// Runs the job over filters of these kinds; false where some are of none of them.
template <class... Filters>
bool run_over(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  using Bank = VariantBank<kMostModels, Filters...>;
  if (out.states != Bank::kComponents.size()) return false;
  std::vector<typename Bank::Filter> filters;
  for (const LaneModel& model : job.models) {
    const auto add = [&]<class Filter>(std::type_identity<Filter>) {
      const auto* motion = std::get_if<typename Filter::Motion>(&model.motion);
      constexpr bool unscented = !std::is_same_v<Filter, Ekf<typename Filter::Motion, Lanes>>;
      if (motion != nullptr && unscented == model.unscented)
        filters.push_back(filter_of<Filter>(*motion, model));
    };
    (add(std::type_identity<Filters>{}), ...);
  }
  if (filters.size() != job.models.size() || filters.size() > kMostModels) return false;
  return run_begun(Imm<Bank>{*job.chain, Bank(filters)}, job, in, out, threads);
}

}  // namespace

bool run_mixed_imm(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  return run_over<Ekf<CoordinatedTurnRate, Lanes>, Ukf<CoordinatedTurnRate, Lanes>>(job, in, out,
                                                                                    threads) ||
         run_over<Ekf<ConstantAcceleration, Lanes>, Ukf<ConstantAcceleration, Lanes>,
                  Ekf<Singer, Lanes>, Ukf<Singer, Lanes>>(job, in, out, threads) ||
         run_over<Ekf<CoordinatedTurn, Lanes>, Ekf<WanderingCourse, Lanes>,
                  Ekf<CoordinatedTurnRate, Lanes>, Ekf<ConstantAcceleration, Lanes>,
                  Ekf<Singer, Lanes>, Ukf<CoordinatedTurn, Lanes>, Ukf<WanderingCourse, Lanes>,
                  Ukf<CoordinatedTurnRate, Lanes>, Ukf<ConstantAcceleration, Lanes>,
                  Ukf<Singer, Lanes>>(job, in, out, threads);
}

}  // namespace wakeline::python
