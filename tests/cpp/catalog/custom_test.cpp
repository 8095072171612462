// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Models and sensors made at run time against the same known at compile time.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include "support/malloc_fence.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/catalog/filters.hpp"
#include "wakeline/catalog/imm_smoother.hpp"

namespace wakeline::custom_test {
namespace {

using test::matrices_near;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A model of the catalogue as one made at run time.
template <class Motion>
class Custom : public CustomMotion {
 public:
  explicit Custom(const Motion& motion)
      : CustomMotion(StateRows::of(Motion::kComponents)), motion_(motion) {}
  [[nodiscard]] bool linear() const noexcept override { return LinearMotionModel<Motion>; }
  [[nodiscard]] State transition(const State& x, double dt_s) const noexcept override {
    return wakeline::transition<Motion, double>(motion_, x, dt_s);
  }
  [[nodiscard]] Matrix jacobian(const State& x, double dt_s) const noexcept override {
    if constexpr (LinearMotionModel<Motion>)
      return motion_.matrix(dt_s);
    else
      return CustomMotion::jacobian(x, dt_s);
  }
  [[nodiscard]] Matrix process_noise(const State& x, double dt_s) const noexcept override {
    return wakeline::process_noise<Motion, double>(motion_, x, dt_s);
  }
  [[nodiscard]] double prior_variance(Component component) const noexcept override {
    return wakeline::prior_variance(motion_, component);
  }

