// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "wakeline/filter/unscented.hpp"
#include "wakeline/simd/flatten.hpp"

namespace wakeline {

/// Lower-triangular L with L Lᵀ = A Aᵀ and a non-negative diagonal: Householder reflections from
/// the right, one for each row of A. Source: G. H. Golub, C. F. Van Loan, Matrix Computations, 5.2.
template <class Scalar, int N, int Cols>
Mat<Scalar, N, N> lower_root(Mat<Scalar, N, Cols> a) noexcept {
  using std::abs, std::sqrt;
  for (int row = 0; row < N; ++row) {
    Scalar squares = Scalar(0);
    for (int k = row; k < Cols; ++k) squares += a(row, k) * a(row, k);
    const Scalar norm = sqrt(squares);
    const MaskOf<Scalar> negative = a(row, row) < Scalar(0);
    const Scalar head = a(row, row) + select(negative, Scalar(-norm), norm);
    const MaskOf<Scalar> empty = !(norm > Scalar(0));
    const Scalar scale =
        select(empty, Scalar(0), Scalar(1) / select(empty, Scalar(1), Scalar(norm * abs(head))));
    for (int other = row + 1; other < N; ++other) {
      Scalar dot = head * a(other, row);
      for (int k = row + 1; k < Cols; ++k) dot += a(row, k) * a(other, k);
      dot *= scale;
      const Scalar reflected = a(other, row) - dot * head;
      a(other, row) = select(negative, reflected, Scalar(-reflected));
      for (int k = row + 1; k < Cols; ++k) a(other, k) -= dot * a(row, k);
    }
    a(row, row) = norm;
  }
  Mat<Scalar, N, N> lower = Mat<Scalar, N, N>::Zero();
  for (int row = 0; row < N; ++row)
    for (int column = 0; column <= row; ++column) lower(row, column) = a(row, column);
  return lower;
}

/// The square-root unscented Kalman filter, for long unattended runs: the covariance is L Lᵀ and
/// stays positive semidefinite. Both steps are one triangularisation of an array, without a
/// downdate; beta must therefore be at least alpha². Source: R. van der Merwe, E. A. Wan, ICASSP
/// 2001; the array form after Bar-Shalom, Li, Kirubarajan, 7.4.
template <class MotionType, class ScalarType = double>
class SquareRootUkf {
  static_assert(MotionModel<MotionType>, "wakeline: not a motion model; see cpp/docs/concepts.md");

 public:
  using Motion = MotionType;
  using Scalar = ScalarType;
  static constexpr auto kComponents = Motion::kComponents;
  static constexpr int kStates = kStatesOf<Motion>;
  static constexpr int kPoints = 2 * kStates;

  /// Throws `std::invalid_argument` when a parameter is invalid.
  explicit SquareRootUkf(const MotionType& motion, const Unscented& unscented = {})
      : motion_(validated(motion)), unscented_(unscented) {
    check_components<Motion>();
    unscented.template validate<Scalar>(kStates);
    require(unscented.beta >= unscented.alpha * unscented.alpha, "beta", "at least alpha squared",
            unscented.beta);
  }

  /// Starts with `belief`; rejects one that is not finite or whose covariance is not symmetric
  /// positive definite.
  StatusOf<Scalar> start(const Gaussian<kStates, Scalar>& belief) noexcept {
    const StatusOf<Scalar> status = check(belief);
    if (none(ok(status))) return status;
    assign_in(ok(status), belief);
    started_ = true;
    return status;
  }

  /// Starts with a belief over `[x, vx, y, vy]`; the other components get the model's prior.
  StatusOf<Scalar> start(const Gaussian<4, Scalar>& kinematics) noexcept
      requires(kStates != 4 && holds(kComponents, kKinematics)) {
    return start(lift(motion_, kinematics));
  }

  /// Replaces the belief.
  StatusOf<Scalar> assign(const Gaussian<kStates, Scalar>& belief) noexcept {
    const MaskOf<Scalar> definite = assign_in(true, belief);
    started_ = started_ || any(definite);
    return ok_or(definite, Status::kNotPositiveDefinite);
  }

  /// Replaces the belief in some lanes; returns the lanes in which its covariance had a factor.
  MaskOf<Scalar> assign_in(const MaskOf<Scalar>& lanes,
                           const Gaussian<kStates, Scalar>& belief) noexcept {
    const Cholesky<kStates, Scalar> root(belief.covariance);
    const MaskOf<Scalar> replaced = lanes && root.ok();
    replace(replaced, belief.mean, root.lower());
    return replaced;
  }

  /// Copies the belief of another filter in some lanes, bit for bit.
  void assign_in(const MaskOf<Scalar>& lanes, const SquareRootUkf& other) noexcept {
    replace(lanes, other.mean_, other.root_);
  }

  /// Replaces the motion model, unchecked; the belief stays.
  void set_motion(const Motion& motion) noexcept { motion_ = motion; }

