// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Alpha-beta filters in the lanes of packs are those one by one.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "support/draw.hpp"
#include "wakeline/filter/alpha_beta.hpp"
#include "wakeline/measurement/position.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/multimodel/imm.hpp"
#include "wakeline/simd/pack_math.hpp"

namespace wakeline::alpha_beta_lanes_test {
namespace {

constexpr int kLanes = kNativeLanes<double>;
using Lanes = Pack<double, kLanes>;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// One filter over packs beside one over numbers for each lane.
template <int Order>
struct SideBySide {
  AlphaBetaFilter<Order, Lanes> packed;
  std::vector<AlphaBetaFilter<Order>> alone;

  explicit SideBySide(const GainSchedule<Order>& gains)
      : packed(gains), alone(kLanes, AlphaBetaFilter<Order>(gains)) {
    Gaussian<4, Lanes> belief;
    for (int k = 0; k < kLanes; ++k) {
      Gaussian<4> own{{4000.0 + k, 5.0, 3000.0, -2.0 * k}, Mat<double, 4, 4>::Identity()};
      own.covariance.diagonal() << 400.0, 25.0, 900.0 + k, 30.0;
      EXPECT_EQ(alone[std::size_t(k)].start(own), Status::kOk);
      for (int i = 0; i < 4; ++i) belief.mean[i].set(k, own.mean[i]);
      for (int i = 0; i < 16; ++i) belief.covariance.data()[i].set(k, own.covariance.data()[i]);
    }
    EXPECT_TRUE(all(ok(packed.start(belief))));
  }

  void predict(const Lanes& dt_s) {
    const auto status = packed.predict(dt_s);
    for (int k = 0; k < kLanes; ++k)
      EXPECT_EQ(alone[std::size_t(k)].predict(dt_s[k]), lane(status, k)) << k;
  }

  template <class Sensor>
  void update(const Sensor& sensor, const Vec<Lanes, 2>& z) {
    const auto step = packed.update(sensor, z);
    for (int k = 0; k < kLanes; ++k) {
      const auto own = alone[std::size_t(k)].update(sensor, Vec<double, 2>(z[0][k], z[1][k]));
      ASSERT_EQ(own.status, lane(step.status, k)) << k;
      if (own) {
        EXPECT_NEAR(step.nis[k], own.nis, 1e-9 * (1.0 + own.nis));
      }
    }
  }

  void expect_same() const {
    for (int k = 0; k < kLanes; ++k) {
      const auto& own = alone[std::size_t(k)].estimate();
      const auto& packs = packed.estimate();
      for (int i = 0; i < 2 * Order; ++i) {
        const double std = std::sqrt(own.covariance(i, i));
        ASSERT_NEAR(packs.mean[i][k], own.mean[i], 1e-9 * std) << k << ", row " << i;
        for (int j = 0; j < 2 * Order; ++j)
          ASSERT_NEAR(packs.covariance(i, j)[k], own.covariance(i, j),
                      1e-10 * std * std::sqrt(own.covariance(j, j)))
              << k << ", " << i << ", " << j;
      }
    }
  }
};

/// A plot for each lane; every fifth is missed, and now and then one cannot be taken.
Vec<Lanes, 2> plots(test::Draw& draw, int scan) {
  Vec<Lanes, 2> z;
  for (int k = 0; k < kLanes; ++k) {
    const Vec<double, 2> noise = draw.normals<2>();
    z[0].set(k, (scan + k) % 5 == 0 ? kNaN : (scan + k) % 11 == 0 ? 1e300 : 5e3 + 20.0 * noise[0]);
    z[1].set(k, 0.64 + 0.01 * noise[1]);
  }
  return z;
}

/// Steps that differ from lane to lane, some of them none and one backwards.
Lanes steps(int scan) {
  return Lanes::of([&](int k) {
    return (scan + k) % 7 == 0 ? 0.0 : (scan + 3 * k) % 31 == 4 ? -1.0 : 2.0 + 0.25 * k;
  });
}

template <int Order>
void expect_lanes_apart(const GainSchedule<Order>& gains) {
  SCOPED_TRACE("schedule " + std::to_string(gains.index()));
  test::Draw draw(5);
  SideBySide<Order> filters(gains);
  const RangeBearing radar{.range_std_m = 20.0, .bearing_std_rad = 0.01};
  const Position round{.position_std_m = 30.0};
  for (int scan = 0; scan < 60; ++scan) {
    filters.predict(steps(scan));
    if (scan % 3 == 2)
      filters.update(round, Vec<Lanes, 2>(Lanes(4e3 + scan), Lanes(3e3 - scan)));
    else
      filters.update(radar, plots(draw, scan));
    filters.expect_same();
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(AlphaBetaLanes, AreTheFiltersOneByOne) {
  for (const GainSchedule<2>& gains : std::initializer_list<GainSchedule<2>>{
           ConstantGains{}, GrowingMemory{.max_plots = 9}, BenedictBordner{}, CriticallyDamped{0.6},
           TrackingIndex{0.3}, RangeDependent{.alpha_range_m = 4.9e3, .beta_range_m = 4.9e3},
           RecentMemory{.max_plots = 9}, AdaptiveGains{}, AdaptiveGains{.window = 8}})
    expect_lanes_apart<2>(gains);
  for (const GainSchedule<3>& gains :
       std::initializer_list<GainSchedule<3>>{ConstantGains{0.6, 0.3, 0.05}, GrowingMemory{},
                                              CriticallyDamped{0.6}, TrackingIndex{0.1}})
    expect_lanes_apart<3>(gains);
}

// A lane that takes only the first of two readings has taken one; its schedule continues.
TEST(AlphaBetaLanes, RememberWhatEachHasTakenOfSeveralReadings) {
  const Position sensor{.position_std_m = 30.0};
  const auto track = [&]<class Scalar>(Scalar, bool first_lane) {
    using Filter = AlphaBetaFilter<2, Scalar>;
    Imm imm{ModeChain<2>::staying(0.9), Filter(GrowingMemory{}), Filter(GrowingMemory{})};
    Gaussian<4, Scalar> belief;
    belief.mean.setZero();
    belief.covariance.setIdentity();
    EXPECT_TRUE(all(ok(imm.start(belief))));
    for (int scan = 0; scan < 4; ++scan) {
      EXPECT_TRUE(all(ok(imm.predict(Scalar(1.0)))));
      const auto second = lanes_of<Scalar>(
          [&](int k) { return RealOf<Scalar>(k == 0 && first_lane ? kNaN : 2.0 * scan); });
      const std::array<Alternative<Position, Scalar>, 2> readings{
          {{sensor, {Scalar(scan), Scalar(1.0)}, Scalar(0.5)},
           {sensor, {second, Scalar(-1.0)}, Scalar(0.4)}}};
      std::array<Scalar, 2> share;
      (void)imm.update(std::span<const Alternative<Position, Scalar>>(readings), Scalar(0.1),
                       std::span<Scalar>(share));
    }
    return imm.estimate();
  };
  const auto packs = track(Lanes(0.0), true);
  for (int k = 0; k < std::min(2, kLanes); ++k) {
    const auto alone = track(0.0, k == 0);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(packs.mean[i][k], alone.mean[i], 1e-11) << k;
      EXPECT_NEAR(packs.covariance(i, i)[k], alone.covariance(i, i),
                  1e-11 * alone.covariance(i, i));
    }
  }
}

}  // namespace
}  // namespace wakeline::alpha_beta_lanes_test
