// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Recordings that are smoothed by themselves, over pauses of any length.
#include "wakeline/batch/run_smoothed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "support/draw.hpp"
#include "support/run_results.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/motion/coordinated_turn.hpp"

namespace wakeline::run_smoothed_test {
namespace {

using Filter = Ekf<CoordinatedTurn>;
using Bank = FilterBank<Filter, Filter>;

constexpr std::size_t kScans = 20, kPause = 12;
constexpr Position kSensor{.position_std_m = 30.0};

Imm<Bank> started() {
  const auto turning = [](double rate_deg_s) {
    return Filter{
        CoordinatedTurn{.turn_rate_rad_s = deg(rate_deg_s), .noise = PiecewiseAcceleration{0.05}}};
  };
  Imm<Bank> imm{ModeChain<2>::staying(0.9), turning(0.0), turning(2.0)};
  Gaussian<4> start;
  start.mean << 0, 8, 0, 3;
  start.covariance = Vec<double, 4>(900, 4, 900, 4).asDiagonal();
  EXPECT_EQ(imm.start(start), Status::kOk);
  return imm;
}

/// Plots three seconds apart, but for a pause before one of them, and what is known of the scans.
struct Smoothed {
  test::RunResults results;
  Status status;
};

Smoothed smoothed(std::size_t scans, double pause_s) {
  std::vector<double> z, dt_s(scans, 3.0);
  test::Draw draw(15);
  for (std::size_t k = 0; k < scans; ++k) {
    z.push_back(24.0 * double(k) + 30.0 * draw.normal());
    z.push_back(9.0 * double(k) + 30.0 * draw.normal());
  }
  if (scans > kPause) dt_s[kPause] = pause_s;
  const RunInput in{.runs = 1, .scans = scans, .z = z.data(), .dt_s = dt_s.data()};
  Smoothed all{test::RunResults(in, 4, 2), Status::kOk};
  all.status = run_smoothed(started(), kSensor, in, 0, all.results.out());
  return all;
}

TEST(RunSmoothed, BeforeAPauseOverWhichNothingGoesBackIsSmoothedByItself) {
  const std::vector<double> before = smoothed(kPause, 3.0).results.mean;
  int by_itself = 0;
  for (double pause_s = 3.0; pause_s < kLargestInput; pause_s *= 3.0) {
    const auto [results, status] = smoothed(kScans, pause_s);
    ASSERT_EQ(status, Status::kOk) << pause_s;
    by_itself += std::equal(before.begin(), before.end(), results.mean.begin());
    for (const double number : results.mean) EXPECT_TRUE(std::isfinite(number)) << pause_s;
  }
  EXPECT_GT(by_itself, 0);
}

TEST(RunSmoothed, ReportsAnInvalidStep) {
  EXPECT_EQ(smoothed(kScans, -1.0).status, Status::kNegativeTimeStep);
}

}  // namespace
}  // namespace wakeline::run_smoothed_test
