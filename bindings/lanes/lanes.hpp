// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Runs as lanes: what the engine hands to a module that is compiled for one instruction set. Such a
// module shares no inline function with the engine, so that nothing meant for one processor runs on
// another.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "wakeline/batch/run.hpp"
#include "wakeline/simd/side_by_side.hpp"
#include "wakeline/filter/alpha_beta.hpp"
#include "wakeline/filter/unscented.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"
#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/singer.hpp"
#include "wakeline/motion/wandering_course.hpp"
#include "wakeline/multimodel/adaptive_grid_imm.hpp"
#include "wakeline/multimodel/bayesian_alpha_beta.hpp"
#include "wakeline/multimodel/fuzzy_criterion.hpp"
#include "wakeline/multimodel/history_tree.hpp"
#include "wakeline/multimodel/likely_model_set_imm.hpp"
#include "wakeline/multimodel/mode_chain.hpp"
#include "wakeline/multimodel/switching_grid_imm.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline::python {

enum class LaneFilter : std::uint8_t { kExtended, kUnscented, kSquareRoot };

/// One filter. Constant velocity is a turn at rate zero.
struct LaneModel {
  std::variant<CoordinatedTurn, CoordinatedTurnRate, ConstantAcceleration, Singer, WanderingCourse>
      motion;
  LaneFilter filter = LaneFilter::kExtended;
  Unscented transform = {};  ///< of all but the extended
};

/// An alpha-beta filter of 2 or 3 states an axis.
template <int Order>
struct LaneAlphaBeta {
  GainSchedule<Order> gains;
  typename AlphaBetaFilter<Order>::Motion motion;
};

/// What draws lines through plots, one or several.
using LaneLines =
    std::variant<std::monostate, LineWeighing, FuzzyCriterion, LaneAlphaBeta<2>, LaneAlphaBeta<3>>;

/// A belief of up to six states, column by column.
struct LaneStart {
  int states = 4;
  double mean[6] = {};
  double covariance[36] = {};
};

/// What a ModeHistory or an estimator over turn rates that change has beside its chain; nothing of
/// an Imm.
using Structure =
    std::variant<std::monostate, HistoryTree, AdaptiveGrid, SwitchingGrid, LikelyModelSet>;

/// An estimator, its sensor and where it starts.
struct LaneJob {
  std::vector<LaneModel> models;                    ///< none of an estimator that draws lines
  const ModeChain<kRuntimeModes>* chain = nullptr;  ///< between the models; none of one filter
  Structure structure = {};
  LaneLines lines = {};
  std::vector<double> initial_mode_probability;
  std::variant<RangeBearing, ConvertedRangeBearing, Position, RangeBearingDoppler> sensor;
  std::vector<LaneStart> starts;  ///< one for all runs, or one each
};

/// Steps of many estimators of a tracker.
class VesselLanes {
 public:
  virtual ~VesselLanes() = default;
  virtual void predict(std::span<PredictionStep<VesselImm>> steps) noexcept = 0;
  virtual void update(std::span<UpdateStep<VesselImm>> steps) noexcept = 0;
};

struct LaneKernels {
  /// Runs the job in lanes over some threads. False, and nothing done, when there is no kernel for
  /// it.
  bool (*run)(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads);
  std::unique_ptr<VesselLanes> (*vessels)(const VesselImm& prototype);
  int lanes;
};

/// Those for this processor; null where no module could be loaded.
const LaneKernels* lane_kernels() noexcept;

}  // namespace wakeline::python
