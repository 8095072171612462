// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A motion model that names the velocity to the north twice, and that to the east not at all.
#include "wakeline/filter/ekf.hpp"

using wakeline::Component;
using wakeline::Mat;

struct Drifting {
#ifdef WAKELINE_COMPILE_FAIL
  static constexpr std::array kComponents{Component::kNorth, Component::kVnorth, Component::kEast,
                                          Component::kVnorth};
#else
  static constexpr std::array kComponents{Component::kNorth, Component::kVnorth, Component::kEast,
                                          Component::kVeast};
#endif

  template <class Scalar>
  Mat<Scalar, 4, 4> matrix(Scalar dt_s) const noexcept {
    Mat<Scalar, 4, 4> f = Mat<Scalar, 4, 4>::Identity();
    f(0, 1) = f(2, 3) = dt_s;
    return f;
  }
  template <class Scalar>
  Mat<Scalar, 4, 4> process_noise(Scalar dt_s) const noexcept {
    return dt_s * Mat<Scalar, 4, 4>::Identity();
  }
};

int main() {
  const wakeline::Ekf filter{Drifting{}};
  return filter.started() ? 1 : 0;
}
