// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/track/scan_plots.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// Moves plots along with a track, each from its own time to the track's.
///
/// A plot dt before the track moves by dt times the velocity, and gets less certain by dt² times
/// the covariance of the velocity. Over more than a period of the antenna a target may also have
/// maneuvered, which adds `maneuver_m2s3` |dt|³ per axis.
class TimeAlignment {
 public:
  TimeAlignment(const Track& track, double period_s, double maneuver_m2s3) noexcept
      : time_s_(track.time_s),
        position_(position_in(track.kinematics)),
        velocity_(track.velocity()),
        velocity_covariance_(track.velocity_covariance()),
        period_s_(period_s),
        maneuver_m2s3_(maneuver_m2s3) {}

  /// The position of a plot as read, at the track's time.
  [[nodiscard]] Vec<double, 2> moved(const ScanPlot& plot) const noexcept {
    return plot.position.mean + (time_s_ - plot.time_s) * velocity_;
  }

  /// A plot beside the prediction of the track, at the track's time.
  [[nodiscard]] Gaussian<2> at_prediction(const ScanPlot& plot) const noexcept {
    const Vec<double, 2> way_m = (time_s_ - plot.time_s) * velocity_;
    Gaussian<2> beside =
        plot.errors.in_sight(plot.position, {position_.mean - way_m, position_.covariance});
    beside.mean += way_m;
    return beside;
  }

  /// The covariance that the move of that plot adds to its own.
  [[nodiscard]] Mat<double, 2, 2> added_m2(const ScanPlot& plot) const noexcept {
    return added_m2(time_s_ - plot.time_s);
  }
  /// The same over a time step.
  [[nodiscard]] Mat<double, 2, 2> added_m2(double dt_s) const noexcept {
    const double late_s = std::abs(dt_s) > period_s_ ? std::abs(dt_s) : 0.0;
    const double maneuver_m2 = late_s * late_s * late_s * maneuver_m2s3_;
    return dt_s * dt_s * velocity_covariance_ + maneuver_m2 * Mat<double, 2, 2>::Identity();
  }

  /// No plot that is at most this far apart in time moves farther, north or east.
  [[nodiscard]] double longest_way_m(double apart_s) const noexcept {
    return apart_s * velocity_.cwiseAbs().maxCoeff();
  }

 private:
  double time_s_;
  Gaussian<2> position_;
  Vec<double, 2> velocity_;
  Mat<double, 2, 2> velocity_covariance_;
  double period_s_;
  double maneuver_m2s3_;
};

/// The time to which a track is predicted: that of the plot nearest to where it will be, with an
/// antenna that rotates and so gives each plot its own time; without one near, that of the scan.
inline double expected_time_s(const Track& track, const ScanPlots& plots,
                              double max_speed_mps) noexcept {
  const double scan_s = plots.scan_s();
  if (plots.greatest_lag_s(scan_s) == 0.0) return scan_s;
  const double ahead_s = std::max(scan_s - track.time_s, 0.0);
  const Vec<double, 2> expected = track.position() + ahead_s * track.velocity();
  const double own_m = 3.0 * track.position_std_m() + max_speed_mps * ahead_s;
  const auto reach_m = [&](double plot_m2) { return own_m + 3.0 * std::sqrt(plot_m2); };
  double least = std::numeric_limits<double>::infinity();
  double time_s = scan_s;
  plots.for_each_near(expected, reach_m, [&](int index) {
    const ScanPlot& plot = plots[index];
    const double distance = (plot.position.mean - expected).squaredNorm();
    if (distance < least) {
      least = distance;
      time_s = plot.time_s;
    }
  });
  return time_s;
}

}  // namespace wakeline
