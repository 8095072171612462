// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "filter/cases.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::imm_laws_test {
namespace {

using test::beliefs_identical;
using test::Draw;
using test::matrices_identical;
using test::matrices_near;

const RangeBearing kRadar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
const ModeChain<2>::Matrix kAsymmetric{{0.9, 0.1}, {0.4, 0.6}};

auto turning(double deg_s, double psd = 0.05) {
  return Ekf{CoordinatedTurn{.turn_rate_rad_s = deg(deg_s), .noise = WhiteAcceleration{psd}}};
}

Vec<double, 2> plot_near(const Gaussian<4>& belief, Draw& draw) {
  return kRadar.measure(
      Vec<double, 2>(belief.mean[0] + 30 * draw.normal(), belief.mean[2] + 30 * draw.normal()));
}

template <class Filter>
void expect_its_filter(Filter filter) {
  Imm imm{ModeChain<1>(ModeChain<1>::Matrix::Ones()), filter};
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(filter.start(test::five_km_off<double>()), Status::kOk);
  Draw draw(61);
  for (int scan = 0; scan < 30; ++scan) {
    const double dt = draw.uniform(0, 5);
    ASSERT_EQ(imm.predict(dt), Status::kOk);
    ASSERT_EQ(filter.predict(dt), Status::kOk);
    if (scan % 4 != 3) {
      const Vec<double, 2> z =
          kRadar.measure(Vec<double, 2>(3000 + 40 * draw.normal(), 4000 + 40 * draw.normal()));
      const auto step = imm.update(kRadar, z);
      const auto expected = filter.update(kRadar, z);
      ASSERT_TRUE(step && expected);
      EXPECT_TRUE(matrices_identical(step.innovation, expected.innovation));
      EXPECT_TRUE(matrices_identical(step.innovation_covariance, expected.innovation_covariance));
      EXPECT_EQ(step.nis, expected.nis);
      EXPECT_EQ(step.log_likelihood, expected.log_likelihood);
    }
    ASSERT_TRUE(beliefs_identical<Filter::kStates>(imm.estimate(), filter.estimate()))
        << "scan " << scan;
    EXPECT_EQ(imm.mode_probability()[0], 1.0);
  }
}

TEST(Imm, OfOneModeIsItsFilterBitForBit) {
  expect_its_filter(turning(1.0));
  expect_its_filter(Ekf{CoordinatedTurnRate{}});
  expect_its_filter(Ukf{CoordinatedTurnRate{}});
}

TEST(Imm, OfIdenticalModelsIsOneFilter) {
  Imm imm{ModeChain<2>(kAsymmetric), turning(1.0), turning(1.0)};
  Ekf filter = turning(1.0);
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(filter.start(test::five_km_off<double>()), Status::kOk);
  Draw draw(62);
  for (int scan = 0; scan < 50; ++scan) {
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    ASSERT_EQ(filter.predict(2.5), Status::kOk);
    const Vec<double, 2> z = plot_near(filter.estimate(), draw);
    const auto step = imm.update(kRadar, z);
    const auto expected = filter.update(kRadar, z);
    ASSERT_TRUE(step && expected);
    EXPECT_NEAR(step.log_likelihood, expected.log_likelihood, 1e-10);
    EXPECT_TRUE(matrices_near(imm.estimate().mean, filter.estimate().mean,
                              {.absolute = 1e-9, .relative = 1e-11}));
    EXPECT_LT((test::covariance_difference<double, 4>(imm.estimate().covariance,
                                                      filter.estimate().covariance)),
              1e-11);
  }
}

// vortex-vkf handed the mixing matrix to the routine that wants the transition matrix: with equal
// likelihoods .695/.305 became .664/.336. With equal likelihoods the modes follow the chain, and an
// asymmetric chain shows its orientation.
TEST(Imm, EqualLikelihoodsGiveTheProbabilitiesOfTheChain) {
  Imm imm{ModeChain<2>(kAsymmetric), turning(0.0), turning(0.0)};
  imm.set_initial_mode_probability(Vec<double, 2>(0.59, 0.41));
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  EXPECT_TRUE(matrices_near(imm.mode_probability(), Vec<double, 2>(0.59, 0.41), {0, 0}));
  Vec<double, 2> expected(0.59, 0.41);
  for (int scan = 0; scan < 5; ++scan) {
    expected = (kAsymmetric.transpose() * expected).eval();
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    ASSERT_TRUE(imm.update(kRadar, test::plot_of<double>(2990, 4010)));
    EXPECT_TRUE(matrices_near(imm.mode_probability(), expected)) << "scan " << scan;
  }
}

// FilterPy recomputes the likelihood of a missed scan with a zero innovation and a stale S, so that
// each miss raises the mode of less noise: .961 -> .974 in five misses, where the chain relaxes.
TEST(Imm, MissedScansRelaxTheModesAlongTheChain) {
  ModeChain<2>::Matrix sticky{{0.95, 0.05}, {0.05, 0.95}};
  Imm imm{ModeChain<2>(sticky), turning(0.0, 1e-3), turning(0.0, 10.0)};
  imm.set_initial_mode_probability(Vec<double, 2>(0.961, 0.039));
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  double expected = 0.961;
  for (int miss = 0; miss < 100; ++miss) {
    expected = 0.95 * expected + 0.05 * (1 - expected);
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    EXPECT_NEAR(imm.mode_probability()[0], expected, 1e-12);
  }
  EXPECT_NEAR(imm.mode_probability()[0], 0.5, 1e-4);
}

TEST(Imm, ChainInContinuousTimeFollowsTheStep) {
  const auto chain = ModeChain<2>::from_sojourn_s({60.0, 15.0});
  Imm imm{chain, turning(0.0), turning(3.0)};
  imm.set_initial_mode_probability(Vec<double, 2>(0.1, 0.9));
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  for (const double dt : {1.0, 0.5, 3.0}) ASSERT_EQ(imm.predict(dt), Status::kOk);
  const Vec<double, 2> expected = chain.transition(4.5).transpose() * Vec<double, 2>(0.1, 0.9);
  EXPECT_TRUE(matrices_near(imm.mode_probability(), expected));
}

TEST(Imm, WeighsTheModesByBayes) {
  Imm imm{ModeChain<2>(kAsymmetric), turning(0.0), turning(3.0)};
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(imm.predict(10.0), Status::kOk);
  const Vec<double, 2> z = test::plot_of<double>(2960, 4070);
  const Vec<double, 2> prior = imm.mode_probability();
  Ekf first = imm.filter<0>();
  Ekf second = imm.filter<1>();
  const auto a = first.update(kRadar, z);
  const auto b = second.update(kRadar, z);
  const Vec<double, 2> joint(prior[0] * std::exp(a.log_likelihood),
                             prior[1] * std::exp(b.log_likelihood));
  const auto step = imm.update(kRadar, z);
  ASSERT_TRUE(step);
  EXPECT_TRUE(matrices_near(imm.mode_probability(), (joint / joint.sum()).eval()));
  EXPECT_NEAR(step.log_likelihood, std::log(joint.sum()), 1e-12) << "the likelihood of the mixture";
  // The innovation is that of the moment-matched prediction.
  EXPECT_TRUE(
      matrices_near(step.innovation, (prior[0] * a.innovation + prior[1] * b.innovation).eval()));
  const Vec<double, 2> apart = a.innovation - b.innovation;
  const Mat<double, 2, 2> s = prior[0] * a.innovation_covariance +
                              prior[1] * b.innovation_covariance +
                              prior[0] * prior[1] * apart * apart.transpose();
  EXPECT_LT(test::covariance_difference(step.innovation_covariance, s), 1e-12);
  // A second sensor in the same scan: an update without a prediction.
  const Vec<double, 2> before = imm.mode_probability();
  const auto c = first.update(kRadar, z);
  const auto d = second.update(kRadar, z);
  ASSERT_TRUE(imm.update(kRadar, z));
  const Vec<double, 2> again(before[0] * std::exp(c.log_likelihood),
                             before[1] * std::exp(d.log_likelihood));
  EXPECT_TRUE(matrices_near(imm.mode_probability(), (again / again.sum()).eval()));
}

TEST(Imm, MixingKeepsTheMomentsOfTheMixture) {
  Imm imm{ModeChain<2>(kAsymmetric), turning(0.0), turning(6.0)};
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  for (const double dt : {20.0, 20.0}) {
    ASSERT_EQ(imm.predict(dt), Status::kOk);
    ASSERT_TRUE(imm.update(kRadar, test::plot_of<double>(2900, 4100)));
  }
  const Gaussian<4> before = imm.estimate();
  EXPECT_GT((imm.filter<0>().estimate().mean - imm.filter<1>().estimate().mean).norm(), 1.0)
      << "the modes disagree";
  ASSERT_EQ(imm.predict(0.0), Status::kOk);  // the chain jumps, the vessel does not move
  EXPECT_TRUE(matrices_near(imm.estimate().mean, before.mean));
  EXPECT_LT((test::covariance_difference<double, 4>(imm.estimate().covariance, before.covariance)),
            1e-12);
}

/// A model over position and velocity as paper A prints it, with rows and columns of zeros for an
/// acceleration.
template <class Motion>
struct WithoutAcceleration {
  static constexpr auto kComponents = kAccelerationKinematics;

