// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "wakeline/core/require.hpp"

namespace wakeline {

/// The plots that each track may be associated with, and at what cost: a sparse matrix of gated
/// costs in compressed rows.
///
/// A row is a track, a column a plot. Costs may have any sign; only their differences to the row's
/// unassigned cost matter (NIS + ln det S against the gate threshold, or a negative log-likelihood
/// ratio against 0).
///
///     candidates.clear(plot_count);
///     for each track: candidates.start_row(cost_of_a_miss);
///                     for each plot in its gate: candidates.add(plot, cost);
///
/// All memory is allocated in the constructor. When a capacity is used up, further candidates are
/// rejected with `false` and counted in `rejected()`; the smaller problem remains valid.
template <class Scalar = double>
class Candidates {
 public:
  /// Capacity for this many rows and candidates. Throws `std::invalid_argument` when one is
  /// negative.
  Candidates(int row_capacity, int candidate_capacity) {
    require_not_negative("row_capacity", row_capacity);
    require_not_negative("candidate_capacity", candidate_capacity);
    row_start_.resize(static_cast<std::size_t>(row_capacity) + 1);
    unassigned_cost_.resize(static_cast<std::size_t>(row_capacity));
    column_.resize(static_cast<std::size_t>(candidate_capacity));
    cost_.resize(static_cast<std::size_t>(candidate_capacity));
  }

  /// Capacity for every pair of this many rows and columns. Throws `std::invalid_argument` when one
  /// is negative or there are more pairs than an `int` can count.
  [[nodiscard]] static Candidates dense(int row_capacity, int column_capacity) {
    require_not_negative("row_capacity", row_capacity);
    require_not_negative("column_capacity", column_capacity);
    const double pairs = static_cast<double>(row_capacity) * column_capacity;
    require(pairs <= std::numeric_limits<int>::max(), "row_capacity * column_capacity", "an int",
            pairs);
    return Candidates(row_capacity, row_capacity * column_capacity);
  }

  /// Removes all rows; the rows added next choose from columns 0 .. columns - 1.
  void clear(int columns) noexcept {
    columns_ = columns > 0 ? columns : 0;
    rows_ = 0;
    rejected_ = 0;
    open_ = false;
  }

  /// Starts the next row, which may stay without a column at this cost.
  ///
  /// False when the row capacity is used up (the row is not added) or when the cost is not finite
  /// (the row is added but stays empty); candidates are then rejected until the next row.
  bool start_row(Scalar unassigned_cost) noexcept {
    using std::isfinite;
    if (rows_ == row_capacity()) {
      open_ = false;
      ++rejected_;
      return false;
    }
    open_ = isfinite(unassigned_cost);
    unassigned_cost_[at(rows_)] = open_ ? unassigned_cost : Scalar(0);
    row_start_[at(rows_ + 1)] = row_start_[at(rows_)];
    ++rows_;
    return open_;
  }

  /// Adds a candidate to the current row; each column at most once per row, in any order.
  ///
  /// False, and nothing added, when the candidate capacity is used up, there is no current row, the
  /// column is out of range or the cost is not finite.
  bool add(int column, Scalar cost) noexcept {
    using std::isfinite;
    if (!open_ || size() == candidate_capacity() || column < 0 || column >= columns_ ||
        !isfinite(cost)) {
      ++rejected_;
      return false;
    }
    int& end = row_start_[at(rows_)];
    column_[at(end)] = column;
    cost_[at(end)] = cost;
    ++end;
    return true;
  }

  [[nodiscard]] int rows() const noexcept { return rows_; }
  [[nodiscard]] int columns() const noexcept { return columns_; }
  /// Number of candidates in all rows.
  [[nodiscard]] int size() const noexcept { return row_start_[at(rows_)]; }
  /// Number of rows and candidates rejected since `clear`.
  [[nodiscard]] int rejected() const noexcept { return rejected_; }
  [[nodiscard]] int row_capacity() const noexcept {
    return static_cast<int>(unassigned_cost_.size());
  }
  [[nodiscard]] int candidate_capacity() const noexcept { return static_cast<int>(cost_.size()); }

  /// Cost of leaving the row without a column.
  [[nodiscard]] Scalar unassigned_cost(int row) const noexcept { return unassigned_cost_[at(row)]; }

  /// The row's candidate columns, in the order of `add`.
  [[nodiscard]] std::span<const int> columns_of(int row) const noexcept {
    return {column_.data() + row_start_[at(row)], length(row)};
  }

  /// The costs of the row's candidates, in the same order.
  [[nodiscard]] std::span<const Scalar> costs_of(int row) const noexcept {
    return {cost_.data() + row_start_[at(row)], length(row)};
  }

 private:
  static std::size_t at(int index) noexcept { return static_cast<std::size_t>(index); }
  [[nodiscard]] std::size_t length(int row) const noexcept {
    return at(row_start_[at(row + 1)] - row_start_[at(row)]);
  }

  std::vector<int> row_start_;  // row r is [row_start_[r], row_start_[r + 1])
  std::vector<Scalar> unassigned_cost_;
  std::vector<int> column_;
  std::vector<Scalar> cost_;
  int rows_ = 0;
  int columns_ = 0;
  int rejected_ = 0;
  bool open_ = false;
};

}  // namespace wakeline
