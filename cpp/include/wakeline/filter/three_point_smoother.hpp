// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "wakeline/core/fields.hpp"
#include "wakeline/filter/smoother.hpp"

namespace wakeline {

/// Three consecutive readings: differences from the middle one, and times.
template <class Scalar>
struct ThreePoints {
  Scalar before = Scalar(0);    ///< x_i-1 - x_i
  Scalar after = Scalar(0);     ///< x_i+1 - x_i
  Scalar before_s = Scalar(1);  ///< t_-, from x_i-1 to x_i, positive
  Scalar after_s = Scalar(1);   ///< t_+

  [[nodiscard]] Scalar backward_slope() const noexcept { return -before / before_s; }
  [[nodiscard]] Scalar forward_slope() const noexcept { return after / after_s; }
  [[nodiscard]] Scalar whole_slope() const noexcept {
    return (after - before) / (before_s + after_s);
  }

  /// (22) minus the middle reading: the mean with weights p_-/t_-, 1, p_+/t_+.
  [[nodiscard]] Scalar correction(Scalar weight_before_s, Scalar weight_after_s) const noexcept {
    const Scalar w_before = weight_before_s / before_s, w_after = weight_after_s / after_s;
    return (w_before * before + w_after * after) / (Scalar(1) + w_before + w_after);
  }

  /// (25), five-fold form: 2/3 c + (b + f) / 6, the slopes averaged with Simpson's weights. Less
  /// noise than the exact form, but exact for a parabola at equal steps only.
  [[nodiscard]] Scalar simpson_rate() const noexcept {
    return whole_slope() * Scalar(2) / 3 + (backward_slope() + forward_slope()) / 6;
  }

  /// (25), exact for a parabola at any steps: b + f - c.
  [[nodiscard]] Scalar parabola_rate() const noexcept {
    return backward_slope() + forward_slope() - whole_slope();
  }
};

/// The weights of (22).
struct ThreePointSettings {
  double weight_before_s = 1.0;
  double weight_after_s = 1.0;
  bool adaptive = false;
  bool parabola = true;

  static constexpr auto fields() noexcept {
    using T = ThreePointSettings;
    return field_table(field("weight_before_s", &T::weight_before_s, kNotNegative, "s",
                             "Step at which the reading before counts as much as the middle one."),
                       field("weight_after_s", &T::weight_after_s, kNotNegative, "s",
                             "Step at which the reading after counts as much as the middle one."),
                       field("adaptive", &T::adaptive,
                             "Both weights are fitted to the last five readings instead."),
                       field("parabola", &T::parabola,
                             "The rate is exact for a parabola, else it has Simpson's weights."));
  }
};

/// Each reading smoothed with its neighbours (22); the value is that of the reading before the
/// newest.
///
/// Adaptive weights (24) are P = p / (1 + p_-/t_- + p_+/t_+), P_- on (x_i-1 - x_i)/t_- and P_+ on
/// (x_i+1 - x_i)/t_+, chosen by least squares to bring the inner readings of a window of five
/// nearest to the line through it. (The source's target is the smoother's own output, which any
/// weights reach.)
template <class Residual = Linear, class ScalarType = double>
class ThreePointSmoother {
 public:
  using Scalar = ScalarType;
  static constexpr int kWindow = 5;

  /// Throws `std::invalid_argument` when a weight is invalid.
  explicit ThreePointSmoother(const ThreePointSettings& settings = {}) : settings_(settings) {
    validate_fields(settings);
  }

  /// Adds a reading. Two readings of the same time (dt_s = 0) are replaced by their mean.
  Status update(Scalar dt_s, Scalar reading) noexcept {
    const Status status = readings_.take(dt_s, reading);
    if (status != Status::kOk) return status;
    const int n = readings_.size();
    correction_ = rate_ = Scalar(0);
    if (n == 2) rate_ = -readings_.offset(0) / delay_s();
    if (n < 3) return status;
    const ThreePoints<Scalar> last = points(n - 2);
    correction_ =
        settings_.adaptive && n == kWindow
            ? adaptive_correction()
            : last.correction(Scalar(settings_.weight_before_s), Scalar(settings_.weight_after_s));
    rate_ = settings_.parabola ? last.parabola_rate() : last.simpson_rate();
    return status;
  }

