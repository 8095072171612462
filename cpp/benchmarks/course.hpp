// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// What the benchmarks of filters run along: a closed course, which a filter goes round.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline::bench {

inline constexpr double kStep_s = 2.5;

/// Two straight legs and two half circles at 1 deg/s, 10 m/s, seen from the origin.
template <class Scalar>
struct Course {
  std::vector<Vec<Scalar, 2>> polar;     ///< range m, bearing rad
  std::vector<Vec<Scalar, 2>> position;  ///< north m, east m
  Gaussian<4, Scalar> start;

  explicit Course(unsigned seed = 1) {
    constexpr int kLeg = 56, kTurn = 72;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    double north = 3000.0, east = 2000.0;
    for (int k = 0; k < 2 * (kLeg + kTurn); ++k) {
      const int phase = k % (kLeg + kTurn);
      const double course =
          deg(kStep_s) * std::max(0, phase - kLeg) + (k >= kLeg + kTurn ? deg(180.0) : 0.0);
      north += 10.0 * kStep_s * std::cos(course);
      east += 10.0 * kStep_s * std::sin(course);
      polar.emplace_back(Scalar(std::hypot(north, east) + 20.0 * normal(random)),
                         Scalar(std::atan2(east, north) + deg(0.5) * normal(random)));
      position.emplace_back(Scalar(north + 20.0 * normal(random)),
                            Scalar(east + 20.0 * normal(random)));
    }
    start.mean << Scalar(3000), Scalar(10), Scalar(2000), Scalar(0);
    start.covariance.diagonal() << Scalar(400), Scalar(25), Scalar(400), Scalar(25);
  }
};

/// Largest difference over largest element.
template <class A, class B>
auto relative_error(const A& a, const B& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

}  // namespace wakeline::bench
