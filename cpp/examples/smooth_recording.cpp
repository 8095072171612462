// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A recorded target, filtered and then smoothed: an extended filter runs forwards over the plots,
// the Rauch-Tung-Striebel smoother backwards over its beliefs.
//
//   state   x, vx, y, vy   m, m/s   north and east of the radar
//   plots   range (m) and bearing (rad, clockwise from north) every 3 s
//
// Prints the RMS errors of position and velocity. Returns 1 unless smoothing reduces both.
#include <cmath>
#include <cstdio>
#include <random>
#include <span>
#include <vector>

#include "wakeline/filter/ekf.hpp"
#include "wakeline/filter/rts_smoother.hpp"
#include "wakeline/filter/start.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/constant_velocity.hpp"

using namespace wakeline;

struct Errors {
  double position_m = 0.0, velocity_mps = 0.0;
};

/// RMS errors of beliefs against true states.
Errors errors_of(std::span<const Gaussian<4>> beliefs, std::span<const Vec<double, 4>> truth) {
  Errors sum;
  for (std::size_t k = 0; k < beliefs.size(); ++k) {
    const Vec<double, 4> error = beliefs[k].mean - truth[k];
    sum.position_m += error[0] * error[0] + error[2] * error[2];
    sum.velocity_mps += error[1] * error[1] + error[3] * error[3];
  }
  const double n = static_cast<double>(beliefs.size());
  return {std::sqrt(sum.position_m / n), std::sqrt(sum.velocity_mps / n)};
}

int main() {
  constexpr double kPeriod_s = 3.0;
  constexpr int kScans = 80;
  const RangeBearing radar{.range_std_m = 60.0, .bearing_std_rad = deg(0.5)};
  const ConstantVelocity motion{.noise = WhiteAcceleration{0.01}};
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;

  std::vector<Vec<double, 4>> truth;
  std::vector<Vec<double, 2>> plots;
  Vec<double, 4> vessel(4000.0, 6.0, 3000.0, -8.0);
  for (int scan = 0; scan < kScans; ++scan) {
    truth.push_back(vessel);
    const Vec<double, 2> exact = radar.measure(Vec<double, 2>(vessel[0], vessel[2]));
    plots.emplace_back(exact[0] + radar.range_std_m * normal(random),
                       exact[1] + radar.bearing_std_rad * normal(random));
    vessel = (motion.matrix(kPeriod_s) * vessel).eval();
  }

  Ekf filter{motion};
  std::vector<Gaussian<4>> beliefs;
  if (filter.start(two_point(radar, plots[0], plots[1], kPeriod_s)) != Status::kOk) return 1;
  beliefs.push_back(filter.estimate());
  for (std::size_t scan = 2; scan < plots.size(); ++scan) {
    if (filter.predict(kPeriod_s) != Status::kOk) return 1;
    if (!filter.update(radar, plots[scan])) return 1;
    beliefs.push_back(filter.estimate());
  }
  const std::span known = std::span(truth).subspan(1);  // the first belief is of the second plot
  const Errors filtered = errors_of(beliefs, known);

  const std::vector<double> steps_s(beliefs.size() - 1, kPeriod_s);
  if (smooth<ConstantVelocity, double>(motion, beliefs, steps_s) != Status::kOk) return 1;
  const Errors smoothed = errors_of(beliefs, known);

  std::printf("            position m   velocity m/s\n");
  std::printf("filtered  %12.1f   %12.2f\n", filtered.position_m, filtered.velocity_mps);
  std::printf("smoothed  %12.1f   %12.2f\n", smoothed.position_m, smoothed.velocity_mps);
  return smoothed.position_m < filtered.position_m && smoothed.velocity_mps < filtered.velocity_mps
             ? 0
             : 1;
}
