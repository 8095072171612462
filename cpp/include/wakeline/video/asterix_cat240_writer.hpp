// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "wakeline/video/asterix_cat240.hpp"

namespace wakeline {

/// Result of writing a sweep.
enum class Cat240Written : std::uint8_t {
  kOk = 0,
  kNoSweep = 1,       ///< invalid (see `Sweep::valid`), or half a revolution wide or more
  kTooManyCells = 2,  ///< more than `Cat240Writer::max_cells`
  kCellLength = 3,    ///< the cells are shorter than 75 nm
  kStartRange = 4,    ///< starts 2^32 cells from the antenna or more
  kNoRoom = 5,        ///< `out` is too small
  kTextTooLong = 6,   ///< a summary of more than 255 characters
};

/// The result as text, for messages and logs.
constexpr const char* to_string(Cat240Written written) noexcept {
  switch (written) {
    case Cat240Written::kOk:
      return "ok";
    case Cat240Written::kNoSweep:
      return "not a sweep of a radar";
    case Cat240Written::kTooManyCells:
      return "too many cells for one block";
    case Cat240Written::kCellLength:
      return "a cell length outside the range of the format";
    case Cat240Written::kStartRange:
      return "a start range outside the range of the format";
    case Cat240Written::kNoRoom:
      return "no room to write to";
    case Cat240Written::kTextTooLong:
      return "a text of more than 255 characters";
  }
  return "unknown";
}

/// Writes sweeps as ASTERIX category 240, a block with one record each; never allocates, never
/// throws.
///
/// Precision: amplitudes unchanged, 8 or 16 bits; azimuth to half a step of 2 pi / 65536, width to
/// one; time of day to 1/256 s; cell length to 75 nm up to 643 m (cell durations in whole
/// nanoseconds where possible, else in femtoseconds) and to 75 mm above; start range to half a
/// cell, as the format counts it in cells.
class Cat240Writer {
 public:
  /// Octets that suffice for any sweep or summary.
  static constexpr std::size_t kRoom = cat240::kLongestBlock;

  explicit Cat240Writer(Cat240Source source = {}) noexcept : source_(source) {}

  /// Capacity of one record in cells: 254 parts of 256 octets.
  template <std::unsigned_integral Amplitude>
  [[nodiscard]] static constexpr std::size_t max_cells() noexcept {
    return std::size_t{254} * 256 / sizeof(Amplitude);
  }

  /// Writes one sweep to the start of `out` and counts it; `size()` is then its number of octets.
  template <std::unsigned_integral Amplitude>
  requires(sizeof(Amplitude) <= 2) Cat240Written
      write(const Sweep<Amplitude>& sweep, std::span<std::byte> out)
  noexcept {
    using namespace cat240;
    begin(out);
    if (!sweep.valid() || sweep.azimuth_width_rad >= kWidest) return Cat240Written::kNoSweep;
    if (sweep.amplitude.size() > max_cells<Amplitude>()) return Cat240Written::kTooManyCells;
    const Duration duration = Duration::of(sweep.cell_m);
    if (duration.count == 0) return Cat240Written::kCellLength;
    const double start_cell = std::round(sweep.start_range_m / duration.cell_m());
    if (start_cell > 0xFFFFFFFFu) return Cat240Written::kStartRange;
    const std::size_t octets = sizeof(Amplitude) * sweep.amplitude.size();
    const Parts parts = Parts::of(octets);

    specify({kSource, kMessageType, kSequence, duration.nano ? kHeaderNano : kHeaderFemto,
             kResolution, kCounters, parts.item, kTimeOfDay});
    put_labels(2);
    put(4, sequence_);
    put(2, asterix::azimuth_steps(sweep.azimuth_rad - 0.5 * sweep.azimuth_width_rad));
    put(2, asterix::azimuth_steps(sweep.azimuth_rad + 0.5 * sweep.azimuth_width_rad));
    put(4, static_cast<std::uint64_t>(start_cell));
    put(4, duration.count);
    put(2, sizeof(Amplitude) == 1 ? 4 : 5);
    put(2, octets);
    put(3, sweep.amplitude.size());
    put(1, parts.count);
    for (const Amplitude amplitude : sweep.amplitude) put(sizeof(Amplitude), amplitude);
    for (std::size_t k = octets; k < parts.octets(); ++k) put(1, 0);
    put(3, asterix::day_ticks(sweep.time_s));
    if (!end()) return Cat240Written::kNoRoom;
    ++sequence_;
    return Cat240Written::kOk;
  }

  /// Writes a text about the video, ASCII, at most 255 characters.
  Cat240Written write_summary(std::string_view text, std::span<std::byte> out) noexcept {
    using namespace cat240;
    begin(out);
    if (text.size() > 0xFF) return Cat240Written::kTextTooLong;
    specify({kSource, kMessageType, kSummary});
    put_labels(1);
    put(1, text.size());
    for (const char letter : text) put(1, static_cast<unsigned char>(letter));
    return end() ? Cat240Written::kOk : Cat240Written::kNoRoom;
  }

  /// Octets of the last block written; 0 after a failure.
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

 private:
  static constexpr double kWidest =
      kPi<double> - 2e-4;  ///< still less than half a revolution after rounding

  /// The duration of a cell in the unit that represents it best.
  struct Duration {
    std::uint64_t count = 0;
    bool nano = false;

    static Duration of(double cell_m) noexcept {
      using namespace cat240;
      constexpr double most = 0xFFFFFFFFu;
      const double femtos = std::round(cell_m / kFemtosecondRange);
      const double nanos = std::round(femtos / kFemtosPerNano);
      if (femtos > most || femtos == nanos * kFemtosPerNano)
        return {static_cast<std::uint64_t>(nanos), true};
      return {static_cast<std::uint64_t>(femtos), false};
    }
    [[nodiscard]] double cell_m() const noexcept {
      const std::uint64_t femtos = count * (nano ? cat240::kFemtosPerNano : 1);
      return static_cast<double>(femtos) * cat240::kFemtosecondRange;
    }
  };

  /// The smallest video block for a number of octets.
  struct Parts {
    cat240::Item item;
    std::size_t count;

    static Parts of(std::size_t octets) noexcept {
      using namespace cat240;
      const Item item = octets <= 255 * kForms[kVideoLow].octets      ? kVideoLow
                        : octets <= 255 * kForms[kVideoMedium].octets ? kVideoMedium
                                                                      : kVideoHigh;
      const std::size_t part = kForms[item].octets;
      return {item, (octets + part - 1) / part};
    }
    [[nodiscard]] std::size_t octets() const noexcept {
      return count * cat240::kForms[item].octets;
    }
  };

  void begin(std::span<std::byte> out) noexcept {
    block_.begin(cat240::kCategory, out);
    size_ = 0;
  }

  /// Writes the field specification of these items.
  void specify(std::initializer_list<cat240::Item> items) noexcept {
    std::uint64_t bits = 0;
    for (const cat240::Item item : items) bits |= std::uint64_t{1} << item;
    block_.specify(bits);
  }

  void put_labels(unsigned message_type) noexcept {
    put(1, source_.area);
    put(1, source_.system);
    put(1, message_type);
  }

  void put(std::size_t octets, std::uint64_t value) noexcept { block_.put(octets, value); }

  /// Writes the length of the block.
  bool end() noexcept {
    size_ = block_.end() ? block_.size() : 0;
    return size_ > 0;
  }

  Cat240Source source_;
  std::uint32_t sequence_ = 0;
  asterix::BlockWriter block_;
  std::size_t size_ = 0;
};

}  // namespace wakeline
