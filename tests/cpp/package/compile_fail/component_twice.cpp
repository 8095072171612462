// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A motion model that names the velocity to the north twice, and that to the east not at all.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"

using wakeline::Component;

struct Drifting : wakeline::ConstantVelocity {
#ifdef WAKELINE_COMPILE_FAIL
  static constexpr Component kFourth = Component::kVnorth;
#else
  static constexpr Component kFourth = Component::kVeast;
#endif
  static constexpr std::array kComponents{Component::kNorth, Component::kVnorth, Component::kEast,
                                          kFourth};
};

int main() {
  const wakeline::Ekf filter{Drifting{}};
  return filter.started() ? 1 : 0;
}
