// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Which cells are of one echo, and what its plot says.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <tuple>

#include "video/pictures.hpp"

namespace wakeline::echoes_test {
namespace {

using test::every_cell;
using test::feed;
using test::finish;
using test::Picture;

/// What can be said of an echo in whole numbers.
using Summary = std::tuple<long, int, int, int>;  // total amplitude, cells, peak, cells of range

std::vector<Summary> summaries(const std::vector<VideoPlot>& plots, double cell_m) {
  std::vector<Summary> list;
  for (const VideoPlot& plot : plots)
    list.emplace_back(std::lround(plot.total_amplitude), plot.cells,
                      static_cast<int>(plot.peak_amplitude),
                      static_cast<int>(std::lround(plot.range_extent_m / cell_m)));
  std::ranges::sort(list);
  return list;
}

/// Components of the picture by filling, over a seam or not.
std::vector<Summary> components(const Picture<>& picture, int gap_cells, int gap_sweeps,
                                bool closed) {
  std::vector<bool> seen(picture.amplitude.size());
  const auto place = [&](int j, int i) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(picture.cells) +
           static_cast<std::size_t>(i);
  };
  std::vector<Summary> list;
  for (int j = 0; j < picture.sweeps; ++j)
    for (int i = 0; i < picture.cells; ++i) {
      if (seen[place(j, i)] || picture.at(j, i) == 0) continue;
      long total = 0;
      int cells = 0, peak = 0, near = i, far = i;
      std::vector<std::pair<int, int>> waiting{{j, i}};
      seen[place(j, i)] = true;
      while (!waiting.empty()) {
        const auto [y, x] = waiting.back();
        waiting.pop_back();
        total += picture.at(y, x);
        ++cells;
        peak = std::max<int>(peak, picture.at(y, x));
        near = std::min(near, x);
        far = std::max(far, x);
        for (int dy = -1 - gap_sweeps; dy <= 1 + gap_sweeps; ++dy)
          for (int dx = -1 - gap_cells; dx <= 1 + gap_cells; ++dx) {
            int row = y + dy;
            const int cell = x + dx;
            if (closed) row = (row + picture.sweeps) % picture.sweeps;
            if (row < 0 || row >= picture.sweeps || cell < 0 || cell >= picture.cells) continue;
            if (picture.at(row, cell) == 0 || seen[place(row, cell)]) continue;
            seen[place(row, cell)] = true;
            waiting.emplace_back(row, cell);
          }
      }
      list.emplace_back(total, cells, peak, far - near + 1);
    }
  std::ranges::sort(list);
  return list;
}

TEST(Echoes, AreTheConnectedComponents) {
  std::mt19937 random(2);
  for (const double density : {0.02, 0.1, 0.3, 0.5, 0.8})
    for (const int gap_cells : {0, 1, 3})
      for (const int gap_sweeps : {0, 1, 2})
        for (const bool closed : {false, true}) {
          const auto picture = test::speckle(40, 70, density, random);
          auto settings = every_cell(70);
          settings.gap_cells = gap_cells;
          settings.gap_sweeps = gap_sweeps;
          settings.closed_circle = closed;
          PlotExtractor<> extractor(settings);
          auto plots = feed(extractor, picture, 0, picture.sweeps);
          const auto rest = finish(extractor);
          plots.insert(plots.end(), rest.begin(), rest.end());
          ASSERT_EQ(summaries(plots, picture.cell_m),
                    components(picture, gap_cells, gap_sweeps, closed))
              << "density " << density << ", gaps " << gap_cells << " and " << gap_sweeps
              << (closed ? ", closed" : "");
          EXPECT_EQ(extractor.open_echoes(), 0u);
        }
}

TEST(Echoes, OfSixteenBitsAreTheSameAsOfEight) {
  std::mt19937 random(3);
  const auto narrow = test::speckle(40, 200, 0.3, random);
  Picture<std::uint16_t> wide{40, 200};
  std::ranges::transform(narrow.amplitude, wide.amplitude.begin(),
                         [](int a) { return static_cast<std::uint16_t>(a * 257); });
  auto settings = every_cell(200);
  const auto of_narrow = extract_plots(narrow.image(), settings);
  const auto of_wide = extract_plots(wide.image(), settings);
  ASSERT_EQ(of_narrow.size(), of_wide.size());
  for (std::size_t k = 0; k < of_narrow.size(); ++k) {
    EXPECT_NEAR(of_wide[k].range_m, of_narrow[k].range_m, 1e-9);
    EXPECT_NEAR(of_wide[k].bearing_rad, of_narrow[k].bearing_rad, 1e-12);
    EXPECT_TRUE(of_wide[k].covariance.isApprox(of_narrow[k].covariance, 1e-9));
    EXPECT_NEAR(of_wide[k].total_amplitude, 257 * of_narrow[k].total_amplitude, 1e-6);
  }
}

TEST(Echoes, AreGivenAsSoonAsASweepPassesThemBy) {
  for (const int gap_sweeps : {0, 2}) {
    Picture<> picture{100, 50};
    picture.at(10, 20) = picture.at(11, 20) = 90;
    auto settings = every_cell(50);
    settings.gap_sweeps = gap_sweeps;
    PlotExtractor<> extractor(settings);
    EXPECT_TRUE(feed(extractor, picture, 0, 12 + gap_sweeps).empty());
    const auto plots = feed(extractor, picture, 12 + gap_sweeps, 1);
    ASSERT_EQ(plots.size(), 1u);
    EXPECT_FALSE(plots[0].cut);
  }
}

TEST(Echoes, GapsDoNotCount) {
  Picture<> picture{100, 50};
  picture.at(10, 20) = 60;
  picture.at(10, 23) = 60;
  picture.at(13, 21) = 60;
  auto settings = every_cell(50);
  settings.gap_cells = settings.gap_sweeps = 2;
  const auto plots = extract_plots(picture.image(), settings);
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_EQ(plots[0].cells, 3);
  EXPECT_DOUBLE_EQ(plots[0].total_amplitude, 180.0);
  EXPECT_NEAR(plots[0].bearing_rad, 11 * picture.step(), 1e-12);
}

TEST(VideoPlot, IsTheWeightedMeanOfItsCells) {
  Picture<> picture{360, 100};
  const std::vector<std::tuple<int, int, int>> cells{
      {50, 30, 10}, {50, 31, 40}, {51, 31, 100}, {51, 32, 30}, {52, 33, 20}};
  double w = 0, r = 0, b = 0, t = 0, ww = 0;
  for (const auto& [j, i, a] : cells) {
    picture.at(j, i) = static_cast<std::uint8_t>(a);
    w += a, r += a * (i + 0.5), b += a * j, t += a * j * 1e-3, ww += a * a;
  }
  r /= w, b /= w, t /= w;
  Mat<double, 2, 2> spread = Mat<double, 2, 2>::Zero();
  for (const auto& [j, i, a] : cells) {
    const Vec<double, 2> off((i + 0.5 - r) * picture.cell_m, (j - b) * picture.step());
    spread += a / w * off * off.transpose();
  }
  PlotExtractor<> extractor(every_cell(100));
  const auto plots = feed(extractor, picture, 0, 360);
  ASSERT_EQ(plots.size(), 1u);
  const VideoPlot& plot = plots[0];
  EXPECT_NEAR(plot.range_m, picture.start_range_m + r * picture.cell_m, 1e-9);
  EXPECT_NEAR(plot.bearing_rad, b * picture.step(), 1e-12);
  EXPECT_NEAR(plot.time_s, t, 1e-12);
  EXPECT_DOUBLE_EQ(plot.total_amplitude, w);
  EXPECT_DOUBLE_EQ(plot.peak_amplitude, 100.0);
  EXPECT_EQ(plot.cells, 5);
  EXPECT_DOUBLE_EQ(plot.range_extent_m, 4 * picture.cell_m);
  EXPECT_NEAR(plot.bearing_extent_rad, 3 * picture.step(), 1e-12);
  const double n = w * w / ww;
  Mat<double, 2, 2> expected = spread / n;
  expected(0, 0) += picture.cell_m * picture.cell_m / 12;
  expected(1, 1) += picture.step() * picture.step() / 12;
  EXPECT_NEAR(plot.covariance(0, 0), expected(0, 0), 1e-9);
  EXPECT_NEAR(plot.covariance(1, 1), expected(1, 1), 1e-15);
  EXPECT_NEAR(plot.covariance(0, 1), expected(0, 1), 1e-12);
  EXPECT_EQ(plot.covariance(1, 0), plot.covariance(0, 1));
  EXPECT_FALSE(plot.touches_first_cell || plot.touches_last_cell || plot.cut);
}

TEST(VideoPlot, ReportsThatItTouchesTheEnds) {
  Picture<> picture{360, 100};
  picture.at(50, 0) = picture.at(90, 99) = 200;
  const auto plots = extract_plots(picture.image(), every_cell(100));
  ASSERT_EQ(plots.size(), 2u);
  EXPECT_TRUE(plots[0].touches_first_cell && !plots[0].touches_last_cell);
  EXPECT_TRUE(!plots[1].touches_first_cell && plots[1].touches_last_cell);
}

/// Plots sorted by range, and where that is the same by bearing.
std::vector<VideoPlot> by_range(std::vector<VideoPlot> plots) {
  std::ranges::sort(plots, {}, [](const VideoPlot& plot) {
    return std::pair(std::lround(1e6 * plot.range_m), std::lround(1e9 * plot.bearing_rad));
  });
  return plots;
}

void expect_same_shape(const VideoPlot& a, const VideoPlot& b) {
  EXPECT_NEAR(a.bearing_extent_rad, b.bearing_extent_rad, 1e-12);
  EXPECT_DOUBLE_EQ(a.range_extent_m, b.range_extent_m);
  EXPECT_TRUE(a.covariance.isApprox(b.covariance, 1e-9));
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_DOUBLE_EQ(a.total_amplitude, b.total_amplitude);
  EXPECT_DOUBLE_EQ(a.peak_amplitude, b.peak_amplitude);
}

TEST(VideoPlot, TurnsWithThePicture) {
  for (const int turn : {1, 17, 250, 355, 356, 357, 358, 359}) {
    Picture<> picture{360, 200}, turned{360, 200};
    for (int ship = 0; ship < 5; ++ship) {
      test::add_ship(picture, 5.3 + 3 * ship, 20.0 + 30 * ship);
      test::add_ship(turned, 5.3 + 3 * ship + turn, 20.0 + 30 * ship);
    }
    const auto settings = PlotExtractorSettings{};
    const auto before = by_range(extract_plots(picture.image(), settings));
    const auto after = by_range(extract_plots(turned.image(), settings));
    ASSERT_EQ(before.size(), 5u);
    ASSERT_EQ(after.size(), 5u) << turn;
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_NEAR(wrap_angle(after[k].bearing_rad - before[k].bearing_rad - turn * picture.step()),
                  0.0, 1e-10);
      EXPECT_NEAR(after[k].range_m, before[k].range_m, 1e-9);
      EXPECT_FALSE(after[k].cut);
      EXPECT_GE(after[k].bearing_rad, 0.0);
      EXPECT_LT(after[k].bearing_rad, 2 * kPi<double>);
      expect_same_shape(after[k], before[k]);
    }
  }
}

