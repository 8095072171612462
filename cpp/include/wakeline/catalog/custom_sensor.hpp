// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>

#include "wakeline/catalog/belief.hpp"
#include "wakeline/catalog/sensors.hpp"
#include "wakeline/catalog/type_list.hpp"

namespace wakeline {

/// The most numbers in a reading of a `RuntimeSensor`.
inline constexpr int kMostNumbers = 4;

/// Numbers of a reading, a matrix of them, and dh/dx of the components that a sensor reads.
using ReadingVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostNumbers, 1>;
using ReadingMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostNumbers, kMostNumbers>;
using ReadingJacobian =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostNumbers, kMaxStates>;

/// A sensor that is made at run time, z = h(x_r) + v, v ~ N(0, R), of 1 to `kMostNumbers` numbers:
/// the members of a `MeasurementModel`, of vectors whose size is known at run time.
///
/// A function that cannot give its result returns NaN, and the step fails with `kNotFinite`.
class CustomSensor {
 public:
  virtual ~CustomSensor() = default;
  [[nodiscard]] virtual int numbers() const noexcept = 0;
  /// The components that it reads, x_r.
  [[nodiscard]] virtual const StateRows& reads() const noexcept = 0;
  [[nodiscard]] virtual bool linear() const noexcept = 0;
  [[nodiscard]] virtual ReadingVector measure(const AnyBelief::Mean& x) const noexcept = 0;
  [[nodiscard]] virtual ReadingJacobian jacobian(const AnyBelief::Mean& x) const noexcept = 0;
  /// a - b, angles wrapped.
  [[nodiscard]] virtual ReadingVector residual(const ReadingVector& a,
                                               const ReadingVector& b) const noexcept = 0;
  /// R.
  [[nodiscard]] virtual const ReadingMatrix& noise() const noexcept = 0;
};

/// A sensor of up to four numbers, of which any may be missing: one made at run time, one that
/// measures a part of a position, or any other of the catalogue.
///
/// A number of a reading that is NaN is not measured: the others are used. What the error of
/// another number depends on is taken as predicted (the range, for the error across it of a bearing
/// alone). A part of a converted plot is used as range or bearing. `Gaussian<kMostNumbers>` of an
/// observed reading has an infinite variance where a number is missing; its other variances follow
/// from the prediction, unless `set_covariance` has given them.
template <class SensorList>
class RuntimeSensorOf {
  /// The components that a sensor reads, as it takes them.
  template <class Sensor>
  static decltype(auto) read(const Sensor&, const AnyBelief::Mean& x) noexcept {
    if constexpr (DeclaresSizes<Sensor>)
      return Vec<double, kReadsOf<Sensor>>(x);
    else
      return (x);
  }

 public:
  static constexpr int kMeasurements = kMostNumbers;

  template <class Sensor>
  requires(DeclaresSizes<Sensor>)
      // NOLINTNEXTLINE(google-explicit-constructor): each of them is one.
      RuntimeSensorOf(const Sensor& sensor)
      : sensor_(sensor) {
    static_assert(Sensor::kMeasurements <= kMostNumbers);
  }
  explicit RuntimeSensorOf(std::shared_ptr<const CustomSensor> sensor)
      : sensor_(std::move(sensor)) {}

  /// Calls a function with the sensor itself; that of a converted plot is one of range and bearing.
  template <class Function>
  auto visit(const Function& function) const noexcept {
    return std::visit(
        [&]<class Sensor>(const Sensor& sensor) {
          if constexpr (std::is_same_v<Sensor, ConvertedRangeBearing>)
            return function(RangeBearing{sensor.range_std_m, sensor.bearing_std_rad,
                                         sensor.extent_std_m, sensor.bearing_offset_rad,
                                         sensor.own});
          else if constexpr (DeclaresSizes<Sensor>)
            return function(sensor);
          else
            return function(*sensor);
        },
        sensor_);
  }

  /// Calls a function with the sensor and a reading that is a whole position with the sensor's own
  /// covariance. False where it is none.
  template <class Function>
  bool visit_whole(const Gaussian<kMostNumbers>& observed,
                   const Function& function) const noexcept {
    return std::visit(
        [&]<class Sensor>(const Sensor& sensor) {
          if constexpr (PositionSensor<Sensor>) {
            constexpr int kM = Sensor::kMeasurements;
            for (int m = 0; m < kM; ++m)
              if (has_covariance_ || std::isinf(observed.covariance(m, m))) return false;
            function(sensor, Vec<double, kM>(observed.mean.template head<kM>()));
            return true;
          } else {
            return false;
          }
        },
        sensor_);
  }

  [[nodiscard]] int numbers() const noexcept {
    return visit([]<class Sensor>(const Sensor& sensor) {
      if constexpr (DeclaresSizes<Sensor>)
        return Sensor::kMeasurements;
      else
        return sensor.numbers();
    });
  }

  /// The components that it reads.
  [[nodiscard]] StateRows reads() const noexcept {
    return visit([]<class Sensor>(const Sensor& sensor) {
      if constexpr (DeclaresSizes<Sensor>)
        return StateRows::of(Sensor::kReads);
      else
        return sensor.reads();
    });
  }

