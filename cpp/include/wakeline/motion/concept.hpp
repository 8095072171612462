// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <concepts>

#include "wakeline/core/component.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

template <class Motion>
inline constexpr int kStatesOf = static_cast<int>(Motion::kComponents.size());

template <class Motion, class Scalar = double>
using StateOf = Vec<Scalar, kStatesOf<Motion>>;

template <class Motion, class Scalar = double>
using StateMatrixOf = Mat<Scalar, kStatesOf<Motion>, kStatesOf<Motion>>;

/// A linear motion model: x' = F(dt) x + w, w ~ N(0, Q(dt)).
///
/// Needs `kComponents`, `matrix(dt_s)` and `process_noise(dt_s)`, both templated on the scalar of
/// `dt_s`.
template <class Motion>
concept LinearMotionModel = requires(const Motion& motion, double dt_s) {
  Motion::kComponents.size();
  { motion.matrix(dt_s) } -> SameSize<StateMatrixOf<Motion>>;
  { motion.process_noise(dt_s) } -> SameSize<StateMatrixOf<Motion>>;
};

/// A nonlinear motion model: x' = f(x, dt) + w, w ~ N(0, Q(x, dt)).
///
/// Needs `kComponents`, `transition(x, dt_s)`, `jacobian(x, dt_s)` and `process_noise(x, dt_s)`.
template <class Motion>
concept NonlinearMotionModel = requires(const Motion& motion, const StateOf<Motion>& x,
                                        double dt_s) {
  Motion::kComponents.size();
  { motion.transition(x, dt_s) } -> SameSize<StateOf<Motion>>;
  { motion.jacobian(x, dt_s) } -> SameSize<StateMatrixOf<Motion>>;
  { motion.process_noise(x, dt_s) } -> SameSize<StateMatrixOf<Motion>>;
};

template <class Motion>
concept MotionModel = LinearMotionModel<Motion> || NonlinearMotionModel<Motion>;

/// True for a model that declares with `kForPacks` that its formulas also work on packs.
template <class Motion>
inline constexpr bool kForPacks = requires {
  requires Motion::kForPacks;
};

/// f(x, dt).
template <MotionModel Motion, class Scalar>
StateOf<Motion, Scalar> transition(const Motion& motion, const StateOf<Motion, Scalar>& x,
                                   Scalar dt_s) noexcept {
  if constexpr (LinearMotionModel<Motion>)
    return motion.matrix(dt_s) * x;
  else
    return motion.transition(x, dt_s);
}

/// F = df/dx at x.
template <MotionModel Motion, class Scalar>
StateMatrixOf<Motion, Scalar> transition_jacobian(const Motion& motion,
                                                  const StateOf<Motion, Scalar>& x,
                                                  Scalar dt_s) noexcept {
  if constexpr (LinearMotionModel<Motion>)
    return motion.matrix(dt_s);
  else
    return motion.jacobian(x, dt_s);
}

/// Q, the covariance added by the motion during dt.
template <MotionModel Motion, class Scalar>
StateMatrixOf<Motion, Scalar> process_noise(const Motion& motion, const StateOf<Motion, Scalar>& x,
                                            Scalar dt_s) noexcept {
  if constexpr (LinearMotionModel<Motion>)
    return motion.process_noise(dt_s);
  else
    return motion.process_noise(x, dt_s);
}

/// F and Q of a linear model over a step.
template <int N, class Scalar>
struct StepMatrices {
  Mat<Scalar, N, N> f;
  Mat<Scalar, N, N> q;
};

/// F and Q together, by the model's own `step_matrices(dt_s)` where `HasStepMatrices` names the
/// model itself: an inherited one would ignore an F or Q that the derived model overrides.
template <LinearMotionModel Motion, class Scalar>
StepMatrices<kStatesOf<Motion>, Scalar> step_matrices(const Motion& motion, Scalar dt_s) noexcept {
  if constexpr (requires { requires std::same_as<typename Motion::HasStepMatrices, Motion>; })
    return motion.step_matrices(dt_s);
  else
    return {motion.matrix(dt_s), motion.process_noise(dt_s)};
}

/// Checks at compile time that no component occurs twice and that a state of position and velocity
/// alone has the order `[x, vx, y, vy]`, which a start could not be distinguished from otherwise.
template <class Motion>
constexpr void check_components() noexcept {
  constexpr auto kComponents = Motion::kComponents;
  static_assert(differ(kComponents),
                "wakeline: the kComponents of this motion model name a component twice; those of "
                "your own are numbered from kUser; see cpp/docs/concepts.md");
  static_assert(kComponents.size() != 4 || !holds(kComponents, kKinematics) ||
                    std::equal(kComponents.begin(), kComponents.end(), kKinematics.begin()),
                "wakeline: a state of position and velocity alone has the order [x, vx, y, vy] "
                "(kNorth, kVnorth, kEast, kVeast); see cpp/docs/concepts.md");
}

/// Variance of a component that a start does not give (a turn rate, an acceleration): the model's
/// `prior_variance(component)` if it has one, else 1.
template <class Motion>
double prior_variance(const Motion& motion, Component component) noexcept {
  if constexpr (requires { motion.prior_variance(component); })
    return motion.prior_variance(component);
  else
    return 1.0;
}

/// Mean of a component that a start does not give: the model's `prior_mean(component)` if it has
/// one, else 0.
template <class Motion>
double prior_mean(const Motion& motion, Component component) noexcept {
  if constexpr (requires { motion.prior_mean(component); })
    return motion.prior_mean(component);
  else
    return 0.0;
}

}  // namespace wakeline
