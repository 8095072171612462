// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Bearings and ranges without the other part of a position.
#include "wakeline/track/partial_scan.hpp"

#include <Eigen/LU>
#include <array>
#include <limits>

#include "support/malloc_fence.hpp"
#include "track/scene.hpp"

namespace wakeline::partial_test {
namespace {

using namespace test;

const Radar kRadar{.range_std_m = 10.0,
                   .bearing_std_rad = deg(1.0),
                   .extent_std_m = 2.0,
                   .period_s = 3.0,
                   .max_speed_mps = 20.0};

/// A sensor beside the radar, that has a value of each boat and some false ones, every second.
struct Sensor {
  PositionPart part;
  double std;
  double detection = 0.9;
  int false_values = 3;
  double late_s = 0.0;

  /// Its values at a time.
  std::vector<double> values(const std::vector<Boat>& boats, double time_s, Draw& draw) const {
    std::vector<double> found;
    for (const Boat& boat : boats) {
      if (draw.uniform(0.0, 1.0) > detection) continue;
      const Vec<double, 2> place = boat.at(time_s);
      found.push_back(
          (part == PositionPart::kRange ? place.norm() : std::atan2(place[1], place[0])) +
          std * draw.normal());
    }
    for (int k = 0; k < false_values; ++k)
      found.push_back(part == PositionPart::kRange ? draw.uniform(500.0, 6000.0)
                                                   : draw.uniform(-3.1, 3.1));
    return found;
  }
};

std::vector<Boat> boats() {
  return {{{3000.0, 500.0}, {-2.0, 5.0}},
          {{2500.0, -1500.0}, {3.0, 4.0}},
          {{-2000.0, 2500.0}, {5.0, 0.0}},
          {{-1500.0, -2500.0}, {0.0, -6.0}},
          {{400.0, 3500.0}, {-6.0, 1.0}}};
}

/// RMS position error of the tracks; every boat has one.
double rms_m(const std::vector<Sensor>& sensors, std::uint64_t seed) {
  VesselTracker tracker = make_tracker({}, kRadar);
  Sea sea(seed, kRadar);
  Draw draw(seed + 100);
  double sum_m2 = 0.0;
  int count = 0;
  for (int turn = 1; turn <= 60; ++turn) {
    std::vector<Plot> plots;
    for (const Boat& boat : boats())
      if (sea.draw.uniform(0.0, 1.0) < 0.9) plots.push_back(sea.swept(boat, 3.0 * (turn - 1)));
    EXPECT_EQ(tracker.process(3.0 * turn, plots).status, Status::kOk);
    for (int part = 0; part < 3; ++part)
      for (const Sensor& sensor : sensors) {
        const double time_s = 3.0 * turn + part - sensor.late_s;
        const std::vector<double> values = sensor.values(boats(), time_s, draw);
        EXPECT_EQ(tracker
                      .partial({sensor.part, 0, time_s, values, sensor.std,
                                sensor.part == PositionPart::kRange ? 1e-3 : 1.0})
                      .status,
                  Status::kOk);
      }
    if (turn < 20) continue;
    for (const Boat& boat : boats()) {
      const Track* track = track_at(tracker, boat.at(3.0 * turn), 150.0);
      EXPECT_NE(track, nullptr);
      if (track == nullptr) continue;
      const Gaussian<4> now = tracker.kinematics_at(*track, 3.0 * turn);
      sum_m2 += (Vec<double, 2>(now.mean[0], now.mean[2]) - boat.at(3.0 * turn)).squaredNorm();
      ++count;
    }
  }
  EXPECT_EQ(tracks_of(tracker, true).size(), boats().size()) << "they start none";
  return std::sqrt(sum_m2 / count);
}

TEST(Partial, PreciseBearingsMakePositionsBetter) {
  const Sensor camera{PositionPart::kBearing, deg(0.1)};
  EXPECT_LT(rms_m({camera}, 1), 0.6 * rms_m({}, 1));
}

TEST(Partial, PreciseRangesMakePositionsBetter) {
  const Sensor ranger{PositionPart::kRange, 1.0};
  EXPECT_LT(rms_m({ranger}, 2), 0.97 * rms_m({}, 2));
}

TEST(Partial, CoarseOrFalseValuesDoNoHarm) {
  const Sensor coarse{PositionPart::kBearing, deg(5.0), 0.5, 20};
  const Sensor blind{PositionPart::kBearing, deg(0.2), 0.0, 6};
  EXPECT_LT(rms_m({coarse}, 3), 1.02 * rms_m({}, 3));
  EXPECT_LT(rms_m({blind}, 3), 1.10 * rms_m({}, 3));
}

TEST(Partial, LateValuesAreOfTheirTime) {
  const Sensor late{.part = PositionPart::kBearing, .std = deg(0.1), .late_s = 2.0};
  EXPECT_LT(rms_m({late}, 4), 0.7 * rms_m({}, 4));
}

TEST(Partial, AFixHasTheLikelihoodOfItsValue) {
  Draw draw(5);
  for (int trial = 0; trial < 200; ++trial) {
    const Gaussian<2> place{{draw.uniform(500.0, 4000.0), draw.uniform(-4000.0, 4000.0)},
                            100.0 * draw.definite<2>()};
    for (const PositionPart part : {PositionPart::kBearing, PositionPart::kRange}) {
      const double std = part == PositionPart::kBearing ? deg(0.5) : 10.0;
      const PartialScan scan{.part = part, .std = std};
      const PartOfPosition of(scan, place, 3.0);
      const double expected = part == PositionPart::kBearing
                                  ? std::atan2(place.mean[1], place.mean[0])
                                  : place.mean.norm();
      const double value = expected + std * draw.normal();
      const Gaussian<2> fix = of.fix(value);
      const Mat<double, 2, 2> s = fix.covariance + place.covariance;
      const Vec<double, 2> d = fix.mean - place.mean;
      const double likelihood =
          std::exp(-0.5 * d.dot(s.inverse() * d)) / (2 * kPi<double> * std::sqrt(s.determinant()));
      EXPECT_NEAR(of.per_fix() * likelihood / of.likelihood(value), 1.0, 1e-3);
    }
  }
}

TEST(Partial, WhatMakesNoSenseIsRejectedAndNothingTakesMemory) {
  VesselTracker tracker = make_tracker({}, kRadar);
  Sea sea(6, kRadar);
  for (int turn = 1; turn <= 10; ++turn) {
    std::vector<Plot> plots;
    for (const Boat& boat : boats()) plots.push_back(sea.swept(boat, 3.0 * (turn - 1)));
    (void)tracker.process(3.0 * turn, plots);
  }
  const std::vector<std::byte> before = tracker.save();
  const std::vector<double> values{0.1, 0.2, std::numeric_limits<double>::quiet_NaN()};
  PartialScan scan{.time_s = 30.0, .values = values};
  scan.std = 0.0;
  EXPECT_EQ(tracker.partial(scan).status, Status::kNotFinite);
  scan.std = deg(1.0);
  scan.time_s = 1e4;
  EXPECT_EQ(tracker.partial(scan).status, Status::kNotFinite);
  scan.time_s = -1e4;
  EXPECT_EQ(tracker.partial(scan).status, Status::kNegativeTimeStep);
  EXPECT_EQ(tracker.save(), before);
  scan.time_s = 30.0;
  const NoHeap fence;
  const ScanReport report = tracker.partial(scan);
  EXPECT_EQ(report.plot_track_id[2], 0) << "a value that is not finite is of none";
  EXPECT_EQ(report.rejected_plots, 1);
  const std::array behind{-1.0};
  const PartialScan ranges{
      .part = PositionPart::kRange, .time_s = 30.0, .values = behind, .own = {.north_m = 1900.0}};
  EXPECT_EQ(tracker.partial(ranges).rejected_plots, 1);
  EXPECT_EQ(fence.allocations(), 0);
  expect_sound(tracker);
}

}  // namespace
}  // namespace wakeline::partial_test
