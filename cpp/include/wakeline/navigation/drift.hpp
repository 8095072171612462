// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Observed drift of a vessel: its velocity over ground minus that through the water, [north, east]
// m/s. Source: Hannoshyna, Kalinichenko, Nikitin, equations (16)-(20); see
// cpp/docs/theory/dead_reckoning.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/archive.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/navigation/dead_reckoning.hpp"

namespace wakeline {

// At once -----------------------------------------------------------------------------------------

/// Velocity through the water from log and compass, with its covariance: the log error along the
/// heading, speed times the heading error across it.
inline Gaussian<2> water_velocity(double speed_mps, double heading_rad, double log_std_mps,
                                  double heading_std_rad) noexcept {
  const Vec<double, 2> ahead(std::cos(heading_rad), std::sin(heading_rad));
  const Vec<double, 2> abeam(-ahead[1], ahead[0]);
  const double across_std = speed_mps * heading_std_rad;
  return {speed_mps * ahead, log_std_mps * log_std_mps * ahead * ahead.transpose() +
                                 across_std * across_std * abeam * abeam.transpose()};
}

/// From velocities: (V_N - V cos K, V_E - V sin K).
inline Vec<double, 2> drift_from_rates_mps(const Vec<double, 2>& ground_velocity_mps,
                                           const SpeedCourse& through_water) noexcept {
  return ground_velocity_mps - through_water.velocity_mps();
}

/// The same for uncertain velocities with independent errors.
inline Gaussian<2> drift_between(const Gaussian<2>& over_ground,
                                 const Gaussian<2>& through_water) noexcept {
  return {over_ground.mean - through_water.mean, over_ground.covariance + through_water.covariance};
}

/// Own velocity over ground from a stationary mark tracked by radar: minus its motion relative to
/// the ship (axes to true north).
inline Gaussian<2> ground_velocity_from_mark(const Gaussian<2>& relative_velocity) noexcept {
  return {-relative_velocity.mean, relative_velocity.covariance};
}

/// The same from several marks, each weighted by its information. NaN without a mark or where a
/// covariance is not positive definite.
inline Gaussian<2> ground_velocity_from_marks(
    std::span<const Gaussian<2>> relative_velocities) noexcept {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const Gaussian<2> unknown{Vec<double, 2>::Constant(nan), Mat<double, 2, 2>::Constant(nan)};
  const Mat<double, 2, 2> identity = Mat<double, 2, 2>::Identity();
  Mat<double, 2, 2> information = Mat<double, 2, 2>::Zero();
  Vec<double, 2> weighted = Vec<double, 2>::Zero();
  for (const Gaussian<2>& mark : relative_velocities) {
    const Cholesky<2> factor(mark.covariance);
    if (!factor.ok()) return unknown;
    information += factor.solve<2>(identity);
    weighted -= factor.solve<1>(mark.mean);
  }
  const Cholesky<2> factor(information);
  if (!factor.ok()) return unknown;
  return {factor.solve<1>(weighted), factor.solve<2>(identity)};
}

// Stabilisation of a radar's picture --------------------------------------------------------------

/// True velocity of a target through the water (sea stabilised): its motion relative to the ship
/// plus the ship's by log and compass. It corresponds to the target's lights and aspect.
inline Vec<double, 2> sea_stabilised_mps(const Vec<double, 2>& relative_mps,
                                         const SpeedCourse& own_through_water) noexcept {
  return relative_mps + own_through_water.velocity_mps();
}

/// True velocity of a target over ground (ground stabilised); zero for a stationary mark.
inline Vec<double, 2> ground_stabilised_mps(const Vec<double, 2>& relative_mps,
                                            const SpeedCourse& own_through_water,
                                            const Vec<double, 2>& drift_mps) noexcept {
  return sea_stabilised_mps(relative_mps, own_through_water) + drift_mps;
}

// Over a window -----------------------------------------------------------------------------------

/// Parameters of a drift estimate over a window.
struct DriftWindowSettings {
  int max_fixes = 20;
  double log_std_mps = 0.0;
  double heading_std_rad = 0.0;
  double alteration_mps = 0.0;

