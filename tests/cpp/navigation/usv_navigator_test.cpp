// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/navigation/usv_navigator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <vector>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "support/matrix_assert.hpp"
#include "support/numeric_jacobian.hpp"
#include "wakeline/filter/augmented_ukf.hpp"
#include "wakeline/measurement/fix.hpp"

namespace wakeline::usv_navigator_test {
namespace {

using test::Draw;
using test::is_covariance;
using test::matrices_near;
using Vec2 = Vec<double, 2>;
using Vec3 = Vec<double, 3>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Vec2 kFixStd(8.0, 7.0);
const Vec3 kBias(0.03, 0.02, deg(0.28));  // forward, starboard, gyro
const Vec3 kNoBias = Vec3::Zero();

Fix gnss() { return {.covariance_m2 = kFixStd.cwiseAbs2().asDiagonal()}; }
Vec<double, 1> of(double z) { return Vec<double, 1>(z); }

// The mission -------------------------------------------------------------------------------------

struct Instant {
  Vec2 position = Vec2::Zero(), velocity = Vec2::Zero();
  double heading = deg(150);
  Imu imu;  ///< of the step that led here
  Vec2 fix = Vec2::Zero();
  double compass = 0.0;
};

/// 800 m x 800 m at 1 m/s through waypoints, turning at up to 5 deg/s, in a current towards 090.
/// The accelerometers feel what changes the velocity over ground.
std::vector<Instant> mission(std::uint64_t seed, const Vec3& bias, double current_mps = 0.5) {
  const std::array waypoints{Vec2(200, 300), Vec2(450, 420), Vec2(620, 700), Vec2(800, 800)};
  const double most = deg(5);
  const ImuNoise noise;
  Draw draw(seed);
  Instant now;
  const auto over_ground = [&] {
    return Vec2(body_to_north_east(now.heading).col(0) + Vec2(0, current_mps));
  };
  now.velocity = over_ground();
  const auto sense = [&] {
    now.fix = now.position + kFixStd.cwiseProduct(draw.normals<2>());
    now.compass = wrap_angle(now.heading + deg(1) * draw.normal());
  };
  sense();
  std::vector<Instant> log{now};
  for (std::size_t leg = 0; leg < waypoints.size() && log.size() < 5000;) {
    const Vec2 way = waypoints[leg] - now.position;
    if (way.norm() < 10) {
      ++leg;
      continue;
    }
    const double turn =
        std::clamp(wrap_angle(std::atan2(way[1], way[0]) - now.heading), -most, most);
    const double before = now.heading;
    const Vec2 slow = now.velocity;
    now.heading = wrap_angle(before + turn);
    now.velocity = over_ground();
    now.position += (slow + now.velocity) / 2;
    const Vec2 body = body_to_north_east(before + turn / 2).transpose() * (now.velocity - slow);
    now.imu = {body[0] + bias[0] + noise.acceleration_std_mps2 * draw.normal(),
               body[1] + bias[1] + noise.acceleration_std_mps2 * draw.normal(),
               turn + bias[2] + noise.yaw_rate_std_rad_s * draw.normal()};
    sense();
    log.push_back(now);
  }
  return log;
}

/// Her true place and heading, and a velocity that knows nothing of the current.
UsvStart start_of(const Instant& first) {
  return {.position_m = first.position,
          .velocity_mps = body_to_north_east(first.heading).col(0),
          .heading_rad = first.heading};
}

template <class Model>
Vec3 pose(const Vec<double, kStatesOf<Model>>& x) {
  constexpr auto kRows =
      rows_of(Model::kComponents, std::array{Component::kNorth, Component::kEast, kHeading});
  return {x[kRows[0]], x[kRows[1]], x[kRows[2]]};
}

/// Squared errors north, east (m²) and of heading (deg²).
template <class Model>
Vec3 squared_error(const Vec<double, kStatesOf<Model>>& x, const Instant& truth) {
  Vec3 error = pose<Model>(x) - Vec3(truth.position[0], truth.position[1], truth.heading);
  error[2] = wrap_angle(error[2]) / deg(1);
  return error.cwiseAbs2();
}

template <class Navigator>
std::vector<typename Navigator::State> navigate(Navigator& navigator,
                                                const std::vector<Instant>& log) {
  std::vector<typename Navigator::State> beliefs;
  EXPECT_EQ(navigator.start(start_of(log.front())), Status::kOk);
  beliefs.push_back(navigator.estimate());
  for (std::size_t k = 1; k < log.size(); ++k) {
    EXPECT_EQ(navigator.predict(1.0, log[k].imu), Status::kOk);
    (void)navigator.update(gnss(), log[k].fix);
    (void)navigator.update(Compass(), of(log[k].compass));
    beliefs.push_back(navigator.estimate());
  }
  return beliefs;
}

template <class Navigator>
std::vector<typename Navigator::Leg> legs_of(const Navigator& navigator,
                                             const std::vector<Instant>& log) {
  std::vector<typename Navigator::Leg> legs;
  for (std::size_t k = 1; k < log.size(); ++k) legs.push_back(navigator.leg(1.0, log[k].imu));
  return legs;
}

struct Score {
  Vec3 filter = Vec3::Zero(), second_half = Vec3::Zero(), smoother = Vec3::Zero();
  double nees = 0.0;  ///< of the paper's five states
};

template <template <class, class> class Filter = Ekf, class Model>
Score score(const Model& model, const Vec3& bias, int runs) {
  Score mean;
  for (int run = 0; run < runs; ++run) {
    UsvNavigator<Model, Filter> navigator(model);
    const std::vector<Instant> log = mission(std::uint64_t(1000 + run), bias);
    auto beliefs = navigate(navigator, log);
    const double steps = double(log.size() - 1) * runs;
    for (std::size_t k = 1; k < log.size(); ++k) {
      const Vec3 error = squared_error<Model>(beliefs[k].mean, log[k]);
      mean.filter += error / steps;
      if (2 * k >= log.size()) mean.second_half += 2 * error / steps;
      if constexpr (kStatesOf<Model> != 7) {
        Vec<double, 5> x = beliefs[k].mean.template head<5>();
        x.template head<2>() -= log[k].position;
        x.template segment<2>(2) -= log[k].velocity;
        x[4] = wrap_angle(x[4] - log[k].heading);
        const Mat<double, 5, 5> p = beliefs[k].covariance.template topLeftCorner<5, 5>();
        mean.nees += Cholesky<5>(p).squared_norm(x) / steps;
      }
    }
    EXPECT_EQ(navigator.smooth(beliefs, legs_of(navigator, log)), Status::kOk);
    for (std::size_t k = 1; k < log.size(); ++k)
      mean.smoother += squared_error<Model>(beliefs[k].mean, log[k]) / steps;
  }
  return mean;
}

void report(const char* name, const Score& score) {
  const auto text = [](const Vec3& v) {
    return std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]);
  };
  ::testing::Test::RecordProperty(name, text(score.filter));
  std::cout << name << ": filter " << text(score.filter) << ", second half "
            << text(score.second_half) << ", smoother " << text(score.smoother) << ", NEES "
            << score.nees << '\n';
}

