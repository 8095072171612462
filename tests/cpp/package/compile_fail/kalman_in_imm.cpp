// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// An Imm of Kalman filters of plots in range and bearing, which are linear only once converted.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/multimodel/filter_bank.hpp"
#include "wakeline/multimodel/imm.hpp"

#ifdef WAKELINE_COMPILE_FAIL
using Radar = wakeline::RangeBearing;
#else
using Radar = wakeline::ConvertedRangeBearing;
#endif

int main() {
  const wakeline::Kalman kalman{wakeline::ConstantAcceleration{}};
  wakeline::Imm imm{wakeline::ModeChain<2>::from_sojourn_s({60.0, 60.0}), kalman, kalman};
  return imm.update(Radar{}, wakeline::Vec<double, 2>(1000.0, 1.0)) ? 1 : 0;
}
