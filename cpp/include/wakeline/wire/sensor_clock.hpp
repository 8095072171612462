// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Times of day and wrong clocks of sensors.
#pragma once

#include <cmath>

#include "wakeline/core/asterix.hpp"
#include "wakeline/core/require.hpp"

namespace wakeline {

/// The time with this time of day that is nearest to another time, both in s since a midnight. NaN
/// stays NaN.
inline double on_nearest_day(double time_of_day_s, double near_s) noexcept {
  return time_of_day_s + asterix::kDay * std::round((near_s - time_of_day_s) / asterix::kDay);
}

/// Times of a sensor on the receiver's clock.
///
/// Clocks of sensors are often wrong and seldom drift. A time that is at most `limit_s` from that
/// of reception is right. Otherwise the difference is held as the offset of the sensor's clock,
/// until a time is again more than `limit_s` from where the offset puts it.
class SensorClock {
 public:
  /// Throws `std::invalid_argument` unless the limit, s, is finite and positive.
  explicit SensorClock(double limit_s = 5.0) : limit_s_(limit_s) {
    require(limit_s > 0.0 && limit_s < 0.5 * asterix::kDay, "limit_s", "from 0 to half a day",
            limit_s);
  }

  /// The time on the receiver's clock, on the day nearest to that of reception; that of reception
  /// for NaN.
  double operator()(double time_s, double received_s) noexcept {
    if (std::isnan(time_s)) return received_s;
    double on_time_s = on_nearest_day(time_s + offset_s_, received_s);
    if (std::abs(received_s - on_time_s) > limit_s_) {
      const double near_s = on_nearest_day(time_s, received_s);
      const double late_s = received_s - near_s;
      offset_s_ = std::abs(late_s) > limit_s_ ? late_s : 0.0;
      ++changes_;
      on_time_s = near_s + offset_s_;
    }
    return on_time_s;
  }

  /// What is added to the sensor's times; 0 where its clock is right.
  [[nodiscard]] double offset_s() const noexcept { return offset_s_; }
  /// How often the offset has changed.
  [[nodiscard]] int changes() const noexcept { return changes_; }

 private:
  double limit_s_;
  double offset_s_ = 0.0;
  int changes_ = 0;
};

}  // namespace wakeline
