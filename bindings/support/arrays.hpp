// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The border between numpy arrays and Eigen, with errors that name the argument, the wanted and the
// given shape.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace wakeline::python {

namespace py = pybind11;

/// Anything numpy can take for an array of real numbers, row-major. Masked numbers are NaN, as a
/// missed reading is. Times, complex numbers and text are a TypeError: numpy would take them for
/// numbers.
class DoubleArray : public py::array_t<double, py::array::c_style | py::array::forcecast> {
 public:
  using Base = py::array_t<double, py::array::c_style | py::array::forcecast>;
  using Base::Base;
  DoubleArray() = default;
  DoubleArray(const py::object& numbers) : Base(filled(numbers)) {}

  /// Null, and no error set, for what is no array of numbers.
  static DoubleArray ensure(py::handle numbers) {
    try {
      return argument(numbers);
    } catch (const Text&) {
      return py::reinterpret_steal<DoubleArray>(py::handle());
    }
  }

  /// The same, but for text, which is a TypeError that says so.
  static DoubleArray argument(py::handle numbers) {
    try {
      return py::reinterpret_steal<DoubleArray>(Base::ensure(filled(numbers)).release());
    } catch (const py::error_already_set&) {  // masked, but no numbers
      return py::reinterpret_steal<DoubleArray>(py::handle());
    }
  }

 private:
  struct Text : py::type_error {
    using type_error::type_error;
  };

  static py::object filled(py::handle numbers) {
    const auto& numpy = py::detail::npy_api::get();
    const bool plain = Py_TYPE(numbers.ptr()) == numpy.PyArray_Type_;
    if (plain || !numpy.PyArray_Check_(numbers.ptr()) || !py::hasattr(numbers, "filled")) {
      py::array array = real(py::array::ensure(numbers));
      return array && array.dtype().kind() == 'O' ? known(numbers, array) : array;
    }
    real(py::reinterpret_borrow<py::array>(numbers));
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    return numbers.attr("astype")(py::dtype::of<double>()).attr("filled")(kNaN);
  }

  /// Objects as numbers; what pandas does not know (NA) is NaN.
  static py::object known(py::handle numbers, const py::array& objects) {
    if (!py::hasattr(numbers, "to_numpy")) return objects;
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    return numbers.attr("to_numpy")(py::arg("dtype") = py::dtype::of<double>(),
                                    py::arg("na_value") = kNaN);
  }

  static py::array real(py::array numbers) {
    const char kind = numbers ? numbers.dtype().kind() : 'f';
    if (kind == 'M' || kind == 'm' || kind == 'c')
      throw py::type_error("an array must hold real numbers (times in seconds), got " +
                           py::str(numbers.dtype()).cast<std::string>());
    if (kind == 'U' || kind == 'S' || kind == 'O') reject_text(numbers);
    return numbers;
  }

  static void reject_text(const py::array& numbers) {
    for (const py::handle one : numbers.attr("flat"))
      if (py::isinstance<py::str>(one) || py::isinstance<py::bytes>(one))
        throw Text("an array must hold real numbers, got text such as " +
                   py::repr(py::str(one)).cast<std::string>());
  }
};

/// "(3, 2)".
inline std::string shape_text(const std::vector<py::ssize_t>& shape) {
  std::string text = "(";
  for (std::size_t k = 0; k < shape.size(); ++k) text += (k ? ", " : "") + std::to_string(shape[k]);
  return text + (shape.size() == 1 ? ",)" : ")");
}

inline std::vector<py::ssize_t> shape_of(const py::array& array) {
  return {array.shape(), array.shape() + array.ndim()};
}

/// Throws ValueError unless the condition holds: "z must have shape (T, 2), got (5,)".
inline void require_shape(bool condition, const std::string& name, const std::string& wanted,
                          const py::array& array) {
  if (!condition)
    throw py::value_error(name + " must have shape " + wanted + ", got " +
                          shape_text(shape_of(array)));
}

/// Numbers as a new numpy array.
inline py::array_t<double> array_of(std::span<const double> values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Any Eigen vector or matrix as a new numpy array.
template <class Derived>
py::array_t<double> to_array(const Eigen::MatrixBase<Derived>& matrix) {
  if constexpr (Derived::ColsAtCompileTime == 1) {
    py::array_t<double> array(matrix.rows());
    auto view = array.mutable_unchecked<1>();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) view(i) = matrix(i, 0);
    return array;
  } else {
    py::array_t<double> array({matrix.rows(), matrix.cols()});
    auto view = array.mutable_unchecked<2>();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) view(i, j) = matrix(i, j);
    return array;
  }
}

/// A numpy vector of a size that is known, without the heap.
template <int N>
Eigen::Matrix<double, N, 1> to_vector(const char* name, const DoubleArray& array) {
  if (array.ndim() != 1 || array.shape(0) != N) require_shape(false, name, shape_text({N}), array);
  return Eigen::Map<const Eigen::Matrix<double, N, 1>>(array.data());
}

/// A numpy vector; `size` of -1 takes any.
inline Eigen::VectorXd to_vector(const std::string& name, const DoubleArray& array,
                                 py::ssize_t size = -1) {
  require_shape(array.ndim() == 1 && (size < 0 || array.shape(0) == size), name,
                size < 0 ? "(N,)" : shape_text({size}), array);
  Eigen::VectorXd vector(array.shape(0));
  for (py::ssize_t i = 0; i < array.shape(0); ++i) vector[i] = array.at(i);
  return vector;
}

inline Eigen::MatrixXd to_matrix(const std::string& name, const DoubleArray& array,
                                 py::ssize_t rows, py::ssize_t cols) {
  require_shape(array.ndim() == 2 && array.shape(0) == rows && array.shape(1) == cols, name,
                shape_text({rows, cols}), array);
  Eigen::MatrixXd matrix(rows, cols);
  for (py::ssize_t i = 0; i < rows; ++i)
    for (py::ssize_t j = 0; j < cols; ++j) matrix(i, j) = array.at(i, j);
  return matrix;
}

}  // namespace wakeline::python

namespace pybind11::detail {

/// As that of its base, which does not know of masks.
template <>
struct pyobject_caster<wakeline::python::DoubleArray> {
  using type = wakeline::python::DoubleArray;

  bool load(handle numbers, bool convert) {
    if (!convert && !type::check_(numbers)) return false;
    value = type::argument(numbers);
    return static_cast<bool>(value);
  }
  static handle cast(const handle& array, return_value_policy, handle) { return array.inc_ref(); }
  PYBIND11_TYPE_CASTER(type, handle_type_name<type::Base>::name);
};

}  // namespace pybind11::detail
