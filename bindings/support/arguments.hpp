// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The arguments that make an equal object: what it shows, how it is pickled, and what its saved
// state is checked against.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "support/arrays.hpp"

namespace wakeline {
class ProcessNoise;
}

namespace wakeline::python {

/// The name of a class.
std::string name_of(py::handle type);

/// A value as Python gets it among the arguments, where `py::cast` would not give what the call
/// takes.
template <class Value>
struct AsPython {
  static py::object of(const Value& value) {
    if constexpr (std::is_base_of_v<py::handle, Value>)
      return py::reinterpret_borrow<py::object>(value);
    else if constexpr (requires { to_array(value); })
      return to_array(value);
    else
      return py::cast(value);
  }
};

template <class Value>
struct AsPython<std::vector<Value>> {
  static py::object of(const std::vector<Value>& values) {
    py::list list;
    for (const Value& value : values) list.append(AsPython<Value>::of(value));
    return list;
  }
};

/// Its policy.
template <>
struct AsPython<ProcessNoise> {
  static py::object of(const ProcessNoise& noise);
};

/// Collects the arguments of the call that makes an equal object, of its type or of a factory of
/// its type: `Arguments().with("maneuver_time_s", 20.0)`.
class Arguments {
 public:
  /// `factory` is a static method of the type; empty for its constructor.
  explicit Arguments(std::string factory = "") : factory_(std::move(factory)) {}

  template <class Value>
  Arguments& with(const char* name, const Value& value) {
    values_[name] = AsPython<Value>::of(value);
    return *this;
  }

  [[nodiscard]] const std::string& factory() const { return factory_; }
  [[nodiscard]] const py::dict& values() const { return values_; }

 private:
  std::string factory_;
  py::dict values_;
};

/// The type of an object of the engine. Throws TypeError for one that is derived from it in Python.
py::handle engine_type(const py::object& one);

/// Of an object with `_arguments`: a number that differs where the arguments do.
std::uint64_t fingerprint(const py::object& one);

/// A value of the caller as messages quote it, in at most 80 characters.
std::string quoted(const py::handle& value);
inline std::string quoted(const std::string& text) { return quoted(py::str(text)); }

/// A value as Python shows it, arrays as lists.
std::string text_of(const py::handle& value);

template <class Value>
std::string text_of(const Value& value) {
  return text_of(static_cast<const py::handle&>(AsPython<Value>::of(value)));
}

/// Gives a type whose `_arguments()` returns `Arguments` a `__repr__` that shows them and a
/// `__reduce_ex__` that pickles them, with the state that `save` gives where the type has one.
void define_arguments(py::handle type);

/// "1 run", "3 runs".
inline std::string many(py::ssize_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace wakeline::python

namespace pybind11::detail {

/// In Python a tuple: the factory, or None, and a dict.
template <>
struct type_caster<wakeline::python::Arguments> {
  static constexpr auto name = const_name("tuple");
  static handle cast(const wakeline::python::Arguments& arguments, return_value_policy, handle) {
    const object factory = arguments.factory().empty() ? object(none()) : str(arguments.factory());
    return make_tuple(factory, arguments.values()).release();
  }
};

}  // namespace pybind11::detail
