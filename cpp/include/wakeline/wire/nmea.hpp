// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Sentences of NMEA 0183 (IEC 61162-1) that a radar sends: TTM, TLL and OSD.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/asterix.hpp"
#include "wakeline/navigation/geodesy.hpp"

namespace wakeline {

/// One sentence under construction, at most 82 characters from `$` to the line feed. Numbers do not
/// depend on the locale; never allocates.
class NmeaSentence {
 public:
  static constexpr std::size_t kMost = 82;

  /// Starts `$` and a talker and sentence formatter, e.g. "RATTM".
  void begin(std::string_view address) noexcept {
    size_ = 0;
    overflow_ = false;
    put('$');
    for (const char letter : address) put(letter);
  }

  /// An empty field.
  void empty() noexcept { put(','); }

  void field(std::string_view text) noexcept {
    put(',');
    for (const char letter : text) put(letter);
  }

  /// A number rounded to so many decimals, with at least so many digits before the point; an empty
  /// field for NaN.
  void field(double value, int decimals, int digits = 1) noexcept {
    put(',');
    if (std::isfinite(value)) append(value, decimals, digits);
  }

  /// An angle in degrees, in [0, 360) also after rounding, with three digits before the point.
  void angle(double angle_rad, int decimals) noexcept {
    const double scale = power(decimals);
    const double steps = std::round(compass_angle(angle_rad) * (180.0 / kPi<double>)*scale);
    field(std::fmod(steps, 360.0 * scale) / scale, decimals, 3);
  }

  /// A text of at most `most` characters. Other characters than printable ASCII and those that the
  /// format reserves become
  /// `_`; a character of UTF-8 is one.
  void text(std::string_view text, std::size_t most) noexcept {
    put(',');
    for (const char letter : text) {
      const auto code = static_cast<unsigned char>(letter);
      if ((code & 0xC0) == 0x80) continue;  // within a character of UTF-8
      if (most-- == 0) break;
      constexpr std::string_view reserved = "$*,!\\^~";
      const bool plain = code >= 0x20 && code < 0x7F && reserved.find(letter) == reserved.npos;
      put(plain ? letter : '_');
    }
  }

  /// The time of day as hhmmss.ss; an empty field where it is not finite.
  void time_of_day(double time_s) noexcept {
    if (!std::isfinite(time_s)) return empty();
    const std::int64_t day = 8'640'000;  // in hundredths
    const std::int64_t of_day = std::llround(100.0 * asterix::time_of_day(time_s)) % day;
    const std::int64_t minutes = of_day / 6000;
    put(',');
    digits(minutes / 60, 2);
    digits(minutes % 60, 2);
    append(static_cast<double>(of_day % 6000) / 100.0, 2, 2);
  }

  /// A latitude or longitude as degrees and minutes with five decimals, and its letter.
  void latitude(double latitude_rad) noexcept { place(latitude_rad, 2, 'N', 'S'); }
  void longitude(double longitude_rad) noexcept { place(wrap_angle(longitude_rad), 3, 'E', 'W'); }

  /// Characters left for fields, but for the checksum and the end of the line.
  [[nodiscard]] std::size_t left() const noexcept { return kMost - kTail - size_; }

  /// Appends checksum and end of line; empty when it was too long.
  std::string_view end() noexcept {
    if (overflow_) return {};
    unsigned sum = 0;
    for (std::size_t k = 1; k < size_; ++k) sum ^= static_cast<unsigned char>(text_[k]);
    constexpr std::string_view hex = "0123456789ABCDEF";
    for (const char letter : {'*', hex[sum >> 4], hex[sum & 15], '\r', '\n'})
      text_[size_++] = letter;
    return {text_.data(), size_};
  }

 private:
  static constexpr std::size_t kTail = 5;  ///< "*hh\r\n"

  static double power(int decimals) noexcept {
    double scale = 1.0;
    for (int k = 0; k < decimals; ++k) scale *= 10.0;
    return scale;
  }

  void put(char letter) noexcept {
    if (left() == 0)
      overflow_ = true;
    else
      text_[size_++] = letter;
  }

  void digits(std::int64_t number, int count) noexcept {
    std::array<char, 20> backwards{};
    int size = 0;
    for (; number > 0 || size < count; number /= 10)
      backwards[static_cast<std::size_t>(size++)] = static_cast<char>('0' + number % 10);
    while (size > 0) put(backwards[static_cast<std::size_t>(--size)]);
  }

  void append(double value, int decimals, int digits_before) noexcept {
    const double scale = power(decimals), scaled = std::round(std::abs(value) * scale);
    if (!(scaled < 1e15)) {
      overflow_ = true;
      return;
    }
    const auto steps = static_cast<std::int64_t>(scaled), unit = static_cast<std::int64_t>(scale);
    if (value < 0.0 && steps > 0) put('-');
    digits(steps / unit, digits_before);
    if (decimals == 0) return;
    put('.');
    digits(steps % unit, decimals);
  }

  void place(double angle_rad, int degree_digits, char positive, char negative) noexcept {
    const double minutes = std::round(std::abs(angle_rad) * (180.0 * 60.0 / kPi<double>)*1e5);
    const double degrees = std::floor(minutes / 60e5);
    put(',');
    digits(static_cast<std::int64_t>(degrees), degree_digits);
    append((minutes - 60e5 * degrees) / 1e5, 5, 2);
    put(',');
    put(angle_rad < 0.0 ? negative : positive);
  }

