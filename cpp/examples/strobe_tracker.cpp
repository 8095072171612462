// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Radar video to tracks by strobes: each vessel is measured where it is expected, as soon as the
// beam has passed it. The estimator is chosen at run time.
//
//     strobe_tracker [fuzzy|bayesian|imm]
//
// A made-up radar sees a pilot boat that overtakes a ship 40 m abeam, both in the noise of the
// receiver. The operator designates the boat; the ship is acquired from a plot. Prints the tracks;
// returns 1 unless both are followed.
#include <cmath>
#include <cstdio>
#include <random>
#include <string_view>
#include <vector>

#include "wakeline/multimodel/bayesian_alpha_beta.hpp"
#include "wakeline/multimodel/fuzzy_alpha_beta.hpp"
#include "wakeline/track/strobe_tracker.hpp"
#include "wakeline/track/vessel_models.hpp"
#include "wakeline/video/plot_extractor.hpp"

namespace {

using namespace wakeline;

constexpr int kSweeps = 1440;
constexpr double kWidth_rad = 2 * kPi<double> / kSweeps;

struct Vessel {
  const char* name;
  Vec<double, 2> start_m, velocity_mps;
  [[nodiscard]] Vec<double, 2> at(double time_s) const { return start_m + time_s * velocity_mps; }
};

class MadeUpRadar {
 public:
  static constexpr double kPeriod_s = 2.5;
  const std::vector<Vessel> vessels{{"boat", {1200.0, -260.0}, {0.0, 9.0}},
                                    {"ship", {1240.0, -100.0}, {0.0, 5.0}}};

  /// The next sweep, valid until the one after.
  Sweep<> sweep() {
    const double time_s = sweep_ * kPeriod_s / kSweeps;
    const double azimuth_rad = (sweep_ % kSweeps) * kWidth_rad;
    ++sweep_;
    for (std::uint8_t& cell : cells_)
      cell = static_cast<std::uint8_t>(6.0 * std::hypot(normal_(random_), normal_(random_)));
    for (const Vessel& vessel : vessels) {
      const Vec<double, 2> p = vessel.at(time_s);
      const double off = wrap_angle(azimuth_rad - std::atan2(p[1], p[0])) / deg(0.4);
      if (std::abs(off) > 3.0) continue;
      for (int k = -3; k <= 3; ++k) {
        const auto cell = static_cast<std::size_t>(p.norm() / kCell_m) + std::size_t(k);
        const double along = (kCell_m * (double(cell) + 0.5) - p.norm()) / 6.0;
        const double a = 200.0 * std::exp(-0.5 * (along * along + off * off));
        cells_[cell] = std::max(cells_[cell], static_cast<std::uint8_t>(a));
      }
    }
    return {.time_s = time_s,
            .azimuth_rad = azimuth_rad,
            .azimuth_width_rad = kWidth_rad,
            .cell_m = kCell_m,
            .amplitude = cells_};
  }

 private:
  static constexpr double kCell_m = 6.0;
  int sweep_ = 0;
  std::mt19937 random_{1};
  std::normal_distribution<double> normal_;
  std::vector<std::uint8_t> cells_ = std::vector<std::uint8_t>(400);
};

const Radar kRadar{.range_std_m = 3.0,
                   .bearing_std_rad = deg(0.15),
                   .extent_std_m = 2.0,
                   .period_s = MadeUpRadar::kPeriod_s,
                   .max_speed_mps = 20.0};

template <class Estimator>
int follow(const Estimator& estimator) {
  MadeUpRadar radar;
  StrobeTracker tracker(kRadar, {.least_amplitude = 40, .radius_m = 30.0}, estimator);
  PlotExtractor<> extractor({.cfar = {.threshold_factor = 5.0}, .min_cells = 6});
  (void)tracker.designate(0.0, 1200.0, -260.0, 10.0);
  int shared = 0;
  for (int k = 0; k < 32 * kSweeps; ++k) {
    const Sweep<> sweep = radar.sweep();
    const StrobeReport report = tracker.process(sweep);
    for (const StrobeReading& reading : report.readings) shared += reading.echo.shared;
    for (const Event& event : report.events)
      if (event.kind == TrackEvent::kConfirmed || event.kind == TrackEvent::kLost)
        std::printf("%5.1f s: track %lld %s\n", event.time_s,
                    static_cast<long long>(event.track_id),
                    event.kind == TrackEvent::kLost ? "lost" : "confirmed");
    tracker.acquire(extractor.process(sweep));
  }
  int followed = 0;
  tracker.for_each([&](const StrobeTrack& track) {
    if (!track.confirmed()) return;
    for (const Vessel& vessel : radar.vessels) {
      if ((track.position() - vessel.at(track.time_s)).norm() > 10.0) continue;
      ++followed;
      std::printf("track %lld is the %s: %.0f N %.0f E, %.1f m/s, strobe of %.0f m\n",
                  static_cast<long long>(track.id), vessel.name, track.position()[0],
                  track.position()[1], track.speed_mps(), track.strobe.radius_m);
    }
  });
  std::printf("%d readings of shared echoes\n", shared);
  return followed == 2 ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  const std::string_view name = count > 1 ? arguments[1] : "bayesian";
  if (name == "fuzzy") return follow(FuzzyAlphaBeta<>{});
  if (name == "imm") return follow(vessel_imm(kRadar));
  if (name == "bayesian") return follow(BayesianAlphaBeta<>{});
  std::fprintf(stderr, "estimator must be fuzzy, bayesian or imm\n");
  return 2;
}
