// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The estimators of several models, each bound in a file of its own.
#pragma once

#include "face.hpp"

namespace wakeline::python {

/// Adds `smooth` to `Imm`.
void define_imm_smoother(EstimatorClass<AnyImm>& imm);
/// Adds `ModeHistory`.
void define_mode_history(py::module_& m);
/// Adds `BayesianAlphaBeta`.
void define_bayesian_alpha_beta(py::module_& m);
/// Adds `FuzzyAlphaBeta`.
void define_fuzzy_alpha_beta(py::module_& m);

}  // namespace wakeline::python
