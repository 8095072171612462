// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/simd/pack_math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

namespace wakeline::pack_math_test {
namespace {

using Long = long double;

/// The same number, or both NaN.
template <class Real>
bool is_same(Real a, Real b) {
  return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
}

template <class PackType>
class PackMathOf : public ::testing::Test {
 protected:
  using Real = RealOf<PackType>;
  using Limits = std::numeric_limits<Real>;
  using Numbers = std::vector<Real>;
  static constexpr int kLanes = kLanesOf<PackType>;

  /// Of `count` numbers each: even between two bounds, and even in magnitude between two powers of
  /// two, of both signs.
  Numbers between(Real low, Real high, int count = 100'000) {
    return drawn(count, [&, even = std::uniform_real_distribution<Real>(low, high)]() mutable {
      return even(generator_);
    });
  }
  Numbers of_magnitudes(int low, int high, int count = 100'000) {
    return drawn(count, [&, exponent = std::uniform_int_distribution<int>(low, high),
                         mantissa = std::uniform_real_distribution<Real>(1, 2)]() mutable {
      const Real size = std::ldexp(mantissa(generator_), exponent(generator_));
      return generator_() % 2 ? size : -size;
    });
  }
  Numbers of_all_magnitudes() {
    return of_magnitudes(Limits::min_exponent - Limits::digits, Limits::max_exponent - 1);
  }
  /// The numbers next to each point.
  static Numbers around(const std::vector<Long>& points) {
    Numbers numbers;
    for (const Long point : points)
      for (const Real near : {Real(point), std::nextafter(Real(point), Limits::infinity()),
                              std::nextafter(Real(point), -Limits::infinity())}) {
        numbers.push_back(near);
        numbers.push_back(-near);
      }
    return numbers;
  }
  static Numbers special() {
    Numbers numbers =
        around({0, Limits::min(), Limits::max(), 0.5L, 1, 2, Limits::epsilon(), 1000, 1e6L});
    for (const Real number : {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()})
      numbers.push_back(number);
    return numbers;
  }

  /// The function of packs is that of long numbers, rounded, within `bound_ulp`, and is it to the
  /// sign at zeros, infinities and NaN.
  template <class Function, class Exact>
  void expect_within(Long bound_ulp, const char* name, const Function& function, const Exact& exact,
                     const Numbers& x, const Numbers& y = {}) {
    Long largest = 0;
    const int count = int(x.size());
    const auto at = [](const Numbers& numbers, int k) {
      return numbers.empty() ? Real(0) : numbers[std::size_t(k) % numbers.size()];
    };
    for (int first = 0; first < count; first += kLanes) {
      const PackType u = PackType::of([&](int k) { return at(x, first + k); });
      const PackType v = PackType::of([&](int k) { return at(y, first + k); });
      const PackType result = function(u, v);
      for (int k = 0; k < kLanes; ++k) {
        const Long wanted = exact(Long(u[k]), Long(v[k]));
        if (is_same(result[k], Real(wanted)) && !(std::abs(wanted) <= Limits::max())) continue;
        if (wanted == 0) {
          ASSERT_TRUE(is_same(result[k], Real(wanted))) << name << " of " << u[k] << " " << v[k];
          continue;
        }
        const Long error = std::abs(result[k] - wanted) / unit_in_last_place(wanted);
        ASSERT_LE(error, bound_ulp)
            << name << " of " << u[k] << " " << v[k] << " is " << result[k] << ", not " << wanted;
        ASSERT_EQ(std::signbit(result[k]), std::signbit(wanted)) << name << " of " << u[k];
        largest = std::max(largest, error);
      }
    }
    std::printf("%-6s %2d lanes of %-6s: %.2Lf of %.2Lf units in the last place\n", name, kLanes,
                sizeof(Real) == 8 ? "double" : "float", largest, bound_ulp);
  }

 private:
  template <class Draw>
  static Numbers drawn(int count, Draw&& draw) {
    Numbers numbers(static_cast<std::size_t>(count));
    std::generate(numbers.begin(), numbers.end(), draw);
    return numbers;
  }

  static Long unit_in_last_place(Long number) {
    int exponent;
    std::frexp(number, &exponent);
    return std::ldexp(
        Long(1), std::clamp(exponent, Limits::min_exponent, Limits::max_exponent) - Limits::digits);
  }

