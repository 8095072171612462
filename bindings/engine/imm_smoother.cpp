// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include "multimodel.hpp"
#include "thread_share.hpp"
#include "wakeline/batch/run_smoothed.hpp"
#include "wakeline/catalog/imm_smoother.hpp"

namespace wakeline {

template Status smooth_any_pair(const AnyFilter&, AnyBelief&, const AnyBelief&, double,
                                std::span<const Vec<double, 2>>) noexcept;

}  // namespace wakeline

namespace wakeline::python {
namespace {

/// All recordings of an Imm, smoothed, each by itself. Throws where one cannot be.
int smooth_all(const AnyImm& prototype, const Recordings& recordings) {
  const RunInput& in = recordings.in;
  std::vector<Status> status(in.runs);
  const ThreadShare threads(in.runs * in.scans);
  const bool calls = calls_python(prototype) || calls_python(recordings.sensor);
  const auto smooth_with = [&](const auto& sensor) {
    Threads{calls ? 1 : threads.count()}(in.runs, [&](std::size_t run) noexcept {
      AnyImm imm = prototype;
      (void)imm.start(recordings.start(run));
      status[run] = run_smoothed(imm, sensor, in, run, recordings.out);
    });
  };
  if (const auto* const sensor = std::get_if<RuntimeSensor>(&recordings.sensor))
    smooth_with(*sensor);
  else
    visit_numbers(std::get<AnySensor>(recordings.sensor), smooth_with);
  raise_fault(prototype);
  for (std::size_t run = 0; run < in.runs; ++run)
    if (status[run] != Status::kOk)
      throw FilterError("smooth of run " + std::to_string(run) + ": " + to_string(status[run]));
  return calls ? 0 : 1;
}

RunResult smooth(const PyEstimator<AnyImm>& estimator, const RunArguments& arguments) {
  const ReadingSensor sensor =
      to_reading_sensor(static_cast<const AnyEstimator&>(estimator), arguments.sensor, arguments.z,
                        arguments.covariance.has_value());
  warn_of_uneven_steps(estimator, arguments.dt_s);
  const AnyImm prototype = estimator.get();  // as another thread may change it meanwhile
  return run_recordings(run_layout(estimator), arguments, sensor,
                        [&](const Recordings& recordings) {
                          require_starts(prototype, recordings.starts);
                          return smooth_all(prototype, recordings);
                        });
}

}  // namespace

void define_imm_smoother(EstimatorClass<AnyImm>& imm) {
  define_run(imm, "smooth", &smooth,
             R"(Run and smooth whole recordings: each estimate also uses later scans.

Each pair of modes of two scans is a separate path, smoothed by the Rauch-Tung-Striebel smoother of
its filter and weighted by how well it predicted the later readings. A scan takes K² predictions and
smoothings; each thread takes one recording after the other. If a step is too long to smooth across
(weeks, with `PiecewiseAcceleration`), the part before it is smoothed separately.

Parameters
----------
z, dt_s, sensor, start, own_position_m, own_velocity_mps, acceleration_mps2, gate, reopen_after, covariance
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
    When an estimator cannot start, or a recording cannot be smoothed because a step between two
    scans is negative or NaN.

References
----------
R. E. Helmick, W. D. Blair, S. A. Hoffman, IEEE Trans. Information Theory 41, 1995; N. Nadarajah,
R. Tharmarasa, M. McDonald, T. Kirubarajan, IEEE Trans. AES 48, 2012.)");
}

}  // namespace wakeline::python
