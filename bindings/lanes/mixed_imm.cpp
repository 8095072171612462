// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "mixed_imm.hpp"

namespace wakeline::python {

bool run_mixed_imm(const LaneJob& job, const RunInput& in, const RunOutput& out, int threads) {
  const auto run_filters_over = [&]<class... Motions>(std::type_identity<Motions>...) {
    return run_mixed<PlaneSensors, Ekf<Motions, Lanes>..., Ukf<Motions, Lanes>...,
                     SquareRootUkf<Motions, Lanes>...>(job, in, out, threads);
  };
  constexpr std::type_identity<CoordinatedTurnRate> kTurnRate;
  constexpr std::type_identity<ConstantAcceleration> kAcceleration;
  constexpr std::type_identity<Singer> kSinger;
  return run_filters_over(kTurnRate) || run_filters_over(kAcceleration, kSinger) ||
         run_filters_over(std::type_identity<CoordinatedTurn>{},
                          std::type_identity<WanderingCourse>{}, kTurnRate, kAcceleration, kSinger);
}

}  // namespace wakeline::python
