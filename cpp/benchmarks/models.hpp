// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Motion models, sensors and the IMM that the benchmarks share.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "course.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::bench {

inline constexpr std::array kTurnRates_deg_s{0.0, 1.0, -1.0, 2.0, -2.0};
inline constexpr Position kFix{.position_std_m = 20.0};
inline constexpr RangeBearing kRadar{.range_std_m = 20.0, .bearing_std_rad = deg(0.5)};
inline constexpr ConstantVelocity kSteady{.noise = WhiteAcceleration{0.05}};
inline constexpr CoordinatedTurnRate kTurning{.noise = WhiteAcceleration{0.01}};

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

}  // namespace wakeline::bench
