// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "wakeline/video/asterix_cat240.hpp"

namespace wakeline {

/// What the reader found next.
enum class Cat240Event : std::uint8_t {
  kEnd = 0,      ///< no more in these data
  kVideo = 1,    ///< a sweep: see `video()`
  kSummary = 2,  ///< a text of the sender about its video: see `summary()`
  kProblem = 3,  ///< data that cannot be read: see `problem()`
};

/// Time since the first midnight, from times of day that restart at each midnight.
class DayClock {
 public:
  /// The time nearest to the one before with this time of day. NaN stays NaN.
  double operator()(double time_of_day_s) noexcept {
    if (std::isnan(time_of_day_s)) return time_of_day_s;
    if (last_s_ - time_of_day_s > cat240::kDay / 2) midnight_s_ += cat240::kDay;
    if (time_of_day_s - last_s_ > cat240::kDay / 2) midnight_s_ -= cat240::kDay;
    last_s_ = time_of_day_s;
    return midnight_s_ + time_of_day_s;
  }

 private:
  double last_s_ = std::numeric_limits<double>::quiet_NaN();
  double midnight_s_ = 0.0;
};

/// Reads ASTERIX category 240 from memory, record by record; never allocates, never throws.
///
///     Cat240Reader reader;
///     reader.feed(octets);
///     for (auto event = reader.next(); event != Cat240Event::kEnd; event = reader.next())
///       if (event == Cat240Event::kVideo) show(reader.video().unpack<std::uint8_t>(room));
///
/// A long file is fed in pieces: after `kEnd`, `consumed()` octets are finished, and the next piece
/// starts with the rest. Pieces of `kPiece` octets or more give the same events.
///
/// **Blocks of other categories** are skipped by their length.
///
/// **Damage.** A record that cannot be read is a problem. Reading continues after it, or after its
/// block where its end cannot be determined, provided that the length of the block leads to valid
/// data: to a video block with a complete first record, to the end of the data, or over blocks of
/// other categories (at most 128 KiB or 256 of them) to one of these. Otherwise the reader searches
/// for a valid video block octet by octet. A block length of any category that skips two
/// consecutive valid video blocks is considered wrong. So almost no valid data are lost after
/// damage, whether of contents or of a length.
class Cat240Reader {
 public:
  static constexpr std::size_t kPiece = 1 << 19;  ///< octets

  /// Octets to read: the rest of the last ones, from `consumed()` on, and what follows. `last`:
  /// nothing follows. They must live until the next `feed`.
  void feed(std::span<const std::byte> octets, bool last = true) noexcept {
    base_ += position_;
    block_end_ -= std::min(block_end_, position_);
    resume_ -= std::min(resume_, position_);
    position_ = 0;
    octets_ = octets;
    last_ = last;
  }

  /// Advances to the next record or problem.
  Cat240Event next() noexcept {
    for (;;) {
      const Cat240Event event = step();
      if (event != kGoOn) return event;
    }
  }

  /// The sweep found by `next`; its cells are in the data fed.
  [[nodiscard]] const Cat240Video& video() const noexcept { return video_; }
  /// The text found by `next`, in the data fed.
  [[nodiscard]] std::string_view summary() const noexcept { return summary_; }
  /// The problem found by `next`.
  [[nodiscard]] const Cat240Problem& problem() const noexcept { return problem_; }

  /// Octets of these data that are finished.
  [[nodiscard]] std::size_t consumed() const noexcept { return position_; }
  /// Number of blocks of other categories so far.
  [[nodiscard]] std::uint64_t other_blocks() const noexcept { return other_blocks_; }
  /// Number of octets skipped so far because of damage.
  [[nodiscard]] std::uint64_t skipped_octets() const noexcept { return skipped_; }

 private:
  using Octets = std::span<const std::byte>;
  using Items = std::array<Octets, cat240::kItems>;

  enum class At : std::uint8_t { kBlock, kRecord, kDamage, kNowhere };
  enum class Sound : std::uint8_t { kNo, kYes, kUnknown };  ///< kUnknown: more data are needed

  struct Record {
    Items items;
    std::size_t end = 0;
  };

  static constexpr auto kGoOn = static_cast<Cat240Event>(255);
  static constexpr std::size_t kLookAhead = 1 << 17;
  static constexpr int kBlocksAhead = 256;

  Cat240Event step() noexcept {
    switch (at_) {
      case At::kBlock:
        return enter_block();
      case At::kRecord:
        return read_record();
      case At::kDamage:
        return leave_damage();
      case At::kNowhere:
        return look_for_block();
    }
    return Cat240Event::kEnd;
  }

