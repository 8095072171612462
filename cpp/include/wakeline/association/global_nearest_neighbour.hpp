// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "wakeline/association/assignment.hpp"
#include "wakeline/association/candidates.hpp"

namespace wakeline {

/// The optimal assignment on gated sparse costs: minimises, over all one-to-one pairings,
///
///     Σ cost(row, column) of the pairs + Σ unassigned_cost(row) of the other rows.
///
/// Columns have prices; a row prefers the column of least cost + price, or no column. Rows first
/// bid in turn, which raises the price of a contested column to the winner's point of indifference.
/// Rows still in conflict are then added by a shortest augmenting path (Dijkstra on reduced costs)
/// that ends at a free column or at a row that becomes unassigned. Prices and assignment satisfy
/// complementary slackness throughout, which proves optimality. Exact up to the rounding of sums of
/// costs; deterministic; ties are broken by the order of rows.
///
/// Sources: R. Jonker, A. Volgenant, A Shortest Augmenting Path Algorithm for Dense and Sparse
/// Linear Assignment Problems, Computing 38, 1987; D. P. Bertsekas, The Auction Algorithm, Annals
/// of Operations Research 14, 1988.
template <class Scalar = double>
class GlobalNearestNeighbour {
 public:
  /// Allocates all memory. Throws `std::invalid_argument` when a capacity is negative.
  GlobalNearestNeighbour(int row_capacity, int column_capacity)
      : assignment_(row_capacity, column_capacity),
        column_of_row_(static_cast<std::size_t>(row_capacity)),
        columns_(static_cast<std::size_t>(column_capacity)),
        visits_(static_cast<std::size_t>(column_capacity)) {
    waiting_rows_.reserve(static_cast<std::size_t>(row_capacity));
    frontier_.reserve(static_cast<std::size_t>(column_capacity));
    settled_columns_.reserve(static_cast<std::size_t>(column_capacity));
  }

  /// False, and an empty assignment, when the problem is larger than the capacities.
  [[nodiscard]] bool solve(const Candidates<Scalar>& candidates) noexcept {
    assignment_.clear(0, 0);
    if (!assignment_.fits(candidates.rows(), candidates.columns())) return false;
    assignment_.clear(candidates.rows(), candidates.columns());
    std::fill_n(columns_.begin(), candidates.columns(), Column{});
    waiting_rows_.clear();
    evictions_left_ = kEvictionsPerRow * candidates.rows();

    for (int row = 0; row < candidates.rows(); ++row) bid(candidates, row);
    if (!waiting_rows_.empty()) std::fill_n(visits_.begin(), candidates.columns(), Visit{});
    search_ = 0;
    for (const int row : waiting_rows_) augment(candidates, row);

    for (int row = 0; row < candidates.rows(); ++row) {
      const int column = column_of_row_[at(row)];
      if (column == kUnassigned)
        assignment_.leave_out(candidates.unassigned_cost(row));
      else
        assignment_.pair(row, column, columns_[at(column)].owner_cost);
    }
    return true;
  }

  /// The result of the last `solve`.
  [[nodiscard]] const Assignment<Scalar>& assignment() const noexcept { return assignment_; }

 private:
  /// A free column has price zero; an assigned one is among its row's cheapest choices.
  struct Column {
    Scalar price = Scalar(0);
    Scalar owner_cost = Scalar(0);
    int owner = kUnassigned;
  };

  /// How the current search reached a column.
  struct Visit {
    Scalar distance = Scalar(0);
    Scalar cost = Scalar(0);  // of the pair (from_row, this column)
    int from_row = kUnassigned;
    int search = 0;        // the search this belongs to
    int place = kSettled;  // index in the frontier
  };

  /// End of the shortest path found so far: a free column, or a row that becomes unassigned.
  struct PathEnd {
    Scalar distance;
    int row;
    int column;
  };

  static constexpr int kSettled = -1;
  static constexpr int kEvictionsPerRow = 8;  // on average, in the bidding stage

  static std::size_t at(int index) noexcept { return static_cast<std::size_t>(index); }

  void own(int row, int column, Scalar cost) noexcept {
    columns_[at(column)].owner = row;
    columns_[at(column)].owner_cost = cost;
    column_of_row_[at(row)] = column;
  }

  /// Assigns the row to its cheapest choice; the row evicted by that bids next. A row with a tie,
  /// or without evictions left (many rows competing for few columns), is left to `augment`.
  void bid(const Candidates<Scalar>& candidates, int row) noexcept {
    while (true) {
      const auto columns = candidates.columns_of(row);
      const auto costs = candidates.costs_of(row);
      Scalar best = candidates.unassigned_cost(row);
      Scalar second = best;
      int choice = kUnassigned;
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const Scalar reduced = costs[k] + columns_[at(columns[k])].price;
        choice = reduced < best ? static_cast<int>(k) : choice;
        second = std::min(second, std::max(best, reduced));
        best = std::min(best, reduced);
      }
      column_of_row_[at(row)] = kUnassigned;
      if (choice == kUnassigned) return;
      Column& column = columns_[at(columns[at(choice)])];
      const int evicted = column.owner;
      if (evicted != kUnassigned) {
        if (evictions_left_ == 0 || !(second > best)) break;
        --evictions_left_;
        column.price += second - best;
      }
      own(row, columns[at(choice)], costs[at(choice)]);
      if (evicted == kUnassigned) return;
      row = evicted;
    }
    waiting_rows_.push_back(row);
  }