  std::array<char, kMost> text_{};
  std::size_t size_ = 0;
  bool overflow_ = false;
};

/// A target as TTM and TLL describe it. NaN is an empty field.
struct NmeaTarget {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  int number = 0;
  double range_m = kNone;
  double bearing_rad = kNone;  ///< true, from own ship
  GeoPoint place = {kNone, kNone};
  double speed_mps = kNone;   ///< over ground
  double course_rad = kNone;  ///< over ground, true
  double cpa_m = kNone;
  double tcpa_s = kNone;  ///< negative in the past
  std::string_view name;
  bool lost = false;
  double time_s = 0.0;     ///< UTC, since a midnight
  bool acquiring = false;  ///< not yet followed
  bool manual = false;     ///< acquired by the operator

  [[nodiscard]] std::string_view status() const noexcept {
    return lost ? "L" : acquiring ? "Q" : "T";
  }
};

/// Own ship as OSD describes it. NaN is an empty field.
struct NmeaOwnShip {
  double heading_rad = NAN;  ///< true; NaN: V, not valid
  double course_rad = NAN;   ///< over ground, true
  double speed_mps = NAN;    ///< over ground
};

namespace detail {

inline constexpr double kMile_m = asterix::kNauticalMile;
inline double knots_of(double speed_mps) noexcept { return speed_mps / knots(1.0); }
inline constexpr std::size_t kLongestName = 20;  ///< what OpenCPN shows

}  // namespace detail

/// TTM, tracked target message: range and bearing from own ship, in true directions. A lost target
/// has the status L, any other T; OpenCPN takes a range of 0 for a lost one, so that 0.001 NM is
/// the least. The name is cut to the room left, a range or speed beyond 999 NM or kn gives no
/// sentence.
inline std::string_view write_ttm(NmeaSentence& sentence, std::string_view talker,
                                  const NmeaTarget& target) noexcept {
  const double range_nm = std::max(target.range_m / detail::kMile_m, 0.001);
  const double speed_kn = detail::knots_of(target.speed_mps);
  if (!(range_nm < 999.9995) || speed_kn >= 999.95 || !std::isfinite(target.bearing_rad)) return {};
  const double cpa_nm = target.cpa_m / detail::kMile_m, tcpa_min = target.tcpa_s / 60.0;
  const bool soon = std::abs(tcpa_min) < 999.5;  // else of no use, as for one that does not move
  std::array<char, 5> address{talker[0], talker[1], 'T', 'T', 'M'};
  sentence.begin({address.data(), address.size()});
  sentence.field(target.number, 0, 2);
  sentence.field(range_nm, 3);
  sentence.angle(target.bearing_rad, 3);
  sentence.field("T");
  sentence.field(speed_kn, 1);
  sentence.angle(target.course_rad, 1);
  sentence.field("T");
  sentence.field(cpa_nm < 999.995 ? cpa_nm : NAN, 2);
  sentence.field(soon ? tcpa_min : NAN, std::abs(tcpa_min) < 99.95 ? 1 : 0);
  sentence.field("N");
  constexpr std::size_t rest = std::string_view(",,L,,235959.99,A").size();
  const std::size_t room = sentence.left() - std::min(sentence.left(), rest);
  sentence.text(target.name, std::min(room, detail::kLongestName));
  sentence.field(target.status());
  sentence.empty();
  sentence.time_of_day(target.time_s);
  sentence.field(target.manual ? "M" : "A");
  return sentence.end();
}

/// TLL, target latitude and longitude, for receivers that cannot use TTM.
inline std::string_view write_tll(NmeaSentence& sentence, std::string_view talker,
                                  const NmeaTarget& target) noexcept {
  if (!std::isfinite(target.place.latitude_rad + target.place.longitude_rad)) return {};
  std::array<char, 5> address{talker[0], talker[1], 'T', 'L', 'L'};
  sentence.begin({address.data(), address.size()});
  sentence.field(target.number, 0, 2);
  sentence.latitude(target.place.latitude_rad);
  sentence.longitude(target.place.longitude_rad);
  sentence.text(target.name, detail::kLongestName);
  sentence.time_of_day(target.time_s);
  sentence.field(target.status());
  sentence.empty();
  return sentence.end();
}

/// OSD, own ship data; course and speed are those over ground (P, positioning system).
inline std::string_view write_osd(NmeaSentence& sentence, std::string_view talker,
                                  const NmeaOwnShip& own) noexcept {
  const bool valid = std::isfinite(own.heading_rad);
  std::array<char, 5> address{talker[0], talker[1], 'O', 'S', 'D'};
  sentence.begin({address.data(), address.size()});
  sentence.angle(own.heading_rad, 1);
  sentence.field(valid ? "A" : "V");
  sentence.angle(own.course_rad, 1);
  sentence.field(std::isfinite(own.course_rad) ? "P" : "");
  sentence.field(detail::knots_of(own.speed_mps), 1);
  sentence.field(std::isfinite(own.speed_mps) ? "P" : "");
  sentence.empty();
  sentence.empty();
  sentence.field("N");
  return sentence.end();
}

}  // namespace wakeline
