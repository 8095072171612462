// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/filter/alpha_beta.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <vector>

#include "filter/consistency_laws.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::alpha_beta_test {
namespace {

using test::beliefs_identical;
using test::Draw;
using test::matrices_near;

const Position kSensor{.position_std_m = 10.0};

/// Schedules of every kind.
template <int Order>
std::vector<GainSchedule<Order>> every_schedule() {
  if constexpr (Order == 2)
    return {ConstantGains{},    GrowingMemory{},  BenedictBordner{}, CriticallyDamped{0.6},
            TrackingIndex{0.3}, RangeDependent{}, RecentMemory{},    AdaptiveGains{}};
  else
    return {ConstantGains{0.6, 0.3, 0.05}, GrowingMemory{}, CriticallyDamped{0.6},
            TrackingIndex{0.1}};
}

template <class Filter>
Filter started(const Filter& prototype) {
  Filter filter = prototype;
  EXPECT_EQ(filter.start(test::five_km_off<typename Filter::Scalar>()), Status::kOk);
  return filter;
}

/// Value and derivatives at the last of n readings one second apart of the polynomial through them,
/// by least squares with the weights `weight(k)`.
template <int Order, class Weight>
Mat<double, Order, 2> polynomial(const std::vector<Vec<double, 2>>& readings,
                                 const Weight& weight) {
  const auto n = double(readings.size());
  Mat<double, Order, Order> moments = Mat<double, Order, Order>::Zero();
  Mat<double, Order, 2> products = Mat<double, Order, 2>::Zero();
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const double t = (double(k) + 1.0 - n) / n;
    Vec<double, Order> powers;
    for (int power = 0; power < Order; ++power)
      powers[power] = std::pow(t, power) / (power < 2 ? 1 : 2);
    moments += weight(k) * powers * powers.transpose();
    products += weight(k) * powers * readings[k].transpose();
  }
  Mat<double, Order, 2> solution = moments.llt().solve(products);
  for (int power = 1; power < Order; ++power) solution.row(power) /= std::pow(n, power);
  return solution;
}

template <int Order>
void expect_polynomial() {
  Draw draw(7);
  auto filter = started(AlphaBetaFilter<Order>(GrowingMemory{}));
  std::vector<Vec<double, 2>> readings;
  for (int n = 1; n <= 60; ++n) {
    readings.push_back(draw.normals<2>());
    ASSERT_EQ(filter.predict(1.0), Status::kOk);
    ASSERT_TRUE(filter.update(kSensor, readings.back()));
    if (n < Order) continue;
    const Mat<double, Order, 2> wanted =
        polynomial<Order>(readings, [](std::size_t) { return 1.0; });
    Mat<double, Order, 2> actual;
    actual.col(0) = filter.estimate().mean.template head<Order>();
    actual.col(1) = filter.estimate().mean.template tail<Order>();
    ASSERT_TRUE(matrices_near(actual, wanted, {.absolute = 1e-9, .relative = 0})) << n;
    if (n > 10) {
      ASSERT_TRUE(matrices_near(actual, wanted, {.absolute = 1e-12, .relative = 0})) << n;
    }
  }
}

TEST(GrowingMemory, IsTheLeastSquaresLine) { expect_polynomial<2>(); }
TEST(GrowingMemory, IsTheLeastSquaresParabola) { expect_polynomial<3>(); }

TEST(GrowingMemory, CountsThePlotsOfTheStartAndForgetsThoseBeyondTheMost) {
  const auto gains = [](const GrowingMemory& memory, double reading) {
    return memory.gains<2>(GainOccasion<double>{.reading = reading});
  };
  for (int k = 1; k < 10; ++k) {  // of k updates after a start of one plot
    const Vec<double, 2> wanted(2.0 * (2 * k + 1) / ((k + 1) * (k + 2)), 6.0 / ((k + 1) * (k + 2)));
    EXPECT_TRUE(matrices_near(gains({.plots_before = 1}, k), wanted));
  }
  EXPECT_EQ(gains({.max_plots = 5}, 9), gains({}, 5));
}

TEST(BenedictBordner, BetaFollowsAlpha) {
  for (double alpha = 0.05; alpha <= 1.0; alpha += 0.05) {
    const Vec<double, 2> k = BenedictBordner{alpha}.gains<2>(GainOccasion<double>{});
    EXPECT_DOUBLE_EQ(k[1] * (2 - k[0]), k[0] * k[0]);
    EXPECT_TRUE(stable_gains(k[0], k[1]));
  }
}

