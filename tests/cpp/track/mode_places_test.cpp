// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/mode_places.hpp"

#include <gtest/gtest.h>

#include <random>

#include "wakeline/measurement/fix.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline {
namespace {

TEST(ModePlaces, AgreeWithTheEstimator) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const double threshold = 6.0;
  int inside = 0;
  for (int trial = 0; trial < 200; ++trial) {
    VesselImm imm = vessel_imm(Radar{});
    Gaussian<4> start{{100.0, 8.0 * normal(random), -50.0, 8.0 * normal(random)},
                      Mat<double, 4, 4>::Identity()};
    start.covariance.diagonal() << 90.0, 9.0, 400.0, 4.0;
    ASSERT_EQ(imm.start(start), Status::kOk);
    ASSERT_EQ(imm.predict(3.0 + trial % 20), Status::kOk);
    ModePlaces places;
    places.take(imm);
    for (int k = 0; k < 20; ++k) {
      const auto belief = kinematics_of(imm.estimate());
      const Vec<double, 2> z(belief.mean[0] + 100.0 * normal(random),
                             belief.mean[2] + 100.0 * normal(random));
      Fix fix;
      fix.covariance_m2 << 400.0, 120.0, 120.0, 90.0;
      const Evidence<double> evidence = places.evidence(z, fix.covariance_m2);
      const Evidence<double> wanted = imm.evidence(fix, z);
      EXPECT_NEAR(evidence.least_nis, wanted.least_nis, 1e-12 * (1.0 + wanted.least_nis));
      EXPECT_NEAR(evidence.likelihood, wanted.likelihood, 1e-11 * wanted.likelihood + 1e-300);
      const bool gated = wanted.least_nis <= threshold;
      EXPECT_EQ(places.may_own(z, fix.covariance_m2, threshold), gated);
      const double off_m =
          (z - Vec<double, 2>(belief.mean[0], belief.mean[2])).cwiseAbs().maxCoeff();
      if (gated) {
        EXPECT_LE(off_m, places.reach_m({belief.mean[0], belief.mean[2]}, 400.0, threshold));
      }
      inside += gated;
    }
  }
  EXPECT_GT(inside, 400);
  EXPECT_LT(inside, 3600);
}

TEST(ModePlaces, OfAnEstimatorWithoutModesAnythingMayBe) {
  struct {
  } estimator;
  ModePlaces places;
  places.take(estimator);
  EXPECT_FALSE(places.known());
  EXPECT_TRUE(places.may_own({1e9, 1e9}, Mat<double, 2, 2>::Identity(), 6.0));
  EXPECT_EQ(places.reach_m({0.0, 0.0}, 1.0, 6.0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace wakeline
