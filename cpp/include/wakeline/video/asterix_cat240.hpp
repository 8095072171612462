// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Radar video in ASTERIX category 240: EUROCONTROL-SPEC-0149-240, edition 1.3 (2015), and part 1
// (SPEC-0149) for blocks and records. Common parts of reader and writer.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/asterix.hpp"
#include "wakeline/video/sweep.hpp"

namespace wakeline {

/// The radar and area that sent a record (I240/010).
using Cat240Source = asterix::Source;

namespace cat240 {

using asterix::ItemForm;
using asterix::kAzimuthTurn;
using asterix::kBlockHeader;
using asterix::kDay;
using asterix::kLongestBlock;
using asterix::kTicksPerSecond;
using asterix::Length;
using asterix::number;

inline constexpr unsigned kCategory = 240;
inline constexpr double kLight = 299792458.0;                  ///< m/s
inline constexpr double kFemtosecondRange = 0.5e-15 * kLight;  ///< m, round trip
inline constexpr std::uint64_t kFemtosPerNano = 1000000;

/// The data items of a record, in the order of its field specification.
enum Item : std::size_t {
  kSource,
  kMessageType,
  kSequence,
  kSummary,
  kHeaderNano,
  kHeaderFemto,
  kResolution,
  kCounters,
  kVideoLow,
  kVideoMedium,
  kVideoHigh,
  kTimeOfDay,
  kExpansion,
  kSpecial,
  kItems
};

inline constexpr std::array<ItemForm, kItems> kForms{{
    {"I240/010", Length::kFixed, 2},
    {"I240/000", Length::kFixed, 1},
    {"I240/020", Length::kFixed, 4},
    {"I240/030", Length::kRepeated, 1},
    {"I240/040", Length::kFixed, 12},
    {"I240/041", Length::kFixed, 12},
    {"I240/048", Length::kFixed, 2},
    {"I240/049", Length::kFixed, 5},
    {"I240/050", Length::kRepeated, 4},
    {"I240/051", Length::kRepeated, 64},
    {"I240/052", Length::kRepeated, 256},
    {"I240/140", Length::kFixed, 3},
    {"RE", Length::kOwn, 1},
    {"SP", Length::kOwn, 1},
}};

}  // namespace cat240

/// Faults of ASTERIX data.
enum class Cat240Fault : std::uint8_t {
  kNone = 0,
  kBlockLength = 1,         ///< a block shorter than its own header
  kTruncated = 2,           ///< the data end inside a block
  kNoBlock = 3,             ///< these octets do not lead to another block
  kFieldSpecification = 4,  ///< names undefined items
  kItemLength = 5,          ///< an item extends past its block
  kItemCount = 6,           ///< an item is missing, or two are present where one is allowed
  kMessageType = 7,         ///< neither video nor summary
  kCompressed = 8,          ///< cells are compressed in an unknown way
  kResolution = 9,          ///< unsupported number of bits per cell
  kCounters = 10,           ///< more cells than octets for them
  kNoCells = 11,            ///< video without cells
  kAzimuth = 12,            ///< a sweep half a revolution wide or more
  kCellDuration = 13,       ///< a cell of zero length
};

/// The fault as text, for messages and logs.
constexpr const char* to_string(Cat240Fault fault) noexcept {
  switch (fault) {
    case Cat240Fault::kNone:
      return "no fault";
    case Cat240Fault::kBlockLength:
      return "a data block is shorter than its header";
    case Cat240Fault::kTruncated:
      return "the data end inside a data block";
    case Cat240Fault::kNoBlock:
      return "no data block begins here";
    case Cat240Fault::kFieldSpecification:
      return "a field specification is too long";
    case Cat240Fault::kItemLength:
      return "an item extends past its data block";
    case Cat240Fault::kItemCount:
      return "a record lacks an item or has two of a kind";
    case Cat240Fault::kMessageType:
      return "a message of an unknown type";
    case Cat240Fault::kCompressed:
      return "the compressed video cannot be read";
    case Cat240Fault::kResolution:
      return "the resolution of the video cannot be read";
    case Cat240Fault::kCounters:
      return "a sweep announces more cells than it holds";
    case Cat240Fault::kNoCells:
      return "a sweep without cells";
    case Cat240Fault::kAzimuth:
      return "a sweep as wide as half a turn";
    case Cat240Fault::kCellDuration:
      return "range cells of no length";
  }
  return "unknown";
}

/// A fault, its position, what was expected and what was found.
struct Cat240Problem {
  Cat240Fault fault = Cat240Fault::kNone;
  std::uint64_t offset = 0;  ///< of the faulty block or record, octets from the start of the data
  const char* item = "";     ///< the faulty item, if any
  std::uint64_t wanted = 0;
  std::uint64_t came = 0;
};

/// What was expected, e.g. "at least 3 octets".
inline std::string wanted_text(const Cat240Problem& problem) {
  const std::string number = std::to_string(problem.wanted);
  switch (problem.fault) {
    case Cat240Fault::kBlockLength:
      return "a length of " + number + " octets or more";
    case Cat240Fault::kNoBlock:
      return "a block that another follows";
    case Cat240Fault::kFieldSpecification:
      return "at most " + number + " octets";
    case Cat240Fault::kItemLength:
      return number + " octets of " + problem.item;
    case Cat240Fault::kItemCount:
      return std::string("one ") + problem.item;
    case Cat240Fault::kMessageType:
      return "1 (summary) or 2 (video)";
    case Cat240Fault::kCompressed:
      return "zlib data of all cells";
    case Cat240Fault::kResolution:
      return "1 to " + number + " (1, 2, 4, 8 or 16 bits a cell)";
    case Cat240Fault::kNoCells:
      return "at least 1 cell";
    case Cat240Fault::kAzimuth:
      return "fewer than " + number + " steps of azimuth";
    case Cat240Fault::kCellDuration:
      return "at least 1 femtosecond";
    default:
      return number + " octets";
  }
}

/// What was found.
inline std::string came_text(const Cat240Problem& problem) {
  const std::string number = std::to_string(problem.came);
  switch (problem.fault) {
    case Cat240Fault::kNoBlock:
      return "category " + number;
    case Cat240Fault::kFieldSpecification:
      return number + " or more";
    case Cat240Fault::kCompressed:
      return "others";
    default:
      return number;
  }
}

/// One video record: the reception at one azimuth, its cells still packed in the data read.
struct Cat240Video {
  std::uint64_t offset = 0;  ///< of the record, octets from the start of the data
  Cat240Source source;
  std::int64_t sequence = -1;  ///< 32-bit counter of the sender's messages; -1 when absent
  double time_s = std::numeric_limits<double>::quiet_NaN();  ///< since the midnight before the
                                                             ///< first record; NaN when absent
  std::uint16_t start_azimuth = 0;                           ///< in steps of 2 pi / 65536
  std::uint16_t end_azimuth = 0;
  std::uint32_t start_cell = 0;        ///< number of cells between the antenna and the first one
  std::uint64_t cell_duration_fs = 0;  ///< round trip
  int bits = 8;                        ///< per cell
  std::uint32_t cells = 0;
  bool compressed = false;            ///< see `decompressed`
  std::span<const std::byte> packed;  ///< the octets occupied by the cells, or compressed ones

