// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// Field tables: a parameter struct lists its fields once, with rule, unit and one sentence each.
// Validation, archives, Python keywords, docstrings, settings files and the table in the
// documentation are derived from that list.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "wakeline/core/require.hpp"

namespace wakeline {

/// The interval that a number must be in. NaN is in none.
struct Rule {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above_low = false;   ///< `low` itself is excluded
  bool below_high = false;  ///< `high` itself is excluded
  bool or_zero = false;     ///< zero is allowed, too
  const char* words = "";   ///< in place of those made of the bounds

  [[nodiscard]] constexpr bool holds(double value) const noexcept {
    if (or_zero && value == 0.0) return true;
    return (above_low ? value > low : value >= low) && (below_high ? value < high : value <= high);
  }

  friend constexpr bool operator==(const Rule&, const Rule&) = default;
};

/// The square of a standard deviation; NaN of one that breaks its rule, so that a step with it
/// fails.
constexpr double variance(const Rule& rule, double std) noexcept {
  return rule.holds(std) ? std * std : std::numeric_limits<double>::quiet_NaN();
}

inline constexpr double kLargest = std::numeric_limits<double>::max();

inline constexpr Rule kNumber{.words = "a number"};  ///< infinite ones, too
inline constexpr Rule kFinite{.low = -kLargest, .high = kLargest, .words = "finite"};
inline constexpr Rule kPositive{
    .low = 0.0, .high = kLargest, .above_low = true, .words = "finite and positive"};
inline constexpr Rule kNotNegative{
    .low = 0.0, .high = kLargest, .words = "finite and not negative"};
inline constexpr Rule kNotNegativeOrInfinite{.low = 0.0, .words = "not negative"};
inline constexpr Rule kProbability{
    .low = 0.0, .high = 1.0, .words = "a probability between 0 and 1"};
/// A mean time, whose rate and shares have digits left.
inline constexpr Rule kTime{.low = 1e-3, .high = 1e12, .words = "0.001 s to 1e12 s"};
inline constexpr Rule kTimeOrZero{
    .low = 1e-3, .high = 1e12, .or_zero = true, .words = "0, or 0.001 s to 1e12 s"};

/// Both bounds are allowed.
constexpr Rule between(double low, double high) noexcept { return {.low = low, .high = high}; }
/// Neither bound is allowed.
constexpr Rule inside(double low, double high) noexcept {
  return {.low = low, .high = high, .above_low = true, .below_high = true};
}
/// `low` is allowed, `high` is not.
constexpr Rule from_to_below(double low, double high) noexcept {
  return {.low = low, .high = high, .below_high = true};
}
/// `high` is allowed, `low` is not.
constexpr Rule above_to(double low, double high) noexcept {
  return {.low = low, .high = high, .above_low = true};
}
/// From `low` on.
constexpr Rule at_least(double low) noexcept { return {.low = low, .high = kLargest}; }

/// The largest magnitude of a quantity by its unit: beyond what a radar, a vessel or a study has,
/// and such that squares and products of several quantities are finite.
struct UnitLimit {
  std::string_view unit;
  double most;
};
inline constexpr std::array<UnitLimit, 16> kUnitLimits{{
    {"1", 1e6},
    {"m", 1e9},
    {"m/s", 1e6},
    {"m/s²", 1e6},
    {"m²/s³", 1e9},
    {"m²/s⁵", 1e9},
    {"rad", 10.0},
    {"rad/s", 1e3},
    {"rad²/s", 1e3},
    {"rad²/s³", 1e3},
    {"s", 1e12},
    {"1/m²", 1e3},
    {"1/volume", 1e9},
    {"sigma", 1e3},
    {"sigma²", 1e6},
    {"counts", 65535.0},
}};
inline constexpr double kLargestCount = 1e9;  ///< of plots, scans, readings and the like
/// The least of a quantity that must be positive: its square and the inverse of that have digits.
inline constexpr double kLeastPositive = 1e-9;

/// The rule of a field in that unit; where it has no bound, that of the unit.
constexpr Rule within(Rule rule, std::string_view unit) noexcept {
  double most = kLargestCount;
  for (const UnitLimit& limit : kUnitLimits)
    if (limit.unit == unit) most = limit.most;
  if (rule.low == -kLargest) rule.low = -most;
  if (rule.high != kLargest) return rule;
  rule.high = most;
  rule.words = "";
  if (rule.low == 0.0 && rule.above_low) {
    rule.low = kLeastPositive;
    rule.above_low = false;
  }
  return rule;
}

/// "1e9", "0.001", "6.28319".
[[gnu::noinline]] inline std::string bound_text(double bound) {
  char number[32];
  std::snprintf(number, sizeof number, "%.6g", bound);
  std::string text = number;
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  const std::size_t sign = exponent + 1, digits = text.find_first_not_of("+-0", sign);
  return text.substr(0, sign) + (text[sign] == '-' ? "-" : "") + text.substr(digits);
}

/// What a rule asks for, to be read after "must be".
inline std::string to_words(const Rule& rule) {
  if (*rule.words != '\0') return rule.words;
  const std::string low = bound_text(rule.low), high = bound_text(rule.high);
  const std::string zero = rule.or_zero ? "0, or " : "";
  if (rule.high == kLargest) return zero + (rule.above_low ? "above " : "at least ") + low;
  if (!rule.above_low && !rule.below_high) return zero + low + " to " + high;
  return zero + (rule.above_low ? "above " : "at least ") + low + " and " +
         (rule.below_high ? "below " : "at most ") + high;
}

/// What an enumerator is called in settings files and in Python.
template <class Enum>
struct Word {
  const char* text;
  Enum value;
};

/// An enumeration whose words are given by a function `words_of(Enum)`, found beside it, that
/// returns an array of `Word<Enum>`.
template <class Enum>
concept NamedEnum = std::is_enum_v<Enum> && requires {
  words_of(Enum{});
};

/// The words to choose from: "'all', 'nearest' or 'strongest'".
template <NamedEnum Enum>
std::string choices() {
  constexpr auto words = words_of(Enum{});
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    text += (k == 0 ? "'" : k + 1 < words.size() ? "', '" : "' or '") + std::string(words[k].text);
  return text + "'";
}

/// One field of a parameter struct. Its rule is a finite range.
template <class Struct, class Value>
struct Field {
  const char* name;
  Value Struct::*member;
  Rule rule;
  const char* unit;      ///< "" where there is none, "1" for a ratio
  const char* sentence;  ///< what it is
};

/// A line of a field table: name, member, rule, unit and one sentence.
template <class Struct, class Value>
constexpr Field<Struct, Value> field(const char* name, Value Struct::*member, const Rule& rule,
                                     const char* unit, const char* sentence) noexcept {
  return {name, member, within(rule, unit), unit, sentence};
}

/// A truth, an enumeration or another struct, which has no number to be ruled.
template <class Struct, class Value>
constexpr Field<Struct, Value> field(const char* name, Value Struct::*member,
                                     const char* sentence) noexcept {
  return {name, member, kNumber, "", sentence};
}

/// A table of fields, and of other tables: a function that calls another for each `Field` in order.
/// (A `std::tuple` of them would be a hundred templates for each struct.)
template <class... Entries>
constexpr auto field_table(const Entries&... entries) noexcept {
  return [=](auto&& visit) {
    const auto visit_entry = [&](const auto& entry) {
      if constexpr (requires { entry.member; })
        visit(entry);
      else
        entry(visit);
    };
    (visit_entry(entries), ...);
  };
}

/// A struct with a table of its fields: `static constexpr auto fields()` returns a `field_table`.
template <class Struct>
concept HasFields = requires {
  Struct::fields();
};

/// The table of a struct, made by the compiler.
template <HasFields Struct>
inline constexpr auto kFieldsOf = Struct::fields();

/// Calls `visit(field, value)` for each field of a struct, in order.
template <class Struct, class Visit>
constexpr void for_each_field(Struct& x, Visit&& visit) {
  kFieldsOf<std::remove_const_t<Struct>>([&](const auto& entry) { visit(entry, x.*entry.member); });
}

/// Rejects a number that breaks the rule.
inline void require_rule(const Rule& rule, const std::string& name, double value) {
  if (!rule.holds(value))
    reject(name + " must be " + to_words(rule) + ", got " + number_text(value));
}

/// Throws `std::invalid_argument` in words that name the first field whose rule does not hold, that
/// of a struct inside with the name of both: "own.north_m must be finite, got nan".
template <HasFields Struct>
void validate_fields(const Struct& x, const std::string& prefix = "") {
  for_each_field(x, [&]<class Value>(const auto& entry, const Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      if (!entry.rule.holds(static_cast<double>(value)))
        require_rule(entry.rule, prefix + entry.name, static_cast<double>(value));
    } else if constexpr (NamedEnum<Value>) {
      bool known = false;
      for (const auto& word : words_of(value)) known = known || word.value == value;
      if (!known) reject(prefix + entry.name + " must be " + choices<Value>());
    } else if constexpr (HasFields<Value>) {
      validate_fields(value, prefix + entry.name + ".");
      if constexpr (requires { value.validate(); }) value.validate();
    }
  });
}

/// Throws what `model.validate()` throws; where there is none, what `validate_fields` does for a
/// struct with a table.
template <class Model>
const Model& validated(const Model& model) {
  if constexpr (requires { model.validate(); })
    model.validate();
  else if constexpr (HasFields<Model>)
    validate_fields(model);
  return model;
}

}  // namespace wakeline
