// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "wakeline/core/fields.hpp"
#include "wakeline/measurement/range_bearing.hpp"

namespace wakeline {

/// A plot `[range m, bearing rad, range rate m/s]`. The range rate is relative to own ship, which
/// moves. Source: Bar-Shalom, Li, Kirubarajan, 10.4.1, with the range rate d·v / r.
struct RangeBearingDoppler {
  static constexpr const char* kName = "RangeBearingDoppler";
  static constexpr const char* kSummary =
      "A plot [range m, bearing rad, range rate m/s], relative to own ship.";
  static constexpr int kMeasurements = 3;
  static constexpr auto kReads = kKinematics;
  static constexpr bool kLinear = false;

  double range_std_m = 10.0;
  double bearing_std_rad = deg(1.0);
  double range_rate_std_mps = 1.0;
  double extent_std_m = 0.0;
  double bearing_offset_rad = 0.0;
  OwnShip own = {};

  static constexpr auto fields() noexcept {
    using D = RangeBearingDoppler;
    return field_table(radar_fields<D>(),
                       field("range_rate_std_mps", &D::range_rate_std_mps, kPositive, "m/s",
                             "Standard deviation of the range rate."));
  }

  /// z and R: R of RangeBearing, and the variance of the range rate including own ship's velocity
  /// error.
  template <class Scalar>
  Gaussian<3, Scalar> observe(const Vec<Scalar, 3>& z) const noexcept {
    Gaussian<3, Scalar> reading{z, Mat<Scalar, 3, 3>::Zero()};
    reading.covariance.template topLeftCorner<2, 2>() =
        range_bearing().observe(Vec<Scalar, 2>(z.template head<2>())).covariance;
    reading.covariance(2, 2) = Scalar(variance(kPositive, range_rate_std_mps) +
                                      own.velocity_std_mps * own.velocity_std_mps);
    return reading;
  }

  /// h of `[x, vx, y, vy]`.
  template <class Scalar>
  Vec<Scalar, 3> measure(const Vec<Scalar, 4>& kinematics) const noexcept {
    const View<Scalar> view(kinematics, own);
    Vec<Scalar, 3> z;
    z.template head<2>() = range_bearing().measure(view.position);
    z[2] = view.line_of_sight.dot(view.velocity);
    return z;
  }

  /// dh / d[x, vx, y, vy], 3 x 4.
  template <class Scalar>
  Mat<Scalar, 3, 4> jacobian(const Vec<Scalar, 4>& kinematics) const noexcept {
    const View<Scalar> view(kinematics, own);
    const Mat<Scalar, 2, 2> polar = range_bearing().jacobian(view.position);
    const Scalar rate = view.line_of_sight.dot(view.velocity);
    const Vec<Scalar, 2> rate_by_position =
        (view.velocity - rate * view.line_of_sight) / view.range;
    Mat<Scalar, 3, 4> h = Mat<Scalar, 3, 4>::Zero();
    h.template block<2, 1>(0, 0) = polar.col(0);
    h.template block<2, 1>(0, 2) = polar.col(1);
    h(2, 0) = rate_by_position[0];
    h(2, 1) = view.line_of_sight[0];
    h(2, 2) = rate_by_position[1];
    h(2, 3) = view.line_of_sight[1];
    return h;
  }

  template <class Scalar>
  Vec<Scalar, 3> residual(const Vec<Scalar, 3>& a, const Vec<Scalar, 3>& b) const noexcept {
    return {a[0] - b[0], wrap_angle<Scalar>(a[1] - b[1]), a[2] - b[2]};
  }

  /// Where range and bearing do.
  template <class Scalar>
  MaskOf<Scalar> bends(const Gaussian<4, Scalar>& kinematics,
                       const Mat<Scalar, 3, 3>& r) const noexcept {
    const auto position = Eigen::seqN(0, Eigen::fix<2>, Eigen::fix<2>);
    return range_bearing().bends(
        Gaussian<2, Scalar>{kinematics.mean(position), kinematics.covariance(position, position)},
        Mat<Scalar, 2, 2>(r.template topLeftCorner<2, 2>()));
  }

  /// The position of the plot with the velocity as it is.
  template <class Scalar>
  Vec<Scalar, 4> moved_to(const Vec<Scalar, 4>& kinematics,
                          const Vec<Scalar, 3>& z) const noexcept {
    const Vec<Scalar, 2> position = range_bearing().moved_to(
        Vec<Scalar, 2>(kinematics[0], kinematics[2]), Vec<Scalar, 2>(z[0], z[1]));
    return {position[0], kinematics[1], position[1], kinematics[3]};
  }

  template <class Scalar>
  Gaussian<2, Scalar> position(const Vec<Scalar, 3>& z) const noexcept {
    return range_bearing().errors().position(z[0], z[1], true);
  }

  template <class Scalar>
  Gaussian<2, Scalar> start_position(const Vec<Scalar, 3>& z) const noexcept {
    return range_bearing().errors().start_position(z[0], z[1], true);
  }

  void validate() const { validate_fields(*this); }

 private:
  [[nodiscard]] RangeBearing range_bearing() const noexcept {
    return {range_std_m, bearing_std_rad, extent_std_m, bearing_offset_rad, own};
  }

  /// The target relative to own ship.
  template <class Scalar>
  struct View {
    Vec<Scalar, 2> position;       ///< difference in the plane
    Vec<Scalar, 2> velocity;       ///< relative to own ship
    Vec<Scalar, 2> line_of_sight;  ///< unit vector from own ship to the target
    Scalar range;

    View(const Vec<Scalar, 4>& x, const OwnShip& own) noexcept
        : position(x[0], x[2]), velocity(Vec<Scalar, 2>(x[1], x[3]) - own.velocity<Scalar>()) {
      using std::sqrt;
      const Vec<Scalar, 2> d = position - own.position<Scalar>();
      const Scalar distance = sqrt(d.squaredNorm());
      range = at_least(distance, Scalar(kMinRange_m));
      line_of_sight = d / range;
    }
  };
};

}  // namespace wakeline