  [[nodiscard]] bool linear() const noexcept {
    return visit([]<class Sensor>(const Sensor& sensor) {
      if constexpr (DeclaresSizes<Sensor>)
        return Sensor::kLinear;
      else
        return sensor.linear();
    });
  }

  /// How many numbers of a reading there are.
  [[nodiscard]] int numbers_in(const Vec<double, kMostNumbers>& z) const noexcept {
    int count = 0;
    for (int m = 0; m < numbers(); ++m) count += z[m] == z[m];
    return count;
  }

  [[nodiscard]] Gaussian<kMostNumbers> observe(const Vec<double, kMostNumbers>& z) const noexcept {
    Gaussian<kMostNumbers> reading{z, covariance_};
    for (int m = 0; m < kMostNumbers; ++m)
      if (z[m] != z[m] || m >= numbers()) {
        reading.mean[m] = 0.0;
        reading.covariance(m, m) = std::numeric_limits<double>::infinity();
      }
    return reading;
  }

  /// Gives readings this covariance, M x M, instead of that of the sensor.
  void set_covariance(const double* covariance) noexcept {
    const int count = numbers();
    covariance_.setZero();
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) covariance_(i, j) = covariance[count * i + j];
    has_covariance_ = true;
  }

  [[nodiscard]] ReadingVector measure(const AnyBelief::Mean& x) const noexcept {
    return visit(
        [&](const auto& sensor) -> ReadingVector { return sensor.measure(read(sensor, x)); });
  }

  [[nodiscard]] ReadingJacobian jacobian(const AnyBelief::Mean& x) const noexcept {
    return visit(
        [&](const auto& sensor) -> ReadingJacobian { return sensor.jacobian(read(sensor, x)); });
  }

  [[nodiscard]] ReadingVector residual(const ReadingVector& a,
                                       const ReadingVector& b) const noexcept {
    return visit([&]<class Sensor>(const Sensor& sensor) -> ReadingVector {
      if constexpr (DeclaresSizes<Sensor>)
        return sensor.residual(NumbersOf<Sensor>(a), NumbersOf<Sensor>(b));
      else
        return sensor.residual(a, b);
    });
  }

  /// R of a reading of a target whose components that it reads are N(x, p).
  [[nodiscard]] ReadingMatrix noise(const ReadingVector& z, const AnyBelief::Mean& x,
                                    const AnyBelief::Covariance& p) const noexcept {
    if (has_covariance_) return covariance_.topLeftCorner(z.size(), z.size());
    return visit([&]<class Sensor>(const Sensor& sensor) -> ReadingMatrix {
      if constexpr (SensorAtPrediction<Sensor>)
        return sensor
            .at_prediction(sensor.observe(NumbersOf<Sensor>(z)), Gaussian<kReadsOf<Sensor>>{x, p})
            .covariance;
      else if constexpr (DeclaresSizes<Sensor>)
        return sensor.observe(NumbersOf<Sensor>(z)).covariance;
      else
        return sensor.noise();
    });
  }

  /// The place to linearise at instead of x, for a belief N(x, P) and a reading with covariance
  /// `r`; see `BendingSensor`. False where it is x.
  [[nodiscard]] bool moves(AnyBelief::Mean& x, const AnyBelief::Covariance& p,
                           const ReadingVector& z,
                           const Mat<double, kMostNumbers, kMostNumbers>& r) const noexcept {
    return visit([&]<class Sensor>(const Sensor& sensor) {
      if constexpr (BendingSensor<Sensor>) {
        constexpr int kM = Sensor::kMeasurements;
        const auto at = read(sensor, x);
        const Gaussian<kReadsOf<Sensor>> belief{at, p};
        if (!sensor.bends(belief, Mat<double, kM, kM>(r.topLeftCorner(kM, kM)))) return false;
        x = sensor.moved_to(at, NumbersOf<Sensor>(z));
        return true;
      } else {
        return false;
      }
    });
  }

  [[nodiscard]] OwnShip* own_ship() noexcept {
    return std::visit(
        []<class Sensor>(Sensor& sensor) -> OwnShip* {
          if constexpr (DeclaresSizes<Sensor>)
            return own_ship_of(sensor);
          else
            return nullptr;
        },
        sensor_);
  }

  /// Null of a sensor of the catalogue.
  [[nodiscard]] const CustomSensor* custom() const noexcept {
    const auto* const sensor = std::get_if<std::shared_ptr<const CustomSensor>>(&sensor_);
    return sensor != nullptr ? sensor->get() : nullptr;
  }

 private:
  template <class Sensor>
  using NumbersOf = Vec<double, Sensor::kMeasurements>;

  AsVariant<Joined<SensorList, TypeList<std::shared_ptr<const CustomSensor>>>> sensor_;
  Mat<double, kMostNumbers, kMostNumbers> covariance_ =
      Mat<double, kMostNumbers, kMostNumbers>::Zero();
  bool has_covariance_ = false;
};

/// One over the sensors of the catalogue.
using RuntimeSensor = RuntimeSensorOf<Joined<Sensors, PartSensors>>;

}  // namespace wakeline
