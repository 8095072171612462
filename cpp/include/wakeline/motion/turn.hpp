// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "wakeline/core/types.hpp"
#include "wakeline/motion/process_noise.hpp"
#include "wakeline/simd/scalar.hpp"
#include "wakeline/simd/unroll.hpp"

namespace wakeline {

/// Stumpff functions of an angle: c0 = cos(theta), c1 = sin(theta) / theta, c2 = (1 - cos(theta)) /
/// theta² and c3 = (theta - sin(theta)) / theta³, without a singularity at zero. Source: Battin, An
/// Introduction to the Mathematics and Methods of Astrodynamics, 4.5.
template <class Scalar>
struct Stumpff {
  Scalar c0, c1, c2, c3;

  [[gnu::always_inline]] explicit Stumpff(Scalar angle) noexcept {
    const Scalar square = angle * angle;
    c2 = series<2>(square);
    c3 = series<3>(square);
    c1 = 1 - square * c3;
    c0 = 1 - square * c2;
    if (const auto wide = square > Scalar(kWidest); any(wide)) [[unlikely]] {
      const std::array closed = closed_forms(select(wide, angle, Scalar(1)));
      c0 = select(wide, closed[0], c0);
      c1 = select(wide, closed[1], c1);
      c2 = select(wide, closed[2], c2);
      c3 = select(wide, closed[3], c3);
    }
  }

 private:
  /// The sum over n of (-square)^n / (2 n + First)!, accurate to one or two units in the last place
  /// up to kWidest; terms of even and odd n side by side.
  template <int First>
  [[gnu::always_inline]] static Scalar series(Scalar square) noexcept {
    constexpr std::array kTerm = inverse_factorials<First>();
    const Scalar fourth = square * square;
    Scalar even = Scalar(kTerm[kTerms - 2]), odd = Scalar(kTerm[kTerms - 1]);
    unroll<kTerms / 2 - 1>([&](auto n) {
      constexpr std::size_t k = kTerms - 4 - 2 * n.value;
      even = Scalar(kTerm[k]) + fourth * even;
      odd = Scalar(kTerm[k + 1]) + fourth * odd;
    });
    return even - square * odd;
  }

  /// 1 / First!, 1 / (First + 2)!, ...
  template <int First>
  static constexpr auto inverse_factorials() noexcept {
    std::array<RealOf<Scalar>, kTerms> inverse{};
    double factorial = 1.0;
    for (int n = 2; n < First + 2 * kTerms; ++n) {
      factorial *= n;
      if (n >= First && (n - First) % 2 == 0)
        inverse[std::size_t((n - First) / 2)] = RealOf<Scalar>(1.0 / factorial);
    }
    return inverse;
  }

  [[gnu::cold, gnu::noinline]] static std::array<Scalar, 4> closed_forms(Scalar angle) noexcept {
    using std::cos, std::sin;
    const Scalar half_sine = sin(angle / 2);
    const Scalar versine = 2 * half_sine * half_sine;
    const Scalar sinc = 2 * half_sine * Scalar(cos(angle / 2)) / angle;
    return {1 - versine, sinc, versine / angle / angle, (1 - sinc) / angle / angle};
  }

  static constexpr int kTerms = sizeof(RealOf<Scalar>) > 4 ? 8 : 6;  ///< must be even
  static constexpr double kWidest = 0.64;                            ///< largest theta²
};

/// Trigonometry of a coordinated turn by theta = omega dt. Source: Bar-Shalom, Li, Kirubarajan,
/// 11.7.1; paper A, equation (3).
template <class Scalar>
struct Turn {
  Scalar angle;  ///< theta
  Stumpff<Scalar> c;
  Scalar sine;      ///< sin theta
  Scalar cosine;    ///< cos theta
  Scalar along_s;   ///< sin(theta) / omega, s: distance ahead at unit speed
  Scalar across_s;  ///< (1 - cos(theta)) / omega, s: distance to starboard at unit speed
  Scalar dt_s;

  [[gnu::always_inline]] Turn(Scalar turn_rate_rad_s, Scalar dt) noexcept
      : angle(turn_rate_rad_s * dt),
        c(angle),
        sine(angle * c.c1),
        cosine(c.c0),
        along_s(dt * c.c1),
        across_s(dt * angle * c.c2),
        dt_s(dt) {}

  /// F of `[x, vx, y, vy]`.
  Mat<Scalar, 4, 4> matrix() const noexcept {
    Mat<Scalar, 4, 4> f = Mat<Scalar, 4, 4>::Identity();
    f(1, 1) = f(3, 3) = cosine;
    f(0, 1) = f(2, 3) = along_s;
    f(2, 1) = across_s;
    f(0, 3) = -across_s;
    f(3, 1) = sine;
    f(1, 3) = -sine;
    return f;
  }

  /// d along / d omega and d across / d omega, s².
  Vec<Scalar, 2> rate_derivatives() const noexcept {
    return dt_s * dt_s * Vec<Scalar, 2>(angle * (c.c3 - c.c2), c.c1 - c.c2);
  }

  /// Q of `[x, vx, y, vy]` under the piecewise policy, independent of the turn.
  static Mat<Scalar, 4, 4> piecewise_noise(const ProcessNoise& policy, Scalar dt_s) noexcept {
    const Mat<Scalar, 2, 2> axis = policy.of_velocity_axis(dt_s);
    return noise_of(axis(0, 0), axis(1, 0), axis(1, 1), Scalar(0));
  }

  /// Q of `[x, vx, y, vy]` under acceleration noise that acts throughout the turn. White
  /// acceleration gives the exact integral of F(s) G q Gᵀ F(s)ᵀ; the piecewise policy gives the
  /// papers' G s² Gᵀ, which ignores the turn.
  Mat<Scalar, 4, 4> noise(const ProcessNoise& policy) const noexcept {
    if (policy.kind() == ProcessNoise::Kind::kPiecewiseAcceleration)
      return piecewise_noise(policy, dt_s);
    return white_noise(Scalar(policy.strength()));
  }

  /// The same with the density of the white acceleration increased by `more`.
  Mat<Scalar, 4, 4> noise(const ProcessNoise& policy, Scalar more_m2s3) const noexcept {
    if (policy.kind() == ProcessNoise::Kind::kPiecewiseAcceleration)
      return piecewise_noise(policy, dt_s) + white_noise(more_m2s3);
    return white_noise(Scalar(policy.strength()) + more_m2s3);
  }

 private:
  /// Q of white acceleration of this density.
  Mat<Scalar, 4, 4> white_noise(Scalar density) const noexcept {
    const Scalar velocity = density * dt_s;
    return noise_of(velocity * dt_s * dt_s * (2 * c.c3), velocity * dt_s * c.c2, velocity,
                    velocity * dt_s * angle * c.c3);
  }

  /// Q that is the same in every direction; `aside` is the correlation between the axes caused by
  /// the turn.
  static Mat<Scalar, 4, 4> noise_of(Scalar position, Scalar ahead, Scalar velocity,
                                    Scalar aside) noexcept {
    Mat<Scalar, 4, 4> q;
    // clang-format off
    q << position,  ahead,    0,        aside,
         ahead,     velocity, -aside,   0,
         0,         -aside,   position, ahead,
         aside,     0,        ahead,    velocity;
    // clang-format on
    return q;
  }
};

}  // namespace wakeline
