// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

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

/// Where the modes of an estimator believe their target to be: what tells plots that none of them
/// can own from the rest, at a small part of the cost of asking the estimator.
class ModePlaces {
 public:
  /// Looks at an estimator: an `Imm`, or one that shows the beliefs of its modes by
  /// `for_each_mode(f(mode, belief))`. Of others it knows nothing.
  template <class Estimator>
  void take(const Estimator& estimator) noexcept {
    count_ = 0;
    const auto add = [&](int, const auto& belief) {
      if (count_ < places_.size()) places_[count_] = place_of(belief);
      ++count_;
    };
    if constexpr (requires { estimator.for_each_mode(add); })
      estimator.for_each_mode(add);
    else if constexpr (requires { beliefs_of(estimator, add); })
      beliefs_of(estimator, add);
    known_ = count_ > 0 && count_ <= places_.size();
  }

  /// How far from a position, north or east, a plot with at most that variance may be and yet in a
  /// gate of that threshold about one of the modes; infinite where nothing is known.
  [[nodiscard]] double reach_m(const Vec<double, 2>& position, double variance_m2,
                               double threshold) const noexcept {
    constexpr double kRounding = 1.0 + 1e-6;
    if (!known_) return std::numeric_limits<double>::infinity();
    double reach_m = 0.0;
    for (std::size_t k = 0; k < count_; ++k) {
      const Gaussian<2>& place = places_[k];
      const double widest_m2 = std::max(place.covariance(0, 0), place.covariance(1, 1));
      const double off_m = (place.mean - position).cwiseAbs().maxCoeff();
      reach_m = std::max(reach_m, off_m + std::sqrt(threshold * (widest_m2 + variance_m2)));
    }
    return kRounding * reach_m;
  }

  /// Whether a plot with covariance `r` may be in a gate of that threshold about one of the modes;
  /// where nothing is known it may.
  [[nodiscard]] bool may_own(const Vec<double, 2>& z, const Mat<double, 2, 2>& r,
                             double threshold) const noexcept {
    constexpr double kRounding = 1.0 + 1e-6;
    if (!known_) return true;
    for (std::size_t k = 0; k < count_; ++k) {
      const Gaussian<2>& place = places_[k];
      const double d0 = z[0] - place.mean[0];
      const double d1 = z[1] - place.mean[1];
      const double s00 = place.covariance(0, 0) + r(0, 0);
      const double s01 = place.covariance(1, 0) + r(1, 0);
      const double s11 = place.covariance(1, 1) + r(1, 1);
      // dᵀ S⁻¹ d <= γ, times det S
      if (s11 * d0 * d0 - 2.0 * s01 * d0 * d1 + s00 * d1 * d1 <=
          kRounding * threshold * (s00 * s11 - s01 * s01))
        return true;
    }
    return false;
  }

 private:
  template <class Bank, class Function>
  static void beliefs_of(const Imm<Bank>& imm, Function& function) noexcept {
    imm.bank().for_each_belief(function);
  }

  std::array<Gaussian<2>, static_cast<std::size_t>(kMaxModes)> places_;
  std::size_t count_ = 0;
  bool known_ = false;
};

}  // namespace wakeline
