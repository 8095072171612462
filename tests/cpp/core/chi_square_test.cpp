// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/core/chi_square.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wakeline::chi_square_test {
namespace {

constexpr double kDofs[] = {0.3, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 9.0, 31.0, 32.5, 100.0, 1e3, 1e5};
constexpr double kProbabilities[] = {1e-9, 1e-4, 0.01, 0.05,  0.3,       0.5,
                                     0.7,  0.95, 0.99, 0.999, 1.0 - 1e-9};

TEST(ChiSquare, QuantileInvertsTheDistribution) {
  for (const double dof : kDofs)
    for (const double probability : kProbabilities) {
      const double value = chi_square_quantile(probability, dof);
      if (probability <= 0.5)
        EXPECT_NEAR(chi_square_probability(value, dof) / probability, 1.0, 1e-11) << dof;
      else
        EXPECT_NEAR(chi_square_tail(value, dof) / (1.0 - probability), 1.0, 1e-11) << dof;
    }
}

TEST(ChiSquare, AgreesWithPrintedTables) {
  EXPECT_NEAR(chi_square_quantile(0.95, 1), 3.841, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.95, 2), 5.991, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.99, 2), 9.210, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.95, 4), 9.488, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.99, 4), 13.277, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.05, 10), 3.940, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.025, 200), 162.728, 5e-4);
  EXPECT_NEAR(chi_square_quantile(0.975, 200), 241.058, 5e-4);
}

TEST(ChiSquare, OneDofIsASquaredNormal) {
  for (const double value : {1e-12, 0.01, 0.5, 1.0, 4.0, 9.0, 100.0, 400.0}) {
    EXPECT_NEAR(chi_square_probability(value, 1) / std::erf(std::sqrt(0.5 * value)), 1.0, 1e-13);
    EXPECT_NEAR(chi_square_tail(value, 1) / std::erfc(std::sqrt(0.5 * value)), 1.0, 1e-12);
  }
}

TEST(ChiSquare, EvenDofIsAFinitePoissonSum) {
  for (const int half_dof : {1, 2, 5, 20})
    for (const double value : {0.1, 3.0, 10.0, 39.0, 41.0, 90.0}) {
      double term = std::exp(-0.5 * value);
      double sum = 0.0;
      for (int k = 0; k < half_dof; ++k) {
        sum += term;
        term *= 0.5 * value / (k + 1);
      }
      EXPECT_NEAR(chi_square_tail(value, 2.0 * half_dof) / sum, 1.0, 1e-12);
    }
}

TEST(ChiSquare, ManyDofAreNearlyNormal) {
  // Cornish and Fisher: normal quantiles z, sqrt(2 dof) z + 2/3 (z² - 1) above dof.
  constexpr double kNormal[][2] = {{0.025, -1.959963984540054}, {0.5, 0.0}, {0.999, 3.090232306}};
  for (const double dof : {1e10, 1e12, 1.9e12, 2.1e12, 1e14, 1e16, 1e20, 1e100, 1e300})
    for (const auto& [probability, z] : kNormal) {
      const double above = std::sqrt(2.0 * dof) * z + 2.0 / 3.0 * (z * z - 1.0);
      EXPECT_NEAR(chi_square_quantile(probability, dof) - dof, above,
                  1e-4 + 1e-15 * dof + 1e-8 * std::abs(above))
          << probability << " of " << dof;
    }
  // On both sides of where the form changes.
  for (const double sigmas : {-7.0, -3.0, -0.5, 0.0, 0.5, 3.0, 7.0}) {
    const auto at = [&](auto probability, double dof) {
      return probability(dof + sigmas * std::sqrt(2.0 * dof), dof);
    };
    const double below = std::nextafter(2e12, 0.0);
    EXPECT_NEAR(at(chi_square_tail, 2e12) / at(chi_square_tail, below), 1.0, 1e-8) << sigmas;
    EXPECT_NEAR(at(chi_square_probability, 2e12) / at(chi_square_probability, below), 1.0, 1e-8)
        << sigmas;
  }
  EXPECT_EQ(chi_square_probability(1e308, 1e20), 1.0);
  EXPECT_EQ(chi_square_tail(1e308, 1e20), 0.0);
  EXPECT_EQ(chi_square_probability(1.0, 1e20), 0.0);
}

TEST(ChiSquare, TwoDofMatchesTheGeneralForm) {
  const double beside = std::nextafter(2.0, 3.0);
  for (const double probability : kProbabilities)
    EXPECT_NEAR(chi_square_quantile(probability, 2.0) / chi_square_quantile(probability, beside),
                1.0, 1e-12);
}

TEST(ChiSquare, TailsSumToOneAndProbabilityGrowsWithValue) {
  for (const double dof : kDofs) {
    double before = 0.0;
    for (double value = 0.01 * dof; value < 4.0 * dof; value += 0.03 * dof) {
      const double probability = chi_square_probability(value, dof);
      EXPECT_NEAR(probability + chi_square_tail(value, dof), 1.0, 1e-15);
      EXPECT_GE(probability, before - 1e-15);
      before = probability;
    }
  }
}

TEST(ChiSquare, EdgesAreDefined) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double dof : {0.5, 2.0, 7.0}) {
    EXPECT_EQ(chi_square_quantile(0.0, dof), 0.0);
    EXPECT_EQ(chi_square_quantile(1.0, dof), infinity);
    EXPECT_EQ(chi_square_probability(-1.0, dof), 0.0);
    EXPECT_EQ(chi_square_probability(infinity, dof), 1.0);
    EXPECT_EQ(chi_square_tail(infinity, dof), 0.0);
    EXPECT_TRUE(std::isnan(chi_square_probability(nan, dof)));
    for (const double probability : {-0.1, 1.1, nan})
      EXPECT_TRUE(std::isnan(chi_square_quantile(probability, dof)));
  }
  for (const double dof : {0.0, -1.0, nan, infinity}) {
    EXPECT_TRUE(std::isnan(chi_square_quantile(0.5, dof)));
    EXPECT_TRUE(std::isnan(chi_square_probability(0.5, dof)));
    EXPECT_TRUE(std::isnan(chi_square_tail(0.5, dof)));
  }
}

}  // namespace
}  // namespace wakeline::chi_square_test