  /// Adds one row by the shortest augmenting path and raises the prices of the columns settled on
  /// it.
  void augment(const Candidates<Scalar>& candidates, int row) noexcept {
    ++search_;
    frontier_.clear();
    settled_columns_.clear();
    PathEnd end{candidates.unassigned_cost(row), row, kUnassigned};
    reach_from(candidates, row, Scalar(0), end);
    while (!frontier_.empty()) {
      const int column = pop_nearest();
      const Scalar distance = visits_[at(column)].distance;
      if (!(distance < end.distance)) break;
      settled_columns_.push_back(column);
      const Column& owned = columns_[at(column)];
      const Scalar offset = distance - (owned.owner_cost + owned.price);
      const Scalar step_out = offset + candidates.unassigned_cost(owned.owner);
      if (step_out < end.distance) end = {step_out, owned.owner, kUnassigned};
      reach_from(candidates, owned.owner, offset, end);
    }
    for (const int column : settled_columns_)
      columns_[at(column)].price += end.distance - visits_[at(column)].distance;

    int column = end.column;
    if (column == kUnassigned) column = std::exchange(column_of_row_[at(end.row)], kUnassigned);
    while (column != kUnassigned) {
      const Visit& visit = visits_[at(column)];
      const int next = column_of_row_[at(visit.from_row)];
      own(visit.from_row, column, visit.cost);
      column = next;
    }
  }

  /// Relaxes the candidates of a row whose choices start at distance `offset` + cost + price.
  void reach_from(const Candidates<Scalar>& candidates, int row, Scalar offset,
                  PathEnd& end) noexcept {
    const auto columns = candidates.columns_of(row);
    const auto costs = candidates.costs_of(row);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const Column& column = columns_[at(columns[k])];
      const Scalar distance = offset + (costs[k] + column.price);
      if (!(distance < end.distance)) continue;
      Visit& visit = visits_[at(columns[k])];
      const bool seen = visit.search == search_;
      if (column.owner == kUnassigned) {
        visit = {distance, costs[k], row, search_, kSettled};
        end = {distance, row, columns[k]};
      } else if (!seen) {
        visit = {distance, costs[k], row, search_, static_cast<int>(frontier_.size())};
        frontier_.push_back(columns[k]);
        sift_up(visit.place);
      } else if (visit.place != kSettled && distance < visit.distance) {
        visit = {distance, costs[k], row, search_, visit.place};
        sift_up(visit.place);
      }
    }
  }

  // The frontier is a binary heap of columns by distance, ties by column; each visit stores its
  // index.

  [[nodiscard]] bool nearer(int a, int b) const noexcept {
    const Scalar& distance_a = visits_[at(a)].distance;
    const Scalar& distance_b = visits_[at(b)].distance;
    return distance_a < distance_b || (distance_a == distance_b && a < b);
  }

  void put(int place, int column) noexcept {
    frontier_[at(place)] = column;
    visits_[at(column)].place = place;
  }

  void sift_up(int place) noexcept {
    const int column = frontier_[at(place)];
    while (place > 0) {
      const int parent = (place - 1) / 2;
      if (!nearer(column, frontier_[at(parent)])) break;
      put(place, frontier_[at(parent)]);
      place = parent;
    }
    put(place, column);
  }

  int pop_nearest() noexcept {
    const int nearest = frontier_.front();
    visits_[at(nearest)].place = kSettled;
    const int column = frontier_.back();
    frontier_.pop_back();
    const int size = static_cast<int>(frontier_.size());
    if (size == 0) return nearest;
    int place = 0;
    for (int child = 1; child < size; child = 2 * place + 1) {
      if (child + 1 < size && nearer(frontier_[at(child + 1)], frontier_[at(child)])) ++child;
      if (!nearer(frontier_[at(child)], column)) break;
      put(place, frontier_[at(child)]);
      place = child;
    }
    put(place, column);
    return nearest;
  }

  Assignment<Scalar> assignment_;
  std::vector<int> column_of_row_;
  std::vector<Column> columns_;
  std::vector<Visit> visits_;
  std::vector<int> waiting_rows_;
  std::vector<int> frontier_;
  std::vector<int> settled_columns_;  // by the current search
  int evictions_left_ = 0;
  int search_ = 0;
};

}  // namespace wakeline
