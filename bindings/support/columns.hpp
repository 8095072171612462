// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Columns of tables: given by Python, and made of rows.
#pragma once

#include <algorithm>
#include <string>

#include "support/arrays.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline::python {

/// A column given as one number for all rows or one for each.
inline DoubleArray column(const char* name, const py::object& values, py::ssize_t rows) {
  const DoubleArray array = values.is_none() ? DoubleArray() : DoubleArray::ensure(values);
  if (!array || values.is_none())
    throw py::type_error(std::string(name) + " must be a number or an array, got " +
                         py::repr(values).cast<std::string>());
  if (array.ndim() == 0) {
    DoubleArray filled(rows);
    std::fill_n(filled.mutable_data(), rows, *array.data());
    return filled;
  }
  require_shape(array.ndim() == 1 && array.shape(0) == rows, name, shape_text({rows}), array);
  return array;
}

/// An array (n,) of what `value(row)` gives for each row.
template <class T, class Rows, class Value>
py::array_t<T> column_of(const Rows& rows, const Value& value) {
  py::array_t<T> column(static_cast<py::ssize_t>(rows.size()));
  T* to = column.mutable_data();
  for (const auto& row : rows) *to++ = value(row);
  return column;
}

/// The same (n, N) of vectors.
template <int N, class Rows, class Value>
py::array_t<double> vectors_of(const Rows& rows, const Value& value) {
  py::array_t<double> column({static_cast<py::ssize_t>(rows.size()), py::ssize_t{N}});
  double* to = column.mutable_data();
  for (const auto& row : rows) {
    const Vec<double, N> vector = value(row);
    to = std::copy_n(vector.data(), N, to);
  }
  return column;
}

/// The same (n, N, N) of matrices.
template <int N, class Rows, class Value>
py::array_t<double> matrices_of(const Rows& rows, const Value& value) {
  py::array_t<double> column(
      {static_cast<py::ssize_t>(rows.size()), py::ssize_t{N}, py::ssize_t{N}});
  double* to = column.mutable_data();
  for (const auto& row : rows) {
    Eigen::Map<Eigen::Matrix<double, N, N, Eigen::RowMajor>> matrix(to);
    matrix = value(row);
    to += N * N;
  }
  return column;
}

}  // namespace wakeline::python