  Cat240Event enter_block() noexcept {
    using namespace cat240;
    const std::size_t left = octets_.size() - position_;
    if (left == 0 || (left < kBlockHeader && !last_)) return Cat240Event::kEnd;
    if (left < kBlockHeader) return give_up(Cat240Fault::kTruncated, kBlockHeader, left);
    const std::size_t length = block_length(position_);
    if (length < kBlockHeader) return give_up(Cat240Fault::kBlockLength, kBlockHeader, length);
    if (category(position_) != kCategory) return pass_block(position_ + length);
    if (length > left && !last_) return Cat240Event::kEnd;
    block_end_ = position_ + length;
    const std::size_t block = position_;
    position_ += kBlockHeader;
    at_ = At::kRecord;
    return length > left ? fault_event(Cat240Fault::kTruncated, block, length, left) : kGoOn;
  }

  Cat240Event pass_block(std::size_t end) noexcept {
    const Sound sound = category(position_) == 0 ? Sound::kNo : leads_rightly_to(end);
    if (sound == Sound::kUnknown) return Cat240Event::kEnd;
    if (sound == Sound::kNo) return give_up(Cat240Fault::kNoBlock, 0, category(position_));
    ++other_blocks_;
    position_ = end;
    return kGoOn;
  }

  Cat240Event read_record() noexcept {
    const bool truncated = block_end_ > octets_.size();
    if (position_ == block_end_ || (truncated && position_ == octets_.size())) {
      at_ = At::kBlock;
      return kGoOn;
    }
    Record record;
    const bool whole = split(position_, std::min(block_end_, octets_.size()), record);
    const Cat240Event event = whole ? interpret(position_, record) : Cat240Event::kProblem;
    if (event == Cat240Event::kProblem) {
      resume_ = whole ? record.end : block_end_;
      at_ = At::kDamage;
      return truncated && !whole ? kGoOn : event;  // the truncation has been reported
    }
    position_ = record.end;
    return event;
  }

  /// Continues after the block if its length is plausible, else searches for another block from the
  /// faulty record on.
  Cat240Event leave_damage() noexcept {
    const Sound sound = leads_rightly_to(block_end_);
    if (sound == Sound::kUnknown) return Cat240Event::kEnd;
    if (sound == Sound::kYes) skip_to(resume_);
    at_ = sound == Sound::kYes ? At::kRecord : At::kNowhere;
    return kGoOn;
  }

  Cat240Event look_for_block() noexcept {
    for (;;) {
      skip_to(find_mark(position_));
      if (position_ == octets_.size()) return Cat240Event::kEnd;
      const Sound sound = sound_video(position_);
      if (sound == Sound::kUnknown) return Cat240Event::kEnd;
      if (sound == Sound::kYes) {
        at_ = At::kBlock;
        return kGoOn;
      }
      skip_to(position_ + 1);
    }
  }

  /// The first octet from here on that can start a video block, or the end of these data.
  [[nodiscard]] std::size_t find_mark(std::size_t at) const noexcept {
    const Octets rest = octets_.subspan(at);
    const void* found =
        rest.empty() ? nullptr : std::memchr(rest.data(), static_cast<int>(kMark), rest.size());
    if (found == nullptr) return octets_.size();
    return static_cast<std::size_t>(static_cast<const std::byte*>(found) - octets_.data());
  }

  /// True when a length that leads from here to `end` is right: to valid data, and past no video.
  [[nodiscard]] Sound leads_rightly_to(std::size_t end) const noexcept {
    const Sound sound = leads_on(end);
    if (sound != Sound::kYes) return sound;
    const Sound passed = video_before(end);
    return passed == Sound::kUnknown ? passed : passed == Sound::kYes ? Sound::kNo : Sound::kYes;
  }

  /// True when two consecutive valid video blocks, which other data do not contain by chance, start
  /// between here and the end.
  [[nodiscard]] Sound video_before(std::size_t end) const noexcept {
    for (std::size_t at = find_mark(position_); at < end; at = find_mark(at + 1)) {
      Sound sound = sound_video(at);
      if (sound == Sound::kYes) sound = sound_video(at + block_length(at));
      if (sound != Sound::kNo) return sound;
    }
    return Sound::kNo;
  }