  Motion motion;

  template <class Scalar>
  Mat<Scalar, 6, 6> matrix(Scalar dt_s) const noexcept {
    return spread(motion.matrix(dt_s));
  }
  template <class Scalar>
  Mat<Scalar, 6, 6> process_noise(Scalar dt_s) const noexcept {
    return spread(motion.process_noise(dt_s));
  }
  double prior_variance(Component) const noexcept { return 1.0; }

 private:
  template <class Scalar>
  static Mat<Scalar, 6, 6> spread(const Mat<Scalar, 4, 4>& four) noexcept {
    constexpr auto kAt = rows_of(kComponents, kKinematics);
    Mat<Scalar, 6, 6> six = Mat<Scalar, 6, 6>::Zero();
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) six(kAt[i], kAt[j]) = four(i, j);
    return six;
  }
};
template <class Motion>
WithoutAcceleration(Motion) -> WithoutAcceleration<Motion>;

TEST(Imm, OfSixStatesAsPrintedGivesTheNumbersOfFour) {
  const PiecewiseAcceleration noise{0.05};
  const ConstantVelocity straight{.noise = noise};
  const CoordinatedTurn starboard{.turn_rate_rad_s = deg(1.0), .noise = noise};
  const CoordinatedTurn port{.turn_rate_rad_s = -deg(1.0), .noise = noise};
  const auto chain = ModeChain<3>::staying(0.95);
  Imm four{chain, Ekf{straight}, Ekf{starboard}, Ekf{port}};
  Imm six{chain, Ekf{WithoutAcceleration{straight}}, Ekf{WithoutAcceleration{starboard}},
          Ekf{WithoutAcceleration{port}}};
  ASSERT_EQ(four.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(six.start(test::five_km_off<double>()), Status::kOk);
  Draw draw(67);
  for (int scan = 0; scan < 100; ++scan) {
    ASSERT_EQ(four.predict(3.0), Status::kOk);
    ASSERT_EQ(six.predict(3.0), Status::kOk);
    const Vec<double, 2> z = plot_near(four.estimate(), draw);
    const auto step = six.update(kRadar, z);
    const auto expected = four.update(kRadar, z);
    ASSERT_TRUE(step && expected);
    EXPECT_NEAR(step.log_likelihood, expected.log_likelihood, 1e-10);
    EXPECT_TRUE(
        matrices_near(six.mode_probability(), four.mode_probability(), {.absolute = 1e-12}));
    const Gaussian<4> kinematics = kinematics_of(six.estimate());
    EXPECT_TRUE(matrices_near(kinematics.mean, four.estimate().mean, {.relative = 1e-12}));
    EXPECT_TRUE(matrices_near(kinematics.covariance, four.estimate().covariance,
                              {.absolute = 1e-10, .relative = 1e-10}));
    for (const int acceleration : {2, 5}) {
      EXPECT_EQ(six.estimate().mean[acceleration], 0.0);
      EXPECT_TRUE(six.estimate().covariance.row(acceleration).isZero(0.0));
    }
  }
}

TEST(Imm, EstimateIsTheMixturesMeanAndCovariance) {
  Imm imm{ModeChain<2>(kAsymmetric), turning(0.0), turning(6.0)};
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(imm.predict(20.0), Status::kOk);
  const Vec<double, 2> p = imm.mode_probability();
  const Gaussian<4> a = imm.filter<0>().estimate(), b = imm.filter<1>().estimate();
  const Vec<double, 4> apart = a.mean - b.mean;
  EXPECT_TRUE(matrices_near(imm.estimate().mean, (p[0] * a.mean + p[1] * b.mean).eval()));
  const Mat<double, 4, 4> covariance =
      p[0] * a.covariance + p[1] * b.covariance + p[0] * p[1] * apart * apart.transpose();
  EXPECT_LT((test::covariance_difference<double, 4>(imm.estimate().covariance, covariance)), 1e-12);
}

// vortex-vkf keeps the transition of the first step in a function-local static, shared by every
// instance.
TEST(Imm, InstancesOfDifferentStepsAreIndependent) {
  const auto chain = ModeChain<2>::from_sojourn_s({60.0, 15.0});
  const auto run = [&](auto& imm, double dt) {
    EXPECT_EQ(imm.predict(dt), Status::kOk);
    EXPECT_TRUE(imm.update(kRadar, test::plot_of<double>(2990, 4010)));
  };
  const Imm fresh{chain, turning(0.0), turning(3.0)};
  auto alone = fresh, fast = fresh, slow = fresh;
  for (auto* imm : {&alone, &fast, &slow})
    ASSERT_EQ(imm->start(test::five_km_off<double>()), Status::kOk);
  for (int scan = 0; scan < 5; ++scan) run(alone, 1.0);
  for (int scan = 0; scan < 5; ++scan) {
    run(slow, 10.0);
    run(fast, 1.0);
  }
  EXPECT_TRUE(matrices_identical(fast.mode_probability(), alone.mode_probability()));
  EXPECT_TRUE(beliefs_identical<4>(fast.estimate(), alone.estimate()));
  EXPECT_FALSE(matrices_near(slow.mode_probability(), alone.mode_probability()));
  // Nor does one instance remember the step before.
  ASSERT_EQ(slow.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(slow.predict(1.0), Status::kOk);
  const Vec<double, 2> expected = chain.transition(1.0).transpose() * Vec<double, 2>(0.5, 0.5);
  EXPECT_TRUE(matrices_near(slow.mode_probability(), expected));
}

TEST(Imm, ProbabilitiesSumToOneOverALongRun) {
  Imm imm{ModeChain<3>::from_sojourn_s({60.0, 30.0, 30.0}), turning(0.0), turning(3.0),
          turning(-3.0)};
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  Draw draw(63);
  for (int scan = 0; scan < 2000; ++scan) {
    ASSERT_EQ(imm.predict(draw.uniform(0, 10)), Status::kOk);
    if (draw.uniform(0, 1) < 0.7)
      (void)imm.update(
          kRadar, test::plot_of<double>(3000 + 200 * draw.normal(), 4000 + 200 * draw.normal()));
    ASSERT_NEAR(imm.mode_probability().sum(), 1.0, 1e-12);
    ASSERT_TRUE((imm.mode_probability().array() >= 0.0).all());
    ASSERT_TRUE((test::is_covariance<double, 4>(imm.estimate().covariance))) << "scan " << scan;
  }
}

TEST(Imm, InitialProbabilitiesOfFewDigitsMoveNoPlace) {
  Imm imm{ModeChain<2>(kAsymmetric), turning(0.0), turning(3.0)};
  imm.set_initial_mode_probability(Vec<double, 2>(0.3333333, 0.6666666));
  EXPECT_EQ(imm.initial_mode_probability().sum(), 1.0);
  Gaussian<4> far = test::five_km_off<double>();
  far.mean[0] = 5e6;
  ASSERT_EQ(imm.start(far), Status::kOk);
  EXPECT_NEAR(imm.estimate().mean[0], 5e6, 1e-6);
}

TEST(Imm, InvalidInitialProbabilitiesAreRejected) {
  Imm imm{ModeChain<2>(kAsymmetric), turning(0.0), turning(3.0)};
  EXPECT_THROW(imm.set_initial_mode_probability(Vec<double, 2>(0.5, 0.6)), std::invalid_argument);
  EXPECT_THROW(imm.set_initial_mode_probability(Vec<double, 2>(1.5, -0.5)), std::invalid_argument);
  EXPECT_THROW(imm.set_initial_mode_probability(Vec<double, 2>(std::nan(""), 1.0)),
               std::invalid_argument);
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  EXPECT_TRUE(matrices_near(imm.mode_probability(), Vec<double, 2>(0.5, 0.5), {0, 0}))
      << "uniform unless set";
}

}  // namespace
}  // namespace wakeline::imm_laws_test
