// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Own ship by GNSS, compass and speed log, and by compass and log alone where satellites fail.
//
// A vessel that turns in a current: the navigator estimates the current while it has fixes, and
// dead reckons with it for the last minute, without fixes. Prints the error beside that of dead
// reckoning that ignores the current. Returns 1 unless the navigator is closer to the truth.
#include <cmath>
#include <cstdio>
#include <random>

#include "wakeline/measurement/position.hpp"
#include "wakeline/navigation/usv_models.hpp"
#include "wakeline/navigation/usv_navigator.hpp"
#include "wakeline/navigation/usv_sensors.hpp"

using namespace wakeline;

int main() {
  constexpr int kSeconds = 660, kFixesUntil_s = 600;
  constexpr double kSpeed_mps = 5.0;
  const Vec<double, 2> current_mps(0.4, -0.3);
  const Position gnss{.position_std_m = 3.0};
  const Compass compass(deg(1.0));
  const SpeedLog log(0.1);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;

  UsvNavigator<UsvCurrentMotion> navigator;
  if (navigator.start(UsvStart{.velocity_mps = {kSpeed_mps, 0.0}}) != Status::kOk) return 1;

  Vec<double, 2> truth_m = Vec<double, 2>::Zero(), reckoned_m = truth_m;
  for (int second = 1; second <= kSeconds; ++second) {
    const double heading_rad = deg(40.0) * std::sin(2 * kPi<double> * second / 300.0);
    const Vec<double, 2> through_water_mps(kSpeed_mps * std::cos(heading_rad),
                                           kSpeed_mps * std::sin(heading_rad));
    truth_m += through_water_mps + current_mps;

    const double heading_read_rad = heading_rad + compass.heading_std_rad * normal(random);
    const double speed_read_mps = kSpeed_mps + log.speed_std_mps * normal(random);
    if (navigator.predict(1.0) != Status::kOk) return 1;
    if (!navigator.update(compass, Vec<double, 1>(heading_read_rad))) return 1;
    if (!navigator.update(log, Vec<double, 1>(speed_read_mps))) return 1;
    if (second <= kFixesUntil_s) {
      Vec<double, 2> fix_m = truth_m;
      fix_m[1] += gnss.position_std_m * normal(random);
      fix_m[0] += gnss.position_std_m * normal(random);
      if (!navigator.update(gnss, fix_m)) return 1;
      reckoned_m = fix_m;
    } else {
      reckoned_m +=
          speed_read_mps * Vec<double, 2>(std::cos(heading_read_rad), std::sin(heading_read_rad));
    }
  }

  const auto& mean = navigator.estimate().mean;
  const double error_m = (mean.head<2>() - truth_m).norm();
  const double reckoned_error_m = (reckoned_m - truth_m).norm();
  std::printf("current %.2f N %.2f E m/s, true %.2f N %.2f E\n", mean[5], mean[6], current_mps[0],
              current_mps[1]);
  std::printf("after %d s without satellites: navigator %.1f m off, heading and log alone %.1f m\n",
              kSeconds - kFixesUntil_s, error_m, reckoned_error_m);
  return error_m < reckoned_error_m ? 0 : 1;
}
