// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/simd/pack.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "wakeline/core/types.hpp"

namespace wakeline::pack_test {
namespace {

/// The same number: zeros of one sign, or both NaN.
template <class Real>
bool is_same(Real a, Real b) {
  return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
}

/// Numbers of every kind: fractions about integers, where fractions end, extremes, no numbers.
template <class Real>
std::vector<Real> numbers_of_every_kind() {
  using Limits = std::numeric_limits<Real>;
  const Real last_fraction = std::ldexp(Real(1), Limits::digits - 2);
  std::vector<Real> numbers;
  for (const Real number :
       {Real(0), Real(0.25), Real(0.5), Real(1), Real(1.5), Real(2.5), Real(3.75), Real(1e6) / 3,
        last_fraction - Real(0.5), last_fraction + Real(0.5), 2 * last_fraction - Real(0.5),
        2 * last_fraction, 2 * last_fraction + 1, 4 * last_fraction + 2, Real(1e30), Limits::min(),
        Limits::denorm_min(), Limits::max(), Limits::infinity()})
    for (const Real near :
         {number, std::nextafter(number, Real(0)), std::nextafter(number, Limits::infinity())}) {
      numbers.push_back(near);
      numbers.push_back(-near);
    }
  numbers.push_back(Limits::quiet_NaN());
  return numbers;
}

template <class PackType>
class PackOf : public ::testing::Test {
 protected:
  using Real = RealOf<PackType>;
  static constexpr int kLanes = kLanesOf<PackType>;

