// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Filters composed at run time: a closed set of the shipped ones. Each step dispatches once and
// then runs the same template as C++ does, so that both give the same bits.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"
#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/singer.hpp"
#include "wakeline/motion/wandering_course.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::python {

/// The state layouts of the shipped motion models.
enum class StateLayout : std::uint8_t { kKinematics, kTurn, kAcceleration };

inline constexpr int kMaxStates = 6;

template <class Motion>
inline constexpr StateLayout kLayoutOf = kStatesOf<Motion> == 4   ? StateLayout::kKinematics
                                         : kStatesOf<Motion> == 5 ? StateLayout::kTurn
                                                                  : StateLayout::kAcceleration;

constexpr int states_of(StateLayout layout) noexcept {
  return layout == StateLayout::kKinematics ? 4 : layout == StateLayout::kTurn ? 5 : 6;
}

/// A belief over any of the layouts, without heap.
struct AnyBelief {
  StateLayout layout = StateLayout::kKinematics;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1> mean = Eigen::Vector4d::Zero();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates> covariance =
      Eigen::Matrix4d::Identity();

  [[nodiscard]] int states() const noexcept { return states_of(layout); }
};

inline void keep_lower(const AnyBelief& belief, AnyBelief& kept) noexcept { kept = belief; }
inline void complete(AnyBelief&) noexcept {}
AnyBelief zero_like(const AnyBelief& belief) noexcept;
void add_mean(AnyBelief& sum, double weight, const AnyBelief& part, const AnyBelief& own) noexcept;
void add_spread(AnyBelief& sum, double weight, const AnyBelief& part,
                const AnyBelief& own) noexcept;
Gaussian<4> kinematics_of(const AnyBelief& belief) noexcept;

/// One of the shipped filters over one of the shipped motion models. A linear one takes linear
/// sensors only.
class AnyFilter {
 public:
  using Scalar = double;
  using Variant =
      std::variant<Ekf<ConstantVelocity>, Ekf<WanderingCourse>, Ekf<ConstantAcceleration>,
                   Ekf<CoordinatedTurn>, Ekf<CoordinatedTurnRate>, Ekf<Singer>,
                   Ukf<ConstantVelocity>, Ukf<WanderingCourse>, Ukf<ConstantAcceleration>,
                   Ukf<CoordinatedTurn>, Ukf<CoordinatedTurnRate>, Ukf<Singer>,
                   SquareRootUkf<ConstantVelocity>, SquareRootUkf<WanderingCourse>,
                   SquareRootUkf<ConstantAcceleration>, SquareRootUkf<CoordinatedTurn>,
                   SquareRootUkf<CoordinatedTurnRate>, SquareRootUkf<Singer>>;

  explicit AnyFilter(const Variant& filter, bool linear = false)
      : filter_(filter), linear_(linear) {}

  /// Begins with a belief over the filter's state or over `[x, vx, y, vy]`.
  Status start(const AnyBelief& belief) noexcept;
  Status start(const Gaussian<4>& kinematics) noexcept;
  Status assign(const AnyBelief& belief) noexcept;
  Status predict(double dt_s) noexcept;
  /// Under a known acceleration, [north, east].
  Status predict(double dt_s, const Vec<double, 2>& acceleration_mps2) noexcept;

  template <class Sensor>
  Step<Sensor::kMeasurements> update(const Sensor& sensor,
                                     const Vec<double, Sensor::kMeasurements>& z) noexcept {
    return correct(sensor, sensor.observe(z)).scored();
  }

  /// The innovation of a reading, without taking it.
  template <class Sensor>
  Step<Sensor::kMeasurements> innovation(
      const Sensor& sensor, const Vec<double, Sensor::kMeasurements>& z) const noexcept {
    return compare(sensor, sensor.observe(z)).scored();
  }

  /// Corrects the belief by a reading that the sensor has observed. Of a direct sensor only the
  /// reading matters, so that one instantiation serves all.
  template <class Sensor>
  Correction<Sensor::kMeasurements> correct(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& reading) noexcept {
    if constexpr (kIsDirect<Sensor>)
      return correct_by(Fix{}, reading);
    else
      return correct_by(sensor, reading);
  }

