// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/mode_positions.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <random>

#include "wakeline/track/vessel_models.hpp"

namespace wakeline::mode_positions_test {
namespace {

/// The likelihood and the least distance of a fix by asking each mode in turn.
template <class Estimator>
Evidence<double> mode_by_mode(const Estimator& estimator, const Vec<double, 2>& z,
                              const Mat<double, 2, 2>& r) {
  Evidence<double> evidence;
  estimator.for_each_mode([&](int mode, const auto& belief) {
    const Gaussian<2> position = position_of(belief);
    const Mat<double, 2, 2> s = position.covariance + r;
    const Vec<double, 2> d = z - position.mean;
    const double nis = d.dot(s.inverse() * d);
    evidence.likelihood += estimator.mode_probability()[mode] * std::exp(-nis / 2) /
                           (2.0 * 3.14159265358979324 * std::sqrt(s.determinant()));
    evidence.least_nis = std::min(evidence.least_nis, nis);
  });
  return evidence;
}

TEST(ModePositions, AreTheMixtureOfTheModes) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const double threshold = 6.0;
  int inside = 0, excluded = 0;
  for (int trial = 0; trial < 200; ++trial) {
    VesselImm::All imm = vessel_imm(Radar{}).all();
    Gaussian<4> start{{100.0, 8.0 * normal(random), -50.0, 8.0 * normal(random)},
                      Mat<double, 4, 4>::Identity()};
    start.covariance.diagonal() << 90.0, 9.0, 400.0, 4.0;
    ASSERT_EQ(imm.start(start), Status::kOk);
    ASSERT_EQ(imm.predict(3.0 + trial % 20), Status::kOk);
    ModePositions modes;
    modes.read(imm);
    const auto belief = kinematics_of(imm.estimate());
    const Vec<double, 2> position(belief.mean[0], belief.mean[2]);
    for (int k = 0; k < 20; ++k) {
      const Vec<double, 2> z = position + 100.0 * Vec<double, 2>(normal(random), normal(random));
      Mat<double, 2, 2> r;
      r << 400.0, 120.0, 120.0, 90.0;
      const Evidence<double> evidence = modes.evidence(z, r);
      const Evidence<double> expected = mode_by_mode(imm, z, r);
      EXPECT_NEAR(evidence.least_nis, expected.least_nis, 1e-11 * (1.0 + expected.least_nis));
      EXPECT_NEAR(evidence.likelihood, expected.likelihood, 1e-10 * expected.likelihood + 1e-300);
      const bool gated = expected.least_nis <= threshold;
      EXPECT_EQ(modes.gate(z, r, threshold), gated);
      if (gated) {
        EXPECT_LE((z - position).cwiseAbs().maxCoeff(),
                  modes.about(position).reach_m(400.0, threshold));
      }
      const bool is_excluded = modes.along(z - position, position).excludes(z, r, threshold);
      EXPECT_FALSE(gated && is_excluded);
      excluded += is_excluded;
      inside += gated;
    }
  }
  EXPECT_GT(inside, 400);
  EXPECT_LT(inside, 3600);
  EXPECT_GT(excluded, 100);
}

TEST(ModePositions, NothingThatIsNotFiniteIsInside) {
  VesselImm::All imm = vessel_imm(Radar{}).all();
  ASSERT_EQ(imm.start(Gaussian<4>{Vec<double, 4>::Zero(), Mat<double, 4, 4>::Identity()}),
            Status::kOk);
  ModePositions modes;
  modes.read(imm);
  const Mat<double, 2, 2> r = Mat<double, 2, 2>::Identity();
  EXPECT_TRUE(modes.gate({0.0, 0.0}, r, 6.0));
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_FALSE(modes.gate({bad, 0.0}, r, 6.0));
    EXPECT_FALSE(modes.gate({0.0, 0.0}, bad * r, 6.0));
  }
}

/// An estimator that does not show its modes.
struct Closed {
  [[nodiscard]] Evidence<double> evidence(const Fix& fix, const Vec<double, 2>& z) const noexcept {
    return {.likelihood = fix.covariance_m2(0, 0), .least_nis = z[0]};
  }
};

TEST(ModePositions, AskAnEstimatorThatDoesNotShowItsModes) {
  const Closed closed;
  ModePositions modes;
  modes.read(closed);
  const Mat<double, 2, 2> r = 7.0 * Mat<double, 2, 2>::Identity();
  EXPECT_EQ(modes.evidence({5.0, 0.0}, r).likelihood, 7.0);
  EXPECT_TRUE(modes.gate({5.0, 0.0}, r, 6.0));
  EXPECT_FALSE(modes.gate({6.1, 0.0}, r, 6.0));
  EXPECT_EQ(modes.about({0.0, 0.0}).reach_m(1.0, 6.0), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(modes.along({1.0, 0.0}, {0.0, 0.0}).excludes({1e6, 0.0}, r, 6.0));
}

}  // namespace
}  // namespace wakeline::mode_positions_test
