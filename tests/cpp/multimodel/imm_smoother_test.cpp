// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/multimodel/imm_smoother.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "support/draw.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/uniform_bank.hpp"

namespace wakeline::imm_smoother_test {
namespace {

using test::Draw;
using test::is_covariance;
using test::matrices_near;
using Vec2 = Vec<double, 2>;

constexpr double kStep_s = 3.0;
constexpr Position kSensor{.position_std_m = 30.0};
const PiecewiseAcceleration kNoise{0.05};

Ekf<CoordinatedTurn> turning(double rate_deg_s) {
  return Ekf{CoordinatedTurn{.turn_rate_rad_s = deg(rate_deg_s), .noise = kNoise}};
}

Gaussian<4> start() {
  Gaussian<4> belief;
  belief.mean << 0, 8, 0, 3;
  belief.covariance = Vec<double, 4>(900, 4, 900, 4).asDiagonal();
  return belief;
}

using Turns = Imm<UniformBank<Ekf<CoordinatedTurn>>>;
using TurnScan = ImmScan<Turns::Bank>;

/// An Imm of turns, each of which continues with probability 0.9.
Turns turns(const std::vector<double>& rates_deg_s) {
  std::vector<Ekf<CoordinatedTurn>> filters;
  for (const double rate : rates_deg_s) filters.push_back(turning(rate));
  const std::span<const Ekf<CoordinatedTurn>> models(filters);
  const auto modes = static_cast<Eigen::Index>(filters.size());
  return {modes == 1 ? ModeChain<kRuntimeModes>(Mat<double, 1, 1>::Ones())
                     : ModeChain<kRuntimeModes>::staying(0.9, modes),
          Turns::Bank(models)};
}

/// A voyage that goes straight, turns to starboard by 2°/s and goes straight again, and its plots.
struct Voyage {
  std::vector<Vec<double, 4>> truth;
  std::vector<std::optional<Vec2>> plots;

