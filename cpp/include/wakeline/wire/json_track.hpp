// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Tracks as JSON lines: one object a line, SI units, radians, UTC seconds; unknown numbers are
// null.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "wakeline/core/angle.hpp"
#include "wakeline/core/types.hpp"

namespace wakeline {

/// A track as it is written; texts are UTF-8.
struct JsonTrack {
  /// Where it is.
  struct Place {
    double latitude_deg, longitude_deg;
  };
  /// Where it is seen from own ship.
  struct Direction {
    double range_m, bearing_rad;
  };
  /// The closest approach to own ship.
  struct Approach {
    double cpa_m, tcpa_s;
    double probability;  ///< of a distance below the limit
  };

  std::int64_t id = 0;
  std::string_view status = {}, name = {}, mode = {};
  double time_s = 0.0;          ///< of the estimate
  Gaussian<4> kinematics = {};  ///< `[x, vx, y, vy]`
  std::span<const double> mode_probability = {};
  double existence = 0.0;
  std::int64_t hits = 0, misses = 0;
  std::string_view identity = {};  ///< of the vessel that reports; empty without one
  double identity_probability = 0.0, identity_time_s = NAN;
  double mean_nis = NAN, mean_nis_lower = NAN, mean_nis_upper = NAN;
  double whiteness = NAN, whiteness_bound = NAN;
  std::optional<Place> place = {};
  std::optional<Direction> direction = {};
  std::optional<Approach> approach = {};
  std::optional<std::string_view> radar = {};  ///< whose sector has updated the track
};

/// Appends JSON to a text.
class JsonWriter {
 public:
  explicit JsonWriter(std::string& out) : out_(out) {}

  /// What is JSON already.
  JsonWriter& raw(std::string_view json) {
    out_ += json;
    return *this;
  }
  JsonWriter& integer(std::int64_t value) {
    std::array<char, 24> text;
    return raw({text.data(), std::to_chars(text.begin(), text.end(), value).ptr});
  }
  /// With so many decimal places.
  JsonWriter& fixed(double value, int places) {
    return number(value, std::chars_format::fixed, places);
  }
  /// With so many significant digits.
  JsonWriter& general(double value, int digits) {
    return number(value, std::chars_format::general, digits);
  }
  JsonWriter& general(std::span<const double> values, int digits) {
    const char* before = "[";
    for (const double value : values) {
      raw(before).general(value, digits);
      before = ",";
    }
    return raw(values.empty() ? "[]" : "]");
  }
  JsonWriter& text(std::string_view utf8) {
    constexpr std::string_view kHex = "0123456789abcdef";
    out_ += '"';
    for (const char c : utf8) {
      const auto octet = static_cast<unsigned char>(c);
      if (octet < 0x20) {
        raw("\\u00");
        out_ += kHex[octet >> 4];
        out_ += kHex[octet & 15];
        continue;
      }
      if (c == '"' || c == '\\') out_ += '\\';
      out_ += c;
    }
    out_ += '"';
    return *this;
  }

 private:
  JsonWriter& number(double value, std::chars_format format, int precision) {
    if (!std::isfinite(value)) return raw("null");
    std::array<char, 352> text;  // of the largest double, with its places
    const auto end = std::to_chars(text.begin(), text.end(), value, format, precision);
    return raw({text.data(), end.ptr});
  }

  std::string& out_;
};

/// Appends a line of version 1, with its end.
inline void append_track_line(const JsonTrack& track, std::string& out) {
  const Vec<double, 4>& mean = track.kinematics.mean;
  const Mat<double, 4, 4>& covariance = track.kinematics.covariance;
  JsonWriter json(out);
  json.raw(R"({"version":1,"type":"track","track_id":)").integer(track.id);
  json.raw(R"(,"status":)").text(track.status);
  json.raw(R"(,"name":)").text(track.name);
  json.raw(R"(,"time_s":)").fixed(track.time_s, 6);
  json.raw(R"(,"north_m":)").fixed(mean[0], 3);
  json.raw(R"(,"east_m":)").fixed(mean[2], 3);
  json.raw(R"(,"vnorth_mps":)").fixed(mean[1], 5);
  json.raw(R"(,"veast_mps":)").fixed(mean[3], 5);
  json.raw(R"(,"covariance":)");
  for (int row = 0; row < 4; ++row)
    json.raw(row == 0 ? "[" : ",").general({covariance.col(row).data(), 4}, 8);  // symmetric
  json.raw(R"(],"course_rad":)").fixed(compass_angle(std::atan2(mean[3], mean[1])), 6);
  json.raw(R"(,"speed_mps":)").fixed(std::hypot(mean[1], mean[3]), 5);
  json.raw(R"(,"mode":)").text(track.mode);
  json.raw(R"(,"mode_probability":)").general(track.mode_probability, 6);
  json.raw(R"(,"existence":)").general(track.existence, 6);
  json.raw(R"(,"hits":)").integer(track.hits);
  json.raw(R"(,"misses":)").integer(track.misses);
  json.raw(R"(,"nis":{"mean":)").fixed(track.mean_nis, 3);
  json.raw(R"(,"lower":)").fixed(track.mean_nis_lower, 3);
  json.raw(R"(,"upper":)").fixed(track.mean_nis_upper, 3);
  json.raw(R"(},"whiteness":{"value":)").fixed(track.whiteness, 3);
  json.raw(R"(,"bound":)").fixed(track.whiteness_bound, 3);
  json.raw(R"(},"identity":)").text(track.identity);
  json.raw(R"(,"identity_probability":)").general(track.identity_probability, 5);
  json.raw(R"(,"identity_time_s":)").fixed(track.identity_time_s, 3);
  if (track.place) {
    json.raw(R"(,"latitude_deg":)").fixed(track.place->latitude_deg, 9);
    json.raw(R"(,"longitude_deg":)").fixed(track.place->longitude_deg, 9);
  }
  if (track.direction) {
    json.raw(R"(,"range_m":)").fixed(track.direction->range_m, 3);
    json.raw(R"(,"bearing_rad":)").fixed(track.direction->bearing_rad, 7);
  }
  if (track.approach) {
    json.raw(R"(,"cpa":{"cpa_m":)").fixed(track.approach->cpa_m, 2);
    json.raw(R"(,"tcpa_s":)").fixed(track.approach->tcpa_s, 2);
    json.raw(R"(,"probability":)").fixed(track.approach->probability, 5).raw("}");
  }
  if (track.radar) json.raw(R"(,"radar":)").text(*track.radar);
  json.raw("}\n");
}

}  // namespace wakeline
