// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/cholesky.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// Of two tracks on one target, whether `a` is the one to stay: confirmed before tentative, older
/// before younger, likelier before less likely.
template <class Estimator>
bool senior(const Track<Estimator>& a, const Track<Estimator>& b) noexcept {
  if (a.confirmed() != b.confirmed()) return a.confirmed();
  if ((a.id > 0) != (b.id > 0)) return a.id > 0;
  if (a.id > 0) return a.id < b.id;
  return a.existence > b.existence || (a.existence == b.existence && a.id > b.id);
}

/// Whether two beliefs over `[x, vx, y, vy]` are of one target: the squared distance of their
/// positions and that of their velocities, in standard deviations of the difference, sum to less
/// than the limit.
inline bool same_target(const Gaussian<4>& a, const Gaussian<4>& b, double limit) noexcept {
  const Vec<double, 4> d = a.mean - b.mean;
  for (const int k : {0, 2})
    if (d[k] * d[k] > limit * (a.covariance(k, k) + b.covariance(k, k))) return false;
  double sum = 0.0;
  for (const int k : {0, 1}) {
    Mat<double, 2, 2> s;
    for (const int i : {0, 1})
      for (const int j : {0, 1})
        s(i, j) = a.covariance(k + 2 * i, k + 2 * j) + b.covariance(k + 2 * i, k + 2 * j);
    const Cholesky<2> factor(s);
    if (!factor.ok()) return false;
    sum += factor.squared_norm(Vec<double, 2>(d[k], d[k + 2]));
  }
  return sum < limit;
}

/// Whether another track may be of the same vessel as a known one that is shown, by another of her
/// echoes: nearer to it than her length, m, at a velocity whose squared distance, in standard
/// deviations of the difference, is at most the limit. That of a tentative track is of two plots,
/// each of which may be another echo, and tells nothing.
template <class Estimator>
bool same_vessel(const Track<Estimator>& known, const Track<Estimator>& other, double length_m,
                 double limit) noexcept {
  if (!known.shown()) return false;
  if (!((known.position() - other.position()).squaredNorm() < length_m * length_m)) return false;
  if (!other.confirmed()) return true;
  const Cholesky<2> factor(known.velocity_covariance() + other.velocity_covariance());
  return factor.ok() && factor.squared_norm(known.velocity() - other.velocity()) <= limit;
}

}  // namespace wakeline
