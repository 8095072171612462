// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/association/probabilistic_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include "support/malloc_fence.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/core/angle.hpp"
#include "wakeline/core/cholesky.hpp"

namespace wakeline::probabilistic_data_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Scalar>
std::vector<Scalar> associate(const ProbabilisticData& pda,
                              const std::vector<Scalar>& log_likelihood) {
  std::vector<Scalar> probability(log_likelihood.size() + 1);
  EXPECT_EQ(pda.association_probability(std::span<const Scalar>(log_likelihood),
                                        std::span<Scalar>(probability)),
            Status::kOk);
  return probability;
}

template <class Scalar>
class ProbabilisticDataOf : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(ProbabilisticDataOf, Scalars, );

TYPED_TEST(ProbabilisticDataOf, ProbabilitiesSumToOneAndRankAsLikelihoods) {
  std::mt19937_64 random(21);
  std::uniform_real_distribution<TypeParam> log_likelihood(-60, 5);
  for (std::size_t plots = 0; plots < 20; ++plots) {
    std::vector<TypeParam> values(plots);
    for (TypeParam& value : values) value = log_likelihood(random);
    const auto probability = associate(ProbabilisticData{}, values);
    EXPECT_NEAR(std::accumulate(probability.begin(), probability.end(), 0.0), 1.0, 1e-5);
    for (std::size_t i = 0; i < plots; ++i) {
      EXPECT_GE(probability[i + 1], TypeParam(0));
      for (std::size_t j = 0; j < plots; ++j) {
        if (values[i] > values[j]) {
          EXPECT_GE(probability[i + 1], probability[j + 1]);
        }
      }
    }
  }
}

TEST(ProbabilisticData, IsTheTextbookFormula) {
  // Bar-Shalom and Li's form: e_i = exp(-NIS_i / 2), b = λ √det(2πS) (1 - P_D P_G) / P_D.
  const ProbabilisticData pda{
      .detection_probability = 0.8, .gate_probability = 0.99, .clutter_density = 2e-4};
  const std::vector<double> nis = {0.3, 2.0, 8.5};
  const double root_det_two_pi_s = 2.0 * kPi<double> * 30.0 * 50.0;
  const double b = 2e-4 * root_det_two_pi_s * (1.0 - 0.8 * 0.99) / 0.8;
  double sum = b;
  std::vector<double> log_likelihood;
  for (const double value : nis) {
    sum += std::exp(-0.5 * value);
    log_likelihood.push_back(-0.5 * value - std::log(root_det_two_pi_s));
  }
  const auto probability = associate(pda, log_likelihood);
  EXPECT_NEAR(probability[0], b / sum, 1e-14);
  for (std::size_t i = 0; i < nis.size(); ++i)
    EXPECT_NEAR(probability[i + 1], std::exp(-0.5 * nis[i]) / sum, 1e-14);
}

TEST(ProbabilisticData, CertainDetectionWithoutClutterLeavesNoDoubt) {
  const ProbabilisticData certain{
      .detection_probability = 1.0, .gate_probability = 1.0, .clutter_density = 0.0};
  EXPECT_EQ(associate<double>(certain, {-700.0}), (std::vector<double>{0.0, 1.0}));
  const ProbabilisticData clean{
      .detection_probability = 0.7, .gate_probability = 0.9, .clutter_density = 0.0};
  EXPECT_EQ(associate<double>(clean, {-20.0}), (std::vector<double>{0.0, 1.0}));
}

TEST(ProbabilisticData, NoPlotIsTheTargetsWhenAllWeightsAreZero) {
  const ProbabilisticData certain{
      .detection_probability = 1.0, .gate_probability = 1.0, .clutter_density = 0.0};
  EXPECT_EQ(associate<double>(certain, {}), (std::vector<double>{1.0}));
  EXPECT_EQ(associate<double>(certain, {-kInfinity}), (std::vector<double>{1.0, 0.0}));
  EXPECT_EQ(associate<double>({.detection_probability = 0.0}, {3.0}),
            (std::vector<double>{1.0, 0.0}));
}

