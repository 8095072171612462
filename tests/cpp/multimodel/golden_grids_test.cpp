// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The estimators of a moving grid against an independent reference, scan by scan.
#include <gtest/gtest.h>

#include "support/golden.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/adaptive_grid_imm.hpp"
#include "wakeline/multimodel/switching_grid_imm.hpp"

namespace wakeline::golden_grids_test {
namespace {

using Filter = Kalman<CoordinatedTurn>;

Filter filter_of(const nlohmann::json& item) {
  return Filter{CoordinatedTurn{.noise = PiecewiseAcceleration{item.at("accel_std_mps2")}}};
}

template <class Estimator>
void expect_golden(Estimator estimator, const nlohmann::json& item) {
  const nlohmann::json& parameters = item.at("parameters");
  SCOPED_TRACE(parameters.dump());
  estimator.set_initial_mode_probability(
      test::to_vector(parameters.at("initial_mode_probability")));
  Gaussian<4> start{test::to_vector(item.at("start_mean")), Mat<double, 4, 4>::Zero()};
  start.covariance.diagonal() << 100, 1, 100, 1;
  ASSERT_EQ(estimator.start(start), Status::kOk);
  const ConvertedRangeBearing radar{
      .range_std_m = 60, .bearing_std_rad = deg(0.5), .unbiased = false};
  const Eigen::MatrixXd plots = test::to_matrix(item.at("z"));
  const Eigen::MatrixXd means = test::to_matrix(item.at("mean"));
  const Eigen::MatrixXd probabilities = test::to_matrix(item.at("mode_probability"));
  const Eigen::MatrixXd rates = test::to_matrix(item.at("turn_rate_deg_s")) * deg(1.0);
  for (Eigen::Index k = 0; k < plots.rows(); ++k) {
    ASSERT_EQ(estimator.predict(item.at("period_s").get<double>()), Status::kOk);
    ASSERT_TRUE(estimator.update(radar, Vec<double, 2>(plots.row(k))));
    ASSERT_TRUE(test::matrices_near(estimator.estimate().mean, means.row(k).transpose(),
                                    {.absolute = 1e-9, .relative = 1e-9}))
        << "scan " << k;
    ASSERT_TRUE(test::matrices_near(estimator.mode_probability(), probabilities.row(k).transpose(),
                                    {.absolute = 1e-9, .relative = 0}))
        << "scan " << k;
    ASSERT_TRUE(test::matrices_near(estimator.turn_rates_rad_s(), rates.row(k).transpose(),
                                    {.absolute = 1e-9, .relative = 0}))
        << "scan " << k;
  }
}

TEST(GoldenGrids, AdaptiveGrid) {
  int cases = 0;
  const nlohmann::json reference = test::golden("multiple_models.json");
  for (const auto& item : reference.at("cases")) {
    if (item.at("estimator") != "agmm") continue;
    ++cases;
    const nlohmann::json& parameters = item.at("parameters");
    const Eigen::VectorXd set = test::to_vector(parameters.at("initial_set_deg_s")) * deg(1.0);
    const AdaptiveGrid grid{.max_turn_rate_rad_s = deg(parameters.at("max_turn_rate_deg_s")),
                            .initial_turn_rates_rad_s = AdaptiveGrid::Rates{set[0], set[1], set[2]},
                            .min_spacing_rad_s = deg(parameters.at("min_spacing_deg_s")),
                            .kept_spacing_rad_s = 0.0,
                            .least_move_rad_s = 0.0,
                            .centre_threshold = parameters.at("t1"),
                            .centre_gain = 1.0,
                            .unlikely_threshold = parameters.at("t2"),
                            .likely_threshold = parameters.at("t3")};
    expect_golden(AdaptiveGridImm{grid, ModeChain<3>::staying(0.9), filter_of(item)}, item);
  }
  EXPECT_EQ(cases, 4);
}

TEST(GoldenGrids, SwitchingGrid) {
  int cases = 0;
  const nlohmann::json reference = test::golden("multiple_models.json");
  for (const auto& item : reference.at("cases")) {
    if (item.at("estimator") != "sgmm") continue;
    ++cases;
    const nlohmann::json& parameters = item.at("parameters");
    const Eigen::VectorXd rates = test::to_vector(parameters.at("grid_deg_s")) * deg(1.0);
    const SwitchingGrid grid{
        .grid_rad_s = TurnRateGrid(std::span<const double>(rates.data(), 5)),
        .threshold = parameters.at("t"),
        .rule = parameters.at("rule") == "literal" ? SwitchRule::kLiteral : SwitchRule::kSymmetric,
        .carry = parameters.at("carry") == "slot" ? SwitchCarry::kSlot : SwitchCarry::kIdentity,
        .initial_centre = parameters.at("initial_centre").get<int>()};
    expect_golden(SwitchingGridImm{grid, ModeChain<3>::staying(0.9), filter_of(item)}, item);
  }
  EXPECT_EQ(cases, 8);
}

}  // namespace
}  // namespace wakeline::golden_grids_test
