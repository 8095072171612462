// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The one instance of the tracker that these tests share.
#include "track/scene.hpp"

namespace wakeline {

template class Tracker<VesselImm>;

namespace test {

VesselTracker make_tracker(const TrackerConfig& config, const Radar& radar) {
  return VesselTracker(radar, config, vessel_imm(radar));
}

}  // namespace test
}  // namespace wakeline