  /// True when the data there lead to a valid video block or to the end of the data.
  [[nodiscard]] Sound leads_on(std::size_t at) const noexcept {
    const std::size_t limit = position_ + cat240::kLongestBlock + kLookAhead;
    for (int block = 0; block < kBlocksAhead; ++block) {
      if (last_ && at == octets_.size()) return Sound::kYes;
      if (at > limit) return Sound::kNo;
      if (at + cat240::kBlockHeader > octets_.size()) return cut();
      if (category(at) == cat240::kCategory) return sound_video(at);
      if (category(at) == 0 || block_length(at) < cat240::kBlockHeader) return Sound::kNo;
      at += block_length(at);
    }
    return Sound::kYes;
  }

  /// True when a video block starts there whose first record is complete and has source and type.
  [[nodiscard]] Sound sound_video(std::size_t at) const noexcept {
    using namespace cat240;
    if (at + kBlockHeader > octets_.size()) return cut();
    const std::size_t end = at + block_length(at);
    if (category(at) != kCategory || end <= at + kBlockHeader) return Sound::kNo;
    if (end > octets_.size()) return cut();
    Record record;
    Cat240Problem ignored;
    if (!split(at + kBlockHeader, end, record, ignored)) return Sound::kNo;
    const bool named = !record.items[kSource].empty() && is_known(record.items[kMessageType]);
    return named ? Sound::kYes : Sound::kNo;
  }

  [[nodiscard]] Sound cut() const noexcept { return last_ ? Sound::kNo : Sound::kUnknown; }

  bool split(std::size_t begin, std::size_t limit, Record& record) noexcept {
    return split(begin, limit, record, problem_);
  }

  /// Splits a record into its items; false, and the reason, when they do not end within `limit`.
  bool split(std::size_t begin, std::size_t limit, Record& record,
             Cat240Problem& problem) const noexcept {
    const asterix::Split found =
        asterix::split(cat240::kForms, octets_.subspan(begin, limit - begin), record.items);
    record.end = begin + found.octets;
    if (found.flaw == asterix::Flaw::kNone) return true;
    const Cat240Fault fault = found.flaw == asterix::Flaw::kSpecification
                                  ? Cat240Fault::kFieldSpecification
                                  : Cat240Fault::kItemLength;
    problem = {fault, base_ + begin, found.item, found.wanted, found.came};
    return false;
  }

  Cat240Event interpret(std::size_t begin, const Record& record) noexcept {
    using namespace cat240;
    const Items& items = record.items;
    if (!known_type(begin, items)) return Cat240Event::kProblem;
    if (!items[kSummary].empty()) return read_summary(items[kSummary].subspan(1));
    video_ = {};
    video_.offset = base_ + begin;
    read_labels(items);
    if (!read_header(begin, items) || !read_resolution(begin, items) || !read_cells(begin, items))
      return Cat240Event::kProblem;
    video_.time_s = clock_(time_of_day_s(items[kTimeOfDay]));
    return Cat240Event::kVideo;
  }

  bool known_type(std::size_t begin, const Items& items) noexcept {
    const Octets octet = items[cat240::kMessageType];
    if (octet.empty()) return reject_count(begin, "I240/000", 0);
    return is_known(octet) || reject(Cat240Fault::kMessageType, begin, 2, cat240::number(octet));
  }

  Cat240Event read_summary(Octets text) noexcept {
    summary_ = {reinterpret_cast<const char*>(text.data()), text.size()};
    return Cat240Event::kSummary;
  }

  void read_labels(const Items& items) noexcept {
    using namespace cat240;
    if (const Octets source = items[kSource]; !source.empty())
      video_.source = {std::to_integer<std::uint8_t>(source[0]),
                       std::to_integer<std::uint8_t>(source[1])};
    if (const Octets sequence = items[kSequence]; !sequence.empty())
      video_.sequence = static_cast<std::int64_t>(number(sequence));
  }

  bool read_header(std::size_t begin, const Items& items) noexcept {
    using namespace cat240;
    const Choice header = choose(items, kHeaderNano, kHeaderFemto);
    if (header.count != 1) return reject_count(begin, "I240/040 or I240/041", header.count);
    video_.start_azimuth = static_cast<std::uint16_t>(number(header.octets.subspan(0, 2)));
    video_.end_azimuth = static_cast<std::uint16_t>(number(header.octets.subspan(2, 2)));
    video_.start_cell = static_cast<std::uint32_t>(number(header.octets.subspan(4, 4)));
    const std::uint64_t unit_fs = items[kHeaderFemto].empty() ? kFemtosPerNano : 1;
    video_.cell_duration_fs = unit_fs * number(header.octets.subspan(8, 4));
    if (video_.turned() == -kHalfTurn)
      return reject(Cat240Fault::kAzimuth, begin, kHalfTurn, kHalfTurn);
    return video_.cell_duration_fs > 0 || reject(Cat240Fault::kCellDuration, begin, 1, 0);
  }

