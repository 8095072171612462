// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Runs in lanes are the runs one by one.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "support/run_results.hpp"
#include "wakeline/batch/run.hpp"
#include "wakeline/filter/alpha_beta.hpp"
#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/square_root_ukf.hpp"
#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/coordinated_turn.hpp"
#include "wakeline/motion/singer.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/multimodel/likely_model_set_imm.hpp"
#include "wakeline/multimodel/switching_grid_imm.hpp"

namespace wakeline::run_batch_test {
namespace {

using Results = test::RunResults;
using Lanes = Pack<double, kNativeLanes<double>>;

constexpr std::size_t kRuns = 2 * std::size_t(kNativeLanes<double>) + 1;
constexpr std::size_t kScans = 120;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr RangeBearing kRadar{.range_std_m = 20.0, .bearing_std_rad = deg(0.5)};

/// Vessels that steer here and there, some of their scans missed.
std::vector<double> recordings(std::size_t runs) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> z;
  for (std::size_t run = 0; run < runs; ++run) {
    double north = 3000.0, east = 2000.0, course = double(run);
    for (std::size_t scan = 0; scan < kScans; ++scan) {
      course += scan > 40 ? deg(2.5) : 0.0;
      north += 25.0 * std::cos(course);
      east += 25.0 * std::sin(course);
      const bool missed = (scan + 3 * run) % 17 == 5;
      z.push_back(missed ? kNaN : std::hypot(north, east) + 20.0 * normal(random));
      z.push_back(missed ? kNaN : std::atan2(east, north) + deg(0.5) * normal(random));
    }
  }
  return z;
}

template <class Scalar>
Gaussian<4, Scalar> start() {
  Gaussian<4, Scalar> belief;
  belief.mean << Scalar(3000.0), Scalar(0.0), Scalar(2000.0), Scalar(0.0);
  belief.covariance.setZero();
  belief.covariance(0, 0) = belief.covariance(2, 2) = Scalar(400.0);
  belief.covariance(1, 1) = belief.covariance(3, 3) = Scalar(100.0);
  return belief;
}

struct Dense {
  std::vector<double> z;
  std::vector<double> dt_s = std::vector<double>(kScans, 2.5);
  RunInput in;
  explicit Dense(std::size_t runs) : z(recordings(runs)) {
    in.runs = runs;
    in.scans = kScans;
    dt_s[50] = 4.0;
    link();
  }
  void link() {
    in.z = z.data();
    in.dt_s = dt_s.data();
  }
};

template <class Scalar>
struct Imm3 {
  static constexpr std::size_t kModels = 3;
  static auto make() {
    const auto turning = [](double rate_deg_s) {
      return Ekf<CoordinatedTurn, Scalar>(
          CoordinatedTurn{.turn_rate_rad_s = deg(rate_deg_s), .noise = WhiteAcceleration{0.01}});
    };
    return Imm{ModeChain<3>::from_sojourn_s({60.0, 30.0, 30.0}), turning(0.0), turning(1.0),
               turning(-1.0)};
  }
};

/// A filter of a turn whose rate may be another in each lane.
template <template <class, class> class Filter, class Scalar>
auto turn_filter() {
  return Filter<KnownTurn<TurnRate<Scalar>>, Scalar>({.noise = WhiteAcceleration{0.01}});
}

/// Three turn models whose rates move.
template <template <class> class Estimator, class Scalar, class Grid>
auto turning(const Grid& grid) {
  const auto filter = turn_filter<Ekf, Scalar>();
  const FilterBank bank(filter, filter, filter);
  return Estimator<std::decay_t<decltype(bank)>>(grid, ModeChain<3>::staying(0.9), bank);
}

const SwitchingGrid kSwitching{.grid_rad_s = TurnRateGrid::evenly(deg(2.0), 4)};
const LikelyModelSet kLikely{.unlikely_threshold = 0.1, .likely_threshold = 0.3};

template <class Scalar>
struct Switching {
  static constexpr std::size_t kModels = 3;
  static auto make() { return turning<SwitchingGridImm, Scalar>(kSwitching); }
};

/// Models that rest in some lanes and not in others.
template <class Scalar>
struct Likely {
  static constexpr std::size_t kModels = 5;
  static auto make() {
    return LikelyModelSetImm(kLikely, ModeChain<kRuntimeModes>::staying(0.9, 5),
                             turn_filter<Ekf, Scalar>());
  }
};

template <class Scalar>
struct UkfTurnRate {
  static constexpr std::size_t kModels = 0;
  static auto make() { return Ukf<CoordinatedTurnRate, Scalar>(CoordinatedTurnRate{}); }
};

template <class Scalar>
struct SquareRootImm {
  static constexpr std::size_t kModels = 2;
  static auto make() {
    return Imm{ModeChain<2>::staying(0.9), SquareRootUkf<CoordinatedTurnRate, Scalar>({}),
               SquareRootUkf<Singer, Scalar>(Singer{})};
  }
};

template <class Scalar>
struct GammaOfIndex {
  static constexpr std::size_t kModels = 0;
  static auto make() { return AlphaBetaGamma<Scalar>(TrackingIndex{0.3}); }
};

template <class Estimator, class Sensor>
Results run_copies(const Estimator& prototype, std::size_t models, const Sensor& sensor,
                   const RunInput& in, int threads) {
  Results results(in, std::size_t(prototype.estimate().mean.size()), models);
  run_batch(
      [&](std::size_t) {
        auto estimator = prototype;
        EXPECT_TRUE(all(ok(estimator.start(start<typename Estimator::Scalar>()))));
        return estimator;
      },
      sensor, in, results.out(), Threads{threads});
  return results;
}

template <template <class> class Kind, class Scalar, class Sensor>
Results run(const Sensor& sensor, const RunInput& in, int threads = 1) {
  return run_copies(Kind<Scalar>::make(), Kind<Scalar>::kModels, sensor, in, threads);
}

/// Equal to 1e-12 of the largest number; later, when a filter has had time to amplify its rounding,
/// to ten times that.
void expect_near(const Results& a, const Results& b) {
  constexpr double kRelative = 1e-12;
  constexpr std::size_t kEarly_scans = 20;
  EXPECT_EQ(a.status, b.status);
  for (std::size_t k = 0; k < a.numbers().size(); ++k) {
    const auto& x = *a.numbers()[k];
    const auto& y = *b.numbers()[k];
    ASSERT_EQ(x.size(), y.size());
    double scale = 0.0;
    for (const double value : y)
      if (std::isfinite(value)) scale = std::max(scale, std::abs(value));
    for (std::size_t i = 0; i < x.size(); ++i) {
      ASSERT_EQ(std::isnan(x[i]), std::isnan(y[i])) << k << ' ' << i;
      if (std::isnan(y[i])) continue;
      const std::size_t scan = i / (x.size() / a.status.size()) % kScans;
      const double tolerance = scale * (scan < kEarly_scans ? kRelative : 10 * kRelative);
      ASSERT_NEAR(x[i], y[i], tolerance) << k << " at scan " << scan;
    }
  }
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

template <class Case>
struct Batch : ::testing::Test {};

template <template <class> class KindType>
struct Of {
  template <class Scalar>
  using Kind = KindType<Scalar>;
};
using Cases = ::testing::Types<Of<Imm3>, Of<Switching>, Of<Likely>, Of<UkfTurnRate>,
                               Of<SquareRootImm>, Of<GammaOfIndex>>;
TYPED_TEST_SUITE(Batch, Cases);

TYPED_TEST(Batch, LanesAreTheRunsOneByOne) {
  const Dense data(kRuns);
  const Results lanes = run<TypeParam::template Kind, Lanes>(kRadar, data.in);
  const Results one_by_one = run<TypeParam::template Kind, double>(kRadar, data.in);
  EXPECT_GT(
      std::count(lanes.status.begin(), lanes.status.end(), static_cast<std::uint8_t>(Status::kOk)),
      0);
  expect_near(lanes, one_by_one);
}

// Not in every run: the printed rule of the switching grid loses a vessel now and then.
TEST(Grid, FollowsTheVessel) {
  const Results lanes = run<Switching, Lanes>(kRadar, Dense(kRuns).in);
  std::size_t follow = 0;
  for (std::size_t run = 0; run < kRuns; ++run) {
    const double* first = &lanes.rates[run * kScans * 3];
    EXPECT_EQ(first[1], 0.0);
    follow += std::abs(first[(kScans - 1) * 3 + 1] - deg(1.0)) < deg(0.6);
  }
  EXPECT_GE(4 * follow, 3 * kRuns);
}

TEST(LikelyModels, RestInSomeLanesOnly) {
  constexpr std::size_t kRow = kScans * Likely<Lanes>::kModels;
  const Results lanes = run<Likely, Lanes>(kRadar, Dense(kRuns).in);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < kRow; ++i)
    differ += std::isnan(lanes.rates[i]) != std::isnan(lanes.rates[kRow + i]);
  EXPECT_GT(differ, 0U);
}

TYPED_TEST(Batch, NeighboursDoNotMatter) {
  Dense data(kRuns);
  const Results before = run<TypeParam::template Kind, Lanes>(kRadar, data.in);
  // All runs but the second have other readings, some of them impossible.
  for (std::size_t run = 0; run < kRuns; ++run)
    for (std::size_t scan = 0; scan < kScans && run != 1; ++scan) {
      double* z = &data.z[2 * (run * kScans + scan)];
      z[0] = scan % 5 == 0 ? kInfinity : scan % 7 == 0 ? 1e200 : z[0] + 3000.0;
      z[1] = scan % 3 == 0 ? kNaN : -z[1];
    }
  const Results after = run<TypeParam::template Kind, Lanes>(kRadar, data.in);
  for (std::size_t k = 0; k < before.numbers().size(); ++k) {
    const auto& x = *before.numbers()[k];
    const auto& y = *after.numbers()[k];
    const auto size = static_cast<std::ptrdiff_t>(x.size() / kRuns);
    EXPECT_TRUE(same_bits({x.begin() + size, x.begin() + 2 * size},
                          {y.begin() + size, y.begin() + 2 * size}))
        << k;
  }
}

TYPED_TEST(Batch, ThreadsDoNotMatter) {
  const Dense data(kRuns);
  const Results one = run<TypeParam::template Kind, Lanes>(kRadar, data.in, 1);
  const Results three = run<TypeParam::template Kind, Lanes>(kRadar, data.in, 3);
  for (std::size_t k = 0; k < one.numbers().size(); ++k)
    EXPECT_TRUE(same_bits(*one.numbers()[k], *three.numbers()[k])) << k;
}

template <class Scalar>
void expect_numbers_in_place() {
  const std::size_t scans = 19, runs = std::size_t(kLanesOf<Scalar>) - 1;
  RunInput in;
  in.runs = runs;
  in.scans = scans;
  const RunLanes<Scalar> lanes(in, 0);
  for (const std::size_t size : {1U, 2U, 3U, 4U, 5U, 16U, 25U, 400U}) {
    std::vector<double> numbers(runs * scans * size, -1.0);
    const RunColumn<Scalar> column(lanes, numbers.data(), size);
    for (std::size_t scan = 0; scan < scans; ++scan) {
      Eigen::Matrix<Scalar, Eigen::Dynamic, 1, 0, 400, 1> of_scan(Eigen::Index(size), 1);
      for (std::size_t k = 0; k < size; ++k)
        of_scan[Eigen::Index(k)] = Scalar::of(
            [&](int lane) { return double((std::size_t(lane) * scans + scan) * size + k); });
      if (size > 1)
        column.write(scan, of_scan);
      else
        column.write(scan, of_scan[0]);
      column.fetch(scan + 2);
    }
    for (std::size_t k = 0; k < numbers.size(); ++k) ASSERT_EQ(numbers[k], double(k)) << size;
  }
}

// One lane is left over, and has other numbers than the last run.
TEST(BatchColumn, PutsEveryNumberInItsPlaceWhateverTheSize) {
  expect_numbers_in_place<Lanes>();
  expect_numbers_in_place<Pack<float, kNativeLanes<float>>>();
}

TEST(BatchStatus, AReadingThatIsNotFiniteFailsInItsLaneOnly) {
  Dense data(kRuns);
  data.z[2 * (1 * kScans + 10)] = kInfinity;  // run 1, scan 10
  const Results results = run<Imm3, Lanes>(kRadar, data.in);
  const Results sound = run<Imm3, Lanes>(kRadar, Dense(kRuns).in);
  for (std::size_t run = 0; run < kRuns; ++run)
    EXPECT_EQ(Status(results.status[run * kScans + 10]),
              run == 1 ? Status::kNotFinite : Status(sound.status[run * kScans + 10]))
        << run;
  EXPECT_TRUE(std::isnan(results.nis[kScans + 10]));
  EXPECT_TRUE(std::isfinite(results.mean[4 * (kScans + 10)]));
}

TEST(BatchStatus, AStartThatIsNotDefiniteFailsInItsLaneOnly) {
  auto imm = Imm3<Lanes>::make();
  Gaussian<4, Lanes> belief = start<Lanes>();
  belief.covariance(0, 0).set(1, -1.0);
  const auto status = imm.start(belief);
  for (int k = 0; k < kNativeLanes<double>; ++k)
    EXPECT_EQ(lane(status, k), k == 1 ? Status::kNotPositiveDefinite : Status::kOk);
}

/// How many scans have a status.
std::ptrdiff_t count(const Results& results, Status status) {
  return std::count(results.status.begin(), results.status.end(),
                    static_cast<std::uint8_t>(status));
}

TEST(BatchGate, OutsideIsGated) {
  Dense data(kRuns);
  const std::ptrdiff_t missed = count(run<Imm3, Lanes>(kRadar, data.in), Status::kMissed);
  const RadiusGate gate{60.0};
  data.in.gate = &gate;
  const Results lanes = run<Imm3, Lanes>(kRadar, data.in);
  const Results one_by_one = run<Imm3, double>(kRadar, data.in);
  expect_near(lanes, one_by_one);
  EXPECT_EQ(count(lanes, Status::kMissed), missed);
  EXPECT_GT(count(lanes, Status::kGated), 0);
}

/// With wild readings: one alone in run 1, and in run 2 all from scan 60 on, 2 km off.
Dense with_outliers() {
  Dense data(kRuns);
  data.z[2 * (1 * kScans + 30)] += 800.0;
  for (std::size_t scan = 60; scan < kScans; ++scan) data.z[2 * (2 * kScans + scan)] += 2000.0;
  return data;
}

TEST(BatchGate, AReadingOutsideTheEllipsoidLeavesThePrediction) {
  Dense data = with_outliers();
  data.link();
  const ChiSquareGate gate{0.9999};
  data.in.nis_gate = &gate;
  const Results lanes = run<Imm3, Lanes>(kRadar, data.in);
  expect_near(lanes, run<Imm3, double>(kRadar, data.in));
  EXPECT_EQ(Status(lanes.status[kScans + 30]), Status::kGated);
  EXPECT_TRUE(std::isnan(lanes.nis[kScans + 30]));
  for (std::size_t scan = 60; scan < 70; ++scan)
    EXPECT_NE(Status(lanes.status[2 * kScans + scan]), Status::kOk);
  for (const double nis : lanes.nis) EXPECT_FALSE(nis > gate.threshold(2));

  // The gated reading is as one that was never made.
  Dense without = with_outliers();
  without.z[2 * (kScans + 30)] = without.z[2 * (kScans + 30) + 1] = kNaN;
  without.link();
  without.in.nis_gate = &gate;
  const Results missed = run<Imm3, Lanes>(kRadar, without.in);
  EXPECT_EQ(missed.mean, lanes.mean);
  EXPECT_EQ(missed.modes, lanes.modes);
}

TEST(BatchGate, OpensAfterReadingsOutsideInARow) {
  constexpr int kAfter = 4;
  const ChiSquareGate ellipsoid{0.9999};
  const RadiusGate circle{800.0};
  for (const bool by_nis : {true, false}) {
    Dense data = with_outliers();
    data.link();
    data.in.reopen_after = kAfter;
    data.in.nis_gate = by_nis ? &ellipsoid : nullptr;
    data.in.gate = by_nis ? nullptr : &circle;
    const Results lanes = run<Imm3, Lanes>(kRadar, data.in);
    EXPECT_EQ(lanes.status, (run<Imm3, double>(kRadar, data.in).status));
    int gated = 0;
    Status last = Status::kMissed;
    for (std::size_t scan = 60; scan < kScans; ++scan) {
      const auto status = static_cast<Status>(lanes.status[2 * kScans + scan]);
      gated += status == Status::kGated;
      EXPECT_TRUE(status != Status::kOk || gated >= kAfter) << scan;
      if (status != Status::kMissed) last = status;
    }
    EXPECT_LE(gated, 3 * kAfter) << "it may overshoot once or twice";
    EXPECT_EQ(last, Status::kOk);
  }
}

/// Straight motion beside something of one's own, positions first.
struct PositionsFirst {
  static constexpr std::array kComponents{Component::kNorth, Component::kEast, Component::kVnorth,
                                          Component::kVeast, Component::kUser};
  [[maybe_unused]] static constexpr bool kForPacks = true;

