// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "wakeline/core/fields.hpp"
#include "wakeline/measurement/concept.hpp"
#include "wakeline/measurement/polar.hpp"

namespace wakeline {

/// Smallest range (m) used in derivatives, which are singular at the antenna.
inline constexpr double kMinRange_m = 1e-3;

/// Distance from the antenna, in standard deviations of the position (the root of the trace of its
/// covariance), within which derivatives at the mean are useless. With less an EKF that starts at
/// two to three of them is wrong by tens of its standard deviations.
inline constexpr double kBendingStds = 4.0;

/// Whether range and bearing bend too much for derivatives at the mean of a belief, of which `d` is
/// the way from the antenna: within `kBendingStds`. To a bearing or a range alone, which does not
/// say where on the line of sight or about the antenna a target is, only what is uncertain across
/// the line counts. Derivatives at the reading, of which the errors are then those of the reading,
/// would lead an EKF astray where they are not needed.
template <class Scalar>
MaskOf<Scalar> bends_about_antenna(const Vec<Scalar, 2>& d, const Mat<Scalar, 2, 2>& covariance,
                                   const MaskOf<Scalar>& is_whole) noexcept {
  const Scalar range2 = d[0] * d[0] + d[1] * d[1];
  const Scalar stds2 = Scalar(kBendingStds * kBendingStds);
  const MaskOf<Scalar> within = range2 < stds2 * (covariance(0, 0) + covariance(1, 1));
  if (none(within)) [[likely]]
    return within;
  const Scalar across = d[1] * d[1] * covariance(0, 0) -
                        Scalar(2) * d[0] * d[1] * covariance(0, 1) + d[0] * d[0] * covariance(1, 1);
  return within && (is_whole || range2 * range2 <= Scalar(2) * stds2 * across);
}

/// A plot `[range m, bearing rad]` for EKF and UKF.
/// Source: Bar-Shalom, Li, Kirubarajan, 10.4.1; paper A, equation (6).
struct RangeBearing {
  static constexpr const char* kName = "RangeBearing";
  static constexpr const char* kSummary = "A plot [range m, bearing rad] for Ekf and Ukf.";
  static constexpr int kMeasurements = 2;
  static constexpr auto kReads = kPosition;
  static constexpr bool kLinear = false;

  double range_std_m = 10.0;
  double bearing_std_rad = deg(1.0);
  double extent_std_m = 0.0;
  double bearing_offset_rad = 0.0;
  OwnShip own = {};

  static constexpr auto fields() noexcept { return radar_fields<RangeBearing>(); }

  /// z and R = diag(sr² + se², sb² + (se / r)²); se includes the error of own ship's position, sb
  /// that of its heading.
  template <class Scalar>
  Gaussian<2, Scalar> observe(const Vec<Scalar, 2>& z) const noexcept {
    const PolarErrors e = errors();
    const Scalar isotropic = Scalar(e.isotropic_variance_m2());
    const Scalar range2 = at_least(z[0] * z[0], Scalar(kMinRange_m * kMinRange_m));
    Gaussian<2, Scalar> reading{z, Mat<Scalar, 2, 2>::Zero()};
    reading.covariance(0, 0) = Scalar(e.range_variance_m2()) + isotropic;
    reading.covariance(1, 1) = Scalar(e.bearing_variance_rad2()) + isotropic / range2;
    return reading;
  }

  template <class Scalar>
  Vec<Scalar, 2> measure(const Vec<Scalar, 2>& position) const noexcept {
    using std::atan2, std::sqrt;
    const Vec<Scalar, 2> d = position - own.position<Scalar>();
    return {sqrt(d[0] * d[0] + d[1] * d[1]), atan2(d[1], d[0]) + Scalar(bearing_offset_rad)};
  }

  template <class Scalar>
  Mat<Scalar, 2, 2> jacobian(const Vec<Scalar, 2>& position) const noexcept {
    const Vec<Scalar, 2> d = position - own.position<Scalar>();
    const Scalar range2 = d[0] * d[0] + d[1] * d[1];
    const Scalar nearness = inverse_sqrt(at_least(range2, Scalar(kMinRange_m * kMinRange_m)));
    const Scalar cosine = d[0] * nearness;
    const Scalar sine = d[1] * nearness;
    Mat<Scalar, 2, 2> h;
    h(0, 0) = cosine;
    h(0, 1) = sine;
    h(1, 0) = -sine * nearness;
    h(1, 1) = cosine * nearness;
    return h;
  }

  template <class Scalar>
  Vec<Scalar, 2> residual(const Vec<Scalar, 2>& a, const Vec<Scalar, 2>& b) const noexcept {
    return {a[0] - b[0], wrap_angle<Scalar>(a[1] - b[1])};
  }