  /// The value at the reading before the newest; of a single reading, that reading.
  [[nodiscard]] Scalar value() const noexcept { return forecast(-delay_s()); }
  /// The rate at the same time.
  [[nodiscard]] Scalar rate() const noexcept { return rate_; }
  /// Time from that to the newest reading.
  [[nodiscard]] Scalar delay_s() const noexcept {
    const int n = readings_.size();
    return n > 1 ? readings_.gap_s(n - 1) : Scalar(0);
  }
  /// `ahead_s` after the newest reading.
  [[nodiscard]] Scalar forecast(Scalar ahead_s) const noexcept {
    const int n = readings_.size();
    const Scalar middle = n > 1 ? readings_.offset(n - 2) : Scalar(0);
    return Residual::normal(readings_.newest() + middle + correction_ +
                            rate_ * (delay_s() + ahead_s));
  }

  /// Saves or restores the state; invalid bytes change nothing.
  void archive(Archive& fields) {
    ThreePointSmoother read = *this;
    read.readings_.archive(fields);
    fields(read.correction_);
    fields(read.rate_);
    if (fields.ok()) *this = read;
  }

 private:
  /// The three readings about reading k of the window.
  [[nodiscard]] ThreePoints<Scalar> points(int k) const noexcept {
    return {readings_.offset(k - 1) - readings_.offset(k),
            readings_.offset(k + 1) - readings_.offset(k), readings_.gap_s(k),
            readings_.gap_s(k + 1)};
  }

  /// (24), then (22) with these weights.
  [[nodiscard]] Scalar adaptive_correction() const noexcept {
    // The least-squares line through the window, times relative to its middle reading.
    Scalar t[kWindow] = {}, mean_t = Scalar(0), mean_x = Scalar(0);
    for (int k = 1; k < kWindow; ++k) t[k] = t[k - 1] + readings_.gap_s(k);
    for (int k = 0; k < kWindow; ++k) {
      mean_t += t[k] / kWindow;
      mean_x += readings_.offset(k) / kWindow;
    }
    Scalar tt = Scalar(0), tx = Scalar(0);
    for (int k = 0; k < kWindow; ++k) {
      tt += (t[k] - mean_t) * (t[k] - mean_t);
      tx += (t[k] - mean_t) * (readings_.offset(k) - mean_x);
    }
    // Normal equations of the weights.
    Scalar uu = Scalar(0), uw = Scalar(0), ww = Scalar(0), uy = Scalar(0), wy = Scalar(0);
    for (int k = 1; k + 1 < kWindow; ++k) {
      const ThreePoints<Scalar> at = points(k);
      const Scalar u = at.before / at.before_s, w = at.after / at.after_s;
      const Scalar y = mean_x + (t[k] - mean_t) * tx / tt - readings_.offset(k);
      uu += u * u;
      uw += u * w;
      ww += w * w;
      uy += u * y;
      wy += w * y;
    }
    const ThreePoints<Scalar> last = points(kWindow - 2);
    const Scalar determinant = uu * ww - uw * uw;
    constexpr Scalar kSafe = Scalar(64) * std::numeric_limits<Scalar>::epsilon();
    if (!(determinant > kSafe * uu * ww))  // collinear readings need no smoothing
      return Scalar(0);
    const Scalar p_before = (uy * ww - wy * uw) / determinant;
    const Scalar p_after = (wy * uu - uy * uw) / determinant;
    const Scalar correction =
        p_before * last.before / last.before_s + p_after * last.after / last.after_s;
    return std::isfinite(correction) ? correction : Scalar(0);
  }

  ThreePointSettings settings_;
  ReadingWindow<Residual, kWindow, Scalar> readings_;
  Scalar correction_ = Scalar(0);
  Scalar rate_ = Scalar(0);
};

}  // namespace wakeline
