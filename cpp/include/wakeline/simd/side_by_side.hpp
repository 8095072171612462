// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Steps of many estimators with the same parameters, several of them in the lanes of one.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <utility>

#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/model_group_imm.hpp"
#include "wakeline/simd/flatten.hpp"
#include "wakeline/simd/pack_math.hpp"
#include "wakeline/simd/prefetch.hpp"

namespace wakeline {

/// One prediction step of an estimator and its result.
template <class Estimator>
struct PredictionStep {
  Estimator* estimator;  ///< must have been started
  double dt_s;
  Status status = Status::kOk;
  Gaussian<4> kinematics = {};  ///< of the estimate after the step

  /// The same step of another estimator.
  template <class Other>
  [[nodiscard]] PredictionStep<Other> of(Other& other) const noexcept {
    return {&other, dt_s};
  }
  /// Takes the result of the same step of another estimator.
  template <class Other>
  void take_result(const PredictionStep<Other>& step) noexcept {
    status = step.status;
    kinematics = step.kinematics;
  }
};

/// One update of an estimator by one or more fixes that may belong to its target, and its result;
/// see `Imm::update` by several readings.
template <class Estimator>
struct UpdateStep {
  Estimator* estimator;  ///< must have been started
  std::span<const Alternative<Fix>> fixes;
  double none;
  std::span<double> share;
  double total = 0.0;
  Gaussian<4> kinematics = {};

  /// The same step of another estimator.
  template <class Other>
  [[nodiscard]] UpdateStep<Other> of(Other& other) const noexcept {
    return {&other, fixes, none, share};
  }
  /// Takes the result of the same step of another estimator.
  template <class Other>
  void take_result(const UpdateStep<Other>& step) noexcept {
    total = step.total;
    kinematics = step.kinematics;
  }
};

/// Takes steps of many estimators with the parameters of one prototype.
template <class Steps, class Estimator>
concept EstimatorSteps = std::movable<Steps> && std::constructible_from<Steps, const Estimator&> &&
    requires(Steps steps, std::span<PredictionStep<Estimator>> predictions,
             std::span<UpdateStep<Estimator>> updates) {
  steps.predict(predictions);
  steps.update(updates);
};

/// `InLanes<Estimator, Scalar>::of(prototype)` is the same estimator over packs of numbers. It
/// exists for estimators that differ from others with the same parameters only in beliefs and mode
/// probabilities.
template <class Estimator, class Scalar>
struct InLanes;

template <class Motion, class Scalar>
requires(kForPacks<Motion>) struct InLanes<Ekf<Motion>, Scalar> {
  static auto of(const Ekf<Motion>& filter) { return Ekf<Motion, Scalar>(filter.motion()); }
};

template <class Motion, class Scalar>
requires(kForPacks<Motion>) struct InLanes<Kalman<Motion>, Scalar> {
  static auto of(const Kalman<Motion>& filter) { return Kalman<Motion, Scalar>(filter.motion()); }
};

template <class Motion, class Scalar>
requires(kForPacks<Motion>) struct InLanes<Ukf<Motion>, Scalar> {
  static auto of(const Ukf<Motion>& filter) {
    return Ukf<Motion, Scalar>(filter.motion(), filter.unscented());
  }
};

template <class... Filters, class Scalar>
requires(requires(const Filters& filter) { InLanes<Filters, Scalar>::of(filter); } &&
         ...) struct InLanes<Imm<FilterBank<Filters...>>, Scalar> {
  static auto of(const Imm<FilterBank<Filters...>>& imm) {
    return of(imm, std::index_sequence_for<Filters...>{});
  }

 private:
  template <std::size_t... Index>
  static auto of(const Imm<FilterBank<Filters...>>& imm, std::index_sequence<Index...>) {
    return Imm(imm.chain(), InLanes<Filters, Scalar>::of(imm.template filter<Index>())...);
  }
};

/// Performs the steps one after the other.
template <class Estimator>
class OneByOne {
 public:
  explicit OneByOne(const Estimator&) noexcept {}

  void predict(std::span<PredictionStep<Estimator>> steps) noexcept {
    for (auto& [estimator, dt_s, status, kinematics] : steps) {
      status = estimator->predict(dt_s);
      kinematics = kinematics_of(estimator->estimate());
    }
  }

