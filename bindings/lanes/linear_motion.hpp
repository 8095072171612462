// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

#include "wakeline/batch/run.hpp"
#include "wakeline/catalog/custom_motion.hpp"
#include "wakeline/catalog/motions.hpp"
#include "wakeline/catalog/type_list.hpp"
#include "wakeline/motion/pattern.hpp"

namespace wakeline::python {

/// A linear motion model over the states of a layout: one of the catalogue, or one that is made at
/// run time. Filters ask for F and Q once per step, so that one kernel serves all of them.
template <StateLayout Layout>
class LinearInLanes {
  template <class Motion>
  struct Has : std::false_type {};
  template <LinearMotionModel Motion>
  struct Has<Motion> : std::bool_constant<kForPacks<Motion> && kLayoutOf<Motion> == Layout> {};
  using Models = Selected<Has, Motions>;
  static constexpr int kN = states_of(Layout);
  template <class Scalar>
  using Matrix = Mat<Scalar, kN, kN>;

 public:
  static constexpr auto kComponents = [] {
    std::array<Component, static_cast<std::size_t>(kN)> components{};
    for (std::size_t k = 0; k < components.size(); ++k)
      components[k] = rows_of(Layout).components[k];
    return components;
  }();
  static constexpr bool kForPacks = true;

  /// What the transition matrices of the catalogue have in common.
  static constexpr Pattern<kN> common_pattern() noexcept {
    Pattern<kN> common;
    bool first = true;
    Models::for_each([&]<class Motion>(std::type_identity<Motion>) {
      for (int i = 0; i < kN; ++i)
        for (int j = 0; j < kN; ++j) {
          const char one = kPatternOf<Motion>.element[i][j];
          if (first)
            common.element[i][j] = one;
          else if (common.element[i][j] != one)
            common.element[i][j] = 'x';
        }
      first = false;
    });
    return common;
  }

  template <class Motion>
  requires(Has<Motion>::value) explicit LinearInLanes(const Motion& motion) : motion_(motion) {}
  /// A linear one, which must outlive this object.
  explicit LinearInLanes(const CustomMotion& motion) : motion_(&motion) {}

  /// True where its transition matrices have the common pattern in all steps of recordings.
  [[nodiscard]] bool fits(const RunInput& in) const noexcept {
    constexpr Pattern<kN> kCommon = common_pattern();
    for (std::size_t scan = 0; scan < in.scans; ++scan) {
      if (scan > 0 && in.dt_s[scan] == in.dt_s[scan - 1]) continue;
      if (check_time_step(in.dt_s[scan]) != Status::kOk) continue;  // a step that is not made
      const Matrix<double> f = matrix(in.dt_s[scan]);
      for (int i = 0; i < kN; ++i)
        for (int j = 0; j < kN; ++j)
          if (const char one = kCommon.element[i][j]; one != 'x' && f(i, j) != double(one == '1'))
            return false;
    }
    return true;
  }

  template <class Scalar>
  Matrix<Scalar> matrix(Scalar dt_s) const noexcept {
    return visit<Matrix<Scalar>>(
        [&](const auto& motion) -> Matrix<Scalar> { return motion.matrix(dt_s); },
        [&](const CustomMotion& motion) { return in_all_lanes<Scalar>(f_of(motion, dt_s)); });
  }

  template <class Scalar>
  Matrix<Scalar> process_noise(Scalar dt_s) const noexcept {
    return visit<Matrix<Scalar>>(
        [&](const auto& motion) -> Matrix<Scalar> { return motion.process_noise(dt_s); },
        [&](const CustomMotion& motion) { return in_all_lanes<Scalar>(q_of(motion, dt_s)); });
  }

  using HasStepMatrices = LinearInLanes;
  template <class Scalar>
  StepMatrices<kN, Scalar> step_matrices(Scalar dt_s) const noexcept {
    return visit<StepMatrices<kN, Scalar>>(
        [&](const auto& motion) { return wakeline::step_matrices(motion, dt_s); },
        [&](const CustomMotion& motion) {
          return StepMatrices<kN, Scalar>{in_all_lanes<Scalar>(f_of(motion, dt_s)),
                                          in_all_lanes<Scalar>(q_of(motion, dt_s))};
        });
  }

  [[nodiscard]] double prior_mean(Component component) const noexcept {
    return visit<double>(
        [&](const auto& motion) { return wakeline::prior_mean(motion, component); },
        [](const CustomMotion&) { return 0.0; });
  }
  [[nodiscard]] double prior_variance(Component component) const noexcept {
    return visit<double>(
        [&](const auto& motion) { return wakeline::prior_variance(motion, component); },
        [&](const CustomMotion& motion) { return motion.prior_variance(component); });
  }

 private:
  template <class Result, class OfCatalog, class OfCustom>
  [[gnu::noinline]] Result visit(const OfCatalog& of_catalog,
                                 const OfCustom& of_custom) const noexcept {
    return std::visit(
        [&]<class Motion>(const Motion& motion) -> Result {
          if constexpr (std::is_pointer_v<Motion>)
            return of_custom(*motion);
          else
            return of_catalog(motion);
        },
        motion_);
  }

  /// F and Q of a step that all lanes have in common.
  template <class Scalar>
  static CustomMotion::Matrix f_of(const CustomMotion& motion, Scalar dt_s) noexcept {
    return motion.jacobian(CustomMotion::State::Zero(kN), double(lane(dt_s, 0)));
  }
  template <class Scalar>
  static CustomMotion::Matrix q_of(const CustomMotion& motion, Scalar dt_s) noexcept {
    return motion.process_noise(CustomMotion::State::Zero(kN), double(lane(dt_s, 0)));
  }
  template <class Scalar>
  static Matrix<Scalar> in_all_lanes(const CustomMotion::Matrix& numbers) noexcept {
    Matrix<Scalar> result;
    for (int k = 0; k < kN * kN; ++k) result.data()[k] = Scalar(numbers.data()[k]);
    return result;
  }

  AsVariant<Joined<Models, TypeList<const CustomMotion*>>> motion_;
};

}  // namespace wakeline::python

namespace wakeline {

template <StateLayout Layout>
inline constexpr Pattern<states_of(Layout)> kPatternOf<python::LinearInLanes<Layout>> =
    python::LinearInLanes<Layout>::common_pattern();

}  // namespace wakeline