  /// Saves or restores the belief.
  void archive(Archive& fields) {
    fields(mean_);
    fields(root_);
    fields(started_);
  }

  /// The belief, with the covariance L Lᵀ.
  [[nodiscard]] Gaussian<kStates, Scalar> estimate() const noexcept {
    Gaussian<kStates, Scalar> belief{mean_, product_transposed(root_, root_)};
    mirror_lower<Scalar, kStates>(belief.covariance);
    return belief;
  }

  [[nodiscard]] const Mat<Scalar, kStates, kStates>& root() const noexcept { return root_; }
  [[nodiscard]] const Motion& motion() const noexcept { return motion_; }
  [[nodiscard]] const Unscented& unscented() const noexcept { return unscented_; }
  [[nodiscard]] bool started() const noexcept { return started_; }

  /// The root of the array [sqrt(w) e_i, sqrt(beta - alpha²) d, Q^(1/2)].
  /// Not inlined, as is `correct`: beside the sigma points a call is nothing, and each estimator
  /// over the filter would compile them anew.
  [[gnu::noinline]] WAKELINE_FLATTEN StatusOf<Scalar> predict(Scalar dt_s) noexcept {
    using std::sqrt;
    if (!started_) return Status::kNotStarted;
    const StatusOf<Scalar> forward = check_time_step(dt_s);
    if (none(ok(forward))) return forward;
    const MovedPoints<Scalar, kStates> moved(motion_, dt_s, mean_, points());
    const Vec<Scalar, kStates> shift = weighted_sum(moved.differences);
    const Mat<Scalar, kStates, kStates> noise =
        semidefinite_root<kStates, Scalar>(process_noise(motion_, mean_, dt_s));
    const Scalar scale = sqrt(weight()), of_centre = centre_root();
    Mat<Scalar, kStates, kPoints + 1 + kStates> array;
    Vec<Scalar, kStates> mean;
    for (int i = 0; i < kStates; ++i) {
      for (int k = 0; k < kPoints; ++k) array(i, k) = scale * moved.differences(i, k);
      array(i, kPoints) = of_centre * shift[i];
      for (int k = 0; k < kStates; ++k) array(i, kPoints + 1 + k) = noise(i, k);
      mean[i] = moved.centre[i] + shift[i];
    }
    const Mat<Scalar, kStates, kStates> root = lower_root(array);
    const StatusOf<Scalar> status = first_failure(
        forward,
        ok_or(is_finite(moved.centre) && is_finite(array) && has_finite_moments(mean, root),
              Status::kNotFinite));
    replace(ok(status), mean, root);
    return status;
  }

  /// The same under a known acceleration, [north, east]; see `Control`.
  StatusOf<Scalar> predict(Scalar dt_s, const Vec<Scalar, 2>& acceleration_mps2) noexcept {
    return Control::predict(*this, dt_s, acceleration_mps2);
  }

  /// The innovation of a reading and its likelihood, without an update.
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> innovation(
      const Sensor& sensor, const Vec<Scalar, Sensor::kMeasurements>& z) const noexcept {
    return compare(sensor, sensor.observe(z)).scored();
  }

  /// The same for an observed reading, with the likelihood in two factors.
  template <class Sensor>
  Correction<Sensor::kMeasurements, Scalar> compare(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements, Scalar>& reading) const noexcept {
    return SquareRootUkf(*this).correct(sensor, reading);
  }

  /// Updates the belief with the reading z of a sensor: the root of [sqrt(w) e_z, sqrt(beta -
  /// alpha²) d_z, R^(1/2); sqrt(w) (points - x), 0, 0] is [S^(1/2), 0; K S^(1/2), P^(1/2)].
  template <class Sensor>
  Step<Sensor::kMeasurements, Scalar> update(const Sensor& sensor,
                                             const Vec<Scalar, Sensor::kMeasurements>& z) noexcept {
    return with_model(
        sensor, [&](const auto& model) { return correct(model, sensor.observe(z)).scored(); });
  }

