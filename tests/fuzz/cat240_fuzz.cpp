// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// libFuzzer on the reader of ASTERIX category 240: any octets, at once and in pieces. See
// cpp/docs/video_files.md.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "wakeline/video/asterix_cat240_reader.hpp"
#include "wakeline/video/asterix_cat240_writer.hpp"

namespace {

using namespace wakeline;

void require(bool law) {
  if (!law) std::abort();
}

/// What is read of cells is a sweep, and one that can be written comes back as it is.
template <class Amplitude>
void try_cells(const Cat240Video& video) {
  static std::vector<Amplitude> room(1 << 20), again(1 << 20);
  static std::vector<std::byte> block(Cat240Writer::kRoom);
  const auto sweep = video.unpack(std::span<Amplitude>(room));
  require(sweep.amplitude.size() == (video.fits<Amplitude>() ? video.cells : 0));
  Cat240Writer writer(video.source);
  if (writer.write(sweep, std::span<std::byte>(block)) != Cat240Written::kOk) return;
  Cat240Reader reader;
  reader.feed(std::span<const std::byte>(block).first(writer.size()));
  require(reader.next() == Cat240Event::kVideo);
  const auto back = reader.video().unpack(std::span<Amplitude>(again));
  require(std::ranges::equal(back.amplitude, sweep.amplitude));
  require(reader.video().turned() == std::abs(video.turned()));
  require(reader.next() == Cat240Event::kEnd && reader.consumed() == writer.size());
}

/// A number that depends on all that was read.
std::uint64_t read(const std::vector<std::byte>& all, std::size_t piece) {
  Cat240Reader reader;
  std::uint64_t story = 0, records = 0, last_offset = 0;
  const auto note = [&](std::uint64_t value) { story = story * 1099511628211u + value; };
  std::size_t begin = 0, end = std::min(piece, all.size());
  for (bool last = false; !last; end = std::min(end + piece, all.size())) {
    last = end == all.size();
    const std::vector<std::byte> part(all.begin() + static_cast<std::ptrdiff_t>(begin),
                                      all.begin() + static_cast<std::ptrdiff_t>(end));
    reader.feed(part, last);
    for (auto event = reader.next(); event != Cat240Event::kEnd; event = reader.next()) {
      require(++records <= 2 * all.size());
      note(static_cast<std::uint64_t>(event));
      if (event == Cat240Event::kVideo) {
        require(reader.video().offset > last_offset);
        last_offset = reader.video().offset;
        note(reader.video().cells);
        note(last_offset);
        try_cells<std::uint8_t>(reader.video());
        try_cells<std::uint16_t>(reader.video());
      } else if (event == Cat240Event::kSummary) {
        for (const char letter : reader.summary()) note(static_cast<unsigned char>(letter));
      } else {
        note(reader.problem().offset);
        require(reader.problem().offset < all.size());
        require(!wanted_text(reader.problem()).empty() && !came_text(reader.problem()).empty());
      }
    }
    begin += reader.consumed();
  }
  require(begin == all.size());
  note(reader.skipped_octets());
  note(reader.other_blocks());
  return story;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::byte> all(size);
  std::transform(data, data + size, all.begin(),
                 [](std::uint8_t octet) { return std::byte{octet}; });
  require(read(all, size + 1) == read(all, 1 + size % 61));
  return 0;
}
