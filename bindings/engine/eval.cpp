// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>
#include <vector>

#include "estimators.hpp"
#include "support/arguments.hpp"
#include "support/each.hpp"
#include "wakeline/eval/consistency.hpp"
#include "wakeline/eval/cramer_rao_bound.hpp"
#include "wakeline/eval/gospa.hpp"

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

/// NEES of errors (..., N) whose covariances are the N x N matrices at `covariance`, one by one.
template <int N>
void nees_into(double* out, const double* error, const double* covariance, py::ssize_t count) {
  using Square = Eigen::Matrix<double, N, N, N == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
  for (py::ssize_t k = 0; k < count; ++k)
    out[k] = nees<N, double>(Eigen::Map<const Vec<double, N>>(error + k * N),
                             Mat<double, N, N>(Eigen::Map<const Square>(covariance + k * N * N)));
}

Array nees_of(const DoubleArray& error, const DoubleArray& covariance) {
  constexpr int kMost = 9;
  std::vector<py::ssize_t> shape = shape_of(error);
  const py::ssize_t size = shape.empty() ? 0 : shape.back();
  require_shape(size >= 1 && size <= kMost, "error", "(..., N) with N from 1 to 9", error);
  const std::vector<py::ssize_t> squares = with_last(shape, size);
  require_shape(shape_of(covariance) == squares, "covariance", shape_text(squares), covariance);
  shape.pop_back();
  Array result(shape);
  const py::gil_scoped_release released;
  [&]<int... I>(std::integer_sequence<int, I...>) {
    ((size == I + 1
          ? nees_into<I + 1>(result.mutable_data(), error.data(), covariance.data(), result.size())
          : void()),
     ...);
  }
  (std::make_integer_sequence<int, kMost>{});
  return result;
}

SetDistance set_distance(const DoubleArray& truth_m, const DoubleArray& tracks_m, double cutoff_m,
                         double order) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto points = [](const char* name, const DoubleArray& array,
                         py::ssize_t axes) -> Eigen::Map<const Rows> {
    if (array.size() == 0) return {nullptr, 0, axes < 0 ? 0 : axes};
    require_shape(array.ndim() == 2 && (axes < 0 || array.shape(1) == axes), name,
                  axes < 0 ? "(N, D)" : "(N, " + std::to_string(axes) + ")", array);
    for (py::ssize_t k = 0; k < array.size(); ++k) require_finite(name, array.data()[k]);
    return {array.data(), array.shape(0), array.shape(1)};
  };
  const auto targets = points("truth_m", truth_m, -1);
  const auto tracks = points("tracks_m", tracks_m, targets.rows() > 0 ? targets.cols() : -1);
  // Tracks by their first coordinate: those of a target's pairs follow each other.
  std::vector<std::pair<double, int>> sorted;
  for (int k = 0; k < tracks.rows(); ++k)
    sorted.emplace_back(tracks.cols() > 0 ? tracks(k, 0) : 0.0, k);
  std::sort(sorted.begin(), sorted.end());
  std::vector<Gospa::Pair> pairs;
  for (int k = 0; k < targets.rows(); ++k) {
    const double at = targets.cols() > 0 ? targets(k, 0) : 0.0;
    auto near = std::lower_bound(sorted.begin(), sorted.end(), std::pair(at - cutoff_m, 0));
    for (; near != sorted.end() && near->first <= at + cutoff_m; ++near) {
      const double distance = (targets.row(k) - tracks.row(near->second)).norm();
      if (distance < cutoff_m) pairs.push_back({k, near->second, distance});
    }
  }
  return Gospa({.cutoff_m = cutoff_m, .order = order}, int(targets.rows()), int(tracks.rows()),
               int(pairs.size()))
      .between(int(targets.rows()), int(tracks.rows()), pairs);
}