/// (I - K H) F of one axis with T = 1: what becomes of an error from one update to the next.
template <int Order>
Mat<double, Order, Order> error_transition(const Vec<double, Order>& gains) {
  Mat<double, Order, Order> f = Mat<double, Order, Order>::Identity(), rest = f;
  f(0, 1) = 1.0;
  rest(0, 0) -= gains[0];
  rest(1, 0) -= gains[1];
  if constexpr (Order == 3) {
    f(0, 2) = 0.5;
    f(1, 2) = 1.0;
    rest(2, 0) -= gains[2] / 2;
  }
  return rest * f;
}

/// By Gelfand: the norm of a high power, per factor.
template <int Order>
double spectral_radius(const Vec<double, Order>& gains) {
  constexpr int kSquarings = 30;
  Mat<double, Order, Order> power = error_transition<Order>(gains);
  double log_scale = 0.0;
  for (int k = 0; k < kSquarings; ++k) {
    const double norm = power.norm();
    if (norm == 0.0) return 0.0;
    power = (power / norm).eval() * (power / norm).eval();
    log_scale = 2.0 * (log_scale + std::log(norm));
  }
  return std::exp(std::ldexp(log_scale, -kSquarings));
}

TEST(StableGains, AreThoseWhoseErrorsDieOut) {
  Draw draw(8);
  int stable = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Vec<double, 2> k(draw.uniform(-0.5, 2.5), draw.uniform(-0.5, 4.5));
    ASSERT_EQ(spectral_radius<2>(k) < 1.0, stable_gains(k[0], k[1])) << k;
    const Vec<double, 3> g(k[0], k[1], draw.uniform(-0.5, 8.0));
    ASSERT_EQ(spectral_radius<3>(g) < 1.0, stable_gains(g[0], g[1], g[2])) << g;
    stable += stable_gains(g[0], g[1], g[2]);
  }
  EXPECT_GT(stable, 200);
}

TEST(CriticallyDamped, HasAllPolesInOnePlace) {
  for (const double theta : {0.0, 0.3, 0.8, 0.95}) {
    const GainOccasion<double> any;
    const auto line = error_transition<2>(CriticallyDamped{theta}.gains<2>(any));
    const auto parabola = error_transition<3>(CriticallyDamped{theta}.gains<3>(any));
    EXPECT_NEAR(line.trace(), 2 * theta, 1e-12);
    EXPECT_NEAR(line.determinant(), theta * theta, 1e-12);
    EXPECT_NEAR(parabola.trace(), 3 * theta, 1e-12);
    EXPECT_NEAR(parabola.determinant(), theta * theta * theta, 1e-12);
    EXPECT_NEAR((parabola * parabola).trace(), 3 * theta * theta, 1e-12);
  }
}

/// Gain and covariance of the steady Kalman filter of one axis, by iteration.
template <int Order>
struct Steady {
  Vec<double, Order> gain;
  Mat<double, Order, Order> covariance;

  Steady(double accel_std_mps2, double t, double std_m) {
    Mat<double, Order, Order> f = Mat<double, Order, Order>::Identity();
    Vec<double, Order> g;
    f(0, 1) = t;
    g[0] = t * t / 2;
    g[1] = t;
    if constexpr (Order == 3) {
      f(0, 2) = t * t / 2;
      f(1, 2) = t;
      g[2] = 1.0;
    }
    const Mat<double, Order, Order> q = accel_std_mps2 * accel_std_mps2 * g * g.transpose();
    covariance = std_m * std_m * Mat<double, Order, Order>::Identity();
    for (int k = 0; k < 3000; ++k) {
      const Mat<double, Order, Order> ahead = f * covariance * f.transpose() + q;
      gain = ahead.col(0) / (ahead(0, 0) + std_m * std_m);
      covariance = ahead - gain * ahead.row(0);
    }
  }
};

template <int Order>
void expect_kalman_gains() {
  for (const double accel : {0.003, 0.1, 2.0, 50.0})
    for (const double t : {1.0, 3.0}) {
      const TrackingIndex schedule{accel};
      const Steady<Order> steady(accel, t, 12.0);
      Vec<double, Order> gain =
          schedule.gains<Order>(GainOccasion<double>{.elapsed_s = t, .std_m = 12.0});
      gain[1] /= t;
      if constexpr (Order == 3) gain[2] /= 2 * t * t;
      const double tolerance = accel < 0.1 ? 1e-6 : 1e-9;  // of the slow iteration
      EXPECT_TRUE(matrices_near(gain, steady.gain, {.absolute = 1e-12, .relative = tolerance}));
      EXPECT_TRUE(matrices_near(schedule.steady_covariance<Order>(t, 12.0), steady.covariance,
                                {.absolute = 1e-12, .relative = tolerance}));
    }
}

