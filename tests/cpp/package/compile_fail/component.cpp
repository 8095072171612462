// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A compass on a vessel whose state holds no heading.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/navigation/usv_models.hpp"
#include "wakeline/navigation/usv_sensors.hpp"

#ifdef WAKELINE_COMPILE_FAIL
using Motion = wakeline::ConstantVelocity;
#else
using Motion = wakeline::UsvBiasMotion;
#endif

int main() {
  wakeline::Ekf filter{Motion{}};
  return filter.update(wakeline::Compass{}, wakeline::Vec<double, 1>(0.1)) ? 1 : 0;
}
