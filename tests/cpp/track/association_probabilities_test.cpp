// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/association_probabilities.hpp"

#include <gtest/gtest.h>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "track/stages.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline::association_probabilities_test {
namespace {

using namespace test;

VesselImm started() {
  VesselImm imm = vessel_imm(kStageRadar);
  const Track at = track_at(0, {100.0, 5.0, 0.0, -3.0}, {8.0, 3.0, 8.0, 3.0});
  EXPECT_EQ(imm.start(at.kinematics), Status::kOk);
  EXPECT_EQ(imm.predict(2.5), Status::kOk);
  return imm;
}

CandidatePlot plot_near(int plot, double north_m, double east_m) {
  CandidatePlot near = candidate(plot, 1e-3, 1e-6);
  near.z = {north_m, east_m};
  near.nominal_r = 64.0 * Mat<double, 2, 2>::Identity();
  near.outlier_r = 16.0 * near.nominal_r;
  return near;
}

TEST(AssociationProbabilities, SumToOneWithThatOfNoPlot) {
  Draw draw(1);
  for (int trial = 0; trial < 50; ++trial) {
    VesselImm imm = started();
    CandidatePlots candidates;
    for (int k = 0; k <= trial % 8; ++k)
      candidates.add(plot_near(k, 112.0 + 20.0 * draw.normal(), -7.0 + 20.0 * draw.normal()));
    AssociationWeights weights{.none = 0.3};
    for (std::size_t k = 0; k < candidates.size(); ++k) weights.plot[k] = draw.uniform(1e2, 1e4);
    TrackReadings readings;
    readings.list(candidates, weights, 0.2);
    const double total = imm.update<Fix>(readings.fixes(), weights.none, readings.share());
    const AssociationProbabilities probabilities = readings.probabilities();
    EXPECT_NEAR(probabilities.any + weights.none / total, 1.0, 1e-12);
    double sum = 0.0;
    for (const double probability : probabilities.of_candidate) {
      EXPECT_GE(probability, 0.0);
      sum += probability;
    }
    EXPECT_NEAR(sum, probabilities.any, 1e-12);
    ASSERT_GE(probabilities.best, 0);
    for (const double probability : probabilities.of_candidate)
      EXPECT_LE(probability, probabilities.of_candidate[std::size_t(probabilities.best)]);
  }
}

TEST(AssociationProbabilities, OnePlotThatMustBeTheTargetsIsTheUpdateOfTheFilter) {
  VesselImm associated = started(), filtered = started();
  const CandidatePlots candidates = candidates_of({plot_near(0, 118.0, -2.0)});
  AssociationWeights weights{.none = 0.0, .assigned = true};
  weights.plot[0] = 5e3;
  TrackReadings readings;
  readings.list(candidates, weights, 0.0);
  EXPECT_GT(associated.update<Fix>(readings.fixes(), 0.0, readings.share()), 0.0);
  EXPECT_TRUE(filtered.update(Fix{candidates[0].nominal_r}, candidates[0].z));
  EXPECT_NEAR(readings.probabilities().of_candidate[0], 1.0, 1e-12);
  EXPECT_TRUE(matrices_near(kinematics_of(associated.estimate()).mean,
                            kinematics_of(filtered.estimate()).mean,
                            {.absolute = 1e-9, .relative = 1e-9}));
  EXPECT_TRUE(matrices_near(kinematics_of(associated.estimate()).covariance,
                            kinematics_of(filtered.estimate()).covariance,
                            {.absolute = 1e-8, .relative = 1e-8}));
}

TEST(TrackReadings, AreOfTheHypothesesOnly) {
  const CandidatePlots candidates =
      candidates_of({candidate(0, 3e-3, 1e-6), candidate(1, 2e-3, 1e-6)});
  AssociationWeights weights{.none = 0.0, .assigned = true};
  weights.plot[1] = 1e3;  // the second was assigned
  TrackReadings readings;
  readings.list(candidates, weights, 0.2);
  ASSERT_EQ(readings.fixes().size(), 2u);
  EXPECT_DOUBLE_EQ(readings.fixes()[0].weight, 0.8e3);
  EXPECT_DOUBLE_EQ(readings.fixes()[1].weight, 0.2e3);
  readings.share()[0] = 0.6;
  readings.share()[1] = 0.4;
  const AssociationProbabilities probabilities = readings.probabilities();
  EXPECT_EQ(probabilities.best, 1);
  EXPECT_EQ(probabilities.of_candidate[0], 0.0);
  EXPECT_EQ(probabilities.of_candidate[1], 1.0);

  readings.list(candidates, AssociationWeights{}, 0.2);
  EXPECT_TRUE(readings.empty());
  EXPECT_EQ(readings.probabilities().best, -1);
  EXPECT_EQ(readings.probabilities().any, 0.0);
}

}  // namespace
}  // namespace wakeline::association_probabilities_test
