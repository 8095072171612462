// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Prediction under a known acceleration.
#include <limits>

#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline::control_test {
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
  EXPECT_EQ(filter.predict(3.0, {0.0, -2.0 * kLargestInput}), Status::kNotFinite);
  EXPECT_TRUE(beliefs_identical<Filter::kStates>(filter.estimate(), before));
}

TEST(KnownAcceleration, MovesEveryFilterAsModelled) {
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

template <template <class, class> class Filter>
void expect_lane_unmoved_by_failure() {
  using Lanes = Pack<double, 2>;
  Filter<ConstantVelocity, Lanes> filter(ConstantVelocity{});
  ASSERT_TRUE(all(ok(filter.start(test::five_km_off<Lanes>()))));
  const Position fine{.position_std_m = 1e-3};
  ASSERT_TRUE(all(ok(filter.predict(Lanes(3600.0)))));
  ASSERT_TRUE(all(ok(filter.update(fine, Vec<Lanes, 2>(1e4, 2e4)).status)));
  ASSERT_TRUE(all(ok(filter.predict(Lanes(3600.0)))));
  const auto before = filter;
  const Vec<Lanes, 2> push(Lanes::of([](int k) { return k == 0 ? 0.3 : kNan; }), Lanes(0.1));
  const auto status = filter.predict(Lanes(3.0), push);
  EXPECT_EQ(lane(status, 0), Status::kOk);
  EXPECT_EQ(lane(status, 1), Status::kNotFinite);
  const auto was = before.estimate(), is = filter.estimate();
  for (int i = 0; i < 4; ++i) {
    EXPECT_NE(is.mean[i][0], was.mean[i][0]);
    EXPECT_EQ(is.mean[i][1], was.mean[i][1]);
    for (int j = 0; j < 4; ++j) EXPECT_EQ(is.covariance(i, j)[1], was.covariance(i, j)[1]);
  }
}

TEST(KnownAcceleration, OutOfRangeInOneLaneChangesNothingThere) {
  expect_lane_unmoved_by_failure<Ekf>();
  expect_lane_unmoved_by_failure<Ukf>();
  expect_lane_unmoved_by_failure<SquareRootUkf>();
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
}  // namespace wakeline::control_test
