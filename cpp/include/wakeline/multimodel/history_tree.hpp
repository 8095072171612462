// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "wakeline/core/require.hpp"

namespace wakeline {

/// How the tree of a `ModeHistory` branches, joins and is cut.
struct HistoryTree {
  int max_hypotheses = 75;         ///< kept after an update; the number of modes or more
  int max_branches = 100;          ///< filtered in a scan: what was kept and the switches from it
  double min_segment_s = 12.0;     ///< a mode that is younger does not end
  double merge_distance = 1.9;     ///< hypotheses of one mode that are nearer join: Mahalanobis, in
                                   ///< the covariance of the heavier one; 0 joins none
  double sibling_distance = 12.0;  ///< the same for those that came into the mode in one scan
                                   ///< and differ only in what came before
  double switch_time_spread = 0.15;  ///< uncertainty of when in the scan a switch came: this part
                                     ///< of the variance of a time uniform in it
  double negligible_probability = 1e-7;  ///< less is dropped
  int pseudo_bayes_order = 0;  ///< 0, or n of GPBn, which ignores the distances (and GPB1 all else)

  /// The generalised pseudo-Bayes estimator of an order (GPB1, GPB2, ...) over a number of modes:
  /// hypotheses with the same last n - 1 modes join, whatever their distance, and nothing is cut.
  /// Source: Bar-Shalom, Li, Kirubarajan, 11.6.3-11.6.5.
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

  /// Throws `std::invalid_argument` on a parameter that makes no sense.
  void validate() const {
    require(max_hypotheses >= 1, "max_hypotheses", "1 or more", max_hypotheses);
    require(max_branches > max_hypotheses || pseudo_bayes_order > 0, "max_branches",
            "more than max_hypotheses", max_branches);
    require(max_branches >= max_hypotheses, "max_branches", "max_hypotheses or more", max_branches);
    require_not_negative("min_segment_s", min_segment_s);
    require(merge_distance >= 0.0, "merge_distance", "not negative", merge_distance);
    require(sibling_distance >= merge_distance, "sibling_distance", "merge_distance or more",
            sibling_distance);
    require(switch_time_spread >= 0.0 && switch_time_spread <= 1.0, "switch_time_spread", "0 to 1",
            switch_time_spread);
    require(negligible_probability >= 0.0 && negligible_probability < 1e-2,
            "negligible_probability", "0 or more and below 0.01", negligible_probability);
    require(pseudo_bayes_order >= 0 && pseudo_bayes_order <= 8, "pseudo_bayes_order", "0 to 8",
            pseudo_bayes_order);
  }
};

}  // namespace wakeline