  static constexpr auto fields() noexcept {
    using W = DriftWindowSettings;
    return field_table(
        field("max_fixes", &W::max_fixes, at_least(2), "fixes", "Fixes that are remembered."),
        field("log_std_mps", &W::log_std_mps, kNotNegative, "m/s",
              "Standard deviation of a reading of the log."),
        field("heading_std_rad", &W::heading_std_rad, kNotNegative, "rad",
              "Standard deviation of a reading of the compass."),
        field("alteration_mps", &W::alteration_mps, kNotNegative, "m/s",
              "Change of the velocity through the water since a fix that ends the line there; "
              "0: none does."));
  }
};

/// The drift of a vessel from the differences between observed and reckoned positions over a
/// sliding window: the slope of the least-squares line through them, with its covariance.
///
/// The differences have the errors of the fixes and the accumulated errors of log and compass in
/// between; the errors of each reading (each `advance`) are independent. Steps between fixes
/// therefore have a block-tridiagonal covariance, R_k + R_k+1 + Q next to -R_k, for which the slope
/// is optimal. Without errors of log and compass it is the ordinary line. A constant error of log
/// or compass appears as drift. Storage is in place, no heap.
///
/// With `alteration_mps` a line ends at the fix before an alteration of course or speed and another
/// begins at the fix after it: the step between is left out, since log and compass are read too
/// seldom to reckon the way through it. The lines of the window share one slope.
template <int Capacity = 32>
class DriftWindow {
 public:
  static_assert(Capacity >= 2, "wakeline: a drift needs two fixes");
  static constexpr int kCapacity = Capacity;
  using Settings = DriftWindowSettings;

  /// Throws `std::invalid_argument` when a setting is invalid. The default number of fixes is
  /// limited to the capacity.
  explicit DriftWindow(
      const Settings& settings = {.max_fixes = std::min(DriftWindowSettings{}.max_fixes, Capacity)})
      : settings_(settings) {
    validate_fields(settings);
    require(settings.max_fixes <= Capacity, "max_fixes",
            ("at most " + std::to_string(Capacity)).c_str(), settings.max_fixes);
  }

  /// Removes all fixes, e.g. after a course alteration.
  void clear() noexcept {
    size_ = 0;
    step_ = {};
  }

  /// Advances by a time step at a speed through the water and a heading. A number that is not
  /// `in_range` gives `kNotFinite` and changes nothing.
  Status advance(double dt_s, double speed_mps, double heading_rad) noexcept {
    if (const Status status = check_time_step(dt_s); status != Status::kOk) return status;
    if (!in_range(speed_mps) || !in_range(heading_rad)) return Status::kNotFinite;
    const Gaussian<2> water =
        water_velocity(speed_mps, heading_rad, settings_.log_std_mps, settings_.heading_std_rad);
    if (!step_.begun) step_.begin(water.mean);
    const double change_mps = (water.mean - step_.begun_mps).norm();
    step_.altered |= settings_.alteration_mps > 0.0 && change_mps > settings_.alteration_mps;
    now_mps_ = water.mean;
    step_.gap_s += dt_s;
    step_.reckoned_m += dt_s * water.mean;
    step_.reckoned_covariance_m2 += dt_s * dt_s * water.covariance;
    return Status::kOk;
  }

  /// Adds a fix of the present time, [north, east] m on a plane. One whose mean is not `in_range`
  /// or whose covariance is not positive definite changes nothing.
  Status add(const Gaussian<2>& fix) noexcept {
    if (const Status status = check(fix); status != Status::kOk) return status;
    newest_ = (newest_ + 1) % settings_.max_fixes;
    size_ = std::min(size_ + 1, settings_.max_fixes);
    step_.fix = fix;
    latest(0) = step_;
    const bool under_way = step_.begun;
    step_ = {};
    if (under_way) step_.begin(now_mps_);
    return Status::kOk;
  }

  /// Saves or restores the fixes and the motion since the last one.
  void archive(Archive& fields) {
    for (Fixed& fixed : fixes_) fixed.archive(fields);
    step_.archive(fields);
    fields(now_mps_);
    fields(size_);
    fields(newest_);
    const int most = settings_.max_fixes;
    if (size_ < 0 || size_ > most || newest_ < 0 || newest_ >= most) fields.fail();
  }

  /// Number of stored fixes.
  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] const Settings& settings() const noexcept { return settings_; }

