// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A motion model whose matrices are smaller than its state.
#include "wakeline/filter/ekf.hpp"

using wakeline::Component;
using wakeline::Mat;

struct Drifting {
#ifdef WAKELINE_COMPILE_FAIL
  static constexpr std::array kComponents{Component::kNorth, Component::kVnorth, Component::kEast,
                                          Component::kVeast, Component::kTurnRate};
#else
  static constexpr auto kComponents = wakeline::kKinematics;
#endif

  template <class Scalar>
  Mat<Scalar, 4, 4> matrix(Scalar) const noexcept {
    return Mat<Scalar, 4, 4>::Identity();
  }
  template <class Scalar>
  Mat<Scalar, 4, 4> process_noise(Scalar dt_s) const noexcept {
    return dt_s * Mat<Scalar, 4, 4>::Identity();
  }
};

int main() {
  wakeline::Ekf ekf{Drifting{}};
  return ekf.predict(1.0) == wakeline::Status::kNotStarted ? 0 : 1;
}
