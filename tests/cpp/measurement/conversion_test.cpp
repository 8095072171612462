// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <stdexcept>
#include <string>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"

namespace wakeline::conversion_test {
namespace {

using test::Draw;
using test::matrices_near;

/// Mean error and mean NEES of converted plots of one target.
struct Score {
  Vec<double, 2> bias = Vec<double, 2>::Zero();
  double nees = 0.0;
};

Score score_conversion(const ConvertedRangeBearing& radar, const Vec<double, 2>& target,
                       int draws) {
  Draw draw(11);
  const RangeBearing truth{.bearing_offset_rad = radar.bearing_offset_rad, .own = radar.own};
  const Vec<double, 2> exact = truth.measure(target);
  Score score;
  for (int k = 0; k < draws; ++k) {
    const Vec<double, 2> z = exact + Vec<double, 2>(radar.range_std_m * draw.normal(),
                                                    radar.bearing_std_rad * draw.normal());
    const Gaussian<2> fix = radar.observe(z);
    const Vec<double, 2> error = fix.mean - target;
    const Cholesky<2> cholesky(fix.covariance);
    EXPECT_TRUE(cholesky.ok());
    score.bias += error / draws;
    score.nees += cholesky.whiten<1>(error).squaredNorm() / draws;
  }
  return score;
}

// 30 km, 3 degrees, 50 m: the plain conversion puts the plot r sb²/2 = 41 m short, nearly the range
// error.
TEST(Conversion, UnbiasedHasNoBiasWhereThePlainOneHas) {
  constexpr int kDraws = 40'000;
  const OwnShip own{.north_m = 500, .east_m = -800};
  for (const double bearing : {0.3, 2.0, -3.1}) {
    const Vec<double, 2> u = towards(bearing);
    const Vec<double, 2> target = own.position<double>() + 30e3 * u;
    ConvertedRangeBearing radar{.range_std_m = 50, .bearing_std_rad = deg(3), .own = own};
    const Score unbiased = score_conversion(radar, target, kDraws);
    // Four standard errors: about 77 m along and 1570 m across, over sqrt(40 000).
    EXPECT_NEAR(unbiased.bias.dot(u), 0.0, 4 * 77.0 / 200);
    EXPECT_NEAR(unbiased.bias.dot(Vec<double, 2>(-u[1], u[0])), 0.0, 4 * 1570.0 / 200);
    EXPECT_NEAR(unbiased.nees, 2.0, 0.15);

    radar.unbiased = false;
    const Score plain = score_conversion(radar, target, kDraws);
    EXPECT_NEAR(plain.bias.dot(u), -30e3 * deg(3) * deg(3) / 2, 4 * 77.0 / 200);
    EXPECT_GT(plain.nees, 3.0) << "over-confident";
  }
}

TEST(Conversion, BothAgreeWhereTheBearingIsPrecise) {
  const Vec<double, 2> z(8000, 0.7);
  const ConvertedRangeBearing unbiased{.range_std_m = 30, .bearing_std_rad = 1e-4};
  ConvertedRangeBearing plain = unbiased;
  plain.unbiased = false;
  EXPECT_TRUE(matrices_near(unbiased.observe(z).mean, plain.observe(z).mean,
                            {.absolute = 0, .relative = 1e-8}));
  EXPECT_TRUE(matrices_near(unbiased.observe(z).covariance, plain.observe(z).covariance,
                            {.absolute = 0, .relative = 1e-6}));
}

TEST(Conversion, PlainCovarianceIsAlignedWithTheBearing) {
  ConvertedRangeBearing radar{.range_std_m = 30, .bearing_std_rad = deg(1), .unbiased = false};
  const Gaussian<2> north = radar.observe(Vec<double, 2>(1000, 0));
  Mat<double, 2, 2> expected;
  expected << 900, 0, 0, std::pow(1000 * deg(1), 2);
  EXPECT_TRUE(matrices_near(north.covariance, expected));
  EXPECT_TRUE(matrices_near(north.mean, Vec<double, 2>(1000, 0)));
  // It turns with the plot.
  for (int k = 0; k < 12; ++k) {
    const double b = deg(30.0 * k);
    Mat<double, 2, 2> turn;
    turn << std::cos(b), -std::sin(b), std::sin(b), std::cos(b);
    const Gaussian<2> fix = radar.observe(Vec<double, 2>(1000, b));
    EXPECT_TRUE(matrices_near(fix.covariance, Mat<double, 2, 2>(turn * expected * turn.transpose()),
                              {.absolute = 1e-9, .relative = 1e-9}));
    EXPECT_TRUE(
        matrices_near(fix.mean, (turn * north.mean).eval(), {.absolute = 1e-9, .relative = 1e-9}));
  }
}

template <class Scalar>
class ConversionOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(ConversionOf, Scalars, );

TYPED_TEST(ConversionOf, CovarianceIsPositiveDefiniteAtEveryRange) {
  using Scalar = TypeParam;
  for (const double range : {0.0, 1e-3, 1.0, 100.0, 1e4, 1e5})
    for (const double bearing_std : {deg(0.01), deg(0.1), deg(1.0), deg(10.0), 1.0}) {
      // At zero range the axes of the ellipse are as sb : 1, squared in the covariance: beyond
      // float at 0.01 degrees.
      if (sizeof(Scalar) == 4 && bearing_std < deg(0.1)) continue;
      const ConvertedRangeBearing radar{.range_std_m = 20, .bearing_std_rad = bearing_std};
      const Gaussian<2, Scalar> fix = radar.observe(Vec<Scalar, 2>(Scalar(range), Scalar(2)));
      EXPECT_TRUE(test::is_covariance(fix.covariance)) << range << ", " << bearing_std;
    }
}

// At the radar itself the plain form claims to know the position across the bearing exactly: a
// stated limit. With an extent of the echo it does not.
TEST(Conversion, PlainNeedsAnExtentAtTheRadarItself) {
  ConvertedRangeBearing radar{.unbiased = false};
  const Vec<double, 2> z(0, 0.4);
  EXPECT_TRUE(is_finite(radar.observe(z).covariance));
  EXPECT_NEAR(radar.observe(z).covariance.determinant(), 0.0, 1e-9);
  radar.extent_std_m = 3;
  EXPECT_TRUE(test::is_covariance(radar.observe(z).covariance));
}

TEST(Conversion, ReportsWhenTheBiasMatters) {
  EXPECT_TRUE(conversion_bias_matters(30e3, 50, deg(3)));
  EXPECT_FALSE(conversion_bias_matters(3e3, 50, deg(1)));
  const double limit = 0.4 * 50 / (deg(3) * deg(3));
  EXPECT_TRUE(conversion_bias_matters(limit * 1.001, 50, deg(3)));
  EXPECT_FALSE(conversion_bias_matters(limit * 0.999, 50, deg(3)));
  // What it says: twice the bias over the range error.
  const ConvertedRangeBearing plain{
      .range_std_m = 50, .bearing_std_rad = deg(3), .unbiased = false};
  const double bias = -score_conversion(plain, Vec<double, 2>(30e3, 0), 40'000).bias[0];
  EXPECT_NEAR(2 * bias / 50, conversion_bias_ratio(30e3, 50, deg(3)), 0.07);
}

TEST(Errors, HeadingErrorIsABearingError) {
  const OwnShip rolling{.heading_std_rad = 0.03};
  const Vec<double, 2> z(2000, 0.5);
  EXPECT_NEAR((RangeBearing{.bearing_std_rad = 0.04, .own = rolling}.observe(z).covariance(1, 1)),
              0.05 * 0.05, 1e-15);
  for (const bool unbiased : {false, true}) {
    const ConvertedRangeBearing with{.bearing_std_rad = 0.04, .unbiased = unbiased, .own = rolling};
    const ConvertedRangeBearing same{.bearing_std_rad = 0.05, .unbiased = unbiased};
    EXPECT_TRUE(matrices_near(with.observe(z).covariance, same.observe(z).covariance));
    EXPECT_TRUE(matrices_near(with.observe(z).mean, same.observe(z).mean));
  }
}

TEST(Errors, ExtentAndOwnPositionCountPerAxis) {
  const OwnShip own{.position_std_m = 4};
  const Vec<double, 2> z(2000, 0.5);
  const Gaussian<2> plain = RangeBearing{}.observe(z);
  const Gaussian<2> wide = RangeBearing{.extent_std_m = 3, .own = own}.observe(z);
  EXPECT_NEAR(wide.covariance(0, 0) - plain.covariance(0, 0), 25, 1e-9);
  EXPECT_NEAR((wide.covariance(1, 1) - plain.covariance(1, 1)) * 2000 * 2000, 25, 1e-9);
  const Gaussian<2> point = ConvertedRangeBearing{}.observe(z);
  const Gaussian<2> hull = ConvertedRangeBearing{.extent_std_m = 3, .own = own}.observe(z);
  EXPECT_TRUE(matrices_near(Mat<double, 2, 2>(hull.covariance - point.covariance),
                            (25 * Mat<double, 2, 2>::Identity()).eval(),
                            {.absolute = 1e-9, .relative = 0}));
}

TEST(Errors, OffsetTurnsThePlotBack) {
  const ConvertedRangeBearing radar{.bearing_offset_rad = deg(2)};
  const ConvertedRangeBearing exact{};
  EXPECT_TRUE(matrices_near(radar.observe(Vec<double, 2>(1000, deg(92))).mean,
                            exact.observe(Vec<double, 2>(1000, deg(90))).mean,
                            {.absolute = 1e-9, .relative = 1e-12}));
}

TEST(Position, IsThePlotWithEqualErrors) {
  const Gaussian<2> fix = Position{.position_std_m = 7}.observe(Vec<double, 2>(3, -4));
  EXPECT_TRUE(matrices_near(fix.mean, Vec<double, 2>(3, -4), {0, 0}));
  EXPECT_TRUE(matrices_near(fix.covariance, (49 * Mat<double, 2, 2>::Identity()).eval(), {0, 0}));
}

template <class Sensor>
std::string complaint(const Sensor& sensor) {
  try {
    sensor.validate();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(SensorParameters, AWrongOneIsNamed) {
  EXPECT_EQ(complaint(RangeBearing{}), "");
  EXPECT_EQ(complaint(RangeBearingDoppler{}), "");
  EXPECT_EQ(complaint(ConvertedRangeBearing{}), "");
  EXPECT_EQ(complaint(Position{}), "");
  const double nan = std::nan("");
  for (const double degrees : {45.0, 90.0}) {
    EXPECT_NE(complaint(RangeBearing{.bearing_std_rad = degrees}).find("in radians"),
              std::string::npos);
  }
  for (const double bad : {-1.0, 0.0, nan}) {
    EXPECT_NE(complaint(RangeBearing{.range_std_m = bad}).find("range_std_m"), std::string::npos);
    EXPECT_NE(complaint(ConvertedRangeBearing{.bearing_std_rad = bad}).find("bearing_std_rad"),
              std::string::npos);
    EXPECT_NE(complaint(RangeBearingDoppler{.range_rate_std_mps = bad}).find("range_rate_std_mps"),
              std::string::npos);
    EXPECT_NE(complaint(Position{.position_std_m = bad}).find("position_std_m"), std::string::npos);
  }
  EXPECT_NE(complaint(RangeBearing{.extent_std_m = -1}).find("extent_std_m"), std::string::npos);
  EXPECT_NE(complaint(RangeBearing{.bearing_offset_rad = nan}).find("bearing_offset_rad"),
            std::string::npos);
  EXPECT_NE(complaint(RangeBearing{.own = {.north_m = nan}}).find("own.north_m"),
            std::string::npos);
  EXPECT_NE(
      complaint(RangeBearingDoppler{.own = {.heading_std_rad = -1}}).find("own.heading_std_rad"),
      std::string::npos);
}

/// Mean and covariance of what `of(plot)` makes of plots of one target.
template <class Function>
Gaussian<2> moments(const PolarErrors& errors, const Vec<double, 2>& target, const Function& of) {
  constexpr int kDraws = 40'000;
  Draw draw(12);
  const Vec<double, 2> exact = RangeBearing{.own = errors.own}.measure(target);
  Vec<double, 2> sum = Vec<double, 2>::Zero();
  Mat<double, 2, 2> squares = Mat<double, 2, 2>::Zero();
  for (int k = 0; k < kDraws; ++k) {
    const Gaussian<2> plot =
        of(errors.position<double>(exact[0] + errors.range_std_m * draw.normal(),
                                   exact[1] + errors.bearing_std_rad * draw.normal(), true));
    const Vec<double, 2> error = plot.mean - target;
    sum += error / kDraws;
    squares += error * error.transpose() / kDraws;
  }
  return {sum, squares - sum * sum.transpose()};
}

// Where the target is known, the covariance is that of its plots, whatever they read.
TEST(ConvertedErrors, AreTheMomentsOfThePlotsOfATarget) {
  const PolarErrors errors{40.0, deg(3), 0.0, 0.0, {.north_m = 300.0, .east_m = -100.0}};
  for (const double range_m : {200.0, 4e3, 30e3}) {
    const Vec<double, 2> target = errors.own.position<double>() + range_m * towards(2.0);
    const Gaussian<2> known{target, 1e-6 * Mat<double, 2, 2>::Identity()};
    const auto at = [&](const Gaussian<2>& plot) { return errors.converted().at(plot, known); };
    const Gaussian<2> found = moments(errors, target, at);
    const Mat<double, 2, 2> said = at({target, Mat<double, 2, 2>::Identity()}).covariance;
    const Cholesky<2> cholesky(said);
    ASSERT_TRUE(cholesky.ok());
    // Whitened, so that the short axis counts as much as the long one.
    const Mat<double, 2, 2> once = cholesky.whiten<2>(found.covariance);
    const Mat<double, 2, 2> white = cholesky.whiten<2>(Mat<double, 2, 2>(once.transpose()));
    EXPECT_LT((white - Mat<double, 2, 2>::Identity()).norm(), 0.06) << range_m;
    EXPECT_LT(cholesky.whiten<1>(found.mean).norm(), 4.0 / 200.0);
    const auto in_sight = [&](const Gaussian<2>& plot) {
      return errors.converted().in_sight(plot, known);
    };
    const Gaussian<2> sight = moments(errors, target, in_sight);
    const Mat<double, 2, 2> narrow = in_sight({target, {}}).covariance;
    EXPECT_NEAR(sight.covariance.trace() / narrow.trace(), 1.0, 0.03) << range_m;
    EXPECT_NEAR(towards(2.0).dot(sight.covariance * towards(2.0)), 1600.0, 60.0) << range_m;
  }
}

TEST(ConvertedErrors, AddTheErrorsOfOwnShipAndEcho) {
  const PolarErrors bare{40.0, deg(1), 0.0, 0.0, {}};
  PolarErrors all = bare;
  all.extent_std_m = 3.0;
  all.own.position_std_m = 4.0;
  const Gaussian<2> target{{3000.0, 4000.0}, 100.0 * Mat<double, 2, 2>::Identity()};
  const Gaussian<2> plot{{3010.0, 3990.0}, Mat<double, 2, 2>::Identity()};
  for (const bool sight : {false, true}) {
    const auto of = [&](const PolarErrors& errors) {
      return sight ? errors.converted().in_sight(plot, target)
                   : errors.converted().at(plot, target);
    };
    EXPECT_TRUE(matrices_near((of(all).covariance - of(bare).covariance).eval(),
                              (25.0 * Mat<double, 2, 2>::Identity()).eval(),
                              {.absolute = 1e-8, .relative = 0}));
  }
}

}  // namespace
}  // namespace wakeline::conversion_test
