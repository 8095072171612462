// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/filter/start.hpp"

namespace wakeline {

/// A belief over `[x, vx, y, vy]` updated with the prior that the velocity is N(0, std² I): the
/// speed limit in a start from two plots. In Joseph form, as the velocity of two plots of nearly
/// one time is far wider than the limit.
inline Gaussian<4> with_speed_prior(const Gaussian<4>& belief, double speed_std_mps) noexcept {
  Mat<double, 2, 4> velocity_rows;
  velocity_rows << belief.covariance.row(1), belief.covariance.row(3);
  const double variance = speed_std_mps * speed_std_mps;
  Mat<double, 2, 2> s;
  s << velocity_rows.col(1), velocity_rows.col(3);
  s.diagonal().array() += variance;
  const Cholesky<2> factor(s);
  if (!factor.ok()) return belief;
  const Mat<double, 4, 2> gain = factor.solve<4>(velocity_rows).transpose();
  Mat<double, 4, 4> rest = Mat<double, 4, 4>::Identity();
  rest.col(1) -= gain.col(0);
  rest.col(3) -= gain.col(1);
  Gaussian<4> slower{rest * belief.mean, rest * belief.covariance * rest.transpose() +
                                             variance * gain * gain.transpose()};
  mirror_lower(slower.covariance);
  return slower;
}

/// Whether a target under a speed limit can have given both plots: their distance is at most what
/// it covers in dt, and `sigmas` standard deviations of the plots' difference along it.
inline bool within_speed_limit(const Gaussian<2>& first, const Gaussian<2>& second, double dt_s,
                               double max_speed_mps, double sigmas) noexcept {
  const Vec<double, 2> d = second.mean - first.mean;
  const double distance = d.norm();
  if (distance <= max_speed_mps * dt_s) return true;
  const Vec<double, 2> along = d / distance;
  const double variance = along.dot((first.covariance + second.covariance) * along);
  return distance <= max_speed_mps * dt_s + sigmas * std::sqrt(variance);
}

}  // namespace wakeline