  void update(std::span<UpdateStep<Estimator>> steps) noexcept {
    for (auto& [estimator, fixes, none, share, total, kinematics] : steps) {
      total = estimator->update(fixes, none, share);
      kinematics = kinematics_of(estimator->estimate());
    }
  }
};

/// Performs the steps of estimators without a form for lanes.
template <class Estimator>
class SideBySide : public OneByOne<Estimator> {
  using OneByOne<Estimator>::OneByOne;
};

/// Performs the steps in lanes. The result of a step does not depend on the others.
template <class Estimator>
requires requires(const Estimator& prototype) {
  InLanes<Estimator, Pack<double, kNativeLanes<double>>>::of(prototype);
}
class SideBySide<Estimator> {
  using Scalar = Pack<double, kNativeLanes<double>>;
  static constexpr std::size_t kLanes = kLanesOf<Scalar>;

 public:
  explicit SideBySide(const Estimator& prototype)
      : lanes_(InLanes<Estimator, Scalar>::of(prototype)) {}

  void predict(std::span<PredictionStep<Estimator>> steps) noexcept {
    in_rows(
        steps, [](const auto&) {}, [&](const auto& row) { predict_row(row); });
  }

  void update(std::span<UpdateStep<Estimator>> steps) noexcept {
    // By number of fixes, so that the steps of a row have the same number or nearly.
    const auto arrange = [](std::span<UpdateStep<Estimator>*> order) {
      std::sort(order.begin(), order.end(),
                [](const auto* a, const auto* b) { return a->fixes.size() < b->fixes.size(); });
    };
    in_rows(steps, arrange, [&](const auto& row) { update_row(row); });
  }

 private:
  static constexpr std::size_t kArranged = 64;  ///< steps that are sorted together

  /// A fix for each lane.
  struct LaneFix : Fix {
    Mat<Scalar, 2, 2> covariance;

    template <class Lanes>
    Gaussian<2, Lanes> observe(const Vec<Lanes, 2>& z) const noexcept {
      return {z, covariance};
    }
  };

  /// Steps performed together. Unused lanes repeat the last one.
  template <class Step>
  struct Row {
    std::array<Step*, kLanes> step;
    int count;

    Step& operator[](int k) const noexcept { return *step[std::size_t(k)]; }

    /// `field(step)` of each lane, read before anything is written.
    template <class Field>
    [[nodiscard]] auto each(const Field& field) const noexcept {
      std::array<decltype(&field(*step[0])), kLanes> fields;
      unroll<int(kLanes)>([&](auto k) { fields[k.value] = &field(*step[k.value]); });
      return fields;
    }
  };

  /// Performs the steps in rows, in the order to which `arrange` sorts pointers to them.
  template <class Step, class Arrange, class TakeRow>
  static void in_rows(std::span<Step> steps, const Arrange& arrange, const TakeRow& take) noexcept {
    while (!steps.empty()) {
      const std::size_t count = std::min(kArranged, steps.size());
      std::array<Step*, kArranged> order;
      for (std::size_t k = 0; k < count; ++k) order[k] = &steps[k];
      arrange(std::span<Step*>(order.data(), count));
      for (std::size_t first = 0; first < count; first += kLanes) {
        Row<Step> row{.step = {}, .count = int(std::min(kLanes, count - first))};
        for (std::size_t k = 0; k < kLanes; ++k)
          row.step[k] = order[std::min(first + k, count - 1)];
        // Those of the next row, which are seldom in the cache, while this row is at work.
        for (std::size_t k = first + kLanes; k < std::min(first + 2 * kLanes, count); ++k)
          prefetch(*order[k]->estimator);
        take(row);
      }
      steps = steps.subspan(count);
    }
  }

  [[gnu::noinline]] WAKELINE_FLATTEN void predict_row(
      const Row<PredictionStep<Estimator>>& row) noexcept {
    gather(row);
    const auto status = lanes_.predict(lanes_of<Scalar>([&](int k) { return row[k].dt_s; }));
    for (int k = 0; k < row.count; ++k) row[k].status = lane(status, k);
    scatter(row);
  }

  [[gnu::noinline]] WAKELINE_FLATTEN void update_row(
      const Row<UpdateStep<Estimator>>& row) noexcept {
    gather(row);
    const std::size_t count = std::min(row[row.count - 1].fixes.size(), kMaxAlternatives);
    for (std::size_t i = 0; i < count; ++i) read(row, i);
    std::array<Scalar, kMaxAlternatives> share;
    const Scalar total = lanes_.update(
        std::span<const Alternative<LaneFix, Scalar>>(fixes_.data(), count),
        lanes_of<Scalar>([&](int k) { return row[k].none; }), std::span(share.data(), count));
    for (int k = 0; k < row.count; ++k) {
      row[k].total = lane(total, k);
      for (std::size_t i = 0; i < row[k].share.size(); ++i)
        row[k].share[i] = i < count ? lane(share[i], k) : 0.0;
    }
    scatter(row);
  }

