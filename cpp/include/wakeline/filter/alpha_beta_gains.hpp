// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Gain schedules of alpha-beta and alpha-beta-gamma filters.
//
// A filter with `Order` states per axis (2: position and velocity, 3: also acceleration) corrects
// them by alpha e, beta e / T and gamma e / (2 T²), e the innovation and T the time since the last
// reading. The gains are a dimensionless vector [alpha, beta] or [alpha, beta, gamma].
#pragma once

#include <cmath>
#include <string>
#include <type_traits>
#include <variant>

#include "wakeline/core/fields.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// True for a stable alpha-beta filter: alpha > 0, beta > 0 and 2 alpha + beta < 4.
constexpr bool stable_gains(double alpha, double beta) noexcept {
  return alpha > 0.0 && beta > 0.0 && 2.0 * alpha + beta < 4.0;
}

/// True for a stable alpha-beta-gamma filter: also 0 < gamma < 4 alpha beta / (2 - alpha).
constexpr bool stable_gains(double alpha, double beta, double gamma) noexcept {
  return stable_gains(alpha, beta) && gamma > 0.0 && gamma * (2.0 - alpha) < 4.0 * alpha * beta;
}

/// The inputs of a gain schedule.
template <class Scalar = double>
struct GainOccasion {
  Scalar reading = Scalar(1);    ///< 1 for the first one after the start
  Scalar elapsed_s = Scalar(1);  ///< since the reading before, or the start
  Scalar std_m = Scalar(1);      ///< error of the reading along the axis
  Scalar range_m = Scalar(0);    ///< from the sensor
  /// [alpha, beta] that the last readings call for, (33); see `AdaptiveGains`.
  Vec<Scalar, 2> response = Vec<Scalar, 2>::Ones();
};

/// The number of plots that count, limited to `most`; 0 for no limit.
template <class Scalar>
Scalar counted(Scalar plots, int max_plots) noexcept {
  const Scalar most = Scalar(max_plots);
  return max_plots > 0 ? select(plots < most, plots, most) : plots;
}

/// Constant gains.
struct ConstantGains {
  double alpha = 0.5;
  double beta = 0.2;
  double gamma = 0.0;

  static constexpr auto fields() noexcept {
    using C = ConstantGains;
    return field_table(
        field("alpha", &C::alpha, kFinite, "1", "Gain of the position."),
        field("beta", &C::beta, kFinite, "1", "Gain of the velocity, over the step."),
        field("gamma", &C::gamma, kFinite, "1",
              "Gain of the acceleration, over half the squared step; 0 for an alpha-beta filter."));
  }

  template <int Order, class Scalar>
  Vec<Scalar, Order> gains(const GainOccasion<Scalar>&) const noexcept {
    if constexpr (Order == 2)
      return {Scalar(alpha), Scalar(beta)};
    else
      return {Scalar(alpha), Scalar(beta), Scalar(gamma)};
  }

  /// Throws `std::invalid_argument` when the gains are not stable.
  template <int Order>
  void validate() const {
    require(stable_gains(alpha, beta), "alpha and beta",
            "positive with 2 alpha + beta below 4, which a stable filter needs", 2 * alpha + beta);
    if constexpr (Order == 2)
      require(gamma == 0.0, "gamma", "left out: this filter holds no acceleration", gamma);
    else
      require(stable_gains(alpha, beta, gamma), "gamma",
              "between 0 and 4 alpha beta / (2 - alpha), which a stable filter needs", gamma);
  }
};

/// The fields of schedules over the readings so far.
template <class Memory>
constexpr auto memory_fields() noexcept {
  return field_table(field("plots_before", &Memory::plots_before, at_least(0), "plots",
                           "Plots that the start was made of."),
                     field("max_plots", &Memory::max_plots, at_least(0), "plots",
                           "Plots at which the gains stop falling; 0: never."));
}

/// Throws `std::invalid_argument` when a field, or a limit below the order, makes no sense.
template <int Order, class Memory>
void validate_memory(const Memory& memory) {
  validate_fields(memory);
  require(memory.max_plots == 0 || memory.max_plots >= Order, "max_plots",
          Order == 2 ? "0 or 2 or more" : "0 or 3 or more", memory.max_plots);
}

