// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <span>
#include <type_traits>
#include <vector>

#include "job.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/variant_bank.hpp"

namespace wakeline::python {
namespace {

/// Models of a bank; more are run one recording after the other.
constexpr int kMostModels = 6;

template <class>
inline constexpr LaneFilter kFilterOf = LaneFilter::kExtended;
template <class Motion>
inline constexpr LaneFilter kFilterOf<Ukf<Motion, Lanes>> = LaneFilter::kUnscented;
template <class Motion>
inline constexpr LaneFilter kFilterOf<SquareRootUkf<Motion, Lanes>> = LaneFilter::kSquareRoot;

template <class Filter>
Filter filter_of(const typename Filter::Motion& motion, const LaneModel& model) {
  if constexpr (kFilterOf<Filter> == LaneFilter::kExtended)
    return Filter(motion);
  else
    return Filter(motion, model.transform);
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
      if (motion != nullptr && model.filter == kFilterOf<Filter>)
        filters.push_back(filter_of<Filter>(*motion, model));
    };
    (add(std::type_identity<Filters>{}), ...);
  }
  if (filters.size() != job.models.size() || filters.size() > kMostModels) return false;
  return run_begun(Imm<Bank>{*job.chain, Bank(filters)}, job, in, out, threads);
}

}  // namespace

bool run_mixed_imm(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  const auto run_filters_over = [&]<class... Motions>(std::type_identity<Motions>...) {
    return run_over<Ekf<Motions, Lanes>..., Ukf<Motions, Lanes>...,
                    SquareRootUkf<Motions, Lanes>...>(job, in, out, threads);
  };
  constexpr std::type_identity<CoordinatedTurnRate> kTurnRate;
  constexpr std::type_identity<ConstantAcceleration> kAcceleration;
  constexpr std::type_identity<Singer> kSinger;
  return run_filters_over(kTurnRate) || run_filters_over(kAcceleration, kSinger) ||
         run_filters_over(std::type_identity<CoordinatedTurn>{},
                          std::type_identity<WanderingCourse>{}, kTurnRate, kAcceleration, kSinger);
}

}  // namespace wakeline::python
