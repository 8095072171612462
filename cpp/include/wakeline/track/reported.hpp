// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "wakeline/core/archive.hpp"
#include "wakeline/measurement/polar.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// What the innovations of its confirmed tracks show of a radar's errors, for what is reported.
///
/// The covariance of a filter is that of stated errors, independent from scan to scan. If they are
/// larger or smaller, or have more outliers, so is it. Errors that stay, as an echo wanders along
/// the hull or a bearing is off, are not averaged, and stay in the estimate in full. They make each
/// innovation like the one before; independent errors and outliers do not. With the normalized
/// innovation squared (NIS) of a plot, χ² of two degrees of freedom where all is as stated, and the
/// product u·u' of whitened innovations that follow each other:
///
///     w = 1 / E[exp(-NIS/2)] - 1           1, and the scale of what is not an outlier
///     m = E[min(NIS, 18)] / 2              1, and the scale of all
///     r = E[u·u'] / E[min(NIS, 18)]        0, and the part of m that stays, where r > c
///     stays = r m / 2, plus (1/w - 1), at most 2.5, if w < 0.9 - c and r > 0.4 (1 - w)
///     scale = 1 + (m (1 - r) - 1) (1 + 3/2 gain) if more than 1,
///             else w, at least 0.1, if w < 0.9 - c and r < 0
///
/// over the last n looks, about 500 at most; chance seldom passes c = 2.3 / sqrt(n). Beyond its
/// bound each sets in over a tenth, with r > 0.4 (1 - w) over a twentieth.
///
/// - Half of r m: the difference of two radars' offsets shows, their mean does not.
/// - (1/w - 1) is of innovations that are smaller than the errors, which do not show. It counts
///   what does not show against what does, as errors that wander slowly show in part.
/// - Where a plot has a large weight `gain`, innovations are also of alterations of the course.
class LearnedErrors {
 public:
  /// Takes the NIS of a plot of a track, and the product of its innovation and the one before.
  void learn(double nis, double product) noexcept {
    usual_ = kMemory * usual_ + std::exp(-0.5 * nis);
    products_ = kMemory * products_ + std::clamp(product, -kMostNis, kMostNis);
    all_ = kMemory * all_ + 0.5 * std::min(nis, kMostNis);
    looks_ = kMemory * looks_ + 1.0;
  }

  /// Errors that stay, as a part of the covariance of an innovation.
  [[nodiscard]] double stays() const noexcept {
    constexpr double kMostHidden = 2.5;
    const double hidden = beyond(2.0 * (alike() - 0.4 * (1.0 - usual()))) * fewer();
    return 0.5 * alike_shown() * all() + hidden * std::min(1.0 / usual() - 1.0, kMostHidden);
  }

  /// The factor on the covariance of an estimate, of which a plot has the weight `gain`.
  [[nodiscard]] double scale(double gain) const noexcept {
    const double more = all() * (1.0 - alike_shown()) - 1.0;
    if (more > 0.0) return 1.0 + more * (1.0 + 1.5 * std::min(gain, 1.0));
    constexpr double kLeast = 0.1;
    return std::max(1.0 - (1.0 - usual()) * fewer() * (1.0 - beyond(alike())), kLeast);
  }

  void archive(Archive& fields) {
    fields(usual_);
    fields(products_);
    fields(all_);
    fields(looks_);
  }

 private:
  static double beyond(double excess) noexcept { return std::clamp(10.0 * excess, 0.0, 1.0); }

  [[nodiscard]] double usual() const noexcept { return looks_ / usual_ - 1.0; }
  [[nodiscard]] double all() const noexcept { return all_ / looks_; }
  [[nodiscard]] double alike() const noexcept { return products_ / (2.0 * all_); }
  [[nodiscard]] double chance() const noexcept { return 2.3 / std::sqrt(looks_); }
  [[nodiscard]] double fewer() const noexcept { return beyond(0.9 - chance() - usual()); }
  [[nodiscard]] double alike_shown() const noexcept {
    return std::max(alike(), 0.0) * beyond(alike() - chance());
  }

  static constexpr double kPriorLooks = 8.0;
  static constexpr double kMemory = 0.998;
  static constexpr double kMostNis = 18.0;

  double usual_ = 0.5 * kPriorLooks;
  double products_ = 0.6 * kPriorLooks;
  double all_ = kPriorLooks;
  double looks_ = kPriorLooks;
};

