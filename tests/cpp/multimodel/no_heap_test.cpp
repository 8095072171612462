// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/multimodel/imm.hpp"

namespace wakeline::no_heap_test {
namespace {

template <class ImmType>
void expect_no_heap(ImmType imm) {
  const RangeBearing radar{.range_std_m = 15, .bearing_std_rad = deg(0.5)};
  const Vec<double, 2> z = test::plot_of<double>(2990, 4010);
  const Vec<double, 2> bad(std::nan(""), 1.0);
  const test::NoHeap fence;
  bool good = imm.start(test::five_km_off<double>()) == Status::kOk;
  double position = 0.0;
  for (int scan = 0; scan < 3; ++scan) {
    good = imm.predict(2.5 + scan) == Status::kOk && good;  // a new transition for each step
    good = static_cast<bool>(imm.update(radar, z)) && good;
    good = !imm.update(radar, bad) && good;
    good = imm.predict(-1.0) == Status::kNegativeTimeStep && good;
    position += imm.estimate().mean[0];
  }
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_TRUE(good);
  EXPECT_GT(position, 0.0);
}

TEST(ImmHeap, IsNotTouched) {
  const Ekf straight{ConstantVelocity{}};
  expect_no_heap(Imm{ModeChain<2>::from_sojourn_s({60.0, 30.0}), straight, straight});
  expect_no_heap(
      Imm{ModeChain<2>(ModeChain<2>::Matrix{{0.9, 0.1}, {0.1, 0.9}}), straight, straight});
  expect_no_heap(Imm{ModeChain<3>::from_sojourn_s({60.0, 30.0, 30.0}), straight,
                     Ukf{CoordinatedTurnRate{}}, SquareRootUkf{ConstantAcceleration{}}});
}

TEST(ChainHeap, RuntimeChainNeedsNone) {
  const auto chain = ModeChain<kRuntimeModes>::from_sojourn_s({60.0, 30.0, 10.0, 20.0});
  const test::NoHeap fence;
  const auto p = chain.transition(7.0);
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_NEAR(p.row(0).sum(), 1.0, 1e-12);
}

}  // namespace
}  // namespace wakeline::no_heap_test
