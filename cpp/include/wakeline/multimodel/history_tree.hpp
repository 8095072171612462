// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "wakeline/core/fields.hpp"

namespace wakeline {

/// Branching, merging and pruning of the tree of a `ModeHistory`.
struct HistoryTree {
  int max_hypotheses = 75;
  int max_branches = 100;
  double min_segment_s = 12.0;
  double merge_distance = 1.9;
  double sibling_distance = 12.0;
  double switch_time_spread = 0.15;
  double negligible_probability = 1e-7;
  int pseudo_bayes_order = 0;

  static constexpr auto fields() noexcept {
    using H = HistoryTree;
    return field_table(
        field("max_hypotheses", &H::max_hypotheses, between(1, 10'000), "hypotheses",
              "Hypotheses kept after an update; at least the number of modes."),
        field("max_branches", &H::max_branches, between(1, 100'000), "hypotheses",
              "Hypotheses filtered in a scan: those that were kept and the switches from them."),
        field("min_segment_s", &H::min_segment_s, kNotNegative, "s",
              "A mode does not end before this time."),
        field("merge_distance", &H::merge_distance, kNotNegativeOrInfinite, "sigma²",
              "Hypotheses of one mode that are nearer are merged, by squared Mahalanobis distance "
              "in the covariance of the heavier one; 0: none."),
        field("sibling_distance", &H::sibling_distance, kNotNegativeOrInfinite, "sigma²",
              "The same for those that entered the mode in one scan and differ only in what came "
              "before; at least merge_distance."),
        field("switch_time_spread", &H::switch_time_spread, between(0, 1), "1",
              "Variance of the time of a switch within its scan, over that of a uniform one."),
        field("negligible_probability", &H::negligible_probability, from_to_below(0, 1e-2), "1",
              "Hypotheses of less probability are dropped."),
        field("pseudo_bayes_order", &H::pseudo_bayes_order, between(0, 8), "1",
              "Order n of the generalised pseudo-Bayes estimator, which ignores the distances; 0: "
              "none."));
  }

  /// The generalised pseudo-Bayes estimator of an order (GPB1, GPB2, ...) over a number of modes:
  /// hypotheses with the same last n - 1 modes are merged, whatever their distance, and nothing is
  /// pruned. Source: Bar-Shalom, Li, Kirubarajan, 11.6.3-11.6.5.
  static HistoryTree pseudo_bayes(int order, int modes) {
    require(order >= 1 && order <= 8, "pseudo_bayes_order", "1 to 8", order);
    require(modes >= 1 && modes <= 16, "modes", "1 to 16", modes);
    const double branches = std::pow(modes, order);
    require(branches <= 65536, "modes to the power of pseudo_bayes_order", "65536 or less",
            branches);
    return {.max_hypotheses = static_cast<int>(std::max(branches / modes, double(modes))),
            .max_branches = static_cast<int>(branches),
            .min_segment_s = 0.0,
            .merge_distance = 0.0,
            .sibling_distance = 0.0,
            .switch_time_spread = 0.0,
            .negligible_probability = 0.0,
            .pseudo_bayes_order = order};
  }

  /// Throws `std::invalid_argument` when a parameter is invalid.
  void validate() const {
    validate_fields(*this);
    require(max_branches > max_hypotheses || pseudo_bayes_order > 0, "max_branches",
            "more than max_hypotheses", max_branches);
    require(max_branches >= max_hypotheses, "max_branches", "max_hypotheses or more", max_branches);
    require(sibling_distance >= merge_distance, "sibling_distance", "merge_distance or more",
            sibling_distance);
  }
};

}  // namespace wakeline