TEST(VideoPlot, MovesInRangeWithThePicture) {
  Picture<> picture{360, 400}, moved{360, 400};
  test::add_ship(picture, 100.4, 130.2);
  test::add_ship(moved, 100.4, 187.2);
  const auto before = extract_plots(picture.image(), {});
  const auto after = extract_plots(moved.image(), {});
  ASSERT_EQ(before.size(), 1u);
  ASSERT_EQ(after.size(), 1u);
  EXPECT_NEAR(after[0].range_m - before[0].range_m, 57 * picture.cell_m, 1e-9);
  EXPECT_NEAR(after[0].bearing_rad, before[0].bearing_rad, 1e-12);
  expect_same_shape(after[0], before[0]);
}

TEST(VideoPlot, DoesNotChangeWithTheGainOfTheReceiver) {
  std::mt19937 random(4);
  auto weak = test::speckle<std::uint16_t>(360, 300, 1.0, random, 40);
  test::add_ship(weak, 100.4, 130.2, 400.0);
  auto strong = weak;
  for (auto& a : strong.amplitude) a = static_cast<std::uint16_t>(100 * a);
  PlotExtractorSettings settings{.cfar = {.threshold_factor = 4.0}};
  const auto before = extract_plots(weak.image(), settings);
  const auto after = extract_plots(strong.image(), settings);
  ASSERT_EQ(before.size(), after.size());
  ASSERT_FALSE(before.empty());
  for (std::size_t k = 0; k < before.size(); ++k) {
    EXPECT_NEAR(after[k].range_m, before[k].range_m, 1e-9);
    EXPECT_NEAR(after[k].bearing_rad, before[k].bearing_rad, 1e-12);
    EXPECT_TRUE(after[k].covariance.isApprox(before[k].covariance, 1e-9));
    EXPECT_EQ(after[k].cells, before[k].cells);
  }
}

