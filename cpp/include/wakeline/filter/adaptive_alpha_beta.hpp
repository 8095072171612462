// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "wakeline/core/fields.hpp"
#include "wakeline/filter/alpha_beta_gains.hpp"
#include "wakeline/filter/smoother.hpp"

namespace wakeline {

/// [alpha, beta] of (27) for the n-th reading.
template <class Scalar>
Vec<Scalar, 2> growing_memory_gains(std::int64_t n) noexcept {
  return GrowingMemory{}.gains<2>(GainOccasion<Scalar>{.reading = Scalar(n)});
}

/// Parameters of the adaptive alpha-beta filter.
struct AdaptiveAlphaBetaSettings {
  int window = 5;

  static constexpr auto fields() noexcept {
    return field_table(field("window", &AdaptiveAlphaBetaSettings::window, at_least(3), "readings",
                             "Readings of the sliding window, the newest among them."));
  }
};

/// The adaptive alpha-beta filter (33): two passes over a sliding window of the last readings. The
/// first uses the gains (27). The second starts again from the oldest reading of the window, with
/// the gains that follow from the first pass,
///     alpha = sum((x^ - x~) e) / sum(e²),  beta = sum(dv e/t) / sum((e/t)²).
/// (The source computes these sums from the filter's own corrections, which returns the gains just
/// used, so that they never adapt; see cpp/docs/theory/dead_reckoning.md.)
template <class Residual = Linear, int Capacity = 16, class ScalarType = double>
class AdaptiveAlphaBeta {
 public:
  static_assert(Capacity >= 3, "wakeline: gains need three readings");
  using Scalar = ScalarType;

  /// Throws `std::invalid_argument` when a setting is invalid. The default is limited to the
  /// capacity.
  explicit AdaptiveAlphaBeta(const AdaptiveAlphaBetaSettings& settings =
                                 {.window = std::min(AdaptiveAlphaBetaSettings{}.window, Capacity)})
      : settings_(settings) {
    validate_fields(settings);
    require(settings.window <= Capacity, "window", ("at most " + std::to_string(Capacity)).c_str(),
            settings.window);
  }

  /// Adds a reading. Two readings of the same time (dt_s = 0) are replaced by their mean.
  Status update(Scalar dt_s, Scalar reading) noexcept {
    const Status status = readings_.take(dt_s, reading);
    if (status != Status::kOk) return status;
    gains_ = Vec<Scalar, 2>::Ones();
    if (readings_.size() > 2) {
      GainSums<Scalar> sums;
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

  /// Saves or restores the state; invalid bytes change nothing.
  void archive(Archive& fields) {
    AdaptiveAlphaBeta read = *this;
    read.readings_.archive(fields);
    fields(read.line_);
    fields(read.gains_);
    if (fields.ok()) *this = read;
  }

 private:
  /// Filters the window with `gains_for(n)` at its n-th reading; values relative to the newest one.
  template <class Gains>
  AlphaBetaLine<Scalar> pass(GainSums<Scalar>* sums, Gains gains_for) const noexcept {
    const int first = std::max(0, readings_.size() - settings_.window);
    AlphaBetaLine<Scalar> line{readings_.offset(first), Scalar(0)};
    for (int k = first + 1; k < readings_.size(); ++k) {
      const Vec<Scalar, 2> gains = gains_for(k - first + 1);
      const AlphaBetaStep<Scalar> step =
          line.template step<Linear>(readings_.gap_s(k), readings_.offset(k), gains[0], gains[1]);
      if (sums != nullptr) sums->add(step);
    }
    return line;
  }

  AdaptiveAlphaBetaSettings settings_;
  ReadingWindow<Residual, Capacity, Scalar> readings_;
  AlphaBetaLine<Scalar> line_;
  Vec<Scalar, 2> gains_ = Vec<Scalar, 2>::Ones();
};

}  // namespace wakeline
