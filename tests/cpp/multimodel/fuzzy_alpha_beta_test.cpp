// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/multimodel/fuzzy_alpha_beta.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/eval/consistency.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing_doppler.hpp"

namespace wakeline::fuzzy_alpha_beta_test {
namespace {

using test::beliefs_identical;
using test::Draw;
using test::matrices_near;

using Fuzzy = FuzzyAlphaBeta<>;
constexpr double kPeriod_s = 3.0;
const Position kSensor{.position_std_m = 5.0};

double output(const FuzzyCriterion& criterion, std::vector<double> ratios) {
  std::vector<double> strengths(ratios.size() + 1);
  return criterion.evaluate(ratios, strengths);
}

FuzzyCriterion minimum() { return {.t_norm = TNorm::kMinimum}; }

TEST(FuzzyCriterion, GivesTheValuesOfTheSource) {
  const std::vector<double> rising{.5, .5, .5, 1, 1.5, 2, 2.5, 3, 3};
  EXPECT_NEAR(output({}, rising), 5.499994, 1e-6);
  EXPECT_NEAR(output(minimum(), rising), 5.464032, 1e-6);
  EXPECT_NEAR(output({}, std::vector<double>(9, 1.5)), 5.6, 1e-12);
  EXPECT_NEAR(output({}, std::vector<double>(9, 0.0)), 9.999447, 1e-6);
  EXPECT_NEAR(output(minimum(), std::vector<double>(9, 0.0)), 9.975785, 1e-6);
  EXPECT_NEAR(output({}, std::vector<double>(9, 3.0)), 2.0, 1e-6);
  EXPECT_NEAR(output(minimum(), std::vector<double>(9, 3.0)), 2.019812, 1e-6);
}

TEST(FuzzyCriterion, EveryRuleGivesItsOutput) {
  Draw draw(21);
  for (const FuzzyCriterion& criterion : {FuzzyCriterion{}, minimum()})
    for (int trial = 0; trial < 200; ++trial) {
      std::vector<double> ratios(std::size_t(1 + trial % 15));
      for (double& ratio : ratios) ratio = draw.uniform(0, 3);
      std::vector<double> strengths(ratios.size() + 1);
      const double m = criterion.evaluate(ratios, strengths);
      double sum = 0.0, total = 0.0;
      for (std::size_t p = 0; p <= ratios.size(); ++p) {
        double strength = 1.0;
        for (std::size_t k = 0; k < ratios.size(); ++k) {
          const double bad = 1 / (1 + std::exp(-5 * (ratios[k] - 1.5)));
          strength = criterion.both(strength, k < p ? 1 - bad : bad);
        }
        EXPECT_NEAR(strengths[p], strength, 1e-12);
        total += strength;
        sum += strength * double(std::max<std::size_t>(2, p + 1));
      }
      EXPECT_NEAR(m, sum / total, 1e-9);
    }
}

TEST(FuzzyCriterion, WorseTrackingNeverLengthensTheLine) {
  Draw draw(22);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> ratios(9);
    for (double& ratio : ratios) ratio = draw.uniform(0, 3);
    const double before = output({}, ratios);
    ratios[std::size_t(trial % 9)] += 0.3;
    EXPECT_LE(output({}, ratios), before + 1e-12);
  }
}

TEST(FuzzyCriterion, RejectsInvalidParameters) {
  EXPECT_THROW(Fuzzy({.max_plots = 1}), std::invalid_argument);
  EXPECT_THROW(Fuzzy({.max_plots = 17}), std::invalid_argument);
  EXPECT_THROW(Fuzzy({.steepness = 0.0}), std::invalid_argument);
  EXPECT_THROW(Fuzzy({.steepness = 50.0}), std::invalid_argument);
  EXPECT_THROW(Fuzzy({.threshold = 3.5}), std::invalid_argument);
  EXPECT_THROW(Fuzzy({.clip = NAN}), std::invalid_argument);
  EXPECT_THROW(Fuzzy({.acceleration_std_mps2 = -1.0}), std::invalid_argument);
}

/// The method in the plainest words, over a list of plots.
class Reference {
 public:
  explicit Reference(const FuzzyCriterion& criterion) : criterion_(criterion) {}

