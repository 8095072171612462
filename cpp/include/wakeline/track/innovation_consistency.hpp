// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "wakeline/core/archive.hpp"
#include "wakeline/core/cholesky.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// Whether the innovations ν of a track are as large as their covariances S say, and independent:
/// means over its plots, of which each counts a tenth less than the one after it.
///
///     mean NIS   Σ aʲ |uₙ₋ⱼ|² / Σ aʲ                                          2 if consistent
///     whiteness  Σ aʲ uₙ₋ⱼ·uₙ₋ⱼ₋₁ / sqrt(Σ aʲ |uₙ₋ⱼ|² · Σ aʲ |uₙ₋ⱼ₋₁|²)      0
///
/// with u = L⁻¹ ν, L Lᵀ = S, a = 0.9. A mean NIS above its bounds shows errors that are larger than
/// reported, a positive whiteness an estimate that lags. Source: Bar-Shalom, Li, Kirubarajan 2001,
/// sections 5.4 (consistency) and 11.2 (fading memory).
class InnovationConsistency {
 public:
  static constexpr int kMeasurements = 2;

  /// Adds a whitened innovation u; one that is not finite changes nothing.
  void add(const Vec<double, kMeasurements>& whitened) noexcept {
    if (!is_finite(whitened)) return;
    squares_ = kMemory * squares_ + whitened.squaredNorm();
    products_ = kMemory * products_ + whitened.dot(last_);
    last_ = whitened;
    ++plots_;
  }

  /// How many there have been.
  [[nodiscard]] int plots() const noexcept { return plots_; }

  /// NaN before the first plot.
  [[nodiscard]] double mean_nis() const noexcept {
    return squares_ * (1.0 - kMemory) / (1.0 - forgotten(plots_));
  }

  /// From -1 to 1; NaN before the second plot.
  [[nodiscard]] double whiteness() const noexcept {
    const double before = std::max(squares_ - last_.squaredNorm(), 0.0) / kMemory;
    return products_ / std::sqrt(squares_ * before);
  }

  /// How many independent plots have a mean that is as sure as this one of `plots`:
  /// (Σ aʲ)² / Σ a²ʲ, at most 19. For `consistency_bounds`; whiteness has one plot less.
  [[nodiscard]] static double samples(int plots) noexcept {
    const double left = forgotten(plots);
    return (1.0 - left) / (1.0 + left) * (1.0 + kMemory) / (1.0 - kMemory);
  }

  void archive(Archive& fields) {
    fields(squares_);
    fields(products_);
    fields(last_);
    fields(plots_);
  }

 private:
  static constexpr double kMemory = 0.9;

  static double forgotten(int plots) noexcept { return std::pow(kMemory, plots); }

  double squares_ = 0.0, products_ = 0.0;
  Vec<double, kMeasurements> last_ = Vec<double, kMeasurements>::Zero();
  int plots_ = 0;
};

}  // namespace wakeline