// What a mission costs; the numbers beside are of an independent implementation, 100 runs.
TEST(UsvNavigator, ReachesTheKnownErrorsWithUnknownBiases) {
  const Score eight = score(UsvBiasMotion{}, kBias, 100);
  report("eight", eight);
  EXPECT_TRUE(matrices_near(eight.filter, Vec3(2.91, 2.40, 0.044), {0, 0.15}));
  EXPECT_TRUE(matrices_near(eight.second_half, Vec3(2.07, 1.70, 0.034), {0, 0.15}));
  EXPECT_GT(eight.nees, 4.5);
  EXPECT_LT(eight.nees, 5.5);
  EXPECT_LT(eight.smoother[0], 0.65);
  EXPECT_LT(eight.smoother[1], 0.55);
  EXPECT_LT(eight.smoother[2], 0.02);
}

TEST(UsvNavigator, ReachesTheKnownErrorsWithKnownBiases) {
  const Score five = score(UsvMotion{}, kNoBias, 100);
  report("five", five);
  EXPECT_TRUE(matrices_near(five.filter, Vec3(2.27, 1.89, 0.034), {0, 0.15}));
  EXPECT_GT(five.nees, 4.5);
  EXPECT_LT(five.nees, 5.5);
}

TEST(UsvNavigator, ReachesTheKnownErrorsAtAConstantSpeedInACurrent) {
  const Score seven =
      score(UsvCurrentMotion{.speed_walk_mps = 1e-4, .current_walk_mps = 1e-4}, kBias, 100);
  report("seven", seven);
  EXPECT_TRUE(matrices_near(seven.filter, Vec3(1.37, 1.13, 0.044), {0, 0.2}));
}

TEST(UsvNavigator, IsConsistentWithAugmentedNoise) {
  const Score additive = score<Ukf>(UsvBiasMotion{}, kBias, 20);
  const Score augmented = score<AugmentedUkf>(UsvBiasMotion{}, kBias, 20);
  report("additive", additive);
  report("augmented", augmented);
  EXPECT_TRUE(matrices_near(augmented.filter, additive.filter, {0, 0.01}));
  EXPECT_GT(augmented.nees, 4.5);
  EXPECT_LT(augmented.nees, 5.5);
}

TEST(UsvNavigator, FindsTheBiasesAndTheCurrent) {
  const std::vector<Instant> log = mission(7, kBias);
  UsvNavigator<UsvBiasMotion> eight;
  navigate(eight, log);
  const Vec3 error = eight.estimate().mean.tail<3>() - kBias;
  const Vec3 std = eight.estimate().covariance.diagonal().tail<3>().cwiseSqrt();
  EXPECT_LT(std[0], 0.005) << "known to a tenth of the prior";
  EXPECT_LT((error.cwiseQuotient(std)).cwiseAbs().maxCoeff(), 3.5);

  UsvNavigator<UsvCurrentMotion> seven;
  navigate(seven, log);
  EXPECT_TRUE(matrices_near(seven.estimate().mean.tail<2>(), Vec2(0, 0.5), {0.1, 0}));
  EXPECT_NEAR(seven.estimate().mean[4], kBias[2], deg(0.02));
}

TEST(UsvNavigator, WithoutRejectionsEveryReadingIsUsedAsItIs) {
  UsvNavigator<UsvMotion> any(UsvMotion{}, UsvOutliers{.gate = {0.5}, .rejections = 0});
  UsvNavigator<UsvMotion> wide(UsvMotion{}, UsvOutliers{.gate = {1 - 1e-12}});
  const std::vector<Instant> log = mission(8, kNoBias);
  const auto used = navigate(any, log).back(), expected = navigate(wide, log).back();
  EXPECT_EQ(used.mean, expected.mean);
  EXPECT_EQ(used.covariance, expected.covariance);
}

TEST(UsvNavigator, IgnoredBiasesAreFarWorse) {
  UsvNavigator<UsvMotion> five(UsvMotion{}, UsvOutliers{.gate = {1 - 1e-9}, .rejections = 0});
  const std::vector<Instant> log = mission(8, kBias);
  const auto beliefs = navigate(five, log);
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 1; k < log.size(); ++k)
    sum += squared_error<UsvMotion>(beliefs[k].mean, log[k]) / double(log.size());
  EXPECT_GT(sum[0] + sum[1], 12.0);
}

template <class Model, template <class, class> class Filter>
void expect_single_precision_will_do(const Vec3& bias) {
  const std::vector<Instant> log = mission(15, bias);
  UsvNavigator<Model, Filter> exact;
  navigate(exact, log);
  UsvNavigator<Model, Filter, float> navigator;
  ASSERT_EQ(navigator.start(start_of(log.front())), Status::kOk);
  for (std::size_t k = 1; k < log.size(); ++k) {
    ASSERT_EQ(navigator.predict(1.0f, log[k].imu), Status::kOk) << k;
    (void)navigator.update(gnss(), Vec<float, 2>(log[k].fix.cast<float>()));
    (void)navigator.update(Compass(), Vec<float, 1>(float(log[k].compass)));
  }
  EXPECT_TRUE(is_covariance(navigator.estimate().covariance));
  const Vec3 apart = pose<Model>(navigator.estimate().mean.template cast<double>()) -
                     pose<Model>(exact.estimate().mean);
  EXPECT_LT(apart.head<2>().norm(), 0.5);
  EXPECT_LT(std::abs(wrap_angle(apart[2])), deg(0.1));
}

TEST(UsvNavigator, WorksInSinglePrecision) {
  expect_single_precision_will_do<UsvBiasMotion, Ekf>(kBias);
  expect_single_precision_will_do<UsvMotion, Ukf>(kNoBias);
  expect_single_precision_will_do<UsvBiasMotion, AugmentedUkf>(kBias);
}

template <class Model>
class EveryUsvModel : public ::testing::Test {};
using Models = ::testing::Types<UsvMotion, UsvBiasMotion, UsvCurrentMotion>;
TYPED_TEST_SUITE(EveryUsvModel, Models, );

/// A model in the middle of a turn.
template <class Model>
Model turning() {
  Model model;
  model.input.imu = {0.3, -0.2, 0.08};
  return model;
}

template <class Model>
StateOf<Model> some_state(Draw& draw) {
  StateOf<Model> x = draw.normals<kStatesOf<Model>>();
  x.template head<2>() *= 100;
  return x;
}

