// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/drift.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"

namespace wakeline::drift_test {
namespace {

using test::Draw;
using Vec2 = Vec<double, 2>;
using Mat2 = Mat<double, 2, 2>;

const Mat2 kIdentity = Mat2::Identity();

/// The slope of the plain line through points.
Vec2 line_slope(const std::vector<double>& t, const std::vector<Vec2>& d) {
  double mean_t = 0, tt = 0;
  for (const double time : t) mean_t += time / double(t.size());
  Vec2 td = Vec2::Zero();
  for (std::size_t k = 0; k < t.size(); ++k) {
    td += (t[k] - mean_t) * d[k];
    tt += (t[k] - mean_t) * (t[k] - mean_t);
  }
  return td / tt;
}

TEST(DriftWindow, IsTheLeastSquaresLineWhereTheLogIsPerfect) {
  Draw draw(1);
  DriftWindow<> window({.max_fixes = 8});
  std::vector<double> times;
  std::vector<Vec2> differences;
  Vec2 reckoned = Vec2::Zero();
  double now = 0;
  for (int k = 0; k < 30; ++k) {
    const double dt = draw.uniform(1, 60), speed = draw.uniform(0, 8), heading = draw.uniform(0, 7);
    if (k > 0) {
      EXPECT_EQ(window.advance(dt, speed, heading), Status::kOk);
      reckoned += dt * speed * Vec2(std::cos(heading), std::sin(heading));
      now += dt;
    }
    const Vec2 fix = reckoned + 50 * draw.normals<2>();
    ASSERT_EQ(window.add({fix, 16 * kIdentity}), Status::kOk);
    times.push_back(now);
    differences.push_back(fix - reckoned);
    if (times.size() > 8) {
      times.erase(times.begin());
      differences.erase(differences.begin());
    }
    ASSERT_EQ(window.size(), int(times.size()));
    if (k == 0) continue;
    const Gaussian<2> drift = window.drift();
    EXPECT_LT((drift.mean - line_slope(times, differences)).norm(), 1e-8);
    double mean_t = 0, tt = 0;
    for (const double t : times) mean_t += t / double(times.size());
    for (const double t : times) tt += (t - mean_t) * (t - mean_t);
    EXPECT_NEAR(drift.covariance(0, 0) * tt / 16, 1.0, 1e-9);
    EXPECT_NEAR(drift.covariance(1, 0), 0.0, 1e-12);
  }
}

TEST(DriftWindow, IsTheEndPointsWhereTheFixesArePerfect) {
  DriftWindow<> window({.max_fixes = 5, .log_std_mps = 0.1, .heading_std_rad = 0.1});
  Draw draw(2);
  Vec2 last = Vec2::Zero();
  for (int k = 0; k < 5; ++k) {
    if (k > 0) {
      EXPECT_EQ(window.advance(10.0, 1.0, 0.0), Status::kOk);
    }
    last = k == 0 ? Vec2::Zero().eval() : Vec2(last + 10 * draw.normals<2>());
    EXPECT_EQ(window.add({last, 1e-8 * kIdentity}), Status::kOk);
  }
  EXPECT_LT((window.drift().mean - (last - Vec2(40, 0)) / 40).norm(), 1e-6);
}

struct Outcome {
  double rms_kn;
  double nees;
};

/// Many windows of fixes at 30 s of a ship of 10 kn in a current of 1.2 kn to 060.
Outcome many_windows(int fixes, double fix_std_m, int runs) {
  Draw draw(3);
  const double log = knots(0.1), gyro = deg(0.3);
  const Vec2 current = SpeedCourse{knots(1.2), deg(60)}.velocity_mps();
  double squared = 0, nees = 0;
  for (int run = 0; run < runs; ++run) {
    const SpeedCourse ship{knots(10), draw.uniform(0, 6.28)};
    DriftWindow<> window({.max_fixes = fixes, .log_std_mps = log, .heading_std_rad = gyro});
    Vec2 position = Vec2::Zero();
    for (int k = 0; k < fixes; ++k) {
      if (k > 0) {
        position += 30 * (ship.velocity_mps() + current);
        EXPECT_EQ(window.advance(30, ship.speed_mps + log * draw.normal(),
                                 ship.course_rad + gyro * draw.normal()),
                  Status::kOk);
      }
      EXPECT_EQ(
          window.add({position + fix_std_m * draw.normals<2>(), fix_std_m * fix_std_m * kIdentity}),
          Status::kOk);
    }
    const Gaussian<2> drift = window.drift();
    const Vec2 error = drift.mean - current;
    squared += error.squaredNorm() / runs;
    nees += Cholesky<2>(drift.covariance).squared_norm(error) / runs;
  }
  return {std::sqrt(squared) / knots(1), nees};
}

TEST(DriftWindow, FindsACurrentAndKnowsHowWell) {
  const double fix_std_m = 4 / std::sqrt(2.0);  // 4 m of distance, root mean square
  const Outcome five = many_windows(5, fix_std_m, 4000), twenty = many_windows(20, fix_std_m, 4000);
  RecordProperty("rms_kn_5", std::to_string(five.rms_kn));
  RecordProperty("rms_kn_20", std::to_string(twenty.rms_kn));
  EXPECT_LT(five.rms_kn, 0.11);
  EXPECT_LT(twenty.rms_kn, 0.030);
  EXPECT_NEAR(five.nees, 2.0, 0.13);
  EXPECT_NEAR(twenty.nees, 2.0, 0.13);
}

TEST(DriftWindow, OfErrorsOf4MetresAnAxisNeedsOneFixMore) {
  const Outcome five = many_windows(5 + 1, 4, 8000), twenty = many_windows(20 + 1, 4, 8000);
  RecordProperty("rms_kn_6", std::to_string(five.rms_kn));
  RecordProperty("rms_kn_21", std::to_string(twenty.rms_kn));
  EXPECT_LT(five.rms_kn, 0.11);
  EXPECT_LT(twenty.rms_kn, 0.030);
}

TEST(DriftWindow, OfAFixWithoutInformationIsThatOfTheOthers) {
  for (const double std_m : {1e6, 1e9, 1e15}) {
    DriftWindow<> with, without;
    for (int k = 0; k < 6; ++k) {
      if (k > 0) {
        EXPECT_EQ(with.advance(10, 0, 0), Status::kOk);
        EXPECT_EQ(without.advance(10, 0, 0), Status::kOk);
      }
      const bool blind = k == 2;
      const Gaussian<2> fix{Vec2(3 * k, k * k), (blind ? std_m * std_m : 1e-4) * kIdentity};
      EXPECT_EQ(with.add(fix), Status::kOk);
      if (!blind) {
        EXPECT_EQ(without.add(fix), Status::kOk);
      }
    }
    const Gaussian<2> drift = with.drift(), expected = without.drift();
    EXPECT_LT((drift.mean - expected.mean).norm(), 1e-9) << std_m;
    EXPECT_LT(test::covariance_difference(drift.covariance, expected.covariance), 1e-9) << std_m;
  }
}

TEST(DriftWindow, LeavesOutTheStepsInWhichTheShipAlters) {
  const Vec2 drift(0.3, -0.5);
  const double seconds = 30;
  DriftWindow<> ended({.alteration_mps = 0.5}), through;
  Vec2 position = Vec2::Zero();
  SpeedCourse ship{5.0, deg(10)};
  EXPECT_EQ(ended.add({position, kIdentity}), Status::kOk);
  EXPECT_EQ(through.add({position, kIdentity}), Status::kOk);
  for (int k = 1; k < 18; ++k) {
    const SpeedCourse before = ship;
    if (k % 6 == 3) ship = {k == 9 ? 7.0 : 5.0, ship.course_rad + deg(50)};
    // Log and gyro are read at the end of a step only, the ship has altered in its middle.
    position += seconds * (0.5 * (before.velocity_mps() + ship.velocity_mps()) + drift);
    for (auto* window : {&ended, &through}) {
      EXPECT_EQ(window->advance(seconds, ship.speed_mps, ship.course_rad), Status::kOk);
      EXPECT_EQ(window->add({position, kIdentity}), Status::kOk);
    }
    EXPECT_LT((ended.drift().mean - drift).norm(), 1e-9) << k;
    if (k > 2) {
      EXPECT_GT((through.drift().mean - drift).norm(), 0.05) << k;
    }
  }
}

TEST(DriftWindow, OfSeveralLinesHasTheirCommonSlope) {
  Draw draw(5);
  DriftWindow<> window({.alteration_mps = 0.5});
  Vec2 product = Vec2::Zero();
  double squared = 0;
  EXPECT_EQ(window.add({20 * draw.normals<2>(), 16 * kIdentity}), Status::kOk);
  window.clear();
  for (const int fixes : {5, 2, 6}) {  // each line at another speed
    std::vector<double> times;
    std::vector<Vec2> differences;
    for (int k = 0; k < fixes; ++k) {
      const double dt = draw.uniform(10, 60);
      EXPECT_EQ(window.advance(dt, fixes, 0.0), Status::kOk);
      times.push_back(k == 0 ? 0.0 : times.back() + dt);
      differences.push_back(20 * draw.normals<2>());
      const Vec2 reckoned(fixes * times.back(), 0.0);
      EXPECT_EQ(window.add({reckoned + differences.back(), 16 * kIdentity}), Status::kOk);
    }
    double mean_t = 0, tt = 0;
    for (const double t : times) mean_t += t / fixes;
    for (const double t : times) tt += (t - mean_t) * (t - mean_t);
    product += tt * line_slope(times, differences);
    squared += tt;
  }
  EXPECT_LT((window.drift().mean - product / squared).norm(), 1e-9);
  EXPECT_NEAR(window.drift().covariance(0, 0) * squared / 16, 1.0, 1e-9);
}

TEST(DriftWindow, IsUnknownBeforeTwoTimes) {
  DriftWindow<> window;
  EXPECT_FALSE(window.ready());
  EXPECT_TRUE(std::isinf(window.drift().covariance(0, 0)));
  EXPECT_EQ(window.add({Vec2(1, 2), kIdentity}), Status::kOk);
  EXPECT_EQ(window.add({Vec2(2, 2), kIdentity}), Status::kOk);
  EXPECT_FALSE(window.ready());
  EXPECT_DOUBLE_EQ(window.drift().covariance(1, 0), 0.0);
  EXPECT_EQ(window.advance(1.0, 0.0, 0.0), Status::kOk);
  EXPECT_EQ(window.add({Vec2(2, 2), kIdentity}), Status::kOk);
  EXPECT_TRUE(window.ready());
  window.clear();
  EXPECT_FALSE(window.ready());
}

TEST(DriftWindow, ThatIsSmallRemembersAsManyFixesAsItHolds) {
  EXPECT_EQ(DriftWindow<8>().settings().max_fixes, 8);
  EXPECT_EQ(DriftWindow<32>().settings().max_fixes, DriftWindowSettings{}.max_fixes);
}

TEST(DriftWindow, RejectsInvalidInputAndStaysUnchanged) {
  DriftWindow<> window({.log_std_mps = 0.05});
  EXPECT_EQ(window.add({Vec2(0, 0), kIdentity}), Status::kOk);
  EXPECT_EQ(window.advance(10, 5, 1), Status::kOk);
  EXPECT_EQ(window.add({Vec2(30, 40), kIdentity}), Status::kOk);
  const Gaussian<2> before = window.drift();
  EXPECT_EQ(window.advance(-1, 5, 1), Status::kNegativeTimeStep);
  EXPECT_EQ(window.advance(1, NAN, 1), Status::kNotFinite);
  EXPECT_EQ(window.advance(1, 5, INFINITY), Status::kNotFinite);
  EXPECT_EQ(window.add({Vec2(NAN, 0), kIdentity}), Status::kNotFinite);
  EXPECT_EQ(window.add({Vec2(0, 0), -kIdentity}), Status::kNotPositiveDefinite);
  EXPECT_EQ(window.drift().mean, before.mean);
  EXPECT_THROW(DriftWindow<>({.max_fixes = 1}), std::invalid_argument);
  EXPECT_THROW(DriftWindow<>({.max_fixes = 33}), std::invalid_argument);
  EXPECT_THROW(DriftWindow<>({.log_std_mps = -1}), std::invalid_argument);
  EXPECT_THROW(DriftWindow<>({.alteration_mps = -1}), std::invalid_argument);
}

TEST(DriftWindow, RejectsNumbersOutOfRange) {
  DriftWindow<> window({.log_std_mps = 0.05});
  const auto go_on = [&] {
    EXPECT_EQ(window.advance(10, 5, 1), Status::kOk);
    EXPECT_EQ(window.add({Vec2(30, 40), kIdentity}), Status::kOk);
  };
  go_on();
  go_on();
  const Gaussian<2> before = window.drift();
  EXPECT_EQ(window.advance(1e10, 0, 1), Status::kNotFinite);
  EXPECT_EQ(window.advance(1, 1e10, 1), Status::kNotFinite);
  EXPECT_EQ(window.add({Vec2(1e10, 0), kIdentity}), Status::kNotFinite);
  EXPECT_EQ(window.drift().mean, before.mean);
  go_on();
  EXPECT_TRUE(is_finite(window.drift().mean) && is_finite(window.drift().covariance));
}

TEST(DriftWindow, KnowsNothingOfTimesTooNearEachOther) {
  DriftWindow<> window;
  EXPECT_EQ(window.add({Vec2(0, 0), kIdentity}), Status::kOk);
  EXPECT_EQ(window.advance(1e-200, 5, 1), Status::kOk);
  EXPECT_EQ(window.add({Vec2(30, 40), kIdentity}), Status::kOk);
  EXPECT_EQ(window.drift().mean, Vec2(0, 0));
  EXPECT_TRUE(std::isinf(window.drift().covariance(0, 0)));
}

TEST(DriftWindow, NeedsNoHeap) {
  DriftWindow<> window({.max_fixes = 4, .log_std_mps = 0.05, .heading_std_rad = 0.01});
  const test::NoHeap fence;
  for (int k = 0; k < 10; ++k) {
    (void)window.advance(1.0, 5.0, 0.1 * k);
    (void)window.add({Vec2(k, 2 * k), kIdentity});
    (void)window.drift();
  }
  EXPECT_EQ(fence.allocations(), 0);
}

TEST(Drift, FromRatesIsTheVectorDifference) {
  const SpeedCourse water{6.0, deg(359)};
  const Vec2 drift(0.3, -0.5);
  EXPECT_LT((drift_from_rates_mps(water.velocity_mps() + drift, water) - drift).norm(), 1e-12);
}

TEST(Drift, FromFixedMarks) {
  Draw draw(4);
  const SpeedCourse water{6.0, deg(80)};
  const Vec2 current(0.2, 0.5), ground = water.velocity_mps() + current;
  Mat2 sharp, blunt;
  sharp << 0.01, 0.002, 0.002, 0.02;
  blunt << 0.09, -0.01, -0.01, 0.04;
  double nees = 0;
  constexpr int runs = 4000;
  for (int run = 0; run < runs; ++run) {
    const std::array<Gaussian<2>, 2> marks{
        {{-ground + draw.error<2>(sharp), sharp}, {-ground + draw.error<2>(blunt), blunt}}};
    const Gaussian<2> own = ground_velocity_from_marks(marks);
    const Gaussian<2> drift = drift_between(
        own, {water.velocity_mps() + draw.error<2>(0.01 * kIdentity), 0.01 * kIdentity});
    EXPECT_LT(own.covariance.trace(), sharp.trace());
    nees += Cholesky<2>(drift.covariance).squared_norm(drift.mean - current) / runs;
  }
  EXPECT_NEAR(nees, 2.0, 0.13);
  const std::array<Gaussian<2>, 1> one{{{-ground, sharp}}};
  EXPECT_LT((ground_velocity_from_marks(one).mean - ground_velocity_from_mark(one[0]).mean).norm(),
            1e-12);
  EXPECT_TRUE(std::isnan(ground_velocity_from_marks({}).mean[0]));
}

TEST(Stabilisation, AStationaryMarkIsFixedOverGroundAndDriftsThroughTheWater) {
  const SpeedCourse water{7.0, deg(200)};
  const Vec2 drift(0.4, 0.3), relative = -(water.velocity_mps() + drift);
  EXPECT_LT(ground_stabilised_mps(relative, water, drift).norm(), 1e-12);
  EXPECT_LT((sea_stabilised_mps(relative, water) + drift).norm(), 1e-12);
}

TEST(WaterVelocity, HasTheCovarianceOfItsReadings) {
  Draw draw(5);
  const double speed = 6, heading = 2.0, log = 0.05, gyro = 0.01;
  const Gaussian<2> water = water_velocity(speed, heading, log, gyro);
  Mat2 seen = Mat2::Zero();
  constexpr int draws = 40'000;
  for (int k = 0; k < draws; ++k) {
    const SpeedCourse read{speed + log * draw.normal(), heading + gyro * draw.normal()};
    const Vec2 off = read.velocity_mps() - water.mean;
    seen += off * off.transpose() / draws;
  }
  EXPECT_LT(test::covariance_difference<double>(seen, water.covariance), 0.03);
}

}  // namespace
}  // namespace wakeline::drift_test
