// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

// The errors of a filter are those its covariance claims: NEES and NIS over independent runs,
// within the chi-square bounds that a consistent filter meets 999 times in 1000.
#include "filter/cases.hpp"
#include "wakeline/eval/consistency.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"

namespace wakeline::test {

inline constexpr double kConfidence = 0.999;

/// Runs `filter` on truths drawn from its own model; a fifth of the scans is missed. NEES of the
/// last scan and NIS of the last plot of each run.
template <class Filter, class Sensor>
void expect_consistent(const Filter& prototype, const Sensor& sensor,
                       const Gaussian<Filter::kStates>& start, int runs, int scans, double dt) {
  constexpr int N = Filter::kStates;
  ConsistencyAverage nees_average(N), nis_average(Sensor::kMeasurements);
  for (int run = 0; run < runs; ++run) {
    Draw draw(std::uint64_t(1000 + run));
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
      const auto step = filter.update(
          sensor,
          Vec<double, Sensor::kMeasurements>(exact + draw.error(sensor.observe(exact).covariance)));
      ASSERT_TRUE(step);
      nis = step.nis;
    }
    const auto belief = filter.estimate();
    nees_average.add(nees<N, double>(belief.mean - truth, belief.covariance));
    nis_average.add(nis);
  }
  const auto nees_bounds = nees_average.bounds(kConfidence),
             nis_bounds = nis_average.bounds(kConfidence);
  EXPECT_TRUE(nees_bounds.contains(nees_average.average()))
      << "NEES " << nees_average.average() << ", wanted " << nees_bounds.lower << " .. "
      << nees_bounds.upper;
  EXPECT_TRUE(nis_bounds.contains(nis_average.average()))
      << "NIS " << nis_average.average() << ", wanted " << nis_bounds.lower << " .. "
      << nis_bounds.upper;
}

template <int N>
Gaussian<N> lifted(const auto& motion) {
  return lift(motion, five_km_off<double>());
}

}  // namespace wakeline::test
