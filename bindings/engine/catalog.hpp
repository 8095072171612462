// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The catalogue, compiled once: in catalog_*.cpp.
#pragma once

#include <vector>

#include "wakeline/batch/run.hpp"
#include "wakeline/catalog/estimators.hpp"

namespace wakeline {

extern template class AnyFilterOf<Filters>;
extern template Correction<2> AnyFilter::correct_by(const RangeBearing&,
                                                    const Gaussian<2>&) noexcept;
extern template Correction<2> AnyFilter::correct_by(const ConvertedRangeBearing&,
                                                    const Gaussian<2>&) noexcept;
extern template Correction<3> AnyFilter::correct_by(const RangeBearingDoppler&,
                                                    const Gaussian<3>&) noexcept;
extern template Step<kMostNumbers> AnyFilter::update(const RuntimeSensor&,
                                                     const Vec<double, kMostNumbers>&) noexcept;
extern template class AnyFilterBankOf<Filters>;
extern template class Imm<AnyFilterBank>;
extern template Step<2> AnyImm::update(const AnySensorOf<2>&, const Vec<double, 2>&) noexcept;
extern template Step<3> AnyImm::update(const AnySensorOf<3>&, const Vec<double, 3>&) noexcept;
extern template Step<kMostNumbers> AnyImm::update(const RuntimeSensor&,
                                                  const Vec<double, kMostNumbers>&) noexcept;
extern template class AnyModeHistoryOf<Filters>;
extern template Step<2> AnyModeHistory::update(const AnySensorOf<2>&,
                                               const Vec<double, 2>&) noexcept;
extern template Step<3> AnyModeHistory::update(const AnySensorOf<3>&,
                                               const Vec<double, 3>&) noexcept;
extern template class AnyEstimatorOf<Estimators>;
extern template AnyStep<2> AnyEstimator::update(const AnySensorOf<2>&,
                                                const Vec<double, 2>&) noexcept;
extern template AnyStep<3> AnyEstimator::update(const AnySensorOf<3>&,
                                                const Vec<double, 3>&) noexcept;

}  // namespace wakeline

namespace wakeline::python {

/// A sensor as `update` and `run` take it: of the catalogue where all numbers of all readings are
/// there, else as a `RuntimeSensor`.
using ReadingSensor = std::variant<AnySensor, RuntimeSensor>;

/// Calls `function` with the sensor itself.
template <class Function>
auto visit_reading(const ReadingSensor& any, const Function& function) {
  return std::visit(
      [&]<class Sensor>(const Sensor& sensor) {
        if constexpr (std::is_same_v<Sensor, RuntimeSensor>)
          return sensor.visit(function);
        else
          return std::visit(function, sensor);
      },
      any);
}

/// Recordings of one sensor, where each begins (or all do), and where the results go.
struct Recordings {
  const ReadingSensor& sensor;
  const RunInput& in;
  const std::vector<AnyBelief>& starts;
  const RunOutput& out;

  [[nodiscard]] const AnyBelief& start(std::size_t run) const noexcept {
    return starts[starts.size() == 1 ? 0 : run];
  }
};

/// Calls `function` with the sensor, as one of those that report as many numbers.
template <class Function>
decltype(auto) visit_numbers(const AnySensor& any, Function&& function) {
  return std::visit(
      [&]<class Sensor>(const Sensor& sensor) {
        return function(AnySensorOf<Sensor::kMeasurements>(sensor));
      },
      any);
}

/// All recordings one after the other, over some threads; of a `RuntimeSensor` with a filter or an
/// Imm only.
void run_one_by_one(const AnyFilter& prototype, const Recordings& recordings, int threads);
void run_one_by_one(const AnyEstimator& prototype, const Recordings& recordings, int threads);
/// Those of a `RuntimeSensor`.
void run_readings(const AnyFilter& prototype, const Recordings& recordings, int threads);
void run_readings(const AnyImm& prototype, const Recordings& recordings, int threads);

}  // namespace wakeline::python
