// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// An Imm of motion models where filters are wanted.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/multimodel/imm.hpp"

int main() {
  const auto chain = wakeline::ModeChain<2>::from_sojourn_s({60.0, 30.0});
#ifdef WAKELINE_COMPILE_FAIL
  const wakeline::ConstantVelocity model;
#else
  const wakeline::Ekf model{wakeline::ConstantVelocity{}};
#endif
  const wakeline::Imm imm{chain, model, model};
  return imm.started() ? 1 : 0;
}
