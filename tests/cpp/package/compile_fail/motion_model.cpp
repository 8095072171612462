// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A motion model that forgets its process noise.
#include "wakeline/filter/ekf.hpp"

struct Drifting {
  static constexpr auto kComponents = wakeline::kKinematics;

  template <class Scalar>
  wakeline::Mat<Scalar, 4, 4> matrix(Scalar) const noexcept {
    return wakeline::Mat<Scalar, 4, 4>::Identity();
  }
#ifndef WAKELINE_COMPILE_FAIL
  template <class Scalar>
  wakeline::Mat<Scalar, 4, 4> process_noise(Scalar dt_s) const noexcept {
    return dt_s * wakeline::Mat<Scalar, 4, 4>::Identity();
  }
#endif
};

int main() {
  wakeline::Ekf ekf{Drifting{}};
  return ekf.predict(1.0) == wakeline::Status::kNotStarted ? 0 : 1;
}
