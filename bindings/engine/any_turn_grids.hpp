// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The estimators over a grid of turn rates, composed at run time.
#pragma once

#include "any_filter.hpp"
#include "wakeline/multimodel/adaptive_grid_imm.hpp"
#include "wakeline/multimodel/likely_model_set_imm.hpp"
#include "wakeline/multimodel/switching_grid_imm.hpp"

namespace wakeline::python {

using AnyAdaptiveGridImm = AdaptiveGridImm<AnyFilterBank>;
using AnySwitchingGridImm = SwitchingGridImm<AnyFilterBank>;
using AnyLikelyModelSetImm = LikelyModelSetImm<AnyFilterBank>;

}  // namespace wakeline::python
