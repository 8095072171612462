// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/fields.hpp"
#include "wakeline/measurement/concept.hpp"
#include "wakeline/measurement/polar.hpp"
#include "wakeline/measurement/range_bearing.hpp"

namespace wakeline {

/// A range alone, `[range m]`: of a rangefinder, a transponder or a beacon. Source: Bar-Shalom, Li,
/// Kirubarajan, 10.3.4.
struct Range {
  static constexpr const char* kName = "Range";
  static constexpr const char* kSummary = "A range alone, [range m], for Ekf, Ukf and Imm.";
  static constexpr int kMeasurements = 1;
  static constexpr auto kReads = kPosition;
  static constexpr bool kLinear = false;

  double range_std_m = 10.0;
  double extent_std_m = 0.0;
  OwnShip own = {};

  static constexpr auto fields() noexcept {
    using R = Range;
    return field_table(
        field("range_std_m", &R::range_std_m, kPositive, "m", "Standard deviation of the range."),
        field("extent_std_m", &R::extent_std_m, kNotNegative, "m",
              "Standard deviation of the echo's position on the hull, per axis."),
        field("own", &R::own, "Position of the sensor, with its standard deviation."));
  }

  /// z and R = sr² + se², which includes the error of own ship's position.
  template <class Scalar>
  Gaussian<1, Scalar> observe(const Vec<Scalar, 1>& z) const noexcept {
    const PolarErrors e = polar().errors();
    Gaussian<1, Scalar> reading{z, Mat<Scalar, 1, 1>::Zero()};
    reading.covariance(0, 0) = Scalar(e.range_variance_m2()) + Scalar(e.isotropic_variance_m2());
    return reading;
  }

  template <class Scalar>
  Vec<Scalar, 1> measure(const Vec<Scalar, 2>& position) const noexcept {
    return polar().measure(position).template head<1>();
  }

  template <class Scalar>
  Mat<Scalar, 1, 2> jacobian(const Vec<Scalar, 2>& position) const noexcept {
    return polar().jacobian(position).row(0);
  }

  template <class Scalar>
  Vec<Scalar, 1> residual(const Vec<Scalar, 1>& a, const Vec<Scalar, 1>& b) const noexcept {
    return a - b;
  }

  /// About the antenna.
  template <class Scalar>
  MaskOf<Scalar> bends(const Gaussian<2, Scalar>& position,
                       const Mat<Scalar, 1, 1>&) const noexcept {
    return bends_about_antenna<Scalar>(position.mean - own.position<Scalar>(), position.covariance,
                                       false);
  }

  /// The position at that range and at the bearing of `position`.
  template <class Scalar>
  Vec<Scalar, 2> moved_to(const Vec<Scalar, 2>& position, const Vec<Scalar, 1>& z) const noexcept {
    return polar().moved_to(position, Vec<Scalar, 2>(z[0], polar().measure(position)[1]));
  }

  void validate() const { validate_fields(*this); }

 private:
  [[nodiscard]] RangeBearing polar() const noexcept {
    return {.range_std_m = range_std_m, .extent_std_m = extent_std_m, .own = own};
  }
};

}  // namespace wakeline
