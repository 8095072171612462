// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/filter/rts_smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/coordinated_turn.hpp"

namespace wakeline::rts_smoother_test {
namespace {

using test::Draw;
using test::matrices_near;

constexpr int kScans = 6;
constexpr std::array<double, kScans - 1> kSteps{2.5, 2.5, 0.7, 6.0, 2.5};
const CoordinatedTurn kMotion{.turn_rate_rad_s = 0.06, .noise = WhiteAcceleration{0.4}};
const Position kSensor{.position_std_m = 12};

using Pushes = std::array<Vec<double, 2>, kScans - 1>;
const Pushes kNoPush{Vec<double, 2>(0, 0), {0, 0}, {0, 0}, {0, 0}, {0, 0}};
const Pushes kPush{Vec<double, 2>(3, 0), {0, -2}, {1, 1}, {-4, 2}, {0, 5}};

struct Voyage {
  std::vector<Gaussian<4>> beliefs;
  std::vector<Vec<double, 2>> plots;
  Gaussian<4> start;
};

/// Filtered beliefs of a short run; scan 2 is missed.
Voyage filtered(const Pushes& push = kNoPush) {
  Draw draw(31);
  Voyage run;
  run.start.mean << 100, 5, -50, 8;
  run.start.covariance = Vec<double, 4>(900, 16, 900, 16).asDiagonal();
  Kalman<CoordinatedTurn> kalman{kMotion};
  EXPECT_EQ(kalman.start(run.start), Status::kOk);
  Vec<double, 4> truth = draw.of(run.start);
  for (int scan = 0; scan < kScans; ++scan) {
    if (scan > 0) {
      const double dt = kSteps[std::size_t(scan - 1)];
      const Vec<double, 2>& u = push[std::size_t(scan - 1)];
      EXPECT_EQ(kalman.predict(dt, u), Status::kOk);
      truth = (kMotion.matrix(dt) * truth + draw.error(kMotion.process_noise(dt))).eval();
      truth += Control::shift(kMotion.kComponents, dt, u);
    }
    const Vec<double, 2> z(truth[0] + 12 * draw.normal(), truth[2] + 12 * draw.normal());
    run.plots.push_back(z);
    if (scan == 2) {
      run.beliefs.push_back(kalman.estimate());
      continue;
    }
    EXPECT_TRUE(kalman.update(kSensor, z));
    run.beliefs.push_back(kalman.estimate());
  }
  return run;
}

Status smooth_run(std::vector<Gaussian<4>>& beliefs, const Pushes& push = kNoPush) {
  return smooth<CoordinatedTurn, double>(kMotion, beliefs, kSteps, push);
}

// The smoothed beliefs are the marginals of one Gaussian over the whole trajectory, whose
// information matrix and vector add up from the start, the motions and the plots.
void expect_the_batch_solution(const Pushes& push) {
  Voyage run = filtered(push);
  constexpr int kSize = 4 * kScans;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(kSize, kSize);
  Eigen::VectorXd vector = Eigen::VectorXd::Zero(kSize);
  information.topLeftCorner<4, 4>() += run.start.covariance.inverse();
  vector.head<4>() += run.start.covariance.inverse() * run.start.mean;
  for (int k = 0; k + 1 < kScans; ++k) {
    Eigen::MatrixXd change(4, kSize);  // x(k+1) - F x(k)
    change.setZero();
    change.block<4, 4>(0, 4 * k) = -kMotion.matrix(kSteps[std::size_t(k)]);
    change.block<4, 4>(0, 4 * k + 4).setIdentity();
    const Mat<double, 4, 4> q = kMotion.process_noise(kSteps[std::size_t(k)]);
    information += change.transpose() * q.inverse() * change;
    vector += change.transpose() * q.inverse() *
              Control::shift(kMotion.kComponents, kSteps[std::size_t(k)], push[std::size_t(k)]);
  }
  for (int k = 0; k < kScans; ++k) {
    if (k == 2) continue;
    for (int axis = 0; axis < 2; ++axis) {
      information(4 * k + 2 * axis, 4 * k + 2 * axis) += 1.0 / 144;
      vector(4 * k + 2 * axis) += run.plots[std::size_t(k)][axis] / 144;
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> solver(information);
  ASSERT_EQ(solver.info(), Eigen::Success);
  const Eigen::VectorXd means = solver.solve(vector);
  const Eigen::MatrixXd covariance = solver.solve(Eigen::MatrixXd::Identity(kSize, kSize));

  ASSERT_EQ(smooth_run(run.beliefs, push), Status::kOk);
  for (int k = 0; k < kScans; ++k) {
    const Gaussian<4>& belief = run.beliefs[std::size_t(k)];
    EXPECT_TRUE(
        matrices_near(belief.mean, means.segment<4>(4 * k), {.absolute = 1e-7, .relative = 1e-9}))
        << k;
    const Mat<double, 4, 4> expected = covariance.block<4, 4>(4 * k, 4 * k);
    EXPECT_LT(test::covariance_difference(belief.covariance, expected), 1e-8) << k;
  }
}

TEST(RtsSmoother, IsTheBatchSolution) { expect_the_batch_solution(kNoPush); }

TEST(RtsSmoother, KnowsTheAccelerationThatTheFilterKnew) { expect_the_batch_solution(kPush); }

TEST(RtsSmoother, NeverWidensABelief) {
  Voyage run = filtered();
  const std::vector<Gaussian<4>> before = run.beliefs;
  ASSERT_EQ(smooth_run(run.beliefs), Status::kOk);
  EXPECT_TRUE(test::matrices_identical(run.beliefs.back().covariance, before.back().covariance));
  EXPECT_TRUE(test::matrices_identical(run.beliefs.back().mean, before.back().mean));
  for (std::size_t k = 0; k + 1 < before.size(); ++k) {
    EXPECT_TRUE(test::is_covariance(run.beliefs[k].covariance));
    const Mat<double, 4, 4> gained = before[k].covariance - run.beliefs[k].covariance;
    const Mat<double, 4, 4> slightly = gained + 1e-9 * before[k].covariance;
    EXPECT_TRUE(Cholesky<4>(slightly).ok()) << "scan " << k << ": smaller in every direction";
    EXPECT_LT(run.beliefs[k].covariance(0, 0), 0.99 * before[k].covariance(0, 0))
        << "and really smaller";
  }
}

TEST(RtsSmoother, SmoothsANonlinearMotion) {
  const CoordinatedTurnRate motion{.noise = WhiteAcceleration{0.05}, .turn_rate_psd_rad2s3 = 1e-4};
  const RangeBearing radar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
  constexpr int kRuns = 200;
  double filtered_error = 0.0, smoothed_error = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Draw draw(std::uint64_t(400 + run));
    Gaussian<5> start;
    start.mean << 2000, 8, 1500, -4, 0.03;
    start.covariance = Vec<double, 5>(400, 4, 400, 4, 4e-4).asDiagonal();
    Vec<double, 5> truth = draw.of(start);
    Ekf ekf{motion};
    ASSERT_EQ(ekf.start(start), Status::kOk);
    std::vector<Gaussian<5>> beliefs;
    std::vector<Vec<double, 5>> truths;
    for (int scan = 0; scan < 30; ++scan) {
      truth = (motion.transition(truth, 2.5) + draw.error(motion.process_noise(truth, 2.5))).eval();
      ASSERT_EQ(ekf.predict(2.5), Status::kOk);
      const Vec<double, 2> exact = radar.measure(Vec<double, 2>(truth[0], truth[2]));
      ASSERT_TRUE(
          ekf.update(radar, Vec<double, 2>(exact + draw.error(radar.observe(exact).covariance))));
      beliefs.push_back(ekf.estimate());
      truths.push_back(truth);
    }
    const std::vector<double> steps(beliefs.size() - 1, 2.5);
    const Gaussian<5> middle = beliefs[15];
    ASSERT_EQ((smooth<CoordinatedTurnRate, double>(motion, beliefs, steps)), Status::kOk);
    filtered_error += (middle.mean - truths[15])[4] * (middle.mean - truths[15])[4];
    smoothed_error += (beliefs[15].mean - truths[15])[4] * (beliefs[15].mean - truths[15])[4];
  }
  EXPECT_LT(smoothed_error, 0.6 * filtered_error) << "the turn rate, from both sides";
}

const CoordinatedTurnRate kTurning{.noise = WhiteAcceleration{0.05}, .turn_rate_psd_rad2s3 = 1e-4};

/// Filtered beliefs of a turning vessel, and its true positions.
struct Turning {
  CoordinatedTurnRate motion = kTurning;
  std::vector<Gaussian<5>> beliefs;
  std::vector<Vec<double, 5>> truths;
  std::vector<double> steps;

  template <class Filter>
  explicit Turning(std::uint64_t seed, Filter filter) {
    const RangeBearing radar{.range_std_m = 30, .bearing_std_rad = deg(0.6)};
    Draw draw(seed);
    Gaussian<5> start;
    start.mean << 4000, 8, 3000, -4, 0.03;
    start.covariance = Vec<double, 5>(900, 4, 900, 4, 4e-4).asDiagonal();
    Vec<double, 5> truth = draw.of(start);
    EXPECT_EQ(filter.start(start), Status::kOk);
    for (int scan = 0; scan < 60; ++scan) {
      truth = (motion.transition(truth, 2.5) + draw.error(motion.process_noise(truth, 2.5))).eval();
      EXPECT_EQ(filter.predict(2.5), Status::kOk);
      const Vec<double, 2> exact = radar.measure(Vec<double, 2>(truth[0], truth[2]));
      EXPECT_TRUE(filter.update(
          radar, Vec<double, 2>(exact + draw.error(radar.observe(exact).covariance))));
      beliefs.push_back(filter.estimate());
      truths.push_back(truth);
    }
    steps.assign(beliefs.size() - 1, 2.5);
  }
};

// Gains of the book, by sums over the sigma points: C = Σ w dx e^T, P+ = P + C Pp⁻¹ (Ps - Pp) Pp⁻¹
// Cᵀ.
TEST(RtsSmoother, OfAnUnscentedFilterIsThatOfTheBook) {
  for (const Unscented unscented : {Unscented{}, Unscented{.alpha = 0.7, .kappa = 1.0}}) {
    Turning run(7, Ukf(kTurning, unscented));
    std::vector<Gaussian<5>> expected = run.beliefs;
    const double n = 5.0, scale = unscented.alpha * unscented.alpha * (n + unscented.kappa);
    for (std::size_t k = expected.size() - 1; k-- > 0;) {
      const Gaussian<5>& filtered = run.beliefs[k];
      const Mat<double, 5, 5> root = filtered.covariance.llt().matrixL();
      Eigen::Matrix<double, 5, 11> points, images;
      points.colwise() = filtered.mean;
      points.middleCols<5>(1) += std::sqrt(scale) * root;
      points.rightCols<5>() -= std::sqrt(scale) * root;
      for (int i = 0; i < 11; ++i)
        images.col(i) = run.motion.transition(Vec<double, 5>(points.col(i)), 2.5);
      Eigen::Matrix<double, 11, 1> of_mean = Eigen::Matrix<double, 11, 1>::Constant(0.5 / scale);
      of_mean[0] = 1.0 - n / scale;
      Eigen::Matrix<double, 11, 1> of_spread = of_mean;
      of_spread[0] += 1.0 - unscented.alpha * unscented.alpha + unscented.beta;
      const Vec<double, 5> mean = images * of_mean;
      const Eigen::Matrix<double, 5, 11> off = images.colwise() - mean;
      const Mat<double, 5, 5> predicted = off * of_spread.asDiagonal() * off.transpose() +
                                          run.motion.process_noise(filtered.mean, 2.5);
      const Mat<double, 5, 5> gain = (points.colwise() - filtered.mean) * of_spread.asDiagonal() *
                                     off.transpose() * predicted.inverse();
      expected[k].mean = filtered.mean + gain * (expected[k + 1].mean - mean);
      expected[k].covariance =
          filtered.covariance + gain * (expected[k + 1].covariance - predicted) * gain.transpose();
    }
    ASSERT_EQ((smooth<CoordinatedTurnRate, double>(run.motion, unscented, run.beliefs, run.steps)),
              Status::kOk);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      EXPECT_TRUE(matrices_near(run.beliefs[k].mean, expected[k].mean,
                                {.absolute = 1e-6, .relative = 1e-7}))
          << k;
      EXPECT_LT(test::covariance_difference(run.beliefs[k].covariance, expected[k].covariance),
                1e-6)
          << k;
    }
  }
}

TEST(RtsSmoother, BringsAnUnscentedFilterNearerToTheTruth) {
  double filtered_m2 = 0.0, smoothed_m2 = 0.0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Turning run(seed, Ukf(kTurning));
    const auto error_m2 = [&] {
      double sum = 0.0;
      for (std::size_t k = 0; k < run.truths.size(); ++k)
        for (const int row : {0, 2})
          sum += std::pow(run.beliefs[k].mean[row] - run.truths[k][row], 2);
      return sum;
    };
    filtered_m2 += error_m2();
    ASSERT_EQ(
        (smooth<CoordinatedTurnRate, double>(run.motion, Unscented{}, run.beliefs, run.steps)),
        Status::kOk);
    smoothed_m2 += error_m2();
  }
  EXPECT_LT(smoothed_m2, 0.5 * filtered_m2);
}

TEST(RtsSmoother, LeavesTheRestFilteredWhereItFails) {
  Voyage run = filtered();
  run.beliefs[2].covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Gaussian<4>> before = run.beliefs;
  EXPECT_NE(smooth_run(run.beliefs), Status::kOk);
  for (const std::size_t k : {0u, 1u, 2u}) {
    EXPECT_TRUE(test::matrices_identical(run.beliefs[k].mean, before[k].mean)) << k;
    EXPECT_TRUE(test::matrices_identical(run.beliefs[k].covariance, before[k].covariance)) << k;
  }
  run.beliefs = before;
  run.beliefs[5].mean[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(smooth_run(run.beliefs), Status::kNotFinite);
  for (const std::size_t k : {0u, 1u, 3u, 4u}) {
    EXPECT_TRUE(test::matrices_identical(run.beliefs[k].mean, before[k].mean)) << k;
    EXPECT_TRUE(test::matrices_identical(run.beliefs[k].covariance, before[k].covariance)) << k;
  }
}

TEST(RtsSmoother, RejectsNegativeTimeSteps) {
  Voyage run = filtered();
  const std::vector<Gaussian<4>> before = run.beliefs;
  std::array<double, kScans - 1> steps = kSteps;
  steps[4] = -2.5;
  EXPECT_EQ((smooth<CoordinatedTurn, double>(kMotion, run.beliefs, steps)),
            Status::kNegativeTimeStep);
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_TRUE(test::matrices_identical(run.beliefs[k].mean, before[k].mean)) << k;
}

TEST(RtsSmoother, OfNothingAndOfOneScan) {
  std::vector<Gaussian<4>> none;
  EXPECT_EQ((smooth<CoordinatedTurn, double>(kMotion, none, std::span<const double>{})),
            Status::kOk);
  std::vector<Gaussian<4>> one(1);
  EXPECT_EQ((smooth<CoordinatedTurn, double>(kMotion, one, std::span<const double>{})),
            Status::kOk);
  EXPECT_TRUE(test::matrices_identical(one[0].covariance, Gaussian<4>{}.covariance));
}

}  // namespace
}  // namespace wakeline::rts_smoother_test
