// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the benchmarks of lanes do: estimators over any Scalar, their sensors, and a course for each
// lane.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "flop_count.hpp"
#include "models.hpp"
#include "wakeline/simd/pack_math.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/multimodel/bayesian_alpha_beta.hpp"
#include "wakeline/multimodel/fuzzy_alpha_beta.hpp"

namespace wakeline::bench {

template <class Real>
using Lanes = Pack<Real, kNativeLanes<Real>>;

template <class Scalar>
auto kalman() {
  return Kalman<ConstantVelocity, Scalar>(kSteady);
}

template <class Scalar>
auto polar_ekf() {
  return Ekf<ConstantVelocity, Scalar>(kSteady);
}

/// Five states, as the turn rate is one.
template <class Scalar>
auto ukf() {
  return Ukf<CoordinatedTurnRate, Scalar>(kTurning);
}

/// The same course in each lane, with its own noise.
template <class Scalar>
struct LaneCourse {
  std::vector<Vec<Scalar, 2>> polar;     ///< range m, bearing rad
  std::vector<Vec<Scalar, 2>> position;  ///< north m, east m
  Gaussian<4, Scalar> start;

  LaneCourse() {
    std::vector<Course<double>> courses;
    for (unsigned k = 0; k < kLanesOf<Scalar>; ++k) courses.emplace_back(k + 1);
    const auto gather = [&](const auto& number) {
      return lanes_of<Scalar>(
          [&](int k) { return RealOf<Scalar>(number(courses[static_cast<std::size_t>(k)])); });
    };
    const auto gather_plots = [&](std::vector<Vec<double, 2>> Course<double>::*plots) {
      std::vector<Vec<Scalar, 2>> gathered((courses[0].*plots).size());
      for (std::size_t scan = 0; scan < gathered.size(); ++scan)
        for (int m = 0; m < 2; ++m)
          gathered[scan][m] =
              gather([&](const Course<double>& course) { return (course.*plots)[scan][m]; });
      return gathered;
    };
    polar = gather_plots(&Course<double>::polar);
    position = gather_plots(&Course<double>::position);
    start = courses[0].start.template cast<Scalar>();
  }

  /// The plots that a sensor gives.
  const std::vector<Vec<Scalar, 2>>& plots(const Position&) const noexcept { return position; }
  const std::vector<Vec<Scalar, 2>>& plots(const RangeBearing&) const noexcept { return polar; }
};

/// One step, as one function without calls: what keeps the packs in registers.
template <class Estimator, class Sensor>
[[gnu::flatten]] inline auto take(Estimator& estimator, const Sensor& sensor,
                                  const Vec<typename Estimator::Scalar, 2>& z) noexcept {
  (void)estimator.predict(typename Estimator::Scalar(kStep_s));
  return estimator.update(sensor, z);
}

/// The works that are timed.
enum class Work {
  kImm3,
  kImm5,
  kImm3Tuned,
  kImm5Tuned,
  kImm3Plain,
  kImm5Plain,
  kImm3Polar,
  kImm5Polar,
  kKalman,
  kPolarEkf,
  kUkf5,
  kFuzzy,
  kBayesian
};

/// Arithmetic of one step, by running it.
FlopCount arithmetic_of(Work work);

}  // namespace wakeline::bench
