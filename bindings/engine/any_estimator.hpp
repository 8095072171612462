// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What a tracker may keep its tracks with.
#pragma once

#include <span>
#include <type_traits>
#include <variant>

#include "any_lines.hpp"
#include "any_turn_grids.hpp"
#include "mode_history.hpp"

namespace wakeline::python {

/// One of the multi-model estimators.
class AnyEstimator {
 public:
  using Variant =
      std::variant<AnyImm, AnyAdaptiveGridImm, AnySwitchingGridImm, AnyLikelyModelSetImm,
                   AnyModeHistory, AnyFuzzyAlphaBeta, AnyBayesianAlphaBeta>;

  template <class Estimator>
  requires(std::is_constructible_v<Variant, const Estimator&>)
      // NOLINTNEXTLINE(google-explicit-constructor): each of them is one.
      AnyEstimator(const Estimator& estimator)
      : estimator_(estimator) {}

  Status start(const Gaussian<4>& kinematics) noexcept {
    return std::visit([&](auto& estimator) { return estimator.start(kinematics); }, estimator_);
  }

  Status predict(double dt_s) noexcept {
    return std::visit([&](auto& estimator) { return estimator.predict(dt_s); }, estimator_);
  }

  template <class Sensor>
  [[nodiscard]] Evidence<double> evidence(
      const Sensor& sensor, const Vec<double, Sensor::kMeasurements>& z) const noexcept {
    return std::visit([&](const auto& estimator) { return estimator.evidence(sensor, z); },
                      estimator_);
  }

  template <class Sensor>
  double update(std::span<const Alternative<Sensor>> readings, double none,
                std::span<double> share) noexcept {
    return std::visit([&](auto& estimator) { return estimator.update(readings, none, share); },
                      estimator_);
  }

  /// Calls `f(mode, belief)` for each mode in use, where the estimator has modes with beliefs.
  template <class Function>
  void for_each_mode(Function&& function) const noexcept {
    std::visit([&](const auto& estimator) { visit_modes(estimator, function); }, estimator_);
  }

  [[nodiscard]] AnyBelief estimate() const noexcept {
    return std::visit([](const auto& estimator) { return estimator.estimate(); }, estimator_);
  }

  [[nodiscard]] const AnyImm::Probability& mode_probability() const noexcept {
    return std::visit(
        [](const auto& estimator) -> const auto& { return estimator.mode_probability(); },
        estimator_);
  }

  /// Of each model, where models change theirs; else none.
  [[nodiscard]] AnyImm::Probability turn_rates_rad_s() const noexcept {
    return std::visit(
        [](const auto& estimator) -> AnyImm::Probability {
          if constexpr (requires { estimator.turn_rates_rad_s(); })
            return estimator.turn_rates_rad_s();
          else
            return {};
        },
        estimator_);
  }

  [[nodiscard]] const Variant& variant() const noexcept { return estimator_; }

  void archive(Archive& fields) {
    std::visit([&](auto& estimator) { estimator.archive(fields); }, estimator_);
  }

 private:
  template <class Estimator, class Function>
  static void visit_modes(const Estimator& estimator, Function& function) noexcept {
    if constexpr (std::is_base_of_v<AnyImm, Estimator>) estimator.bank().for_each_belief(function);
  }

  Variant estimator_;
};

}  // namespace wakeline::python
