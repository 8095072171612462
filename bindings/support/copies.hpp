// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// How objects are copied, and kept as bytes.
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wakeline/core/archive.hpp"

namespace wakeline::python {

namespace py = pybind11;

inline py::bytes to_bytes(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline std::span<const std::byte> bytes_of(const py::bytes& bytes) {
  const std::string_view text = bytes;
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

/// A value that lists its state for an archive.
template <class Value>
concept Archived = requires(Value& value, Archive& fields) {
  value.archive(fields);
};

/// Of the class that was bound, not one derived from it in Python, which the engine knows nothing
/// of.
template <class Value>
const Value& exactly(const py::object& one) {
  const py::handle kind = py::type::handle_of(one);
  if (!kind.is(py::type::of<Value>()))
    throw py::type_error(py::cast<std::string>(kind.attr("__name__")) +
                         " is derived in Python: define __copy__, __deepcopy__ and __reduce_ex__");
  return one.cast<const Value&>();
}

/// The state of a value, behind the text of the call that makes an equal one.
template <class Value>
void archive(Archive& fields, std::vector<char>& call, Value& value) {
  constexpr std::size_t kLongest = 1 << 20;
  fields(call, kLongest);
  value.archive(fields);
}

inline std::vector<char> call_of(const py::object& one) {
  const std::string text = py::repr(one);
  return {text.begin(), text.end()};
}

/// Adds what `copy.copy` and `copy.deepcopy` ask for; `save` and `restore` where there is a state.
///
/// What can be copied can be pickled: as the call that makes an equal one, which is its `repr`, and
/// its state (`wakeline/_pickling.py`).
template <class Value, class... Options>
void define_copies(py::class_<Value, Options...>& value) {
  value.def("__copy__", [](const py::object& one) { return Value(exactly<Value>(one)); })
      .def(
          "__deepcopy__",
          [](const py::object& one, const py::dict&) { return Value(exactly<Value>(one)); },
          py::arg("memo"));
  if constexpr (Archived<Value>)
    value
        .def(
            "save",
            [](const py::object& one) {
              Archive fields;
              std::vector<char> call = call_of(one);
              Value copy = one.cast<const Value&>();
              archive(fields, call, copy);
              return to_bytes(fields.bytes());
            },
            "What it knows as bytes, for one that is made alike, on the same kind of machine.")
        .def(
            "restore",
            [](const py::object& one, const py::bytes& state) {
              Archive fields(bytes_of(state));
              std::vector<char> call;
              Value restored = one.cast<const Value&>();
              archive(fields, call, restored);
              if (!fields.ok() || !fields.at_end() || call != call_of(one))
                throw py::value_error("state is not that of one that is made alike");
              one.cast<Value&>() = restored;
            },
            py::arg("state"), "Goes on bit for bit where the saved one was.");
}

/// Adds what `pickle` asks for, and so `copy`: of a plain result, its fields in order.
template <class Value, class... Options, class... Field>
void define_pickle(py::class_<Value, Options...>& value, Field Value::*... field) {
  value.def(py::pickle([field...](const Value& one) { return py::make_tuple(one.*field...); },
                       [field...](const py::tuple& fields) {
                         if (fields.size() != sizeof...(field))
                           throw py::value_error("state is not that of such a result");
                         Value one;
                         std::size_t k = 0;
                         ((one.*field = fields[k++].cast<Field>()), ...);
                         return one;
                       }));
}

}  // namespace wakeline::python
