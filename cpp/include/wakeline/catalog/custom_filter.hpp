// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Steps of filters whose motion model or sensor is made at run time: the equations of `Ekf` and
// `Ukf` for vectors whose size is known at run time.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "wakeline/catalog/belief.hpp"
#include "wakeline/catalog/custom_motion.hpp"
#include "wakeline/catalog/custom_sensor.hpp"
#include "wakeline/core/archive.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/filter/control.hpp"
#include "wakeline/filter/rts_smoother.hpp"
#include "wakeline/filter/unscented.hpp"

namespace wakeline {

/// `Cholesky` of up to `kMaxStates` rows: `at(i, j)` is an element of the lower triangle.
template <class Scalar>
struct RuntimeCholeskyOf {
  int size = 0;
  MaskOf<Scalar> ok = false;
  Scalar lower[kMaxStates][kMaxStates];
  Scalar inverse_diagonal[kMaxStates];

  template <class At>
  RuntimeCholeskyOf(int rows, const At& at) noexcept : size(rows), ok(true) {
    using std::sqrt;
    for (int j = 0; j < size; ++j) {
      Scalar pivot = at(j, j);
      for (int k = 0; k < j; ++k) pivot -= lower[j][k] * lower[j][k];
      ok = ok && pivot > Scalar(0) && pivot <= Scalar(std::numeric_limits<double>::max());
      lower[j][j] = sqrt(pivot);
      inverse_diagonal[j] = Scalar(1) / lower[j][j];
      for (int i = j + 1; i < size; ++i) {
        Scalar sum = at(i, j);
        for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
        lower[i][j] = sum * inverse_diagonal[j];
      }
    }
  }

  /// v = L⁻¹ v.
  void whiten(Scalar* v) const noexcept {
    for (int i = 0; i < size; ++i) {
      for (int k = 0; k < i; ++k) v[i] -= lower[i][k] * v[k];
      v[i] *= inverse_diagonal[i];
    }
  }

  /// v = L⁻ᵀ v: of a row vᵀ, vᵀ L⁻¹.
  void unwhiten(Scalar* v) const noexcept {
    for (int i = size - 1; i >= 0; --i) {
      for (int k = i + 1; k < size; ++k) v[i] -= lower[k][i] * v[k];
      v[i] *= inverse_diagonal[i];
    }
  }
};

using RuntimeCholesky = RuntimeCholeskyOf<double>;

/// The numbers that there are of a reading, beside a belief N(x, P): innovation v, its covariance S
/// and the covariance of state and innovation, P Hᵀ.
struct RuntimeInnovation {
  Status status = Status::kOk;
  int count = 0;
  int number[kMostNumbers];  ///< of the sensor's
  double v[kMostNumbers];
  double s[kMostNumbers][kMostNumbers];
  double ph[kMaxStates][kMostNumbers];
  double h[kMostNumbers][kMaxStates];
  double r[kMostNumbers][kMostNumbers];  ///< S - H P Hᵀ

  /// By the derivatives at the mean, or by sigma points where `unscented` is not null.
  template <class Sensor, int M>
  RuntimeInnovation(const Sensor& sensor, const Gaussian<M>& observed, const Unscented* unscented,
                    const AnyBelief& belief) noexcept {
    const StateRows reads = sensor.reads();
    const StateRows& held = rows_of(belief.layout);
    int row[kMaxStates];
    AnyBelief::Mean x(reads.states);
    for (int k = 0; k < reads.states; ++k) {
      row[k] = held.row_of(reads.components[static_cast<std::size_t>(k)]);
      if (row[k] < 0) {
        status = Status::kMissed;
        return;
      }
      x[k] = belief.mean[row[k]];
    }
    AnyBelief::Covariance p(reads.states, reads.states);
    for (int j = 0; j < reads.states; ++j)
      for (int i = 0; i < reads.states; ++i) p(i, j) = belief.covariance(row[i], row[j]);

    const auto centre = sensor.measure(x);
    auto z = centre;
    for (int m = 0; m < z.size(); ++m) {
      const bool known = !std::isinf(observed.covariance(m, m));
      if (known) z[m] = observed.mean[m];
      if (known) number[count++] = m;
    }
    if (count == 0) {
      status = Status::kMissed;
      return;
    }
    const auto noise = sensor.noise(z, x, p);
    for (int m = 0; m < count; ++m)
      for (int n = 0; n < count; ++n) s[m][n] = r[m][n] = noise(number[m], number[n]);
    if (unscented == nullptr)
      linearise(sensor, z, observed.covariance, x, p, row, centre, belief);
    else
      spread_points(sensor, z, x, row, centre, *unscented, belief);
  }

