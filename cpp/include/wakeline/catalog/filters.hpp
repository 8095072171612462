// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "wakeline/catalog/belief.hpp"
#include "wakeline/catalog/custom_filter.hpp"
#include "wakeline/catalog/custom_sensor.hpp"
#include "wakeline/catalog/motions.hpp"
#include "wakeline/catalog/sensors.hpp"
#include "wakeline/catalog/type_list.hpp"
#include "wakeline/filter/alpha_beta.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/turn_rate_grid.hpp"

namespace wakeline {

/// One of some filters over some motion models, chosen at run time. Each call dispatches once and
/// then runs the template of that filter, with the same bits. A linear one takes linear sensors
/// only: a Kalman filter, which is an `Ekf` of linear motion, or an alpha-beta filter.
///
/// Members are defined out of class, so that a program may compile them once (`extern template`).
template <class FilterList>
class AnyFilterOf {
 public:
  using Scalar = double;
  using Variant = AsVariant<FilterList>;

  explicit AnyFilterOf(const Variant& filter, bool linear = false)
      : filter_(filter), linear_(linear || std::holds_alternative<AlphaBeta<>>(filter)) {}

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
    return with_model(
        sensor, [&](const auto& model) { return correct(model, sensor.observe(z)).scored(); });
  }

  /// Corrects the belief by a reading that the sensor has observed. An alpha-beta filter misses
  /// those of a sensor that is not direct.
  template <class Sensor>
  Correction<Sensor::kMeasurements> correct(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& reading) noexcept {
    return correct_by(model_of(sensor), reading);
  }

  /// The same of a sensor that is made at run time, or of a reading of which a part is missing. An
  /// alpha-beta filter misses it; a square-root filter corrects as `Ukf`.
  Correction<kMostNumbers> correct(const RuntimeSensor& sensor,
                                   const Gaussian<kMostNumbers>& reading) noexcept;

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

  template <class Sensor>
  Correction<Sensor::kMeasurements> correct_by(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& reading) noexcept;

 private:
  Variant filter_;
  bool linear_;
};

/// Gives the filter another turn rate, rad/s, positive to starboard.
template <class FilterList>
void set_turn_rate(AnyFilterOf<FilterList>& filter, double turn_rate_rad_s) noexcept {
  filter.set_turn_rate(turn_rate_rad_s);
}

/// An EKF, a UKF and a square-root UKF over each of some motion models.
template <class MotionList>
struct FiltersOver;
template <class... Motion>
struct FiltersOver<TypeList<Motion...>> {
  using Type = TypeList<Ekf<Motion>..., Ukf<Motion>..., SquareRootUkf<Motion>...>;
};
using MotionFilters = typename FiltersOver<Motions>::Type;

/// Those over the motion models of the catalogue, the alpha-beta filter, and filters over a motion
/// model that is made at run time.
using Filters = Joined<MotionFilters, TypeList<AlphaBeta<>, CustomFilter>>;

/// One of the filters of the catalogue.
using AnyFilter = AnyFilterOf<Filters>;

/// Makes a filter over a motion model, with the parameters that such a filter has.
/// Throws `std::invalid_argument` when a parameter makes no sense.
template <template <class, class> class Filter, class... Parameters>
AnyFilter any_filter(const AnyMotion& motion, const Parameters&... parameters) {
  return std::visit(
      [&]<class Motion>(const Motion& model) {
        return AnyFilter(Filter<Motion, double>(model, parameters...));
      },
      motion);
}

/// A Kalman filter. Throws `std::invalid_argument` when a parameter makes no sense.
inline AnyFilter any_kalman(const AnyLinearMotion& motion) {
  return std::visit(
      []<class Motion>(const Motion& model) { return AnyFilter(Ekf<Motion>(model), true); },
      motion);
}

/// Filters chosen at run time: the face of `FilterBank` and of `UniformBank`.
template <class FilterList>
class AnyFilterBankOf {
 public:
  using Filter = AnyFilterOf<FilterList>;
  using Scalar = double;
  static constexpr int kModels = kRuntimeModes;

  /// Throws `std::invalid_argument` without filters or with more than `kMaxModes`.
  explicit AnyFilterBankOf(const std::vector<Filter>& filters);

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

