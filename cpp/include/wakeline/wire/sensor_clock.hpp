// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Times of day and wrong clocks of sensors.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
/// of reception is right; the difference of a first time that is not is held as the offset of the
/// sensor's clock. It is found again when all times have been more than `limit_s` from where the
/// offset puts them for `kPatience_s`. Until then such a time is that of data that come late, where
/// it is before the reception, and else that of reception.
class SensorClock {
 public:
  /// Of reception, after which a clock counts as changed: longer than a connection that was
  /// held up takes to deliver what has waited.
  static constexpr double kPatience_s = 10.0;

  /// Throws `std::invalid_argument` unless the limit, s, is finite and positive.
  explicit SensorClock(double limit_s = 5.0) : limit_s_(limit_s) {
    require(limit_s > 0.0 && limit_s < 0.5 * asterix::kDay, "limit_s", "from 0 to half a day",
            limit_s);
  }

  /// The time on the receiver's clock, on the day nearest to that of reception; that of reception
  /// for NaN.
  double operator()(double time_s, double received_s) noexcept {
    if (std::isnan(time_s)) return received_s;
    const bool is_known = std::exchange(is_known_, true);
    const double on_time_s = on_nearest_day(time_s + offset_s_, received_s);
    if (std::abs(received_s - on_time_s) <= limit_s_) {
      astray_since_s_ = kNever;
      return on_time_s;
    }
    if (is_known && astray_since_s_ == kNever) astray_since_s_ = received_s;
    if (std::abs(received_s - astray_since_s_) < kPatience_s)
      return std::min(on_time_s, received_s);
    const double near_s = on_nearest_day(time_s, received_s);
    const double late_s = received_s - near_s;
    offset_s_ = std::abs(late_s) > limit_s_ ? late_s : 0.0;
    ++changes_;
    astray_since_s_ = kNever;
    return near_s + offset_s_;
  }

  /// What is added to the sensor's times; 0 where its clock is right.
  [[nodiscard]] double offset_s() const noexcept { return offset_s_; }
  /// How often the offset has changed.
  [[nodiscard]] int changes() const noexcept { return changes_; }

 private:
  static constexpr double kNever = -std::numeric_limits<double>::infinity();

  double limit_s_;
  double offset_s_ = 0.0;
  double astray_since_s_ = kNever;  ///< reception of the first of the times that are not right
  bool is_known_ = false;           ///< whether a time has come
  int changes_ = 0;
};

}  // namespace wakeline
