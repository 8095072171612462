// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A sensor whose jacobian has a row for what it reads, not for what it measures.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"

struct SpeedLog {
  static constexpr int kMeasurements = 1;
#ifdef WAKELINE_COMPILE_FAIL
  static constexpr std::array kReads{wakeline::Component::kVnorth, wakeline::Component::kVeast};
#else
  static constexpr std::array kReads{wakeline::Component::kVnorth};
#endif
  static constexpr int kRead = static_cast<int>(kReads.size());

  template <class Scalar>
  wakeline::Gaussian<1, Scalar> observe(const wakeline::Vec<Scalar, 1>& z) const noexcept {
    return {z, wakeline::Mat<Scalar, 1, 1>::Identity()};
  }
  template <class Scalar>
  wakeline::Vec<Scalar, 1> measure(const wakeline::Vec<Scalar, kRead>& velocity) const noexcept {
    return wakeline::Vec<Scalar, 1>(velocity[0]);
  }
  template <class Scalar>
  wakeline::Mat<Scalar, kRead, 1> jacobian(const wakeline::Vec<Scalar, kRead>&) const noexcept {
    return wakeline::Mat<Scalar, kRead, 1>::Identity();
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
