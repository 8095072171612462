// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "wakeline/core/require.hpp"

namespace wakeline {

/// Marks a row or column without a partner.
inline constexpr int kUnassigned = -1;

/// A one-to-one assignment of rows (tracks) to columns (plots) and its cost. Memory is allocated in
/// the constructor only.
template <class Scalar = double>
class Assignment {
 public:
  /// Capacity for problems of up to this size. Throws `std::invalid_argument` when a capacity is
  /// negative.
  Assignment(int row_capacity, int column_capacity) {
    require_not_negative("row_capacity", row_capacity);
    require_not_negative("column_capacity", column_capacity);
    column_of_row_.resize(static_cast<std::size_t>(row_capacity));
    row_of_column_.resize(static_cast<std::size_t>(column_capacity));
  }

  [[nodiscard]] bool fits(int rows, int columns) const noexcept {
    return static_cast<std::size_t>(rows) <= column_of_row_.size() &&
           static_cast<std::size_t>(columns) <= row_of_column_.size();
  }

  /// Resets to every row and column unassigned, at cost zero. The size must fit.
  void clear(int rows, int columns) noexcept {
    rows_ = static_cast<std::size_t>(rows);
    columns_ = static_cast<std::size_t>(columns);
    std::fill_n(column_of_row_.begin(), rows, kUnassigned);
    std::fill_n(row_of_column_.begin(), columns, kUnassigned);
    pairs_ = 0;
    pair_cost_ = Scalar(0);
    unassigned_cost_ = Scalar(0);
  }

  /// Assigns a free row to a free column.
  void pair(int row, int column, Scalar cost) noexcept {
    column_of_row_[static_cast<std::size_t>(row)] = column;
    row_of_column_[static_cast<std::size_t>(column)] = row;
    pair_cost_ += cost;
    ++pairs_;
  }

  /// Adds the cost of a row that stays unassigned.
  void leave_out(Scalar cost) noexcept { unassigned_cost_ += cost; }

  /// The column of each row, or `kUnassigned`.
  [[nodiscard]] std::span<const int> column_of_row() const noexcept {
    return {column_of_row_.data(), rows_};
  }
  /// The row of each column, or `kUnassigned`.
  [[nodiscard]] std::span<const int> row_of_column() const noexcept {
    return {row_of_column_.data(), columns_};
  }
  [[nodiscard]] int pairs() const noexcept { return pairs_; }
  /// Cost of the assigned pairs only.
  [[nodiscard]] Scalar pair_cost() const noexcept { return pair_cost_; }
  /// Cost of the pairs plus the unassigned costs of the other rows.
  [[nodiscard]] Scalar total_cost() const noexcept { return pair_cost_ + unassigned_cost_; }

 private:
  std::vector<int> column_of_row_;
  std::vector<int> row_of_column_;
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
  int pairs_ = 0;
  Scalar pair_cost_ = Scalar(0);
  Scalar unassigned_cost_ = Scalar(0);
};

}  // namespace wakeline