TEST(TrackingIndex, GivesTheSteadyKalmanFilterOfTwoStates) { expect_kalman_gains<2>(); }
TEST(TrackingIndex, GivesTheSteadyKalmanFilterOfThreeStates) { expect_kalman_gains<3>(); }

TEST(TrackingIndex, OfZeroLeavesEverythingAsItIs) {
  EXPECT_EQ((TrackingIndex::of_index<2>(0.0)), (Vec<double, 2>(0, 0)));
  EXPECT_EQ((TrackingIndex::of_index<3>(0.0)), (Vec<double, 3>(0, 0, 0)));
}

TEST(TrackingIndex, FollowsTheErrorAlongAndAcrossTheBearing) {
  auto filter = started(AlphaBeta<>(TrackingIndex{0.3}));
  Mat<double, 2, 2> turn;
  turn << std::cos(0.7), -std::sin(0.7), std::sin(0.7), std::cos(0.7);
  const Fix sensor{turn * Vec<double, 2>(25, 900).asDiagonal() * turn.transpose()};
  ASSERT_EQ(filter.predict(3.0), Status::kOk);
  const Gaussian<4> before = filter.estimate();
  const auto step = filter.update(sensor, Vec<double, 2>(3050, 3980));
  ASSERT_TRUE(step);
  const auto moved = [&](int state) {
    return Vec<double, 2>(
        turn.transpose() *
        Vec<double, 2>(filter.estimate().mean[state] - before.mean[state],
                       filter.estimate().mean[state + 2] - before.mean[state + 2]));
  };
  const Vec<double, 2> e = turn.transpose() * step.innovation;
  const double std_m[] = {5.0, 30.0};
  for (int axis = 0; axis < 2; ++axis) {
    const Vec<double, 2> k = TrackingIndex::of_index<2>(0.3 * 9 / std_m[axis]);
    EXPECT_NEAR(moved(0)[axis], k[0] * e[axis], 1e-9);
    EXPECT_NEAR(moved(1)[axis], k[1] / 3 * e[axis], 1e-9);
  }
}

TEST(RangeDependent, IsThatOfAPlottingAid) {
  const auto at = [](double range_m) {
    return RangeDependent{}.gains<2>(GainOccasion<double>{.range_m = range_m});
  };
  EXPECT_EQ(at(5e3), (Vec<double, 2>(0.5, 0.2)));
  EXPECT_TRUE(matrices_near(at(40e3), Vec<double, 2>(0.5, 0.1)));  // 20 / D, 4 / D
  EXPECT_TRUE(matrices_near(at(50e3), Vec<double, 2>(0.4, 0.08)));
  EXPECT_TRUE(matrices_near(at(100e3), Vec<double, 2>(0.2, 0.04)));
  EXPECT_EQ(at(900e3), (Vec<double, 2>(0.2, 0.01)));
}

TEST(RecentMemory, IsTheLineWithWeightsThatGrow) {
  Draw draw(17);
  auto filter = started(AlphaBeta<>(RecentMemory{}));
  std::vector<Vec<double, 2>> readings;
  for (int n = 1; n <= 60; ++n) {
    readings.push_back(draw.normals<2>());
    ASSERT_EQ(filter.predict(1.0), Status::kOk);
    ASSERT_TRUE(filter.update(kSensor, readings.back()));
    if (n < 2) continue;
    const Mat<double, 2, 2> wanted =
        polynomial<2>(readings, [](std::size_t k) { return double(k) + 1.0; });
    const auto& mean = filter.estimate().mean;
    const Mat<double, 2, 2> actual{{mean[0], mean[2]}, {mean[1], mean[3]}};
    ASSERT_TRUE(matrices_near(actual, wanted, {.absolute = 1e-9, .relative = 0})) << n;
  }
}

TEST(AdaptiveGains, OfThreePlotsAreThoseOfTheThirdOne) {
  Draw draw(18);
  auto adaptive = started(AlphaBeta<>(AdaptiveGains{.window = 3}));
  auto constant = started(AlphaBeta<>(ConstantGains{5.0 / 6, 1.0 / 2}));
  for (int k = 0; k < 40; ++k) {
    const Vec<double, 2> z = 50.0 * draw.normals<2>();
    for (auto* filter : {&adaptive, &constant}) {
      ASSERT_EQ(filter->predict(2.0), Status::kOk);
      ASSERT_TRUE(filter->update(kSensor, z));
    }
    if (k < 2) {
      ASSERT_EQ(constant.assign(adaptive.estimate()), Status::kOk);
      continue;
    }
    ASSERT_TRUE(matrices_near(adaptive.estimate().mean, constant.estimate().mean, {1e-9, 1e-12}));
  }
}