  /// Octets occupied by the cells, not compressed.
  [[nodiscard]] std::size_t octets() const noexcept {
    return (std::size_t{cells} * static_cast<unsigned>(bits) + 7) / 8;
  }

  /// The same with its cells in `octets`, decompressed from `packed` by the caller; the format does
  /// not define how, and senders use zlib. Remains compressed if there are too few octets.
  [[nodiscard]] Cat240Video decompressed(std::span<const std::byte> octets) const noexcept {
    Cat240Video video = *this;
    if (octets.size() < this->octets()) return video;
    video.packed = octets.first(this->octets());
    video.compressed = false;
    return video;
  }

  /// Azimuth steps from start to end; negative for an antenna that turns anticlockwise.
  [[nodiscard]] int turned() const noexcept {
    return std::bit_cast<std::int16_t>(static_cast<std::uint16_t>(end_azimuth - start_azimuth));
  }
  /// Centre of the sweep, clockwise from north, in [0, 2 pi).
  [[nodiscard]] double azimuth_rad() const noexcept {
    const double steps = start_azimuth + 0.5 * turned();
    return compass_angle(steps * (2 * kPi<double> / cat240::kAzimuthTurn));
  }
  /// 0 where start and end azimuth are equal.
  [[nodiscard]] double azimuth_width_rad() const noexcept {
    return std::abs(turned()) * (2 * kPi<double> / cat240::kAzimuthTurn);
  }
  /// cell_m = c t / 2.
  [[nodiscard]] double cell_m() const noexcept {
    return static_cast<double>(cell_duration_fs) * cat240::kFemtosecondRange;
  }
  /// Near edge of the first cell.
  [[nodiscard]] double start_range_m() const noexcept { return start_cell * cell_m(); }

  /// True when the cells can be unpacked to this type of amplitude: 1 to 8 bits to octets, 16 to
  /// words.
  template <std::unsigned_integral Amplitude>
  [[nodiscard]] bool fits() const noexcept {
    return (bits <= 8) == (sizeof(Amplitude) == 1);
  }

  /// The sweep with its cells unpacked into `room`, which must hold `cells` of them and outlive the
  /// sweep.
  ///
  /// Cells of 1, 2 and 4 bits are scaled by 255, 85 and 17, so that full scale stays full scale;
  /// the first cell of an octet is in the high bits. Returns a sweep without amplitudes when they
  /// do not fit `room` or its type, or are compressed.
  template <std::unsigned_integral Amplitude>
  requires(sizeof(Amplitude) <= 2) Sweep<Amplitude> unpack(std::span<Amplitude> room)
  const noexcept {
    Sweep<Amplitude> sweep{.time_s = time_s,
                           .azimuth_rad = azimuth_rad(),
                           .azimuth_width_rad = azimuth_width_rad(),
                           .start_range_m = start_range_m(),
                           .cell_m = cell_m(),
                           .amplitude = {}};
    if (compressed || !fits<Amplitude>() || room.size() < cells) return sweep;
    room = room.first(cells);
    if constexpr (sizeof(Amplitude) == 2) {
      for (std::size_t k = 0; k < cells; ++k)
        room[k] = static_cast<Amplitude>(cat240::number(packed.subspan(2 * k, 2)));
    } else if (bits == 8) {
      std::transform(packed.begin(), packed.end(), room.begin(),
                     [](std::byte octet) { return std::to_integer<Amplitude>(octet); });
    } else {
      unpack_parts(room);
    }
    sweep.amplitude = room;
    return sweep;
  }

 private:
  template <class Amplitude>
  void unpack_parts(std::span<Amplitude> room) const noexcept {
    const auto width = static_cast<std::size_t>(bits);
    const std::size_t per_octet = 8 / width;
    const unsigned full_scale = (1u << width) - 1;
    for (std::size_t k = 0; k < room.size(); ++k) {
      const std::size_t shift = 8 - width * (k % per_octet + 1);
      const unsigned value = std::to_integer<unsigned>(packed[k / per_octet]) >> shift & full_scale;
      room[k] = static_cast<Amplitude>(value * (255 / full_scale));
    }
  }
};

}  // namespace wakeline
