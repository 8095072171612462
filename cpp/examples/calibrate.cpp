// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Find the offsets of a radar from the position reports of five vessels: ten minutes of a simulated
// radar that is 2 degrees, 40 m and 0.4 s off, with false plots.
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "wakeline/track/calibration.hpp"

int main() {
  using namespace wakeline;
  const Radar radar{.range_std_m = 10.0, .bearing_std_rad = deg(0.5)};
  const double range_offset_m = 40.0, bearing_offset_rad = deg(2.0), time_offset_s = 0.4;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Calibration calibration(radar);

  struct Vessel {
    double north_m, east_m, vnorth_mps, veast_mps;
  };
  const std::vector<Vessel> vessels{{3000.0, 500.0, -6.0, 4.0},
                                    {-2000.0, 2500.0, 8.0, -2.0},
                                    {500.0, -4000.0, 3.0, 10.0},
                                    {-1500.0, -1500.0, -2.0, 5.0},
                                    {4500.0, 3000.0, -9.0, -6.0}};
  for (int scan = 0; scan < 200; ++scan) {
    const double time_s = 3.0 * scan;
    std::vector<Plot> plots;
    for (std::size_t k = 0; k < vessels.size(); ++k) {
      const Vessel& v = vessels[k];
      const double north_m = v.north_m + v.vnorth_mps * time_s;
      const double east_m = v.east_m + v.veast_mps * time_s;
      if (scan % 4 == 0 && !ok(calibration.report({.vessel = static_cast<std::int64_t>(k),
                                                   .time_s = time_s,
                                                   .north_m = north_m + 5.0 * normal(random),
                                                   .east_m = east_m + 5.0 * normal(random),
                                                   .vnorth_mps = v.vnorth_mps,
                                                   .veast_mps = v.veast_mps})))
        return 1;
      plots.push_back({time_s + time_offset_s,
                       std::hypot(north_m, east_m) + range_offset_m + 10.0 * normal(random),
                       std::atan2(east_m, north_m) + bearing_offset_rad + deg(0.5) * normal(random),
                       OwnShip{}});
    }
    for (int k = 0; k < 20; ++k)
      plots.push_back({time_s, 6000.0 * std::sqrt(uniform(random)),
                       2.0 * kPi<double> * uniform(random), OwnShip{}});
    calibration.plots(plots);
  }

  const CalibrationResult found = calibration.solve();
  const auto print = [](const char* name, const CalibratedOffset& offset, double scale) {
    std::printf("%-14s %7.2f +- %.2f %s\n", name, scale * offset.value, scale * offset.std,
                offset.determined() ? "" : "not determined");
  };
  std::printf("%.0f plots of %zu vessels\n", found.matches, found.vessels.size());
  print("range, m", found.range_m, 1.0);
  print("bearing, deg", found.bearing_rad, 180.0 / kPi<double>);
  print("time, s", found.time_s, 1.0);
  const Radar calibrated = found.applied_to(radar);
  std::printf("plots are now corrected by %.1f m\n", -calibrated.range_offset_m);
}
