// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What all bindings share: beliefs and steps as Python sees them.
#pragma once

#include <pybind11/stl.h>

#include <stdexcept>
#include <string>

#include "support/arrays.hpp"
#include "support/copies.hpp"
#include "wakeline/core/status.hpp"

namespace wakeline::python {

/// Raised in Python when a step cannot be done.
class FilterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline void require_ok(Status status, const char* what) {
  if (status != Status::kOk) throw FilterError(std::string(what) + ": " + to_string(status));
}

/// The same of one row of many.
inline void require_ok_in(py::ssize_t row, Status status, const char* what) {
  if (status != Status::kOk)
    require_ok(status, (std::string(what) + " in row " + std::to_string(row)).c_str());
}

/// A belief of any size.
struct PyGaussian {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;

  template <int N>
  static PyGaussian from(const Gaussian<N>& belief) {
    return {belief.mean, belief.covariance};
  }
};

struct PyStep {
  static constexpr int kMost = 6;  ///< measurements that there is room for
  Status status;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1> innovation;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost> innovation_covariance;
  double nis;
  double log_likelihood;
};

/// A step as a tuple, and back.
inline py::tuple fields_of(const PyStep& s) {
  return py::make_tuple(s.status, to_array(s.innovation), to_array(s.innovation_covariance), s.nis,
                        s.log_likelihood);
}
inline PyStep step_of(const py::tuple& fields) {
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto innovation = fields[1].cast<DoubleArray>();
  const auto covariance = fields[2].cast<DoubleArray>();
  const py::ssize_t size = innovation.size();
  require_shape(innovation.ndim() == 1 && size <= PyStep::kMost, "innovation",
                "(M,), M at most " + std::to_string(PyStep::kMost), innovation);
  require_shape(shape_of(covariance) == std::vector{size, size}, "innovation_covariance",
                shape_text({size, size}), covariance);
  return {fields[0].cast<Status>(), Eigen::Map<const Eigen::VectorXd>(innovation.data(), size),
          Eigen::Map<const Square>(covariance.data(), size, size), fields[3].cast<double>(),
          fields[4].cast<double>()};
}

template <int M>
PyStep to_step(const Step<M>& step) {
  static_assert(M <= PyStep::kMost);
  return {step.status, step.innovation, step.innovation_covariance, step.nis, step.log_likelihood};
}

void define_batch(py::module_& m);
void define_benchmark(py::module_& m);
void define_core(py::module_& m);
void define_motion(py::module_& m);
void define_measurement(py::module_& m);
void define_custom(py::module_& m);
void define_filter(py::module_& m);
void define_alpha_beta(py::module_& filter);
void define_smoothers(py::module_& filter);
void define_multimodel(py::module_& m);
void define_navigation(py::module_& m);
void define_gating(py::module_& m);
void define_association(py::module_& m);
void define_track(py::module_& m);
void define_eval(py::module_& m);
void define_video(py::module_& m);
void define_video_asterix(py::module_& video);
void define_wire(py::module_& m);

}  // namespace wakeline::python