// To an observer who moves and looks another way a target has the same gains.
TEST(AdaptiveGains, DependNeitherOnTheSpeedNorOnTheAxes) {
  Draw draw(19);
  Mat<double, 2, 2> turn;
  turn << std::cos(0.7), -std::sin(0.7), std::sin(0.7), std::cos(0.7);
  const Vec<double, 2> velocity(12.0, -7.0);
  auto filter = started(AlphaBeta<>(AdaptiveGains{})), moved = filter;
  for (double t = 0; t < 100;) {
    const double dt_s = draw.uniform(1.0, 4.0);
    t += dt_s;
    const Vec<double, 2> z(3e3 + draw.normal() * 20, 4e3 + draw.normal() * 20);
    ASSERT_EQ(filter.predict(dt_s), Status::kOk);
    ASSERT_EQ(moved.predict(dt_s), Status::kOk);
    ASSERT_TRUE(filter.update(kSensor, z));
    ASSERT_TRUE(moved.update(kSensor, Vec<double, 2>(turn * z + t * velocity)));
    if (t < 20) continue;  // the start, which is not moved
    const auto &here = filter.estimate().mean, &there = moved.estimate().mean;
    const Vec<double, 2> rate = turn * Vec<double, 2>(here[1], here[3]) + velocity;
    EXPECT_TRUE(matrices_near(Vec<double, 2>(there[1], there[3]), rate, {1e-6, 0}));
  }
}

TEST(AdaptiveGains, OfNoiseAreAboutThreeQuarters) {
  Draw draw(20);
  auto filter = started(AlphaBeta<>(AdaptiveGains{}));
  double alpha = 0, beta = 0;
  constexpr int kScans = 4000, kBegun = 10;
  for (int k = 0; k < kScans; ++k) {
    ASSERT_EQ(filter.predict(1.0), Status::kOk);
    const auto before = filter.estimate().mean;
    const auto step = filter.update(kSensor, Vec<double, 2>(10.0 * draw.normals<2>()));
    ASSERT_TRUE(step);
    if (k < kBegun) continue;
    const auto& mean = filter.estimate().mean;
    alpha += (mean[0] - before[0]) / step.innovation[0] / (kScans - kBegun);
    beta += (mean[1] - before[1]) / step.innovation[0] / (kScans - kBegun);
  }
  EXPECT_NEAR(alpha, 0.74, 0.01);
  EXPECT_NEAR(beta, 0.37, 0.01);
}

TEST(RangeDependent, MeasuresTheRangeFromOwnShip) {
  RangeBearing radar{.range_std_m = 10, .bearing_std_rad = 0.001};
  radar.own.north_m = -150e3;
  const auto alpha = [](const auto& sensor, const Vec<double, 2>& z) {
    auto filter = started(AlphaBeta<>(RangeDependent{}));
    (void)filter.predict(3.0);
    const double before = filter.estimate().mean[2];
    const auto step = filter.update(sensor, z);
    return (filter.estimate().mean[2] - before) / step.innovation[1];
  };
  EXPECT_NEAR(alpha(kSensor, {3000, 4100}), 0.5, 1e-9);
  EXPECT_NEAR(alpha(radar, radar.measure(Vec<double, 2>(3000, 4100))), 0.2, 1e-9);
}

TEST(AlphaBetaFilter, ErrorsAreThoseItClaims) {
  for (const auto& schedule : every_schedule<2>())
    test::expect_consistent(AlphaBeta<>(schedule), kSensor, test::five_km_off<double>(), 400, 15,
                            3.0);
  for (const auto& schedule : every_schedule<3>()) {
    const AlphaBetaGamma<> filter(schedule);
    test::expect_consistent(filter, kSensor, test::lifted<6>(filter.motion()), 400, 15, 3.0);
  }
}

TEST(AlphaBetaFilter, OfATrackingIndexEndsInItsSteadyCovariance) {
  const TrackingIndex schedule{0.3};
  auto line = started(AlphaBeta<>(schedule));
  auto parabola = started(AlphaBetaGamma<>(schedule));
  for (int k = 0; k < 400; ++k) {
    (void)line.predict(2.0);
    (void)line.update(kSensor, Vec<double, 2>(0, 0));
    (void)parabola.predict(2.0);
    (void)parabola.update(kSensor, Vec<double, 2>(0, 0));
  }
  const Mat<double, 2, 2> of_line = line.estimate().covariance.topLeftCorner<2, 2>();
  const Mat<double, 3, 3> of_parabola = parabola.estimate().covariance.bottomRightCorner<3, 3>();
  EXPECT_TRUE(matrices_near(of_line, schedule.steady_covariance<2>(2.0, 10.0), {0, 1e-9}));
  EXPECT_TRUE(matrices_near(of_parabola, schedule.steady_covariance<3>(2.0, 10.0), {0, 1e-9}));
}

