// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/association/assign_dense.hpp"

#include "types.hpp"

namespace wakeline::python {
namespace {

/// The pairs (row, column) of an assignment, by row.
py::array_t<std::int64_t> assign(const DoubleArray& cost) {
  require_shape(cost.ndim() == 2, "cost", "(rows, columns)", cost);
  const Eigen::MatrixXd matrix = to_matrix("cost", cost, cost.shape(0), cost.shape(1));
  for (const double element : matrix.reshaped())
    if (std::isnan(element))
      throw py::value_error("cost must not hold NaN; forbid a pair with inf");
  const std::vector<int> columns = matrix.size() > 0 ? assign_dense(matrix) : std::vector<int>{};
  py::ssize_t pairs = 0;
  for (const int column : columns) pairs += column != kUnassigned;
  py::array_t<std::int64_t> result({pairs, py::ssize_t{2}});
  auto view = result.mutable_unchecked<2>();
  py::ssize_t pair = 0;
  for (std::size_t row = 0; row < columns.size(); ++row) {
    if (columns[row] == kUnassigned) continue;
    view(pair, 0) = static_cast<std::int64_t>(row);
    view(pair++, 1) = columns[row];
  }
  return result;
}

}  // namespace

void define_association(py::module_& parent) {
  py::module_ m = parent.def_submodule("association", "Which plot is whose.");
  m.def("assign", &assign, py::arg("cost"), R"(Optimal one-to-one assignment.

Parameters
----------
cost : (rows, columns) array
    Any finite costs; inf forbids a pair.

Returns
-------
(pairs, 2) int array
    Row and column of each pair, by row: as many pairs as can be, then the least total cost.)");
}

}  // namespace wakeline::python
