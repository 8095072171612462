// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "wakeline/core/require.hpp"
#include "wakeline/filter/alpha_beta_gains.hpp"
#include "wakeline/filter/smoother.hpp"

namespace wakeline {

/// An alpha-beta filter (26) of one quantity with a gain schedule: (27) `GrowingMemory{}`, (28)
/// `GrowingMemory{.plots_before = 1}`, (29) `RecentMemory{}`, (30) `RangeDependent{}`, or any other
/// of alpha_beta_gains.hpp. The first reading is the first plot.
template <class Schedule = GrowingMemory, class Residual = Linear, class ScalarType = double>
class AlphaBetaSmoother {
 public:
  using Scalar = ScalarType;

  /// `reading_std` is the error of a reading in its own unit, for `TrackingIndex`, whose
  /// acceleration is then that of the quantity. Throws `std::invalid_argument` when a parameter is
  /// invalid.
  explicit AlphaBetaSmoother(const Schedule& schedule = {}, double reading_std = 1.0)
      : schedule_(schedule), reading_std_(reading_std) {
    schedule.template validate<2>();
    require_positive("reading_std", reading_std);
  }

  /// Adds a reading; `range_m` is the range of the object from the radar, for schedules that need
  /// it.
  Status update(Scalar dt_s, Scalar reading, Scalar range_m = Scalar(0)) noexcept {
    if (const Status status = check_reading(readings_ == 0, dt_s, reading); status != Status::kOk)
      return status;
    if (!std::isfinite(range_m)) return Status::kNotFinite;
    if (++readings_ == 1) {
      line_.value = Residual::normal(reading);
      return Status::kOk;
    }
    const GainOccasion<Scalar> occasion{Scalar(readings_), dt_s, Scalar(reading_std_), range_m};
    const Vec<Scalar, 2> gains = schedule_.template gains<2>(occasion);
    line_.template step<Residual>(dt_s, reading, gains[0], gains[1]);
    line_.value = Residual::normal(line_.value);
    return Status::kOk;
  }

  [[nodiscard]] Scalar value() const noexcept { return line_.value; }
  [[nodiscard]] Scalar rate() const noexcept { return line_.rate; }
  [[nodiscard]] Scalar forecast(Scalar ahead_s) const noexcept {
    return Residual::normal(line_.value + line_.rate * ahead_s);
  }

  /// Saves or restores the state; invalid bytes change nothing.
  void archive(Archive& fields) {
    AlphaBetaSmoother read = *this;
    fields(read.line_);
    fields(read.readings_);
    if (read.readings_ < 0) fields.fail();
    if (fields.ok()) *this = read;
  }

 private:
  Schedule schedule_;
  double reading_std_;
  AlphaBetaLine<Scalar> line_;
  std::int64_t readings_ = 0;
};

}  // namespace wakeline