  explicit Voyage(std::uint64_t seed, int scans = 75) {
    Draw draw(seed);
    Vec<double, 4> x = start().mean;
    for (int k = 0; k < scans; ++k) {
      const double rate = k >= scans / 3 && k < 2 * scans / 3 ? deg(2.0) : 0.0;
      x = CoordinatedTurn{.turn_rate_rad_s = rate}.matrix(kStep_s) * x;
      truth.push_back(x);
      plots.emplace_back(Vec2(x[0], x[2]) + kSensor.position_std_m * draw.normals<2>());
    }
  }
};

/// Takes an Imm through plots.
std::vector<TurnScan> recorded(Turns imm, const std::vector<std::optional<Vec2>>& plots) {
  std::vector<TurnScan> scans;
  EXPECT_EQ(imm.start(start()), Status::kOk);
  for (const auto& plot : plots) {
    EXPECT_EQ(imm.predict(kStep_s), Status::kOk);
    const Turns predicted = imm;
    if (plot) {
      EXPECT_TRUE(imm.update(kSensor, *plot));
    }
    scans.push_back({predicted, imm, kStep_s});
  }
  return scans;
}

std::vector<TurnScan> smoothed(const Turns& imm, const std::vector<std::optional<Vec2>>& plots) {
  auto scans = recorded(imm, plots);
  EXPECT_EQ(ImmSmoother<Turns::Bank>::smooth(scans), Status::kOk);
  return scans;
}

TEST(Revised, IsThePosteriorOfWhatMadeOneBeliefAnother) {
  Draw draw(1);
  Gaussian<4> before = start(), prior = start();
  before.mean += 5.0 * draw.normals<4>();
  prior.covariance *= 1.7;
  prior.covariance(0, 1) = prior.covariance(1, 0) = 20.0;
  // A reading H x of noise R, taken by both.
  Mat<double, 2, 4> h;
  h << 1, 0.5, 0, 0, 0, 0, 1, -0.2;
  const Mat<double, 2, 2> r = Vec2(100, 50).asDiagonal();
  const Vec2 z(12.0, -7.0);
  const auto taken = [&](const Gaussian<4>& belief, double& log_likelihood) {
    const Cholesky<2> s(Mat<double, 2, 2>(h * belief.covariance * h.transpose() + r));
    const Mat<double, 4, 2> ph = belief.covariance * h.transpose();
    const Vec2 v = z - h * belief.mean;
    log_likelihood = -(s.squared_norm(v) + s.log_determinant()) / 2;
    Gaussian<4> after;
    after.mean = belief.mean + ph * s.solve<1>(v);
    after.covariance = belief.covariance - ph * s.solve<4>(Mat<double, 2, 4>(ph.transpose()));
    mirror_lower<double, 4>(after.covariance);
    return after;
  };
  double of_before = 0.0, of_prior = 0.0;
  const Gaussian<4> after = taken(before, of_before), expected = taken(prior, of_prior);
  const auto result = revised(prior, before, after);
  ASSERT_EQ(result.status, Status::kOk);
  EXPECT_TRUE(matrices_near(result.belief.mean, expected.mean, {1e-8, 1e-9}));
  EXPECT_TRUE(matrices_near(result.belief.covariance, expected.covariance, {1e-8, 1e-9}));
  EXPECT_NEAR(result.log_evidence, of_prior - of_before, 1e-9);
}

TEST(Revised, OfTheSamePriorIsItsPosterior) {
  Gaussian<4> after = start();
  after.mean << 3, 8.5, -2, 2.5;
  after.covariance *= 0.4;
  const auto result = revised(start(), start(), after);
  ASSERT_EQ(result.status, Status::kOk);
  EXPECT_TRUE(matrices_near(result.belief.mean, after.mean, {1e-12, 1e-12}));
  EXPECT_TRUE(matrices_near(result.belief.covariance, after.covariance, {1e-12, 1e-12}));
  EXPECT_NEAR(result.log_evidence, 0.0, 1e-12);
}

// Where all modes are one model there is nothing to choose: the smoother of Rauch, Tung, Striebel.
void expect_rts(const Turns& imm, const Ekf<CoordinatedTurn>& filter) {
  Voyage voyage(2);
  voyage.plots[20] = voyage.plots[21] = std::nullopt;
  const auto scans = smoothed(imm, voyage.plots);
  std::vector<Gaussian<4>> beliefs;
  Ekf<CoordinatedTurn> alone = filter;
  ASSERT_EQ(alone.start(start()), Status::kOk);
  for (const auto& plot : voyage.plots) {
    ASSERT_EQ(alone.predict(kStep_s), Status::kOk);
    if (plot) {
      ASSERT_TRUE(alone.update(kSensor, *plot));
    }
    beliefs.push_back(alone.estimate());
  }
  const std::vector<double> steps_s(beliefs.size() - 1, kStep_s);
  ASSERT_EQ((smooth<CoordinatedTurn, double>(filter.motion(), beliefs, steps_s)), Status::kOk);
  for (std::size_t k = 0; k < beliefs.size(); ++k) {
    const auto estimate = scans[k].updated.estimate();
    EXPECT_TRUE(matrices_near(estimate.mean, beliefs[k].mean, {1e-7, 1e-9})) << k;
    EXPECT_TRUE(matrices_near(estimate.covariance, beliefs[k].covariance, {1e-6, 1e-7})) << k;
  }
}

TEST(ImmSmoother, OfOneModelIsThatOfItsFilter) { expect_rts(turns({1.0}), turning(1.0)); }

TEST(ImmSmoother, OfEqualModelsIsThatOfTheirFilter) {
  expect_rts(turns({0.0, 0.0, 0.0}), turning(0.0));
}

TEST(ImmSmoother, LeavesTheLastScanAsItWas) {
  const Voyage voyage(3);
  const Turns imm = turns({0.0, 2.0});
  const auto filtered = recorded(imm, voyage.plots), smooth = smoothed(imm, voyage.plots);
  EXPECT_EQ(smooth.back().updated.estimate().mean, filtered.back().updated.estimate().mean);
  EXPECT_EQ(smooth.back().updated.mode_probability(), filtered.back().updated.mode_probability());
}

/// The smoothed estimate and the probability of the second mode in each scan, from every history of
/// modes there can be.
struct Exact {
  std::vector<Vec<double, 4>> mean;
  std::vector<double> probability;

