// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/bad_input_laws.hpp"

namespace wakeline {
namespace {

INSTANTIATE_TYPED_TEST_SUITE_P(Double, BadInput, test::EveryFilter, );

/// A transform that asks for less than the covariance of its points: beta below alpha², points
/// close together.
TEST(UkfOfNegativeCovariance, IsRefusedAndLeavesTheBelief) {
  Ukf ukf{CoordinatedTurnRate{}, Unscented{.alpha = 1.0, .beta = 0.0, .kappa = -4.5}};
  Gaussian<5> belief;
  belief.mean << 0, 20, 0, 0, 0;
  belief.covariance = Vec<double, 5>(1, 1, 1, 1, 0.3).asDiagonal();
  ASSERT_EQ(ukf.start(belief), Status::kOk);
  EXPECT_EQ(ukf.predict(10.0), Status::kNotPositiveDefinite);
  EXPECT_TRUE(test::beliefs_identical<5>(ukf.estimate(), belief));
  EXPECT_EQ(ukf.predict(0.1), Status::kOk);
}

}  // namespace
}  // namespace wakeline
