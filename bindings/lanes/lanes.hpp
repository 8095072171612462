// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Estimators in lanes: a module for each instruction set, which shares no inline function with the
// engine, so that nothing meant for one processor runs on another. What goes across is the
// catalogue's own objects, whose layout is the same in all modules.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "wakeline/batch/run.hpp"
#include "wakeline/catalog/custom_sensor.hpp"
#include "wakeline/catalog/filters.hpp"
#include "wakeline/catalog/mode_history.hpp"
#include "wakeline/catalog/sensors.hpp"
#include "wakeline/simd/side_by_side.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline::python {

/// Recordings of a sensor of two numbers, the beliefs that they begin with (one for all, or one
/// each), where the results go and over how many threads.
struct LaneRecordings {
  const AnySensorOf<2>& sensor;
  const RunInput& in;
  const std::vector<AnyBelief>& starts;
  const RunOutput& out;
  int threads;
};

/// A filter over a linear motion model, with a linear sensor.
class LinearSteps {
 public:
  virtual ~LinearSteps() = default;
  /// F and Q over a step.
  virtual void matrices(double dt_s, AnyBelief::Covariance& f,
                        AnyBelief::Covariance& q) const noexcept = 0;
  /// Updates a belief with a reading.
  virtual Step<kMostNumbers> update(AnyBelief& belief,
                                    const Vec<double, kMostNumbers>& z) const noexcept = 0;
};

/// Recordings of such a filter: readings in rows of `kMostNumbers`, none of which lacks a part, z =
/// H x + v, v ~ N(0, R) of its whole state.
struct LinearRecordings {
  const LinearSteps& filter;
  StateLayout layout;
  ReadingJacobian h;
  ReadingMatrix r;
  const RunInput& in;
  const std::vector<AnyBelief>& starts;  ///< over the state
  const RunOutput& out;
  int threads;
};

/// Steps of many estimators of a tracker.
class VesselLanes {
 public:
  virtual ~VesselLanes() = default;
  virtual void predict(std::span<PredictionStep<VesselImm>> steps) noexcept = 0;
  virtual void update(std::span<UpdateStep<VesselImm>> steps) noexcept = 0;
};

/// What such a module does. A run returns false, and does nothing, where the estimator is one that
/// has no lanes: over a motion model that is not for packs, of matrices with other zeros than those
/// of the catalogue, or with starts of several layouts.
struct LaneKernels {
  int lanes;
  /// Recordings side by side.
  bool (*run_filter)(const AnyFilter& filter, const LaneRecordings& recordings);
  bool (*run_imm)(const AnyImm& imm, const LaneRecordings& recordings);
  /// The same of matrices that are known at run time.
  void (*run_linear)(const LinearRecordings& recordings);
  /// The hypotheses of a recording side by side.
  bool (*run_history)(const AnyModeHistory& history, const LaneRecordings& recordings);
  std::unique_ptr<VesselLanes> (*vessels)(const VesselImm& prototype);
};

/// Those for this processor; null where no module could be loaded.
const LaneKernels* lane_kernels() noexcept;

}  // namespace wakeline::python
