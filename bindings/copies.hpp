// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// How objects are copied, and kept as bytes.
#pragma once

#include <pybind11/pybind11.h>

#include <cstddef>
#include <span>
#include <string_view>

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

/// Adds what `copy.copy` and `copy.deepcopy` ask for; `save` and `restore` where there is a state.
///
/// What can be copied can be pickled: as the call that makes an equal one, which is its `repr`, and
/// its state (`wakeline/_pickling.py`).
template <class Value, class... Options>
void define_copies(py::class_<Value, Options...>& value) {
  value.def("__copy__", [](const Value& one) { return Value(one); })
      .def(
          "__deepcopy__", [](const Value& one, const py::dict&) { return Value(one); },
          py::arg("memo"));
  if constexpr (Archived<Value>)
    value
        .def(
            "save",
            [](const Value& one) {
              Archive fields;
              Value(one).archive(fields);
              return to_bytes(fields.bytes());
            },
            "What it knows as bytes, for one that is made alike, on the same kind of machine.")
        .def(
            "restore",
            [](Value& one, const py::bytes& state) {
              Archive fields(bytes_of(state));
              Value restored(one);
              restored.archive(fields);
              if (!fields.ok() || !fields.at_end())
                throw py::value_error("state is not that of one that is made alike");
              one = restored;
            },
            py::arg("state"), "Goes on bit for bit where the saved one was.");
}

}  // namespace wakeline::python