 private:
  template <class Sensor, class Reading, int M>
  void linearise(const Sensor& sensor, const Reading& z, const Mat<double, M, M>& observed_r,
                 const AnyBelief::Mean& x, const AnyBelief::Covariance& p, const int* row,
                 const Reading& centre, const AnyBelief& belief) noexcept {
    AnyBelief::Mean at = x;
    const bool moved = sensor.moves(at, p, z, observed_r);
    const auto innovation = sensor.residual(z, moved ? sensor.measure(at) : centre);
    const auto jacobian = sensor.jacobian(at);
    const auto reads = static_cast<int>(x.size());
    const int states = belief.states();
    for (int m = 0; m < count; ++m) {
      v[m] = innovation[number[m]];
      for (int i = 0; i < states; ++i) h[m][i] = 0.0;
      for (int k = 0; k < reads; ++k) {
        h[m][row[k]] = jacobian(number[m], k);
        if (moved) v[m] += h[m][row[k]] * (at[k] - x[k]);
      }
      for (int i = 0; i < states; ++i) {
        ph[i][m] = 0.0;
        for (int k = 0; k < reads; ++k) ph[i][m] += h[m][row[k]] * belief.covariance(i, row[k]);
      }
    }
    for (int m = 0; m < count; ++m)
      for (int n = 0; n <= m; ++n) {
        for (int k = 0; k < reads; ++k) s[m][n] += h[m][row[k]] * ph[row[k]][n];
        s[n][m] = s[m][n];
      }
  }