  /// True when there are two fixes of different times without an alteration in between.
  [[nodiscard]] bool ready() const noexcept {
    double span_s = 0.0;
    for (int k = 0; k + 1 < size_; ++k) span_s += latest(k).altered ? 0.0 : latest(k).gap_s;
    return span_s > 0.0;
  }

  /// The drift, [north, east] m/s; zero with infinite covariance until `ready()`, and while the
  /// times are too close together.
  [[nodiscard]] Gaussian<2> drift() const noexcept {
    const Mat<double, 2, 2> identity = Mat<double, 2, 2>::Identity();
    if (!ready()) return unknown();
    // Block elimination of the tridiagonal covariance of the steps: subtracts from each step the
    // part correlated with the one before through their common fix. `rest` is the covariance of a
    // step without the fix at its end.
    Mat<double, 2, 2> information = Mat<double, 2, 2>::Zero();
    Vec<double, 2> weighted = Vec<double, 2>::Zero();
    Mat<double, 2, 2> rest = latest(size_ - 1).fix.covariance;
    Mat<double, 2, 2> time = Mat<double, 2, 2>::Zero();
    Vec<double, 2> off = Vec<double, 2>::Zero();
    Cholesky<2> before;
    bool continued = false;
    for (int k = size_ - 2; k >= 0; --k) {
      const Fixed &from = latest(k + 1), &to = latest(k);
      if (to.altered) {
        rest = to.fix.covariance;
        continued = false;
        continue;
      }
      Mat<double, 2, 2> t = to.gap_s * identity;
      Vec<double, 2> d = to.fix.mean - from.fix.mean - to.reckoned_m;
      if (continued) {
        const Mat<double, 2, 2> overlap = before.template solve<2>(from.fix.covariance).transpose();
        rest = overlap * rest;
        mirror_lower<double, 2>(rest);
        t += overlap * time;
        d += overlap * off;
      }
      rest += to.reckoned_covariance_m2;
      time = t;
      off = d;
      continued = true;
      before.compute(Mat<double, 2, 2>(rest + to.fix.covariance));
      information += time.transpose() * before.template solve<2>(time);
      weighted += time.transpose() * before.template solve<1>(off);
    }
    mirror_lower<double, 2>(information);
    const Cholesky<2> factor(information);
    if (!factor.ok()) return unknown();
    Gaussian<2> drift{factor.template solve<1>(weighted), factor.template solve<2>(identity)};
    mirror_lower<double, 2>(drift.covariance);
    return drift;
  }

 private:
  /// A fix, and the reckoned motion from the fix before.
  struct Fixed {
    Gaussian<2> fix;
    double gap_s = 0.0;
    Vec<double, 2> reckoned_m = Vec<double, 2>::Zero();
    Mat<double, 2, 2> reckoned_covariance_m2 = Mat<double, 2, 2>::Zero();
    Vec<double, 2> begun_mps = Vec<double, 2>::Zero();  ///< through the water, at the fix before
    bool begun = false;
    bool altered = false;

    void begin(const Vec<double, 2>& water_mps) noexcept {
      begun_mps = water_mps;
      begun = true;
    }

    void archive(Archive& fields) {
      fields(fix.mean);
      fields(fix.covariance);
      fields(gap_s);
      fields(reckoned_m);
      fields(reckoned_covariance_m2);
      fields(begun_mps);
      fields(begun);
      fields(altered);
    }
  };

  static Gaussian<2> unknown() noexcept {
    Gaussian<2> drift{Vec<double, 2>::Zero(), Mat<double, 2, 2>::Zero()};
    drift.covariance.diagonal().setConstant(std::numeric_limits<double>::infinity());
    return drift;
  }

  /// The k-th newest fix.
  [[nodiscard]] const Fixed& latest(int k) const noexcept {
    const int slot = newest_ - k;
    return fixes_[static_cast<std::size_t>(slot < 0 ? slot + settings_.max_fixes : slot)];
  }
  Fixed& latest(int k) noexcept {
    return const_cast<Fixed&>(static_cast<const DriftWindow&>(*this).latest(k));
  }

  Settings settings_;
  std::array<Fixed, static_cast<std::size_t>(Capacity)> fixes_{};
  Fixed step_;                                       ///< since the newest fix
  Vec<double, 2> now_mps_ = Vec<double, 2>::Zero();  ///< the last reading
  int size_ = 0;
  int newest_ = 0;
};

}  // namespace wakeline
