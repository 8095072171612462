// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "job.hpp"

namespace wakeline::python {

bool run_history(const AnyModeHistory& any, const LaneRecordings& recordings) {
  return std::visit(
      [&]<class Filter>(const ModeHistory<Filter>& history) {
        if constexpr (kForPacks<typename Filter::Motion>) {
          using Packed =
              decltype(in_lanes(std::declval<Filter>(), std::declval<Filter>().motion()));
          std::vector<Packed> filters;
          history.bank().for_each([&](int, const Filter& filter) {
            filters.push_back(in_lanes(filter, filter.motion()));
          });
          ModeHistory packed(history.tree(), history.chain(),
                             UniformBank<Packed>(std::span<const Packed>(filters)));
          packed.set_initial_mode_probability(history.initial_mode_probability());
          return run_from<Filter::kStates>(packed, recordings);
        } else {
          return false;
        }
      },
      any.variant());
}

}  // namespace wakeline::python
