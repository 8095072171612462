// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "wakeline/batch/run.hpp"
#include "wakeline/core/archive.hpp"
#include "wakeline/multimodel/imm_smoother.hpp"

namespace wakeline {

/// Keeps beliefs and mode probabilities of a running Imm, after each prediction and at the end of
/// each scan.
template <class Bank>
class KeptScans {
 public:
  /// Of `imm`, which must be the one that runs.
  explicit KeptScans(Imm<Bank>& imm) : imm_(imm) { imm_.archive(one_); }

  void predicted(std::size_t, const Imm<Bank>&) const { imm_.archive(all_); }
  void updated(std::size_t, const Imm<Bank>&) const { imm_.archive(all_); }

  /// Writes those of a scan into Imms over the same models.
  void recall(std::size_t scan, ImmScan<Bank>& to) const {
    const std::size_t size = one_.bytes().size();
    Archive fields(std::span(all_.bytes()).subspan(2 * scan * size, 2 * size));
    to.predicted.archive(fields);
    to.updated.archive(fields);
  }

 private:
  Imm<Bank>& imm_;
  Archive one_;
  mutable Archive all_;
};

/// Runs a recording through a started Imm and smooths it: mean, covariance and mode probability of
/// each scan use the later readings too. A step so long that the predicted covariance has no factor
/// separates two stretches that are smoothed independently. Returns the status of any other
/// failure; the scans before it stay as filtered.
template <class Bank, class Sensor>
Status run_smoothed(Imm<Bank> imm, const Sensor& sensor, const RunInput& in, std::size_t run,
                    const RunOutput& out) {
  using Scalar = typename Bank::Scalar;
  const KeptScans<Bank> kept(imm);
  run_side_by_side(imm, sensor, in, run, out, kept);

  const RunLanes<Scalar> lanes(in, run);
  const RunColumn<Scalar> mean(lanes, out.mean, out.states),
      covariance(lanes, out.covariance, out.states * out.states),
      mode_probability(lanes, out.mode_probability, out.models);
  std::array<ImmScan<Bank>, 2> pair{ImmScan<Bank>{imm, imm}, ImmScan<Bank>{imm, imm}};
  for (std::size_t k = in.scans; k-- > 0;) {
    ImmScan<Bank>&now = pair[k % 2], &next = pair[(k + 1) % 2];
    kept.recall(k, now);
    now.dt_s = in.dt_s[k];
    if (k + 1 < in.scans) {
      std::array<Vec<Scalar, 2>, 1> known;
      const bool is_known = in.acceleration_mps2 != nullptr;
      if (is_known) known[0] = Vec<double, 2>(in.acceleration_mps2 + 2 * (k + 1)).cast<Scalar>();
      const Status status = ImmSmoother<Bank>::smooth(
          now.updated, next, std::span<const Vec<Scalar, 2>>(known).first(is_known ? 1 : 0));
      if (status != Status::kOk && status != Status::kNotPositiveDefinite) return status;
    }
    const auto belief = now.updated.estimate();
    mean.write(k, belief.mean);
    covariance.write(k, belief.covariance);
    mode_probability.write(k, now.updated.mode_probability());
  }
  return Status::kOk;
}

}  // namespace wakeline
