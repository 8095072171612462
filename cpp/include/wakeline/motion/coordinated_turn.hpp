// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/motion/concept.hpp"
#include "wakeline/motion/pattern.hpp"
#include "wakeline/motion/turn.hpp"
#include "wakeline/motion/wandering_course.hpp"

namespace wakeline {

/// A coordinated turn at a known rate: state `[x, vx, y, vy]` (m, m/s); at zero rate equal to
/// ConstantVelocity. `Rate` is `double`, or a pack with a turn rate for each lane. Source:
/// Bar-Shalom, Li, Kirubarajan, 11.7.1; paper A, equation (3).
template <class Rate>
struct KnownTurn {
  static constexpr const char* kName = "CoordinatedTurn";
  static constexpr const char* kSummary =
      "A coordinated turn at a known rate, positive to starboard: state [x, vx, y, vy].";
  static constexpr auto kComponents = kKinematics;
  static constexpr bool kForPacks = true;
  static constexpr Pattern<4> kPattern{"1x0x 0x0x 0x1x 0x0x"};

  Rate turn_rate_rad_s = 0.0;
  ProcessNoise noise = WhiteAcceleration{};

  static constexpr auto fields() noexcept {
    using T = KnownTurn;
    return field_table(field("turn_rate_rad_s", &T::turn_rate_rad_s, kFinite, "rad/s",
                             "Turn rate, positive to starboard."),
                       field("noise", &T::noise, "Process noise."));
  }

  /// F(dt), 4 x 4.
  template <class Scalar>
  Mat<Scalar, 4, 4> matrix(Scalar dt_s) const noexcept {
    return Turn<Scalar>(Scalar(turn_rate_rad_s), dt_s).matrix();
  }

  /// Q(dt), 4 x 4.
  template <class Scalar>
  Mat<Scalar, 4, 4> process_noise(Scalar dt_s) const noexcept {
    if (noise.kind() == ProcessNoise::Kind::kPiecewiseAcceleration)
      return Turn<Scalar>::piecewise_noise(noise, dt_s);  // needs no trigonometry
    return Turn<Scalar>(Scalar(turn_rate_rad_s), dt_s).noise(noise);
  }

  using HasStepMatrices = KnownTurn;
  /// F and Q with one evaluation of the trigonometry.
  template <class Scalar>
  StepMatrices<4, Scalar> step_matrices(Scalar dt_s) const noexcept {
    Turn<Scalar> turn(Scalar(turn_rate_rad_s), dt_s);
    return {turn.matrix(), turn.noise(noise)};
  }

  void validate() const {
    for (int k = 0; k < kLanesOf<Rate>; ++k)
      require_finite("turn_rate_rad_s", lane(turn_rate_rad_s, k));
    noise.validate(false);
  }
};

using CoordinatedTurn = KnownTurn<double>;

/// A coordinated turn with the rate in the state: `[x, vx, y, vy, omega]` (m, m/s, rad/s).
///
/// With `turn_rate_time_s` = 0 omega is a random walk. Otherwise it returns exponentially to its
/// prior, as the acceleration of Singer's model does; without that, an estimator of a target at
/// rest, whose turn rate is not observable, can diverge to half a turn per scan. Source:
/// Bar-Shalom, Li, Kirubarajan, 11.7.2, 8.2.
struct CoordinatedTurnRate {
  static constexpr const char* kName = "CoordinatedTurnRate";
  static constexpr const char* kSummary =
      "A coordinated turn with the rate in the state: [x, vx, y, vy, omega] (m, m/s, rad/s); the "
      "rate returns to its prior with `turn_rate_time_s`, or is a random walk if that is 0.";
  static constexpr std::array kComponents{Component::kNorth, Component::kVnorth, Component::kEast,
                                          Component::kVeast, Component::kTurnRate};
  static constexpr bool kForPacks = true;
  static constexpr Pattern<5> kPattern{"1x0xx 0x0xx 0x1xx 0x0xx 0000x"};

  ProcessNoise noise = WhiteAcceleration{};
  double turn_rate_psd_rad2s3 = 1e-4;
  double prior_turn_rate_std_rad_s = deg(3.0);
  double course_psd_rad2s = 0.0;
  double max_speed_mps = 30.0;
  double prior_turn_rate_rad_s = 0.0;
  double turn_rate_time_s = 0.0;

  static constexpr auto fields() noexcept {
    using C = CoordinatedTurnRate;
    return field_table(
        field("noise", &C::noise, "Process noise of the acceleration."),
        field("turn_rate_psd_rad2s3", &C::turn_rate_psd_rad2s3, kNotNegative, "rad²/s³",
              "Power spectral density of the noise of the turn rate."),
        field("prior_turn_rate_std_rad_s", &C::prior_turn_rate_std_rad_s, kPositive, "rad/s",
              "Standard deviation of the turn rate for a start that does not know it."),
        field("course_psd_rad2s", &C::course_psd_rad2s, kNotNegative, "rad²/s",
              "Power spectral density of the course noise, which grows with the speed."),
        field("max_speed_mps", &C::max_speed_mps, kPositive, "m/s",
              "Speed up to which the course noise grows."),
        field("prior_turn_rate_rad_s", &C::prior_turn_rate_rad_s, kFinite, "rad/s",
              "Mean of the turn rate for such a start, to which it returns."),
        field("turn_rate_time_s", &C::turn_rate_time_s, kNotNegative, "s",
              "Correlation time in which the turn rate returns to its prior; 0: never."));
  }

