// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Filters composed at run time against the same composed at compile time: bit for bit.
#include "wakeline/catalog/filters.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/matrix_assert.hpp"
#include "wakeline/track/vessel_models.hpp"

namespace wakeline::any_filter_test {
namespace {

using test::matrices_identical;

/// A wandering target's plots, some of them missing (NaN).
std::vector<Vec<double, 2>> plots(int scans) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<Vec<double, 2>> z;
  double range = 1500.0, bearing = 0.7;
  for (int k = 0; k < scans; ++k) {
    range += 15.0 + 20.0 * normal(random);
    bearing += 0.004 + 0.008 * normal(random);
    z.emplace_back(k % 7 == 5 ? std::nan("") : range, bearing);
  }
  return z;
}

AnyBelief any(const Gaussian<4>& belief) {
  AnyBelief result;
  result.mean = belief.mean;
  result.covariance = belief.covariance;
  return result;
}

template <class Fixed, class Sensor>
void expect_same_bits(Fixed fixed, AnyImm composed, const Sensor& sensor) {
  const auto z = plots(120);
  const Gaussian<4> start = two_point<Sensor, double>(sensor, z[0], z[1], 3.0);
  ASSERT_EQ(fixed.start(start), Status::kOk);
  ASSERT_EQ(composed.start(any(start)), Status::kOk);
  for (std::size_t k = 2; k < z.size(); ++k) {
    ASSERT_EQ(fixed.predict(2.0 + 0.1 * double(k % 5)), Status::kOk);
    ASSERT_EQ(composed.predict(2.0 + 0.1 * double(k % 5)), Status::kOk);
    if (!std::isnan(z[k][0])) {
      const auto a = fixed.update(sensor, z[k]);
      const auto b = composed.update(sensor, z[k]);
      ASSERT_EQ(a.status, Status::kOk);
      ASSERT_EQ(a.nis, b.nis) << "scan " << k;
      ASSERT_EQ(a.log_likelihood, b.log_likelihood) << "scan " << k;
    }
    const auto a = fixed.estimate();
    const AnyBelief b = composed.estimate();
    ASSERT_EQ(a.mean.size(), b.mean.size());
    ASSERT_TRUE(matrices_identical(a.mean, b.mean)) << "scan " << k;
    ASSERT_TRUE(matrices_identical(a.covariance, b.covariance)) << "scan " << k;
    for (int mode = 0; mode < fixed.bank().size(); ++mode)
      ASSERT_EQ(fixed.mode_probability()[mode], composed.mode_probability()[mode]) << "scan " << k;
  }
}

TEST(AnyFilterBank, EqualsThreeTurnsBitForBit) {
  const auto turn = [](double deg_s) {
    return Ekf{
        CoordinatedTurn{.turn_rate_rad_s = deg(deg_s), .noise = PiecewiseAcceleration{0.05}}};
  };
  const Mat<double, 3, 3> matrix{{0.95, 0.025, 0.025}, {0.025, 0.95, 0.025}, {0.025, 0.025, 0.95}};
  expect_same_bits(
      Imm{ModeChain<3>(matrix), turn(0), turn(1), turn(-1)},
      AnyImm(ModeChain<kRuntimeModes>(matrix),
             AnyFilterBank({AnyFilter(turn(0)), AnyFilter(turn(1)), AnyFilter(turn(-1))})),
      ConvertedRangeBearing{.range_std_m = 60.0, .bearing_std_rad = deg(0.5)});
}

TEST(AnyFilterBank, EqualsMixedSizesBitForBit) {
  const Ekf straight{ConstantVelocity{}};
  const Ekf turn{CoordinatedTurnRate{}};
  const Ekf accelerated{ConstantAcceleration{}};
  const SquareRootUkf square_root{CoordinatedTurnRate{}};
  expect_same_bits(
      Imm{ModeChain<4>::from_sojourn_s({60, 20, 30, 40}), straight, turn, accelerated, square_root},
      AnyImm(ModeChain<kRuntimeModes>::from_sojourn_s({60, 20, 30, 40}),
             AnyFilterBank({AnyFilter(straight), AnyFilter(turn), AnyFilter(accelerated),
                            AnyFilter(square_root)})),
      RangeBearing{.range_std_m = 20.0, .bearing_std_rad = deg(0.5)});
}

TEST(AnyFilterBank, EqualsTheTrackersEstimatorBitForBit) {
  const Radar radar{.max_speed_mps = 20.0};
  const VesselModels models;
  AnyImm composed(
      ModeChain<kRuntimeModes>(models.chain()),
      AnyFilterBank({AnyFilter(Ekf(models.cruising(20.0))), AnyFilter(Ekf(models.steady(20.0))),
                     AnyFilter(Ekf(models.restless(20.0))), AnyFilter(Ekf(models.turning(20.0))),
                     AnyFilter(Ekf(models.weaving(20.0))), AnyFilter(Ekf(models.port_turn())),
                     AnyFilter(Ekf(models.starboard_turn()))}));
  composed.set_initial_mode_probability(
      ModeVector<double, kRuntimeModes>(models.initial_mode_probability()));
  expect_same_bits(vessel_imm(radar, models).all(), composed,
                   ConvertedRangeBearing{.range_std_m = 20.0, .bearing_std_rad = deg(0.5)});
}

TEST(AnyFilterBank, RejectsNoneAndTooMany) {
  const AnyFilter filter(Ekf{ConstantVelocity{}});
  EXPECT_THROW(AnyFilterBank({}), std::invalid_argument);
  EXPECT_THROW(AnyFilterBank(std::vector<AnyFilter>(kMaxModes + 1, filter)), std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::any_filter_test
