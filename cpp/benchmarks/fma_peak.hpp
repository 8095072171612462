// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

#include "wakeline/simd/pack.hpp"
#include "wakeline/simd/unroll.hpp"

namespace wakeline::bench {

/// Some multiplications, each with an addition, in as many independent chains as keep every unit of
/// the processor busy. Returns the operations: two for each lane.
template <class Real>
[[gnu::flatten]] double multiply_and_add(Real& result) noexcept {
  using Numbers = Pack<Real, kNativeLanes<Real>>;
  constexpr int kChains = 12, kRounds = 2000;
  const Numbers factor = Real(0.999) * result, term = Real(0.001) * result;
  Numbers chain[kChains];
  unroll<kChains>([&](auto k) { chain[k.value] = result + Real(k.value); });
  for (int round = 0; round < kRounds; ++round)
    unroll<kChains>([&](auto k) { chain[k.value] = chain[k.value] * factor + term; });
  Numbers sum = chain[0];
  unroll<kChains - 1>([&](auto k) { sum += chain[k.value + 1]; });
  result = sum[0] / (sum[0] + Real(1e-30));  // 1 again
  return 2.0 * kNativeLanes<Real> * kChains * kRounds;
}

/// Most operations a second that multiply and add in packs, the best of many times.
template <class Real>
double peak_flops() {
  static const double peak = [] {
    using Clock = std::chrono::steady_clock;
    Real result = 1;
    double best = 0.0;
    for (int repeat = 0; repeat < 2000; ++repeat) {
      const auto began = Clock::now();
      const double operations = multiply_and_add(result);
      const double rate = operations / std::chrono::duration<double>(Clock::now() - began).count();
      if (rate > best && result > 0) best = rate;
    }
    return best;
  }();
  return peak;
}

}  // namespace wakeline::bench
