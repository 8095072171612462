// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The program of the README: three turn rates in an interacting multiple model estimator.

#include <cstdio>
#include <wakeline/wakeline.hpp>
using namespace wakeline;

int main() {
  const RangeBearing radar{.range_std_m = 60.0, .bearing_std_rad = deg(0.5)};
  auto turn = [](double deg_s) { return Ekf{CoordinatedTurn{.turn_rate_rad_s = deg(deg_s)}}; };
  Imm imm{ModeChain<3>::from_sojourn_s({60.0, 30.0, 30.0}), turn(0.0), turn(1.0), turn(-1.0)};

  const Vec<double, 2> z[] = {{5000.0, 0.500}, {4980.0, 0.506}, {4955.0, 0.511}};  // m, rad
  if (imm.start(two_point(radar, z[0], z[1], 3.0)) != Status::kOk) return 1;
  if (imm.predict(3.0) != Status::kOk || !imm.update(radar, z[2])) return 1;
  const auto mean = imm.estimate().mean;
  std::printf("north %.0f m, east %.0f m\n", mean[0], mean[2]);
}
