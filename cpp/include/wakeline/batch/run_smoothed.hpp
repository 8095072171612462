// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "wakeline/batch/run.hpp"
#include "wakeline/multimodel/imm_smoother.hpp"

namespace wakeline {

/// Stores the state of an Imm in each scan of a run.
template <class Bank>
struct KeepScans {
  std::vector<ImmScan<Bank>>& scans;
  const RunInput& in;

  void predicted(std::size_t scan, const Imm<Bank>& imm) const noexcept {
    scans[scan].predicted = imm;
    scans[scan].dt_s = in.dt_s[scan];
  }
  void updated(std::size_t scan, const Imm<Bank>& imm) const noexcept { scans[scan].updated = imm; }
};

/// Smooths the scans of a recording backwards. A step so long that the predicted covariance has no
/// factor separates two stretches that are smoothed independently. Returns the status of any other
/// failure; the scans before it stay as filtered.
template <class Bank>
Status smooth_stretches(std::span<ImmScan<Bank>> scans,
                        std::span<const Vec<typename Bank::Scalar, 2>> acceleration_mps2) {
  for (std::size_t k = scans.size(); k-- > 1;) {
    const auto known =
        acceleration_mps2.empty() ? acceleration_mps2 : acceleration_mps2.subspan(k - 1, 2);
    const Status status = ImmSmoother<Bank>::smooth(scans.subspan(k - 1, 2), known);
    if (status != Status::kOk && status != Status::kNotPositiveDefinite) return status;
  }
  return Status::kOk;
}

/// Runs a recording through a started Imm and smooths it: mean, covariance and mode probability of
/// each scan use the later readings too, up to a step that separates stretches
/// (`smooth_stretches`). Returns the status of a failure; the scans before it stay as filtered.
template <class Bank, class Sensor>
Status run_smoothed(Imm<Bank> imm, const Sensor& sensor, const RunInput& in, std::size_t run,
                    const RunOutput& out) {
  using Scalar = typename Bank::Scalar;
  std::vector<ImmScan<Bank>> scans(in.scans, {imm, imm});
  run_side_by_side(imm, sensor, in, run, out, KeepScans<Bank>{scans, in});
  std::vector<Vec<Scalar, 2>> known;
  if (in.acceleration_mps2 != nullptr)
    for (std::size_t k = 0; k < in.scans; ++k)
      known.emplace_back(in.acceleration_mps2[2 * k], in.acceleration_mps2[2 * k + 1]);
  const Status status = smooth_stretches<Bank>(scans, known);

  const RunLanes<Scalar> lanes(in, run);
  const RunColumn<Scalar> mean(lanes, out.mean, out.states),
      covariance(lanes, out.covariance, out.states * out.states),
      mode_probability(lanes, out.mode_probability, out.models);
  for (std::size_t k = 0; k < in.scans; ++k) {
    const auto belief = scans[k].updated.estimate();
    mean.write(k, belief.mean);
    covariance.write(k, belief.covariance);
    mode_probability.write(k, scans[k].updated.mode_probability());
  }
  return status;
}

}  // namespace wakeline