  template <class Sensor>
  Correction<Sensor::kMeasurements> compare(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& reading) const noexcept {
    if constexpr (kIsDirect<Sensor>)
      return compare_by(Fix{}, reading);
    else
      return compare_by(sensor, reading);
  }

  void archive(Archive& fields);

  [[nodiscard]] AnyBelief estimate() const noexcept;
  [[nodiscard]] bool started() const noexcept;
  [[nodiscard]] StateLayout layout() const noexcept;
  [[nodiscard]] bool linear() const noexcept { return linear_; }
  /// True over a motion model with a known turn rate.
  [[nodiscard]] bool turns() const noexcept;
  /// Changes that turn rate; nothing where there is none.
  void set_turn_rate(double turn_rate_rad_s) noexcept;
  [[nodiscard]] const Variant& variant() const noexcept { return filter_; }
  [[nodiscard]] Variant& variant() noexcept { return filter_; }

 private:
  template <class Sensor>
  Correction<Sensor::kMeasurements> correct_by(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& reading) noexcept;
  template <class Sensor>
  Correction<Sensor::kMeasurements> compare_by(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& reading) const noexcept;

  Variant filter_;
  bool linear_;  ///< a Kalman filter
};

inline void set_turn_rate(AnyFilter& filter, double turn_rate_rad_s) noexcept {
  filter.set_turn_rate(turn_rate_rad_s);
}

extern template Correction<2> AnyFilter::correct_by(const RangeBearing&,
                                                    const Gaussian<2>&) noexcept;
extern template Correction<2> AnyFilter::correct_by(const Fix&, const Gaussian<2>&) noexcept;
extern template Correction<2> AnyFilter::compare_by(const Fix&, const Gaussian<2>&) const noexcept;
extern template Correction<3> AnyFilter::correct_by(const RangeBearingDoppler&,
                                                    const Gaussian<3>&) noexcept;

/// The filters of a multi-model estimator, composed at run time: the face of
/// `wakeline::FilterBank` and of `wakeline::UniformBank`.
class AnyFilterBank {
 public:
  static constexpr int kModels = kRuntimeModes;
  using Scalar = double;

  /// Throws `std::invalid_argument` without filters or with more than `kMaxModes`.
  explicit AnyFilterBank(const std::vector<AnyFilter>& filters);

  [[nodiscard]] int size() const noexcept { return static_cast<int>(slots_.size()); }
  [[nodiscard]] bool active(int k) const noexcept {
    return slots_[static_cast<std::size_t>(k)].active;
  }
  void set_active(int k, bool active) noexcept {
    slots_[static_cast<std::size_t>(k)].active = active;
  }

  template <class Function>
  void for_each(Function&& function) noexcept {
    visit(slots_, [&](int k, Slot& slot) { function(k, slot.filter, slot.before); });
  }

  template <class Function>
  void for_each(Function&& function) const noexcept {
    visit(slots_, [&](int k, const Slot& slot) { function(k, slot.filter); });
  }

  template <class Function>
  void for_each_belief(Function&& function) const noexcept {
    visit(slots_, [&](int k, const Slot& slot) { function(k, slot.filter.estimate()); });
  }

  template <class Function>
  void for_each_before(Function&& function) const noexcept {
    visit(slots_, [&](int k, const Slot& slot) { function(k, slot.before); });
  }

  [[nodiscard]] AnyBelief empty_estimate() const noexcept { return empty_; }
  [[nodiscard]] const AnyFilter& filter(std::size_t index) const { return slots_.at(index).filter; }
  [[nodiscard]] AnyFilter& filter(std::size_t index) { return slots_.at(index).filter; }

 private:
  struct Slot {
    AnyFilter filter;
    AnyBelief before;
    bool active = true;
  };

  template <class Slots, class Function>
  static void visit(Slots& slots, Function&& function) noexcept {
    for (int k = 0; auto& slot : slots) {
      if (slot.active) function(k, slot);
      ++k;
    }
  }

  std::vector<Slot> slots_;
  AnyBelief empty_;
};

using AnyImm = Imm<AnyFilterBank>;

}  // namespace wakeline::python
