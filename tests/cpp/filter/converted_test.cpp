// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Estimates from converted plots: neither too far out nor over-confident where bearings are coarse.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/draw.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/constant_velocity.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::converted_test {
namespace {

using test::Draw;

constexpr double kPeriod_s = 3.0, kPsd_m2s3 = 0.01;
constexpr int kRuns = 500, kScans = 90, kSettled = 30;

/// Error of the range (mean and standard deviation) and NEES of the position, over runs and scans.
struct Score {
  double mean_m = 0.0, std_m = 0.0, nees = 0.0;
  [[nodiscard]] double outwards() const { return mean_m / std_m; }
};

enum class Start { kOnePlot, kTwoPlots };

/// Vessels that move by the model of the filter, about a range.
template <class Estimator>
Score score(const Estimator& prototype, const ConvertedRangeBearing& radar, double range_m,
            double psd_m2s3 = kPsd_m2s3, Start start = Start::kOnePlot, int from_scan = kSettled) {
  Draw draw(5);
  const ConstantVelocity motion{WhiteAcceleration{psd_m2s3}};
  const Mat<double, 4, 4> f = motion.matrix(kPeriod_s);
  const Mat<double, 4, 4> root =
      Cholesky<4>(Mat<double, 4, 4>(motion.process_noise(kPeriod_s))).lower();
  const RangeBearing polar{};
  double sum = 0.0, squares = 0.0, nees = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const Vec<double, 2> u = towards(draw.uniform(-3.0, 3.0));
    const Vec<double, 2> v = 8.0 * towards(draw.uniform(-3.0, 3.0));
    Vec<double, 4> x(range_m * u[0], v[0], range_m * u[1], v[1]);
    Estimator estimator = prototype;
    Vec<double, 2> before;
    for (int k = 0; k < kScans; ++k) {
      if (k > 0) {
        Vec<double, 4> noise;
        for (double& element : noise) element = draw.normal();
        x = Vec<double, 4>(f * x + root * noise);
      }
      const Vec<double, 2> place(x[0], x[2]), exact = polar.measure(place);
      const Vec<double, 2> z(exact[0] + radar.range_std_m * draw.normal(),
                             exact[1] + radar.bearing_std_rad * draw.normal());
      const Vec<double, 2> last = before;
      before = z;
      if (k == 0) {
        EXPECT_EQ(estimator.start(one_point(radar, z, 10.0)), Status::kOk);
        continue;
      }
      if (k == 1 && start == Start::kTwoPlots) {
        EXPECT_EQ(estimator.start(two_point(radar, last, z, kPeriod_s)), Status::kOk);
        continue;
      }
      EXPECT_EQ(estimator.predict(kPeriod_s), Status::kOk);
      EXPECT_EQ(estimator.update(radar, z).status, Status::kOk);
      if (k < from_scan) continue;
      const Gaussian<4> belief = estimator.estimate();
      const Vec<double, 2> found(belief.mean[0], belief.mean[2]);
      const double outwards_m = found.norm() - place.norm();
      sum += outwards_m;
      squares += outwards_m * outwards_m;
      Mat<double, 2, 2> p;
      p << belief.covariance(0, 0), belief.covariance(0, 2), belief.covariance(2, 0),
          belief.covariance(2, 2);
      nees += Cholesky<2>(p).squared_norm(Vec<double, 2>(found - place));
    }
  }
  const int count = kRuns * (kScans - from_scan);
  const double mean_m = sum / count;
  return {mean_m, std::sqrt(squares / count - mean_m * mean_m), nees / count};
}

struct Case {
  double range_m, bearing_std_deg;
};
constexpr Case kCases[] = {{3e3, 2.0}, {12e3, 2.0}, {24e3, 1.0}, {24e3, 3.0}, {48e3, 3.0}};

template <class Estimator>
void expect_consistent(const Estimator& estimator) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(testing::Message() << c.range_m << " m, " << c.bearing_std_deg << " deg");
    const Score of =
        score(estimator,
              ConvertedRangeBearing{.range_std_m = 10.0, .bearing_std_rad = deg(c.bearing_std_deg)},
              c.range_m);
    EXPECT_LT(std::abs(of.outwards()), 0.15);
    EXPECT_NEAR(of.nees, 2.0, 0.2);
  }
}

using Cv = ConstantVelocity;

