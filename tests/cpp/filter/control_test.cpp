// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Prediction under a known acceleration.
#include <limits>

#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"

namespace wakeline {
namespace {

using test::beliefs_identical;
using test::matrices_near;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Vec<double, 2> kPush(0.3, -0.2);

template <class Filter>
Filter started(const typename Filter::Motion& motion) {
  Filter filter(motion);
  EXPECT_EQ(filter.start(test::five_km_off<double>()), Status::kOk);
  return filter;
}

/// The push of 3 s on a state, by name of its components.
template <class Filter>
Vec<double, Filter::kStates> pushed() {
  Vec<double, Filter::kStates> shift = Vec<double, Filter::kStates>::Zero();
  const auto at = [&](Component component, double value) {
    if (const int row = index_of(Filter::kComponents, component); row >= 0) shift[row] = value;
  };
  at(Component::kNorth, 4.5 * 0.3);
  at(Component::kVnorth, 3.0 * 0.3);
  at(Component::kAnorth, 0.3);
  at(Component::kEast, 4.5 * -0.2);
  at(Component::kVeast, 3.0 * -0.2);
  at(Component::kAeast, -0.2);
  return shift;
}

template <class Filter>
void expect_push(const typename Filter::Motion& motion) {
  Filter free = started<Filter>(motion);
  Filter told = started<Filter>(motion);
  const test::NoHeap fence;
  const bool good = free.predict(3.0) == Status::kOk && told.predict(3.0, kPush) == Status::kOk;
  EXPECT_EQ(fence.allocations(), 0);
  ASSERT_TRUE(good);
  EXPECT_TRUE(matrices_near(told.estimate().mean,
                            Vec<double, Filter::kStates>(free.estimate().mean + pushed<Filter>()),
                            {.absolute = 1e-12, .relative = 1e-12}));
  EXPECT_TRUE(test::matrices_identical(told.estimate().covariance, free.estimate().covariance));
}

template <class Filter>
void expect_unmoved_by_failure(const typename Filter::Motion& motion) {
  Filter filter(motion);
  EXPECT_EQ(filter.predict(3.0, kPush), Status::kNotStarted);
  filter = started<Filter>(motion);
  const auto before = filter.estimate();
  EXPECT_NE(filter.predict(-1.0, kPush), Status::kOk);
  EXPECT_EQ(filter.predict(3.0, {kNan, 0.0}), Status::kNotFinite);
  EXPECT_EQ(filter.predict(3.0, {0.0, std::numeric_limits<double>::infinity()}),
            Status::kNotFinite);
  EXPECT_TRUE(beliefs_identical<Filter::kStates>(filter.estimate(), before));
}

TEST(KnownAcceleration, PushesEveryFilterAsTheModelSays) {
  expect_push<Kalman<ConstantVelocity>>({});
  expect_push<Ekf<CoordinatedTurn>>({.turn_rate_rad_s = 0.03});
  expect_push<Ekf<CoordinatedTurnRate>>({});
  expect_push<Kalman<ConstantAcceleration>>({});
  expect_push<Ukf<CoordinatedTurn>>({.turn_rate_rad_s = 0.03});
  expect_push<SquareRootUkf<ConstantAcceleration>>({});
}

TEST(KnownAcceleration, ThatCannotBeChangesNothing) {
  expect_unmoved_by_failure<Kalman<ConstantVelocity>>({});
  expect_unmoved_by_failure<Ukf<CoordinatedTurnRate>>({});
  expect_unmoved_by_failure<SquareRootUkf<CoordinatedTurnRate>>({});
}

TEST(KnownAcceleration, OfAShipThatThrustsIsItsPath) {
  // Constant thrust from rest: x = u t² / 2, v = u t, in steps of any length.
  Gaussian<4> rest{Vec<double, 4>::Zero(), Mat<double, 4, 4>::Identity()};
  Kalman<ConstantVelocity> filter(ConstantVelocity{});
  ASSERT_EQ(filter.start(rest), Status::kOk);
  double time_s = 0.0;
  for (const double dt_s : {0.5, 3.0, 1.25, 10.0}) {
    ASSERT_EQ(filter.predict(dt_s, kPush), Status::kOk);
    time_s += dt_s;
    const Vec<double, 4> wanted(kPush[0] * time_s * time_s / 2, kPush[0] * time_s,
                                kPush[1] * time_s * time_s / 2, kPush[1] * time_s);
    EXPECT_TRUE(matrices_near(filter.estimate().mean, wanted, {.absolute = 1e-12}));
  }
}

}  // namespace
}  // namespace wakeline
