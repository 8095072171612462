// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A motion model that writes its pattern with a capital letter.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"

struct Drifting : wakeline::ConstantVelocity {
#ifdef WAKELINE_COMPILE_FAIL
  static constexpr wakeline::Pattern<4> kPattern{"1X00 0100 001X 0001"};
#else
  static constexpr wakeline::Pattern<4> kPattern{"1x00 0100 001x 0001"};
#endif
};

int main() {
  wakeline::Ekf filter{Drifting{}};
  return ok(filter.predict(1.0)) ? 1 : 0;
}