TEST(ConvertedPlots, LeaveKalmanUnbiasedAndConsistent) {
  expect_consistent(Kalman(Cv{WhiteAcceleration{kPsd_m2s3}}));
}

TEST(ConvertedPlots, LeaveUkfUnbiasedAndConsistent) {
  expect_consistent(Ukf(Cv{WhiteAcceleration{kPsd_m2s3}}));
}

TEST(ConvertedPlots, LeaveImmUnbiasedAndConsistent) {
  const auto filter = [](double factor) {
    return Kalman(Cv{WhiteAcceleration{factor * kPsd_m2s3}});
  };
  expect_consistent(Imm(ModeChain<2>::from_sojourn_s({60.0, 60.0}), filter(0.7), filter(1.4)));
}

// Two plots leave the velocity across the line of sight open: what is wrong with the start stays
// for as many scans as the filter remembers.
TEST(ConvertedPlots, LeaveKalmanUnbiasedFromTwoPlotsOn) {
  constexpr double kSlow_m2s3 = 0.002;
  constexpr int kEarly = 15;
  for (const Case& c : {Case{24e3, 3.0}, Case{48e3, 2.0}, Case{48e3, 3.0}}) {
    SCOPED_TRACE(testing::Message() << c.range_m << " m, " << c.bearing_std_deg << " deg");
    const ConvertedRangeBearing radar{.bearing_std_rad = deg(c.bearing_std_deg)};
    const Score of = score(Kalman(Cv{WhiteAcceleration{kSlow_m2s3}}), radar, c.range_m, kSlow_m2s3,
                           Start::kTwoPlots, kEarly);
    EXPECT_LT(std::abs(of.outwards()), 0.12);
    EXPECT_LT(of.nees, 2.3);
  }
}

// What the papers do: as read, and so too far out.
TEST(ConvertedPlots, AreTooFarOutByTheBearingAsRead) {
  const ConvertedRangeBearing plain{
      .range_std_m = 10.0, .bearing_std_rad = deg(2.0), .unbiased = false};
  const Score of = score(Kalman(Cv{WhiteAcceleration{kPsd_m2s3}}), plain, 12e3);
  EXPECT_GT(of.outwards(), 0.5);
  EXPECT_GT(of.nees, 2.5);
}

// A prediction that knows the direction less well than the plot says nothing of its errors: the
// plot starts the estimate anew.
TEST(ConvertedPlots, AreTakenAsReadBesideAVaguePrediction) {
  const ConvertedRangeBearing radar{.bearing_std_rad = deg(1.0)};
  const Vec<double, 2> z(20e3, 0.4);
  const Gaussian<2> read = radar.observe(z);
  const Gaussian<2> vague{{1000.0, 0.0}, 1e9 * Mat<double, 2, 2>::Identity()};
  const Gaussian<2> taken = radar.at_prediction(read, vague);
  EXPECT_LT((taken.mean - radar.start_position(z).mean).norm(), 1e-9);
  EXPECT_EQ(taken.covariance, read.covariance);
}

// An estimate has the mean of its range right where that of its position is r s²/2 further out
// than its target's, with the standard deviation s of its direction after the update.
TEST(ConvertedPlots, AreMovedOutwardsByTheDirectionThatIsLeft) {
  const ConvertedRangeBearing radar{.bearing_std_rad = deg(2.0)};
  const double range_m = 30e3, plot_rad2 = radar.bearing_std_rad * radar.bearing_std_rad;
  const Vec<double, 2> u = towards(2.0), across(-u[1], u[0]);
  const Gaussian<2> read = radar.observe(Vec<double, 2>(range_m, 2.0));
  for (const double ratio : {1e-3, 0.3, 1.0, 3.0}) {
    const double s2 = ratio * plot_rad2, left_rad2 = 1.0 / (1.0 / s2 + 1.0 / plot_rad2);
    const Gaussian<2> target{range_m * u, range_m * range_m * s2 * across * across.transpose() +
                                              100.0 * u * u.transpose()};
    const Gaussian<2> taken = radar.at_prediction(read, target);
    EXPECT_NEAR(u.dot(taken.mean - read.mean), range_m * left_rad2 / 2.0,
                0.02 * range_m * left_rad2);
    EXPECT_NEAR(across.dot(taken.mean - read.mean), 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace wakeline::converted_test
