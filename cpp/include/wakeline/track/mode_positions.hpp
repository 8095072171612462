// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include "wakeline/core/state_belief.hpp"
#include "wakeline/filter/belief.hpp"
#include "wakeline/measurement/fix.hpp"
#include "wakeline/multimodel/mixture.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline {

/// An estimator of which `ModePositions` can be read.
template <class Estimator>
concept HasModePositions = requires(const Estimator& estimator) {
  estimator.mode_probability();
  estimator.for_each_mode([](int, const auto&) {});
}
|| requires(const Estimator& estimator) {
  { estimator.evidence(Fix{}, Vec<double, 2>{}) } -> std::same_as<Evidence<double>>;
};

/// How far predictions of a position are from another one, north or east.
struct GateSquare {
  double farthest_m;
  double variance_m2;  ///< the greatest along one of the axes

  /// How far a fix with at most that variance may be and still be within the gate of that threshold
  /// about one of them.
  [[nodiscard]] double reach_m(double fix_m2, double threshold) const noexcept {
    constexpr double kRounding = 1.0 + 1e-6;
    return kRounding * (farthest_m + std::sqrt(threshold * (variance_m2 + fix_m2)));
  }
};

/// Predictions of a position in one direction w, by which most fixes outside of their gate are
/// found at less expense: with S = P + R, |w·ν|² > γ wᵀ S w means that νᵀ S⁻¹ ν > γ.
struct GateStrip {
  Vec<double, 2> direction;  ///< w, of any length
  Vec<double, 2> position;
  double from;      ///< the least of w · (mean - position)
  double to;        ///< and the greatest
  double variance;  ///< the greatest wᵀ P w

  /// Whether a fix with covariance `r` is outside of the gate of that threshold about each.
  [[nodiscard]] bool excludes(const Vec<double, 2>& z, const Mat<double, 2, 2>& r,
                              double threshold) const noexcept {
    constexpr double kRounding = 1.0 + 1e-6;
    const double along = direction.dot(z - position);
    const double outside = std::max(along - to, from - along);
    return (outside > 0.0) &
           (outside * outside > kRounding * threshold * (variance + direction.dot(r * direction)));
  }
};

/// An estimator's prediction of its target's position, as a mixture over its modes: what gates and
/// likelihoods of position fixes ask for.
///
/// Modes are laid out side by side, so that a fix is compared with all of them in lanes, at a small
/// part of the cost of asking each filter. Of an estimator that does not show its modes it asks
/// `evidence`.
class ModePositions {
  using Lanes = Pack<double, kNativeLanes<double>>;
  static constexpr std::size_t kLanes = kLanesOf<Lanes>;

 public:
  static constexpr std::size_t kMost = 64;  ///< modes of one estimator; more are left out
  static_assert(kMost % kLanes == 0);

  /// Reads an estimator: the modes that it shows by `for_each_mode(f(mode, belief))` with
  /// `mode_probability()`, or none; it is then to stay where it is while this is used.
  template <class Estimator>
  void read(const Estimator& estimator) noexcept {
    count_ = 0;
    evidence_ = nullptr;
    if constexpr (requires { estimator.mode_probability(); }) {
      const auto& probability = estimator.mode_probability();
      const auto add = [&](int mode, const auto& belief) {
        if (count_ < kMost) put(count_, position_of(belief), probability[mode]);
        ++count_;
      };
      if constexpr (requires { estimator.for_each_mode(add); }) estimator.for_each_mode(add);
    }
    if constexpr (requires { estimator.evidence(Fix{}, Vec<double, 2>{}); }) {
      if (count_ == 0 || count_ > kMost) {
        estimator_ = &estimator;
        evidence_ = [](const void* of, const Vec<double, 2>& z, const Mat<double, 2, 2>& r) {
          return static_cast<const Estimator*>(of)->evidence(Fix{r}, z);
        };
        return;
      }
    }
    count_ = std::min(count_, kMost);
    // One more mode, of probability zero, in each lane that is left over.
    for (std::size_t k = count_; k % kLanes != 0; ++k) put(k, row<double>(0), 0.0);
  }

  /// All modes about a position; infinitely far where modes are not shown.
  [[nodiscard]] GateSquare about(const Vec<double, 2>& position) const noexcept {
    if (evidence_ != nullptr) return {std::numeric_limits<double>::infinity(), 0.0};
    Lanes farthest_m = 0.0, variance_m2 = 0.0;
    for (std::size_t k = 0; k < count_; k += kLanes) {
      const Gaussian<2, Lanes> modes = row(k);
      farthest_m =
          max(farthest_m, max(abs(modes.mean[0] - position[0]), abs(modes.mean[1] - position[1])));
      variance_m2 = max(variance_m2, max(modes.covariance(0, 0), modes.covariance(1, 1)));
    }
    return {greatest_of_lanes(farthest_m), greatest_of_lanes(variance_m2)};
  }

