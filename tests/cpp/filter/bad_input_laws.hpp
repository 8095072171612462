// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

// A step that cannot be done says why and leaves the belief bit for bit as it was.
#include <limits>

#include "filter/cases.hpp"

namespace wakeline {

template <class FilterType>
class BadInput : public ::testing::Test {
 protected:
  using Filter = FilterType;
  using Scalar = typename Filter::Scalar;
  static constexpr Scalar kNan = std::numeric_limits<Scalar>::quiet_NaN();
  static constexpr Scalar kInfinity = std::numeric_limits<Scalar>::infinity();
  static constexpr Scalar kHuge = std::numeric_limits<Scalar>::max();

  void SetUp() override {
    ASSERT_EQ(filter.start(test::five_km_off<Scalar>()), Status::kOk);
    ASSERT_EQ(filter.predict(Scalar(2.5)), Status::kOk);
    before = filter.estimate();
  }

  Filter filter{typename Filter::Motion{}};
  Gaussian<Filter::kStates, Scalar> before;
};
TYPED_TEST_SUITE_P(BadInput);

TYPED_TEST_P(BadInput, NotStarted) {
  using Scalar = typename TypeParam::Scalar;
  TypeParam fresh{typename TypeParam::Motion{}};
  EXPECT_FALSE(fresh.started());
  EXPECT_EQ(fresh.predict(Scalar(1)), Status::kNotStarted);
  const auto step = fresh.update(test::radar_of<TypeParam>(10, 0.01), Vec<Scalar, 2>(5000, 1));
  EXPECT_FALSE(step);
  EXPECT_EQ(step.status, Status::kNotStarted);
  EXPECT_TRUE(this->filter.started());
}

TYPED_TEST_P(BadInput, InvalidTimeSteps) {
  EXPECT_EQ(this->filter.predict(this->kNan), Status::kNotFinite);
  EXPECT_EQ(this->filter.predict(this->kInfinity), Status::kNotFinite);
  EXPECT_EQ(this->filter.predict(-this->kInfinity), Status::kNotFinite);
  EXPECT_EQ(this->filter.predict(-1), Status::kNegativeTimeStep);
  EXPECT_EQ(this->filter.predict(this->kHuge), Status::kNotFinite) << "too long";
  EXPECT_TRUE(test::beliefs_identical<TypeParam::kStates>(this->filter.estimate(), this->before));
  EXPECT_EQ(this->filter.predict(1), Status::kOk) << "and it goes on";
}

TYPED_TEST_P(BadInput, NoTimeChangesNothing) {
  using Scalar = typename TypeParam::Scalar;
  EXPECT_EQ(this->filter.predict(0), Status::kOk);
  const double rounding = 256 * std::numeric_limits<Scalar>::epsilon();
  const auto after = this->filter.estimate();
  EXPECT_TRUE(test::matrices_near(after.mean, this->before.mean,
                                  {.absolute = 0.1 * rounding, .relative = rounding}));
  EXPECT_LT((test::covariance_difference<Scalar, TypeParam::kStates>(after.covariance,
                                                                     this->before.covariance)),
            rounding);
}

TYPED_TEST_P(BadInput, InvalidPlots) {
  using Scalar = typename TypeParam::Scalar;
  const auto radar = test::radar_of<TypeParam>(10, 0.01);
  const Vec<Scalar, 2> good = test::plot_of<Scalar>(2990, 4010);
  for (const Scalar bad : {this->kNan, this->kInfinity, -this->kInfinity, this->kHuge})
    for (int k = 0; k < 2; ++k) {
      if (k == 1 && bad == this->kHuge) continue;  // a bearing of many turns is an angle still
      Vec<Scalar, 2> z = good;
      z[k] = bad;
      const auto step = this->filter.update(radar, z);
      EXPECT_FALSE(step) << z.transpose();
      EXPECT_EQ(step.status, Status::kNotFinite) << z.transpose() << ": " << to_string(step.status);
      EXPECT_TRUE(
          test::beliefs_identical<TypeParam::kStates>(this->filter.estimate(), this->before))
          << z.transpose();
    }
  EXPECT_TRUE(this->filter.update(radar, good)) << "and it goes on";
}

TYPED_TEST_P(BadInput, InnovationIsTheStepOfTheUpdateNotTaken) {
  using Scalar = typename TypeParam::Scalar;
  const auto radar = test::radar_of<TypeParam>(10, 0.01);
  const Vec<Scalar, 2> z = test::plot_of<Scalar>(2990, 4010);
  const auto step = this->filter.innovation(radar, z);
  EXPECT_TRUE(test::beliefs_identical<TypeParam::kStates>(this->filter.estimate(), this->before));
  const auto expected = this->filter.update(radar, z);
  ASSERT_TRUE(step && expected);
  EXPECT_TRUE(test::matrices_identical(step.innovation, expected.innovation));
  EXPECT_TRUE(test::matrices_identical(step.innovation_covariance, expected.innovation_covariance));
  EXPECT_EQ(step.nis, expected.nis);
  EXPECT_EQ(step.log_likelihood, expected.log_likelihood);
}

TYPED_TEST_P(BadInput, InvalidStarts) {
  using Scalar = typename TypeParam::Scalar;
  constexpr int N = TypeParam::kStates;
  Gaussian<N, Scalar> bad = this->before;
  bad.mean[1] = this->kNan;
  EXPECT_EQ(this->filter.start(bad), Status::kNotFinite);
  bad = this->before;
  bad.covariance(0, 0) = this->kInfinity;
  EXPECT_EQ(this->filter.start(bad), Status::kNotFinite);
  bad = this->before;
  bad.covariance(1, 1) = Scalar(-1);
  EXPECT_EQ(this->filter.start(bad), Status::kNotPositiveDefinite);
  bad = this->before;
  bad.covariance(0, 1) += Scalar(10);
  EXPECT_EQ(this->filter.start(bad), Status::kNotPositiveDefinite) << "not symmetric";
  bad.covariance.setZero();
  EXPECT_EQ(this->filter.start(bad), Status::kNotPositiveDefinite);
  EXPECT_TRUE(test::beliefs_identical<N>(this->filter.estimate(), this->before));

  TypeParam fresh{typename TypeParam::Motion{}};
  EXPECT_NE(fresh.start(bad), Status::kOk);
  EXPECT_FALSE(fresh.started());
}

/// A sensor of one's own that has gone wrong.
struct Broken {
  static constexpr int kMeasurements = 2;
  static constexpr auto kReads = kPosition;
  static constexpr bool kLinear = true;

