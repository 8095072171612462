// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "types.hpp"

namespace wakeline::python {

void define_video(py::module_& parent) {
  py::module_ m = parent.def_submodule("video", "Radar video to plots.");
}

}  // namespace wakeline::python
