// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the benchmarks of lanes do: estimators over any Scalar, their sensors, and a course for each
// lane.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "course.hpp"
#include "flop_count.hpp"
#include "wakeline/core/pack_math.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::bench {

template <class Real>
using Lanes = Pack<Real, kNativeLanes<Real>>;

inline constexpr std::array kTurnRates_deg_s{0.0, 1.0, -1.0, 2.0, -2.0};
inline constexpr Position kFix{.position_std_m = 20.0};
inline constexpr RangeBearing kRadar{.range_std_m = 20.0, .bearing_std_rad = deg(0.5)};

/// Mode k of an IMM.
inline CoordinatedTurn turning(int mode) {
  return {.turn_rate_rad_s = deg(kTurnRates_deg_s[static_cast<std::size_t>(mode)]),
          .noise = WhiteAcceleration{0.01}};
}

template <int K>
Mat<double, K, K> transition() {
  Mat<double, K, K> chain = Mat<double, K, K>::Constant(0.06 / (K - 1));
  chain.diagonal().setConstant(0.94);
  return chain;
}

/// An IMM of K turns.
template <int K, class Scalar>
auto imm() {
  return []<int... Mode>(std::integer_sequence<int, Mode...>) {
    return Imm{ModeChain<K>(transition<K>()), Ekf<CoordinatedTurn, Scalar>(turning(Mode))...};
  }
  (std::make_integer_sequence<int, K>{});
}

template <class Scalar>
auto kalman() {
  return Kalman<ConstantVelocity, Scalar>(ConstantVelocity{.noise = WhiteAcceleration{0.05}});
}

template <class Scalar>
auto polar_ekf() {
  return Ekf<ConstantVelocity, Scalar>(ConstantVelocity{.noise = WhiteAcceleration{0.05}});
}

/// Five states, as the turn rate is one.
template <class Scalar>
auto ukf() {
  return Ukf<CoordinatedTurnRate, Scalar>(CoordinatedTurnRate{.noise = WhiteAcceleration{0.01}});
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
      if constexpr (kLanesOf<Scalar> == 1)
        return Scalar(number(courses[0]));
      else
        return Scalar::of([&](int k) { return number(courses[static_cast<std::size_t>(k)]); });
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
  kUkf5
};

/// Arithmetic of one step, by running it.
FlopCount arithmetic_of(Work work);

}  // namespace wakeline::bench
