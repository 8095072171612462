// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "imm_smoother.hpp"

#include <array>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "run.hpp"
#include "wakeline/batch/run_smoothed.hpp"

namespace wakeline::python {

namespace {

/// Calls `function` with a belief that knows its components at compile time.
template <class Function>
auto visit_layout(const AnyBelief& any, const Function& function) noexcept {
  const auto with = [&]<class Motion>(const Motion&) {
    StateBelief<Motion::kComponents, double> belief;
    belief = Gaussian<kStatesOf<Motion>>{any.mean, any.covariance};
    return function(belief);
  };
  switch (any.layout) {
    case StateLayout::kKinematics:
      return with(ConstantVelocity{});
    case StateLayout::kTurn:
      return with(CoordinatedTurnRate{});
    default:
      return with(ConstantAcceleration{});
  }
}

template <int N>
AnyBelief to_any(StateLayout layout, const Gaussian<N>& belief) noexcept {
  return {layout, belief.mean, belief.covariance};
}

}  // namespace

/// As of Gaussians; all three are of one layout.
Revised<AnyBelief> revised(const AnyBelief& prior, const AnyBelief& before,
                           const AnyBelief& after) noexcept {
  return visit_layout(prior, [&]<int N>(const Gaussian<N>& belief) -> Revised<AnyBelief> {
    const auto result = wakeline::revised(belief, Gaussian<N>{before.mean, before.covariance},
                                          Gaussian<N>{after.mean, after.covariance});
    return {result.status, to_any(prior.layout, result.belief), result.log_evidence};
  });
}

/// As of beliefs whose components are known at compile time.
AnyBelief carried_over(const AnyBelief& own, const AnyBelief& part) noexcept {
  if (own.layout == part.layout) return part;
  return visit_layout(own, [&](const auto& to) {
    return visit_layout(part, [&](const auto& from) {
      return to_any(own.layout, wakeline::carried_over(to, from));
    });
  });
}

/// As of the filter itself.
template <class... Known>
Status smooth_pair(const AnyFilter& filter, AnyBelief& belief, const AnyBelief& later, double dt_s,
                   const Known&... acceleration_mps2) noexcept {
  return std::visit(
      [&]<class Filter>(const Filter& one) {
        StateBelief<Filter::kComponents, double> fixed;
        fixed = Gaussian<Filter::kStates>{belief.mean, belief.covariance};
        const Status status = wakeline::smooth_pair(
            one, fixed, Gaussian<Filter::kStates>{later.mean, later.covariance}, dt_s,
            acceleration_mps2...);
        belief.mean = fixed.mean;
        belief.covariance = fixed.covariance;
        return status;
      },
      filter.variant());
}

namespace {

/// All runs of an Imm, smoothed, each by itself. Throws where one cannot be.
struct RunSmoothed {
  template <class Sensor>
  void operator()(const AnyImm& prototype, const Sensor& sensor, const RunInput& in,
                  const std::vector<AnyBelief>& starts, const RunOutput& out) const {
    std::vector<Status> status(in.runs);
    const ThreadShare threads(in.runs * in.scans);
    Threads{threads.count()}(in.runs, [&](std::size_t run) noexcept {
      AnyImm imm = prototype;
      (void)imm.start(starts[starts.size() == 1 ? 0 : run]);
      status[run] = run_smoothed(imm, sensor, in, run, out);
    });
    for (std::size_t run = 0; run < in.runs; ++run)
      if (status[run] != Status::kOk)
        throw FilterError("smooth of run " + std::to_string(run) + ": " + to_string(status[run]));
  }
};

}  // namespace

void define_imm_smoother(py::class_<AnyImm>& imm) {
  imm.def(
      "smooth", &run<AnyImm, RunSmoothed>, py::arg("z"), py::arg("dt_s"), py::arg("sensor"),
      py::arg("start"), py::arg("own_position_m") = py::none(),
      py::arg("own_velocity_mps") = py::none(), py::arg("acceleration_mps2") = py::none(),
      py::arg("gate") = py::none(),
      R"(Runs whole recordings and smooths them: what each scan tells knows the scans after it, too.

Each pair of modes of two scans is a way of its own: carried back by the Rauch-Tung-Striebel
smoother of its filter, and as likely as it foretold what came. For recordings that are over; takes
K² predictions and smoothings a scan, one recording after the other on each thread. Where a step is
so long that nothing can be carried back over it (weeks, of `PiecewiseAcceleration`), what was
before is smoothed by itself.

Parameters
----------
z, dt_s, sensor, start, own_position_m, own_velocity_mps, acceleration_mps2, gate
    As of `run`.

Returns
-------
RunResult
    mean, covariance and mode_probability are smoothed, those of the last scan as filtered;
    innovation, nis, log_likelihood and status are those of `run`.

Raises
------
ValueError
    As of `run`.
FilterError
    When an estimator cannot start, or a recording cannot be smoothed: a step between two scans is
    below zero or no number.

References
----------
R. E. Helmick, W. D. Blair, S. A. Hoffman, IEEE Trans. Information Theory 41, 1995; N. Nadarajah,
R. Tharmarasa, M. McDonald, T. Kirubarajan, IEEE Trans. AES 48, 2012.)");
}

}  // namespace wakeline::python
