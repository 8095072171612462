// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/border.hpp"

#include <pybind11/numpy.h>

#include <string>
#include <string_view>
#include <unordered_set>

namespace wakeline::python {
namespace {

using Call = PyObject* (*)(PyObject*, PyObject* const*, Py_ssize_t, PyObject*);

/// pybind11's function behind all functions.
Call dispatch = nullptr;

std::unordered_set<const PyTypeObject*>& writable_types() {
  static std::unordered_set<const PyTypeObject*> types;
  return types;
}

std::unordered_set<const PyObject*>& copies() {
  static std::unordered_set<const PyObject*> objects;
  return objects;
}

/// Replaces the list of signatures, which pybind11 raises for arguments that do not fit, by a
/// sentence.
void shorten(PyObject* const* arguments, Py_ssize_t count, PyObject* names) {
  py::error_already_set error;
  const std::string text = py::str(error.value());
  if (text.find("(): incompatible ") == std::string::npos) {
    error.restore();
    return;
  }
  py::list positional;
  for (Py_ssize_t k = 0; k < count; ++k) positional.append(py::handle(arguments[k]));
  py::dict named;
  const Py_ssize_t more = names == nullptr ? 0 : PyTuple_GET_SIZE(names);
  for (Py_ssize_t k = 0; k < more; ++k)
    named[py::handle(PyTuple_GET_ITEM(names, k))] = py::handle(arguments[count + k]);
  try {
    const py::str sentence =
        py::module_::import("wakeline._mismatch").attr("sentence")(text, positional, named);
    PyErr_SetObject(PyExc_TypeError, sentence.ptr());
  } catch (py::error_already_set&) {
    error.restore();
  }
}

PyObject* call(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* names) {
  PyObject* result = dispatch(self, arguments, count, names);
  if (result == nullptr && PyErr_ExceptionMatches(PyExc_TypeError) != 0)
    shorten(arguments, PyVectorcall_NARGS(static_cast<std::size_t>(count)), names);
  return result;
}

/// The same for the getter of a property. A result that nothing else holds is a copy.
PyObject* get(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* names) {
  PyObject* result = call(self, arguments, count, names);
  if (result == nullptr || Py_REFCNT(result) != 1) return result;
  const py::handle value(result);
  if (py::isinstance<py::array>(value)) {
    const auto array = py::reinterpret_borrow<py::array>(value);
    if (array.owndata()) array.attr("flags").attr("writeable") = false;
  } else if (writable_types().contains(Py_TYPE(result)) &&
             reinterpret_cast<py::detail::instance*>(result)->owned) {
    make_copy(value);
  }
  return result;
}

/// Puts a function between Python and a function of pybind11; others stay.
void wrap(py::handle function, Call between) {
  PyObject* one = function.ptr();
  if (one != nullptr && PyInstanceMethod_Check(one)) one = PyInstanceMethod_GET_FUNCTION(one);
  if (one == nullptr || !PyCFunction_Check(one)) return;
  PyMethodDef* definition = reinterpret_cast<PyCFunctionObject*>(one)->m_ml;
  PyObject* record = PyCFunction_GET_SELF(one);
  if (record == nullptr || py::detail::function_record_ptr_from_PyObject(record) == nullptr) return;
  if (definition->ml_flags != (METH_FASTCALL | METH_KEYWORDS)) return;
  const auto now = reinterpret_cast<Call>(reinterpret_cast<void (*)()>(definition->ml_meth));
  if (now == &call || now == &get) return;
  dispatch = now;
  definition->ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(between));
}

void finish(py::handle scope, const std::string& root) {
  py::list names;
  const py::object all = py::dict(scope.attr("__dict__"));
  for (const auto& [key, value] : all.cast<py::dict>()) {
    const std::string name = py::str(key);
    if (PyModule_Check(value.ptr()) || PyType_Check(value.ptr())) {
      const std::string home =
          py::str(value.attr(PyType_Check(value.ptr()) ? "__module__" : "__name__"));
      if (home.starts_with(root)) finish(value, root);
    } else if (py::isinstance(value, py::handle(reinterpret_cast<PyObject*>(&PyProperty_Type)))) {
      wrap(value.attr("fget"), &get);
      wrap(value.attr("fset"), &call);
    } else if (Py_TYPE(value.ptr()) == &PyStaticMethod_Type) {
      wrap(value.attr("__func__"), &call);
    } else {
      wrap(value, &call);
    }
    if (!name.starts_with("_")) names.append(key);
  }
  if (PyModule_Check(scope.ptr())) scope.attr("__all__") = names;
}

}  // namespace

void finish_border(const py::module_& module) { finish(module, py::str(module.attr("__name__"))); }

void note_writable(py::handle type) {
  writable_types().insert(reinterpret_cast<const PyTypeObject*>(type.ptr()));
}

bool is_copy(py::handle one) { return copies().contains(one.ptr()); }

void make_copy(py::handle one) {
  const PyObject* object = one.ptr();
  if (!copies().insert(object).second) return;
  const py::cpp_function forget([object](py::handle reference) {
    copies().erase(object);
    reference.dec_ref();
  });
  (void)py::weakref(one, forget).release();
}

}  // namespace wakeline::python
