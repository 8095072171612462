// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Estimators that draw lines through plots, beside those over filters composed at run time.
#pragma once

#include "any_filter.hpp"
#include "support/types.hpp"
#include "wakeline/multimodel/bayesian_alpha_beta.hpp"
#include "wakeline/multimodel/fuzzy_alpha_beta.hpp"

namespace wakeline::python {

/// The estimator itself, with beliefs of any layout.
template <class Estimator>
class AnyLines : public Estimator {
 public:
  using Estimator::Estimator;
  using Estimator::start;

  Status start(const AnyBelief& belief) noexcept { return start(kinematics_of(belief)); }

  [[nodiscard]] AnyBelief estimate() const noexcept {
    const auto& belief = Estimator::estimate();
    return {StateLayout::kKinematics, belief.mean, belief.covariance};
  }

  /// They take the position out of any sensor.
  [[nodiscard]] bool linear() const noexcept { return false; }
};

using AnyBayesianAlphaBeta = AnyLines<BayesianAlphaBeta<>>;
using AnyFuzzyAlphaBeta = AnyLines<FuzzyAlphaBeta<>>;

/// Adds `BayesianAlphaBeta`.
void define_bayesian_alpha_beta(py::module_& m);
/// Adds `FuzzyAlphaBeta`.
void define_fuzzy_alpha_beta(py::module_& m);

}  // namespace wakeline::python
