// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "wakeline/core/archive.hpp"
#include "wakeline/measurement/polar.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// The share of a radar's errors that stays from scan to scan, learned from the innovations of its
/// confirmed tracks.
///
/// A filter averages errors that are independent from scan to scan. Those that stay, as an echo
/// wanders along the hull or a bearing is off, are in its estimate, and its covariance does not
/// know of them. Two signs of them are learned: innovations that are smaller than the errors of the
/// radar, which must then be elsewhere, and innovations that are larger, by which the errors are
/// larger than stated. Smaller ones are a sign only as far as each is like the one before: those of
/// a radar that is better than stated are independent. With the normalized innovation squared (NIS)
/// of a plot, χ² of two degrees of freedom where all is as stated, and the product u·u' of whitened
/// innovations that follow each other:
///
///     w = 1 / E[exp(-NIS/2)] - 1           1, and the scale of what is not an outlier
///     m = E[min(NIS, 18)] / 2              1, and the scale of all
///     r = E[u·u'] / E[min(NIS, 18)]        0, and about 1 - w of errors that stay
///     share = (1/w - 1), at most 2.5, if w < 0.9 - 2.3 / sqrt(n) and r > 0.4 (1 - w),
///             plus (m - 1) if m > 1.05 + 2.3 / sqrt(n)
///
/// over the last n looks, about 500 at most. The first counts what does not show against what
/// does, as errors that wander slowly show in part. Beyond these bounds, which chance seldom
/// passes, each sets in over a tenth, with r over a twentieth.
class PersistentErrors {
 public:
  /// Takes the NIS of a plot of a track, and the product of its innovation and the one before.
  void learn(double nis, double product) noexcept {
    usual_ = kMemory * usual_ + std::exp(-0.5 * nis);
    products_ = kMemory * products_ + std::clamp(product, -kMostNis, kMostNis);
    all_ = kMemory * all_ + 0.5 * std::min(nis, kMostNis);
    looks_ = kMemory * looks_ + 1.0;
  }

  /// The part of the covariance of an innovation.
  [[nodiscard]] double share() const noexcept {
    constexpr double kMostHidden = 2.5, kMostShare = 9.0;
    const double chance = 2.3 / std::sqrt(looks_);
    const double usual = looks_ / usual_ - 1.0, all = all_ / looks_;
    const double alike = products_ / (2.0 * all_) - 0.4 * (1.0 - usual);
    const double fewer = std::min(1.0 / usual - 1.0, kMostHidden) * beyond(0.9 - chance - usual) *
                         beyond(2.0 * alike);
    const double more = (all - 1.0) * beyond(all - 1.05 - chance);
    return std::min(fewer + more, kMostShare);
  }

  void archive(Archive& fields) {
    fields(usual_);
    fields(products_);
    fields(all_);
    fields(looks_);
  }

 private:
  static double beyond(double excess) noexcept { return std::clamp(10.0 * excess, 0.0, 1.0); }

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

/// The belief of a track as it is reported. The estimator does without all three:
///
/// - Noise and outliers are allowances. Where a plot has a small weight `gain`, the target has held
///   its course for as long as the filter remembers, and neither came: the position errs by two
///   thirds of its variance (three quarters without maneuvers, the small-gain limit of an
///   alpha-beta filter, and a tenth less without outliers). The rest is left out as far as plots
///   older than eight scans count, (1 - gain)⁸, and the first of its `hits` plots no longer do: a
///   line through n plots has the gain 4/n with neither noise nor outliers. Of a belief ahead of
///   the track, whose own position has the variance `estimate_m2`, what the way adds stays.
/// - An alteration that does not show yet: of the course by `kUnseenCourse_rad`, of the speed by
///   `kUnseenSpeed` of it.
/// - The errors of the position that stay from scan to scan.
inline Gaussian<4> reported(Gaussian<4> kinematics, double estimate_m2, double gain, int hits,
                            const Mat<double, 2, 2>& stays_m2) noexcept {
  constexpr double kUnseenCourse_rad = 0.06, kUnseenSpeed = 0.02;
  const double of_a_line = std::min(4.0 / (hits * gain), 1.0);
  const double held = std::pow(std::max(1.0 - gain, 0.0), 8) * (1.0 - std::pow(of_a_line, 8));
  const double now_m2 = (kinematics.covariance(0, 0) + kinematics.covariance(2, 2)) / 2;
  const double errs = std::sqrt(1.0 - held / 3.0 * std::min(estimate_m2 / now_m2, 1.0));
  const Vec<double, 4> scale(errs, 1.0, errs, 1.0);
  kinematics.covariance = scale.asDiagonal() * kinematics.covariance * scale.asDiagonal();
  const Vec<double, 2> velocity_mps(kinematics.mean[1], kinematics.mean[3]);
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
