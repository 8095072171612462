// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// wakeline::tracker: the tracker of vessels, compiled once.
#include "wakeline/track/compiled.hpp"

#ifdef __AVX__
#error \
    "wakeline::tracker serves every processor of its kind: compile it without -mavx and -march=native"
#endif

namespace wakeline {

template class Tracker<VesselImm>;

namespace {
[[gnu::used]] const auto kCompiled = &vessel_imm;  // has it compiled, as inline as it is
}

}  // namespace wakeline