TEST(AlphaBetaFilter, AMissedScanWidensTheBeliefAndLengthensTheStep) {
  auto filter = started(AlphaBeta<>(ConstantGains{0.5, 0.2})), patient = filter;
  const Vec<double, 2> z(3030, 3990);
  for (int k = 0; k < 3; ++k) {
    const double before = patient.estimate().covariance(0, 0);
    ASSERT_EQ(patient.predict(2.0), Status::kOk);
    EXPECT_GT(patient.estimate().covariance(0, 0), before);
  }
  ASSERT_EQ(filter.predict(6.0), Status::kOk);
  ASSERT_TRUE(filter.update(kSensor, z));
  ASSERT_TRUE(patient.update(kSensor, z));
  EXPECT_TRUE(matrices_near(patient.estimate().mean, filter.estimate().mean, {1e-9, 1e-12}));
}

TEST(AlphaBetaFilter, ReadingsOfOneTimeHaveOneStepBetweenThem) {
  const Vec<double, 2> z(3030, 3990);
  auto filter = started(AlphaBeta<>(GrowingMemory{}));
  for (int k = 0; k < 5; ++k) {
    (void)filter.predict(3.0);
    (void)filter.update(kSensor, z);
  }
  (void)filter.predict(3.0);
  auto again = filter;  // as probabilistic data association does
  const auto before = again.estimate();
  ASSERT_TRUE(again.update(kSensor, Vec<double, 2>(2900, 4000)));
  ASSERT_EQ(again.assign(before), Status::kOk);
  ASSERT_TRUE(again.update(kSensor, z));
  ASSERT_TRUE(filter.update(kSensor, z));
  EXPECT_TRUE(beliefs_identical<4>(again.estimate(), filter.estimate()));
  auto at_once = started(AlphaBeta<>(TrackingIndex{0.1}));
  ASSERT_TRUE(at_once.update(kSensor, z));
  EXPECT_EQ(at_once.estimate().mean[1], test::five_km_off<double>().mean[1]);
}

TEST(AlphaBetaFilter, TheReadingAfterAGapIsNotOneOfItsTime) {
  constexpr double kAlpha = 0.5, kBeta = 0.2;
  auto filter = started(AlphaBeta<>(ConstantGains{kAlpha, kBeta}));
  for (int k = 0; k < 20; ++k) {
    const bool seen = k < 5 || k > 15;
    ASSERT_EQ(filter.predict(1.0), Status::kOk);
    const auto predicted = filter.estimate().mean;
    if (!seen) continue;
    ASSERT_TRUE(filter.update(kSensor, Vec<double, 2>(3030, 3990)));
    const double step_s = k == 16 ? 12.0 : 1.0;
    EXPECT_NEAR(filter.estimate().mean[1], predicted[1] + kBeta / step_s * (3030 - predicted[0]),
                1e-9)
        << k;
  }
}

// Two radars of one period, the second so much behind the first.
TEST(AlphaBetaFilter, ForgetsItsErrorsHoweverTwoRadarsAreOutOfStep) {
  constexpr double kPeriod_s = 2.5;
  for (const auto& schedule : every_schedule<2>())
    for (const double behind_s : {1e-9, 0.001, 0.005, 0.05, 0.2, 0.3, 0.5, 1.25}) {
      auto filter = started(AlphaBeta<>(schedule));
      const Vec<double, 2> at_rest(3000, 4000);
      for (int k = 0; k < 200; ++k)
        for (const double dt_s : {behind_s, kPeriod_s - behind_s}) {
          ASSERT_EQ(filter.predict(dt_s), Status::kOk);
          ASSERT_TRUE(filter.update(kSensor, at_rest));
        }
      const auto& mean = filter.estimate().mean;
      EXPECT_LT(std::hypot(mean[0] - 3000, mean[2] - 4000), 5.0) << schedule.index() << behind_s;
      EXPECT_LT(std::hypot(mean[1], mean[3]), 1.0) << schedule.index() << ", " << behind_s;
    }
}

TEST(AlphaBetaFilter, KeepsADefiniteCovarianceWhateverComes) {
  Draw draw(91);
  for (const auto& schedule : every_schedule<3>()) {
    auto filter = started(AlphaBetaGamma<>(schedule));
    for (int k = 0; k < 300; ++k) {
      ASSERT_EQ(filter.predict(draw.uniform(2.0, k % 50 == 7 ? 60.0 : 5.0)), Status::kOk);
      const Vec<double, 2> z(draw.uniform(2e3, 4e3), draw.uniform(3e3, 5e3));
      if (k % 3 > 0) {
        ASSERT_TRUE(filter.update(Position{.position_std_m = draw.uniform(1, 50)}, z));
      }
      ASSERT_TRUE(test::is_covariance(filter.estimate().covariance)) << k;
    }
  }
}

