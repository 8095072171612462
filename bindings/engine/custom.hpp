// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Motion models and sensors of matrices and functions in Python.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "support/arguments.hpp"
#include "support/types.hpp"
#include "wakeline/catalog/custom_motion.hpp"
#include "wakeline/catalog/custom_sensor.hpp"
#include "wakeline/catalog/estimators.hpp"

namespace wakeline::python {

/// "x", "vx", …: a component in Python.
std::string name_of(Component component);
/// "[x, vx, y, vy]".
std::string names_of(const StateRows& rows);

/// How much elements `at(i, j)` of a covariance may be off by rounding.
template <class At>
double rounding_of(int rows, const At& at) {
  double largest = 0.0;
  for (int i = 0; i < rows; ++i) largest = std::max(largest, std::abs(at(i, i)));
  return 1e-9 * largest;
}

/// The first element of a covariance, row and column, that differs from its mirror image.
template <class At>
std::optional<std::pair<int, int>> asymmetry(int rows, const At& at) {
  const double rounding = rounding_of(rows, at);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < i; ++j)
      if (!(std::abs(at(i, j) - at(j, i)) <= rounding)) return std::pair(i, j);
  return std::nullopt;
}

/// The first exception of a model's functions, until the call that they were called in raises it:
/// the steps between are C++, which exceptions do not pass.
class Fault {
 public:
  void keep(std::exception_ptr error) noexcept {
    const std::lock_guard hold(mutex_);
    if (!error_) error_ = std::move(error);
    there_is_ = true;
  }
  [[nodiscard]] bool there_is() const noexcept { return there_is_; }
  void raise() {
    if (!there_is_) return;
    std::exception_ptr error;
    {
      const std::lock_guard hold(mutex_);
      error.swap(error_);
      there_is_ = false;
    }
    if (error) std::rethrow_exception(error);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr error_;
  std::atomic<bool> there_is_ = false;
};

/// A motion model in Python.
class PyMotion : public CustomMotion {
 public:
  using CustomMotion::CustomMotion;
  [[nodiscard]] virtual const char* type() const noexcept = 0;
  /// True where a step calls Python.
  [[nodiscard]] virtual bool calls() const noexcept = 0;
  [[nodiscard]] Fault& fault() const noexcept { return fault_; }

 private:
  mutable Fault fault_;
};

/// A sensor in Python.
class PySensor : public CustomSensor {
 public:
  [[nodiscard]] Fault& fault() const noexcept { return fault_; }
  /// True where a step calls Python.
  [[nodiscard]] virtual bool calls() const noexcept = 0;

 private:
  mutable Fault fault_;
};

/// The Python object that it is.
template <>
struct AsPython<std::shared_ptr<const CustomMotion>> {
  static py::object of(const std::shared_ptr<const CustomMotion>& motion) {
    return py::cast(
        std::const_pointer_cast<PyMotion>(std::static_pointer_cast<const PyMotion>(motion)));
  }
};

/// Calls a function with each custom motion model of a filter, or of the filters of an Imm.
template <class Function>
void for_each_custom(const AnyFilter& filter, const Function& function) {
  if (const auto* custom = std::get_if<CustomFilter>(&filter.variant()))
    function(static_cast<const PyMotion&>(*custom->motion()));
}
template <class Function>
void for_each_custom(const AnyImm& imm, const Function& function) {
  for (int k = 0; k < imm.bank().size(); ++k) for_each_custom(imm.bank().filter(k), function);
}
template <class Function>
void for_each_custom(const AnyEstimator& estimator, const Function& function) {
  if (const auto* imm = std::get_if<AnyImm>(&estimator.variant())) for_each_custom(*imm, function);
}

/// Raises what a function of the estimator's models has raised since the last call.
template <class Estimator>
void raise_fault(const Estimator& estimator) {
  for_each_custom(estimator, [](const PyMotion& motion) { motion.fault().raise(); });
}

/// True where each step of the estimator calls Python.
template <class Estimator>
bool calls_python(const Estimator& estimator) {
  bool calls = false;
  for_each_custom(estimator, [&](const PyMotion& motion) { calls = calls || motion.calls(); });
  return calls;
}

inline const PySensor* python_sensor(const RuntimeSensor& sensor) {
  return static_cast<const PySensor*>(sensor.custom());
}

/// The same of a sensor.
inline void raise_fault(const RuntimeSensor& sensor) {
  if (const PySensor* one = python_sensor(sensor)) one->fault().raise();
}

}  // namespace wakeline::python
