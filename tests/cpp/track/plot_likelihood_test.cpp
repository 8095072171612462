// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/plot_likelihood.hpp"

#include <gtest/gtest.h>

#include "support/draw.hpp"
#include "track/stages.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline::plot_likelihood_test {
namespace {

using namespace test;

TEST(CandidatePlots, AreTheLikeliestBestFirst) {
  Draw draw(1);
  std::vector<double> likelihood;
  CandidatePlots candidates;
  for (int k = 0; k < 30; ++k) {
    likelihood.push_back(draw.uniform(0.0, 1.0));
    candidates.add(candidate(k, likelihood.back(), 1e-6));
  }
  std::sort(likelihood.rbegin(), likelihood.rend());
  ASSERT_EQ(candidates.size(), CandidatePlots::kMost);
  for (std::size_t k = 0; k < candidates.size(); ++k)
    EXPECT_EQ(candidates[k].likelihood, likelihood[k]);
  EXPECT_FALSE(candidates.admits(likelihood[CandidatePlots::kMost - 1]));
  EXPECT_TRUE(candidates.admits(likelihood[CandidatePlots::kMost - 2]));
}

TEST(PlotLikelihood, IsADensityOverThePlane) {
  VesselImm imm = vessel_imm(kStageRadar);
  const Track at = track_at(0, {0.0, 5.0, 0.0, -3.0}, {8.0, 3.0, 8.0, 3.0});
  ASSERT_EQ(imm.start(at.kinematics), Status::kOk);
  ASSERT_EQ(imm.predict(2.5), Status::kOk);
  ModePositions modes;
  modes.read(imm);
  ValidatedPlot plot{};
  plot.nominal_r = 64.0 * Mat<double, 2, 2>::Identity();
  plot.outlier_r = 16.0 * plot.nominal_r;
  for (const double outlier_probability : {0.0, 0.2}) {
    constexpr double kStep_m = 4.0;
    double integral = 0.0;
    for (double n = -400.0; n < 400.0; n += kStep_m)
      for (double e = -400.0; e < 400.0; e += kStep_m) {
        plot.z = {n, e};
        integral += plot_likelihood(plot, modes, outlier_probability) * kStep_m * kStep_m;
      }
    EXPECT_NEAR(integral, 1.0, 1e-3) << outlier_probability;
  }
}

TEST(InnovationSquared, IsOneWithinOneStandardDeviationAlongAnAxis) {
  const Track track = track_at(0, {10.0, 0.0, 20.0, 0.0}, {3.0, 1.0, 4.0, 1.0});
  const Mat<double, 2, 2> r = 16.0 * Mat<double, 2, 2>::Identity();
  EXPECT_NEAR(innovation_squared(track.kinematics, {15.0, 20.0}, r), 1.0, 1e-12);
  EXPECT_NEAR(innovation_squared(track.kinematics, {10.0, 20.0 + 2.0 * std::sqrt(32.0)}, r), 4.0,
              1e-12);
}

}  // namespace
}  // namespace wakeline::plot_likelihood_test
