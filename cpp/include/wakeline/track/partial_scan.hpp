// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/status.hpp"
#include "wakeline/core/types.hpp"
#include "wakeline/measurement/own_ship.hpp"
#include "wakeline/track/track.hpp"

namespace wakeline {

/// Which part of a position a sensor measures.
enum class PositionPart : std::uint8_t {
  kBearing,  ///< as a camera does
  kRange,
};

/// Bearings or ranges of one time, of some targets in any order, with false ones among them.
struct PartialScan {
  PositionPart part = PositionPart::kBearing;
  int sensor = 0;  ///< its number, below `kMostPartialSensors`: which targets it sees is learned
  double time_s = 0.0;
  std::span<const double> values = {};  ///< rad from north, or m
  double std = deg(1.0);                ///< standard deviation of a value, rad or m
  double false_per_unit = 1.0;          ///< false values per rad, or per m
  OwnShip own = {};                     ///< of the sensor at that time

  /// Whether a value can be one of such a sensor.
  [[nodiscard]] bool is_usable(double value) const noexcept {
    return in_range(value) && (part == PositionPart::kBearing || value >= 0.0);
  }

  [[nodiscard]] bool is_valid() const noexcept {
    return sensor >= 0 && sensor < static_cast<int>(kMostPartialSensors) && std::isfinite(time_s) &&
           std > 0.0 && in_range(std) && false_per_unit > 0.0 && in_range(false_per_unit) &&
           in_range(own.position<double>());
  }
};

}  // namespace wakeline
