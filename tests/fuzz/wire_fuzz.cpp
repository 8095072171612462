// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// libFuzzer on the codecs of radar networks: any octets as a datagram, and as tracks to be sent.
// See cpp/docs/live.md.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "wakeline/wire/asterix_feed.hpp"
#include "wakeline/wire/asterix_reader.hpp"
#include "wakeline/wire/ttm_feed.hpp"

namespace {

using namespace wakeline;

void require(bool law) {
  if (!law) std::abort();
}

/// Every event is in the data, and there are no more of them than octets.
void read(const std::vector<std::byte>& datagram) {
  AsterixReader reader;
  reader.feed(datagram, 1.7e9);
  std::size_t events = 0;
  for (auto event = reader.next(); event != AsterixEvent::kEnd; event = reader.next()) {
    require(++events <= datagram.size());
    if (event == AsterixEvent::kProblem) {
      require(reader.problem().offset < datagram.size());
      continue;
    }
    const RadarRecord& one = reader.record();
    require(!(one.range_m < 0.0) && !(std::abs(one.bearing_rad) > 7.0));
    require(std::isnan(one.time_s) || std::abs(one.time_s - 1.7e9) <= 43201.0 + 45000.0);
    if (one.kind == RadarRecordKind::kPlot)
      require(std::isfinite(one.range_m) || std::isfinite(one.latitude_rad));
  }
}

/// Sentences and datagrams are whole, whatever the tracks.
void send(const std::vector<ReportedTrack>& tracks, double time_s) {
  const LocalPlane plane({deg(63.4), deg(10.4)});
  TtmFeed feeds[] = {TtmFeed(plane), TtmFeed(plane, {.tll = true})};
  Cat062Feed system(plane);
  Cat010Feed coastal(plane);
  for (int turn = 0; turn < 2; ++turn) {
    const std::span<const ReportedTrack> some =
        std::span(tracks).first(tracks.size() / (turn == 0 ? 1 : 2));
    for (TtmFeed& feed : feeds)
      feed.update(time_s + turn, OwnShip{}, time_s, some, [](std::string_view text) {
        require(text.size() <= 82 && text.front() == '$' && text.ends_with("\r\n"));
        for (const char letter : text.substr(0, text.size() - 2))
          require(letter >= 0x20 && letter < 0x7F);
      });
    const auto whole = [](asterix::Octets octets) {
      require(octets.size() <= 1400 && asterix::number(octets.subspan(1, 2)) == octets.size());
    };
    system.update(time_s + turn, some, whole);
    coastal.update(time_s + turn, some, [&](asterix::Octets octets) {
      whole(octets);
      AsterixReader reader;
      reader.feed(octets, 0.0);
      for (auto event = reader.next(); event != AsterixEvent::kEnd; event = reader.next())
        require(event == AsterixEvent::kRecord);
    });
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::byte> octets(size);
  if (size > 0) std::memcpy(octets.data(), data, size);
  read(octets);
  struct Raw {
    double time_s, mean[4], variance, turn_rate_rad_s, age_s;
    char name[16];
  };
  std::vector<ReportedTrack> tracks(size / sizeof(Raw));
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    Raw raw;
    std::memcpy(&raw, data + k * sizeof raw, sizeof raw);
    ReportedTrack& track = tracks[k];
    track.id = static_cast<std::int64_t>(k);
    track.time_s = raw.time_s;
    track.kinematics.mean << raw.mean[0], raw.mean[1], raw.mean[2], raw.mean[3];
    track.kinematics.covariance *= raw.variance;
    track.has_covariance = std::isfinite(raw.variance);
    track.turn_rate_rad_s = raw.turn_rate_rad_s;
    track.age_s = raw.age_s;
    track.coasting = raw.name[0] > 0;
    track.set_name({raw.name, sizeof raw.name});
  }
  double time_s = 0.0;
  if (size >= sizeof time_s) std::memcpy(&time_s, data, sizeof time_s);
  send(tracks, std::isfinite(time_s) ? time_s : 0.0);
  return 0;
}
