// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/innovation_consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/draw.hpp"
#include "wakeline/eval/consistency.hpp"

namespace wakeline::innovation_consistency_test {
namespace {

using test::Draw;
using Innovation = Vec<double, 2>;

/// Innovations that follow each other with that correlation.
std::vector<Innovation> innovations(Draw& draw, int count, double scale, double correlation) {
  std::vector<Innovation> all;
  Innovation last = draw.normals<2>();
  for (int k = 0; k < count; ++k) {
    last = correlation * last + std::sqrt(1.0 - correlation * correlation) * draw.normals<2>();
    all.push_back(scale * last);
  }
  return all;
}

InnovationConsistency of(const std::vector<Innovation>& innovations) {
  InnovationConsistency consistency;
  for (const Innovation& one : innovations) consistency.add(one);
  return consistency;
}

/// How often the mean NIS and the whiteness of so many plots are within their bounds of 0.9.
std::pair<double, double> shares_inside(int plots, double scale, double correlation) {
  constexpr int kRuns = 4000;
  constexpr double kConfidence = 0.9;
  const ConsistencyBounds bounds =
      consistency_bounds(kConfidence, 2, InnovationConsistency::samples(plots));
  const double white = std::sqrt(chi_square_quantile(kConfidence, 1.0) /
                                 (2.0 * InnovationConsistency::samples(plots - 1)));
  Draw draw(7);
  int nis = 0, whiteness = 0;
  for (int run = 0; run < kRuns; ++run) {
    const InnovationConsistency one = of(innovations(draw, plots, scale, correlation));
    nis += bounds.contains(one.mean_nis());
    whiteness += std::abs(one.whiteness()) < white;
  }
  return {double(nis) / kRuns, double(whiteness) / kRuns};
}

TEST(InnovationConsistency, IsTheWeightedMeanOfAllPlots) {
  Draw draw(1);
  const std::vector<Innovation> all = innovations(draw, 30, 1.3, 0.4);
  InnovationConsistency consistency;
  for (std::size_t n = 1; n <= all.size(); ++n) {
    consistency.add(all[n - 1]);
    double squares = 0.0, before = 0.0, products = 0.0, weights = 0.0, weights_squared = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      const double weight = std::pow(0.9, double(n - 1 - k));
      squares += weight * all[k].squaredNorm();
      weights += weight;
      weights_squared += weight * weight;
      if (k == 0) continue;
      before += weight * all[k - 1].squaredNorm();
      products += weight * all[k].dot(all[k - 1]);
    }
    EXPECT_EQ(consistency.plots(), int(n));
    EXPECT_NEAR(consistency.mean_nis(), squares / weights, 1e-12);
    EXPECT_NEAR(InnovationConsistency::samples(int(n)), weights * weights / weights_squared, 1e-9);
    if (n > 1) {
      EXPECT_NEAR(consistency.whiteness(), products / std::sqrt(squares * before), 1e-9);
    }
  }
}

TEST(InnovationConsistency, IsWithinItsBoundsAsOftenAsTheySay) {
  for (const int plots : {5, 20, 200}) {
    const auto [nis, whiteness] = shares_inside(plots, 1.0, 0.0);
    EXPECT_NEAR(nis, 0.9, 0.02) << plots;
    EXPECT_GT(whiteness, 0.88) << plots;  // the bound of many plots is wide for few
    if (plots >= 20) {
      EXPECT_LT(whiteness, 0.93) << plots;
    }
  }
}

TEST(InnovationConsistency, ShowsErrorsLargerThanStatedAndEstimatesThatLag) {
  EXPECT_LT(shares_inside(40, 2.0, 0.0).first, 0.01);
  EXPECT_LT(shares_inside(40, 0.4, 0.0).first, 0.01);
  EXPECT_LT(shares_inside(40, 1.0, 0.8).second, 0.05);
}

TEST(InnovationConsistency, HasNoValueBeforeItsPlotsAndIgnoresWhatIsNotFinite) {
  InnovationConsistency consistency;
  EXPECT_TRUE(std::isnan(consistency.mean_nis()));
  consistency.add(Innovation(std::numeric_limits<double>::infinity(), 0.0));
  EXPECT_EQ(consistency.plots(), 0);
  consistency.add(Innovation(1.0, 1.0));
  EXPECT_DOUBLE_EQ(consistency.mean_nis(), 2.0);
  EXPECT_TRUE(std::isnan(consistency.whiteness()));
}

}  // namespace
}  // namespace wakeline::innovation_consistency_test
