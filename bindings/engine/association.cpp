// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/association/assign_dense.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "support/types.hpp"
#include "wakeline/core/require.hpp"

namespace wakeline::python {
namespace {

/// Throws ValueError on numbers that are not whole.
void require_whole(const char* name, const DoubleArray& numbers) {
  for (py::ssize_t k = 0; k < numbers.size(); ++k)
    require(std::floor(numbers.data()[k]) == numbers.data()[k], name, "whole numbers",
            numbers.data()[k]);
}

/// Throws ValueError unless a cost is a number or forbids its pair.
void require_cost(const char* name, double cost) {
  require(cost > -std::numeric_limits<double>::infinity(), name,
          "numbers, or inf where a pair is forbidden", cost);
}

/// The pairs (row, column) of the rows that have a column.
py::array_t<std::int64_t> pairs_of(std::span<const int> column_of_row, int count) {
  py::array_t<std::int64_t> result({py::ssize_t{count}, py::ssize_t{2}});
  std::int64_t* pair = result.mutable_data();
  for (std::size_t row = 0; row < column_of_row.size(); ++row) {
    if (column_of_row[row] == kUnassigned) continue;
    *pair++ = static_cast<std::int64_t>(row);
    *pair++ = column_of_row[row];
  }
  return result;
}

/// The pairs (row, column) of an assignment, by row.
py::array_t<std::int64_t> assign(const DoubleArray& cost) {
  require_shape(cost.ndim() == 2, "cost", "(rows, columns)", cost);
  const Eigen::MatrixXd matrix = to_matrix("cost", cost, cost.shape(0), cost.shape(1));
  for (const double element : matrix.reshaped()) require_cost("cost", element);
  const std::vector<int> columns = matrix.size() > 0 ? assign_dense(matrix) : std::vector<int>{};
  const auto pairs = static_cast<int>(columns.size()) -
                     static_cast<int>(std::count(columns.begin(), columns.end(), kUnassigned));
  return pairs_of(columns, pairs);
}

/// Fills candidates from compressed rows; throws where these are none.
Candidates<double> to_candidates(const DoubleArray& indptr, const DoubleArray& indices,
                                 const DoubleArray& data, const DoubleArray& unassigned_cost,
                                 int columns) {
  const py::ssize_t rows = indptr.shape(0) - 1;
  Candidates<double> candidates(static_cast<int>(rows), static_cast<int>(data.shape(0)));
  candidates.clear(columns);
  require_whole("indptr", indptr);
  require_whole("indices", indices);
  const double* start = indptr.data();
  if (start[0] != 0.0 || start[rows] != static_cast<double>(data.shape(0)) ||
      !std::is_sorted(start, start + rows + 1))
    throw py::value_error("indptr must rise from 0 to the number of costs");
  for (py::ssize_t row = 0; row < rows; ++row) {
    const double out = unassigned_cost.data()[unassigned_cost.ndim() == 0 ? 0 : row];
    require_finite("unassigned_cost", out);
    candidates.start_row(out);
    for (auto k = static_cast<py::ssize_t>(start[row]);
         k < static_cast<py::ssize_t>(start[row + 1]); ++k) {
      const double cost = data.data()[k];
      require_cost("data", cost);
      const double column = indices.data()[k];
      require(column >= 0.0 && column < columns, "indices", "0 to columns - 1", column);
      if (std::isfinite(cost)) candidates.add(static_cast<int>(column), cost);
    }
  }
  return candidates;
}

py::array_t<std::int64_t> assign_sparse(const DoubleArray& indptr, const DoubleArray& indices,
                                        const DoubleArray& data, const DoubleArray& unassigned_cost,
                                        int columns) {
  require_shape(indptr.ndim() == 1 && indptr.shape(0) > 0, "indptr", "(rows + 1,)", indptr);
  require_shape(data.ndim() == 1, "data", "(candidates,)", data);
  require_shape(indices.ndim() == 1 && indices.shape(0) == data.shape(0), "indices",
                shape_text({data.shape(0)}), indices);
  require_shape(unassigned_cost.ndim() == 0 || (unassigned_cost.ndim() == 1 &&
                                                unassigned_cost.shape(0) == indptr.shape(0) - 1),
                "unassigned_cost", "() or (rows,)", unassigned_cost);
  if (columns < 0)
    throw py::value_error("columns must not be negative, got " + std::to_string(columns));
  const Candidates<double> candidates =
      to_candidates(indptr, indices, data, unassigned_cost, columns);
  GlobalNearestNeighbour<double> solver(candidates.rows(), columns);
  (void)solver.solve(candidates);
  return pairs_of(solver.assignment().column_of_row(), solver.assignment().pairs());
}

}  // namespace

void define_association(py::module_& parent) {
  py::module_ m = parent.def_submodule("association", "Assignment of plots to tracks.");
  m.def("assign", &assign, py::arg("cost"), R"(Optimal one-to-one assignment.

Parameters
----------
cost : (rows, columns) array
    Any finite costs; inf forbids a pair.

Returns
-------
(pairs, 2) int array
    Row and column of each pair, by row: the most pairs possible, at the least total cost.)");
  m.def("assign_sparse", &assign_sparse, py::arg("indptr"), py::arg("indices"), py::arg("data"),
        py::kw_only(), py::arg("unassigned_cost"), py::arg("columns"),
        R"(Optimal one-to-one assignment of gated pairs.

Minimizes the costs of the pairs plus `unassigned_cost` of the unassigned rows. Pairs are given as
the compressed rows of a sparse matrix, as in `scipy.sparse.csr_array`; other pairs are forbidden.

Parameters
----------
indptr : (rows + 1,) int array
    Row r has the candidates `indptr[r]` to `indptr[r + 1] - 1`.
indices : (candidates,) int array
    Column of each candidate, at most once per row.
data : (candidates,) array
    Cost of each candidate, of any sign; inf forbids it.
unassigned_cost : float or (rows,) array
    Cost of an unassigned row.
columns : int

Returns
-------
(pairs, 2) int array
    Row and column of each pair, by row.)");
}

}  // namespace wakeline::python
