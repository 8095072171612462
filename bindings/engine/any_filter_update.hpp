// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The one dispatch of an update; instantiated in a translation unit per sensor, because they are
// slow to compile.
#pragma once

#include "any_filter.hpp"

namespace wakeline::python {

template <class Sensor>
Correction<Sensor::kMeasurements> AnyFilter::correct_by(
    const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& reading) noexcept {
  return std::visit([&](auto& filter) { return filter.correct(sensor, reading); }, filter_);
}

template <class Sensor>
Correction<Sensor::kMeasurements> AnyFilter::compare_by(
    const Sensor& sensor, const Gaussian<Sensor::kMeasurements>& reading) const noexcept {
  return std::visit([&](const auto& filter) { return filter.compare(sensor, reading); }, filter_);
}

}  // namespace wakeline::python