/// What a belief over north and east leaves out where the direction is uncertain: a target to the
/// side of the line of sight is less far along it, by r δ²/2 with E[δ⁴] = 3 s⁴.
inline Mat<double, 2, 2> bent_m2(const Vec<double, 2>& from_antenna,
                                 const Mat<double, 2, 2>& covariance) noexcept {
  const double square = from_antenna.squaredNorm();
  if (!(square > covariance.trace())) return Mat<double, 2, 2>::Zero();
  const double s2 = direction_variance_rad2(from_antenna, covariance);
  return 0.75 * s2 * s2 * from_antenna * from_antenna.transpose();
}

/// Leaves out a part of the variance of the position along the course, as if the place along it had
/// been measured and found where it is.
inline void leave_out_along_course(double part, Gaussian<4>& kinematics) noexcept {
  const Vec<double, 4> along(kinematics.mean[1], 0.0, kinematics.mean[3], 0.0);
  const Vec<double, 4> of_all = kinematics.covariance * along;
  const double of_along = along.dot(of_all);
  if (of_along > 0.0) kinematics.covariance -= part / of_along * of_all * of_all.transpose();
}

/// The belief of a track as it is reported. The estimator does without all four:
///
/// - Noise and outliers are allowances. Where a plot has a small weight `gain`, the target has held
///   its course and speed for as long as the filter remembers, and neither came: the position errs
///   by two thirds of its variance (three quarters without maneuvers, the small-gain limit of an
///   alpha-beta filter, and a tenth less without outliers). The rest, `kAllowed`, is left out where
///   the course is not known. Where it is, it may be altered at any time, the speed of a vessel
///   seldom: `kKept` of what is along the course is left out, half of it at most, and all else has
///   the factor 1 + `kAlters`. All of this as far as plots older than eight scans count,
///   (1 - gain)⁸, and the first of its `hits` plots no longer do: a line through n plots has the
///   gain 4/n with neither noise nor outliers. Of a belief ahead of the track, whose own position
///   has the variance `estimate_m2`, what the way adds stays.
/// - The errors of the radar are not as stated: the same variance has the factor `scale`.
/// - An alteration that does not show yet: of the course by `kUnseenCourse_rad`, of the speed by
///   `kUnseenSpeed` of it.
/// - The errors of the position that stay from scan to scan.
inline Gaussian<4> reported(Gaussian<4> kinematics, double estimate_m2, double gain, int hits,
                            double scale, const Mat<double, 2, 2>& stays_m2) noexcept {
  constexpr double kAllowed = 1.0 / 3, kKept = 0.8, kMostKept = 0.5, kAlters = 0.1;
  constexpr double kUnseenCourse_rad = 0.06, kUnseenSpeed = 0.02;
  const double of_a_line = std::min(4.0 / (hits * gain), 1.0);
  const double held = std::pow(std::max(1.0 - gain, 0.0), 8) * (1.0 - std::pow(of_a_line, 8));
  const Vec<double, 2> velocity_mps(kinematics.mean[1], kinematics.mean[3]);
  const double square = velocity_mps.squaredNorm();
  const double known = square / (square + velocity_covariance(kinematics).trace());
  const double now_m2 = (kinematics.covariance(0, 0) + kinematics.covariance(2, 2)) / 2;
  const double of_estimate = std::min(estimate_m2 / now_m2, 1.0);
  const double allowed = 1.0 + held * (known * kAlters - (1.0 - known) * kAllowed);
  const double errs = std::sqrt(1.0 + (allowed * scale - 1.0) * of_estimate);
  const Vec<double, 4> factor(errs, 1.0, errs, 1.0);
  kinematics.covariance = factor.asDiagonal() * kinematics.covariance * factor.asDiagonal();
  leave_out_along_course(known * std::min(kKept * held, kMostKept) * of_estimate, kinematics);
  const Vec<double, 2> ahead_mps = kUnseenSpeed * velocity_mps;
  const Vec<double, 2> abeam_mps =
      kUnseenCourse_rad * Vec<double, 2>(-velocity_mps[1], velocity_mps[0]);
  const Mat<double, 2, 2> unseen_m2s2 =
      ahead_mps * ahead_mps.transpose() + abeam_mps * abeam_mps.transpose();
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      kinematics.covariance(2 * i, 2 * j) += stays_m2(i, j);
      kinematics.covariance(2 * i + 1, 2 * j + 1) += unseen_m2s2(i, j);
    }
  }
  return kinematics;
}

}  // namespace wakeline
