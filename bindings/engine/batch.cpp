// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "lanes/lanes.hpp"
#include "mode_history.hpp"
#include "run.hpp"

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

LaneModel lane_model(const AnyFilter& filter) {
  return std::visit(
      []<class Filter>(const Filter& one) {
        LaneModel model;
        if constexpr (std::same_as<typename Filter::Motion, ConstantVelocity>)
          model.motion = CoordinatedTurn{.turn_rate_rad_s = 0.0, .noise = one.motion().noise};
        else
          model.motion = one.motion();
        if constexpr (requires { one.unscented(); }) {
          const bool keeps_root = requires { one.root(); };
          model.filter = keeps_root ? LaneFilter::kSquareRoot : LaneFilter::kUnscented;
          model.transform = one.unscented();
        }
        return model;
      },
      filter.variant());
}

/// Runs the job of some models. False, and nothing done, where the sensor or the runs are none for
/// lanes.
bool run(LaneJob& job, const Runs& runs) {
  if (kernels == nullptr || runs.in.runs < 2) return false;
  const bool known = std::visit(
      [&]<class Sensor>(const Sensor& one) {
        if constexpr (std::is_constructible_v<decltype(job.sensor), Sensor>) {
          job.sensor = one;
          return true;
        }
        return false;
      },
      runs.sensor);
  if (!known) return false;
  for (const AnyBelief& start : runs.starts) {
    LaneStart& lane = job.starts.emplace_back();
    lane.states = start.states();
    for (int i = 0; i < lane.states; ++i) {
      lane.mean[i] = start.mean[i];
      for (int j = 0; j < lane.states; ++j)
        lane.covariance[j * lane.states + i] = start.covariance(i, j);
    }
  }
  const ThreadShare threads(runs.in.runs * runs.in.scans /
                            static_cast<std::size_t>(kernels->lanes));
  return kernels->run(job, runs.in, runs.out, threads.count());
}

/// The same of an estimator of several models and what it has beside its chain.
template <class Estimator>
bool run_mixture(const Estimator& estimator, const Structure& structure, const Runs& runs) {
  LaneJob job;
  job.chain = &estimator.chain();
  job.structure = structure;
  for (int k = 0; k < estimator.bank().size(); ++k) {
    job.models.push_back(lane_model(AnyFilter(estimator.bank().filter(k))));
    job.initial_mode_probability.push_back(estimator.initial_mode_probability()[k]);
  }
  return run(job, runs);
}

/// The same of what draws lines.
bool run_lines(const LaneLines& lines, const Runs& runs) {
  LaneJob job;
  job.lines = lines;
  return run(job, runs);
}

}  // namespace

const LaneKernels* lane_kernels() noexcept { return kernels; }

void define_batch(py::module_& parent) {
  kernels = load();
  auto m = parent.def_submodule("batch", "Many runs at once: lanes and threads.");
  m.def(
      "lanes", [] { return kernels == nullptr ? 1 : kernels->lanes; },
      "Runs that go side by side in one register of this processor.");
  m.def("threads", &thread_limit,
        "Threads that all calls at one time use together: the environment's WAKELINE_THREADS or "
        "OMP_NUM_THREADS, else the processors that the process may run on, unless set.");
  m.def(
      "set_threads",
      [](int threads) {
        if (threads < 1)
          throw py::value_error("threads must be at least 1, got " + std::to_string(threads));
        set_thread_limit(threads);
      },
      py::arg("threads"),
      "Sets how many threads all calls at one time use together. Results do not depend on it.");
}

bool run_lanes(const AnyFilter& filter, const Runs& runs) {
  LaneJob job;
  job.models.push_back(lane_model(filter));
  return run(job, runs);
}

bool run_lanes(const AnyImm& imm, const Runs& runs) { return run_mixture(imm, {}, runs); }

bool run_lanes(const AnyAdaptiveGridImm& imm, const Runs& runs) {
  return run_mixture(imm, imm.grid(), runs);
}

bool run_lanes(const AnySwitchingGridImm& imm, const Runs& runs) {
  return run_mixture(imm, imm.grid(), runs);
}

bool run_lanes(const AnyLikelyModelSetImm& imm, const Runs& runs) {
  return run_mixture(imm, imm.grid(), runs);
}

bool run_lanes(const AnyBayesianAlphaBeta& lines, const Runs& runs) {
  return run_lines(lines.weighing(), runs);
}

bool run_lanes(const AnyFuzzyAlphaBeta& lines, const Runs& runs) {
  return run_lines(lines.criterion(), runs);
}

template <int Order>
bool run_lanes(const AnyAlphaBeta<Order>& filter, const Runs& runs) {
  return run_lines(LaneAlphaBeta<Order>{filter.schedule(), filter.motion()}, runs);
}
template bool run_lanes(const AnyAlphaBeta<2>&, const Runs&);
template bool run_lanes(const AnyAlphaBeta<3>&, const Runs&);

bool run_lanes(const AnyModeHistory& any, const Runs& runs) {
  return std::visit([&](const auto& history) { return run_mixture(history, history.tree(), runs); },
                    any.variant());
}

}  // namespace wakeline::python