  std::mt19937_64 generator_{1};
};

template <class Numbers>
Numbers joined(Numbers a, const Numbers& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
template <class Numbers, class... More>
Numbers joined(const Numbers& a, const Numbers& b, const More&... more) {
  return joined(joined(a, b), more...);
}

using Packs = ::testing::Types<Pack<double, kNativeLanes<double>>, Pack<float, kNativeLanes<float>>,
                               Pack<double, 2>>;
TYPED_TEST_SUITE(PackMathOf, Packs, );

// Function f of one pack beside std::f, through the lookup that a template uses.
#define WAKELINE_ONE(f) \
#f,                             \
      [](auto x, auto) {          \
        using std::f;             \
        return f(x);              \
      },                          \
      [](Long x, Long) { return std::f(x); }
#define WAKELINE_TWO(f) \
#f,                             \
      [](auto x, auto y) {        \
        using std::f;             \
        return f(x, y);           \
      },                          \
      [](Long x, Long y) { return std::f(x, y); }

TYPED_TEST(PackMathOf, Exponential) {
  using Limits = typename TestFixture::Limits;
  const Long largest = std::log(Long(Limits::max())), least = std::log(Long(Limits::min())),
             zero = std::log(Long(Limits::denorm_min()) / 2);
  const auto everywhere =
      joined(this->between(RealOf<TypeParam>(zero) - 2, RealOf<TypeParam>(largest) + 2),
             this->between(-1, 1), this->of_all_magnitudes(), this->special(),
             this->around({largest, least, zero, std::log(2.L) / 2, 3 * std::log(2.L) / 2}));
  this->expect_within(1.1L, WAKELINE_ONE(exp), everywhere);
  this->expect_within(1.3L, WAKELINE_ONE(expm1), joined(everywhere, this->between(-3, 50)));
}

TYPED_TEST(PackMathOf, Logarithm) {
  this->expect_within(
      0.9L, WAKELINE_ONE(log),
      joined(this->of_all_magnitudes(), this->between(0.5, 2), this->between(0, 100),
             this->of_magnitudes(-3, 3), this->special(),
             this->around({std::sqrt(0.5L), std::sqrt(2.L), std::exp(1.L), 1e-6L, 1e9L})));
}

TYPED_TEST(PackMathOf, SineAndCosine) {
  using Real = RealOf<TypeParam>;
  std::vector<Long> eighths;
  for (int k = 1; k < 130'000; k += k < 1000 ? 1 : 7) eighths.push_back(k * std::atan(Long(1)));
  const auto everywhere = joined(this->between(-7, 7), this->between(-400, 400),
                                 this->between(Real(-1.1e5), Real(1.1e5)),
                                 this->of_all_magnitudes(), this->special(), this->around(eighths));
  this->expect_within(1.2L, WAKELINE_ONE(sin), everywhere);
  this->expect_within(1.2L, WAKELINE_ONE(cos), everywhere);
  for (std::size_t k = 0; k < everywhere.size(); k += 97) {
    const TypeParam angle = everywhere[k];
    const auto both = sin_cos(angle);
    EXPECT_TRUE(is_same(both.sin[0], sin(angle)[0]) && is_same(both.cos[0], cos(angle)[0]));
  }
}

TYPED_TEST(PackMathOf, Arctangent) {
  const auto everywhere =
      joined(this->between(-2, 2), this->of_magnitudes(-3, 2), this->of_all_magnitudes());
  this->expect_within(1.6L, WAKELINE_ONE(atan), joined(everywhere, this->special()));
  this->expect_within(
      1.6L, WAKELINE_TWO(atan2), everywhere,
      joined(this->between(-2, 2), this->of_magnitudes(-3, 2), this->of_all_magnitudes()));
  // About the axes, the diagonals, and where the arithmetic changes.
  this->expect_within(
      1.6L, WAKELINE_TWO(atan2),
      this->around({1e-30L, 0.5L, 0.5625L, std::tan(0.5L), 1, 1 / 0.5625L, 2, 1e30L}), {1, -1});
}

TYPED_TEST(PackMathOf, Hypotenuse) {
  using Limits = typename TestFixture::Limits;
  const auto everywhere =
      joined(this->between(-2, 2), this->of_magnitudes(-3, 2), this->of_all_magnitudes(),
             this->of_magnitudes(Limits::min_exponent - 5, Limits::min_exponent + 5),
             this->of_magnitudes(Limits::max_exponent - 5, Limits::max_exponent - 1));
  auto others = everywhere;
  std::mt19937 generator(1);
  for (std::size_t k = 0; k < others.size(); ++k)
    if (k >= others.size() / 4) others[k] = std::ldexp(others[k] / 2, int(generator() % 5) - 2);
  std::rotate(others.begin(), others.begin() + 7, others.end());
  this->expect_within(1.3L, WAKELINE_TWO(hypot), everywhere, others);
}

TYPED_TEST(PackMathOf, TwoSpecialNumbersAsTheStandardHasThem) {
  const auto numbers = this->special();
  std::vector<RealOf<TypeParam>> y, x;
  for (const auto v : numbers)
    for (const auto u : numbers) y.push_back(v), x.push_back(u);
  this->expect_within(1.6L, WAKELINE_TWO(atan2), y, x);
  this->expect_within(1.3L, WAKELINE_TWO(hypot), y, x);
}

// Beside a lane of every kind of number each lane has the result that it has alone.
TYPED_TEST(PackMathOf, LanesDoNotInfluenceEachOther) {
  constexpr int kLanes = kLanesOf<TypeParam>;
  const auto numbers = joined(this->special(), this->between(-4, 4, 20));
  const auto functions = [](TypeParam x, TypeParam y) {
    return std::vector<TypeParam>{exp(x), expm1(x), log(x),      sin(x),
                                  cos(x), atan(x),  atan2(x, y), hypot(x, y)};
  };
  for (const auto a : numbers)
    for (const auto b : numbers) {
      const TypeParam y = TypeParam(1);
      const auto alone = functions(TypeParam(a), y);
      for (int odd = 0; odd < kLanes; ++odd) {
        TypeParam mixed = a;
        mixed.set(odd, b);
        const auto beside = functions(mixed, y);
        for (std::size_t f = 0; f < alone.size(); ++f)
          for (int k = 0; k < kLanes; ++k)
            ASSERT_TRUE(k == odd || is_same(beside[f][k], alone[f][k]))
                << f << " of " << a << " beside " << b;
      }
    }
}

}  // namespace
}  // namespace wakeline::pack_math_test
