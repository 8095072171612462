// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What holds of every function and property that Python sees, done once, when a module is complete.
#pragma once

#include <pybind11/pybind11.h>

namespace wakeline::python {

namespace py = pybind11;

/// Of a module and all inside:
///
/// - a call with arguments that do not fit raises a TypeError of one sentence;
/// - what a property gives as a copy cannot be written to: arrays are read-only, and setting a
/// field
///   of a parameter struct raises an AttributeError;
/// - `__all__` lists the public names.
void finish_border(const py::module_& module);

/// Writable parameter structs of this Python type lose that when a property gives them as a copy.
void note_writable(py::handle type);

/// Whether a struct was given as a copy, or is a part of one.
bool is_copy(py::handle one);

/// Makes a struct one that was given as a copy.
void make_copy(py::handle one);

}  // namespace wakeline::python