/// Growing memory: the gains of the least-squares line (or parabola) through all n readings so far.
/// With regular steps the filter equals that line exactly, independent of the start.
///     alpha = 2(2n-1) / (n(n+1)),  beta = 6 / (n(n+1));
///     alpha = 3(3n²-3n+2) / N,  beta = 18(2n-1) / N,  gamma = 120 / N,  N = n(n+1)(n+2).
/// A missed scan does not count; the step after it is longer. Source: E. Brookner, Tracking and
/// Kalman Filtering Made Easy, 1998, 5.7.
struct GrowingMemory {
  int plots_before = 0;
  int max_plots = 0;

  static constexpr auto fields() noexcept { return memory_fields<GrowingMemory>(); }

  template <int Order, class Scalar>
  Vec<Scalar, Order> gains(const GainOccasion<Scalar>& at) const noexcept {
    const Scalar n = counted(at.reading + Scalar(plots_before), max_plots);
    // Fewer plots than a line or parabola needs: it passes through them and the start.
    const auto one = n < Scalar(2), two = n < Scalar(3);
    if constexpr (Order == 2) {
      const Scalar product = n * (n + 1);
      return {2 * (2 * n - 1) / product, select(one, Scalar(0), 6 / product)};
    } else {
      const Scalar product = n * (n + 1) * (n + 2);
      const Scalar beta = select(two, Scalar(1), 18 * (2 * n - 1) / product);
      return {3 * (3 * n * n - 3 * n + 2) / product, select(one, Scalar(0), beta),
              select(two, Scalar(0), 120 / product)};
    }
  }

  template <int Order>
  void validate() const {
    validate_memory<Order>(*this);
  }
};

/// Recent memory: the gains of the least-squares line through all n readings with weights
/// 1, 2, ..., n, which forgets sooner than `GrowingMemory`:
///     alpha = 6n / ((n+1)(n+2)),  beta = 12 / ((n+1)(n+2)).
/// Source: I. M. Hannoshyna, T. V. Kalinichenko, P. V. Nikitin, Research of methods of forecasting
/// the movement, search and tracking of sea objects, equation (29), printed with i = n - 1.
struct RecentMemory {
  int plots_before = 0;
  int max_plots = 0;

  static constexpr auto fields() noexcept { return memory_fields<RecentMemory>(); }

  template <int Order, class Scalar>
  Vec<Scalar, 2> gains(const GainOccasion<Scalar>& at) const noexcept {
    const Scalar n = counted(at.reading + Scalar(plots_before), max_plots);
    const Scalar product = (n + 1) * (n + 2);
    return {6 * n / product, select(n < Scalar(2), Scalar(0), 12 / product)};
  }

  template <int Order>
  void validate() const {
    validate_memory<Order>(*this);
  }
};

/// beta = alpha² / (2 - alpha): the least transient error of a velocity step for the noise
/// reduction of a given alpha. Source: T. R. Benedict, G. W. Bordner, IRE Trans. AC-7, 1962.
struct BenedictBordner {
  double alpha = 0.5;

  static constexpr auto fields() noexcept {
    using B = BenedictBordner;
    return field_table(field("alpha", &B::alpha, above_to(0, 1), "1", "Gain of the position."));
  }

  template <int Order, class Scalar>
  Vec<Scalar, 2> gains(const GainOccasion<Scalar>&) const noexcept {
    return {Scalar(alpha), Scalar(alpha * alpha / (2.0 - alpha))};
  }

  template <int Order>
  void validate() const {
    validate_fields(*this);
  }
};

/// Critically damped: all poles at theta, equal to the least-squares line or parabola with weights
/// theta per reading back (fading memory); 0 uses the newest readings only.
///     alpha = 1 - theta²,  beta = (1 - theta)²;
///     alpha = 1 - theta³,  beta = 3/2 (1 - theta)² (1 + theta),  gamma = 2 (1 - theta)³.
/// One theta per reading, independent of the step. Source: Brookner 1998, 1.2.6 and 7.2.
struct CriticallyDamped {
  double theta = 0.5;

  static constexpr auto fields() noexcept {
    using C = CriticallyDamped;
    return field_table(
        field("theta", &C::theta, from_to_below(0, 1), "1",
              "Weight of a reading over that of the next one; 0: only the newest readings count."));
  }

  template <int Order, class Scalar>
  Vec<Scalar, Order> gains(const GainOccasion<Scalar>&) const noexcept {
    const Scalar t = Scalar(theta);
    const Scalar u = Scalar(1) - t;
    if constexpr (Order == 2)
      return {u * (1 + t), u * u};
    else
      return {u * (1 + t + t * t), Scalar(1.5) * u * u * (1 + t), 2 * u * u * u};
  }

  template <int Order>
  void validate() const {
    validate_fields(*this);
  }
};

