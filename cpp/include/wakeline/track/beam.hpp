// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

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

  /// Passes a sector `dt_s` after the one before. A gap in front of it is not swept; where sectors
  /// overlap the beam does not go back. After a silence as many turns are missed as it took.
  void sweep(double from_rad, double width_rad, double dt_s, double period_s) noexcept {
    if (!running_) {
      running_ = true;
      swept_from_rad_ = angle_rad_ + compass_angle(from_rad - angle_rad_);
      angle_rad_ = swept_from_rad_ + width_rad;
      return;
    }
    double ahead_rad = wrap_angle(from_rad - angle_rad_);
    if (std::abs(ahead_rad) > kSame_rad || dt_s > 2.0 * period_s) {
      const double turns = std::round((kTurn * dt_s / period_s - width_rad - ahead_rad) / kTurn);
      ahead_rad += kTurn * std::max(turns, 0.0);
    }
    if (ahead_rad > kSame_rad) swept_from_rad_ = angle_rad_ + ahead_rad;
    angle_rad_ = std::max(angle_rad_, angle_rad_ + ahead_rad + width_rad);
  }

  [[nodiscard]] double angle_rad() const noexcept { return angle_rad_; }

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
  }

 private:
  static constexpr double kSame_rad = 1e-6;  ///< no antenna knows its angle better

  bool running_ = false;
  double angle_rad_ = 0.0;
  double swept_from_rad_ = 0.0;
};

/// The angles at which plots of a target may come, as seen from own ship: those of the gate about
/// its predicted position, where the covariance of plots is larger by `plot_factor` than that of
/// usual ones, in the turn after `passed_rad`.
///
/// A gate that reaches the antenna has the whole turn about its centre.
inline BeamArc gate_arc(const Track& track, double passed_rad, double time_s, double threshold,
                        double plot_factor, const Radar& radar, const OwnShip& own) noexcept {
  const double dt_s = time_s - track.time_s;
  const Vec<double, 2> d = track.position() + dt_s * track.velocity() - own.position<double>();
  const double range_m = d.norm();
  const double near_rad = passed_rad + Beam::kTurn;
  const double centre_rad =
      Beam::unwrapped(std::atan2(d[1], d[0]) + radar.bearing_offset_rad, near_rad);
  const Gaussian<4> now = at_constant_velocity(track.kinematics, dt_s);
  const PolarErrors errors{radar.range_std_m, radar.bearing_std_rad, radar.extent_std_m, 0.0, own};
  const double isotropic_m2 = errors.isotropic_variance_m2();
  const auto half_m = [&](const Vec<double, 2>& u, double plot_m2) {
    const double track_m2 = now.covariance(0, 0) * u[0] * u[0] +
                            2.0 * now.covariance(0, 2) * u[0] * u[1] +
                            now.covariance(2, 2) * u[1] * u[1];
    return std::sqrt(threshold * (track_m2 + plot_factor * (plot_m2 + isotropic_m2)));
  };
  const Vec<double, 2> u = range_m > 0.0 ? Vec<double, 2>(d / range_m) : Vec<double, 2>(1.0, 0.0);
  const double along_m = half_m(u, errors.range_variance_m2());
  const double across_m = half_m({-u[1], u[0]}, range_m * range_m * errors.bearing_variance_rad2());
  const double half_rad = along_m < range_m ? std::atan2(across_m, range_m - along_m) : kPi<double>;
  return {centre_rad - half_rad, centre_rad, centre_rad + half_rad};
}

}  // namespace wakeline
