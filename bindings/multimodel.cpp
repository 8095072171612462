// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "run.hpp"

namespace wakeline::python {
namespace {

using Chain = ModeChain<kRuntimeModes>;

Chain make_chain(const DoubleArray& matrix, const std::optional<double>& period_s) {
  require_shape(matrix.ndim() == 2 && matrix.shape(0) == matrix.shape(1) && matrix.shape(0) > 0 &&
                    matrix.shape(0) <= kMaxModes,
                "matrix", "(K, K), K at most " + std::to_string(kMaxModes), matrix);
  const Chain::Matrix rows = to_matrix("matrix", matrix, matrix.shape(0), matrix.shape(0));
  return period_s ? Chain(rows, *period_s) : Chain(rows);
}

AnyImm make_imm(const std::vector<AnyFilter>& filters, const Chain& chain,
                const std::optional<DoubleArray>& initial) {
  AnyImm imm(chain, AnyFilterBank(filters));
  if (initial)
    imm.set_initial_mode_probability(
        to_vector("initial_mode_probability", *initial, static_cast<py::ssize_t>(filters.size())));
  return imm;
}

std::vector<AnyFilter> to_filters(const py::sequence& sequence) {
  std::vector<AnyFilter> filters;
  for (const py::handle item : sequence) {
    if (!py::isinstance<AnyFilter>(item))
      throw py::type_error("filters must be Kalman, Ekf, Ukf or SquareRootUkf, got " +
                           py::str(py::type::of(item).attr("__name__")).cast<std::string>());
    filters.push_back(item.cast<const AnyFilter&>());
  }
  return filters;
}

}  // namespace

void define_multimodel(py::module_& parent) {
  py::module_ m = parent.def_submodule("multimodel", "Estimators with several motion models.");

  py::class_<Chain>(
      m, "ModeChain",
      R"(The Markov chain between modes: `matrix[i, j] = P(mode j now | mode i before)`.

Parameters
----------
matrix : (K, K) array
    Rows sum to 1.
period_s : float, optional
    The time the matrix stands for; the chain then depends on the time step. Left out, the matrix is applied once per
    prediction.

Raises
------
ValueError
    When a row is no distribution, or no continuous-time chain has this matrix over the period.)")
      .def(py::init(&make_chain), py::arg("matrix"), py::arg("period_s") = py::none())
      .def_static(
          "from_sojourn_s",
          [](const DoubleArray& sojourn_s) {
            const Eigen::VectorXd times = to_vector("sojourn_s", sojourn_s);
            if (times.size() < 1 || times.size() > kMaxModes)
              throw py::value_error("sojourn_s must have 1 to " + std::to_string(kMaxModes) +
                                    " times, got " + std::to_string(times.size()));
            return Chain::from_sojourn_s(ModeVector<double, kRuntimeModes>(times));
          },
          py::arg("sojourn_s"),
          "The chain that stays in mode k for sojourn_s[k] seconds on average and leaves to each "
          "other mode alike.")
      .def(
          "transition",
          [](const Chain& chain, double dt_s) { return to_array(chain.transition(dt_s)); },
          py::arg("dt_s"), "P(dt), (K, K).")
      .def_property_readonly("modes", [](const Chain& chain) { return chain.modes(); })
      .def_property_readonly("continuous", &Chain::continuous);

  py::class_<AnyImm>(m, "Imm", R"(The interacting multiple model estimator.

Parameters
----------
filters : sequence of K filters
    Of any kinds and state sizes.
chain : ModeChain
initial_mode_probability : (K,) array, optional
    What a start begins with; uniform when left out.)")
      .def(py::init([](const py::sequence& filters, const Chain& chain,
                       const std::optional<DoubleArray>& initial) {
             return make_imm(to_filters(filters), chain, initial);
           }),
           py::arg("filters"), py::arg("chain"), py::arg("initial_mode_probability") = py::none())
      .def(
          "start",
          [](AnyImm& imm, const PyGaussian& belief) {
            require_ok(imm.start(to_start("belief", belief, states_of(imm))), "start");
          },
          py::arg("belief"),
          "Begins with a belief over [x, vx, y, vy], or over the state that all filters share.")
      .def(
          "predict", [](AnyImm& imm, double dt_s) { require_ok(imm.predict(dt_s), "predict"); },
          py::arg("dt_s"), "Mixes and moves dt_s seconds on; mode probabilities follow the chain.")
      .def(
          "update",
          [](AnyImm& imm, const py::object& sensor, const DoubleArray& z) {
            return visit_sensor(sensor, [&]<class Sensor>(const Sensor& model) {
              require_linear<Sensor>(imm);
              constexpr int kM = Sensor::kMeasurements;
              const auto step = imm.update(model, Vec<double, kM>(to_vector("z", z, kM)));
              require_ok(step.status, "update");
              return to_step(step);
            });
          },
          py::arg("sensor"), py::arg("z"),
          "Corrects every model and weighs them; returns the Step.")
      .def(
          "estimate", [](const AnyImm& imm) { return to_gaussian(imm.estimate()); },
          "The moment-matched belief: over the state where all filters share one, else over [x, "
          "vx, y, vy].")
      .def(
          "mode_probability", [](const AnyImm& imm) { return to_array(imm.mode_probability()); },
          "(K,)")
      .def(
          "filter_estimate",
          [](const AnyImm& imm, std::size_t index) {
            return to_gaussian(imm.bank().filter(index).estimate());
          },
          py::arg("index"), "The belief of one of the filters, over its own state.")
      .def_property_readonly("models", [](const AnyImm& imm) { return imm.bank().size(); })
      .def_property_readonly("started", &AnyImm::started)
      .def("run", &run<AnyImm>, py::arg("z"), py::arg("dt_s"), py::arg("sensor"), py::arg("start"),
           py::arg("own_position_m") = py::none(), kRunDoc);
}

}  // namespace wakeline::python
