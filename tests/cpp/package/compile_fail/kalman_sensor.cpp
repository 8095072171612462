// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A Kalman filter of plots in range and bearing, which are linear only once converted.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/constant_velocity.hpp"

#ifdef WAKELINE_COMPILE_FAIL
using Radar = wakeline::RangeBearing;
#else
using Radar = wakeline::ConvertedRangeBearing;
#endif

int main() {
  wakeline::Kalman kalman{wakeline::ConstantVelocity{}};
  return kalman.update(Radar{}, wakeline::Vec<double, 2>(1000.0, 1.0)) ? 1 : 0;
}
