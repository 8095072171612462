// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "support/draw.hpp"
#include "support/malloc_fence.hpp"
#include "wakeline/filter/adaptive_alpha_beta.hpp"
#include "wakeline/filter/alpha_beta_smoother.hpp"
#include "wakeline/filter/exponential_smoother.hpp"
#include "wakeline/filter/three_point_smoother.hpp"
#include "wakeline/filter/window_bank.hpp"

namespace wakeline::smoothers_test {
namespace {

using test::Draw;

// Laws of every smoother
// ---------------------------------------------------------------------------

struct Adaptive3 {
  template <class Residual, class Scalar>
  struct Of : ThreePointSmoother<Residual, Scalar> {
    Of() : ThreePointSmoother<Residual, Scalar>({.adaptive = true, .parabola = false}) {}
  };
};

/// A kind of smoother, over lines and over angles.
template <template <class, class> class Kind, class S>
struct Both {
  using Scalar = S;
  using OnLine = Kind<Linear, S>;
  using OnAngles = Kind<Wrapped, S>;
};
template <class R, class S>
using Exponential = ExponentialSmoother<R, S>;
template <class R, class S>
using AdaptiveExponential = AdaptiveExponentialSmoother<R, 5, S>;
template <class R, class S>
using ThreePoint = ThreePointSmoother<R, S>;
template <class R, class S>
using AdaptiveThreePoint = Adaptive3::Of<R, S>;
template <class R, class S>
using Growing = AlphaBetaSmoother<GrowingMemory, R, S>;
template <class R, class S>
using Recent = AlphaBetaSmoother<RecentMemory, R, S>;
template <class R, class S>
using ByRange = AlphaBetaSmoother<RangeDependent, R, S>;
template <class R, class S>
using TwoPasses = AdaptiveAlphaBeta<R, 5, S>;
template <class R, class S>
using Bank = WindowBank<R, 32, S>;

template <class Case>
class EverySmoother : public ::testing::Test {};
using Cases =
    ::testing::Types<Both<Exponential, double>, Both<AdaptiveExponential, double>,
                     Both<ThreePoint, double>, Both<AdaptiveThreePoint, double>,
                     Both<Growing, double>, Both<Recent, double>, Both<ByRange, double>,
                     Both<TwoPasses, double>, Both<Bank, double>, Both<TwoPasses, float>,
                     Both<Bank, float>, Both<ThreePoint, float>, Both<Exponential, float>>;
TYPED_TEST_SUITE(EverySmoother, Cases, );

TYPED_TEST(EverySmoother, IsASmoother) {
  static_assert(Smoother<typename TypeParam::OnLine>);
  static_assert(Smoother<typename TypeParam::OnAngles>);
}

TYPED_TEST(EverySmoother, KeepsWhatDoesNotChange) {
  using Scalar = typename TypeParam::Scalar;
  typename TypeParam::OnLine smoother;
  for (int k = 0; k < 50; ++k) {
    ASSERT_EQ(smoother.update(Scalar(1 + k % 3), Scalar(7)), Status::kOk);
    EXPECT_NEAR(smoother.value(), 7, 1e-5);
    EXPECT_NEAR(smoother.rate(), 0, 1e-5);
    EXPECT_NEAR(smoother.forecast(Scalar(10)), 7, 1e-4);
  }
}

TYPED_TEST(EverySmoother, OfAnglesIsThatOfTheUnwrappedOnes) {
  using Scalar = typename TypeParam::Scalar;
  const double tolerance = std::is_same_v<Scalar, double> ? 1e-9 : 2e-3;
  typename TypeParam::OnLine on_line;
  typename TypeParam::OnAngles on_angles;
  Draw draw(1);
  double course = deg(350);
  for (int k = 0; k < 200; ++k) {
    course += deg(k < 100 ? 3 : -4) + 0.01 * draw.normal();
    const Scalar dt = Scalar(0.5 + k % 4);
    ASSERT_EQ(on_line.update(dt, Scalar(course)), Status::kOk);
    ASSERT_EQ(on_angles.update(dt, wrap_angle(Scalar(course))), Status::kOk);
    EXPECT_LE(std::abs(on_angles.value()), kPi<Scalar> + Scalar(1e-6));
    EXPECT_NEAR(wrap_angle(double(on_angles.value() - on_line.value())), 0, tolerance);
    EXPECT_NEAR(on_angles.rate(), on_line.rate(), tolerance);
    EXPECT_NEAR(wrap_angle(double(on_angles.forecast(dt) - on_line.forecast(dt))), 0,
                10 * tolerance);
  }
}

TYPED_TEST(EverySmoother, RejectsInvalidReadingsAndStaysUnchanged) {
  using Scalar = typename TypeParam::Scalar;
  constexpr Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
  constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
  typename TypeParam::OnLine smoother, same;
  EXPECT_EQ(smoother.update(nan, nan), Status::kNotFinite);
  EXPECT_EQ(smoother.update(nan, Scalar(3)), Status::kOk);  // the first step means nothing
  EXPECT_EQ(same.update(Scalar(0), Scalar(3)), Status::kOk);
  for (int k = 0; k < 12; ++k) {
    const Scalar reading = Scalar(k * k % 7);
    EXPECT_EQ(smoother.update(Scalar(1), nan), Status::kNotFinite);
    EXPECT_EQ(smoother.update(Scalar(1), infinity), Status::kNotFinite);
    EXPECT_EQ(smoother.update(nan, reading), Status::kNotFinite);
    EXPECT_EQ(smoother.update(Scalar(-1), reading), Status::kNegativeTimeStep);
    EXPECT_EQ(smoother.update(Scalar(2), reading), Status::kOk);
    EXPECT_EQ(same.update(Scalar(2), reading), Status::kOk);
    EXPECT_EQ(smoother.value(), same.value());
    EXPECT_EQ(smoother.rate(), same.rate());
  }
}

TYPED_TEST(EverySmoother, RejectsReadingsOutOfRange) {
  using Scalar = typename TypeParam::Scalar;
  constexpr Scalar most = Scalar(kLargestInput);
  typename TypeParam::OnLine smoother;
  for (int k = 0; k < 10; ++k) ASSERT_EQ(smoother.update(Scalar(1), Scalar(k)), Status::kOk);
  for (const Scalar sign : {Scalar(1), Scalar(-1)}) {
    EXPECT_EQ(smoother.update(Scalar(1), sign * 2 * most), Status::kNotFinite);
    EXPECT_EQ(smoother.update(Scalar(1), sign * most), Status::kOk);
    EXPECT_TRUE(std::isfinite(smoother.value()));
    EXPECT_TRUE(std::isfinite(smoother.rate()));
  }
  for (int k = 0; k < 100; ++k) {
    ASSERT_EQ(smoother.update(Scalar(1), Scalar(k)), Status::kOk);
    EXPECT_TRUE(std::isfinite(smoother.value()));
    EXPECT_TRUE(std::isfinite(smoother.rate()));
  }
}

TYPED_TEST(EverySmoother, StaysFiniteWhateverItTakes) {
  using Scalar = typename TypeParam::Scalar;
  const Scalar far[] = {Scalar(kLargestInput), Scalar(-1e6)};
  const Scalar step_s[] = {Scalar(1e-6), Scalar(1e-3), Scalar(0), Scalar(1e6),
                           Scalar(2 * kLargestInput)};
  Draw draw(9);
  for (int run = 0; run < 200; ++run) {
    typename TypeParam::OnLine smoother;
    for (int k = 0; k < 20; ++k) {
      const bool is_far = draw.uniform(0, 1) < 0.15, is_odd = draw.uniform(0, 1) < 0.4;
      const Scalar reading = is_far ? far[int(draw.uniform(0, 2))] : Scalar(9 * draw.normal());
      const Scalar dt_s = is_odd ? step_s[int(draw.uniform(0, 5))] : Scalar(draw.uniform(0.01, 9));
      (void)smoother.update(dt_s, reading);
      ASSERT_TRUE(std::isfinite(smoother.value())) << "run " << run << ", reading " << k;
      ASSERT_TRUE(std::isfinite(smoother.rate())) << "run " << run << ", reading " << k;
    }
  }
}

TYPED_TEST(EverySmoother, NeedsNoHeapAndStaysFiniteWithZeroTimeSteps) {
  using Scalar = typename TypeParam::Scalar;
  typename TypeParam::OnAngles smoother;
  const test::NoHeap fence;
  for (int k = 0; k < 100; ++k) {
    (void)smoother.update(Scalar(k % 5 == 0 ? 0 : 1), Scalar(k % 11));
    EXPECT_TRUE(std::isfinite(smoother.forecast(Scalar(3)) + smoother.rate()));
  }
  EXPECT_EQ(fence.allocations(), 0);
}

TYPED_TEST(EverySmoother, TakesTwoReadingsOfOneTime) {
  using Scalar = typename TypeParam::Scalar;
  typename TypeParam::OnLine smoother;
  for (int k = 0; k < 9; ++k)
    for (const int dt : {1, 0})
      ASSERT_EQ(smoother.update(Scalar(dt), Scalar(k)), Status::kOk) << "reading " << k;
  EXPECT_NEAR(double(smoother.forecast(Scalar(0))), 8.0, 1.0);
}

TYPED_TEST(EverySmoother, ContinuesFromAnArchiveBitForBit) {
  using Scalar = typename TypeParam::Scalar;
  for (const int taken : {0, 1, 2, 4, 9, 60}) {
    typename TypeParam::OnAngles saved, restored;
    Draw draw(10);
    for (int k = 0; k < taken; ++k)
      ASSERT_EQ(saved.update(Scalar(1 + k % 3), Scalar(draw.normal())), Status::kOk);
    for (int k = 0; k < 7; ++k)  // which the archive wipes out
      ASSERT_EQ(restored.update(Scalar(2), Scalar(draw.normal())), Status::kOk);
    Archive written;
    saved.archive(written);
    Archive read(written.bytes());
    restored.archive(read);
    ASSERT_TRUE(read.ok() && read.at_end());
    for (int k = 0; k < 20; ++k) {
      EXPECT_EQ(restored.value(), saved.value());
      EXPECT_EQ(restored.rate(), saved.rate());
      EXPECT_EQ(restored.forecast(Scalar(5)), saved.forecast(Scalar(5)));
      const Scalar reading = Scalar(3 + draw.normal());
      ASSERT_EQ(saved.update(Scalar(1.5), reading), Status::kOk);
      ASSERT_EQ(restored.update(Scalar(1.5), reading), Status::kOk);
    }
  }
}

TYPED_TEST(EverySmoother, RejectsADamagedArchiveAndStaysUnchanged) {
  using Scalar = typename TypeParam::Scalar;
  typename TypeParam::OnLine smoother, same;
  for (int k = 0; k < 9; ++k) {
    ASSERT_EQ(smoother.update(Scalar(1), Scalar(k * k % 7)), Status::kOk);
    ASSERT_EQ(same.update(Scalar(1), Scalar(k * k % 7)), Status::kOk);
  }
  Archive written;
  typename TypeParam::OnLine{}.archive(written);
  for (std::size_t size = 0; size < written.bytes().size(); ++size) {
    Archive cut(std::span(written.bytes()).first(size));
    smoother.archive(cut);
    ASSERT_FALSE(cut.ok());
    EXPECT_EQ(smoother.value(), same.value());
    EXPECT_EQ(smoother.rate(), same.rate());
  }
  ASSERT_EQ(smoother.update(Scalar(1), Scalar(2)), Status::kOk);
  ASSERT_EQ(same.update(Scalar(1), Scalar(2)), Status::kOk);
  EXPECT_EQ(smoother.forecast(Scalar(3)), same.forecast(Scalar(3)));
}

/// All bits set: counts of -1.
template <class S>
bool takes_ones() {
  Archive written;
  S{}.archive(written);
  const std::vector<std::byte> ones(written.bytes().size(), std::byte{0xFF});
  Archive read{ones};
  S{}.archive(read);
  return read.ok();
}

TEST(Smoothers, RejectInvalidCounts) {
  EXPECT_FALSE(takes_ones<AdaptiveExponentialSmoother<>>());
  EXPECT_FALSE(takes_ones<ThreePointSmoother<>>());
  EXPECT_FALSE(takes_ones<AlphaBetaSmoother<>>());
  EXPECT_FALSE(takes_ones<AdaptiveAlphaBeta<>>());
  EXPECT_FALSE(takes_ones<WindowBank<>>());

  // A bank of fewer windows than the one that spoke.
  WindowBank<> longer({.max_readings = 32, .memory = 1.0}), shorter({.max_readings = 4});
  Draw draw(11);
  for (int k = 0; k < 64; ++k) ASSERT_EQ(longer.update(1, draw.normal()), Status::kOk);
  ASSERT_GT(longer.window(), 4);
  Archive written;
  longer.archive(written);
  Archive read{written.bytes()};
  shorter.archive(read);
  EXPECT_FALSE(read.ok());
  EXPECT_EQ(shorter.window(), 0);
}

template <class Case>
class SmootherOfLines : public ::testing::Test {};
using OfLines =
    ::testing::Types<Both<AdaptiveThreePoint, double>, Both<TwoPasses, double>, Both<Bank, double>>;
TYPED_TEST_SUITE(SmootherOfLines, OfLines, );

TYPED_TEST(SmootherOfLines, FollowsALineAtUnevenSteps) {
  typename TypeParam::OnLine smoother;
  double now = 0;
  for (int k = 0; k < 40; ++k) {
    const double dt = 1 + (k * k) % 5;
    now += dt;
    ASSERT_EQ(smoother.update(dt, 3 - 0.5 * now), Status::kOk);
    if (k < 5) continue;
    EXPECT_NEAR(smoother.rate(), -0.5, 1e-9);
    EXPECT_NEAR(smoother.forecast(10), 3 - 0.5 * (now + 10), 1e-8);
  }
}

TYPED_TEST(SmootherOfLines, IsTheSameWhenEachReadingIsRepeated) {
  typename TypeParam::OnLine twice, once;
  Draw draw(14);
  for (int k = 0; k < 100; ++k) {
    const double dt = 1 + k % 3, reading = (k > 50 ? 3.0 * k : 0.0) + draw.normal();
    for (const double step : {dt, 0.0, 0.0}) ASSERT_EQ(twice.update(step, reading), Status::kOk);
    ASSERT_EQ(once.update(dt, reading), Status::kOk);
    EXPECT_EQ(twice.value(), once.value());
    EXPECT_EQ(twice.rate(), once.rate());
  }
}

// Each of them
// -------------------------------------------------------------------------------------

TEST(ExponentialSmoother, ForgetsGeometrically) {
  ExponentialSmoother<> smoother(0.3);
  ASSERT_EQ(smoother.update(1, 1), Status::kOk);
  for (int k = 1; k < 20; ++k) {
    ASSERT_EQ(smoother.update(1, 0), Status::kOk);
    EXPECT_NEAR(smoother.value(), std::pow(0.7, k), 1e-12);
  }
  for (const double alpha : {0.0, -1.0, 1.5, double(NAN)})
    EXPECT_THROW((ExponentialSmoother<>(alpha)), std::invalid_argument);
}

TEST(AdaptiveExponentialSmoother, FollowsAJumpAndRestsInNoise) {
  AdaptiveExponentialSmoother<> smoother;
  Draw draw(2);
  double at_rest = 0;
  for (int k = 0; k < 500; ++k) {
    ASSERT_EQ(smoother.update(1, draw.normal()), Status::kOk);
    if (k > 10) at_rest += smoother.alpha() / 489;
  }
  double in_motion = 0;
  for (int k = 0; k < 500; ++k) {
    ASSERT_EQ(smoother.update(1, 20.0 * k + draw.normal()), Status::kOk);
    if (k > 10) in_motion += smoother.alpha() / 489;
  }
  EXPECT_LT(at_rest, 0.8);
  EXPECT_GT(in_motion, at_rest + 0.15);
}

// The line of two readings rises by 1, and meets 5/6 of what a third one is off by. To 3 it goes by
// 11/6 of 2, to 1.5 by 7/12 of 0.5: (1 + 11/3) / 5 and (1 + 7/24) / 1.25 of all that was read.
TEST(AdaptiveExponentialSmoother, GoesAsFarAsTheLineButNotBeyondAReading) {
  for (const auto& [third, alpha] : {std::pair{3.0, 14.0 / 15.0}, std::pair{1.5, 1.0}}) {
    AdaptiveExponentialSmoother<> smoother;
    for (const double reading : {0.0, 1.0, third})
      ASSERT_EQ(smoother.update(1, reading), Status::kOk);
    EXPECT_NEAR(smoother.alpha(), alpha, 1e-12);
    EXPECT_NEAR(smoother.value(), 1.0 + alpha * (third - 1.0), 1e-12);
  }
}

TEST(ThreePoints, DifferentiateParabolas) {
  const double a = 0.3, b = -2, c = 5;  // a t² + b t + c about t = 0
  const auto about_zero = [&](double before_s, double after_s) {
    const auto x = [&](double t) { return a * t * t + b * t + c; };
    return ThreePoints<double>{x(-before_s) - c, x(after_s) - c, before_s, after_s};
  };
  EXPECT_NEAR(about_zero(1, 4).parabola_rate(), b, 1e-12);
  EXPECT_NEAR(about_zero(2, 2).parabola_rate(), b, 1e-12);
  EXPECT_NEAR(about_zero(2, 2).simpson_rate(), b, 1e-12);
  // 2/3 c + (b + f)/6: of a parabola its bend times (t_+ - t_-) (2/3 + 1/6).
  EXPECT_NEAR(about_zero(1, 4).simpson_rate(), b + a * 3 * 5 / 6, 1e-12);
}

TEST(ThreePoints, TheSimpsonFormPassesLessNoiseAtUnevenSteps) {
  Draw draw(4);
  double simpson = 0, parabola = 0;
  for (int k = 0; k < 4000; ++k) {
    const double middle = draw.normal();
    const ThreePoints<double> points{draw.normal() - middle, draw.normal() - middle, 1, 4};
    simpson += points.simpson_rate() * points.simpson_rate();
    parabola += points.parabola_rate() * points.parabola_rate();
  }
  EXPECT_LT(simpson, 0.5 * parabola);
}

TEST(ThreePointSmoother, IsTheWeightedMeanOfNeighbours) {
  ThreePointSmoother<> smoother({.weight_before_s = 2, .weight_after_s = 3});
  ASSERT_EQ(smoother.update(0, 10), Status::kOk);
  ASSERT_EQ(smoother.update(4, 20), Status::kOk);
  EXPECT_DOUBLE_EQ(smoother.value(), 10 + 0.0);
  ASSERT_EQ(smoother.update(6, 35), Status::kOk);
  EXPECT_DOUBLE_EQ(smoother.delay_s(), 6.0);
  EXPECT_NEAR(smoother.value(), (0.5 * 10 + 20 + 0.5 * 35) / 2, 1e-12);
  EXPECT_THROW((ThreePointSmoother<>({.weight_before_s = -1})), std::invalid_argument);
}

/// Two readings of each time are as their mean, of angles that pass through pi, to a smoother
/// of a kind that is given twice.
template <class Smoother>
void expect_mean_of_two(Smoother twice, Smoother once) {
  Draw draw(12);
  for (int k = 0; k < 20; ++k) {
    const double reading = 3.0 + 0.1 * k + 0.1 * draw.normal(), dt = 1.0 + k % 3;
    ASSERT_EQ(twice.update(dt, wrap_angle(reading - 0.05)), Status::kOk);
    ASSERT_EQ(twice.update(0, wrap_angle(reading + 0.05)), Status::kOk);
    ASSERT_EQ(once.update(dt, wrap_angle(reading)), Status::kOk);
    EXPECT_NEAR(wrap_angle(twice.value() - once.value()), 0, 1e-9);
    EXPECT_NEAR(twice.rate(), once.rate(), 1e-9);
    EXPECT_EQ(twice.update(0, NAN), Status::kNotFinite);
  }
}

TEST(ThreePointSmoother, TwoReadingsOfOneTimeAreTheirMean) {
  for (const bool adaptive : {false, true}) {
    const ThreePointSmoother<Wrapped> fresh({.adaptive = adaptive});
    expect_mean_of_two(fresh, fresh);
  }
}

TEST(ThreePointSmoother, SmoothsNoiseAndItsAdaptiveWeightsComeNearTheLine) {
  Draw draw(5);
  ThreePointSmoother<> fixed, adaptive({.adaptive = true});
  double fixed_error = 0, adaptive_error = 0;
  constexpr int n = 4000;
  for (int k = 0; k < n; ++k) {
    const double reading = 0.2 * k + draw.normal();
    ASSERT_EQ(fixed.update(1, reading), Status::kOk);
    ASSERT_EQ(adaptive.update(1, reading), Status::kOk);
    if (k < 5) continue;
    fixed_error += std::pow(fixed.value() - 0.2 * (k - 1), 2) / n;
    adaptive_error += std::pow(adaptive.value() - 0.2 * (k - 1), 2) / n;
  }
  EXPECT_NEAR(fixed_error, 1.0 / 3, 0.03);  // three equal readings
  EXPECT_LT(adaptive_error, 0.65);  // a line through five would have 0.3, the reading itself 1
}

TEST(AlphaBetaSmoother, OfGrowingMemoryIsTheLineThroughAll) {
  AlphaBetaSmoother<> smoother;
  Draw draw(6);
  double t_sum = 0, x_sum = 0, tt = 0, tx = 0;
  for (int k = 0; k < 100; ++k) {
    const double t = 2.0 * k, x = 5 + 0.3 * t + draw.normal();
    ASSERT_EQ(smoother.update(2, x), Status::kOk);
    t_sum += t;
    x_sum += x;
    tt += t * t;
    tx += t * x;
    const double n = k + 1;
    if (k == 0) continue;
    const double slope = (n * tx - t_sum * x_sum) / (n * tt - t_sum * t_sum);
    EXPECT_NEAR(smoother.rate(), slope, 1e-9);
    EXPECT_NEAR(smoother.value(), (x_sum - slope * t_sum) / n + slope * t, 1e-9);
  }
}

TEST(AlphaBetaSmoother, OfRecentMemoryIsTheLineWithWeightsThatGrow) {
  AlphaBetaSmoother<RecentMemory> smoother;
  Draw draw(7);
  double w_sum = 0, t_sum = 0, x_sum = 0, tt = 0, tx = 0;
  for (int k = 0; k < 100; ++k) {
    const double w = k + 1, t = k, x = 5 - 0.3 * t + draw.normal();
    ASSERT_EQ(smoother.update(1, x), Status::kOk);
    w_sum += w;
    t_sum += w * t;
    x_sum += w * x;
    tt += w * t * t;
    tx += w * t * x;
    if (k == 0) continue;
    const double slope = (w_sum * tx - t_sum * x_sum) / (w_sum * tt - t_sum * t_sum);
    EXPECT_NEAR(smoother.rate(), slope, 1e-9);
    EXPECT_NEAR(smoother.forecast(0), (x_sum - slope * t_sum) / w_sum + slope * t, 1e-9);
  }
}

TEST(AlphaBetaSmoother, HasTheSchedulesOfThePaper) {
  const auto gains = [](const auto& schedule, std::int64_t reading, double range_m = 0) {
    return schedule.template gains<2, double>({.reading = double(reading), .range_m = range_m});
  };
  for (std::int64_t i = 2; i < 50; ++i) {
    const double n = double(i);
    EXPECT_NEAR(gains(GrowingMemory{}, i)[0], 2 * (2 * n - 1) / (n * (n + 1)), 1e-12);
    EXPECT_EQ(gains(GrowingMemory{.plots_before = 1}, i), gains(GrowingMemory{}, i + 1));
    EXPECT_NEAR(gains(RecentMemory{}, i)[1], 12 / ((n + 1) * (n + 2)), 1e-12);
  }
  for (const double range_km : {1.0, 19.0, 20.0, 35.0, 40.0, 60.0, 99.0, 150.0, 390.0, 500.0}) {
    EXPECT_DOUBLE_EQ(gains(RangeDependent{}, 5, 1e3 * range_km)[0],
                     std::clamp(20 / range_km, 0.2, 0.5));
    EXPECT_DOUBLE_EQ(gains(RangeDependent{}, 5, 1e3 * range_km)[1],
                     std::clamp(4 / range_km, 0.01, 0.2));
  }
  EXPECT_EQ(gains(RecentMemory{.max_plots = 4}, 100), gains(RecentMemory{}, 4));
  EXPECT_THROW((AlphaBetaSmoother<RecentMemory>({.max_plots = 1})), std::invalid_argument);
  EXPECT_THROW((AlphaBetaSmoother<ConstantGains>({.alpha = 2})), std::invalid_argument);
  EXPECT_THROW((AlphaBetaSmoother<>({}, 0.0)), std::invalid_argument);
}

TEST(AlphaBetaSmoother, RejectsANanRangeAndStaysUnchanged) {
  AlphaBetaSmoother<RangeDependent> smoother;
  ASSERT_EQ(smoother.update(0, 1, 1e3), Status::kOk);
  EXPECT_EQ(smoother.update(1, 2, std::numeric_limits<double>::quiet_NaN()), Status::kNotFinite);
  EXPECT_EQ(smoother.value(), 1.0);
  EXPECT_EQ(smoother.update(1, 2, 1e3), Status::kOk);
  EXPECT_EQ(smoother.value(), 1.5);
}

TEST(AdaptiveAlphaBeta, GoesThroughAManeuverFasterThanAtRest) {
  AdaptiveAlphaBeta<> smoother;
  Draw draw(8);
  double rest = 0, turn = 0;
  for (int k = 0; k < 400; ++k) {
    ASSERT_EQ(smoother.update(1, draw.normal()), Status::kOk);
    if (k >= 5) rest += smoother.beta() / 395;
    EXPECT_GT(smoother.alpha(), 0.5);
    EXPECT_LE(smoother.alpha(), 1.0);
  }
  for (int k = 0; k < 400; ++k) {
    ASSERT_EQ(smoother.update(1, 5.0 * k * k + draw.normal()), Status::kOk);
    if (k >= 5) turn += smoother.alpha() / 395;
  }
  EXPECT_LT(rest, 0.65);
  EXPECT_GT(turn, 0.7);
}

TEST(AdaptiveAlphaBeta, LooksBackNoFurtherThanItsWindow) {
  for (const int window : {3, 5, 16}) {
    AdaptiveAlphaBeta<> after_noise({.window = window}), fresh({.window = window});
    Draw draw(9);
    for (int k = 0; k < 30; ++k) ASSERT_EQ(after_noise.update(1, draw.normal()), Status::kOk);
    for (int k = 0; k < window; ++k) {
      const double reading = draw.normal();
      ASSERT_EQ(after_noise.update(1, reading), Status::kOk);
      ASSERT_EQ(fresh.update(1, reading), Status::kOk);
    }
    EXPECT_NEAR(after_noise.value(), fresh.value(), 1e-12);
    EXPECT_NEAR(after_noise.rate(), fresh.rate(), 1e-12);
    EXPECT_NEAR(after_noise.alpha(), fresh.alpha(), 1e-12);
  }
  EXPECT_THROW(AdaptiveAlphaBeta<>({.window = 2}), std::invalid_argument);
  EXPECT_THROW(AdaptiveAlphaBeta<>({.window = 17}), std::invalid_argument);
}

TEST(AdaptiveAlphaBeta, TwoReadingsOfOneTimeAreTheirMean) {
  expect_mean_of_two(AdaptiveAlphaBeta<Wrapped>(), AdaptiveAlphaBeta<Wrapped>());
}

TEST(WindowBank, RestsOnLongWindowsAndManeuversOnShortOnes) {
  WindowBank<> bank;
  Draw draw(10);
  double rest = 0, maneuver = 0;
  for (int k = 0; k < 300; ++k) {
    ASSERT_EQ(bank.update(1, 0.5 * k + draw.normal()), Status::kOk);
    if (k >= 100) rest += bank.window() / 200.0;
  }
  for (int k = 0; k < 300; ++k) {
    ASSERT_EQ(bank.update(1, 150 + 60 * std::sin(0.1 * k) + draw.normal()), Status::kOk);
    if (k >= 100) maneuver += bank.window() / 200.0;
  }
  EXPECT_GT(rest, 20.0);
  EXPECT_LT(maneuver, 10.0);
}

TEST(WindowBank, OfOneWindowIsItsLine) {
  WindowBank<> bank({.max_readings = 2});
  Draw draw(11);
  double last = 0;
  for (int k = 0; k < 50; ++k) {
    const double reading = draw.normal(), dt = draw.uniform(1, 3);
    ASSERT_EQ(bank.update(dt, reading), Status::kOk);
    EXPECT_NEAR(bank.value(), reading, 1e-12);
    if (k > 0) {
      EXPECT_NEAR(bank.rate(), (reading - last) / dt, 1e-9);
    }
    last = reading;
  }
  WindowBank<Linear, 2> small, same({.max_readings = 2});
  for (const double reading : {1.0, 3.0, 4.0}) {
    ASSERT_EQ(small.update(1.0, reading), Status::kOk);
    ASSERT_EQ(same.update(1.0, reading), Status::kOk);
    EXPECT_EQ(small.forecast(1.0), same.forecast(1.0));
  }
  EXPECT_THROW((WindowBank<>({.max_readings = 1})), std::invalid_argument);
  EXPECT_THROW((WindowBank<>({.max_readings = 33})), std::invalid_argument);
  EXPECT_THROW((WindowBank<>({.memory = 1.1})), std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::smoothers_test
