// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/video/asterix_cat240.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "support/malloc_fence.hpp"
#include "support/tests_dir.hpp"
#include "wakeline/video/asterix_cat240_reader.hpp"
#include "wakeline/video/asterix_cat240_writer.hpp"

namespace wakeline::asterix_cat240_test {
namespace {

using Bytes = std::vector<std::byte>;
constexpr double kStep = 2 * kPi<double> / 65536;

Bytes bytes(std::initializer_list<int> octets) {
  Bytes result;
  for (const int octet : octets) result.push_back(static_cast<std::byte>(octet));
  return result;
}

Bytes operator+(Bytes left, const Bytes& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

template <class Amplitude>
std::vector<Amplitude> ramp(std::size_t cells, int slope = 7) {
  std::vector<Amplitude> amplitude(cells);
  for (std::size_t k = 0; k < cells; ++k)
    amplitude[k] = static_cast<Amplitude>(static_cast<unsigned>(slope) * k + 1);
  return amplitude;
}

template <class Amplitude>
Sweep<Amplitude> sweep_of(const std::vector<Amplitude>& amplitude, double time_s = 100.0,
                          double azimuth_rad = 1.0) {
  return {.time_s = time_s,
          .azimuth_rad = azimuth_rad,
          .azimuth_width_rad = 16 * kStep,
          .start_range_m = 60.0,
          .cell_m = 6.0,
          .amplitude = amplitude};
}

template <class Amplitude>
Bytes written(Cat240Writer& writer, const Sweep<Amplitude>& sweep) {
  Bytes room(Cat240Writer::kRoom);
  EXPECT_EQ(writer.write(sweep, std::span<std::byte>(room)), Cat240Written::kOk);
  room.resize(writer.size());
  return room;
}

/// A turn of `n` sweeps of 40 cells, one block each.
std::vector<Bytes> turn_of(int n) {
  Cat240Writer writer({25, 7});
  std::vector<Bytes> blocks;
  for (int k = 0; k < n; ++k)
    blocks.push_back(
        written(writer, sweep_of(ramp<std::uint8_t>(40, k), 100 + 0.01 * k, 0.01 * k)));
  return blocks;
}

Bytes joined(const std::vector<Bytes>& blocks) {
  Bytes all;
  for (const Bytes& block : blocks) all = all + block;
  return all;
}

/// All that a reader comes to, in plain numbers that can be compared.
struct Story {
  std::vector<std::int64_t> sequence;
  std::vector<double> time_s;
  std::vector<std::vector<unsigned>> amplitude;
  std::vector<std::string> summaries;
  std::vector<Cat240Problem> problems;
  std::uint64_t other_blocks = 0;
  std::uint64_t skipped = 0;

  [[nodiscard]] std::vector<Cat240Fault> faults() const {
    std::vector<Cat240Fault> all;
    for (const Cat240Problem& problem : problems) all.push_back(problem.fault);
    return all;
  }
};

void note(Story& story, const Cat240Reader& reader, Cat240Event event) {
  if (event == Cat240Event::kProblem) story.problems.push_back(reader.problem());
  if (event == Cat240Event::kSummary) story.summaries.emplace_back(reader.summary());
  if (event != Cat240Event::kVideo) return;
  const Cat240Video& video = reader.video();
  story.sequence.push_back(video.sequence);
  story.time_s.push_back(video.time_s);
  std::vector<std::uint8_t> octets(video.cells);
  std::vector<std::uint16_t> words(video.cells);
  const auto narrow = video.unpack(std::span<std::uint8_t>(octets)).amplitude;
  const auto wide = video.unpack(std::span<std::uint16_t>(words)).amplitude;
  // One of them takes the cells, but compressed ones.
  EXPECT_EQ(narrow.size() + wide.size(), video.compressed ? 0 : video.cells);
  std::vector<unsigned> amplitude(narrow.begin(), narrow.end());
  amplitude.insert(amplitude.end(), wide.begin(), wide.end());
  story.amplitude.push_back(amplitude);
}

/// Reads all of it, fed in pieces as a file would be.
Story read(const Bytes& all, std::size_t piece = std::numeric_limits<std::size_t>::max()) {
  Story story;
  Cat240Reader reader;
  std::size_t begin = 0, end = std::min(piece, all.size());
  for (;;) {
    // A separate copy, so that the sanitizer detects reads past its end.
    const Bytes part(all.begin() + static_cast<std::ptrdiff_t>(begin),
                     all.begin() + static_cast<std::ptrdiff_t>(end));
    const bool last = end == all.size();
    reader.feed(part, last);
    for (auto event = reader.next(); event != Cat240Event::kEnd; event = reader.next())
      note(story, reader, event);
    begin += reader.consumed();
    if (last) break;
    end = std::min(end + std::min(piece, all.size()), all.size());
  }
  EXPECT_EQ(begin, all.size());
  story.other_blocks = reader.other_blocks();
  story.skipped = reader.skipped_octets();
  return story;
}

TEST(Cat240, Writes_what_the_specification_requires) {
  const std::vector<std::uint8_t> amplitude{1, 2, 3, 4, 5};
  Cat240Writer writer({25, 7});
  const Bytes block = written(writer, Sweep<std::uint8_t>{.time_s = 1.0,
                                                          .azimuth_rad = deg(90),
                                                          .azimuth_width_rad = 32 * kStep,
                                                          .start_range_m = 149.896229,
                                                          .cell_m = 14.9896229,
                                                          .amplitude = amplitude});
  EXPECT_EQ(block, bytes({240,  0,    43,                         // category, length
                          0xEB, 0xC8,                             // items 1 2 3 5 7, 8 9 12
                          25,   7,    2,                          // source, video
                          0,    0,    0,    0,                    // first message
                          0x3F, 0xF0, 0x40, 0x10,                 // 90 deg less and more 16 steps
                          0,    0,    0,    10,                   // ten cells from the antenna
                          0,    0,    0,    100,                  // 100 ns
                          0,    4,                                // 8 bits, not compressed
                          0,    5,    0,    0,    5,              // octets, cells
                          2,    1,    2,    3,    4, 5, 0, 0, 0,  // two parts of four octets
                          0,    0,    128}));                     // 1 s
}

template <class Amplitude>
void expect_back(double azimuth_rad, double width_rad, double start_range_m, double cell_m,
                 std::size_t cells, double time_s) {
  const auto amplitude = ramp<Amplitude>(cells);
  const Sweep<Amplitude> sweep{time_s, azimuth_rad, width_rad, start_range_m, cell_m, amplitude};
  Cat240Writer writer({1, 2});
  const Bytes block = written(writer, sweep);
  Cat240Reader reader;
  reader.feed(block);
  ASSERT_EQ(reader.next(), Cat240Event::kVideo);
  std::vector<Amplitude> room(cells);
  const Sweep<Amplitude> back = reader.video().unpack(std::span<Amplitude>(room));
  EXPECT_TRUE(
      std::equal(back.amplitude.begin(), back.amplitude.end(), amplitude.begin(), amplitude.end()));
  EXPECT_LE(std::abs(wrap_angle(back.azimuth_rad - azimuth_rad)), kStep / 2 + 1e-12);
  EXPECT_LE(std::abs(back.azimuth_width_rad - width_rad), kStep + 1e-12);
  const double cell_error_m = cell_m < 643 ? 0.5e-15 * 299792458 / 2 : 0.5e-9 * 299792458 / 2;
  EXPECT_LE(std::abs(back.cell_m - cell_m), cell_error_m * (1 + 1e-6));
  EXPECT_LE(std::abs(back.start_range_m - start_range_m), back.cell_m * 0.500001);
  EXPECT_LE(std::abs(std::remainder(back.time_s - time_s, 86400.0)), 1.0 / 256 + 1e-9);
  EXPECT_TRUE(reader.video().source == (Cat240Source{1, 2}));
  EXPECT_EQ(reader.next(), Cat240Event::kEnd);
  EXPECT_EQ(reader.consumed(), block.size());
}

TEST(Cat240, Gives_back_what_was_written) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  for (const std::size_t cells :
       {1u, 2u, 4u, 255u, 1020u, 1021u, 2048u, 16320u, 16321u, 32512u, 65024u}) {
    const double cell_m = std::pow(10.0, 5 * uniform(random) - 1.5);
    const double width = std::pow(10.0, -4 * uniform(random)) * 3.0;
    const double azimuth = 20 * (uniform(random) - 0.5);
    const double start_m = 1e4 * uniform(random);
    const double time_s = 4e5 * (uniform(random) - 0.2);
    SCOPED_TRACE(cells);
    expect_back<std::uint8_t>(azimuth, width, start_m, cell_m, cells, time_s);
    if (cells <= 32512) expect_back<std::uint16_t>(azimuth, width, start_m, cell_m, cells, time_s);
  }
}

TEST(Cat240, Crosses_north) {
  for (const double azimuth : {0.0, -5e-4, 5e-4, 2 * kPi<double> - 1e-6})
    expect_back<std::uint8_t>(azimuth, 2e-3, 0.0, 3.0, 10, 0.0);
}

TEST(Cat240, An_antenna_that_turns_anticlockwise_ends_before_it_starts) {
  Bytes block = turn_of(1)[0];
  for (std::size_t k = 0; k < 2; ++k) std::swap(block[12 + k], block[14 + k]);
  Cat240Reader reader;
  reader.feed(block);
  ASSERT_EQ(reader.next(), Cat240Event::kVideo);
  EXPECT_EQ(reader.video().turned(), -16);
  EXPECT_NEAR(wrap_angle(reader.video().azimuth_rad()), 0.0, kStep);
  EXPECT_NEAR(reader.video().azimuth_width_rad(), 16 * kStep, 1e-12);
}

TEST(Cat240, Expands_small_cells_to_full_scale) {
  const auto with = [](int resolution, int octets, int cells, Bytes packed) {
    return bytes({240, 0, 40, 0xEB, 0xC0, 0, 0, 2,   0, 0,          0, 0,      0, 0, 0,     16,
                  0,   0, 0,  0,    0,    0, 0, 100, 0, resolution, 0, octets, 0, 0, cells, 2}) +
           packed;
  };
  const Bytes packed = bytes({0b10110001, 0b01000000, 0, 0, 0, 0, 0, 0});
  using Row = std::vector<unsigned>;
  EXPECT_EQ(read(with(1, 2, 10, packed)).amplitude[0],
            (Row{255, 0, 255, 255, 0, 0, 0, 255, 0, 255}));
  EXPECT_EQ(read(with(2, 2, 5, packed)).amplitude[0], (Row{170, 255, 0, 85, 85}));
  EXPECT_EQ(read(with(3, 2, 3, packed)).amplitude[0], (Row{187, 17, 68}));
  EXPECT_EQ(read(with(4, 2, 2, packed)).amplitude[0], (Row{0xB1, 0x40}));
  EXPECT_EQ(read(with(5, 2, 1, packed)).amplitude[0], (Row{0xB140}));
  EXPECT_TRUE(std::isnan(read(with(4, 2, 2, packed)).time_s[0]));  // absent
}

TEST(Cat240, Leaves_decompression_to_its_user) {
  Bytes block = turn_of(1)[0];
  block[24] = std::byte{0x80};
  block[27] = std::byte{7};  // octets of compressed data
  Cat240Reader reader;
  reader.feed(block);
  ASSERT_EQ(reader.next(), Cat240Event::kVideo);
  const Cat240Video video = reader.video();
  EXPECT_TRUE(video.compressed);
  EXPECT_EQ(video.packed.size(), 7u);
  std::vector<std::uint8_t> room(video.cells);
  EXPECT_TRUE(video.unpack(std::span(room)).amplitude.empty());
  const Bytes cells(video.octets(), std::byte{5});
  EXPECT_TRUE(video.decompressed(std::span(cells).first(cells.size() - 1)).compressed);
  const auto sweep = video.decompressed(cells).unpack(std::span(room));
  ASSERT_EQ(sweep.amplitude.size(), video.cells);
  EXPECT_EQ(sweep.amplitude.back(), 5);
}

TEST(Cat240, Reports_what_it_cannot_read_and_continues) {
  const std::vector<Bytes> blocks = turn_of(2);
  const auto with = [&](std::size_t at, std::initializer_list<int> octets) {
    Bytes bad = blocks[0];
    for (const int octet : octets) bad[at++] = static_cast<std::byte>(octet);
    return read(bad + blocks[1]);
  };
  const auto expect = [&](const Story& story, Cat240Fault fault, std::uint64_t wanted,
                          std::uint64_t came) {
    SCOPED_TRACE(to_string(fault));
    ASSERT_EQ(story.faults(), std::vector{fault});
    EXPECT_EQ(story.problems[0].offset, 3u);
    EXPECT_EQ(story.problems[0].wanted, wanted);
    EXPECT_EQ(story.problems[0].came, came);
    EXPECT_EQ(story.sequence, std::vector<std::int64_t>{1});
  };
  expect(with(7, {3}), Cat240Fault::kMessageType, 2, 3);
  expect(with(12, {0, 0, 0x80, 0}), Cat240Fault::kAzimuth, 32768, 32768);
  expect(with(20, {0, 0, 0, 0}), Cat240Fault::kCellDuration, 1, 0);
  expect(with(25, {0}), Cat240Fault::kResolution, 5, 0);
  expect(with(25, {6}), Cat240Fault::kResolution, 5, 6);
  expect(with(28, {0, 0, 0}), Cat240Fault::kNoCells, 1, 0);
  expect(with(28, {0, 0, 41}), Cat240Fault::kCounters, 41, 40);
  expect(with(28, {0xFF, 0xFF, 0xFF}), Cat240Fault::kCounters, 0xFFFFFF, 40);
  expect(with(26, {0, 39}), Cat240Fault::kCounters, 40, 39);
  expect(with(26, {0xFF, 0xFF, 0, 0, 41}), Cat240Fault::kCounters, 41, 40);
  expect(with(24, {0x80, 4, 0, 0}), Cat240Fault::kCounters, 1, 0);  // compressed
  expect(with(31, {11}), Cat240Fault::kItemLength, 45, 44);
  expect(with(31, {255}), Cat240Fault::kItemLength, 1021, 44);
  expect(with(4, {0xFF}), Cat240Fault::kFieldSpecification, 2, 3);
}

TEST(Cat240, A_record_must_have_its_items_once) {
  const Bytes block = turn_of(1)[0];
  const auto item = [](const Bytes& record) {
    const Bytes whole = bytes({240, 0, static_cast<int>(record.size() + 3)}) + record;
    const Story story = read(whole);
    EXPECT_EQ(story.faults(), std::vector{Cat240Fault::kItemCount});
    return story.problems.empty() ? "" : std::string(story.problems[0].item);
  };
  EXPECT_EQ(item(bytes({0x80, 1, 2})), "I240/000");
  EXPECT_EQ(item(bytes({0xC0, 1, 2, 2})), "I240/040 or I240/041");
  const Bytes header(12, std::byte{1});
  EXPECT_EQ(item(bytes({0xCC, 1, 2, 2}) + header + header), "I240/040 or I240/041");
  const Bytes nano = bytes({1, 2, 2, 0, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0, 100});
  EXPECT_EQ(item(bytes({0xC8}) + nano), "I240/048");
  EXPECT_EQ(item(bytes({0xCA}) + nano + bytes({0, 4})), "I240/049");
  EXPECT_EQ(item(bytes({0xCB, 0x80}) + nano + bytes({0, 4, 0, 1, 0, 0, 1})),
            "I240/050, I240/051 or I240/052");
}

TEST(Cat240, Reads_several_records_of_a_block_and_its_summary) {
  Cat240Writer writer({25, 7});
  Bytes room(300);
  ASSERT_EQ(writer.write_summary("harbour radar", std::span<std::byte>(room)), Cat240Written::kOk);
  room.resize(writer.size());
  Bytes both = room;
  for (const Bytes& block : turn_of(3)) both.insert(both.end(), block.begin() + 3, block.end());
  both[1] = static_cast<std::byte>(both.size() >> 8);
  both[2] = static_cast<std::byte>(both.size() & 0xFF);
  const Story story = read(both);
  EXPECT_EQ(story.summaries, std::vector<std::string>{"harbour radar"});
  EXPECT_EQ(story.sequence, (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_TRUE(story.problems.empty());
}

TEST(Cat240, Passes_over_other_categories) {
  const auto blocks = turn_of(3);
  const Bytes plots = bytes({48, 0, 7, 1, 2, 3, 240}), nothing = bytes({34, 0, 3});
  Bytes many = plots;
  for (int k = 0; k < 1000; ++k) many = many + nothing + plots;
  const Story story =
      read(plots + blocks[0] + nothing + plots + blocks[1] + blocks[2] + many + nothing);
  EXPECT_EQ(story.sequence, (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(story.other_blocks, 2005u);
  EXPECT_TRUE(story.problems.empty());
  EXPECT_EQ(story.skipped, 0u);
}

TEST(Cat240, An_empty_file_has_nothing) {
  const Story story = read({});
  EXPECT_TRUE(story.sequence.empty());
  EXPECT_TRUE(story.problems.empty());
}

TEST(Cat240, A_length_out_of_place_loses_its_own_sweep_only) {
  const auto blocks = turn_of(12);
  const int own = static_cast<int>(blocks[4].size());
  for (const int length : {0, 2, 3, 20, 74, 76, 200, 500, 65535, 2 * own, 5 * own, 8 * own}) {
    auto damaged = blocks;
    damaged[4][1] = static_cast<std::byte>(length >> 8);
    damaged[4][2] = static_cast<std::byte>(length & 0xFF);
    const Story story = read(joined(damaged));
    SCOPED_TRACE(length);
    EXPECT_FALSE(story.problems.empty());
    std::vector<std::int64_t> sequence = story.sequence;
    std::erase(sequence, 4);
    EXPECT_EQ(sequence, (std::vector<std::int64_t>{0, 1, 2, 3, 5, 6, 7, 8, 9, 10, 11}));
  }
}

TEST(Cat240, Garbage_that_leads_past_video_is_no_block_of_another_category) {
  const auto blocks = turn_of(12);
  for (std::size_t to = 5; to <= blocks.size(); ++to) {
    const Bytes passed = joined({blocks.begin() + 4, blocks.begin() + static_cast<int>(to)});
    const int length = static_cast<int>(passed.size()) + 3;
    auto damaged = blocks;
    damaged[3] = damaged[3] + bytes({48, length >> 8, length & 0xFF});
    const Story story = read(joined(damaged));
    SCOPED_TRACE(to);
    EXPECT_EQ(story.sequence.size(), blocks.size());
    EXPECT_EQ(story.faults(), std::vector{Cat240Fault::kNoBlock});
    EXPECT_EQ(story.other_blocks, 0u);
    EXPECT_EQ(story.skipped, 3u);
  }
}

TEST(Cat240, Garbage_between_blocks_is_reported_and_skipped) {
  std::mt19937 random(5);
  const auto blocks = turn_of(8);
  for (int trial = 0; trial < 200; ++trial) {
    Bytes garbage(1 + random() % 3000);
    for (std::byte& octet : garbage) octet = static_cast<std::byte>(random());
    const Bytes before = joined({blocks.begin(), blocks.begin() + 3});
    const Bytes after = joined({blocks.begin() + 3, blocks.end()});
    const Story story = read(before + garbage + after);
    SCOPED_TRACE(trial);
    EXPECT_EQ(story.sequence, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_FALSE(story.problems.empty());
    EXPECT_LE(story.skipped, garbage.size());
  }
}

TEST(Cat240, A_file_cut_anywhere_gives_all_whole_sweeps_before_the_cut) {
  const auto blocks = turn_of(3);
  const Bytes all = joined(blocks);
  const std::size_t block = blocks[0].size();
  for (std::size_t size = 0; size < all.size(); ++size) {
    const Story story = read({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(size)});
    SCOPED_TRACE(size);
    EXPECT_EQ(story.sequence.size(), size / block);
    EXPECT_EQ(story.problems.size(), size % block == 0 ? 0u : 1u);
    if (size % block == 0) continue;
    EXPECT_EQ(story.problems[0].fault, Cat240Fault::kTruncated);
    EXPECT_EQ(story.problems[0].offset, size / block * block);
    EXPECT_EQ(story.problems[0].came, size % block);
  }
}

TEST(Cat240, Time_goes_on_over_midnight_and_back) {
  Cat240Writer writer;
  Bytes all;
  const std::vector<double> times{86399.5, 86399.75, 86400.25, 86399.875,
                                  86401.0, 120000.0, 150000.0, 2 * 86400 + 1.0};
  const auto amplitude = ramp<std::uint8_t>(4);
  for (const double time_s : times) all = all + written(writer, sweep_of(amplitude, time_s));
  EXPECT_EQ(read(all).time_s, times);
}

TEST(Cat240, Reports_why_a_sweep_cannot_be_written) {
  Cat240Writer writer;
  Bytes room(Cat240Writer::kRoom);
  const auto amplitude = ramp<std::uint8_t>(65025);
  const auto outcome = [&](auto change, std::size_t cells = 10) {
    auto sweep = sweep_of(amplitude);
    sweep.amplitude = sweep.amplitude.first(cells);
    change(sweep);
    const auto result = writer.write(sweep, std::span<std::byte>(room));
    EXPECT_EQ(writer.size() == 0, result != Cat240Written::kOk);
    return result;
  };
  using S = Sweep<std::uint8_t>;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(outcome([](S&) {}, 65024), Cat240Written::kOk);
  EXPECT_EQ(outcome([](S&) {}, 65025), Cat240Written::kTooManyCells);
  EXPECT_EQ(outcome([](S&) {}, 0), Cat240Written::kNoSweep);
  EXPECT_EQ(outcome([&](S& s) { s.time_s = nan; }), Cat240Written::kNoSweep);
  EXPECT_EQ(outcome([&](S& s) { s.azimuth_rad = 1e9; }), Cat240Written::kNoSweep);
  EXPECT_EQ(outcome([&](S& s) { s.azimuth_width_rad = kPi<double>; }), Cat240Written::kNoSweep);
  EXPECT_EQ(outcome([&](S& s) { s.cell_m = 1e-8; }), Cat240Written::kCellLength);
  const auto far = [](S& s) {
    s.cell_m = 0.1;
    s.start_range_m = 9e8;
  };
  EXPECT_EQ(outcome(far), Cat240Written::kStartRange);
  const Sweep<std::uint8_t> sweep = sweep_of(amplitude);
  const auto small =
      Sweep<std::uint8_t>{sweep.time_s,        sweep.azimuth_rad, sweep.azimuth_width_rad,
                          sweep.start_range_m, sweep.cell_m,      sweep.amplitude.first(10)};
  for (std::size_t size = 0; size < 47; ++size)
    EXPECT_EQ(writer.write(small, std::span<std::byte>(room).first(size)), Cat240Written::kNoRoom);
  EXPECT_EQ(writer.write(small, std::span<std::byte>(room).first(47)), Cat240Written::kOk);
  EXPECT_EQ(writer.write_summary(std::string(256, 'x'), room), Cat240Written::kTextTooLong);
}

TEST(Cat240, Neither_reads_nor_writes_on_the_heap) {
  const auto amplitude = ramp<std::uint16_t>(2048);
  std::vector<std::uint16_t> cells(2048);
  Bytes room(Cat240Writer::kRoom);
  Cat240Writer writer;
  Cat240Reader reader;
  test::NoHeap fence;
  const bool done =
      writer.write(sweep_of(amplitude), std::span<std::byte>(room)) == Cat240Written::kOk;
  reader.feed(std::span<const std::byte>(room).first(writer.size()));
  const bool found = reader.next() == Cat240Event::kVideo;
  const auto back = reader.video().unpack(std::span<std::uint16_t>(cells));
  EXPECT_EQ(fence.allocations(), 0);
  EXPECT_TRUE(done && found && back.valid());
}

Bytes contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  Bytes all(text.size());
  for (std::size_t k = 0; k < text.size(); ++k) all[k] = static_cast<std::byte>(text[k]);
  return all;
}

std::vector<Bytes> corpus() {
  std::vector<Bytes> all;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::tests_dir() / "fuzz" / "cat240_corpus"))
    all.push_back(contents(entry.path()));
  return all;
}

/// Changes, cuts out, doubles or swaps a few octets.
void damage(Bytes& octets, std::mt19937& random) {
  for (unsigned k = 0, changes = 1 + random() % 4; k < changes && !octets.empty(); ++k) {
    const auto at = octets.begin() + static_cast<std::ptrdiff_t>(random() % octets.size());
    switch (random() % 4) {
      case 0:
        *at = static_cast<std::byte>(random());
        break;
      case 1:
        *at ^= static_cast<std::byte>(1u << random() % 8);
        break;
      case 2:
        octets.erase(at, at + std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(random() % 9),
                                                       octets.end() - at));
        break;
      default:
        octets.insert(at, 1 + random() % 5, *at);
    }
  }
}

void expect_same(const Story& whole, const Story& pieces) {
  EXPECT_EQ(whole.sequence, pieces.sequence);
  EXPECT_EQ(whole.amplitude, pieces.amplitude);
  EXPECT_EQ(whole.summaries, pieces.summaries);
  EXPECT_EQ(whole.faults(), pieces.faults());
  EXPECT_EQ(whole.other_blocks, pieces.other_blocks);
  EXPECT_EQ(whole.skipped, pieces.skipped);
  for (std::size_t k = 0; k < std::min(whole.problems.size(), pieces.problems.size()); ++k)
    EXPECT_EQ(whole.problems[k].offset, pieces.problems[k].offset);
}

TEST(Cat240Corpus, Comes_through_whole_cut_and_damaged_and_in_pieces) {
  std::mt19937 random(240);
  const auto files = corpus();
  ASSERT_GE(files.size(), 5u);
  for (const Bytes& file : files) {
    const Story whole = read(file);
    for (const std::size_t piece : {1u, 2u, 7u, 100u}) expect_same(whole, read(file, piece));
    for (std::size_t size = 0; size < file.size(); size += 1 + random() % 5)
      (void)read({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)});
    for (int trial = 0; trial < 300; ++trial) {
      Bytes damaged = file;
      damage(damaged, random);
      const Story story = read(damaged);
      if (trial % 10 == 0) expect_same(story, read(damaged, 1 + random() % 50));
    }
  }
}

TEST(Cat240, Every_fault_has_words) {
  for (int k = 0; k <= static_cast<int>(Cat240Fault::kCellDuration); ++k) {
    const Cat240Problem problem{static_cast<Cat240Fault>(k), 3, "I240/049", 4, 5};
    EXPECT_STRNE(to_string(problem.fault), "unknown");
    EXPECT_FALSE(wanted_text(problem).empty());
    EXPECT_FALSE(came_text(problem).empty());
  }
  for (int k = 0; k <= static_cast<int>(Cat240Written::kTextTooLong); ++k)
    EXPECT_STRNE(to_string(static_cast<Cat240Written>(k)), "unknown");
}

}  // namespace
}  // namespace wakeline::asterix_cat240_test
