// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "lanes/lanes.hpp"

#include "support/types.hpp"
#include "thread_share.hpp"

namespace wakeline::python {
namespace {

/// Names of the modules of lanes, the widest first, that this processor can run.
std::vector<const char*> module_names() {
  std::vector<const char*> names;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    names.push_back("_lanes_avx512");
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    names.push_back("_lanes_avx2");
#endif
  names.push_back("_lanes");
  return names;
}

const LaneKernels* load() {
  for (const char* name : module_names()) {
    try {
      const py::object module = py::module_::import((std::string("wakeline.") + name).c_str());
      return module.attr("kernels").cast<py::capsule>().get_pointer<const LaneKernels>();
    } catch (const py::error_already_set& error) {
      if (!error.matches(PyExc_ImportError)) throw;
    }
  }
  return nullptr;
}

const LaneKernels* kernels = nullptr;

}  // namespace

const LaneKernels* lane_kernels() noexcept { return kernels; }

void define_batch(py::module_& parent) {
  kernels = load();
  auto m = parent.def_submodule("batch", "Many runs at once: lanes and threads.");
  m.def(
      "lanes", [] { return kernels == nullptr ? 1 : kernels->lanes; },
      "Runs side by side in one register of this processor.");
  m.def("threads", &thread_limit,
        "Threads that all simultaneous calls share: the environment's WAKELINE_THREADS or "
        "OMP_NUM_THREADS, else the processors that the process may run on, unless set.");
  m.def(
      "set_threads",
      [](int threads) {
        if (threads < 1)
          throw py::value_error("threads must be at least 1, got " + std::to_string(threads));
        set_thread_limit(threads);
      },
      py::arg("threads"),
      "Set the number of threads that all simultaneous calls share. Results do not depend on it.");
}

}  // namespace wakeline::python