TEST(VideoPlot, FindsTheShip) {
  for (const double sweep : {100.0, 100.25, 100.5, 359.9, 0.3})
    for (const double cell : {60.0, 60.3, 60.5}) {
      Picture<std::uint16_t> picture{360, 200};
      test::add_ship(picture, sweep, cell, 50000.0);
      const auto plots = extract_plots(picture.image(), {});
      ASSERT_EQ(plots.size(), 1u);
      EXPECT_NEAR(wrap_angle(plots[0].bearing_rad - sweep * picture.step()), 0.0,
                  0.1 * picture.step());
      EXPECT_NEAR(plots[0].range_m, picture.start_range_m + (cell + 0.5) * picture.cell_m,
                  0.1 * picture.cell_m);
    }
}

/// Echoes of a point in noise, for a beam and a pulse of some width in sweeps and cells; the point
/// fluctuates from sweep to sweep.
struct Errors {
  double both = 0.0, range = 0.0, bearing = 0.0;
};
Errors mean_normalized_errors(double sweeps, double cells) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> within(0.0, 1.0);
  std::exponential_distribution<double> power(1.0);
  Errors sum;
  int count = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const double sweep = 30 + within(random);
    const double cell = 50 + within(random);
    Picture<std::uint16_t> picture{60, 100};
    for (int j = 0; j < 60; ++j) {
      const double pulse = 60.0 * std::sqrt(power(random));
      for (int i = 0; i < 100; ++i) {
        const double u = (j - sweep) / sweeps;
        const double v = (i - cell) / cells;
        const double echo = pulse * std::exp(-0.5 * (u * u + v * v));
        picture.at(j, i) = static_cast<std::uint16_t>(
            std::min(300.0 * (echo + std::sqrt(power(random))), 65535.0));
      }
    }
    const auto plots = extract_plots(
        picture.image(),
        {.cfar = {.guard_cells = 6, .threshold_factor = 5.0}, .gap_sweeps = 2, .min_cells = 1});
    if (plots.empty()) continue;
    const VideoPlot& plot = *std::ranges::max_element(plots, {}, &VideoPlot::total_amplitude);
    const Vec<double, 2> error(
        plot.range_m - (picture.start_range_m + (cell + 0.5) * picture.cell_m),
        wrap_angle(plot.bearing_rad - sweep * picture.step()));
    sum.both += error.dot(plot.covariance.inverse() * error) / 2;
    sum.range += error[0] * error[0] / plot.covariance(0, 0);
    sum.bearing += error[1] * error[1] / plot.covariance(1, 1);
    ++count;
  }
  EXPECT_GT(count, 200);
  return {sum.both / count, sum.range / count, sum.bearing / count};
}

