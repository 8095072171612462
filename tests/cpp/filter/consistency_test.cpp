// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The errors of a filter are those its covariance claims: NEES and NIS over independent runs, within the chi-square
// bounds that a consistent filter meets 999 times in 1000.
#include "filter/cases.hpp"
#include "wakeline/eval/consistency.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"

namespace wakeline {
namespace {

constexpr double kConfidence = 0.999;

/// Runs `filter` on truths drawn from its own model; a fifth of the scans is missed. NEES of the last scan and NIS of the
/// last plot of each run.
template <class Filter, class Sensor>
void expect_consistent(const Filter& prototype, const Sensor& sensor,
                       const Gaussian<Filter::kStates>& start, int runs, int scans, double dt) {
  constexpr int N = Filter::kStates;
  ConsistencyAverage nees_average(N), nis_average(Sensor::kMeasurements);
  for (int run = 0; run < runs; ++run) {
    test::Draw draw(std::uint64_t(1000 + run));
    Vec<double, N> truth = draw.of(start);
    Filter filter = prototype;
    ASSERT_EQ(filter.start(start), Status::kOk);
    double nis = 0.0;
    for (int scan = 0; scan < scans; ++scan) {
      const auto& motion = filter.motion();
      truth = (transition(motion, truth, dt) + draw.error(process_noise(motion, truth, dt))).eval();
      ASSERT_EQ(filter.predict(dt), Status::kOk);
      if (scan % 5 == 2) continue;
      constexpr auto kRows = rows_read<Sensor>(Filter::kComponents);
      Vec<double, kReadsOf<Sensor>> read;
      for (int k = 0; k < read.size(); ++k) read[k] = truth[kRows[k]];
      const Vec<double, Sensor::kMeasurements> exact = sensor.measure(read);
      const auto step = filter.update(sensor, Vec<double, Sensor::kMeasurements>(exact + draw.error(sensor.observe(exact).covariance)));
      ASSERT_TRUE(step);
      nis = step.nis;
    }
    const auto belief = filter.estimate();
    nees_average.add(nees<N, double>(belief.mean - truth, belief.covariance));
    nis_average.add(nis);
  }
  const auto nees_bounds = nees_average.bounds(kConfidence), nis_bounds = nis_average.bounds(kConfidence);
  EXPECT_TRUE(nees_bounds.contains(nees_average.average()))
      << "NEES " << nees_average.average() << ", wanted " << nees_bounds.lower << " .. " << nees_bounds.upper;
  EXPECT_TRUE(nis_bounds.contains(nis_average.average()))
      << "NIS " << nis_average.average() << ", wanted " << nis_bounds.lower << " .. " << nis_bounds.upper;
}

template <int N>
Gaussian<N> lifted(const auto& motion) {
  return lift(motion, test::five_km_off<double>());
}

TEST(Consistency, LinearMotionAndSensor) {
  const Position sensor{.position_std_m = 20};
  const ConstantVelocity straight{.noise = WhiteAcceleration{0.1}};
  const CoordinatedTurn turning{.turn_rate_rad_s = 0.05, .noise = PiecewiseAcceleration{0.1}};
  expect_consistent(Kalman{straight}, sensor, lifted<4>(straight), 400, 20, 2.5);
  expect_consistent(Ekf{turning}, sensor, lifted<4>(turning), 400, 20, 2.5);
  const ConstantAcceleration accelerating{.noise = WhiteJerk{1e-3}, .prior_accel_std_mps2 = 0.3};
  expect_consistent(Ukf{accelerating}, sensor, lifted<6>(accelerating), 400, 20, 2.5);
  const Singer singer{.maneuver_time_s = 15, .accel_std_mps2 = 0.3};
  expect_consistent(SquareRootUkf{singer}, sensor, lifted<6>(singer), 400, 20, 2.5);
}

// 5 km at half a degree: 44 m across, curved by 0.2 m.
TEST(Consistency, PolarPlotsOfAFarVessel) {
  const RangeBearing radar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
  const ConstantVelocity motion{.noise = WhiteAcceleration{0.1}};
  expect_consistent(Ekf{motion}, radar, lifted<4>(motion), 400, 20, 2.5);
  expect_consistent(Ukf{motion}, radar, lifted<4>(motion), 400, 20, 2.5);
  expect_consistent(SquareRootUkf{motion}, radar, lifted<4>(motion), 400, 20, 2.5);
}

TEST(Consistency, TurnRateInTheState) {
  const RangeBearing radar{.range_std_m = 15, .bearing_std_rad = deg(0.3)};
  const CoordinatedTurnRate motion{.noise = WhiteAcceleration{0.02}, .turn_rate_psd_rad2s3 = 2e-5, .prior_turn_rate_std_rad_s = deg(1)};
  expect_consistent(Ekf{motion}, radar, lifted<5>(motion), 400, 30, 2.5);
  expect_consistent(Ukf{motion}, radar, lifted<5>(motion), 400, 30, 2.5);
  expect_consistent(SquareRootUkf{motion}, radar, lifted<5>(motion), 400, 30, 2.5);
}

TEST(Consistency, DopplerFromAMovingShip) {
  const RangeBearingDoppler radar{.range_std_m = 15, .bearing_std_rad = deg(0.5), .range_rate_std_mps = 0.3,
                                  .own = {.north_m = 100, .east_m = -200, .vnorth_mps = 8, .veast_mps = -3}};
  const ConstantVelocity motion{.noise = WhiteAcceleration{0.05}};
  expect_consistent(Ekf{motion}, radar, lifted<4>(motion), 400, 20, 2.5);
  expect_consistent(Ukf{motion}, radar, lifted<4>(motion), 400, 20, 2.5);
}

}  // namespace
}  // namespace wakeline
