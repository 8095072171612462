// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/leeway.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/navigation/dead_reckoning.hpp"
#include "wakeline/navigation/drift_forecast.hpp"

namespace wakeline::leeway_test {
namespace {

using Vec2 = Vec<double, 2>;
using Mat2 = Mat<double, 2, 2>;

TEST(Leeway, OfEveryObjectGoesDownwind) {
  const Vec2 wind(6, -8);
  for (const FloatingObject object : {FloatingObject::kBuoy, FloatingObject::kDinghy,
                                      FloatingObject::kLaunch, FloatingObject::kShip}) {
    const LeewayFactor k = leeway_factor(object);
    EXPECT_GT(k.least, 0.0);
    EXPECT_LE(k.least, k.greatest);
    const Vec2 drift = wind_drift_mps(wind, k.middle());
    EXPECT_NEAR(drift.norm() / knots(1), 1.944 * k.middle() * 10, 1e-3);
    EXPECT_NEAR(drift[0] * wind[1], drift[1] * wind[0], 1e-12);
    EXPECT_GT(drift.dot(wind), 0.0);
  }
}

TEST(Leeway, IsTheTableOfThePaper) {
  const auto expect = [](FloatingObject object, double least, double greatest) {
    EXPECT_EQ(leeway_factor(object).least, least);
    EXPECT_EQ(leeway_factor(object).greatest, greatest);
  };
  expect(FloatingObject::kBuoy, 0.012, 0.015);
  expect(FloatingObject::kDinghy, 0.032, 0.045);
  expect(FloatingObject::kLaunch, 0.065, 0.065);
  expect(FloatingObject::kShip, 0.056, 0.062);
  EXPECT_NEAR(leeway_factor(FloatingObject::kDinghy).std(), 0.003753, 1e-6);
}

TEST(WindCurrent, HasThePublishedSpeeds) {
  const auto speed_kn = [](double wind_mps, double latitude_deg) {
    return WindCurrent(deg(latitude_deg)).velocity_mps({wind_mps, 0}).norm() / knots(1);
  };
  EXPECT_NEAR(speed_kn(10, 20), 0.422, 5e-4);
  EXPECT_NEAR(speed_kn(10, 90), 0.247, 5e-4);
  EXPECT_NEAR(speed_kn(20, 20), 0.844, 5e-4);
  EXPECT_NEAR(speed_kn(20, -90), 0.494, 5e-4);
}

TEST(WindCurrent, TurnsWithTheHemisphere) {
  const SpeedCourse wind{10.0, deg(350)};
  const auto set = [&](double latitude) {
    return SpeedCourse::of(WindCurrent(latitude).velocity_mps(wind.velocity_mps())).course_rad;
  };
  EXPECT_NEAR(set(deg(50)), deg(35), 1e-12);
  EXPECT_NEAR(set(deg(-50)), deg(305), 1e-12);
}

TEST(WindCurrent, HasNoLawNearTheEquator) {
  for (const double latitude : {0.0, deg(19.99), deg(-19.99), 1.6, double(NAN)})
    EXPECT_THROW((WindCurrent(latitude)), std::invalid_argument);
  EXPECT_THROW(WindCurrent(deg(50.0), -0.01), std::invalid_argument);
  EXPECT_NO_THROW((WindCurrent(deg(-20.0))));
  try {
    const WindCurrent near(0.1);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("20 degrees"), std::string::npos);
  }
}

TEST(StokesDrift, IsThePublishedOneAndScales) {
  EXPECT_NEAR(stokes_drift_mps(2, 50), 0.1395, 5e-5);
  EXPECT_NEAR(stokes_drift_mps(4, 50) / stokes_drift_mps(2, 50), 4.0, 1e-12);
  EXPECT_NEAR(stokes_drift_mps(2, 200) / stokes_drift_mps(2, 50), 1.0 / 8, 1e-12);
}

const Gaussian<2> kStart{{100, -50}, Mat2{{2500, 300}, {300, 900}}};

TEST(DriftForecast, DoesNotDependOnHowTimeIsCut) {
  const DriftModel model = DriftModel::of(FloatingObject::kDinghy);
  DriftForecast once(model, kStart), often(model, kStart);
  EXPECT_EQ(once.advance(7200, {8, 3}, {0.2, -0.4}), Status::kOk);
  for (int k = 0; k < 720; ++k) EXPECT_EQ(often.advance(10, {8, 3}, {0.2, -0.4}), Status::kOk);
  EXPECT_LT((once.position().mean - often.position().mean).norm(), 1e-7);
  EXPECT_LT(
      test::covariance_difference<double>(once.position().covariance, often.position().covariance),
      1e-9);
  EXPECT_LT(
      (once.position().mean - kStart.mean - 7200 * Vec2(8 * 0.0385 + 0.2, 3 * 0.0385 - 0.4)).norm(),
      1e-7);
}

TEST(DriftForecast, GrowsAndNeverShrinks) {
  DriftForecast forecast(DriftModel{}, kStart);
  double area = UncertaintyEllipse::of(kStart.covariance, 0.9).area_m2;
  EXPECT_EQ(forecast.position().covariance, kStart.covariance);
  for (int k = 0; k < 48; ++k) {
    EXPECT_EQ(forecast.advance(1800, {k < 24 ? 8.0 : -8.0, 0}, {0, 0}), Status::kOk);
    const double now = UncertaintyEllipse::of(forecast.position().covariance, 0.9).area_m2;
    EXPECT_GT(now, area);
    area = now;
  }
  // The wind has blown back what it blew: the leeway that it depends on does not matter any more.
  EXPECT_NEAR(forecast.position().mean[0], kStart.mean[0], 1e-6);
}

std::vector<DriftParticle> cloud(const DriftModel& model, int count, std::uint64_t seed) {
  std::vector<DriftParticle> particles;
  for (int k = 0; k < count; ++k) particles.emplace_back(model, kStart, seed, std::uint64_t(k));
  return particles;
}

TEST(DriftParticles, HaveTheMomentsOfTheForecast) {
  DriftModel model;
  model.leeway_std = 0.01;
  for (const double residual_time_s : {60.0, 1800.0, 1e7}) {
    model.residual_time_s = residual_time_s;
    model.residual_std_mps = 0.3;
    DriftForecast forecast(model, kStart);
    constexpr int count = 20'000;
    std::vector<DriftParticle> particles = cloud(model, count, 7);
    for (int k = 0; k < 10; ++k) {
      const Vec2 wind(10, 0.5 * k), current(0.1, 0.1 * k);
      EXPECT_EQ(forecast.advance(300, wind, current), Status::kOk);
      for (DriftParticle& particle : particles) particle.advance(300, wind, current);
    }
    Vec2 mean = Vec2::Zero();
    for (const DriftParticle& particle : particles) mean += particle.position_m() / count;
    Mat2 covariance = Mat2::Zero();
    int inside = 0;
    const Gaussian<2> expected = forecast.position();
    const Cholesky<2> factor(expected.covariance);
    for (const DriftParticle& particle : particles) {
      const Vec2 off = particle.position_m() - mean;
      covariance += off * off.transpose() / count;
      inside += factor.squared_norm(particle.position_m() - expected.mean) <= -2 * std::log(0.1);
    }
    EXPECT_LT((mean - expected.mean).norm(), 5 * std::sqrt(expected.covariance.trace() / count));
    EXPECT_LT(test::covariance_difference<double>(covariance, expected.covariance), 0.05);
    EXPECT_NEAR(inside / double(count), 0.9, 0.01);
  }
}

TEST(DriftParticles, AreTheSameForTheSameSeedAndNumber) {
  const auto last = [](std::uint64_t seed, std::uint64_t index) {
    DriftParticle particle(DriftModel{}, kStart, seed, index);
    for (int k = 0; k < 20; ++k) particle.advance(60, {5, 5}, {0.1, 0});
    return particle.position_m();
  };
  EXPECT_EQ(last(1, 5), last(1, 5));
  EXPECT_NE(last(1, 5), last(1, 6));
  EXPECT_NE(last(1, 5), last(2, 5));
}

TEST(UncertaintyEllipse, HasTheAxesOfTheCovariance) {
  const double course = deg(160), major = 30, minor = 10;
  const Vec2 along(std::cos(course), std::sin(course)), across(-along[1], along[0]);
  const Mat2 covariance =
      major * major * along * along.transpose() + minor * minor * across * across.transpose();
  const double scale = std::sqrt(-2 * std::log(1 - 0.95));
  const UncertaintyEllipse ellipse = UncertaintyEllipse::of(covariance, 0.95);
  EXPECT_NEAR(ellipse.semi_major_m, scale * major, 1e-9);
  EXPECT_NEAR(ellipse.semi_minor_m, scale * minor, 1e-9);
  EXPECT_NEAR(ellipse.major_axis_rad, course, 1e-12);
  EXPECT_NEAR(ellipse.area_m2, kPi<double> * scale * scale * major * minor, 1e-6);
}

TEST(DriftForecast, RejectsInvalidParameters) {
  const auto with = [](auto change) {
    DriftModel model;
    change(model);
    return DriftForecast(model, kStart);
  };
  EXPECT_THROW(with([](DriftModel& m) { m.leeway = -0.1; }), std::invalid_argument);
  EXPECT_THROW(with([](DriftModel& m) { m.wind_std_mps = NAN; }), std::invalid_argument);
  EXPECT_THROW(with([](DriftModel& m) { m.residual_time_s = 0; }), std::invalid_argument);
  EXPECT_THROW(DriftForecast(DriftModel{}, {{0, 0}, Mat2::Zero()}), std::invalid_argument);
  DriftForecast forecast(DriftModel{}, kStart);
  EXPECT_EQ(forecast.advance(-1, {0, 0}, {0, 0}), Status::kNegativeTimeStep);
  EXPECT_EQ(forecast.advance(1, {NAN, 0}, {0, 0}), Status::kNotFinite);
  EXPECT_EQ(forecast.advance(1, {0, 0}, {0, INFINITY}), Status::kNotFinite);
  EXPECT_EQ(forecast.advance(1e10, {0, 0}, {0, 0}), Status::kNotFinite);
  EXPECT_EQ(forecast.advance(1, {1e10, 0}, {0, 0}), Status::kNotFinite);
  EXPECT_EQ(forecast.advance(1, {0, 0}, {0, 1e10}), Status::kNotFinite);
  EXPECT_EQ(forecast.position().mean, kStart.mean);
}

TEST(DriftForecast, NeedsNoHeap) {
  DriftForecast forecast(DriftModel{}, kStart);
  DriftParticle particle(DriftModel{}, kStart, 1, 2);
  const test::NoHeap fence;
  (void)forecast.advance(10, {1, 2}, {0, 0});
  particle.advance(10, {1, 2}, {0, 0});
  EXPECT_TRUE(std::isfinite(forecast.position().mean[0] + particle.position_m()[0]));
  EXPECT_EQ(fence.allocations(), 0);
}

}  // namespace
}  // namespace wakeline::leeway_test
