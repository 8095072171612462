// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <type_traits>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/singer.hpp"

namespace wakeline::test {

/// Every kind of filter in double, and in float.
using EveryFilter = ::testing::Types<Kalman<ConstantVelocity>, Ekf<CoordinatedTurnRate>,
                                     Ukf<CoordinatedTurnRate>, SquareRootUkf<CoordinatedTurnRate>>;
using EveryFloatFilter =
    ::testing::Types<Kalman<CoordinatedTurn, float>, Ekf<CoordinatedTurnRate, float>,
                     Ukf<ConstantVelocity, float>, SquareRootUkf<ConstantVelocity, float>>;

template <class Filter>
inline constexpr bool kIsKalman =
    std::is_same_v<Filter, Kalman<typename Filter::Motion, typename Filter::Scalar>>;

/// The radar that suits the filter: of converted plots for Kalman, polar for the others.
template <class Filter>
auto radar_of(double range_std_m, double bearing_std_rad) {
  if constexpr (kIsKalman<Filter>)
    return ConvertedRangeBearing{.range_std_m = range_std_m, .bearing_std_rad = bearing_std_rad};
  else
    return RangeBearing{.range_std_m = range_std_m, .bearing_std_rad = bearing_std_rad};
}

/// A vessel 5 km off, known to 50 m and 3 m/s.
template <class Scalar>
Gaussian<4, Scalar> five_km_off() {
  Gaussian<4> belief;
  belief.mean << 3000, -4, 4000, 7;
  belief.covariance << 2500, 20, 300, 0, 20, 9, 0, 1, 300, 0, 2000, -10, 0, 1, -10, 8;
  return belief.template cast<Scalar>();
}

/// The plot an exact radar would have of it.
template <class Scalar>
Vec<Scalar, 2> plot_of(double north_m, double east_m) {
  return RangeBearing{}.measure(Vec<double, 2>(north_m, east_m)).template cast<Scalar>();
}

/// The same belief bit for bit.
template <int N, class Scalar>
testing::AssertionResult beliefs_identical(const Gaussian<N, Scalar>& actual,
                                           const Gaussian<N, Scalar>& expected) {
  if (const auto same = matrices_identical(actual.mean, expected.mean); !same) return same;
  return matrices_identical(actual.covariance, expected.covariance);
}

}  // namespace wakeline::test
