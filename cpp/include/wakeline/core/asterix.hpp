// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Blocks, records and items of ASTERIX: EUROCONTROL-SPEC-0149, part 1. A category is a table of
// the forms of its items; reading, skipping and writing follow from the table.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "wakeline/core/angle.hpp"

namespace wakeline::asterix {

using Octets = std::span<const std::byte>;

inline constexpr std::size_t kBlockHeader = 3;          ///< CAT, LEN
inline constexpr std::size_t kLongestBlock = 0xFFFF;    ///< octets, header included
inline constexpr double kAzimuthTurn = 65536.0;         ///< azimuth steps per revolution
inline constexpr double kTicksPerSecond = 128.0;        ///< ticks of the time of day
inline constexpr double kDay = 86400.0;                 ///< s
inline constexpr double kNauticalMile = 1852.0;         ///< m
inline constexpr double kSpeedUnit = 1852.0 / 16384.0;  ///< m/s, 2^-14 NM/s

/// The radar or system that sent a record (item 010 of most categories).
struct Source {
  std::uint8_t area = 0;    ///< SAC
  std::uint8_t system = 0;  ///< SIC

  bool operator==(const Source&) const = default;
};

/// How the length of an item is encoded.
enum class Length : std::uint8_t {
  kSpare,     ///< there is no such item
  kFixed,     ///< this number of octets
  kRepeated,  ///< an octet n, then n times this number of octets
  kOwn,       ///< its first octet is its length, including itself
  kExtended,  ///< octets up to the first one whose lowest bit is 0
  kCompound,  ///< a field specification, then those of its parts that it names
};

/// The form of an item, or of a part of a compound item.
struct ItemForm {
  const char* name;
  Length length;
  std::size_t octets = 1;
  std::span<const ItemForm> parts = {};
};

/// An unsigned number, most significant octet first.
inline std::uint64_t number(Octets octets) noexcept {
  std::uint64_t value = 0;
  for (const std::byte octet : octets) value = value << 8 | std::to_integer<std::uint64_t>(octet);
  return value;
}

/// The same in two's complement.
inline std::int64_t signed_number(Octets octets) noexcept {
  const unsigned unused = 64 - 8 * static_cast<unsigned>(octets.size());
  return static_cast<std::int64_t>(number(octets) << unused) >> unused;
}

/// An angle in [0, 2 pi) as steps of 1/65536 turn.
inline std::uint64_t azimuth_steps(double azimuth_rad) noexcept {
  const double turns = compass_angle(azimuth_rad) / (2 * kPi<double>);
  return static_cast<std::uint64_t>(std::llround(turns * kAzimuthTurn)) & 0xFFFFu;
}

/// The time since the midnight before, s.
inline double time_of_day(double time_s) noexcept {
  const double of_day = std::fmod(time_s, kDay);
  return of_day < 0.0 ? of_day + kDay : of_day;
}

/// The time of day as ticks of 1/128 s.
inline std::uint64_t day_ticks(double time_s) noexcept {
  const auto count =
      static_cast<std::uint64_t>(std::llround(time_of_day(time_s) * kTicksPerSecond));
  return count % static_cast<std::uint64_t>(kDay * kTicksPerSecond);
}

/// Octets of the field specification that starts here: its lowest bit is set while another octet
/// follows. One more than there are where it does not end in them.
inline std::size_t specification_octets(Octets octets) noexcept {
  std::size_t count = 0;
  while (count < octets.size())
    if ((octets[count++] & std::byte{1}) == std::byte{0}) return count;
  return count + 1;
}

/// Whether a field specification names this item.
inline bool names(Octets specification, std::size_t item) noexcept {
  return item / 7 < specification.size() &&
         (specification[item / 7] & std::byte{0x80} >> static_cast<int>(item % 7)) != std::byte{0};
}

/// Octets of an item that starts here, or more than there are where it does not end in them. 0 of a
/// spare item and of a compound one that names a spare part.
inline std::size_t item_octets(const ItemForm& form, Octets rest) noexcept {
  if (form.length == Length::kFixed) return form.octets;
  if (form.length == Length::kSpare) return 0;
  if (rest.empty()) return 1;
  if (form.length == Length::kRepeated) return 1 + number(rest.first(1)) * form.octets;
  if (form.length == Length::kOwn) return std::max<std::size_t>(number(rest.first(1)), 1);
  const std::size_t first = specification_octets(rest);
  if (form.length == Length::kExtended || first > rest.size()) return first;
  std::size_t at = first;
  for (std::size_t part = 0; part < 7 * first; ++part) {
    if (!names(rest.first(first), part)) continue;
    const std::size_t octets = part < form.parts.size() && at <= rest.size()
                                   ? item_octets(form.parts[part], rest.subspan(at))
                                   : 0;
    if (octets == 0) return at > rest.size() ? at : 0;
    at += octets;
  }
  return at;
}

/// Why a record cannot be split.
enum class Flaw : std::uint8_t {
  kNone,
  kSpecification,  ///< the field specification is longer than that of the category
  kItem,           ///< an item is undefined or ends past the data
};

/// A record split into its items, or the reason why it cannot be.
struct Split {
  std::size_t octets = 0;  ///< of the record
  Flaw flaw = Flaw::kNone;
  const char* item = "";
  std::size_t wanted = 0;  ///< octets
  std::size_t came = 0;    ///< octets
};

/// Splits the record that starts here. `items` are as many as `forms`, and empty; those in the
/// record become their octets.
inline Split split(std::span<const ItemForm> forms, Octets data, std::span<Octets> items) noexcept {
  const std::size_t most = (forms.size() + 6) / 7;
  const std::size_t first = specification_octets(data.first(std::min(data.size(), most)));
  if (first > most) return {0, Flaw::kSpecification, "FSPEC", most, first};
  if (first > data.size()) return {0, Flaw::kItem, "FSPEC", first, data.size()};
  std::size_t at = first;
  for (std::size_t item = 0; item < forms.size(); ++item) {
    if (!names(data.first(first), item)) continue;
    const Octets rest = data.subspan(at);
    const std::size_t octets = item_octets(forms[item], rest);
    if (octets == 0 || octets > rest.size())
      return {0, Flaw::kItem, forms[item].name, octets, rest.size()};
    items[item] = rest.first(octets);
    at += octets;
  }
  return {.octets = at};
}

/// Writes a block of records; past the room it only counts.
class BlockWriter {
 public:
  void begin(unsigned category, std::span<std::byte> out) noexcept {
    out_ = out;
    at_ = 0;
    put(1, category);
    put(2, 0);
  }

