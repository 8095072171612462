// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/bad_input_laws.hpp"
#include "wakeline/measurement/position.hpp"

namespace wakeline::bad_input_test {
namespace {

INSTANTIATE_TYPED_TEST_SUITE_P(Double, BadInput, test::EveryFilter, );

/// A transform that asks for less than the covariance of its points: beta below alpha², points
/// close together.
TEST(UkfOfNegativeCovariance, IsRejectedAndLeavesTheBelief) {
  Ukf ukf{CoordinatedTurnRate{}, Unscented{.alpha = 1.0, .beta = 0.0, .kappa = -4.5}};
  Gaussian<5> belief;
  belief.mean << 0, 20, 0, 0, 0;
  belief.covariance = Vec<double, 5>(1, 1, 1, 1, 0.3).asDiagonal();
  ASSERT_EQ(ukf.start(belief), Status::kOk);
  EXPECT_EQ(ukf.predict(10.0), Status::kNotPositiveDefinite);
  EXPECT_TRUE(test::beliefs_identical<5>(ukf.estimate(), belief));
  EXPECT_EQ(ukf.predict(0.1), Status::kOk);
}

/// Of readings in lanes, one is good, one of a negative variance and one of none that is a number.
template <template <class, class> class Filter>
void expect_each_lane_to_report_its_status() {
  using Lanes = Pack<float, 4>;
  Filter<ConstantVelocity, Lanes> filter(ConstantVelocity{});
  Gaussian<4, Lanes> belief;
  ASSERT_TRUE(all(ok(filter.start(belief))));
  Gaussian<2, Lanes> reading;
  reading.covariance(0, 0).set(1, -100.0f);
  reading.covariance(0, 0).set(2, std::numeric_limits<float>::quiet_NaN());
  const auto found = filter.correct(Position{}, reading);
  const Status wanted[] = {Status::kOk, Status::kNotPositiveDefinite, Status::kNotFinite,
                           Status::kOk};
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(lane(found.status, k), wanted[k]) << "lane " << k;
    EXPECT_EQ(std::isnan(lane(found.nis, k)), wanted[k] != Status::kOk) << "lane " << k;
  }
}

TEST(EkfInLanes, EachLaneReportsItsStatus) { expect_each_lane_to_report_its_status<Ekf>(); }
TEST(UkfInLanes, EachLaneReportsItsStatus) { expect_each_lane_to_report_its_status<Ukf>(); }

}  // namespace
}  // namespace wakeline::bad_input_test