  template <class Sensor, class Reading>
  void spread_points(const Sensor& sensor, const Reading& z, const AnyBelief::Mean& x,
                     const int* row, const Reading& centre, const Unscented& unscented,
                     const AnyBelief& belief) noexcept {
    const int states = belief.states();
    const RuntimeCholesky root(states, [&](int i, int j) { return belief.covariance(i, j); });
    if (!root.ok) {
      status = Status::kNotPositiveDefinite;
      return;
    }
    const auto spread = unscented.spread<double>(states), weight = unscented.weight<double>(states);
    Reading shift = z;
    shift.setZero();
    double slope[kMostNumbers][kMaxStates];  // H L
    AnyBelief::Mean ahead = x, behind = x;
    for (int k = 0; k < states; ++k) {
      for (int i = 0; i < x.size(); ++i) {
        const double offset = row[i] < k ? 0.0 : spread * root.lower[row[i]][k];
        ahead[i] = x[i] + offset;
        behind[i] = x[i] - offset;
      }
      const auto plus = sensor.residual(sensor.measure(ahead), centre);
      const auto minus = sensor.residual(sensor.measure(behind), centre);
      for (int m = 0; m < z.size(); ++m) shift[m] += weight * (plus[m] + minus[m]);
      for (int m = 0; m < count; ++m) {
        const int a = number[m];
        slope[m][k] = (plus[a] - minus[a]) / (2.0 * spread);
        for (int n = 0; n < count; ++n) {
          const int b = number[n];
          s[m][n] += weight * (plus[a] * plus[b] + minus[a] * minus[b]);
        }
      }
    }
    const auto innovation = sensor.residual(z, Reading(centre + shift));
    const auto correction = unscented.centre_correction<double>();
    for (int m = 0; m < count; ++m) {
      v[m] = innovation[number[m]];
      for (int n = 0; n < count; ++n) s[m][n] += correction * shift[number[m]] * shift[number[n]];
      for (int i = 0; i < states; ++i) {
        ph[i][m] = 0.0;
        for (int k = 0; k <= i; ++k) ph[i][m] += root.lower[i][k] * slope[m][k];
      }
    }
    for (int m = 0; m < count; ++m) {
      for (int n = 0; n < count; ++n) {
        r[m][n] = s[m][n];
        for (int k = 0; k < states; ++k) r[m][n] -= slope[m][k] * slope[n][k];
      }
      for (int k = 0; k < states; ++k) h[m][k] = slope[m][k];
    }
    for (int m = 0; m < count; ++m) root.unwhiten(h[m]);
  }
};

/// Updates a belief by an innovation. The correction has zeros and ones in the rows of missing
/// numbers.
template <class BeliefType>
[[gnu::noinline]] Correction<kMostNumbers> corrected(const RuntimeInnovation& one,
                                                     BeliefType& belief) noexcept {
  Correction<kMostNumbers> correction;
  correction.status = one.status;
  if (one.status != Status::kOk) return correction;
  const int count = one.count, states = belief.states();
  for (int m = 0; m < count; ++m) {
    correction.innovation[one.number[m]] = one.v[m];
    for (int n = 0; n < count; ++n)
      correction.innovation_covariance(one.number[m], one.number[n]) = one.s[m][n];
  }
  const RuntimeCholesky factor(count, [&](int i, int j) { return one.s[i][j]; });
  double whitened[kMostNumbers];
  std::copy_n(one.v, count, whitened);
  factor.whiten(whitened);
  double nis = 0.0, peak = 1.0;
  for (int m = 0; m < count; ++m) {
    nis += whitened[m] * whitened[m];
    peak *= factor.inverse_diagonal[m] / kRootOf2Pi;
  }
  if (!factor.ok || !std::isfinite(nis)) {
    correction.status = is_finite(correction.innovation_covariance) && std::isfinite(nis)
                            ? Status::kNotPositiveDefinite
                            : Status::kNotFinite;
    return correction;
  }
  correction.nis = nis;
  correction.peak = peak;

  double gain[kMaxStates][kMostNumbers];  // P Hᵀ L⁻ᵀ
  double* const p = belief.covariance.data();
  bool lost = false;
  for (int i = 0; i < states; ++i) {
    std::copy_n(one.ph[i], count, gain[i]);
    factor.whiten(gain[i]);
    double variance = p[(states + 1) * i];
    for (int m = 0; m < count; ++m) variance -= gain[i][m] * gain[i][m];
    lost = lost || !(variance > 1e-8 * p[(states + 1) * i]);
  }
  if (lost) [[unlikely]] {
    // (I - K H) P (I - K H)ᵀ + K R Kᵀ, where P - K S Kᵀ has lost its digits.
    BeliefType next = belief;
    auto rest = next.covariance;
    rest.setIdentity();
    double k[kMaxStates][kMostNumbers];
    for (int i = 0; i < states; ++i) {
      std::copy_n(gain[i], count, k[i]);
      factor.unwhiten(k[i]);
      for (int j = 0; j < states; ++j)
        for (int m = 0; m < count; ++m) rest(i, j) -= k[i][m] * one.h[m][j];
    }
    for (int i = 0; i < states; ++i)
      for (int j = 0; j <= i; ++j) {
        double sum = 0.0;
        for (int a = 0; a < states; ++a)
          for (int b = 0; b < states; ++b) sum += rest(i, a) * belief.covariance(a, b) * rest(j, b);
        for (int m = 0; m < count; ++m)
          for (int n = 0; n < count; ++n) sum += k[i][m] * one.r[m][n] * k[j][n];
        next.covariance(i, j) = next.covariance(j, i) = sum;
      }
    for (int i = 0; i < states; ++i)
      if (!(next.covariance(i, i) >= 0.0)) correction.status = Status::kNotPositiveDefinite;
    if (correction.status != Status::kOk) return correction;
    belief.covariance = next.covariance;
  } else {
    for (int j = 0; j < states; ++j)
      for (int i = j; i < states; ++i) {
        double element = p[states * j + i];
        for (int m = 0; m < count; ++m) element -= gain[i][m] * gain[j][m];
        p[states * j + i] = p[states * i + j] = element;
      }
  }
  for (int i = 0; i < states; ++i)
    for (int m = 0; m < count; ++m) belief.mean[i] += gain[i][m] * whitened[m];
  return correction;
}

/// A sensor of the catalogue that has observed a reading, as `RuntimeInnovation` asks for it.
template <class Sensor>
struct Observing {
  using Reading = Vec<double, Sensor::kMeasurements>;
  using Read = Vec<double, kReadsOf<Sensor>>;
  const Sensor& sensor;
  const Mat<double, Sensor::kMeasurements, Sensor::kMeasurements>& r;

