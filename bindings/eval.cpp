// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/eval/consistency.hpp"

#include "types.hpp"

namespace wakeline::python {

void define_eval(py::module_& parent) {
  py::module_ m =
      parent.def_submodule("eval", "Whether an estimator tells the truth about its errors.");
  m.def(
      "consistency_bounds",
      [](double confidence, int dof, long samples) {
        if (!(confidence > 0.0 && confidence < 1.0) || dof < 1 || samples < 1)
          throw py::value_error(
              "confidence must lie between 0 and 1, dof and samples must be at least 1");
        const ConsistencyBounds bounds = consistency_bounds(confidence, dof, samples);
        return py::make_tuple(bounds.lower, bounds.upper);
      },
      py::arg("confidence"), py::arg("dof"), py::arg("samples"),
      "(lower, upper) bounds of the average NEES or NIS of that many samples of a consistent "
      "estimator.");
}

}  // namespace wakeline::python
