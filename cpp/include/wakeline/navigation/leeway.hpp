// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Effect of wind and waves on a drifting object and on the surface water. Source: Hannoshyna,
// Kalinichenko, Nikitin, equations (12)-(15); see cpp/docs/theory/dead_reckoning.md.
//
// A wind is the velocity of the air, [north, east] m/s: the direction it blows to.
#pragma once

#include <array>
#include <cmath>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/require.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Kinds of floating objects.
enum class FloatingObject : unsigned char { kBuoy, kDinghy, kLaunch, kShip };

/// Range of the ratio of an object's drift to the wind speed.
struct LeewayFactor {
  double least = 0.0;
  double greatest = 0.0;

  [[nodiscard]] constexpr double middle() const noexcept { return (least + greatest) / 2; }

  /// Standard deviation of a uniform distribution over the range.
  [[nodiscard]] double std() const noexcept { return (greatest - least) / std::sqrt(12.0); }
};

/// The table of (12).
constexpr LeewayFactor leeway_factor(FloatingObject object) noexcept {
  constexpr std::array<LeewayFactor, 4> table{
      {{0.012, 0.015}, {0.032, 0.045}, {0.065, 0.065}, {0.056, 0.062}}};
  return table[static_cast<std::size_t>(object)];
}

/// (12), (13): V = k U, downwind. (In knots of a wind in m/s: 1.944 k U.)
inline Vec<double, 2> wind_drift_mps(const Vec<double, 2>& wind_mps, double factor) noexcept {
  return factor * wind_mps;
}

/// The factor k of (14) by the wind speed U, from the range that the paper gives: 0.04 at 2 m/s and
/// less to 0.012 at 20 m/s and more, in between a power of U (k U then grows with U; on a straight
/// line it would fall from 14 m/s on).
inline double wind_current_factor(double wind_mps) noexcept {
  constexpr double slow_mps = 2.0, fast_mps = 20.0, at_slow = 0.04, at_fast = 0.012;
  const double power = std::log(at_fast / at_slow) / std::log(fast_mps / slow_mps);
  const double wind = wind_mps < slow_mps ? slow_mps : wind_mps > fast_mps ? fast_mps : wind_mps;
  return at_slow * std::pow(wind / slow_mps, power);
}

/// (14): the surface current caused by a steady wind, V = k U / sqrt(sin |latitude|), 45 degrees to
/// the right of the wind in the northern hemisphere, to the left in the southern.
///
/// The factor is 0.0127 after Ekman; observed ones range from 0.04 (wind of 2 m/s) to 0.012 (20
/// m/s).
class WindCurrent {
 public:
  static constexpr double kLeastLatitude_rad = deg(20.0);
  static constexpr double kDefaultFactor = 0.0127;

  /// Throws `std::invalid_argument` less than 20 degrees from the equator, where the formula is not
  /// valid.
  explicit WindCurrent(double latitude_rad, double factor = kDefaultFactor) {
    require(
        std::abs(latitude_rad) >= kLeastLatitude_rad && std::abs(latitude_rad) <= kPi<double> / 2,
        "latitude_rad",
        "20 degrees (0.349066) or more from the equator, where (14) holds, and at most pi/2",
        latitude_rad);
    require_not_negative("factor", factor);
    const double gain = factor / std::sqrt(std::sin(std::abs(latitude_rad)));
    const double to_starboard = latitude_rad > 0 ? kPi<double> / 4 : -kPi<double> / 4;
    const double c = gain * std::cos(to_starboard), s = gain * std::sin(to_starboard);
    of_wind_ << c, -s, s, c;
  }

  /// Velocity of the water [north, east] m/s.
  [[nodiscard]] Vec<double, 2> velocity_mps(const Vec<double, 2>& wind_mps) const noexcept {
    return of_wind_ * wind_mps;
  }

 private:
  Mat<double, 2, 2> of_wind_;
};

/// (15): speed of the Stokes drift at the surface for waves in deep water, in their direction:
/// (h/2)² (2 pi / L) sqrt(2 pi g / L), h from trough to crest, L from crest to crest.
inline double stokes_drift_mps(double wave_height_m, double wave_length_m) noexcept {
  constexpr double gravity_mps2 = 9.80665;
  const double amplitude = wave_height_m / 2;
  const double wave_number = 2 * kPi<double> / wave_length_m;
  return amplitude * amplitude * wave_number * std::sqrt(gravity_mps2 * wave_number);
}

}  // namespace wakeline
