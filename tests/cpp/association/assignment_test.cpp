// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "support/malloc_fence.hpp"
#include "wakeline/association/assign_dense.hpp"
#include "wakeline/association/candidates.hpp"
#include "wakeline/association/global_nearest_neighbour.hpp"
#include "wakeline/association/nearest_neighbour.hpp"

namespace wakeline::assignment_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// A sparse problem in the plainest form there is.
template <class Scalar>
struct Problem {
  int columns = 0;
  std::vector<Scalar> unassigned_cost;
  std::vector<std::vector<std::pair<int, Scalar>>> rows;

  Candidates<Scalar> candidates() const {
    Candidates<Scalar> result(static_cast<int>(rows.size()), 64 * static_cast<int>(rows.size()));
    fill(result);
    return result;
  }

  void fill(Candidates<Scalar>& result) const {
    result.clear(columns);
    for (std::size_t row = 0; row < rows.size(); ++row) {
      result.start_row(unassigned_cost[row]);
      for (const auto& [column, cost] : rows[row]) result.add(column, cost);
    }
  }
};

/// Costs are integers when `steps` is small, so that there are many ties and sums are exact.
template <class Scalar = double>
Problem<Scalar> draw_problem(int rows, int columns, double density, int steps,
                             std::mt19937_64& random) {
  std::bernoulli_distribution present(density);
  std::uniform_int_distribution<int> cost(-steps / 4, steps);
  Problem<Scalar> problem;
  problem.columns = columns;
  problem.rows.resize(at(rows));
  for (auto& row : problem.rows) {
    problem.unassigned_cost.push_back(static_cast<Scalar>(cost(random)));
    for (int column = 0; column < columns; ++column)
      if (present(random)) row.emplace_back(column, static_cast<Scalar>(cost(random)));
  }
  return problem;
}

/// The least cost by trying everything.
template <class Scalar>
double exhaustive_cost(const Problem<Scalar>& problem, std::size_t row, std::vector<bool>& used) {
  if (row == problem.rows.size()) return 0.0;
  double best = problem.unassigned_cost[row] + exhaustive_cost(problem, row + 1, used);
  for (const auto& [column, cost] : problem.rows[row]) {
    if (used[at(column)]) continue;
    used[at(column)] = true;
    best = std::min(best, cost + exhaustive_cost(problem, row + 1, used));
    used[at(column)] = false;
  }
  return best;
}

/// Partners are mutual, every pair is a candidate, and the cost is the sum it claims to be.
template <class Scalar>
void expect_sound(const Problem<Scalar>& problem, const Assignment<Scalar>& assignment) {
  ASSERT_EQ(assignment.column_of_row().size(), problem.rows.size());
  ASSERT_EQ(assignment.row_of_column().size(), at(problem.columns));
  double cost = 0.0;
  int pairs = 0;
  for (std::size_t row = 0; row < problem.rows.size(); ++row) {
    const int column = assignment.column_of_row()[row];
    if (column == kUnassigned) {
      cost += problem.unassigned_cost[row];
      continue;
    }
    ++pairs;
    ASSERT_EQ(assignment.row_of_column()[at(column)], static_cast<int>(row));
    const auto candidate = std::find_if(problem.rows[row].begin(), problem.rows[row].end(),
                                        [&](const auto& c) { return c.first == column; });
    ASSERT_NE(candidate, problem.rows[row].end());
    cost += candidate->second;
  }
  EXPECT_EQ(assignment.pairs(), pairs);
  EXPECT_EQ(std::count_if(assignment.row_of_column().begin(), assignment.row_of_column().end(),
                          [](int row) { return row != kUnassigned; }),
            pairs);
  EXPECT_NEAR(assignment.total_cost(), cost, 1e-5 * (1.0 + std::abs(cost)));
}

template <class Scalar>
Scalar optimal_cost(const Problem<Scalar>& problem) {
  GlobalNearestNeighbour<Scalar> solver(static_cast<int>(problem.rows.size()), problem.columns);
  EXPECT_TRUE(solver.solve(problem.candidates()));
  expect_sound(problem, solver.assignment());
  return solver.assignment().total_cost();
}

template <class Scalar>
class GlobalNearestNeighbourOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(GlobalNearestNeighbourOf, Scalars, );