  /// Writes the field specification of a record; bit k of `items` is item k of the category.
  void specify(std::uint64_t items) noexcept {
    do {
      unsigned octet = 0;
      for (unsigned item = 0; item < 7; ++item)
        if (items >> item & 1) octet |= 0x80u >> item;
      items >>= 7;
      put(1, octet | (items != 0 ? 1u : 0u));
    } while (items != 0);
  }

  /// Appends a number of so many octets, most significant first; a negative one in two's
  /// complement.
  template <class Number>
  void put(std::size_t octets, Number number) noexcept {
    const auto value = static_cast<std::uint64_t>(number);
    if (at_ + octets <= out_.size())
      for (std::size_t k = 0; k < octets; ++k)
        out_[at_ + k] = static_cast<std::byte>(value >> 8 * (octets - 1 - k) & 0xFF);
    at_ += octets;
  }

  /// Octets so far.
  [[nodiscard]] std::size_t size() const noexcept { return at_; }
  /// Takes back all but the first octets.
  void cut(std::size_t size) noexcept { at_ = size; }
  [[nodiscard]] bool fits() const noexcept { return at_ <= std::min(out_.size(), kLongestBlock); }

  /// Writes the length of the block. False, and nothing, where it does not fit.
  bool end() noexcept {
    if (!fits()) return false;
    out_[1] = static_cast<std::byte>(at_ >> 8);
    out_[2] = static_cast<std::byte>(at_ & 0xFF);
    return true;
  }

 private:
  std::span<std::byte> out_;
  std::size_t at_ = 0;
};

}  // namespace wakeline::asterix