  Exact(const std::array<double, 2>& rates_deg_s, const std::vector<std::optional<Vec2>>& plots)
      : mean(plots.size(), Vec<double, 4>::Zero()), probability(plots.size(), 0.0) {
    const std::size_t scans = plots.size();
    std::vector<double> weights;
    std::vector<std::vector<Gaussian<4>>> ways;
    for (unsigned history = 0; history < (1u << scans); ++history) {
      const auto mode = [&](std::size_t k) { return (history >> k) & 1u; };
      double weight = 0.0;
      Gaussian<4> belief = start();
      std::vector<Gaussian<4>> beliefs;
      for (std::size_t k = 0; k < scans; ++k) {
        weight += k == 0 ? std::log(0.5) : std::log(mode(k) == mode(k - 1) ? 0.9 : 0.1);
        Ekf<CoordinatedTurn> filter = turning(rates_deg_s[mode(k)]);
        EXPECT_EQ(filter.start(belief), Status::kOk);
        EXPECT_EQ(filter.predict(kStep_s), Status::kOk);
        if (plots[k]) weight += filter.update(kSensor, *plots[k]).log_likelihood;
        beliefs.push_back(belief = filter.estimate());
      }
      for (std::size_t k = scans; k-- > 1;) {
        std::array<Gaussian<4>, 2> pair{beliefs[k - 1], beliefs[k]};
        const Ekf<CoordinatedTurn> filter = turning(rates_deg_s[mode(k)]);
        EXPECT_EQ((smooth<CoordinatedTurn, double>(filter.motion(), pair, std::span(&kStep_s, 1))),
                  Status::kOk);
        beliefs[k - 1] = pair[0];
      }
      weights.push_back(weight);
      ways.push_back(beliefs);
    }
    const double greatest = *std::ranges::max_element(weights);
    double sum = 0.0;
    for (double& weight : weights) sum += weight = std::exp(weight - greatest);
    for (unsigned history = 0; history < weights.size(); ++history)
      for (std::size_t k = 0; k < scans; ++k) {
        mean[k] += weights[history] / sum * ways[history][k].mean;
        probability[k] += ((history >> k) & 1u) * weights[history] / sum;
      }
  }
};

TEST(ImmSmoother, ComesNearTheSumOverAllHistories) {
  const std::array rates_deg_s{0.0, 4.0};
  const Turns imm = turns({rates_deg_s[0], rates_deg_s[1]});
  double off_m = 0.0, filtered_off_m = 0.0, off = 0.0, filtered_off = 0.0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Voyage voyage(seed, 10);
    const Exact exact(rates_deg_s, voyage.plots);
    const auto filtered = recorded(imm, voyage.plots), smooth = smoothed(imm, voyage.plots);
    for (std::size_t k = 0; k < voyage.plots.size(); ++k) {
      const auto estimate = smooth[k].updated.estimate();
      off_m += (estimate.mean - exact.mean[k]).norm();
      filtered_off_m += (filtered[k].updated.estimate().mean - exact.mean[k]).norm();
      off += std::abs(smooth[k].updated.mode_probability()[1] - exact.probability[k]);
      filtered_off += std::abs(filtered[k].updated.mode_probability()[1] - exact.probability[k]);
      EXPECT_TRUE(is_covariance(estimate.covariance)) << seed << ' ' << k;
    }
  }
  EXPECT_LT(off_m, 0.1 * filtered_off_m);
  EXPECT_LT(off, 0.1 * filtered_off);
}

/// Mean squared errors of position and velocity, filtered and smoothed.
std::array<double, 4> errors(const Turns& imm, int runs) {
  std::array<double, 4> sums{};
  for (int run = 0; run < runs; ++run) {
    const Voyage voyage(std::uint64_t(100 + run));
    const auto filtered = recorded(imm, voyage.plots), smooth = smoothed(imm, voyage.plots);
    for (std::size_t k = 0; k < voyage.truth.size(); ++k)
      for (const auto* scans : {&filtered, &smooth}) {
        const Gaussian<4> belief = kinematics_of((*scans)[k].updated.estimate());
        const Vec<double, 4> off = belief.mean - voyage.truth[k];
        const std::size_t at = scans == &smooth ? 2 : 0;
        sums[at] += off[0] * off[0] + off[2] * off[2];
        sums[at + 1] += off[1] * off[1] + off[3] * off[3];
      }
  }
  return sums;
}

TEST(ImmSmoother, KnowsTurnsFarBetterThanTheFilter) {
  const auto sums = errors(turns({-2.0, 0.0, 2.0}), 20);
  EXPECT_LT(sums[2], 0.4 * sums[0]);
  EXPECT_LT(sums[3], 0.2 * sums[1]);
}

TEST(ImmSmoother, DoesNotMindTheOrderOfModes) {
  const Voyage voyage(7);
  const auto one = smoothed(turns({0.0, 2.0}), voyage.plots);
  const auto other = smoothed(turns({2.0, 0.0}), voyage.plots);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_TRUE(matrices_near(one[k].updated.estimate().mean, other[k].updated.estimate().mean,
                              {1e-9, 1e-9}));
    EXPECT_NEAR(one[k].updated.mode_probability()[0], other[k].updated.mode_probability()[1], 1e-9);
  }
}