TEST(ProbabilisticData, SurvivesLikelihoodsThatUnderflow) {
  const auto probability = associate<double>({.clutter_density = 0.0}, {-5000.0, -5001.0});
  EXPECT_NEAR(probability[1] / probability[2], std::exp(1.0), 1e-9);
  EXPECT_NEAR(probability[1] + probability[2], 1.0, 1e-15);
}

TEST(ProbabilisticData, MoreClutterMeansMoreDoubt) {
  double before = 0.0;
  for (const double density : {0.0, 1e-8, 1e-6, 1e-4, 1e-2, 1.0}) {
    const double none = associate<double>({.clutter_density = density}, {-8.0, -9.0})[0];
    EXPECT_GE(none, before);
    before = none;
  }
  EXPECT_GT(before, 0.9);
}

TEST(ProbabilisticData, NonParametricFormCountsThePlotsInTheGate) {
  const ProbabilisticData pda{.clutter_density = 123.0};
  EXPECT_DOUBLE_EQ(pda.with_clutter_from(3, 600.0).clutter_density, 0.005);
  EXPECT_EQ(pda.with_clutter_from(3, 600.0).detection_probability, pda.detection_probability);
}

TEST(ProbabilisticData, BadInputIsRejectedAndNothingWritten) {
  const ProbabilisticData pda;
  std::vector<double> probability = {7.0, 7.0};
  for (const double bad : {std::nan(""), kInfinity}) {
    const std::vector<double> values = {bad};
    EXPECT_EQ(pda.association_probability(std::span<const double>(values),
                                          std::span<double>(probability)),
              Status::kNotFinite);
    EXPECT_EQ(probability, (std::vector<double>{7.0, 7.0}));
  }
  const std::vector<double> two = {0.0, 0.0};
  EXPECT_EQ(
      pda.association_probability(std::span<const double>(two), std::span<double>(probability)),
      Status::kNotFinite);
  const std::vector<double> one = {0.0};
  for (const ProbabilisticData& wrong :
       {ProbabilisticData{.detection_probability = 2.0, .gate_probability = 0.3},
        ProbabilisticData{.gate_probability = -5.0}, ProbabilisticData{.gate_probability = 1.05},
        ProbabilisticData{.clutter_density = -1.0}}) {
    EXPECT_EQ(
        wrong.association_probability(std::span<const double>(one), std::span<double>(probability)),
        Status::kNotFinite);
    EXPECT_EQ(probability, (std::vector<double>{7.0, 7.0}));
  }
  EXPECT_THROW(ProbabilisticData{.detection_probability = 1.1}.validate(), std::invalid_argument);
  EXPECT_THROW(ProbabilisticData{.gate_probability = -0.1}.validate(), std::invalid_argument);
  EXPECT_THROW(ProbabilisticData{.clutter_density = -1.0}.validate(), std::invalid_argument);
}

/// A linear update of a 4-state belief by a position, written out for this test.
struct LinearUpdate {
  Gaussian<4> predicted;
  Mat<double, 4, 2> gain;
  Mat<double, 4, 4> updated_covariance;

  LinearUpdate() {
    Mat<double, 4, 4> root;
    root << 9, 0, 0, 0, 1, 2, 0, 0, -2, 0.3, 8, 0, 0.5, 0, 1, 3;
    predicted.mean << 100, 5, -40, 2;
    predicted.covariance = root * root.transpose();
    Mat<double, 2, 4> observe;
    observe << 1, 0, 0, 0, 0, 0, 1, 0;
    const Mat<double, 2, 2> innovation_covariance =
        observe * predicted.covariance * observe.transpose() + 25.0 * Mat<double, 2, 2>::Identity();
    gain = Cholesky<2>(innovation_covariance).solve<4>(observe * predicted.covariance).transpose();
    updated_covariance = predicted.covariance - gain * innovation_covariance * gain.transpose();
  }
};

using Innovations = std::vector<Vec<double, 2>>;

CombinedInnovation<2> combine(const Innovations& innovations,
                              const std::vector<double>& probability) {
  return combine_innovations<2, double>(std::span<const Vec<double, 2>>(innovations),
                                        std::span<const double>(probability));
}