  template <class Scalar>
  Mat<Scalar, 5, 5> matrix(Scalar dt_s) const noexcept {
    Mat<Scalar, 5, 5> f = Mat<Scalar, 5, 5>::Identity();
    f(0, 2) = f(1, 3) = dt_s;
    return f;
  }
  template <class Scalar>
  Mat<Scalar, 5, 5> process_noise(Scalar dt_s) const noexcept {
    return Scalar(0.1) * dt_s * Mat<Scalar, 5, 5>::Identity();
  }
};

template <class Scalar>
struct Own {
  static constexpr std::size_t kModels = 0;
  static auto make() { return Ekf<PositionsFirst, Scalar>(PositionsFirst{}); }
};

template <class Scalar>
struct ImmOfOwn {
  static constexpr std::size_t kModels = 2;
  static auto make() {
    return Imm{ModeChain<2>::staying(0.9), Own<Scalar>::make(), Own<Scalar>::make()};
  }
};

template <class Case>
struct BatchGateOfOwn : ::testing::Test {};
using OwnCases = ::testing::Types<Of<Own>, Of<ImmOfOwn>>;
TYPED_TEST_SUITE(BatchGateOfOwn, OwnCases);

TYPED_TEST(BatchGateOfOwn, UsesTheComponentsOfTheState) {
  Dense data(kRuns);
  const Results free = run<TypeParam::template Kind, Lanes>(kRadar, data.in);
  const RadiusGate gate{2000.0};  // of plots 3 km off and more
  data.in.gate = &gate;
  EXPECT_EQ((run<TypeParam::template Kind, Lanes>(kRadar, data.in).status), free.status);
}

/// Hears where a vessel is, and not how far off.
struct Bearings {
  static constexpr int kMeasurements = 1;
  static constexpr auto kReads = kPosition;