TEST(VideoPlot, CovarianceIsThatOfItsErrors) {
  for (const auto& [sweeps, cells] : {std::pair{4.0, 1.2}, {8.0, 0.6}, {0.5, 0.3}}) {
    const Errors errors = mean_normalized_errors(sweeps, cells);
    EXPECT_GT(errors.both, 0.1);
    EXPECT_LT(errors.both, 1.5);
    EXPECT_LT(errors.range, 1.5);
    EXPECT_LT(errors.bearing, 1.5);
  }
}

TEST(Streaming, GivesWhatTheWholePictureGives) {
  std::mt19937 random(7);
  const auto picture = test::speckle(60, 100, 0.25, random);
  const auto whole = by_range(extract_plots(picture.image(), every_cell(100)));
  // Turn after turn without a seam: each turn gives the plots of a closed circle.
  PlotExtractor<> extractor(every_cell(100));
  (void)feed(extractor, picture, 0, 2 * picture.sweeps);
  auto third = feed(extractor, picture, 2 * picture.sweeps, picture.sweeps);
  third = by_range(third);
  ASSERT_EQ(third.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_NEAR(third[k].range_m, whole[k].range_m, 1e-9);
    EXPECT_NEAR(wrap_angle(third[k].bearing_rad - whole[k].bearing_rad), 0.0, 1e-10);
    expect_same_shape(third[k], whole[k]);
  }
}