TEST(ProbabilisticDataUpdate, ACertainPlotGivesTheKalmanUpdate) {
  const LinearUpdate kalman;
  const Vec<double, 2> innovation(12.0, -7.0);
  const auto combined = combine({Vec<double, 2>(90.0, 3.0), innovation}, {0.0, 0.0, 1.0});
  EXPECT_EQ(combined.spread, (Mat<double, 2, 2>::Zero()));
  const auto posterior = probabilistic_data_update<4, 2, double>(
      kalman.predicted, kalman.updated_covariance, kalman.gain, combined);
  const Vec<double, 4> expected = kalman.predicted.mean + kalman.gain * innovation;
  EXPECT_TRUE(test::matrices_near(posterior.mean, expected));
  EXPECT_TRUE(test::matrices_near(posterior.covariance, kalman.updated_covariance));
}

TEST(ProbabilisticDataUpdate, NoPlotLeavesThePrediction) {
  const LinearUpdate kalman;
  const auto posterior = probabilistic_data_update<4, 2, double>(
      kalman.predicted, kalman.updated_covariance, kalman.gain, combine({}, {1.0}));
  EXPECT_EQ(posterior.mean, kalman.predicted.mean);
  EXPECT_TRUE(test::matrices_near(posterior.covariance, kalman.predicted.covariance));
}

TEST(ProbabilisticDataUpdate, MatchesTheMomentsOfTheGaussianMixture) {
  const LinearUpdate kalman;
  const Innovations innovations = {{12.0, -7.0}, {-30.0, 15.0}, {4.0, 4.0}};
  const std::vector<double> probability = {0.2, 0.4, 0.1, 0.3};
  Vec<double, 4> mean = probability[0] * kalman.predicted.mean;
  for (std::size_t i = 0; i < innovations.size(); ++i)
    mean += probability[i + 1] * (kalman.predicted.mean + kalman.gain * innovations[i]);
  Vec<double, 4> deviation = kalman.predicted.mean - mean;
  Mat<double, 4, 4> covariance =
      probability[0] * (kalman.predicted.covariance + deviation * deviation.transpose());
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    deviation = kalman.predicted.mean + kalman.gain * innovations[i] - mean;
    covariance +=
        probability[i + 1] * (kalman.updated_covariance + deviation * deviation.transpose());
  }
  const auto posterior = probabilistic_data_update<4, 2, double>(
      kalman.predicted, kalman.updated_covariance, kalman.gain, combine(innovations, probability));
  EXPECT_TRUE(test::matrices_near(posterior.mean, mean));
  EXPECT_TRUE(test::matrices_near(posterior.covariance, covariance));
  EXPECT_TRUE(test::matrices_identical(posterior.covariance, posterior.covariance.transpose()));
  EXPECT_EQ(check(posterior), Status::kOk);
}

TEST(ProbabilisticDataUpdate, SpreadStaysPositiveSemidefiniteFarFromTheOrigin) {
  // Σ β ν νᵀ - ν νᵀ as printed loses all digits here.
  const Innovations innovations = {{1e8, 1e8}, {1e8 + 1.0, 1e8}};
  const auto combined = combine(innovations, {0.0, 0.5, 0.5});
  EXPECT_NEAR(combined.spread(0, 0), 0.25, 1e-12);
  EXPECT_GE(combined.spread(1, 1), 0.0);
}

TEST(ProbabilisticDataUpdate, TakesNoHeap) {
  const LinearUpdate kalman;
  const Innovations innovations = {{12.0, -7.0}, {-30.0, 15.0}};
  const std::vector<double> log_likelihood = {-8.0, -9.0};
  std::vector<double> probability(3);
  test::NoHeap fence;
  const Status status = ProbabilisticData{}.association_probability(
      std::span<const double>(log_likelihood), std::span<double>(probability));
  const auto posterior = probabilistic_data_update<4, 2, double>(
      kalman.predicted, kalman.updated_covariance, kalman.gain,
      combine_innovations<2, double>(innovations, probability));
  const long allocations = fence.allocations();
  EXPECT_EQ(status, Status::kOk);
  EXPECT_TRUE(is_finite(posterior.mean));
  EXPECT_EQ(allocations, 0);
}

}  // namespace
}  // namespace wakeline::probabilistic_data_test
