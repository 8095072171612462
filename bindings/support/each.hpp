// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Functions of numbers over numpy arrays, which are broadcast against each other.
#pragma once

#include <array>
#include <utility>

#include "support/arrays.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline::python {

using Array = py::array_t<double>;

inline std::vector<py::ssize_t> with_last(std::vector<py::ssize_t> shape, py::ssize_t last) {
  shape.push_back(last);
  return shape;
}

/// North and east of an array (..., 2), each (...).
inline std::array<DoubleArray, 2> components(const char* name, const DoubleArray& vectors) {
  require_shape(vectors.ndim() > 0 && vectors.shape(vectors.ndim() - 1) == 2, name, "(..., 2)",
                vectors);
  std::vector<py::ssize_t> shape = shape_of(vectors);
  shape.pop_back();
  std::array<DoubleArray, 2> parts{DoubleArray(shape), DoubleArray(shape)};
  for (py::ssize_t k = 0; k < parts[0].size(); ++k)
    for (std::size_t axis = 0; axis < 2; ++axis)
      parts[axis].mutable_data()[k] = vectors.data()[2 * k + py::ssize_t(axis)];
  return parts;
}

/// Arrays of one shape. Throws ValueError when there is none.
template <class... Arrays>
std::array<DoubleArray, sizeof...(Arrays)> broadcast(const Arrays&... arrays) {
  const py::list same = py::module_::import("numpy").attr("broadcast_arrays")(arrays...);
  std::array<DoubleArray, sizeof...(Arrays)> result;
  for (std::size_t k = 0; k < result.size(); ++k) result[k] = same[k].template cast<DoubleArray>();
  return result;
}

/// Calls `visit(index, numbers...)` for each place of broadcast arrays.
template <std::size_t N, class Visit>
void at_each(const std::array<DoubleArray, N>& arrays, Visit visit) {
  for (py::ssize_t k = 0; k < arrays[0].size(); ++k)
    [&]<std::size_t... I>(std::index_sequence<I...>) { visit(k, arrays[I].data()[k]...); }
  (std::make_index_sequence<N>{});
}

/// f of numbers, which gives a number, over arrays.
template <class F, class... Arrays>
Array each(F f, const Arrays&... arrays) {
  const auto same = broadcast(arrays...);
  Array result(shape_of(same[0]));
  at_each(same, [&](py::ssize_t k, auto... x) { result.mutable_data()[k] = f(x...); });
  return result;
}

/// f of numbers, which gives [north, east], over arrays: (..., 2).
template <class F, class... Arrays>
Array each_vector(F f, const Arrays&... arrays) {
  const auto same = broadcast(arrays...);
  Array result(with_last(shape_of(same[0]), 2));
  at_each(same, [&](py::ssize_t k, auto... x) {
    const Vec<double, 2> vector = f(x...);
    result.mutable_data()[2 * k] = vector[0];
    result.mutable_data()[2 * k + 1] = vector[1];
  });
  return result;
}

/// f of numbers, which gives an array of `Count` of them, over arrays: as many arrays.
template <std::size_t Count, class F, class... Arrays>
std::array<Array, Count> each_of(F f, const Arrays&... arrays) {
  const auto same = broadcast(arrays...);
  std::array<Array, Count> result;
  for (Array& array : result) array = Array(shape_of(same[0]));
  at_each(same, [&](py::ssize_t k, auto... x) {
    const std::array<double, Count> values = f(x...);
    for (std::size_t i = 0; i < Count; ++i) result[i].mutable_data()[k] = values[i];
  });
  return result;
}

}  // namespace wakeline::python
