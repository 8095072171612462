// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "wakeline/core/cholesky.hpp"

namespace wakeline {

/// A plot in the gate of a track.
struct Claim {
  int echo;
  Vec<double, 2> z;            ///< brought to the track's time
  Mat<double, 2, 2> moved_m2;  ///< covariance that this adds to the plot's own
  double likelihood = 0.0;     ///< under all modes, nominal and wild
  double density = 0.0;        ///< of false plots about it, but for the track's own
  double odds = 0.0;           ///< that it is this track's
  double nis = 0.0;            ///< under the moment-matched prediction
};

/// The likeliest plots of one track, best first.
class Claims {
 public:
  static constexpr int kMost = 8;  ///< most plots that one track looks at

  void clear() noexcept {
    count_ = 0;
    certain_ = false;
  }

  /// Whether a claim of that likelihood is among the likeliest.
  [[nodiscard]] bool takes(double likelihood) const noexcept {
    return count_ < kMost || likelihood > claims_.back().likelihood;
  }

  /// Takes a claim in if it is among the likeliest.
  void add(const Claim& claim) noexcept {
    if (!takes(claim.likelihood)) return;
    auto place = std::min(static_cast<std::size_t>(count_), claims_.size() - 1);
    for (; place > 0 && claim.likelihood > claims_[place - 1].likelihood; --place)
      claims_[place] = claims_[place - 1];
    claims_[place] = claim;
    count_ = std::min(count_ + 1, kMost);
  }

  /// Leaves the claim to that plot, now certain, or none.
  void keep_only(int echo) noexcept {
    const Claim* kept =
        std::find_if(begin(), end(), [&](const Claim& claim) { return claim.echo == echo; });
    certain_ = kept != end();
    if (certain_) claims_[0] = *kept;
    count_ = certain_ ? 1 : 0;
  }

  /// True when the plot left was assigned, so that the track cannot have none.
  [[nodiscard]] bool certain() const noexcept { return certain_; }
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] Claim* begin() noexcept { return claims_.data(); }
  [[nodiscard]] Claim* end() noexcept { return claims_.data() + count_; }
  [[nodiscard]] const Claim* begin() const noexcept { return claims_.data(); }
  [[nodiscard]] const Claim* end() const noexcept { return claims_.data() + count_; }

 private:
  std::array<Claim, kMost> claims_;
  int count_ = 0;
  bool certain_ = false;
};

/// d² of a plot with covariance `r` (m²) from the position in a belief over `[x, vx, y, vy]`.
inline double squared_distance(const Gaussian<4>& kinematics, const Vec<double, 2>& z,
                               const Mat<double, 2, 2>& r) noexcept {
  Mat<double, 2, 2> s;
  s << kinematics.covariance(0, 0), kinematics.covariance(0, 2), kinematics.covariance(2, 0),
      kinematics.covariance(2, 2);
  s += r;
  const Cholesky<2> factor(s);
  const Vec<double, 2> d(z[0] - kinematics.mean[0], z[1] - kinematics.mean[2]);
  return factor.ok() ? factor.squared_norm(d) : std::numeric_limits<double>::infinity();
}

}  // namespace wakeline
