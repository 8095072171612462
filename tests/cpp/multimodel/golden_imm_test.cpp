// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The five-model Imm of the papers against an independent reference, scan by scan.
#include <gtest/gtest.h>

#include "support/golden.hpp"
#include "support/matrix_assert.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::golden_imm_test {
namespace {

TEST(GoldenImm, FiveModelsOfKnownTurnRates) {
  const nlohmann::json reference = test::golden("multiple_models.json");
  int cases = 0;
  for (const auto& item : reference.at("cases")) {
    if (item.at("estimator") != "imm5") continue;
    ++cases;
    SCOPED_TRACE(item.at("scenario").get<std::string>());
    const Eigen::VectorXd rates = test::to_vector(item["parameters"].at("turn_rates_deg_s"));
    const double std = item.at("accel_std_mps2");
    const auto model = [&](int k) {
      return Kalman{
          CoordinatedTurn{.turn_rate_rad_s = deg(rates[k]), .noise = PiecewiseAcceleration{std}}};
    };
    ModeChain<5>::Matrix chain = ModeChain<5>::Matrix::Constant(0.1 / 4);
    chain.diagonal().setConstant(0.9);
    Imm imm{ModeChain<5>(chain), model(0), model(1), model(2), model(3), model(4)};
    imm.set_initial_mode_probability(
        test::to_vector(item["parameters"].at("initial_mode_probability")));
    Gaussian<4> start{test::to_vector(item.at("start_mean")), Mat<double, 4, 4>::Zero()};
    start.covariance.diagonal() << 100, 1, 100, 1;
    ASSERT_EQ(imm.start(start), Status::kOk);

    const ConvertedRangeBearing radar{
        .range_std_m = 60, .bearing_std_rad = deg(0.5), .unbiased = false};
    const Eigen::MatrixXd plots = test::to_matrix(item.at("z"));
    const Eigen::MatrixXd means = test::to_matrix(item.at("mean"));
    const Eigen::MatrixXd probabilities = test::to_matrix(item.at("mode_probability"));
    for (Eigen::Index k = 0; k < plots.rows(); ++k) {
      ASSERT_EQ(imm.predict(item.at("period_s").get<double>()), Status::kOk);
      ASSERT_TRUE(imm.update(radar, Vec<double, 2>(plots.row(k))));
      ASSERT_TRUE(test::matrices_near(imm.estimate().mean, means.row(k).transpose(),
                                      {.absolute = 1e-9, .relative = 1e-9}))
          << "scan " << k;
      ASSERT_TRUE(test::matrices_near(imm.mode_probability(), probabilities.row(k).transpose(),
                                      {.absolute = 1e-9, .relative = 0}))
          << "scan " << k;
    }
  }
  EXPECT_GE(cases, 2);
}

}  // namespace
}  // namespace wakeline::golden_imm_test