  bool read_resolution(std::size_t begin, const Items& items) noexcept {
    const Octets octets = items[cat240::kResolution];
    if (octets.empty()) return reject_count(begin, "I240/048", 0);
    video_.compressed = (octets[0] & std::byte{0x80}) != std::byte{0};
    const auto resolution = std::to_integer<unsigned>(octets[1]);
    video_.bits = resolution - 1 < 5 ? 1 << (resolution - 1) : 0;
    return video_.bits > 0 || reject(Cat240Fault::kResolution, begin, 5, resolution);
  }

  bool read_cells(std::size_t begin, const Items& items) noexcept {
    using namespace cat240;
    const Octets counters = items[kCounters];
    const Choice block = choose(items, kVideoLow, kVideoHigh);
    if (counters.empty()) return reject_count(begin, "I240/049", 0);
    if (block.count != 1) return reject_count(begin, "I240/050, I240/051 or I240/052", block.count);
    video_.cells = static_cast<std::uint32_t>(number(counters.subspan(2)));
    if (video_.cells == 0) return reject(Cat240Fault::kNoCells, begin, 1, 0);
    const Octets room = block.octets.subspan(1);
    const std::size_t given = number(counters.first(2));
    const std::size_t held = std::min<std::size_t>(given, room.size());
    const std::size_t needed =
        video_.compressed ? std::max(given, std::size_t{1}) : video_.octets();
    if (needed > held) return reject(Cat240Fault::kCounters, begin, needed, held);
    video_.packed = room.first(needed);
    return true;
  }

  struct Choice {
    Octets octets;
    std::size_t count = 0;
  };

  /// The item present out of several alternatives, and how many of them are.
  static Choice choose(const Items& items, std::size_t first, std::size_t last) noexcept {
    Choice choice;
    for (std::size_t item = first; item <= last; ++item)
      if (!items[item].empty()) choice = {items[item], choice.count + 1};
    return choice;
  }

  static double time_of_day_s(Octets ticks) noexcept {
    if (ticks.empty()) return std::numeric_limits<double>::quiet_NaN();
    return static_cast<double>(cat240::number(ticks)) / cat240::kTicksPerSecond;
  }

  static bool is_known(Octets message_type) noexcept {
    const std::uint64_t type = cat240::number(message_type);
    return type == 1 || type == 2;
  }

  [[nodiscard]] unsigned category(std::size_t at) const noexcept {
    return std::to_integer<unsigned>(octets_[at]);
  }
  [[nodiscard]] std::size_t block_length(std::size_t at) const noexcept {
    return static_cast<std::size_t>(cat240::number(octets_.subspan(at + 1, 2)));
  }

  void skip_to(std::size_t position) noexcept {
    skipped_ += position - position_;
    position_ = position;
  }

  /// Reports a problem of the block that should start here; the search for a block starts at the
  /// next octet.
  Cat240Event give_up(Cat240Fault fault, std::uint64_t wanted, std::uint64_t came) noexcept {
    const std::size_t block = position_;
    skip_to(position_ + 1);
    at_ = At::kNowhere;
    return fault_event(fault, block, wanted, came);
  }

  Cat240Event fault_event(Cat240Fault fault, std::size_t where, std::uint64_t wanted,
                          std::uint64_t came) noexcept {
    reject(fault, where, wanted, came);
    return Cat240Event::kProblem;
  }

  bool reject(Cat240Fault fault, std::size_t where, std::uint64_t wanted,
              std::uint64_t came) noexcept {
    problem_ = {fault, base_ + where, "", wanted, came};
    return false;
  }

  bool reject_count(std::size_t where, const char* item, std::uint64_t came) noexcept {
    problem_ = {Cat240Fault::kItemCount, base_ + where, item, 1, came};
    return false;
  }

  static constexpr std::byte kMark{cat240::kCategory};
  static constexpr int kHalfTurn = 0x8000;

  Octets octets_;
  bool last_ = true;
  At at_ = At::kBlock;
  std::size_t position_ = 0;
  std::size_t block_end_ = 0;  ///< of the current block
  std::size_t resume_ = 0;     ///< after the damage, where the length of the block is right
  std::uint64_t base_ = 0;     ///< octets of earlier pieces
  std::uint64_t other_blocks_ = 0;
  std::uint64_t skipped_ = 0;
  Cat240Video video_;
  std::string_view summary_;
  Cat240Problem problem_;
  DayClock clock_;
};

}  // namespace wakeline