  /// Calls `law(a, b)` with packs in which every number has met every other.
  template <class Law>
  static void for_each_pair(const Law& law) {
    const std::vector<Real> numbers = numbers_of_every_kind<Real>();
    const int count = int(numbers.size());
    for (int first = 0; first < count; ++first)
      for (int shift = 0; shift < count; shift += kLanes)
        law(PackType(numbers[std::size_t(first)]),
            PackType::of([&](int k) { return numbers[std::size_t((shift + k) % count)]; }));
  }
};

using Packs = ::testing::Types<Pack<double, kNativeLanes<double>>, Pack<float, kNativeLanes<float>>,
                               Pack<double, 2>, Pack<float, 2>>;
TYPED_TEST_SUITE(PackOf, Packs, );

TYPED_TEST(PackOf, ArithmeticIsThatOfEachLane) {
  using Real = RealOf<TypeParam>;
  this->for_each_pair([](TypeParam a, TypeParam b) {
    TypeParam sum = a, difference = a, product = a, quotient = a;
    sum += b, difference -= b, product *= b, quotient /= b;
    for (int k = 0; k < kLanesOf<TypeParam>; ++k) {
      const Real u = a[k], v = b[k];
      EXPECT_TRUE(is_same((a + b)[k], u + v)) << u << " " << v;
      EXPECT_TRUE(is_same((a - b)[k], u - v)) << u << " " << v;
      EXPECT_TRUE(is_same((a * b)[k], u * v)) << u << " " << v;
      EXPECT_TRUE(is_same((a / b)[k], u / v)) << u << " " << v;
      EXPECT_TRUE(is_same((-b)[k], -v)) << v;
      EXPECT_TRUE(is_same((+b)[k], v)) << v;
      EXPECT_TRUE(is_same(sum[k], u + v) && is_same(difference[k], u - v));
      EXPECT_TRUE(is_same(product[k], u * v) && is_same(quotient[k], u / v));
    }
  });
}

TYPED_TEST(PackOf, ANumberIsInEveryLane) {
  using Real = RealOf<TypeParam>;
  const TypeParam a = TypeParam::of([](int k) { return Real(k) + Real(0.5); });
  for (int k = 0; k < kLanesOf<TypeParam>; ++k) {
    EXPECT_EQ((2 * a + 1)[k], 2 * a[k] + 1);
    EXPECT_EQ((a / Real(3) - 1)[k], a[k] / 3 - 1);
    EXPECT_TRUE(is_same(TypeParam(Real(-0.0))[k], Real(-0.0)));
    EXPECT_EQ(lane(a, k), Real(k) + Real(0.5));
  }
}

TYPED_TEST(PackOf, SettingALaneLeavesTheOthers) {
  using Real = RealOf<TypeParam>;
  const TypeParam before = TypeParam::of([](int k) { return k; });
  for (int changed = 0; changed < kLanesOf<TypeParam>; ++changed) {
    TypeParam after = before;
    after.set(changed, Real(-7));
    for (int k = 0; k < kLanesOf<TypeParam>; ++k)
      EXPECT_EQ(after[k], k == changed ? Real(-7) : before[k]);
  }
}

TYPED_TEST(PackOf, ComparisonsAreThoseOfEachLane) {
  using Real = RealOf<TypeParam>;
  this->for_each_pair([](TypeParam a, TypeParam b) {
    for (int k = 0; k < kLanesOf<TypeParam>; ++k) {
      const Real u = a[k], v = b[k];
      EXPECT_EQ((a < b)[k], u < v) << u << " " << v;
      EXPECT_EQ((a <= b)[k], u <= v) << u << " " << v;
      EXPECT_EQ((a > b)[k], u > v) << u << " " << v;
      EXPECT_EQ((a >= b)[k], u >= v) << u << " " << v;
      EXPECT_EQ((a == b)[k], u == v) << u << " " << v;
      EXPECT_EQ((a != b)[k], u != v) << u << " " << v;
      EXPECT_EQ(isnan(b)[k], std::isnan(v)) << v;
      EXPECT_EQ(isfinite(b)[k], std::isfinite(v)) << v;
    }
  });
}

TYPED_TEST(PackOf, ChoicesAreThoseOfEachLane) {
  using Real = RealOf<TypeParam>;
  this->for_each_pair([](TypeParam a, TypeParam b) {
    for (int k = 0; k < kLanesOf<TypeParam>; ++k) {
      const Real u = a[k], v = b[k];
      EXPECT_TRUE(is_same(select(a < b, a, b)[k], u < v ? u : v)) << u << " " << v;
      EXPECT_TRUE(is_same(min(a, b)[k], std::min(u, v))) << u << " " << v;
      EXPECT_TRUE(is_same(max(a, b)[k], std::max(u, v))) << u << " " << v;
      EXPECT_TRUE(is_same(abs(b)[k], std::abs(v))) << v;
      EXPECT_TRUE(is_same(copysign(a, b)[k], std::copysign(u, v))) << u << " " << v;
    }
  });
}

TYPED_TEST(PackOf, RootsAndIntegersAreThoseOfEachLane) {
  using Real = RealOf<TypeParam>;
  this->for_each_pair([](TypeParam, TypeParam b) {
    for (int k = 0; k < kLanesOf<TypeParam>; ++k) {
      const Real v = b[k];
      EXPECT_TRUE(is_same(sqrt(b)[k], std::sqrt(v))) << v;
      EXPECT_TRUE(is_same(floor(b)[k], std::floor(v))) << v << " " << floor(b)[k];
      EXPECT_TRUE(is_same(round_to_even(b)[k], std::nearbyint(v))) << v << round_to_even(b)[k];
    }
  });
}

TYPED_TEST(PackOf, MaskIsALogicOfEachLane) {
  using Mask = MaskOf<TypeParam>;
  constexpr int kLanes = kLanesOf<TypeParam>;
  const int patterns = 1 << std::min(kLanes, 8);
  const auto mask_of = [](int pattern) {
    Mask mask(false);
    for (int k = 0; k < kLanes; ++k) mask.set(k, (pattern >> (k % 8) & 1) != 0);
    return mask;
  };
  for (int p = 0; p < patterns; ++p) {
    const Mask a = mask_of(p);
    EXPECT_EQ(any(a), p != 0);
    EXPECT_EQ(none(a), p == 0);
    EXPECT_EQ(all(a), p == patterns - 1);
    for (int q = 0; q < patterns; q += 1 + patterns / 16) {
      const Mask b = mask_of(q);
      for (int k = 0; k < kLanes; ++k) {
        EXPECT_EQ((a && b)[k], a[k] && b[k]);
        EXPECT_EQ((a || b)[k], a[k] || b[k]);
        EXPECT_EQ((!a)[k], !a[k]);
      }
    }
  }
  EXPECT_TRUE(all(Mask(true)));
  EXPECT_TRUE(none(Mask(false)));
  for (int only = 0; only < kLanes; ++only) {
    Mask one(false);
    one.set(only, true);
    EXPECT_TRUE(any(one));
    EXPECT_FALSE(all(one));
    EXPECT_FALSE(all(!one));
  }
}

TYPED_TEST(PackOf, BitsAreTheNumbers) {
  using Real = RealOf<TypeParam>;
  this->for_each_pair([](TypeParam, TypeParam b) {
    const TypeParam same = TypeParam::from_bits(b.bits());
    for (int k = 0; k < kLanesOf<TypeParam>; ++k) {
      using Integer = std::decay_t<decltype(b.bits()[k])>;
      EXPECT_EQ(b.bits()[k], std::bit_cast<Integer>(Real(b[k])));
      EXPECT_TRUE(is_same(same[k], b[k]));
    }
  });
}

// Of small integers, so that sums are exact in whatever order and with whatever instructions.
TYPED_TEST(PackOf, NumbersInARowAreReadAndWritten) {
  using Real = RealOf<TypeParam>;
  constexpr int kLanes = kLanesOf<TypeParam>;
  Real row[kLanes + 1], copy[kLanes + 1] = {};
  for (int k = 0; k <= kLanes; ++k) row[k] = Real(k * k - 3);
  const TypeParam pack = load<TypeParam>(row + 1);  // wherever they lie
  store(pack, copy + 1);
  for (int k = 0; k < kLanes; ++k) {
    EXPECT_EQ(lane(pack, k), row[k + 1]);
    EXPECT_EQ(copy[k + 1], row[k + 1]);
    EXPECT_EQ(lanes_of<TypeParam>([&](int of_lane) { return row[of_lane + 1]; })[k], row[k + 1]);
  }
  EXPECT_EQ(copy[0], Real(0));
}

TYPED_TEST(PackOf, SumAndExtremesAreOfAllLanes) {
  using Real = RealOf<TypeParam>;
  constexpr int kLanes = kLanesOf<TypeParam>;
  for (int greatest = 0; greatest < kLanes; ++greatest) {
    const auto pack = TypeParam::of([&](int k) { return Real(k == greatest ? 100 : -k); });
    Real sum = Real(0), least = Real(100);
    for (int k = 0; k < kLanes; ++k) {
      sum += pack[k];
      least = std::min(least, pack[k]);
    }
    EXPECT_EQ(sum_of_lanes(pack), sum);
    EXPECT_EQ(least_of_lanes(pack), least);
    EXPECT_EQ(greatest_of_lanes(pack), Real(100));
    EXPECT_EQ(sum_to<Real>(pack), sum);
    EXPECT_EQ(sum_to<TypeParam>(pack)[0], pack[0]) << "each lane for itself";
    EXPECT_EQ(bits_of(pack == TypeParam(100)), 1u << greatest);
    EXPECT_EQ(bits_of(!(pack == TypeParam(100))), ((1u << kLanes) - 1) & ~(1u << greatest));
  }
}

TYPED_TEST(PackOf, MasksGoToBitsAndBack) {
  constexpr int kLanes = kLanesOf<TypeParam>;
  for (unsigned bits = 0; bits < 1u << kLanes; ++bits) {
    const auto mask = mask_of_bits<TypeParam>(bits);
    EXPECT_EQ(bits_of(mask), bits);
    for (int k = 0; k < kLanes; ++k)
      EXPECT_EQ(lane(select(mask, TypeParam(1), TypeParam(0)), k) == 1, (bits >> k & 1u) != 0);
  }
  EXPECT_TRUE(mask_of_bits<double>(1));
  EXPECT_FALSE(mask_of_bits<double>(0));
}

TYPED_TEST(PackOf, RowsBecomeColumns) {
  using Real = RealOf<TypeParam>;
  constexpr int kLanes = kLanesOf<TypeParam>;
  TypeParam rows[kLanes];
  for (int row = 0; row < kLanes; ++row)
    rows[row] = TypeParam::of([&](int column) { return Real(100 * row + column); });
  transpose(rows);
  for (int row = 0; row < kLanes; ++row)
    for (int column = 0; column < kLanes; ++column)
      EXPECT_EQ(rows[row][column], Real(100 * column + row));
}

TYPED_TEST(PackOf, SumsOfSeveralAreThoseOfEach) {
  using Real = RealOf<TypeParam>;
  constexpr int kSize = 15, kLanes = kLanesOf<TypeParam>;
  TypeParam packs[kSize];
  for (int k = 0; k < kSize; ++k)
    packs[k] = TypeParam::of([&](int lane) { return Real(1) / Real(1 + k + lane * lane); });
  Real sums[kSize + kLanes];
  sum_lanes<kSize>(packs, sums);
  for (int k = 0; k < kSize; ++k) EXPECT_EQ(sums[k], sum_of_lanes(packs[k])) << k;
}

template <int Size, class PackType>
void expect_gathered_and_scattered() {
  using Real = RealOf<PackType>;
  constexpr int kLanes = kLanesOf<PackType>;
  Real from[kLanes][Size], to[kLanes][Size] = {};
  for (int of_lane = 0; of_lane < kLanes; ++of_lane)
    for (int k = 0; k < Size; ++k) from[of_lane][k] = Real(100 * of_lane + k + 1);
  PackType packs[Size];
  gather_lanes<Size>([&](int of_lane) { return from[of_lane]; }, packs);
  for (int of_lane = 0; of_lane < kLanes; ++of_lane)
    for (int k = 0; k < Size; ++k) EXPECT_EQ(packs[k][of_lane], from[of_lane][k]);
  for (int count = 1; count <= kLanes; ++count) {
    std::fill_n(&to[0][0], kLanes * Size, Real(0));
    scatter_lanes<Size>(packs, count, [&](int of_lane) { return to[of_lane]; });
    for (int of_lane = 0; of_lane < kLanes; ++of_lane)
      for (int k = 0; k < Size; ++k)
        EXPECT_EQ(to[of_lane][k], of_lane < count ? from[of_lane][k] : Real(0));
  }
}

TYPED_TEST(PackOf, ArraysAreGatheredIntoLanesAndScatteredBack) {
  expect_gathered_and_scattered<1, TypeParam>();
  expect_gathered_and_scattered<4, TypeParam>();
  expect_gathered_and_scattered<16, TypeParam>();
  expect_gathered_and_scattered<25, TypeParam>();
}

TYPED_TEST(PackOf, MatricesAreThoseOfEachLane) {
  using Real = RealOf<TypeParam>;
  std::mt19937 generator(1);
  std::uniform_int_distribution<int> integer(-20, 20);
  const auto draw = [&] {
    return Mat<TypeParam, 4, 4>(Mat<TypeParam, 4, 4>::NullaryExpr(
        [&] { return TypeParam::of([&](int) { return integer(generator); }); }));
  };
  const auto of_lane = [](const Mat<TypeParam, 4, 4>& m, int k) {
    return Mat<Real, 4, 4>(m.unaryExpr([k](const TypeParam& entry) { return entry[k]; }));
  };
  const Mat<TypeParam, 4, 4> a = draw(), b = draw();
  const Mat<TypeParam, 4, 4> product = a * b.transpose() + 2 * a - b;
  const Vec<TypeParam, 4> image = a * b.col(1);
  const TypeParam trace = a.trace(), square = a.col(2).squaredNorm();
  for (int k = 0; k < kLanesOf<TypeParam>; ++k) {
    const Mat<Real, 4, 4> u = of_lane(a, k), v = of_lane(b, k);
    EXPECT_EQ(of_lane(product, k), u * v.transpose() + 2 * u - v);
    EXPECT_EQ(trace[k], u.trace());
    EXPECT_EQ(square[k], u.col(2).squaredNorm());
    for (int i = 0; i < 4; ++i) EXPECT_EQ(image(i)[k], (u * v.col(1))(i));
  }
}

TEST(Pack, TemplatesSeeItAsANumber) {
  using Number = Pack<double, kNativeLanes<double>>;
  static_assert(std::same_as<RealOf<Number>, double>);
  static_assert(std::same_as<MaskOf<Number>, Number::Mask>);
  static_assert(kLanesOf<Number> == kNativeLanes<double> && kLanesOf<float> == 1);
  static_assert(sizeof(Number) == WAKELINE_REGISTER_BYTES && alignof(Number) == sizeof(Number));
  static_assert(std::is_trivially_copyable_v<Number>);
}

}  // namespace
}  // namespace wakeline::pack_test