TYPED_TEST(EveryUsvModel, HasTheJacobianOfItsTransition) {
  Draw draw(3);
  for (const double share : {1.0, 0.0}) {
    TypeParam model = turning<TypeParam>();
    model.input.bias_share = share;
    model.input.gyro_share = 0.3;
    if constexpr (requires { model.turned_at; }) model.turned_at = share / 2;
    for (const double dt : {0.1, 1.0, 5.0}) {
      const StateOf<TypeParam> x = some_state<TypeParam>(draw);
      const auto numeric = test::numeric_jacobian(
          [&](const StateOf<TypeParam>& at) { return model.transition(at, dt); }, x);
      EXPECT_TRUE(matrices_near(model.jacobian(x, dt), numeric, {1e-7, 1e-7}));
    }
  }
}

TYPED_TEST(EveryUsvModel, HasAProcessNoiseThatIsACovariance) {
  Draw draw(4);
  const TypeParam model = turning<TypeParam>();
  const StateOf<TypeParam> x = some_state<TypeParam>(draw);
  StateMatrixOf<TypeParam> q = model.process_noise(x, 2.0);
  EXPECT_EQ(q, q.transpose());
  q.diagonal() *= 1 + 1e-9;
  q.diagonal().array() += 1e-15;
  EXPECT_TRUE(Cholesky<kStatesOf<TypeParam>>(q).ok());
  EXPECT_EQ(model.process_noise(x, 0.0).norm(), 0.0);
}

/// Largest velocity error without any fix, in four turns of 5 m/s and 5°/s under an
/// IMU whose rows are means over a second.
double worst_velocity_in_turns_mps(double turned_at) {
  const double speed = 5.0, rate = deg(5.0);
  UsvNavigator<UsvBiasMotion> navigator(UsvBiasMotion{.turned_at = turned_at});
  EXPECT_EQ(navigator.start({.velocity_mps = {speed, 0.0}}), Status::kOk);
  double worst = 0.0;
  for (int k = 1; k <= 288; ++k) {
    EXPECT_EQ(navigator.predict(1.0, {.starboard_mps2 = speed * rate, .yaw_rate_rad_s = rate}),
              Status::kOk);
    const Vec2 velocity = speed * body_to_north_east(k * rate).col(0);
    worst = std::max(worst, (navigator.estimate().mean.segment<2>(2) - velocity).norm());
  }
  return worst;
}

TEST(UsvInertialMotion, FollowsATurnByTheHeadingInTheMiddleOfAStep) {
  EXPECT_LT(worst_velocity_in_turns_mps(UsvBiasMotion{}.turned_at), 0.005);
  EXPECT_GT(worst_velocity_in_turns_mps(0.0), 0.4);
}

// Samples of the gyro error move it as modelled by the noise.
TEST(UsvInertialMotion, ErrsWhereTheGyroTurnsTheAcceleration) {
  UsvMotion model;
  model.input = {.imu = {0.3, -0.2, 0.08}, .noise = {1e-9, deg(0.5)}};
  Draw draw(6);
  const StateOf<UsvMotion> x = some_state<UsvMotion>(draw);
  const StateOf<UsvMotion> expected = model.transition(x, 2.0);
  constexpr int kDraws = 20'000;
  StateMatrixOf<UsvMotion> drawn = StateMatrixOf<UsvMotion>::Zero();
  for (int k = 0; k < kDraws; ++k) {
    const Vec3 error(0.0, 0.0, model.input.noise.yaw_rate_std_rad_s * draw.normal());
    const StateOf<UsvMotion> off = model.disturbed(error).transition(x, 2.0) - expected;
    drawn += off * off.transpose() / kDraws;
  }
  EXPECT_TRUE(matrices_near(model.process_noise(x, 2.0), drawn, {1e-9, 0.05}));
}

// A whole turn of the state turns the motion with it: there is no preferred direction.
TYPED_TEST(EveryUsvModel, HasNoPreferredDirection) {
  constexpr int kRow = index_of(TypeParam::kComponents, kHeading);
  Draw draw(5);
  const TypeParam model = turning<TypeParam>();
  const StateOf<TypeParam> x = some_state<TypeParam>(draw);
  StateMatrixOf<TypeParam> turn = StateMatrixOf<TypeParam>::Identity();
  const Mat<double, 2, 2> r = body_to_north_east(1.2);
  turn.template topLeftCorner<2, 2>() = r;
  if (kRow == 4)
    turn.template block<2, 2>(2, 2) = r;
  else
    turn.template bottomRightCorner<2, 2>() = r;
  StateOf<TypeParam> turned = turn * x, expected = turn * model.transition(x, 1.0);
  turned[kRow] += 1.2;
  expected[kRow] += 1.2;
  EXPECT_TRUE(matrices_near(model.transition(turned, 1.0), expected, {1e-12, 1e-12}));
}

// Q is what the errors of the readings do to the motion, and the walk.
TYPED_TEST(EveryUsvModel, HasTheErrorsOfItsReadingsAndItsWalkInItsProcessNoise) {
  using Errors = Vec<double, TypeParam::kInputs>;
  Draw draw(6);
  const TypeParam model = turning<TypeParam>();
  for (const double dt : {0.1, 1.0, 5.0}) {
    const StateOf<TypeParam> x = some_state<TypeParam>(draw);
    const auto by_error = test::numeric_jacobian(
        [&](const Errors& error) { return model.disturbed(error).transition(x, dt); },
        Errors(Errors::Zero()));
    const Errors variance = model.input_std().cwiseAbs2();
    const StateMatrixOf<TypeParam> sum =
        model.walk_noise(x, dt) + by_error * variance.asDiagonal() * by_error.transpose();
    EXPECT_TRUE(matrices_near(sum, model.process_noise(x, dt), {1e-12, 1e-6}));
  }
}

template <class Model, class One, class Other>
void expect_close(const std::vector<One>& one, const std::vector<Other>& other) {
  for (std::size_t k = 0; k < one.size(); ++k) {
    Vec3 difference = pose<Model>(one[k].mean) - pose<Model>(other[k].mean);
    difference[2] = wrap_angle(difference[2]);
    EXPECT_LT(difference.template head<2>().norm(), 0.1) << k;
    EXPECT_LT(std::abs(difference[2]), deg(0.01)) << k;
    EXPECT_TRUE(is_covariance(one[k].covariance));
    EXPECT_TRUE(is_covariance(other[k].covariance));
  }
}

