// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/archive.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/track/radar.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// A part of the antenna's turn: what a radar has seen while its beam went clockwise from one angle
/// to another.
struct Sector {
  int radar = 0;  ///< its index
  double from_rad = 0.0;
  double to_rad = 0.0;  ///< one turn after `from_rad`: a whole turn
  double time_s = 0.0;  ///< at the end
  std::span<const Plot> plots = {};
  std::optional<OwnShip> own = {};  ///< at the end; without, that of the last plot, moved on
};

/// An interval of the beam's angle.
struct BeamArc {
  double from_rad;
  double centre_rad;
  double to_rad;
};

/// How far plots come behind the sectors that they are given with: an extractor that takes longer
/// than a sector gives them with the next one or two.
class PlotLag {
 public:
  /// The sector that the beam has passed where plots are so late: from which angle, and its width.
  [[nodiscard]] std::pair<double, double> passed(double from_rad, double width_rad) noexcept {
    const double before_rad = std::exchange(lag_rad_, share_ > kMany ? farthest_rad_ : 0.0);
    const double less_rad = std::max(before_rad - lag_rad_, 0.0);
    return {from_rad - lag_rad_ - less_rad, width_rad + less_rad};
  }

  /// Learns from a plot so far behind a sector of that width.
  void learn(double behind_rad, double width_rad) noexcept {
    constexpr double kMemory = 0.95, kMostWidths = 2.0;
    const bool is_behind = behind_rad > 0.0 && behind_rad <= kMostWidths * width_rad;
    share_ = kMemory * share_ + (is_behind ? 1.0 - kMemory : 0.0);
    farthest_rad_ = share_ < kFew ? 0.0
                    : is_behind   ? std::max(farthest_rad_, behind_rad)
                                  : farthest_rad_;
  }

  void archive(Archive& fields) {
    fields(share_);
    fields(farthest_rad_);
    fields(lag_rad_);
  }

 private:
  /// Few plots are outside of their sectors by their errors.
  static constexpr double kFew = 0.1, kMany = 1.0 / 3;

  double share_ = 0.0;         ///< of the last twenty plots or so that are behind their sectors
  double farthest_rad_ = 0.0;  ///< of these
  double lag_rad_ = 0.0;       ///< of the last sector
};

/// Where the beam of an antenna is, and since which angle it has swept without a gap. Angles are
/// unwrapped: they grow by a turn with each turn, and north is no seam.
class Beam {
 public:
  static constexpr double kTurn = 2 * kPi<double>;

  /// Width of a sector; NaN where it is not from nothing to a turn.
  [[nodiscard]] static double width_rad(double from_rad, double to_rad) noexcept {
    if (!in_range(from_rad) || !in_range(to_rad)) return std::numeric_limits<double>::quiet_NaN();
    const double ahead_rad = to_rad - from_rad;
    const double width_rad = ahead_rad < 0.0 ? ahead_rad + kTurn : ahead_rad;  // past north
    return width_rad >= 0.0 && width_rad <= kTurn + kSame_rad
               ? width_rad
               : std::numeric_limits<double>::quiet_NaN();
  }

  /// Whether a sector of that width is a whole turn.
  [[nodiscard]] static bool is_turn(double width_rad) noexcept {
    return width_rad >= kTurn - kSame_rad;
  }

  /// Passes a whole turn.
  void turn() noexcept {
    angle_rad_ += kTurn;
    swept_from_rad_ = angle_rad_ - kTurn;
  }

  /// Passes a sector `dt_s` after the one before; one of no width only lets time pass. A gap in
  /// front of it that a vessel could be in is not swept; where sectors overlap the beam does not go
  /// back. After a silence as many turns are missed as it took: returns the angle of the whole
  /// ones.
  double sweep(double from_rad, double width_rad, double dt_s, double period_s) noexcept {
    if (width_rad == 0.0) return 0.0;
    if (!running_) {
      running_ = true;
      swept_from_rad_ = angle_rad_ + compass_angle(from_rad - angle_rad_);
      angle_rad_ = turned_from_rad_ = swept_from_rad_ + width_rad;
      return 0.0;
    }
    double ahead_rad = wrap_angle(from_rad - angle_rad_);
    if (std::abs(ahead_rad) > kSame_rad || dt_s > 2.0 * period_s) {
      const double turns = std::round((kTurn * dt_s / period_s - width_rad - ahead_rad) / kTurn);
      ahead_rad += kTurn * std::max(turns, 0.0);
    }
    const double missed_rad = kTurn * std::max(std::floor((ahead_rad + kSame_rad) / kTurn), 0.0);
    const double begin_rad = angle_rad_ + ahead_rad;
    behind_rad_ = begin_rad + width_rad > angle_rad_ + kSame_rad ? 0.0 : behind_rad_ + width_rad;
    if (missed_rad > 0.0) resumed_rad_ = begin_rad;
    if (ahead_rad > kSeam_rad) swept_from_rad_ = begin_rad;
    angle_rad_ = std::max(angle_rad_, begin_rad + width_rad);
    measure_turn(dt_s, missed_rad > 0.0);
    return missed_rad;
  }

  /// How long a turn takes by its sectors: the shorter of the last two, since data may be missing;
  /// 0 before the first.
  [[nodiscard]] double turn_s() const noexcept { return std::min(last_turn_s_, turn_before_s_); }

  /// Whether a sector goes against the turn of the antenna: it is behind the beam, as those of the
  /// last quarter of a turn were.
  [[nodiscard]] bool goes_back(double from_rad, double width_rad) const noexcept {
    return width_rad > 0.0 && behind_rad_ >= kTurn / 4 &&
           wrap_angle(from_rad - angle_rad_) + width_rad <= kSame_rad;
  }