 private:
  Motion motion_;
};

template <class Motion>
std::shared_ptr<const CustomMotion> custom(const Motion& motion) {
  return std::make_shared<Custom<Motion>>(motion);
}

const Gaussian<4> kStart{{4000.0, 6.0, 3000.0, -8.0},
                         Vec<double, 4>(2500.0, 4.0, 2500.0, 4.0).asDiagonal()};

/// Both filters by the same steps, each estimate near the other's.
template <class Sensor>
void expect_alike(AnyFilter own, AnyFilter ours, const Sensor& sensor, double relative) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  ASSERT_EQ(own.start(kStart), Status::kOk);
  ASSERT_EQ(ours.start(kStart), Status::kOk);
  for (int k = 0; k < 40; ++k) {
    const double dt_s = 2.0 + 0.5 * (k % 3);
    ASSERT_EQ(own.predict(dt_s), Status::kOk);
    ASSERT_EQ(ours.predict(dt_s), Status::kOk);
    if (k % 7 == 3) continue;
    const Vec<double, 2> z(5000.0 - 4.0 * k + 20.0 * normal(random), 0.64 + 0.01 * normal(random));
    const auto a = own.update(sensor, z), b = ours.update(sensor, z);
    ASSERT_EQ(a.status, Status::kOk);
    ASSERT_EQ(b.status, Status::kOk);
    ASSERT_NEAR(b.nis, a.nis, relative * (1.0 + a.nis));
    ASSERT_NEAR(b.log_likelihood, a.log_likelihood, relative * (1.0 + std::abs(a.log_likelihood)));
    ASSERT_TRUE(matrices_near(ours.estimate().mean, own.estimate().mean,
                              {.absolute = relative, .relative = relative}));
    ASSERT_TRUE(matrices_near(ours.estimate().covariance, own.estimate().covariance,
                              {.absolute = relative, .relative = relative}));
  }
  AnyBelief before = own.estimate(), filtered = before;
  AnyBelief later = own.estimate();
  later.covariance *= 0.5;
  ASSERT_EQ(smooth_pair(own, before, later, 2.0), Status::kOk);
  ASSERT_EQ(smooth_pair(ours, filtered, later, 2.0), Status::kOk);
  ASSERT_TRUE(matrices_near(filtered.mean, before.mean, {.absolute = 1e-6, .relative = relative}));
  ASSERT_TRUE(
      matrices_near(filtered.covariance, before.covariance, {.absolute = 1e-6, .relative = 1e-6}));
}

TEST(CustomFilter, EqualsTheFilterOfTheModel) {
  const RangeBearing polar{.range_std_m = 20.0};
  const ConvertedRangeBearing converted{.range_std_m = 20.0};
  const ConstantVelocity straight;
  expect_alike(any_kalman(straight), AnyFilter(CustomFilter(custom(straight)), true), converted,
               1e-9);
  expect_alike(AnyFilter(Ekf(straight)), AnyFilter(CustomFilter(custom(straight))), polar, 1e-9);
  expect_alike(AnyFilter(Ukf(straight)), AnyFilter(CustomFilter(custom(straight), Unscented{})),
               polar, 1e-8);
  const CoordinatedTurnRate turn;
  expect_alike(AnyFilter(Ekf(turn)), AnyFilter(CustomFilter(custom(turn))), polar, 1e-5);
  expect_alike(AnyFilter(Ukf(turn)), AnyFilter(CustomFilter(custom(turn), Unscented{})), converted,
               1e-8);
}

TEST(CustomFilter, StepsWithoutHeap) {
  AnyFilter filter{CustomFilter(custom(ConstantVelocity{}))};
  (void)filter.start(kStart);
  const AnyFilter started = filter;
  test::NoHeap fence;
  for (int k = 0; k < 3; ++k) {
    (void)filter.predict(3.0);
    (void)filter.update(RangeBearing{}, Vec<double, 2>(5000.0, 0.64));
    (void)filter.update(RuntimeSensor(Bearing{}), Vec<double, 4>(0.64, kNaN, kNaN, kNaN));
  }
  filter = started;
  EXPECT_EQ(fence.allocations(), 0);
}

TEST(CustomFilter, RejectsABeliefThatIsNone) {
  CustomFilter filter(custom(ConstantVelocity{}));
  EXPECT_EQ(filter.predict(1.0), Status::kNotStarted);
  Gaussian<4> bad = kStart;
  bad.covariance(0, 0) = -1.0;
  EXPECT_EQ(filter.start(bad), Status::kNotPositiveDefinite);
  bad = kStart;
  bad.mean[2] = kNaN;
  EXPECT_EQ(filter.start(bad), Status::kNotFinite);
  EXPECT_FALSE(filter.started());
  ASSERT_EQ(filter.start(kStart), Status::kOk);
  EXPECT_EQ(filter.predict(-1.0), Status::kNegativeTimeStep);
  EXPECT_EQ(filter.predict(kNaN), Status::kNotFinite);
}

TEST(RuntimeSensor, OfAWholeReadingIsTheSensor) {
  const RangeBearing radar{.range_std_m = 20.0, .extent_std_m = 4.0};
  AnyFilter own{Ekf(ConstantVelocity{})};
  (void)own.start(kStart);
  AnyFilter ours = own;
  (void)own.update(radar, Vec<double, 2>(5010.0, 0.641));
  const auto step = ours.update(RuntimeSensor(radar), Vec<double, 4>(5010.0, 0.641, kNaN, kNaN));
  EXPECT_EQ(step.status, Status::kOk);
  EXPECT_TRUE(matrices_near(ours.estimate().mean, own.estimate().mean));
  EXPECT_TRUE(matrices_near(ours.estimate().covariance, own.estimate().covariance));
}

TEST(RuntimeSensor, MissesAReadingWithoutNumbersAndAStateWithoutItsComponents) {
  AnyFilter filter{Ekf(ConstantVelocity{})};
  (void)filter.start(kStart);
  EXPECT_EQ(filter.update(RuntimeSensor(Range{}), Vec<double, 4>::Constant(kNaN)).status,
            Status::kMissed);
  class Gauge : public CustomSensor {
   public:
    [[nodiscard]] int numbers() const noexcept override { return 1; }
    [[nodiscard]] const StateRows& reads() const noexcept override { return reads_; }
    [[nodiscard]] bool linear() const noexcept override { return true; }
    [[nodiscard]] ReadingVector measure(const AnyBelief::Mean& x) const noexcept override {
      return x;
    }
    [[nodiscard]] ReadingJacobian jacobian(const AnyBelief::Mean&) const noexcept override {
      return noise_;
    }
    [[nodiscard]] ReadingVector residual(const ReadingVector& a,
                                         const ReadingVector& b) const noexcept override {
      return a - b;
    }
    [[nodiscard]] const ReadingMatrix& noise() const noexcept override { return noise_; }

   private:
    StateRows reads_ = StateRows::of(std::array{Component::kTurnRate});
    ReadingMatrix noise_ = ReadingMatrix::Identity(1, 1);
  };
  const RuntimeSensor gauge(std::make_shared<const Gauge>());
  const Vec<double, 4> z(0.02, kNaN, kNaN, kNaN);
  EXPECT_EQ(filter.update(gauge, z).status, Status::kMissed);
  AnyFilter turning{Ekf(CoordinatedTurnRate{})};
  (void)turning.start(kStart);
  EXPECT_EQ(turning.update(gauge, z).status, Status::kOk);
  EXPECT_GT(turning.estimate().mean[4], 0.0);
}

TEST(CustomLayouts, AreKeptOnceEach) {
  const auto rows = StateRows::of(std::array{Component::kUser, Component::kNorth});
  const StateLayout layout = CustomLayouts::of(rows);
  EXPECT_EQ(CustomLayouts::of(rows), layout);
  EXPECT_FALSE(is_of_catalog(layout));
  EXPECT_EQ(rows_of(layout), rows);
  EXPECT_FALSE(has_kinematics(layout));
  EXPECT_EQ(CustomLayouts::of(StateRows::of(CoordinatedTurnRate::kComponents)),
            kLayoutOf<CoordinatedTurnRate>);
  EXPECT_EQ(rows_between(StateLayout::kKinematics, layout)[1], 0);
}

}  // namespace
}  // namespace wakeline::custom_test
