// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "wakeline/core/fields.hpp"
#include "wakeline/simd/scalar.hpp"

namespace wakeline {

/// Conjunction of the degrees of several conditions.
enum class TNorm : std::uint8_t { kProduct, kMinimum };

/// Names of the norms.
constexpr std::array<Word<TNorm>, 2> words_of(TNorm) noexcept {
  return {{{"product", TNorm::kProduct}, {"minimum", TNorm::kMinimum}}};
}

/// Chooses with which of the lines through the last 2 .. `max_plots` plots a target is tracked: a
/// zero-order Sugeno system that rates how well each line predicted the newest plot.
///
/// L is the ratio of a line's residual to the usual one of the shortest line, and
///     bad(L) = 1 / (1 + exp(-steepness (L - threshold))),   good(L) = 1 - bad(L).
/// Rule p: if the first p lines are good and the rest bad, track with max(2, p + 1) plots. Source:
/// V. M. Grinyak, M. V. Trofimov, Multi-model tracking of moving vessels with a fuzzy criterion of
/// maneuver detection.
struct FuzzyCriterion {
  static constexpr int kMaxPlots = 16;

  int max_plots = 10;
  double steepness = 5.0;
  double threshold = 1.5;
  double clip = 3.0;
  TNorm t_norm = TNorm::kProduct;
  bool hold = true;
  double acceleration_std_mps2 = 0.5;

  static constexpr auto fields() noexcept {
    using F = FuzzyCriterion;
    return field_table(
        field("max_plots", &F::max_plots, between(2, kMaxPlots), "plots",
              "Plots of the longest line."),
        field("steepness", &F::steepness, kPositive, "1", "Slope a of the membership functions."),
        field("threshold", &F::threshold, kPositive, "1",
              "Ratio c of residuals that is as good as it is bad; less than clip."),
        field("clip", &F::clip, kPositive, "1", "Greater ratios count as this one."),
        field("t_norm", &F::t_norm, "How the conditions of a rule are joined."),
        field("hold", &F::hold,
              "The greater of the last two outputs counts, against single outliers."),
        field("acceleration_std_mps2", &F::acceleration_std_mps2, kNotNegative, "m/s²",
              "Standard deviation, per axis, of a maneuver that the line has not seen yet: it "
              "widens the covariance and does not count in the choice."));
  }

  /// Degrees of membership of the tracking quality in good and bad.
  template <class Scalar>
  struct Degrees {
    Scalar good;
    Scalar bad;
  };

  template <class Scalar>
  [[nodiscard]] Degrees<Scalar> degrees(Scalar ratio) const noexcept {
    using std::exp;
    const Scalar odds = exp(-Scalar(steepness) * (ratio - Scalar(threshold)));
    return {odds / (Scalar(1) + odds), Scalar(1) / (Scalar(1) + odds)};
  }

  /// Degree of the conjunction of all conditions.
  template <class Scalar>
  [[nodiscard]] Scalar both(Scalar a, Scalar b) const noexcept {
    using std::min;
    return t_norm == TNorm::kProduct ? a * b : min(a, b);
  }

  /// Output of the system, 2 .. n + 1, for the ratios (n >= 1) of the lines through 2, 3, ... n + 1
  /// plots: the outputs of the n + 1 rules averaged with their strengths, which are written to
  /// `strengths`. O(n).
  double evaluate(std::span<const double> ratios, std::span<double> strengths) const noexcept {
    return evaluate<double>(ratios, strengths, double(ratios.size()));
  }

  /// The same for any scalar; each lane of a pack uses the first `lines` ratios.
  template <class Scalar>
  Scalar evaluate(std::span<const Scalar> ratios, std::span<Scalar> strengths,
                  std::type_identity_t<Scalar> lines) const noexcept {
    std::array<Degrees<Scalar>, kMaxPlots> degree;
    Scalar ahead = Scalar(1);  // degree to which the first p are good
    for (std::size_t p = 0; p < ratios.size(); ++p) {
      degree[p] = degrees(ratios[p]);
      strengths[p] = ahead;
      ahead = select(Scalar(p) < lines, both(ahead, degree[p].good), ahead);
    }
    strengths[ratios.size()] = ahead;
    Scalar behind = Scalar(1);  // degree to which the rest are bad
    Scalar total = ahead;
    Scalar sum = total * (lines + Scalar(1));
    for (std::size_t p = ratios.size(); p-- > 0;) {
      const auto exists = Scalar(p) < lines;
      behind = select(exists, both(behind, degree[p].bad), behind);
      strengths[p] = select(exists, both(strengths[p], behind), strengths[p]);
      total += select(exists, strengths[p], Scalar(0));
      sum += select(exists, strengths[p] * Scalar(std::max<std::size_t>(2, p + 1)), Scalar(0));
    }
    return sum / total;
  }

  friend bool operator==(const FuzzyCriterion&, const FuzzyCriterion&) = default;

  /// Throws `std::invalid_argument` when a parameter is invalid.
  void validate() const {
    validate_fields(*this);
    require(threshold < clip, "threshold", "less than clip", threshold);
    // Keeps the product over all lines far above underflow.
    require(steepness * std::max(threshold, clip - threshold) <= 40.0, "steepness",
            "such that no membership is below exp(-40) within 0 .. clip", steepness);
  }
};

}  // namespace wakeline