TYPED_TEST(GlobalNearestNeighbourOf, IsOptimalOnSmallProblemsWithTiesAndEmptyRows) {
  std::mt19937_64 random(11);
  std::uniform_int_distribution<int> size(0, 6);
  for (int trial = 0; trial < 6000; ++trial) {
    const int rows = size(random);
    const int columns = size(random);
    const double density = 0.15 + 0.8 * (trial % 10) / 10.0;
    const int steps = trial % 3 == 0 ? 4 : 1000;
    const auto problem = draw_problem<TypeParam>(rows, columns, density, steps, random);
    std::vector<bool> used(at(columns));
    ASSERT_EQ(optimal_cost(problem), exhaustive_cost(problem, 0, used)) << "trial " << trial;
  }
}

/// The optimum by the Hungarian method on the dense problem in which each row has a column of its
/// own to stay out.
double hungarian_cost(const Problem<double>& problem) {
  const int rows = static_cast<int>(problem.rows.size());
  const int columns = problem.columns + rows;
  Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(rows, columns, 1e9);
  for (int row = 0; row < rows; ++row) {
    for (const auto& [column, value] : problem.rows[at(row)]) cost(row, column) = value;
    cost(row, problem.columns + row) = problem.unassigned_cost[at(row)];
  }
  std::vector<double> row_price(at(rows + 1));
  std::vector<double> column_price(at(columns + 1));
  std::vector<int> row_of(at(columns + 1));
  std::vector<int> way(at(columns + 1));
  for (int row = 1; row <= rows; ++row) {
    row_of[0] = row;
    int column = 0;
    std::vector<double> least(at(columns + 1), kInfinity);
    std::vector<bool> used(at(columns + 1));
    do {
      used[at(column)] = true;
      const int from = row_of[at(column)];
      double step = kInfinity;
      int next = 0;
      for (int j = 1; j <= columns; ++j) {
        if (used[at(j)]) continue;
        const double reduced = cost(from - 1, j - 1) - row_price[at(from)] - column_price[at(j)];
        if (reduced < least[at(j)]) {
          least[at(j)] = reduced;
          way[at(j)] = column;
        }
        if (least[at(j)] < step) {
          step = least[at(j)];
          next = j;
        }
      }
      for (int j = 0; j <= columns; ++j) {
        if (used[at(j)]) {
          row_price[at(row_of[at(j)])] += step;
          column_price[at(j)] -= step;
        } else {
          least[at(j)] -= step;
        }
      }
      column = next;
    } while (row_of[at(column)] != 0);
    while (column != 0) {
      row_of[at(column)] = row_of[at(way[at(column)])];
      column = way[at(column)];
    }
  }
  double sum = 0.0;
  for (int j = 1; j <= columns; ++j)
    if (row_of[at(j)] != 0) sum += cost(row_of[at(j)] - 1, j - 1);
  return sum;
}

TEST(GlobalNearestNeighbour, IsOptimalOnLargeProblemsOfEveryDensity) {
  std::mt19937_64 random(12);
  for (const int steps : {3, 50, 1'000'000})
    for (const double density : {0.01, 0.03, 0.1, 0.5, 1.0})
      for (const auto& [rows, columns] :
           {std::pair{60, 60}, std::pair{90, 40}, std::pair{40, 90}}) {
        const auto problem = draw_problem(rows, columns, density, steps, random);
        Candidates<double> candidates(rows, rows * columns);
        problem.fill(candidates);
        GlobalNearestNeighbour<double> solver(rows, columns);
        ASSERT_TRUE(solver.solve(candidates));
        expect_sound(problem, solver.assignment());
        EXPECT_EQ(solver.assignment().total_cost(), hungarian_cost(problem))
            << rows << " x " << columns << ", density " << density << ", steps " << steps;
      }
}

TEST(GlobalNearestNeighbour, SettlesTheBidWarOfManyRowsForFewColumns) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> cost(0.0, 1e-3);
  Problem<double> problem;
  problem.columns = 12;
  problem.rows.resize(40);
  problem.unassigned_cost.assign(40, 1e6);
  for (auto& row : problem.rows)
    for (int column = 0; column < problem.columns; ++column) row.emplace_back(column, cost(random));
  EXPECT_NEAR(optimal_cost(problem), hungarian_cost(problem), 1e-6);
}