  /// Fix `i` of each lane; a missing one has weight zero.
  void read(const Row<UpdateStep<Estimator>>& row, std::size_t i) noexcept {
    const auto fix = [&](int k) -> const Alternative<Fix>& {
      return row[k].fixes[std::min(i, row[k].fixes.size() - 1)];
    };
    auto& [sensor, z, weight] = fixes_[i];
    gather_lanes<4>([&](int k) { return fix(k).sensor.covariance_m2.data(); },
                    sensor.covariance.data());
    gather_lanes<2>([&](int k) { return fix(k).z.data(); }, z.data());
    weight = lanes_of<Scalar>([&](int k) { return i < row[k].fixes.size() ? fix(k).weight : 0.0; });
  }

  template <class Step>
  void gather(const Row<Step>& row) noexcept {
    const auto estimators = row.each([](Step& step) -> Estimator& { return *step.estimator; });
    lanes_.gather([&](int k) -> const Estimator& { return *estimators[std::size_t(k)]; });
  }

  template <class Step>
  void scatter(const Row<Step>& row) const noexcept {
    const auto estimators = row.each([](Step& step) -> Estimator& { return *step.estimator; });
    const auto kinematics = row.each([](Step & step) -> auto& { return step.kinematics; });
    lanes_.scatter(row.count, [&](int k) -> Estimator& { return *estimators[std::size_t(k)]; });
    scatter_lanes(
        kinematics_of(lanes_.estimate()),
        row.count, [&](int k) -> auto& { return *kinematics[std::size_t(k)]; });
  }

  decltype(InLanes<Estimator, Scalar>::of(std::declval<const Estimator&>())) lanes_;
  std::array<Alternative<LaneFix, Scalar>, kMaxAlternatives> fixes_;
};

/// Performs the steps apart: of those whose group rests, and of those whose group has joined.
template <class CoreBank, class AllBank>
class SideBySide<ModelGroupImm<CoreBank, AllBank>> {
  using Estimator = ModelGroupImm<CoreBank, AllBank>;

 public:
  explicit SideBySide(const Estimator& prototype)
      : core_(prototype.core()), all_(prototype.all()) {}

  void predict(std::span<PredictionStep<Estimator>> steps) noexcept {
    for (const auto& step : steps) step.estimator->choose_models(step.dt_s);
    apart(steps, [](auto& side_by_side, auto some) { side_by_side.predict(some); });
  }

  void update(std::span<UpdateStep<Estimator>> steps) noexcept {
    apart(steps, [](auto& side_by_side, auto some) { side_by_side.update(some); });
  }

 private:
  static constexpr std::size_t kTogether = 64;  ///< steps that are sorted together

  template <class Step, class Perform>
  void apart(std::span<Step> steps, const Perform& perform) noexcept {
    while (!steps.empty()) {
      const std::span<Step> some = steps.first(std::min(kTogether, steps.size()));
      perform_some(core_, some, perform,
                   [](Estimator& one) { return one.joined() ? nullptr : &one.core(); });
      perform_some(all_, some, perform,
                   [](Estimator& one) { return one.joined() ? &one.all() : nullptr; });
      steps = steps.subspan(some.size());
    }
  }

  /// Performs the steps of the estimators of which `imm_of` has something.
  template <class Imm, class Step, class Perform, class ImmOf>
  static void perform_some(SideBySide<Imm>& side_by_side, std::span<Step> steps,
                           const Perform& perform, const ImmOf& imm_of) noexcept {
    std::array<decltype(steps[0].of(std::declval<Imm&>())), kTogether> some;
    std::array<Step*, kTogether> step_of;
    std::size_t count = 0;
    for (Step& step : steps) {
      Imm* const imm = imm_of(*step.estimator);
      if (imm == nullptr) continue;
      step_of[count] = &step;
      some[count++] = step.of(*imm);
    }
    if (count == 0) return;
    perform(side_by_side, std::span(some.data(), count));
    for (std::size_t k = 0; k < count; ++k) step_of[k]->take_result(some[k]);
  }

  SideBySide<typename Estimator::Core> core_;
  SideBySide<typename Estimator::All> all_;
};

}  // namespace wakeline
