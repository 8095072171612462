// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// An Imm on truths drawn from its own models and chain claims about the errors that it makes. It is
// not exact (it keeps one Gaussian a mode), so the band is wider than chi-square's.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/draw.hpp"
#include "wakeline/eval/consistency.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::imm_consistency_test {
namespace {

TEST(ImmConsistency, NeesAndModesOnItsOwnModel) {
  const RangeBearing radar{.range_std_m = 15, .bearing_std_rad = deg(0.3)};
  const auto chain = ModeChain<3>::from_sojourn_s({60.0, 40.0, 40.0});
  const CoordinatedTurn motions[] = {
      {.turn_rate_rad_s = 0.0, .noise = WhiteAcceleration{0.02}},
      {.turn_rate_rad_s = deg(3), .noise = WhiteAcceleration{0.02}},
      {.turn_rate_rad_s = deg(-3), .noise = WhiteAcceleration{0.02}}};
  Gaussian<4> start;
  start.mean << 3000, -6, 3000, 9;
  start.covariance = Vec<double, 4>(400, 4, 400, 4).asDiagonal();
  const double dt = 2.5;
  constexpr int kRuns = 500, kScans = 60;
  ConsistencyAverage nees_average(4);
  double claimed = 0.0,
         right = 0.0;  // the probability of the true mode, and how often the likeliest is true
  double likeliest_claims = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    test::Draw draw(std::uint64_t(5000 + run));
    int mode = std::min(2, static_cast<int>(draw.uniform(0, 3)));
    Vec<double, 4> truth = draw.of(start);
    Imm imm{chain, Ekf{motions[0]}, Ekf{motions[1]}, Ekf{motions[2]}};
    ASSERT_EQ(imm.start(start), Status::kOk);
    const auto p = chain.transition(dt);
    for (int scan = 0; scan < kScans; ++scan) {
      double u = draw.uniform(0, 1);
      int next = 0;
      while (next < 2 && u >= p(mode, next)) u -= p(mode, next++);
      mode = next;
      const CoordinatedTurn& motion = motions[mode];
      truth = (motion.matrix(dt) * truth + draw.error(motion.process_noise(dt))).eval();
      ASSERT_EQ(imm.predict(dt), Status::kOk);
      if (scan % 5 == 2) continue;
      const Vec<double, 2> exact = radar.measure(Vec<double, 2>(truth[0], truth[2]));
      ASSERT_TRUE(
          imm.update(radar, Vec<double, 2>(exact + draw.error(radar.observe(exact).covariance))));
    }
    const auto belief = imm.estimate();
    nees_average.add(nees<4, double>(belief.mean - truth, belief.covariance));
    Eigen::Index likeliest = 0;
    likeliest_claims += imm.mode_probability().maxCoeff(&likeliest) / kRuns;
    right += (likeliest == mode) / double(kRuns);
    claimed += imm.mode_probability()[mode] / kRuns;
  }
  EXPECT_GT(nees_average.average(), 3.4);
  EXPECT_LT(nees_average.average(), 4.6);
  // A forecast that says p is right p of the time: within four standard errors.
  EXPECT_NEAR(right, likeliest_claims, 4 * std::sqrt(0.25 / kRuns));
  EXPECT_GT(claimed, 0.5) << "and it knows the mode better than a guess of a third";
}

}  // namespace
}  // namespace wakeline::imm_consistency_test