TEST(GlobalNearestNeighbour, DoesNotDependOnTheOrderOfRowsAndColumns) {
  std::mt19937_64 random(14);
  for (int trial = 0; trial < 200; ++trial) {
    // Costs from a continuum: the optimum is unique.
    const auto problem = draw_problem(30, 25, 0.15, 1'000'000'000, random);
    std::vector<std::size_t> row_order(30);
    std::vector<int> column_order(25);
    std::iota(row_order.begin(), row_order.end(), 0);
    std::iota(column_order.begin(), column_order.end(), 0);
    std::shuffle(row_order.begin(), row_order.end(), random);
    std::shuffle(column_order.begin(), column_order.end(), random);
    Problem<double> shuffled;
    shuffled.columns = problem.columns;
    for (const std::size_t row : row_order) {
      shuffled.unassigned_cost.push_back(problem.unassigned_cost[row]);
      auto& target = shuffled.rows.emplace_back();
      for (const auto& [column, cost] : problem.rows[row])
        target.emplace_back(column_order[at(column)], cost);
      std::shuffle(target.begin(), target.end(), random);
    }
    GlobalNearestNeighbour<double> solver(30, 25);
    GlobalNearestNeighbour<double> shuffled_solver(30, 25);
    ASSERT_TRUE(solver.solve(problem.candidates()));
    ASSERT_TRUE(shuffled_solver.solve(shuffled.candidates()));
    EXPECT_EQ(solver.assignment().total_cost(), shuffled_solver.assignment().total_cost());
    for (std::size_t k = 0; k < row_order.size(); ++k) {
      const int column = solver.assignment().column_of_row()[row_order[k]];
      EXPECT_EQ(shuffled_solver.assignment().column_of_row()[k],
                column == kUnassigned ? kUnassigned : column_order[at(column)]);
    }
  }
}

TEST(GlobalNearestNeighbour, AUsedWorkspaceSolvesAsAFreshOneDoes) {
  std::mt19937_64 random(15);
  GlobalNearestNeighbour<double> used(40, 40);
  for (int trial = 0; trial < 300; ++trial) {
    const auto problem = draw_problem(1 + trial % 40, 1 + (7 * trial) % 40, 0.2, 5, random);
    GlobalNearestNeighbour<double> fresh(40, 40);
    ASSERT_TRUE(used.solve(problem.candidates()));
    ASSERT_TRUE(fresh.solve(problem.candidates()));
    EXPECT_TRUE(
        std::ranges::equal(used.assignment().column_of_row(), fresh.assignment().column_of_row()));
  }
}

TEST(GlobalNearestNeighbour, NeverCostsMoreThanNearestNeighbour) {
  std::mt19937_64 random(16);
  int better = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const auto problem = draw_problem(20, 20, 0.2, 1000, random);
    NearestNeighbour<double> greedy(20, 20, 20 * 64);
    ASSERT_TRUE(greedy.solve(problem.candidates()));
    expect_sound(problem, greedy.assignment());
    const double optimum = optimal_cost(problem);
    EXPECT_LE(optimum, greedy.assignment().total_cost());
    better += optimum < greedy.assignment().total_cost() ? 1 : 0;
  }
  EXPECT_GT(better, 250);
}

TEST(GlobalNearestNeighbour, KeepsTwoCrossingTracksApart) {
  // Greedy takes the pair of cost 0.5 and leaves the other track without a plot.
  Problem<double> problem;
  problem.columns = 2;
  problem.unassigned_cost = {9.0, 9.0};
  problem.rows = {{{0, 0.5}, {1, 3.0}}, {{0, 1.0}}};
  NearestNeighbour<double> greedy(2, 2, 3);
  GlobalNearestNeighbour<double> solver(2, 2);
  ASSERT_TRUE(greedy.solve(problem.candidates()));
  ASSERT_TRUE(solver.solve(problem.candidates()));
  EXPECT_EQ(greedy.assignment().column_of_row()[1], kUnassigned);
  EXPECT_EQ(solver.assignment().column_of_row()[0], 1);
  EXPECT_EQ(solver.assignment().column_of_row()[1], 0);
}

TEST(NearestNeighbour, TakesTheCheapestPairFirstAndTiesByRowThenColumn) {
  Problem<double> problem;
  problem.columns = 3;
  problem.unassigned_cost = {10.0, 10.0, 10.0};
  problem.rows = {{{2, 1.0}, {1, 1.0}}, {{1, 1.0}, {0, 10.0}}, {{2, 0.5}}};
  NearestNeighbour<double> greedy(3, 3, 8);
  ASSERT_TRUE(greedy.solve(problem.candidates()));
  const auto columns = greedy.assignment().column_of_row();
  EXPECT_EQ(columns[0], 1);
  EXPECT_EQ(columns[1], kUnassigned);  // column 0 costs as much as staying out
  EXPECT_EQ(columns[2], 2);
  EXPECT_EQ(greedy.assignment().total_cost(), 11.5);
}

