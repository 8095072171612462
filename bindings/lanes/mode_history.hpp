// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A job of a ModeHistory, each kind of filter compiled in a file of few: what the compiler puts
// into one function depends on how much else is in its file.
#pragma once

#include "job.hpp"
#include "wakeline/multimodel/mode_history.hpp"

namespace wakeline::python {

/// Over one kind of filter. False, and nothing done, where some are of another.
template <class Filter>
bool run_history_of(const HistoryTree& tree, const LaneJob& job, const RunInput& in,
                    const RunOutput& out, int threads) {
  return all_over<typename Filter::Motion>(job, kFilterOf<Filter>) &&
         run_begun(ModeHistory(tree, *job.chain, bank_of<Filter>(job)), job, in, out, threads);
}

/// Over unscented or square-root filters.
bool run_unscented_history(const HistoryTree& tree, const LaneJob& job, const RunInput& in,
                           const RunOutput& out, int threads);

}  // namespace wakeline::python
