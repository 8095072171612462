// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A filter whose own prediction hides that under a known acceleration.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/multimodel/imm.hpp"

struct Patient : wakeline::Ekf<wakeline::ConstantVelocity> {
  using Ekf::Ekf;
#ifndef WAKELINE_COMPILE_FAIL
  using Ekf::predict;
#endif
  wakeline::Status predict(double dt_s) noexcept { return Ekf::predict(dt_s); }
};

int main() {
  wakeline::Imm imm{wakeline::ModeChain<1>::from_sojourn_s({60.0}),
                    Patient{wakeline::ConstantVelocity{}}};
  return ok(imm.predict(1.0, wakeline::Vec<double, 2>(0.1, 0.0))) ? 1 : 0;
}
