// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The one dispatch of an update; instantiated in a translation unit per sensor, because they are
// slow to compile.
#pragma once

#include "any_filter.hpp"

namespace wakeline::python {

template <class Sensor>
Step<Sensor::kMeasurements> AnyFilter::update(
    const Sensor& sensor, const Vec<double, Sensor::kMeasurements>& z) noexcept {
  return std::visit([&](auto& filter) { return filter.update(sensor, z); }, filter_);
}

template <class Sensor>
Step<Sensor::kMeasurements> AnyFilter::innovation(
    const Sensor& sensor, const Vec<double, Sensor::kMeasurements>& z) const noexcept {
  return std::visit([&](const auto& filter) { return filter.innovation(sensor, z); }, filter_);
}

}  // namespace wakeline::python
