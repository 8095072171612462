// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "wakeline/gating/strobe_sums.hpp"

namespace wakeline::detail {

/// Runs of neighbouring cells joined to echoes: two runs of neighbouring sweeps belong together
/// when their cells touch, be it at a corner.
///
/// Rows come in the order of sweeps; of runs only the first row and the last two are kept, of
/// echoes the sums. No heap: when there is no room for another run of a row, or for another echo
/// (or branch of one that has not met the rest yet), it is left out and `full()` says so.
template <int kCapacity>
class StrobeLabels {
 public:
  /// What comes now is of the next sweep.
  void start_row() noexcept {
    ++row_;
    runs(row_).size = 0;
  }

  /// Cells `first` to `last` of the sweep, beyond those that came before.
  void add(int first, int last, const StrobeSums& sums) noexcept {
    int echo = kNone;
    if (row_ > 0) {
      const Row& before = runs(row_ - 1);
      for (int k = 0; k < before.size; ++k)
        if (touch(before[k], first, last)) echo = join(echo, before[k].echo);
    }
    if (echo == kNone) echo = open();
    Row& row = runs(row_);
    if (echo == kNone || row.size == kCapacity) {
      full_ = true;
      return;
    }
    at(echo).sums += sums;
    row[row.size++] = {first, last, echo};
  }

  /// The last row lies beside the first one.
  void close_circle() noexcept {
    const Row& top = runs(0);
    const Row& bottom = runs(row_);
    for (int a = 0; a < top.size; ++a)
      for (int b = 0; b < bottom.size; ++b)
        if (touch(top[a], bottom[b].first, bottom[b].last)) join(top[a].echo, bottom[b].echo);
  }

  [[nodiscard]] bool full() const noexcept { return full_; }

  /// Echoes, counted as they came; of one that came as several branches the first has all, and only
  /// it `is_whole`.
  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] bool is_whole(int echo) const noexcept { return at(echo).root == echo; }
  [[nodiscard]] const StrobeSums& sums(int echo) const noexcept { return at(echo).sums; }

 private:
  static constexpr int kNone = -1;

  struct Run {
    int first;
    int last;
    int echo;
  };

  struct Row {
    std::array<Run, static_cast<std::size_t>(kCapacity)> runs;
    int size = 0;
    Run& operator[](int k) noexcept { return runs[static_cast<std::size_t>(k)]; }
    const Run& operator[](int k) const noexcept { return runs[static_cast<std::size_t>(k)]; }
  };

  struct Echo {
    int root;
    StrobeSums sums;
  };

  static bool touch(const Run& run, int first, int last) noexcept {
    return run.first <= last + 1 && first <= run.last + 1;
  }

  /// The first row keeps its place, all others take turns.
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
    while (!is_whole(echo)) echo = at(echo).root = at(at(echo).root).root;
    return echo;
  }

  /// Makes two echoes one, the earlier; `a` may be none.
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
  std::array<Echo, static_cast<std::size_t>(kCapacity)> echoes_;
  int row_ = -1;
  int size_ = 0;
  bool full_ = false;
};

}  // namespace wakeline::detail
