// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A bank composed at run time is the one composed at compile time.
#include "wakeline/multimodel/variant_bank.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline::variant_bank_test {
namespace {

using test::beliefs_identical;
using test::matrices_identical;
using test::matrices_near;

template <class Scalar>
using Bank = VariantBank<4, Ekf<ConstantVelocity, Scalar>, Ekf<CoordinatedTurnRate, Scalar>,
                         Ukf<CoordinatedTurnRate, Scalar>, Ekf<ConstantAcceleration, Scalar>>;
using Lanes = Pack<double, kNativeLanes<double>>;

const RangeBearing kRadar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
const ModeChain<3> kChain = ModeChain<3>::from_sojourn_s({60.0, 30.0, 30.0});
const ConstantVelocity kStraight{.noise = WhiteAcceleration{0.01}};
const CoordinatedTurnRate kTurning{.noise = WhiteAcceleration{0.01},
                                   .prior_turn_rate_std_rad_s = deg(5)};
const ConstantAcceleration kPushed{.noise = WhiteJerk{0.01}};

auto at_compile_time() { return Imm{kChain, Ekf{kStraight}, Ukf{kTurning}, Ekf{kPushed}}; }

template <class Scalar>
Imm<Bank<Scalar>> at_run_time() {
  std::vector<typename Bank<Scalar>::Filter> filters;
  filters.reserve(3);
  filters.emplace_back(std::in_place_type<Ekf<ConstantVelocity, Scalar>>, kStraight);
  filters.emplace_back(std::in_place_type<Ukf<CoordinatedTurnRate, Scalar>>, kTurning);
  filters.emplace_back(std::in_place_type<Ekf<ConstantAcceleration, Scalar>>, kPushed);
  return {ModeChain<kRuntimeModes>(kChain), Bank<Scalar>(filters)};
}

Vec<double, 2> reading(test::Draw& draw) {
  return test::plot_of<double>(3000 + 40 * draw.normal(), 4000 + 40 * draw.normal());
}

TEST(VariantBank, GivesTheBitsOfAFilterBank) {
  auto expected = at_compile_time();
  auto imm = at_run_time<double>();
  static_assert(decltype(imm)::Bank::kComponents == kKinematics, "what all kinds have in common");
  ASSERT_EQ(expected.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  test::Draw draw(95);
  for (int scan = 0; scan < 60; ++scan) {
    const double dt = draw.uniform(0, 4);
    const Vec<double, 2> push(draw.uniform(-1, 1), draw.uniform(-1, 1));
    ASSERT_EQ(expected.predict(dt, push), Status::kOk);
    ASSERT_EQ(imm.predict(dt, push), Status::kOk);
    const Vec<double, 2> z = reading(draw);
    if (scan % 5 == 4) {
      const std::array<Alternative<RangeBearing>, 2> readings{
          {{kRadar, z, 0.4}, {kRadar, reading(draw), 0.3}}};
      std::array<double, 2> share, expected_share;
      EXPECT_EQ(imm.update<RangeBearing>(readings, 1e-6, share),
                expected.update<RangeBearing>(readings, 1e-6, expected_share));
      EXPECT_EQ(share, expected_share);
    } else {
      const auto step = imm.update(kRadar, z), wanted = expected.update(kRadar, z);
      ASSERT_TRUE(step && wanted);
      EXPECT_EQ(step.log_likelihood, wanted.log_likelihood);
      EXPECT_EQ(step.nis, wanted.nis);
    }
    ASSERT_TRUE(beliefs_identical<4>(imm.estimate(), expected.estimate())) << scan;
    ASSERT_TRUE(matrices_identical(imm.mode_probability().eval(),
                                   Eigen::VectorXd(expected.mode_probability())))
        << scan;
  }
}

TEST(VariantBank, InLanesIsThatOfNumbers) {
  auto expected = at_run_time<double>();
  auto imm = at_run_time<Lanes>();
  ASSERT_EQ(expected.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_TRUE(all(ok(imm.start(test::five_km_off<double>().cast<Lanes>()))));
  test::Draw draw(96);
  for (int scan = 0; scan < 40; ++scan) {
    ASSERT_EQ(expected.predict(2.5), Status::kOk);
    ASSERT_TRUE(all(ok(imm.predict(2.5))));
    if (scan % 6 == 5) continue;  // missed
    const Vec<double, 2> z = reading(draw);
    ASSERT_TRUE(expected.update(kRadar, z));
    ASSERT_TRUE(all(ok(imm.update(kRadar, z.cast<Lanes>().eval()).status)));
    for (int k = 0; k < 4; ++k) {
      const double mean = expected.estimate().mean[k];
      EXPECT_NEAR(imm.estimate().mean[k][0], mean, 1e-9 * (1 + std::abs(mean))) << scan;
    }
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(imm.mode_probability()[k][0], expected.mode_probability()[k], 1e-9) << scan;
  }
}

TEST(VariantBank, AStepThatFailsChangesNothing) {
  auto imm = at_run_time<double>();
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(imm.predict(2.0), Status::kOk);
  const auto before = imm.estimate();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(imm.update(kRadar, {nan, 0.0}));
  EXPECT_EQ(imm.predict(-1.0), Status::kNegativeTimeStep);
  EXPECT_EQ(imm.predict(1e300), Status::kNotFinite);
  EXPECT_TRUE(beliefs_identical<4>(imm.estimate(), before));
}

TEST(VariantBank, RejectsTooManyAndNone) {
  using Few = VariantBank<2, Ekf<ConstantVelocity>>;
  const std::vector<Few::Filter> three(3, Ekf<ConstantVelocity>(kStraight));
  EXPECT_THROW(Few(std::span<const Few::Filter>(three)), std::invalid_argument);
  EXPECT_THROW(Few(std::span<const Few::Filter>()), std::invalid_argument);
  EXPECT_EQ(Few(std::span<const Few::Filter>(three).first(2)).size(), 2);
}

TEST(VariantBank, DoesNotTouchTheHeap) {
  auto imm = at_run_time<double>();
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  const test::NoHeap fence;
  bool good = true;
  for (int scan = 0; scan < 5; ++scan) {
    good = imm.predict(2.5) == Status::kOk && good;
    good = static_cast<bool>(imm.update(kRadar, test::plot_of<double>(2990, 4010))) && good;
  }
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_TRUE(good);
}

}  // namespace
}  // namespace wakeline::variant_bank_test