  static constexpr StateRows reads() noexcept { return StateRows::of(Sensor::kReads); }
  Reading measure(const AnyBelief::Mean& x) const noexcept { return sensor.measure(Read(x)); }
  auto jacobian(const AnyBelief::Mean& x) const noexcept { return sensor.jacobian(Read(x)); }
  Reading residual(const Reading& a, const Reading& b) const noexcept {
    return sensor.residual(a, b);
  }
  const auto& noise(const Reading&, const AnyBelief::Mean&,
                    const AnyBelief::Covariance&) const noexcept {
    return r;
  }
  bool moves(
      AnyBelief::Mean& x, const AnyBelief::Covariance& p, const Reading& z,
      const Mat<double, Sensor::kMeasurements, Sensor::kMeasurements>& observed_r) const noexcept {
    if constexpr (BendingSensor<Sensor>) {
      const Read at = x;
      if (!sensor.bends(Gaussian<kReadsOf<Sensor>>{at, p}, observed_r)) return false;
      x = sensor.moved_to(at, z);
      return true;
    } else {
      return false;
    }
  }
};

/// An extended or unscented Kalman filter over a motion model that is made at run time. That of a
/// linear model is the Kalman filter, whose moments the unscented transform gives too.
template <class MotionType>
class RuntimeFilter {
 public:
  using Motion = MotionType;
  using Matrix = AnyBelief::Covariance;
  /// A motion linearised about a belief, with states at rest to fill up `kMaxStates`.
  using Linearised = LinearisedMotion<kMaxStates, double>;

  /// An extended one; with `unscented` an unscented one. Throws `std::invalid_argument` when these
  /// parameters are invalid.
  explicit RuntimeFilter(std::shared_ptr<const Motion> motion,
                         const std::optional<Unscented>& unscented = std::nullopt)
      : motion_(std::move(motion)), unscented_(unscented), memory_(std::make_unique<Memory>()) {
    const int states = motion_->states();
    if (unscented_) unscented_->validate(states);
    memory_->belief = {motion_->layout(), AnyBelief::Mean::Zero(states),
                       Matrix::Identity(states, states)};
    memory_->f = memory_->q = Matrix::Zero(states, states);
  }

  RuntimeFilter(const RuntimeFilter& other)
      : motion_(other.motion_),
        unscented_(other.unscented_),
        memory_(std::make_unique<Memory>(*other.memory_)) {}
  RuntimeFilter(RuntimeFilter&&) noexcept = default;
  RuntimeFilter& operator=(const RuntimeFilter& other) {
    if (memory_)
      *memory_ = *other.memory_;  // without the heap
    else
      memory_ = std::make_unique<Memory>(*other.memory_);
    motion_ = other.motion_;
    unscented_ = other.unscented_;
    return *this;
  }
  RuntimeFilter& operator=(RuntimeFilter&&) noexcept = default;
  ~RuntimeFilter() = default;

  /// Starts with a belief over the state of the motion or over `[x, vx, y, vy]`; rejects one that
  /// is not finite or whose covariance is not symmetric positive definite.
  Status start(const AnyBelief& given) noexcept {
    if (given.layout != motion_->layout()) {
      const bool lifts =
          given.layout == StateLayout::kKinematics && has_kinematics(motion_->layout());
      return lifts ? start(given.fixed<4>()) : Status::kNotStarted;
    }
    const Status status = check(filled_up(given));
    return status == Status::kOk ? assign(given) : status;
  }
  Status start(const Gaussian<4>& kinematics) noexcept {
    const StateRows& rows = rows_of(motion_->layout());
    const int states = rows.states;
    AnyBelief lifted{motion_->layout(), AnyBelief::Mean::Zero(states),
                     Matrix::Zero(states, states)};
    const auto& row = rows_between(StateLayout::kKinematics, motion_->layout());
    for (int i = 0; i < states; ++i) {
      const int a = row[static_cast<std::size_t>(i)];
      if (a < 0) {
        lifted.covariance(i, i) =
            motion_->prior_variance(rows.components[static_cast<std::size_t>(i)]);
        continue;
      }
      lifted.mean[i] = kinematics.mean[a];
      for (int j = 0; j < states; ++j)
        if (const int b = row[static_cast<std::size_t>(j)]; b >= 0)
          lifted.covariance(i, j) = kinematics.covariance(a, b);
    }
    return start(lifted);
  }

  /// Replaces the belief, unchecked.
  Status assign(const AnyBelief& belief) noexcept {
    memory_->belief = belief;
    memory_->started = true;
    return Status::kOk;
  }

