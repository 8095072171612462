// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "wakeline/core/require.hpp"
#include "wakeline/filter/adaptive_alpha_beta.hpp"
#include "wakeline/filter/smoother.hpp"

namespace wakeline {

/// (21): x^ += alpha (x - x^), independent of the time step. The rate is 0, the forecast the value.
template <class Residual = Linear, class ScalarType = double>
class ExponentialSmoother {
 public:
  using Scalar = ScalarType;

  /// Throws `std::invalid_argument` unless 0 < alpha <= 1.
  explicit ExponentialSmoother(double alpha = 0.5) : alpha_(Scalar(alpha)) {
    require(alpha > 0.0 && alpha <= 1.0, "alpha", "above 0 and at most 1", alpha);
  }

  Status update(Scalar dt_s, Scalar reading) noexcept {
    if (const Status status = check_reading(!started_, dt_s, reading); status != Status::kOk)
      return status;
    const Scalar correction =
        started_ ? alpha_ * Residual::difference(reading, value_) : reading - value_;
    value_ = Residual::normal(value_ + correction);
    started_ = true;
    return Status::kOk;
  }

  [[nodiscard]] Scalar value() const noexcept { return value_; }
  [[nodiscard]] Scalar rate() const noexcept { return Scalar(0); }
  [[nodiscard]] Scalar forecast(Scalar) const noexcept { return value_; }
  [[nodiscard]] Scalar alpha() const noexcept { return alpha_; }

  /// Saves or restores the state; invalid bytes change nothing.
  void archive(Archive& fields) {
    ExponentialSmoother read = *this;
    fields(read.value_);
    fields(read.started_);
    if (fields.ok()) *this = read;
  }

 private:
  Scalar alpha_;
  Scalar value_ = Scalar(0);
  bool started_ = false;
};

/// (23): exponential smoothing with alpha estimated over a sliding window of the last readings,
///     alpha = sum((l_i - l_i-1)(x_i - l_i-1)) / sum((x_i - l_i-1)²)  within 0 .. 1,
/// l the line (26), (27) through the window: the part of an innovation that the line follows.
/// (The source computes the sum from the smoother's own output, which returns the alpha just used.)
template <class Residual = Linear, int Window = 5, class ScalarType = double>
class AdaptiveExponentialSmoother {
 public:
  static_assert(Window >= 3, "wakeline: alpha needs three readings");
  using Scalar = ScalarType;

  Status update(Scalar dt_s, Scalar reading) noexcept {
    const bool first = readings_.size() == 0;
    const Status status = readings_.add(dt_s, reading);
    if (status != Status::kOk) return status;
    alpha_ = window_alpha();
    const Scalar correction =
        first ? reading - value_ : alpha_ * Residual::difference(reading, value_);
    value_ = Residual::normal(value_ + correction);
    return Status::kOk;
  }

  [[nodiscard]] Scalar value() const noexcept { return value_; }
  [[nodiscard]] Scalar rate() const noexcept { return Scalar(0); }
  [[nodiscard]] Scalar forecast(Scalar) const noexcept { return value_; }
  [[nodiscard]] Scalar alpha() const noexcept { return alpha_; }

  /// Saves or restores the state; invalid bytes change nothing.
  void archive(Archive& fields) {
    AdaptiveExponentialSmoother read = *this;
    read.readings_.archive(fields);
    fields(read.value_);
    fields(read.alpha_);
    if (fields.ok()) *this = read;
  }

 private:
  [[nodiscard]] Scalar window_alpha() const noexcept {
    AlphaBetaLine<Scalar> line{readings_.offset(0), Scalar(0)};
    Scalar product = Scalar(0), squared = Scalar(0);
    for (int k = 1; k < readings_.size(); ++k) {
      const Scalar before = line.value;
      const Vec<Scalar, 2> gains = growing_memory_gains<Scalar>(k + 1);
      line.template step<Linear>(readings_.gap_s(k), readings_.offset(k), gains[0], gains[1]);
      const Scalar jump = readings_.offset(k) - before;
      product += (line.value - before) * jump;
      squared += jump * jump;
    }
    return squared > Scalar(0) ? std::clamp(product / squared, Scalar(0), Scalar(1)) : Scalar(1);
  }

  ReadingWindow<Residual, Window, Scalar> readings_;
  Scalar value_ = Scalar(0);
  Scalar alpha_ = Scalar(1);
};

}  // namespace wakeline
