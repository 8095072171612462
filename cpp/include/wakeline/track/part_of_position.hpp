// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/measurement/polar.hpp"
#include "wakeline/track/partial_scan.hpp"

namespace wakeline {

/// The part of a target's position that a sensor measures, as it is seen from there.
class PartOfPosition {
 public:
  PartOfPosition(const PartialScan& scan, const Gaussian<2>& position, double extent_std_m) noexcept
      : part_(scan.part), from_(scan.own.position<double>()) {
    const Vec<double, 2> d = position.mean - from_;
    range_m_ = std::max(d.norm(), kNearest_m);
    bearing_rad_ = std::atan2(d[1], d[0]);
    const Vec<double, 2> along = towards(bearing_rad_), across(-along[1], along[0]);
    measured_ = part_ == PositionPart::kBearing ? across : along;
    unknown_ = part_ == PositionPart::kBearing ? along : across;
    scale_ = part_ == PositionPart::kBearing ? range_m_ : 1.0;
    const double own_m = scan.own.position_std_m;
    const double turned_m =
        part_ == PositionPart::kBearing ? range_m_ * scan.own.heading_std_rad : 0.0;
    const double error_m = scale_ * scan.std;
    error_m2_ =
        error_m * error_m + extent_std_m * extent_std_m + own_m * own_m + turned_m * turned_m;
    variance_m2_ = measured_.dot(position.covariance * measured_) + error_m2_;
    unknown_m2_ = unknown_.dot(position.covariance * unknown_) + kUnknown_m * kUnknown_m;
  }

  /// How far a value is from the expected one, m.
  [[nodiscard]] double off_m(double value) const noexcept {
    return part_ == PositionPart::kBearing ? range_m_ * wrap_angle(value - bearing_rad_)
                                           : value - range_m_;
  }

  [[nodiscard]] double squared_distance(double value) const noexcept {
    const double d_m = off_m(value);
    return d_m * d_m / variance_m2_;
  }

  /// Of a value, per rad or per m.
  [[nodiscard]] double likelihood(double value) const noexcept {
    return scale_ * std::exp(-0.5 * squared_distance(value)) /
           std::sqrt(2.0 * std::numbers::pi * variance_m2_);
  }

  /// A value as a position whose other part is that expected, and is not known.
  [[nodiscard]] Gaussian<2> fix(double value) const noexcept {
    return {from_ + range_m_ * towards(bearing_rad_) + off_m(value) * measured_,
            error_m2_ * measured_ * measured_.transpose() +
                kUnknown_m * kUnknown_m * unknown_ * unknown_.transpose()};
  }

  /// The likelihood of a value over that of its position as `fix` has it, m per unit.
  [[nodiscard]] double per_fix() const noexcept {
    return scale_ * std::sqrt(2.0 * std::numbers::pi * unknown_m2_);
  }

 private:
  static constexpr double kNearest_m = 1.0;
  static constexpr double kUnknown_m = 1e5;

  PositionPart part_;
  Vec<double, 2> from_, measured_, unknown_;
  double range_m_, bearing_rad_, scale_, error_m2_, variance_m2_, unknown_m2_;
};

}  // namespace wakeline
