// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/eval/cramer_rao_bound.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"
#include "wakeline/motion/constant_acceleration.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"

namespace wakeline::cramer_rao_bound_test {
namespace {

using State = Vec<double, 4>;
using Matrix = Mat<double, 4, 4>;

const Matrix kPrior = State(100, 1, 100, 1).asDiagonal();

template <int N>
double largest_difference(const Mat<double, N, N>& a, const Mat<double, N, N>& b) {
  const Vec<double, N> std = b.diagonal().cwiseSqrt();
  return ((a - b).array() / (std * std.transpose()).array()).abs().maxCoeff();
}

TEST(CramerRaoBound, IsTheKalmanCovarianceOfALinearModel) {
  const CoordinatedTurn motion{.turn_rate_rad_s = 0.03, .noise = WhiteAcceleration{0.01}};
  const Position sensor{.position_std_m = 25.0};
  Ekf filter{motion};
  ASSERT_EQ(filter.start(Gaussian<4>{State(1000, 5, 2000, -3), kPrior}), Status::kOk);
  CramerRaoBound<4> bound(kPrior);
  test::Draw draw(1);
  for (int scan = 0; scan < 60; ++scan) {
    ASSERT_EQ(filter.predict(2.0 + 0.1 * (scan % 7)), Status::kOk);
    ASSERT_EQ(bound.predict(motion, State::Zero(), 2.0 + 0.1 * (scan % 7)), Status::kOk);
    ASSERT_LT(largest_difference<4>(bound.covariance(), filter.estimate().covariance), 1e-9);
    ASSERT_TRUE(filter.update(sensor, Vec<double, 2>(1000 * draw.normal(), draw.normal())));
    ASSERT_EQ(bound.update<CoordinatedTurn>(sensor, State(1, 2, 3, 4)), Status::kOk);
    ASSERT_LT(largest_difference<4>(bound.covariance(), filter.estimate().covariance), 1e-9);
  }
}

TEST(CramerRaoBound, IsTheInverseOfTheInformation) {
  test::Draw draw(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Matrix prior = draw.definite<4>();
    const Mat<double, 2, 2> noise = draw.definite<2>();
    Mat<double, 2, 4> jacobian;
    for (int k = 0; k < 4; ++k) jacobian.col(k) = draw.normals<2>();
    const double chance = draw.uniform(0, 1);
    CramerRaoBound<4> bound(prior);
    ASSERT_EQ(bound.update<2>(jacobian, noise, chance), Status::kOk);
    const Cholesky<4> root(prior);
    const Matrix information =
        root.solve<4>(Matrix::Identity()) +
        chance * jacobian.transpose() * Cholesky<2>(noise).solve<4>(jacobian);
    const Matrix one = bound.covariance() * information;
    ASSERT_LT((one - Matrix::Identity()).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(CramerRaoBound, AReadingNeverWidensItAndTheChanceOfOneIsInBetween) {
  const RangeBearing radar{.range_std_m = 60.0, .bearing_std_rad = deg(0.5)};
  const State truth(1500, 3, -800, 6);
  const auto after = [&](double chance) {
    CramerRaoBound<4> bound(kPrior);
    EXPECT_EQ(bound.update<ConstantVelocity>(radar, truth, chance), Status::kOk);
    return bound.covariance();
  };
  EXPECT_LT(largest_difference<4>(after(0.0), kPrior), 1e-14);
  double before = kPrior.trace();
  for (const double chance : {0.2, 0.5, 1.0}) {
    EXPECT_LT(after(chance).trace(), before);
    EXPECT_TRUE(Cholesky<4>(kPrior - after(chance) + 1e-9 * Matrix::Identity()).ok());
    before = after(chance).trace();
  }
}

TEST(CramerRaoBound, AConvertedReadingHoldsWhatItsPlotHolds) {
  const State truth(1500, 3, -800, 6);
  CramerRaoBound<4> polar(kPrior), converted(kPrior);
  ASSERT_EQ(
      polar.update<ConstantVelocity>(
          RangeBearing{.range_std_m = 60.0, .bearing_std_rad = deg(0.5), .extent_std_m = 4}, truth),
      Status::kOk);
  ASSERT_EQ(converted.update<ConstantVelocity>(ConvertedRangeBearing{.range_std_m = 60.0,
                                                                     .bearing_std_rad = deg(0.5),
                                                                     .unbiased = false,
                                                                     .extent_std_m = 4},
                                               truth),
            Status::kOk);
  EXPECT_EQ(polar.covariance(), converted.covariance());
}

TEST(CramerRaoBound, FindsTheComponentsASensorReads) {
  using Motion = ConstantAcceleration;
  const Motion motion;
  const Vec<double, 6> truth = (Vec<double, 6>() << 900, 4, 0.1, 1200, -5, 0.05).finished();
  const Mat<double, 6, 6> prior = Vec<double, 6>(Vec<double, 6>::Constant(50)).asDiagonal();
  const RangeBearingDoppler doppler{};
  CramerRaoBound<6> bound(prior);
  Ekf filter{motion};
  ASSERT_EQ(filter.start(Gaussian<6>{truth, prior}), Status::kOk);
  ASSERT_EQ(bound.update<Motion>(doppler, truth), Status::kOk);
  ASSERT_TRUE(filter.update(doppler, doppler.measure(Vec<double, 4>(900, 4, 1200, -5))));
  EXPECT_LT(largest_difference<6>(bound.covariance(), filter.estimate().covariance), 1e-9);
}

TEST(CramerRaoBound, ATurnRateInTheStateMovesWithTheTruth) {
  const CoordinatedTurnRate motion;
  const Vec<double, 5> truth = (Vec<double, 5>() << 900, 4, 1200, -5, 0.02).finished();
  const Mat<double, 5, 5> prior = Vec<double, 5>(100, 1, 100, 1, 1e-4).asDiagonal();
  CramerRaoBound<5> bound(prior);
  ASSERT_EQ(bound.predict(motion, truth, 3.0), Status::kOk);
  const Mat<double, 5, 5> f = motion.jacobian(truth, 3.0);
  const Mat<double, 5, 5> wanted = f * prior * f.transpose() + motion.process_noise(truth, 3.0);
  EXPECT_LT(largest_difference<5>(bound.covariance(), wanted), 1e-12);
}

TEST(CramerRaoBound, WhatCannotBeDoneChangesNothing) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  CramerRaoBound<4> bound(kPrior);
  const Mat<double, 2, 2> noise = Mat<double, 2, 2>::Identity();
  const Mat<double, 2, 4> jacobian = Mat<double, 2, 4>::Identity();
  EXPECT_EQ(bound.predict(nan * Matrix::Identity(), kPrior), Status::kNotFinite);
  EXPECT_EQ(bound.predict(Matrix::Zero(), Matrix::Zero()), Status::kNotPositiveDefinite);
  const ConstantVelocity motion{.noise = PiecewiseAcceleration{0.1}};
  const Vec<double, 4> truth(4000, -6, 3000, 8);
  EXPECT_EQ(bound.predict(motion, truth, -1.0), Status::kNegativeTimeStep);
  EXPECT_EQ(bound.predict(motion, truth, nan), Status::kNotFinite);
  EXPECT_EQ(bound.update<2>(nan * jacobian, noise), Status::kNotFinite);
  EXPECT_EQ(bound.update<2>(jacobian, -noise), Status::kNotPositiveDefinite);
  EXPECT_EQ(bound.update<2>(jacobian, nan * noise), Status::kNotPositiveDefinite);
  EXPECT_EQ(bound.update<2>(jacobian, noise, 1.5), Status::kNotFinite);
  EXPECT_EQ(bound.update<2>(jacobian, noise, nan), Status::kNotFinite);
  EXPECT_EQ(bound.covariance(), kPrior);
  EXPECT_THROW(CramerRaoBound<4>(-kPrior), std::invalid_argument);
  EXPECT_THROW(CramerRaoBound<4>(nan * kPrior), std::invalid_argument);
}

TEST(CramerRaoBound, DoesNotTouchTheHeap) {
  CramerRaoBound<4> bound(kPrior);
  const RangeBearing radar;
  const CoordinatedTurn motion{.turn_rate_rad_s = 0.02};
  Status worst = Status::kOk;
  const test::NoHeap fence;
  for (int scan = 0; scan < 5; ++scan) {
    if (bound.predict(motion, State(1, 2, 3, 4), 3.0) != Status::kOk) worst = Status::kNotFinite;
    if (bound.update<CoordinatedTurn>(radar, State(900, 2, 800, 4)) != Status::kOk)
      worst = Status::kNotFinite;
  }
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_EQ(worst, Status::kOk);
}

}  // namespace
}  // namespace wakeline::cramer_rao_bound_test