  [[nodiscard]] double angle_rad() const noexcept { return angle_rad_; }

  /// Whether the beam has not yet passed all gates since it missed whole turns.
  [[nodiscard]] bool resumes() const noexcept {
    constexpr double kTurns = 1.25;
    return angle_rad_ < resumed_rad_ + kTurns * kTurn;
  }

  /// A bearing as an angle of the beam, the one nearest to `near_rad`.
  [[nodiscard]] static double unwrapped(double bearing_rad, double near_rad) noexcept {
    return near_rad + wrap_angle(bearing_rad - near_rad);
  }

  /// The last angle at which the beam had a bearing.
  [[nodiscard]] double last_rad(double bearing_rad) const noexcept {
    return angle_rad_ - compass_angle(angle_rad_ - bearing_rad);
  }

  /// Whether all of an arc has been swept, without a gap.
  [[nodiscard]] bool has_swept(const BeamArc& arc) const noexcept {
    return arc.from_rad >= swept_from_rad_ && arc.to_rad <= angle_rad_;
  }

  void archive(Archive& fields) {
    fields(running_);
    fields(angle_rad_);
    fields(swept_from_rad_);
    fields(resumed_rad_);
    fields(behind_rad_);
    fields(turned_from_rad_);
    fields(turning_s_);
    fields(last_turn_s_);
    fields(turn_before_s_);
  }

 private:
  void measure_turn(double dt_s, bool missed) noexcept {
    turning_s_ += dt_s;
    const double turned_rad = angle_rad_ - turned_from_rad_;
    if (!missed && turned_rad < kTurn) return;
    if (!missed) turn_before_s_ = std::exchange(last_turn_s_, turning_s_ * kTurn / turned_rad);
    turned_from_rad_ = angle_rad_;
    turning_s_ = 0.0;
  }

  static constexpr double kSame_rad = 1e-6;  ///< no antenna knows its angle better
  /// Between the last sweep of a sector and the first of the next, or rounded: less than a beam.
  static constexpr double kSeam_rad = 0.01;

  bool running_ = false;
  double angle_rad_ = 0.0;
  double swept_from_rad_ = 0.0;
  double resumed_rad_ = -std::numeric_limits<double>::infinity();  ///< after turns that it missed
  double behind_rad_ = 0.0;       ///< width of the last sectors, of which none was ahead
  double turned_from_rad_ = 0.0;  ///< where the turn begins that is being measured
  double turning_s_ = 0.0;        ///< since then
  double last_turn_s_ = 0.0;
  double turn_before_s_ = std::numeric_limits<double>::infinity();
};

/// Where the beam of a radar meets the gate of a track, by its angles, unwrapped.
struct Meeting {
  double passed_rad = 0.0;  ///< when it last passed the target
  double look_rad = 0.0;    ///< before that angle it does not reach the gate

  /// Up to which angle the gate that it last passed may have reached.
  [[nodiscard]] double end_rad() const noexcept {
    return 2.0 * passed_rad + Beam::kTurn - look_rad;
  }

  /// The beam has missed turns of that angle.
  void miss_turns(double missed_rad) noexcept {
    passed_rad += missed_rad;
    look_rad += missed_rad;
  }
};

/// Arc tangent of a positive slope. Of a gentle one it is the slope, which takes less time and is
/// more by a hundredth at most.
inline double angle_of(double slope) noexcept {
  constexpr double kGentle = 0.17;
  return slope < kGentle ? slope : std::atan(slope);
}

/// A gate about a predicted position as seen from own ship: the angles at which plots of the target
/// may come in the turn after the beam passed `passed_rad`.
class GateSight {
 public:
  GateSight(const Gaussian<2>& predicted, double passed_rad, double threshold, const Radar& radar,
            const OwnShip& own) noexcept
      : predicted_m2_(predicted.covariance),
        threshold_(threshold),
        errors_{radar.range_std_m, radar.bearing_std_rad, radar.extent_std_m, 0.0, own} {
    const Vec<double, 2> d = predicted.mean - own.position<double>();
    range_m_ = d.norm();
    centre_rad_ = Beam::unwrapped(std::atan2(d[1], d[0]) + radar.bearing_offset_rad,
                                  passed_rad + Beam::kTurn);
    if (range_m_ > 0.0) along_ = d / range_m_;
  }

  /// The arc where the covariance of plots is larger by `plot_factor` than that of usual ones. A
  /// gate that reaches the antenna has the whole turn about its centre.
  [[nodiscard]] BeamArc arc(double plot_factor) const noexcept {
    const double isotropic_m2 = errors_.isotropic_variance_m2();
    const auto half_m = [&](const Vec<double, 2>& u, double plot_m2) {
      const double track_m2 = predicted_m2_(0, 0) * u[0] * u[0] +
                              2.0 * predicted_m2_(0, 1) * u[0] * u[1] +
                              predicted_m2_(1, 1) * u[1] * u[1];
      return std::sqrt(threshold_ * (track_m2 + plot_factor * (plot_m2 + isotropic_m2)));
    };
    const double along_m = half_m(along_, errors_.range_variance_m2());
    const double across_m =
        half_m({-along_[1], along_[0]}, range_m_ * range_m_ * errors_.bearing_variance_rad2());
    const double half_rad =
        along_m < range_m_ ? angle_of(across_m / (range_m_ - along_m)) : kPi<double>;
    return {centre_rad_ - half_rad, centre_rad_, centre_rad_ + half_rad};
  }

 private:
  Mat<double, 2, 2> predicted_m2_;
  double threshold_;
  PolarErrors errors_;
  double range_m_;
  double centre_rad_;
  Vec<double, 2> along_{1.0, 0.0};
};

}  // namespace wakeline
