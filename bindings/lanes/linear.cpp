// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The Kalman filter of matrices that are known at run time, of many recordings side by side.
#include <array>
#include <cmath>

#include "job.hpp"
#include "wakeline/catalog/custom_filter.hpp"

namespace wakeline::python {
namespace {

/// The elements of a matrix that are not zero, row by row.
template <int MostRows>
class Sparse {
 public:
  template <class Matrix>
  void set(const Matrix& matrix) noexcept {
    for (int i = 0; i < matrix.rows(); ++i) {
      count_[i] = 0;
      for (int k = 0; k < matrix.cols(); ++k)
        if (matrix(i, k) != 0.0) {
          column_[i][count_[i]] = k;
          value_[i][count_[i]++] = matrix(i, k);
        }
    }
  }

  /// Row i times the vector whose element k is `at(k)`.
  template <class At>
  [[gnu::always_inline]] Lanes row_times(int i, const At& at) const noexcept {
    Lanes sum = 0.0;
    for (int k = 0; k < count_[i]; ++k) sum += Lanes(value_[i][k]) * at(column_[i][k]);
    return sum;
  }

 private:
  int count_[MostRows];
  int column_[MostRows][kMaxStates];
  double value_[MostRows][kMaxStates];
};

/// As `Ekf`, of N states and M numbers that are known at run time.
class LinearFilter {
 public:
  using Scalar = Lanes;
  struct Belief {
    Eigen::Matrix<Lanes, Eigen::Dynamic, 1, 0, kStateRoom, 1> mean;
    Eigen::Matrix<Lanes, Eigen::Dynamic, Eigen::Dynamic, 0, kStateRoom, kStateRoom> covariance;
  };

  /// Begins with the starts of the recordings `first`, `first + 1`, ...
  LinearFilter(const LinearRecordings& recordings, std::size_t first)
      : recordings_(&recordings),
        states_(static_cast<int>(recordings.h.cols())),
        numbers_(static_cast<int>(recordings.h.rows())) {
    const auto start = [&](int k) -> const AnyBelief& {
      return recordings
          .starts[std::min(first + static_cast<std::size_t>(k), recordings.starts.size() - 1)];
    };
    belief_.mean.resize(states_);
    belief_.covariance.resize(states_, states_);
    for (int i = 0; i < states_; ++i)
      belief_.mean[i] = Lanes::of([&](int k) { return start(k).mean[i]; });
    for (int i = 0; i < states_ * states_; ++i)
      belief_.covariance.data()[i] =
          Lanes::of([&](int k) { return start(k).covariance.data()[i]; });
    h_.set(recordings.h);
  }

  StatusOf<Lanes> predict(Lanes dt_s) noexcept {
    const StatusOf<Lanes> forward = check_time_step(dt_s);
    if (none(ok(forward))) return forward;
    if (lane(dt_s, 0) != step_s_) keep(lane(dt_s, 0));
    const auto& p = belief_.covariance;
    Belief next{decltype(Belief::mean)(states_), decltype(Belief::covariance)(states_, states_)};
    Lanes fp[kMaxStates][kMaxStates];
    Lanes sum = 0.0;
    for (int i = 0; i < states_; ++i) {
      next.mean[i] = f_.row_times(i, [&](int k) { return belief_.mean[k]; });
      for (int j = 0; j < states_; ++j) fp[i][j] = f_.row_times(i, [&](int k) { return p(k, j); });
    }
    for (int i = 0; i < states_; ++i) {
      for (int j = 0; j <= i; ++j)
        next.covariance(i, j) = next.covariance(j, i) =
            Lanes(q_(i, j)) + f_.row_times(j, [&](int k) { return fp[i][k]; });
      sum += next.mean[i] + next.covariance(i, i);
    }
    const auto finite = sum - sum == Lanes(0.0);
    take(finite, next);
    return first_failure(forward, ok_or(finite, Status::kNotFinite));
  }

  /// Under a known acceleration, the same in all lanes.
  StatusOf<Lanes> predict(Lanes dt_s, const Vec<Lanes, 2>& acceleration_mps2) noexcept {
    const Vec<double, 2> known(lane(acceleration_mps2[0], 0), lane(acceleration_mps2[1], 0));
    if (!in_range(known)) return Status::kNotFinite;
    const StatusOf<Lanes> status = predict(dt_s);
    const auto shift =
        Control::shift(rows_of(recordings_->layout).components, lane(dt_s, 0), known);
    for (int i = 0; i < states_; ++i)
      belief_.mean[i] += select(ok(status), Lanes(shift[i]), Lanes(0.0));
    return status;
  }

