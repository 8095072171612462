// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// How objects show themselves: by the call in Python that makes an equal one, results by what they
// hold.
#pragma once

#include <cmath>
#include <string>

#include "support/types.hpp"

namespace wakeline::python {

/// A value as Python reads it.
inline std::string text_of(const py::object& value) {
  const std::string text = py::repr(value);
  const bool literal = !py::isinstance<py::float_>(value) || std::isfinite(value.cast<double>());
  return literal ? text : "float('" + text + "')";
}

template <class Value>
std::string text_of(const Value& value) {
  if constexpr (requires { to_array(value); })
    return text_of(py::object(to_array(value).attr("tolist")()));
  else
    return text_of(py::cast(value));
}

/// The text of a call, argument by argument: "Singer(maneuver_time_s=20.0, accel_std_mps2=0.5)".
class CallText {
 public:
  explicit CallText(const std::string& function) : text_(function + "(") {}

  template <class Value>
  CallText& with(const std::string& argument, const Value& value) {
    text_ += between_ + argument + "=" + text_of(value);
    between_ = ", ";
    return *this;
  }

  [[nodiscard]] std::string text() const { return text_ + ")"; }

 private:
  std::string text_;
  const char* between_ = "";
};

/// "1 run", "3 runs".
inline std::string many(py::ssize_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace wakeline::python