  template <class Scalar>
  Gaussian<1, Scalar> observe(const Vec<Scalar, 1>& z) const noexcept {
    return {z, Mat<Scalar, 1, 1>::Constant(Scalar(1e-4))};
  }
  template <class Scalar>
  Vec<Scalar, 1> measure(const Vec<Scalar, 2>& position) const noexcept {
    return Vec<Scalar, 1>(kRadar.measure(position)[1]);
  }
  template <class Scalar>
  Mat<Scalar, 1, 2> jacobian(const Vec<Scalar, 2>& position) const noexcept {
    return kRadar.jacobian(position).row(1);
  }
  template <class Scalar>
  Vec<Scalar, 1> residual(const Vec<Scalar, 1>& a, const Vec<Scalar, 1>& b) const noexcept {
    return Vec<Scalar, 1>(wrap_angle<Scalar>(a[0] - b[0]));
  }
};

TEST(BatchOwnSensor, NeedNotFixAPosition) {
  const Dense data(kRuns);
  std::vector<double> bearings;
  for (std::size_t k = 1; k < data.z.size(); k += 2) bearings.push_back(data.z[k]);
  RunInput in = data.in;
  in.z = bearings.data();
  const Results lanes = run<Own, Lanes>(Bearings{}, in);
  Ekf filter{PositionsFirst{}};
  ASSERT_EQ(filter.start(start<double>()), Status::kOk);
  for (std::size_t scan = 0; scan < kScans; ++scan) {
    ASSERT_EQ(filter.predict(data.dt_s[scan]), Status::kOk);
    if (!std::isnan(bearings[scan])) {
      ASSERT_TRUE(filter.update(Bearings{}, Vec<double, 1>(bearings[scan])));
    }
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_NEAR(lanes.mean[5 * scan + i], filter.estimate().mean[Eigen::Index(i)], 1e-6);
  }
}

TEST(BatchLinear, AWidePriorIsJosephsInItsLaneOnly) {
  // One lane begins with a prior in which P - W Wᵀ would cancel.
  using Filter = Ekf<CoordinatedTurn, Lanes>;
  Filter lanes(CoordinatedTurn{});
  Gaussian<4, Lanes> belief = start<Lanes>();
  for (int k = 0; k < 4; ++k) belief.covariance(k, k).set(1, 1e12);
  ASSERT_TRUE(all(ok(lanes.start(belief))));
  const ConvertedRangeBearing radar{.range_std_m = 5.0, .bearing_std_rad = deg(0.1)};
  ASSERT_TRUE(all(ok(lanes.update(radar, Vec<Lanes, 2>(Lanes(3000.0), Lanes(0.1))).status)));
  for (int k = 0; k < kNativeLanes<double>; ++k) {
    Ekf<CoordinatedTurn> one(CoordinatedTurn{});
    Gaussian<4> prior = start<double>();
    if (k == 1) prior.covariance.diagonal().setConstant(1e12);
    ASSERT_EQ(one.start(prior), Status::kOk);
    ASSERT_TRUE(one.update(radar, Vec<double, 2>(3000.0, 0.1)));
    for (int i = 0; i < 16; ++i)
      EXPECT_NEAR(lane(lanes.estimate().covariance.data()[i], k),
                  one.estimate().covariance.data()[i],
                  1e-12 * one.estimate().covariance.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace wakeline::run_batch_test
