// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A Kalman filter of a motion that is not linear.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/coordinated_turn.hpp"

#ifdef WAKELINE_COMPILE_FAIL
using Motion = wakeline::CoordinatedTurnRate;
#else
using Motion = wakeline::CoordinatedTurn;
#endif

int main() {
  wakeline::Kalman kalman{Motion{}};
  return kalman.predict(1.0) == wakeline::Status::kNotStarted ? 0 : 1;
}
