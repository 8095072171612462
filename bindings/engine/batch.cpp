// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <thread>

#if defined(__linux__)
#include <sched.h>
#endif

#include "lanes/lanes.hpp"
#include "support/types.hpp"
#include "thread_share.hpp"

namespace wakeline::python {
namespace {

/// To start a thread takes about as long as so many steps.
constexpr std::size_t kWorthThread_steps = 500;

int processors() noexcept {
#if defined(__linux__)
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
#endif
  return static_cast<int>(std::thread::hardware_concurrency());
}

int initial_limit() noexcept {
  for (const char* name : {"WAKELINE_THREADS", "OMP_NUM_THREADS"})
    if (const char* value = std::getenv(name))
      if (const int threads = std::atoi(value); threads > 0) return threads;
  return std::max(processors(), 1);
}

std::atomic<int>& limit() noexcept {
  static std::atomic<int> threads{initial_limit()};
  return threads;
}

std::atomic<int> others_of_all{0};

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

int thread_limit() noexcept { return limit(); }
void set_thread_limit(int threads) noexcept { limit() = std::max(threads, 1); }

ThreadShare::ThreadShare(std::size_t steps) noexcept {
  const int worth = static_cast<int>(std::min<std::size_t>(steps / kWorthThread_steps, 1024));
  int taken = others_of_all;
  do {
    others_ = std::clamp(thread_limit() - 1 - taken, 0, worth);
  } while (!others_of_all.compare_exchange_weak(taken, taken + others_));
}

ThreadShare::~ThreadShare() { others_of_all -= others_; }

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
