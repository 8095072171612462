// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/arguments.hpp"

#include <cstddef>
#include <span>

#include "wakeline/core/archive.hpp"

namespace wakeline::python {
std::string name_of(py::handle type) { return py::cast<std::string>(type.attr("__name__")); }

namespace {

/// "Singer(maneuver_time_s=20.0, accel_std_mps2=0.5)".
std::string shown(const py::object& one) {
  const py::tuple arguments = one.attr("_arguments")();
  std::string text = name_of(py::type::handle_of(one));
  if (!arguments[0].is_none()) text += "." + arguments[0].cast<std::string>();
  const char* between = "(";
  for (const auto& [name, value] : arguments[1].cast<py::dict>()) {
    text += between + name.cast<std::string>() + "=" + text_of(value);
    between = ", ";
  }
  return text + (*between == '(' ? "()" : ")");
}

py::tuple reduced(const py::object& one, int) {
  const py::handle type = engine_type(one);
  const py::tuple arguments = one.attr("_arguments")();
  const py::object state = py::hasattr(one, "save") ? one.attr("save")() : py::none();
  return py::make_tuple(py::module_::import("wakeline._pickling").attr("rebuilt"),
                        py::make_tuple(type, arguments[0], arguments[1], state));
}

}  // namespace

py::handle engine_type(const py::object& one) {
  const py::handle type = py::type::handle_of(one);
  const auto* known = py::detail::get_type_info(Py_TYPE(one.ptr()));
  if (known == nullptr || known->type != Py_TYPE(one.ptr()))
    throw py::type_error(name_of(type) +
                         " is derived in Python: define __copy__, __deepcopy__ and __reduce_ex__");
  return type;
}

std::uint64_t fingerprint(const py::object& one) {
  const std::string text = shown(one);
  return checksum(std::as_bytes(std::span(text.data(), text.size())));
}

std::string quoted(const py::handle& value) {
  constexpr py::ssize_t kMost = 80;
  const py::str text = py::repr(value);
  if (PyUnicode_GetLength(text.ptr()) <= kMost) return text.cast<std::string>();
  return text[py::slice(0, kMost - 3, 1)].cast<std::string>() + "...";
}

std::string text_of(const py::handle& value) {
  return py::repr(py::isinstance<py::array>(value) ? value.attr("tolist")() : value)
      .cast<std::string>();
}

void define_arguments(py::handle type) {
  py::options options;
  options.enable_function_signatures();
  const auto method = [&](const char* name, auto&& function, const auto&... extra) {
    type.attr(name) = py::cpp_function(std::forward<decltype(function)>(function), py::name(name),
                                       py::is_method(type), extra...);
  };
  method("__repr__", &shown);
  method("__reduce_ex__", &reduced, py::arg("protocol"));
}

}  // namespace wakeline::python