  double seen = 1.0;
  double variance = 1.0;

  template <class Scalar>
  Gaussian<2, Scalar> observe(const Vec<Scalar, 2>& z) const noexcept {
    return {z, Scalar(variance) * Mat<Scalar, 2, 2>::Identity()};
  }
  template <class Scalar>
  Vec<Scalar, 2> measure(const Vec<Scalar, 2>& x) const noexcept {
    return Scalar(seen) * x;
  }
  template <class Scalar>
  Mat<Scalar, 2, 2> jacobian(const Vec<Scalar, 2>&) const noexcept {
    return Scalar(seen) * Mat<Scalar, 2, 2>::Identity();
  }
  template <class Scalar>
  Vec<Scalar, 2> residual(const Vec<Scalar, 2>& a, const Vec<Scalar, 2>& b) const noexcept {
    return a - b;
  }
};

TYPED_TEST_P(BadInput, InvalidSensors) {
  using Scalar = typename TypeParam::Scalar;
  const Vec<Scalar, 2> z(3000, 4000);
  EXPECT_EQ(this->filter.update(Broken{.seen = double(this->kNan)}, z).status, Status::kNotFinite);
  EXPECT_EQ(this->filter.update(Broken{.variance = double(this->kNan)}, z).status,
            Status::kNotFinite);
  EXPECT_EQ(this->filter.update(Broken{.variance = -1e9}, z).status, Status::kNotPositiveDefinite);
  EXPECT_TRUE(test::beliefs_identical<TypeParam::kStates>(this->filter.estimate(), this->before));
}

TYPED_TEST_P(BadInput, AVarianceThatWouldBeNegative) {
  using Scalar = typename TypeParam::Scalar;
  auto wide = this->before;
  wide.covariance.diagonal() *= Scalar(10);
  ASSERT_EQ(this->filter.start(wide), Status::kOk);
  const auto started = this->filter.estimate();
  EXPECT_EQ(this->filter.update(Broken{.variance = -100}, Vec<Scalar, 2>(3000, 4000)).status,
            Status::kNotPositiveDefinite);
  EXPECT_TRUE(test::beliefs_identical<TypeParam::kStates>(this->filter.estimate(), started));
}

REGISTER_TYPED_TEST_SUITE_P(BadInput, NotStarted, InvalidTimeSteps, NoTimeChangesNothing,
                            InvalidPlots, InnovationIsTheStepOfTheUpdateNotTaken, InvalidStarts,
                            InvalidSensors, AVarianceThatWouldBeNegative);

}  // namespace wakeline
