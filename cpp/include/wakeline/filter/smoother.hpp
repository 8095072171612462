// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Common parts of the smoothers of one quantity (a speed, a course, a latitude).
//
// A smoother takes readings one at a time, `update(dt_s, reading)`, and has a `value()`, a `rate()`
// and a `forecast(ahead_s)`. The time step of the first reading is ignored. A reading that is not
// in range or whose time step is negative returns a status and changes nothing. An `archive` can be
// loaded into a smoother with the same settings. Source of the smoothers, unless another is given:
// I. M. Hannoshyna, T. V. Kalinichenko, P. V. Nikitin, Research of methods of forecasting the
// movement, search and tracking of sea objects, equations (21)-(33) in their corrected form; see
// cpp/docs/theory/dead_reckoning.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/archive.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/filter/belief.hpp"

namespace wakeline {

/// A quantity on a line.
struct Linear {
  template <class Scalar>
  static Scalar difference(Scalar a, Scalar b) noexcept {
    return a - b;
  }
  template <class Scalar>
  static Scalar normal(Scalar a) noexcept {
    return a;
  }
};

/// An angle, radians: from 359 to 1 degree is 2 degrees. Values are in -pi .. pi.
struct Wrapped {
  template <class Scalar>
  static Scalar difference(Scalar a, Scalar b) noexcept {
    return wrap_angle(a - b);
  }
  template <class Scalar>
  static Scalar normal(Scalar a) noexcept {
    return wrap_angle(a);
  }
};

/// The interface of a smoother.
template <class T>
concept Smoother = requires(T smoother, const T& view, typename T::Scalar x, Archive fields) {
  { smoother.update(x, x) }
  noexcept->std::same_as<Status>;
  { view.value() }
  noexcept->std::same_as<typename T::Scalar>;
  { view.rate() }
  noexcept->std::same_as<typename T::Scalar>;
  { view.forecast(x) }
  noexcept->std::same_as<typename T::Scalar>;
  smoother.archive(fields);
};

/// `kOk` when a reading that is `in_range` can be taken `dt_s` after the one before; the time step
/// of the first one is not looked at.
template <class Scalar>
Status check_reading(bool first, Scalar dt_s, Scalar reading) noexcept {
  if (!in_range(reading)) return Status::kNotFinite;
  return first ? Status::kOk : check_time_step(dt_s);
}

/// The last readings, oldest first, each relative to the newest, so that a sequence of angles is
/// continuous through north.
template <class Residual, int Capacity, class ScalarType>
class ReadingWindow {
 public:
  using Scalar = ScalarType;

  /// Adds a reading. One at the time of the newest (dt_s = 0) has no rate: both are replaced by
  /// their mean.
  Status take(Scalar dt_s, Scalar reading) noexcept {
    return is_of_newest_time(dt_s) ? join(reading) : add(dt_s, reading);
  }

  [[nodiscard]] bool is_of_newest_time(Scalar dt_s) const noexcept {
    return size_ > 0 && dt_s == Scalar(0);
  }

  Status add(Scalar dt_s, Scalar reading) noexcept {
    if (const Status status = check_reading(size_ == 0, dt_s, reading); status != Status::kOk)
      return status;
    const Scalar rise = size_ > 0 ? Residual::difference(reading, newest_) : Scalar(0);
    if (size_ == Capacity) {
      std::move(offset_.begin() + 1, offset_.end(), offset_.begin());
      std::move(gap_s_.begin() + 1, gap_s_.end(), gap_s_.begin());
      --size_;
    }
    for (int k = 0; k < size_; ++k) offset_[std::size_t(k)] -= rise;
    offset_[std::size_t(size_)] = Scalar(0);
    gap_s_[std::size_t(size_)] = size_ > 0 ? dt_s : Scalar(0);
    ++size_;
    newest_ = reading;
    return Status::kOk;
  }

  /// Moves the newest reading half way to another one of the same time.
  Status join(Scalar reading) noexcept {
    if (const Status status = check_reading(false, Scalar(0), reading); status != Status::kOk)
      return status;
    const Scalar half = Residual::difference(reading, newest_) / 2;
    for (int k = 0; k + 1 < size_; ++k) offset_[std::size_t(k)] -= half;
    newest_ += half;
    return Status::kOk;
  }

  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] Scalar newest() const noexcept { return newest_; }
  /// Reading k, oldest first, minus the newest.
  [[nodiscard]] Scalar offset(int k) const noexcept { return offset_[std::size_t(k)]; }
  /// Time from reading k - 1 to reading k.
  [[nodiscard]] Scalar gap_s(int k) const noexcept { return gap_s_[std::size_t(k)]; }

  /// Saves or restores the readings; invalid bytes change nothing.
  void archive(Archive& fields) {
    ReadingWindow read = *this;
    fields(read.offset_);
    fields(read.gap_s_);
    fields(read.newest_);
    fields(read.size_);
    if (read.size_ < 0 || read.size_ > Capacity) fields.fail();
    if (fields.ok()) *this = read;
  }

 private:
  std::array<Scalar, std::size_t(Capacity)> offset_{};
  std::array<Scalar, std::size_t(Capacity)> gap_s_{};
  Scalar newest_ = Scalar(0);
  int size_ = 0;
};

/// One correction of (26) and its terms.
template <class Scalar>
struct AlphaBetaStep {
  Scalar innovation = Scalar(0);   ///< e
  Scalar correction = Scalar(0);   ///< of the value, alpha e
  Scalar rate_change = Scalar(0);  ///< beta e / t
  Scalar dt_s = Scalar(0);
};

/// A value and its rate, predicted and corrected by (26): x += v t; x += alpha e, v += beta e / t.
template <class Scalar>
struct AlphaBetaLine {
  Scalar value = Scalar(0);
  Scalar rate = Scalar(0);

  template <class Residual>
  AlphaBetaStep<Scalar> step(Scalar dt_s, Scalar reading, Scalar alpha, Scalar beta) noexcept {
    const Scalar predicted = value + rate * dt_s;
    const Scalar innovation = Residual::difference(reading, predicted);
    const Scalar change = dt_s > Scalar(0) ? beta * innovation / dt_s : Scalar(0);
    value = predicted + alpha * innovation;
    rate += change;
    return {innovation, alpha * innovation, change, dt_s};
  }
};

/// The sums of (33) over steps, and the gains that follow from them.
template <class Scalar>
struct GainSums {
  Scalar correction_innovation = Scalar(0);
  Scalar innovation_squared = Scalar(0);
  Scalar change_slope = Scalar(0);
  Scalar slope_squared = Scalar(0);

  void add(const AlphaBetaStep<Scalar>& step) noexcept {
    correction_innovation += step.correction * step.innovation;
    innovation_squared += step.innovation * step.innovation;
    if (!(step.dt_s > Scalar(0))) return;
    const Scalar slope = step.innovation / step.dt_s;
    change_slope += step.rate_change * slope;
    slope_squared += slope * slope;
  }

  /// alpha = sum(dx e) / sum(e²); `otherwise` where all innovations are zero or a sum overflows.
  [[nodiscard]] Scalar alpha(Scalar otherwise) const noexcept {
    const Scalar ratio = correction_innovation / innovation_squared;
    return std::isfinite(ratio) ? ratio : otherwise;
  }
  /// beta = sum(dv e/t) / sum((e/t)²).
  [[nodiscard]] Scalar beta(Scalar otherwise) const noexcept {
    const Scalar ratio = change_slope / slope_squared;
    return std::isfinite(ratio) ? ratio : otherwise;
  }
};

}  // namespace wakeline
