// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Connected-component labelling of the cells of a radar picture, sweep by sweep, shared by the
// strobe and the plot extractor. They differ in the sums over the cells of an echo and in when an
// echo is complete: a strobe is evaluated at once on the stack, video is streamed.
#pragma once

#include "wakeline/core/environment.hpp"

#include <span>

namespace wakeline::detail {

/// Cells `first` to `last` of a sweep and the label of their echo.
struct LabelledRun {
  int first;
  int last;
  int label;
};

/// The runs of an earlier sweep, to compare with those of the present one. Both are in order of
/// range; the comparison is linear in the number of runs.
class EarlierRuns {
 public:
  EarlierRuns() = default;
  explicit EarlierRuns(std::span<const LabelledRun> runs) noexcept
      : at_(runs.data()), end_(runs.data() + runs.size()) {}

  /// Calls `visit(label)` for every earlier run that is connected with cells `first` to `last`: at
  /// most `gap_cells` cells are between them; with 0, cells that share an edge or a corner.
  template <class Visit>
  void for_each_connected(int first, int last, int gap_cells, const Visit& visit) noexcept {
    const int reach = gap_cells + 1;
    while (at_ != end_ && at_->last + reach < first) ++at_;
    for (const LabelledRun* run = at_; run != end_ && run->first - reach <= last; ++run)
      visit(run->label);
  }

 private:
  const LabelledRun* at_ = nullptr;
  const LabelledRun* end_ = nullptr;
};

/// The root of a label in a union-find with parents `int& parent(label)`; halves the path.
template <class Parent>
int find_root(int label, const Parent& parent) noexcept {
  while (parent(label) != label) label = parent(label) = parent(parent(label));
  return label;
}

}  // namespace wakeline::detail
