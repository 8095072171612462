// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "wakeline/simd/pack_math.hpp"
#include "wakeline/multimodel/filter_bank.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/mode_chain.hpp"

namespace wakeline {

/// The position, [north, east], in a belief over any state that holds it.
template <class Belief>
Gaussian<2> place_of(const Belief& belief) noexcept {
  if constexpr (requires { Belief::kComponents; }) {
    constexpr auto kRows = rows_of(Belief::kComponents, kKinematics);
    constexpr int kNorth = kRows[0], kEast = kRows[2];
    const double common = belief.covariance(kEast, kNorth);
    return {{belief.mean[kNorth], belief.mean[kEast]},
            (Mat<double, 2, 2>() << belief.covariance(kNorth, kNorth), common, common,
             belief.covariance(kEast, kEast))
                .finished()};
  } else {
    const Gaussian<4> kinematics = kinematics_of(belief);
    return {
        {kinematics.mean[0], kinematics.mean[2]},
        kinematics.covariance(Eigen::seqN(0, 2, Eigen::fix<2>), Eigen::seqN(0, 2, Eigen::fix<2>))};
  }
}

/// Where the modes of an estimator believe their target to be, side by side: all that a fix asks of
/// them, at a small part of the cost of asking the estimator.
class ModePlaces {
  using Lanes = Pack<double, kNativeLanes<double>>;
  static constexpr std::size_t kLanes = kLanesOf<Lanes>;
  static constexpr std::size_t kMost = kMaxModes;
  static_assert(kMost % kLanes == 0);

 public:
  /// Looks at an estimator: an `Imm`, or one that shows the beliefs of its modes by
  /// `for_each_mode(f(mode, belief))`. Of others it knows nothing.
  template <class Estimator>
  void take(const Estimator& estimator) noexcept {
    count_ = 0;
    if constexpr (requires { estimator.mode_probability(); }) {
      const auto& probability = estimator.mode_probability();
      const auto add = [&](int mode, const auto& belief) {
        if (count_ < kMost) put(count_, place_of(belief), probability[mode]);
        ++count_;
      };
      if constexpr (requires { estimator.for_each_mode(add); })
        estimator.for_each_mode(add);
      else if constexpr (requires { beliefs_of(estimator, add); })
        beliefs_of(estimator, add);
    }
    known_ = count_ > 0 && count_ <= kMost;
    // A mode more in each lane that is left over, which nobody believes in.
    if (known_)
      for (std::size_t k = count_; k % kLanes != 0; ++k) put(k, row<double>(0), 0.0);
  }

  /// False of an estimator without such modes.
  [[nodiscard]] bool known() const noexcept { return known_; }

  /// How far from a position, north or east, a plot with at most that variance may be and yet in a
  /// gate of that threshold about one of the modes; infinite where nothing is known.
  [[nodiscard]] double reach_m(const Vec<double, 2>& position, double variance_m2,
                               double threshold) const noexcept {
    constexpr double kRounding = 1.0 + 1e-6;
    if (!known_) return std::numeric_limits<double>::infinity();
    Lanes reach_m = 0.0;
    for (std::size_t k = 0; k < count_; k += kLanes) {
      const Gaussian<2, Lanes> places = row(k);
      const Lanes widest_m2 = max(places.covariance(0, 0), places.covariance(1, 1));
      const Lanes off_m = max(abs(places.mean[0] - position[0]), abs(places.mean[1] - position[1]));
      reach_m = max(reach_m, off_m + sqrt(threshold * (widest_m2 + variance_m2)));
    }
    return kRounding * greatest_of_lanes(reach_m);
  }

  /// Whether a plot with covariance `r` may be in a gate of that threshold about one of the modes;
  /// where nothing is known it may.
  [[nodiscard]] bool may_own(const Vec<double, 2>& z, const Mat<double, 2, 2>& r,
                             double threshold) const noexcept {
    constexpr double kRounding = 1.0 + 1e-6;
    bool owned = !known_;
    for (std::size_t k = 0; k < count_ && !owned; k += kLanes) {
      const Gaussian<2, Lanes> places = row(k);
      const Lanes d0 = z[0] - places.mean[0];
      const Lanes d1 = z[1] - places.mean[1];
      const Lanes s00 = places.covariance(0, 0) + r(0, 0);
      const Lanes s01 = places.covariance(1, 0) + r(1, 0);
      const Lanes s11 = places.covariance(1, 1) + r(1, 1);
      // dᵀ S⁻¹ d <= γ, times det S
      owned = any(s11 * d0 * d0 - 2.0 * s01 * d0 * d1 + s00 * d1 * d1 <=
                  kRounding * threshold * (s00 * s11 - s01 * s01));
    }
    return owned;
  }

  /// What the modes think of a fix with covariance `r`: the `evidence` of the estimator.
  [[nodiscard]] Evidence<double> evidence(const Vec<double, 2>& z,
                                          const Mat<double, 2, 2>& r) const noexcept {
    Evidence<Lanes> evidence;
    for (std::size_t k = 0; k < count_; k += kLanes) {
      const Gaussian<2, Lanes> places = row(k);
      const Cholesky<2, Lanes> factor(places.covariance + r.cast<Lanes>());
      Correction<2, Lanes> correction;
      correction.innovation = z.cast<Lanes>() - places.mean;
      rate(correction, factor.whiten(correction.innovation), factor);
      evidence.add(load<Lanes>(&probability_[k]), correction);
    }
    return {sum_of_lanes(evidence.likelihood), least_of_lanes(evidence.least_nis)};
  }

 private:
  template <class Bank, class Function>
  static void beliefs_of(const Imm<Bank>& imm, Function& function) noexcept {
    imm.bank().for_each_belief(function);
  }

  void put(std::size_t k, const Gaussian<2>& place, double probability) noexcept {
    north_m_[k] = place.mean[0];
    east_m_[k] = place.mean[1];
    north_m2_[k] = place.covariance(0, 0);
    common_m2_[k] = place.covariance(1, 0);
    east_m2_[k] = place.covariance(1, 1);
    probability_[k] = probability;
  }

  /// As many places as there are lanes, from place `k` on; or that one.
  template <class Scalar = Lanes>
  [[nodiscard]] Gaussian<2, Scalar> row(std::size_t k) const noexcept {
    const Scalar common = load<Scalar>(&common_m2_[k]);
    Gaussian<2, Scalar> places;
    places.mean << load<Scalar>(&north_m_[k]), load<Scalar>(&east_m_[k]);
    places.covariance << load<Scalar>(&north_m2_[k]), common, common, load<Scalar>(&east_m2_[k]);
    return places;
  }

  std::array<double, kMost> north_m_, east_m_, north_m2_, common_m2_, east_m2_, probability_;
  std::size_t count_ = 0;
  bool known_ = false;
};

}  // namespace wakeline
