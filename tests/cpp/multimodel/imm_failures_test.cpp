// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What an Imm does where it, or one of its filters, cannot do a step.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "filter/cases.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::imm_failures_test {
namespace {

using test::beliefs_identical;
using test::matrices_identical;
using test::matrices_near;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const RangeBearing kRadar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
const ModeChain<2> kChain(ModeChain<2>::Matrix{{0.9, 0.1}, {0.2, 0.8}});

Ekf<ConstantVelocity> straight(double psd = 0.05) {
  return Ekf{ConstantVelocity{.noise = WhiteAcceleration{psd}}};
}

/// A custom filter that fails on demand.
struct Moody : Ekf<ConstantVelocity> {
  using Ekf::Ekf;
  bool rejects_plots = false;
  bool rejects_time = false;

  Status predict(double dt_s) noexcept {
    return rejects_time ? Status::kNotPositiveDefinite : Ekf::predict(dt_s);
  }
  template <class Sensor>
  Correction<Sensor::kMeasurements> correct(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& reading) noexcept {
    if (rejects_plots)
      return failed_correction<Sensor::kMeasurements, double>(Status::kNotPositiveDefinite);
    return Ekf::correct(sensor, reading);
  }
};

template <class ImmType>
struct Snapshot {
  explicit Snapshot(const ImmType& imm)
      : probability(imm.mode_probability()),
        first(imm.template filter<0>().estimate()),
        second(imm.template filter<1>().estimate()) {}
  testing::AssertionResult matches(const ImmType& imm) const {
    if (const auto same = matrices_identical(imm.mode_probability(), probability); !same)
      return same;
    if (const auto same = beliefs_identical<decltype(first.mean)::RowsAtCompileTime>(
            imm.template filter<0>().estimate(), first);
        !same)
      return same;
    return beliefs_identical<decltype(second.mean)::RowsAtCompileTime>(
        imm.template filter<1>().estimate(), second);
  }
  typename ImmType::Probability probability;
  std::decay_t<decltype(std::declval<ImmType>().template filter<0>().estimate())> first;
  std::decay_t<decltype(std::declval<ImmType>().template filter<1>().estimate())> second;
};

template <class ImmType>
void run_a_little(ImmType& imm) {
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  for (int scan = 0; scan < 3; ++scan) {
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    ASSERT_TRUE(imm.update(kRadar, test::plot_of<double>(2980, 4020)));
  }
}

template <class ImmType>
void expect_unmoved_by_bad_input(ImmType imm) {
  run_a_little(imm);
  const Snapshot before(imm);
  EXPECT_EQ(imm.predict(kNan), Status::kNotFinite);
  EXPECT_EQ(imm.predict(kInfinity), Status::kNotFinite);
  EXPECT_EQ(imm.predict(-1.0), Status::kNegativeTimeStep);
  for (const double bad : {kNan, kInfinity, -kInfinity})
    for (int k = 0; k < 2; ++k) {
      Vec<double, 2> z(5000, 0.9);
      z[k] = bad;
      const auto step = imm.update(kRadar, z);
      EXPECT_FALSE(step);
      EXPECT_EQ(step.status, Status::kNotFinite);
    }
  const auto huge = imm.update(kRadar, Vec<double, 2>(1e300, 0.9));
  EXPECT_FALSE(huge);
  EXPECT_EQ(huge.status, Status::kNotFinite);
  EXPECT_TRUE(before.matches(imm));
}

TEST(ImmFailures, BadInputLeavesEverything) {
  expect_unmoved_by_bad_input(Imm{kChain, straight(), Ukf{CoordinatedTurnRate{}}});
  expect_unmoved_by_bad_input(
      Imm{kChain, SquareRootUkf{CoordinatedTurnRate{}}, SquareRootUkf{ConstantVelocity{}}});
}

// Modes of very different gains, so that the spread of their means is as large as it can be.
template <class Scalar>
void expect_a_finite_estimate_after_a_plot_at(Scalar far_m, Scalar std_m) {
  const auto mode = [](double psd) {
    return Ekf<ConstantVelocity, Scalar>{ConstantVelocity{.noise = WhiteAcceleration{psd}}};
  };
  Imm imm(kChain, mode(0.01), mode(1e8));
  ASSERT_EQ(imm.start(test::five_km_off<Scalar>()), Status::kOk);
  ASSERT_EQ(imm.predict(Scalar(1)), Status::kOk);
  const Snapshot before(imm);
  const Position sensor{std_m};
  const auto step = imm.update(sensor, Vec<Scalar, 2>(far_m, far_m));
  if (!step) {
    EXPECT_EQ(step.status, Status::kNotFinite) << far_m;
    EXPECT_TRUE(before.matches(imm)) << far_m;
    EXPECT_EQ(imm.predict(Scalar(1)), Status::kOk);
    EXPECT_TRUE(imm.update(sensor, Vec<Scalar, 2>(3000, 4000)));
  }
  EXPECT_TRUE(is_finite(imm.estimate().mean)) << far_m;
  EXPECT_TRUE(is_finite(imm.estimate().covariance)) << far_m;
}

TEST(ImmFailures, AFarPlotIsTakenOrLeavesThePrediction) {
  for (int power = 7; power <= 11; ++power) {
    for (const double std_m : {10.0, 1e5})
      expect_a_finite_estimate_after_a_plot_at<double>(std::pow(10.0, power), std_m);
    expect_a_finite_estimate_after_a_plot_at<float>(std::pow(10.0F, float(power)), 1e3F);
  }
}

TEST(ImmFailures, AnAccelerationOutOfRangeChangesNothing) {
  Imm imm{kChain, Ekf<CoordinatedTurn>{CoordinatedTurn{.turn_rate_rad_s = 0.02}},
          Ekf<CoordinatedTurn>{CoordinatedTurn{.turn_rate_rad_s = -0.02}}};
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  const Snapshot before(imm);
  for (const double push_mps2 : {1e10, -1e10, kNan, kInfinity})
    EXPECT_EQ(imm.predict(3.0, {push_mps2, 0.0}), Status::kNotFinite) << push_mps2;
  EXPECT_TRUE(before.matches(imm));
  for (int scan = 0; scan < 10; ++scan) {
    ASSERT_EQ(imm.predict(3.0, {1e9, -1e9}), Status::kOk);
    ASSERT_TRUE(imm.estimate().covariance.allFinite()) << scan;
  }
}

TEST(ImmFailures, NotStarted) {
  Imm imm{kChain, straight(), straight()};
  EXPECT_FALSE(imm.started());
  EXPECT_EQ(imm.predict(1.0), Status::kNotStarted);
  EXPECT_EQ(imm.update(kRadar, Vec<double, 2>(5000, 1)).status, Status::kNotStarted);
  Gaussian<4> bad = test::five_km_off<double>();
  bad.covariance(0, 0) = -1;
  EXPECT_EQ(imm.start(bad), Status::kNotPositiveDefinite);
  EXPECT_FALSE(imm.started());
}

// FilterPy clamps underflowed likelihoods to one tiny number, so that a far outlier tells the modes
// nothing.
TEST(ImmFailures, AFarOutlierStillOrdersTheModes) {
  for (const double away : {1e4, 1e5, 1e6}) {
    Imm imm{kChain, straight(1e-3), straight(10.0)};
    run_a_little(imm);
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    ASSERT_GT(imm.mode_probability()[0], 0.5) << "until now it went straight";
    const auto step = imm.update(Position{.position_std_m = 1}, Vec<double, 2>(3000 + away, 4000));
    ASSERT_TRUE(step);
    EXPECT_TRUE(std::isfinite(step.log_likelihood)) << away;
    EXPECT_LT(step.log_likelihood, -745) << "beyond what exp can hold";
    EXPECT_GT(imm.mode_probability()[1], 1 - 1e-12) << "the wide model is the likelier by far";
    EXPECT_NEAR(imm.mode_probability().sum(), 1.0, 1e-15);
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    EXPECT_NEAR(imm.mode_probability()[0], 0.2, 1e-9) << "and the chain brings the other back";
  }
}

// A mode without probability has none after the plot, however well it explains it.
TEST(ImmFailures, AnImpossibleModeStaysImpossible) {
  const ModeChain<2> one_way(ModeChain<2>::Matrix{{1.0, 0.0}, {0.1, 0.9}});
  Imm imm{one_way, straight(1e-3), straight(10.0)};
  imm.set_initial_mode_probability(Vec<double, 2>(1.0, 0.0));
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(imm.predict(2.5), Status::kOk);
  ASSERT_TRUE(imm.update(Position{.position_std_m = 1}, Vec<double, 2>(3000 + 1e5, 4000)));
  EXPECT_TRUE(matrices_near(imm.mode_probability(), Vec<double, 2>(1.0, 0.0), {0, 0}));
  EXPECT_TRUE(is_finite(imm.estimate().mean));
}

auto moody_imm(bool first_rejects, bool second_rejects) {
  Moody first{ConstantVelocity{}}, second{ConstantVelocity{.noise = WhiteAcceleration{1.0}}};
  first.rejects_plots = first_rejects;
  second.rejects_plots = second_rejects;
  Imm imm{kChain, first, second};
  EXPECT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  EXPECT_EQ(imm.predict(2.5), Status::kOk);
  return imm;
}

TEST(ImmFailures, AFilterThatFailsKeepsItsPredictionAndHasNoWeight) {
  auto imm = moody_imm(true, false);
  const Gaussian<4> predicted = imm.filter<0>().estimate();
  const double prior = imm.mode_probability()[1];
  Ekf<ConstantVelocity> other = imm.filter<1>();
  const auto expected = other.update(kRadar, test::plot_of<double>(2990, 4010));
  const auto step = imm.update(kRadar, test::plot_of<double>(2990, 4010));
  ASSERT_TRUE(step);
  EXPECT_TRUE(beliefs_identical<4>(imm.filter<0>().estimate(), predicted));
  EXPECT_TRUE(matrices_near(imm.mode_probability(), Vec<double, 2>(0.0, 1.0), {0, 0}));
  EXPECT_TRUE(matrices_near(imm.estimate().mean, other.estimate().mean));
  EXPECT_TRUE(matrices_near(step.innovation, expected.innovation));
  EXPECT_NEAR(step.nis, expected.nis, 1e-12);
  EXPECT_NEAR(step.log_likelihood, expected.log_likelihood + std::log(prior), 1e-12);
  ASSERT_EQ(imm.predict(2.5), Status::kOk);
  EXPECT_NEAR(imm.mode_probability()[0], 0.2, 1e-12) << "the chain brings it back";
}

TEST(ImmFailures, WhereAllFailNothingChanges) {
  auto imm = moody_imm(true, true);
  const Snapshot before(imm);
  const auto step = imm.update(kRadar, test::plot_of<double>(2990, 4010));
  EXPECT_FALSE(step);
  EXPECT_EQ(step.status, Status::kNotPositiveDefinite);
  EXPECT_TRUE(before.matches(imm));
}

// The only mode with any probability fails while an impossible one succeeds: that is a failure, not
// a success.
TEST(ImmFailures, SuccessOfAnImpossibleModeAloneIsAFailure) {
  const ModeChain<2> stay(ModeChain<2>::Matrix::Identity());
  for (const int possible : {0, 1}) {
    Moody filters[] = {Moody{ConstantVelocity{}}, Moody{ConstantVelocity{}}};
    filters[possible].rejects_plots = true;
    Imm imm{stay, filters[0], filters[1]};
    imm.set_initial_mode_probability(possible == 0 ? Vec<double, 2>(1, 0) : Vec<double, 2>(0, 1));
    ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    const Snapshot before(imm);
    const auto step = imm.update(kRadar, test::plot_of<double>(2990, 4010));
    EXPECT_FALSE(step) << possible;
    EXPECT_EQ(step.status, Status::kNotPositiveDefinite) << possible;
    EXPECT_TRUE(matrices_identical(imm.mode_probability(), before.probability));
  }
}

TEST(ImmFailures, APredictionThatFailsInOneFilterIsUndoneInAll) {
  Moody second{ConstantVelocity{}};
  second.rejects_time = true;
  Imm imm{kChain, straight(), second};
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  const Snapshot before(imm);
  EXPECT_EQ(imm.predict(2.5), Status::kNotPositiveDefinite);
  EXPECT_TRUE(before.matches(imm));
}

TEST(ImmFailures, AModeThatDwindlesBeyondNumbersHoldsNothingUp) {
  // No way leads back: what is as unlikely as 1e-300 and less must not spoil what is likely.
  const Position fix{.position_std_m = 10.0};
  for (const double leaves : {0.0, 0.05}) {
    const ModeChain<2>::Matrix matrix{{1.0, 0.0}, {leaves, 1.0 - leaves}};
    Imm imm{ModeChain<2>(matrix), Ekf{CoordinatedTurn{.turn_rate_rad_s = 0.0}},
            Ekf{CoordinatedTurn{.turn_rate_rad_s = deg(2.0)}}};
    Gaussian<4> start;
    start.mean << 0.0, 10.0, 0.0, 0.0;
    start.covariance *= 100.0;
    ASSERT_EQ(imm.start(start), Status::kOk);
    for (int scan = 1; scan <= 3000; ++scan) {
      ASSERT_EQ(imm.predict(3.0), Status::kOk) << scan;
      ASSERT_EQ(imm.update(fix, Vec<double, 2>(30.0 * scan, 0.0)).status, Status::kOk) << scan;
      ASSERT_NEAR(imm.mode_probability().sum(), 1.0, 1e-12) << scan;
    }
    EXPECT_LT(imm.mode_probability()[1], 1e-290);
    EXPECT_NEAR(imm.estimate().mean[0], 90000.0, 1.0);
  }
}

TEST(ImmFailures, AFarPlotDoesNotAffectAnotherOfTheSameTime) {
  const auto chain = ModeChain<3>::from_sojourn_s(Vec<double, 3>(60.0, 30.0, 30.0));
  const Position fix{.position_std_m = 2.0};
  for (double away_m = 10.0; away_m < 400.0; away_m += 1.0) {
    Imm imm{chain, Ekf{CoordinatedTurn{.turn_rate_rad_s = 0.0}},
            Ekf{CoordinatedTurn{.turn_rate_rad_s = deg(3.0)}},
            Ekf{CoordinatedTurn{.turn_rate_rad_s = deg(-3.0)}}};
    Gaussian<4> start;
    start.mean << 0.0, 10.0, 0.0, 0.0;
    ASSERT_EQ(imm.start(start), Status::kOk);
    for (const Vec<double, 2>& z : {Vec<double, 2>(30.0, away_m), Vec<double, 2>(30.0, 0.0)}) {
      ASSERT_EQ(imm.predict(z[1] == 0.0 ? 0.0 : 3.0), Status::kOk) << away_m;
      ASSERT_EQ(imm.update(fix, z).status, Status::kOk) << away_m;
      ASSERT_TRUE(imm.estimate().mean.allFinite()) << away_m;
    }
  }
}

TEST(ImmFailures, WeightsNearTheLeastNumberAreZero) {
  constexpr double kTiny = 1.5e-308;
  Imm imm{ModeChain<2>(ModeChain<2>::Matrix{{1.0, 0.0}, {0.0, 1.0}}), straight(), straight(1.0)};
  imm.set_initial_mode_probability(Vec<double, 2>(1.0, kTiny));
  EXPECT_EQ(imm.mode_probability()[1], kTiny);  // before a start, too
  ASSERT_EQ(imm.start(Gaussian<4>{}), Status::kOk);
  ASSERT_EQ(imm.update(Position{.position_std_m = 1.0}, Vec<double, 2>(75.0, 0.0)).status,
            Status::kOk);
  EXPECT_EQ(imm.mode_probability()[0], 1.0);
  EXPECT_EQ(imm.mode_probability()[1], 0.0);
}

}  // namespace
}  // namespace wakeline::imm_failures_test