TEST(AlphaBetaFilter, BadInputChangesNothing) {
  AlphaBeta<> filter{GrowingMemory{}};
  EXPECT_EQ(filter.predict(1.0), Status::kNotStarted);
  EXPECT_EQ(filter.update(kSensor, Vec<double, 2>(1, 2)).status, Status::kNotStarted);
  Gaussian<4> bad;
  bad.covariance(0, 0) = -1.0;
  EXPECT_EQ(filter.start(bad), Status::kNotPositiveDefinite);
  filter = started(filter);
  ASSERT_EQ(filter.predict(3.0), Status::kOk);
  auto wanted = filter;
  const auto before = filter.estimate();
  EXPECT_EQ(filter.start(bad), Status::kNotPositiveDefinite);
  EXPECT_EQ(filter.predict(NAN), Status::kNotFinite);
  EXPECT_EQ(filter.predict(-1.0), Status::kNegativeTimeStep);
  EXPECT_EQ(filter.predict(1e300), Status::kNotFinite);
  EXPECT_EQ(filter.update(kSensor, Vec<double, 2>(NAN, 1)).status, Status::kNotFinite);
  EXPECT_TRUE(beliefs_identical<4>(filter.estimate(), before));
  (void)filter.update(kSensor, Vec<double, 2>(3000, 4000));
  (void)wanted.update(kSensor, Vec<double, 2>(3000, 4000));
  EXPECT_TRUE(beliefs_identical<4>(filter.estimate(), wanted.estimate()));
}

TEST(AlphaBetaFilter, RejectsInvalidParameters) {
  EXPECT_THROW(AlphaBeta<>(ConstantGains{1.5, 1.0}), std::invalid_argument);
  EXPECT_THROW(AlphaBeta<>(ConstantGains{0.5, 0.2, 0.1}), std::invalid_argument);
  EXPECT_THROW(AlphaBetaGamma<>(ConstantGains{0.5, 0.2}), std::invalid_argument);
  EXPECT_THROW(AlphaBetaGamma<>(ConstantGains{0.5, 0.2, 0.5}), std::invalid_argument);
  EXPECT_THROW(AlphaBeta<>(BenedictBordner{1.1}), std::invalid_argument);
  EXPECT_THROW(AlphaBeta<>(CriticallyDamped{1.0}), std::invalid_argument);
  EXPECT_THROW(AlphaBeta<>(TrackingIndex{0.0}), std::invalid_argument);
  EXPECT_THROW(AlphaBeta<>(GrowingMemory{.plots_before = -1}), std::invalid_argument);
  EXPECT_THROW(AlphaBetaGamma<>(GrowingMemory{.max_plots = 2}), std::invalid_argument);
  EXPECT_THROW(AlphaBeta<>(RangeDependent{.far_alpha = 0.6}), std::invalid_argument);
  EXPECT_THROW(AlphaBeta<>(RecentMemory{.max_plots = 1}), std::invalid_argument);
  EXPECT_THROW(AlphaBeta<>(AdaptiveGains{.window = 2}), std::invalid_argument);
  EXPECT_THROW(AlphaBeta<>(AdaptiveGains{.window = 9}), std::invalid_argument);
}

TEST(AlphaBetaFilter, TakesThePositionOutOfAnySensorAndAKnownAcceleration) {
  auto filter = started(AlphaBeta<>(TrackingIndex{0.1})), plain = filter;
  const Vec<double, 2> u(0.2, -0.1);
  ASSERT_EQ(filter.predict(3.0, u), Status::kOk);
  ASSERT_EQ(plain.predict(3.0), Status::kOk);
  EXPECT_TRUE(matrices_near(Vec<double, 4>(filter.estimate().mean - plain.estimate().mean),
                            Vec<double, 4>(0.9, 0.6, -0.45, -0.3), {1e-9, 0}));
  plain = filter;
  ASSERT_TRUE(filter.update(RangeBearingDoppler{}, Vec<double, 3>(5000, 0.92, 3)));
  ASSERT_TRUE(plain.update(RangeBearing{}, Vec<double, 2>(5000, 0.92)));
  EXPECT_TRUE(beliefs_identical<4>(filter.estimate(), plain.estimate()));
}

