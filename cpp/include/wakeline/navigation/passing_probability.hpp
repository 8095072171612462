// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Probability that a point in straight motion, of uncertain position and velocity, enters a disc.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline::detail {
inline namespace WAKELINE_INSTRUCTION_SET {

constexpr int kFewSlices = 4, kManySlices = 8;
constexpr int kSlicesAtOnce = std::min(kFewSlices, kNativeLanes<double>);
using Slices = Pack<double, kSlicesAtOnce>;

/// P(Z < z) of a standard normal variable, and sqrt(2 pi) times its density.
struct StandardNormal {
  Slices below, bell;

  /// Error below 1e-7: Abramowitz, Stegun, 7.1.26.
  explicit StandardNormal(Slices z) noexcept {
    bell = exp(Slices(-0.5) * z * z);
    const Slices t = 1.0 / (1.0 + Slices(0.3275911 / std::numbers::sqrt2) * abs(z));
    const Slices sum =
        t * (0.254829592 +
             t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
    const Slices beyond = 0.5 * sum * bell;
    below = select(z > Slices(0.0), 1.0 - beyond, beyond);
  }
};

inline double normal_below(double z) noexcept {
  constexpr double kSure = 5.2;  // the rest is 1e-7
  return z > kSure ? 1.0 : z < -kSure ? 0.0 : std::erfc(-z / std::numbers::sqrt2) / 2;
}

/// A nearly Gaussian variable with skewness, conditional on the offset of another one from its
/// mean: mean + slope off + curve off² + std Z.
struct GivenOffset {
  double mean, slope = 0.0, curve = 0.0, std = 0.0, skewness = 0.0;

  static constexpr double kFarthest = 40.0;  ///< where the density is zero

  /// Edgeworth expansion, up to the squared skewness.
  [[nodiscard]] Slices probability_below(Slices limit, Slices off) const noexcept {
    const Slices left = limit - (mean + off * (slope + curve * off));
    if (std == 0.0) return select(left > Slices(0.0), Slices(1.0), Slices(0.0));
    const Slices z = max(min(left * (1.0 / std), Slices(kFarthest)), Slices(-kFarthest));
    const StandardNormal normal(z);
    constexpr double kDensity = 0.3989422804014327;  // 1 / sqrt(2 pi)
    // Excess kurtosis over squared skewness of the length; 0.615 in the plane.
    constexpr double kExcess = 0.615;
    const Slices z2 = z * z, once = (z2 - 1.0) * (1.0 / 6.0);
    const Slices twice =
        z * ((z2 - 3.0) * (kExcess / 24.0) + ((z2 - 10.0) * z2 + 15.0) * (1.0 / 72.0));
    const Slices below =
        normal.below - kDensity * skewness * normal.bell * (once + skewness * twice);
    return min(max(below, Slices(0.0)), Slices(1.0));
  }
};

/// P(|x| < L) of a Gaussian x.
inline double within_limit(double limit_m, double mean_m, double std_m) noexcept {
  if (std_m == 0.0) return std::abs(mean_m) < limit_m ? 1.0 : 0.0;
  return normal_below((limit_m - mean_m) / std_m) - normal_below((-limit_m - mean_m) / std_m);
}

/// ∫ P(x, half chord at x) p(x) dx over a disc of radius L, x Gaussian along a diameter: the mean
/// of P over slices x = L sin f, equal in f and offset by the fraction `stagger` of their width.
template <class OnChord>
double within_disc(double limit_m, double mean_m, double std_m, int slices, double stagger,
                   const OnChord& on_chord) noexcept {
  constexpr double kSigmas = 3.5;  // the integral beyond is negligible
  if (std_m == 0.0) {
    if (std::abs(mean_m) >= limit_m) return 0.0;
    const double half_chord_m = std::sqrt((limit_m - mean_m) * (limit_m + mean_m));
    return on_chord(Slices(mean_m), Slices(half_chord_m))[0];
  }
  const double low = std::max(-limit_m, mean_m - kSigmas * std_m);
  const double high = std::min(limit_m, mean_m + kSigmas * std_m);
  const double mass = within_limit(limit_m, mean_m, std_m);
  if (!(high > low) || mass == 0.0) return 0.0;
  const double first = std::asin(low / limit_m);
  const double width = (std::asin(high / limit_m) - first) / slices;
  Slices sum = 0.0, weights = 0.0;
  for (int from = 0; from < slices; from += kSlicesAtOnce) {
    const auto [sine, cosine] =
        sin_cos(Slices::of([&](int k) { return first + (from + k + stagger) * width; }));
    const Slices x = limit_m * sine, z = (x - mean_m) * (1.0 / std_m);
    const Slices weight = cosine * exp(Slices(-0.5) * z * z);
    sum += weight * on_chord(x, limit_m * cosine);
    weights += weight;
  }
  const double all = sum_of_lanes(weights);
  return all > 0.0 ? mass * sum_of_lanes(sum) / all : 0.0;
}

/// Direction of a velocity v = ρ A c(ψ), A Aᵀ its covariance, c a unit vector: ψ = 0 is the mean.
/// Given ψ, the density of ρ is proportional to ρ exp(-(ρ - D cos ψ)² / 2), D = |A⁻¹ mean(v)|.
struct Length {
  double mean, variance, third;  ///< of ρ; `third` is the third central moment
  double weight;                 ///< proportional to the density of ψ

  /// With D for ρ and a somewhat larger value for ψ.
  Length(double distance, double narrowed, double cos_psi, double sin_psi) noexcept {
    const double a = distance * cos_psi, q = zeroth(a) / first(a);
    mean = a + q;
    variance = std::max(2.0 - a * q - q * q, 0.0);
    third = a * (a * q - 1.0) - 3.0 * q + 3.0 * a * q * q + 2.0 * q * q * q;
    const double aside = narrowed * sin_psi;
    weight = std::exp(-0.5 * aside * aside) * first(narrowed * cos_psi);
  }

 private:
  // ∫ ρ^k exp(-(ρ - a)² / 2) dρ, ρ > 0.
  static double zeroth(double a) noexcept {
    return std::sqrt(2.0 * std::numbers::pi) * normal_below(a);
  }
  static double first(double a) noexcept {
    constexpr double kFar = 6.0;  // the other term is relatively less than 1e-8
    return (a > kFar ? 0.0 : std::exp(-0.5 * a * a)) + a * zeroth(a);
  }
};

constexpr double kRest_mps = 1e-6;  ///< smallest relative speed of a moving target

/// Unit vectors and standard deviations along the axes of a covariance ellipse, the longer first.
struct PrincipalAxes {
  Mat<double, 2, 2> axes;
  Vec<double, 2> std;

  explicit PrincipalAxes(const Mat<double, 2, 2>& covariance) noexcept {
    const double across = covariance(0, 0) - covariance(1, 1), twice = 2.0 * covariance(1, 0);
    const double size = std::sqrt(across * across + twice * twice);  // at the doubled angle
    const double larger = size > 0.0 ? std::sqrt((1.0 + std::abs(across) / size) / 2.0) : 1.0;
    const double smaller = size > 0.0 ? twice / (2.0 * size * larger) : 0.0;
    Vec<double, 2> longer(larger, smaller);
    if (across < 0.0) longer = {smaller, larger};
    axes << longer[0], -longer[1], longer[1], longer[0];
    for (const int k : {0, 1}) {
      const Vec<double, 2> axis = axes.col(k);
      std[k] = std::sqrt(std::max(axis.dot(covariance * axis), 0.0));
    }
  }
};

/// Of all directions.
inline double largest_variance(const Mat<double, 2, 2>& covariance) noexcept {
  return covariance.trace() / 2 +
         std::hypot((covariance(0, 0) - covariance(1, 1)) / 2, covariance(1, 0));
}

/// P(|p| < L).
inline double probability_within(double limit_m, const Vec<double, 2>& position_m,
                                 const Mat<double, 2, 2>& covariance) noexcept {
  const PrincipalAxes ellipse(covariance);
  const Vec<double, 2> mean = ellipse.axes.transpose() * position_m;
  const GivenOffset along{.mean = mean[0], .std = ellipse.std[0]};
  const auto on_chord = [&](Slices, Slices half_chord_m) {
    return along.probability_below(half_chord_m, 0.0) - along.probability_below(-half_chord_m, 0.0);
  };
  return within_disc(limit_m, mean[1], ellipse.std[1], 2 * kManySlices, 0.5, on_chord);
}

/// Position and velocity in independent errors: v = A w, p = p0 + G (w - mean(w)) + e, w and e
/// Gaussian, w with unit covariance.
class PassingProbability {
 public:
  explicit PassingProbability(const Gaussian<4>& relative) noexcept
      : position_m_(relative.mean[0], relative.mean[2]) {
    const auto& p = relative.covariance;
    Mat2 velocity;
    position_covariance_ << p(0, 0), p(0, 2), p(2, 0), p(2, 2);
    velocity << p(1, 1), p(1, 3), p(3, 1), p(3, 3);
    Mat2 both;
    both << p(0, 1), p(0, 3), p(2, 1), p(2, 3);
    const Vec2 velocity_mps(relative.mean[1], relative.mean[3]);
    const double size2 = velocity.trace() + velocity_mps.squaredNorm();
    moves_ = size2 > kRest_mps * kRest_mps;
    if (!moves_) return;
    const PrincipalAxes ellipse(velocity);
    const Vec2 std = ellipse.std.cwiseMax(kLeastError * std::sqrt(size2));
    sigmas_ = velocity_mps.norm() / std[0];
    root_ = ellipse.axes * std.asDiagonal();
    const Vec2 inverse = std.cwiseInverse();
    whitened_ = inverse.asDiagonal() * (ellipse.axes.transpose() * velocity_mps);
    by_velocity_ = both * ellipse.axes * inverse.asDiagonal();
    rest_ = position_covariance_ - by_velocity_ * by_velocity_.transpose();
  }

  [[nodiscard]] double operator()(double limit_m, double horizon_s) const noexcept {
    if (std::isinf(limit_m)) return limit_m > 0.0 ? 1.0 : 0.0;
    const double outside_m = position_m_.norm() - limit_m;
    const double certain_m = kCertain * std::sqrt(largest_variance(position_covariance_));
    if (outside_m < -certain_m) return 1.0;
    const bool outside = outside_m > certain_m;
    const double sigmas = outside ? sigmas_ : sigmas_ / kAtLimit;
    const int directions = sigmas > kKnown         ? 1
                           : sigmas > kFairlyKnown ? kFewDirections
                                                   : kDirections;
    const int least = directions == 1 ? kManySlices : kFewSlices;
    const int slices = outside || directions == kDirections ? least : 2 * least;
    const Start start = directions == 1 ? Start::kAnywhere : Start::kOutside;
    const double now = outside || start == Start::kAnywhere
                           ? 0.0
                           : probability_within(limit_m, position_m_, position_covariance_);
    if (!moves_) return now;
    return std::min(now + along(directions, slices, start, limit_m, horizon_s), 1.0);
  }

 private:
  using Vec2 = Vec<double, 2>;
  using Mat2 = Mat<double, 2, 2>;

  static constexpr int kDirections = 32;
  static constexpr int kFewDirections = 8;
  static constexpr double kKnown = 12.0;       ///< sigmas of a velocity of one direction
  static constexpr double kFairlyKnown = 5.0;  ///< and of one of few directions
  static constexpr double kAtLimit = 2.0;      ///< times as many for a target at the limit now
  static constexpr double kCertain = 4.5;      ///< sigmas beyond which nothing is expected
  static constexpr double kLeastError = 1e-8;  ///< relative to a velocity without error
  static constexpr double kSpread = 0.4;       ///< of a direction, relative to their spacing
  static constexpr double kFewSpread = 0.5;    ///< of one of few
  static constexpr double kWidest = 4.0;       ///< of all directions, in sigmas
  static constexpr double kFewWidest = 3.6;    ///< of few

  /// Which targets are summed along directions: of several directions, those that are inside now
  /// are summed apart.
  enum class Start : std::uint8_t { kAnywhere, kOutside };

  /// The probability to start there and to be inside at some time, summed over directions of the
  /// velocity.
  [[nodiscard]] double along(int directions, int slices, Start start, double limit_m,
                             double horizon_s) const noexcept {
    const double distance = whitened_.norm();
    const Vec2 ahead = distance > 0.0 ? Vec2(whitened_ / distance) : Vec2(1.0, 0.0);
    const Vec2 aside(-ahead[1], ahead[0]);
    if (directions == 1)
      return towards(ahead, aside, Length(distance, distance, 1.0, 0.0), 1.0 / distance, slices,
                     0.5, start, limit_m, horizon_s);
    const double half_turn = std::numbers::pi;
    const bool few = directions == kFewDirections;
    const double sigmas = (few ? kFewWidest : kWidest) * (1.0 + 1.0 / distance);
    const double widest = distance > 0.0 ? std::min(sigmas / distance, half_turn) : half_turn;
    const double step = 2.0 * widest / directions, spread = (few ? kFewSpread : kSpread) * step;
    const double blurred = std::min(spread * distance, 0.7);
    const double narrowed = distance / std::sqrt(1.0 - blurred * blurred);
    double sum = 0.0, weights = 0.0;
    for (int k = 0; k < directions; ++k) {
      const double psi = (k + 0.5) * step - widest, c = std::cos(psi), s = std::sin(psi);
      if (distance * c < -5.0) continue;  // probability below one in a million
      const Length length(distance, narrowed, c, s);
      sum += length.weight * towards(c * ahead + s * aside, c * aside - s * ahead, length, spread,
                                     slices, stagger(k), start, limit_m, horizon_s);
      weights += length.weight;
    }
    return sum / weights;
  }

  /// The bit-reversed k as a fraction, so that the slices of a direction are between those of
  /// others.
  static constexpr double stagger(int k) noexcept {
    int reversed = 0;
    for (int bit = 1; bit < kDirections; bit *= 2, k /= 2) reversed = 2 * reversed + k % 2;
    return (reversed + 0.5) / kDirections;
  }

  /// Changes of a path by one standard deviation of ρ and of ψ.
  struct Ways {
    double by_length, by_turn;
  };

  /// The same for a direction ψ with the spread `spread`. With n the unit vector to starboard of
  /// the velocity |v| u, d = p·n, s = -p·u the distance to go and h² = L² - d² half the chord, it
  /// is inside where |d| < L, s > -h and s - |v| H < h:
  ///
  ///     ∫ (P(s - |v| H < h, given d) - P(s < -h, given d)) p(d) dd,    -L < d < L;
  ///
  /// from outside, s > h.
  ///
  /// First order in the errors, second order in the direction.
  [[nodiscard]] double towards(const Vec2& c, const Vec2& by_psi, const Length& length,
                               double spread, int slices, double stagger, Start start,
                               double limit_m, double horizon_s) const noexcept {
    const bool ever = horizon_s > kLargestInput;
    const double reach_s = ever ? 0.0 : horizon_s;
    const double length_std = std::sqrt(length.variance), aside = length.mean * spread;
    const Vec2 one = root_ * c, turned = root_ * by_psi * aside;
    const double speed_mps = length.mean * one.norm();
    const Vec2 u = one / one.norm(), n(-u[1], u[0]);
    const double turn_rad = turned.dot(n) / speed_mps;

    const Vec2 p = position_m_ + by_velocity_ * (length.mean * c - whitened_);
    const Vec2 p_by_length = by_velocity_ * c * length_std;
    const Vec2 p_by_turn = by_velocity_ * by_psi * aside;
    const double to_go = -p.dot(u), off = p.dot(n), range2 = p.squaredNorm();
    const double bend =
        range2 > 0.0 ? off * turn_rad * turn_rad / 2.0 * to_go * to_go / range2 : 0.0;
    const double d = off - bend;
    const Ways of_d{p_by_length.dot(n), p_by_turn.dot(n) + to_go * turn_rad};
    const Ways of_to_go{-p_by_length.dot(u), -p_by_turn.dot(u) - off * turn_rad};
    const Ways of_left{of_to_go.by_length - one.norm() * length_std * reach_s,
                       of_to_go.by_turn - turned.dot(u) * reach_s};

    const double d_variance = squared(of_d) + std::max(n.dot(rest_ * n), 0.0) + 2.0 * bend * bend;
    const double along_variance = std::max(u.dot(rest_ * u), 0.0);
    const double left = to_go - speed_mps * reach_s;
    const double left_certain = kCertain * std::sqrt(squared(of_left) + along_variance);
    if (!ever && left - limit_m > left_certain) return 0.0;  // too far to come in time
    const bool outside = to_go - limit_m > kCertain * std::sqrt(squared(of_to_go) + along_variance);
    if (outside && (ever || left < -left_certain))  // past the closest point in time
      return within_limit(limit_m, d, std::sqrt(d_variance));
    const double arc = to_go * turn_rad * turn_rad / 2.0;
    const auto given_d = [&](double mean, const Ways& of) noexcept {
      const double common = product(of_d, of) - n.dot(rest_ * u);
      const double by_turn = d_variance > 0.0 ? squared({0.0, of_d.by_turn}) / d_variance : 0.0;
      GivenOffset way{.mean = mean - arc * (1.0 - by_turn)};
      if (d_variance > 0.0) {
        way.slope = common / d_variance;
        way.curve = -arc * by_turn / d_variance;
      }
      const double variance = squared(of) + along_variance - way.slope * common;
      way.std = std::sqrt(std::max(variance, 0.0));
      if (way.std > 0.0 && length_std > 0.0)
        way.skewness = length.third *
                       cube((of.by_length - way.slope * of_d.by_length) / (length_std * way.std));
      return way;
    };
    const GivenOffset way = given_d(to_go, of_to_go);
    const GivenOffset way_left = given_d(left, of_left);
    return within_disc(
        limit_m, d, std::sqrt(d_variance), slices, stagger, [&](Slices x, Slices half_chord_m) {
          const Slices from_mean = x - d;
          const Slices in_time =
              ever ? Slices(1.0) : way_left.probability_below(half_chord_m, from_mean);
          if (outside) return in_time;
          const Slices edge_m = start == Start::kOutside ? half_chord_m : -half_chord_m;
          return max(in_time - way.probability_below(edge_m, from_mean), Slices(0.0));
        });
  }

  static double product(const Ways& a, const Ways& b) noexcept {
    return a.by_length * b.by_length + a.by_turn * b.by_turn;
  }
  static double squared(const Ways& a) noexcept { return product(a, a); }
  static double cube(double x) noexcept { return x * x * x; }

  Vec2 position_m_;
  Mat2 position_covariance_;
  bool moves_ = false;
  double sigmas_ = 0.0;             ///< speed over its largest error
  Mat2 root_, by_velocity_, rest_;  ///< A, G, the covariance of e
  Vec2 whitened_;                   ///< the mean of w
};

}  // namespace WAKELINE_INSTRUCTION_SET
}  // namespace wakeline::detail