  /// All modes in one direction from a position, about which they are; infinitely wide where modes
  /// are not shown.
  [[nodiscard]] GateStrip along(const Vec<double, 2>& direction,
                                const Vec<double, 2>& position) const noexcept {
    constexpr double kAnywhere = std::numeric_limits<double>::infinity();
    if (evidence_ != nullptr) return {direction, position, -kAnywhere, kAnywhere, kAnywhere};
    Lanes back = -kAnywhere, ahead = -kAnywhere, variance = 0.0;
    for (std::size_t k = 0; k < count_; k += kLanes) {
      const Gaussian<2, Lanes> modes = row(k);
      const Lanes mean = direction[0] * (modes.mean[0] - position[0]) +
                         direction[1] * (modes.mean[1] - position[1]);
      back = max(back, -mean);
      ahead = max(ahead, mean);
      variance = max(variance, direction[0] * direction[0] * modes.covariance(0, 0) +
                                   2.0 * direction[0] * direction[1] * modes.covariance(1, 0) +
                                   direction[1] * direction[1] * modes.covariance(1, 1));
    }
    return {direction, position, -greatest_of_lanes(back), greatest_of_lanes(ahead),
            greatest_of_lanes(variance)};
  }

  /// Whether a fix with covariance `r` is within a gate of that threshold about one of the modes.
  [[nodiscard]] bool gate(const Vec<double, 2>& z, const Mat<double, 2, 2>& r,
                          double threshold) const noexcept {
    if (evidence_ != nullptr) return evidence_(estimator_, z, r).least_nis <= threshold;
    bool inside = false;
    for (std::size_t k = 0; k < count_ && !inside; k += kLanes) {
      const Gaussian<2, Lanes> modes = row(k);
      const Lanes d0 = z[0] - modes.mean[0];
      const Lanes d1 = z[1] - modes.mean[1];
      const Lanes s00 = modes.covariance(0, 0) + r(0, 0);
      const Lanes s01 = modes.covariance(1, 0) + r(1, 0);
      const Lanes s11 = modes.covariance(1, 1) + r(1, 1);
      // dᵀ S⁻¹ d <= γ, times det S
      const Lanes determinant = s00 * s11 - s01 * s01;
      inside = any(s11 * d0 * d0 - 2.0 * s01 * d0 * d1 + s00 * d1 * d1 <= threshold * determinant &&
                   determinant > 0.0);
    }
    return inside;
  }

  /// The likelihood of a fix with covariance `r` under all modes, and its least distance to one.
  [[nodiscard]] Evidence<double> evidence(const Vec<double, 2>& z,
                                          const Mat<double, 2, 2>& r) const noexcept {
    if (evidence_ != nullptr) return evidence_(estimator_, z, r);
    Evidence<Lanes> evidence;
    for (std::size_t k = 0; k < count_; k += kLanes) {
      const Gaussian<2, Lanes> modes = row(k);
      const Cholesky<2, Lanes> factor(modes.covariance + r.cast<Lanes>());
      Correction<2, Lanes> correction;
      correction.innovation = z.cast<Lanes>() - modes.mean;
      rate(correction, factor.whiten(correction.innovation), factor);
      evidence.add(load<Lanes>(&probability_[k]), correction);
    }
    return {sum_of_lanes(evidence.likelihood), least_of_lanes(evidence.least_nis)};
  }

 private:
  using EvidenceOf = Evidence<double> (*)(const void* estimator, const Vec<double, 2>& z,
                                          const Mat<double, 2, 2>& r);

  void put(std::size_t k, const Gaussian<2>& position, double probability) noexcept {
    north_m_[k] = position.mean[0];
    east_m_[k] = position.mean[1];
    north_m2_[k] = position.covariance(0, 0);
    common_m2_[k] = position.covariance(1, 0);
    east_m2_[k] = position.covariance(1, 1);
    probability_[k] = probability;
  }

  /// As many modes as there are lanes, from mode `k` on; or that one.
  template <class Scalar = Lanes>
  [[nodiscard]] Gaussian<2, Scalar> row(std::size_t k) const noexcept {
    const Scalar common = load<Scalar>(&common_m2_[k]);
    Gaussian<2, Scalar> modes;
    modes.mean << load<Scalar>(&north_m_[k]), load<Scalar>(&east_m_[k]);
    modes.covariance << load<Scalar>(&north_m2_[k]), common, common, load<Scalar>(&east_m2_[k]);
    return modes;
  }

  std::array<double, kMost> north_m_, east_m_, north_m2_, common_m2_, east_m2_, probability_;
  std::size_t count_ = 0;
  const void* estimator_ = nullptr;
  EvidenceOf evidence_ = nullptr;  ///< of an estimator whose modes are not shown; else null
};

}  // namespace wakeline
