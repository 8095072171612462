// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/core/fields.hpp"
#include "wakeline/filter/belief.hpp"

namespace wakeline {

/// The parameters of the scaled unscented transform.
///
/// Sigma points are x and x ± sqrt(alpha² (n + kappa)) times the columns of the Cholesky factor.
/// With e_i the image of a point relative to that of the centre and w = 1 / (2 alpha² (n + kappa)),
/// the weighted mean and covariance are, whatever the sign of the centre weight,
///
///     d = w Σ e_i,   mean = f(x) + d,   covariance = w Σ e_i e_iᵀ + (beta - alpha²) d dᵀ,
///
/// without cancellation of large weights, and positive semidefinite for beta >= alpha². The
/// rounding error of f has weight 1 / alpha² in the mean: points nearer than 1e-4 columns (`float`:
/// 0.1) are rejected, as are those farther than 1e4. Source: S. J. Julier, "The scaled unscented
/// transformation", ACC 2002; E. A. Wan, R. van der Merwe, 2000.
struct Unscented {
  double alpha = 1.0;
  double beta = 2.0;
  double kappa = 0.0;

  static constexpr auto fields() noexcept {
    using U = Unscented;
    return field_table(
        field("alpha", &U::alpha, kPositive, "1", "Distance of the sigma points from the mean."),
        field("beta", &U::beta, kFinite, "1",
              "Weight of the central point in the covariance; 2 suits a Gaussian."),
        field("kappa", &U::kappa, kFinite, "1",
              "Second scale of that distance, sqrt(alpha² (n + kappa)) for n states."));
  }

  /// Distance of the points from the centre, in columns of the factor: sqrt(alpha² (n + kappa)).
  template <class Scalar>
  [[nodiscard]] Scalar spread(int states) const noexcept {
    return Scalar(alpha * std::sqrt(states + kappa));
  }

  /// Weight w of each point except the centre.
  template <class Scalar>
  [[nodiscard]] Scalar weight(int states) const noexcept {
    return Scalar(1.0 / (2.0 * alpha * alpha * (states + kappa)));
  }

  /// beta - alpha².
  template <class Scalar>
  [[nodiscard]] Scalar centre_correction() const noexcept {
    return Scalar(beta - alpha * alpha);
  }

  template <class Scalar = double>
  void validate(int states) const {
    validate_fields(*this);
    require(states + kappa > 0.0, "kappa", "greater than minus the number of states", kappa);
    constexpr bool kDouble = sizeof(RealOf<Scalar>) > 4;
    const double reach = spread<double>(states);
    require(reach >= (kDouble ? 1e-4 : 0.1) && reach <= 1e4, "alpha sqrt(states + kappa)",
            kDouble ? "0.0001 to 10000" : "0.1 to 10000, in float", reach);
  }
};

/// The 2 N sigma points about a mean, without the mean: pair k differs from the mean in the rows
/// from k on, because the root is lower triangular.
template <class Scalar, int N>
Mat<Scalar, N, 2 * N> sigma_points(const Vec<Scalar, N>& mean, const Mat<Scalar, N, N>& lower,
                                   Scalar spread) noexcept {
  Mat<Scalar, N, 2 * N> points;
  unroll<N>([&](int k) {
    unroll<N>([&](int i) {
      const Scalar offset = i < k ? Scalar(0) : spread * lower(i, k);
      points(i, 2 * k) = mean[i] + offset;
      points(i, 2 * k + 1) = mean[i] - offset;
    });
  });
  return points;
}

/// Sigma points after the motion: the centre, and the others relative to it.
template <class Scalar, int N>
struct MovedPoints {
  Vec<Scalar, N> centre;
  Mat<Scalar, N, 2 * N> differences;

  template <class Motion>
  MovedPoints(const Motion& motion, Scalar dt_s, const Vec<Scalar, N>& mean,
              const Mat<Scalar, N, 2 * N>& points) noexcept {
    if constexpr (LinearMotionModel<Motion>) {
      const Mat<Scalar, N, N> f = motion.matrix(dt_s);
      centre = product(f, mean);
      differences = product(f, points);
      for (int k = 0; k < 2 * N; ++k)
        for (int i = 0; i < N; ++i) differences(i, k) -= centre[i];
    } else {
      centre = motion.transition(mean, dt_s);
      for (int k = 0; k < 2 * N; ++k)
        differences.col(k) = motion.transition(Vec<Scalar, N>(points.col(k)), dt_s) - centre;
    }
  }
};

/// Sigma points in measurement space: the centre, and the wrapped differences of the others from
/// it, up to the last pair that differs from the mean in a row that the sensor reads.
template <auto Components, class Sensor, class Scalar>
struct MeasuredPoints {
  static constexpr int kStates = static_cast<int>(Components.size());
  static constexpr int kM = Sensor::kMeasurements;
  static constexpr auto kRows = rows_read<Sensor>(Components);
  static constexpr int kPairs = [] {
    int last = 0;
    for (int k = 0; k < kReadsOf<Sensor>; ++k) last = kRows[k] > last ? kRows[k] : last;
    return last + 1;
  }();

  Vec<Scalar, kM> centre;
  Mat<Scalar, kM, 2 * kPairs> differences;

  MeasuredPoints(const Sensor& sensor, const Vec<Scalar, kStates>& mean,
                 const Mat<Scalar, kStates, 2 * kStates>& points) noexcept {
    const auto see = [&](const auto& state) {
      Vec<Scalar, kReadsOf<Sensor>> read;
      for (int k = 0; k < read.size(); ++k) read[k] = state[kRows[k]];
      return Vec<Scalar, kM>(sensor.measure(read));
    };
    centre = see(mean);
    for (int k = 0; k < differences.cols(); ++k)
      differences.col(k) = sensor.residual(see(points.col(k)), centre);
  }
};

/// Mean and covariance of the images, given the centre's image and the differences e of the others
/// from it.
template <class Scalar, int M, int Points>
Gaussian<M, Scalar> unscented_moments(const Unscented& unscented, int states,
                                      const Vec<Scalar, M>& centre,
                                      const Mat<Scalar, M, Points>& differences) noexcept {
  const Scalar w = unscented.template weight<Scalar>(states);
  const Scalar beta = unscented.template centre_correction<Scalar>();
  Vec<Scalar, M> shift;
  unroll<M>([&](int i) {
    Scalar sum = differences(i, 0);
    for (int k = 1; k < Points; ++k) sum += differences(i, k);
    shift[i] = w * sum;
  });
  Gaussian<M, Scalar> moments;
  unroll<M>([&](int i) { moments.mean[i] = centre[i] + shift[i]; });
  unroll_lower<M>([&](int i, int j) {
    Scalar sum = differences(i, 0) * differences(j, 0);
    for (int k = 1; k < Points; ++k) sum += differences(i, k) * differences(j, k);
    moments.covariance(i, j) = moments.covariance(j, i) = w * sum + beta * shift[i] * shift[j];
  });
  return moments;
}

}  // namespace wakeline
