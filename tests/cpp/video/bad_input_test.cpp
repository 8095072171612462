// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Sweeps that do not come as they should, pictures that are no pictures, and memory.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>
#include <limits>
#include <stdexcept>

#include "support/malloc_fence.hpp"
#include "video/pictures.hpp"

namespace wakeline::bad_input_test {
namespace {

using test::every_cell;
using test::feed;
using test::finish;
using test::Picture;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An echo over sweeps 40 to 49.
Picture<> one_ship() {
  Picture<> picture{360, 80};
  for (int j = 40; j < 50; ++j) picture.at(j, 30) = picture.at(j, 31) = 150;
  return picture;
}

TEST(BadSweep, IsRejectedAndChangesNothing) {
  const auto picture = one_ship();
  const std::vector<std::function<void(Sweep<>&)>> damages{
      [](auto& s) { s.time_s = kNan; },
      [](auto& s) { s.time_s = kInfinity; },
      [](auto& s) { s.azimuth_rad = kNan; },
      [](auto& s) { s.azimuth_rad = -kInfinity; },
      [](auto& s) { s.azimuth_rad = 1e300; },
      [](auto& s) { s.azimuth_width_rad = 0.0; },
      [](auto& s) { s.azimuth_width_rad = -1; },
      [](auto& s) { s.azimuth_width_rad = 4.0; },
      [](auto& s) { s.azimuth_width_rad = kNan; },
      [](auto& s) { s.start_range_m = -1.0; },
      [](auto& s) { s.start_range_m = kNan; },
      [](auto& s) { s.start_range_m = 1e300; },
      [](auto& s) { s.cell_m = 0.0; },
      [](auto& s) { s.cell_m = kNan; },
      [](auto& s) { s.cell_m = 1e300; },
      [](auto& s) { s.amplitude = {}; }};
  for (const auto& damage : damages) {
    PlotExtractor<> extractor(every_cell(80));
    (void)feed(extractor, picture, 0, 45);
    auto bad = picture.sweep(45);
    damage(bad);
    EXPECT_TRUE(extractor.process(bad).empty());
    EXPECT_EQ(extractor.status(), SweepStatus::kInvalid);
    const auto plots = feed(extractor, picture, 45, 20);
    ASSERT_EQ(plots.size(), 1u);
    EXPECT_EQ(plots[0].cells, 20);
    EXPECT_EQ(extractor.counts().invalid, 1);
    EXPECT_EQ(extractor.counts().sweeps, 65);
  }
}

TEST(BadSweep, TooLongIsRejected) {
  PlotExtractor<> extractor(every_cell(80));
  const Picture<> longer{360, 81};
  EXPECT_TRUE(extractor.process(longer.sweep(0)).empty());
  EXPECT_EQ(extractor.status(), SweepStatus::kTooLong);
  EXPECT_EQ(extractor.counts().too_long, 1);
  EXPECT_TRUE(rejected(extractor.status()));
}

TEST(BadSweep, RepeatedIsRejected) {
  const auto picture = one_ship();
  PlotExtractor<> extractor(every_cell(80));
  std::vector<VideoPlot> plots;
  for (int k = 0; k < 60; ++k)
    for (int again = 0; again < 3; ++again) {
      for (const VideoPlot& plot : extractor.process(picture.sweep(k))) plots.push_back(plot);
      EXPECT_EQ(extractor.status(), again == 0 ? SweepStatus::kOk : SweepStatus::kRepeated);
    }
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_EQ(plots[0].cells, 20);
  EXPECT_EQ(extractor.counts().repeated, 120);
}

TEST(MissingSweeps, CloseWhatIsOpen) {
  const auto picture = one_ship();
  PlotExtractor<> extractor(every_cell(80));
  (void)feed(extractor, picture, 0, 45);
  const auto before = feed(extractor, picture, 46, 1);
  EXPECT_EQ(extractor.status(), SweepStatus::kGap);
  ASSERT_EQ(before.size(), 1u);
  EXPECT_TRUE(before[0].cut);
  EXPECT_EQ(before[0].cells, 10);
  const auto after = feed(extractor, picture, 47, 20);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_TRUE(after[0].cut);
  EXPECT_EQ(after[0].cells, 8);
  EXPECT_EQ(extractor.counts().gaps, 1);
  EXPECT_EQ(extractor.counts().cut, 2);
}

TEST(MissingSweeps, MayBeBridged) {
  const auto picture = one_ship();
  for (const int missing : {1, 2, 3}) {
    auto settings = every_cell(80);
    settings.gap_sweeps = 2;
    PlotExtractor<> extractor(settings);
    auto plots = feed(extractor, picture, 0, 44);
    const auto rest = feed(extractor, picture, 44 + missing, 30);
    plots.insert(plots.end(), rest.begin(), rest.end());
    EXPECT_EQ(plots.size(), missing <= 2 ? 1u : 2u);
    EXPECT_EQ(plots[0].cut, missing > 2);
  }
}

TEST(MissingSweeps, UnevenStepsAreNotMissing) {
  const auto picture = one_ship();
  PlotExtractor<> extractor(every_cell(80));
  std::vector<VideoPlot> plots;
  for (int k = 0; k < 60; ++k) {
    auto sweep = picture.sweep(k);
    sweep.azimuth_rad += (k % 2 == 0 ? 0.2 : -0.2) * picture.step();
    for (const VideoPlot& plot : extractor.process(sweep)) plots.push_back(plot);
    EXPECT_EQ(extractor.status(), SweepStatus::kOk);
  }
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_EQ(plots[0].cells, 20);
}

TEST(Reversal, ClosesWhatIsOpen) {
  const auto picture = one_ship();
  PlotExtractor<> extractor(every_cell(80));
  (void)feed(extractor, picture, 0, 45);
  const auto turned = feed(extractor, picture, 43, 1);
  EXPECT_EQ(extractor.status(), SweepStatus::kReversed);
  ASSERT_EQ(turned.size(), 1u);
  EXPECT_TRUE(turned[0].cut);
  EXPECT_EQ(turned[0].cells, 10);
  EXPECT_EQ(extractor.counts().reversals, 1);
  const auto forward = feed(extractor, picture, 44, 20);
  ASSERT_EQ(forward.size(), 1u);
  EXPECT_EQ(forward[0].cells, 14);
}

TEST(Sector, ScannedToAndFroGivesThePlotEachTime) {
  const auto picture = one_ship();
  PlotExtractor<> extractor(every_cell(80));
  for (int pass = 0; pass < 4; ++pass) {
    const auto plots = feed(extractor, picture, 20, 50);
    ASSERT_EQ(plots.size(), 1u);
    EXPECT_FALSE(plots[0].cut);
  }
}

TEST(Geometry, ThatChangesClosesWhatIsOpen) {
  const auto picture = one_ship();
  for (const auto& [start, cell] : {std::pair{100.0, 20.0}, {150.0, 10.0}}) {
    PlotExtractor<> extractor(every_cell(80));
    (void)feed(extractor, picture, 0, 45);
    auto other = picture;
    other.start_range_m = start;
    other.cell_m = cell;
    const auto before = feed(extractor, other, 45, 1);
    EXPECT_EQ(extractor.status(), SweepStatus::kGeometryChanged);
    ASSERT_EQ(before.size(), 1u);
    EXPECT_NEAR(before[0].range_m, 100 + 31 * 10.0, 1e-9);
    EXPECT_TRUE(before[0].cut);
    const auto after = feed(extractor, other, 46, 20);
    ASSERT_EQ(after.size(), 1u);
    EXPECT_NEAR(after[0].range_m, start + 31 * cell, 1e-9);
    EXPECT_EQ(extractor.counts().geometry_changes, 1);
  }
}

TEST(Sweeps, MayDifferInLength) {
  const auto picture = one_ship();
  PlotExtractor<> extractor(every_cell(80));
  std::vector<VideoPlot> plots;
  for (int k = 0; k < 60; ++k) {
    auto sweep = picture.sweep(k);
    sweep.amplitude = sweep.amplitude.first(static_cast<std::size_t>(40 + k % 40));
    for (const VideoPlot& plot : extractor.process(sweep)) plots.push_back(plot);
  }
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_EQ(plots[0].cells, 20);
}

TEST(Sizes, AreLimited) {
  const auto picture = one_ship();
  const std::vector<std::pair<std::function<void(PlotExtractorSettings&)>, bool>> limits{
      {[](auto& s) { s.min_cells = 20; }, true},
      {[](auto& s) { s.min_cells = 21; }, false},
      {[](auto& s) { s.max_cells = 20; }, true},
      {[](auto& s) { s.max_cells = 19; }, false},
      {[](auto& s) { s.max_range_extent_m = 20.5; }, true},
      {[](auto& s) { s.max_range_extent_m = 19.5; }, false},
      {[](auto& s) { s.max_bearing_extent_rad = deg(10.5); }, true},
      {[](auto& s) { s.max_bearing_extent_rad = deg(9.5); }, false}};
  for (const auto& [limit, seen] : limits) {
    auto settings = every_cell(80);
    limit(settings);
    PlotExtractor<> extractor(settings);
    EXPECT_EQ(feed(extractor, picture, 0, 360).size(), seen ? 1u : 0u);
    const ExtractionCounts& counts = extractor.counts();
    EXPECT_EQ(counts.plots + counts.too_small + counts.too_large, 1);
  }
}

TEST(EndlessEcho, IsCutAtTheBound) {
  Picture<> ring{360, 80};
  for (int j = 0; j < 360; ++j) ring.at(j, 30) = ring.at(j, 31) = 150;
  auto settings = every_cell(80);
  settings.max_sweeps = 100;
  PlotExtractor<> extractor(settings);
  const auto plots = feed(extractor, ring, 0, 3 * 360);
  ASSERT_EQ(plots.size(), 10u);
  for (std::size_t k = 0; k < plots.size(); ++k) {
    EXPECT_TRUE(plots[k].cut);
    EXPECT_EQ(plots[k].cells, 200);
    const double middle = (100.0 * static_cast<double>(k) + 49.5) * ring.step();
    EXPECT_NEAR(wrap_angle(plots[k].bearing_rad - middle), 0.0, 1e-9);
  }
  EXPECT_EQ(finish(extractor).size(), 1u);
  // One that ends with the bound leaves nothing behind.
  Picture<> arc{360, 80};
  for (int j = 5; j < 105; ++j) arc.at(j, 30) = 150;
  PlotExtractor<> other(settings);
  EXPECT_EQ(feed(other, arc, 0, 360).size(), 1u);
  EXPECT_TRUE(finish(other).empty());
  EXPECT_EQ(other.open_echoes(), 0u);
}

TEST(EndlessEcho, OfAClosedCircleIsOne) {
  Picture<> ring{360, 80};
  for (int j = 0; j < 360; ++j) ring.at(j, 30) = 150;
  const auto plots = extract_plots(ring.image(), every_cell(80));
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_EQ(plots[0].cells, 360);
  EXPECT_NEAR(plots[0].bearing_extent_rad, 2 * kPi<double>, 1e-9);
}

TEST(Pictures, OfZerosAndOfFullScaleHaveNoPlots) {
  for (const int level : {0, 255}) {
    Picture<> picture{360, 300};
    std::ranges::fill(picture.amplitude, static_cast<std::uint8_t>(level));
    EXPECT_TRUE(extract_plots(picture.image(), PlotExtractorSettings{}).empty());
  }
}

/// Content of any kind: all of it, noise, a chess board, stripes, a comb that grows together.
std::vector<Picture<>> pictures() {
  std::mt19937 random(9);
  std::vector<Picture<>> list;
  list.push_back(test::speckle(200, 300, 1.0, random));
  list.push_back(test::speckle(200, 300, 0.5, random));
  list.push_back(test::speckle(200, 300, 0.1, random));
  const std::vector<std::function<bool(int, int)>> patterns{
      [](int j, int i) { return (i + j) % 2 == 0; }, [](int, int i) { return i % 2 == 0; },
      [](int j, int) { return j % 2 == 0; },
      [](int j, int i) { return i % 2 == 0 || j % 50 == 49; },
      [](int j, int i) { return i % 2 == 0 && (j / 3) % 2 == 0; }};
  for (const auto& pattern : patterns) {
    Picture<> picture{200, 300};
    for (int j = 0; j < 200; ++j)
      for (int i = 0; i < 300; ++i) picture.at(j, i) = pattern(j, i) ? 100 : 0;
    list.push_back(std::move(picture));
  }
  return list;
}

TEST(Memory, IsThatOfConstructionWhateverThePicture) {
  const auto list = pictures();
  for (const int gap : {0, 1, 2})
    for (const bool closed : {false, true})
      for (const int max_sweeps : {1, 7, 1024}) {
        auto settings = every_cell(300);
        settings.gap_cells = settings.gap_sweeps = gap;
        settings.closed_circle = closed;
        settings.max_sweeps = max_sweeps;
        PlotExtractor<> extractor(settings, LandMask(64), StaticClutterMap(64, 300, 1e9, 1.5));
        for (const auto& picture : list) {
          long cells = 0;
          const test::NoHeap fence;
          for (int k = 0; k < 2 * picture.sweeps; ++k) {
            if (k % 97 == 96) continue;
            for (const VideoPlot& plot : extractor.process(picture.sweep(k))) cells += plot.cells;
          }
          for (const VideoPlot& plot : extractor.finish()) cells += plot.cells;
          EXPECT_EQ(fence.allocations(), 0);
          EXPECT_EQ(extractor.open_echoes(), 0u);
          // No cell is lost and none counts twice.
          long there = 0;
          for (int k = 0; k < 2 * picture.sweeps; ++k)
            if (k % 97 != 96)
              for (const auto a : picture.sweep(k).amplitude) there += a > 0;
          EXPECT_EQ(cells, there);
        }
      }
}

TEST(AnySweeps, LoseNoCellAndGiveSensiblePlots) {
  std::mt19937 random(11);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int trial = 0; trial < 60; ++trial) {
    auto settings = every_cell(64);
    settings.gap_cells = trial % 3;
    settings.gap_sweeps = trial % 4;
    settings.closed_circle = trial % 2 == 0;
    settings.max_sweeps = 1 + trial % 20;
    PlotExtractor<> extractor(settings);
    long there = 0, found = 0;
    const auto check = [&](std::span<const VideoPlot> plots) {
      for (const VideoPlot& plot : plots) {
        found += plot.cells;
        ASSERT_GE(plot.bearing_rad, 0.0);
        ASSERT_LT(plot.bearing_rad, 2 * kPi<double>);
        ASSERT_GT(plot.range_m, 0.0);
        ASSERT_GT(plot.covariance(0, 0), 0.0);
        ASSERT_GT(plot.covariance.determinant(), 0.0);
        ASSERT_GT(plot.bearing_extent_rad, 0.0);
        ASSERT_TRUE(std::isfinite(plot.time_s));
      }
    };
    double azimuth = uniform(-10, 10), width = 0.1;
    double start = 0.0, cell = 5.0;
    for (int k = 0; k < 500; ++k) {
      const int event = static_cast<int>(uniform(0, 60));
      azimuth += event == 0 ? uniform(-7, 7) : event == 1 ? 0.0 : width * uniform(0.6, 1.4);
      if (event == 2) width = uniform(0.001, 1.0);
      if (event == 3) cell = uniform(1, 20);
      if (event == 4) start = uniform(0, 100);
      if (event == 5) azimuth -= 2 * kPi<double> * std::round(uniform(-3, 3));
      const auto cells = static_cast<std::size_t>(event == 6 ? uniform(0, 80) : 64);
      std::vector<std::uint8_t> amplitude(cells);
      for (auto& a : amplitude) a = uniform(0, 1) < 0.3 ? 100 : 0;
      check(extractor.process({.time_s = event == 7 ? kNan : 0.1 * k,
                               .azimuth_rad = azimuth,
                               .azimuth_width_rad = width,
                               .start_range_m = start,
                               .cell_m = cell,
                               .amplitude = amplitude}));
      // A cell alone in its sweep has nothing to be compared with.
      if (!rejected(extractor.status()) && cells > 1)
        there += std::ranges::count_if(amplitude, [](int a) { return a > 0; });
    }
    check(extractor.finish());
    EXPECT_EQ(found, there);
    EXPECT_EQ(extractor.open_echoes(), 0u);
  }
}

TEST(Memory, IsEnoughForLongSweepsOfNothingButEchoes) {
  constexpr int kCells = 65536;
  PlotExtractor<std::uint16_t> extractor(every_cell(kCells));
  Picture<std::uint16_t> picture{8, kCells};
  for (int j = 0; j < 8; j += 2)
    for (int i = 0; i < kCells; i += 2) picture.at(j, i) = 30000;
  const test::NoHeap fence;
  std::size_t plots = 0;
  for (int k = 0; k < 8; ++k) plots += extractor.process(picture.sweep(k)).size();
  EXPECT_EQ(plots, 4u * kCells / 2);
  EXPECT_EQ(fence.allocations(), 0);
}

TEST(Settings, ThatAreInvalidAreRejected) {
  const std::vector<std::function<void(PlotExtractorSettings&)>> damages{
      [](auto& s) { s.max_sweep_cells = 0; },
      [](auto& s) { s.max_sweep_cells = 65537; },
      [](auto& s) { s.gap_cells = -1; },
      [](auto& s) { s.gap_cells = 65; },
      [](auto& s) { s.gap_sweeps = -1; },
      [](auto& s) { s.gap_sweeps = 9; },
      [](auto& s) { s.min_cells = 0; },
      [](auto& s) { s.max_cells = 1; },
      [](auto& s) { s.max_range_extent_m = 0.0; },
      [](auto& s) { s.max_range_extent_m = kNan; },
      [](auto& s) { s.max_bearing_extent_rad = -1.0; },
      [](auto& s) { s.max_sweeps = 0; },
      [](auto& s) { s.cfar.train_cells = 0; }};
  for (const auto& damage : damages) {
    PlotExtractorSettings settings;
    damage(settings);
    EXPECT_THROW(PlotExtractor<>{settings}, std::invalid_argument);
  }
}

}  // namespace
}  // namespace wakeline::bad_input_test
