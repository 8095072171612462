// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A tracker of single filters, which know nothing of several readings.
#include "wakeline/track/tracker.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/multimodel/imm.hpp"

using namespace wakeline;

int main() {
  const Ekf filter{ConstantVelocity{}};
#ifdef WAKELINE_COMPILE_FAIL
  const Tracker tracker(Radar{}, TrackerConfig{}, filter);
#else
  const Tracker tracker(Radar{}, TrackerConfig{},
                        Imm{ModeChain<1>::from_sojourn_s({60.0}), filter});
#endif
  return tracker.size();
}
