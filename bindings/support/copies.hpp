// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// How objects are copied, saved and pickled.
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <span>
#include <string_view>

#include "support/arguments.hpp"
#include "wakeline/core/archive.hpp"

namespace wakeline::python {

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

/// Adds `copy.copy`, `copy.deepcopy`, `pickle` and `repr` to a type whose method `_arguments`
/// returns `Arguments`; `save` and `restore` where there is a state.
template <class Value, class... Options>
void define_copies(py::class_<Value, Options...>& value) {
  const auto copy = [](const py::object& one) {
    engine_type(one);
    return Value(one.cast<const Value&>());
  };
  value.def("__copy__", copy)
      .def(
          "__deepcopy__", [copy](const py::object& one, const py::dict&) { return copy(one); },
          py::arg("memo"));
  define_arguments(value);
  if constexpr (Archived<Value>)
    value
        .def(
            "save",
            [](const py::object& one) {
              Archive fields;
              std::uint64_t parameters = fingerprint(one);
              fields(parameters);
              Value(one.cast<const Value&>()).archive(fields);
              return to_bytes(fields.bytes());
            },
            "Its state as bytes, for `restore` of one with the same parameters on the same kind "
            "of machine.")
        .def(
            "restore",
            [](const py::object& one, const py::bytes& state) {
              Archive fields(bytes_of(state));
              const std::uint64_t own_parameters = fingerprint(one);
              std::uint64_t parameters = own_parameters;
              fields(parameters);
              if (parameters != own_parameters)
                throw py::value_error("state was saved with different parameters");
              Value restored = one.cast<const Value&>();
              restored.archive(fields);
              if (!fields.ok() || !fields.at_end())
                throw py::value_error("state must be the bytes that save() returned");
              one.cast<Value&>() = restored;
            },
            py::arg("state"),
            "Continues bit for bit where the saved one was. Raises ValueError, and changes "
            "nothing, when the state was saved with different parameters or is damaged.");
}

/// Adds `pickle`, and so `copy`, to a plain result: its fields in order.
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
