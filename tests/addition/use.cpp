// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Uses what was added: a filter over the model takes readings of the sensor, and the setting is checked.
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "wakeline/wakeline.hpp"

int main() {
  using namespace wakeline;
  Ekf filter{DampedVelocity{.decay_time_s = 10.0}};
  if (filter.start(Gaussian<4>{{0.0, 10.0, 0.0, 0.0}, Mat<double, 4, 4>::Identity()}) !=
          Status::kOk ||
      filter.predict(10.0) != Status::kOk)
    return 1;
  if (std::abs(filter.estimate().mean[1] - 10.0 * std::exp(-1.0)) > 1e-9) return 2;
  const NorthEast sensor{.north_std_m = 1.0, .east_std_m = 1000.0};
  if (!filter.update(sensor, Vec<double, 2>(0.0, 50.0))) return 3;
  if (!(filter.estimate().mean[0] < 50.0 && filter.estimate().mean[2] < 1.0)) return 4;
  try {
    TrackerConfig{.added_margin_m = -1.0}.validate();
    return 5;
  } catch (const std::invalid_argument& error) {
    std::puts(error.what());
  }
}
