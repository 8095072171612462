// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Steps of one track as C++ takes them, which `wakeline bench` times.
#include <string>

#include "models.hpp"
#include "support/arguments.hpp"
#include "support/types.hpp"
#include "wakeline/filter/ukf.hpp"

namespace wakeline::python {
namespace {

using bench::kStep_s;
using Plots = std::vector<Vec<double, 2>>;

/// Has the compiler work out a value that nobody reads.
template <class Value>
void use(const Value& value) noexcept {
  asm volatile("" : : "m"(value) : "memory");
}

/// Goes round the course, each time from the start; returns the number of steps.
template <class Filter, class Sensor>
std::size_t go_round(Filter started, const Gaussian<4>& start, const Sensor& sensor,
                     const Plots& plots, int rounds) {
  (void)started.start(start);
  const auto step = [&](Filter & filter, const auto& z) __attribute__((flatten)) {
    use(filter.predict(kStep_s));
    use(filter.update(sensor, z));
    use(filter.estimate());
    use(filter);
  };
  for (int round = 0; round < rounds; ++round) {
    Filter filter = started;
    for (const auto& z : plots) step(filter, z);
  }
  return plots.size() * static_cast<std::size_t>(rounds);
}

std::size_t steps(const std::string& work, int rounds) {
  static const bench::Course<double> course;
  const auto polar = [&](const auto& filter) {
    return go_round(filter, course.start, bench::kRadar, course.polar, rounds);
  };
  if (work == "kf_step")
    return go_round(Kalman<ConstantVelocity>(bench::kSteady), course.start, bench::kFix,
                    course.position, rounds);
  if (work == "ekf_polar_step") return polar(Ekf<ConstantVelocity>(bench::kSteady));
  if (work == "ukf5_step") return polar(Ukf<CoordinatedTurnRate>(bench::kTurning));
  if (work == "imm3_step") return polar(bench::imm<3, double>());
  if (work == "imm5_step") return polar(bench::imm<5, double>());
  throw py::value_error(
      "work must be kf_step, ekf_polar_step, ukf5_step, imm3_step or imm5_step, got " +
      quoted(work));
}

}  // namespace

void define_benchmark(py::module_& m) {
  py::module_ benchmark =
      m.def_submodule("benchmark", "Steps of one track, for `wakeline bench` to time.");
  benchmark.def("steps", &steps, py::arg("work"), py::kw_only(), py::arg("rounds"),
                py::call_guard<py::gil_scoped_release>(),
                R"(Goes round a course, each round from the same start, and keeps nothing.

Parameters
----------
work : str
    kf_step, ekf_polar_step, ukf5_step, imm3_step or imm5_step.
rounds : int

Returns
-------
int
    How many steps these were.

Raises
------
ValueError
    When the work is another.)");
}

}  // namespace wakeline::python
