// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <type_traits>
#include <variant>

#include "wakeline/catalog/belief.hpp"
#include "wakeline/catalog/filters.hpp"
#include "wakeline/catalog/mode_history.hpp"
#include "wakeline/catalog/sensors.hpp"
#include "wakeline/catalog/type_list.hpp"
#include "wakeline/filter/alpha_beta.hpp"
#include "wakeline/multimodel/adaptive_grid_imm.hpp"
#include "wakeline/multimodel/bayesian_alpha_beta.hpp"
#include "wakeline/multimodel/fuzzy_alpha_beta.hpp"
#include "wakeline/multimodel/likely_model_set_imm.hpp"
#include "wakeline/multimodel/switching_grid_imm.hpp"

namespace wakeline {

using AnyAdaptiveGridImm = AdaptiveGridImm<AnyFilterBank>;
using AnySwitchingGridImm = SwitchingGridImm<AnyFilterBank>;
using AnyLikelyModelSetImm = LikelyModelSetImm<AnyFilterBank>;

/// The estimators that can be chosen at run time.
using Estimators =
    TypeList<AnyImm, AnyAdaptiveGridImm, AnySwitchingGridImm, AnyLikelyModelSetImm, AnyModeHistory,
             FuzzyAlphaBeta<>, BayesianAlphaBeta<>, AlphaBeta<>, AlphaBetaGamma<>>;

/// True for an estimator of several models, which a tracker can keep its tracks with.
template <class Estimator>
concept WeighsAlternatives = requires(Estimator& estimator,
                                      std::span<const Alternative<Fix>> readings, double none,
                                      std::span<double> share) {
  estimator.update(readings, none, share);
};

/// The step of an estimator for a sensor of M numbers; some take no more than the position out of a
/// reading, and their innovation is that of north and east.
template <int M>
struct AnyStep {
  Status status;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, M, 1> innovation;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, M, M> innovation_covariance;
  double nis;
  double log_likelihood;
};

/// One of some estimators, chosen at run time: the face of `Imm`.
template <class EstimatorList>
class AnyEstimatorOf {
 public:
  using Scalar = double;
  using Variant = AsVariant<EstimatorList>;
  using Probability = ModeVector<double, kRuntimeModes>;

  template <class Estimator>
  requires(std::is_constructible_v<Variant, const Estimator&>)
      // NOLINTNEXTLINE(google-explicit-constructor): each of them is one.
      AnyEstimatorOf(const Estimator& estimator)
      : estimator_(estimator) {}

  /// Begins with a belief over the state of the estimate or over `[x, vx, y, vy]`.
  Status start(const AnyBelief& belief) noexcept;
  Status start(const Gaussian<4>& kinematics) noexcept;
  Status predict(double dt_s) noexcept;
  Status predict(double dt_s, const Vec<double, 2>& acceleration_mps2) noexcept;
  template <int M>
  AnyStep<M> update(const AnySensorOf<M>& sensor, const Vec<double, M>& z) noexcept;

  /// True for an estimator of several models.
  [[nodiscard]] bool has_modes() const noexcept;
  /// Empty of one model.
  [[nodiscard]] Probability mode_probability() const noexcept;
  /// Of each model, where models change theirs; else empty.
  [[nodiscard]] Probability turn_rates_rad_s() const noexcept;
  [[nodiscard]] AnyBelief estimate() const noexcept;
  [[nodiscard]] bool started() const noexcept;
  /// True when it takes linear sensors only.
  [[nodiscard]] bool linear() const noexcept;
  void archive(Archive& fields);

  // What a tracker asks of an estimator of several models.

  [[nodiscard]] Evidence<double> evidence(const Fix& sensor,
                                          const Vec<double, 2>& z) const noexcept;
  double update(std::span<const Alternative<Fix>> readings, double none,
                std::span<double> share) noexcept;
  /// Calls `f(mode, belief)` for each mode in use, where the estimator has modes with beliefs.
  template <class Function>
  void for_each_mode(Function&& function) const noexcept {
    std::visit(
        [&](const auto& estimator) {
          if constexpr (requires { estimator.bank().for_each_belief(function); })
            estimator.bank().for_each_belief(function);
        },
        estimator_);
  }

  [[nodiscard]] const Variant& variant() const noexcept { return estimator_; }
  [[nodiscard]] Variant& variant() noexcept { return estimator_; }