  /// f(x, dt): a turn at the mean of omega over the step.
  template <class Scalar>
  Vec<Scalar, 5> transition(const Vec<Scalar, 5>& x, Scalar dt_s) const noexcept {
    const Turn<Scalar> turn(mean_rate(x[4], dt_s), dt_s);
    Vec<Scalar, 5> next;
    next[0] = x[0] + turn.along_s * x[1] - turn.across_s * x[3];
    next[1] = turn.cosine * x[1] - turn.sine * x[3];
    next[2] = x[2] + turn.across_s * x[1] + turn.along_s * x[3];
    next[3] = turn.sine * x[1] + turn.cosine * x[3];
    next[4] = x[4] + (1 - remembered(dt_s)) * (Scalar(prior_turn_rate_rad_s) - x[4]);
    return next;
  }

  /// df/dx, 5 x 5.
  template <class Scalar>
  Mat<Scalar, 5, 5> jacobian(const Vec<Scalar, 5>& x, Scalar dt_s) const noexcept {
    const Turn<Scalar> turn(mean_rate(x[4], dt_s), dt_s);
    const Scalar share = remembered_meanwhile(dt_s);
    const Vec<Scalar, 2> slope = share * turn.rate_derivatives();
    const Scalar vx = x[1], vy = x[3];
    Mat<Scalar, 5, 5> f = Mat<Scalar, 5, 5>::Identity();
    f.template topLeftCorner<4, 4>() = turn.matrix();
    f(0, 4) = slope[0] * vx - slope[1] * vy;
    f(1, 4) = share * dt_s * (-turn.sine * vx - turn.cosine * vy);
    f(2, 4) = slope[1] * vx + slope[0] * vy;
    f(3, 4) = share * dt_s * (turn.cosine * vx - turn.sine * vy);
    f(4, 4) = remembered(dt_s);
    return f;
  }

  /// Q(x, dt), 5 x 5: the acceleration noise of the turn, plus white noise of density q on omega,
  /// which enters velocity and position through the acceleration omega x v with v fixed at its
  /// value in x: per axis a chain of integrators of white jerk q v², across the course. The return
  /// of omega during the step is included in omega only.
  template <class Scalar>
  Mat<Scalar, 5, 5> process_noise(const Vec<Scalar, 5>& x, Scalar dt_s) const noexcept {
    // Position and velocity, north and east, are `across` times elements of the chain of
    // integrators.
    const Scalar across[5] = {-x[3], -x[3], x[1], x[1], kept_wander(dt_s)};
    constexpr int kIntegrator[5] = {0, 1, 0, 1, 2};
    Mat<Scalar, 3, 3> chain =
        ProcessNoise(WhiteJerk{turn_rate_psd_rad2s3}).of_acceleration_axis(dt_s);
    Turn<Scalar> turn(mean_rate(x[4], dt_s), dt_s);
    Mat<Scalar, 4, 4> white =
        turn.noise(noise, course_wander_psd(course_psd_rad2s, max_speed_mps, x[1], x[3]));
    Mat<Scalar, 5, 5> q;
    unroll_lower<5>([&](int i, int j) {
      Scalar element = across[i] * across[j] * chain(kIntegrator[i], kIntegrator[j]);
      if (i < 4) element += white(i, j);
      q(i, j) = q(j, i) = element;
    });
    return q;
  }

  double prior_mean(Component) const noexcept { return prior_turn_rate_rad_s; }
  double prior_variance(Component) const noexcept {
    return prior_turn_rate_std_rad_s * prior_turn_rate_std_rad_s;
  }

  void validate() const {
    validate_fields(*this);
    noise.validate(false);
  }

 private:
  /// exp(-dt / turn_rate_time_s): the part of omega's deviation from its prior that remains after a
  /// step.
  template <class Scalar>
  Scalar remembered(Scalar dt_s) const noexcept {
    using std::exp;
    return turn_rate_time_s > 0.0 ? exp(-dt_s / Scalar(turn_rate_time_s)) : Scalar(1);
  }

  /// Mean of that part over the step: (1 - e^-u) / u, u = dt / turn_rate_time_s.
  template <class Scalar>
  Scalar remembered_meanwhile(Scalar dt_s) const noexcept {
    if (!(turn_rate_time_s > 0.0)) return Scalar(1);
    const Scalar u = dt_s / Scalar(turn_rate_time_s);
    const auto is_short = u < Scalar(1e-3);
    const Scalar divisor = select(is_short, Scalar(1), u);
    return select(is_short, 1 - u / 2 * (1 - u / 3 * (1 - u / 4)),
                  (1 - remembered(dt_s)) / divisor);
  }

  /// Mean of omega over a step that starts with this omega.
  template <class Scalar>
  Scalar mean_rate(Scalar rate_rad_s, Scalar dt_s) const noexcept {
    if (!(turn_rate_time_s > 0.0)) return rate_rad_s;
    const Scalar prior = Scalar(prior_turn_rate_rad_s);
    return prior + remembered_meanwhile(dt_s) * (rate_rad_s - prior);
  }

  /// Standard deviation that a step adds to omega, relative to that of a random walk: the square
  /// root of (1 - e^-2u) / 2u, u = dt / turn_rate_time_s.
  template <class Scalar>
  Scalar kept_wander(Scalar dt_s) const noexcept {
    using std::sqrt;
    if (!(turn_rate_time_s > 0.0)) return Scalar(1);
    const Scalar u = dt_s / Scalar(turn_rate_time_s);
    const Scalar left = remembered(dt_s);
    const auto is_short = u < Scalar(1e-3);
    const Scalar divisor = select(is_short, Scalar(1), 2 * u);
    return sqrt(select(is_short, 1 - u * (1 - 2 * u / 3), (1 - left * left) / divisor));
  }
};

}  // namespace wakeline