void define_set_distance(py::module_& m) {
  py::class_<SetDistance> result(m, "SetDistance",
                                 R"(GOSPA (alpha = 2) and OSPA of one scan.

The parts are in metres to the power of the order: ``gospa_m ** order = localisation + missed + false_tracks``.)");
  result
      .def_readonly("gospa_m", &SetDistance::gospa_m,
                    "Distance from errors, missed targets and false tracks.")
      .def_readonly("localisation", &SetDistance::localisation, "Sum over pairs of d ** order.")
      .def_readonly("missed", &SetDistance::missed,
                    "cutoff_m ** order / 2 for each target without a track.")
      .def_readonly("false_tracks", &SetDistance::false_tracks,
                    "cutoff_m ** order / 2 for each track without a target.")
      .def_readonly("ospa_m", &SetDistance::ospa_m, "At most the cut-off.")
      .def_readonly("pairs", &SetDistance::pairs, "Targets with a track nearer than the cut-off.")
      .def("__repr__", [](const SetDistance& d) {
        return "<SetDistance: GOSPA " + std::to_string(d.gospa_m) + " m, OSPA " +
               std::to_string(d.ospa_m) + " m, " + many(d.pairs, "pair") + ">";
      });
  define_pickle(result, &SetDistance::gospa_m, &SetDistance::localisation, &SetDistance::missed,
                &SetDistance::false_tracks, &SetDistance::ospa_m, &SetDistance::pairs);
  m.def("set_distance", &set_distance, py::arg("truth_m"), py::arg("tracks_m"),
        py::arg("cutoff_m") = 50.0, py::arg("order") = 2.0,
        R"(GOSPA and OSPA: how far a set of tracks is from the set of true targets, in one scan.

With the cut-off c, the order p and the best pairing of targets with tracks,
``gospa_m ** p = sum of d ** p over pairs + c ** p / 2 for each point without a pair`` and
``ospa_m ** p = (sum of d ** p over pairs + c ** p (n - pairs)) / n`` for n the size of the larger set; zero where both are empty.

Parameters
----------
truth_m : (N, D) array_like
    True positions; `[]` for none.
tracks_m : (M, D) array_like
    Estimated positions; `[]` for none.
cutoff_m : float
    Distance at which a pair is as bad as a missed target and a false track.
order : float
    p, at least 1.

Raises
------
ValueError
    When a shape does not fit, a position is not finite, the cut-off is not positive and finite, or the order is below 1 or
    so high that the cut-off to its power overflows.

References
----------
A. S. Rahmathullah, A. F. Garcia-Fernandez, L. Svensson, Generalized Optimal Sub-Pattern Assignment Metric, Fusion 2017;
D. Schuhmacher, B.-T. Vo, B.-N. Vo, A Consistent Metric for Performance Evaluation of Multi-Object Filters, IEEE Trans. Signal
Processing 56(8), 2008.)");
}

}  // namespace

void define_eval(py::module_& parent) {
  py::module_ m = parent.def_submodule("eval", "Consistency of estimators, and bounds.");
  define_set_distance(m);
  m.def("nees", &nees_of, py::arg("error"), py::arg("covariance"),
        R"(Normalised estimation error squared ``e' inv(P) e`` of any number of errors.

Of innovations and their covariances it is the NIS. Chi-square with N degrees of freedom where the covariance is right.

Parameters
----------
error : (..., N) array_like
    Estimate minus truth, N from 1 to 9.
covariance : (..., N, N) array_like
    Symmetric; its lower triangle is read.

Returns
-------
(...) array
    NaN where the covariance is not positive definite or a number is not finite.

Raises
------
ValueError
    When a shape does not fit.)");
  m.def(
      "consistency_bounds",
      [](double confidence, int dof, double samples) {
        require(confidence > 0.0 && confidence < 1.0, "confidence", "between 0 and 1", confidence);
        require(dof >= 1, "dof", "at least 1", dof);
        require(samples >= 1.0, "samples", "at least 1", samples);
        const ConsistencyBounds bounds = consistency_bounds(confidence, dof, samples);
        return py::make_tuple(bounds.lower, bounds.upper);
      },
      py::arg("confidence"), py::arg("dof"), py::arg("samples"),
      "(lower, upper) bounds of the average NEES or NIS of that many samples of a consistent "
      "estimator; a mean with weights w counts as (sum w)^2 / sum w^2 samples.");
  m.def("cramer_rao_bound", &bound_of, py::arg("transition"), py::arg("process_noise"),
        py::arg("states"), py::arg("sensor"), py::arg("start_covariance"),
        py::arg("detection_probability") = 1.0,
        R"(The posterior Cramér-Rao bound of a vessel whose motion is known.

`P' = F P Fᵀ + Q`, then `P'⁻¹ = P⁻¹ + p Hᵀ R⁻¹ H`, at the true states.

Parameters
----------
transition, process_noise : (T, 4, 4) array
    F and Q from the previous reading to each reading; the first from the start.
states : (T, 4) array
    True states [x, vx, y, vy] (m, m/s) at the readings; a row of NaN is a missed scan.
sensor : RangeBearing, ConvertedRangeBearing, RangeBearingDoppler or Position
start_covariance : (4, 4) array
    Covariance of the prior.
detection_probability : float
    Probability p of a reading.

Returns
-------
(T, 4, 4) array
    The least covariance of an unbiased estimator after each reading.

Raises
------
ValueError
    When a shape does not fit, the prior is not positive definite or p is not from 0 to 1.
FilterError
    When a step fails.)");
}

}  // namespace wakeline::python
