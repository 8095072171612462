// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The trackers of vessels that Python has, with or without a window for late data.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "estimators.hpp"
#include "lanes/lanes.hpp"
#include "support/arguments.hpp"
#include "support/thread_lock.hpp"
#include "support/types.hpp"
#include "track_table.hpp"
#include "wakeline/track/late_window.hpp"
#include "wakeline/track/tracker.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline::python {

/// Steps of the usual estimator in the lanes of this processor.
class VesselSteps {
 public:
  explicit VesselSteps(const VesselImm& prototype) : one_by_one_(prototype) {
    if (const LaneKernels* kernels = lane_kernels()) lanes_ = kernels->vessels(prototype);
  }

  void predict(std::span<PredictionStep<VesselImm>> steps) noexcept {
    lanes_ ? lanes_->predict(steps) : one_by_one_.predict(steps);
  }
  void update(std::span<UpdateStep<VesselImm>> steps) noexcept {
    lanes_ ? lanes_->update(steps) : one_by_one_.update(steps);
  }

 private:
  OneByOne<VesselImm> one_by_one_;
  std::unique_ptr<VesselLanes> lanes_;
};

using VesselTracker = Tracker<VesselImm, VesselSteps>;

using LockedTracker = LockedVariant<VesselTracker, Tracker<AnyEstimator>, LateWindow<VesselTracker>,
                                    LateWindow<Tracker<AnyEstimator>>>;

/// A tracker with any estimator.
class AnyTracker : public LockedTracker {
 public:
  /// Behind a window for late data where one is given.
  AnyTracker(std::span<const Radar> radars, const TrackerConfig& config,
             const AnyEstimator& estimator, const LateWindowConfig* window)
      : LockedTracker(make<Tracker<AnyEstimator>>(window, radars, config, estimator)) {}
  AnyTracker(std::span<const Radar> radars, const TrackerConfig& config, const VesselImm& imm,
             const LateWindowConfig* window)
      : LockedTracker(make<VesselTracker>(window, radars, config, imm)) {}

  /// Raises what a function of the estimator's models has raised in the call.
  template <class Function>
  auto visit(const Function& function) {
    return checked([&] { return LockedTracker::visit(function); });
  }
  /// Calls a function with the tracker, also of a window.
  template <class Function>
  auto visit(const Function& function) const {
    return checked([&] {
      return LockedTracker::visit([&](const auto& one) { return function(tracker_of(one)); });
    });
  }
  /// Calls a function with the window, which there must be.
  template <class Function>
  auto visit_window(const Function& function) {
    return checked([&] {
      const auto hold = lock();
      const auto usual = std::get_if<LateWindow<VesselTracker>>(&object_);
      return usual != nullptr ? function(*usual)
                              : function(std::get<LateWindow<Tracker<AnyEstimator>>>(object_));
    });
  }

  [[nodiscard]] bool has_window() const noexcept { return object_.index() > 1; }

 private:
  template <class Call>
  auto checked(const Call& call) const {
    if constexpr (std::is_void_v<decltype(call())>) {
      call();
      raise_faults();
    } else {
      auto result = call();
      raise_faults();
      return result;
    }
  }
  template <class One, class... Arguments>
  static Variant make(const LateWindowConfig* window, const Arguments&... arguments) {
    if (window == nullptr) return One(arguments...);
    return LateWindow<One>(*window, arguments...);
  }

  template <class Estimator, class Steps>
  static const auto& tracker_of(const Tracker<Estimator, Steps>& tracker) {
    return tracker;
  }
  template <class One>
  static const One& tracker_of(const LateWindow<One>& window) {
    return window.tracker();
  }

  void raise_faults() const {
    std::visit(
        []<class One>(const One& one) {
          using Estimator = std::decay_t<decltype(tracker_of(one).prototype())>;
          if constexpr (std::is_same_v<Estimator, AnyEstimator>)
            raise_fault(tracker_of(one).prototype());
        },
        object_);
  }
};

struct PyReport {
  py::array_t<std::int64_t> plot_track_id;
  std::vector<Event> events;
  int rejected_plots;
};

struct PyReportResult {
  Status status;
  std::int64_t track_id;
  std::vector<Event> events;
};

/// Radars by number, of which some may have been removed: one alone is not a list.
using Radars = std::variant<Radar, std::vector<std::optional<Radar>>>;

/// A tracker with the arguments that Python has, behind a window where one is given.
AnyTracker make_tracker(const Radars& radars, const TrackerConfig& config,
                        const VesselModels& models, const py::object& estimator,
                        const LateWindowConfig* window = nullptr);

/// The arguments of an equal one.
Arguments tracker_arguments(const AnyTracker& any);

/// The tracks at a time; not `predicted`, each at that of its last update.
PyTracks tracks_of(const AnyTracker& any, const std::optional<double>& time_s, bool tentative,
                   bool predicted);

}  // namespace wakeline::python
