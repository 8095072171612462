// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>
#include <vector>

#include "wakeline/association/candidates.hpp"
#include "wakeline/association/global_nearest_neighbour.hpp"

namespace wakeline {

/// Rectangular assignment on a dense cost matrix: the largest possible number of pairs and, among
/// these assignments, the least total cost.
///
/// An element that is not finite forbids its pair; a finite one is clamped to ±`kLargestCost`. An
/// unassigned row costs (min(rows, columns) + 1) times the spread of the finite costs, more than
/// any other choice can gain; the optimum is exact to about 1e-16 times that. For scoring and small
/// problems: memory grows with rows x columns.
template <class Scalar = double>
class DenseAssignment {
  static_assert(std::is_floating_point_v<Scalar>, "wakeline: costs are float or double");

 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  static constexpr Scalar kLargestCost = Scalar(1e30L);

  /// Allocates all memory. Throws `std::invalid_argument` when a capacity is negative.
  DenseAssignment(int row_capacity, int column_capacity)
      : candidates_(Candidates<Scalar>::dense(row_capacity, column_capacity)),
        solver_(row_capacity, column_capacity) {}

  /// False, and an empty assignment, when the matrix is larger than the capacities.
  [[nodiscard]] bool solve(const Eigen::Ref<const Matrix>& cost) noexcept {
    const int rows = static_cast<int>(cost.rows());
    const int columns = static_cast<int>(cost.cols());
    candidates_.clear(columns);
    if (rows > candidates_.row_capacity()) {
      (void)solver_.solve(candidates_);
      return false;
    }
    const auto clamped = [](Scalar element) {
      return std::isfinite(element) ? std::clamp(element, -kLargestCost, kLargestCost) : element;
    };
    Scalar least = kLargestCost;
    Scalar most = -kLargestCost;
    for (int column = 0; column < columns; ++column)
      for (int row = 0; row < rows; ++row) {
        const Scalar element = clamped(cost(row, column));
        if (!std::isfinite(element)) continue;
        least = std::min(least, element);
        most = std::max(most, element);
      }
    const Scalar more_than_pairs = static_cast<Scalar>(std::min(rows, columns) + 1);
    const Scalar spread = most > least ? most - least : Scalar(1);
    const Scalar unassigned_cost = more_than_pairs * spread;

    // The least cost is subtracted from all, which does not change the best assignment of a given
    // number of pairs.
    for (int row = 0; row < rows; ++row) {
      candidates_.start_row(unassigned_cost);
      for (int column = 0; column < columns; ++column)
        candidates_.add(column, clamped(cost(row, column)) - least);  // rejects non-finite costs
    }
    return solver_.solve(candidates_);
  }

  /// The column of each row, or `kUnassigned`.
  [[nodiscard]] std::span<const int> column_of_row() const noexcept {
    return solver_.assignment().column_of_row();
  }
  /// The row of each column, or `kUnassigned`.
  [[nodiscard]] std::span<const int> row_of_column() const noexcept {
    return solver_.assignment().row_of_column();
  }
  [[nodiscard]] int pairs() const noexcept { return solver_.assignment().pairs(); }

 private:
  Candidates<Scalar> candidates_;
  GlobalNearestNeighbour<Scalar> solver_;
};

/// The column of each row, or `kUnassigned`, by a `DenseAssignment` allocated for this call.
/// Integer costs are converted to `double`.
template <class Derived>
[[nodiscard]] std::vector<int> assign_dense(const Eigen::MatrixBase<Derived>& cost) {
  using Given = typename Derived::Scalar;
  using Scalar = std::conditional_t<std::is_integral_v<Given>, double, Given>;
  DenseAssignment<Scalar> assignment(static_cast<int>(cost.rows()), static_cast<int>(cost.cols()));
  const typename DenseAssignment<Scalar>::Matrix matrix = cost.template cast<Scalar>();
  if (!assignment.solve(matrix)) return {};
  const auto columns = assignment.column_of_row();
  return {columns.begin(), columns.end()};
}

}  // namespace wakeline
