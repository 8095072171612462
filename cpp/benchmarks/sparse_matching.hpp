// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What a user would write by hand for gated assignment: successive shortest augmenting paths over
// compressed rows, with the standard library's heap.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace wakeline::bench {

/// Costs of row r are `[start[r], start[r + 1])` of `column` and `cost`; a row may stay out at
/// `unassigned`.
struct SparseCosts {
  std::vector<int> start{0};
  std::vector<int> column;
  std::vector<double> cost;
  std::vector<double> unassigned;
  int columns = 0;
};

class SparseMatching {
 public:
  explicit SparseMatching(int size)
      : owner_(at(size)),
        column_of_row_(at(size)),
        price_(at(size)),
        from_(at(size)),
        distance_(at(size)),
        done_(at(size)) {}

  /// The least total cost.
  double solve(const SparseCosts& problem) {
    const int rows = static_cast<int>(problem.unassigned.size());
    std::fill(owner_.begin(), owner_.end(), -1);
    std::fill(column_of_row_.begin(), column_of_row_.end(), -1);
    std::fill(price_.begin(), price_.end(), 0.0);
    std::fill(distance_.begin(), distance_.end(), kFar);
    for (int row = 0; row < rows; ++row) augment(problem, row);
    double total = 0.0;
    for (int row = 0; row < rows; ++row) total += cost_of(problem, row);
    return total;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  using Reach = std::pair<double, int>;  // distance, column

  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  double cost_of(const SparseCosts& problem, int row) const {
    if (column_of_row_[at(row)] < 0) return problem.unassigned[at(row)];
    int k = problem.start[at(row)];
    while (problem.column[at(k)] != column_of_row_[at(row)]) ++k;
    return problem.cost[at(k)];
  }

  void augment(const SparseCosts& problem, int first_row) {
    heap_.clear();
    reached_.clear();
    settled_.clear();
    double end_distance = problem.unassigned[at(first_row)];
    int end_row = first_row, end_column = -1;
    int row = first_row;
    double offset = 0.0;
    while (true) {
      for (int k = problem.start[at(row)]; k < problem.start[at(row + 1)]; ++k) {
        const int column = problem.column[at(k)];
        const double distance = offset + problem.cost[at(k)] + price_[at(column)];
        if (done_[at(column)] || distance >= distance_[at(column)] || distance >= end_distance)
          continue;
        if (distance_[at(column)] == kFar) reached_.push_back(column);
        distance_[at(column)] = distance;
        from_[at(column)] = row;
        if (owner_[at(column)] < 0) {
          end_distance = distance;
          end_column = column;
        } else {
          heap_.emplace_back(distance, column);
          std::push_heap(heap_.begin(), heap_.end(), std::greater<Reach>());
        }
      }
      while (!heap_.empty() && heap_.front().first > distance_[at(heap_.front().second)]) pop();
      if (heap_.empty() || heap_.front().first >= end_distance) break;
      const int column = heap_.front().second;
      pop();
      settled_.push_back(column);
      done_[at(column)] = true;
      row = owner_[at(column)];
      offset = distance_[at(column)] - cost_of(problem, row) - price_[at(column)];
      if (offset + problem.unassigned[at(row)] < end_distance) {
        end_distance = offset + problem.unassigned[at(row)];
        end_row = row;
        end_column = -1;
      }
    }
    for (const int settled : settled_) {
      price_[at(settled)] += end_distance - distance_[at(settled)];
      done_[at(settled)] = false;
    }
    int column = end_column < 0 ? std::exchange(column_of_row_[at(end_row)], -1) : end_column;
    while (column >= 0) {
      owner_[at(column)] = from_[at(column)];
      column = std::exchange(column_of_row_[at(from_[at(column)])], column);
    }
    for (const int reached : reached_) distance_[at(reached)] = kFar;
  }

  void pop() {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<Reach>());
    heap_.pop_back();
  }

  std::vector<int> owner_;
  std::vector<int> column_of_row_;
  std::vector<double> price_;
  std::vector<int> from_;
  std::vector<double> distance_;
  std::vector<char> done_;
  std::vector<Reach> heap_;
  std::vector<int> reached_;
  std::vector<int> settled_;
};

}  // namespace wakeline::bench