TEST(Candidates, RejectWhatExceedsTheirCapacityAndStayValid) {
  Candidates<double> candidates(2, 3);
  candidates.clear(4);
  EXPECT_FALSE(candidates.add(0, 1.0)) << "no row is open";
  EXPECT_TRUE(candidates.start_row(5.0));
  EXPECT_TRUE(candidates.add(3, 1.0));
  EXPECT_FALSE(candidates.add(4, 1.0)) << "no such column";
  EXPECT_FALSE(candidates.add(-1, 1.0));
  EXPECT_FALSE(candidates.add(0, std::nan("")));
  EXPECT_FALSE(candidates.add(0, kInfinity));
  EXPECT_TRUE(candidates.add(0, 2.0));
  EXPECT_TRUE(candidates.start_row(5.0));
  EXPECT_TRUE(candidates.add(0, 1.5));
  EXPECT_FALSE(candidates.add(1, 1.5)) << "full";
  EXPECT_FALSE(candidates.start_row(5.0)) << "full";
  EXPECT_FALSE(candidates.add(1, 1.5)) << "a rejected row takes no candidates";
  EXPECT_EQ(candidates.rejected(), 8);
  EXPECT_EQ(candidates.rows(), 2);
  EXPECT_EQ(candidates.size(), 3);
  GlobalNearestNeighbour<double> solver(2, 4);
  ASSERT_TRUE(solver.solve(candidates));
  EXPECT_EQ(solver.assignment().total_cost(), 2.5);

  candidates.clear(1);
  EXPECT_EQ(candidates.size(), 0);
  EXPECT_EQ(candidates.rejected(), 0);
  EXPECT_FALSE(candidates.start_row(kInfinity));
  EXPECT_FALSE(candidates.add(0, 1.0));
  EXPECT_TRUE(candidates.start_row(1.0));
  EXPECT_TRUE(candidates.add(0, 0.5));
  ASSERT_TRUE(solver.solve(candidates));
  EXPECT_EQ(solver.assignment().column_of_row()[0], kUnassigned);
  EXPECT_EQ(solver.assignment().column_of_row()[1], 0);
}

TEST(Candidates, RejectNegativeCapacities) {
  EXPECT_THROW(Candidates<double>(-1, 1), std::invalid_argument);
  EXPECT_THROW(Candidates<double>(1, -1), std::invalid_argument);
  EXPECT_THROW((void)Candidates<double>::dense(100'000, 100'000), std::invalid_argument);
  EXPECT_THROW(GlobalNearestNeighbour<double>(-1, 1), std::invalid_argument);
  EXPECT_THROW(NearestNeighbour<double>(1, 1, -1), std::invalid_argument);
}

TEST(Assignment, SolversRejectAProblemBeyondTheirCapacity) {
  std::mt19937_64 random(17);
  const auto problem = draw_problem(5, 5, 1.0, 100, random);
  const auto candidates = problem.candidates();
  for (const auto& [rows, columns] : {std::pair{4, 5}, std::pair{5, 4}}) {
    GlobalNearestNeighbour<double> solver(rows, columns);
    NearestNeighbour<double> greedy(rows, columns, 100);
    EXPECT_FALSE(solver.solve(candidates));
    EXPECT_FALSE(greedy.solve(candidates));
    EXPECT_TRUE(solver.assignment().column_of_row().empty());
    EXPECT_TRUE(greedy.assignment().column_of_row().empty());
  }
  NearestNeighbour<double> few(5, 5, 24);
  EXPECT_FALSE(few.solve(candidates));
}

TEST(Assignment, SolvingTakesNoHeap) {
  std::mt19937_64 random(18);
  const auto problem = draw_problem(100, 100, 0.3, 20, random);
  Candidates<double> candidates(100, 100 * 100);
  GlobalNearestNeighbour<double> solver(100, 100);
  NearestNeighbour<double> greedy(100, 100, 100 * 100);
  DenseAssignment<double> dense(100, 100);
  const Eigen::MatrixXd cost = Eigen::MatrixXd::Random(100, 100);
  test::NoHeap fence;
  problem.fill(candidates);
  const bool solved = solver.solve(candidates) && greedy.solve(candidates) && dense.solve(cost);
  const long allocations = fence.allocations();
  EXPECT_TRUE(solved);
  EXPECT_EQ(allocations, 0);
}

