// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/reported.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/track/config.hpp"

namespace wakeline::reported_test {
namespace {

using test::Draw;

/// NIS of a plot whose errors are as stated.
double nis(Draw& draw) {
  const double a = draw.normal(), b = draw.normal();
  return a * a + b * b;
}

/// What a radar has learned from a target whose whitened innovations have the variance `shown`, of
/// which the part `stays` is the same at each look, and which are outliers as often and as far as
/// the default settings say where `outliers`.
struct Errors {
  double shown = 1.0, stays = 0.0;
  bool outliers = false;
};

LearnedErrors learned(std::uint64_t seed, int looks, const Errors& of) {
  const TrackerConfig config;
  Draw draw(seed);
  LearnedErrors errors;
  const auto vector = [&](double variance) -> Vec<double, 2> {
    return std::sqrt(variance) * draw.normals<2>();
  };
  // Of a length that does not vary from radar to radar.
  const double angle_rad = draw.uniform(0.0, 2.0 * kPi<double>);
  const Vec<double, 2> same = std::sqrt(2.0 * of.stays * of.shown) *
                              Vec<double, 2>(std::cos(angle_rad), std::sin(angle_rad));
  Vec<double, 2> before = Vec<double, 2>::Zero();
  for (int k = 0; k < looks; ++k) {
    const bool is_outlier = of.outliers && draw.uniform(0.0, 1.0) < config.outlier_probability;
    const double variance = is_outlier ? config.outlier_variance() : 1.0;
    const Vec<double, 2> innovation = same + vector((1.0 - of.stays) * of.shown * variance);
    errors.learn(innovation.squaredNorm(), innovation.dot(before));
    before = innovation;
  }
  return errors;
}

/// The means over many radars.
struct Mean {
  double stays = 0.0, scale = 0.0, of_large_weight = 0.0;
};

Mean mean_learned(int looks, const Errors& of) {
  constexpr int kRadars = 200;
  Mean mean;
  for (std::uint64_t seed = 0; seed < kRadars; ++seed) {
    const LearnedErrors errors = learned(seed, looks, of);
    mean.stays += errors.stays() / kRadars;
    mean.scale += errors.scale(0.0) / kRadars;
    mean.of_large_weight += errors.scale(1.0) / kRadars;
  }
  return mean;
}

TEST(LearnedErrors, AreTheStatedOnesBeforeALookAndWhereTheseCome) {
  EXPECT_EQ(LearnedErrors{}.stays(), 0.0);
  EXPECT_EQ(LearnedErrors{}.scale(1.0), 1.0);
  for (const int looks : {20, 100, 1000}) {
    const Mean mean = mean_learned(looks, {});
    EXPECT_LT(mean.stays, 0.01) << looks;
    EXPECT_NEAR(mean.scale, 1.0, 0.1) << looks;
  }
}

TEST(LearnedErrors, DoNotStayWhereTheyAreIndependent) {
  for (const double shown : {0.3, 0.5, 2.0, 4.0}) {
    const Mean mean = mean_learned(500, {shown});
    EXPECT_LT(mean.stays, 0.01) << shown;
    EXPECT_GT(mean.scale, 0.85 * shown) << shown;
    EXPECT_LT(mean.scale, (shown < 1.0 ? 1.5 : 1.15) * shown) << shown;
  }
}

TEST(LearnedErrors, LeaveACovarianceOfAnEstimateThatErrsByNothing) {
  LearnedErrors errors;
  for (int k = 0; k < 5000; ++k) errors.learn(1e-12, 0.0);
  EXPECT_GE(errors.scale(0.1), 0.1);
  EXPECT_TRUE(std::isfinite(errors.stays()));
}

// An outlier is not like the plot before: it makes the estimate worse, but does not stay in it.
TEST(LearnedErrors, DoNotStayWhereOutliersAreIndependent) {
  const Mean mean = mean_learned(500, {.outliers = true});
  EXPECT_LT(mean.stays, 0.01);
  EXPECT_GT(mean.scale, 1.4);
  EXPECT_LT(mean.scale, 2.0);
  EXPECT_LT(mean_learned(500, {.shown = 0.3, .outliers = true}).stays, 0.01);
}

TEST(LearnedErrors, AreAlsoOfTheCourseWhereAPlotHasALargeWeight) {
  const Mean mean = mean_learned(500, {2.0});
  EXPECT_NEAR((mean.of_large_weight - 1.0) / (mean.scale - 1.0), 2.5, 1e-6);
}

TEST(LearnedErrors, StayWhereInnovationsAreAlike) {
  for (const double part : {0.3, 0.6, 0.9}) {
    const Mean mean = mean_learned(500, {1.0 / (1.0 - part), part});
    EXPECT_NEAR(mean.stays, 0.5 * part / (1.0 - part), 0.1 / (1.0 - part)) << part;
    EXPECT_NEAR(mean.scale, 1.0, 0.1) << part << ", the others are as stated";
  }
}

TEST(LearnedErrors, StayWhereInnovationsDoNotShowThem) {
  for (const double shown : {0.5, 0.3}) {
    const double stays = mean_learned(500, {shown, 0.6}).stays;
    EXPECT_NEAR(stays, 1.0 / shown - 1.0, 0.35 / shown) << shown;
    EXPECT_GT(stays, 0.9 * (1.0 / shown - 1.0)) << shown;
  }
}

// An outlier in ten does not hide that the others are half of what is stated.
TEST(LearnedErrors, StayBesideOutliers) {
  Draw draw(4);
  LearnedErrors errors;
  for (int k = 0; k < 1000; ++k) {
    const double square = k % 10 == 0 ? 1e6 : 0.4 * nis(draw);
    errors.learn(square, 0.6 * square);
  }
  EXPECT_GT(errors.stays(), 0.8);
  EXPECT_LT(errors.stays(), 2.5);
}

// Targets of one range, seen in directions that err by s: what the line of sight leaves out.
TEST(BentLineOfSight, HasTheMeanSquareOfItsDepth) {
  constexpr double kRange_m = 40e3, kStd_rad = 0.03;
  const Vec<double, 2> u = towards(1.0), across(-u[1], u[0]);
  const double s_m = kRange_m * kStd_rad;
  const Mat<double, 2, 2> p = s_m * s_m * across * across.transpose() + 9.0 * u * u.transpose();
  Draw draw(6);
  double square = 0.0;
  constexpr int kDraws = 20'000;
  for (int k = 0; k < kDraws; ++k) {
    const double depth_m = kRange_m * (1.0 - std::cos(kStd_rad * draw.normal()));
    square += depth_m * depth_m / kDraws;
  }
  const Mat<double, 2, 2> bent = bent_m2(kRange_m * u, p);
  EXPECT_NEAR(u.dot(bent * u) / square, 1.0, 0.05);
  EXPECT_NEAR(across.dot(bent * across), 0.0, 1e-6);
  EXPECT_EQ(bent_m2({1.0, 2.0}, p), (Mat<double, 2, 2>::Zero())) << "about the antenna itself";
}

TEST(Reported, AddsWhatStaysAndAnAlterationThatDoesNotShow) {
  Draw draw(7);
  const Gaussian<4> belief{{100.0, 6.0, -50.0, 8.0}, draw.definite<4>()};
  Mat<double, 2, 2> stays;
  stays << 9.0, 2.0, 2.0, 4.0;
  const Gaussian<4> found = reported(belief, 1.0, 1.0, 100, 1.0, stays);
  EXPECT_EQ(found.mean, belief.mean);
  const Mat<double, 4, 4> more = found.covariance - belief.covariance;
  const Vec<double, 4> ahead(0.0, 0.6, 0.0, 0.8), abeam(0.0, -0.8, 0.0, 0.6);
  EXPECT_NEAR(std::sqrt(ahead.dot(more * ahead)) / 10.0, 0.02, 1e-12) << "of the speed";
  EXPECT_NEAR(std::sqrt(abeam.dot(more * abeam)) / 10.0, 0.06, 1e-12) << "of the course";
  EXPECT_NEAR(ahead.dot(more * abeam), 0.0, 1e-12);
  EXPECT_NEAR(more(0, 0), 9.0, 1e-12);
  EXPECT_NEAR(more(0, 2), 2.0, 1e-12);
  EXPECT_NEAR(more(2, 2), 4.0, 1e-12);
  EXPECT_TRUE(Cholesky<4>(found.covariance).ok());
}

/// A filter of one axis that takes plots for ones of variance 1, as it allows for outliers, which
/// have 0.9, with a period of 1 and noise that its target does not have: its variance, the gain,
/// and the variance of its error, all of the position and settled.
struct SettledFilter {
  explicit SettledFilter(double psd) {
    Mat<double, 2, 2> step, noise, p = Mat<double, 2, 2>::Identity(), error = p;
    step << 1.0, 1.0, 0.0, 1.0;
    noise << psd / 3, psd / 2, psd / 2, psd;
    for (int k = 0; k < 2000; ++k) {
      p = step * p * step.transpose() + noise;
      const Vec<double, 2> weight = p.col(0) / (p(0, 0) + 1.0);
      Mat<double, 2, 2> keep = Mat<double, 2, 2>::Identity();
      keep.col(0) -= weight;
      p = keep * p;
      error = keep * step * error * step.transpose() * keep.transpose() +
              0.9 * weight * weight.transpose();
    }
    variance = gain = p(0, 0);
    error_variance = error(0, 0);
  }
  double variance, gain, error_variance;
};

// On a straight course: neither too small, nor larger than by a fifth where the gain is small.
TEST(Reported, IsTheErrorOfAFilterWhoseNoiseDoesNotCome) {
  for (const double psd : {1e-7, 1e-6, 1e-5, 1e-3, 0.1, 10.0}) {
    const SettledFilter filter(psd);
    Gaussian<4> belief{Vec<double, 4>::Zero(), Mat<double, 4, 4>::Identity()};
    belief.covariance(0, 0) = belief.covariance(2, 2) = filter.variance;
    const Gaussian<4> found =
        reported(belief, filter.variance, filter.gain, 2000, 1.0, Mat<double, 2, 2>::Zero());
    const double ratio = found.covariance(0, 0) / filter.error_variance;
    EXPECT_GE(ratio, 1.0) << filter.gain;
    EXPECT_LT(ratio, filter.gain < 0.05 ? 1.2 : 1.5) << filter.gain;
    EXPECT_EQ(found.covariance(0, 0), found.covariance(2, 2));
  }
}

// Of a vessel that makes way the place along its course is known better than the filter says, and
// by no more than a filter without noise knows; that across it is known no better.
TEST(Reported, KnowsAVesselThatMakesWayBetterAlongItsCourse) {
  const Vec<double, 2> along(0.6, 0.8), across(-0.8, 0.6);
  for (const double psd : {1e-6, 1e-5, 1e-3, 0.1}) {
    const SettledFilter filter(psd);
    Gaussian<4> belief{{0.0, 6.0, 0.0, 8.0}, Mat<double, 4, 4>::Identity()};
    belief.covariance(0, 0) = belief.covariance(2, 2) = filter.variance;
    const Mat<double, 2, 2> found = position_in(reported(belief, filter.variance, filter.gain, 2000,
                                                         1.0, Mat<double, 2, 2>::Zero()))
                                        .covariance;
    EXPECT_LE(along.dot(found * along), filter.variance) << filter.gain;
    EXPECT_GE(along.dot(found * along) / filter.error_variance, 0.75) << filter.gain;
    EXPECT_GE(across.dot(found * across), filter.variance) << filter.gain;
    EXPECT_NEAR(along.dot(found * across), 0.0, 1e-12);
  }
}

TEST(Reported, IsACovarianceHoweverMuchIsLeftOut) {
  Draw draw(10);
  for (int k = 0; k < 100; ++k) {
    const Gaussian<4> belief{10.0 * draw.normals<4>(), draw.definite<4>()};
    const Gaussian<4> found = reported(belief, 100.0, 0.01, 2000, 1.0, Mat<double, 2, 2>::Zero());
    EXPECT_TRUE(Cholesky<4>(found.covariance).ok());
  }
}

TEST(Reported, LeavesOutNothingOfWhatAPredictionAdds) {
  const Mat<double, 2, 2> none = Mat<double, 2, 2>::Zero();
  const Gaussian<4> estimate{Vec<double, 4>::Zero(), 4.0 * Mat<double, 4, 4>::Identity()};
  Gaussian<4> later = estimate;
  later.covariance(0, 0) = later.covariance(2, 2) = 25.0;
  const double left_out = 4.0 - reported(estimate, 4.0, 0.01, 2000, 1.0, none).covariance(0, 0);
  EXPECT_GT(left_out, 1.0);
  EXPECT_NEAR(25.0 - reported(later, 4.0, 0.01, 2000, 1.0, none).covariance(0, 0), left_out, 1e-12);
}

// The factor is of what the filter knows; what a prediction adds is not of the radar.
TEST(Reported, ScalesTheVarianceOfTheEstimate) {
  const Mat<double, 2, 2> none = Mat<double, 2, 2>::Zero();
  Gaussian<4> belief{Vec<double, 4>::Zero(), 4.0 * Mat<double, 4, 4>::Identity()};
  for (const double scale : {0.1, 0.5, 3.0}) {
    const Gaussian<4> now = reported(belief, 4.0, 1.0, 100, scale, none);
    EXPECT_NEAR(now.covariance(0, 0), 4.0 * scale, 1e-12);
    EXPECT_EQ(now.covariance(1, 1), 4.0) << "of the velocity";
    EXPECT_GT(reported(belief, 4.0, 0.01, 2000, scale, none).covariance(2, 2), 0.6 * 4.0 * scale);
    Gaussian<4> later = belief;
    later.covariance(0, 0) = later.covariance(2, 2) = 25.0;
    EXPECT_NEAR(reported(later, 4.0, 1.0, 100, scale, none).covariance(0, 0), 21.0 + 4.0 * scale,
                1e-12);
  }
}

TEST(GainOfATrack, IsTheWeightOfAPlotWhereOneRadarSeesIt) {
  Track track;
  track.kinematics.covariance = 25.0 * Mat<double, 4, 4>::Identity();
  track.plot_m2 = 100.0;
  EXPECT_DOUBLE_EQ(track.gain(), 0.25);
  track.seen_until_s = track.time_s + 1.0;
  EXPECT_EQ(track.gain(), 1.0);
}

TEST(Reported, KeepsTheCovarianceOfAPlot) {
  Draw draw(8);
  const Gaussian<4> belief{Vec<double, 4>::Zero(), draw.definite<4>()};
  for (const double gain : {1.0, 1.7})
    EXPECT_EQ(reported(belief, 1.0, gain, 100, 1.0, Mat<double, 2, 2>::Zero()).covariance,
              belief.covariance);
}

// A line through all plots since the start, however small its gain: no noise was allowed for.
TEST(Reported, KeepsTheCovarianceOfALineThroughAllPlots) {
  Draw draw(9);
  const Gaussian<4> belief{Vec<double, 4>::Zero(), draw.definite<4>()};
  for (const int plots : {5, 40, 400}) {
    const double gain = 2.0 * (2 * plots - 1) / (plots * (plots + 1.0));
    EXPECT_EQ(reported(belief, 1.0, gain, plots, 1.0, Mat<double, 2, 2>::Zero()).covariance,
              belief.covariance);
  }
}

}  // namespace
}  // namespace wakeline::reported_test