 private:
  Variant estimator_;
};

using AnyEstimator = AnyEstimatorOf<Estimators>;

// Out of class, to be compiled once
// -----------------------------------------------------------------

namespace detail {

/// The estimate of an estimator, whatever belief it has.
template <class Estimator>
AnyBelief any_estimate(const Estimator& estimator) noexcept {
  const auto& belief = estimator.estimate();
  if constexpr (std::is_same_v<std::decay_t<decltype(belief)>, AnyBelief>)
    return belief;
  else if constexpr (requires { typename Estimator::Motion; })
    return any_belief<typename Estimator::Motion>(belief);
  else
    return {StateLayout::kKinematics, belief.mean, belief.covariance};
}

template <int M, int N>
AnyStep<M> any_step(const Step<N>& step) noexcept {
  return {step.status, step.innovation, step.innovation_covariance, step.nis, step.log_likelihood};
}

}  // namespace detail

template <class EstimatorList>
Status AnyEstimatorOf<EstimatorList>::start(const AnyBelief& belief) noexcept {
  return std::visit(
      [&]<class Estimator>(Estimator& estimator) {
        if constexpr (requires { typename Estimator::Motion; })
          if (belief.layout == kLayoutOf<typename Estimator::Motion>)
            return estimator.start(belief.template fixed<Estimator::kStates>());
        if constexpr (
            requires { estimator.start(belief); } && !requires { typename Estimator::Motion; })
          return estimator.start(belief);
        else
          return estimator.start(kinematics_of(belief));
      },
      estimator_);
}

template <class EstimatorList>
Status AnyEstimatorOf<EstimatorList>::start(const Gaussian<4>& kinematics) noexcept {
  return std::visit([&](auto& estimator) { return estimator.start(kinematics); }, estimator_);
}

template <class EstimatorList>
Status AnyEstimatorOf<EstimatorList>::predict(double dt_s) noexcept {
  return std::visit([&](auto& estimator) { return estimator.predict(dt_s); }, estimator_);
}

template <class EstimatorList>
Status AnyEstimatorOf<EstimatorList>::predict(double dt_s,
                                              const Vec<double, 2>& acceleration_mps2) noexcept {
  return std::visit([&](auto& estimator) { return estimator.predict(dt_s, acceleration_mps2); },
                    estimator_);
}

template <class EstimatorList>
template <int M>
AnyStep<M> AnyEstimatorOf<EstimatorList>::update(const AnySensorOf<M>& sensor,
                                                 const Vec<double, M>& z) noexcept {
  return std::visit(
      [&](auto& estimator) { return detail::any_step<M>(estimator.update(sensor, z)); },
      estimator_);
}

template <class EstimatorList>
bool AnyEstimatorOf<EstimatorList>::has_modes() const noexcept {
  return std::visit([]<class Estimator>(const Estimator&) { return WeighsAlternatives<Estimator>; },
                    estimator_);
}

template <class EstimatorList>
auto AnyEstimatorOf<EstimatorList>::mode_probability() const noexcept -> Probability {
  return std::visit(
      [](const auto& estimator) -> Probability {
        if constexpr (requires { estimator.mode_probability(); })
          return Probability(estimator.mode_probability());
        else
          return {};
      },
      estimator_);
}

template <class EstimatorList>
auto AnyEstimatorOf<EstimatorList>::turn_rates_rad_s() const noexcept -> Probability {
  return std::visit(
      [](const auto& estimator) -> Probability {
        if constexpr (requires { estimator.turn_rates_rad_s(); })
          return estimator.turn_rates_rad_s();
        else
          return {};
      },
      estimator_);
}

template <class EstimatorList>
AnyBelief AnyEstimatorOf<EstimatorList>::estimate() const noexcept {
  return std::visit([](const auto& estimator) { return detail::any_estimate(estimator); },
                    estimator_);
}

template <class EstimatorList>
bool AnyEstimatorOf<EstimatorList>::started() const noexcept {
  return std::visit([](const auto& estimator) { return estimator.started(); }, estimator_);
}

template <class EstimatorList>
bool AnyEstimatorOf<EstimatorList>::linear() const noexcept {
  return std::visit(
      [](const auto& estimator) {
        if constexpr (requires { estimator.linear(); }) {
          return estimator.linear();
        } else if constexpr (requires { estimator.bank(); }) {
          bool linear = false;
          for (int k = 0; k < estimator.bank().size(); ++k)
            linear = linear || estimator.bank().filter(k).linear();
          return linear;
        } else {
          return false;  // it takes the position out of any sensor
        }
      },
      estimator_);
}

template <class EstimatorList>
void AnyEstimatorOf<EstimatorList>::archive(Archive& fields) {
  std::visit([&](auto& estimator) { estimator.archive(fields); }, estimator_);
}

template <class EstimatorList>
Evidence<double> AnyEstimatorOf<EstimatorList>::evidence(const Fix& sensor,
                                                         const Vec<double, 2>& z) const noexcept {
  return std::visit(
      [&](const auto& estimator) -> Evidence<double> {
        if constexpr (requires { estimator.evidence(sensor, z); })
          return estimator.evidence(sensor, z);
        else
          return {};
      },
      estimator_);
}

template <class EstimatorList>
double AnyEstimatorOf<EstimatorList>::update(std::span<const Alternative<Fix>> readings,
                                             double none, std::span<double> share) noexcept {
  return std::visit(
      [&](auto& estimator) -> double {
        if constexpr (WeighsAlternatives<std::decay_t<decltype(estimator)>>)
          return estimator.update(readings, none, share);
        else
          return 0.0;
      },
      estimator_);
}

}  // namespace wakeline
