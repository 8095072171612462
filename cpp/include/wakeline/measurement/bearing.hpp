// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/fields.hpp"
#include "wakeline/measurement/concept.hpp"
#include "wakeline/measurement/polar.hpp"
#include "wakeline/measurement/range_bearing.hpp"

namespace wakeline {

/// A bearing alone, `[bearing rad]`: of a direction finder, a camera or a jammed radar. The part of
/// its error that is a length, of the extent and of own ship's position, is seen from the predicted
/// range. Source: Bar-Shalom, Li, Kirubarajan, 10.3.4.
struct Bearing {
  static constexpr const char* kName = "Bearing";
  static constexpr const char* kSummary = "A bearing alone, [bearing rad], for Ekf, Ukf and Imm.";
  static constexpr int kMeasurements = 1;
  static constexpr auto kReads = kPosition;
  static constexpr bool kLinear = false;

  double bearing_std_rad = deg(1.0);
  double extent_std_m = 0.0;
  double bearing_offset_rad = 0.0;
  OwnShip own = {};

  static constexpr auto fields() noexcept { return bearing_fields<Bearing>(); }

  /// z and R = sb², which includes the error of own ship's heading.
  template <class Scalar>
  Gaussian<1, Scalar> observe(const Vec<Scalar, 1>& z) const noexcept {
    Gaussian<1, Scalar> reading{z, Mat<Scalar, 1, 1>::Zero()};
    reading.covariance(0, 0) = Scalar(errors().bearing_variance_rad2());
    return reading;
  }

  /// R + (se / r)² at the predicted range r.
  template <class Scalar>
  Gaussian<1, Scalar> at_prediction(const Gaussian<1, Scalar>& reading,
                                    const Gaussian<2, Scalar>& position) const noexcept {
    Gaussian<1, Scalar> seen = reading;
    seen.covariance(0, 0) +=
        Scalar(errors().isotropic_variance_m2()) /
        at_least(Scalar(Vec<Scalar, 2>(position.mean - own.position<Scalar>()).squaredNorm()),
                 Scalar(kMinRange_m * kMinRange_m));
    return seen;
  }

  template <class Scalar>
  Vec<Scalar, 1> measure(const Vec<Scalar, 2>& position) const noexcept {
    return polar().measure(position).template tail<1>();
  }

  template <class Scalar>
  Mat<Scalar, 1, 2> jacobian(const Vec<Scalar, 2>& position) const noexcept {
    return polar().jacobian(position).row(1);
  }

  template <class Scalar>
  Vec<Scalar, 1> residual(const Vec<Scalar, 1>& a, const Vec<Scalar, 1>& b) const noexcept {
    Vec<Scalar, 1> difference;
    difference[0] = wrap_angle<Scalar>(a[0] - b[0]);
    return difference;
  }

  /// About the antenna.
  template <class Scalar>
  MaskOf<Scalar> bends(const Gaussian<2, Scalar>& position,
                       const Mat<Scalar, 1, 1>&) const noexcept {
    return bends_about_antenna<Scalar>(position.mean - own.position<Scalar>(), position.covariance,
                                       false);
  }

  /// The position at that bearing and at the range of `position`.
  template <class Scalar>
  Vec<Scalar, 2> moved_to(const Vec<Scalar, 2>& position, const Vec<Scalar, 1>& z) const noexcept {
    return polar().moved_to(position, Vec<Scalar, 2>(polar().measure(position)[0], z[0]));
  }

  void validate() const { validate_fields(*this); }

 private:
  [[nodiscard]] RangeBearing polar() const noexcept {
    return {.bearing_std_rad = bearing_std_rad,
            .extent_std_m = extent_std_m,
            .bearing_offset_rad = bearing_offset_rad,
            .own = own};
  }
  [[nodiscard]] PolarErrors errors() const noexcept { return polar().errors(); }
};

}  // namespace wakeline
