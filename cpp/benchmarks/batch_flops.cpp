// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "batch_works.hpp"
#include "hand_lanes.hpp"

namespace wakeline::bench {
namespace {

/// Of the second step: the first one computes F and Q, too.
template <class Estimator, class Sensor>
FlopCount counted(Estimator estimator, const Sensor& sensor) {
  const LaneCourse<Counted> course;
  (void)estimator.start(course.start);
  (void)take(estimator, sensor, course.plots(sensor)[0]);
  Counted::count = {};
  (void)take(estimator, sensor, course.plots(sensor)[1]);
  (void)estimator.estimate();
  return Counted::count;
}

template <class Hand>
FlopCount counted_by_hand() {
  const LaneCourse<Counted> course;
  Hand hand(course.start);
  Counted::count = {};
  hand.step(course.position[0]);
  return Counted::count;
}

}  // namespace

FlopCount arithmetic_of(Work work) {
  switch (work) {
    case Work::kImm3:
      return counted(imm<3, Counted>(), kFix);
    case Work::kImm5:
      return counted(imm<5, Counted>(), kFix);
    case Work::kImm3Tuned:
      return counted_by_hand<TunedLanes<3, Counted>>();
    case Work::kImm5Tuned:
      return counted_by_hand<TunedLanes<5, Counted>>();
    case Work::kImm3Plain:
      return counted_by_hand<PlainLanes<3, Counted>>();
    case Work::kImm5Plain:
      return counted_by_hand<PlainLanes<5, Counted>>();
    case Work::kImm3Polar:
      return counted(imm<3, Counted>(), kRadar);
    case Work::kImm5Polar:
      return counted(imm<5, Counted>(), kRadar);
    case Work::kKalman:
      return counted(kalman<Counted>(), kFix);
    case Work::kPolarEkf:
      return counted(polar_ekf<Counted>(), kRadar);
    case Work::kUkf5:
      return counted(ukf<Counted>(), kRadar);
  }
  return {};
}

}  // namespace wakeline::bench
