// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "wakeline/gating/run_labels.hpp"
#include "wakeline/gating/strobe_sums.hpp"

namespace wakeline::detail {

/// Joins runs of cells into echoes: two runs of consecutive sweeps belong to one echo when their
/// cells share an edge or a corner.
///
/// Sweeps are added in order. The runs of the first and of the last two sweeps are kept, and the
/// sums of every echo. No heap: a run without room in its row, or a new echo (or a branch that is
/// not yet connected with the rest) beyond `kCapacity`, is left out, and `full()` returns true.
template <int kCapacity>
class StrobeLabels {
 public:
  /// Starts the next sweep.
  void start_row() noexcept {
    ++row_;
    runs(row_).size = 0;
    if (row_ > 0) before_ = EarlierRuns(runs(row_ - 1).all());
  }

  /// Adds cells `first` to `last` of the sweep; runs are added in order of range.
  void add(int first, int last, const ClaimedSums& sums) noexcept {
    int echo = kNone;
    before_.for_each_connected(first, last, 0, [&](int label) { echo = join(echo, label); });
    if (echo == kNone) echo = open();
    Row& row = runs(row_);
    if (echo == kNone || row.size == kCapacity) {
      full_ = true;
      return;
    }
    at(echo).sums += sums;
    row.runs[static_cast<std::size_t>(row.size++)] = {first, last, echo};
  }

  /// Connects the last sweep with the first one, of a full circle.
  void close_circle() noexcept {
    EarlierRuns last(runs(row_).all());
    for (const LabelledRun& run : runs(0).all())
      last.for_each_connected(run.first, run.last, 0, [&](int label) { join(run.label, label); });
  }

  [[nodiscard]] bool full() const noexcept { return full_; }

  /// Number of labels in order of first appearance. Of an echo that appeared as several branches
  /// the first has the sums of all, and only that one `is_whole`.
  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] bool is_whole(int echo) const noexcept { return at(echo).root == echo; }
  [[nodiscard]] const ClaimedSums& sums(int echo) const noexcept { return at(echo).sums; }

 private:
  static constexpr int kNone = -1;

  struct Row {
    std::array<LabelledRun, static_cast<std::size_t>(kCapacity)> runs;
    int size = 0;
    [[nodiscard]] std::span<const LabelledRun> all() const noexcept {
      return {runs.data(), static_cast<std::size_t>(size)};
    }
  };

  struct Echo {
    int root;
    ClaimedSums sums;
  };

  /// Row 0 is kept; of the others the last two.
  Row& runs(int row) noexcept { return rows_[row == 0 ? 0U : 1U + std::size_t(row) % 2U]; }

  Echo& at(int echo) noexcept { return echoes_[static_cast<std::size_t>(echo)]; }
  [[nodiscard]] const Echo& at(int echo) const noexcept {
    return echoes_[static_cast<std::size_t>(echo)];
  }

  int open() noexcept {
    if (size_ == kCapacity) return kNone;
    at(size_) = {size_, {}};
    return size_++;
  }

  int root_of(int echo) noexcept {
    return find_root(echo, [this](int label) -> int& { return at(label).root; });
  }

  /// Joins two echoes under the earlier label, which is returned; `a` may be `kNone`.
  int join(int a, int b) noexcept {
    b = root_of(b);
    if (a == kNone) return b;
    a = root_of(a);
    const int to = std::min(a, b);
    const int from = std::max(a, b);
    if (to != from) {
      at(from).root = to;
      at(to).sums += at(from).sums;
    }
    return to;
  }

  std::array<Row, 3> rows_;
  EarlierRuns before_;
  std::array<Echo, static_cast<std::size_t>(kCapacity)> echoes_;
  int row_ = -1;
  int size_ = 0;
  bool full_ = false;
};

}  // namespace wakeline::detail
