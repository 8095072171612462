// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "batch_works.hpp"
#include "hand_lanes.hpp"

namespace wakeline::bench {
namespace {

/// Of the step after some: the first one computes F and Q, too.
template <class Estimator, class Sensor>
FlopCount counted(Estimator estimator, const Sensor& sensor, std::size_t after = 1) {
  const LaneCourse<Counted> course;
  (void)estimator.start(course.start);
  for (std::size_t scan = 0; scan < after; ++scan)
    (void)take(estimator, sensor, course.plots(sensor)[scan]);
  Counted::count = {};
  (void)take(estimator, sensor, course.plots(sensor)[after]);
  (void)estimator.estimate();
  return Counted::count;
}

constexpr std::size_t kAllPlots = 20;  ///< scans until a line goes through as many as it may

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
    case Work::kFuzzy:
      return counted(FuzzyAlphaBeta<Counted>(), kFix, kAllPlots);
    case Work::kBayesian:
      return counted(BayesianAlphaBeta<Counted>(), kFix, kAllPlots);
  }
  return {};
}

}  // namespace wakeline::bench
