// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>

#include "wakeline/filter/unscented.hpp"
#include "wakeline/simd/flatten.hpp"

namespace wakeline {

/// The unscented Kalman filter. The update draws new sigma points from the predicted belief.
/// Covariances are updated as P - K S Kᵀ, and from the points where the prior is so much wider than
/// the plot that this difference would cancel. Source: S. J. Julier, J. K. Uhlmann, Proc. IEEE 92,
/// 2004; parameters as in `Unscented`.
template <class MotionType, class ScalarType = double>
class Ukf : public Belief<MotionType, ScalarType> {
  using Base = Belief<MotionType, ScalarType>;

 public:
  using Base::kComponents;
  using Base::kStates;
  using typename Base::Motion;
  using typename Base::Scalar;
  static constexpr int kPoints = 2 * kStates;

  explicit Ukf(const MotionType& motion, const Unscented& unscented = {})
      : Base(motion), unscented_(unscented) {
    unscented.template validate<Scalar>(kStates);
  }

  [[nodiscard]] const Unscented& unscented() const noexcept { return unscented_; }

  /// As in `Belief`: the functions that replace the belief.
  template <class StartType>
  requires requires(Base& base, const StartType& belief) { base.start(belief); }
  StatusOf<Scalar> start(const StartType& belief) noexcept {
    rooted_ = false;
    return Base::start(belief);
  }
  StatusOf<Scalar> assign(const Gaussian<kStates, Scalar>& belief) noexcept {
    rooted_ = false;
    return Base::assign(belief);
  }
  [[nodiscard]] Gaussian<kStates, Scalar>& to_assign() noexcept {
    rooted_ = false;
    return Base::to_assign();
  }
  void assign_in(const MaskOf<Scalar>& lanes, const Gaussian<kStates, Scalar>& belief) noexcept {
    rooted_ = false;
    Base::assign_in(lanes, belief);
  }
  void archive(Archive& fields) {
    rooted_ = false;
    Base::archive(fields);
  }

  /// Moments of the moved sigma points, plus Q. Like `correct` not inlined: a call costs little
  /// compared with the sigma points, and every estimator would compile them again.
  [[gnu::noinline]] WAKELINE_FLATTEN StatusOf<Scalar> predict(Scalar dt_s) noexcept {
    if (!this->started_) return Status::kNotStarted;
    const StatusOf<Scalar> forward = check_time_step(dt_s);
    if (none(ok(forward))) return forward;
    const Cholesky<kStates, Scalar>& root = this->root();
    const Vec<Scalar, kStates>& x = this->belief_.mean;
    const MovedPoints<Scalar, kStates> moved(this->motion_, dt_s, x, points(root));
    return take_moments(kStates, moved.centre, moved.differences,
                        process_noise(this->motion_, x, dt_s), forward);
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
    return Ukf(*this).correct(sensor, reading);
  }

  /// Updates the belief with the reading z of a sensor.
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
    check_sensor<Sensor, Ukf>();
    constexpr int kM = Sensor::kMeasurements;
    if (!this->started_) return failed_correction<kM, Scalar>(Status::kNotStarted);
    const Gaussian<kM, Scalar> reading =
        at_prediction<kComponents>(sensor, observed, this->belief_);
    const Cholesky<kStates, Scalar>& root = this->root();
    if (none(root.ok())) return failed_correction<kM, Scalar>(Status::kNotPositiveDefinite);

    // Not const: GCC keeps const matrices in memory.
    MeasuredPoints<kComponents, Sensor, Scalar> images(sensor, this->belief_.mean, points(root));
    Gaussian<kM, Scalar> predicted =
        unscented_moments(unscented_, kStates, images.centre, images.differences);

    Correction<kM, Scalar> correction;
    correction.innovation = sensor.residual(reading.mean, predicted.mean);
    correction.innovation_covariance = predicted.covariance + reading.covariance;
    Cholesky<kM, Scalar> factor(correction.innovation_covariance);
    if (none(factor.ok()))
      return failed_correction<kM, Scalar>(
          factor_failure<Scalar, kM>(correction.innovation_covariance));
    Vec<Scalar, kM> whitened = factor.template whiten<1>(correction.innovation);
    rate(correction, whitened, factor);

    // The points of a pair are equally far from the mean.
    constexpr int kPairs = decltype(images)::kPairs;
    Mat<Scalar, kM, kPairs> apart;
    unroll<kPairs>([&](int k) {
      apart.col(k) = images.differences.col(2 * k) - images.differences.col(2 * k + 1);
    });
    const Scalar w =
        unscented_.template weight<Scalar>(kStates) * unscented_.template spread<Scalar>(kStates);
    Mat<Scalar, kStates, kM> cross;
    unroll<kStates>([&](auto row) {
      constexpr int i = row.value;
      unroll<kM>([&](int m) {
        Scalar sum = root.lower()(i, 0) * apart(m, 0);
        unroll<std::min(i + 1, kPairs) - 1>(
            [&](int k) { sum += root.lower()(i, k + 1) * apart(m, k + 1); });
        cross(i, m) = w * sum;
      });
    });
    Mat<Scalar, kStates, kM> gain = factor.whiten_rows(cross);
    Gaussian<kStates, Scalar> next = this->belief_;
    shift(next.mean, gain, whitened);
    subtract_gram(next.covariance, gain);
    const auto lost = cancels<Scalar, kStates>(this->belief_.covariance, next.covariance);
    if (any(lost)) [[unlikely]]
      assign_where(lost, next.covariance,
                   joseph(sensor, factor.unwhiten_rows(gain), reading.covariance));
    correction.status = take(
        next, first_failure(correction.status, ok_or(root.ok(), Status::kNotPositiveDefinite)));
    return correction;
  }

