// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A sensor that does not say which components of the state it reads.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/motion/constant_velocity.hpp"

struct Silent : wakeline::Position {
#ifdef WAKELINE_COMPILE_FAIL
 private:
#endif
  using wakeline::Position::kReads;
};

int main() {
  wakeline::Ekf ekf{wakeline::ConstantVelocity{}};
  return ekf.update(Silent{}, wakeline::Vec<double, 2>(1.0, 1.0)) ? 1 : 0;
}
