// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/core/archive.hpp"

#include <gtest/gtest.h>

#include "wakeline/filter/ekf.hpp"
#include "wakeline/motion/constant_velocity.hpp"

namespace wakeline::archive_test {
namespace {

TEST(Archive, GivesBackWhatItWasGiven) {
  bool yes = true, no = false;
  double number = 0.3;
  std::vector<int> counts{1, 2, 3};
  Archive out;
  out(yes);
  out(number);
  out(no);
  out(counts, 3);
  EXPECT_EQ(out.bytes().size(), 1 + 8 + 1 + 8 + 3 * sizeof(int));
  Archive in(out.bytes());
  bool was_yes = false, was_no = true;
  double was_number = 0.0;
  std::vector<int> were;
  in(was_yes);
  in(was_number);
  in(was_no);
  in(were, 3);
  EXPECT_TRUE(in.ok() && in.at_end());
  EXPECT_TRUE(was_yes && !was_no);
  EXPECT_EQ(was_number, number);
  EXPECT_EQ(were, counts);
}

TEST(Archive, AByteThatIsNoTruthFails) {
  for (const int byte : {2, 0x37, 255}) {
    const std::byte bytes[] = {std::byte(byte), std::byte(1)};
    Archive in(bytes);
    bool first = true, second = false;
    in(first);
    in(second);
    EXPECT_FALSE(in.ok());
    EXPECT_TRUE(first && !second);
  }
  Kalman filter{ConstantVelocity{}};
  ASSERT_EQ(filter.start(Gaussian<4>{}), Status::kOk);
  Archive out;
  filter.archive(out);
  std::vector<std::byte> bytes = out.bytes();
  bytes.back() = std::byte(0x37);
  Archive in(bytes);
  Kalman other{ConstantVelocity{}};
  other.archive(in);
  EXPECT_FALSE(in.ok());
}

}  // namespace
}  // namespace wakeline::archive_test
