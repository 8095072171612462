// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/core/cholesky.hpp"
#include "wakeline/filter/start.hpp"

namespace wakeline {

/// A belief over `[x, vx, y, vy]` after learning that the velocity is drawn from N(0, std² I): what
/// a speed limit says of a start from two plots.
inline Gaussian<4> with_speed_prior(const Gaussian<4>& belief, double speed_std_mps) noexcept {
  Mat<double, 2, 4> velocity_rows;
  velocity_rows << belief.covariance.row(1), belief.covariance.row(3);
  Mat<double, 2, 2> s;
  s << velocity_rows.col(1), velocity_rows.col(3);
  s.diagonal().array() += speed_std_mps * speed_std_mps;
  const Cholesky<2> factor(s);
  if (!factor.ok()) return belief;
  const Mat<double, 2, 4> gain = factor.whiten<4>(velocity_rows);
  const Vec<double, 2> excess = factor.whiten<1>(Vec<double, 2>(-belief.mean[1], -belief.mean[3]));
  return {belief.mean + gain.transpose() * excess, belief.covariance - gain.transpose() * gain};
}

/// Whether a target under a speed limit can have given both plots: their distance is at most what
/// it covers in dt, and `sigmas` standard deviations of the plots' difference along it.
inline bool within_speed_limit(const Gaussian<2>& first, const Gaussian<2>& second, double dt_s,
                               double max_speed_mps, double sigmas) noexcept {
  const Vec<double, 2> d = second.mean - first.mean;
  const double distance = d.norm();
  const Vec<double, 2> along = distance > 0.0 ? Vec<double, 2>(d / distance) : Vec<double, 2>(1, 0);
  const double variance = along.dot((first.covariance + second.covariance) * along);
  return distance <= max_speed_mps * dt_s + sigmas * std::sqrt(variance);
}

}  // namespace wakeline
