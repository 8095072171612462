// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "wakeline/filter/alpha_beta_gains.hpp"
#include "wakeline/filter/smoother.hpp"

namespace wakeline {

/// [alpha, beta] of (27) for the n-th reading.
template <class Scalar>
Vec<Scalar, 2> growing_memory_gains(std::int64_t n) noexcept {
  return GrowingMemory{}.gains<2>(GainOccasion<Scalar>{.reading = Scalar(n)});
}

/// The adaptive alpha-beta filter (33), in two passes over a sliding window of the last readings:
/// the first with the gains (27); the second anew from the window's oldest reading, with the gains
///     alpha = sum((x^ - x~) e) / sum(e²),  beta = sum(dv e/t) / sum((e/t)²)
/// of the first. On the filter's own output, as printed, these sums give back the gains that were
/// just used; see `PrintedAdaptiveAlphaBeta`.
template <class Residual = Linear, int Window = 5, class ScalarType = double>
class AdaptiveAlphaBeta {
 public:
  static_assert(Window >= 3, "wakeline: gains need three readings");
  using Scalar = ScalarType;

  /// Takes a reading; one of the time of the reading before joins it: both become their mean.
  Status update(Scalar dt_s, Scalar reading) noexcept {
    const Status status = readings_.take(dt_s, reading);
    if (status != Status::kOk) return status;
    gains_ = Vec<Scalar, 2>::Ones();
    if (readings_.size() > 2) {
      AdaptiveGains<Scalar> sums;
      pass(&sums, [](int n) { return growing_memory_gains<Scalar>(n); });
      gains_ = {sums.alpha(Scalar(1)), sums.beta(Scalar(1))};
    }
    line_ = pass(nullptr, [this](int) { return gains_; });
    return Status::kOk;
  }

  [[nodiscard]] Scalar value() const noexcept {
    return Residual::normal(readings_.newest() + line_.value);
  }
  [[nodiscard]] Scalar rate() const noexcept { return line_.rate; }
  [[nodiscard]] Scalar forecast(Scalar ahead_s) const noexcept {
    return Residual::normal(readings_.newest() + line_.value + line_.rate * ahead_s);
  }
  [[nodiscard]] Scalar alpha() const noexcept { return gains_[0]; }
  [[nodiscard]] Scalar beta() const noexcept { return gains_[1]; }

  /// Saves or restores what the readings have left; bytes that do not fit change nothing.
  void archive(Archive& fields) {
    AdaptiveAlphaBeta read = *this;
    read.readings_.archive(fields);
    fields(read.line_);
    fields(read.gains_);
    if (fields.ok()) *this = read;
  }

 private:
  /// Filters the window with the gains for its n-th reading; less the newest reading.
  template <class Gains>
  AlphaBetaLine<Scalar> pass(AdaptiveGains<Scalar>* sums, Gains gains_for) const noexcept {
    AlphaBetaLine<Scalar> line{readings_.offset(0), Scalar(0)};
    for (int k = 1; k < readings_.size(); ++k) {
      const Vec<Scalar, 2> gains = gains_for(k + 1);
      const AlphaBetaStep<Scalar> step =
          line.template step<Linear>(readings_.gap_s(k), readings_.offset(k), gains[0], gains[1]);
      if (sums != nullptr) sums->add(step);
    }
    return line;
  }

  ReadingWindow<Residual, Window, Scalar> readings_;
  AlphaBetaLine<Scalar> line_;
  Vec<Scalar, 2> gains_ = Vec<Scalar, 2>::Ones();
};

/// (33) by the letter: the sums run over the filter's own last steps. Its corrections are its gains
/// times the innovations, so that the "new" gains are means of those used last, whatever the
/// readings are: it never adapts. Kept for comparison; use `AdaptiveAlphaBeta`.
template <class Residual = Linear, int Window = 5, class ScalarType = double>
class PrintedAdaptiveAlphaBeta {
 public:
  static_assert(Window >= 2, "wakeline: gains need two steps");
  using Scalar = ScalarType;

  Status update(Scalar dt_s, Scalar reading) noexcept {
    if (const Status status = check_reading(count_ == 0, dt_s, reading); status != Status::kOk)
      return status;
    if (++count_ == 1) {
      line_.value = Residual::normal(reading);
      return Status::kOk;
    }
    if (count_ <= Window + 1) {  // until the sums are full
      gains_ = growing_memory_gains<Scalar>(count_);
    } else {
      AdaptiveGains<Scalar> sums;
      for (const AlphaBetaStep<Scalar>& step : steps_) sums.add(step);
      gains_ = {sums.alpha(gains_[0]), sums.beta(gains_[1])};
    }
    steps_[static_cast<std::size_t>(count_ % Window)] =
        line_.template step<Residual>(dt_s, reading, gains_[0], gains_[1]);
    line_.value = Residual::normal(line_.value);
    return Status::kOk;
  }

  [[nodiscard]] Scalar value() const noexcept { return line_.value; }
  [[nodiscard]] Scalar rate() const noexcept { return line_.rate; }
  [[nodiscard]] Scalar forecast(Scalar ahead_s) const noexcept {
    return Residual::normal(line_.value + line_.rate * ahead_s);
  }
  [[nodiscard]] Scalar alpha() const noexcept { return gains_[0]; }
  [[nodiscard]] Scalar beta() const noexcept { return gains_[1]; }

  /// Saves or restores what the readings have left; bytes that do not fit change nothing.
  void archive(Archive& fields) {
    PrintedAdaptiveAlphaBeta read = *this;
    fields(read.line_);
    fields(read.steps_);
    fields(read.gains_);
    fields(read.count_);
    if (read.count_ < 0) fields.fail();
    if (fields.ok()) *this = read;
  }

 private:
  AlphaBetaLine<Scalar> line_;
  std::array<AlphaBetaStep<Scalar>, static_cast<std::size_t>(Window)> steps_{};
  Vec<Scalar, 2> gains_ = Vec<Scalar, 2>::Ones();
  std::int64_t count_ = 0;
};

}  // namespace wakeline
