// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include "any_filter.hpp"
#include "support/types.hpp"

namespace wakeline::python {

/// Adds `smooth` to `Imm`.
void define_imm_smoother(py::class_<AnyImm>& imm);

}  // namespace wakeline::python