/// Gains of the steady-state Kalman filter by the tracking index, accel_std T² / error of the
/// reading.
///
/// They are optimal for a motion with a random acceleration (with three states: a change of
/// acceleration) of that standard deviation in each step, `PiecewiseAcceleration`. The error is
/// that of each reading along and across the bearing, so that the gains depend on the range, and
/// the index depends on the step. Source: P. R. Kalata, IEEE Trans. AES-20, 1984; Bar-Shalom, Li,
/// Kirubarajan, 6.5.2 and 6.5.3.
struct TrackingIndex {
  double accel_std_mps2 = 0.1;

  static constexpr auto fields() noexcept {
    using T = TrackingIndex;
    return field_table(field("accel_std_mps2", &T::accel_std_mps2, kPositive, "m/s²",
                             "Standard deviation of the acceleration, of three states of its "
                             "change, drawn anew for each step."));
  }

  template <int Order, class Scalar>
  Vec<Scalar, Order> gains(const GainOccasion<Scalar>& at) const noexcept {
    return of_index<Order>(Scalar(accel_std_mps2) * at.elapsed_s * at.elapsed_s / at.std_m);
  }

  /// Gains for a tracking index that is not negative.
  ///
  /// With r = sqrt(1 - alpha), two states: r = 4 / (index + 4 + sqrt(index² + 8 index)) and beta =
  /// index r. Three states: index = 2 (1 - r)³ / (r (1 + r)), beta = 2 (1 - r)², gamma = 2 index r.
  template <int Order, class Scalar>
  static Vec<Scalar, Order> of_index(Scalar index) noexcept {
    const auto [r, w] = root<Order>(index);
    if constexpr (Order == 2)
      return {w * (1 + r), index * r};
    else
      return {w * (1 + r), 2 * w * w, 2 * index * r};
  }

  /// Covariance of the states of one axis after an update, in the steady state with period T and
  /// readings of error `std_m`.
  template <int Order, class Scalar>
  [[nodiscard]] Mat<Scalar, Order, Order> steady_covariance(Scalar period_s,
                                                            Scalar std_m) const noexcept {
    const Scalar index = Scalar(accel_std_mps2) * period_s * period_s / std_m;
    const Vec<Scalar, Order> k = of_index<Order>(index);
    const Scalar r = root<Order>(index).r;
    const Scalar p = std_m * std_m, t = period_s;
    Mat<Scalar, Order, Order> covariance;
    if constexpr (Order == 2) {
      covariance(0, 0) = k[0] * p;
      covariance(1, 0) = k[1] / t * p;
      covariance(1, 1) = k[1] * (k[0] - k[1] / 2) / (r * r * t * t) * p;
    } else {
      const Scalar t2 = t * t;
      covariance(0, 0) = k[0] * p;
      covariance(1, 0) = k[1] / t * p;
      covariance(2, 0) = k[2] / (2 * t2) * p;
      covariance(1, 1) = (8 * k[0] * k[1] + k[2] * (k[1] - 2 * k[0] - 4)) / (8 * t2 * r * r) * p;
      covariance(2, 1) = k[1] * (2 * k[1] - k[2]) / (4 * t2 * t * r * r) * p;
      covariance(2, 2) = k[2] * (2 * k[1] - k[2]) / (4 * t2 * t2 * r * r) * p;
    }
    mirror_lower<Scalar, Order>(covariance);
    return covariance;
  }

  template <int Order>
  void validate() const {
    validate_fields(*this);
  }

 private:
  template <class Scalar>
  struct Root {
    Scalar r;  ///< sqrt(1 - alpha)
    Scalar w;  ///< 1 - r
  };

  template <int Order, class Scalar>
  static Root<Scalar> root(Scalar index) noexcept {
    using std::exp, std::log, std::sqrt;
    const auto moves = index > Scalar(0);
    const Scalar i = select(moves, index, Scalar(1));
    if constexpr (Order == 2) {
      const Scalar s = sqrt(i * (i + 8));
      return {select(moves, 4 / (i + 4 + s), Scalar(1)),
              select(moves, (i + s) / (i + 4 + s), Scalar(0))};
    } else {
      // Newton's iteration on 2 w³ = index (1 - w)(2 - w), which has one solution in 0 .. 1.
      const Scalar start = exp(log(i) / 3);
      Scalar w = start / (1 + start);
      for (int k = 0; k < 8; ++k)
        w -= (2 * w * w * w - i * (1 - w) * (2 - w)) / (6 * w * w + i * (3 - 2 * w));
      return {select(moves, 2 * w * w * w / (i * (2 - w)), Scalar(1)), select(moves, w, Scalar(0))};
    }
  }
};

