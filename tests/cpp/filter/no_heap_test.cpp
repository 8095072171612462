// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "filter/cases.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/filter/rts_smoother.hpp"
#include "wakeline/measurement/position.hpp"

namespace wakeline::no_heap_test {
namespace {

template <class Filter>
class FilterHeap : public ::testing::Test {};
TYPED_TEST_SUITE(FilterHeap, test::EveryFilter, );

TYPED_TEST(FilterHeap, IsNotTouched) {
  using Scalar = typename TypeParam::Scalar;
  TypeParam filter{typename TypeParam::Motion{}};
  const auto radar = test::radar_of<TypeParam>(10, 0.01);
  const Vec<Scalar, 2> z = test::plot_of<Scalar>(2990, 4010);
  Vec<Scalar, 2> bad = z;
  bad[0] = std::numeric_limits<Scalar>::quiet_NaN();
  const test::NoHeap fence;
  Status worst = filter.start(test::five_km_off<Scalar>());
  for (int scan = 0; scan < 3; ++scan) {
    const Status status = filter.predict(Scalar(2.5 + scan));
    const auto step = filter.update(radar, z);
    if (status != Status::kOk || !step) worst = Status::kMissed;
    (void)filter.update(radar, bad);
  }
  (void)filter.predict(Scalar(3600));
  (void)filter.update(Position{.position_std_m = 0.1},
                      Vec<Scalar, 2>(3000, 4000));  // the Joseph form
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_EQ(worst, Status::kOk);
}

TEST(SmootherHeap, IsNotTouched) {
  std::array<Gaussian<4>, 4> beliefs;
  constexpr std::array kSteps{1.0, 2.0, 0.5};
  const ConstantVelocity motion;
  const test::NoHeap fence;
  const Status status = smooth<ConstantVelocity, double>(motion, beliefs, kSteps);
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_EQ(status, Status::kOk);
}

}  // namespace
}  // namespace wakeline::no_heap_test
