// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A motion model that hides its process noise.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"

struct Drifting : wakeline::ConstantVelocity {
#ifdef WAKELINE_COMPILE_FAIL
 private:
#endif
  using wakeline::ConstantVelocity::process_noise;
};

int main() {
  wakeline::Ekf ekf{Drifting{}};
  return ekf.predict(1.0) == wakeline::Status::kNotStarted ? 0 : 1;
}
