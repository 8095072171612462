// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/core/fields.hpp"
#include "wakeline/motion/constant_acceleration.hpp"

namespace wakeline {

/// phi_k(u) = sum over n of (-u)ⁿ / (n + k)!, which is e⁻ᵘ, (1 - e⁻ᵘ)/u, (u - 1 + e⁻ᵘ)/u² for k =
/// 0, 1, 2, without their cancellation near u = 0.
template <int K, class Scalar>
Scalar exponential_remainder(Scalar u) noexcept {
  using std::exp;
  if constexpr (K == 0) {
    return exp(-u);
  } else {
    constexpr int kTerms = 18;
    Scalar sum = Scalar(1);
    for (int n = kTerms; n > 0; --n) sum = Scalar(1) - u / Scalar(n + K) * sum;
    return select(u > Scalar(1), (Scalar(1) - exponential_remainder<K - 1>(u)) / u,  // 1/(K-1)! = 1
                  K == 1 ? sum : sum / 2);
  }
}

/// Singer's model: an exponentially correlated acceleration, da/dt = -a/tau + w, with stationary
/// standard deviation `accel_std_mps2` per axis. State `[x, vx, ax, y, vy, ay]` (m, m/s, m/s²).
/// Source: R. A. Singer, IEEE Trans. AES-6, 1970; Bar-Shalom, Li, Kirubarajan, 8.2.
struct Singer {
  static constexpr const char* kName = "Singer";
  static constexpr const char* kSummary =
      "Singer's model of a maneuvering target: state [x, vx, ax, y, vy, ay] (m, m/s, m/s²).";
  static constexpr auto kComponents = kAccelerationKinematics;
  static constexpr bool kForPacks = true;
  static constexpr Pattern<6> kPattern{"1xx000 01x000 00x000 0001xx 00001x 00000x"};

  double maneuver_time_s = 20.0;
  double accel_std_mps2 = 0.5;

  static constexpr auto fields() noexcept {
    using S = Singer;
    return field_table(field("maneuver_time_s", &S::maneuver_time_s, kPositive, "s",
                             "Correlation time of the acceleration."),
                       field("accel_std_mps2", &S::accel_std_mps2, kPositive, "m/s²",
                             "Stationary standard deviation of the acceleration, per axis."));
  }

  /// F(dt), 6 x 6.
  template <class Scalar>
  Mat<Scalar, 6, 6> matrix(Scalar dt_s) const noexcept {
    const Vec<Scalar, 3> response = impulse_response(dt_s);
    Mat<Scalar, 3, 3> axis = Mat<Scalar, 3, 3>::Identity();
    axis(0, 1) = dt_s;
    axis.col(2) = response;
    return both_axes(axis);
  }

  /// Q(dt), 6 x 6: the integral over the step of g(s) 2 s_a²/tau g(s)ᵀ with the impulse response g.
  template <class Scalar>
  Mat<Scalar, 6, 6> process_noise(Scalar dt_s) const noexcept {
    const Scalar variance = Scalar(accel_std_mps2 * accel_std_mps2);
    Mat<Scalar, 3, 3> axis = short_step_noise(dt_s);
    assign_where(dt_s > Scalar(maneuver_time_s), axis, long_step_noise(dt_s));
    return both_axes<Scalar>(variance * axis);
  }

  double prior_variance(Component) const noexcept { return accel_std_mps2 * accel_std_mps2; }

  void validate() const { validate_fields(*this); }

 private:
  /// Response `[position, velocity, acceleration]` after t to a unit acceleration.
  template <class Scalar>
  Vec<Scalar, 3> impulse_response(Scalar t_s) const noexcept {
    const Scalar u = t_s / Scalar(maneuver_time_s);
    return {t_s * t_s * exponential_remainder<2>(u), t_s * exponential_remainder<1>(u),
            exponential_remainder<0>(u)};
  }

  /// Gauss-Legendre quadrature with eight nodes: exact to rounding for steps up to tau, where the
  /// closed form cancels.
  template <class Scalar>
  Mat<Scalar, 3, 3> short_step_noise(Scalar dt_s) const noexcept {
    constexpr std::array kNode{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                               0.9602898564975363};
    constexpr std::array kWeight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                 0.1012285362903763};
    Mat<Scalar, 3, 3> noise = Mat<Scalar, 3, 3>::Zero();
    for (std::size_t k = 0; k < kNode.size(); ++k)
      for (const double node : {-kNode[k], kNode[k]}) {
        const Vec<Scalar, 3> g = impulse_response(dt_s * Scalar((1.0 + node) / 2));
        noise += Scalar(kWeight[k]) * g * g.transpose();
      }
    mirror_lower<Scalar, 3>(noise);
    return dt_s / Scalar(maneuver_time_s) * noise;
  }

  /// Singer's closed form.
  template <class Scalar>
  Mat<Scalar, 3, 3> long_step_noise(Scalar dt_s) const noexcept {
    using std::exp;
    const Scalar tau = Scalar(maneuver_time_s);
    const Scalar u = dt_s / tau;
    const Scalar e1 = exp(-u);
    const Scalar e2 = e1 * e1;
    const Scalar pp = 1 - e2 + 2 * u + 2 * u * u * u / 3 - 2 * u * u - 4 * u * e1;
    const Scalar pv = e2 + 1 - 2 * e1 + 2 * u * e1 - 2 * u + u * u;
    const Scalar pa = 1 - e2 - 2 * u * e1;
    const Scalar vv = 4 * e1 - 3 - e2 + 2 * u;
    const Scalar va = e2 + 1 - 2 * e1;
    const Scalar aa = 1 - e2;
    Mat<Scalar, 3, 3> noise;
    // clang-format off
    noise << pp * tau * tau * tau * tau, pv * tau * tau * tau, pa * tau * tau,
             pv * tau * tau * tau,       vv * tau * tau,       va * tau,
             pa * tau * tau,             va * tau,             aa;
    // clang-format on
    return noise;
  }
};

}  // namespace wakeline