  /// A zero belief over the state of the filters where all share one, else over `[x, vx, y, vy]`.
  [[nodiscard]] AnyBelief empty_estimate() const noexcept { return empty_; }
  [[nodiscard]] const Filter& filter(int k) const {
    return slots_.at(static_cast<std::size_t>(k)).filter;
  }
  [[nodiscard]] Filter& filter(int k) { return slots_.at(static_cast<std::size_t>(k)).filter; }

 private:
  struct Slot {
    Filter filter;
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

using AnyFilterBank = AnyFilterBankOf<Filters>;
using AnyImm = Imm<AnyFilterBank>;

/// True where a value makes a `Kind` without loss: not where it is of a class derived from it.
template <class Kind, class Value>
inline constexpr bool kMakes = std::is_constructible_v<Kind, const Value&> &&
                               (std::is_same_v<Kind, Value> || !std::is_base_of_v<Kind, Value>);

/// The filters of a bank where all of them make a `Kind`; else none.
template <class Kind, class FilterList>
std::vector<Kind> filters_as(const AnyFilterBankOf<FilterList>& bank) {
  std::vector<Kind> filters;
  for (int k = 0; k < bank.size(); ++k) {
    const bool taken = std::visit(
        [&](const auto& filter) {
          if constexpr (kMakes<Kind, std::decay_t<decltype(filter)>>) {
            filters.push_back(filter);
            return true;
          } else {
            return false;
          }
        },
        bank.filter(k).variant());
    if (!taken) return {};
  }
  return filters;
}

/// An Imm over another bank, with the same chain and initial mode probabilities.
template <class Bank, class FilterList>
Imm<Bank> imm_over(const Bank& bank, const Imm<AnyFilterBankOf<FilterList>>& other) {
  Imm<Bank> imm(ModeChain<Bank::kModels>(other.chain()), bank);
  imm.set_initial_mode_probability(typename Imm<Bank>::Probability(
      other.initial_mode_probability().template cast<typename Bank::Scalar>()));
  return imm;
}

// Out of class: see above
// ---------------------------------------------------------------------------

template <class FilterList>
Status AnyFilterOf<FilterList>::start(const AnyBelief& belief) noexcept {
  return std::visit(
      [&]<class Filter>(Filter& filter) {
        if constexpr (std::is_same_v<Filter, CustomFilter>) {
          return filter.start(belief);
        } else {
          if (belief.layout == kLayoutOf<typename Filter::Motion>)
            return filter.start(belief.template fixed<Filter::kStates>());
          if constexpr (Filter::kStates != 4)
            if (belief.layout == StateLayout::kKinematics)
              return filter.start(belief.template fixed<4>());
          return Status::kNotStarted;
        }
      },
      filter_);
}

template <class FilterList>
Status AnyFilterOf<FilterList>::start(const Gaussian<4>& kinematics) noexcept {
  return std::visit([&](auto& filter) { return filter.start(kinematics); }, filter_);
}

template <class FilterList>
Status AnyFilterOf<FilterList>::assign(const AnyBelief& belief) noexcept {
  return std::visit(
      [&]<class Filter>(Filter& filter) {
        if constexpr (std::is_same_v<Filter, CustomFilter>)
          return filter.assign(belief);
        else
          return filter.assign(belief.template fixed<Filter::kStates>());
      },
      filter_);
}

template <class FilterList>
Status AnyFilterOf<FilterList>::predict(double dt_s) noexcept {
  return std::visit([&](auto& filter) { return filter.predict(dt_s); }, filter_);
}

template <class FilterList>
Status AnyFilterOf<FilterList>::predict(double dt_s,
                                        const Vec<double, 2>& acceleration_mps2) noexcept {
  return std::visit([&](auto& filter) { return filter.predict(dt_s, acceleration_mps2); }, filter_);
}

template <class FilterList>
template <class Sensor>
Correction<Sensor::kMeasurements> AnyFilterOf<FilterList>::correct_by(
    const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& reading) noexcept {
  return std::visit(
      [&]<class Filter>(Filter& filter) {
        Correction<Sensor::kMeasurements> result;
        if constexpr (!kIsDirect<Sensor> && std::is_same_v<Filter, AlphaBeta<>>)
          result.status = Status::kMissed;
        else
          result = filter.correct(sensor, reading);
        return result;
      },
      filter_);
}

template <class FilterList>
Correction<kMostNumbers> AnyFilterOf<FilterList>::correct(
    const RuntimeSensor& sensor, const Gaussian<kMostNumbers>& reading) noexcept {
  if (!started()) return {};
  Correction<kMostNumbers> of_whole;
  if (sensor.visit_whole(reading,
                         [&]<class Sensor, int M>(const Sensor& one, const Vec<double, M>& z) {
                           const Correction<M> correction = correct(one, one.observe(z));
                           of_whole.status = correction.status;
                           of_whole.innovation.template head<M>() = correction.innovation;
                           of_whole.innovation_covariance.template topLeftCorner<M, M>() =
                               correction.innovation_covariance;
                           of_whole.nis = correction.nis;
                           of_whole.peak = correction.peak;
                         }))
    return of_whole;
  return std::visit(
      [&]<class Filter>(Filter& filter) -> Correction<kMostNumbers> {
        if constexpr (std::is_same_v<Filter, CustomFilter>) {
          return filter.correct(sensor, reading);
        } else if constexpr (std::is_same_v<Filter, AlphaBeta<>>) {
          return {.status = Status::kMissed};
        } else {
          const Unscented* unscented = nullptr;
          if constexpr (requires { filter.unscented(); }) unscented = &filter.unscented();
          AnyBelief belief = estimate();
          Correction<kMostNumbers> correction =
              corrected(RuntimeInnovation(sensor, reading, unscented, belief), belief);
          if (correction.status == Status::kOk)
            correction.status = filter.assign(belief.template fixed<Filter::kStates>());
          return correction;
        }
      },
      filter_);
}

template <class FilterList>
void AnyFilterOf<FilterList>::archive(Archive& fields) {
  std::visit([&](auto& filter) { filter.archive(fields); }, filter_);
}

template <class FilterList>
AnyBelief AnyFilterOf<FilterList>::estimate() const noexcept {
  return std::visit(
      []<class Filter>(const Filter& filter) -> AnyBelief {
        if constexpr (std::is_same_v<Filter, CustomFilter>)
          return filter.estimate();
        else
          return any_belief<typename Filter::Motion>(filter.estimate());
      },
      filter_);
}

template <class FilterList>
bool AnyFilterOf<FilterList>::started() const noexcept {
  return std::visit([](const auto& filter) { return filter.started(); }, filter_);
}

template <class FilterList>
StateLayout AnyFilterOf<FilterList>::layout() const noexcept {
  return std::visit(
      []<class Filter>(const Filter& filter) {
        if constexpr (std::is_same_v<Filter, CustomFilter>)
          return filter.motion()->layout();
        else
          return kLayoutOf<typename Filter::Motion>;
      },
      filter_);
}

template <class FilterList>
bool AnyFilterOf<FilterList>::turns() const noexcept {
  return std::visit(
      [](const auto& filter) {
        return requires { filter.motion().turn_rate_rad_s; };
      },
      filter_);
}

template <class FilterList>
void AnyFilterOf<FilterList>::set_turn_rate(double turn_rate_rad_s) noexcept {
  std::visit(
      [&](auto& filter) {
        if constexpr (requires { filter.motion().turn_rate_rad_s; })
          wakeline::set_turn_rate(filter, turn_rate_rad_s);
      },
      filter_);
}

template <class FilterList>
AnyFilterBankOf<FilterList>::AnyFilterBankOf(const std::vector<Filter>& filters) {
  if (filters.empty() || filters.size() > kMaxModes)
    reject("filters must be 1 to " + std::to_string(kMaxModes) + " filters, got " +
           std::to_string(filters.size()));
  bool same = true;
  for (const Filter& filter : filters) {
    slots_.push_back({filter, filter.estimate(), true});
    same = same && filter.layout() == filters.front().layout();
  }
  for (const Filter& filter : filters)
    if (!same && !has_kinematics(filter.layout()))
      reject("filters of different states must all have [x, vx, y, vy] among their states");
  if (same) empty_ = filters.front().estimate();
  empty_ = zero_like(empty_);
}

}  // namespace wakeline
