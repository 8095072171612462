// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What `wakeline bench` times of one track: steps as C++ takes them, and as one writes them by
// hand.
#include <string>

#include "hand_loops.hpp"
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
template <class Filter, class Step>
std::size_t go_round(const Filter& started, const Plots& plots, int rounds, const Step& step) {
  for (int round = 0; round < rounds; ++round) {
    Filter filter = started;
    for (const auto& z : plots) {
      step(filter, z);
      use(filter);
    }
  }
  return plots.size() * static_cast<std::size_t>(rounds);
}

template <class Hand>
std::size_t by_hand(const Hand& started, const Plots& plots, int rounds) {
  return go_round(
      started, plots, rounds,
      [](Hand & hand, const auto& z) __attribute__((flatten)) { hand.step(z); });
}

template <class Sensor, class Filter>
std::size_t by_us(Filter filter, const Gaussian<4>& start, const Sensor& sensor, const Plots& plots,
                  int rounds) {
  (void)filter.start(start);
  return go_round(
      filter, plots, rounds, [&](Filter & at, const auto& z) __attribute__((flatten)) {
        use(at.predict(kStep_s));
        use(at.update(sensor, z));
        use(at.estimate());
      });
}

template <int Modes>
std::size_t imm_steps(const bench::Course<double>& course, bool hand, int rounds) {
  if (hand) return by_hand(bench::HandImm<Modes, double>(course.start), course.polar, rounds);
  return by_us(bench::imm<Modes, double>(), course.start, bench::kRadar, course.polar, rounds);
}

std::size_t ukf_steps(const bench::Course<double>& course, bool hand, int rounds) {
  Ukf<CoordinatedTurnRate> filter(bench::kTurning);
  (void)filter.start(course.start);
  if (hand) return by_hand(bench::HandUkf<double>(filter.estimate()), course.polar, rounds);
  return by_us(filter, course.start, bench::kRadar, course.polar, rounds);
}

std::size_t steps(const std::string& work, bool hand, int rounds) {
  static const bench::Course<double> course;
  if (work == "kf_step") {
    if (hand)
      return by_hand(bench::HandKalman<false, double>(course.start), course.position, rounds);
    return by_us(Kalman<ConstantVelocity>(bench::kSteady), course.start, bench::kFix,
                 course.position, rounds);
  }
  if (work == "ekf_polar_step") {
    if (hand) return by_hand(bench::HandKalman<true, double>(course.start), course.polar, rounds);
    return by_us(Ekf<ConstantVelocity>(bench::kSteady), course.start, bench::kRadar, course.polar,
                 rounds);
  }
  if (work == "ukf5_step") return ukf_steps(course, hand, rounds);
  if (work == "imm3_step") return imm_steps<3>(course, hand, rounds);
  if (work == "imm5_step") return imm_steps<5>(course, hand, rounds);
  throw py::value_error(
      "work must be kf_step, ekf_polar_step, ukf5_step, imm3_step or imm5_step, got " + work);
}

}  // namespace

void define_benchmark(py::module_& m) {
  py::module_ benchmark =
      m.def_submodule("benchmark", "Steps of one track, for `wakeline bench` to time.");
  benchmark.def("steps", &steps, py::arg("work"), py::kw_only(), py::arg("hand"), py::arg("rounds"),
                py::call_guard<py::gil_scoped_release>(),
                R"(Goes round a course, each round from the same start, and keeps nothing.

Parameters
----------
work : str
    kf_step, ekf_polar_step, ukf5_step, imm3_step or imm5_step.
hand : bool
    True: the loop that one writes by hand from the book, in fixed-size Eigen. False: the engine's
    templates, which check every step and tell more of it.
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
