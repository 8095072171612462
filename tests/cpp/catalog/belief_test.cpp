// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Beliefs whose layout is known at run time, against those of a layout known at compile time.
#include "wakeline/catalog/belief.hpp"

#include <gtest/gtest.h>

#include "support/matrix_assert.hpp"
#include "wakeline/core/state_belief.hpp"
#include "wakeline/multimodel/filter_bank.hpp"

namespace wakeline::belief_test {
namespace {

using test::matrices_identical;

/// A belief of N states; `seed` makes one differ from another.
template <int N>
Gaussian<N> belief(double seed) {
  Gaussian<N> belief;
  for (int i = 0; i < N; ++i) {
    belief.mean[i] = seed + i;
    for (int j = 0; j < N; ++j)
      belief.covariance(i, j) = (i == j ? 10.0 + i : 0.0) + seed / (1.0 + i + j);
  }
  return belief;
}

template <class Motion>
StateBelief<Motion::kComponents, double> fixed(double seed) {
  StateBelief<Motion::kComponents, double> fixed;
  fixed = belief<kStatesOf<Motion>>(seed);
  return fixed;
}

template <class To, class From>
void expect_mixing_alike() {
  const auto own = fixed<To>(1.0);
  const auto part = fixed<From>(2.0);
  auto sum = zero_like(own);
  add_mean(sum, 0.7, part, own);
  add_spread(sum, 0.7, part, own);
  const AnyBelief any_own = any_belief<To>(own), any_part = any_belief<From>(part);
  AnyBelief any_sum = zero_like(any_own);
  add_mean(any_sum, 0.7, any_part, any_own);
  add_spread(any_sum, 0.7, any_part, any_own);
  EXPECT_EQ(any_sum.layout, kLayoutOf<To>);
  EXPECT_TRUE(matrices_identical(sum.mean, any_sum.mean));
  EXPECT_TRUE(matrices_identical(sum.covariance, any_sum.covariance));
}

TEST(AnyBelief, MixesAsBeliefsOfFixedLayoutDo) {
  Motions::for_each([]<class To>(std::type_identity<To>) {
    Motions::for_each(
        []<class From>(std::type_identity<From>) { expect_mixing_alike<To, From>(); });
  });
}

TEST(AnyBelief, HasTheKinematicsOfEachMotionModel) {
  Motions::for_each([]<class Motion>(std::type_identity<Motion>) {
    const auto one = fixed<Motion>(3.0);
    const Gaussian<4> any = kinematics_of(any_belief<Motion>(one));
    EXPECT_TRUE(matrices_identical(kinematics_of(one).mean, any.mean));
    EXPECT_TRUE(matrices_identical(kinematics_of(one).covariance, any.covariance));
  });
}

TEST(StateLayouts, AreThoseOfTheMotionModelsEachOnce) {
  EXPECT_EQ(kLayoutOf<ConstantVelocity>, StateLayout::kKinematics);
  EXPECT_EQ(kLayoutOf<CoordinatedTurn>, StateLayout::kKinematics);
  EXPECT_EQ(kLayoutOf<Singer>, kLayoutOf<ConstantAcceleration>);
  EXPECT_EQ(states_of(kLayoutOf<CoordinatedTurnRate>), 5);
  for (int a = 0; a < kStateLayouts.count; ++a)
    for (int b = 0; b < a; ++b) EXPECT_NE(rows_of(StateLayout(a)), rows_of(StateLayout(b)));
}

}  // namespace
}  // namespace wakeline::belief_test
