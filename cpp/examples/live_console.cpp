// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Radar video (ASTERIX category 240) in by UDP, tracks out as TTM: live_console IN_PORT OUT_ADDRESS
// OUT_PORT
//
// Without arguments a made-up radar sends two boats through the loopback, the sentences come back
// by it, and the program returns 1 unless they are of two targets.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "wakeline/track/tracker.hpp"
#include "wakeline/track/vessel_models.hpp"
#include "wakeline/video/asterix_cat240_reader.hpp"
#include "wakeline/video/asterix_cat240_writer.hpp"
#include "wakeline/video/plot_extractor.hpp"
#include "wakeline/wire/ttm_feed.hpp"

namespace {

using namespace wakeline;

constexpr Radar kRadar{
    .range_std_m = 6.0, .bearing_std_rad = deg(0.4), .period_s = 2.5, .max_speed_mps = 25.0};
constexpr double kSector_rad = deg(10.0);  // the tracker's step
constexpr double kLag_rad = deg(10.0);     // an echo is a plot when the beam has left it

sockaddr_in address_of(const char* host, int port) {
  sockaddr_in address{AF_INET, htons(static_cast<in_port_t>(port)), {}, {}};
  if (inet_pton(AF_INET, host, &address.sin_addr) != 1) throw std::runtime_error(host);
  return address;
}

/// A UDP socket; port 0 is any free one.
int open_udp(const char* host, int port) {
  const int udp = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in own = address_of(host, port);
  if (bind(udp, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
    throw std::runtime_error("port " + std::to_string(port) + " cannot be opened");
  return udp;
}

/// Video in, sentences out: `send(sentence)`.
class Console {
 public:
  template <class Send>
  void take(std::span<const std::byte> datagram, Send&& send) {
    reader_.feed(datagram);
    for (auto event = reader_.next(); event != Cat240Event::kEnd; event = reader_.next()) {
      if (event != Cat240Event::kVideo) continue;
      const Sweep<> sweep = reader_.video().unpack<std::uint8_t>(cells_);
      for (const VideoPlot& plot : extractor_.process(sweep))
        plots_.push_back({plot.time_s, plot.range_m, plot.bearing_rad, OwnShip{}});
      if (std::isnan(edge_rad_)) edge_rad_ = sweep.azimuth_rad;
      if (compass_angle(sweep.azimuth_rad - edge_rad_) < kSector_rad + kLag_rad) continue;
      step(sweep.time_s - kRadar.period_s * kLag_rad / (2 * kPi<double>));
      report(sweep.time_s, send);
    }
  }

 private:
  /// Gives the tracker the plots of a sector that the beam has left, and keeps the others.
  void step(double time_s) {
    const auto later = std::partition(plots_.begin(), plots_.end(), [&](const Plot& plot) {
      return wrap_angle(plot.bearing_rad - edge_rad_) < kSector_rad;
    });
    const double from_rad = edge_rad_;
    edge_rad_ = compass_angle(edge_rad_ + kSector_rad);
    (void)tracker_.sector({0, from_rad, edge_rad_, time_s, {plots_.begin(), later}, OwnShip{}});
    plots_.erase(plots_.begin(), later);
  }

  template <class Send>
  void report(double time_s, Send& send) {
    tracks_.clear();
    tracker_.for_each([&](const auto& track) {
      if (track.shown()) tracks_.push_back({track.id, track.time_s, track.kinematics});
    });
    feed_.update(time_s, OwnShip{}, 0.0, tracks_, send);  // an antenna on the shore, north up
  }

  Cat240Reader reader_;
  PlotExtractor<> extractor_{{.cfar = {.threshold_factor = 4.5}, .min_cells = 3}};
  Tracker<VesselImm> tracker_{kRadar, TrackerConfig{}, vessel_imm(kRadar)};
  TtmFeed feed_{LocalPlane({deg(59.4), deg(10.5)})};  // where the antenna is
  std::vector<std::uint8_t> cells_ = std::vector<std::uint8_t>(65536);
  std::vector<Plot> plots_;
  std::vector<ReportedTrack> tracks_;
  double edge_rad_ = NAN;
};

/// A sweep of a made-up radar with two boats on their courses.
std::span<const std::byte> made_up(int sweep, Cat240Writer& writer, std::span<std::byte> room) {
  constexpr double width_rad = 2 * kPi<double> / 720, cell_m = 10.0;
  const double time_s = sweep * kRadar.period_s / 720, azimuth_rad = sweep % 720 * width_rad;
  std::vector<std::uint8_t> cells(256);
  for (int k = 0; k < 256; ++k) cells[std::size_t(k)] = std::uint8_t(8 + (7 * k + sweep) % 9);
  for (const Vec<double, 2>& p : {Vec<double, 2>(1500 - 6 * time_s, 500 + 4 * time_s),
                                  Vec<double, 2>(-900 + 3 * time_s, 1200 + 7 * time_s)})
    if (std::abs(wrap_angle(std::atan2(p[1], p[0]) - azimuth_rad)) < 1.5 * width_rad)
      cells[std::size_t(p.norm() / cell_m)] = cells[std::size_t(p.norm() / cell_m) + 1] = 200;
  (void)writer.write(Sweep<>{time_s, azimuth_rad, width_rad, 0.0, cell_m, cells}, room);
  return room.first(writer.size());
}

}  // namespace

int main(int argc, char** argv) try {
  const bool live = argc == 4;
  const int in = live ? open_udp("0.0.0.0", std::atoi(argv[1])) : open_udp("127.0.0.1", 0);
  sockaddr_in to = live ? address_of(argv[2], std::atoi(argv[3])) : sockaddr_in{}, from{};
  socklen_t size = sizeof from;
  getsockname(in, reinterpret_cast<sockaddr*>(&from), &size);
  const int reader = open_udp("127.0.0.1", 0);
  if (!live) getsockname(reader, reinterpret_cast<sockaddr*>(&to), &size);
  Console console;
  Cat240Writer writer;
  std::vector<std::byte> octets(65536);
  char line[128];
  std::set<std::string> numbers;
  for (int sweep = 0; live || sweep < 20 * 720; ++sweep) {
    if (!live) {
      const auto made = made_up(sweep, writer, octets);
      sendto(in, made.data(), made.size(), 0, reinterpret_cast<sockaddr*>(&from), sizeof from);
    }
    const auto got = recv(in, octets.data(), octets.size(), 0);
    if (got <= 0) continue;
    console.take(std::span(octets).first(std::size_t(got)), [&](std::string_view text) {
      sendto(in, text.data(), text.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
    });
    while (!live && recv(reader, line, sizeof line, MSG_DONTWAIT) > 9) {
      if (std::string(line, 6) == "$RATTM") numbers.insert(std::string(line + 7, 2));
      if (sweep > 19 * 720) std::printf("%.*s\n", int(std::strcspn(line, "\r")), line);
    }
  }
  return numbers.size() == 2 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "live_console: %s\n", error.what());
  return 2;
}
