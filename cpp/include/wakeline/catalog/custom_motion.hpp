// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "wakeline/catalog/belief.hpp"
#include "wakeline/catalog/motions.hpp"

namespace wakeline {

/// A motion model that is made at run time, x' = f(x, dt) + w, w ~ N(0, Q(x, dt)), of 1 to
/// `kMaxStates` states: what an application or another language passes to the filters of the
/// catalogue. (A C++ program that knows its model when it is compiled writes a `MotionModel`.)
///
/// A function that cannot give its result returns NaN, and the step fails with `kNotFinite`.
class CustomMotion {
 public:
  using State = AnyBelief::Mean;
  using Matrix = AnyBelief::Covariance;

  virtual ~CustomMotion() = default;

  [[nodiscard]] StateLayout layout() const noexcept { return layout_; }
  [[nodiscard]] int states() const noexcept { return rows_of(layout_).states; }

  /// True where f(x, dt) = F(dt) x and Q depends on dt alone: `transition` is then not called, and
  /// `jacobian` and `process_noise` once for each new step, with any x.
  [[nodiscard]] virtual bool linear() const noexcept = 0;
  [[nodiscard]] virtual State transition(const State& x, double dt_s) const noexcept = 0;
  /// df/dx, N x N; by central differences unless the model knows it.
  [[nodiscard]] virtual Matrix jacobian(const State& x, double dt_s) const noexcept {
    return central_differences<Matrix>(x, [&](const State& at) { return transition(at, dt_s); });
  }
  [[nodiscard]] virtual Matrix process_noise(const State& x, double dt_s) const noexcept = 0;
  /// Variance of a component that a start over `[x, vx, y, vy]` does not give; its mean is 0.
  [[nodiscard]] virtual double prior_variance(Component /*component*/) const noexcept {
    return 1.0;
  }

  /// The Jacobian of a function at x by central differences with the step cbrt(epsilon) max(1,
  /// |x|), whose error of rounding is as large as that of the cut series. Source: Press et al.,
  /// Numerical Recipes, 5.7.
  template <class Jacobian, class Function>
  static Jacobian central_differences(const State& x, const Function& function) noexcept {
    constexpr double kStep = 6e-6;
    Jacobian result;
    State at = x;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      const double step = kStep * std::max(1.0, std::abs(x[k]));
      at[k] = x[k] + step;
      const auto ahead = function(at);
      const double width = at[k];
      at[k] = x[k] - step;
      const auto behind = function(at);
      if (k == 0) result.resize(ahead.size(), x.size());
      for (Eigen::Index i = 0; i < ahead.size(); ++i)
        result(i, k) = (ahead[i] - behind[i]) / (width - at[k]);
      at[k] = x[k];
    }
    return result;
  }

 protected:
  /// Throws `std::invalid_argument` when there are more layouts than `CustomLayouts` has room for.
  explicit CustomMotion(const StateRows& rows) : layout_(CustomLayouts::of(rows)) {}

 private:
  StateLayout layout_;
};

}  // namespace wakeline