/// Gains that depend on the range only, as in a radar plotting aid: each is that of `near` up to
/// its range, then inversely proportional to the range, down to that of `far`. By default, with D
/// in km,
///     alpha = 20 / D  within 0.2 .. 0.5,  beta = 4 / D  within 0.01 .. 0.2.
/// Source: I. M. Hannoshyna, T. V. Kalinichenko, P. V. Nikitin, Research of methods of forecasting
/// the movement, search and tracking of sea objects, equation (30) with its caps. The range is from
/// own ship where the sensor has it, else from the origin (a `Fix`, also in a `Tracker`).
struct RangeDependent {
  double alpha_range_m = 40e3;
  double beta_range_m = 20e3;
  double near_alpha = 0.5;
  double near_beta = 0.2;
  double far_alpha = 0.2;
  double far_beta = 0.01;

  static constexpr auto fields() noexcept {
    using R = RangeDependent;
    return field_table(
        field("alpha_range_m", &R::alpha_range_m, kPositive, "m",
              "Range up to which the gain of the position is near_alpha."),
        field("beta_range_m", &R::beta_range_m, kPositive, "m",
              "Range up to which the gain of the velocity is near_beta."),
        field("near_alpha", &R::near_alpha, kPositive, "1", "Gain of the position at short range."),
        field("near_beta", &R::near_beta, kPositive, "1", "Gain of the velocity at short range."),
        field("far_alpha", &R::far_alpha, kPositive, "1",
              "Least gain of the position; at most near_alpha."),
        field("far_beta", &R::far_beta, kPositive, "1",
              "Least gain of the velocity; at most near_beta."));
  }

  template <int Order, class Scalar>
  Vec<Scalar, 2> gains(const GainOccasion<Scalar>& at) const noexcept {
    const auto gain = [&](double up_to_m, double nearest, double least) {
      const Scalar nearness = Scalar(up_to_m) / at_least(at.range_m, Scalar(up_to_m));
      return at_least(Scalar(nearest) * nearness, Scalar(least));
    };
    return {gain(alpha_range_m, near_alpha, far_alpha), gain(beta_range_m, near_beta, far_beta)};
  }

  template <int Order>
  void validate() const {
    validate_fields(*this);
    require(stable_gains(near_alpha, near_beta), "near_alpha and near_beta",
            "positive with 2 alpha + beta below 4, which a stable filter needs",
            2 * near_alpha + near_beta);
    require(far_alpha <= near_alpha, "far_alpha", "at most near_alpha", far_alpha);
    require(far_beta <= near_beta, "far_beta", "at most near_beta", far_beta);
  }
};

/// Gains from the last readings, (33): those of `GrowingMemory` over a window, each weighted with
/// the squared innovation that it met,
///     alpha = sum((x^ - x~) e) / sum(e²),  beta = sum(dv e/T) / sum((e/T)²).
/// Noise alone makes them about 0.74 and 0.37 with a window of five; a maneuver changes them
/// little. The second reading of the window is left out: its innovation is the motion of the
/// target, on whose speed the gains would depend. Source: I. M. Hannoshyna, T. V. Kalinichenko,
/// P. V. Nikitin, Research of methods of forecasting the movement, search and tracking of sea
/// objects, equation (33), in two passes; see cpp/docs/theory/dead_reckoning.md.
struct AdaptiveGains {
  static constexpr int kMostPlots = 8;
  int window = 5;

  static constexpr auto fields() noexcept {
    return field_table(field("window", &AdaptiveGains::window, between(3, kMostPlots), "plots",
                             "Plots that the gains come from, the newest among them."));
  }

  template <int Order, class Scalar>
  Vec<Scalar, 2> gains(const GainOccasion<Scalar>& at) const noexcept {
    return at.response;
  }

  template <int Order>
  void validate() const {
    validate_fields(*this);
  }
};

/// Any of the schedules for this number of states per axis.
template <int Order>
using GainSchedule =
    std::conditional_t<Order == 2,
                       std::variant<ConstantGains, GrowingMemory, BenedictBordner, CriticallyDamped,
                                    TrackingIndex, RangeDependent, RecentMemory, AdaptiveGains>,
                       std::variant<ConstantGains, GrowingMemory, CriticallyDamped, TrackingIndex>>;

}  // namespace wakeline