TEST(AlphaBetaFilter, AloneInAnImmIsTheFilter) {
  for (const auto& schedule : every_schedule<2>()) {
    Draw draw(23);
    auto filter = started(AlphaBeta<>(schedule));
    Imm imm{ModeChain<1>(Mat<double, 1, 1>::Ones()), AlphaBeta<>(schedule)};
    ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
    for (int scan = 0; scan < 30; ++scan) {
      ASSERT_EQ(filter.predict(2.5), Status::kOk);
      ASSERT_EQ(imm.predict(2.5), Status::kOk);
      if (scan % 7 == 3) continue;
      const Vec<double, 2> z = filter.estimate().mean({0, 2}) + 30.0 * draw.normals<2>();
      const auto one = filter.update(kSensor, z);
      const auto other = imm.update(kSensor, z);
      ASSERT_TRUE(one);
      ASSERT_TRUE(other);
      EXPECT_NEAR(other.log_likelihood, one.log_likelihood, 1e-12 * std::abs(one.log_likelihood));
      ASSERT_TRUE(matrices_near(imm.estimate().mean, filter.estimate().mean,
                                {.absolute = 1e-9, .relative = 1e-12}));
      ASSERT_TRUE(matrices_near(imm.estimate().covariance, filter.estimate().covariance,
                                {.absolute = 1e-9, .relative = 1e-12}));
    }
  }
}

TEST(AlphaBetaFilter, TakesOneOfSeveralReadingsAsIfItWereAlone) {
  auto filter = started(AlphaBeta<>(ConstantGains{0.5, 0.2}));
  Imm imm{ModeChain<1>(Mat<double, 1, 1>::Ones()), AlphaBeta<>(ConstantGains{0.5, 0.2})};
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  for (int scan = 0; scan < 5; ++scan) {
    ASSERT_EQ(filter.predict(2.5), Status::kOk);
    ASSERT_EQ(imm.predict(2.5), Status::kOk);
    const Vec<double, 2> z = filter.estimate().mean({0, 2}) + Vec<double, 2>(20.0, -10.0);
    ASSERT_TRUE(filter.update(kSensor, z));
    const Vec<double, 2> impossible(1e9, 1e9);
    const Alternative<Position> readings[] = {{kSensor, impossible, 1.0}, {kSensor, z, 1.0}};
    double share[2];
    ASSERT_GT(imm.update(std::span<const Alternative<Position>>(readings), 0.0, share), 0.0);
    EXPECT_EQ(share[1], 1.0);
    ASSERT_TRUE(matrices_near(imm.estimate().mean, filter.estimate().mean,
                              {.absolute = 1e-9, .relative = 1e-12}));
  }
}

TEST(AlphaBetaFilter, DoesNotCountAReadingThatOnlyWasTried) {
  const Vec<double, 2> impossible(1e9, 1e9);
  Imm imm{ModeChain<1>(Mat<double, 1, 1>::Ones()), AlphaBeta<>(ConstantGains{0.5, 0.2})};
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(imm.predict(2.5), Status::kOk);
  Imm tried = imm;
  const Alternative<Position> reading{kSensor, impossible, 1.0};
  double share = 0.0;
  ASSERT_EQ(tried.update(std::span(&reading, 1), 0.0, std::span(&share, 1)), 0.0);
  ASSERT_GT(tried.update(std::span(&reading, 1), 1.0, std::span(&share, 1)), 0.0);
  for (auto* one : {&imm, &tried}) {
    ASSERT_EQ(one->predict(2.5), Status::kOk);
    ASSERT_TRUE(one->update(kSensor, Vec<double, 2>(3050.0, 3950.0)));
  }
  EXPECT_TRUE(matrices_near(tried.estimate().mean, imm.estimate().mean,
                            {.absolute = 1e-9, .relative = 1e-12}));
}

TEST(AlphaBetaFilter, RejectsPlotsWithoutAFiniteGain) {
  for (const Mat<double, 2, 2>& errors : {Mat<double, 2, 2>(Mat<double, 2, 2>::Zero()),
                                          Mat<double, 2, 2>(Mat<double, 2, 2>::Ones())}) {
    auto filter = started(AlphaBeta<>(TrackingIndex{0.3}));
    ASSERT_EQ(filter.predict(2.5), Status::kOk);
    const auto before = filter.estimate();
    const auto step = filter.update(Fix{errors}, Vec<double, 2>(1.0, 2.0));
    EXPECT_EQ(step.status, Status::kNotFinite);
    EXPECT_TRUE(beliefs_identical(filter.estimate(), before));
  }
}

