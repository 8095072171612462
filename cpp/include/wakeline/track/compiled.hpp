// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The tracker of vessels, `Tracker<VesselImm>`. Where the CMake target `wakeline::tracker` is
// linked it is compiled already, and a unit that uses it compiles in a fraction of the time.
#pragma once

#include "wakeline/track/tracker.hpp"
#include "wakeline/track/vessel_models.hpp"

#ifdef WAKELINE_USES_COMPILED_TRACKER
namespace wakeline {

template <>
inline constexpr bool kTrackerIsCompiled<VesselImm> = true;

extern template class Tracker<VesselImm>;

}  // namespace wakeline
#endif
