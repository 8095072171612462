// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

#include "wakeline/association/assignment.hpp"
#include "wakeline/association/candidates.hpp"

namespace wakeline {

/// Greedy assignment: repeatedly the cheapest remaining pair. Ties are broken by row, then by
/// column. A row is left unassigned when a pair would cost its unassigned cost or more.
///
/// Sorting dominates: O(n log n) for n candidates. Not optimal; `GlobalNearestNeighbour` is, and
/// never costs more.
template <class Scalar = double>
class NearestNeighbour {
 public:
  /// Allocates all memory. Throws `std::invalid_argument` when a capacity is negative.
  NearestNeighbour(int row_capacity, int column_capacity, int candidate_capacity)
      : assignment_(row_capacity, column_capacity) {
    require_not_negative("candidate_capacity", candidate_capacity);
    pairs_.resize(static_cast<std::size_t>(candidate_capacity));
  }

  /// False, and an empty assignment, when the problem is larger than the capacities.
  [[nodiscard]] bool solve(const Candidates<Scalar>& candidates) noexcept {
    assignment_.clear(0, 0);
    if (!assignment_.fits(candidates.rows(), candidates.columns()) ||
        static_cast<std::size_t>(candidates.size()) > pairs_.size())
      return false;
    assignment_.clear(candidates.rows(), candidates.columns());

    auto end = pairs_.begin();
    for (int row = 0; row < candidates.rows(); ++row) {
      const auto columns = candidates.columns_of(row);
      const auto costs = candidates.costs_of(row);
      for (std::size_t k = 0; k < columns.size(); ++k)
        if (costs[k] < candidates.unassigned_cost(row)) *end++ = {costs[k], row, columns[k]};
    }
    std::sort(pairs_.begin(), end, [](const Pair& a, const Pair& b) {
      return std::tie(a.cost, a.row, a.column) < std::tie(b.cost, b.row, b.column);
    });
    for (auto pair = pairs_.begin(); pair != end; ++pair)
      if (is_free(assignment_.column_of_row(), pair->row) &&
          is_free(assignment_.row_of_column(), pair->column))
        assignment_.pair(pair->row, pair->column, pair->cost);
    for (int row = 0; row < candidates.rows(); ++row)
      if (is_free(assignment_.column_of_row(), row))
        assignment_.leave_out(candidates.unassigned_cost(row));
    return true;
  }

  /// The result of the last `solve`.
  [[nodiscard]] const Assignment<Scalar>& assignment() const noexcept { return assignment_; }

 private:
  struct Pair {
    Scalar cost;
    int row;
    int column;
  };

  static bool is_free(std::span<const int> partner, int index) noexcept {
    return partner[static_cast<std::size_t>(index)] == kUnassigned;
  }

  Assignment<Scalar> assignment_;
  std::vector<Pair> pairs_;
};

}  // namespace wakeline
