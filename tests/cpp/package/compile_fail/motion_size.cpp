// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A motion model whose matrices are smaller than its state.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"

using wakeline::Component;

struct Drifting : wakeline::ConstantVelocity {
#ifdef WAKELINE_COMPILE_FAIL
  static constexpr std::array kComponents{Component::kNorth, Component::kVnorth, Component::kEast,
                                          Component::kVeast, Component::kTurnRate};
#endif
};

int main() {
  wakeline::Ekf ekf{Drifting{}};
  return ekf.predict(1.0) == wakeline::Status::kNotStarted ? 0 : 1;
}
