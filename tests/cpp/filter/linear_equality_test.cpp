// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// On a linear motion and a linear sensor every filter is the Kalman filter, whatever the spread of
// its sigma points.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "filter/cases.hpp"
#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/coordinated_turn.hpp"

namespace wakeline::linear_equality_test {
namespace {

using test::covariance_difference;
using test::Draw;
using test::matrices_near;

const CoordinatedTurn kMotion{.turn_rate_rad_s = 0.05, .noise = WhiteAcceleration{0.2}};

Gaussian<4> first_belief() {
  Gaussian<4> belief;
  belief.mean << 100, 5, -200, 3;
  belief.covariance << 400, 30, 10, 0, 30, 25, 0, 2, 10, 0, 300, -20, 0, 2, -20, 16;
  return belief;
}

/// Steps and plots of irregular scans, one in five missed.
template <class Filter>
void expect_kalman(Filter filter, double tolerance) {
  using Scalar = typename Filter::Scalar;
  Kalman<CoordinatedTurn> kalman{kMotion};
  ASSERT_EQ(kalman.start(first_belief()), Status::kOk);
  ASSERT_EQ(filter.start(first_belief().template cast<Scalar>()), Status::kOk);
  const Position sensor{.position_std_m = 15};
  Draw draw(5);
  for (int scan = 0; scan < 50; ++scan) {
    const Scalar dt = Scalar(draw.uniform(0.0, 5.0));
    ASSERT_EQ(kalman.predict(double(dt)), Status::kOk);
    ASSERT_EQ(filter.predict(dt), Status::kOk);
    if (scan % 5 != 4) {
      const Vec<double, 2> z(kalman.estimate().mean[0] + 20 * draw.normal(),
                             kalman.estimate().mean[2] + 20 * draw.normal());
      const auto expected = kalman.update(sensor, Vec<double, 2>(z));
      const auto step = filter.update(sensor, Vec<Scalar, 2>(z.cast<Scalar>()));
      ASSERT_TRUE(expected);
      ASSERT_TRUE(step);
      EXPECT_NEAR(double(step.nis), expected.nis, 10 * tolerance * (1 + expected.nis));
      EXPECT_NEAR(double(step.log_likelihood), expected.log_likelihood,
                  10 * tolerance * (10 + expected.nis));
      EXPECT_TRUE(matrices_near(step.innovation.template cast<double>(), expected.innovation,
                                {.absolute = 1e3 * tolerance, .relative = tolerance}));
      EXPECT_LT(covariance_difference(
                    Mat<double, 2, 2>(step.innovation_covariance.template cast<double>()),
                    expected.innovation_covariance),
                tolerance);
    }
    const auto belief = filter.estimate();
    EXPECT_TRUE(matrices_near(belief.mean.template cast<double>(), kalman.estimate().mean,
                              {.absolute = 1e3 * tolerance, .relative = tolerance}));
    ASSERT_LT(covariance_difference(Mat<double, 4, 4>(belief.covariance.template cast<double>()),
                                    kalman.estimate().covariance),
              tolerance)
        << "scan " << scan;
  }
}

constexpr Unscented kSpreads[] = {
    {},
    {.alpha = 1e-3, .beta = 2.0, .kappa = 0.0},
    {.alpha = 1e-3, .beta = 2.0, .kappa = -1.0},
    {.alpha = 0.5, .beta = 2.0, .kappa = 3.0},
    {.alpha = 1.0, .beta = 1.0, .kappa = -1.0},  // kappa = 3 - n: centre weight -1/3
    {.alpha = 1.0, .beta = 2.0, .kappa = -3.9},  // centre weight -39
};

TEST(LinearEquality, Ekf) { expect_kalman(Ekf{kMotion}, 1e-15); }

TEST(LinearEquality, Ukf) {
  for (const Unscented& unscented : kSpreads) {
    SCOPED_TRACE(testing::Message()
                 << "alpha " << unscented.alpha << ", kappa " << unscented.kappa);
    // A small alpha loses digits in the differences: positions of 1e3 over 1e-3 standard
    // deviations.
    expect_kalman(Ukf{kMotion, unscented}, unscented.alpha < 0.1 ? 1e-8 : 1e-11);
  }
}

TEST(LinearEquality, SquareRootUkf) {
  for (const Unscented& unscented : kSpreads) {
    SCOPED_TRACE(testing::Message()
                 << "alpha " << unscented.alpha << ", kappa " << unscented.kappa);
    expect_kalman(SquareRootUkf{kMotion, unscented}, unscented.alpha < 0.1 ? 1e-8 : 1e-11);
  }
}

TEST(LinearEquality, Float) {
  expect_kalman(Kalman<CoordinatedTurn, float>{kMotion}, 2e-4);
  expect_kalman(Ukf<CoordinatedTurn, float>{kMotion}, 2e-4);
  expect_kalman(SquareRootUkf<CoordinatedTurn, float>{kMotion}, 2e-4);
}

/// A number that stays, with noise 1 per step, and a sensor of variance 1/2 of it.
struct Walk {
  static constexpr std::array kComponents{Component::kNorth};
  template <class Scalar>
  Mat<Scalar, 1, 1> matrix(Scalar) const noexcept {
    return Mat<Scalar, 1, 1>::Identity();
  }
  template <class Scalar>
  Mat<Scalar, 1, 1> process_noise(Scalar) const noexcept {
    return Mat<Scalar, 1, 1>::Identity();
  }
};
struct Gauge {
  static constexpr int kMeasurements = 1;
  static constexpr std::array kReads{Component::kNorth};
  static constexpr bool kLinear = true;
  template <class Scalar>
  Gaussian<1, Scalar> observe(const Vec<Scalar, 1>& z) const noexcept {
    return {z, Mat<Scalar, 1, 1>::Constant(Scalar(0.5))};
  }
  template <class Scalar>
  Vec<Scalar, 1> measure(const Vec<Scalar, 1>& x) const noexcept {
    return x;
  }
  template <class Scalar>
  Mat<Scalar, 1, 1> jacobian(const Vec<Scalar, 1>&) const noexcept {
    return Mat<Scalar, 1, 1>::Identity();
  }
  template <class Scalar>
  Vec<Scalar, 1> residual(const Vec<Scalar, 1>& a, const Vec<Scalar, 1>& b) const noexcept {
    return a - b;
  }
};

template <class Filter>
void expect_gain(Filter filter) {
  ASSERT_EQ(filter.start(Gaussian<1>{}), Status::kOk);  // P = 1
  ASSERT_EQ(filter.predict(1.0), Status::kOk);          // P = 2
  ASSERT_TRUE(filter.update(Gauge{}, Vec<double, 1>(1.0)));
  EXPECT_NEAR(filter.estimate().mean[0], 0.8, 1e-12) << "gain 2 / 2.5";
  EXPECT_NEAR(filter.estimate().covariance(0, 0), 0.4, 1e-12);
}

// WPILib paired the sigma points of the prediction with those drawn for the update: gain .566 for P
// = Q = 1, R = .5.
TEST(Traps, SigmaPointsOfTheUpdateAreThoseOfThePredictedBelief) {
  expect_gain(Kalman{Walk{}});
  expect_gain(Ekf{Walk{}});
  expect_gain(Ukf{Walk{}});
  expect_gain(SquareRootUkf{Walk{}});
  expect_gain(Ukf{Walk{}, Unscented{.alpha = 1e-3, .kappa = 2.0}});
}

// vortex-vkf drew its sigma points from matrixLLT(): their covariance was P only for diagonal P.
TEST(Traps, SigmaPointsHaveTheCovarianceOfACorrelatedBelief) {
  const Gaussian<4> belief = first_belief();
  const Cholesky<4> root(belief.covariance);
  ASSERT_TRUE(root.ok());
  const Unscented unscented{.alpha = 0.7, .kappa = 1.0};
  const auto points =
      sigma_points<double, 4>(belief.mean, root.lower(), unscented.spread<double>(4));
  const Mat<double, 4, 8> differences = points.colwise() - belief.mean;
  EXPECT_TRUE(matrices_near(
      Mat<double, 4, 4>(unscented.weight<double>(4) * differences * differences.transpose()),
      belief.covariance, {.absolute = 1e-10, .relative = 1e-12}));
}

TEST(Unscented, WrongParametersAreNamed) {
  const auto complaint = [](const Unscented& unscented) -> std::string {
    try {
      Ukf{kMotion, unscented};
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(complaint({}), "");
  EXPECT_NE(complaint({.alpha = 0.0}).find("alpha"), std::string::npos);
  EXPECT_NE(complaint({.beta = std::nan("")}).find("beta"), std::string::npos);
  for (const double kappa : {-4.0, std::numeric_limits<double>::infinity()})
    EXPECT_NE(complaint({.kappa = kappa}).find("kappa"), std::string::npos);
  for (const Unscented& far_or_near : {Unscented{.alpha = 1e-6}, Unscented{.alpha = 1e-170},
                                       Unscented{.kappa = -4 + 1e-12}, Unscented{.alpha = 1e5}})
    EXPECT_NE(complaint(far_or_near), "");
  EXPECT_EQ(complaint({.alpha = 1e-4}), "");
  EXPECT_THROW((Ukf<CoordinatedTurn, float>{kMotion, {.alpha = 1e-3}}), std::invalid_argument);
  EXPECT_THROW((SquareRootUkf{kMotion, Unscented{.alpha = 1.0, .beta = 0.5}}),
               std::invalid_argument);
}

/// The spread of the points matters little to a turn at a known rate, whatever is allowed.
TEST(Unscented, NearPointsFindWhatFarOnesFind) {
  const RangeBearing radar;
  const auto north_m = [&](auto scalar, double alpha) {
    using Scalar = decltype(scalar);
    Ukf<CoordinatedTurn, Scalar> filter{kMotion, {.alpha = alpha}};
    EXPECT_EQ(filter.start(test::five_km_off<Scalar>()), Status::kOk);
    for (int scan = 0; scan < 10; ++scan) {
      EXPECT_EQ(filter.predict(Scalar(3)), Status::kOk);
      EXPECT_TRUE(filter.update(radar, test::plot_of<Scalar>(3000.0 - 5 * scan, 4000.0)));
    }
    return double(filter.estimate().mean[0]);
  };
  EXPECT_NEAR(north_m(0.0, 1e-4), north_m(0.0, 0.01), 0.01);
  EXPECT_NEAR(north_m(0.0F, 0.06), north_m(0.0, 0.06), 2.0);
}

/// y = x² of a normal x has mean m² + s² and variance 4 m² s² + 2 s⁴: what the transform must find
/// for beta = 2.
TEST(Unscented, SquareOfANormalVariable) {
  for (const double alpha : {1.0, 0.1, 1e-3}) {
    const Unscented unscented{.alpha = alpha, .beta = 2.0, .kappa = 0.0};
    const double mean = 3.0, std = 0.7;
    const auto points = sigma_points<double, 1>(Vec<double, 1>(mean), Mat<double, 1, 1>(std),
                                                unscented.spread<double>(1));
    const Vec<double, 1> centre(mean * mean);
    const Mat<double, 1, 2> differences = points.array().square() - mean * mean;
    const Gaussian<1> moments = unscented_moments<double, 1, 2>(unscented, 1, centre, differences);
    EXPECT_NEAR(moments.mean[0], mean * mean + std * std, 1e-8) << alpha;
    EXPECT_NEAR(moments.covariance(0, 0), 4 * mean * mean * std * std + 2 * std * std * std * std,
                1e-4)
        << alpha;
  }
}

}  // namespace
}  // namespace wakeline::linear_equality_test