TEST(AlphaBetaFilter, IsAModelOfAnImm) {
  const ModeChain<2> chain(ModeChain<2>::Matrix{{0.95, 0.05}, {0.1, 0.9}});
  using Bank = FilterBank<AlphaBeta<>, Ekf<CoordinatedTurnRate>>;
  Imm<Bank> imm(chain, Bank(AlphaBeta<>(TrackingIndex{0.05}),
                            Ekf<CoordinatedTurnRate>(CoordinatedTurnRate{})));
  ASSERT_EQ(imm.start(test::five_km_off<double>()), Status::kOk);
  for (int k = 0; k < 10; ++k) {
    ASSERT_EQ(imm.predict(3.0), Status::kOk);
    ASSERT_TRUE(imm.update(kSensor, Vec<double, 2>(3000 - 12.0 * k, 4000 + 21.0 * k)));
    EXPECT_TRUE(test::is_covariance(imm.estimate().covariance));
  }
  EXPECT_NEAR(imm.mode_probability().sum(), 1.0, 1e-12);
}

TEST(AlphaBetaFilter, ArchiveBringsEverythingBack) {
  auto filter = started(AlphaBeta<>(GrowingMemory{}));
  for (int k = 0; k < 5; ++k) {
    (void)filter.predict(2.0);
    if (k != 3) (void)filter.update(kSensor, Vec<double, 2>(3000 + k, 4000));
  }
  AlphaBeta<> restored{GrowingMemory{}};
  Archive written;
  filter.archive(written);
  Archive read(written.bytes());
  restored.archive(read);
  ASSERT_TRUE(read.ok() && read.at_end());
  for (int k = 0; k < 3; ++k) {
    (void)filter.predict(2.0);
    (void)restored.predict(2.0);
    (void)filter.update(kSensor, Vec<double, 2>(3010, 4000));
    (void)restored.update(kSensor, Vec<double, 2>(3010, 4000));
    EXPECT_TRUE(beliefs_identical<4>(filter.estimate(), restored.estimate()));
  }
}

TEST(AlphaBetaFilter, TouchesNoHeap) {
  for (const auto& schedule : every_schedule<3>()) {
    AlphaBetaGamma<> filter(schedule);
    const test::NoHeap fence;
    Status worst = filter.start(test::five_km_off<double>());
    for (int k = 0; k < 3; ++k) {
      if (filter.predict(3.0) != Status::kOk) worst = Status::kMissed;
      if (!filter.update(kSensor, Vec<double, 2>(3000, 4000))) worst = Status::kMissed;
    }
    EXPECT_EQ(fence.allocations(), 0);
    EXPECT_EQ(worst, Status::kOk);
  }
}

TEST(AlphaBetaFilter, IsOfFloatToo) {
  for (const auto& schedule : every_schedule<2>()) {
    auto filter = started(AlphaBeta<>(schedule));
    auto single = started(AlphaBeta<float>(schedule));
    for (int k = 0; k < 30; ++k) {
      const Vec<double, 2> z(3000 - 12.0 * k, 4000 + 21.0 * k);
      ASSERT_EQ(filter.predict(3.0), Status::kOk);
      ASSERT_EQ(single.predict(3.0f), Status::kOk);
      ASSERT_TRUE(filter.update(kSensor, z));
      ASSERT_TRUE(single.update(kSensor, Vec<float, 2>(z.cast<float>())));
    }
    EXPECT_TRUE(matrices_near(single.estimate().mean.cast<double>(), filter.estimate().mean,
                              {.absolute = 0.01, .relative = 1e-5}));
    EXPECT_TRUE(test::is_covariance(single.estimate().covariance));
  }
}

/// The covariance after the first plot of a prior all but without bound.
template <class Scalar>
Mat<Scalar, 4, 4> after_first_plot() {
  AlphaBeta<Scalar> filter(TrackingIndex{10.0});
  Gaussian<4, Scalar> belief;
  belief.mean.setZero();
  belief.covariance = Scalar(1e10) * Mat<Scalar, 4, 4>::Identity();
  EXPECT_EQ(filter.start(belief), Status::kOk);
  EXPECT_EQ(filter.predict(Scalar(60)), Status::kOk);
  EXPECT_TRUE(filter.update(kSensor, Vec<Scalar, 2>(Scalar(30), Scalar(40))));
  return filter.estimate().covariance;
}

// The difference P - K H P would be all rounding.
TEST(AlphaBetaFilter, HoldsWhatThePlotKnowsOfAWidePriorInFloatToo) {
  const Mat<float, 4, 4> p = after_first_plot<float>();
  const Mat<double, 4, 4> wanted = after_first_plot<double>();
  for (const int row : {0, 2}) EXPECT_NEAR(p(row, row), wanted(row, row), 0.01 * wanted(row, row));
  EXPECT_TRUE(test::is_covariance(p));
}

}  // namespace
}  // namespace wakeline::alpha_beta_test
