// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/video/scan_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/malloc_fence.hpp"
#include "video/pictures.hpp"

namespace wakeline::scan_image_test {
namespace {

using test::Picture;

TEST(ScanImage, IsThePictureItIsFedWith) {
  std::mt19937 random(1);
  const auto picture = test::speckle(360, 50, 0.5, random);
  ScanImage<> image(360, 50);
  for (int turn = 0; turn < 2; ++turn)
    for (int k = 0; k < 360; ++k) ASSERT_TRUE(image.add(picture.sweep(k)));
  const auto view = image.view();
  for (int j = 0; j < 360; ++j)
    ASSERT_TRUE(std::ranges::equal(view.row(j), picture.image().row(j))) << j;
  EXPECT_TRUE(view.full_circle());
  EXPECT_DOUBLE_EQ(view.cell_m, picture.cell_m);
  EXPECT_DOUBLE_EQ(view.start_range_m, picture.start_range_m);
}

TEST(ScanImage, KeepsTheGreatestOfSweepsThatShareARow) {
  Picture<> fine{1440, 4};
  for (int k = 0; k < 1440; ++k) fine.at(k, k % 4) = static_cast<std::uint8_t>(100 + k % 7);
  ScanImage<> image(360, 4);
  for (int turn = 0; turn < 2; ++turn)
    for (int k = 0; k < 1440; ++k) ASSERT_TRUE(image.add(fine.sweep(k)));
  const auto view = image.view();
  for (int j = 1; j < 360; ++j)
    for (int i = 0; i < 4; ++i) {
      int most = 0;
      for (int k = 4 * j - 1; k <= 4 * j + 1; ++k) most = std::max<int>(most, fine.at(k, i));
      EXPECT_GE(view.row(j)[static_cast<std::size_t>(i)], most) << j << " " << i;
    }
}

TEST(ScanImage, AWideSweepFillsItsRows) {
  Picture<> coarse{90, 4};
  for (int k = 0; k < 90; ++k) coarse.at(k, 1) = static_cast<std::uint8_t>(k + 1);
  ScanImage<> image(360, 4);
  for (int k = 0; k < 90; ++k) ASSERT_TRUE(image.add(coarse.sweep(k)));
  const auto view = image.view();
  for (int j = 0; j < 360; ++j) EXPECT_GT(view.row(j)[1], 0) << j;
  EXPECT_EQ(view.row(40)[1], 11);
  EXPECT_EQ(view.row(41)[1], 11);
}

TEST(ScanImage, HoldsTheLastTurn) {
  Picture<> bright{360, 10}, dark{360, 10};
  std::ranges::fill(bright.amplitude, std::uint8_t{200});
  std::ranges::fill(dark.amplitude, std::uint8_t{3});
  ScanImage<> image(360, 10);
  for (int k = 0; k < 360; ++k) ASSERT_TRUE(image.add(bright.sweep(k)));
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(image.add(dark.sweep(k)));
  EXPECT_EQ(image.view().row(99)[5], 3);
  EXPECT_EQ(image.view().row(100)[5], 200);
}

TEST(ScanImage, BeginsAtTheGivenAzimuth) {
  Picture<> picture{360, 4};
  picture.at(90, 2) = 77;
  ScanImage<> image(360, 4, deg(90));
  for (int k = 0; k < 360; ++k) ASSERT_TRUE(image.add(picture.sweep(k)));
  EXPECT_EQ(image.view().row(0)[2], 77);
  EXPECT_NEAR(image.view().position(0, 2)[1], picture.start_range_m + 2.5 * picture.cell_m, 1e-9);
}

TEST(ScanImage, RejectsSweepsThatDoNotFit) {
  ScanImage<> image(360, 50);
  const Picture<> picture{360, 50}, longer{360, 51};
  EXPECT_FALSE(image.add(longer.sweep(0)));
  auto bad = picture.sweep(0);
  bad.azimuth_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(image.add(bad));
  EXPECT_THROW(ScanImage<>(2, 10), std::invalid_argument);
  EXPECT_THROW(ScanImage<>(360, 0), std::invalid_argument);
  EXPECT_THROW(ScanImage<>(360, 10, std::nan("")), std::invalid_argument);
}

TEST(ScanImage, AnotherGeometryClearsIt) {
  Picture<> picture{360, 50};
  std::ranges::fill(picture.amplitude, std::uint8_t{9});
  ScanImage<> image(360, 50);
  for (int k = 0; k < 360; ++k) ASSERT_TRUE(image.add(picture.sweep(k)));
  picture.cell_m = 20.0;
  ASSERT_TRUE(image.add(picture.sweep(0)));
  EXPECT_EQ(image.view().row(0)[0], 9);
  EXPECT_EQ(image.view().row(1)[0], 0);
  EXPECT_DOUBLE_EQ(image.view().cell_m, 20.0);
}

TEST(ScanImage, NeedsNoHeap) {
  const Picture<> picture{360, 50};
  ScanImage<> image(360, 50);
  const test::NoHeap fence;
  for (int k = 0; k < 360; ++k) ASSERT_TRUE(image.add(picture.sweep(k)));
  EXPECT_EQ(fence.allocations(), 0);
}

}  // namespace
}  // namespace wakeline::scan_image_test