  /// The same with an observed reading; the likelihood in two factors.
  template <class Sensor>
  [[gnu::noinline]] WAKELINE_FLATTEN Correction<Sensor::kMeasurements, Scalar> correct(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements, Scalar>& observed) noexcept {
    using std::sqrt;
    check_sensor<Sensor, SquareRootUkf>();
    constexpr int kM = Sensor::kMeasurements;
    if (!started_) return failed_correction<kM, Scalar>(Status::kNotStarted);
    Gaussian<kM, Scalar> reading = observed;
    if constexpr (SensorAtPrediction<Sensor>)
      reading = at_prediction<kComponents>(sensor, observed, estimate());
    const Mat<Scalar, kStates, kPoints> sigma = points();
    const MeasuredPoints<kComponents, Sensor, Scalar> images(sensor, mean_, sigma);
    const Vec<Scalar, kM> shift = weighted_sum(images.differences);
    const Mat<Scalar, kM, kM> noise = semidefinite_root<kM, Scalar>(reading.covariance);

    const Scalar scale = sqrt(weight()), of_centre = centre_root();
    Mat<Scalar, kM + kStates, kPoints + 1 + kM> array =
        Mat<Scalar, kM + kStates, kPoints + 1 + kM>::Zero();
    Vec<Scalar, kM> predicted;
    for (int m = 0; m < kM; ++m) {
      for (int k = 0; k < images.differences.cols(); ++k)
        array(m, k) = scale * images.differences(m, k);
      array(m, kPoints) = of_centre * shift[m];
      for (int k = 0; k < kM; ++k) array(m, kPoints + 1 + k) = noise(m, k);
      predicted[m] = images.centre[m] + shift[m];
    }
    for (int k = 0; k < kPoints; ++k)
      for (int i = 0; i < kStates; ++i) array(kM + i, k) = scale * (sigma(i, k) - mean_[i]);
    const Vec<Scalar, kM> innovation = sensor.residual(reading.mean, predicted);
    const Mat<Scalar, kM + kStates, kM + kStates> root = lower_root(array);
    Mat<Scalar, kM, kM> s_root;
    for (int n = 0; n < kM; ++n)
      for (int m = 0; m < kM; ++m) s_root(m, n) = root(m, n);
    Correction<kM, Scalar> correction;
    correction.innovation = innovation;
    correction.innovation_covariance = product_transposed(s_root, s_root);
    const Cholesky<kM, Scalar> factor(correction.innovation_covariance);
    const Vec<Scalar, kM> whitened = factor.template whiten<1>(innovation);
    rate(correction, whitened, factor);
    Vec<Scalar, kStates> mean = mean_;
    Mat<Scalar, kStates, kStates> next;
    for (int i = 0; i < kStates; ++i) {
      for (int m = 0; m < kM; ++m) mean[i] += root(kM + i, m) * whitened[m];
      for (int k = 0; k < kStates; ++k) next(i, k) = root(kM + i, kM + k);
    }

    MaskOf<Scalar> variances = true;
    for (int m = 0; m < kM; ++m) variances = variances && !(reading.covariance(m, m) < Scalar(0));
    StatusOf<Scalar> status = ok_or(is_finite(array) && is_finite(innovation), Status::kNotFinite);
    status = first_failure(status, ok_or(variances, Status::kNotPositiveDefinite));
    status = first_failure(status, correction.status);
    status = first_failure(status, ok_or(has_finite_moments(mean, next), Status::kNotFinite));
    if (none(ok(status))) return failed_correction<kM, Scalar>(status);
    correction.status = status;
    replace(ok(status), mean, next);
    return correction;
  }

 private:
  friend struct Control;

  /// True when a mean and the squared rows of a root, the variances, are finite.
  static MaskOf<Scalar> has_finite_moments(const Vec<Scalar, kStates>& mean,
                                           const Mat<Scalar, kStates, kStates>& root) noexcept {
    using std::isfinite;
    Scalar squares = Scalar(0);
    for (int k = 0; k < root.size(); ++k) squares += root.data()[k] * root.data()[k];
    return is_finite(mean) && isfinite(squares);
  }

  /// The weighted sum of the differences of all points from the centre.
  template <int Rows, int Points>
  Vec<Scalar, Rows> weighted_sum(const Mat<Scalar, Rows, Points>& differences) const noexcept {
    Vec<Scalar, Rows> sum;
    for (int i = 0; i < Rows; ++i) {
      Scalar of_row = differences(i, 0);
      for (int k = 1; k < Points; ++k) of_row += differences(i, k);
      sum[i] = weight() * of_row;
    }
    return sum;
  }

  void replace(const MaskOf<Scalar>& lanes, const Vec<Scalar, kStates>& mean,
               const Mat<Scalar, kStates, kStates>& root) noexcept {
    assign_where(lanes, mean_, mean);
    assign_where(lanes, root_, root);
  }

  Vec<Scalar, kStates>& mean() noexcept { return mean_; }
  Mat<Scalar, kStates, kPoints> points() const noexcept {
    return sigma_points<Scalar, kStates>(mean_, root_, unscented_.template spread<Scalar>(kStates));
  }
  Scalar weight() const noexcept { return unscented_.template weight<Scalar>(kStates); }
  Scalar centre_root() const noexcept {
    using std::sqrt;
    return sqrt(unscented_.template centre_correction<Scalar>());
  }

  Motion motion_;
  Unscented unscented_;
  Vec<Scalar, kStates> mean_ = Vec<Scalar, kStates>::Zero();
  Mat<Scalar, kStates, kStates> root_ = Mat<Scalar, kStates, kStates>::Identity();
  bool started_ = false;
};

}  // namespace wakeline