  void plot(double time_s, const Vec<double, 2>& z) {
    std::vector<double> residuals;
    for (int n = 2; n <= std::min(int(plots_.size()), criterion_.max_plots); ++n)
      residuals.push_back((z - at(time_s, n).head<2>()).norm());
    if (!residuals.empty()) {
      sum_ += residuals[0];
      sigma_hat = sum_ / ++count_;
      std::vector<double> ratios;
      for (const double residual : residuals) ratios.push_back(std::min(residual / sigma_hat, 3.0));
      const double m = output(criterion_, ratios);
      const double held = criterion_.hold && count_ > 1 ? std::max(m, quality) : m;
      quality = m;
      chosen = int(std::nearbyint(held));
    }
    times_.push_back(time_s);
    plots_.push_back(z);
  }

  /// [north, east, vnorth, veast] of the line through the last n plots.
  Vec<double, 4> at(double time_s, int n) const {
    const std::size_t first = plots_.size() - std::size_t(n);
    double t = 0, tt = 0;
    Vec<double, 2> p(0, 0), tp(0, 0);
    for (std::size_t k = first; k < plots_.size(); ++k) {
      const double s = times_[k] - times_[first];
      t += s, tt += s * s, p += plots_[k], tp += s * plots_[k];
    }
    const Vec<double, 2> slope = (n * tp - t * p) / (n * tt - t * t);
    Vec<double, 4> x;
    x << (p - slope * t) / n + slope * (time_s - times_[first]), slope;
    return x;
  }

  double quality = NAN, sigma_hat = NAN;
  int chosen = 2;