TEST(Streaming, AnEchoAcrossTheSeamIsOfTheEndOfTheTurn) {
  Picture<> picture{360, 100};
  test::add_ship(picture, 0.0, 60.0);
  PlotExtractorSettings settings;
  settings.closed_circle = true;
  PlotExtractor<> extractor(settings);
  EXPECT_TRUE(feed(extractor, picture, 0, 360).empty());
  const auto plots = finish(extractor);
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_NEAR(wrap_angle(plots[0].bearing_rad), 0.0, 1e-9);
  EXPECT_NEAR(plots[0].time_s, 0.355, 0.02);
}

TEST(Streaming, ACircleIsNotClosedAcrossMissingSweeps) {
  Picture<> picture{60, 40};
  for (int cell = 20; cell < 23; ++cell) picture.at(21, cell) = picture.at(59, cell) = 100;
  PlotExtractorSettings settings;
  settings.gap_sweeps = 1;
  settings.closed_circle = true;
  PlotExtractor<> extractor(settings);
  EXPECT_TRUE(feed(extractor, picture, 0, 1).empty());
  auto plots = feed(extractor, picture, 21, 39);
  const auto rest = finish(extractor);
  plots.insert(plots.end(), rest.begin(), rest.end());
  ASSERT_EQ(plots.size(), 2u);
  EXPECT_NEAR(plots[0].bearing_rad, 21 * picture.step(), 1e-9);
  EXPECT_TRUE(plots[0].cut);
  EXPECT_NEAR(plots[1].bearing_rad, 59 * picture.step(), 1e-9);
  EXPECT_FALSE(plots[1].cut);
}

TEST(Streaming, ClosesTheCircleOfEachTurn) {
  std::mt19937 random(8);
  const auto picture = test::speckle(60, 100, 0.2, random);
  const auto whole = by_range(extract_plots(picture.image(), every_cell(100)));
  auto settings = every_cell(100);
  settings.closed_circle = true;
  PlotExtractor<> extractor(settings);
  for (int turn = 0; turn < 3; ++turn) {
    auto plots = feed(extractor, picture, turn * picture.sweeps, picture.sweeps);
    // The seam is closed as the next turn begins.
    const auto joined = extractor.finish();
    plots.insert(plots.end(), joined.begin(), joined.end());
    EXPECT_EQ(summaries(plots, 10), summaries(whole, 10));
  }
  std::vector<VideoPlot> plots;
  for (int k = 0; k < 3 * picture.sweeps; ++k)
    for (const VideoPlot& plot : extractor.process(picture.sweep(k))) plots.push_back(plot);
  for (const VideoPlot& plot : extractor.finish()) plots.push_back(plot);
  EXPECT_EQ(plots.size(), 3 * whole.size());
}

}  // namespace
}  // namespace wakeline::echoes_test
