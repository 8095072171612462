// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "support/border.hpp"
#include "support/types.hpp"

PYBIND11_MODULE(_engine, m) {
  m.doc() = "The C++ engine of Wakeline.";
  wakeline::python::define_core(m);
  wakeline::python::define_motion(m);
  wakeline::python::define_measurement(m);
  wakeline::python::define_custom(m);
  wakeline::python::define_gating(m);
  wakeline::python::define_filter(m);
  wakeline::python::define_multimodel(m);
  wakeline::python::define_association(m);
  wakeline::python::define_track(m);
  wakeline::python::define_navigation(m);
  wakeline::python::define_eval(m);
  wakeline::python::define_video(m);
  wakeline::python::define_wire(m);
  wakeline::python::define_batch(m);
  wakeline::python::define_benchmark(m);
  wakeline::python::finish_border(m);
}
