// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A rate gyro on a vessel whose state holds no turn rate.
#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"

struct Gyro {
  static constexpr int kMeasurements = 1;
  static constexpr std::array kReads{wakeline::Component::kTurnRate};

  template <class Scalar>
  wakeline::Gaussian<1, Scalar> observe(const wakeline::Vec<Scalar, 1>& z) const noexcept {
    return {z, wakeline::Mat<Scalar, 1, 1>::Identity()};
  }
  template <class Scalar>
  wakeline::Vec<Scalar, 1> measure(const wakeline::Vec<Scalar, 1>& turn_rate) const noexcept {
    return turn_rate;
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

#ifdef WAKELINE_COMPILE_FAIL
using Motion = wakeline::ConstantVelocity;
#else
using Motion = wakeline::CoordinatedTurnRate;
#endif

int main() {
  wakeline::Ekf filter{Motion{}};
  return filter.update(Gyro{}, wakeline::Vec<double, 1>(0.1)) ? 1 : 0;
}
