// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/fields.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/video/video_plot.hpp"

namespace wakeline {

struct Plot;

/// What a console knows of its radar and of the vessels it looks at.
struct Radar {
  double range_std_m = 10.0;
  double bearing_std_rad = deg(1.0);
  double extent_std_m = 5.0;
  double period_s = 3.0;
  double max_speed_mps = 30.0;
  double bearing_offset_rad = 0.0;
  double range_offset_m = 0.0;
  double time_offset_s = 0.0;
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double blind_from_rad = 0.0;
  double blind_to_rad = 0.0;
  double correlation_time_s = 0.0;

  static constexpr auto fields() noexcept {
    using R = Radar;
    return field_table(
        field("range_std_m", &R::range_std_m, between(1e-3, 1e5), "m",
              "Standard deviation of the range of a plot."),
        field("bearing_std_rad", &R::bearing_std_rad, kAngleStd, "rad",
              "Standard deviation of the bearing of a plot."),
        field("extent_std_m", &R::extent_std_m, between(0, 1e4), "m",
              "Standard deviation of an echo's position on the hull, per axis."),
        field("period_s", &R::period_s, between(0.01, 3600), "s", "Antenna revolution."),
        field(
            "max_speed_mps", &R::max_speed_mps, between(0.1, 1e4), "m/s",
            "Speed limit of the vessels: no faster track starts, and a confirmed one is lost above "
            "it by three standard deviations of its speed."),
        field("bearing_offset_rad", &R::bearing_offset_rad, kFinite, "rad",
              "Measured minus true bearing; subtracted from every plot."),
        field("range_offset_m", &R::range_offset_m, between(-1e5, 1e5), "m",
              "Measured minus true range; subtracted from every plot."),
        field("time_offset_s", &R::time_offset_s, between(-3600, 3600), "s",
              "Clock of the radar minus true time; subtracted from the times of scans and plots."),
        field("min_range_m", &R::min_range_m, between(0, 1e6), "m",
              "Range from which the radar sees targets; a track nearer than that has no misses."),
        field(
            "max_range_m", &R::max_range_m, between(0, 1e6), "m",
            "Range up to which the radar sees targets, as a track beyond it has no misses; 0: the "
            "radar sees any."),
        field(
            "blind_from_rad", &R::blind_from_rad, kFinite, "rad",
            "From this bearing clockwise to `blind_to_rad`, as the radar measures it, targets are "
            "hidden by a mast or by land, and a track there has no misses."),
        field("blind_to_rad", &R::blind_to_rad, kFinite, "rad",
              "End of the blind sector; equal to `blind_from_rad`: there is none."),
        field("correlation_time_s", &R::correlation_time_s, between(0, 3600), "s",
              "Time constant by which the errors of a target's plots are correlated, as an echo "
              "wanders along a hull: plots that follow each other faster count as one; 0: the "
              "errors are independent."));
  }

  /// How many plots of a target count as one, each so long after the one before: the variance of
  /// the mean of n readings with the correlation ρ = exp(-dt / τ) of neighbors is, over that of
  /// independent ones,
  ///
  ///     (1 + ρ) / (1 - ρ)
  ///
  /// for large n. Source: Box, Jenkins, Time Series Analysis, 2.1.5 with ρₖ = ρᵏ.
  [[nodiscard]] double plots_as_one(double dt_s) const noexcept {
    if (correlation_time_s == 0.0) return 1.0;
    constexpr double kLeast = 1e-3;
    const double correlation = std::exp(-std::max(dt_s / correlation_time_s, kLeast));
    return (1.0 + correlation) / (1.0 - correlation);
  }

  /// A plot seen from own ship as a position with its covariance.
  [[nodiscard]] Gaussian<2> position(double range_m, double bearing_rad,
                                     const OwnShip& own) const noexcept {
    return PolarErrors{range_std_m, bearing_std_rad, extent_std_m, bearing_offset_rad, own}
        .position(range_m - range_offset_m, bearing_rad, true);
  }

  /// The same of a plot, with its own covariance where it has one.
  [[nodiscard]] Gaussian<2> position(const Plot& plot) const noexcept;

  /// Whether the radar sees targets at all ranges and bearings.
  [[nodiscard]] bool covers_all() const noexcept {
    return min_range_m == 0.0 && max_range_m == 0.0 && blind_from_rad == blind_to_rad;
  }

  /// Whether it sees targets at a range and bearing, as it measures them.
  [[nodiscard]] bool covers(double range_m, double bearing_rad) const noexcept {
    const bool in_range = range_m >= min_range_m && (max_range_m == 0.0 || range_m <= max_range_m);
    return in_range && !(compass_angle(bearing_rad - blind_from_rad) <
                         compass_angle(blind_to_rad - blind_from_rad));
  }

  /// The errors of a plot, to be taken where its target is predicted.
  [[nodiscard]] ConvertedErrors errors(const Plot& plot) const noexcept;

  /// A time by the radar's clock as true time.
  [[nodiscard]] double true_time_s(double time_s) const noexcept { return time_s - time_offset_s; }

  friend bool operator==(const Radar&, const Radar&) = default;

  void validate() const { validate_fields(*this); }

 private:
  [[nodiscard]] PolarErrors polar_errors(const Plot& plot) const noexcept;
};

/// One plot of a scan: when it was seen, where, and from where.
struct Plot {
  double time_s = 0.0;
  double range_m = 0.0;
  double bearing_rad = 0.0;
  OwnShip own = {};
  /// Of range_m and bearing_rad, in place of the radar's errors of both, to which the extent of the
  /// echo and the errors of own ship add; zero: the radar's.
  Mat<double, 2, 2> covariance = Mat<double, 2, 2>::Zero();
};

/// An echo of radar video as a plot that carries its own covariance.
inline Plot plot_of(const VideoPlot& echo, const OwnShip& own = {}) noexcept {
  return {echo.time_s, echo.range_m, echo.bearing_rad, own, echo.covariance};
}

inline PolarErrors Radar::polar_errors(const Plot& plot) const noexcept {
  const Mat<double, 2, 2>& r = plot.covariance;
  if (r.isZero(0.0))
    return {range_std_m, bearing_std_rad, extent_std_m, bearing_offset_rad, plot.own};
  return {std::sqrt(r(0, 0)), std::sqrt(r(1, 1)), extent_std_m, bearing_offset_rad, plot.own};
}

inline Gaussian<2> Radar::position(const Plot& plot) const noexcept {
  const double range_m = plot.range_m - range_offset_m;
  Gaussian<2> fix = polar_errors(plot).position(range_m, plot.bearing_rad, true);
  const Mat<double, 2, 2>& r = plot.covariance;
  if (r.isZero(0.0)) return fix;
  const Vec<double, 2> u = towards(plot.bearing_rad - bearing_offset_rad);
  const Vec<double, 2> across(-u[1], u[0]);
  const double common_m2 = range_m * (r(0, 1) + r(1, 0)) / 2;
  fix.covariance += common_m2 * (u * across.transpose() + across * u.transpose());
  return fix;
}

inline ConvertedErrors Radar::errors(const Plot& plot) const noexcept {
  ConvertedErrors errors = polar_errors(plot).converted();
  errors.range_bearing_m = (plot.covariance(0, 1) + plot.covariance(1, 0)) / 2;
  return errors;
}

}  // namespace wakeline
