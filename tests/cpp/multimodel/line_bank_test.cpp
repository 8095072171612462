// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/multimodel/line_bank.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "support/matrix_assert.hpp"

namespace wakeline::line_bank_test {
namespace {

using test::Draw;
using test::matrices_near;
using test::Tolerance;

using Bank = LineBank<>;
const Mat<double, 2, 2> kPlot{{9.0, 2.0}, {2.0, 16.0}};

/// A plot and when it was, counted from the present.
struct Known {
  double time_s;
  Vec<double, 2> position;
};

/// [position, velocity, ...] at time 0 of the polynomial with so many terms through the last
/// `plots`, by an orthogonal factorisation.
Eigen::MatrixXd fitted(const std::vector<Known>& known, int plots, int terms,
                       Eigen::MatrixXd& factors) {
  Eigen::MatrixXd design(plots, terms), values(plots, 2);
  for (int k = 0; k < plots; ++k) {
    const Known& plot = known[known.size() - 1 - std::size_t(k)];
    const Vec<double, 3> powers(1.0, plot.time_s, plot.time_s * plot.time_s / 2);
    design.row(k) = powers.head(terms).transpose();
    values.row(k) = plot.position.transpose();
  }
  factors = (design.transpose() * design).inverse();
  return design.colPivHouseholderQr().solve(values);
}

/// That a line or a parabola is the polynomial with so many terms, and its factors are.
void expect_fit(const Line<double>& line, const std::vector<Known>& known, int plots, int terms) {
  Eigen::MatrixXd factors;
  const Eigen::MatrixXd wanted = fitted(known, plots, terms, factors);
  const Tolerance tolerance{.absolute = 1e-8, .relative = 1e-12};
  EXPECT_EQ(line.plots, plots);
  EXPECT_TRUE(matrices_near(line.position_m, wanted.row(0).transpose(), tolerance));
  EXPECT_TRUE(matrices_near(line.velocity_mps, wanted.row(1).transpose(), tolerance));
  EXPECT_NEAR(line.position_factor / factors(0, 0), 1.0, 1e-9);
  EXPECT_NEAR(line.cross_factor / factors(0, 1), 1.0, 1e-9);
  EXPECT_NEAR(line.velocity_factor / factors(1, 1), 1.0, 1e-9);
}

/// Lets time pass on both sides.
void pass(Bank& bank, std::vector<Known>& known, double dt_s) {
  bank.advance(dt_s);
  for (Known& plot : known) plot.time_s -= dt_s;
}

TEST(LineBank, IsThePolynomialFitForEveryLengthAndIrregularTimes) {
  Draw draw(11);
  Bank bank(10);
  std::vector<Known> known;
  Bank::Lines lines;
  for (int scan = 0; scan < 60; ++scan) {
    pass(bank, known, draw.uniform(0.5, 8.0));
    if (scan % 7 != 3) {  // else missed
      known.push_back({0.0, Vec<double, 2>(20000, -7000) + 50.0 * draw.normals<2>()});
      bank.add({known.back().position, kPlot});
      if (known.size() > 10) known.erase(known.begin());
    }
    ASSERT_EQ(bank.size(), int(known.size()));
    bank.fit(lines);
    for (int n = 2; n <= bank.size(); ++n) {
      const auto& line = lines[std::size_t(n - 2)];
      expect_fit(line, known, n, 2);
      if (n > 2) expect_fit(line.parabola(), known, n, 3);
    }
  }
}

TEST(LineBank, PredictionOfRegularPlotsObeysTheLaws) {
  constexpr double kPeriod_s = 3.0, kAcceleration_mps2 = 0.4;
  Bank bank;
  for (int k = 0; k < 20; ++k) {
    const double t = k * kPeriod_s;
    bank.add({{2000 + 7 * t + kAcceleration_mps2 * t * t / 2, -3 * t}, kPlot});
    bank.advance(kPeriod_s);
  }
  Bank::Lines lines;
  bank.fit(lines);
  const double now = 20 * kPeriod_s;
  for (int n = 2; n <= Bank::kCapacity; ++n) {
    const auto& line = lines[std::size_t(n - 2)];
    const double lag = -kPeriod_s * kPeriod_s * (n + 1) * (n + 2) / 12.0;
    EXPECT_NEAR(line.steady_lag[0], lag, 1e-10);
    EXPECT_NEAR(line.position_factor, 2.0 * (2 * n + 1) / (n * (n - 1.0)), 1e-12);
    const double x = 2000 + 7 * now + kAcceleration_mps2 * now * now / 2;
    EXPECT_NEAR(line.position_m[0] - x, kAcceleration_mps2 * lag, 1e-9);
    EXPECT_NEAR(line.velocity_mps[0] - 7 - kAcceleration_mps2 * now,
                kAcceleration_mps2 * line.steady_lag[1], 1e-10);
    EXPECT_NEAR(line.position_m[1], -3 * now, 1e-9);
  }
}

TEST(LineBank, LagOfAnAccelerationThatHasJustBegun) {
  Bank bank;
  const double times[] = {0, 3, 5, 9, 12, 14.5};  // the acceleration begins at 12
  for (int k = 0; k < 6; ++k) {
    if (k > 0) bank.advance(times[k] - times[k - 1]);
    const double since = std::max(times[k] - 12.0, 0.0);
    bank.add({{since * since / 2, 0.0}, kPlot});
  }
  bank.advance(2.0);
  Bank::Lines lines;
  bank.fit(lines);
  for (int n = 2; n <= 6; ++n) {
    const auto& line = lines[std::size_t(n - 2)];
    EXPECT_NEAR(line.position_m[0] - 4.5 * 4.5 / 2, line.onset_lag[0], 1e-12) << n;
    EXPECT_NEAR(line.velocity_mps[0] - 4.5, line.onset_lag[1], 1e-12) << n;
    if (n < 3) continue;
    const auto curved = line.parabola();
    EXPECT_NEAR(curved.position_m[0] - 4.5 * 4.5 / 2, curved.onset_lag[0], 1e-10) << n;
    EXPECT_NEAR(curved.velocity_mps[0] - 4.5, curved.onset_lag[1], 1e-10) << n;
  }
  EXPECT_NEAR(lines[0].onset_lag[0], lines[0].steady_lag[0], 1e-12);  // two plots: the same
}

TEST(LineBank, KnownAccelerationIsNoManeuver) {
  Draw draw(3);
  Bank bank;
  Vec<double, 2> position(1000, 2000), velocity(4, -6);
  for (int k = 0; k < 30; ++k) {
    const double dt = draw.uniform(1, 4);
    const Vec<double, 2> u = 0.5 * draw.normals<2>();
    position += dt * velocity + dt * dt / 2 * u;
    velocity += dt * u;
    bank.advance(dt, u);
    if (k % 3 != 1) bank.add({position, kPlot});
  }
  Bank::Lines lines;
  bank.fit(lines);
  for (int k = 0; k < bank.lines(); ++k) {
    EXPECT_TRUE(matrices_near(lines[std::size_t(k)].position_m, position, {1e-8, 0}));
    EXPECT_TRUE(matrices_near(lines[std::size_t(k)].velocity_mps, velocity, {1e-9, 0}));
  }
}

TEST(LineBank, ErrorsAreThoseOfTheBelief) {
  Draw draw(5);
  constexpr int kRuns = 4000;
  Mat<double, 4, 4> spread = Mat<double, 4, 4>::Zero();
  Gaussian<4> belief;
  for (int run = 0; run < kRuns; ++run) {
    Bank bank;
    for (const double dt : {0.0, 2.0, 3.0, 6.0, 3.0}) {
      bank.advance(dt);
      bank.add({draw.error<2>(kPlot), kPlot});
    }
    bank.advance(3.0);
    Bank::Lines lines;
    bank.fit(lines);
    belief = lines[3].belief(0.0);
    spread += belief.mean * belief.mean.transpose() / kRuns;
  }
  EXPECT_LT(test::covariance_difference(spread, belief.covariance), 0.06);
  EXPECT_TRUE(test::is_covariance(belief.covariance));
}

TEST(LineBank, PlotsOfOneTimeBecomeTheirMean) {
  Bank bank;
  bank.add({{0, 0}, kPlot});
  bank.advance(3.0);
  bank.add({{30, 8}, kPlot});
  bank.add({{34, 4}, kPlot});
  EXPECT_EQ(bank.size(), 2);
  Bank::Lines lines;
  bank.fit(lines);
  EXPECT_TRUE(matrices_near(lines[0].position_m, Vec<double, 2>(32, 6)));
  EXPECT_TRUE(matrices_near(lines[0].velocity_mps, Vec<double, 2>(32, 6) / 3.0));
}

TEST(LineBank, PlotsOfTwoRadarsOutOfStepBecomeTheirMeanAtTheMeanOfTheirTimes) {
  Bank bank;
  Bank::Lines lines;
  const Vec<double, 2> velocity(20.0, -10.0);
  double time_s = 0.0;
  for (int scan = 1; scan <= 5; ++scan)
    for (const double dt_s : {2.9, 0.1}) {
      bank.advance(dt_s);
      time_s += dt_s;
      bank.add({time_s * velocity, kPlot});
    }
  EXPECT_EQ(bank.size(), 5);
  bank.fit(lines);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_TRUE(matrices_near(lines[k].position_m, time_s * velocity, {.absolute = 1e-9}));
    EXPECT_TRUE(matrices_near(lines[k].velocity_mps, velocity, {.absolute = 1e-9}));
  }
}

TEST(LineBank, ArchiveRestoresEverythingAndRejectsOtherArchives) {
  Draw draw(9);
  Bank bank(7);
  for (int k = 0; k < 11; ++k) {
    bank.add({100 * draw.normals<2>(), kPlot});
    bank.advance(draw.uniform(1, 3));
  }
  Archive written;
  bank.archive(written);
  Bank restored(7);
  Archive read(written.bytes());
  restored.archive(read);
  ASSERT_TRUE(read.ok() && read.at_end());
  Bank::Lines a, b;
  bank.fit(a);
  restored.fit(b);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_TRUE(test::matrices_identical(a[k].position_m, b[k].position_m));
  Bank shorter(5);
  Archive again(written.bytes());
  shorter.archive(again);
  EXPECT_FALSE(again.ok());
}

TEST(LineBank, TheTimeSinceTheNewestPlotCostsNoAccuracy) {
  LineBank<10, float> coarse;
  LineBank<10, double> fine;
  Draw draw(5);
  for (int k = 0; k < 10; ++k) {
    const Vec<float, 2> plot(float(1000.0 + 15.0 * k + draw.normal()), float(3.0 * draw.normal()));
    coarse.advance(3.0f);
    fine.advance(3.0);
    coarse.add({plot, kPlot.cast<float>()});
    fine.add({plot.cast<double>(), kPlot});
  }
  for (const double waited_s : {600.0, 3000.0, 32400.0}) {
    coarse.advance(float(waited_s));
    fine.advance(waited_s);
    LineBank<10, float>::Lines line{};
    LineBank<10, double>::Lines wanted{};
    coarse.fit(line);
    fine.fit(wanted);
    for (std::size_t k = 1; k < 9; ++k) {  // through three plots and more
      EXPECT_NEAR(double(line[k].acceleration_factor) / wanted[k].acceleration_factor, 1.0, 1e-4);
      const auto parabola = line[k].parabola();
      const auto exact = wanted[k].parabola();
      EXPECT_NEAR(double(parabola.position_factor) / exact.position_factor, 1.0, 1e-4);
      const double error_m = (parabola.position_m.cast<double>() - exact.position_m).norm();
      EXPECT_LT(error_m, 1e-2 * std::sqrt(exact.position_factor)) << k << " after " << waited_s;
    }
  }
}

template <class Scalar>
void expect_sound_lines_across_a_gap(double period_s, double gap_s) {
  Draw draw(6);
  for (int before = 3; before < 9; ++before) {
    LineBank<10, Scalar> bank;
    typename LineBank<10, Scalar>::Lines lines{};
    for (int k = 0; k <= before; ++k) {
      bank.add({draw.normals<2>().template cast<Scalar>(), kPlot.cast<Scalar>()});
      bank.advance(Scalar(k + 1 < before ? period_s : gap_s));
    }
    bank.fit(lines);
    for (int k = 1; k < bank.lines(); ++k) {
      const auto belief = lines[std::size_t(k)].parabola().belief(Scalar(0.15));
      EXPECT_TRUE(belief.mean.allFinite() && belief.covariance.allFinite()) << k + 2 << " plots";
      EXPECT_GT(belief.covariance.diagonal().minCoeff(), Scalar(0)) << k + 2 << " plots";
    }
  }
}

TEST(LineBank, AGapThatDwarfsAllOthersLeavesSoundLines) {
  for (const double gap_s : {3e3, 1e4, 3e4, 1e5})
    expect_sound_lines_across_a_gap<float>(3.0, gap_s);
  for (const double gap_s : {1e5, 1e6, 1e7}) expect_sound_lines_across_a_gap<double>(0.002, gap_s);
}

TEST(LineBank, IsOfFloatTooAndTouchesNoHeap) {
  LineBank<8, float> bank;
  LineBank<8, float>::Lines lines;
  const test::NoHeap fence;
  for (int k = 0; k < 12; ++k) {
    bank.add({{10.0f * float(k), 5.0f}, Mat<float, 2, 2>::Identity()});
    bank.advance(2.0f, Vec<float, 2>(0, 0));
    bank.fit(lines);
  }
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_NEAR(lines[6].velocity_mps[0], 5.0f, 1e-5f);
}

TEST(LineBank, RejectsALengthBeyondItsCapacity) {
  EXPECT_THROW(Bank(1), std::invalid_argument);
  EXPECT_THROW(Bank(17), std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::line_bank_test
