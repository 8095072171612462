// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

// Covariances stay covariances: over long unattended runs, and through the widest gaps.
#include "filter/cases.hpp"
#include "wakeline/measurement/position.hpp"

namespace wakeline {

template <class Filter>
class LongRun : public ::testing::Test {};
TYPED_TEST_SUITE_P(LongRun);

// Steps from nothing to a minute, plots from a millimetre to a kilometre, one in three missed.
TYPED_TEST_P(LongRun, CovarianceStaysPositiveDefinite) {
  using Scalar = typename TypeParam::Scalar;
  constexpr bool kSingle = sizeof(Scalar) == 4;
  test::Draw draw(41);
  TypeParam filter{typename TypeParam::Motion{}};
  ASSERT_EQ(filter.start(test::five_km_off<Scalar>()), Status::kOk);
  for (int step = 0; step < 10'000; ++step) {
    const double dt =
        draw.uniform(0, 1) < 0.1 ? 0.0 : std::pow(10.0, draw.uniform(-3, kSingle ? 1.0 : 1.8));
    ASSERT_EQ(filter.predict(Scalar(dt)), Status::kOk) << "step " << step;
    const auto predicted = filter.estimate().covariance;
    ASSERT_TRUE((test::is_covariance<Scalar, TypeParam::kStates>(predicted)))
        << "predicted, step " << step << "\n"
        << predicted;
    if (draw.uniform(0, 1) < 0.33) continue;
    const double range_std = std::pow(10.0, draw.uniform(kSingle ? 0 : -3, 3));
    const auto radar = test::radar_of<TypeParam>(range_std, std::min(range_std / 5000, 0.05));
    const Vec<Scalar, 2> z =
        test::plot_of<Scalar>(3000 + range_std * draw.normal(), 4000 + range_std * draw.normal());
    const auto result = filter.update(radar, z);
    ASSERT_EQ(result.status, Status::kOk) << "step " << step;
    ASSERT_TRUE(std::isfinite(result.nis) && result.nis >= 0);
    const auto posterior = filter.estimate().covariance;
    ASSERT_TRUE((test::is_covariance<Scalar, TypeParam::kStates>(posterior)))
        << "posterior, step " << step << "\n"
        << posterior;
  }
}

TYPED_TEST_P(LongRun, AnHourWithoutAPlotThenAPreciseOne) {
  using Scalar = typename TypeParam::Scalar;
  TypeParam filter{typename TypeParam::Motion{}};
  Gaussian<4, Scalar> lost = test::five_km_off<Scalar>();
  lost.covariance = Scalar(1e8) * Mat<Scalar, 4, 4>::Identity();
  ASSERT_EQ(filter.start(lost), Status::kOk);
  for (int hour = 0; hour < 3; ++hour) {
    ASSERT_EQ(filter.predict(Scalar(3600)), Status::kOk);
    const double precise = sizeof(Scalar) == 4 ? 10.0 : 0.01;
    const auto step =
        filter.update(Position{.position_std_m = precise}, Vec<Scalar, 2>(3000, 4000));
    ASSERT_EQ(step.status, Status::kOk);
    const auto after = filter.estimate();
    ASSERT_TRUE((test::is_covariance<Scalar, TypeParam::kStates>(after.covariance)))
        << after.covariance;
    const int east = index_of(TypeParam::kComponents, Component::kEast);
    EXPECT_NEAR(after.mean[0], 3000, precise);
    EXPECT_NEAR(after.mean[east], 4000, precise);
    for (const int row : {0, east}) {
      const double claimed = double(after.covariance(row, row)) / (precise * precise);
      EXPECT_GT(claimed, 0.99) << "never over-confident";
      // In float 1 - K is rounded by 6e-8, whose square times a prior of 1e15 m² and more is no
      // small variance.
      EXPECT_LT(claimed, sizeof(Scalar) > 4 ? 1.01 : 1e6);
    }
  }
}

// A plot far off is a thin ellipse: oblique to the axes, neither variance shows how thin.
TYPED_TEST_P(LongRun, AWideBeliefThenAThinPlotAskew) {
  using Scalar = typename TypeParam::Scalar;
  constexpr double kRange_m = 20e3, kRangeStd_m = 1.0;
  const auto radar = test::radar_of<TypeParam>(kRangeStd_m, deg(1.0));
  for (double prior_std_m = 300.0; prior_std_m < 30e3; prior_std_m *= 1.1)
    for (const double bearing_deg : {30.0, 45.0, 60.0}) {
      const Vec<Scalar, 2> ahead = towards(Scalar(deg(bearing_deg)));
      Gaussian<4, Scalar> wide;
      wide.mean << Scalar(kRange_m) * ahead[0], 0, Scalar(kRange_m) * ahead[1], 0;
      wide.covariance.diagonal() = Vec<Scalar, 4>(Scalar(prior_std_m * prior_std_m), 25,
                                                  Scalar(prior_std_m * prior_std_m), 25);
      TypeParam filter{typename TypeParam::Motion{}};
      ASSERT_EQ(filter.start(wide), Status::kOk);
      ASSERT_TRUE(filter.update(radar, Vec<Scalar, 2>(Scalar(kRange_m), Scalar(deg(bearing_deg)))));
      const auto after = filter.estimate().covariance;
      EXPECT_TRUE((test::is_covariance<Scalar, TypeParam::kStates>(after))) << after;
      const int east = index_of(TypeParam::kComponents, Component::kEast);
      const double along = double(ahead[0]) * double(ahead[0]) * double(after(0, 0)) +
                           2 * double(ahead[0]) * double(ahead[1]) * double(after(0, east)) +
                           double(ahead[1]) * double(ahead[1]) * double(after(east, east));
      EXPECT_GT(along, 0.9 * kRangeStd_m * kRangeStd_m) << "never over-confident";
    }
}

REGISTER_TYPED_TEST_SUITE_P(LongRun, CovarianceStaysPositiveDefinite,
                            AnHourWithoutAPlotThenAPreciseOne, AWideBeliefThenAThinPlotAskew);

}  // namespace wakeline