TYPED_TEST(EveryUsvModel, IsTheSameToEveryFilter) {
  const std::vector<Instant> log = mission(11, kStatesOf<TypeParam> == 5 ? kNoBias : kBias);
  UsvNavigator<TypeParam, Ekf> ekf;
  UsvNavigator<TypeParam, Ukf> ukf;
  UsvNavigator<TypeParam, AugmentedUkf> augmented;
  const auto by_ekf = navigate(ekf, log);
  expect_close<TypeParam>(by_ekf, navigate(ukf, log));
  expect_close<TypeParam>(by_ekf, navigate(augmented, log));
}

TYPED_TEST(EveryUsvModel, CoastsThroughAnOutageAndComesBack) {
  constexpr bool kBiased = kStatesOf<TypeParam> != 5;
  const std::vector<Instant> log = mission(12, kBiased ? kBias : kNoBias);
  for (const bool imu : {true, false}) {
    UsvNavigator<TypeParam> navigator;
    ASSERT_EQ(navigator.start(start_of(log.front())), Status::kOk);
    double north_std = 0;
    int rejected = 0;
    for (std::size_t k = 1; k < 500; ++k) {
      const bool out = k > 400 && k <= 460;
      EXPECT_EQ(out && !imu ? navigator.predict(1.0) : navigator.predict(1.0, log[k].imu),
                Status::kOk);
      const double std = std::sqrt(navigator.estimate().covariance(0, 0));
      if (out) {
        EXPECT_GT(std, north_std) << "uncertainty grows: " << k;
        north_std = std;
        continue;
      }
      if (k == 400) north_std = 0;
      const auto fixed = navigator.update(gnss(), log[k].fix);
      const auto turned = navigator.update(Compass(), of(log[k].compass));
      rejected += fixed.rejected + turned.rejected;
      const Vec3 error = squared_error<TypeParam>(navigator.estimate().mean, log[k]);
      const Vec2 position = error.template head<2>();
      if (k > 460) {
        EXPECT_LT(position.norm(), 16 * navigator.estimate().covariance.topLeftCorner(2, 2).trace())
            << "no jump that was not owned up to: " << k;
      }
    }
    EXPECT_LE(rejected, 3) << "nothing of it is an outlier";
  }
}

TYPED_TEST(EveryUsvModel, RejectsAnOutlierAndReportsIt) {
  const std::vector<Instant> log = mission(13, kBias);
  UsvNavigator<TypeParam> navigator;
  navigate(navigator, log);
  const auto before = navigator.estimate();
  const auto outlier = navigator.update(gnss(), Vec2(log.back().fix + Vec2(500, 0)));
  EXPECT_TRUE(outlier.rejected);
  EXPECT_FALSE(outlier);
  EXPECT_EQ(outlier.status, Status::kGated);
  EXPECT_GT(outlier.nis, 100);
  EXPECT_TRUE(test::matrices_identical(navigator.estimate().mean, before.mean));
  EXPECT_TRUE(test::matrices_identical(navigator.estimate().covariance, before.covariance));
}

TYPED_TEST(EveryUsvModel, BelievesReadingsThatInsist) {
  const UsvOutliers outliers{.rejections = 4};
  const std::vector<Instant> log = mission(14, kStatesOf<TypeParam> == 5 ? kNoBias : kBias);
  UsvNavigator<TypeParam> navigator(TypeParam{}, outliers);
  navigate(navigator, log);
  const Vec2 elsewhere = log.back().position + Vec2(300, -200);
  for (int k = 0; k < 4; ++k) {
    EXPECT_TRUE(navigator.update(gnss(), elsewhere).rejected);
    EXPECT_FALSE(navigator.update(Compass(), of(log.back().heading)).rejected)
        << "each kind is counted by itself";
  }
  const auto taken = navigator.update(gnss(), elsewhere);
  EXPECT_TRUE(taken);
  EXPECT_TRUE(taken.widened);
  EXPECT_LT((navigator.estimate().mean.template head<2>() - elsewhere).norm(), 10);
  EXPECT_TRUE(is_covariance(navigator.estimate().covariance));
  EXPECT_FALSE(navigator.update(gnss(), elsewhere).rejected);
}

/// What the instruments say of a ship that goes north at 3 m/s, and is made to say.
struct Told {
  double log_mps, heading_rad;
  Vec2 velocity_mps;
};

/// A ship that fixes of 3 m, of which a few go astray, a log, a compass and velocities over ground
/// follow, the latter three changed by `fault` for some seconds after the first 150.
class StraightNorth {
 public:
  using Navigator = UsvNavigator<UsvCurrentMotion>;

  template <class Fault>
  StraightNorth(double heading_rad, int seconds, Fault fault, int seconds_per_fix = 1) {
    EXPECT_EQ(navigator.start({.velocity_mps = {3, 0}, .heading_rad = heading_rad}), Status::kOk);
    Draw draw(19);
    for (int k = 1; k < 150 + seconds + 100; ++k) {
      EXPECT_EQ(navigator.predict(1.0, {}), Status::kOk);
      const Vec2 truth(3 * k, 0);
      const bool is_stray = k % 30 == 20;
      const Vec2 noisy = truth + Vec2(is_stray ? 60 : 0, 0) + 3 * draw.normals<2>();
      Told told{3 + 0.1 * draw.normal(), deg(1) * draw.normal(),
                Vec2(3, 0) + 0.1 * draw.normals<2>()};
      if (k >= 150 && k < 150 + seconds) fault(told);
      const Fix gnss{.covariance_m2 = 9 * Mat<double, 2, 2>::Identity()};
      if (k % seconds_per_fix == 0)
        rejected[0] += navigator.update(gnss, noisy).rejected != is_stray;
      rejected[1] += navigator.update(GroundVelocityInCurrent(), told.velocity_mps).rejected;
      rejected[2] += navigator.update(Compass(), of(told.heading_rad)).rejected;
      rejected[3] += navigator.update(SpeedLog(), of(told.log_mps)).rejected;
      const Vec2 off = navigator.estimate().mean.head<2>() - truth;
      farthest_m = std::max(farthest_m, off.norm());
      strongest_current_mps =
          std::max(strongest_current_mps, navigator.estimate().mean.tail<2>().norm());
    }
  }

  Navigator navigator;
  std::array<int, 4> rejected{};  ///< fixes but the stray ones, velocities, headings, speeds
  double farthest_m = 0, strongest_current_mps = 0;
};

void nothing(Told&) {}

