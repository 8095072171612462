// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Line estimators in lanes with different plots and times.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "filter/cases.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/multimodel/bayesian_alpha_beta.hpp"
#include "wakeline/multimodel/fuzzy_alpha_beta.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline::line_lanes_test {
namespace {

using test::Draw;

constexpr int kLanes = kNativeLanes<double>;
using Lanes = Pack<double, kLanes>;
using OfLanes = std::array<double, std::size_t(kLanes)>;

constexpr int kScans = 120;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr RangeBearing kRadar{.range_std_m = 8.0, .bearing_std_rad = deg(0.2)};

struct Fuzzy {
  template <class Scalar>
  static auto make() {
    return FuzzyAlphaBeta<Scalar>();
  }
};
struct FuzzyOfLeast {
  template <class Scalar>
  static auto make() {
    return FuzzyAlphaBeta<Scalar>({.max_plots = 6, .t_norm = TNorm::kMinimum, .hold = false});
  }
};
struct Bayesian {
  template <class Scalar>
  static auto make() {
    return BayesianAlphaBeta<Scalar>();
  }
};
struct LongBayesian {
  template <class Scalar>
  static auto make() {
    return BayesianAlphaBeta<Scalar>({.min_plots = 4, .max_plots = 9, .parabolas = false});
  }
};

/// What happens to the vessel of a lane in a scan.
struct Scan {
  double dt_s;
  Vec<double, 2> z;
};

/// A maneuvering vessel, seen in most scans. Some time steps are zero, negative, NaN or too long,
/// some plots out of range.
std::vector<Scan> voyage(std::uint64_t seed) {
  Draw draw(seed);
  Vec<double, 2> position(4000.0 + 500.0 * double(seed), -3000.0);
  double course = double(seed), rate = 0.0;
  std::vector<Scan> scans;
  for (int k = 0; k < kScans; ++k) {
    const double chance = draw.uniform(0, 1);
    const double dt_s = chance < 0.03   ? 4e-4
                        : chance < 0.04 ? -1.0
                        : chance < 0.05 ? kNaN
                        : chance < 0.06 ? 1e10
                                        : draw.uniform(1.0, 6.0);
    if (draw.uniform(0, 1) < 0.06) rate = draw.uniform(-0.05, 0.05);
    if (dt_s > 0.0 && dt_s < 10.0) {
      course += rate * dt_s;
      position += 9.0 * dt_s * Vec<double, 2>(std::cos(course), std::sin(course));
    }
    Vec<double, 2> z = kRadar.measure(position);
    z[0] += 8.0 * draw.normal();
    z[1] += deg(0.2) * draw.normal();
    if (draw.uniform(0, 1) < 0.12) z[0] = kNaN;
    if (draw.uniform(0, 1) < 0.02) z[0] = 1e10;
    scans.push_back({dt_s, z});
  }
  return scans;
}

template <class Scalar>
Gaussian<4, Scalar> anywhere() {
  Gaussian<4, Scalar> belief;
  belief.mean << Scalar(4500.0), Scalar(0.0), Scalar(-3000.0), Scalar(0.0);
  belief.covariance.setZero();
  belief.covariance(0, 0) = belief.covariance(2, 2) = Scalar(1e6);
  belief.covariance(1, 1) = belief.covariance(3, 3) = Scalar(100.0);
  return belief;
}

/// An estimator after a scan.
template <class Scalar>
struct After {
  StatusOf<Scalar> moved, taken;
  std::vector<Scalar> numbers;
};

template <class Estimator>
auto after(Estimator& estimator, int k, const typename Estimator::Scalar& dt_s,
           const Vec<typename Estimator::Scalar, 2>& z) {
  using Scalar = typename Estimator::Scalar;
  After<Scalar> result;
  result.moved = k % 4 == 3 ? estimator.predict(dt_s, Vec<Scalar, 2>(Scalar(0.02), Scalar(-0.01)))
                            : estimator.predict(dt_s);
  const auto step = estimator.update(kRadar, z);
  result.taken = step.status;
  for (const Scalar& number :
       {step.nis, step.log_likelihood, step.innovation[0], step.innovation[1]})
    result.numbers.push_back(select(ok(step.status), number, Scalar(0)));
  const auto add = [&](const auto& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) result.numbers.push_back(matrix.data()[i]);
  };
  add(estimator.estimate().mean);
  add(estimator.estimate().covariance);
  add(estimator.mode_probability());
  return result;
}

