// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/long_run_laws.hpp"

namespace wakeline::long_run_test {
namespace {

INSTANTIATE_TYPED_TEST_SUITE_P(Double, LongRun, test::EveryFilter, );

/// The posterior after the gap, by the same equations in 80 bits.
Gaussian<4, long double> in_long_double(double precise) {
  Kalman<ConstantVelocity, long double> kalman{ConstantVelocity{}};
  Gaussian<4, long double> lost;
  lost.covariance *= 1e8L;
  EXPECT_EQ(kalman.start(lost), Status::kOk);
  EXPECT_EQ(kalman.predict(3600.0L), Status::kOk);
  EXPECT_TRUE(
      kalman.update(Position{.position_std_m = precise}, Vec<long double, 2>(30.0L, 40.0L)));
  return kalman.estimate();
}

template <class Filter>
void expect_posterior(double precise) {
  const Gaussian<4> expected = in_long_double(precise).cast<double>();
  Filter filter{ConstantVelocity{}};
  Gaussian<4> lost;
  lost.covariance *= 1e8;
  ASSERT_EQ(filter.start(lost), Status::kOk);
  ASSERT_EQ(filter.predict(3600.0), Status::kOk);
  ASSERT_TRUE(filter.update(Position{.position_std_m = precise}, Vec<double, 2>(30, 40)));
  EXPECT_LT(
      (test::covariance_difference<double, 4>(filter.estimate().covariance, expected.covariance)),
      1e-3)
      << precise;
}

TEST(Gap, PosteriorOfThePlotIsThatOfExactArithmetic) {
  for (const double precise : {100.0, 1.0, 0.01}) {
    expect_posterior<Kalman<ConstantVelocity>>(precise);
    expect_posterior<Ekf<ConstantVelocity>>(precise);
    expect_posterior<Ukf<ConstantVelocity>>(precise);
    expect_posterior<SquareRootUkf<ConstantVelocity>>(precise);
  }
}

}  // namespace
}  // namespace wakeline::long_run_test
