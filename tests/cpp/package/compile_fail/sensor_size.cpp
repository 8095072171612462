// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A sensor whose jacobian has one row for two measurements.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/motion/constant_velocity.hpp"

struct Short : wakeline::Position {
#ifdef WAKELINE_COMPILE_FAIL
  static constexpr int kRows = 1;
#else
  static constexpr int kRows = 2;
#endif

  template <class Scalar>
  wakeline::Mat<Scalar, kRows, 2> jacobian(const wakeline::Vec<Scalar, 2>&) const noexcept {
    return wakeline::Mat<Scalar, kRows, 2>::Identity();
  }
};

int main() {
  wakeline::Ekf ekf{wakeline::ConstantVelocity{}};
  return ekf.update(Short{}, wakeline::Vec<double, 2>(1.0, 1.0)) ? 1 : 0;
}