 protected:
  /// The factor of the covariance, cached from the last step where possible.
  const Cholesky<kStates, Scalar>& root() noexcept {
    if (!std::exchange(rooted_, true)) root_.compute(this->belief_.covariance);
    return root_;
  }

  /// Assigns the moments of moved sigma points, spread for so many states, plus a noise. `root()`
  /// is the factor that the points were drawn with.
  template <int Points>
  [[gnu::always_inline]] StatusOf<Scalar> take_moments(
      int states, const Vec<Scalar, kStates>& centre,
      const Mat<Scalar, kStates, Points>& differences, const Mat<Scalar, kStates, kStates>& noise,
      const StatusOf<Scalar>& so_far) noexcept {
    Gaussian<kStates, Scalar> next = unscented_moments(unscented_, states, centre, differences);
    next.covariance += noise;
    mirror_lower<Scalar, kStates>(next.covariance);
    const auto finite = is_finite(next.mean) && is_finite(next.covariance);
    const StatusOf<Scalar> status =
        first_failure(first_failure(so_far, ok_or(root_.ok(), Status::kNotPositiveDefinite)),
                      ok_or(finite, Status::kNotFinite));
    return take(next, status);
  }

 private:
  /// Assigns a belief where nothing has failed and its covariance has a factor, which is cached.
  StatusOf<Scalar> take(const Gaussian<kStates, Scalar>& next,
                        const StatusOf<Scalar>& so_far) noexcept {
    root_.compute(next.covariance);
    const StatusOf<Scalar> status =
        first_failure(so_far, ok_or(root_.ok(), Status::kNotPositiveDefinite));
    rooted_ = all(ok(status));
    if (rooted_) [[likely]]
      copy(next, this->belief_);
    else
      assign_where(ok(status), this->belief_, next);
    return status;
  }

  /// P - K S Kᵀ from the points, Σ w (e_x - K e_z)(e_x - K e_z)ᵀ + K (S - Σ w e_z e_zᵀ) Kᵀ.
  template <class Sensor, int M>
  [[gnu::cold, gnu::noinline]] Mat<Scalar, kStates, kStates> joseph(
      const Sensor& sensor, const Mat<Scalar, kStates, M>& gain,
      const Mat<Scalar, M, M>& r) const noexcept {
    const Vec<Scalar, kStates>& x = this->belief_.mean;
    const Mat<Scalar, kStates, kPoints> sigma = points(root_);
    const auto differences =
        MeasuredPoints<kComponents, Sensor, Scalar>(sensor, x, sigma).differences;
    const Scalar w = unscented_.template weight<Scalar>(kStates);
    Vec<Scalar, M> shift;
    for (int m = 0; m < M; ++m) {
      Scalar sum = Scalar(0);
      for (int k = 0; k < differences.cols(); ++k) sum += differences(m, k);
      shift[m] = w * sum;
    }
    Mat<Scalar, kStates, kPoints> kept = sigma;
    for (int k = 0; k < kPoints; ++k)
      for (int i = 0; i < kStates; ++i) kept(i, k) -= x[i];
    const auto explained = product(gain, differences);
    for (int k = 0; k < explained.cols(); ++k)
      for (int i = 0; i < kStates; ++i) kept(i, k) -= explained(i, k);
    Mat<Scalar, M, M> rest = r;
    for (int n = 0; n < M; ++n)
      for (int m = 0; m < M; ++m)
        rest(m, n) += unscented_.template centre_correction<Scalar>() * shift[m] * shift[n];
    const Mat<Scalar, kStates, M> pushed = product(gain, rest);
    Mat<Scalar, kStates, kStates> p;
    unroll_lower<kStates>([&](int i, int j) {
      Scalar sum = Scalar(0);
      for (int k = 0; k < kPoints; ++k) sum += kept(i, k) * kept(j, k);
      sum *= w;
      for (int m = 0; m < M; ++m) sum += pushed(i, m) * gain(j, m);
      p(i, j) = p(j, i) = sum;
    });
    return p;
  }

  Mat<Scalar, kStates, kPoints> points(const Cholesky<kStates, Scalar>& root) const noexcept {
    return sigma_points<Scalar, kStates>(this->belief_.mean, root.lower(),
                                         unscented_.template spread<Scalar>(kStates));
  }

  Unscented unscented_;
  Cholesky<kStates, Scalar> root_{Mat<Scalar, kStates, kStates>::Identity()};
  bool rooted_ = false;  ///< true when `root_` belongs to the belief
};

}  // namespace wakeline