  Status predict(double dt_s) noexcept {
    if (!memory_->started) return Status::kNotStarted;
    if (const Status forward = check_time_step(dt_s); forward != Status::kOk) return forward;
    if (motion_->linear()) return predict_linear(dt_s);
    return unscented_ ? predict_points(dt_s) : predict_line(dt_s);
  }

  /// The same under a known acceleration, [north, east]; see `Control`.
  Status predict(double dt_s, const Vec<double, 2>& acceleration_mps2) noexcept {
    if (!in_range(acceleration_mps2)) return Status::kNotFinite;
    const Status status = predict(dt_s);
    if (status == Status::kOk) memory_->belief.mean += shift(dt_s, acceleration_mps2);
    return status;
  }

  /// Updates the belief with an observed reading; the likelihood in two factors.
  Correction<kMostNumbers> correct(const RuntimeSensor& sensor,
                                   const Gaussian<kMostNumbers>& reading) noexcept {
    if (!memory_->started) return {};
    return corrected(RuntimeInnovation(sensor, reading, unscented(), memory_->belief),
                     memory_->belief);
  }

  /// The same of a sensor of the catalogue.
  template <class Sensor>
  requires(DeclaresSizes<Sensor>) Correction<Sensor::kMeasurements> correct(
      const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& observed)
  noexcept {
    constexpr int kM = Sensor::kMeasurements;
    constexpr auto kWanted = StateRows::of(Sensor::kReads);
    const StateRows& rows = rows_of(motion_->layout());
    Gaussian<kReadsOf<Sensor>> read;
    for (int i = 0; i < kWanted.states; ++i) {
      const int a = rows.row_of(kWanted.components[static_cast<std::size_t>(i)]);
      if (a < 0) return {.status = Status::kMissed};
      read.mean[i] = memory_->belief.mean[a];
      for (int j = 0; j < kWanted.states; ++j) {
        const int b = rows.row_of(kWanted.components[static_cast<std::size_t>(j)]);
        read.covariance(i, j) = b < 0 ? 0.0 : memory_->belief.covariance(a, b);
      }
    }
    const auto correct_by = [&](const Gaussian<kM>& reading) -> Correction<kM> {
      const auto all = corrected(RuntimeInnovation(Observing<Sensor>{sensor, reading.covariance},
                                                   reading, unscented(), memory_->belief),
                                 memory_->belief);
      return {all.status, all.innovation.template head<kM>(),
              all.innovation_covariance.template topLeftCorner<kM, kM>(), all.nis, all.peak};
    };
    if constexpr (SensorAtPrediction<Sensor>)
      return correct_by(sensor.at_prediction(observed, read));
    else
      return correct_by(observed);
  }

  /// Turns a filtered belief into a smoothed one by the smoothed belief `later`, `dt_s` after it;
  /// see `smooth_step`. Under a known acceleration where one is given.
  Status smooth(AnyBelief& belief, const AnyBelief& later, double dt_s,
                std::span<const Vec<double, 2>> acceleration_mps2) const noexcept {
    if (const Status forward = check_time_step(dt_s); forward != Status::kOk) return forward;
    Linearised motion = linearised(belief, dt_s);
    if (motion.status != Status::kOk) return motion.status;
    const int states = belief.states();
    if (!acceleration_mps2.empty()) motion.mean.head(states) += shift(dt_s, acceleration_mps2[0]);
    Gaussian<kMaxStates> smoothed = filled_up(belief);
    const Status status = smooth_step(motion, filled_up(later), smoothed);
    if (status == Status::kOk) belief = cut_to(belief.layout, smoothed);
    return status;
  }

  void archive(Archive& fields) {
    fields(memory_->belief.mean);
    fields(memory_->belief.covariance);
    fields(memory_->started);
  }

  [[nodiscard]] const AnyBelief& estimate() const noexcept { return memory_->belief; }
  [[nodiscard]] bool started() const noexcept { return memory_->started; }
  [[nodiscard]] const std::shared_ptr<const Motion>& motion() const noexcept { return motion_; }
  /// Null for an extended filter.
  [[nodiscard]] const Unscented* unscented() const noexcept {
    return unscented_ ? &*unscented_ : nullptr;
  }

 private:
  /// On the heap, so that a `std::variant` of filters is no larger than its other filters.
  struct Memory {
    AnyBelief belief;
    Matrix f, q;  ///< of a linear model, over the last step
    double step_s = -1.0;
    bool started = false;
  };