// Good fixes and one faulty instrument: the estimate follows the fixes, the instrument is rejected.
TEST(UsvNavigator, IsNotMovedByAnInstrumentThatGoodFixesRefute) {
  for (const double knots : {15.0, 30.0, 100.0, 199.0})
    for (const int seconds : {15, 100}) {
      const StraightNorth ship(0, seconds, [&](Told& told) { told.log_mps = knots * 0.5144; });
      EXPECT_LT(ship.farthest_m, 5) << knots;
      EXPECT_LT(ship.strongest_current_mps, 0.5) << knots;
      EXPECT_GE(ship.rejected[3], seconds) << knots;
      EXPECT_LE(ship.rejected[0] + ship.rejected[1] + ship.rejected[2], 6) << knots;
    }
  for (const Vec2& wrong : {Vec2(0, 0), Vec2(20, 0), Vec2(-3, 0), Vec2(3, 2)}) {
    const StraightNorth ship(0, 30, [&](Told& told) { told.velocity_mps = wrong; });
    EXPECT_LT(ship.farthest_m, 5) << wrong.transpose();
    EXPECT_GE(ship.rejected[1], 30) << wrong.transpose();
    EXPECT_LE(ship.rejected[0] + ship.rejected[2] + ship.rejected[3], 6) << wrong.transpose();
  }
  for (const int seconds : {20, 100}) {
    const StraightNorth ship(0, seconds, [](Told& told) { told.heading_rad += kPi<double>; });
    EXPECT_LT(ship.farthest_m, 5);
    EXPECT_GE(ship.rejected[2], seconds);
    EXPECT_LT(std::abs(ship.navigator.estimate().mean[2]), deg(5));
  }
  const StraightNorth rare(
      0, 30,
      [](Told& told) {
        told.velocity_mps = {20, 0};
      },
      5);
  EXPECT_LT(rare.farthest_m, 6) << "a fix in 5 s";
  EXPECT_GE(rare.rejected[1], 30);
}

TEST(UsvNavigator, BelievesACompassOrALogThatOnlyTheCurrentDenies) {
  const StraightNorth turned(0, 60, [](Told& told) { told.heading_rad += deg(20); });
  EXPECT_LT(turned.farthest_m, 5);
  EXPECT_NEAR(turned.rejected[2], 2 * UsvOutliers{}.rejections, 2) << "there and back";
  EXPECT_NEAR(turned.strongest_current_mps, 2 * 3 * std::sin(deg(10)), 0.2);
  const StraightNorth slower(0, 60, [](Told& told) { told.log_mps -= 1; });
  EXPECT_LT(slower.farthest_m, 5);
  EXPECT_NEAR(slower.rejected[3], 2 * UsvOutliers{}.rejections, 2);
  EXPECT_NEAR(slower.strongest_current_mps, 1, 0.2);
}

// Speed astern over the stern is the way ahead: compass and log are right together or not at all.
TEST(UsvNavigator, BelievesACompassAndALogThatInsistTogether) {
  const StraightNorth ship(kPi<double>, 0, nothing);
  EXPECT_LT(ship.farthest_m, 15);
  const auto& mean = ship.navigator.estimate().mean;
  EXPECT_NEAR(mean[2], 0, deg(2));
  EXPECT_NEAR(mean[3], 3, 0.2);
  EXPECT_LT(mean.tail<2>().norm(), 0.3);
}

/// How a ship heading north changes its speed, and how often each sensor reports.
struct SpeedChange {
  double from_mps, to_mps, acceleration_mps2;
  double dt_s;        ///< between speeds, and headings
  int steps_per_fix;  ///< of 3 m
};

/// Errors of position and current when all instruments are right.
struct Strayed {
  double position_m, current_mps;
};

Strayed strayed_of(const SpeedChange& ship) {
  UsvNavigator<UsvCurrentMotion> navigator;
  EXPECT_EQ(navigator.start({.velocity_mps = {ship.from_mps, 0}}), Status::kOk);
  Draw draw(21);
  const double most_mps = std::abs(ship.to_mps - ship.from_mps);
  const double sign = ship.to_mps < ship.from_mps ? -1 : 1;
  double north_m = 0, farthest_m = 0;
  for (int k = 1; k < 600; ++k) {
    const double changed_s = ship.dt_s * (k - 300);
    const double speed_mps =
        ship.from_mps + sign * std::clamp(ship.acceleration_mps2 * changed_s, 0.0, most_mps);
    north_m += ship.dt_s * speed_mps;
    EXPECT_EQ(navigator.predict(ship.dt_s, {}), Status::kOk);
    if (k % ship.steps_per_fix == 0)
      (void)navigator.update(Fix{.covariance_m2 = 9 * Mat<double, 2, 2>::Identity()},
                             Vec2(Vec2(north_m, 0) + 3 * draw.normals<2>()));
    (void)navigator.update(GroundVelocityInCurrent(),
                           Vec2(Vec2(speed_mps, 0) + 0.1 * draw.normals<2>()));
    (void)navigator.update(Compass(), of(deg(1) * draw.normal()));
    (void)navigator.update(SpeedLog(), of(speed_mps + 0.1 * draw.normal()));
    const Vec2 off = navigator.estimate().mean.head<2>() - Vec2(north_m, 0);
    if (k > 100) farthest_m = std::max(farthest_m, off.norm());
  }
  return {farthest_m, navigator.estimate().mean.tail<2>().norm()};
}

// Fixes fit the belief for a while after a change of speed, but they do not refute the log and
// the velocities that say so, however rare or frequent they are.
TEST(UsvNavigator, FollowsAVesselThatChangesItsSpeed) {
  for (const double faster_mps : {2.0, 5.0, 9.0}) {
    const Strayed strayed = strayed_of({3, 3 + faster_mps, 3, 0.2, 5});
    EXPECT_LT(strayed.position_m, 15) << faster_mps;
    EXPECT_LT(strayed.current_mps, 0.2) << faster_mps;
  }
  for (const int steps_per_fix : {1, 2, 5, 10}) {
    const Strayed braked = strayed_of({6, 0.6, 0.3, 1, steps_per_fix});
    EXPECT_LT(braked.position_m, 35) << steps_per_fix;
    EXPECT_LT(braked.current_mps, 0.3) << steps_per_fix;
    const Strayed faster = strayed_of({6, 12, 0.5, 1, steps_per_fix});
    EXPECT_LT(faster.position_m, 40) << steps_per_fix;
    EXPECT_LT(faster.current_mps, 0.3) << steps_per_fix;
  }
}

