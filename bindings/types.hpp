// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What several bindings share: beliefs, steps and sensors as Python sees them.
#pragma once

#include <stdexcept>
#include <string>

#include "any_filter.hpp"
#include "arrays.hpp"

namespace wakeline::python {

/// Raised in Python when a step cannot be done.
class FilterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline void require_ok(Status status, const char* what) {
  if (status != Status::kOk) throw FilterError(std::string(what) + ": " + to_string(status));
}

/// A belief of any size.
struct PyGaussian {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;

  template <int N>
  static PyGaussian from(const Gaussian<N>& belief) {
    return {belief.mean, belief.covariance};
  }
  static PyGaussian from(const AnyBelief& belief) { return {belief.mean, belief.covariance}; }

  /// As a belief over the state layout of its size: 4, 5 or 6.
  [[nodiscard]] AnyBelief to_belief(const char* name) const {
    if (mean.size() < 4 || mean.size() > kMaxStates)
      throw py::value_error(std::string(name) +
                            " must have a mean of 4, 5 or 6 states, got " + std::to_string(mean.size()));
    AnyBelief belief;
    belief.layout = mean.size() == 4   ? StateLayout::kKinematics
                    : mean.size() == 5 ? StateLayout::kTurn
                                       : StateLayout::kAcceleration;
    belief.mean = mean;
    belief.covariance = covariance;
    return belief;
  }
};

struct PyStep {
  Status status;
  Eigen::VectorXd innovation;
  Eigen::MatrixXd innovation_covariance;
  double nis;
  double log_likelihood;
};

template <int M>
PyStep to_step(const Step<M>& step) {
  return {step.status, step.innovation, step.innovation_covariance, step.nis, step.log_likelihood};
}

/// Calls `function(sensor)` with the C++ sensor behind a Python one.
template <class Function>
auto visit_sensor(const py::handle& sensor, Function&& function) {
  if (py::isinstance<RangeBearing>(sensor)) return function(sensor.cast<const RangeBearing&>());
  if (py::isinstance<ConvertedRangeBearing>(sensor))
    return function(sensor.cast<const ConvertedRangeBearing&>());
  if (py::isinstance<Position>(sensor)) return function(sensor.cast<const Position&>());
  if (py::isinstance<RangeBearingDoppler>(sensor))
    return function(sensor.cast<const RangeBearingDoppler&>());
  throw py::type_error("sensor must be RangeBearing, ConvertedRangeBearing, Position or "
                       "RangeBearingDoppler, got " +
                       py::str(py::type::of(sensor).attr("__name__")).cast<std::string>());
}

/// Throws ValueError when a Kalman filter is given a sensor that is not linear.
template <class Sensor>
void require_linear(const AnyFilter& filter) {
  if (filter.linear() && !Sensor::kLinear)
    throw py::value_error("sensor must be linear for Kalman: use ConvertedRangeBearing or Position, or Ekf or Ukf");
}

template <class Sensor>
void require_linear(const AnyImm& imm) {
  for (int k = 0; k < imm.bank().size(); ++k)
    require_linear<Sensor>(imm.bank().filter(static_cast<std::size_t>(k)));
}

void define_core(py::module_& m);
void define_motion(py::module_& m);
void define_measurement(py::module_& m);
void define_filter(py::module_& m);
void define_multimodel(py::module_& m);
void define_gating(py::module_& m);
void define_association(py::module_& m);
void define_track(py::module_& m);
void define_eval(py::module_& m);

}  // namespace wakeline::python