  /// x and P moved by F and Q of N states.
  template <int N>
  static void move(const double* f, const double* q, const double* p, double* next) noexcept {
    double fp[N * N];
    for (int j = 0; j < N; ++j)
      for (int i = 0; i < N; ++i) {
        double sum = f[i] * p[N * j];
        for (int k = 1; k < N; ++k) sum += f[N * k + i] * p[N * j + k];
        fp[N * j + i] = sum;
      }
    for (int j = 0; j < N; ++j)
      for (int i = j; i < N; ++i) {
        double sum = fp[i] * f[j];
        for (int k = 1; k < N; ++k) sum += fp[N * k + i] * f[N * k + j];
        next[N * j + i] = next[N * i + j] = q[N * j + i] + sum;
      }
  }

  /// F P Fᵀ + Q.
  static void move(const Matrix& f, const Matrix& q, const Matrix& p, double* next) noexcept {
    [&]<int... Less>(std::integer_sequence<int, Less...>) {
      (void)((p.rows() == Less + 1 && (move<Less + 1>(f.data(), q.data(), p.data(), next), true)) ||
             ...);
    }
    (std::make_integer_sequence<int, kMaxStates>{});
  }

  /// F and Q of a linear model over a step.
  void keep(double dt_s) noexcept {
    if (dt_s == memory_->step_s) return;
    const AnyBelief::Mean& x = memory_->belief.mean;
    memory_->f = motion_->jacobian(x, dt_s);
    memory_->q = motion_->process_noise(x, dt_s);
    memory_->step_s = is_finite(memory_->f) && is_finite(memory_->q) ? dt_s : -1.0;
  }

  Status predict_linear(double dt_s) noexcept {
    keep(dt_s);
    return take_moved(times(memory_->f, memory_->belief.mean), memory_->f, memory_->q);
  }

  Status predict_line(double dt_s) noexcept {
    const AnyBelief::Mean& x = memory_->belief.mean;
    return take_moved(motion_->transition(x, dt_s), motion_->jacobian(x, dt_s),
                      motion_->process_noise(x, dt_s));
  }

  static AnyBelief::Mean times(const Matrix& f, const AnyBelief::Mean& x) noexcept {
    AnyBelief::Mean product(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      product[i] = f(i, 0) * x[0];
      for (Eigen::Index k = 1; k < x.size(); ++k) product[i] += f(i, k) * x[k];
    }
    return product;
  }

  /// Assigns x and F P Fᵀ + Q as the belief, where they are finite.
  Status take_moved(const AnyBelief::Mean& x, const Matrix& f, const Matrix& q) noexcept {
    AnyBelief& belief = memory_->belief;
    const int states = belief.states();
    double next[kMaxStates * kMaxStates];
    move(f, q, belief.covariance, next);
    double sum = 0.0;
    for (int i = 0; i < states; ++i) sum += x[i] + next[(states + 1) * i];
    if (!std::isfinite(sum)) return Status::kNotFinite;
    std::copy_n(x.data(), states, belief.mean.data());
    std::copy_n(next, states * states, belief.covariance.data());
    return Status::kOk;
  }

  static RuntimeCholesky root_of(const AnyBelief& belief) noexcept {
    return {belief.states(), [&](int i, int j) { return belief.covariance(i, j); }};
  }

  /// Sigma points after the motion, as sums and differences of the images of each pair relative to
  /// that of the centre.
  struct Points {
    AnyBelief::Mean centre, mean;
    Matrix sum, difference;

    Points(const Motion& motion, const Unscented& unscented, const RuntimeCholesky& root,
           const AnyBelief::Mean& x, double dt_s) noexcept
        : centre(motion.transition(x, dt_s)), mean(centre) {
      const auto states = static_cast<int>(x.size());
      const auto spread = unscented.spread<double>(states);
      sum.resize(states, states);
      difference.resize(states, states);
      AnyBelief::Mean ahead = x, behind = x;
      for (int k = 0; k < states; ++k) {
        for (int i = 0; i < states; ++i) {
          const double offset = i < k ? 0.0 : spread * root.lower[i][k];
          ahead[i] = x[i] + offset;
          behind[i] = x[i] - offset;
        }
        const AnyBelief::Mean plus = motion.transition(ahead, dt_s);
        const AnyBelief::Mean minus = motion.transition(behind, dt_s);
        for (int i = 0; i < states; ++i) {
          sum(i, k) = (plus[i] - centre[i]) + (minus[i] - centre[i]);
          difference(i, k) = plus[i] - minus[i];
          mean[i] += unscented.weight<double>(states) * sum(i, k);
        }
      }
    }
  };