// What fixes said of velocities means nothing when there were none for a while.
TYPED_TEST(EveryUsvModel, BelievesVelocitiesThatWereRefutedBeforeAGapOfFixes) {
  constexpr double kDt_s = 0.5;
  UsvNavigator<TypeParam> navigator;
  ASSERT_EQ(navigator.start({.velocity_mps = {5, 0}}), Status::kOk);
  Draw draw(5);
  Vec2 position(0, 0);
  double heading = 0, farthest_m = 0;
  for (int k = 1; k < 700; ++k) {
    const double time_s = kDt_s * k;
    const double turn = time_s > 166 && time_s <= 178 ? deg(5) * kDt_s : 0;
    const Vec2 velocity = 5 * body_to_north_east(heading + turn / 2).col(0);
    heading += turn;
    position += kDt_s * velocity;
    ASSERT_EQ(navigator.predict(kDt_s), Status::kOk);
    const bool is_hidden = time_s > 165 && time_s < 300, is_stuck = time_s >= 140 && time_s < 170;
    const Vec2 fix = position + 3 * draw.normals<2>();
    if (k % 2 == 0 && !is_hidden)
      (void)navigator.update(Fix{.covariance_m2 = 9 * Mat<double, 2, 2>::Identity()}, fix);
    const Vec2 told = is_stuck ? Vec2(0, 0) : Vec2(velocity + 0.1 * draw.normals<2>());
    if constexpr (kStatesOf<TypeParam> == 7)
      (void)navigator.update(GroundVelocityInCurrent(), told);
    else
      (void)navigator.update(GroundVelocity(), told);
    (void)navigator.update(Compass(), of(wrap_angle(heading + deg(1) * draw.normal())));
    const Vec2 off = navigator.estimate().mean.template head<2>() - position;
    if (time_s > 50) farthest_m = std::max(farthest_m, off.norm());
  }
  EXPECT_LT(farthest_m, 80);
}

// A fix that is believed though it did not fit moves the belief, and what would have been is void.
TEST(UsvNavigator, BelievesVelocitiesThroughAGapAfterFixesThatInsisted) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    UsvNavigator<UsvMotion> navigator;
    ASSERT_EQ(navigator.start({.velocity_mps = {5, 0}}), Status::kOk);
    Draw draw(seed);
    double north_m = 0, farthest_m = 0;
    for (int k = 1; k < 1000; ++k) {
      const double time_s = 0.2 * k;
      const double speed_mps = 5 + std::clamp(time_s - 100, 0.0, 15.0);
      north_m += 0.2 * speed_mps;
      ASSERT_EQ(navigator.predict(0.2), Status::kOk);
      if (time_s < 112)
        (void)navigator.update(Fix{.covariance_m2 = 9 * Mat<double, 2, 2>::Identity()},
                               Vec2(Vec2(north_m, 0) + 3 * draw.normals<2>()));
      if (k % 5 == 0)
        (void)navigator.update(GroundVelocity(),
                               Vec2(Vec2(speed_mps, 0) + 0.1 * draw.normals<2>()));
      const Vec2 off = navigator.estimate().mean.head<2>() - Vec2(north_m, 0);
      if (time_s > 50) farthest_m = std::max(farthest_m, off.norm());
    }
    EXPECT_LT(farthest_m, 80) << seed;
  }
}

TYPED_TEST(EveryUsvModel, IsNotMovedByVelocitiesThatGoodFixesRefute) {
  const std::vector<Instant> log = mission(20, kStatesOf<TypeParam> == 5 ? kNoBias : kBias);
  for (const Vec2& wrong : {Vec2(6, 0), Vec2(10, -10)}) {
    UsvNavigator<TypeParam> navigator;
    ASSERT_EQ(navigator.start(start_of(log.front())), Status::kOk);
    int rejected_fixes = 0;
    for (std::size_t k = 1; k < 500; ++k) {
      const bool is_wrong = k >= 300 && k < 340;
      ASSERT_EQ(navigator.predict(1.0, log[k].imu), Status::kOk);
      rejected_fixes += navigator.update(gnss(), log[k].fix).rejected;
      (void)navigator.update(Compass(), of(log[k].compass));
      const Vec2 told = is_wrong ? wrong : log[k].velocity;
      if constexpr (kStatesOf<TypeParam> == 7) {
        EXPECT_EQ(navigator.update(GroundVelocityInCurrent(), told).rejected, is_wrong) << k;
      } else {
        EXPECT_EQ(navigator.update(GroundVelocity(), told).rejected, is_wrong) << k;
      }
      const Vec2 position = navigator.estimate().mean.template head<2>();
      if (k < 50) continue;
      EXPECT_LT((position - log[k].position).norm(), 8) << k;
    }
    EXPECT_LE(rejected_fixes, 2);
  }
}

/// Fixes that are `off` from the truth for so many steps.
template <class Navigator>
void expect_absurd_readings_to_do_nothing(const std::vector<Instant>& log, double off, int steps) {
  using Scalar = typename Navigator::Scalar;
  using Pair = Vec<Scalar, 2>;
  Navigator navigator;
  ASSERT_EQ(navigator.start(start_of(log.front())), Status::kOk);
  const auto outcome = [](const auto& reading) {
    return reading.status == (reading.rejected ? Status::kGated : Status::kOk);
  };
  const int first = 100, last = first + steps;
  for (int k = 1; k < last + 100; ++k) {
    const Instant& now = log[std::size_t(k)];
    ASSERT_EQ(navigator.predict(Scalar(1), now.imu), Status::kOk) << off << " " << k;
    const auto before = navigator.estimate();
    const bool is_implausible = k >= first && k < last;
    const Vec2 outlier = is_implausible ? Vec2(off, -off / 2) : Vec2(0, 0);
    const auto fixed = navigator.update(gnss(), Pair((now.fix + outlier).cast<Scalar>()));
    if (is_implausible) {
      EXPECT_TRUE(fixed.rejected) << off << " " << k;
      EXPECT_GT(fixed.nis, 1e5) << off << " " << k;
      EXPECT_TRUE(test::matrices_identical(navigator.estimate().mean, before.mean));
      EXPECT_TRUE(test::matrices_identical(navigator.estimate().covariance, before.covariance));
    }
    ASSERT_TRUE(outcome(fixed)) << off << " " << k << ": " << to_string(fixed.status);
    const auto turned = navigator.update(Compass(), Vec<Scalar, 1>(Scalar(now.compass)));
    ASSERT_TRUE(outcome(turned)) << off << " " << k << ": " << to_string(turned.status);
  }
  const Vec2 error = navigator.estimate().mean.template head<2>().template cast<double>() -
                     log[std::size_t(last + 99)].position;
  EXPECT_LT(error.norm(), 20) << off;
}

TYPED_TEST(EveryUsvModel, RejectsHeadingsWithoutADigit) {
  const std::vector<Instant> log = mission(18, kNoBias);
  UsvNavigator<TypeParam> navigator;
  navigate(navigator, log);
  const auto before = navigator.estimate();
  for (const double heading_rad : {1e17, -1e30, 1e160, 1.7e308}) {
    const auto reading = navigator.update(Compass(), of(heading_rad));
    EXPECT_TRUE(reading.rejected) << heading_rad;
    EXPECT_EQ(reading.nis, std::numeric_limits<double>::infinity()) << heading_rad;
  }
  EXPECT_TRUE(test::matrices_identical(navigator.estimate().mean, before.mean));
  EXPECT_TRUE(test::matrices_identical(navigator.estimate().covariance, before.covariance));
  EXPECT_TRUE(navigator.update(Compass(), of(log.back().compass + 200 * kPi<double>)));
}

