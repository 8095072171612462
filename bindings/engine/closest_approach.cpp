// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/closest_approach.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "support/types.hpp"

namespace wakeline::python {

void define_closest_approach(py::module_& navigation);

namespace {

using Array = py::array_t<double>;

/// Closest approaches of any number of pairs of ships, in the shape in which they were asked for.
struct ClosestApproaches {
  std::vector<py::ssize_t> shape;
  std::vector<ClosestApproach> approaches;

  /// A number of each.
  template <class F>
  Array each(F f) const {
    Array values(shape);
    for (std::size_t k = 0; k < approaches.size(); ++k) values.mutable_data()[k] = f(approaches[k]);
    return values;
  }
};

/// An array (..., `tail`) as one that shares the shape `lead` in front.
DoubleArray led_by(const py::tuple& lead, const py::tuple& tail, const DoubleArray& array) {
  return py::module_::import("numpy").attr("broadcast_to")(array, lead + tail).cast<DoubleArray>();
}

py::tuple leading(const DoubleArray& array, py::ssize_t count) {
  py::tuple shape(array.ndim() - count);
  for (py::ssize_t k = 0; k < array.ndim() - count; ++k) shape[std::size_t(k)] = array.shape(k);
  return shape;
}

void require_tail(const char* name, const DoubleArray& array, int count) {
  bool good = array.ndim() >= count;
  for (int k = 1; good && k <= count; ++k) good = array.shape(array.ndim() - k) == 4;
  require_shape(good, name, count == 1 ? "(..., 4)" : "(..., 4, 4)", array);
}

/// The matrix, or zero where none is given.
DoubleArray or_zero(const std::optional<DoubleArray>& covariance) {
  if (covariance) return *covariance;
  DoubleArray zero(std::vector<py::ssize_t>{4, 4});
  std::fill_n(zero.mutable_data(), 16, 0.0);
  return zero;
}

Gaussian<4> belief_at(const DoubleArray& mean, const DoubleArray& covariance, py::ssize_t k) {
  Gaussian<4> belief;
  belief.mean = Eigen::Map<const Vec<double, 4>>(mean.data() + 4 * k);
  belief.covariance = Eigen::Map<const Mat<double, 4, 4>>(covariance.data() + 16 * k);
  return belief;
}

ClosestApproaches closest_approaches(const DoubleArray& own, const DoubleArray& target,
                                     const std::optional<DoubleArray>& own_covariance,
                                     const std::optional<DoubleArray>& target_covariance) {
  const DoubleArray own_errors = or_zero(own_covariance);
  const DoubleArray target_errors = or_zero(target_covariance);
  require_tail("own", own, 1);
  require_tail("target", target, 1);
  require_tail("own_covariance", own_errors, 2);
  require_tail("target_covariance", target_errors, 2);
  const py::tuple lead = py::module_::import("numpy").attr("broadcast_shapes")(
      leading(own, 1), leading(target, 1), leading(own_errors, 2), leading(target_errors, 2));
  const py::tuple vector = py::make_tuple(4), matrix = py::make_tuple(4, 4);
  const DoubleArray p = led_by(lead, vector, own), q = led_by(lead, vector, target);
  const DoubleArray a = led_by(lead, matrix, own_errors), b = led_by(lead, matrix, target_errors);
  ClosestApproaches result{lead.cast<std::vector<py::ssize_t>>(), {}};
  const py::ssize_t count = p.size() / 4;
  result.approaches.reserve(std::size_t(count));
  for (py::ssize_t k = 0; k < count; ++k)
    result.approaches.push_back(closest_approach(belief_at(p, a, k), belief_at(q, b, k)));
  return result;
}

/// Mean and covariance of the relative state of each pair, of which all else follows.
auto relative_states_of(const ClosestApproaches& all) {
  std::vector<py::ssize_t> vector = all.shape, matrix = all.shape;
  vector.push_back(4);
  matrix.insert(matrix.end(), {4, 4});
  Array mean(vector), covariance(matrix);
  for (std::size_t k = 0; k < all.approaches.size(); ++k) {
    const Gaussian<4> relative = all.approaches[k].relative();
    Eigen::Map<Vec<double, 4>>(mean.mutable_data() + 4 * k) = relative.mean;
    Eigen::Map<Mat<double, 4, 4>>(covariance.mutable_data() + 16 * k) = relative.covariance;
  }
  return py::make_tuple(mean, covariance);
}

ClosestApproaches approaches_of(const py::tuple& fields) {
  if (fields.size() != 2) throw py::value_error("state is not that of such a result");
  const auto mean = fields[0].cast<DoubleArray>(), covariance = fields[1].cast<DoubleArray>();
  require_tail("mean", mean, 1);
  require_shape(covariance.size() == 4 * mean.size(), "covariance", "(..., 4, 4)", covariance);
  ClosestApproaches all{leading(mean, 1).cast<std::vector<py::ssize_t>>(), {}};
  for (py::ssize_t k = 0; k < mean.size() / 4; ++k)
    all.approaches.emplace_back(belief_at(mean, covariance, k));
  return all;
}

void require_not_below_zero(const char* name, double value) {
  if (!(value >= 0.0))
    throw py::value_error(std::string(name) + " must not be negative, got " +
                          std::to_string(value));
}

}  // namespace

void define_closest_approach(py::module_& m) {
  py::class_<ClosestApproaches>(
      m, "ClosestApproach",
      "Closest approaches of pairs of ships; every array has the shape (...) of the pairs.")
      .def_property_readonly(
          "cpa_m",
          [](const ClosestApproaches& all) {
            return all.each([](const ClosestApproach& one) { return one.cpa_m(); });
          },
          "Distance at the closest point, not negative.")
      .def_property_readonly(
          "signed_cpa_m",
          [](const ClosestApproaches& all) {
            return all.each([](const ClosestApproach& one) { return one.signed_cpa_m(); });
          },
          "Signed distance, positive if the ships pass port to port along their relative motion.")
      .def_property_readonly(
          "tcpa_s",
          [](const ClosestApproaches& all) {
            return all.each([](const ClosestApproach& one) { return one.tcpa_s(); });
          },
          "Time until the closest point; negative in the past, 0 at relative rest.")
      .def_property_readonly(
          "cpa_std_m",
          [](const ClosestApproaches& all) {
            return all.each([](const ClosestApproach& one) { return one.cpa_std_m(); });
          },
          "Standard deviation of signed_cpa_m, of first order.")
      .def_property_readonly(
          "tcpa_std_s",
          [](const ClosestApproaches& all) {
            return all.each([](const ClosestApproach& one) { return one.tcpa_std_s(); });
          },
          "Standard deviation of tcpa_s, of first order.")
      .def_property_readonly(
          "covariance",
          [](const ClosestApproaches& all) {
            std::vector<py::ssize_t> shape = all.shape;
            shape.insert(shape.end(), {2, 2});
            Array covariance(shape);
            for (std::size_t k = 0; k < all.approaches.size(); ++k)
              Eigen::Map<Mat<double, 2, 2>>(covariance.mutable_data() + 4 * k) =
                  all.approaches[k].covariance();
            return covariance;
          },
          "(..., 2, 2) of [signed_cpa_m, tcpa_s].")
      .def(py::pickle(&relative_states_of, &approaches_of))
      .def(
          "probability",
          [](const ClosestApproaches& all, double limit_m, double horizon_s) {
            require_not_below_zero("limit_m", limit_m);
            require_not_below_zero("horizon_s", horizon_s);
            return all.each(
                [&](const ClosestApproach& one) { return one.probability(limit_m, horizon_s); });
          },
          py::arg("limit_m"), py::arg("horizon_s") = ClosestApproach::kForever_s,
          R"(Probability that the ships come closer than a limit L between now and a horizon H: that
          |p + v t| < L at some t, 0 <= t <= H, with p and v jointly Gaussian, also near relative rest. The
          RMS error against random draws is 0.004. Errors above 0.02 are rare, except in one of thirty cases
          with a target within a tenth of the limit; they are at most 0.08, but up to 0.15 (too small) for a
          target with a known position less than a hundredth outside the limit.

Parameters
----------
limit_m : float
horizon_s : float
    May be infinite.

Returns
-------
(...) array

Raises
------
ValueError
    When one is negative or NaN.)");

  m.def("closest_approach", &closest_approaches, py::arg("own"), py::arg("target"),
        py::arg("own_covariance") = py::none(), py::arg("target_covariance") = py::none(),
        R"(CPA and TCPA of ships at constant velocity, with their errors.

    tcpa = -p·v / |v|²,    d = p·n,    cpa = |d|,

with p and v the position and velocity of the target relative to own ship, n the unit vector to
starboard of v. At a relative speed of at most 1 µm/s the CPA is the present range and TCPA is 0.

Parameters
----------
own, target : (..., 4) array_like
    [x, vx, y, vy], metres and m/s; leading shapes are broadcast against each other.
own_covariance, target_covariance : (..., 4, 4) array_like, optional
    Covariances of independent errors; default none.

Returns
-------
ClosestApproach
    NaN where a state is NaN.

Raises
------
ValueError
    When a shape does not fit.)");
}

}  // namespace wakeline::python
