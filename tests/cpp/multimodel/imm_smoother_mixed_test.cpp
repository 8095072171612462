// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The smoother over filters of different kinds and states.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <vector>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/imm_smoother.hpp"
#include "wakeline/multimodel/variant_bank.hpp"

namespace wakeline::imm_smoother_mixed_test {
namespace {

using test::Draw;
using test::is_covariance;
using test::matrices_near;

using Bank = FilterBank<Ekf<ConstantVelocity>, Ukf<CoordinatedTurnRate>>;
using Turn = StateBelief<CoordinatedTurnRate::kComponents, double>;
using Straight = StateBelief<kKinematics, double>;

Turn some_turn() {
  Draw draw(1);
  Turn belief;
  Mat<double, 5, 5> root;
  for (double& number : root.reshaped()) number = draw.normal();
  belief = Gaussian<5>{draw.normals<5>(), root * root.transpose()};
  return belief;
}

TEST(CarriedOver, TakesTheGivenPartAndKeepsTheConditionalOfTheRest) {
  const Turn own = some_turn();
  Straight told;
  told = Gaussian<4>{Vec<double, 4>(1, 2, 3, 4), Vec<double, 4>(0.1, 0.2, 0.3, 0.4).asDiagonal()};
  const Turn result = carried_over(own, told);
  EXPECT_TRUE(is_covariance(result.covariance));
  EXPECT_TRUE(matrices_near(result.mean.head<4>(), told.mean, {1e-12, 1e-12}));
  const auto part = [](const Turn& belief) {
    return Mat<double, 4, 4>(belief.covariance.topLeftCorner<4, 4>());
  };
  EXPECT_TRUE(matrices_near(part(result), told.covariance, {1e-11, 1e-11}));
  // The regression of the turn rate on the others, and what it leaves, are as before.
  const auto slope = [&](const Turn& belief) -> Vec<double, 4> {
    const Vec<double, 4> across = belief.covariance.col(4).head<4>();
    return Cholesky<4>(part(belief)).solve<1>(across);
  };
  EXPECT_TRUE(matrices_near(slope(result), slope(own), {1e-9, 1e-9}));
  const auto left = [&](const Turn& belief) {
    return belief.covariance(4, 4) - slope(belief).dot(belief.covariance.col(4).head<4>());
  };
  EXPECT_NEAR(left(result), left(own), 1e-9);
}

TEST(ImmSmoother, TakesFiltersOfOtherStates) {
  constexpr Position kSensor{.position_std_m = 30.0};
  const PiecewiseAcceleration noise{0.05};
  const Imm<Bank> prototype{
      ModeChain<2>::staying(0.9),
      Bank{Ekf{ConstantVelocity{.noise = noise}}, Ukf{CoordinatedTurnRate{.noise = noise}}}};
  double filtered = 0.0, smoothed = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Draw draw(seed);
    Imm<Bank> imm = prototype;
    Vec<double, 4> x(0, 8, 0, 3);
    ASSERT_EQ(imm.start(Gaussian<4>{x, Vec<double, 4>(900, 4, 900, 4).asDiagonal()}), Status::kOk);
    std::vector<ImmScan<Bank>> scans;
    std::vector<Vec<double, 4>> truth;
    for (int k = 0; k < 75; ++k) {
      const double rate = k >= 25 && k < 50 ? deg(2.0) : 0.0;
      x = CoordinatedTurn{.turn_rate_rad_s = rate}.matrix(3.0) * x;
      truth.push_back(x);
      ASSERT_EQ(imm.predict(3.0), Status::kOk);
      const Imm<Bank> predicted = imm;
      const Vec<double, 2> plot(x[0], x[2]);
      ASSERT_TRUE(imm.update(kSensor, plot + kSensor.position_std_m * draw.normals<2>()));
      scans.push_back({predicted, imm, 3.0});
    }
    const auto error = [&](std::size_t k) {
      return (kinematics_of(scans[k].updated.estimate()).mean - truth[k]).squaredNorm();
    };
    for (std::size_t k = 0; k < scans.size(); ++k) filtered += error(k);
    ASSERT_EQ(ImmSmoother<Bank>::smooth(scans), Status::kOk);
    for (std::size_t k = 0; k < scans.size(); ++k) {
      smoothed += error(k);
      EXPECT_TRUE(is_covariance(scans[k].updated.estimate().covariance));
    }
  }
  EXPECT_LT(smoothed, 0.6 * filtered);
}

/// A recording of 40 plots of a vessel that goes straight.
template <class Estimator>
std::vector<ImmScan<typename Estimator::Bank>> recorded(Estimator imm) {
  std::vector<ImmScan<typename Estimator::Bank>> scans;
  Draw draw(3);
  EXPECT_EQ(imm.start(Gaussian<4>{Vec<double, 4>(0, 8, 0, 3),
                                  Vec<double, 4>(900, 4, 900, 4).asDiagonal()}),
            Status::kOk);
  for (int k = 1; k <= 40; ++k) {
    EXPECT_EQ(imm.predict(3.0), Status::kOk);
    scans.push_back({imm, imm, 3.0});
    EXPECT_TRUE(imm.update(Position{.position_std_m = 30.0},
                           Vec<double, 2>(24.0 * k, 9.0 * k) + 30.0 * draw.normals<2>()));
    scans.back().updated = imm;
  }
  return scans;
}

TEST(ImmSmoother, OfABankComposedAtRunTimeGivesTheBitsOfAFilterBank) {
  using Straight = Ekf<ConstantVelocity>;
  using Turning = Ukf<CoordinatedTurnRate>;
  using AtRunTime = VariantBank<4, Straight, Turning>;
  const PiecewiseAcceleration noise{0.05};
  const Straight straight{ConstantVelocity{.noise = noise}};
  const Turning turn{CoordinatedTurnRate{.noise = noise}};
  const auto chain = ModeChain<2>::staying(0.9);
  const std::array<AtRunTime::Filter, 2> filters{straight, turn};
  auto expected = recorded(Imm<Bank>{chain, Bank{straight, turn}});
  auto scans = recorded(Imm<AtRunTime>{ModeChain<kRuntimeModes>(chain), AtRunTime(filters)});
  const Vec<double, 4> filtered = scans[0].updated.estimate().mean;
  ASSERT_EQ(ImmSmoother<Bank>::smooth(expected), Status::kOk);
  ASSERT_EQ(ImmSmoother<AtRunTime>::smooth(scans), Status::kOk);
  EXPECT_NE(scans[0].updated.estimate().mean, filtered);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const auto one = scans[k].updated.estimate(), other = expected[k].updated.estimate();
    EXPECT_TRUE(test::matrices_identical(one.mean, other.mean)) << k;
    EXPECT_TRUE(test::matrices_identical(one.covariance, other.covariance)) << k;
  }
}

}  // namespace
}  // namespace wakeline::imm_smoother_mixed_test
