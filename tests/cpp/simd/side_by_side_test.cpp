// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Estimators that take their steps in lanes end up where each would alone.
#include "wakeline/simd/side_by_side.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline::side_by_side_test {
namespace {

using test::Draw;
using test::matrices_near;

constexpr test::Tolerance kRounding{.absolute = 1e-9, .relative = 1e-10};

using UnscentedImm = Imm<FilterBank<Ukf<CoordinatedTurnRate>, Ekf<WanderingCourse>>>;

VesselImm prototype_of(const VesselImm*) { return vessel_imm(Radar{.max_speed_mps = 25.0}); }

UnscentedImm prototype_of(const UnscentedImm*) {
  const VesselModels models;
  return UnscentedImm(ModeChain<2>::from_sojourn_s({60.0, 120.0}), Ukf(models.turning(25.0)),
                      Ekf(models.steady(25.0)));
}

/// Estimators with the same parameters, each with its own past and next step.
template <class Estimator>
struct Fleet {
  static constexpr std::size_t kMany = 70;  // more than are put in order together

  explicit Fleet(std::size_t size = kMany, std::uint64_t seed = 3)
      : estimators(size, prototype_of(static_cast<const Estimator*>(nullptr))),
        fixes(size),
        share(size) {
    Draw draw(seed);
    for (std::size_t k = 0; k < size; ++k) {
      Gaussian<4> start;
      start.mean << 3000 + 50 * draw.normal(), 6 * draw.normal(), 50 * draw.normal(), 5.0;
      start.covariance = Vec<double, 4>(100, 4, 100, 4).asDiagonal();
      EXPECT_EQ(estimators[k].start(start), Status::kOk);
      if (k % 3 == 1) {
        EXPECT_EQ(estimators[k].predict(2.0 + draw.uniform(0.0, 1.0)), Status::kOk);
      }
      step_s.push_back(draw.uniform(0.0, 4.0));
      for (std::size_t i = 0; i < 1 + k % 5; ++i)
        fixes[k].push_back(
            {Fix{10.0 * draw.definite<2>()},
             {start.mean[0] + 30 * draw.normal(), start.mean[2] + 30 * draw.normal()},
             draw.uniform(0.0, 20.0)});
      share[k].resize(fixes[k].size());
      none.push_back(k % 4 == 0 ? 0.0 : draw.uniform(0.0, 1e-4));
    }
  }

  std::vector<PredictionStep<Estimator>> predictions() {
    std::vector<PredictionStep<Estimator>> steps;
    for (std::size_t k = 0; k < estimators.size(); ++k)
      steps.push_back({&estimators[k], step_s[k]});
    return steps;
  }

  std::vector<UpdateStep<Estimator>> updates() {
    std::vector<UpdateStep<Estimator>> steps;
    for (std::size_t k = 0; k < estimators.size(); ++k)
      steps.push_back({&estimators[k], fixes[k], none[k], share[k]});
    return steps;
  }

