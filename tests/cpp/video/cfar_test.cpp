// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/video/cfar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

#include "support/malloc_fence.hpp"

namespace wakeline::cfar_test {
namespace {

template <class Amplitude>
std::vector<Amplitude> draw(std::size_t cells, std::mt19937& random) {
  constexpr int kMost = Cfar<Amplitude>::kMost;
  std::uniform_int_distribution<int> any(0, kMost), small(0, 20), kind(0, 9);
  std::vector<Amplitude> sweep(cells);
  for (auto& a : sweep) {
    const int which = kind(random);
    a = static_cast<Amplitude>(which == 0 ? kMost : which < 3 ? any(random) : small(random));
  }
  return sweep;
}

/// The definition, word by word.
template <class Amplitude>
Amplitude threshold_by_definition(const CfarSettings& cfar, const std::vector<Amplitude>& sweep,
                                  int cell) {
  std::vector<std::uint64_t> training;
  for (int i = 0; i < static_cast<int>(sweep.size()); ++i) {
    const int away = std::abs(i - cell);
    if (away > cfar.guard_cells && away <= cfar.guard_cells + cfar.train_cells)
      training.push_back(sweep[static_cast<std::size_t>(i)]);
  }
  if (training.empty()) return Cfar<Amplitude>::kMost;
  const int count = static_cast<int>(training.size());
  std::uint64_t level = 0;
  if (cfar.kind == CfarKind::kCellAveraging) {
    std::uint64_t sum = 0;
    for (const auto a : training) sum += a;
    level =
        sum * static_cast<std::uint64_t>(std::ceil(65536 * cfar.threshold_factor / count - 1e-9)) >>
        16;
  } else {
    std::ranges::sort(training);
    level = training[static_cast<std::size_t>(cfar.rank_of(count) - 1)] *
                static_cast<std::uint64_t>(std::ceil(65536 * cfar.threshold_factor - 1e-9)) >>
            16;
  }
  level += static_cast<std::uint64_t>(cfar.threshold_offset);
  level = std::max(level, static_cast<std::uint64_t>(cfar.least_amplitude - 1));
  return static_cast<Amplitude>(std::min<std::uint64_t>(level, Cfar<Amplitude>::kMost));
}

template <class Amplitude>
class CfarOf : public ::testing::Test {};
using Amplitudes = ::testing::Types<std::uint8_t, std::uint16_t>;
TYPED_TEST_SUITE(CfarOf, Amplitudes, );

TYPED_TEST(CfarOf, IsItsDefinition) {
  std::mt19937 random(1);
  for (const auto kind : {CfarKind::kCellAveraging, CfarKind::kOrderedStatistic})
    for (const int train : {1, 5, 16, 128})
      for (const int guard : {0, 3})
        for (const auto& [factor, offset] :
             {std::pair{0.7, 0}, {3.3, 0}, {60.0, 0}, {1000.0, 0}, {1.0, 5}, {1.0, 60}, {3.3, 999}})
          for (const std::size_t cells : {1U, 2U, 7U, 40U, 300U}) {
            const CfarSettings settings{.kind = kind,
                                        .train_cells = train,
                                        .guard_cells = guard,
                                        .threshold_factor = factor,
                                        .threshold_offset = offset,
                                        .rank = 0.6,
                                        .least_amplitude = 9};
            Cfar<TypeParam> cfar(settings, 300);
            const auto sweep = draw<TypeParam>(cells, random);
            std::vector<TypeParam> threshold(cells);
            cfar.thresholds(sweep, threshold);
            for (int i = 0; i < static_cast<int>(cells); ++i)
              ASSERT_EQ(threshold[static_cast<std::size_t>(i)],
                        threshold_by_definition(settings, sweep, i))
                  << "cell " << i << " of " << cells << ", train " << train << ", guard " << guard
                  << ", factor " << factor;
          }
}

TYPED_TEST(CfarOf, ZerosAndSaturatedSweepsHaveNoDetections) {
  for (const auto kind : {CfarKind::kCellAveraging, CfarKind::kOrderedStatistic})
    for (const int level : {0, 77, static_cast<int>(Cfar<TypeParam>::kMost)}) {
      Cfar<TypeParam> cfar({.kind = kind, .threshold_factor = 1.0}, 500);
      const std::vector<TypeParam> sweep(500, static_cast<TypeParam>(level));
      std::vector<TypeParam> threshold(500);
      cfar.thresholds(sweep, threshold);
      for (std::size_t i = 0; i < sweep.size(); ++i) ASSERT_LE(sweep[i], threshold[i]) << level;
    }
}

TYPED_TEST(CfarOf, ALoneCellHasNothingToBeComparedWith) {
  Cfar<TypeParam> cfar({}, 10);
  const std::vector<TypeParam> sweep{200};
  std::vector<TypeParam> threshold(1);
  cfar.thresholds(sweep, threshold);
  EXPECT_EQ(threshold[0], Cfar<TypeParam>::kMost);
}

TYPED_TEST(CfarOf, NeedsNoHeap) {
  std::mt19937 random(1);
  const auto sweep = draw<TypeParam>(2048, random);
  std::vector<TypeParam> threshold(2048);
  for (const auto kind : {CfarKind::kCellAveraging, CfarKind::kOrderedStatistic}) {
    Cfar<TypeParam> cfar({.kind = kind, .train_cells = 128}, 2048);
    const test::NoHeap fence;
    cfar.thresholds(sweep, threshold);
    EXPECT_EQ(fence.allocations(), 0);
  }
}

/// Share of cells of independent noise that are detected.
double false_alarms(const CfarSettings& settings, Noise noise, std::mt19937_64& random) {
  constexpr int kCells = 4096;
  constexpr int kSweeps = 300;
  Cfar<std::uint16_t> cfar(settings, kCells);
  std::exponential_distribution<double> power(1.0);
  std::vector<std::uint16_t> sweep(kCells), threshold(kCells);
  const int edge = settings.train_cells + settings.guard_cells;
  long alarms = 0;
  for (int k = 0; k < kSweeps; ++k) {
    for (auto& a : sweep) {
      const double p = power(random);
      a = static_cast<std::uint16_t>(
          std::min(3000 * (noise == Noise::kExponential ? p : std::sqrt(p)), 65535.0));
    }
    cfar.thresholds(sweep, threshold);
    for (int i = edge; i < kCells - edge; ++i)
      alarms += sweep[static_cast<std::size_t>(i)] > threshold[static_cast<std::size_t>(i)];
  }
  return static_cast<double>(alarms) / (static_cast<double>(kSweeps) * (kCells - 2 * edge));
}

TEST(FalseAlarmProbability, OfALogarithmicReceiverIsAsDesigned) {
  constexpr double kDesigned = 1e-3, kStepsPerDb = 3.0;
  std::mt19937_64 random(6);
  std::exponential_distribution<double> power(1.0);
  const CfarSettings settings{.train_cells = 128,
                              .guard_cells = 0,
                              .threshold_factor = 1.0,
                              .threshold_offset = static_cast<int>(
                                  std::ceil(kStepsPerDb * threshold_offset_db(kDesigned)))};
  Cfar<std::uint8_t> cfar(settings, 2048);
  int alarms = 0;
  constexpr int kSweeps = 400;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    std::vector<std::uint8_t> noise(2048), threshold(2048);
    for (auto& a : noise)
      a = static_cast<std::uint8_t>(
          std::clamp(100.0 + kStepsPerDb * 10.0 * std::log10(power(random)), 0.0, 255.0));
    cfar.thresholds(noise, threshold);
    for (std::size_t i = 128; i < 1920; ++i) alarms += noise[i] > threshold[i];
  }
  // The offset is rounded to a step, the cells to whole amplitudes: some 15 % either way.
  EXPECT_NEAR(alarms / (kSweeps * 1792.0), kDesigned, 0.35 * kDesigned);
}

TEST(FalseAlarmProbability, IsAsDesigned) {
  std::mt19937_64 random(5);
  for (const auto kind : {CfarKind::kCellAveraging, CfarKind::kOrderedStatistic})
    for (const auto noise : {Noise::kExponential, Noise::kRayleigh})
      for (const int train : {4, 16}) {
        constexpr double kDesigned = 1e-3;
        CfarSettings settings{.kind = kind, .train_cells = train};
        settings.threshold_factor = threshold_factor(settings, noise, kDesigned);
        EXPECT_NEAR(false_alarm_probability(settings, noise), kDesigned, 1e-9);
        // Of 1.2 million cells 1200 detections, neighbours correlated: 10 % are three sigma.
        EXPECT_NEAR(false_alarms(settings, noise, random), kDesigned, 0.13 * kDesigned)
            << "kind " << static_cast<int>(kind) << ", noise " << static_cast<int>(noise)
            << ", train " << train;
      }
}

TEST(FalseAlarmProbability, OfTheMedianOfTwoIsElementary) {
  // One cell against the smaller of two: p = 2 / (2 + f).
  const CfarSettings settings{
      .kind = CfarKind::kOrderedStatistic, .train_cells = 1, .threshold_factor = 3.0, .rank = 0.5};
  EXPECT_NEAR(false_alarm_probability(settings, Noise::kExponential), 0.4, 1e-12);
  EXPECT_NEAR(false_alarm_probability(settings, Noise::kRayleigh), 2.0 / 11.0, 1e-12);
}

TEST(ThresholdFactor, GrowsAsFalseAlarmsGrowRarer) {
  for (const auto kind : {CfarKind::kCellAveraging, CfarKind::kOrderedStatistic}) {
    double before = 0.0;
    for (const double probability : {0.5, 1e-1, 1e-3, 1e-6, 1e-9}) {
      const double factor = threshold_factor({.kind = kind}, Noise::kRayleigh, probability);
      EXPECT_GT(factor, before);
      before = factor;
    }
  }
}

TEST(ThresholdFactor, RejectsInvalidProbabilities) {
  for (const double probability : {0.0, 1.0, -0.1, std::nan("")})
    EXPECT_THROW((void)threshold_factor({}, Noise::kRayleigh, probability), std::invalid_argument);
  EXPECT_THROW((void)threshold_factor({.train_cells = 1}, Noise::kExponential, 1e-9),
               std::invalid_argument);
}

TEST(CfarSettings, RejectsInvalidParameters) {
  EXPECT_THROW(Cfar<>({.train_cells = 0}, 10), std::invalid_argument);
  EXPECT_THROW(Cfar<>({.train_cells = 129}, 10), std::invalid_argument);
  EXPECT_THROW(Cfar<>({.guard_cells = -1}, 10), std::invalid_argument);
  EXPECT_THROW(Cfar<>({.threshold_factor = 0.0}, 10), std::invalid_argument);
  EXPECT_THROW(Cfar<>({.threshold_factor = std::nan("")}, 10), std::invalid_argument);
  EXPECT_THROW(Cfar<>({.rank = 0.0}, 10), std::invalid_argument);
  EXPECT_THROW(Cfar<>({.least_amplitude = 256}, 10), std::invalid_argument);
  EXPECT_THROW(Cfar<>({}, 0), std::invalid_argument);
  EXPECT_THROW(Cfar<>({}, 65537), std::invalid_argument);
}

}  // namespace
}  // namespace wakeline::cfar_test