  /// In lanes whose reading is NaN nothing changes.
  template <class Sensor>
  Step<kMostNumbers, Lanes> update(const Sensor&, const Vec<Lanes, kMostNumbers>& z) noexcept {
    const auto& p = belief_.covariance;
    Correction<kMostNumbers, Lanes> correction;
    Lanes s[kMostNumbers][kMostNumbers], gain[kMaxStates][kMostNumbers], whitened[kMostNumbers];
    for (int m = 0; m < numbers_; ++m) {
      correction.innovation[m] = whitened[m] =
          z[m] - h_.row_times(m, [&](int k) { return belief_.mean[k]; });
      for (int i = 0; i < states_; ++i)  // P Hᵀ
        gain[i][m] = h_.row_times(m, [&](int k) { return p(i, k); });
    }
    for (int m = 0; m < numbers_; ++m)
      for (int n = 0; n <= m; ++n)
        s[m][n] = s[n][m] =
            Lanes(recordings_->r(m, n)) + h_.row_times(m, [&](int k) { return gain[k][n]; });
    const RuntimeCholeskyOf<Lanes> factor(numbers_, [&](int i, int j) { return s[i][j]; });
    factor.whiten(whitened);
    correction.nis = Lanes(0.0);
    correction.peak = Lanes(1.0);
    for (int m = 0; m < numbers_; ++m) {
      correction.nis += whitened[m] * whitened[m];
      correction.peak *= factor.inverse_diagonal[m] / kRootOf2Pi;
    }
    auto sound = factor.ok && correction.nis - correction.nis == Lanes(0.0);
    Belief next = belief_;
    for (int i = 0; i < states_; ++i) {
      factor.whiten(gain[i]);
      for (int m = 0; m < numbers_; ++m) next.mean[i] += gain[i][m] * whitened[m];
      for (int j = 0; j <= i; ++j) {
        Lanes element = p(i, j);
        for (int m = 0; m < numbers_; ++m) element -= gain[i][m] * gain[j][m];
        next.covariance(i, j) = next.covariance(j, i) = element;
      }
      sound = sound && next.covariance(i, i) > Lanes(1e-8) * p(i, i);
    }
    correction.status = ok_or(sound, Status::kNotFinite);
    take(sound, next);
    Step<kMostNumbers, Lanes> step = correction.scored();
    if (!all(sound || z[0] != z[0])) [[unlikely]]
      correct_alone(sound, z, step);
    return step;
  }

  [[nodiscard]] const Belief& estimate() const noexcept { return belief_; }

 private:
  void keep(double dt_s) noexcept {
    AnyBelief::Covariance f;
    recordings_->filter.matrices(dt_s, f, q_);
    f_.set(f);
    step_s_ = dt_s;
  }

  void take(const MaskOf<Lanes>& lanes, const Belief& next) noexcept {
    if (all(lanes)) [[likely]] {
      belief_ = next;
      return;
    }
    for (int i = 0; i < states_; ++i)
      belief_.mean[i] = select(lanes, next.mean[i], belief_.mean[i]);
    for (int i = 0; i < states_ * states_; ++i)
      belief_.covariance.data()[i] =
          select(lanes, next.covariance.data()[i], belief_.covariance.data()[i]);
  }

  /// Each of the other lanes that has a reading, by the filter itself.
  [[gnu::cold, gnu::noinline]] void correct_alone(const MaskOf<Lanes>& done,
                                                  const Vec<Lanes, kMostNumbers>& z,
                                                  Step<kMostNumbers, Lanes>& step) noexcept {
    for (int k = 0; k < kLanesOf<Lanes>; ++k) {
      if (done[k] || z[0][k] != z[0][k]) continue;
      AnyBelief belief{recordings_->layout, AnyBelief::Mean(states_),
                       AnyBelief::Covariance(states_, states_)};
      for (int i = 0; i < states_; ++i) belief.mean[i] = belief_.mean[i][k];
      for (int i = 0; i < states_ * states_; ++i)
        belief.covariance.data()[i] = belief_.covariance.data()[i][k];
      Vec<double, kMostNumbers> reading;
      for (int m = 0; m < kMostNumbers; ++m) reading[m] = z[m][k];
      const Step<kMostNumbers> one = recordings_->filter.update(belief, reading);
      for (int i = 0; i < states_; ++i) belief_.mean[i].set(k, belief.mean[i]);
      for (int i = 0; i < states_ * states_; ++i)
        belief_.covariance.data()[i].set(k, belief.covariance.data()[i]);
      for (int m = 0; m < numbers_; ++m) step.innovation[m].set(k, one.innovation[m]);
      step.nis.set(k, one.nis);
      step.log_likelihood.set(k, one.log_likelihood);
      step.status = select(mask_of_bits<Lanes>(1u << k), StatusOf<Lanes>(one.status), step.status);
    }
  }

  const LinearRecordings* recordings_;
  int states_, numbers_;
  Belief belief_;
  Sparse<kMaxStates> f_;
  Sparse<kMostNumbers> h_;
  AnyBelief::Covariance q_;
  double step_s_ = -1.0;
};

/// Its sensor, as a run asks for it.
struct LinearReadings {
  static constexpr int kMeasurements = kMostNumbers;
  int numbers;
  [[nodiscard]] int numbers_in(const Vec<Lanes, kMostNumbers>&) const noexcept { return numbers; }
};

}  // namespace

void run_linear(const LinearRecordings& recordings) {
  run_batch([&](std::size_t first) { return LinearFilter(recordings, first); },
            LinearReadings{static_cast<int>(recordings.h.rows())}, recordings.in, recordings.out,
            Threads{recordings.threads});
}

}  // namespace wakeline::python