TEST(ImmSmoother, ReportsAnInvalidStep) {
  const Voyage voyage(8, 12);
  const Turns imm = turns({0.0, 2.0});
  const auto filtered = recorded(imm, voyage.plots);
  auto scans = filtered;
  scans[6].dt_s = -1.0;
  EXPECT_NE(ImmSmoother<Turns::Bank>::smooth(scans), Status::kOk);
  EXPECT_EQ(scans[5].updated.estimate().mean, filtered[5].updated.estimate().mean);
  EXPECT_NE(scans[6].updated.estimate().mean, filtered[6].updated.estimate().mean);
}

TEST(ImmSmoother, ReportsWhyAStepCannotBeSmoothed) {
  // Behind a gap of months a belief may be too wide and too flat to have a factor.
  int hindered = 0;
  for (double gap_s = 1e6; gap_s < 1e9; gap_s *= 1.5) {
    Turns imm = turns({0.0, 2.0});
    ASSERT_EQ(imm.start(start()), Status::kOk);
    std::vector<TurnScan> scans;
    for (int k = 0; k < 8; ++k) {
      const double dt_s = k == 4 ? gap_s : kStep_s;
      ASSERT_EQ(imm.predict(dt_s), Status::kOk);
      scans.push_back({imm, imm, dt_s});
      if (imm.update(kSensor, Vec2(24.0 * k, 9.0 * k))) scans.back().updated = imm;
    }
    const Status status = ImmSmoother<Turns::Bank>::smooth(scans);
    if (status == Status::kOk) continue;
    EXPECT_EQ(status, Status::kNotPositiveDefinite) << gap_s;
    ++hindered;
  }
  EXPECT_GT(hindered, 0);
}

TEST(ImmSmoother, ReportsAnInvalidAcceleration) {
  auto scans = recorded(turns({0.0, 2.0}), Voyage(8, 2).plots);
  const std::array<Vec2, 2> acceleration_mps2{Vec2(0, 0), Vec2(NAN, 0)};
  EXPECT_EQ(ImmSmoother<Turns::Bank>::smooth(scans, acceleration_mps2), Status::kNotFinite);
}

}  // namespace
}  // namespace wakeline::imm_smoother_test
