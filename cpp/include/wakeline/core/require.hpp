// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/environment.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace wakeline {

/// Throws `std::invalid_argument`; where exceptions are switched off, says it on the standard error
/// and aborts. For constructors only.
[[noreturn, gnu::noinline]] inline void reject(const std::string& message) {
#if defined(__cpp_exceptions)
  throw std::invalid_argument(message);
#else
  std::fprintf(stderr, "wakeline: %s\n", message.c_str());
  std::abort();
#endif
}

/// A number in a message, with digits enough to distinguish it from one that is allowed.
[[gnu::noinline]] inline std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

/// Rejects a value in words that say what was wanted and what came.
[[noreturn, gnu::noinline]] inline void reject_value(const char* name, const char* wanted,
                                                     double value) {
  reject(std::string(name) + " must be " + wanted + ", got " + number_text(value));
}

/// Rejects the value unless the condition holds.
inline void require(bool condition, const char* name, const char* wanted, double value) {
  if (!condition) reject_value(name, wanted, value);
}

/// Throws `std::invalid_argument` unless the value is finite and not negative.
inline void require_not_negative(const char* name, double value) {
  require(value >= 0.0 && std::isfinite(value), name, "finite and not negative", value);
}

/// Throws `std::invalid_argument` unless the value is finite and positive.
inline void require_positive(const char* name, double value) {
  require(value > 0.0 && std::isfinite(value), name, "finite and positive", value);
}

/// A mean time, large enough that its rate is finite.
inline void require_time(const char* name, double time_s) {
  require(time_s >= 1e-3 && time_s <= 1e12, name, "0.001 s to 1e12 s", time_s);
}

/// Throws `std::invalid_argument` unless the value is finite.
inline void require_finite(const char* name, double value) {
  require(std::isfinite(value), name, "finite", value);
}

/// Throws `std::invalid_argument` unless the value is between 0 and 1.
inline void require_probability(const char* name, double value) {
  require(value >= 0.0 && value <= 1.0, name, "a probability between 0 and 1", value);
}

}  // namespace wakeline
