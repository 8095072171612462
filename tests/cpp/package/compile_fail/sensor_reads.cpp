// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A sensor that does not say which components of the state it reads.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"

struct SpeedLog {
  static constexpr int kMeasurements = 1;
#ifndef WAKELINE_COMPILE_FAIL
  static constexpr std::array kReads{wakeline::Component::kVnorth};
#endif

  template <class Scalar>
  wakeline::Gaussian<1, Scalar> observe(const wakeline::Vec<Scalar, 1>& z) const noexcept {
    return {z, wakeline::Mat<Scalar, 1, 1>::Identity()};
  }
  template <class Scalar>
  wakeline::Vec<Scalar, 1> measure(const wakeline::Vec<Scalar, 1>& velocity) const noexcept {
    return velocity;
  }
  template <class Scalar>
  wakeline::Mat<Scalar, 1, 1> jacobian(const wakeline::Vec<Scalar, 1>&) const noexcept {
    return wakeline::Mat<Scalar, 1, 1>::Identity();
  }
  template <class Scalar>
  wakeline::Vec<Scalar, 1> residual(const wakeline::Vec<Scalar, 1>& a,
                                    const wakeline::Vec<Scalar, 1>& b) const noexcept {
    return a - b;
  }
};

int main() {
  wakeline::Ekf ekf{wakeline::ConstantVelocity{}};
  return ekf.update(SpeedLog{}, wakeline::Vec<double, 1>(1.0)) ? 1 : 0;
}