  /// Σ w (e+ e+ᵀ + e- e-ᵀ) = w/2 Σ (sum sumᵀ + difference differenceᵀ), as in `unscented_moments`.
  Status predict_points(double dt_s) noexcept {
    AnyBelief& belief = memory_->belief;
    const RuntimeCholesky root = root_of(belief);
    if (!root.ok) return Status::kNotPositiveDefinite;
    const Points points(*motion_, *unscented_, root, belief.mean, dt_s);
    AnyBelief next{belief.layout, points.mean, motion_->process_noise(belief.mean, dt_s)};
    add_spread(points, next, true);
    if (!is_finite(next.mean) || !is_finite(next.covariance)) return Status::kNotFinite;
    if (!root_of(next).ok) return Status::kNotPositiveDefinite;
    belief = next;
    return Status::kOk;
  }

  /// Adds the spread of points to a covariance: all, or only what a line through them leaves.
  void add_spread(const Points& points, AnyBelief& to, bool all) const noexcept {
    const int states = to.states();
    const double half = unscented_->weight<double>(states) / 2.0;
    const auto correction = unscented_->centre_correction<double>();
    for (int i = 0; i < states; ++i)
      for (int j = 0; j <= i; ++j) {
        double sum = 0.0;
        for (int k = 0; k < states; ++k) {
          sum += points.sum(i, k) * points.sum(j, k);
          if (all) sum += points.difference(i, k) * points.difference(j, k);
        }
        to.covariance(i, j) += half * sum + correction * (points.mean[i] - points.centre[i]) *
                                                (points.mean[j] - points.centre[j]);
        to.covariance(j, i) = to.covariance(i, j);
      }
  }

  /// As `linearised` of a motion known at compile time.
  [[nodiscard]] Linearised linearised(const AnyBelief& belief, double dt_s) const noexcept {
    const int states = belief.states();
    Linearised result{.mean = Vec<double, kMaxStates>::Zero(),
                      .f = Mat<double, kMaxStates, kMaxStates>::Identity(),
                      .q = Mat<double, kMaxStates, kMaxStates>::Identity()};
    AnyBelief moved{belief.layout, belief.mean, motion_->process_noise(belief.mean, dt_s)};
    Matrix f;
    if (motion_->linear()) {
      f = motion_->jacobian(belief.mean, dt_s);
      moved.mean = times(f, belief.mean);
    } else if (unscented_) {
      const RuntimeCholesky root = root_of(belief);
      if (!root.ok) {
        result.status = Status::kNotPositiveDefinite;
        return result;
      }
      const Points points(*motion_, *unscented_, root, belief.mean, dt_s);
      moved.mean = points.mean;
      add_spread(points, moved, false);
      f = Matrix(states, states);
      const double scale = 1.0 / (2.0 * unscented_->spread<double>(states));
      for (int i = 0; i < states; ++i) {
        double slope[kMaxStates];
        for (int k = 0; k < states; ++k) slope[k] = scale * points.difference(i, k);
        root.unwhiten(slope);
        for (int k = 0; k < states; ++k) f(i, k) = slope[k];
      }
    } else {
      moved.mean = motion_->transition(belief.mean, dt_s);
      f = motion_->jacobian(belief.mean, dt_s);
    }
    result.mean.head(states) = moved.mean;
    result.f.topLeftCorner(states, states) = f;
    result.q.topLeftCorner(states, states) = moved.covariance;
    return result;
  }

  /// G u.
  [[nodiscard]] AnyBelief::Mean shift(double dt_s,
                                      const Vec<double, 2>& acceleration_mps2) const noexcept {
    const StateRows& rows = rows_of(motion_->layout());
    return Control::shift(rows.components, dt_s, acceleration_mps2).head(rows.states);
  }

  std::shared_ptr<const Motion> motion_;
  std::optional<Unscented> unscented_;
  std::unique_ptr<Memory> memory_;
};

/// One over a `CustomMotion`.
using CustomFilter = RuntimeFilter<CustomMotion>;

}  // namespace wakeline