 private:
  FuzzyCriterion criterion_;
  std::vector<double> times_;
  std::vector<Vec<double, 2>> plots_;
  double sum_ = 0.0;
  int count_ = 0;
};

/// Straight, then a turn to starboard, then straight.
Vec<double, 2> weaving(double time_s) {
  constexpr double kSpeed = 12.0, kRate = 0.04, kBegin = 90.0, kEnd = 150.0;
  const double turned = std::clamp(time_s - kBegin, 0.0, kEnd - kBegin);
  const double before = std::min(time_s, kBegin), after = std::max(time_s - kEnd, 0.0);
  const double course = kRate * turned;
  return kSpeed * Vec<double, 2>(before + std::sin(course) / kRate + after * std::cos(course),
                                 (1 - std::cos(course)) / kRate + after * std::sin(course));
}

TEST(FuzzyAlphaBeta, IsTheMethodInPlainWords) {
  for (const FuzzyCriterion& criterion :
       {FuzzyCriterion{}, FuzzyCriterion{.max_plots = 6, .t_norm = TNorm::kMinimum},
        FuzzyCriterion{.hold = false}}) {
    Draw draw(31);
    Fuzzy fuzzy(criterion);
    Reference reference(criterion);
    ASSERT_EQ(fuzzy.start(test::five_km_off<double>()), Status::kOk);
    double time_s = 0.0;
    for (int scan = 0; scan < 80; ++scan) {
      const double dt = draw.uniform(2, 4);
      time_s += dt;
      ASSERT_EQ(fuzzy.predict(dt), Status::kOk);
      if (scan % 9 == 5) continue;  // missed
      const Vec<double, 2> z = weaving(time_s) + 5.0 * draw.normals<2>();
      ASSERT_TRUE(fuzzy.update(kSensor, z));
      reference.plot(time_s, z);
      if (scan < 1) continue;
      ASSERT_EQ(fuzzy.chosen(), reference.chosen) << scan;
      const Vec<double, 4> x = reference.at(time_s, reference.chosen);
      EXPECT_TRUE(matrices_near(fuzzy.estimate().mean, Vec<double, 4>(x[0], x[2], x[1], x[3]),
                                {.absolute = 1e-6, .relative = 1e-9}));
      EXPECT_EQ(fuzzy.mode_probability()[reference.chosen - 2], 1.0);
      EXPECT_EQ(fuzzy.mode_probability().sum(), 1.0);
      if (scan < 2) continue;
      EXPECT_NEAR(fuzzy.quality(), reference.quality, 1e-9);
      EXPECT_NEAR(fuzzy.sigma_hat_m(), reference.sigma_hat, 1e-9);
    }
    EXPECT_EQ(fuzzy.mode_probability().size(), criterion.max_plots - 1);
  }
}

TEST(FuzzyAlphaBeta, RepeatedPlotsAreEvaluatedOnce) {
  Draw draw(35);
  Fuzzy once, twice;
  ASSERT_EQ(once.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(twice.start(test::five_km_off<double>()), Status::kOk);
  for (int scan = 1; scan < 80; ++scan) {
    const Vec<double, 2> z = weaving(3.0 * scan) + 5.0 * draw.normals<2>();
    for (Fuzzy* fuzzy : {&once, &twice}) {
      ASSERT_EQ(fuzzy->predict(3.0), Status::kOk);
      ASSERT_TRUE(fuzzy->update(kSensor, z));
    }
    ASSERT_EQ(twice.predict(0.0), Status::kOk);
    ASSERT_TRUE(twice.update(kSensor, z));
    if (scan < 2) continue;
    EXPECT_EQ(twice.chosen(), once.chosen()) << scan;
    EXPECT_TRUE(test::matrices_identical(twice.estimate().mean, once.estimate().mean)) << scan;
    if (scan < 3) continue;
    EXPECT_EQ(twice.quality(), once.quality()) << scan;
    EXPECT_EQ(twice.sigma_hat_m(), once.sigma_hat_m()) << scan;
  }
}

TEST(FuzzyAlphaBeta, IsLongOnAStraightAndShortInATurn) {
  Draw draw(32);
  Fuzzy fuzzy;
  ASSERT_EQ(fuzzy.start(test::five_km_off<double>()), Status::kOk);
  double straight = 0.0, turn = 0.0;
  for (int scan = 1; scan <= 50; ++scan) {
    ASSERT_EQ(fuzzy.predict(kPeriod_s), Status::kOk);
    ASSERT_TRUE(fuzzy.update(kSensor, weaving(kPeriod_s * scan) + 3.0 * draw.normals<2>()));
    if (scan > 15 && scan <= 29) straight += fuzzy.quality() / 14;
    if (scan > 34 && scan <= 49) turn += fuzzy.quality() / 15;
  }
  EXPECT_GT(straight, 7.0);
  EXPECT_LT(turn, 6.0);
}

TEST(FuzzyAlphaBeta, ExactPlotsOfAStraightGiveItExactly) {
  Fuzzy fuzzy;
  ASSERT_EQ(fuzzy.start(test::five_km_off<double>()), Status::kOk);
  for (int scan = 0; scan < 20; ++scan) {
    ASSERT_EQ(fuzzy.predict(2.0), Status::kOk);
    ASSERT_TRUE(fuzzy.update(kSensor, Vec<double, 2>(8.0 * scan, 100.0 - 4.0 * scan)));
  }
  EXPECT_TRUE(matrices_near(fuzzy.estimate().mean, Vec<double, 4>(152, 4, 24, -2), {1e-9, 1e-12}));
}

TEST(FuzzyAlphaBeta, KeepsTheBeliefAsAKalmanFilterUntilThereAreTwoPlots) {
  Fuzzy fuzzy;
  Ekf<ConstantVelocity> kalman(ConstantVelocity{PiecewiseAcceleration{0.5}});
  ASSERT_EQ(fuzzy.start(test::five_km_off<double>()), Status::kOk);
  ASSERT_EQ(kalman.start(test::five_km_off<double>()), Status::kOk);
  const Vec<double, 2> z(2995, 4010);
  for (int k = 0; k < 2; ++k) {
    ASSERT_EQ(fuzzy.predict(3.0), Status::kOk);
    ASSERT_EQ(kalman.predict(3.0), Status::kOk);
    ASSERT_TRUE(beliefs_identical<4>(fuzzy.estimate(), kalman.estimate()));
    if (k > 0) break;
    const auto step = fuzzy.update(kSensor, z), wanted = kalman.update(kSensor, z);
    EXPECT_NEAR(step.nis, wanted.nis, 1e-12);
    EXPECT_NEAR(step.log_likelihood, wanted.log_likelihood, 1e-12);
    ASSERT_TRUE(beliefs_identical<4>(fuzzy.estimate(), kalman.estimate()));
  }
  EXPECT_TRUE(std::isnan(fuzzy.quality()));
  EXPECT_TRUE(std::isnan(fuzzy.sigma_hat_m()));
  ASSERT_TRUE(fuzzy.update(kSensor, Vec<double, 2>(2983, 4031)));
  EXPECT_TRUE(matrices_near(fuzzy.estimate().mean, Vec<double, 4>(2983, -4, 4031, 7)));
}

TEST(FuzzyAlphaBeta, ErrorsOfAFixedLineAreThoseItClaims) {
  ConsistencyAverage nees_average(4), nis_average(2);
  for (int run = 0; run < 600; ++run) {
    Draw draw(std::uint64_t(700 + run));
    Fuzzy fuzzy({.max_plots = 2, .acceleration_std_mps2 = 0.0});
    ASSERT_EQ(fuzzy.start(test::five_km_off<double>()), Status::kOk);
    double nis = 0.0, time_s = 0.0;
    for (int scan = 0; scan < 6; ++scan) {
      const double dt = draw.uniform(1, 5);
      time_s += dt;
      ASSERT_EQ(fuzzy.predict(dt), Status::kOk);
      const Vec<double, 2> truth(9 * time_s, -5 * time_s);
      const auto step = fuzzy.update(kSensor, truth + 5.0 * draw.normals<2>());
      ASSERT_TRUE(step);
      nis = step.nis;
    }
    const Vec<double, 4> truth(9 * time_s, 9, -5 * time_s, -5);
    nees_average.add(nees<4, double>(fuzzy.estimate().mean - truth, fuzzy.estimate().covariance));
    nis_average.add(nis);
  }
  EXPECT_TRUE(nees_average.bounds(0.999).contains(nees_average.average()))
      << nees_average.average();
  EXPECT_TRUE(nis_average.bounds(0.999).contains(nis_average.average())) << nis_average.average();
}

Fuzzy on_a_straight(int scans, const FuzzyCriterion& criterion = {}) {
  Draw draw(41);
  Fuzzy fuzzy(criterion);
  (void)fuzzy.start(test::five_km_off<double>());
  for (int scan = 0; scan < scans; ++scan) {
    (void)fuzzy.predict(kPeriod_s);
    (void)fuzzy.update(kSensor, Vec<double, 2>(30.0 * scan, -9.0 * scan) + draw.normals<2>());
  }
  (void)fuzzy.predict(kPeriod_s);
  return fuzzy;
}

TEST(FuzzyAlphaBeta, AMissedScanWidensTheBelief) {
  Fuzzy fuzzy = on_a_straight(20);
  Mat<double, 4, 4> before = fuzzy.estimate().covariance;
  for (int scan = 0; scan < 5; ++scan) {
    ASSERT_EQ(fuzzy.predict(kPeriod_s), Status::kOk);
    EXPECT_TRUE(test::is_covariance(fuzzy.estimate().covariance));
    EXPECT_GT(fuzzy.estimate().covariance(0, 0), before(0, 0));
    before = fuzzy.estimate().covariance;
  }
}

TEST(FuzzyAlphaBeta, OneCertainReadingIsAnUpdate) {
  Fuzzy plain = on_a_straight(12), associated = plain;
  const Vec<double, 2> z(364, -101);
  const auto evidence = plain.evidence(kSensor, z);
  const auto step = plain.update(kSensor, z);
  ASSERT_TRUE(step);
  EXPECT_EQ(evidence.least_nis, step.nis);
  const std::array readings{Alternative<Position>{kSensor, z, 0.5}};
  std::array share{0.0};
  const double total = associated.update<Position>(readings, 0.0, share);
  EXPECT_DOUBLE_EQ(total, 0.5 * std::exp(step.log_likelihood));
  EXPECT_EQ(share[0], 1.0);
  EXPECT_TRUE(matrices_near(associated.estimate().mean, plain.estimate().mean, {1e-9, 1e-12}));
  EXPECT_TRUE(
      matrices_near(associated.estimate().covariance, plain.estimate().covariance, {1e-9, 1e-12}));
}

TEST(FuzzyAlphaBeta, ReadingsThatAreProbablyNotItsOwnAreAMissedScan) {
  Fuzzy fuzzy = on_a_straight(12);
  const auto before = fuzzy.estimate();
  const std::array readings{Alternative<Position>{kSensor, {900, 900}, 0.5},
                            Alternative<Position>{kSensor, {NAN, 0}, 0.5}};
  std::array share{7.0, 7.0};
  EXPECT_NEAR(fuzzy.update<Position>(readings, 0.3, share), 0.3, 1e-12);
  EXPECT_TRUE(beliefs_identical<4>(fuzzy.estimate(), before));
  EXPECT_LT(share[0], 1e-12);
  EXPECT_EQ(share[1], 0.0);
  EXPECT_EQ(fuzzy.update<Position>({}, 0.0, {}), 0.0);
}

TEST(FuzzyAlphaBeta, TwoEqualReadingsPullToTheirMiddle) {
  Fuzzy fuzzy = on_a_straight(12);
  const auto ahead = fuzzy.estimate();
  const Vec<double, 2> middle(ahead.mean[0], ahead.mean[2]), off(6, 2);
  Fuzzy wanted = fuzzy;
  const std::array readings{Alternative<Position>{kSensor, middle + off, 0.5},
                            Alternative<Position>{kSensor, middle - off, 0.5}};
  std::array share{0.0, 0.0};
  ASSERT_GT(fuzzy.update<Position>(readings, 1e-9, share), 0.0);
  EXPECT_NEAR(share[0], 0.5, 1e-5);
  ASSERT_TRUE(wanted.update(kSensor, middle));
  EXPECT_TRUE(matrices_near(fuzzy.estimate().mean, wanted.estimate().mean, {1e-6, 1e-9}));
  EXPECT_GT(fuzzy.estimate().covariance(0, 0), wanted.estimate().covariance(0, 0));
}

TEST(FuzzyAlphaBeta, TakesThePositionOutOfAnySensor) {
  Fuzzy fuzzy = on_a_straight(12), plain = fuzzy;
  const RangeBearingDoppler doppler;
  const Vec<double, 3> z(380.0, -0.27, 4.0);
  const auto step = fuzzy.update(doppler, z);
  const auto wanted = plain.update(RangeBearing{}, Vec<double, 2>(380.0, -0.27));
  ASSERT_TRUE(step && wanted);
  EXPECT_EQ(step.nis, wanted.nis);
  EXPECT_TRUE(beliefs_identical<4>(fuzzy.estimate(), plain.estimate()));
}

TEST(FuzzyAlphaBeta, KnownAccelerationShortensNoLine) {
  Draw draw(51);
  Fuzzy fuzzy;
  ASSERT_EQ(fuzzy.start(test::five_km_off<double>()), Status::kOk);
  const Vec<double, 2> u(0.8, -0.5);
  for (int scan = 1; scan <= 40; ++scan) {
    ASSERT_EQ(fuzzy.predict(kPeriod_s, u), Status::kOk);
    const double t = kPeriod_s * scan;
    ASSERT_TRUE(fuzzy.update(kSensor, t * t / 2 * u + 0.5 * draw.normals<2>()));
  }
  EXPECT_GT(fuzzy.quality(), 4.0);
  const Vec<double, 4> truth(7200 * 0.8, 120 * 0.8, 7200 * -0.5, 120 * -0.5);
  EXPECT_TRUE(matrices_near(fuzzy.estimate().mean, truth, {2.0, 0.0}));
}

TEST(FuzzyAlphaBeta, BadInputChangesNothing) {
  Fuzzy fuzzy;
  EXPECT_EQ(fuzzy.predict(1.0), Status::kNotStarted);
  EXPECT_EQ(fuzzy.update(kSensor, Vec<double, 2>(1, 2)).status, Status::kNotStarted);
  Gaussian<4> bad;
  bad.covariance(0, 0) = -1.0;
  EXPECT_EQ(fuzzy.start(bad), Status::kNotPositiveDefinite);
  EXPECT_FALSE(fuzzy.started());
  for (const int scans : {0, 1, 12}) {
    fuzzy = on_a_straight(scans);
    const auto before = fuzzy.estimate();
    EXPECT_EQ(fuzzy.predict(NAN), Status::kNotFinite);
    EXPECT_EQ(fuzzy.predict(-1.0), Status::kNegativeTimeStep);
    EXPECT_EQ(fuzzy.predict(1e200), Status::kNotFinite);
    EXPECT_EQ(fuzzy.predict(1.0, Vec<double, 2>(INFINITY, 0)), Status::kNotFinite);
    EXPECT_EQ(fuzzy.update(kSensor, Vec<double, 2>(NAN, 2)).status, Status::kNotFinite);
    EXPECT_EQ(fuzzy.start(bad), Status::kNotPositiveDefinite);
    EXPECT_TRUE(beliefs_identical<4>(fuzzy.estimate(), before));
    ASSERT_TRUE(fuzzy.update(kSensor, Vec<double, 2>(360, -108)));
    EXPECT_TRUE(is_finite(fuzzy.estimate().mean));
  }
}

TEST(FuzzyAlphaBeta, APlotWithoutASquareChangesNothing) {
  for (int power = 140; power <= 308; ++power) {
    Fuzzy fuzzy = on_a_straight(12);
    const Fuzzy before = fuzzy;
    if (const auto step = fuzzy.update(kSensor, Vec<double, 2>(std::pow(10.0, power), 0)); !step) {
      EXPECT_EQ(step.status, Status::kNotFinite) << power;
      EXPECT_TRUE(beliefs_identical<4>(fuzzy.estimate(), before.estimate())) << power;
      EXPECT_EQ(fuzzy.sigma_hat_m(), before.sigma_hat_m()) << power;
    }
    EXPECT_TRUE(std::isfinite(fuzzy.sigma_hat_m())) << power;
    EXPECT_EQ(fuzzy.mode_probability().sum(), 1.0) << power;
  }
}

TEST(FuzzyAlphaBeta, ArchiveRestoresEverythingAndRejectsOtherArchives) {
  for (const int scans : {0, 1, 3, 25}) {
    Fuzzy fuzzy = on_a_straight(scans), restored;
    Archive written;
    fuzzy.archive(written);
    Archive read(written.bytes());
    restored.archive(read);
    ASSERT_TRUE(read.ok() && read.at_end());
    for (int k = 0; k < 4; ++k) {
      ASSERT_TRUE(beliefs_identical<4>(fuzzy.estimate(), restored.estimate()));
      ASSERT_EQ(fuzzy.chosen(), restored.chosen());
      const Vec<double, 2> z(30.0 * (scans + k) + 4.0 * k, -9.0 * (scans + k));
      ASSERT_EQ(fuzzy.update(kSensor, z).nis, restored.update(kSensor, z).nis);
      ASSERT_EQ(fuzzy.predict(kPeriod_s), restored.predict(kPeriod_s));
    }
    for (Fuzzy other : {Fuzzy({.max_plots = 8}), Fuzzy({.hold = false}), Fuzzy({.clip = 2.5})}) {
      Archive wrong(written.bytes());
      other.archive(wrong);
      EXPECT_FALSE(wrong.ok());
      EXPECT_FALSE(other.started());
    }
    const auto bytes = std::span(written.bytes());
    for (std::size_t size = 0; size < bytes.size(); size += 7) {
      Fuzzy other;
      Archive cut(bytes.first(size));
      other.archive(cut);
      EXPECT_FALSE(cut.ok());
      EXPECT_FALSE(other.started());
    }
  }
}

TEST(FuzzyAlphaBeta, TouchesNoHeap) {
  Fuzzy fuzzy;
  const std::array readings{Alternative<Position>{kSensor, {8, 9}, 0.5}};
  std::array share{0.0};
  const test::NoHeap fence;
  Status worst = fuzzy.start(test::five_km_off<double>());
  for (int scan = 0; scan < 14; ++scan) {
    if (fuzzy.predict(3.0) != Status::kOk) worst = Status::kMissed;
    if (!fuzzy.update(kSensor, Vec<double, 2>(scan, 2 * scan))) worst = Status::kMissed;
  }
  (void)fuzzy.predict(3.0, Vec<double, 2>(0.1, 0.1));
  (void)fuzzy.update<Position>(readings, 0.1, share);
  (void)fuzzy.evidence(kSensor, Vec<double, 2>(5, 5));
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_EQ(worst, Status::kOk);
}

TEST(FuzzyAlphaBeta, IsOfFloatToo) {
  FuzzyAlphaBeta<float> single;
  Fuzzy fuzzy;
  ASSERT_EQ(single.start(test::five_km_off<float>()), Status::kOk);
  ASSERT_EQ(fuzzy.start(test::five_km_off<double>()), Status::kOk);
  Draw draw(61);
  for (int scan = 1; scan <= 60; ++scan) {
    const Vec<double, 2> z = weaving(kPeriod_s * scan) + 5.0 * draw.normals<2>();
    ASSERT_EQ(single.predict(3.0f), Status::kOk);
    ASSERT_EQ(fuzzy.predict(3.0), Status::kOk);
    ASSERT_TRUE(single.update(kSensor, Vec<float, 2>(z.cast<float>())));
    ASSERT_TRUE(fuzzy.update(kSensor, z));
    ASSERT_EQ(single.chosen(), fuzzy.chosen());
    EXPECT_TRUE(matrices_near(single.estimate().mean.cast<double>(), fuzzy.estimate().mean,
                              {.absolute = 0.02, .relative = 1e-4}));
  }
}

/// Largest innovation after scan 10, the middle of many runs: a vessel 20 km off goes straight for
/// 120 s, turns by 180 degrees and goes straight for 60 s, seen in cells of 6 m and 0.03 degrees.
double gate_radius_m(double speed_mps, double radius_m) {
  std::vector<double> worst;
  for (int run = 0; run < 200; ++run) {
    Draw draw(std::uint64_t(9000 + run));
    const double course = draw.uniform(0, 2 * std::numbers::pi);
    const double side = draw.uniform(-1, 1) < 0 ? -1 : 1, rate = side * speed_mps / radius_m;
    const double end = 120 + std::numbers::pi / std::abs(rate);
    const Vec<double, 2> cells(draw.uniform(0, 6), draw.uniform(0, deg(0.03)));
    const RangeBearing radar{.range_std_m = 1.73, .bearing_std_rad = 3.02 / 20000};
    Fuzzy fuzzy;
    (void)fuzzy.start(test::five_km_off<double>());
    Vec<double, 2> position(20000, 0);
    worst.push_back(0.0);
    constexpr double kFine_s = 0.05;
    int scan = 0;
    for (int k = 0; k * kFine_s < end + 60; ++k) {
      const double t = k * kFine_s;
      const double heading = course + rate * std::clamp(t - 120, 0.0, end - 120);
      position += kFine_s * speed_mps * Vec<double, 2>(std::cos(heading), std::sin(heading));
      if (k % 60 != 59) continue;
      const Vec<double, 2> polar = radar.measure(position) + cells;
      const Vec<double, 2> z(6 * std::round(polar[0] / 6),
                             deg(0.03) * std::round(polar[1] / deg(0.03)));
      (void)fuzzy.predict(kPeriod_s);
      const auto step = fuzzy.update(radar, z);
      if (++scan > 10) worst.back() = std::max(worst.back(), step.innovation.norm());
    }
  }
  std::nth_element(worst.begin(), worst.begin() + 100, worst.end());
  return worst[100];
}

TEST(FuzzyAlphaBeta, NeedsTheGateOfAnIndependentImplementation) {
  EXPECT_NEAR(gate_radius_m(10, 300), 21.7, 2.0);
  EXPECT_NEAR(gate_radius_m(20, 300), 41.2, 3.5);
  EXPECT_NEAR(gate_radius_m(20, 600), 27.7, 2.5);
}

}  // namespace
}  // namespace wakeline::fuzzy_alpha_beta_test
