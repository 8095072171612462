// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The tracker of vessels, `Tracker<VesselImm>`. Where the CMake target `wakeline::tracker` is
// linked it is compiled already, and a unit that uses it compiles in a fraction of the time.
#pragma once

#include "wakeline/track/tracker.hpp"
#include "wakeline/track/vessel_models.hpp"

// Units for a wider instruction set compile it themselves, as their lanes are wider.
#if defined(WAKELINE_COMPILED_TRACKER) && !defined(__AVX__)
namespace wakeline {

extern template class Tracker<VesselImm>;

}  // namespace wakeline
#endif
