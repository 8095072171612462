// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <initializer_list>
#include <span>
#include <string>
#include <type_traits>

#include "wakeline/multimodel/mode_chain.hpp"
#include "wakeline/simd/scalar.hpp"

namespace wakeline {

/// Turn rates (rad/s, positive to starboard) in increasing order, at most kMaxModes: the models
/// available to a variable-structure estimator.
class TurnRateGrid {
 public:
  using Rates = ModeVector<double, kRuntimeModes>;

  // NOLINTNEXTLINE(google-explicit-constructor): a list of rates is a grid.
  TurnRateGrid(std::initializer_list<double> rates_rad_s)
      : TurnRateGrid(std::span<const double>(rates_rad_s.begin(), rates_rad_s.size())) {}

  /// Throws `std::invalid_argument` unless there are 2 to kMaxModes, finite and increasing.
  explicit TurnRateGrid(std::span<const double> rates_rad_s) {
    require_count(static_cast<Eigen::Index>(rates_rad_s.size()), 2);
    rates_.resize(static_cast<Eigen::Index>(rates_rad_s.size()));
    for (int k = 0; k < size(); ++k) {
      rates_[k] = rates_rad_s[static_cast<std::size_t>(k)];
      require_finite("every turn rate of grid_rad_s", rates_[k]);
      require(k == 0 || rates_[k] > rates_[k - 1], "every turn rate of grid_rad_s",
              "greater than the one before it", rates_[k]);
    }
  }

  /// Throws `std::invalid_argument` unless the number of rates is `least` to kMaxModes.
  static void require_count(Eigen::Index count, int least) {
    if (count >= least && count <= kMaxModes) return;
    reject("grid_rad_s must have " + std::to_string(least) + " to " + std::to_string(kMaxModes) +
           " turn rates, got " + std::to_string(count));
  }

  /// Throws `std::invalid_argument` unless `count` is the number of rates.
  void require_for_each(const char* name, Eigen::Index count) const {
    if (count != rates_.size())
      reject(std::string(name) + " must have one number for each of the " + std::to_string(size()) +
             " turn rates of grid_rad_s, got " + std::to_string(count));
  }

  /// i wmax / n for i = -n .. n: paper B, step 1.2. Throws as above.
  static TurnRateGrid evenly(double max_turn_rate_rad_s, int steps_each_side) {
    require_positive("max_turn_rate_rad_s", max_turn_rate_rad_s);
    require(steps_each_side >= 1 && steps_each_side <= (kMaxModes - 1) / 2, "steps_each_side",
            "1 to 7", double(steps_each_side));
    std::array<double, kMaxModes> rates{};
    const int count = 2 * steps_each_side + 1;
    for (int k = 0; k < count; ++k)
      rates[static_cast<std::size_t>(k)] =
          (k - steps_each_side) * max_turn_rate_rad_s / steps_each_side;
    return TurnRateGrid(std::span<const double>(rates.data(), static_cast<std::size_t>(count)));
  }

  [[nodiscard]] int size() const noexcept { return static_cast<int>(rates_.size()); }
  double operator[](int k) const noexcept { return rates_[k]; }
  [[nodiscard]] const Rates& rates_rad_s() const noexcept { return rates_; }

  /// Index of the rate nearest to zero; of two equally near ones the middle one of the grid, or the
  /// one to port.
  [[nodiscard]] int straightest() const noexcept {
    int best = (size() - 1) / 2;
    for (int k = 0; k < size(); ++k)
      if (std::abs(rates_[k]) < std::abs(rates_[best])) best = k;
    return best;
  }

 private:
  Rates rates_;
};

/// A turn rate that may differ by lane; `double` for scalar numbers.
template <class Scalar>
using TurnRate = std::conditional_t<kLanesOf<Scalar> == 1, double, Scalar>;

/// Sets the turn rate of a filter; its belief is unchanged.
template <class Filter, class Rate>
void set_turn_rate(Filter& filter, Rate turn_rate_rad_s) noexcept {
  static_assert(
      requires { filter.motion().turn_rate_rad_s; },
      "wakeline: the motion model of this filter has no known turn rate (turn_rate_rad_s); use "
      "CoordinatedTurn, or in a ModeHistory a model that begins to learn one "
      "(prior_turn_rate_rad_s), as CoordinatedTurnRate does");
  static_assert(
      std::is_convertible_v<Rate, std::decay_t<decltype(filter.motion().turn_rate_rad_s)>>,
      "wakeline: each lane has its own turn rate here; use KnownTurn<Scalar> instead of "
      "CoordinatedTurn");
  auto motion = filter.motion();
  motion.turn_rate_rad_s = turn_rate_rad_s;
  filter.set_motion(motion);
}

/// True for a filter that estimates its turn rate from a prior.
template <class Filter>
inline constexpr bool kLearnsTurnRate = requires(const Filter& filter) {
  filter.motion().prior_turn_rate_rad_s;
};

/// Standard deviation of the turn rate that a filter assumes; 0 for one with a known rate.
template <class Filter>
double turn_rate_std_rad_s(const Filter& filter) noexcept {
  if constexpr (kLearnsTurnRate<Filter>)
    return filter.motion().prior_turn_rate_std_rad_s;
  else
    return 0.0;
}

/// Sets the turn rate of a mode: the known rate, or the mean and standard deviation of the prior of
/// a filter that estimates it.
template <class Filter>
void expect_turn_rate(Filter& filter, double turn_rate_rad_s, double std_rad_s) noexcept {
  if constexpr (kLearnsTurnRate<Filter>) {
    auto motion = filter.motion();
    motion.prior_turn_rate_rad_s = turn_rate_rad_s;
    motion.prior_turn_rate_std_rad_s = std_rad_s;
    filter.set_motion(motion);
  } else {
    set_turn_rate(filter, turn_rate_rad_s);
  }
}

}  // namespace wakeline