// What is too far for the square of a number, and what is not, but leaves it no digits.
TYPED_TEST(EveryUsvModel, IsNotMovedByAbsurdReadingsHoweverOftenTheyCome) {
  const std::vector<Instant> log = mission(17, kStatesOf<TypeParam> == 5 ? kNoBias : kBias);
  for (const double off : {1e9, 1e12, 1e30, 1e80, 1e154, 1e160, 1e300, 1.7e308})
    for (const int steps : {1, 15}) {
      expect_absurd_readings_to_do_nothing<UsvNavigator<TypeParam, Ekf>>(log, off, steps);
      expect_absurd_readings_to_do_nothing<UsvNavigator<TypeParam, Ukf>>(log, off, steps);
      expect_absurd_readings_to_do_nothing<UsvNavigator<TypeParam, AugmentedUkf>>(log, off, steps);
    }
  for (const double off : {1e6, 1e12, 1e20, 1e38})
    expect_absurd_readings_to_do_nothing<UsvNavigator<TypeParam, Ekf, float>>(log, off, 15);
}

TYPED_TEST(EveryUsvModel, FindsACurrentThatChangedWhileItCoasted) {
  constexpr std::size_t kChange = 300, kBack = 580, kRuns = 10;
  const Vec2 change(0.4, -0.6);
  double nees = 0;
  for (std::size_t run = 0; run < kRuns; ++run) {
    std::vector<Instant> log = mission(500 + run, kStatesOf<TypeParam> == 5 ? kNoBias : kBias);
    for (std::size_t k = kChange; k < log.size(); ++k) {
      log[k].position += change * double(k - kChange);
      log[k].fix += change * double(k - kChange);
    }
    UsvNavigator<TypeParam> navigator;
    ASSERT_EQ(navigator.start(start_of(log.front())), Status::kOk);
    int rejected = 0;
    for (std::size_t k = 1; k < kBack + 60; ++k) {
      ASSERT_EQ(navigator.predict(1.0, log[k].imu), Status::kOk);
      (void)navigator.update(Compass(), of(log[k].compass));
      if (k >= kChange && k < kBack) continue;
      rejected += navigator.update(gnss(), log[k].fix).rejected;
      if (k < kBack + 20) continue;
      const auto& belief = navigator.estimate();
      const Vec2 error = belief.mean.template head<2>() - log[k].position;
      nees += Cholesky<2>(belief.covariance.template topLeftCorner<2, 2>()).squared_norm(error) /
              (40 * kRuns);
    }
    EXPECT_LE(rejected, UsvOutliers{}.rejections + 3) << "run " << run;
  }
  EXPECT_LT(nees, 4) << "of 2: it owns up to what it has learned anew";
}

TYPED_TEST(EveryUsvModel, CrossesNorthAndSouthTheSameWay) {
  constexpr int kRow = index_of(TypeParam::kComponents, kHeading);
  for (const double middle : {0.0, kPi<double>}) {
    UsvNavigator<TypeParam> navigator;
    ASSERT_EQ(navigator.start({.velocity_mps = {1, 0}, .heading_rad = middle - deg(20)}),
              Status::kOk);
    for (int k = 1; k <= 40; ++k) {
      ASSERT_EQ(navigator.predict(1.0, {.yaw_rate_rad_s = deg(1)}), Status::kOk);
      const double truth = middle + deg(k - 20);
      // The compass counts from 0 to 360 degrees, and once a turn further.
      const double z = k % 2 ? compass_angle(truth) : truth + 2 * kPi<double>;
      const auto step = navigator.update(Compass(), of(z));
      ASSERT_TRUE(step);
      EXPECT_NEAR(step.innovation[0], 0, deg(0.01));
      const double heading = navigator.estimate().mean[kRow];
      EXPECT_LE(std::abs(heading), kPi<double>);
      EXPECT_NEAR(wrap_angle(heading - truth), 0, deg(0.01));
    }
  }
}

// Circles with biases and without one reading: the smoother does not mind where the heading wraps.
TYPED_TEST(EveryUsvModel, SmoothsAcrossTheSeam) {
  constexpr int kRow = index_of(TypeParam::kComponents, kHeading);
  UsvNavigator<TypeParam> navigator;
  ASSERT_EQ(navigator.start({.velocity_mps = {1, 0}}), Status::kOk);
  std::vector beliefs{navigator.estimate()};
  std::vector<UsvLeg<>> legs;
  for (int k = 1; k <= 150; ++k) {
    legs.push_back(navigator.leg(1.0, {0, deg(5), deg(5)}));
    ASSERT_EQ(navigator.predict(legs.back()), Status::kOk);
    ASSERT_TRUE(navigator.update(Compass(), of(deg(5) * k)));
    beliefs.push_back(navigator.estimate());
  }
  const auto filtered = beliefs;
  ASSERT_EQ(navigator.smooth(beliefs, legs), Status::kOk);
  for (std::size_t k = 0; k < beliefs.size(); ++k) {
    EXPECT_NEAR(wrap_angle(beliefs[k].mean[kRow] - deg(5) * double(k)), 0, deg(0.05)) << k;
    EXPECT_LE(std::abs(beliefs[k].mean[kRow]), kPi<double>);
    EXPECT_LE(beliefs[k].covariance(kRow, kRow), filtered[k].covariance(kRow, kRow) * (1 + 1e-9));
    EXPECT_TRUE(is_covariance(beliefs[k].covariance));
  }
}

TYPED_TEST(EveryUsvModel, TouchesNoHeap) {
  UsvNavigator<TypeParam, Ekf> ekf;
  UsvNavigator<TypeParam, Ukf> ukf;
  UsvNavigator<TypeParam, AugmentedUkf> augmented;
  std::array<typename UsvNavigator<TypeParam>::State, 3> beliefs;
  const std::array legs{ekf.leg(1.0, {}), ekf.leg(2.0)};
  const auto drive = [](auto& navigator) {
    bool fine = navigator.start({.heading_rad = 3.1}) == Status::kOk;
    for (int k = 0; k < 12; ++k) {
      fine &= navigator.predict(1.0, {0, 0, 0.1}) == Status::kOk;
      fine &= navigator.predict(1.0) == Status::kOk;
      (void)navigator.update(gnss(), Vec2(k < 11 ? 1e4 : 0, 0));
      (void)navigator.update(Compass(), of(-3.1));
    }
    return fine;
  };
  const test::NoHeap fence;
  const bool fine =
      drive(ekf) && drive(ukf) && drive(augmented) && ekf.smooth(beliefs, legs) == Status::kOk;
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_TRUE(fine);
}

