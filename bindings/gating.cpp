// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/gating/chi_square_gate.hpp"

#include "types.hpp"
#include "wakeline/gating/radius_gate.hpp"

namespace wakeline::python {

void define_gating(py::module_& parent) {
  py::module_ m = parent.def_submodule("gating", "Where to look for a target's plot.");
  py::class_<ChiSquareGate>(
      m, "ChiSquareGate",
      "The ellipsoid that holds the target's own plot with a given probability.")
      .def(py::init([](double probability) {
             const ChiSquareGate gate{probability};
             gate.validate();
             return gate;
           }),
           py::kw_only(), py::arg("probability") = ChiSquareGate{}.probability)
      .def_readonly("probability", &ChiSquareGate::probability)
      .def("threshold", &ChiSquareGate::threshold, py::arg("dof"),
           "Largest normalised innovation squared inside, for `dof` measured quantities.");
  py::class_<RadiusGate>(m, "RadiusGate", "A circle of fixed radius about the predicted position.")
      .def(py::init([](double radius_m) {
             const RadiusGate gate{radius_m};
             gate.validate();
             return gate;
           }),
           py::kw_only(), py::arg("radius_m") = RadiusGate{}.radius_m)
      .def_readonly("radius_m", &RadiusGate::radius_m)
      .def(
          "contains",
          [](const RadiusGate& gate, const DoubleArray& predicted_m, const DoubleArray& plot_m) {
            return gate.contains<double>(Vec<double, 2>(to_vector("predicted_m", predicted_m, 2)),
                                         Vec<double, 2>(to_vector("plot_m", plot_m, 2)));
          },
          py::arg("predicted_m"), py::arg("plot_m"), "Whether a plot [north, east] lies inside.");
}

}  // namespace wakeline::python
