// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// An Imm of a float and a double filter.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/multimodel/imm.hpp"

#ifdef WAKELINE_COMPILE_FAIL
using Other = float;
#else
using Other = double;
#endif

int main() {
  const auto chain = wakeline::ModeChain<2>::from_sojourn_s({60.0, 30.0});
  const wakeline::Ekf<wakeline::ConstantVelocity, double> first{wakeline::ConstantVelocity{}};
  const wakeline::Ekf<wakeline::ConstantVelocity, Other> second{wakeline::ConstantVelocity{}};
  const wakeline::Imm imm{chain, first, second};
  return imm.started() ? 1 : 0;
}
