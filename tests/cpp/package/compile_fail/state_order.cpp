// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A motion model over [x, y, vx, vy], which a start over [x, vx, y, vy] would fill wrongly.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"

using wakeline::Component;

struct Drifting : wakeline::ConstantVelocity {
#ifdef WAKELINE_COMPILE_FAIL
  static constexpr std::array kComponents{Component::kNorth, Component::kEast, Component::kVnorth,
                                          Component::kVeast};
#endif
};

int main() {
  const wakeline::Ekf filter{Drifting{}};
  return filter.started() ? 1 : 0;
}
