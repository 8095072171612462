// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "estimators.hpp"
#include "wakeline/eval/consistency.hpp"
#include "wakeline/eval/cramer_rao_bound.hpp"

namespace wakeline::python {
namespace {

using Matrix = Mat<double, 4, 4>;
using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

py::array_t<double> bound_of(const DoubleArray& transition, const DoubleArray& process_noise,
                             const DoubleArray& states, const py::object& sensor,
                             const DoubleArray& start_covariance, double detection_probability) {
  require_shape(states.ndim() == 2 && states.shape(1) == 4, "states", "(T, 4)", states);
  const py::ssize_t scans = states.shape(0);
  const std::string per_scan = shape_text({scans, 4, 4});
  for (const auto& [name, array] :
       {std::pair{"transition", &transition}, std::pair{"process_noise", &process_noise}})
    require_shape(array->ndim() == 3 && array->shape(0) == scans && array->shape(1) == 4 &&
                      array->shape(2) == 4,
                  name, per_scan, *array);
  if (!(detection_probability >= 0.0 && detection_probability <= 1.0))
    throw py::value_error("detection_probability must be from 0 to 1, got " +
                          std::to_string(detection_probability));
  CramerRaoBound<4> bound(Matrix(to_matrix("start_covariance", start_covariance, 4, 4)));
  py::array_t<double> result({scans, py::ssize_t{4}, py::ssize_t{4}});
  double* out = result.mutable_data();
  visit_sensor(sensor, [&](const auto& model) {
    for (py::ssize_t scan = 0; scan < scans; ++scan) {
      const std::string what = "scan " + std::to_string(scan);
      const Matrix f = Eigen::Map<const RowMajor>(transition.data(scan, 0, 0));
      const Matrix q = Eigen::Map<const RowMajor>(process_noise.data(scan, 0, 0));
      require_ok(bound.predict(f, q), what.c_str());
      const Vec<double, 4> truth = Eigen::Map<const Vec<double, 4>>(states.data(scan, 0));
      if (!truth.array().isNaN().all())
        require_ok(bound.update<ConstantVelocity>(model, truth, detection_probability),
                   what.c_str());
      Eigen::Map<RowMajor>(out + 16 * scan) = bound.covariance();
    }
  });
  return result;
}

}  // namespace

void define_eval(py::module_& parent) {
  py::module_ m =
      parent.def_submodule("eval", "Whether an estimator tells the truth about its errors.");
  m.def(
      "consistency_bounds",
      [](double confidence, int dof, long samples) {
        require(confidence > 0.0 && confidence < 1.0, "confidence", "between 0 and 1", confidence);
        require(dof >= 1, "dof", "at least 1", dof);
        require(samples >= 1, "samples", "at least 1", static_cast<double>(samples));
        const ConsistencyBounds bounds = consistency_bounds(confidence, dof, samples);
        return py::make_tuple(bounds.lower, bounds.upper);
      },
      py::arg("confidence"), py::arg("dof"), py::arg("samples"),
      "(lower, upper) bounds of the average NEES or NIS of that many samples of a consistent "
      "estimator.");
  m.def("cramer_rao_bound", &bound_of, py::arg("transition"), py::arg("process_noise"),
        py::arg("states"), py::arg("sensor"), py::arg("start_covariance"),
        py::arg("detection_probability") = 1.0,
        R"(The posterior Cramér-Rao bound of a vessel whose motion is known.

`P' = F P Fᵀ + Q`, then `P'⁻¹ = P⁻¹ + p Hᵀ R⁻¹ H`, at the true states.

Parameters
----------
transition, process_noise : (T, 4, 4) array
    F and Q from the reading before to each reading; the first from the start.
states : (T, 4) array
    True states [x, vx, y, vy] (m, m/s) at the readings; a row of NaN is a missed scan.
sensor : RangeBearing, ConvertedRangeBearing, RangeBearingDoppler or Position
start_covariance : (4, 4) array
    Covariance of the prior.
detection_probability : float
    Chance p that a reading is made.

Returns
-------
(T, 4, 4) array
    The covariance after each reading that no unbiased estimator beats.

Raises
------
ValueError
    When a shape does not fit, the prior is not positive definite or p is not from 0 to 1.
FilterError
    When a step cannot be done.)");
}

}  // namespace wakeline::python
