// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Radar video to tracks: datagrams of ASTERIX category 240 in, plots of their echoes, tracks out.
//
// A made-up radar sends a sweep in each datagram: two boats in the noise of the receiver. Prints
// the tracks; returns 1 unless they are the boats.
#include <cmath>
#include <cstdio>
#include <random>
#include <span>
#include <vector>

#include "wakeline/track/tracker.hpp"
#include "wakeline/track/vessel_models.hpp"
#include "wakeline/video/asterix_cat240_reader.hpp"
#include "wakeline/video/asterix_cat240_writer.hpp"
#include "wakeline/video/plot_extractor.hpp"

namespace {

using namespace wakeline;

constexpr Cat240Source kOurRadar{.area = 7, .system = 1};
constexpr int kSweeps = 720;
constexpr double kWidth_rad = 2 * kPi<double> / kSweeps;

struct Boat {
  Vec<double, 2> start_m, velocity_mps;
  [[nodiscard]] Vec<double, 2> at(double time_s) const { return start_m + time_s * velocity_mps; }
};

/// Sends one sweep after another, as a network would bring them.
class MadeUpRadar {
 public:
  static constexpr double kPeriod_s = 2.5;
  const std::vector<Boat> boats{{{1500.0, 500.0}, {-6.0, 4.0}}, {{-900.0, 1200.0}, {3.0, 7.0}}};

  std::span<const std::byte> datagram() {
    const double time_s = sweep_ * kPeriod_s / kSweeps;
    const double azimuth_rad = (sweep_ % kSweeps + 0.5) * kWidth_rad;
    ++sweep_;
    for (std::uint8_t& cell : cells_)
      cell = static_cast<std::uint8_t>(12.0 * std::hypot(normal_(random_), normal_(random_)));
    for (const Boat& boat : boats) {
      const Vec<double, 2> p = boat.at(time_s);
      if (std::fabs(wrap_angle(std::atan2(p[1], p[0]) - azimuth_rad)) > 1.5 * kWidth_rad) continue;
      const auto cell = static_cast<std::size_t>(p.norm() / kCell_m);
      cells_[cell] = cells_[cell + 1] = 200;
    }
    (void)writer_.write(Sweep<>{.time_s = 43'200.0 + time_s,
                                .azimuth_rad = azimuth_rad,
                                .azimuth_width_rad = kWidth_rad,
                                .cell_m = kCell_m,
                                .amplitude = cells_},
                        std::span<std::byte>(octets_));
    return std::span(octets_).first(writer_.size());
  }

 private:
  static constexpr double kCell_m = 10.0;
  int sweep_ = 0;
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_;
  std::vector<std::uint8_t> cells_ = std::vector<std::uint8_t>(256);
  std::vector<std::byte> octets_ = std::vector<std::byte>(2000);
  Cat240Writer writer_{kOurRadar};
};

/// What a reader of single records leaves to its user: whose sweeps these are, and in which order.
class Receiver {
 public:
  /// False for another radar's sweep, and for one that is repeated or comes late.
  bool takes(const Cat240Video& video) noexcept {
    if (video.source != kOurRadar) return false;
    const bool in_order = last_ < 0 || video.sequence < 0 || video.sequence > last_ ||
                          video.sequence < last_ - kLate;  // it has begun anew
    if (in_order) last_ = video.sequence;
    return in_order;
  }

 private:
  static constexpr std::int64_t kLate = 63;
  std::int64_t last_ = -1;
};

}  // namespace

int main() {
  const Radar radar{.range_std_m = 6.0,
                    .bearing_std_rad = deg(0.4),
                    .period_s = MadeUpRadar::kPeriod_s,
                    .max_speed_mps = 25.0};
  MadeUpRadar sender;
  Cat240Reader reader;
  Receiver receiver;
  PlotExtractor<> extractor({.cfar = {.threshold_factor = 4.5}, .min_cells = 3});
  Tracker tracker(radar, TrackerConfig{}, vessel_imm(radar));
  std::vector<std::uint8_t> cells(4096);
  std::vector<Plot> plots;
  const OwnShip own;  // at anchor; else where she is at the time of each plot
  double last_azimuth_rad = 0.0, turned_rad = 0.0, time_s = 0.0;

  const auto take = [&](const Cat240Video& video) {
    Sweep<> sweep = video.unpack<std::uint8_t>(cells);
    if (sweep.azimuth_width_rad == 0.0) sweep.azimuth_width_rad = kWidth_rad;  // some tell none
    if (std::isnan(sweep.time_s)) sweep.time_s = time_s;  // nor a time: that of reception will do
    turned_rad += wrap_angle(sweep.azimuth_rad - last_azimuth_rad);  // less where it steps back
    if (turned_rad >= 2 * kPi<double>) {                             // past north: a turn is over
      turned_rad -= 2 * kPi<double>;
      if (const ScanReport scan = tracker.process(sweep.time_s, plots); scan.status != Status::kOk)
        std::printf("scan at %.1f s: %s\n", sweep.time_s, to_string(scan.status));
      plots.clear();
    }
    last_azimuth_rad = sweep.azimuth_rad;
    time_s = sweep.time_s;
    for (const VideoPlot& plot : extractor.process(sweep))
      plots.push_back({plot.time_s, plot.range_m, plot.bearing_rad, own});
    if (rejected(extractor.status())) std::printf("sweep: %s\n", to_string(extractor.status()));
  };

  for (int count = 0; count < 20 * kSweeps + 1; ++count) {
    reader.feed(sender.datagram());
    for (auto event = reader.next(); event != Cat240Event::kEnd; event = reader.next()) {
      if (event == Cat240Event::kVideo && receiver.takes(reader.video())) take(reader.video());
      if (event == Cat240Event::kProblem)
        std::printf("%s: wanted %s, got %s\n", to_string(reader.problem().fault),
                    wanted_text(reader.problem()).c_str(), came_text(reader.problem()).c_str());
    }
  }

  int boats = 0, others = 0;
  tracker.for_each([&](const auto& track) {
    if (!track.shown()) return;
    std::printf("track %lld at %6.0f N %6.0f E, %4.1f m/s\n", static_cast<long long>(track.id),
                track.kinematics.mean[0], track.kinematics.mean[2], track.speed_mps());
    bool one = false;
    for (const Boat& boat : sender.boats)
      one |= (track.position() - boat.at(track.time_s - 43'200.0)).norm() < 30.0;
    ++(one ? boats : others);
  });
  std::printf("%lld sweeps, %lld plots\n", static_cast<long long>(extractor.counts().sweeps),
              static_cast<long long>(extractor.counts().plots));
  return boats == 2 && others == 0 ? 0 : 1;
}
