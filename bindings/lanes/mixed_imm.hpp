// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A job of an Imm over filters of different kinds.
#pragma once

#include <type_traits>
#include <vector>

#include "job.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/variant_bank.hpp"

namespace wakeline::python {

/// Runs the job over filters of these kinds. False, and nothing done, where some are of none of
/// them.
template <class Sensors, class... Filters>
bool run_mixed(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  using Bank = VariantBank<kMaxModes, Filters...>;
  if (out.states != Bank::kComponents.size()) return false;
  std::vector<typename Bank::Filter> filters;
  for (const LaneModel& model : job.models) {
    const auto add = [&]<class Filter>(std::type_identity<Filter>) {
      if (model.filter == kFilterOf<Filter> &&
          std::holds_alternative<typename Filter::Motion>(model.motion))
        filters.push_back(filter_of<Filter>(model));
    };
    (add(std::type_identity<Filters>{}), ...);
  }
  if (filters.size() != job.models.size()) return false;
  return run_begun<Sensors>(Imm<Bank>{*job.chain, Bank(filters)}, job, in, out, threads);
}

}  // namespace wakeline::python
