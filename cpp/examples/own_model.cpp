// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// A motion model and a sensor of one's own: a ferry that has stopped its engines.
//
// The water slows it in proportion to its speed, and nobody on shore knows how much. Radar says
// where the ferry is; now and then its AIS reports a speed. Both structs are plain: the filters
// find what they need by name.
//
//   state   x, y     m      north and east of the radar
//           vx, vy   m/s    velocity over ground
//           k        1/s    drag: the ferry loses the part k of its speed a second
//   motion  v' = e^(-k dt) v,  x' = x + v (1 - e^(-k dt)) / k,  k' = k + noise
//   plots   range (m) and bearing (rad, clockwise from north) every 2.5 s; speed (m/s) every 10 s
//
// Prints the drag as it becomes known, and how far from here the ferry will come to rest. Returns 1
// when it is wrong.
#include <cmath>
#include <cstdio>
#include <random>

#include "wakeline/filter/ukf.hpp"
#include "wakeline/measurement/range_bearing.hpp"
#include "wakeline/motion/singer.hpp"

using namespace wakeline;

constexpr Component kDrag = Component::kUser;

struct CoastingFerry {
  static constexpr std::array kComponents{Component::kNorth, Component::kVnorth, Component::kEast,
                                          Component::kVeast, kDrag};

  double accel_psd_m2s3 = 1e-4;  // gusts
  double drag_psd_s3 = 1e-10;    // the drag hardly changes

  template <class Scalar>
  Vec<Scalar, 5> transition(const Vec<Scalar, 5>& x, Scalar dt_s) const noexcept {
    const Scalar keeps = exponential_remainder<0>(x[4] * dt_s);
    const Scalar glides_s = dt_s * exponential_remainder<1>(x[4] * dt_s);
    Vec<Scalar, 5> next;
    next << x[0] + glides_s * x[1], keeps * x[1], x[2] + glides_s * x[3], keeps * x[3], x[4];
    return next;
  }

  template <class Scalar>
  Mat<Scalar, 5, 5> jacobian(const Vec<Scalar, 5>& x, Scalar dt_s) const noexcept {
    const Scalar u = x[4] * dt_s;
    const Scalar keeps = exponential_remainder<0>(u);
    const Scalar glides = exponential_remainder<1>(u);
    const Scalar glides_slope = exponential_remainder<2>(u) - glides;  // d/du
    Mat<Scalar, 5, 5> f = Mat<Scalar, 5, 5>::Identity();
    for (const int axis : {0, 2}) {
      f(axis, axis + 1) = dt_s * glides;
      f(axis + 1, axis + 1) = keeps;
      f(axis, 4) = dt_s * dt_s * glides_slope * x[axis + 1];
      f(axis + 1, 4) = -dt_s * keeps * x[axis + 1];
    }
    return f;
  }

  template <class Scalar>
  Mat<Scalar, 5, 5> process_noise(const Vec<Scalar, 5>&, Scalar dt_s) const noexcept {
    const Mat<Scalar, 2, 2> axis =
        ProcessNoise(WhiteAcceleration{accel_psd_m2s3}).of_velocity_axis(dt_s);
    Mat<Scalar, 5, 5> q = Mat<Scalar, 5, 5>::Zero();
    q.template block<2, 2>(0, 0) = q.template block<2, 2>(2, 2) = axis;
    q(4, 4) = Scalar(drag_psd_s3) * dt_s;
    return q;
  }

  double prior_variance(Component) const noexcept { return 0.02 * 0.02; }  // of the drag, 1/s²
};

struct AisSpeed {
  static constexpr int kMeasurements = 1;
  static constexpr std::array kReads{Component::kVnorth, Component::kVeast};

  double speed_std_mps = 0.1;

  template <class Scalar>
  Gaussian<1, Scalar> observe(const Vec<Scalar, 1>& z) const noexcept {
    return {z, Mat<Scalar, 1, 1>::Constant(Scalar(speed_std_mps * speed_std_mps))};
  }

  template <class Scalar>
  Vec<Scalar, 1> measure(const Vec<Scalar, 2>& velocity) const noexcept {
    return Vec<Scalar, 1>(velocity.norm());
  }

  template <class Scalar>
  Mat<Scalar, 1, 2> jacobian(const Vec<Scalar, 2>& velocity) const noexcept {
    return velocity.normalized().transpose();
  }

  template <class Scalar>
  Vec<Scalar, 1> residual(const Vec<Scalar, 1>& a, const Vec<Scalar, 1>& b) const noexcept {
    return a - b;
  }
};

int main() {
  constexpr double kStep_s = 2.5;
  constexpr double kTrueDrag = 0.02;
  const CoastingFerry ferry;
  const RangeBearing radar{.range_std_m = 10.0, .bearing_std_rad = deg(0.2)};
  const AisSpeed ais;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;

  Vec<double, 5> truth;
  truth << 1500.0, -6.0, -800.0, 5.0, kTrueDrag;
  const auto plot = [&] {
    const Vec<double, 2> exact = radar.measure(Vec<double, 2>(truth[0], truth[2]));
    return Vec<double, 2>(exact[0] + radar.range_std_m * normal(random),
                          exact[1] + radar.bearing_std_rad * normal(random));
  };

  Ukf filter{ferry};
  if (filter.start(one_point(radar, plot(), 5.0)) != Status::kOk) return 1;
  std::puts("   t s   speed m/s   drag 1/s   +-        comes to rest after m");
  for (int scan = 1; scan <= 32; ++scan) {
    truth = ferry.transition(truth, kStep_s);
    if (filter.predict(kStep_s) != Status::kOk) return 1;
    if (!filter.update(radar, plot())) return 1;
    if (scan % 4 != 0) continue;
    const Vec<double, 1> reported(std::hypot(truth[1], truth[3]) +
                                  ais.speed_std_mps * normal(random));
    if (!filter.update(ais, reported)) return 1;

    const Vec<double, 5>& x = filter.estimate().mean;
    const double speed = std::hypot(x[1], x[3]);
    std::printf("%6.1f   %9.2f   %8.4f   %6.4f   %21.0f\n", scan * kStep_s, speed, x[4],
                std::sqrt(filter.estimate().covariance(4, 4)), speed / x[4]);
  }

  const double error = std::abs(filter.estimate().mean[4] - kTrueDrag);
  const double claimed = std::sqrt(filter.estimate().covariance(4, 4));
  return claimed < 0.002 && error < 3.0 * claimed ? 0 : 1;
}