TYPED_TEST(EveryUsvModel, RejectsBadInputAndStaysUnchanged) {
  UsvNavigator<TypeParam> navigator;
  EXPECT_EQ(navigator.predict(1.0, {}), Status::kNotStarted);
  EXPECT_EQ(navigator.update(Compass(), of(0)).status, Status::kNotStarted);
  EXPECT_EQ(navigator.start({.heading_rad = kNan}), Status::kNotFinite);
  ASSERT_EQ(navigator.start({.velocity_mps = {1, 0}}), Status::kOk);
  const auto before = navigator.estimate();
  EXPECT_EQ(navigator.predict(-1.0, {}), Status::kNegativeTimeStep);
  EXPECT_EQ(navigator.predict(kNan, {}), Status::kNotFinite);
  EXPECT_EQ(navigator.predict(1.0, {kNan, kNan, kNan}), Status::kNotFinite);
  EXPECT_EQ(navigator.update(gnss(), Vec2(kNan, 0)).status, Status::kNotFinite);
  EXPECT_EQ(navigator.update(Compass(), of(kNan)).status, Status::kNotFinite);
  EXPECT_TRUE(test::matrices_identical(navigator.estimate().mean, before.mean));
  EXPECT_TRUE(test::matrices_identical(navigator.estimate().covariance, before.covariance));
  EXPECT_THROW(UsvNavigator<TypeParam>(TypeParam{}, UsvOutliers{.gate = {1.0}}),
               std::invalid_argument);
  EXPECT_THROW(UsvNavigator<TypeParam>(TypeParam{}, UsvOutliers{.rejections = -1}),
               std::invalid_argument);
  EXPECT_THROW(UsvNavigator<TypeParam>(TypeParam{}, {}, ImuNoise{-1, 0}), std::invalid_argument);
}

TYPED_TEST(EveryUsvModel, ContinuesFromAnArchive) {
  const std::vector<Instant> log = mission(16, kNoBias);
  UsvNavigator<TypeParam> one, two;
  navigate(one, log);
  (void)one.update(gnss(), Vec2(1e4, 1e4));
  Archive saved;
  one.archive(saved);
  Archive loaded{saved.bytes()};
  two.archive(loaded);
  ASSERT_TRUE(loaded.ok() && loaded.at_end());
  for (int k = 0; k < 12; ++k) {
    const auto a = one.update(gnss(), Vec2(1e4, 1e4)), b = two.update(gnss(), Vec2(1e4, 1e4));
    EXPECT_EQ(a.widened, b.widened);
  }
  EXPECT_TRUE(test::matrices_identical(one.estimate().mean, two.estimate().mean));
}

// Sensors -----------------------------------------------------------------------------------------

TEST(UsvSensors, VelocityInACurrentHasTheJacobianOfItsMeasurement) {
  const GroundVelocityInCurrent sensor;
  const Vec<double, 4> x(0.3, -0.2, 4, 2);
  const auto numeric =
      test::numeric_jacobian([&](const Vec<double, 4>& at) { return sensor.measure(at); }, x);
  EXPECT_TRUE(matrices_near(sensor.jacobian(x), numeric, {1e-8, 1e-8}));
}

TEST(UsvSensors, LogAndVelocityObserveTheCurrent) {
  UsvNavigator<UsvCurrentMotion> navigator;
  ASSERT_EQ(navigator.start({.velocity_mps = {3, 0}}), Status::kOk);
  for (int k = 0; k < 60; ++k) {
    ASSERT_EQ(navigator.predict(1.0, {}), Status::kOk);
    EXPECT_TRUE(navigator.update(SpeedLog(0.05), of(3.2)));
    EXPECT_TRUE(navigator.update(GroundVelocityInCurrent(0.05), Vec2(3.0, 0.4)));
    EXPECT_TRUE(navigator.update(Compass(), of(0)));
  }
  EXPECT_TRUE(matrices_near(navigator.estimate().mean.tail<2>(), Vec2(-0.2, 0.4), {0.02, 0}));
}

TEST(UsvSensors, RateOfTurnObservesTheBiasOfTheGyro) {
  UsvNavigator<UsvBiasMotion> navigator;
  ASSERT_EQ(navigator.start(UsvStart{}), Status::kOk);
  for (int k = 0; k < 30; ++k) {
    const double turn = deg(k % 4), gyro = turn + deg(0.3);
    ASSERT_EQ(navigator.predict(1.0, {.yaw_rate_rad_s = gyro}), Status::kOk);
    EXPECT_TRUE(navigator.update(RateOfTurn{.gyro_rad_s = gyro}, of(turn)));
  }
  EXPECT_NEAR(navigator.estimate().mean[7], deg(0.3), deg(0.01));
}

TEST(UsvSensors, ARateOfTurnThatHeadingsRefuteIsNotTheBiasOfTheGyro) {
  UsvNavigator<UsvBiasMotion> navigator;
  ASSERT_EQ(navigator.start(UsvStart{}), Status::kOk);
  for (int k = 0; k < 60; ++k) {
    ASSERT_EQ(navigator.predict(1.0, {}), Status::kOk);
    ASSERT_TRUE(navigator.update(Compass(), of(0))) << k;
    const bool is_wrong = k >= 20 && k < 50;
    EXPECT_EQ(navigator.update(RateOfTurn{}, of(is_wrong ? deg(10) : 0)).rejected, is_wrong) << k;
  }
  EXPECT_NEAR(navigator.estimate().mean[7], 0, deg(0.05));
}

TEST(UsvSensors, GroundVelocityTightensTheVelocity) {
  UsvNavigator<UsvBiasMotion> navigator;
  ASSERT_EQ(navigator.start(UsvStart{}), Status::kOk);
  ASSERT_TRUE(navigator.update(GroundVelocity(0.1), Vec2(0.5, -0.5)));
  EXPECT_LT(std::sqrt(navigator.estimate().covariance(2, 2)), 0.1);
  EXPECT_NEAR(navigator.estimate().mean[3], -0.5, 0.05);
}

TEST(UsvSensors, RejectInvalidStandardDeviations) {
  EXPECT_THROW(Compass(0).validate(), std::invalid_argument);
  EXPECT_THROW(SpeedLog(-1).validate(), std::invalid_argument);
  EXPECT_THROW(GroundVelocity(kNan).validate(), std::invalid_argument);
  EXPECT_THROW(GroundVelocityInCurrent(0).validate(), std::invalid_argument);
  EXPECT_THROW((RateOfTurn{.rate_std_rad_s = 0}.validate()), std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::usv_navigator_test
