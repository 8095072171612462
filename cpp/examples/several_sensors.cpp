// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Two radars, one of them a turn late, AIS 4 s late, and an operator: the picture of five boats as
// if all data, which are simulated, had come in time.
#include <cstdio>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "wakeline/track/late_window.hpp"
#include "wakeline/track/vessel_models.hpp"

using namespace wakeline;

int main() {
  constexpr int kSectors = 16;
  constexpr double kSector_rad = Beam::kTurn / kSectors, kEnd_s = 120.0;
  const std::vector<Radar> radars{
      {.range_std_m = 8.0, .bearing_std_rad = deg(0.5), .period_s = 2.5},
      {.range_std_m = 20.0, .bearing_std_rad = deg(1.0), .period_s = 3.0}};
  const OwnShip sites[] = {{}, {.north_m = 2500.0, .east_m = -1500.0}};
  const double delays_s[] = {0.1, 3.0};
  const auto boat_at = [](int boat, double time_s) -> Vec<double, 2> {
    return 900.0 * towards(1.3 * boat) + (5.0 + boat) * time_s * towards(1.3 * boat + 0.8);
  };
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  LateWindow<Tracker<VesselImm>> window({.window_s = 8.0}, std::span(radars), TrackerConfig{},
                                        vessel_imm(radars[0]));
  std::multimap<double, std::function<void()>> inputs;  // by time of arrival
  for (int number = 0; number < 2; ++number)
    for (int k = 0; k * radars[std::size_t(number)].period_s < kEnd_s * kSectors; ++k) {
      const Radar& radar = radars[std::size_t(number)];
      const double end_s = (k + 1) * radar.period_s / kSectors;
      const double from_rad = k % kSectors * kSector_rad, to_rad = from_rad + kSector_rad;
      std::vector<Plot> plots;
      for (int boat = 0; boat < 5; ++boat) {
        const Vec<double, 2> d = boat_at(boat, end_s) - sites[number].position<double>();
        const double bearing_rad = compass_angle(std::atan2(d[1], d[0]));
        if (bearing_rad < from_rad || bearing_rad >= to_rad || random() % 10 == 0) continue;
        plots.push_back({end_s, d.norm() + radar.range_std_m * normal(random),
                         bearing_rad + radar.bearing_std_rad * normal(random), sites[number]});
      }
      inputs.emplace(end_s + delays_s[number], [=, &window] {
        (void)window.sector({number, from_rad, to_rad, end_s, plots, sites[number]});
      });
    }
  for (int boat = 0; boat < 3; ++boat)
    for (double time_s = 5.0 + boat; time_s < kEnd_s; time_s += 10.0)
      inputs.emplace(time_s + 4.0, [=, &window] {
        const std::string identity = "25737850" + std::to_string(boat);
        (void)window.report({.identity = identity,
                             .time_s = time_s,
                             .position_m = boat_at(boat, time_s),
                             .position_std_m = 5.0,
                             .velocity_mps = boat_at(boat, 1.0) - boat_at(boat, 0.0),
                             .velocity_std_mps = 0.3});
      });
  const Vec<double, 2> place = boat_at(4, 60.0);
  inputs.emplace(61.0, [&] {
    (void)window.rename(window.designate(60.0, place[0], place[1], 50.0), "Pilot");
  });
  for (const auto& [time_s, give] : inputs) give();
  (void)window.correct();
  int shown = 0;
  window.tracker().for_each([&](const Track& track) {
    shown += track.shown();
    const Identity* identity = window.tracker().identity_of(track);
    std::printf("track %d at %7.1f N %7.1f E  %s %s\n", int(track.id), track.position()[0],
                track.position()[1], identity != nullptr ? identity->name.data() : "",
                track.label().data());
  });
  std::printf("%d late, %d too late\n", int(window.counts().late), int(window.counts().too_late));
  return shown == 5 ? 0 : 1;
}
