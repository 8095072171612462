// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/core/utf8.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace wakeline::utf8_test {
namespace {

/// A number in the form of a letter of so many bytes, as RFC 3629 lays them out.
std::string written(std::uint32_t letter, int bytes) {
  if (bytes == 1) return {static_cast<char>(letter)};
  std::string text;
  for (int k = 1; k < bytes; ++k, letter >>= 6)
    text.insert(text.begin(), static_cast<char>(0x80 | (letter & 0x3F)));
  const std::uint32_t mark = 0xFF00u >> bytes & 0xFF;
  text.insert(text.begin(), static_cast<char>(mark | letter));
  return text;
}

TEST(Utf8, HasEveryLetterInItsShortestFormAlone) {
  for (std::uint32_t letter = 0; letter < 0x200000; letter += letter < 0x11000 ? 1 : 37) {
    const int shortest = letter < 0x80 ? 1 : letter < 0x800 ? 2 : letter < 0x10000 ? 3 : 4;
    const bool surrogate = letter >= 0xD800 && letter < 0xE000;
    for (int bytes = shortest; bytes <= 4; ++bytes) {
      const std::string text = written(letter, bytes);
      ASSERT_EQ(is_utf8(text), bytes == shortest && !surrogate && letter <= 0x10FFFF) << letter;
      ASSERT_EQ(is_utf8("a" + text + "z"), is_utf8(text));
      EXPECT_TRUE(bytes == 1 || !is_utf8(text.substr(0, text.size() - 1))) << "cut";
    }
  }
  EXPECT_TRUE(is_utf8(""));
  for (const char* bytes : {"\x80", "\xff", "\xfe", "\xf8\x88\x80\x80\x80"})
    EXPECT_FALSE(is_utf8(bytes));
}

}  // namespace
}  // namespace wakeline::utf8_test
