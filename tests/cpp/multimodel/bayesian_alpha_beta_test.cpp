// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/multimodel/bayesian_alpha_beta.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/measurement/position.hpp"

namespace wakeline::bayesian_alpha_beta_test {
namespace {

using test::beliefs_identical;
using test::Draw;
using test::matrices_near;

using Bayesian = BayesianAlphaBeta<>;
constexpr double kPeriod_s = 3.0;
const Position kSensor{.position_std_m = 5.0};

Gaussian<4> anywhere() {
  Gaussian<4> belief;
  belief.covariance = Vec<double, 4>(1e6, 1e4, 1e6, 1e4).asDiagonal();
  return belief;
}

Bayesian started(const LineWeighing& weighing = {}) {
  Bayesian bank(weighing);
  EXPECT_EQ(bank.start(anywhere()), Status::kOk);
  return bank;
}

/// A straight of 8 m/s, then from 60 s on a turn of 3 degrees a second.
Vec<double, 2> turning(double t) {
  constexpr double kSpeed = 8.0, kRate = 0.0524;
  const double turned = std::max(t - 60.0, 0.0);
  return {kSpeed * std::min(t, 60.0) + kSpeed / kRate * std::sin(kRate * turned),
          kSpeed / kRate * (1.0 - std::cos(kRate * turned))};
}

/// One member's forecast of a position, by an orthogonal factorisation: mean and variance factor.
struct Forecast {
  Vec<double, 2> mean;
  double factor;
};

Forecast forecast(const std::vector<double>& times, const std::vector<Vec<double, 2>>& plots,
                  double now_s, int count, int terms) {
  Eigen::MatrixXd design(count, terms), values(count, 2);
  for (int k = 0; k < count; ++k) {
    const std::size_t plot = plots.size() - 1 - std::size_t(k);
    for (int power = 0; power < terms; ++power)
      design(k, power) = std::pow(times[plot] - now_s, power);
    values.row(k) = plots[plot].transpose();
  }
  const Eigen::MatrixXd factors = (design.transpose() * design).inverse();
  const Eigen::MatrixXd fit = factors * (design.transpose() * values);
  return {fit.row(0).transpose(), factors(0, 0)};
}

TEST(BayesianAlphaBeta, IsBayesRuleOverPolynomialForecasts) {
  const LineWeighing weighing{.max_plots = 8, .sojourn_s = 40.0, .longest_line_probability = 0.3};
  Draw draw(3);
  Bayesian bank = started(weighing);
  const int members = weighing.members();
  Eigen::VectorXd prior = Eigen::VectorXd::Constant(members, 0.7 / (members - 1));
  prior[6] = 0.3;
  Eigen::VectorXd weight = prior;
  std::vector<double> times;
  std::vector<Vec<double, 2>> plots;
  double now_s = 0.0;
  for (int scan = 0; scan < 40; ++scan) {
    const double dt_s = draw.uniform(1.0, 6.0);
    now_s += dt_s;
    ASSERT_EQ(bank.predict(dt_s), Status::kOk);
    const double stay = std::exp(-dt_s / 40.0);
    weight = stay * weight + (1 - stay) * prior;
    if (scan % 9 == 7) continue;  // missed
    const Vec<double, 2> z = turning(now_s) + 5.0 * draw.normals<2>();
    double total = 0.0, before = 0.0;
    Eigen::VectorXd likely = Eigen::VectorXd::Zero(members);
    Vec<double, 2> ahead(0, 0);
    for (int m = 0; m < members; ++m) {
      const int count = weighing.plots_of(m);
      if (std::size_t(count) > plots.size()) continue;
      const Forecast f = forecast(times, plots, now_s, count, m < 7 ? 2 : 3);
      const double variance = 25.0 * (1 + f.factor);
      likely[m] = weight[m] * std::exp(-(z - f.mean).squaredNorm() / (2 * variance)) / variance;
      total += likely[m];
      before += weight[m];
      ahead += weight[m] * f.mean;
    }
    const auto step = bank.update(kSensor, z);
    ASSERT_TRUE(step);
    if (plots.size() >= 2) {
      EXPECT_TRUE(matrices_near(step.innovation, z - ahead / before, {.absolute = 1e-7}));
      for (int m = 0; m < members; ++m)
        if (std::size_t(weighing.plots_of(m)) <= plots.size())
          weight[m] = before * likely[m] / total;
    }
    times.push_back(now_s);
    plots.push_back(z);
    double ready = 0.0;
    for (int m = 0; m < members; ++m)
      if (std::size_t(weighing.plots_of(m)) <= plots.size()) ready += weight[m];
    for (int m = 0; m < members && plots.size() >= 2; ++m)
      EXPECT_NEAR(bank.mode_probability()[m],
                  std::size_t(weighing.plots_of(m)) <= plots.size() ? weight[m] / ready : 0.0,
                  1e-9);
  }
}

TEST(BayesianAlphaBeta, AloneAMemberIsThatLine) {
  Draw draw(4);
  Bayesian bank = started({.min_plots = 3, .max_plots = 3, .parabolas = false});
  std::vector<Vec<double, 2>> plots;
  for (int scan = 0; scan < 20; ++scan) {
    ASSERT_EQ(bank.predict(kPeriod_s), Status::kOk);
    const Vec<double, 2> z = 100.0 * draw.normals<2>();
    const auto step = bank.update(kSensor, z);
    ASSERT_TRUE(step);
    if (plots.size() >= 3) {
      const std::size_t n = plots.size();
      const Vec<double, 2> line = (4 * plots[n - 1] + plots[n - 2] - 2 * plots[n - 3]) / 3;
      EXPECT_TRUE(matrices_near(step.innovation, z - line, {.absolute = 1e-9}));
    }
    plots.push_back(z);
  }
}

TEST(BayesianAlphaBeta, LengthensOnAStraightAndBendsInATurn) {
  Draw draw(5);
  double straight = 0.0, bent_straight = 0.0, bent = 0.0;
  constexpr int kRuns = 200;
  for (int run = 0; run < kRuns; ++run) {
    Bayesian bank = started();
    const auto parabolas = [&] { return bank.mode_probability().tail(7).sum(); };
    for (int scan = 1; scan <= 32; ++scan) {
      ASSERT_EQ(bank.predict(kPeriod_s), Status::kOk);
      ASSERT_TRUE(bank.update(kSensor, turning(kPeriod_s * scan) + 5.0 * draw.normals<2>()));
      ASSERT_NEAR(bank.mode_probability().sum(), 1.0, 1e-12);
      if (scan == 20) straight += bank.mode_probability()[8] / kRuns;
      if (scan == 20) bent_straight += parabolas() / kRuns;
      if (scan == 32) bent += parabolas() / kRuns;
    }
  }
  EXPECT_GT(straight, 0.5);
  EXPECT_LT(bent_straight, 0.2);
  EXPECT_GT(bent, 0.6);
}

/// Root mean square of what a radar's plots are off their forecasts; a second radar sees the boat
/// so much later, or none does where that is 0.
double forecast_error_m(double behind_s) {
  Draw draw(7);
  double squared = 0.0;
  int count = 0;
  for (int run = 0; run < 100; ++run) {
    Bayesian bank = started();
    for (int scan = 1; scan <= 32; ++scan) {
      const double time_s = kPeriod_s * scan;
      EXPECT_EQ(bank.predict(scan > 1 ? kPeriod_s - behind_s : kPeriod_s), Status::kOk);
      const auto step = bank.update(kSensor, turning(time_s) + 5.0 * draw.normals<2>());
      EXPECT_TRUE(step);
      if (scan > 5) squared += step.innovation.squaredNorm();
      count += scan > 5;
      if (behind_s == 0.0) continue;
      EXPECT_EQ(bank.predict(behind_s), Status::kOk);
      EXPECT_TRUE(bank.update(kSensor, turning(time_s + behind_s) + 5.0 * draw.normals<2>()));
    }
  }
  return std::sqrt(squared / count);
}

TEST(BayesianAlphaBeta, PredictsWithTwoUnsynchronisedRadarsAtLeastAsWellAsWithOne) {
  const double alone_m = forecast_error_m(0.0);
  for (const double behind_s : {0.0005, 0.002, 0.005, 0.02, 0.05, 0.15})
    EXPECT_LT(forecast_error_m(behind_s), alone_m) << behind_s << " s behind";
}

TEST(BayesianAlphaBeta, MissedScansRelaxTheProbabilitiesAlongTheChain) {
  Draw draw(6);
  Bayesian bank = started();
  for (int scan = 1; scan <= 30; ++scan) {
    ASSERT_EQ(bank.predict(kPeriod_s), Status::kOk);
    ASSERT_TRUE(bank.update(kSensor, turning(kPeriod_s * scan) + 5.0 * draw.normals<2>()));
  }
  Eigen::VectorXd prior = Eigen::VectorXd::Constant(16, 0.04);
  prior[8] = 0.4;
  const Eigen::VectorXd before = bank.mode_probability();
  const double wide = bank.estimate().covariance.trace();
  ASSERT_EQ(bank.predict(12.0), Status::kOk);
  const double stay = std::exp(-12.0 / 30.0);
  EXPECT_TRUE(matrices_near(bank.mode_probability(), stay * before + (1 - stay) * prior,
                            {.absolute = 1e-12}));
  EXPECT_GT(bank.estimate().covariance.trace(), wide);
}

TEST(BayesianAlphaBeta, TwoStepsAreOneOfTheirSum) {
  Draw draw(7);
  Bayesian bank = started();
  for (int scan = 1; scan <= 25; ++scan) {
    ASSERT_EQ(bank.predict(kPeriod_s), Status::kOk);
    ASSERT_TRUE(bank.update(kSensor, turning(kPeriod_s * scan) + 5.0 * draw.normals<2>()));
  }
  Bayesian other = bank;
  ASSERT_EQ(bank.predict(5.0), Status::kOk);
  ASSERT_EQ(other.predict(2.0), Status::kOk);
  ASSERT_EQ(other.predict(3.0), Status::kOk);
  EXPECT_TRUE(matrices_near(bank.estimate().mean, other.estimate().mean, {.absolute = 1e-8}));
  EXPECT_TRUE(
      matrices_near(bank.mode_probability(), other.mode_probability(), {.absolute = 1e-12}));
}

TEST(BayesianAlphaBeta, DoesNotDependOnWhereNorthIs) {
  Draw draw(8);
  Bayesian bank = started(), turned = started();
  Mat<double, 2, 2> rotation;
  rotation << 0.0, -1.0, 1.0, 0.0;
  for (int scan = 1; scan <= 40; ++scan) {
    const Vec<double, 2> z = turning(kPeriod_s * scan) + 5.0 * draw.normals<2>();
    ASSERT_EQ(bank.predict(kPeriod_s), Status::kOk);
    ASSERT_EQ(turned.predict(kPeriod_s), Status::kOk);
    const auto step = bank.update(kSensor, z);
    const auto other = turned.update(kSensor, Vec<double, 2>(rotation * z));
    EXPECT_NEAR(step.nis, other.nis, 1e-9);
    EXPECT_NEAR(step.log_likelihood, other.log_likelihood, 1e-9);
  }
}

TEST(BayesianAlphaBeta, BadInputChangesNothing) {
  Bayesian bank;
  EXPECT_EQ(bank.predict(1.0), Status::kNotStarted);
  EXPECT_EQ(bank.update(kSensor, Vec<double, 2>(1, 2)).status, Status::kNotStarted);
  bank = started();
  for (int scan = 0; scan < 12; ++scan) {
    const auto before = bank.estimate();
    const Eigen::VectorXd weights = bank.mode_probability();
    EXPECT_EQ(bank.predict(NAN), Status::kNotFinite);
    EXPECT_EQ(bank.predict(-1.0), Status::kNegativeTimeStep);
    EXPECT_EQ(bank.predict(1e200), Status::kNotFinite);
    EXPECT_EQ(bank.predict(1.0, Vec<double, 2>(NAN, 0)), Status::kNotFinite);
    EXPECT_EQ(bank.update(kSensor, Vec<double, 2>(NAN, 0)).status, Status::kNotFinite);
    EXPECT_TRUE(beliefs_identical<4>(bank.estimate(), before));
    EXPECT_EQ(bank.mode_probability(), weights);
    ASSERT_EQ(bank.predict(kPeriod_s), Status::kOk);
    ASSERT_TRUE(bank.update(kSensor, turning(kPeriod_s * scan)));
  }
}

TEST(BayesianAlphaBeta, APlotOutOfRangeChangesNothing) {
  const Position vague{1e5};
  const Vec<double, 2> far(2.0 * kLargestInput, 0.0);
  Bayesian bank = started();
  for (int scan = 0; scan < 4; ++scan) {
    ASSERT_EQ(bank.predict(kPeriod_s), Status::kOk);
    ASSERT_TRUE(bank.update(vague, turning(kPeriod_s * scan)));
  }
  ASSERT_EQ(bank.predict(kPeriod_s), Status::kOk);
  const auto before = bank.estimate();
  const Eigen::VectorXd weights = bank.mode_probability();
  EXPECT_EQ(bank.update(vague, far).status, Status::kNotFinite);
  EXPECT_TRUE(beliefs_identical<4>(bank.estimate(), before));
  EXPECT_EQ(bank.mode_probability(), weights);
  EXPECT_TRUE(bank.update(vague, turning(12.0)));
}

TEST(BayesianAlphaBeta, RejectsInvalidParameters) {
  EXPECT_THROW(Bayesian({.min_plots = 1}), std::invalid_argument);
  EXPECT_THROW(Bayesian({.min_plots = 5, .max_plots = 4}), std::invalid_argument);
  EXPECT_THROW(Bayesian({.max_plots = 17, .parabolas = false}), std::invalid_argument);
  EXPECT_THROW(Bayesian({.max_plots = 11}), std::invalid_argument);
  EXPECT_THROW(Bayesian({.sojourn_s = 0.0}), std::invalid_argument);
  EXPECT_THROW(Bayesian({.longest_line_probability = 1.0}), std::invalid_argument);
  EXPECT_THROW(Bayesian({.acceleration_std_mps2 = NAN}), std::invalid_argument);
}

TEST(BayesianAlphaBeta, ArchiveRestoresEverythingAndRejectsOtherArchives) {
  Draw draw(9);
  for (const int scans : {0, 1, 3, 25}) {
    Bayesian bank = started(), restored;
    for (int scan = 1; scan <= scans; ++scan) {
      ASSERT_EQ(bank.predict(kPeriod_s), Status::kOk);
      ASSERT_TRUE(bank.update(kSensor, turning(kPeriod_s * scan) + 5.0 * draw.normals<2>()));
    }
    Archive written;
    bank.archive(written);
    Archive read(written.bytes());
    restored.archive(read);
    ASSERT_TRUE(read.ok() && read.at_end());
    EXPECT_TRUE(beliefs_identical<4>(bank.estimate(), restored.estimate()));
    ASSERT_EQ(bank.predict(kPeriod_s), restored.predict(kPeriod_s));
    EXPECT_EQ(bank.update(kSensor, Vec<double, 2>(9, 9)).nis,
              restored.update(kSensor, Vec<double, 2>(9, 9)).nis);
    Bayesian other({.sojourn_s = 31.0});
    Archive again(written.bytes());
    other.archive(again);
    EXPECT_FALSE(again.ok());
    EXPECT_FALSE(other.started());
  }
}

TEST(BayesianAlphaBeta, TouchesNoHeap) {
  Bayesian bank;
  const std::array readings{Alternative<Position>{kSensor, {8, 9}, 0.5}};
  std::array share{0.0};
  const test::NoHeap fence;
  Status worst = bank.start(test::five_km_off<double>());
  for (int scan = 0; scan < 14; ++scan) {
    if (bank.predict(3.0) != Status::kOk) worst = Status::kMissed;
    if (!bank.update(kSensor, Vec<double, 2>(scan, 2 * scan))) worst = Status::kMissed;
  }
  (void)bank.predict(3.0, Vec<double, 2>(0.1, 0.1));
  (void)bank.update<Position>(readings, 0.1, share);
  (void)bank.evidence(kSensor, Vec<double, 2>(5, 5));
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_EQ(worst, Status::kOk);
}

TEST(BayesianAlphaBeta, IsOfFloatToo) {
  BayesianAlphaBeta<float> single;
  Bayesian bank = started();
  ASSERT_EQ(single.start(anywhere().cast<float>()), Status::kOk);
  Draw draw(61);
  for (int scan = 1; scan <= 60; ++scan) {
    const Vec<double, 2> z = turning(kPeriod_s * scan) + 5.0 * draw.normals<2>();
    ASSERT_EQ(single.predict(3.0f), Status::kOk);
    ASSERT_EQ(bank.predict(3.0), Status::kOk);
    ASSERT_TRUE(single.update(kSensor, Vec<float, 2>(z.cast<float>())));
    ASSERT_TRUE(bank.update(kSensor, z));
    EXPECT_TRUE(matrices_near(single.estimate().mean.cast<double>(), bank.estimate().mean,
                              {.absolute = 0.02, .relative = 1e-4}));
  }
}

}  // namespace
}  // namespace wakeline::bayesian_alpha_beta_test
