// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A sensor that does not say how to subtract two of its readings.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/motion/constant_velocity.hpp"

struct Lone : wakeline::Position {
#ifdef WAKELINE_COMPILE_FAIL
 private:
#endif
  using wakeline::Position::residual;
};

int main() {
  wakeline::Ekf ekf{wakeline::ConstantVelocity{}};
  return ekf.update(Lone{}, wakeline::Vec<double, 2>(1.0, 1.0)) ? 1 : 0;
}