/// Most pairs, then least cost, by trying everything.
std::pair<int, double> exhaustive_dense(const Eigen::MatrixXd& cost, int row,
                                        std::vector<bool>& used) {
  if (row == cost.rows()) return {0, 0.0};
  auto best = exhaustive_dense(cost, row + 1, used);
  for (int column = 0; column < cost.cols(); ++column) {
    if (used[at(column)] || !std::isfinite(cost(row, column))) continue;
    used[at(column)] = true;
    auto [pairs, sum] = exhaustive_dense(cost, row + 1, used);
    used[at(column)] = false;
    ++pairs;
    sum += cost(row, column);
    if (pairs > best.first || (pairs == best.first && sum < best.second)) best = {pairs, sum};
  }
  return best;
}

TEST(AssignDense, FindsMostPairsThenLeastCost) {
  std::mt19937_64 random(19);
  std::uniform_int_distribution<int> size(0, 5);
  std::uniform_int_distribution<int> element(-20, 60);
  for (int trial = 0; trial < 4000; ++trial) {
    const int rows = size(random);
    Eigen::MatrixXd cost(rows, size(random));
    for (double& value : cost.reshaped()) {
      const int drawn = element(random);
      value = drawn > 35 ? kInfinity : drawn;
    }
    std::vector<bool> used(at(static_cast<int>(cost.cols())));
    const auto [pairs, sum] = exhaustive_dense(cost, 0, used);
    const auto columns = assign_dense(cost);
    ASSERT_EQ(columns.size(), at(rows));
    int found_pairs = 0;
    double found_sum = 0.0;
    for (int row = 0; row < rows; ++row) {
      if (columns[at(row)] == kUnassigned) continue;
      ++found_pairs;
      found_sum += cost(row, columns[at(row)]);
    }
    ASSERT_EQ(found_pairs, pairs) << cost;
    ASSERT_EQ(found_sum, sum) << cost;
  }
}

/// A finite cost may be the largest number there is, which is how many mark a pair of last resort.
template <class Scalar>
void expect_the_largest_costs_are_taken() {
  constexpr Scalar kMost = std::numeric_limits<Scalar>::max();
  const std::vector<int> crossed{1, 0}, straight{0, 1};
  using Cost = Eigen::Matrix<Scalar, 2, 2>;
  EXPECT_EQ(assign_dense((Cost() << kMost, 1, 2, kMost).finished()), crossed);
  EXPECT_EQ(assign_dense((Cost() << kMost, -kMost, 0, kMost).finished()), crossed);
  EXPECT_EQ(assign_dense((Cost() << -kMost, 0, 0, -kMost).finished()), straight);
  EXPECT_EQ(assign_dense(Cost::Constant(kMost).eval()), straight);
}

TEST(AssignDense, TakesTheLargestNumbers) {
  expect_the_largest_costs_are_taken<double>();
  expect_the_largest_costs_are_taken<float>();
}

TEST(AssignDense, TreatsEqualCostsAndForbiddenRows) {
  EXPECT_EQ(assign_dense(Eigen::MatrixXd::Constant(3, 3, 7.0)).size(), 3u);
  EXPECT_EQ(assign_dense((Eigen::Matrix2i() << 9, 1, 1, 9).finished()), (std::vector{1, 0}));
  const auto forbidden = assign_dense(Eigen::MatrixXd::Constant(2, 3, kInfinity));
  EXPECT_EQ(forbidden, (std::vector<int>{kUnassigned, kUnassigned}));
  DenseAssignment<double> small(2, 2);
  EXPECT_FALSE(small.solve(Eigen::MatrixXd::Zero(3, 2)));
  EXPECT_TRUE(small.column_of_row().empty());
  EXPECT_FALSE(small.solve(Eigen::MatrixXd::Zero(2, 3)));
  EXPECT_TRUE(small.solve(Eigen::MatrixXd::Zero(2, 2)));
  EXPECT_EQ(small.pairs(), 2);
}

}  // namespace
}  // namespace wakeline::assignment_test