  /// About the antenna; a number with an infinite variance in `r` is missing.
  template <class Scalar>
  MaskOf<Scalar> bends(const Gaussian<2, Scalar>& position,
                       const Mat<Scalar, 2, 2>& r) const noexcept {
    constexpr double kMissing = std::numeric_limits<double>::infinity();
    return bends_about_antenna<Scalar>(position.mean - own.position<Scalar>(), position.covariance,
                                       r(0, 0) + r(1, 1) < Scalar(kMissing));
  }

  /// The position of the plot, at least one standard deviation of the range from the antenna.
  template <class Scalar>
  Vec<Scalar, 2> moved_to(const Vec<Scalar, 2>&, const Vec<Scalar, 2>& z) const noexcept {
    return own.position<Scalar>() +
           at_least(z[0], Scalar(range_std_m)) * towards(Scalar(z[1] - Scalar(bearing_offset_rad)));
  }

  /// The plot in north/east, for gates.
  template <class Scalar>
  Gaussian<2, Scalar> position(const Vec<Scalar, 2>& z) const noexcept {
    return errors().position(z[0], z[1], true);
  }

  /// The same for a start.
  template <class Scalar>
  Gaussian<2, Scalar> start_position(const Vec<Scalar, 2>& z) const noexcept {
    return errors().start_position(z[0], z[1], true);
  }

  void validate() const { validate_fields(*this); }

  [[nodiscard]] PolarErrors errors() const noexcept {
    return {range_std_m, bearing_std_rad, extent_std_m, bearing_offset_rad, own};
  }
};

/// A plot `[range m, bearing rad]` converted to north/east with its covariance, which makes it a
/// linear measurement. With `unbiased` mean and covariance are corrected for the curvature of the
/// bearing error, and filters take the covariance at their prediction (`ConvertedErrors`); without
/// it they take that of the bearing as read, the form of the papers, whose estimates are too far
/// out where r sb² is not small beside the error of the range.
struct ConvertedRangeBearing {
  static constexpr const char* kName = "ConvertedRangeBearing";
  static constexpr const char* kSummary =
      "A plot [range m, bearing rad] converted to north/east with its covariance: linear.";
  static constexpr int kMeasurements = 2;
  static constexpr auto kReads = kPosition;
  static constexpr bool kLinear = true;
  static constexpr bool kDirect = true;

  double range_std_m = 10.0;
  double bearing_std_rad = deg(1.0);
  bool unbiased = true;
  double extent_std_m = 0.0;
  double bearing_offset_rad = 0.0;
  OwnShip own = {};

  static constexpr auto fields() noexcept {
    using C = ConvertedRangeBearing;
    return field_table(
        radar_fields<C>(),
        field("unbiased", &C::unbiased,
              "Mean and covariance are corrected for the curvature of the bearing error, and the "
              "covariance is that at a filter's prediction."));
  }

  /// The plot in north/east.
  template <class Scalar>
  Gaussian<2, Scalar> observe(const Vec<Scalar, 2>& z) const noexcept {
    return errors().position(z[0], z[1], unbiased);
  }

  /// An observed plot beside the prediction of its target.
  template <class Scalar>
  Gaussian<2, Scalar> at_prediction(const Gaussian<2, Scalar>& reading,
                                    const Gaussian<2, Scalar>& position) const noexcept {
    return unbiased ? errors().converted().at(reading, position) : reading;
  }

  template <class Scalar>
  Vec<Scalar, 2> measure(const Vec<Scalar, 2>& position) const noexcept {
    return position;
  }

  template <class Scalar>
  Mat<Scalar, 2, 2> jacobian(const Vec<Scalar, 2>&) const noexcept {
    return Mat<Scalar, 2, 2>::Identity();
  }

  template <class Scalar>
  Vec<Scalar, 2> residual(const Vec<Scalar, 2>& a, const Vec<Scalar, 2>& b) const noexcept {
    return a - b;
  }

  template <class Scalar>
  Gaussian<2, Scalar> position(const Vec<Scalar, 2>& z) const noexcept {
    return observe(z);
  }

  /// The plot in north/east for a start.
  template <class Scalar>
  Gaussian<2, Scalar> start_position(const Vec<Scalar, 2>& z) const noexcept {
    return errors().start_position(z[0], z[1], unbiased);
  }

  void validate() const { validate_fields(*this); }

  [[nodiscard]] PolarErrors errors() const noexcept {
    return {range_std_m, bearing_std_rad, extent_std_m, bearing_offset_rad, own};
  }
};

}  // namespace wakeline