  std::vector<Estimator> estimators;
  std::vector<double> step_s;
  std::vector<std::vector<Alternative<Fix>>> fixes;
  std::vector<double> none;
  std::vector<std::vector<double>> share;
};

template <class Estimator>
void expect_near(const Estimator& actual, const Estimator& expected, std::size_t k) {
  EXPECT_TRUE(matrices_near(actual.estimate().mean, expected.estimate().mean, kRounding)) << k;
  EXPECT_TRUE(
      matrices_near(actual.estimate().covariance, expected.estimate().covariance, kRounding))
      << k;
  EXPECT_TRUE(matrices_near(actual.mode_probability(), expected.mode_probability(), kRounding))
      << k;
}

template <class Estimator>
std::vector<std::byte> bits_of(Estimator estimator) {
  Archive fields;
  estimator.archive(fields);
  return fields.bytes();
}

template <class Estimator>
class SideBySideOf : public testing::Test {};
using Estimators = testing::Types<VesselImm, UnscentedImm>;
TYPED_TEST_SUITE(SideBySideOf, Estimators);

TYPED_TEST(SideBySideOf, StepsAreThoseOfOneAfterTheOther) {
  Fleet<TypeParam> fleet, alone;
  SideBySide<TypeParam> side_by_side(fleet.estimators[0]);
  for (int scan = 0; scan < 3; ++scan) {
    auto predictions = fleet.predictions();
    side_by_side.predict(predictions);
    for (std::size_t k = 0; k < alone.estimators.size(); ++k) {
      TypeParam& estimator = alone.estimators[k];
      EXPECT_EQ(predictions[k].status, estimator.predict(alone.step_s[k]));
      expect_near(fleet.estimators[k], estimator, k);
      EXPECT_TRUE(matrices_near(predictions[k].kinematics.mean,
                                kinematics_of(estimator.estimate()).mean, kRounding));
    }
    auto updates = fleet.updates();
    side_by_side.update(updates);
    for (std::size_t k = 0; k < alone.estimators.size(); ++k) {
      TypeParam& estimator = alone.estimators[k];
      const double total = estimator.update(std::span<const Alternative<Fix>>(alone.fixes[k]),
                                            alone.none[k], std::span(alone.share[k]));
      EXPECT_GT(total, 0.0);
      EXPECT_NEAR(updates[k].total, total, 1e-9 * total);
      for (std::size_t i = 0; i < alone.share[k].size(); ++i)
        EXPECT_NEAR(fleet.share[k][i], alone.share[k][i], 1e-9);
      expect_near(fleet.estimators[k], estimator, k);
      EXPECT_TRUE(matrices_near(updates[k].kinematics.covariance,
                                kinematics_of(estimator.estimate()).covariance, kRounding));
    }
  }
}

TYPED_TEST(SideBySideOf, NeighboursChangeNoBit) {
  Fleet<TypeParam> fleet, other;
  SideBySide<TypeParam> side_by_side(fleet.estimators[0]);
  auto predictions = fleet.predictions();
  side_by_side.predict(predictions);
  auto updates = fleet.updates();
  side_by_side.update(updates);

  auto alone = other.predictions();
  auto readings = other.updates();
  for (std::size_t k = alone.size(); k-- > 0;) {
    side_by_side.predict({&alone[k], 1});
    side_by_side.update({&readings[k], 1});
    EXPECT_EQ(bits_of(fleet.estimators[k]), bits_of(other.estimators[k])) << k;
    EXPECT_EQ(updates[k].total, readings[k].total);
    EXPECT_EQ(fleet.share[k], other.share[k]);
  }
}

TYPED_TEST(SideBySideOf, AFailedStepChangesNothing) {
  Fleet<TypeParam> fleet(9), sound(9);
  SideBySide<TypeParam> side_by_side(fleet.estimators[0]);
  const auto before = bits_of(fleet.estimators[4]);
  fleet.step_s[4] = -1.0;
  auto predictions = fleet.predictions(), expected = sound.predictions();
  side_by_side.predict(predictions);
  side_by_side.predict(expected);
  EXPECT_EQ(predictions[4].status, Status::kNegativeTimeStep);
  EXPECT_EQ(bits_of(fleet.estimators[4]), before);

  fleet.none[4] = 0.0;
  for (auto& fix : fleet.fixes[4]) fix.z[0] = std::numeric_limits<double>::quiet_NaN();
  auto updates = fleet.updates(), readings = sound.updates();
  side_by_side.update(updates);
  side_by_side.update(readings);
  EXPECT_EQ(updates[4].total, 0.0);
  for (const double share : fleet.share[4]) EXPECT_EQ(share, 0.0);
  EXPECT_EQ(bits_of(fleet.estimators[4]), before);
  for (std::size_t k = 0; k < 9; ++k) {
    if (k == 4) continue;
    EXPECT_EQ(predictions[k].status, Status::kOk);
    EXPECT_EQ(bits_of(fleet.estimators[k]), bits_of(sound.estimators[k])) << k;
  }
}

TYPED_TEST(SideBySideOf, TakesNoHeap) {
  Fleet<TypeParam> fleet;
  SideBySide<TypeParam> side_by_side(fleet.estimators[0]);
  auto predictions = fleet.predictions();
  auto updates = fleet.updates();
  const test::NoHeap fence;
  side_by_side.predict(predictions);
  side_by_side.update(updates);
  EXPECT_EQ(fence.allocations(), 0);
}

}  // namespace
}  // namespace wakeline::side_by_side_test
