// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace wakeline {

/// Whether bytes are UTF-8: each letter in its shortest form, no surrogates, up to U+10FFFF.
/// Source: RFC 3629, section 4.
constexpr bool is_utf8(std::string_view bytes) noexcept {
  constexpr std::uint32_t kLeast[] = {0x0, 0x80, 0x800, 0x10000};  // by continuation bytes
  for (std::size_t k = 0; k < bytes.size();) {
    const auto lead = static_cast<unsigned char>(bytes[k++]);
    const std::size_t more = lead < 0x80           ? 0
                             : (lead >> 5) == 0x6  ? 1
                             : (lead >> 4) == 0xE  ? 2
                             : (lead >> 3) == 0x1E ? 3
                                                   : 4;
    if (more > 3 || bytes.size() - k < more) return false;
    std::uint32_t letter = more == 0 ? lead : lead & (0x3Fu >> more);
    for (std::size_t n = 0; n < more; ++n) {
      const auto next = static_cast<unsigned char>(bytes[k++]);
      if ((next >> 6) != 0x2) return false;
      letter = letter << 6 | (next & 0x3Fu);
    }
    const bool surrogate = letter >= 0xD800 && letter <= 0xDFFF;
    if (letter < kLeast[more] || surrogate || letter > 0x10FFFF) return false;
  }
  return true;
}

/// How many of the first `most` bytes of UTF-8 are whole letters.
constexpr std::size_t whole_letters(std::string_view utf8, std::size_t most) noexcept {
  if (utf8.size() <= most) return utf8.size();
  while (most > 0 && (utf8[most] & 0xC0) == 0x80) --most;
  return most;
}

}  // namespace wakeline