/// The voyages of all lanes, scan by scan: `see(scan, after)`.
template <class Case, class See>
void sail(const std::array<std::vector<Scan>, std::size_t(kLanes)>& voyages, const See& see) {
  auto estimator = Case::template make<Lanes>();
  ASSERT_TRUE(all(ok(estimator.start(anywhere<Lanes>()))));
  for (int k = 0; k < kScans; ++k) {
    const auto of = [&](const auto& number) {
      return Lanes::of(
          [&](int lane) { return number(voyages[std::size_t(lane)][std::size_t(k)]); });
    };
    see(k, after(estimator, k, of([](const Scan& scan) { return scan.dt_s; }),
                 Vec<Lanes, 2>(of([](const Scan& scan) { return scan.z[0]; }),
                               of([](const Scan& scan) { return scan.z[1]; }))));
  }
}

std::array<std::vector<Scan>, std::size_t(kLanes)> voyages(std::uint64_t first) {
  std::array<std::vector<Scan>, std::size_t(kLanes)> all;
  for (std::size_t lane = 0; lane < all.size(); ++lane) all[lane] = voyage(first + lane);
  return all;
}

template <class Case>
struct LineLanes : ::testing::Test {};
using Cases = ::testing::Types<Fuzzy, FuzzyOfLeast, Bayesian, LongBayesian>;
TYPED_TEST_SUITE(LineLanes, Cases);

TYPED_TEST(LineLanes, AreEachASeparateEstimator) {
  const auto all_voyages = voyages(1);
  std::vector<decltype(TypeParam::template make<double>())> alone;
  for (int which = 0; which < kLanes; ++which) {
    alone.push_back(TypeParam::template make<double>());
    ASSERT_EQ(alone.back().start(anywhere<double>()), Status::kOk);
  }
  int rejected = 0, joined = 0;
  sail<TypeParam>(all_voyages, [&](int k, const After<Lanes>& lanes) {
    for (int which = 0; which < kLanes; ++which) {
      const auto& scan = all_voyages[std::size_t(which)][std::size_t(k)];
      const auto one = after(alone[std::size_t(which)], k, scan.dt_s, scan.z);
      ASSERT_EQ(lane(lanes.moved, which), one.moved) << k << " of " << which;
      ASSERT_EQ(lane(lanes.taken, which), one.taken) << k << " of " << which;
      rejected += one.moved != Status::kOk || one.taken != Status::kOk;
      joined += scan.dt_s == 4e-4;
      ASSERT_EQ(lanes.numbers.size(), one.numbers.size());
      for (std::size_t i = 0; i < one.numbers.size(); ++i)
        ASSERT_NEAR(lane(lanes.numbers[i], which), one.numbers[i],
                    1e-8 + 1e-8 * std::abs(one.numbers[i]))
            << i << " in scan " << k << " of " << which;
    }
  });
  EXPECT_GT(rejected, 10 * kLanes);
  EXPECT_GT(joined, 0);
}

TYPED_TEST(LineLanes, AreIndependentOfTheirNeighbours) {
  auto one = voyages(20), other = voyages(40);
  one[1] = other[1];
  std::vector<std::vector<double>> first;
  const auto numbers_of = [](const After<Lanes>& lanes) {
    std::vector<double> numbers{double(lane(lanes.moved, 1)), double(lane(lanes.taken, 1))};
    for (const Lanes& number : lanes.numbers) numbers.push_back(lane(number, 1));
    return numbers;
  };
  sail<TypeParam>(one, [&](int, const After<Lanes>& lanes) { first.push_back(numbers_of(lanes)); });
  sail<TypeParam>(other, [&](int k, const After<Lanes>& lanes) {
    ASSERT_EQ(numbers_of(lanes), first[std::size_t(k)]) << k;
  });
}

TYPED_TEST(LineLanes, OneThatCannotStartStaysAsItWas) {
  auto estimator = TypeParam::template make<Lanes>();
  ASSERT_TRUE(all(ok(estimator.start(anywhere<Lanes>()))));
  for (int k = 0; k < 12; ++k) {
    ASSERT_TRUE(all(ok(estimator.predict(Lanes(3.0)))));
    const Vec<double, 2> z = kRadar.measure(Vec<double, 2>(4500.0 + 20.0 * k, -3000.0));
    ASSERT_TRUE(all(ok(estimator.update(kRadar, z.cast<Lanes>().eval()).status)));
  }
  const auto before = estimator.estimate();
  auto belief = anywhere<Lanes>();
  belief.covariance(0, 0).set(1, -1.0);
  const auto status = estimator.start(belief);
  for (int which = 0; which < kLanes; ++which) {
    EXPECT_EQ(lane(status, which), which == 1 ? Status::kNotPositiveDefinite : Status::kOk);
    const auto& wanted = which == 1 ? Gaussian<4, Lanes>{before} : belief;
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(estimator.estimate().mean[i][which], wanted.mean[i][which]);
      EXPECT_EQ(estimator.estimate().covariance(i, i)[which], wanted.covariance(i, i)[which]);
    }
    EXPECT_NEAR(estimator.mode_probability().sum()[which], 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace wakeline::line_lanes_test
